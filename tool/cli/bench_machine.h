// The parts that every report of a bench shares: where it was measured, and intervals as JSON.
#pragma once

#include "bench/statistics.h"
#include "cli/report.h"

#include <glint/context.h>

#include <string>
#include <vector>

namespace glint {

struct BenchMachine {
    std::string device;
    std::string driver;
    std::string deviceType;  // "cpu" or "gpu"
    std::vector<std::string> tracers;
    std::string processor;
    unsigned cores = 0;
    std::string system;
};

// Describes the context's device and the host.
BenchMachine machineOf(Context& context);

bool isOnCpu(const Context& context);

Json toJson(const BenchMachine& machine);
// Numbers that are not finite become null.
Json toJson(const bench::Interval& interval);

// Returns the current time in ISO 8601.
std::string utcNow();

}  // namespace glint
