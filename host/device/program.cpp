#include "host/device/program.h"

#include "host/device/cache_folder.h"
#include "host/device/cl_error.h"
#include "host/device/driver_cache.h"
#include "host/device/quirks.h"
#include "host/device/source.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <string_view>

namespace wedge::device {
namespace {

/// Without it a quotient may be 2.5 ulp off: of hits at equal t another triangle wins than on the host.
constexpr std::string_view exactDivisionOption = " -cl-fp32-correctly-rounded-divide-sqrt";

/// The first line of a compiler's log that speaks of an error; else its first line that is not blank.
std::string firstError(const std::string& log)
{
    std::string fallback = "no message from the compiler";
    bool anyLine = false;
    for (std::string_view rest = log; !rest.empty();) {
        const auto length = std::min(rest.find('\n'), rest.size());
        std::string line(rest.substr(0, length));
        rest.remove_prefix(std::min(length + 1, rest.size()));
        line.erase(0, std::min(line.find_first_not_of(" \t\r"), line.size()));
        line.erase(line.find_last_not_of(" \t\r\0") + 1);
        std::string lower = line;
        std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return std::tolower(c); });
        if (lower.find("error") != std::string::npos) {
            return line;
        }
        if (!anyLine && !line.empty()) {
            fallback = line;
            anyLine = true;
        }
    }
    return fallback;
}

/// Writes text to a new file in the temporary folder and returns its path, or "" if that cannot be done.
std::string writeTemporary(const std::string& text)
{
    std::error_code failed;
    const std::filesystem::path folder = std::filesystem::temp_directory_path(failed);
    std::string path = ((failed ? std::filesystem::path("/tmp") : folder) / "wedge-build-XXXXXX.txt").string();
    const int file = ::mkstemps(path.data(), 4);
    if (file < 0) {
        return "";
    }
    std::string_view rest = text;
    while (!rest.empty()) {
        const auto written = ::write(file, rest.data(), rest.size());
        if (written <= 0) {
            break;
        }
        rest.remove_prefix(static_cast<std::size_t>(written));
    }
    ::close(file);
    return rest.empty() ? path : "";
}

/// What to do about a program that does not build, of a folder of kernels or, "", of ours.
std::string remedyOfFailure(const std::string& kernelDir)
{
    const std::filesystem::path cache = DriverCache::ofProcess().folder();
    if (!cache.empty() && lacksRoom(cache)) {
        return "make room on the disk of " + cache.string();
    }
    return kernelDir.empty() ? "update the driver or choose another device, or report it" : "correct the kernel";
}

/// Whether the identifier occurs in a program's text.
bool names(const std::string& text, const std::string& identifier)
{
    const auto isPart = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
    for (auto at = text.find(identifier); at != std::string::npos; at = text.find(identifier, at + 1)) {
        const std::size_t end = at + identifier.size();
        if ((at == 0 || !isPart(text[at - 1])) && (end == text.size() || !isPart(text[end]))) {
            return true;
        }
    }
    return false;
}

void requirePlain(const Defines& defines)
{
    for (const auto& [name, value] : defines) {
        for (const std::string& text : { name, value }) {
            if (text.find_first_of(" \t\n\"'\\") != std::string::npos) {
                throw Error(
                    "build option", text, "write defines without blanks and quotes, which drivers split differently");
            }
        }
    }
}

/// Each interface is to be in the text, or its kernel takes what nobody declared.
void requireInterfaces(const ProgramSource& source, const std::string& text)
{
    for (const auto& [path, made] : source.generated) {
        const std::string kernel = std::filesystem::path(path).stem().string();
        if (path.starts_with("pass/") && text.find(fmt::format("#define PASS_{} ", kernel)) == std::string::npos) {
            throw Error("kernel does not include its interface", fmt::format("{} ({})", kernel, source.file),
                fmt::format("put #include \"{}\" before it", path));
        }
    }
}

} // namespace

std::string textOf(const BuildOptions& options, const ProgramSource& source)
{
    GeneratedSources generated = options.generated;
    generated.insert(source.generated.begin(), source.generated.end());
    return flattenKernel(options.kernelDir, source.file, generated).text;
}

std::map<std::string, std::string> programFiles(const BuildOptions& options, const std::vector<ProgramSource>& programs)
{
    std::map<std::string, std::string> files;
    std::map<std::string, unsigned> known;
    for (const ProgramSource& program : programs) {
        std::string name = program.file.substr(0, program.file.rfind(".cl"));
        std::ranges::replace(name, '/', '.');
        const unsigned number = ++known[name];
        name += number > 1 ? fmt::format(".{}", number) : "";
        std::string defines;
        for (const Defines* of : { &options.defines, &program.defines }) {
            for (const auto& [define, value] : *of) {
                defines += fmt::format("#define {} {}\n", define, value.empty() ? "1" : value);
            }
        }
        files.emplace(name + ".cl", defines + textOf(options, program));
        for (const GeneratedSources* of : { &options.generated, &program.generated }) {
            for (const auto& [path, text] : *of) {
                files.emplace(fmt::format("{}/{}", name, path), text);
            }
        }
    }
    return files;
}

