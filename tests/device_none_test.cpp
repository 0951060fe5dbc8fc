// A program of its own, since the OpenCL loader looks for platforms once a process.
#include "device_testing.h"

TEST_CASE("without any OpenCL driver the list is empty, and opening says what to install")
{
    const wedge::test::TemporaryFolder empty;
    REQUIRE(::setenv("OCL_ICD_VENDORS", empty.path().c_str(), 1) == 0);
    CHECK(wedge::device::listDevices().empty());
    for (const char* selector : { "", "cpu", "0" }) {
        const std::string message = wedge::test::errorOf([&] { wedge::device::Device::open(selector); });
        CHECK(wedge::test::contains(message, "pocl-opencl-icd"));
    }
}
