#include "view/scene_load.h"

#include "base/clock.h"
#include "view/vulkan.h"

#include <glint/measure/render_settings.h>
#include <glint/scene_view/package.h>
#include <glint/scene_view/pose.h>

#include <utility>

namespace glint::view {

Result<OneTimeCommands> OneTimeCommands::create(const Context& context) {
    OneTimeCommands made;
    made.device_ = context.handles().device;
    GLINT_TRY_DO(createCommands(context, made.pool_, made.commands_));
    VkCommandBufferBeginInfo begin{};
    begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    const VkResult result = vkBeginCommandBuffer(made.commands_, &begin);
    if (result != VK_SUCCESS) {
        return callError("vkBeginCommandBuffer", result);
    }
    return made;
}

OneTimeCommands& OneTimeCommands::operator=(OneTimeCommands&& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(pool_, other.pool_);
    std::swap(commands_, other.commands_);
    return *this;
}

OneTimeCommands::~OneTimeCommands() {
    if (pool_ != VK_NULL_HANDLE) {
        vkDestroyCommandPool(device_, pool_, nullptr);
    }
}

Status OneTimeCommands::submit(const Context& context) {
    VkResult result = vkEndCommandBuffer(commands_);
    if (result != VK_SUCCESS) {
        return callError("vkEndCommandBuffer", result);
    }
    VkSubmitInfo submit{};
    submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &commands_;
    result = vkQueueSubmit(context.handles().queue, 1, &submit, VK_NULL_HANDLE);
    return result == VK_SUCCESS ? okStatus() : Status(callError("vkQueueSubmit", result));
}

Result<LoadedScene> loadScene(Context& context, SceneSource source, const gltf::Scene* posed) {
    const base::Clock::time_point start = base::Clock::now();
    const gltf::Scene& scene = posed != nullptr ? *posed : *source.scene;
    const Package& package = *source.package;
    LoadedScene made;
    made.data = std::make_unique<scene_view::SceneViewData>(measure::sceneView(source.settings, scene));
    made.data->packageScene = scene_view::sceneIn(package, scene).value_or(0);
    made.data->moves = posed != nullptr;
    scene_view::useLayoutOf(package, scene, *made.data);
    scene_view::useTextures(source.textures, *made.data);
    if (posed != nullptr) {
        scene_view::poseSceneView(scene, *made.data);
        measure::sizeLights(source.settings, *made.data);
    }
    GLINT_TRY(made.commands, OneTimeCommands::create(context));
    SceneView view = made.data->view();
    view.streamsTextures = true;
    // The number of the frame is not known here. complete() is not called before that frame is done.
    GLINT_TRY(made.scene, GpuScene::record(context, package, view, made.commands.handle(), 0));
    made.source = std::move(source);
    made.milliseconds = base::millisecondsSince(start);
    return made;
}

}  // namespace glint::view
