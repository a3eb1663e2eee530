// The folder of compiled modules: --cache and --cache-size.
#pragma once

#include <CLI/CLI.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace glint::cli {

// The value that means no folder.
inline constexpr std::string_view kNoCache = "none";

struct CacheArguments {
    std::string folder;  // empty: as the environment says
    std::int64_t mebibytes = 512;
};
void addCacheOptions(CLI::App& command, CacheArguments& arguments);

// Returns the folder of --cache, else of GLINT_CACHE, else glint in XDG_CACHE_HOME, else glint in ~/.cache.
// Returns nothing if it is "none", or if there is no home folder.
std::optional<std::filesystem::path> cacheFolder(const CacheArguments& arguments);

// Returns whether the option may change what a command writes.
bool hasEffect(const CLI::Option& option);

// Returns the given options that can change what a command does or prints: all but those about the cache, the
// number of jobs, and reporting.
std::string describeOptions(const CLI::App& command);

}  // namespace glint::cli
