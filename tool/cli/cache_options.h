// Where compiled modules are kept: --cache and --cache-size.
#pragma once

#include <CLI/CLI.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace glint {

// What stands for no folder.
inline constexpr std::string_view kNoCache = "none";

struct CacheArguments {
    std::string folder;  // empty: as the environment says
    std::int64_t mebibytes = 512;
};
void addCacheOptions(CLI::App& command, CacheArguments& arguments);

// --cache, else GLINT_CACHE, else glint in XDG_CACHE_HOME, else in ~/.cache. Nothing where it is "none", or
// where there is no home.
std::optional<std::filesystem::path> cacheFolder(const CacheArguments& arguments);

// Whether a command may write something else for the option.
bool hasEffect(const CLI::Option& option);

// The options that are given and can change what a command does or says: all but those of the cache, the
// number of jobs, and how to report.
std::string describeOptions(const CLI::App& command);

}  // namespace glint
