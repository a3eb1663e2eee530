// The files of a bench: page, JSON, pictures, settings.
#pragma once

#include "cli/bench_report.h"

#include <glint/result.h>

#include <filesystem>

namespace glint {

inline constexpr const char* kPageFile = "index.html";
inline constexpr const char* kReportFile = "bench.json";
inline constexpr const char* kSettingsFile = "settings.json";

// Error "bench-folder" unless `folder` is one of an earlier bench, which has the file `mark`, an empty one,
// or could be made; nothing is written yet.
Status checkBenchFolder(const std::filesystem::path& folder, const char* mark = kReportFile);

// Pictures first, then settings, report and page, each replaced as a whole; pictures of an earlier bench that
// this one lacks go. Errors "file-write", "png-encode".
Status writeBench(const BenchReport& report, const std::filesystem::path& folder);

}  // namespace glint
