#include "device_testing.h"

#include "host/device/buffer.h"
#include "host/device/cache_root.h"
#include "host/device/program_cache.h"
#include "host/device/queue.h"
#include "host/device/quirks.h"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <iterator>
#include <regex>

using namespace wedge::device;
using wedge::test::contains;
using wedge::test::errorOf;
using wedge::test::TemporaryFolder;

namespace fs = std::filesystem;

namespace {

std::string textOf(const fs::path& path)
{
    std::ifstream stream(path, std::ios::binary);
    return { std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>() };
}

void writeText(const fs::path& path, const std::string& text)
{
    std::ofstream(path, std::ios::binary).write(text.data(), static_cast<std::streamsize>(text.size()));
}

std::vector<fs::path> filesOf(const fs::path& folder)
{
    return std::vector<fs::path>(fs::directory_iterator(folder), fs::directory_iterator());
}

BuildOptions testOptions(const std::string& value)
{
    BuildOptions options;
    options.kernelDir = WEDGE_TEST_KERNELS;
    options.defines = { { "TEST_VALUE", value } };
    return options;
}

/// While it lives no driver is taken for one that keeps kernels by itself: ours are the only binaries.
struct DriverForgets {
    DriverForgets() { ::setenv("POCL_KERNEL_CACHE", "0", 1); }
    ~DriverForgets() { ::unsetenv("POCL_KERNEL_CACHE"); }
    DriverForgets(const DriverForgets&) = delete;
    DriverForgets& operator=(const DriverForgets&) = delete;
};

/// Builds with TEST_VALUE = value, runs the kernel, checks its answer, and says how the program came about.
std::string provenance(const Device& device, const std::string& value)
{
    ProgramLibrary library(device, testOptions(value));
    Kernel kernel = library.kernel("device_basic.cl", "testValue");
    TimedQueue queue(device);
    Buffer<int> result(device, 1, "result");
    result.fill(queue, 0);
    kernel.setArgs(result);
    queue.launch("testValue", PassKind::Analysis, kernel, 1, 1);
    CHECK(result.downloadAll(queue) == std::vector<int> { std::stoi(value) });
    REQUIRE(library.compiled() + library.loaded() == 1);
    return library.compiled() == 1 ? "compiled" : "loaded";
}

} // namespace

TEST_CASE("options: defines, fast maths and what drivers could misread")
{
    const Device device = Device::open("");
    CHECK(ProgramLibrary(device, {}).optionsString()
        == (device.info().exactDivision ? "-cl-std=CL1.2 -w -cl-fp32-correctly-rounded-divide-sqrt"
                                        : "-cl-std=CL1.2 -w"));
    BuildOptions options;
    options.defines = { { "A", "1" }, { "FLAG", "" } };
    options.fastMath = true;
    CHECK(ProgramLibrary(device, options).optionsString() == "-cl-std=CL1.2 -w -cl-fast-relaxed-math -DA=1 -DFLAG");
    options.defines = { { "A", "1 + 1" } };
    CHECK(contains(errorOf([&] { ProgramLibrary(device, options); }), "1 + 1"));
}

TEST_CASE("programs of one file differ by defines, in memory and on the disk")
{
    const DriverForgets forgets;
    for (const Device& device : wedge::test::usableDevices()) {
        const TemporaryFolder folder;
        ::setenv("WEDGE_CACHE_DIR", folder.path().c_str(), 1);
        for (const unsigned loaded : { 0u, 2u }) {
            BuildOptions options;
            options.kernelDir = WEDGE_TEST_KERNELS;
            options.defines = { { "NAMED_NOWHERE", std::to_string(loaded) } }; // another one, which tells nothing apart
            ProgramLibrary library(device, options);
            TimedQueue queue(device);
            for (const int value : { 3, 4, 3 }) {
                Kernel kernel =
                    library.kernel({ "device_basic.cl", { { "TEST_VALUE", std::to_string(value) } } }, "testValue");
                Buffer<int> result(device, 1, "result");
                result.fill(queue, 0);
                kernel.setArgs(result);
                queue.launch("testValue", PassKind::Analysis, kernel, 1, 1);
                CHECK(result.downloadAll(queue) == std::vector<int> { value });
            }
            CHECK(library.loaded() == loaded);
            CHECK(library.compiled() == 2 - loaded);
            CHECK(contains(errorOf([&] { library.program({ "device_basic.cl", { { "A", "1 + 1" } } }); }), "1 + 1"));
        }
    }
}

