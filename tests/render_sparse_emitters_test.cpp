// Emitters of which a texture shows little that is bright: where points on them are chosen, the densities that are told
// of it, and the light of plain and filtered frames.
#include "host/render/emitter_texture.h"
#include "host/render/emitters.h"
#include "tests/lamp_room.h"
#include "tests/render_support.h"

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr int width = 24, height = 18;

/// Black, and so many single texels of white.
int addSparse(SceneBuilder& b, int columns, int rows, int bright, std::uint32_t seed = 3)
{
    scene::Texture& t = b.scene.textures.emplace_back();
    t.width = columns;
    t.height = rows;
    t.rgba.assign(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), 0xff000000u);
    std::mt19937 random(seed);
    for (int i = 0; i < bright; ++i)
        t.rgba[random() % t.rgba.size()] = 0xffffffffu;
    return static_cast<int>(b.scene.textures.size()) - 1;
}

std::uint32_t addSparseGlow(SceneBuilder& b, int texture, float emission)
{
    const std::uint32_t glow = addGlow(b, glm::vec3(emission));
    b.scene.materials[glow].emissionTexture = texture;
    return glow;
}

/// Texture coordinates of all vertices from one on, turned and stretched.
void moveTexture(SceneBuilder& b, std::size_t firstVertex, glm::vec2 along, glm::vec2 across, glm::vec2 origin)
{
    std::vector<float>& t = b.scene.geometry.texcoords;
    for (std::size_t i = 2 * firstVertex; i < t.size(); i += 2) {
        const glm::vec2 to = origin + t[i] * along + t[i + 1] * across;
        t[i] = to.x;
        t[i + 1] = to.y;
    }
}

/// A quad of n x n quads.
void addPanel(SceneBuilder& b, int n, std::uint32_t material)
{
    for (int i = 0; i < n * n; ++i) {
        const auto at = [&](int k) { return (2.0f * static_cast<float>(k) + 1.0f) / static_cast<float>(n) - 1.0f; };
        const int column = i % n, row = i / n;
        const std::size_t first = b.scene.geometry.positions.size() / 3;
        const glm::vec3 u = lampU / static_cast<float>(n), v = lampV / static_cast<float>(n);
        b.quad(lampCentre + at(column) * lampU + at(row) * lampV, u, v, material);
        const float part = 1.0f / static_cast<float>(n);
        moveTexture(
            b, first, { part, 0 }, { 0, part }, { part * static_cast<float>(column), part * static_cast<float>(row) });
    }
}

/// A floor, a box and a wall, and a lamp of n x n quads.
SceneBuilder roomWithPanel(int n, std::uint32_t texels, int bright)
{
    SceneBuilder b = lampRoom();
    b.quad({ 0, 1, -1.5f }, { 2, 0, 0 }, { 0, 1, 0 });
    b.newObject();
    const auto side = static_cast<int>(texels);
    const float share = static_cast<float>(bright) / static_cast<float>(side * side);
    const std::uint32_t glow =
        bright > 0 ? addSparseGlow(b, addSparse(b, side, side, bright), 8.0f / share) : addGlow(b, glm::vec3(8));
    addPanel(b, n, glow);
    return b;
}

render::Settings settingsOf(const render::Settings& method)
{
    render::Settings settings = sized(method, width, height);
    settings.bounces = 0;
    return settings;
}

/// Emitters of all kinds, of five objects: a pair whose texture is turned and repeated, a triangle, faces that are
/// there twice, a mesh with a texture, and one without.
SceneBuilder manyEmitters()
{
    SceneBuilder b;
    const std::uint32_t glow = addSparseGlow(b, addSparse(b, 13, 7, 6), 5);
    b.quad({ 0, 0, 0 }, { 1, 0, 0 }, { 0, 0, 1 }, glow);
    moveTexture(b, 0, { 1.3f, 0.8f }, { -0.9f, 1.6f }, { -3.2f, 4.4f });
    b.newObject();
    std::size_t first = b.scene.geometry.positions.size() / 3;
    b.triangle({ 3, 0, 0 }, { 4, 0, 0 }, { 3, 0, 2 }, glow);
    b.scene.geometry.texcoords[2 * first] = 0.9f;
    b.scene.geometry.texcoords[2 * first + 3] = 1.1f;
    b.newObject();
    first = b.scene.geometry.positions.size() / 3;
    for (const bool turned : { false, true }) {
        b.triangle({ 6, 0, 0 }, turned ? glm::vec3(6, 0, 2) : glm::vec3(7, 0, 0),
            turned ? glm::vec3(7, 0, 0) : glm::vec3(6, 0, 2), glow);
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t v = first + (turned ? 3 : 0) + k;
            b.scene.geometry.texcoords[2 * v] = b.scene.geometry.positions[3 * v];
            b.scene.geometry.texcoords[2 * v + 1] = 0.5f * b.scene.geometry.positions[3 * v + 2];
        }
    }
    b.newObject();
    addPanel(b, 3, glow);
    b.newObject();
    addPanel(b, 5, addGlow(b, glm::vec3(0.3f)));
    return b;
}

