#include "effects/shadow_lights/map_lights.h"

#include "host/error.h"
#include "host/render/luminance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>

#include <fmt/format.h>

namespace wedge::render {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr int fewestColumns = 64, fewestRows = 32, mostColumns = 512, mostRows = 256;
/// Thresholds of luminance are 0 to levels - 1 times its standard deviation.
constexpr int levels = 6;
/// Steradians: what is smaller is hidden as a whole.
constexpr double coherent = 0.01;

using Places = std::vector<std::uint32_t>;

void requireEnough(std::size_t places, std::size_t lights)
{
    if (lights > places) {
        throw UsageError("the environment's map has fewer places for lights",
            fmt::format("{} lights, {} places", lights, places),
            fmt::format("give --shadow-lights {} or less", places));
    }
}

/// Points one after the other, and the cells that places are in by those that there are.
class Spread {
public:
    explicit Spread(const MapPlaces& places)
        : places_(places)
        , nearest_(places.all.size(), -2.0)
        , cells_ { {}, std::vector<std::uint32_t>(places.all.size(), 0) }
    {
    }

    MapCells take() { return std::move(cells_); }

    /// So many more, of a part of the sphere.
    /// first: whether no point is in or around it, so that the first is to be in its middle
    void add(const Places& part, std::size_t points, bool first)
    {
        for (std::size_t i = 0; i < points; ++i) {
            addPoint(first && i == 0 ? middleOf(part) : farthestOf(part));
        }
    }

private:
    void addPoint(std::uint32_t place)
    {
        const auto number = static_cast<std::uint32_t>(cells_.points.size());
        cells_.points.push_back(place);
        isPoint_[place] = true;
        const glm::dvec3 at = places_.all[place].direction;
        for (std::size_t i = 0; i < nearest_.size(); ++i) {
            const double cosine = glm::dot(at, places_.all[i].direction);
            if (cosine > nearest_[i]) {
                nearest_[i] = cosine;
                cells_.cellOf[i] = number;
            }
        }
        cells_.cellOf[place] = number; // rounding or not
        nearest_[place] = 2.0;
    }

    std::uint32_t farthestOf(const Places& part) const
    {
        return *std::ranges::min_element(part, {}, [&](std::uint32_t i) { return nearest_[i]; });
    }

    /// Nearest to the middle of the part's light.
    std::uint32_t middleOf(const Places& part) const
    {
        glm::dvec3 moment(0.0);
        for (const std::uint32_t i : part) {
            moment += places_.all[i].moment;
        }
        return *std::ranges::max_element(part, {},
            [&](std::uint32_t i) { return isPoint_[i] ? -1e300 : glm::dot(places_.all[i].direction, moment); });
    }

    const MapPlaces& places_;
    std::vector<double> nearest_; ///< cosine of the angle to the nearest point
    std::vector<bool> isPoint_ = std::vector<bool>(nearest_.size(), false);
    MapCells cells_;
};

/// What those that are not full want of `count`, by weights, or where these weigh nothing by room.
std::vector<double> wanted(std::span<const double> weights, std::span<const std::size_t> room,
    const std::vector<bool>& full, std::size_t count)
{
    double total = 0, all = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        total += full[i] ? 0.0 : weights[i];
        all += full[i] ? 0.0 : static_cast<double>(room[i]);
    }
    std::vector<double> out(weights.size(), 0.0);
    for (std::size_t i = 0; i < weights.size(); ++i) {
        const double share = total > 0 ? weights[i] / total : static_cast<double>(room[i]) / std::max(all, 1.0);
        out[i] = full[i] ? 0.0 : static_cast<double>(count) * share;
    }
    return out;
}

/// Shares `count` out by weights, each at most what there is room for, the largest remainders first. count: at most all
/// of the room
std::vector<std::size_t> shared(std::span<const double> weights, std::span<const std::size_t> room, std::size_t count)
{
    std::vector<std::size_t> out(weights.size(), 0);
    std::vector<bool> full(weights.size(), false);
    std::vector<double> ideal = wanted(weights, room, full, count);
    std::size_t left = count;
    for (bool more = true; more;) { // who has no room leaves the rest to the others
        more = false;
        for (std::size_t i = 0; i < weights.size(); ++i) {
            if (!full[i] && ideal[i] > static_cast<double>(room[i])) {
                full[i] = more = true;
                out[i] = room[i];
                left -= room[i];
            }
        }
        ideal = more ? wanted(weights, room, full, left) : ideal;
    }
    for (std::size_t i = 0; i < weights.size(); ++i) {
        const std::size_t whole = std::min(static_cast<std::size_t>(ideal[i]), left);
        out[i] += whole;
        left -= whole;
        ideal[i] -= static_cast<double>(whole);
    }
    for (; left > 0; --left) {
        std::size_t most = weights.size();
        for (std::size_t i = 0; i < weights.size(); ++i) {
            if (out[i] < room[i] && (most == weights.size() || ideal[i] > ideal[most])) {
                most = i;
            }
        }
        ++out[most];
        ideal[most] -= 1.0;
    }
    return out;
}

