// The machine on which something was measured, and the program that measured.
#pragma once

#include "base/fields_fwd.h"

#include <glint/context.h>

#include <optional>
#include <string>
#include <string_view>
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
base::Fields fieldsOf(const BenchMachine*);

// Describes the context's device and the host.
BenchMachine machineOf(Context& context);

bool isOnCpu(const Context& context);

// Returns the current time in ISO 8601.
std::string utcNow();

// Returns the abbreviated commit, with "-dirty" if files were changed since, or "unknown" for sources without
// a repository.
std::string_view sourceCommit();

}  // namespace glint::measure
