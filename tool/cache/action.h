// A record of the files that a run read and wrote and of its output, so that the next run can tell that it
// would do the same.
#pragma once

#include <glint/result.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace glint::compiler {

// Returns a text that differs between builds of the program and of the shared libraries that it runs with. It
// consists of their build IDs; for a file without one, of its path, size and time stamp.
std::string programIdentity();

// The state of a file at the time of the run.
struct FileState {
    std::string path;
    std::uint64_t bytes = 0;
    std::uint64_t hash = 0;  // 64-bit XXH3
    std::string real;        // path with links followed; empty if it does not matter
};

struct ActionRecord {
    std::vector<FileState> inputs;
    std::vector<FileState> outputs;
    std::vector<Diagnostic> diagnostics;
    std::string summary;  // the caller's own text
};

// Reads the file. Returns nothing if that fails.
std::optional<FileState> stateOf(const std::filesystem::path& path);
// Returns `path` with links followed, or an empty text if there is no such file.
std::string realPath(const std::filesystem::path& path);

// Returns whether every input and output still has its recorded state.
bool isCurrent(const ActionRecord& record);

std::string pack(const ActionRecord& record);
// Returns nothing if `bytes` is not a record.
std::optional<ActionRecord> unpackAction(std::string_view bytes);

}  // namespace glint::compiler