struct Places {
    std::vector<float> chosen; ///< of choosePlaces
    std::vector<float> met; ///< of meetPlaces
};

constexpr std::uint32_t count = 1u << 18;

float unit(std::mt19937& random) { return static_cast<float>(random() >> 8) * (1.0f / 16777216.0f); }

Places places(const SceneBuilder& b, const device::Device& device, const std::vector<float>& meeting)
{
    KernelBench bench(device, { { "WEDGE_EMITTER_TREES", "1" }, { "WEDGE_EMITTER_TABLES", "1" } },
        kernelDir().empty() ? WEDGE_TEST_KERNELS : kernelDir());
    const render::Hierarchy tree(bvh::build({ b.scene.geometry.positions, b.scene.geometry.indices }));
    const render::PreparedScene prepared(b.scene);
    const render::DeviceScene scene(prepared, tree, device, bench.queue);
    std::mt19937 random(7);
    std::vector<float> numbers(2 * std::size_t { count });
    for (float& u : numbers)
        u = unit(random);
    const auto numberBuffer = bench.buffer(numbers), meetingBuffer = bench.buffer(meeting);
    const auto chosen = bench.filled(5 * std::size_t { count }, 0.0f);
    const auto met = bench.filled(2 * std::size_t { count }, 0.0f);
    const auto run = [&](const char* name, const auto&... more) {
        device::Kernel kernel = bench.library.kernel("emitter_points.cl", name);
        kernel.setArgs(scene.positions, scene.normals, scene.texcoords, scene.indices, scene.materialIds,
            scene.materials, scene.textures, scene.texels, scene.srgbToLinear, scene.positionsAtClose,
            scene.normalsAtClose, scene.emitters, scene.emitterPicks, scene.emitterCount, more...);
        bench.queue.launch(name, device::PassKind::Trace, kernel, count, 16);
    };
    run("choosePlaces", numberBuffer, count, chosen);
    run("meetPlaces", meetingBuffer, count, met);
    return { bench.read(chosen), bench.read(met) };
}

/// Which of 6 x 6 parts of a triangle, all of the same area.
std::size_t binOf(float x, float y)
{
    const shared::Vec2 at = shared::triangleToSquare(shared::vec2(x, y));
    const auto part = [](float u) {
        return std::min(static_cast<std::size_t>(std::max(u, 0.0f) * 6.0f), std::size_t { 5 });
    };
    return 6 * part(at.y) + part(at.x);
}

} // namespace

TEST_CASE("numbers of a triangle's or a pair's places are those that choose them")
{
    std::mt19937 random(5);
    for (int i = 0; i < 1000; ++i) {
        const shared::Vec2 u = shared::vec2(unit(random), unit(random));
        const shared::Vec2 of = shared::triangleToSquare(shared::squareToTriangle(u));
        REQUIRE(of.x == doctest::Approx(u.x).epsilon(1e-5));
        REQUIRE(of.y == doctest::Approx(u.y).epsilon(1e-5));
        for (const std::uint32_t pair : { WEDGE_PAIR_FIRST, WEDGE_PAIR_SECOND }) {
            std::uint32_t second = 0;
            const shared::Vec2 weights = shared::squareToPair(pair, u, &second);
            const shared::Vec2 back = shared::pairToSquare(pair, second, weights);
            REQUIRE(back.x == doctest::Approx(u.x).epsilon(1e-5));
            REQUIRE(back.y == doctest::Approx(u.y).epsilon(1e-5));
        }
    }
}

