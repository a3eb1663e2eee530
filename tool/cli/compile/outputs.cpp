#include "cli/compile/outputs.h"

#include "base/files.h"
#include "base/staged_file.h"
#include "cli/compile/held_signals.h"
#include "emit/package/embed_source.h"

#include <utility>
#include <vector>

namespace glint {

namespace {

// The files outside the package's folder, in the order in which they are moved into place.
class Staging {
public:
    Status addEmbedded(const SceneList& scenes, const CompiledPackage& package,
                       const std::filesystem::path& source) {
        Result<std::vector<StagedFile>> staged = stageEmbeddedSource(scenes, package, source);
        if (!staged) {
            return staged.error();
        }
        for (StagedFile& file : *staged) {
            files_.push_back(std::move(file));
        }
        return okStatus();
    }

    Status add(const std::filesystem::path& path, std::string_view text) {
        removeAbandoned(path);
        Result<StagedFile> staged = StagedFile::create(path, asBytes(text));
        if (!staged) {
            return staged.error();
        }
        files_.push_back(std::move(*staged));
        return okStatus();
    }

    Status commit() {
        for (StagedFile& file : files_) {
            if (Status written = file.commit(); !written) {
                return written;
            }
        }
        return okStatus();
    }

private:
    std::vector<StagedFile> files_;
};

}  // namespace

Status writeOutputs(const SceneList& scenes, const CompiledPackage& package, const CompileOutputs& outputs) {
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

}  // namespace glint
