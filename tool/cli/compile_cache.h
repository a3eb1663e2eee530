// What `compile` keeps from run to run: modules, and whole runs that need not be done again.
#pragma once

#include "cache/action.h"
#include "cache/module_cache.h"
#include "cli/cache_options.h"
#include "cli/console.h"
#include "emit/compile.h"
#include "gltf/scene.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace glint {

// Without a folder nothing is found and nothing kept.
class CompileCache {
public:
    // `options`: as describeOptions(); with the program and the working folder they decide what a run does
    // with its inputs.
    CompileCache(const CacheArguments& arguments, const std::string& options);

    // Null without a folder.
    ModuleCache* modules() {
        return modules_.get();
    }
    // Likewise.
    CacheStore* store() {
        return store_.get();
    }
    // An earlier run with these options, if its inputs and its outputs are as it left them.
    std::optional<ActionRecord> findUpToDate();
    void keep(const ActionRecord& record);
    // Keeps the folder within its bounds, and notes what could not be stored.
    void close(const Console& console);

private:
    std::unique_ptr<CacheStore> store_;
    std::unique_ptr<ModuleCache> modules_;
    std::string action_;
};

// Every file that the scenes were read from, as it was then.
std::vector<FileState> filesOf(std::span<const Scene> scenes);
// Adds each of `paths` as it is now. False where one can't be read.
bool addFiles(std::vector<FileState>& files, std::span<const std::filesystem::path> paths);
// The package's files below `folder`.
std::vector<FileState> filesOf(const CompiledPackage& package, const std::filesystem::path& folder);

std::vector<std::string> pathsOf(std::span<const FileState> files);

}  // namespace glint
