#include "host/render/emitter_texture.h"

#include "host/render/emitters.h"
#include "host/render/luminance.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <unordered_map>

namespace wedge::render {
namespace {

/// Of a side of a table.
constexpr double mostOnSide = 4096;
/// What may emit is chosen at least as if it had this part of the mean.
constexpr double leastShare = 1.0 / 64.0;

/// A square, and what it shows.
struct Square {
    std::uint32_t pair, material;
    SquareMap<glm::dvec2> texture; ///< where it lies there
    std::array<double, 2> areas; ///< of its parts, over their mean

    bool operator==(const Square& o) const
    {
        return pair == o.pair && material == o.material && areas == o.areas && texture.origin == o.texture.origin
            && texture.alongX == o.texture.alongX && texture.alongY == o.texture.alongY;
    }
    /// Whether coordinates are numbers that places can be told from.
    bool isKnown() const
    {
        constexpr double most = 1e6;
        const auto known = [&](const glm::dvec2& v) { return std::abs(v.x) < most && std::abs(v.y) < most; };
        return std::ranges::all_of(texture.origin, known) && std::ranges::all_of(texture.alongX, known)
            && std::ranges::all_of(texture.alongY, known);
    }
};

Square squareOf(const scene::Scene& scene, const EmitterFaces& faces)
{
    const scene::Geometry& g = scene.geometry;
    const std::size_t last = faces.pair == WEDGE_PAIR_NONE ? 0 : 1;
    std::array<std::array<glm::dvec2, 3>, 2> corners {};
    std::array<double, 2> areas { 1, 1 };
    for (std::size_t i = 0; i < 2; ++i) {
        const std::size_t triangle = faces.triangle + std::min(i, last);
        areas[i] = areaOf(g, triangle);
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t v = g.indices[3 * triangle + k];
            corners[i][k] = { g.texcoords[2 * v], g.texcoords[2 * v + 1] };
        }
    }
    const double mean = 0.5 * (areas[0] + areas[1]);
    return { faces.pair, g.materialIds[faces.triangle], squareMap(faces.pair, corners),
        { areas[0] / mean, areas[1] / mean } };
}

std::size_t hashOf(const Square& s)
{
    std::size_t hash = (std::size_t { s.material } << 8) + s.pair;
    const auto add = [&](double x) {
        hash = std::rotl(hash ^ std::bit_cast<std::uint64_t>(x), 23) * 0x9e3779b97f4a7c15u;
    };
    for (std::size_t part = 0; part < 2; ++part) {
        add(s.areas[part]);
        for (const glm::dvec2& v : { s.texture.origin[part], s.texture.alongX[part], s.texture.alongY[part] }) {
            add(v.x);
            add(v.y);
        }
    }
    return hash;
}

/// A material's textures.
struct Means {
    std::unique_ptr<TexelMeans> emission, opacity;
    double plain = 0; ///< what it emits where neither takes anything away

    Means(const scene::Scene& scene, std::uint32_t material)
    {
        const scene::Material& m = scene.materials[material];
        const auto texture = [&](int i) -> const scene::Texture& {
            return scene.textures[static_cast<std::size_t>(i)];
        };
        plain = m.opacity;
        if (m.emissionTexture >= 0) {
            emission = std::make_unique<TexelMeans>(texture(m.emissionTexture), m.emission);
        } else {
            plain *= luminanceOf(m.emission);
        }
        if (m.opacityTexture >= 0) {
            opacity = std::make_unique<TexelMeans>(texture(m.opacityTexture));
        }
    }
    template <typename Value>
    double product(const Value& value) const
    {
        return plain * (emission ? value(*emission) : 1.0) * (opacity ? value(*opacity) : 1.0);
    }
    template <typename Check>
    bool both(const Check& check) const
    {
        return (!emission || check(*emission)) && (!opacity || check(*opacity));
    }
};

/// Texels that a square's sides are long, of the larger texture and part.
glm::dvec2 texelsOf(const Square& s, const scene::Scene& scene)
{
    const scene::Material& m = scene.materials[s.material];
    glm::dvec2 most(1);
    for (const int i : { m.emissionTexture, m.opacityTexture }) {
        if (i < 0 || !s.isKnown()) {
            continue;
        }
        const scene::Texture& t = scene.textures[static_cast<std::size_t>(i)];
        const glm::dvec2 size(t.width, t.height);
        for (std::size_t part = 0; part < 2; ++part) {
            most.x = std::max(most.x, glm::length(s.texture.alongX[part] * size));
            most.y = std::max(most.y, glm::length(s.texture.alongY[part] * size));
        }
    }
    return most;
}

/// A table's columns and rows, of a square so many texels long either way: fewer texels are as good as one, and what
/// rounding is more than a whole number is not.
std::array<std::uint32_t, 2> cellsOf(glm::dvec2 texels, double scale)
{
    const auto number = [&](double n) {
        return static_cast<std::uint32_t>(std::max(std::ceil(std::min(n, mostOnSide) * scale - 1e-3), 1.0));
    };
    return { number(texels.x), number(texels.y) };
}

/// Makes what one square emits.
class Sampling {
public:
    Sampling(const Square& square, const Means& means, std::array<std::uint32_t, 2> cells)
        : s_(square)
        , means_(means)
        , columns_(cells[0])
        , rows_(cells[1])
        , known_(square.isKnown())
        , fine_(known_ && means.both([&](const TexelMeans& m) { return isFine(m); }))
    {
    }

