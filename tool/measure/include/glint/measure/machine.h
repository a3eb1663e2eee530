// The machine on which something was measured.
#pragma once

#include <glint/context.h>

#include <optional>
#include <string>
#include <vector>

namespace glint::measure {

struct BenchMachine {
    std::string device;
    std::string driver;
    std::string deviceType;  // "cpu" or "gpu"
    std::vector<std::string> tracers;
    std::string processor;
    unsigned cores = 0;
    std::string system;
    std::optional<double> subgroupSize{};  // lanes; only files that scripts made have it
};

// Describes the context's device and the host.
BenchMachine machineOf(Context& context);

bool isOnCpu(const Context& context);

// Returns the current time in ISO 8601.
std::string utcNow();

}  // namespace glint::measure
