// The structs that host and device share have the same layout on both.
#include "kernels/shared/bvh_types.h"
#include "kernels/shared/camera.h"
#include "kernels/shared/curvature.h"
#include "kernels/shared/cutout.h"
#include "kernels/shared/distributed.h"
#include "kernels/shared/environment.h"
#include "kernels/shared/filter_params.h"
#include "kernels/shared/frame.h"
#include "kernels/shared/hit.h"
#include "kernels/shared/light.h"
#include "kernels/shared/material.h"
#include "kernels/shared/path.h"
#include "kernels/shared/pixel_grid.h"
#include "kernels/shared/styled_shadows.h"
#include "kernels/shared/temporal.h"
#include "kernels/shared/wave.h"
#include "tests/render_support.h"

#include <cstddef>

using namespace wedge;
using namespace wedge::test;
using namespace wedge::shared;

namespace {

struct Number {
    std::string what;
    std::size_t value;
};

std::vector<Number> hostLayout()
{
    std::vector<Number> out;
#define STRUCT(S)                                                                                                      \
    {                                                                                                                  \
        std::size_t end = 0;
#define FIELD(S, f)                                                                                                    \
    CHECK_MESSAGE(offsetof(S, f) == end, "a field before " #S "." #f " is missing in layout_fields.h");                \
    out.push_back({ "offset of " #S "." #f, offsetof(S, f) });                                                         \
    out.push_back({ "size of " #S "." #f, sizeof(S::f) });                                                             \
    end = offsetof(S, f) + sizeof(S::f);
#define END(S)                                                                                                         \
    CHECK_MESSAGE(sizeof(S) == end, "a field at the end of " #S " is missing in layout_fields.h");                     \
    out.push_back({ "size of " #S, sizeof(S) });                                                                       \
    }
#include "tests/kernels/layout_fields.h"
    return out;
}

} // namespace

TEST_CASE("structs lie in device memory as they do on the host")
{
    const std::vector<Number> host = hostLayout();
    onEveryDevice([&](const device::Device& device) {
        KernelBench bench(device, {}, WEDGE_TEST_KERNELS);
        device::Buffer<std::uint32_t> out = bench.filled(host.size(), 0u);
        device::Buffer<std::uint32_t> count = bench.filled(1, 0u);
        device::Kernel kernel = bench.library.kernel("layout.cl", "layout");
        kernel.setArgs(out, count);
        bench.queue.launch("layout", device::PassKind::Trace, kernel, 1, 1);
        REQUIRE(bench.read(count)[0] == host.size());
        const std::vector<std::uint32_t> found = bench.read(out);
        for (std::size_t i = 0; i < host.size(); ++i) {
            CAPTURE(host[i].what);
            CHECK(found[i] == host[i].value);
        }
    });
}