/// Parts of the sphere within each other, and the points in them.
class Strata {
public:
    Strata(const MapPlaces& places, Spread& spread)
        : places_(places)
        , spread_(spread)
        , luminance_(places.all.size())
        , met_(places.all.size(), 0)
    {
        double mean = 0, square = 0;
        for (std::size_t i = 0; i < luminance_.size(); ++i) {
            luminance_[i] = luminanceOf(places.all[i].irradiance) / places.all[i].solidAngle;
            mean += places.all[i].solidAngle / (4.0 * pi) * luminance_[i];
        }
        for (std::size_t i = 0; i < luminance_.size(); ++i) {
            const double off = luminance_[i] - mean;
            square += places.all[i].solidAngle / (4.0 * pi) * off * off;
        }
        deviation_ = std::sqrt(square);
    }

    /// Points in a part that hangs together at a level; whether any are.
    void share(const Places& part, int level, std::size_t points)
    {
        const std::vector<Places> within = level + 1 < levels ? brighter(part, level + 1) : std::vector<Places> {};
        // What is in none of these comes last.
        Places rest;
        std::ranges::copy_if(part, std::back_inserter(rest), [&](std::uint32_t i) { return met_[i] <= level; });
        std::vector<double> weights;
        std::vector<std::size_t> room;
        for (const Places& each : within) {
            weights.push_back(importance(each));
            room.push_back(each.size());
        }
        weights.push_back(importance(rest));
        room.push_back(rest.size());
        const std::vector<std::size_t> counts = shared(weights, room, points);
        bool none = true;
        for (std::size_t i = 0; i < within.size(); ++i) {
            if (counts[i] > 0) {
                share(within[i], level + 1, counts[i]);
                none = false;
            } else { // parts that get none of their own are as the rest
                rest.insert(rest.end(), within[i].begin(), within[i].end());
            }
        }
        std::ranges::sort(rest);
        spread_.add(rest, counts.back(), none);
    }

private:
    /// Luminance times a root of the solid angle, as far as that is hidden in parts.
    double importance(const Places& part) const
    {
        double luminance = 0, solidAngle = 0;
        for (const std::uint32_t i : part) {
            luminance += luminance_[i] * places_.all[i].solidAngle;
            solidAngle += places_.all[i].solidAngle;
        }
        return luminance * std::sqrt(std::sqrt(std::min(solidAngle, coherent)));
    }

    /// The parts of a part that hang together above a level's threshold.
    std::vector<Places> brighter(const Places& part, int level)
    {
        const double threshold = level * deviation_;
        std::vector<Places> out;
        for (const std::uint32_t first : part) {
            if (met_[first] >= level || luminance_[first] < threshold) {
                continue;
            }
            Places& found = out.emplace_back(Places { first });
            met_[first] = level;
            for (std::size_t i = 0; i < found.size(); ++i) {
                for (const std::uint32_t next : around(found[i])) {
                    if (met_[next] < level && luminance_[next] >= threshold) {
                        met_[next] = level;
                        found.push_back(next);
                    }
                }
            }
        }
        return out;
    }

    /// The four places around one; at the poles that place itself in the stead of one.
    std::array<std::uint32_t, 4> around(std::uint32_t place) const
    {
        const auto columns = static_cast<std::uint32_t>(places_.columns),
                   rows = static_cast<std::uint32_t>(places_.rows);
        const std::uint32_t x = place % columns, row = place - x;
        return { row + (x + 1) % columns, row + (x + columns - 1) % columns, row > 0 ? place - columns : place,
            row + columns < columns * rows ? place + columns : place };
    }

    const MapPlaces& places_;
    Spread& spread_;
    std::vector<double> luminance_; ///< W/(sr m^2)
    std::vector<int> met_; ///< the highest level at which each is in a part
    double deviation_ = 0;
};

} // namespace

