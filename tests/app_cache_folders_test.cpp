// Homes and cache folders that cannot be written: service users, containers, read-only systems.
#include "tests/app_testing.h"

#include <doctest/doctest.h>

#include <cstdlib>
#include <fstream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

using namespace wedge::app::test;

namespace {

/// Variables as they are until the end of a test; nullopt: not set.
class Variables {
public:
    explicit Variables(const std::vector<std::pair<std::string, std::optional<std::string>>>& wanted)
    {
        for (const char* name : { "HOME", "XDG_CACHE_HOME", "WEDGE_CACHE_DIR", "POCL_CACHE_DIR" }) {
            const char* value = ::getenv(name);
            before_.emplace_back(name, value == nullptr ? std::nullopt : std::optional<std::string>(value));
            ::unsetenv(name);
        }
        for (const auto& [name, value] : wanted) {
            set(name, value);
        }
    }
    ~Variables()
    {
        for (const auto& [name, value] : before_) {
            set(name, value);
        }
    }
    Variables(const Variables&) = delete;
    Variables& operator=(const Variables&) = delete;

private:
    static void set(const std::string& name, const std::optional<std::string>& value)
    {
        value ? ::setenv(name.c_str(), value->c_str(), 1) : ::unsetenv(name.c_str());
    }
    std::vector<std::pair<std::string, std::optional<std::string>>> before_;
};

const std::string nowhere = "/dev/null/home"; // where the superuser can make nothing either

std::size_t lines(const std::string& text) { return static_cast<std::size_t>(std::ranges::count(text, '\n')); }

} // namespace

TEST_CASE("devices are found and frames rendered without a home, which is said once")
{
    const Workplace place;
    for (const auto& variables : std::vector<std::vector<std::pair<std::string, std::optional<std::string>>>> {
             { { "HOME", nowhere } }, { { "HOME", "/root" }, { "XDG_CACHE_HOME", "/etc/passwd" } }, {},
             { { "HOME", "/root" }, { "WEDGE_CACHE_DIR", nowhere } } }) {
        const Variables set(variables);
        const Outcome devices = place.run({ "devices" });
        CAPTURE(devices.err);
        CHECK(devices.status == 0);
        CHECK(lines(devices.err) == 1);
        CHECK(contains(devices.err, "wedge: warning: no folder for compiled kernels: "));
        CHECK(contains(devices.err, place.temporary().string() + "/wedge-"));
        CHECK(contains(devices.out, "compute units"));
    }
    const Variables set({ { "HOME", nowhere } });
    const Arguments call = { "render", box, "--size", "8x8", "--method", "mc", "--spp", "1", "-o", "a.exr" };
    const Outcome first = place.run(call);
    CAPTURE(first.err);
    CHECK(first.status == 0);
    CHECK(lines(first.err) == 1);
    CHECK(place.has("a.exr"));
    Arguments quiet = call;
    quiet.emplace_back("--quiet");
    CHECK(place.run(quiet).err == "");
}

TEST_CASE("where nothing at all can be written, that is said, and not to install a driver")
{
    const Workplace place;
    const Variables set({ { "HOME", nowhere }, { "POCL_CACHE_DIR", nowhere } });
    for (const Arguments& call : { Arguments { "devices" },
             Arguments { "render", box, "--size", "8x8", "--method", "mc", "--spp", "1", "-o", "a.exr" } }) {
        const Outcome outcome = place.run(call);
        CAPTURE(outcome.err);
        if (outcome.status == 0) {
            continue; // a driver that keeps no cache
        }
        CHECK(outcome.status == failure);
        CHECK(contains(outcome.err, "wedge: error: OpenCL device: none found, since "));
        CHECK(contains(outcome.err, "POCL_CACHE_DIR=" + nowhere + " (Not a directory)"));
        CHECK(contains(outcome.err, "set POCL_CACHE_DIR to a folder that can be written"));
        CHECK(!contains(outcome.err, "install"));
    }
}
