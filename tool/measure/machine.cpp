#include "resolve/resolve.h"

#include <glint/measure/machine.h>
#include <glint/measure/observer.h>

#include <fmt/chrono.h>
#include <fmt/format.h>

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

std::string utcNow() {
    return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
}

Status checkValidation(const Observer& observer, const Context& context) {
    const std::vector<std::string> messages = context.validationMessages();
    for (const std::string& message : messages) {
        observer.report(makeWarning("validation", "", message));
    }
    if (messages.empty()) {
        return okStatus();
    }
    return makeError("validation", "", fmt::format("the validation layers have {} messages", messages.size()),
                     "this is a defect of Glint or of the driver: please report it");
}

}  // namespace glint::measure