TEST_CASE("emitters' points are as dense as is told of them, everywhere where something emits")
{
    onEveryDevice([](const device::Device& device) {
        const SceneBuilder b = manyEmitters();
        const std::size_t triangles = b.scene.geometry.materialIds.size();
        std::mt19937 random(11);
        std::vector<float> meeting;
        for (std::size_t i = 0; i < count; ++i) {
            const shared::Vec2 w = shared::squareToTriangle(shared::vec2(unit(random), unit(random)));
            meeting.insert(meeting.end(), { static_cast<float>(i % triangles), w.x, w.y });
        }
        const Places found = places(b, device, meeting);
        constexpr std::size_t bins = 36;
        std::vector<double> chosen(triangles * bins), told(triangles * bins), squares(triangles * bins);
        std::vector<std::size_t> asked(triangles * bins);
        int differ = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const float* c = &found.chosen[5 * i];
            chosen[static_cast<std::size_t>(c[0]) * bins + binOf(c[1], c[2])] += 1.0;
            REQUIRE(c[3] > 0);
            differ += std::abs(c[4] - c[3]) > 1e-4f * c[3] ? 1 : 0; // by rounding, at borders of cells
            const float* m = &found.met[2 * i];
            const std::size_t bin =
                static_cast<std::size_t>(meeting[3 * i]) * bins + binOf(meeting[3 * i + 1], meeting[3 * i + 2]);
            told[bin] += m[0];
            squares[bin] += m[0] * m[0];
            asked[bin] += 1;
            if (m[1] > 0)
                REQUIRE(m[0] > 0);
        }
        CHECK(differ < count / 1000);
        // Triangle 4 lies in the place of triangle 3: what is told of it is the same again.
        double chi = 0;
        std::size_t used = 0;
        for (std::size_t i = 0; i < chosen.size(); ++i) {
            if (i / bins == 4)
                continue;
            const double n = static_cast<double>(asked[i]), mean = told[i] / n, expected = mean / bins * count;
            const double ofTold =
                std::max(squares[i] / n - mean * mean, 0.0) / n * std::pow(count / double { bins }, 2);
            if (expected < 8) {
                CHECK(chosen[i] < 8 + 6 * std::sqrt(8.0));
                continue;
            }
            chi += std::pow(chosen[i] - expected, 2) / (expected + ofTold);
            ++used;
        }
        CAPTURE(chi);
        CAPTURE(used);
        CHECK(used > 100);
        CHECK(chi < static_cast<double>(used) + 5 * std::sqrt(2.0 * static_cast<double>(used))); // five deviations
        // The twin's density where the first one's is, whatever corner it begins at.
        for (std::size_t bin = 0; bin < bins; ++bin)
            CHECK((told[3 * bins + bin] > 0) == (told[3 * bins + bin] > 0));
        const auto sum = [&](std::size_t t) {
            return std::accumulate(told.begin() + static_cast<std::ptrdiff_t>(t * bins),
                       told.begin() + static_cast<std::ptrdiff_t>((t + 1) * bins), 0.0)
                / static_cast<double>(asked[t * bins]);
        };
        CHECK(sum(4) == doctest::Approx(sum(3)).epsilon(0.1));
    });
}

TEST_CASE("tables of textures are bounded, and forget no texel")
{
    SceneBuilder b;
    const int columns = 4096, rows = 2048; // more than a table may have cells
    const int texture = addSparse(b, columns, rows, 1);
    const std::uint32_t glow = addSparseGlow(b, texture, 5);
    for (int i = 0; i < 3; ++i) {
        b.quad({ i, 0, 0 }, { 0.4f, 0, 0 }, { 0, 0, 0.4f }, glow);
        b.newObject();
    }
    std::vector<float>& t = b.scene.geometry.texcoords;
    for (std::size_t i = t.size() / 3; i < t.size(); ++i)
        t[i] *= i < 2 * t.size() / 3 ? 300.0f : 1e9f; // repeated, and no numbers to tell places by
    const render::EmitterList list = render::emitterList(b.scene);
    REQUIRE(list.count == 3);
    CHECK(list.picks.size() < 3 * render::EmitterTextures::mostCells / 2);
    for (std::size_t i = 0; i < 6; ++i)
        CHECK(list.picks[i] > 0);
    // A texel is an eight-millionth of all: nothing of its neighbourhood is without a probability.
    const std::vector<render::EmitterFaces> faces { { 0, WEDGE_PAIR_FIRST } };
    render::EmitterTextures textures(b.scene, faces);
    const std::vector<render::EmittedOverSquare> all = textures.take();
    const render::EmittedOverSquare& square = all[0];
    CHECK(std::size_t { square.columns } * square.rows
        <= render::EmitterTextures::mostCells + square.columns + square.rows);
    const auto& rgba = b.scene.textures[0].rgba;
    const auto texel = static_cast<int>(std::ranges::find(rgba, 0xffffffffu) - rgba.begin());
    const int column = texel % columns, row = texel / columns;
    for (const double dx : { -0.99, 0.0, 0.99 })
        for (const double dy : { -0.99, 0.0, 0.99 }) {
            const double u = (column + 0.5 + dx) / columns, v = (row + 0.5 + dy) / rows;
            const auto x = static_cast<std::size_t>(u * square.columns), y = static_cast<std::size_t>(v * square.rows);
            CHECK(square.cells[y * square.columns + x] > 0);
        }
    CHECK(square.mean == doctest::Approx(5.0 / (columns * rows)).epsilon(1.5)); // at least, and not far more
    CHECK(square.mean >= 4.9 / (columns * rows));
}

