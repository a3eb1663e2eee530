// The folder that keeps modules, and whole runs that need not be repeated: its options and its contents.
#pragma once

#include "cache/action.h"
#include "cache/module_cache.h"
#include "cli/console.h"
#include "emit/compile.h"
#include "gltf/scene.h"

#include <glint/context.h>

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

// --- The pipelines that drivers keep from run to run: --pipeline-cache ---

struct PipelineArguments {
    std::string cache;  // empty: beside the compiled shaders
};
void addPipelineOptions(CLI::App& command, PipelineArguments& arguments);

// Returns the folder of --pipeline-cache, else `pipelines` in the folder of compiled shaders. Returns nothing
// if either is "none".
std::optional<std::filesystem::path> pipelineCacheFolder(const PipelineArguments& arguments,
                                                         const CacheArguments& compiled);

// A file for each device and driver. Problems with it are only notes, because pipelines can be made without
// it.
class PipelineCacheFile {
public:
    // Gives the device the contents of its file. `console` and `context` must outlive it.
    PipelineCacheFile(const Console& console, Context& context,
                      const std::optional<std::filesystem::path>& folder);

    // Writes the pipelines that the device has now, together with what other processes wrote meanwhile, by a
    // rename. A file that would be larger than kMostBytes is removed instead, so that the next run starts
    // anew.
    void save();

    // Empty if no file is kept.
    const std::filesystem::path& path() const {
        return path_;
    }
    // Bytes of the file when the device got it; 0 if there was nothing usable.
    std::uint64_t loadedBytes() const {
        return loadedBytes_;
    }
    // Bytes of the file after save().
    std::uint64_t savedBytes() const {
        return savedBytes_;
    }

    static constexpr std::uint64_t kMostBytes = 256ULL << 20;

private:
    void add(bool reports);
    void note(const char* id, const std::string& message, const char* hint) const;

    const Console& console_;
    Context& context_;
    std::filesystem::path path_;
    std::uint64_t loadedBytes_ = 0;
    std::uint64_t savedBytes_ = 0;
    std::uint64_t seenHash_ = 0;  // of the file when it was read last
};

}  // namespace glint::cli
