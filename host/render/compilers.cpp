#include "host/render/compilers.h"

#include "host/device/cache_folder.h"
#include "host/device/driver_cache.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <stdexcept>
#include <thread>
#include <tuple>
#include <utility>

namespace wedge::render {
namespace {

using nlohmann::json;
using Clock = std::chrono::steady_clock;

constexpr std::size_t largeGrid = 65535;
/// For the last program that a process has begun with, once nobody has another to begin with.
constexpr std::chrono::minutes longestWait { 2 };

json bytesOf(const std::vector<std::byte>& value)
{
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(value.data());
    return json::binary({ bytes, bytes + value.size() });
}

std::map<std::string, std::string> toJson(const device::GeneratedSources& sources)
{
    return { sources.begin(), sources.end() };
}

device::GeneratedSources sourcesFrom(const json& j)
{
    device::GeneratedSources out;
    for (const auto& [name, text] : j.items()) {
        out.emplace(name, text.get<std::string>());
    }
    return out;
}

json toJson(const device::ProgramSource& source) { return { source.file, source.defines, toJson(source.generated) }; }

device::ProgramSource sourceFrom(const json& j)
{
    return { j.at(0), j.at(1).get<device::Defines>(), sourcesFrom(j.at(2)) };
}

json toJson(const graph::Trial& t)
{
    json arguments = json::array();
    for (const std::vector<std::byte>& value : t.arguments) {
        arguments.push_back(bytesOf(value));
    }
    return { toJson(t.program), t.kernel, static_cast<int>(t.domain), std::move(arguments), t.columns, t.rows,
        t.columnsOfGroup, t.items, t.itemsOfGroup };
}

graph::Trial trialFrom(const json& j)
{
    graph::Trial t;
    t.program = sourceFrom(j.at(0));
    t.kernel = j.at(1);
    t.domain = static_cast<graph::Domain>(j.at(2).get<int>());
    for (const json& value : j.at(3)) {
        const auto& binary = value.get_binary();
        const auto* bytes = reinterpret_cast<const std::byte*>(binary.data());
        t.arguments.emplace_back(bytes, bytes + binary.size());
    }
    t.columns = j.at(4);
    t.rows = j.at(5);
    t.columnsOfGroup = j.at(6);
    t.items = j.at(7);
    t.itemsOfGroup = j.at(8);
    if (t.itemsOfGroup == 0 || (t.rows > 0 && t.columnsOfGroup == 0)) {
        throw std::runtime_error("work-groups of no items");
    }
    return t;
}

json toJson(const CompileWork& work)
{
    json programs = json::array();
    for (const std::vector<graph::Trial>& program : work.programs) {
        json trials = json::array();
        for (const graph::Trial& trial : program) {
            trials.push_back(toJson(trial));
        }
        programs.push_back(std::move(trials));
    }
    return { { "device", work.device }, { "defines", work.options.defines }, { "fastMath", work.options.fastMath },
        { "kernelDir", work.options.kernelDir }, { "generated", toJson(work.options.generated) },
        { "mostBytes", work.mostBytes }, { "programs", std::move(programs) } };
}

CompileWork workFrom(const json& j)
{
    CompileWork work;
    work.device = j.at("device");
    work.options.defines = j.at("defines");
    work.options.fastMath = j.at("fastMath");
    work.options.kernelDir = j.at("kernelDir");
    work.options.generated = sourcesFrom(j.at("generated"));
    work.mostBytes = j.at("mostBytes");
    for (const json& program : j.at("programs")) {
        std::vector<graph::Trial>& trials = work.programs.emplace_back();
        for (const json& trial : program) {
            trials.push_back(trialFrom(trial));
        }
    }
    return work;
}

/// A file that processes share: the number of the next program to compile, then the work.
class SharedWork {
public:
    explicit SharedWork(int file)
        : file_(file)
    {
        struct stat found { };
        if (::fstat(file, &found) == 0 && found.st_size > static_cast<off_t>(sizeof(std::uint64_t))) {
            bytes_ = static_cast<std::size_t>(found.st_size);
            void* mapped = ::mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
            memory_ = mapped != MAP_FAILED ? static_cast<std::uint8_t*>(mapped) : nullptr;
        }
    }
    ~SharedWork()
    {
        if (memory_ != nullptr) {
            ::munmap(memory_, bytes_);
        }
    }
    SharedWork(const SharedWork&) = delete;
    SharedWork& operator=(const SharedWork&) = delete;

