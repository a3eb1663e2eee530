#include "cli/compile/outputs.h"

#include "base/files.h"
#include "base/staged_file.h"
#include "cli/compile/held_signals.h"
#include "emit/package/embed_source.h"

#include <utility>
#include <vector>

namespace glint::cli {

namespace {

// The files outside the package's folder, in the order in which they are moved into place.
class Staging {
public:
    Status addEmbedded(const gltf::SceneList& scenes, const compiler::CompiledPackage& package,
                       const std::filesystem::path& source) {
        Result<std::vector<base::StagedFile>> staged = stageEmbeddedSource(scenes, package, source);
        if (!staged) {
            return staged.error();
        }
        for (base::StagedFile& file : *staged) {
            files_.push_back(std::move(file));
        }
        return okStatus();
    }

    Status add(const std::filesystem::path& path, std::string_view text) {
        base::removeAbandoned(path);
        Result<base::StagedFile> staged = base::StagedFile::create(path, base::asBytes(text));
        if (!staged) {
            return staged.error();
        }
        files_.push_back(std::move(*staged));
        return okStatus();
    }

    Status commit() {
        for (base::StagedFile& file : files_) {
            if (Status written = file.commit(); !written) {
                return written;
            }
        }
        return okStatus();
    }

private:
    std::vector<base::StagedFile> files_;
};

}  // namespace

Status writeOutputs(const gltf::SceneList& scenes, const compiler::CompiledPackage& package,
                    const CompileOutputs& outputs) {
    const HeldSignals held;
    Staging staging;
    if (outputs.lockChoice.text) {
        if (Status staged = staging.add(outputs.lock.file, *outputs.lockChoice.text); !staged) {
            return staged;
        }
    }
    if (!outputs.embed.empty()) {
        if (Status staged = staging.addEmbedded(scenes, package, outputs.embed); !staged) {
            return staged;
        }
    }
    // The dependency file comes last, because it tells Make and Ninja that the others exist.
    if (!outputs.depfile.file.empty()) {
        const Result<std::string> text = makeDepfile(outputs.depfile.targets, outputs.dependencies);
        if (!text) {
            return text.error();
        }
        if (Status staged = staging.add(outputs.depfile.file, *text); !staged) {
            return staged;
        }
    }
    if (!outputs.folder.empty()) {
        if (Status written = writePackage(package, outputs.folder); !written) {
            return written;
        }
    }
    return staging.commit();
}

}  // namespace glint::cli
