#include "device_testing.h"

#include "host/device/cl_error.h"

#include <algorithm>
#include <cctype>

using namespace wedge::device;
using wedge::test::contains;
using wedge::test::errorOf;

TEST_CASE("listed devices have sensible limits and the same index each time")
{
    const std::vector<DeviceInfo> devices = listDevices();
    const std::vector<DeviceInfo> again = listDevices();
    REQUIRE_FALSE(devices.empty());
    REQUIRE(devices.size() == again.size());
    for (std::size_t i = 0; i < devices.size(); ++i) {
        const DeviceInfo& info = devices[i];
        CAPTURE(info.name);
        CHECK(info.index == i);
        CHECK(info.name == again[i].name);
        CHECK_FALSE(info.name.empty());
        CHECK(info.name.back() != '\0');
        CHECK(info.deviceVersion.starts_with("OpenCL "));
        CHECK(info.computeUnits >= 1);
        CHECK(info.maxAllocation <= info.globalMemory);
        CHECK(info.maxAllocation >= info.globalMemory / 8);
        CHECK(info.defaultWorkGroup >= 1);
        CHECK(info.defaultWorkGroup <= info.maxWorkGroup);
        CHECK(info.maxTiledItems >= info.defaultWorkGroup);
        CHECK(deviceTypeName(info.type) != "");
    }
}

TEST_CASE("selectors: index, type, part of a name in any case, nothing")
{
    for (const Device& device : wedge::test::usableDevices()) {
        const DeviceInfo& info = device.info();
        CAPTURE(info.name);
        std::string shouted = info.name;
        std::transform(
            shouted.begin(), shouted.end(), shouted.begin(), [](unsigned char c) { return std::toupper(c); });
        CHECK(Device::open(shouted).info().name == info.name);
        CHECK(Device::open(info.name.substr(1, 5)).info().unusable.empty());
        CHECK(Device::open(info.platform).info().unusable.empty());
        if (info.type == DeviceType::Cpu || info.type == DeviceType::Gpu) {
            const std::string type(deviceTypeName(info.type));
            CHECK(Device::open(type).info().type == info.type);
            CHECK(Device::open(type == "cpu" ? "CPU" : "GPU").info().type == info.type);
        }
    }
}

TEST_CASE("the default is a GPU where there is one, else a CPU")
{
    const std::vector<DeviceInfo> devices = listDevices();
    const auto has = [&](DeviceType type) {
        return std::any_of(devices.begin(), devices.end(),
            [type](const DeviceInfo& info) { return info.type == type && info.unusable.empty(); });
    };
    const DeviceType chosen = Device::open("").info().type;
    if (has(DeviceType::Gpu)) {
        CHECK(chosen == DeviceType::Gpu);
    } else if (has(DeviceType::Cpu)) {
        CHECK(chosen == DeviceType::Cpu);
    }
}

TEST_CASE("an unknown selector is an error that lists the devices")
{
    const std::vector<DeviceInfo> devices = listDevices();
    for (const std::string& selector : { std::string("abacus"), std::to_string(devices.size()),
             std::string("99999999999999999999999999"), std::string("-1") }) {
        const std::string message = errorOf([&] { Device::open(selector); });
        CAPTURE(message);
        CHECK(contains(message, selector));
        CHECK(contains(message, "no such OpenCL device"));
        for (const DeviceInfo& info : devices) {
            CHECK(contains(message, info.name));
        }
        CHECK_FALSE(contains(message, "\n"));
    }
}

TEST_CASE("OpenCL errors are translated with call, subject, device and the code's name")
{
    CHECK(clErrorName(CL_OUT_OF_RESOURCES) == "CL_OUT_OF_RESOURCES");
    CHECK(clErrorName(CL_INVALID_KERNEL_ARGS) == "CL_INVALID_KERNEL_ARGS");
    CHECK(clErrorName(-1001) == "CL_PLATFORM_NOT_FOUND_KHR");
    CHECK(clErrorName(-12345) == "unknown OpenCL error");
    const std::string message = errorOf([] {
        checked("kernel trace (primary.cl)", "some device",
            []() -> int { throw cl::Error(CL_MEM_OBJECT_ALLOCATION_FAILURE, "clEnqueueNDRangeKernel"); });
    });
    for (const char* part : { "clEnqueueNDRangeKernel", "kernel trace (primary.cl)", "some device",
             "CL_MEM_OBJECT_ALLOCATION_FAILURE (-4)", "smaller" }) {
        CHECK(contains(message, part));
    }
    CHECK(checked("", "", [] { return 7; }) == 7);
}
