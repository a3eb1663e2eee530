// The upload of a scene, which is recorded on any thread and submitted by the window's.
#pragma once

#include "gltf/scene.h"
#include "settings/descriptor.h"

#include <glint/package.h>
#include <glint/renderer.h>
#include <glint/scene_view/scene_view.h>
#include <glint/scene_view/textures.h>

#include <vulkan/vulkan.h>

#include <memory>

namespace glint::view {

// A command buffer that is recorded and submitted once.
class OneTimeCommands {
public:
    // Begins to record.
    static Result<OneTimeCommands> create(const Context& context);
    OneTimeCommands() = default;
    OneTimeCommands(const OneTimeCommands&) = delete;
    OneTimeCommands& operator=(const OneTimeCommands&) = delete;
    OneTimeCommands(OneTimeCommands&& other) noexcept {
        *this = std::move(other);
    }
    OneTimeCommands& operator=(OneTimeCommands&& other) noexcept;
    // The device must be done with the commands.
    ~OneTimeCommands();

    VkCommandBuffer handle() const {
        return commands_;
    }
    // Submits them to the context's queue, before all that is submitted later.
    Status submit(const Context& context);

private:
    VkDevice device_ = VK_NULL_HANDLE;
    VkCommandPool pool_ = VK_NULL_HANDLE;
    VkCommandBuffer commands_ = VK_NULL_HANDLE;
};

// The inputs of a scene.
struct SceneSource {
    compiler::Settings settings;
    std::shared_ptr<const gltf::Scene> scene;
    std::shared_ptr<const Package> package;
    std::shared_ptr<const scene_view::TextureSet> textures;
};

// A scene, and the commands of its upload. Members are destroyed in reverse order.
struct LoadedScene {
    SceneSource source;
    std::unique_ptr<scene_view::SceneViewData> data;
    std::unique_ptr<GpuScene> scene;
    OneTimeCommands commands;
    double milliseconds = 0.0;  // of wall clock, until the upload was recorded
};

// Makes a scene with the coarse levels of its textures; GpuScene::textureStream() brings the others. `posed`
// is null, or the source's scene in its present pose if it moves.
Result<LoadedScene> loadScene(Context& context, SceneSource source, const gltf::Scene* posed);

}  // namespace glint::view
