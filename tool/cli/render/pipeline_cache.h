// The pipelines that drivers keep from run to run: --pipeline-cache.
#pragma once

#include "cli/cache.h"
#include "cli/console.h"

#include <glint/context.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace glint::cli {

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

    const Console& console_;
    Context& context_;
    std::filesystem::path path_;
    std::uint64_t loadedBytes_ = 0;
    std::uint64_t savedBytes_ = 0;
    std::uint64_t seenHash_ = 0;  // of the file when it was read last
};

}  // namespace glint::cli
