#include "cli/compile/cache.h"

#include "cache/packing.h"
#include "cache/program.h"
#include "emit/compile_modules.h"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>
#include <utility>

namespace glint {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kAction = "action";

}  // namespace

CompileCache::CompileCache(const CacheArguments& arguments, const std::string& options,
                           std::span<const fs::path> inputs) {
    const std::optional<fs::path> folder = cacheFolder(arguments);
    if (!folder) {
        return;
    }
    constexpr std::uint64_t kMebibyte = 1ULL << 20;
    store_ = std::make_unique<CacheStore>(
        StoreOptions{*folder, static_cast<std::uint64_t>(arguments.mebibytes) * kMebibyte, {}});
    modules_ = std::make_unique<ModuleCache>(*store_, moduleCompiler());
    std::error_code error;
    action_ = Packer()
                  .add(programIdentity())
                  .add(fs::current_path(error).string())
                  .add(std::string_view(options))
                  .take();
    for (const fs::path& input : inputs) {
        action_ += Packer().add(input.string()).take();
    }
}

std::optional<ActionRecord> CompileCache::findUpToDate() {
    if (!store_) {
        return std::nullopt;
    }
    const std::optional<std::string> found = store_->find(kAction, action_);
    std::optional<ActionRecord> record = found ? unpackAction(*found) : std::nullopt;
    return record && isCurrent(*record) ? std::move(record) : std::nullopt;
}

void CompileCache::keep(const ActionRecord& record) {
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

std::vector<FileState> filesOf(std::span<const Scene> scenes) {
    std::vector<FileState> files;
    for (const Scene& scene : scenes) {
        for (const SourceFile& file : scene.files) {
            files.push_back({file.path, file.bytes, file.hash, realPath(file.path)});
        }
    }
    return files;
}

bool addFiles(std::vector<FileState>& files, std::span<const fs::path> paths) {
    for (const fs::path& path : paths) {
        std::optional<FileState> state = stateOf(path);
        if (!state) {
            return false;
        }
        files.push_back(std::move(*state));
    }
    return true;
}

std::vector<FileState> filesOf(const CompiledPackage& package, const fs::path& folder) {
    std::vector<FileState> files;
    for (const PackageFile& file : package.files) {
        files.push_back({(folder / file.name).string(), file.bytes.size(), hashBytes(file.bytes), {}});
    }
    return files;
}

std::vector<std::string> pathsOf(std::span<const FileState> files) {
    std::vector<std::string> paths;
    for (const FileState& file : files) {
        paths.push_back(file.path);
    }
    return paths;
}

}  // namespace glint
