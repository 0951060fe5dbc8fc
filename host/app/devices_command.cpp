#include "host/app/commands.h"
#include "host/app/console.h"
#include "host/device/device.h"
#include "host/device/memory_plan.h"
#include "host/error.h"

#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace wedge::app {
namespace {

using device::DeviceInfo;
using Json = nlohmann::ordered_json;

Json toJson(const DeviceInfo& d)
{
    return { { "index", d.index }, { "name", d.name }, { "type", device::deviceTypeName(d.type) },
        { "vendor", d.vendor }, { "platform", d.platform }, { "platform_version", d.platformVersion },
        { "device_version", d.deviceVersion }, { "driver", d.driver }, { "compute_units", d.computeUnits },
        { "clock_mhz", d.clockMegahertz }, { "native_float_width", d.nativeFloatWidth },
        { "memory_bytes", d.globalMemory }, { "max_allocation_bytes", d.maxAllocation },
        { "local_memory_bytes", d.localMemory }, { "max_work_group", d.maxWorkGroup }, { "doubles", d.doubles },
        { "unusable", d.unusable }, { "quirks", d.quirks } };
}

void print(const DeviceInfo& d)
{
    say("{}  {} ({})\n", d.index, printable(d.name), device::deviceTypeName(d.type));
    say("   {}, {}, driver {}\n", printable(d.platform), printable(d.deviceVersion), printable(d.driver));
    say("   {} compute units, {} memory, {} at once, work-groups of {}\n", d.computeUnits,
        device::mebibytes(d.globalMemory), device::mebibytes(d.maxAllocation), d.maxWorkGroup);
    for (const std::string& quirk : d.quirks) {
        say("   quirk: {}\n", printable(quirk));
    }
    if (!d.unusable.empty()) {
        say("   unusable: {}\n", d.unusable);
    }
}

int listDevices(bool json)
{
    const std::vector<DeviceInfo> devices = device::listDevices();
    if (!json) {
        device::requireDevices();
    }
    warnOf(device::deviceNotices());
    if (json) {
        Json list = Json::array();
        for (const DeviceInfo& d : devices) {
            list.push_back(toJson(d));
        }
        say("{}\n", list.dump(2, ' ', false, Json::error_handler_t::replace));
        requireSaid();
        return 0;
    }
    for (const DeviceInfo& d : devices) {
        print(d);
    }
    requireSaid();
    return 0;
}

} // namespace

void addDevicesCommand(CLI::App& parser, Action& action)
{
    CLI::App* command = parser.add_subcommand("devices", "List the OpenCL devices that --device can name");
    const auto json = std::make_shared<bool>(false);
    command->add_flag("--json", *json, "Print JSON");
    command->callback([json, &action] { action = [json] { return listDevices(*json); }; });
}

} // namespace wedge::app
