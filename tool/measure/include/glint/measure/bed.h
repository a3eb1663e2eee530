// Renders for a bench: one device and scene, and a renderer for each mounted configuration.
#pragma once

#include "gltf/scene.h"
#include "resolve/resolve.h"

#include <glint/context.h>
#include <glint/measure/observer.h>
#include <glint/measure/point.h>
#include <glint/measure/settings.h>
#include <glint/renderer.h>
#include <glint/result.h>
#include <glint/session/session.h>
#include <glint/session/textures.h>

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <tuple>
#include <vector>

namespace glint::measure {

// Filters the pictures of one renderer.
class PictureFilter {
public:
    PictureFilter() = default;
    virtual ~PictureFilter() = default;
    PictureFilter(const PictureFilter&) = delete;
    PictureFilter& operator=(const PictureFilter&) = delete;

    // Filters the renderer's last picture, with the history that it keeps of earlier ones.
    virtual Result<LinearImage> filter() = 0;
    // Device time of the last filter(), milliseconds.
    virtual double milliseconds() const = 0;
    // Forgets the earlier pictures.
    virtual void restart() = 0;
};

struct FilterMaker {
    std::vector<std::string> layers;       // layers that a package needs
    std::vector<std::string> imageLayers;  // layers that are read if an effect of the package has them
    // Makes the filter of a renderer with pictures of that size, which have `samples` samples a pixel.
    std::function<Result<std::unique_ptr<PictureFilter>>(const Context& context, const Renderer& renderer,
                                                         std::uint32_t width, std::uint32_t height,
                                                         std::uint32_t samples)>
        make;
};

// One picture: all samples of a frame.
struct Exposure {
    LinearImage image;
    double milliseconds = 0.0;  // device time of all samples
    double hitMs = 0.0;  // the part in which strategies differ: from the list of rays to their shaded hits
    // Times by pass, from one sample measured that way, times the number of samples. Passes that otherwise
    // overlap do not overlap here, so their sum is larger.
    std::map<std::string, double> passes;  // by name; those of cases together, as "shade cases"
    HitTimes hits;                         // the times in which strategies differ
    Renderer::Counters counters;           // of the last sample
};

// Milliseconds of the stretches of one sample (Timing::Frame) that are of this kind.
double stretchMs(std::span<const PassTiming> stretches, Pass pass);

// A configuration that is ready to render.
class Mount {
public:
    // With a filter, renders the frames before the picture, too; the times are those of the picture and of
    // its filter. Has the errors of Renderer::render().
    Result<Exposure> expose(std::uint32_t seed) const;
    // Renders with other samples and without measuring times.
    Result<LinearImage> exposeSamples(std::uint32_t seed, std::uint32_t samples) const;
    // Returns which pixels of the last picture see a surface, as Renderer::readSurfaces() does.
    Result<std::vector<std::uint8_t>> surfaces() const {
        return renderer_->readSurfaces();
    }

    const Renderer& renderer() const {
        return *renderer_;
    }
    bool ordersHits() const {
        return ordersHits_;
    }
    const Package& package() const {
        return *scene_->package;
    }
    std::uint32_t cases() const {
        return package().caseCount();
    }

private:
    friend class BenchBed;
    Status addSplit(FrameOptions frame, Exposure& exposure) const;
    Status showFramesBefore(FrameOptions frame) const;

    std::shared_ptr<const session::DeviceScene> scene_;
    std::shared_ptr<Renderer> renderer_;
    std::shared_ptr<PictureFilter> filter_;  // null: none
    std::uint32_t frames_ = 1;               // frames that the filter sees, with the picture
    FrameOptions frame_;
    std::uint32_t samples_ = 1;
    bool ordersHits_ = false;
};

// The facts about its scene and its device that a bench knows.
struct BedFacts {
    bool positionFetch = false;  // of the device and the compiler
    bool float16 = false;        // of the device
    bool onCpu = false;
    std::string cameraName;
    std::uint32_t lights = 0;
    std::uint64_t triangles = 0;  // of all instances
    std::uint32_t instances = 0;
};

class BenchBed {
public:
    // Reads the environment map, and chooses the camera and the device. Messages go to `observer`.
    // `observer`, `scene`, `cache` and `store`, which may be null, must outlive the result. `store` keeps
    // compressed textures. Errors of Context::createHeadless() and of files.
    static Result<std::unique_ptr<BenchBed>> create(const Observer& observer, const compiler::Settings& base,
                                                    const gltf::Scene& scene, compiler::ModuleCache* cache,
                                                    compiler::CacheStore* store);

    // Applies `configuration` to the base. `package` is a folder with a package of the scene to use; if it is
    // empty, one is compiled. Compiles, uploads and makes pipelines unless an existing mount has the same
    // ones. Has the errors of each of these steps.
    Result<Mount> mount(const compiler::Configuration& configuration, const std::string& package = {});
    // Does the same for pictures that are the last of `frames` frames, all of which a filter gets. `filter`
    // is read during the call.
    Result<Mount> mountFiltered(const FilterMaker& filter, std::uint32_t frames);

    Context& context() {
        return *context_;
    }
    // The settings of the user, with the strategy and the alpha policy of the default.
    const compiler::Settings& base() const {
        return base_;
    }
    const compiler::Build& build() const {
        return build_;
    }
    const gltf::Scene& scene() const {
        return scene_;
    }
    const BedFacts& facts() const {
        return facts_;
    }

private:
    BenchBed(const Observer& observer, compiler::Settings base, const gltf::Scene& scene,
             compiler::ModuleCache* cache, compiler::CacheStore* store)
        : observer_(observer),
          base_(std::move(base)),
          scene_(scene),
          list_(std::make_shared<const gltf::SceneList>(std::span(&scene, 1))),
          cache_(cache),
          store_(store) {}
    Status resolveBase();
    Result<Mount> mount(const compiler::Settings& asked);
    Result<session::DeviceScene> mountScene(const compiler::Build& build,
                                            std::shared_ptr<const Package> given);
    Result<std::shared_ptr<const gltf::SceneList>> scenesFor(const Package* package);
    Result<std::shared_ptr<const session::TextureSet>> textures(const compiler::Build& build,
                                                                const Package& package);

    const Observer& observer_;
    compiler::Settings base_;
    compiler::Build build_;
    const gltf::Scene& scene_;
    std::shared_ptr<const gltf::SceneList> list_;
    std::unique_ptr<const gltf::Scene> otherScene_;  // the same, with other trust in textures
    std::shared_ptr<const gltf::SceneList> otherList_;
    compiler::ModuleCache* cache_;
    compiler::CacheStore* store_;
    // By the scene, by whether they are compressed, and whether emission is unpacked as well.
    std::map<std::tuple<const gltf::Scene*, bool, bool>, std::shared_ptr<const session::TextureSet>>
        textures_;
    std::unique_ptr<Context> context_;
    std::unique_ptr<Environment> environment_;
    CameraView camera_;
    session::SkyChoice sky_;
    BedFacts facts_;
    // A package that is mounted, or was.
    struct Known {
        compiler::Settings settings;  // of the build
        std::weak_ptr<const session::DeviceScene> scene;
        std::weak_ptr<Renderer> renderer;
    };
    std::vector<Known> known_;
};

}  // namespace glint::measure
