// Keeps data of `compile` from run to run: modules, and whole runs that need not be repeated.
#pragma once

#include "cache/action.h"
#include "cache/module_cache.h"
#include "cli/console.h"
#include "cli/options/cache_options.h"
#include "emit/compile.h"
#include "gltf/scene.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace glint {

// Without a folder nothing is found and nothing is kept.
class CompileCache {
public:
    // `options` comes from describeOptions(). Together with the program and the working folder it decides
    // what a run does with its inputs, whose names are `inputs`.
    CompileCache(const CacheArguments& arguments, const std::string& options,
                 std::span<const std::filesystem::path> inputs = {});

    // Returns null without a folder.
    ModuleCache* modules() {
        return modules_.get();
    }
    // Returns null without a folder.
    CacheStore* store() {
        return store_.get();
    }
    // Returns an earlier run with these options if its inputs and its outputs have not changed since.
    std::optional<ActionRecord> findUpToDate();
    void keep(const ActionRecord& record);
    // Trims the folder to its bounds, and reports what could not be stored.
    void close(const Console& console);

private:
    std::unique_ptr<CacheStore> store_;
    std::unique_ptr<ModuleCache> modules_;
    std::string action_;
};

// Returns every file from which the scenes were read, in the state at that time.
std::vector<FileState> filesOf(std::span<const Scene> scenes);
// Adds each of `paths` in its current state. Returns false if one can't be read.
bool addFiles(std::vector<FileState>& files, std::span<const std::filesystem::path> paths);
// Returns the package's files below `folder`.
std::vector<FileState> filesOf(const CompiledPackage& package, const std::filesystem::path& folder);

std::vector<std::string> pathsOf(std::span<const FileState> files);

}  // namespace glint
