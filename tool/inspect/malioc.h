// Runs Arm's Mali Offline Compiler if it is installed: cycles, registers and spilling of a compute shader.
#pragma once

#include <glint/result.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace glint::inspect {

// The contents of its JSON report ("performance" schema). Members that a version leaves out are absent.
struct MaliocReport {
    std::string core;                         // "Mali-G710"
    std::map<std::string, double> cycles;     // of the longest path, by pipeline
    std::vector<std::string> boundPipelines;  // those that the longest path is bound by
    std::optional<double> longestCycles;      // the largest of `cycles`
    std::optional<std::int64_t> workRegisters;
    std::optional<std::int64_t> occupancy;  // threads, in percent
    std::optional<bool> spills;
    std::optional<std::int64_t> spillBytes;  // of stack, a thread
    std::optional<bool> slowRayTraversal;    // ray queries leave the fast path of the hardware
};

// Returns `program` as given if it contains a slash, else the first executable file of that name in PATH.
// Returns nothing if there is none.
std::optional<std::filesystem::path> findProgram(const std::string& program);

// Error "malioc" if it can't be run, fails (with its message), or prints no report. An empty `core` means the
// program's default.
Result<MaliocReport> runMalioc(const std::filesystem::path& program, const std::string& core,
                               const std::filesystem::path& spirv);
// Error "malioc" if `text` is no report, or if it reports errors.
Result<MaliocReport> parseMalioc(std::string_view text);

}  // namespace glint::inspect
