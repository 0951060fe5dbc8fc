#include "effects/styled_shadows/object_list.h"

#include "host/graph/lists.h"
#include "host/scene/object_names.h"
#include "kernels/shared/styled_shadows.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <set>
#include <string>
#include <utility>

namespace wedge::render {

namespace {

/// A number for each object's id and for 0, by its name; 0 has 0.
template <class Number>
Arguments listOf(FrameBuilder& frame, const char* name, const Number& number)
{
    const std::vector<std::string>& objects = frame.description.geometry.objectNames;
    std::vector<std::uint32_t> flags { 0 };
    std::ranges::transform(objects, std::back_inserter(flags), number);
    const auto count = static_cast<std::uint32_t>(flags.size());
    auto list = frame.graph.list<Count>(name, graph::counts, count);
    frame.graph.add({ .name = name,
        .kind = device::PassKind::Transfer,
        .arguments = { graph::writes("list", list) },
        .domain = graph::Domain::Host,
        .step =
            [flags = std::move(flags), list](graph::Run& run) {
                if (!run.rehearsal()) {
                    run.buffer<std::uint32_t>(list).upload(run.queue(), flags);
                }
            },
        .constant = true });
    return graph::together("members", { graph::reads(name, list), graph::unlessEmpty("objects", count) });
}

} // namespace

Arguments objectList(FrameBuilder& frame, const char* name, const std::vector<std::string>& names)
{
    const std::set<std::string> wanted(names.begin(), names.end());
    return listOf(frame, name,
        [&](const std::string& object) -> std::uint32_t { return scene::isCalledOneOf(object, wanted) ? 1 : 0; });
}

Arguments casterList(FrameBuilder& frame, const StyleGroup& group)
{
    const std::vector<std::string>& casters = group.styles.front().casters;
    const std::set<std::string> own(casters.begin(), casters.end()), others(group.apart.begin(), group.apart.end());
    return listOf(frame, "casters", [&](const std::string& object) -> std::uint32_t {
        const bool here = scene::isCalledOneOf(object, own), elsewhere = scene::isCalledOneOf(object, others);
        if (here || (!elsewhere && casters.empty())) {
            return WEDGE_CASTS;
        }
        return elsewhere || group.restApart ? WEDGE_CASTS_ELSEWHERE : 0;
    });
}

} // namespace wedge::render
