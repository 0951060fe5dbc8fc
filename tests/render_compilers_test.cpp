// Processes that compile kernels for another one.
#include "device_testing.h"

#include "host/device/quirks.h"
#include "host/render/compilers.h"

#include <cstring>
#include <fstream>
#include <iterator>

using namespace wedge;
using namespace wedge::test;
namespace fs = std::filesystem;

namespace {

/// The caches of this process and of those that it starts.
const fs::path& cache()
{
    static const TemporaryFolder folder;
    return folder.path();
}

/// The driver is told of the cache before the first call of OpenCL, and so are the other processes.
device::Device opened()
{
    static const bool first = [] {
        ::setenv("WEDGE_CACHE_DIR", cache().c_str(), 1);
        ::unsetenv("POCL_CACHE_DIR");
        return true;
    }();
    (void)first;
    return device::Device::open("");
}

/// A program of a value of its own, which no other test has compiled.
graph::Trial trialOf(const char* kernel, std::size_t arguments, int value)
{
    graph::Trial trial { device::ProgramSource("device_basic.cl", { { "TEST_VALUE", std::to_string(value) } }),
        kernel };
    trial.items = 64;
    trial.itemsOfGroup = 16;
    trial.arguments.emplace_back(); // memory
    for (std::size_t i = 1; i < arguments; ++i)
        trial.arguments.emplace_back(sizeof(std::uint32_t)); // a count of 0
    return trial;
}

/// Programs of the tests, one kernel each.
render::CompileWork workOf(const device::Device& device, int value)
{
    render::CompileWork work { device.info().index, {}, 4096, {} };
    work.options.kernelDir = WEDGE_TEST_KERNELS;
    work.programs.push_back({ trialOf("addOne", 2, value) });
    return work;
}

std::uint64_t begun(const fs::path& file)
{
    std::ifstream stream(file, std::ios::binary);
    std::uint64_t number = 0;
    stream.read(reinterpret_cast<char*>(&number), sizeof(number));
    return number;
}

std::size_t compiledFiles()
{
    std::size_t count = 0;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(cache()))
        count += entry.path().extension() == ".so" ? 1 : 0;
    return count;
}

int callOn(const fs::path& file)
{
    return std::system((std::string(WEDGE_PROGRAM " compile-kernels 9 9<>") + file.string() + " 2>/dev/null").c_str());
}

} // namespace

TEST_CASE("a process that is handed a file of work compiles what nobody has begun with")
{
    const device::Device device = opened();
    const bool keeps = device::driverKeepsKernels(device.info().platformVersion);
    const fs::path file = cache() / "work";
    const auto bytes = render::workFile(workOf(device, 1));
    const auto write = [&](std::size_t count) {
        std::ofstream(file, std::ios::binary)
            .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(count));
    };
    write(bytes.size());
    const std::size_t before = compiledFiles();
    CHECK(callOn(file) == 0);
    CHECK(begun(file) == 2); // one, and that there is no second
    const std::size_t after = compiledFiles();
    CHECK((after > before || !keeps));
    CHECK(callOn(file) == 0);
    CHECK(compiledFiles() == after);
    // What is no such file costs an exit status.
    for (const std::size_t count : { std::size_t { 0 }, std::size_t { 8 }, std::size_t { 9 }, bytes.size() / 2 }) {
        CAPTURE(count);
        write(count);
        CHECK(callOn(file) != 0);
    }
}

TEST_CASE("work is done whether other processes start, fail, or help")
{
    const device::Device device = opened();
    int number = 0;
    for (const char* program : { "/nowhere/wedge", "/bin/false", WEDGE_PROGRAM }) {
        CAPTURE(program);
        render::CompileWork work = workOf(device, 10 + ++number);
        work.programs.push_back({ trialOf("testValue", 1, 20 + number) });
        device::ProgramLibrary programs(device, work.options);
        graph::Kernels kernels(programs);
        device::TimedQueue queue(device);
        const std::size_t before = compiledFiles();
        const std::size_t helped = render::compileSideBySide(program, 3, work, queue, kernels);
        CHECK(helped == (std::string(program) == WEDGE_PROGRAM ? 1 : 0)); // one for each program but ours
        const std::size_t after = compiledFiles();
        CAPTURE(after - before);
        CHECK((after >= before + 2 || !device::driverKeepsKernels(device.info().platformVersion)));
    }
}
