// What a run read, said and wrote, so that the next one can tell that it would do the same.
#pragma once

#include <glint/result.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace glint {

// A file as it was.
struct FileState {
    std::string path;
    std::uint64_t bytes = 0;
    std::uint64_t hash = 0;  // XXH3, 64 bits
    std::string real;        // with links followed; empty: does not matter
};

struct ActionRecord {
    std::vector<FileState> inputs;
    std::vector<FileState> outputs;
    std::vector<Diagnostic> diagnostics;
    std::string summary;  // the caller's
};

// Reads the file. Nothing where that fails.
std::optional<FileState> stateOf(const std::filesystem::path& path);
// `path` with links followed; empty where there is no such file.
std::string realPath(const std::filesystem::path& path);

// Whether every input and output is as it was.
bool isCurrent(const ActionRecord& record);

std::string pack(const ActionRecord& record);
// Nothing where `bytes` is no record.
std::optional<ActionRecord> unpackAction(std::string_view bytes);

}  // namespace glint