TEST_CASE("a kernel without its interface is told of it")
{
    for (const Device& device : wedge::test::usableDevices()) {
        ProgramLibrary library = wedge::test::testLibrary(device);
        const ProgramSource source("device_basic.cl", {}, { { "pass/addOne.h", "#define PASS_addOne 1\n" } });
        const std::string message = errorOf([&] { library.kernel(source, "addOne"); });
        CHECK(contains(message, "addOne (device_basic.cl)"));
        CHECK(contains(message, "#include \"pass/addOne.h\""));
    }
}

TEST_CASE("a program is built once and its kernels have arguments of their own")
{
    for (const Device& device : wedge::test::usableDevices()) {
        CAPTURE(device.info().name);
        ProgramLibrary library = wedge::test::testLibrary(device);
        TimedQueue queue(device);
        Buffer<unsigned> a(device, 3, "a");
        Buffer<unsigned> b(device, 3, "b");
        a.fill(queue, 0u);
        b.fill(queue, 10u);
        Kernel first = library.kernel("device_basic.cl", "addOne");
        Kernel second = library.kernel("device_basic.cl", "addOne");
        CHECK(&library.program("device_basic.cl") == &library.program("device_basic.cl"));
        CHECK(library.compiled() == 1);
        CHECK(first.argCount() == 2);
        CHECK(first.workGroupLimit() >= 1);
        first.setArgs(a, 3u);
        second.setArgs(b.cl(), 3u);
        queue.launch("addOne", PassKind::Analysis, first, 3, 1);
        queue.launch("addOne", PassKind::Analysis, second, 3, 1);
        CHECK(a.downloadAll(queue) == std::vector<unsigned> { 1, 1, 1 });
        CHECK(b.downloadAll(queue) == std::vector<unsigned> { 11, 11, 11 });
    }
}

TEST_CASE("included files compile, each once")
{
    for (const Device& device : wedge::test::usableDevices()) {
        CAPTURE(device.info().name);
        BuildOptions options;
        options.kernelDir = WEDGE_TEST_KERNELS "/includes";
        ProgramLibrary library(device, options);
        Kernel kernel = library.kernel("diamond.cl", "diamond");
        TimedQueue queue(device);
        Buffer<int> result(device, 1, "result");
        kernel.setArgs(result);
        queue.launch("diamond", PassKind::Analysis, kernel, 1, 1);
        CHECK(result.downloadAll(queue) == std::vector<int> { 111 });
    }
}

TEST_CASE("structs by value and local memory arrive")
{
    struct Linear {
        float scale;
        int offset;
    };
    for (const Device& device : wedge::test::usableDevices()) {
        CAPTURE(device.info().name);
        ProgramLibrary library = wedge::test::testLibrary(device);
        TimedQueue queue(device);
        Buffer<float> data(device, 2, "data");
        data.upload(queue, std::vector<float> { 1.0f, -2.0f });
        Kernel linear = library.kernel("device_basic.cl", "linear");
        linear.setArgs(data, Linear { 0.5f, 3 }, 2u);
        queue.launch("linear", PassKind::Analysis, linear, 2, 1);
        CHECK(data.downloadAll(queue) == std::vector<float> { 3.5f, 2.0f });

        Buffer<unsigned> numbers(device, 4, "numbers");
        numbers.upload(queue, std::vector<unsigned> { 1, 2, 3, 4 });
        Kernel reverse = library.kernel("device_basic.cl", "reverseGroup");
        reverse.setArgs(numbers, cl::Local(4 * sizeof(unsigned)));
        queue.launch("reverse", PassKind::Analysis, reverse, 4, 4);
        CHECK(numbers.downloadAll(queue) == std::vector<unsigned> { 4, 3, 2, 1 });
    }
}

