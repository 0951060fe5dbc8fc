#include "device_testing.h"

#include "host/device/batch_sizer.h"
#include "host/device/buffer.h"
#include "host/device/queue.h"

#include <algorithm>
#include <cmath>

using namespace wedge::device;
using wedge::test::contains;
using wedge::test::errorOf;
using wedge::test::testLibrary;
using wedge::test::usableDevices;

TEST_CASE("launches are padded to whole work-groups, and none is made for nothing")
{
    for (const Device& device : usableDevices()) {
        CAPTURE(device.info().name);
        ProgramLibrary library = testLibrary(device);
        Kernel kernel = library.kernel("device_basic.cl", "addOne");
        TimedQueue queue(device);
        const std::size_t local = std::min<std::size_t>(16, kernel.workGroupLimit());
        for (const std::size_t count :
            { std::size_t { 0 }, std::size_t { 1 }, local - 1, local, local + 1, std::size_t { 1000 } }) {
            CAPTURE(count);
            Buffer<unsigned> data(device, count + 64, "data");
            data.fill(queue, 5u);
            kernel.setArgs(data, static_cast<unsigned>(count));
            queue.launch("addOne", PassKind::Filter, kernel, count, local);
            std::vector<unsigned> expected(count + 64, 5u);
            std::fill_n(expected.begin(), count, 6u);
            CHECK(data.downloadAll(queue) == expected);
        }
    }
}

TEST_CASE("2D launches reach every pixel once and pad both directions")
{
    for (const Device& device : usableDevices()) {
        CAPTURE(device.info().name);
        ProgramLibrary library = testLibrary(device);
        Kernel kernel = library.kernel("device_basic.cl", "grid");
        TimedQueue queue(device);
        constexpr unsigned width = 13;
        constexpr unsigned height = 7;
        Buffer<unsigned> pixels(device, width * height, "pixels");
        Buffer<unsigned> outside(device, 1, "outside");
        pixels.fill(queue, 0u);
        outside.fill(queue, 0u);
        kernel.setArgs(pixels, outside, width, height);
        queue.launch2D("grid", PassKind::Filter, kernel, width, height, 4, 2);
        queue.launch2D("grid", PassKind::Filter, kernel, 0, height, 4, 2);
        queue.launch2D("grid", PassKind::Filter, kernel, width, 0, 4, 2);
        std::vector<unsigned> expected;
        for (unsigned y = 0; y < height; ++y) {
            for (unsigned x = 0; x < width; ++x) {
                expected.push_back(1 + x + 1000 * y);
            }
        }
        CHECK(pixels.downloadAll(queue) == expected);
        CHECK(outside.downloadAll(queue) == std::vector<unsigned> { 16 * 8 - width * height });
        CHECK(contains(
            errorOf([&] { queue.launch2D("grid", PassKind::Filter, kernel, 1, 1, kernel.workGroupLimit(), 2); }),
            "work-group size of kernel grid"));
    }
}

TEST_CASE("a work-group that the kernel cannot run with is refused")
{
    for (const Device& device : usableDevices()) {
        CAPTURE(device.info().name);
        ProgramLibrary library = testLibrary(device);
        Kernel kernel = library.kernel("device_basic.cl", "visit");
        TimedQueue queue(device);
        for (const std::size_t local : { std::size_t { 0 }, kernel.workGroupLimit() + 1 }) {
            const std::string message = errorOf([&] { queue.launch("visit", PassKind::Trace, kernel, 1, local); });
            CHECK(contains(
                message, "kernel visit (device_basic.cl) on " + device.info().name + ": " + std::to_string(local)));
            CHECK_THROWS_AS(queue.launchTiled("visit", PassKind::Trace, kernel, 1, local, 1), wedge::Error);
        }
        CHECK(queue.takeRecords().empty());
    }
}

TEST_CASE("tiled launches run each group exactly once, whatever the batches")
{
    for (const Device& device : usableDevices()) {
        CAPTURE(device.info().name);
        ProgramLibrary library = testLibrary(device);
        Kernel kernel = library.kernel("device_basic.cl", "visit");
        const std::size_t local = std::min<std::size_t>(32, kernel.workGroupLimit());
        for (const bool waitForEach : { false, true }) {
            TimedQueue queue(device, waitForEach);
            for (const double target : { 0.0, 0.05, 100.0 }) {
                queue.setTargetMilliseconds(target);
                for (const std::size_t groups : { 0u, 1u, 7u, 1000u, 5003u }) {
                    if (target == 0.0 && groups > 1000) {
                        continue; // a launch a group: slow, and says nothing new
                    }
                    CAPTURE(target);
                    CAPTURE(groups);
                    Buffer<unsigned> visits(device, groups * local, "visits");
                    visits.fill(queue, 0u);
                    kernel.setArgs(visits, 12345u);
                    queue.launchTiled("visit", PassKind::Trace, kernel, groups, local, 1);
                    CHECK(visits.downloadAll(queue) == std::vector<unsigned>(groups * local, 1u));
                }
            }
        }
    }
}

