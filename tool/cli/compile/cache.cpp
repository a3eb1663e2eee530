#include "cli/compile/cache.h"

#include "cache/packing.h"
#include "cache/program.h"
#include "emit/compile_modules.h"
#include "emit/measured_module.h"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>
#include <utility>

namespace glint::cli {

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
    std::vector<compiler::FileState> files;
    for (const compiler::PackageFile& file : package.files) {
        files.push_back({(folder / file.name).string(), file.bytes.size(), base::hashBytes(file.bytes), {}});
    }
    return files;
}

std::vector<std::string> pathsOf(std::span<const compiler::FileState> files) {
    std::vector<std::string> paths;
    for (const compiler::FileState& file : files) {
        paths.push_back(file.path);
    }
    return paths;
}

}  // namespace glint::cli
