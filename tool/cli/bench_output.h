// Writes the files of a bench: page, JSON, pictures, settings.
#pragma once

#include "cli/bench_report.h"

#include <glint/result.h>

#include <filesystem>

namespace glint {

inline constexpr const char* kPageFile = "index.html";
inline constexpr const char* kReportFile = "bench.json";
inline constexpr const char* kSettingsFile = "settings.json";

// Returns the error "bench-folder" unless `folder` belongs to an earlier bench (it has the file `mark`), is
// empty, or could be created. Writes nothing yet.
Status checkBenchFolder(const std::filesystem::path& folder, const char* mark = kReportFile);

// Writes pictures first, then settings, report and page, each replaced as a whole. Pictures of an earlier
// bench that this one lacks are removed. Errors "file-write", "png-encode".
Status writeBench(const BenchReport& report, const std::filesystem::path& folder);

}  // namespace glint
