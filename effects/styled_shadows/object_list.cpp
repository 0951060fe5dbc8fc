#include "effects/styled_shadows/object_list.h"

#include "host/graph/lists.h"
#include "host/scene/object_names.h"

#include <cstdint>
#include <set>
#include <string>
#include <utility>

namespace wedge::render {

Arguments objectList(FrameBuilder& frame, const char* name, const std::vector<std::string>& names)
{
    const std::vector<std::string>& objects = frame.description.geometry.objectNames;
    const std::set<std::string> wanted(names.begin(), names.end());
    std::vector<std::uint32_t> flags(objects.size() + 1, 0);
    for (std::size_t i = 0; i < objects.size(); ++i) {
        flags[i + 1] = scene::isCalledOneOf(objects[i], wanted) ? 1 : 0;
    }
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

} // namespace wedge::render