    bool isMapped() const { return memory_ != nullptr; }
    int file() const { return file_; }
    CompileWork work() const { return workFrom(json::from_cbor(memory_ + sizeof(std::uint64_t), memory_ + bytes_)); }
    /// The next program that nobody has begun with.
    std::size_t claim() { return std::atomic_ref(*reinterpret_cast<std::uint64_t*>(memory_)).fetch_add(1); }

private:
    int file_;
    std::uint8_t* memory_ = nullptr;
    std::size_t bytes_ = 0;
};

/// A file without a name that holds the work; null where there is none to be had.
std::unique_ptr<std::FILE, int (*)(std::FILE*)> written(const CompileWork& work)
{
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::tmpfile(), std::fclose);
    const std::vector<std::uint8_t> bytes = workFile(work);
    if (file
        && (std::fwrite(bytes.data(), 1, bytes.size(), file.get()) != bytes.size() || std::fflush(file.get()) != 0)) {
        file.reset();
    }
    return file;
}

/// The numbers of the processes that started.
std::vector<pid_t> startProcesses(const std::string& program, std::size_t count, int file)
{
    // The copy's number is theirs, too; the file's own is not.
    ::fcntl(file, F_SETFD, FD_CLOEXEC);
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    ::posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    ::posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    const int inherited = ::dup(file);
    std::string name = program, command = "compile-kernels", number = std::to_string(inherited);
    char* arguments[] = { name.data(), command.data(), number.data(), nullptr };
    std::vector<pid_t> started;
    for (std::size_t i = 0; inherited >= 0 && i < count; ++i) {
        pid_t process = 0;
        if (::posix_spawn(&process, program.c_str(), &actions, nullptr, arguments, environ) == 0) {
            started.push_back(process);
        }
    }
    ::close(inherited);
    ::posix_spawn_file_actions_destroy(&actions);
    return started;
}

/// Whether a process ends with status 0 until then; ends it if it does not end.
bool endsWell(pid_t process, Clock::time_point until)
{
    int status = 0;
    for (;;) {
        const pid_t ended = ::waitpid(process, &status, WNOHANG);
        if (ended == process) {
            return WIFEXITED(status) && WEXITSTATUS(status) == 0;
        }
        if ((ended < 0 && errno != EINTR) || Clock::now() > until) {
            ::kill(process, SIGKILL);
            ::waitpid(process, &status, 0);
            return false;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
}

void compile(SharedWork& shared, const CompileWork& work, device::TimedQueue& queue, graph::Kernels& kernels)
{
    const std::vector<std::vector<graph::Trial>>& programs = work.programs;
    // Never touched, but by what reads a list whose length it does not ask for.
    const device::Buffer<std::uint8_t> memory(queue.device(), static_cast<std::size_t>(work.mostBytes), "anything");
    for (std::size_t i = shared.claim(); i < programs.size(); i = shared.claim()) {
        for (const graph::Trial& trial : programs[i]) {
            device::Kernel& kernel = kernels.find(trial.program, trial.kernel);
            for (unsigned k = 0; k < trial.arguments.size(); ++k) {
                if (trial.arguments[k].empty()) {
                    kernel.setArg(k, memory.cl());
                }
            }
            graph::launch(queue, "compile", device::PassKind::Analysis, kernel, trial);
        }
        queue.finish();
    }
}

auto sizeOf(const graph::Trial& t)
{
    return std::tuple(t.program, t.kernel, t.domain, t.columns, t.rows, t.items, t.itemsOfGroup);
}

} // namespace

std::size_t CompileWork::kernels() const
{
    std::size_t sum = 0;
    for (const std::vector<graph::Trial>& program : programs) {
        sum += program.size();
    }
    return sum;
}

CompileWork compileWork(const device::Device& device, const device::BuildOptions& options, const graph::Plan& plan,
    const std::vector<graph::Trial>& trials)
{
    CompileWork work { device.info().index, options, 1, {} };
    for (std::size_t i = 0; i < plan.lifetimes.size(); ++i) {
        if (plan.lifetimes[i]) {
            work.mostBytes = std::max(work.mostBytes, plan.graph.resources()[i].bytes());
        }
    }
    std::map<device::ProgramSource, std::vector<graph::Trial>> programs;
    std::set<decltype(sizeOf(trials.front()))> known;
    for (const graph::Trial& trial : trials) {
        if (known.insert(sizeOf(trial)).second) {
            programs[trial.program].push_back(trial);
        }
    }
    // What traces has most text, and takes longest by far.
    std::vector<std::pair<std::size_t, std::vector<graph::Trial>>> bySize;
    bySize.reserve(programs.size());
    for (auto& [program, of] : programs) {
        bySize.emplace_back(device::textOf(options, program).size(), std::move(of));
    }
    std::ranges::stable_sort(bySize, std::greater(), [](const auto& program) { return program.first; });
    for (auto& [size, of] : bySize) {
        work.programs.push_back(std::move(of));
    }
    return work;
}

std::vector<std::uint8_t> workFile(const CompileWork& work)
{
    std::vector<std::uint8_t> bytes(sizeof(std::uint64_t), 0);
    json::to_cbor(toJson(work), bytes);
    return bytes;
}

std::size_t compileSideBySide(const std::string& program, std::size_t count, const CompileWork& work,
    device::TimedQueue& queue, graph::Kernels& kernels)
{
    const auto file = written(work);
    if (!file || work.programs.empty()) {
        return 0;
    }
    SharedWork shared(::fileno(file.get()));
    if (!shared.isMapped()) {
        return 0;
    }
    const std::vector<pid_t> processes =
        startProcesses(program, std::min(count, work.programs.size() - 1), shared.file());
    try {
        compile(shared, work, queue, kernels);
    } catch (const std::exception&) {
        // What does not compile, or fit, is said where it is launched for good.
    }
    const Clock::time_point until = Clock::now() + longestWait;
    return static_cast<std::size_t>(
        std::ranges::count_if(processes, [&](pid_t process) { return endsWell(process, until); }));
}

int compileShare(int file)
{
    ::prctl(PR_SET_PDEATHSIG, SIGTERM); // nobody waits for it then
    // Who started it holds the mark of the driver's cache and records what comes in: of one that is ended from outside
    // nothing is to be left that speaks of damage. The driver has its folder from there, too.
    ::setenv("WEDGE_CACHE_DIR", "", 1);
    SharedWork shared(file);
    if (!shared.isMapped()) {
        return 1;
    }
    const CompileWork work = shared.work();
    const device::Device device = device::Device::open(std::to_string(work.device));
    device::ProgramLibrary programs(device, work.options);
    graph::Kernels kernels(programs);
    device::TimedQueue queue(device);
    compile(shared, work, queue, kernels);
    return 0;
}

KnownKernels::KnownKernels(const device::Device& device, const device::ProgramLibrary& programs,
    const device::BuildOptions& options, const graph::Plan& plan)
{
    const std::filesystem::path& folder = device::DriverCache::ofProcess().folder();
    const char* drivers = std::getenv("POCL_CACHE_DIR");
    if (folder.empty() || drivers == nullptr || folder != drivers) {
        return; // the driver's cache is elsewhere, or nowhere
    }
    std::map<device::ProgramSource, std::set<std::string>> kernelsOf;
    for (const graph::PlannedPass& planned : plan.passes) {
        if (planned.pass->domain != graph::Domain::Host) {
            // Kernels are compiled once more for grids of 65535 items along one axis, which only lists have.
            const graph::Pass& pass = *planned.pass;
            const char* size = pass.domain == graph::Domain::Items && pass.mostItems >= largeGrid ? "large" : "";
            kernelsOf[*planned.program].insert(pass.kernel.name + size);
        }
    }
    const device::DeviceInfo& info = device.info();
    std::string all =
        fmt::format("{}\n{}\n{}\n{}\n", info.platformVersion, info.name, info.driver, device::compilerEnvironment());
    for (const auto& [program, kernels] : kernelsOf) {
        const std::string text = device::textOf(options, program);
        all += fmt::format("{}\n{}\n{}\n", programs.optionsString(program, text), fmt::join(kernels, " "), text);
    }
    path_ = folder / fmt::format("{}{:016x}", device::knownKernels, std::hash<std::string>()(all));
}

bool KnownKernels::areKnown() const
{
    std::error_code failed;
    return path_.empty() || std::filesystem::exists(path_, failed);
}

void KnownKernels::remember() const
{
    if (!path_.empty()) {
        std::ofstream(path_, std::ios::app);
    }
}

} // namespace wedge::render
