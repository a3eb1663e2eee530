#include "readback.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace glint {
namespace {

void recordCopy(const Renderer::State& state, VkCommandBuffer commands, std::uint32_t binding,
                const Buffer& target) {
    recordDependency(state.context, commands,
                     {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_SHADER_WRITE_BIT,
                      VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT});
    VkBufferImageCopy region{};
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.imageExtent = {state.size.width, state.size.height, 1};
    state.context.vk.CmdCopyImageToBuffer(commands, state.frame.images[binding].handle.get(),
                                          VK_IMAGE_LAYOUT_GENERAL, target.handle.get(), 1, &region);
    recordDependency(state.context, commands,
                     {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                      VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT});
}

PixelPath pathOf(float path, float outcome) {
    if (path == static_cast<float>(gpu::kPathScreen)) {
        return PixelPath::Screen;
    }
    if (path == static_cast<float>(gpu::kPathHit)) {
        return PixelPath::Hit;
    }
    if (path == static_cast<float>(gpu::kPathMiss)) {
        return PixelPath::Miss;
    }
    return std::bit_cast<std::uint32_t>(outcome) == gpu::kRayNoSurface ? PixelPath::NoSurface
                                                                       : PixelPath::NoRay;
}

}  // namespace

Result<std::vector<std::array<float, 4>>> readFrameImage(Renderer::State& state, CommandRunner& runner,
                                                         std::uint32_t binding) {
    MemoryPool pool(state.context);
    std::vector<std::array<float, 4>> pixels(std::size_t{state.size.width} * state.size.height);
    const std::size_t bytes = pixels.size() * sizeof(pixels[0]);
    Result<Buffer> buffer =
        createBuffer(state.context, pool, bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT, MemoryUse::Readback);
    if (!buffer) {
        return buffer.error();
    }
    Result<VkCommandBuffer> commands = runner.begin();
    if (!commands) {
        return commands.error();
    }
    recordCopy(state, *commands, binding, *buffer);
    if (Status status = runner.submitAndWait(); !status) {
        return status.error();
    }
    std::memcpy(pixels.data(), buffer->mapped, bytes);
    return pixels;
}

Result<std::vector<PixelPath>> Renderer::readCoverage() {
    if (!state_->recorded) {
        return makeError("frame-not-recorded", "", "no frame has been recorded",
                         "record a frame, submit it and wait for it first");
    }
    Result<CommandRunner> runner = CommandRunner::create(state_->context);
    if (!runner) {
        return runner.error();
    }
    const auto reflection = readFrameImage(*state_, *runner, gpu::kBindingReflection);
    if (!reflection) {
        return reflection.error();
    }
    const auto ray = readFrameImage(*state_, *runner, gpu::kBindingReflectionRay);
    if (!ray) {
        return ray.error();
    }
    std::vector<PixelPath> paths(reflection->size());
    std::ranges::transform(*reflection, *ray, paths.begin(),
                           [](const auto& found, const auto& sent) { return pathOf(found[3], sent[3]); });
    return paths;
}

}  // namespace glint