    EmittedOverSquare emitted() const
    {
        EmittedOverSquare out;
        out.columns = columns_;
        out.rows = rows_;
        out.cells.resize(std::size_t { columns_ } * rows_);
        float least = std::numeric_limits<float>::max(), most = 0;
        for (std::uint32_t row = 0; row < rows_; ++row) {
            for (std::uint32_t column = 0; column < columns_; ++column) {
                const double value = valueOf(column, row);
                out.cells[std::size_t { row } * columns_ + column] = static_cast<float>(value);
                least = std::min(least, static_cast<float>(value));
                most = std::max(most, static_cast<float>(value));
                addTo(out, column, row, value);
            }
        }
        if (most <= 1.001f * least) {
            out.cells.clear();
        }
        return out;
    }

private:
    /// Whether four look-ups tell a cell's mean: that of a cell as large as a texel exactly.
    bool isFine(const TexelMeans& m) const
    {
        bool fine = m.isExact();
        for (std::size_t part = 0; part < 2; ++part) {
            const glm::dvec2 step = (glm::abs(s_.texture.alongX[part]) / static_cast<double>(columns_)
                                        + glm::abs(s_.texture.alongY[part]) / static_cast<double>(rows_))
                * m.size();
            fine = fine && std::max(step.x, step.y) < 1.6;
        }
        return fine;
    }
    /// The mean over all that look-ups in a cell may see.
    double around(std::uint32_t column, std::uint32_t row) const
    {
        const double left = column / static_cast<double>(columns_), right = (column + 1.0) / columns_,
                     low = row / static_cast<double>(rows_), high = (row + 1.0) / rows_;
        const bool second = s_.pair == WEDGE_PAIR_SECOND;
        const std::array<bool, 2> meets { second ? left + low < 1 : right > low,
            second ? right + high > 1 : high > left };
        double most = 0;
        for (std::size_t part = 0; part < 2; ++part) {
            if (!meets[part]) {
                continue;
            }
            TextureBox box { glm::dvec2(std::numeric_limits<double>::max()),
                glm::dvec2(std::numeric_limits<double>::lowest()) };
            for (const glm::dvec2& corner : { s_.texture.at(part, left, low), s_.texture.at(part, right, low),
                     s_.texture.at(part, left, high), s_.texture.at(part, right, high) }) {
                box.low = glm::min(box.low, corner);
                box.high = glm::max(box.high, corner);
            }
            if (!known_) {
                box = { glm::dvec2(0), glm::dvec2(1) };
            }
            most = std::max(most, s_.areas[part] * means_.product([&](const TexelMeans& m) { return m.mean(box); }));
        }
        return most;
    }
    double valueOf(std::uint32_t column, std::uint32_t row) const
    {
        const double around = this->around(column, row);
        if (!fine_ || !(around > 0)) {
            return around;
        }
        double sum = 0;
        for (const double v : { 0.25, 0.75 }) {
            for (const double u : { 0.25, 0.75 }) {
                const double x = (column + u) / columns_, y = (row + v) / rows_;
                const std::size_t part = partOfSquare(s_.pair, x, y);
                const glm::dvec2 at = s_.texture.at(part, x, y);
                sum += s_.areas[part] * means_.product([&](const TexelMeans& m) { return m.at(at); });
            }
        }
        return std::max(0.25 * sum, leastShare * around);
    }
    void addTo(EmittedOverSquare& out, std::uint32_t column, std::uint32_t row, double value) const
    {
        const double share = 1.0 / (static_cast<double>(columns_) * rows_);
        out.mean += share * value;
        out.meanSquare += share * value * value;
        // Few cells are looked at in several places each.
        const std::uint32_t places = columns_ * rows_ < 16 ? 4 : 1;
        const double weight = share * value / (places * places);
        for (std::uint32_t i = 0; i < places * places; ++i) {
            const std::uint32_t across = i % places, down = i / places;
            const double x = (column + (across + 0.5) / places) / columns_, y = (row + (down + 0.5) / places) / rows_;
            SquareMoments& m = out.moments[partOfSquare(s_.pair, x, y)];
            const SquareMoments here { 1, x, y, x * x, x * y, y * y };
            for (std::size_t k = 0; k < here.size(); ++k) {
                m[k] += weight * here[k];
            }
        }
    }