TEST_CASE("what a texture shows in equal brightness needs no table, and what it shows in black is no light")
{
    SceneBuilder b = roomWithPanel(1, 8, 64);
    std::ranges::fill(b.scene.textures[0].rgba, 0xff808080u);
    const render::EmitterList even = render::emitterList(b.scene);
    REQUIRE(even.list.size() == 1);
    CHECK(even.list[0].header == 0);
    CHECK(even.picks.size() == b.scene.geometry.materialIds.size());
    CHECK_FALSE(even.tables);
    std::ranges::fill(b.scene.textures[0].rgba, 0xff000000u);
    CHECK(render::emitterList(b.scene).list.empty());
}

TEST_CASE("lists say what kernels find in them, and parts of a mesh without a table have no entries")
{
    const render::EmitterList one = render::emitterList(roomWithPanel(1, 32, 0).scene);
    CHECK(one.list.size() == 1);
    CHECK_FALSE(one.trees);
    CHECK_FALSE(one.tables);
    // Of 16 pairs: the mesh, 15 splits and 4 x 4 cells.
    const render::EmitterList many = render::emitterList(roomWithPanel(4, 32, 0).scene);
    CHECK(many.list.size() == 1 + 15 + 16);
    CHECK(many.trees);
    CHECK_FALSE(many.tables);
    const std::uint32_t firstCell = many.list[many.list[0].triangle].triangle;
    CHECK((firstCell >> WEDGE_PART_SHIFT) <= WEDGE_PAIR_SECOND);
    const render::EmitterList spot = render::emitterList(roomWithPanel(1, 32, 16).scene);
    CHECK_FALSE(spot.trees);
    CHECK(spot.tables);
}

TEST_CASE("a mesh of 32 triangles brings the light of one of two, and hardly more noise")
{
    onEveryDevice([](const device::Device& device) {
        const render::Settings few = settingsOf(render::monteCarlo(16));
        for (const int bright : { 0, 16 }) {
            CAPTURE(bright);
            const SceneBuilder one = roomWithPanel(1, 32, bright), many = roomWithPanel(4, 32, bright);
            const Moments a = lightOf(one, device, few), b = lightOf(many, device, few);
            checkAgreement(a, b, 1e-3);
            const double noise = rmsNoise(a), ofMany = rmsNoise(b);
            CAPTURE(noise);
            CAPTURE(ofMany);
            CHECK(ofMany < 1.3 * noise);
        }
    });
}

TEST_CASE("points on sparse emitters, directions and both agree")
{
    onEveryDevice([](const device::Device& device) {
        SceneBuilder b = roomWithPanel(1, 16, 8);
        const std::size_t last = b.scene.geometry.positions.size() / 3;
        moveTexture(b, last - 6, { 1.7f, 0.4f }, { -0.5f, 1.2f }, { 0.3f, -2.1f });
        b.newObject();
        // A screen that stands on the floor, near which directions are denser than points.
        b.quad({ 0, 0.8f, -1.45f }, { 1.5f, 0, 0 }, { 0, 0.8f, 0 }, addSparseGlow(b, addSparse(b, 8, 4, 8), 9));
        b.newObject();
        b.triangle({ -1.2f, 0.4f, -1 }, { -1.0f, 1.2f, -1.2f }, { -0.8f, 0.5f, -0.4f },
            static_cast<std::uint32_t>(b.scene.materials.size() - 1));
        for (std::size_t k = 0; k < 6; ++k)
            b.scene.geometry.texcoords[b.scene.geometry.texcoords.size() - 6 + k] = static_cast<float>(k % 4) * 0.7f;
        render::Settings plain = settingsOf(render::monteCarlo(256));
        plain.bounces = 1;
        plain.lightSampling = render::LightSampling::Lights;
        const Moments points = lightOf(b, device, plain);
        CHECK(points.average() > 1e-3);
        plain.lightSampling = render::LightSampling::Both;
        checkAgreement(lightOf(b, device, plain), points, 1e-3);
        plain.spp = 4096;
        plain.lightSampling = render::LightSampling::Directions;
        checkAgreement(lightOf(b, device, plain), points, 3e-3);
    });
}

TEST_CASE("filtered light of sparse emitters has the mean of the plain one")
{
    onEveryDevice([](const device::Device& device) {
        for (const int bright : { 1, 64 }) {
            CAPTURE(bright);
            const SceneBuilder b = roomWithPanel(bright == 1 ? 1 : 4, 32, bright);
            const Moments plain = lightOf(b, device, settingsOf(render::monteCarlo(1024)));
            for (const int spp : { 28, 128 }) {
                CAPTURE(spp);
                const Moments filtered = lightOf(b, device, settingsOf(render::axisAligned(spp)));
                CHECK(filtered.average() == doctest::Approx(plain.average()).epsilon(0.006));
            }
        }
    });
}