TEST_CASE("a pass that was seen goes in larger batches, until its cost is forgotten")
{
    for (const Device& device : usableDevices()) {
        CAPTURE(device.info().name);
        ProgramLibrary library = testLibrary(device);
        Kernel kernel = library.kernel("device_basic.cl", "visit");
        constexpr std::size_t groups = 4096;
        TimedQueue queue(device);
        queue.setTargetMilliseconds(1e6);
        Buffer<unsigned> visits(device, groups, "visits");
        visits.fill(queue, 0u);
        kernel.setArgs(visits, 1u);
        const auto launches = [&] {
            queue.takeRecords();
            queue.launchTiled("visit", PassKind::Trace, kernel, groups, 1, 1);
            return queue.takeRecords().front().launches;
        };
        const auto unknown = launches();
        CHECK(unknown > 1);
        CHECK(launches() < unknown);
        queue.forgetCosts();
        CHECK(launches() == unknown);
    }
}

TEST_CASE("results do not depend on the batches to the last bit")
{
    for (const Device& device : usableDevices()) {
        CAPTURE(device.info().name);
        ProgramLibrary library = testLibrary(device);
        Kernel kernel = library.kernel("device_basic.cl", "chain");
        const std::size_t local = std::min<std::size_t>(64, kernel.workGroupLimit());
        constexpr unsigned count = 20011;
        const auto run = [&](double target) {
            TimedQueue queue(device);
            Buffer<float> result(device, count, "result");
            kernel.setArgs(result, count, 0u);
            if (target < 0.0) {
                queue.launch("chain", PassKind::Trace, kernel, count, local);
            } else {
                queue.setTargetMilliseconds(target);
                queue.launchTiled("chain", PassKind::Trace, kernel, (count + local - 1) / local, local, 2);
            }
            return result.downloadAll(queue);
        };
        const std::vector<float> whole = run(-1.0);
        CHECK(std::all_of(whole.begin(), whole.end(), [](float x) { return std::isfinite(x); }));
        CHECK(run(0.0) == whole);
        CHECK(run(0.1) == whole);
        CHECK(run(1000.0) == whole);
    }
}

TEST_CASE("progress rises to the work units of the launches")
{
    for (const Device& device : usableDevices()) {
        CAPTURE(device.info().name);
        ProgramLibrary library = testLibrary(device);
        Kernel kernel = library.kernel("device_basic.cl", "visit");
        TimedQueue queue(device);
        queue.setTargetMilliseconds(0.0);
        std::vector<double> reports;
        queue.setProgress([&](double done) { reports.push_back(done); });
        // More groups than a first batch has on any device.
        const std::size_t groups = 64 * std::size_t { device.info().computeUnits };
        Buffer<unsigned> visits(device, groups, "visits");
        kernel.setArgs(visits, 0u);
        queue.launchTiled("first", PassKind::Trace, kernel, groups, 1, 1);
        REQUIRE(reports.size() >= 2);
        CHECK(reports.back() == doctest::Approx(1.0));
        queue.launchTiled("none", PassKind::Trace, kernel, 0, 1, 1, 4.0);
        queue.launchTiled("second", PassKind::Trace, kernel, groups, 1, 1, 2.5);
        CHECK(reports.back() == doctest::Approx(7.5));
        CHECK(std::is_sorted(reports.begin(), reports.end()));
        CHECK(reports.front() > 0.0);
    }
}

TEST_CASE("cancelling stops between batches, finishes what runs, and leaves the queue usable")
{
    for (const Device& device : usableDevices()) {
        CAPTURE(device.info().name);
        ProgramLibrary library = testLibrary(device);
        Kernel kernel = library.kernel("device_basic.cl", "visit");
        TimedQueue queue(device);
        queue.setTargetMilliseconds(0.0);
        std::atomic<bool> cancel = false;
        queue.setCancelFlag(&cancel);
        int batches = 0;
        queue.setProgress([&](double) { cancel = ++batches >= 3; });
        constexpr std::size_t groups = 5000;
        Buffer<unsigned> visits(device, groups, "visits");
        visits.fill(queue, 0u);
        kernel.setArgs(visits, 0u);
        CHECK_THROWS_AS(queue.launchTiled("visit", PassKind::Trace, kernel, groups, 1, 1), Cancelled);
        std::vector<unsigned> seen = visits.downloadAll(queue);
        const auto done = static_cast<std::size_t>(std::count(seen.begin(), seen.end(), 1u));
        CHECK(done > 0);
        CHECK(done < groups);
        CHECK(std::count(seen.begin(), seen.begin() + static_cast<std::ptrdiff_t>(done), 1u)
            == static_cast<std::ptrdiff_t>(done));
        CHECK(std::count(seen.begin(), seen.end(), 0u) == static_cast<std::ptrdiff_t>(groups - done));

        CHECK_THROWS_AS(queue.launchTiled("visit", PassKind::Trace, kernel, groups, 1, 1), Cancelled);
        queue.setCancelFlag(nullptr);
        queue.setTargetMilliseconds(100.0);
        visits.fill(queue, 0u);
        queue.launchTiled("visit", PassKind::Trace, kernel, groups, 1, 1);
        CHECK(visits.downloadAll(queue) == std::vector<unsigned>(groups, 1u));
    }
}

