#include "emit/compile.h"
#include "measure/report_json.h"

#include <glint/measure/machine.h>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <cmath>
#include <ctime>
#include <fstream>
#include <sys/utsname.h>
#include <thread>

namespace glint::measure {

namespace {

// Returns the text behind "model name" in Linux's list of processors, or an empty text if there is none.
std::string processorName() {
    std::ifstream list("/proc/cpuinfo");
    for (std::string line; std::getline(list, line);) {
        const std::size_t colon = line.find(": ");
        if (line.starts_with("model name") && colon != std::string::npos) {
            return line.substr(colon + 2);
        }
    }
    return {};
}

base::Json numberOrNull(double value) {
    return std::isfinite(value) ? base::Json(value) : base::Json(nullptr);
}

}  // namespace

BenchMachine machineOf(Context& context) {
    BenchMachine machine;
    machine.device = context.deviceName();
    machine.driver = context.driverName();
    machine.deviceType = isOnCpu(context) ? "cpu" : "gpu";
    machine.tracers = compiler::tracerNames(context.handles().tracers);
    machine.processor = processorName();
    machine.cores = std::thread::hardware_concurrency();
    utsname system{};
    if (uname(&system) == 0) {
        machine.system = fmt::format("{} {}", system.sysname, system.machine);
    }
    return machine;
}

bool isOnCpu(const Context& context) {
    return context.deviceType() == VK_PHYSICAL_DEVICE_TYPE_CPU;
}

base::Json toJson(const BenchMachine& machine) {
    return {{"device", machine.device},   {"driver", machine.driver}, {"deviceType", machine.deviceType},
            {"tracers", machine.tracers}, {"cpu", machine.processor}, {"cores", machine.cores},
            {"os", machine.system}};
}

base::Json toJson(const Interval& interval) {
    return {{"median", numberOrNull(interval.median)},
            {"low", numberOrNull(interval.low)},
            {"high", numberOrNull(interval.high)},
            {"q1", numberOrNull(interval.q1)},
            {"q3", numberOrNull(interval.q3)}};
}

std::string utcNow() {
    return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
}

}  // namespace glint::measure
