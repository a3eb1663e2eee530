#include "cli/options/cache_options.h"

#include "cache/packing.h"
#include "cli/options/options.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string_view>

namespace glint::cli {

namespace fs = std::filesystem;

namespace {

// These options do not change what a command writes. Diagnostics are judged when they are reported.
constexpr std::array<std::string_view, 13> kWithoutEffect = {
    "--cache",          "--cache-size",       "--color", "--depfile", "--depfile-target", "--jobs", "--json",
    "--pipeline-cache", "--pipeline-threads", "--quiet", "--verbose", "--werror",         "-W"};

// Returns an empty text if the variable is not set.
std::string variable(const char* name) {
    const char* const value = std::getenv(name);
    return value == nullptr ? std::string() : value;
}

}  // namespace

void addCacheOptions(CLI::App& command, CacheArguments& arguments) {
    addText(command, "--cache", arguments.folder, "DIR",
            "folder that keeps compiled shaders; none: keep nothing\n"
            "(default: $GLINT_CACHE, else $XDG_CACHE_HOME/glint, else\n"
            "~/.cache/glint)")
        .group(kWork);
    constexpr std::int64_t kLargest = 1 << 20;
    addInteger(command, "--cache-size", arguments.mebibytes, 1, kLargest,
               "size limit of the cache in MiB; the least recently used\n"
               "entries are removed first")
        .group(kWork);
}

std::optional<fs::path> cacheFolder(const CacheArguments& arguments) {
    std::string folder = arguments.folder.empty() ? variable("GLINT_CACHE") : arguments.folder;
    if (folder == kNoCache) {
        return std::nullopt;
    }
    if (!folder.empty()) {
        return folder;
    }
    // The specification says to ignore a relative path: XDG Base Directory Specification, 0.8.
    const fs::path caches = variable("XDG_CACHE_HOME");
    if (caches.is_absolute()) {
        return caches / "glint";
    }
    const fs::path home = variable("HOME");
    return home.is_absolute() ? std::optional(home / ".cache" / "glint") : std::nullopt;
}

bool hasEffect(const CLI::Option& option) {
    return std::ranges::find(kWithoutEffect, option.get_name()) == kWithoutEffect.end();
}

std::string describeOptions(const CLI::App& command) {
    compiler::Packer packer;
    packer.add(std::string_view(command.get_name()));
    for (const CLI::Option* const option : command.get_options()) {
        const std::string name = option->get_name();
        if (option->count() == 0 || !hasEffect(*option)) {
            continue;
        }
        packer.add(std::string_view(name)).add(option->results().size());
        for (const std::string& value : option->results()) {
            packer.add(std::string_view(value));
        }
    }
    return packer.take();
}

}  // namespace glint::cli
