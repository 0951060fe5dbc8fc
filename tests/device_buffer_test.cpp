#include "device_testing.h"

#include "host/device/buffer.h"
#include "host/device/queue.h"

#include <fstream>
#include <limits>
#include <numeric>

#include <unistd.h>

using namespace wedge::device;
using wedge::test::contains;
using wedge::test::errorOf;

namespace {

struct Odd {
    float x, y, z;
    bool operator==(const Odd&) const = default;
};

DeviceInfo imaginary(std::uint64_t memory, std::uint64_t allocation)
{
    DeviceInfo info;
    info.name = "imaginary";
    info.globalMemory = memory;
    info.maxAllocation = allocation;
    return info;
}

constexpr std::uint64_t MiB = 1024 * 1024;

/// What this process has in memory, bytes.
std::uint64_t residentBytes()
{
    std::ifstream statistics("/proc/self/statm");
    std::uint64_t pages = 0, resident = 0;
    statistics >> pages >> resident;
    return resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

} // namespace

TEST_CASE("what goes up comes down, whole and in parts")
{
    for (const Device& device : wedge::test::usableDevices()) {
        CAPTURE(device.info().name);
        TimedQueue queue(device);
        Buffer<unsigned> buffer(device, 1001, "numbers");
        CHECK(buffer.size() == 1001);
        CHECK(buffer.bytes() == 4004);
        std::vector<unsigned> values(1001);
        std::iota(values.begin(), values.end(), 7u);
        buffer.upload(queue, values);
        CHECK(buffer.downloadAll(queue) == values);

        const std::vector<unsigned> part { 1, 2, 3 };
        buffer.upload(queue, part, 998);
        std::copy(part.begin(), part.end(), values.begin() + 998);
        CHECK(buffer.downloadAll(queue) == values);
        std::vector<unsigned> some(5);
        buffer.download(queue, some, 995);
        CHECK(some == std::vector<unsigned>(values.begin() + 995, values.begin() + 1000));
    }
}

TEST_CASE("fill sets every element, whatever its size")
{
    for (const Device& device : wedge::test::usableDevices()) {
        CAPTURE(device.info().name);
        TimedQueue queue(device);
        Buffer<double> doubles(device, 17, "doubles");
        doubles.fill(queue, -2.5);
        CHECK(doubles.downloadAll(queue) == std::vector<double>(17, -2.5));
        Buffer<Odd> odd(device, 5, "twelve bytes each");
        odd.fill(queue, { 1, 2, 3 });
        CHECK(odd.downloadAll(queue) == std::vector<Odd>(5, { 1, 2, 3 }));
        Buffer<unsigned char> bytes(device, 3, "bytes");
        bytes.fill(queue, 255);
        CHECK(bytes.downloadAll(queue) == std::vector<unsigned char>(3, 255));
    }
}

TEST_CASE("an empty buffer is a buffer")
{
    for (const Device& device : wedge::test::usableDevices()) {
        CAPTURE(device.info().name);
        TimedQueue queue(device);
        Buffer<Odd> buffer(device, 0, "empty");
        CHECK(buffer.size() == 0);
        CHECK(buffer.bytes() == 0);
        CHECK(buffer.cl()() != nullptr);
        buffer.fill(queue, { 1, 2, 3 });
        buffer.upload(queue, std::span<const Odd>());
        CHECK(buffer.downloadAll(queue).empty());
    }
}

TEST_CASE("large buffers hold what they are given as long as a part of them is there, and give their memory back")
{
    for (const Device& device : wedge::test::usableDevices()) {
        CAPTURE(device.info().name);
        TimedQueue queue(device);
        constexpr std::size_t count = 8 * MiB; // 32 MiB
        const auto lastOf = [&] {
            const Buffer<unsigned> whole(device, count, "whole");
            std::vector<unsigned> values(count);
            std::iota(values.begin(), values.end(), 3u);
            Buffer<unsigned> written = whole;
            written.upload(queue, values);
            CHECK(whole.downloadAll(queue) == values);
            return whole.part<unsigned>(count - 256, 256, "end");
        };
        std::vector<unsigned> end(256);
        std::iota(end.begin(), end.end(), static_cast<unsigned>(count - 256 + 3));
        std::uint64_t before = 0;
        for (int round = 0; round < 24; ++round) {
            const Buffer<unsigned> part = lastOf();
            CHECK(part.downloadAll(queue) == end);
            before = round == 1 ? residentBytes() : before;
        }
        if (device.info().type == DeviceType::Cpu) {
            CHECK(residentBytes() < before + 320 * MiB); // 22 rounds of 32 MiB
        }
    }
}

TEST_CASE("transfers beyond the buffer are refused, also where the sum of offset and size wraps")
{
    for (const Device& device : wedge::test::usableDevices()) {
        CAPTURE(device.info().name);
        TimedQueue queue(device);
        Buffer<unsigned> buffer(device, 8, "eight");
        buffer.fill(queue, 1u);
        std::vector<unsigned> nine(9);
        std::vector<unsigned> two(2);
        CHECK(contains(
            errorOf([&] { buffer.upload(queue, nine); }), "upload to buffer eight of 8 elements: 9 elements at 0"));
        CHECK(contains(errorOf([&] { buffer.download(queue, nine); }), "download from buffer eight"));
        CHECK(contains(errorOf([&] { buffer.upload(queue, two, 7); }), "2 elements at 7"));
        CHECK(contains(errorOf([&] { buffer.upload(queue, two, std::numeric_limits<std::size_t>::max()); }), "eight"));
        CHECK(buffer.downloadAll(queue) == std::vector<unsigned>(8, 1u));
    }
}

TEST_CASE("a buffer above the device's limit is refused before the driver sees it")
{
    for (const Device& device : wedge::test::usableDevices()) {
        const std::uint64_t limit = device.info().maxAllocation;
        for (const std::size_t count :
            { static_cast<std::size_t>(limit / sizeof(Odd) + 1), std::numeric_limits<std::size_t>::max() }) {
            const std::string message = errorOf([&] { Buffer<Odd>(device, count, "gigantic"); });
            CHECK(contains(message, "buffer gigantic"));
            CHECK(contains(message, mebibytes(limit)));
            CHECK(contains(message, device.info().name));
        }
    }
}

TEST_CASE("the plan adds up and lists the largest first")
{
    MemoryPlan plan;
    CHECK(plan.total() == 0);
    CHECK_NOTHROW(plan.check(imaginary(0, 0)));
    plan.add("small", 3 * MiB / 2);
    plan.addItems("large", 4 * 1024, 1024);
    CHECK(plan.total() == 11 * MiB / 2);
    CHECK(plan.table() == "large       4.0 MiB\nsmall       1.5 MiB\ntotal       5.5 MiB\n");
}

TEST_CASE("the plan refuses what does not fit, to the byte")
{
    MemoryPlan plan;
    plan.add("g-buffer", 60 * MiB);
    plan.add("term", 30 * MiB);
    // A tenth is reserved, a fifth where the host lives in the same memory.
    CHECK_NOTHROW(plan.check(imaginary(100 * MiB, 60 * MiB)));
    DeviceInfo shared = imaginary(100 * MiB, 60 * MiB);
    shared.unifiedMemory = true;
    CHECK_THROWS_AS(plan.check(shared), wedge::Error);
    CHECK_NOTHROW(plan.check(imaginary(100 * MiB, 60 * MiB), 90 * MiB));
    CHECK_NOTHROW(plan.check(imaginary(100 * MiB, 60 * MiB), 1000 * MiB));

    std::string message = errorOf([&] { plan.check(imaginary(100 * MiB, 60 * MiB), 90 * MiB - 1); });
    CHECK(contains(message, "are allowed"));
    message = errorOf([&] { plan.check(imaginary(100 * MiB, 60 * MiB - 1)); });
    CHECK(contains(message, "g-buffer"));
    message = errorOf([&] { plan.check(imaginary(100 * MiB - 10, 60 * MiB)); });
    for (const char* part : { "imaginary", "90.0 MiB", "g-buffer (60.0 MiB)", "--size", "--device" }) {
        CHECK(contains(message, part));
    }
}

TEST_CASE("an image of 100000x100000 is refused and no arithmetic wraps")
{
    constexpr std::uint64_t pixels = std::uint64_t { 100000 } * 100000;
    MemoryPlan plan;
    plan.addItems("position", pixels, 16);
    CHECK(plan.total() == 160000000000u);
    const std::string message = errorOf([&] { plan.check(imaginary(4096 * MiB, 1024 * MiB)); });
    CHECK(contains(message, "152587.9 MiB"));

    MemoryPlan absurd;
    absurd.addItems("product wraps", pixels, std::uint64_t { 1 } << 60);
    absurd.addItems("sum wraps", pixels, 1000);
    CHECK(absurd.total() == std::numeric_limits<std::uint64_t>::max());
    CHECK_THROWS_AS(absurd.check(imaginary(4096 * MiB, 1024 * MiB)), wedge::Error);
    CHECK_THROWS_AS(absurd.check(imaginary(std::numeric_limits<std::uint64_t>::max(), 1024 * MiB)), wedge::Error);
    for (const Device& device : wedge::test::usableDevices()) {
        CHECK_THROWS_AS(absurd.check(device.info()), wedge::Error);
    }
}