TEST_CASE("records merge by name, in order of first appearance, and start anew when taken")
{
    for (const Device& device : usableDevices()) {
        CAPTURE(device.info().name);
        ProgramLibrary library = testLibrary(device);
        Kernel addOne = library.kernel("device_basic.cl", "addOne");
        Kernel visit = library.kernel("device_basic.cl", "visit");
        TimedQueue queue(device);
        CHECK(queue.takeRecords().empty());
        CHECK(queue.deviceMilliseconds() == 0.0);
        Buffer<unsigned> data(device, 100, "data");
        data.upload(queue, std::vector<unsigned>(100));
        addOne.setArgs(data, 100u);
        visit.setArgs(data, 0u);
        queue.launch("b", PassKind::Filter, addOne, 100, 1);
        queue.launchTiled("a", PassKind::Trace, visit, 100, 1, 1);
        queue.launch("b", PassKind::Filter, addOne, 100, 1);
        queue.launch("idle", PassKind::Composite, addOne, 0, 1);
        queue.addBytes("b", PassKind::Filter, 800);
        queue.recordTransfer("from outside", 12, 0.25);
        data.upload(queue, std::vector<unsigned>(50), 50);
        const double sum = queue.deviceMilliseconds();
        const std::vector<PassRecord> records = queue.takeRecords();
        REQUIRE(records.size() == 5);
        const auto expect = [](const PassRecord& record, const char* name, PassKind kind, std::uint64_t bytes) {
            CHECK(record.name == name);
            CHECK(record.kind == kind);
            CHECK(record.bytes == bytes);
            CHECK(std::isfinite(record.milliseconds));
            CHECK(record.milliseconds >= 0.0);
        };
        expect(records[0], "upload data", PassKind::Transfer, 600);
        expect(records[1], "b", PassKind::Filter, 800);
        expect(records[2], "a", PassKind::Trace, 0);
        expect(records[3], "idle", PassKind::Composite, 0);
        expect(records[4], "from outside", PassKind::Transfer, 12);
        CHECK(records[0].launches == 2);
        CHECK(records[1].launches == 2);
        CHECK(records[2].launches >= 1);
        CHECK(records[3].launches == 0);
        CHECK(records[3].milliseconds == 0.0);
        CHECK(records[4].milliseconds == 0.25);
        double total = 0.0;
        for (const PassRecord& record : records) {
            total += record.milliseconds;
        }
        CHECK(total == doctest::Approx(sum));
        CHECK(total > 0.25); // something was measured, by whichever clock
        CHECK(passKindName(records[3].kind) == "composite");

        queue.launch("c", PassKind::Filter, addOne, 100, 1);
        const std::vector<PassRecord> next = queue.takeRecords();
        REQUIRE(next.size() == 1);
        CHECK(next[0].name == "c");
    }
}

TEST_CASE("more launches than a queue keeps events of")
{
    for (const Device& device : usableDevices()) {
        CAPTURE(device.info().name);
        ProgramLibrary library = testLibrary(device);
        Kernel kernel = library.kernel("device_basic.cl", "addOne");
        TimedQueue queue(device);
        Buffer<unsigned> data(device, 1, "data");
        data.fill(queue, 0u);
        kernel.setArgs(data, 1u);
        for (int i = 0; i < 3000; ++i) {
            queue.launch("addOne", PassKind::Filter, kernel, 1, 1);
        }
        CHECK(data.downloadAll(queue) == std::vector<unsigned> { 3000 });
        CHECK(queue.takeRecords().at(1).launches == 3000);
    }
}

TEST_CASE("batches start small, grow to the target by what was measured, and shrink at once")
{
    BatchSizer sizer(100.0, 1000, 32, -1.0);
    CHECK_FALSE(sizer.known());
    CHECK(sizer.groups() == 32);
    sizer.measured(32, 3.2); // 0.1 ms a group: the target is 1000 of them
    CHECK(sizer.known());
    CHECK(sizer.millisecondsPerGroup() == doctest::Approx(0.1));
    CHECK(sizer.groups() == 256); // at most 8 times as many
    sizer.measured(256, 51.2); // 0.2 ms
    CHECK(sizer.groups() == 500);
    sizer.measured(500, 50000.0);
    CHECK(sizer.groups() == 1);
    sizer.measured(1, 0.0); // a coarse timer
    CHECK(sizer.groups() == 8);
    sizer.measured(1000, 0.001);
    CHECK(sizer.groups() == 1000);
}

TEST_CASE("a pass seen before starts at half its target; limits hold from the start")
{
    CHECK(BatchSizer(100.0, 1000, 32, 0.5).groups() == 100);
    CHECK(BatchSizer(100.0, 1000, 32, 1e6).groups() == 1);
    CHECK(BatchSizer(100.0, 20, 32, -1.0).groups() == 20);
    CHECK(BatchSizer(100.0, 20, 32, 0.0).groups() == 20);
    CHECK(BatchSizer(100.0, 0, 0, -1.0).groups() == 1);
}
