#include "cli/compile/outputs.h"

#include "base/files.h"
#include "cli/compile/held_signals.h"
#include "emit/package/embed_source.h"
#include "emit/package/write.h"

#include <utility>
#include <vector>

namespace glint::cli {

namespace {

// The files outside the package's folder, in the order in which they are moved into place.
class Staging {
public:
    Status addEmbedded(const gltf::SceneList& scenes, const compiler::CompiledPackage& package,
                       const std::filesystem::path& source) {
        GLINT_TRY(auto staged, stageEmbeddedSource(scenes, package, source));
        for (base::StagedFile& file : staged) {
            files_.push_back(std::move(file));
        }
        return okStatus();
    }

    Status add(const std::filesystem::path& path, std::string_view text) {
        base::removeAbandoned(path);
        GLINT_TRY(auto staged, base::StagedFile::create(path, base::asBytes(text)));
        files_.push_back(std::move(staged));
        return okStatus();
    }

    Status commit() {
        for (base::StagedFile& file : files_) {
            GLINT_TRY_DO(file.commit());
        }
        return okStatus();
    }

private:
    std::vector<base::StagedFile> files_;
};

}  // namespace

Status writeOutputs(const compiler::Build& build, const compiler::CompiledPackage& package,
                    const CompileOutputs& outputs) {
    const HeldSignals held;
    Staging staging;
    if (build.lockText) {
        GLINT_TRY_DO(staging.add(build.settings.lock.file, *build.lockText));
    }
    if (!outputs.embed.empty()) {
        GLINT_TRY_DO(staging.addEmbedded(*build.scenes, package, outputs.embed));
    }
    // The dependency file comes last, because it tells Make and Ninja that the others exist.
    if (!outputs.depfile.file.empty()) {
        GLINT_TRY(const auto text, makeDepfile(outputs.depfile.targets, outputs.dependencies));
        GLINT_TRY_DO(staging.add(outputs.depfile.file, text));
    }
    if (!outputs.folder.empty()) {
        GLINT_TRY_DO(writePackage(package, outputs.folder));
    }
    return staging.commit();
}

}  // namespace glint::cli
