#include "host/graph/interface.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>
#include <span>
#include <stdexcept>

namespace wedge::graph {
namespace {

std::string macro(const std::string& name, const std::string& parameters, const std::string& meaning)
{
    return fmt::format("#undef {0}\n#define {0}{1} {2}\n", name, parameters, meaning);
}

/// How a plane is read and written. Both, whatever the pass does: the parameter's type says what may be done. What
/// another kernel of the file had of that name is forgotten.
std::string planeMacros(const std::string& name, const Format& format, bool absent)
{
    std::string out;
    for (const char* what : { "FORMAT_", "LOAD_", "STORE_", "LOAD16_" }) {
        out += fmt::format("#undef {}{}\n", what, name);
    }
    out += macro("HAS_" + name, "", absent ? "0" : "1");
    out += macro("PLANE_" + name, "", absent ? fmt::format("((__global const {} *)0)", format.storage) : name);
    if (format.whole) {
        out += fmt::format("#define FORMAT_{} {}\n", name, format.name);
        out += fmt::format("#define LOAD_{}(size, at) {}\n", name,
            absent ? fmt::format("((void)(size), (void)(at), none_{}())", format.name)
                   : fmt::format("load_{}({}, size, at)", format.name, name));
        out += fmt::format("#define STORE_{}(size, at, value) {}\n", name,
            absent ? "((void)(size), (void)(at), (void)(value))"
                   : fmt::format("store_{}({}, size, at, value)", format.name, name));
    }
    if (format.blocks && !absent) {
        out += fmt::format("#define LOAD16_{0}(size, at) load16_{1}({0}, size, at)\n", name, format.name);
    }
    return out;
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

/// Which element of a list an item is, and the end of those beyond its length.
std::string itemMacro(const std::string& listed)
{
    return macro("WEDGE_ITEM", "(i)",
        fmt::format(
            "const uint i = (uint)get_global_id(0); if (i >= min({0}[0], {0}_most)) {{ return; }} (void)i", listed));
}

/// How the groups' structures are read and written.
std::string groupMacros(const Pass& pass)
{
    std::map<std::string, std::pair<std::string, std::string>> groups;
    for (const std::vector<Argument>* list : { &pass.arguments, &pass.absent }) {
        for (const Argument& argument : *list) {
            if (!argument.member) {
                continue;
            }
            auto& [load, store] = groups[argument.group];
            const std::string member = argument.name.substr(argument.group.size() + 1);
            load += fmt::format(" (out)->{} = LOAD_{}(size, at);", member, argument.name);
            if (argument.isUse() && argument.access != Access::Read) {
                store += fmt::format(" STORE_{}(size, at, (in)->{});", argument.name, member);
            }
        }
    }
    std::string out;
    for (const auto& [name, both] : groups) {
        out += macro("LOAD_" + name, "(size, at, out)", fmt::format("do {{{} }} while (0)", both.first));
        out += macro("STORE_" + name, "(size, at, in)", fmt::format("do {{{} }} while (0)", both.second));
    }
    return out;
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
    std::string macros = macro("PASS_" + pass.kernel.name, "", "1"), parameters;
    for (const Argument& argument : pass.arguments) {
        parameters += (parameters.empty() ? "" : ", ") + parameterOf(graph, pass, argument);
        if (argument.isUse()) {
            macros += planeMacros(argument.name, graph.resources()[argument.version.resource].format, false);
            macros += argument.mostItems > 0 ? itemMacro(argument.name) : "";
        }
    }
    for (const Argument& argument : pass.absent) {
        macros += planeMacros(argument.name, *argument.absent, true);
    }
    macros += groupMacros(pass);
    if (pass.domain == Domain::Tiles) {
        parameters += ", const uint firstGroup";
    }
    if (pass.domain == Domain::Pixels || pass.domain == Domain::Blocks) {
        macros += pixelMacro(pass.domain);
    }
    const std::string sinks = pass.kernel.sinks.empty() ? "" : sinkText(graph, pass);
    return "#include \"core/formats.h\"\n" + macros + macro("PARAMETERS", "", parameters) + sinks;
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
