#include "effects/shadow_lights/light_tree.h"

#include "host/render/luminance.h"
#include "kernels/shared/shadow_lights.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace wedge::render {
namespace {

constexpr double pi = 3.14159265358979323846;

/// Of places: columns [left, right) of rows [top, bottom).
struct Rectangle {
    int left, right, top, bottom;
};

/// Light of some places.
struct Light {
    glm::dvec3 irradiance { 0 }, moment { 0 };
    double luminance = 0;
    double within = 0; ///< variance of directions in places, times luminance

    void add(const Light& other)
    {
        irradiance += other.irradiance;
        moment += other.moment;
        luminance += other.luminance;
        within += other.within;
    }
};

class Tree {
public:
    explicit Tree(const MapPlaces& places)
        : places_(places)
    {
        numbers_.resize(treeParts(places.all.size()) * WEDGE_TREE_FLOATS);
    }

    std::vector<float> take()
    {
        add({ 0, places_.columns, 0, places_.rows }, 0);
        return std::move(numbers_);
    }

private:
    /// The part of a rectangle at an index, and behind it all below it.
    Light add(const Rectangle& r, std::size_t index)
    {
        Light light;
        std::size_t parts = 1;
        glm::dvec3 middle(0.0);
        if (r.right - r.left == 1 && r.bottom - r.top == 1) {
            const MapPlace& place = places_.all[indexOf(r.left, r.top)];
            light = { place.irradiance, place.moment, luminanceOf(place.irradiance), 0 };
            // A square varies by 1/12 of its side's square.
            light.within = place.solidAngle / 12.0 * light.luminance;
            middle = place.direction;
        } else {
            const auto [first, second] = halves(r);
            light = add(first, index + 1);
            parts += countOf(first);
            light.add(add(second, index + parts));
            parts += countOf(second);
            middle = places_.all[indexOf((r.left + r.right) / 2, (r.top + r.bottom) / 2)].direction;
        }
        store(light, r, middle, parts, index);
        return light;
    }

    void store(const Light& light, const Rectangle& r, const glm::dvec3& middle, std::size_t parts, std::size_t index)
    {
        const double length = light.luminance > 0 ? glm::length(light.moment) / light.luminance : 0.0;
        // Of light that comes from all sides there is no middle.
        constexpr double leastLength = 1e-6;
        const glm::dvec3 own = length > leastLength ? glm::normalize(light.moment) : middle;
        const glm::dvec3 towards = glm::normalize(places_.axes * own);
        const double variance =
            std::max(0.0, 1.0 - length) + (light.luminance > 0 ? light.within / light.luminance : 0);
        float* out = numbers_.data() + index * WEDGE_TREE_FLOATS;
        for (int axis = 0; axis < 3; ++axis) {
            out[axis] = static_cast<float>(light.irradiance[axis]);
            out[3 + axis] = static_cast<float>(towards[axis]);
        }
        out[6] = static_cast<float>(variance);
        out[7] = static_cast<float>(parts);
        out[8] = static_cast<float>(radius(own, r));
    }

    /// The largest angle between a direction of the map and a rectangle's, radians.
    double radius(const glm::dvec3& from, const Rectangle& r) const
    {
        const double across = 2.0 * pi / places_.columns, down = pi / places_.rows;
        // Meridians and parallels bend: of what is wider there may be something that is farther than all corners.
        constexpr double widest = 0.5;
        if (across * (r.right - r.left) > widest && down * (r.bottom - r.top) > widest) {
            return pi;
        }
        double least = 1.0;
        for (const int column : { r.left, (r.left + r.right) / 2, r.right }) {
            for (const int row : { r.top, r.bottom }) {
                const double angle = column * across - pi, polar = row * down;
                const glm::dvec3 corner(
                    std::sin(polar) * std::sin(angle), std::cos(polar), -std::sin(polar) * std::cos(angle));
                least = std::min(least, glm::dot(from, corner));
            }
        }
        return std::acos(std::clamp(least, -1.0, 1.0));
    }

    /// Across what is longer on the sphere.
    std::pair<Rectangle, Rectangle> halves(const Rectangle& r) const
    {
        const double down = pi * (r.bottom - r.top) / places_.rows;
        const double nearest = pi * (0.5 * (r.bottom + r.top)) / places_.rows;
        const double across = 2.0 * pi * (r.right - r.left) / places_.columns * std::sin(nearest);
        Rectangle first = r, second = r;
        if (r.right - r.left > 1 && (r.bottom - r.top == 1 || across > down)) {
            first.right = second.left = (r.left + r.right) / 2;
        } else {
            first.bottom = second.top = (r.top + r.bottom) / 2;
        }
        return { first, second };
    }

    static std::size_t countOf(const Rectangle& r)
    {
        return treeParts(static_cast<std::size_t>(r.right - r.left) * static_cast<std::size_t>(r.bottom - r.top));
    }

    std::size_t indexOf(int column, int row) const
    {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(places_.columns)
            + static_cast<std::size_t>(column);
    }

    const MapPlaces& places_;
    std::vector<float> numbers_;
};

} // namespace

std::vector<float> lightTree(const MapPlaces& places) { return Tree(places).take(); }

} // namespace wedge::render
