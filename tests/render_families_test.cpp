// Frames traced by either family of traversals, and through other hierarchies, are the same to the last bit.
#include "tests/render_support.h"

using namespace wedge;
using namespace wedge::test;

namespace {

render::Options optionsOf(render::Traversal traversal, bvh::Mode mode = bvh::Mode::Default)
{
    render::Options options = renderOptions();
    options.traversal = traversal;
    options.bvh = mode;
    return options;
}

} // namespace

TEST_CASE("frames of both families, and of another hierarchy, have the same bits")
{
    onEveryDevice([](const device::Device& device) {
        const scene::Scene scene = richScene();
        render::Renderer wide(scene, device, optionsOf(render::Traversal::Wide));
        render::Renderer scalar(scene, device, optionsOf(render::Traversal::Scalar));
        render::Renderer quality(scene, device, optionsOf(render::Traversal::Wide, bvh::Mode::Quality));
        for (const render::Settings& method : { render::monteCarlo(9), render::axisAligned(16) }) {
            const render::Settings settings = sized(method, 75, 53);
            const std::vector<float> expected = renderPixels(wide, settings);
            CHECK(sameBits(renderPixels(scalar, settings), expected));
            CHECK(sameBits(renderPixels(quality, settings), expected));
        }
    });
}

TEST_CASE("the family follows from the device's type unless it is forced, and shows in options and memory")
{
    using render::Traversal;
    device::DeviceInfo info;
    for (const auto& [type, expected] :
        { std::pair(device::DeviceType::Cpu, Traversal::Wide), std::pair(device::DeviceType::Gpu, Traversal::Scalar),
            std::pair(device::DeviceType::Accelerator, Traversal::Scalar),
            std::pair(device::DeviceType::Other, Traversal::Scalar) }) {
        info.type = type;
        CHECK(render::resolveTraversal(Traversal::Automatic, info) == expected);
        CHECK(render::resolveTraversal(Traversal::Wide, info) == Traversal::Wide);
        CHECK(render::resolveTraversal(Traversal::Scalar, info) == Traversal::Scalar);
    }
    onEveryDevice([](const device::Device& device) {
        const scene::Scene scene = smallScene();
        const render::Settings settings = sized(render::monteCarlo(1), 40, 30);
        for (const Traversal family : { Traversal::Automatic, Traversal::Wide, Traversal::Scalar }) {
            const render::Renderer renderer(scene, device, optionsOf(family));
            CHECK(renderer.traversal() == render::resolveTraversal(family, device.info()));
            const bool scalar = renderer.traversal() == Traversal::Scalar;
            CHECK((renderer.buildOptions().find("WEDGE_TRAVERSAL_SCALAR") != std::string::npos) == scalar);
        }
        const bvh::Bvh built = bvh::build({ scene.geometry.positions, scene.geometry.indices });
        const render::Hierarchy wide(built, Traversal::Wide), narrow(built, Traversal::Scalar);
        CHECK(wide.nodes().size() == built.nodes.size() * sizeof(shared::BvhNode));
        CHECK(narrow.nodes().size() == narrow.narrow.size() * sizeof(shared::BvhNode4));
        const auto total = [&](const render::Hierarchy& h) {
            return render::Renderer::plan(render::PreparedScene(scene), h, settings).total();
        };
        CHECK(total(wide) - wide.nodes().size() == total(narrow) - narrow.nodes().size());
    });
}