TEST_CASE("wrong arguments and names are errors with kernel and device")
{
    for (const Device& device : wedge::test::usableDevices()) {
        CAPTURE(device.info().name);
        ProgramLibrary library = wedge::test::testLibrary(device);
        Buffer<unsigned> data(device, 3, "data");
        Kernel kernel = library.kernel("device_basic.cl", "addOne");

        std::string message = errorOf([&] { kernel.setArgs(data); });
        CHECK(contains(message, "kernel addOne (device_basic.cl) takes 2 arguments: 1 given"));
        message = errorOf([&] { kernel.setArgs(data, 3.0); });
        CHECK(contains(message, "argument 1 (8 bytes) of kernel addOne (device_basic.cl) on " + device.info().name));
        CHECK(contains(message, "CL_INVALID_ARG_SIZE"));
        message = errorOf([&] { library.kernel("device_basic.cl", "subtractOne"); });
        CHECK(contains(message, "no such kernel in device_basic.cl: subtractOne"));
        CHECK(contains(message, "addOne"));
        message = errorOf([&] { library.kernel("nothing.cl", "addOne"); });
        CHECK(contains(message, "nothing.cl"));

        Kernel unset = library.kernel("device_basic.cl", "addOne");
        TimedQueue queue(device);
        message = errorOf([&] { queue.launch("forgotten", PassKind::Analysis, unset, 3, 1); });
        CAPTURE(message);
        CHECK(contains(message, "clEnqueueNDRangeKernel for pass forgotten, kernel addOne (device_basic.cl)"));
        CHECK(contains(message, "CL_INVALID_KERNEL_ARGS"));
        CHECK(contains(message, device.info().name));
    }
}

TEST_CASE("a failed build names device, options, the real file and line, and where the whole log is")
{
    struct Case {
        const char* program;
        const char* place;
        const char* name;
    };
    for (const Device& device : wedge::test::usableDevices()) {
        for (const Case& broken : { Case { "broken_in_include.cl", "/includes/broken.h:3:", "undeclaredName" },
                 Case { "broken_after_include.cl", "/includes/broken_after_include.cl:5:", "alsoUndeclared" } }) {
            BuildOptions options = testOptions("1");
            options.kernelDir += "/includes";
            ProgramLibrary library(device, options);
            const std::string message = errorOf([&] { library.program(broken.program); });
            CAPTURE(message);
            CHECK_FALSE(contains(message, "\n"));
            for (const std::string& part :
                { std::string(broken.program), device.info().name, std::string("-cl-std=CL1.2 "),
                    std::string(" -DTEST_VALUE=1: "), std::string(broken.place), std::string(broken.name) }) {
                CHECK(contains(message, part));
            }
            std::smatch report;
            REQUIRE(std::regex_search(message, report, std::regex("whole log and source are in (.*)$")));
            const std::string text = textOf(report[1].str());
            CHECK(contains(text, "#line 1 \"" WEDGE_TEST_KERNELS "/includes/"));
            CHECK(contains(text, broken.place));
            CHECK(contains(text, device.info().name));
            fs::remove(report[1].str());
        }
    }
}

TEST_CASE("binaries come from the disk when nothing changed, and from the source when anything did")
{
    for (const Device& device : wedge::test::usableDevices()) {
        CAPTURE(device.info().name);
        const DriverForgets setting;
        const TemporaryFolder folder;
        const fs::path cache = folder.path() / "made" / "on demand";
        ::setenv("WEDGE_CACHE_DIR", cache.c_str(), 1);
        CHECK(provenance(device, "42") == "compiled");
        REQUIRE(filesOf(cache).size() == 1);
        CHECK(provenance(device, "42") == "loaded");
        CHECK(provenance(device, "43") == "compiled");
        CHECK(filesOf(cache).size() == 2);
        CHECK(provenance(device, "42") == "loaded");
    }
}

TEST_CASE("a damaged cache entry is ignored and replaced")
{
    constexpr std::size_t headerBytes = 32;
    for (const Device& device : wedge::test::usableDevices()) {
        CAPTURE(device.info().name);
        const DriverForgets setting;
        const TemporaryFolder folder;
        ::setenv("WEDGE_CACHE_DIR", folder.path().c_str(), 1);
        REQUIRE(provenance(device, "5") == "compiled");
        const fs::path entry = filesOf(folder.path()).at(0);
        const std::string good = textOf(entry);
        std::uint64_t keyBytes = 0;
        std::memcpy(&keyBytes, good.data() + 8, sizeof(keyBytes));

        std::string flipped = good;
        flipped.back() = static_cast<char>(flipped.back() ^ 1);
        std::string otherKey = good;
        otherKey[headerBytes] = static_cast<char>(otherKey[headerBytes] ^ 1);
        std::string hugeKey = good;
        hugeKey.replace(8, 8, 8, '\xff');
        for (const std::string& bad : { std::string(), std::string("x"), good.substr(0, headerBytes),
                 good.substr(0, good.size() - 1), good + "x", flipped, otherKey, hugeKey }) {
            writeText(entry, bad);
            CHECK(provenance(device, "5") == "compiled");
            CHECK(provenance(device, "5") == "loaded"); // it was replaced
        }
        // An entry that is whole, but that the driver refuses. Some drivers abort on it, which the checks before are
        // there to prevent, so this runs where refusing is known to work.
        if (contains(device.info().platform, "Portable Computing Language")) {
            ProgramCache(folder.path())
                .store(good.substr(headerBytes, keyBytes), { 'n', 'o', 't', ' ', 'o', 'n', 'e' });
            CHECK(provenance(device, "5") == "compiled");
        }
    }
}

