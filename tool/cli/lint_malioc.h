// Arm's Mali Offline Compiler, where it is installed: cycles, registers and spilling of a compute shader.
#pragma once

#include <glint/result.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace glint {

// What its JSON report ("performance" schema) says; nothing where a version leaves a member out.
struct MaliocReport {
    std::string core;                         // "Mali-G710"
    std::map<std::string, double> cycles;     // of the longest path, by pipeline
    std::vector<std::string> boundPipelines;  // those that the longest path is bound by
    std::optional<double> longestCycles;      // the largest of `cycles`
    std::optional<std::int64_t> workRegisters;
    std::optional<std::int64_t> occupancy;  // threads, in percent
    std::optional<bool> spills;
    std::optional<std::int64_t> spillBytes;  // of stack, a thread
};

// `program` as given where it has a slash, else the first file of that name in PATH that can be run; nothing
// if there is none.
std::optional<std::filesystem::path> findProgram(const std::string& program);

// Error "malioc": can't be run, fails (with what it says), or prints no report. An empty `core` is the
// program's default.
Result<MaliocReport> runMalioc(const std::filesystem::path& program, const std::string& core,
                               const std::filesystem::path& spirv);
// Error "malioc" where `text` is no report; its errors, where it reports any.
Result<MaliocReport> parseMalioc(std::string_view text);

}  // namespace glint
