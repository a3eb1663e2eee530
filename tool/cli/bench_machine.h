// What every report of a bench says alike: where it was measured, and intervals as JSON.
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

// The device of the context, and the host.
BenchMachine machineOf(Context& context);

bool isOnCpu(const Context& context);

Json toJson(const BenchMachine& machine);
// With null for what is no number.
Json toJson(const bench::Interval& interval);

// Now, ISO 8601.
std::string utcNow();

}  // namespace glint
