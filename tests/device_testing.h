// What the tests of host/device share.
#pragma once

#include "host/device/device.h"
#include "host/device/program.h"

#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

namespace wedge::test {

/// Every device found that wedge can use. A test run without any is a failure. Keeps programs out of the user's cache.
inline std::vector<device::Device> usableDevices()
{
    ::setenv("WEDGE_CACHE_DIR", "", 1);
    std::vector<device::Device> devices;
    for (const device::DeviceInfo& info : device::listDevices()) {
        if (info.unusable.empty()) {
            devices.push_back(device::Device::open(std::to_string(info.index)));
        }
    }
    REQUIRE_FALSE(devices.empty());
    return devices;
}

/// A folder of this process, removed with the object.
class TemporaryFolder {
public:
    TemporaryFolder()
    {
        std::string name = (std::filesystem::temp_directory_path() / "wedge-test-XXXXXX").string();
        REQUIRE(::mkdtemp(name.data()) != nullptr);
        path_ = name;
    }
    ~TemporaryFolder()
    {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

/// A library over tests/kernels.
inline device::ProgramLibrary testLibrary(const device::Device& device)
{
    device::BuildOptions options;
    options.kernelDir = WEDGE_TEST_KERNELS;
    return device::ProgramLibrary(device, options);
}

/// The message of the Error that f throws; fails the test if it throws none.
template <class F>
std::string errorOf(F&& f)
{
    try {
        f();
    } catch (const Error& error) {
        return error.what();
    }
    FAIL("no error was thrown");
    return "";
}

inline bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

} // namespace wedge::test