PlaceGrid placeGrid(int width, int height)
{
    const auto parts = [](int texels, int fewest) { return (fewest + texels - 1) / texels; };
    const auto together = [](int all, int most) { return (all + most - 1) / most; };
    PlaceGrid grid {};
    grid.timesAcross = parts(width, fewestColumns);
    grid.timesDown = parts(height, fewestRows);
    grid.ofPlaceAcross = together(width * grid.timesAcross, mostColumns);
    grid.ofPlaceDown = together(height * grid.timesDown, mostRows);
    grid.columns = together(width * grid.timesAcross, grid.ofPlaceAcross);
    grid.rows = together(height * grid.timesDown, grid.ofPlaceDown);
    return grid;
}

MapPlaces mapPlaces(const EnvironmentPicture& picture)
{
    const PlaceGrid grid = placeGrid(picture.width, picture.height);
    const int across = picture.width * grid.timesAcross, down = picture.height * grid.timesDown;
    const auto width = static_cast<std::size_t>(picture.width);
    std::vector<glm::dvec3> horizon; // directions of columns, level
    horizon.reserve(static_cast<std::size_t>(across));
    for (int x = 0; x < across; ++x) {
        const double angle = 2.0 * pi * ((x + 0.5) / across - 0.5);
        horizon.emplace_back(std::sin(angle), 0.0, -std::cos(angle));
    }
    MapPlaces out { grid.columns, grid.rows, {},
        glm::dmat3(glm::dvec3(picture.right), glm::dvec3(picture.up), glm::dvec3(picture.back)) };
    out.all.resize(static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows));
    for (int y = 0; y < down; ++y) {
        const double middle = pi * (y + 0.5) / down;
        const double solidAngle = 2.0 * pi / across * (std::cos(pi * y / down) - std::cos(pi * (y + 1) / down));
        const std::size_t row = static_cast<std::size_t>(y / grid.ofPlaceDown) * static_cast<std::size_t>(grid.columns),
                          texels = static_cast<std::size_t>(y / grid.timesDown) * width;
        for (std::size_t x = 0; x < horizon.size(); ++x) {
            const glm::dvec3 direction(
                std::sin(middle) * horizon[x].x, std::cos(middle), std::sin(middle) * horizon[x].z);
            const float* texel =
                picture.radiance.data() + 3 * (texels + x / static_cast<std::size_t>(grid.timesAcross));
            const glm::dvec3 irradiance = solidAngle * glm::dvec3(texel[0], texel[1], texel[2]);
            MapPlace& place = out.all[row + x / static_cast<std::size_t>(grid.ofPlaceAcross)];
            place.direction += solidAngle * direction;
            place.solidAngle += solidAngle;
            place.irradiance += irradiance;
            place.moment += luminanceOf(irradiance) * direction;
        }
    }
    for (MapPlace& place : out.all) {
        place.direction = glm::normalize(place.direction);
    }
    return out;
}

void requirePlaces(const EnvironmentPicture& picture, std::size_t lights)
{
    const PlaceGrid grid = placeGrid(picture.width, picture.height);
    requireEnough(static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows), lights);
}

MapCells mapCells(const MapPlaces& places, std::size_t points)
{
    requireEnough(places.all.size(), points);
    Places all(places.all.size());
    std::iota(all.begin(), all.end(), 0u);
    Spread spread(places);
    Strata(places, spread).share(all, 0, points);
    return spread.take();
}

std::vector<MapLight> mapLights(const MapPlaces& places, const MapCells& cells)
{
    std::vector<glm::dvec3> irradiances(cells.points.size(), glm::dvec3(0.0)), moments = irradiances;
    for (std::size_t i = 0; i < places.all.size(); ++i) {
        irradiances[cells.cellOf[i]] += places.all[i].irradiance;
        moments[cells.cellOf[i]] += places.all[i].moment;
    }
    std::vector<MapLight> out;
    out.reserve(cells.points.size());
    for (std::size_t i = 0; i < cells.points.size(); ++i) {
        // Of light that comes from all sides there is no middle.
        constexpr double leastLength = 1e-6;
        const bool has = glm::length(moments[i]) > leastLength * luminanceOf(irradiances[i]);
        const glm::dvec3 towards = has ? glm::normalize(moments[i]) : places.all[cells.points[i]].direction;
        out.push_back({ glm::vec3(glm::normalize(places.axes * towards)), glm::vec3(irradiances[i]) });
    }
    return out;
}

std::vector<MapLight> mapLights(const EnvironmentPicture& picture, std::size_t lights)
{
    const MapPlaces places = mapPlaces(picture);
    return mapLights(places, mapCells(places, lights));
}

} // namespace wedge::render
