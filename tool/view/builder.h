// Reads the scene and compiles its package on a thread of its own, while the window goes on.
#pragma once

#include "base/input_watch.h"
#include "emit/warm_modules.h"
#include "gltf/scene.h"
#include "resolve/resolve.h"
#include "settings/descriptor.h"
#include "view/request.h"

#include <glint/package.h>
#include <glint/session/edits.h>
#include <glint/session/textures.h>

#include <array>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace glint::view {

// The inputs of a picture, apart from the device's copy.
struct Build {
    std::shared_ptr<const compiler::Build> resolved;  // of `scene`
    std::shared_ptr<const gltf::Scene> scene;
    std::shared_ptr<const Package> package;
    std::shared_ptr<const session::TextureSet> textures;
    // The length of each case's own shader in SPIR-V instructions, by shader ID; 0: it has none, or it is
    // unknown.
    std::vector<std::uint32_t> instructions;
    // The number of edits, from the first on, for which the package is made, and the files that they add,
    // with their textures by the same names.
    std::size_t edits = 0;
    session::SceneFiles files;
    std::map<std::string, std::shared_ptr<const session::TextureSet>, std::less<>> fileTextures;
    std::vector<std::string> layers;      // names of those that its packages may have (PackageLayer::name)
    compiler::BenchFacts facts;           // of the scene, about settings that change nothing
    std::vector<base::InputFile> inputs;  // files to watch

    // Without `auto`.
    const compiler::Settings& settings() const {
        return resolved->settings;
    }
    // Wall clock.
    double readMs = 0.0;
    double compileMs = 0.0;
    double texturesMs = 0.0;
    int modulesCompiled = 0;
    int modulesKept = 0;
};

// The pictures that are built: the one that is always there, and the one that it is compared with.
inline constexpr std::size_t kPictures = 2;

// Returns whether two scenes were read from files with the same contents. Their materials may still be
// planned with other packs.
bool haveSameFiles(const gltf::Scene& a, const gltf::Scene& b);

struct BuildOrder {
    std::size_t picture = 0;
    compiler::Settings settings;
    std::string scene;
    std::vector<session::Edit> edits{};  // all that were made, and those that wait for the build
    bool rereads = false;                // files of the scene, its packs or host have changed
};

class Builder {
public:
    // The arguments must outlive the builder.
    Builder(const Request& request, Context& context);
    // Waits for a build that is running.
    ~Builder();
    Builder(const Builder&) = delete;
    Builder& operator=(const Builder&) = delete;

    // Begins a build. A running build is finished first. Of the orders that wait, only the last one for each
    // picture is kept.
    void start(BuildOrder order);
    // Forgets the order for a picture.
    void cancel(std::size_t picture);
    // Returns the finished build of a picture, once.
    std::optional<Result<Build>> poll(std::size_t picture);
    bool isBusy(std::size_t picture) const;
    // Returns the present activity.
    std::string progress() const;
    // Returns the warnings and notes since the last call.
    std::vector<Diagnostic> takeMessages();

private:
    void work();
    Result<Build> build(const BuildOrder& asked);
    Status readScene(const BuildOrder& order, const Package* package, Build& build);
    Status makePackage(compiler::Settings asked, std::shared_ptr<const Package> given, Build& build);
    Status readTextures(Build& build);
    Status readEdits(const BuildOrder& order, const Package* package, Build& build);
    void say(std::string text);

    const Request& request_;
    Context& context_;
    compiler::WarmModules warm_;
    // The last scene and its textures, and the settings with which they were read.
    std::shared_ptr<const gltf::Scene> scene_;
    std::shared_ptr<const gltf::SceneList> list_;  // of it, and with edits of all that they make of it
    std::string sceneKey_;
    std::shared_ptr<const session::TextureSet> textures_;
    std::string texturesKey_;
    // The files that edits have added.
    session::SceneFiles files_;
    std::map<std::string, std::shared_ptr<const session::TextureSet>, std::less<>> fileTextures_;
    std::uint32_t strategies_ = 0;  // bits
    std::string strategiesKey_;

    mutable std::mutex mutex_;  // guards all below
    std::condition_variable wake_;
    struct Slot {
        std::optional<BuildOrder> order;
        std::optional<Result<Build>> done;
        bool busy = false;
        bool canceled = false;
    };
    std::array<Slot, kPictures> slots_;
    std::string progress_;
    std::vector<Diagnostic> messages_;
    bool ends_ = false;
    std::thread thread_;
};

}  // namespace glint::view
