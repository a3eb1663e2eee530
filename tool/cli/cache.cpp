#include "cli/cache.h"

#include "base/files.h"
#include "base/lists.h"
#include "cache/store.h"
#include "cli/options/options.h"
#include "emit/module_files.h"
#include "emit/modules.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <system_error>
#include <utility>

namespace glint::cli {

namespace fs = std::filesystem;

namespace {

// These options do not change what a command writes. Diagnostics are judged when they are reported.
constexpr std::array<std::string_view, 13> kWithoutEffect = {
    "--cache",          "--cache-size",       "--color", "--depfile", "--depfile-target", "--jobs", "--json",
    "--pipeline-cache", "--pipeline-threads", "--quiet", "--verbose", "--werror",         "-W"};

constexpr std::string_view kAction = "action";

// Returns an empty text if the variable is not set.
std::string variable(const char* name) {
    const char* const value = std::getenv(name);
    return value == nullptr ? std::string() : value;
}

}  // namespace

void addCacheOptions(CLI::App& command, CacheArguments& arguments) {
    const OptionGroup group(command, kWork);
    addText(command, "--cache", arguments.folder, "DIR",
            "folder that keeps compiled shaders; none: keep nothing (default: $GLINT_CACHE, else "
            "$XDG_CACHE_HOME/glint, else ~/.cache/glint)");
    constexpr std::int64_t kLargest = 1 << 20;
    addInteger(command, "--cache-size", arguments.mebibytes, 1, kLargest,
               "size limit of the cache in MiB; the least recently used entries are removed first");
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

CompileCache::CompileCache(const CacheArguments& arguments, const std::string& options,
                           std::span<const fs::path> inputs) {
    const std::optional<fs::path> folder = cacheFolder(arguments);
    if (!folder) {
        return;
    }
    constexpr std::uint64_t kMebibyte = 1ULL << 20;
    store_ = std::make_unique<compiler::CacheStore>(
        compiler::StoreOptions{*folder, static_cast<std::uint64_t>(arguments.mebibytes) * kMebibyte, {}});
    modules_ = std::make_unique<compiler::ModuleCache>(*store_, compiler::moduleCompiler());
    std::error_code error;
    action_ = compiler::Packer()
                  .add(compiler::programIdentity())
                  .add(fs::current_path(error).string())
                  .add(std::string_view(options))
                  .take();
    for (const fs::path& input : inputs) {
        action_ += compiler::Packer().add(input.string()).take();
    }
}

std::optional<compiler::ActionRecord> CompileCache::findUpToDate() {
    if (!store_) {
        return std::nullopt;
    }
    const std::optional<std::string> found = store_->find(kAction, action_);
    std::optional<compiler::ActionRecord> record = found ? compiler::unpackAction(*found) : std::nullopt;
    return record && isCurrent(*record) ? std::move(record) : std::nullopt;
}

void CompileCache::keep(const compiler::ActionRecord& record) {
    if (store_) {
        store_->put(kAction, action_, pack(record));
    }
}

void CompileCache::close(const Console& console) {
    if (!store_) {
        return;
    }
    store_->trim();
    if (const std::optional<Diagnostic> trouble = store_->trouble()) {
        console.report(*trouble);
    }
}

std::vector<compiler::FileState> filesOf(std::span<const gltf::Scene> scenes) {
    std::vector<compiler::FileState> files;
    for (const gltf::Scene& scene : scenes) {
        for (const gltf::SourceFile& file : scene.files) {
            files.push_back({file.path, file.bytes, file.hash, compiler::realPath(file.path)});
        }
    }
    return files;
}

bool addFiles(std::vector<compiler::FileState>& files, std::span<const fs::path> paths) {
    for (const fs::path& path : paths) {
        std::optional<compiler::FileState> state = compiler::stateOf(path);
        if (!state) {
            return false;
        }
        files.push_back(std::move(*state));
    }
    return true;
}

std::vector<compiler::FileState> filesOf(const compiler::CompiledPackage& package, const fs::path& folder) {
    return base::mapped<compiler::FileState>(package.files, [&](const compiler::PackageFile& file) {
        return compiler::FileState{(folder / file.name).string(), file.bytes.size(), file.hash, {}};
    });
}

std::vector<std::string> pathsOf(std::span<const compiler::FileState> files) {
    return base::mapped<std::string>(files, &compiler::FileState::path);
}

// --- Pipelines of drivers ---

void addPipelineOptions(CLI::App& command, PipelineArguments& arguments) {
    addText(command, "--pipeline-cache", arguments.cache, "DIR",
            "folder that keeps the driver's compiled pipelines; none: keep nothing (default: pipelines in "
            "the folder of glint compile --cache)")
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

void PipelineCacheFile::note(const char* id, const std::string& message, const char* hint) const {
    console_.report(Diagnostic{Severity::Note, id, path_.string(), message, hint});
}

void PipelineCacheFile::add(bool reports) {
    std::error_code error;
    if (!fs::exists(path_, error)) {
        return;
    }
    const Result<base::Bytes> bytes = base::readFile(path_, kMostBytes);
    if (!bytes) {
        if (reports) {
            note("pipeline-cache", bytes.error().message, "pipelines are made without it");
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
        note("pipeline-cache", added.error().message,
             "pipelines are made without it, and the file is replaced");
    }
}

void PipelineCacheFile::save() {
    if (path_.empty()) {
        return;
    }
    add(false);
    const Result<std::vector<std::uint8_t>> data = context_.pipelineCacheData();
    if (!data) {
        note("pipeline-cache", data.error().message, "nothing is lost but time");
        return;
    }
    std::error_code error;
    if (data->size() > kMostBytes) {
        fs::remove(path_, error);
        note("pipeline-cache", fmt::format("has grown beyond {} MiB and is dropped", kMostBytes >> 20U),
             "nothing is lost but time");
        return;
    }
    fs::create_directories(path_.parent_path(), error);
    const Status written = base::writeFile(path_, *data);
    if (written) {
        savedBytes_ = data->size();
    } else {
        note("cache-write", written.error().message,
             "nothing is lost but time; name another folder with --pipeline-cache, or --pipeline-cache none");
    }
}

}  // namespace glint::cli
