#include "host/graph/interface.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>
#include <span>
#include <stdexcept>

namespace wedge::graph {
namespace {

/// The functions of a format, once a program.
std::string formatText(const Format& format)
{
    return fmt::format("#ifndef FORMAT_{0}\n#define FORMAT_{0}\n"
                       "static inline {1} load_{0}(__global const {2} *plane, size_t size, size_t at)\n"
                       "{{\n    (void)size;\n    return {3};\n}}\n"
                       "static inline void store_{0}(__global {2} *plane, size_t size, size_t at, {1} value)\n"
                       "{{\n    (void)size;\n    {4};\n}}\n#endif\n",
        format.name, format.value, format.storage, format.load, format.store);
}

std::string macro(const std::string& name, const std::string& parameters, const std::string& meaning)
{
    return fmt::format("#undef {0}\n#define {0}{1} {2}\n", name, parameters, meaning);
}

/// Where in a pass's rectangle an item is, and the end of those beside it. Blocks have indices with signs, which
/// vectors are loaded by.
std::string pixelMacro(Domain domain)
{
    const bool blocks = domain == Domain::Blocks;
    return macro("WEDGE_PIXEL", "(p, x, y, i)",
        fmt::format(
            "const uint x = (p).x0 + (uint)get_global_id(0){}, y = (p).y0 + (uint)get_global_id(1); "
            "if (x >= (p).x1 || y >= (p).y1) {{ return; }} const {} i = ({})pixelIndex(x, y, (p).stride); (void)i",
            blocks ? " * WEDGE_BLOCK_PIXELS" : "", blocks ? "int" : "uint", blocks ? "int" : "uint"));
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
    return argument.type.ends_with('*') ? fmt::format("{}restrict {}", argument.type, argument.name)
                                        : fmt::format("const {} {}", argument.type, argument.name);
}

/// The arguments of the pass that its sinks are handed: its last ones.
std::span<const Argument> sinkArguments(const Pass& pass)
{
    std::set<std::string> names;
    for (const Sink& sink : pass.kernel.sinks) {
        for (const std::vector<std::string>* handed : { &sink.begin, &sink.take, &sink.finish }) {
            names.insert(handed->begin(), handed->end());
        }
    }
    const std::span<const Argument> all = pass.arguments;
    const auto last = all.last(std::min(names.size(), all.size()));
    for (const std::string& name : names) {
        if (std::ranges::none_of(last, [&](const Argument& argument) { return argument.name == name; })) {
            throw std::logic_error(
                fmt::format("pass \"{}\" hands sinks \"{}\", which is not among its last arguments", pass.name, name));
        }
    }
    return last;
}

/// What one of the sinks' three functions of a packet does: the same of each sink.
std::string sinkFunction(const Pass& pass, const std::string& step, const std::string& name,
    std::vector<std::string> Sink::*handed, const std::string& more, const std::string& names)
{
    std::string body;
    for (const Sink& sink : pass.kernel.sinks) {
        if (sink.onlyFinishes && step != "finish") {
            continue;
        }
        std::string call = step == "take" ? "at, s" : "at";
        call += sink.onlyFinishes ? "" : fmt::format(", &sink->of{}", sink.name);
        for (const std::string& argument : sink.*handed) {
            call += ", " + argument;
        }
        body += fmt::format("    {}{}({});\n", step, sink.name, call);
    }
    return fmt::format("WEDGE_INLINE void {}(const Sampling *at, {}Sink *sink, WEDGE_SINK_PARAMETERS)\n{{\n{}{}}}\n",
        name, more, names, body);
}

} // namespace

std::string interfaceText(const Graph& graph, const Pass& pass)
{
    std::string formats, macros = macro("PASS_" + pass.kernel.name, "", "1"), parameters;
    std::set<std::string_view> known;
    for (const Argument& argument : pass.arguments) {
        parameters += (parameters.empty() ? "" : ", ") + parameterOf(graph, pass, argument);
        const Format* format =
            argument.isUse() ? &graph.resources()[argument.version.resource].format : argument.format.get();
        if (!pass.kernel.byFormats || format == nullptr || format->value.empty()) {
            continue;
        }
        formats += known.insert(format->name).second ? formatText(*format) : "";
        // Both, whatever the pass does: the parameter's type says what may be done.
        macros += macro(
            "LOAD_" + argument.name, "(size, at)", fmt::format("load_{}({}, size, at)", format->name, argument.name));
        macros += macro("STORE_" + argument.name, "(size, at, value)",
            fmt::format("store_{}({}, size, at, value)", format->name, argument.name));
    }
    if (pass.domain == Domain::Tiles) {
        parameters += ", const uint firstGroup";
    }
    if (pass.domain == Domain::Pixels || pass.domain == Domain::Blocks) {
        macros += pixelMacro(pass.domain);
    }
    const std::string sinks = pass.kernel.sinks.empty() ? "" : sinkText(graph, pass);
    return formats + macros + macro("PARAMETERS", "", parameters) + sinks;
}

std::string sinkText(const Graph& graph, const Pass& pass)
{
    std::vector<std::string> parameters, names;
    std::set<std::string> includes;
    std::string states, unused = "    (void)sink;\n";
    for (const Argument& argument : sinkArguments(pass)) {
        parameters.push_back(parameterOf(graph, pass, argument));
        names.push_back(argument.name);
        unused += fmt::format("    (void){};\n", argument.name);
    }
    for (const Sink& sink : pass.kernel.sinks) {
        includes.insert(fmt::format("#include \"{}\"\n", sink.file));
        states += sink.onlyFinishes ? "" : fmt::format("    {0} of{0};\n", sink.name);
    }
    return fmt::format(
               "{}\n#define WEDGE_SINK_PARAMETERS {}\n#define WEDGE_SINK_ARGUMENTS {}\ntypedef struct {{\n{}}} Sink;\n",
               fmt::join(includes, ""), fmt::join(parameters, ", "), fmt::join(names, ", "), states)
        + sinkFunction(pass, "begin", "beginReceivers", &Sink::begin, "", unused)
        + sinkFunction(pass, "take", "takeSamples", &Sink::take, "const Samples *s, ", unused)
        + sinkFunction(pass, "finish", "finishReceivers", &Sink::finish, "", unused);
}

std::vector<std::shared_ptr<const device::ProgramSource>> programs(const Graph& graph)
{
    std::vector<std::shared_ptr<device::ProgramSource>> known;
    std::vector<std::shared_ptr<const device::ProgramSource>> out;
    for (const Pass& pass : graph.passes()) {
        if (pass.domain == Domain::Host) {
            out.push_back(nullptr);
            continue;
        }
        const std::string name = "pass/" + pass.kernel.name + ".h", text = interfaceText(graph, pass);
        device::Defines defines = pass.kernel.defines;
        for (const Sink& sink : pass.kernel.sinks) {
            defines.insert(defines.end(), sink.defines.begin(), sink.defines.end());
        }
        const auto fits = [&](const std::shared_ptr<device::ProgramSource>& program) {
            const auto there = program->generated.find(name);
            return program->file == pass.kernel.file && program->defines == defines
                && (there == program->generated.end() || there->second == text);
        };
        auto program = std::ranges::find_if(known, fits);
        if (program == known.end()) {
            program = known.insert(known.end(), std::make_shared<device::ProgramSource>(pass.kernel.file, defines));
        }
        (*program)->generated.emplace(name, text);
        out.push_back(*program);
    }
    return out;
}

} // namespace wedge::graph
