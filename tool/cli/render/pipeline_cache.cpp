#include "cli/render/pipeline_cache.h"

#include "base/files.h"
#include "cli/options/options.h"

#include <fmt/format.h>

#include <system_error>
#include <utility>

namespace glint::cli {

namespace fs = std::filesystem;

void addPipelineOptions(CLI::App& command, PipelineArguments& arguments) {
    addText(command, "--pipeline-cache", arguments.cache, "DIR",
            "folder that keeps the driver's compiled pipelines; none:\n"
            "keep nothing (default: pipelines in the folder of glint\n"
            "compile --cache)")
        .group("Device");
}

std::optional<fs::path> pipelineCacheFolder(const PipelineArguments& arguments,
                                            const CacheArguments& compiled) {
    if (arguments.cache == kNoCache) {
        return std::nullopt;
    }
    if (!arguments.cache.empty()) {
        return arguments.cache;
    }
    const std::optional<fs::path> folder = cacheFolder(compiled);
    return folder ? std::optional(*folder / "pipelines") : std::nullopt;
}

PipelineCacheFile::PipelineCacheFile(const Console& console, Context& context,
                                     const std::optional<fs::path>& folder)
    : console_(console), context_(context) {
    if (folder) {
        path_ = *folder / (context.pipelineCacheName() + ".bin");
        add(true);
    }
}

void PipelineCacheFile::add(bool reports) {
    std::error_code error;
    if (!fs::exists(path_, error)) {
        return;
    }
    const Result<base::Bytes> bytes = base::readFile(path_, kMostBytes);
    if (!bytes) {
        if (reports) {
            console_.report(Diagnostic{Severity::Note, "pipeline-cache", path_.string(),
                                       bytes.error().message, "pipelines are made without it"});
        }
        return;
    }
    const std::uint64_t hash = base::hashBytes(*bytes);
    if (std::exchange(seenHash_, hash) == hash) {
        return;
    }
    const Status added = context_.addPipelineCache(*bytes);
    if (added) {
        loadedBytes_ = reports ? bytes->size() : loadedBytes_;
    } else if (reports) {
        console_.report(Diagnostic{Severity::Note, "pipeline-cache", path_.string(), added.error().message,
                                   "pipelines are made without it, and the file is replaced"});
    }
}

void PipelineCacheFile::save() {
    if (path_.empty()) {
        return;
    }
    add(false);
    const Result<std::vector<std::uint8_t>> data = context_.pipelineCacheData();
    if (!data) {
        console_.report(Diagnostic{Severity::Note, "pipeline-cache", path_.string(), data.error().message,
                                   "nothing is lost but time"});
        return;
    }
    std::error_code error;
    if (data->size() > kMostBytes) {
        fs::remove(path_, error);
        console_.report(Diagnostic{Severity::Note, "pipeline-cache", path_.string(),
                                   fmt::format("has grown beyond {} MiB and is dropped", kMostBytes >> 20U),
                                   "nothing is lost but time"});
        return;
    }
    fs::create_directories(path_.parent_path(), error);
    const Status written = base::writeFile(path_, *data);
    if (written) {
        savedBytes_ = data->size();
    } else {
        console_.report(Diagnostic{Severity::Note, "cache-write", path_.string(), written.error().message,
                                   "nothing is lost but time; name another folder with --pipeline-cache, or "
                                   "--pipeline-cache none"});
    }
}

}  // namespace glint::cli