std::string compilerEnvironment()
{
    std::vector<std::string> settings;
    for (char** variable = environ; variable != nullptr && *variable != nullptr; ++variable) {
        const std::string_view setting(*variable);
        if (setting.starts_with("POCL_") && !setting.starts_with("POCL_CACHE_DIR=")) {
            settings.emplace_back(*variable);
        }
    }
    std::sort(settings.begin(), settings.end());
    return fmt::format("{}", fmt::join(settings, "\n"));
}

ProgramLibrary::ProgramLibrary(const Device& device, BuildOptions options)
    : device_(device)
    , options_(std::move(options))
    , disk_(ProgramCache::fromEnvironment())
{
    requirePlain(options_.defines);
}

cl::Program& ProgramLibrary::program(const ProgramSource& source)
{
    const auto found = programs_.find(source);
    return found != programs_.end() ? found->second : programs_.emplace(source, obtain(source)).first->second;
}

Kernel ProgramLibrary::kernel(const ProgramSource& source, const std::string& name)
{
    return Kernel(device_, program(source), source.file, name);
}

std::string ProgramLibrary::optionsString() const { return optionsString(options_.defines); }

std::string ProgramLibrary::optionsString(const ProgramSource& source, const std::string& text) const
{
    Defines used;
    for (const Defines* of : { &options_.defines, &source.defines }) {
        std::ranges::copy_if(
            *of, std::back_inserter(used), [&](const auto& define) { return names(text, define.first); });
    }
    return optionsString(used);
}

std::string ProgramLibrary::optionsString(const Defines& defines) const
{
    std::string text = "-cl-std=CL1.2";
    if (options_.kernelDir.empty()) {
        // Nobody but who edits kernels wants warnings, and some drivers print their number on the user's terminal:
        // PoCL, of its own built-ins, where the processor has no vectors of 16 floats.
        text += " -w";
    }
    if (options_.fastMath) {
        text += " -cl-fast-relaxed-math";
    } else if (device_.info().exactDivision) {
        text += exactDivisionOption;
    }
    for (const auto& [name, value] : defines) {
        text += value.empty() ? fmt::format(" -D{}", name) : fmt::format(" -D{}={}", name, value);
    }
    return text;
}

cl::Program ProgramLibrary::obtain(const ProgramSource& source)
{
    requirePlain(source.defines);
    const std::string text = textOf(options_, source);
    requireInterfaces(source, text);
    const std::string options = optionsString(source, text);
    const DriverCache::Mark mark;
    if (driverKeepsKernels(device_.info().platformVersion)) {
        ++compiled_;
        return compile(source, text, options);
    }
    const std::string key = cacheKey(options, text);
    if (const auto binary = disk_.load(key)) {
        if (cl::Program program; load(*binary, options, program)) {
            ++loaded_;
            return program;
        }
    }
    cl::Program program = compile(source, text, options);
    ++compiled_;
    try {
        disk_.store(key, program.getInfo<CL_PROGRAM_BINARIES>().at(0));
    } catch (const cl::Error&) {
        // A driver that hands out no binaries costs a compilation next time and nothing now.
    }
    return program;
}

cl::Program ProgramLibrary::compile(const ProgramSource& source, const std::string& text, const std::string& options)
{
    return checked("program " + source.file, device_.info().name, [&] {
        cl::Program program(device_.context(), text);
        try {
            program.build(device_.cl(), options.c_str());
        } catch (const cl::Error& error) {
            if (error.err() != CL_BUILD_PROGRAM_FAILURE) {
                throw;
            }
            reportFailure(
                source, text, options, namePlaces(program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(device_.cl()), text));
        }
        return program;
    });
}

bool ProgramLibrary::load(const ProgramCache::Binary& binary, const std::string& options, cl::Program& program)
{
    try {
        program = cl::Program(device_.context(), { device_.cl() }, cl::Program::Binaries { binary });
        program.build(device_.cl(), options.c_str());
        return true;
    } catch (const cl::Error&) {
        return false; // drivers may refuse binaries at any time; the source is at hand
    }
}

std::string ProgramLibrary::cacheKey(const std::string& options, const std::string& text) const
{
    const DeviceInfo& info = device_.info();
    return fmt::format("{}\n{}\n{}\n{}\n{}\n{}\n{}\n{}\n{}", info.platform, info.platformVersion, info.name,
        info.vendor, info.deviceVersion, info.driver, options, compilerEnvironment(), text);
}

void ProgramLibrary::reportFailure(
    const ProgramSource& source, const std::string& text, std::string options, const std::string& log) const
{
    const std::string report =
        writeTemporary(fmt::format("program: {}\ndevice: {} ({}, driver {})\noptions: {}\n\n{}\n\n{}", source.file,
            device_.info().name, device_.info().platform, device_.info().driver, options, log, text));
    const std::string remedy = remedyOfFailure(options_.kernelDir);
    if (const auto at = options.find(exactDivisionOption); at != std::string::npos) {
        options.erase(at, exactDivisionOption.size()); // one line has to hold the place in the kernel
    }
    throw Error(fmt::format("program {} does not build on {} with {}", source.file, device_.info().name, options),
        firstError(log), report.empty() ? remedy : remedy + "; whole log and source are in " + report);
}

} // namespace wedge::device
