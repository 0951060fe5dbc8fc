// Quirks follow from what drivers report, and are in force where they are needed.
#include "host/device/device.h"
#include "host/device/quirks.h"
#include "tests/device_testing.h"

#include <doctest/doctest.h>

#include <cstdlib>
#include <string>

using namespace wedge::device;

TEST_CASE("which PoCL fails to compile")
{
    CHECK(poclFailsToCompile(
        "OpenCL 3.0 PoCL 6.0+debian  Linux, None+Asserts, RELOC, SPIR-V, LLVM 18.1.8, SLEEF, DISTRO"));
    CHECK(poclFailsToCompile("OpenCL 3.0 PoCL 5.0  Linux, RELOC, LLVM 18.1.2"));
    CHECK_FALSE(poclFailsToCompile("OpenCL 3.0 PoCL 6.0  Linux, RELOC, LLVM 17.0.6, SLEEF"));
    CHECK_FALSE(poclFailsToCompile("OpenCL 3.0 PoCL 3.1+debian  Linux, None+Asserts, RELOC, SPIR, LLVM 15.0.6, SLEEF"));
    CHECK_FALSE(poclFailsToCompile("OpenCL 3.0 PoCL 7.1  Linux, Release, RELOC, LLVM 19.1.7"));
    CHECK_FALSE(poclFailsToCompile("OpenCL 3.0 PoCL 10.0  Linux, LLVM 30.1"));
    CHECK_FALSE(poclFailsToCompile("OpenCL 3.0 CUDA 12.4.131"));
    CHECK_FALSE(poclFailsToCompile("OpenCL 3.0 rusticl LLVM 19.1.7"));
    CHECK_FALSE(poclFailsToCompile("PoCL , LLVM "));
    CHECK_FALSE(poclFailsToCompile(""));
}

TEST_CASE("which driver keeps kernels by itself")
{
    const char* pocl = "OpenCL 3.0 PoCL 3.1+debian  Linux, None+Asserts, RELOC, SPIR, LLVM 15.0.6, SLEEF, DISTRO";
    CHECK(driverKeepsKernels(pocl));
    ::setenv("POCL_KERNEL_CACHE", "0", 1);
    CHECK_FALSE(driverKeepsKernels(pocl));
    ::setenv("POCL_KERNEL_CACHE", "no", 1);
    CHECK_FALSE(driverKeepsKernels(pocl));
    ::setenv("POCL_KERNEL_CACHE", "1", 1);
    CHECK(driverKeepsKernels(pocl));
    ::unsetenv("POCL_KERNEL_CACHE");
    CHECK_FALSE(driverKeepsKernels("OpenCL 3.0 CUDA 12.4.131"));
    CHECK_FALSE(driverKeepsKernels("OpenCL 3.0 LINUX"));
    CHECK_FALSE(driverKeepsKernels(""));
}

TEST_CASE("which driver fails with parts of buffers")
{
    CHECK(driverFailsWithParts("OpenCL 3.0 CUDA 13.0.84"));
    CHECK_FALSE(driverFailsWithParts("OpenCL 3.0 PoCL 6.0  Linux, LLVM 18.1.8"));
    CHECK_FALSE(driverFailsWithParts(""));
    DeviceInfo info;
    info.type = DeviceType::Gpu;
    const std::size_t before = applyQuirks(info).size();
    info.failsWithParts = true;
    CHECK(applyQuirks(info).size() == before + 1);
}

TEST_CASE("a quirk changes what it has to, and what the user chose stays")
{
    DeviceInfo info;
    info.type = DeviceType::Gpu;
    info.platformVersion = "OpenCL 3.0 PoCL 6.0  Linux, LLVM 18.1.8";
    const char* users = std::getenv("POCL_WORK_GROUP_METHOD");
    const std::string before = users == nullptr ? "" : users;
    ::unsetenv("POCL_WORK_GROUP_METHOD");
    // Besides, PoCL keeps kernels by itself.
    CHECK(applyQuirks(info).size() == 2);
    CHECK(std::string(std::getenv("POCL_WORK_GROUP_METHOD")) == "cbs");
    ::setenv("POCL_WORK_GROUP_METHOD", "loops", 1);
    REQUIRE(applyQuirks(info).size() == 2);
    CHECK(applyQuirks(info).front().starts_with("POCL_WORK_GROUP_METHOD=loops is set"));
    CHECK(std::string(std::getenv("POCL_WORK_GROUP_METHOD")) == "loops");
    ::unsetenv("POCL_WORK_GROUP_METHOD");
    info.platformVersion = "OpenCL 3.0 PoCL 7.0  Linux, LLVM 19.1.7";
    CHECK(applyQuirks(info).size() == 1);
    CHECK(std::getenv("POCL_WORK_GROUP_METHOD") == nullptr);
    info.hostTimers = true;
    CHECK(applyQuirks(info).size() == 2);
    info.platformVersion = "OpenCL 3.0 CUDA 12.4.131";
    CHECK(applyQuirks(info).size() == 1);
    if (!before.empty()) {
        ::setenv("POCL_WORK_GROUP_METHOD", before.c_str(), 1);
    }
}

TEST_CASE("devices name the quirks in force")
{
    for (const DeviceInfo& info : listDevices()) {
        CAPTURE(info.platformVersion);
        const bool byContinuations = !info.quirks.empty() && info.quirks.front().find("cbs") != std::string::npos;
        CHECK(byContinuations == poclFailsToCompile(info.platformVersion));
    }
}
