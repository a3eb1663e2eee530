// The folder that keeps modules, and whole runs that need not be repeated: its options and its contents.
#pragma once

#include "cache/action.h"
#include "cache/module_cache.h"
#include "cli/console.h"
#include "emit/compile.h"
#include "gltf/scene.h"

#include <CLI/CLI.hpp>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

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

// --- Keeps data of `compile` from run to run: modules, and whole runs that need not be repeated ---

// Without a folder nothing is found and nothing is kept.
class CompileCache {
public:
    // `options` comes from describeOptions(). Together with the program and the working folder it decides
    // what a run does with its inputs, whose names are `inputs`.
    CompileCache(const CacheArguments& arguments, const std::string& options,
                 std::span<const std::filesystem::path> inputs = {});

    // Returns null without a folder.
    compiler::ModuleCache* modules() {
        return modules_.get();
    }
    // Returns null without a folder.
    compiler::CacheStore* store() {
        return store_.get();
    }
    // Returns an earlier run with these options if its inputs and its outputs have not changed since.
    std::optional<compiler::ActionRecord> findUpToDate();
    void keep(const compiler::ActionRecord& record);
    // Trims the folder to its bounds, and reports what could not be stored.
    void close(const Console& console);

private:
    std::unique_ptr<compiler::CacheStore> store_;
    std::unique_ptr<compiler::ModuleCache> modules_;
    std::string action_;
};

// Returns every file from which the scenes were read, in the state at that time.
std::vector<compiler::FileState> filesOf(std::span<const gltf::Scene> scenes);
// Adds each of `paths` in its current state. Returns false if one can't be read.
bool addFiles(std::vector<compiler::FileState>& files, std::span<const std::filesystem::path> paths);
// Returns the package's files below `folder`.
std::vector<compiler::FileState> filesOf(const compiler::CompiledPackage& package,
                                         const std::filesystem::path& folder);

std::vector<std::string> pathsOf(std::span<const compiler::FileState> files);

}  // namespace glint::cli