TEST_CASE("of hundreds of entries the oldest are dropped, and nothing else")
{
    const TemporaryFolder folder;
    for (int i = 0; i < 305; ++i) {
        writeText(folder.path() / ("theirs" + std::to_string(i) + ".clbin"), "");
    }
    const ProgramCache cache(folder.path());
    for (int i = 0; i < 305; ++i) {
        cache.store(std::to_string(i), { 'x' });
    }
    CHECK(filesOf(folder.path()).size() == 305 + 300);
    CHECK(fs::exists(folder.path() / "theirs304.clbin"));
}

TEST_CASE("a driver that keeps kernels by itself is not asked for binaries, for which it would compile them again")
{
    for (const Device& device : wedge::test::usableDevices()) {
        CAPTURE(device.info().name);
        const TemporaryFolder folder;
        ::setenv("WEDGE_CACHE_DIR", folder.path().c_str(), 1);
        const bool keeps = driverKeepsKernels(device.info().platformVersion);
        CHECK(provenance(device, "7") == "compiled");
        CHECK(provenance(device, "7") == (keeps ? "compiled" : "loaded"));
        const auto files = filesOf(folder.path());
        const auto binaries =
            std::ranges::count_if(files, [](const fs::path& file) { return file.extension() == ".clbin"; });
        CHECK(binaries == (keeps ? 0 : 1));
    }
}

TEST_CASE("the cache can be off, and a folder that cannot be written costs nothing but time")
{
    const Device device = Device::open("");
    const DriverForgets setting;
    const TemporaryFolder folder;
    writeText(folder.path() / "file", "in the way");
    for (const fs::path& cache : { fs::path(), folder.path() / "file", folder.path() / "file" / "below" }) {
        ::setenv("WEDGE_CACHE_DIR", cache.c_str(), 1);
        CHECK(provenance(device, "6") == "compiled");
        CHECK(provenance(device, "6") == "compiled");
    }
    CHECK(filesOf(folder.path()).size() == 1);
}

TEST_CASE("the cache folder: WEDGE_CACHE_DIR before XDG_CACHE_HOME before HOME")
{
    const char* user = std::getenv("HOME");
    const std::string home = user != nullptr ? user : "";
    ::setenv("HOME", "/h", 1);
    ::setenv("XDG_CACHE_HOME", "/x", 1);
    ::setenv("WEDGE_CACHE_DIR", "/w", 1);
    const auto folder = [] { return wedge::device::WantedCache::fromEnvironment().folder; };
    CHECK(folder() == "/w");
    ::unsetenv("WEDGE_CACHE_DIR");
    CHECK(folder() == "/x/wedge");
    ::unsetenv("XDG_CACHE_HOME");
    CHECK(folder() == "/h/.cache/wedge");
    ::unsetenv("HOME");
    CHECK(folder().empty());
    CHECK_FALSE(wedge::device::WantedCache::fromEnvironment().off);
    ::setenv("HOME", home.c_str(), 1);
    ::setenv("WEDGE_CACHE_DIR", "", 1);
    CHECK(folder().empty());
    CHECK(wedge::device::WantedCache::fromEnvironment().off);
}

TEST_CASE("the cache drops its oldest entries")
{
    const TemporaryFolder folder;
    const ProgramCache cache(folder.path());
    cache.store("first", { 1 });
    fs::last_write_time(cache.entry("first"), fs::file_time_type::clock::now() - std::chrono::hours(1));
    for (int i = 0; i < 320; ++i) {
        cache.store("key " + std::to_string(i), { 2, 3 });
    }
    CHECK(filesOf(folder.path()).size() <= 300);
    CHECK_FALSE(cache.load("first"));
    CHECK(cache.load("key 319") == ProgramCache::Binary { 2, 3 });
    CHECK_FALSE(cache.load("key 320"));
}
