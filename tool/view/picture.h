// One picture of the window: a scene on the device and a renderer, made from one set of settings.
#pragma once

#include "view/builder.h"
#include "view/vulkan.h"

#include <glint/session/edits.h>
#include <glint/session/live_scene.h>
#include <glint/session/session.h>

#include <cstdint>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace glint::view {

class Picture {
public:
    explicit Picture(Context& context) : context_(context) {}

    // Begins to record the upload of a build's scene on a thread, if install() will need it, and returns
    // whether it has. The build can be installed when the thread is done.
    bool load(const Build& build);
    bool isLoading() const;
    // Returns whether load() has begun, and install() was not called since.
    bool hasLoaded() const {
        return loading_.valid();
    }
    // Forgets the load. Waits for the thread.
    void cancelLoad() {
        loading_ = {};
    }
    // Takes a build. Keeps scene, buffers and pipelines that it has in common with the one before. The device
    // must be idle unless load() has begun. `frame` is the number of the next frame, which is submitted after
    // the upload. An error leaves the picture as it was, except that an environment may be another one.
    // `width` and `height` are in pixels. Errors are those of the runtime and of reading environment maps,
    // and "half-precision" and "position-fetch" if the device lacks a feature that the build needs.
    Status install(Build build, std::uint32_t width, std::uint32_t height, std::uint64_t frame,
                   std::vector<Diagnostic>& notes);
    // Takes settings of stages after the package, or another size. The device must be idle unless
    // changeBetween() is compiler::kChangesFrame.
    Status change(const compiler::Settings& settings, std::uint32_t width, std::uint32_t height);

    // Shows another moment, or the rest pose. The first one uploads the scene anew, so that it can move,
    // before the frame `frame`.
    Status pose(const std::optional<session::Moment>& moment, std::uint64_t frame);
    // Takes the list of edits, whose first `same` are those of the last call, and makes those that the
    // package is made for. The first one uploads the scene anew, so that it can be edited, before the frame
    // `frame`. install() makes the others. Edits that can't be made are passed over, and the first error is
    // returned.
    Status edit(std::span<const session::Edit> edits, std::size_t same, std::uint64_t frame);
    // Returns whether edits wait for another build.
    bool needsBuild() const {
        return edited_ < edits_.size();
    }
    // Returns the first animations of the files that edits have added, which play with the scene's.
    const std::vector<std::size_t>& addedAnimations() const {
        return addedAnimations_;
    }
    // Returns the index of an instance in data(), if `place` is one of it.
    std::optional<std::size_t> instanceAt(const Renderer::SurfacePlace& place) const;

    bool isReady() const {
        return device_.renderer != nullptr;
    }
    // Begins the mean over samples anew.
    void restart() {
        samples_ = 0;
        fails_ = false;
    }
    // Samples that the picture averages.
    std::uint32_t samples() const {
        return samples_;
    }
    // Also true if the picture can't be drawn as its settings request.
    bool isComplete() const {
        return (samples_ >= settings_.samples && !poseIsNew_ && missingLevels() == 0) || fails_;
    }
    // Returns how many textures have levels that no frame has yet.
    std::uint32_t missingLevels() const;
    // Returns once after each upload whether the device has all levels of the textures.
    bool takeAllLevels(std::uint64_t completed);
    // Draws nothing until the settings or the camera change.
    void skip() {
        fails_ = true;
    }
    // Records a sample. `number` is that of the frame in which it is.
    Status record(VkCommandBuffer commands, const CameraView& camera, Timing timing, std::uint64_t number);
    // The device has completed all frames up to this one.
    void completed(std::uint64_t number);

    const compiler::Settings& settings() const {
        return settings_;
    }
    const Build& build() const {
        return build_;
    }
    // The scene in its present pose.
    const gltf::Scene& scene() const {
        return posed_ ? *posed_ : *build_.scene;
    }
    const session::SceneViewData& data() const {
        return device_.scene.data;
    }
    Renderer& renderer() {
        return *device_.renderer;
    }
    GpuScene& gpuScene() {
        return *device_.scene.gpu;
    }
    const std::optional<session::Moment>& moment() const {
        return moment_;
    }
    // Frame number of the last sample.
    std::uint64_t recordedIn() const {
        return recordedIn_;
    }
    // Device times of the last replacement or upload, for people.
    const std::string& lastChange() const {
        return lastChange_;
    }

private:
    // A scene on the device, with the commands of its upload. Members are destroyed in reverse order.
    struct Device {
        std::shared_ptr<const gltf::Scene> read;  // to which the scene's data point
        session::DeviceScene scene;
        OneTimeCommands commands;
        std::unique_ptr<Renderer> renderer;
        std::uint64_t uploadedIn = 0;  // frame that is done after the upload
        double recordMs = 0.0;         // of wall clock, until the upload was recorded
    };
    // The changes that a scene on the device can take.
    enum class Use : std::uint8_t { Still, Moves, Edited };
    static Result<Device> recordUpload(Context& context, const Build& build, const gltf::Scene& scene,
                                       Use use);
    bool isSameScene(const Build& build) const;
    bool keepsEdits(const Build& build) const;
    Status adopt(Device made, const RendererOptions& options, std::uint64_t frame);
    Status readEnvironment(const Build& build, std::vector<Diagnostic>& notes);
    Result<bool> replace(Build& build, const RendererOptions& options);
    void startEdits();
    Status makeEdits(std::uint64_t frame);
    Status followScene();

    Context& context_;
    compiler::Settings settings_;
    Build build_;
    std::unique_ptr<gltf::Scene> posed_;  // null until the scene moves or is edited
    std::vector<session::Edit> edits_;
    std::size_t edited_ = 0;  // edits that were made, or passed over
    std::vector<std::size_t> addedAnimations_;
    std::optional<session::Moment> moment_;
    bool poseIsNew_ = false;  // the device has another pose
    std::shared_ptr<Environment> environment_;
    std::string environmentKey_;
    session::SkyChoice sky_;
    Device device_;
    std::optional<session::LiveScene> live_;  // of `device_`, if it can be edited
    std::uint64_t levelsIn_ = 0;              // frame that has got the last levels of textures
    bool levelsAreNew_ = false;               // takeAllLevels() has not told yet
    // Earlier scenes, while frames may use them.
    struct RetiredDevice {
        std::uint64_t frame = 0;
        Device device;
    };
    std::vector<RetiredDevice> retired_;
    // The result of load(). Its destructor waits for the thread.
    std::future<Result<Device>> loading_;
    RendererOptions options_;
    FrameOptions lastFrame_;  // as recorded last
    std::uint32_t samples_ = 0;
    bool fails_ = false;
    std::uint64_t recordedIn_ = 0;
    struct Recording {
        std::uint64_t frame = 0;
        std::uint64_t recording = 0;
    };
    std::vector<Recording> inFlight_;
    std::string lastChange_;
};

}  // namespace glint::view
