#include "host/graph/interface.h"

#include <fmt/format.h>

#include <stdexcept>

namespace wedge::graph {
namespace {

/// The functions of a format, once a program.
std::string formatText(const Format& format)
{
    return fmt::format("#ifndef FORMAT_{0}\n#define FORMAT_{0}\n"
                       "static inline {1} load_{0}(__global const {2} *plane, size_t size, size_t at)\n"
                       "{{\n    return {3};\n}}\n"
                       "static inline void store_{0}(__global {2} *plane, size_t size, size_t at, {1} value)\n"
                       "{{\n    {4};\n}}\n#endif\n",
        format.name, format.value, format.storage, format.load, format.store);
}

std::string macro(const std::string& name, const std::string& parameters, const std::string& meaning)
{
    return fmt::format("#undef {0}\n#define {0}{1} {2}\n", name, parameters, meaning);
}

std::string parameterOf(const Graph& graph, const Pass& pass, const Argument& argument)
{
    if (argument.isUse()) {
        return fmt::format("__global {}{} *restrict {}", argument.access == Access::Read ? "const " : "",
            graph.resources()[argument.version.resource].format.storage, argument.name);
    }
    if (argument.type.empty()) {
        throw std::logic_error(
            fmt::format("pass \"{}\" has a value \"{}\" of a type without a name", pass.name, argument.name));
    }
    return fmt::format("{}{}{}", argument.type.ends_with('*') ? "" : "const ", argument.type + " ", argument.name);
}

} // namespace

std::string interfaceText(const Graph& graph, const Pass& pass)
{
    std::string formats, macros, parameters;
    for (const Argument& argument : pass.arguments) {
        parameters += (parameters.empty() ? "" : ", ") + parameterOf(graph, pass, argument);
        if (!argument.isUse()) {
            continue;
        }
        const Format& format = graph.resources()[argument.version.resource].format;
        if (format.value.empty()) {
            continue;
        }
        formats += formatText(format);
        if (argument.access != Access::Write) {
            macros += macro("LOAD_" + argument.name, "(size, at)",
                fmt::format("load_{}({}, size, at)", format.name, argument.name));
        }
        if (argument.access != Access::Read) {
            macros += macro("STORE_" + argument.name, "(size, at, value)",
                fmt::format("store_{}({}, size, at, value)", format.name, argument.name));
        }
    }
    if (pass.domain == Domain::Tiles) {
        parameters += ", const uint firstGroup";
    }
    return formats + macros + macro("PARAMETERS", "", parameters);
}

device::GeneratedSources interfaces(const Graph& graph)
{
    device::GeneratedSources out;
    for (const Pass& pass : graph.passes()) {
        if (pass.domain == Domain::Host) {
            continue;
        }
        const auto [known, isNew] = out.emplace("pass/" + pass.kernel.name + ".h", interfaceText(graph, pass));
        if (!isNew && known->second != interfaceText(graph, pass)) {
            throw std::logic_error(fmt::format(
                "pass \"{}\" hands kernel {} other things than a pass before it", pass.name, pass.kernel.name));
        }
    }
    return out;
}

} // namespace wedge::graph