    const Square& s_;
    const Means& means_;
    std::uint32_t columns_, rows_;
    bool known_, fine_;
};

/// Numbers below each of which, and not below the one before, one is chosen. What has a weight is chosen.
void choices(std::span<const double> weights, std::span<float> upTo)
{
    const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
    const auto least = leastShare * total / static_cast<double>(weights.size());
    double raised = 0;
    std::size_t last = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        raised += weights[i] > 0 ? std::max(weights[i], least) : 0.0;
        last = weights[i] > 0 ? i : last;
    }
    double sum = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        sum += weights[i] > 0 ? std::max(weights[i], least) : 0.0;
        upTo[i] = i >= last ? 1.0f : static_cast<float>(sum / raised);
    }
}

} // namespace

bool EmitterTextures::has(const scene::Scene& scene, std::size_t triangle)
{
    const scene::Material& m = scene.materials[scene.geometry.materialIds[triangle]];
    return m.emissionTexture >= 0 || m.opacityTexture >= 0;
}

EmitterTextures::EmitterTextures(const scene::Scene& scene, std::span<const EmitterFaces> faces)
    : numbers_(faces.size())
{
    std::vector<std::size_t> firsts; // of each of all_, faces that have it
    std::unordered_multimap<std::size_t, std::size_t> known;
    double wanted = 0;
    for (std::size_t i = 0; i < faces.size(); ++i) {
        const Square square = squareOf(scene, faces[i]);
        const auto [from, to] = known.equal_range(hashOf(square));
        const auto same = std::find_if(
            from, to, [&](const auto& entry) { return squareOf(scene, faces[firsts[entry.second]]) == square; });
        if (same != to) {
            numbers_[i] = same->second;
            continue;
        }
        numbers_[i] = firsts.size();
        known.emplace(hashOf(square), firsts.size());
        firsts.push_back(i);
        const auto [columns, rows] = cellsOf(texelsOf(square, scene), 1);
        wanted += columns * rows > 1 ? static_cast<double>(columns) * rows : 0.0;
    }
    const double scale = std::min(1.0, std::sqrt(static_cast<double>(mostCells) / std::max(wanted, 1.0)));
    // One material at a time, for the means of its textures take memory.
    std::vector<std::size_t> order(firsts.size());
    std::iota(order.begin(), order.end(), std::size_t { 0 });
    const auto materialOf = [&](std::size_t i) { return scene.geometry.materialIds[faces[firsts[i]].triangle]; };
    std::ranges::stable_sort(order, {}, materialOf);
    all_.resize(firsts.size());
    std::unique_ptr<Means> means;
    for (std::size_t k = 0; k < order.size(); ++k) {
        if (k == 0 || materialOf(order[k]) != materialOf(order[k - 1])) {
            means.reset(); // before the next ones are made
            means = std::make_unique<Means>(scene, materialOf(order[k]));
        }
        const Square square = squareOf(scene, faces[firsts[order[k]]]);
        all_[order[k]] = Sampling(square, *means, cellsOf(texelsOf(square, scene), scale)).emitted();
    }
}

std::vector<float> emitterTable(const EmittedOverSquare& emitted)
{
    const std::size_t columns = emitted.columns, rows = emitted.rows;
    std::vector<float> out(2 + rows + columns * rows);
    out[0] = std::bit_cast<float>(emitted.columns);
    out[1] = std::bit_cast<float>(emitted.rows);
    const std::span<float> all(out);
    std::vector<double> cells(emitted.cells.begin(), emitted.cells.end()), ofRows(rows);
    const double least =
        leastShare * std::accumulate(cells.begin(), cells.end(), 0.0) / static_cast<double>(cells.size());
    for (double& cell : cells) {
        cell = cell > 0 ? std::max(cell, least) : 0.0;
    }
    for (std::size_t y = 0; y < rows; ++y) {
        const std::span<const double> row(cells.data() + y * columns, columns);
        ofRows[y] = std::accumulate(row.begin(), row.end(), 0.0);
        choices(row, all.subspan(2 + rows + y * columns, columns));
    }
    choices(ofRows, all.subspan(2, rows));
    return out;
}

} // namespace wedge::render
