#include "context/memory_items.h"
#include "frame/motion_history.h"
#include "renderer/renderer_state.h"

#include <iterator>
#include <string_view>

namespace glint {

namespace {

// Names of the images by binding.
constexpr std::string_view kImageNames[] = {"surface", "radiance", "accumulated", "residual", "position"};
static_assert(std::size(kImageNames) == gpu::kFrameImageCount);

}  // namespace

std::vector<MemoryItem> Renderer::memory() const {
    std::vector<MemoryItem> items;
    const FrameResources& frame = state_->frame;
    for (std::size_t binding = 0; binding < frame.images.size(); ++binding) {
        addTo(items, std::string(kImageNames[binding]), frame.images[binding]);
    }
    for (std::size_t i = 0; i < frame.layers.size(); ++i) {
        addTo(items, "layer " + state_->size.layers[i].name, frame.layers[i]);
    }
    // Memory that buffers share with the depth image counts as the buffers' memory.
    VkDeviceSize shared = 0;
    for (const auto& [name, buffer] : frame.buffers()) {
        const bool shares =
            buffer->handle.get() != VK_NULL_HANDLE && buffer->memory.memory == frame.depth.memory.memory;
        shared += shares ? buffer->bytes : 0;
    }
    if (frame.depth.handle.get() != VK_NULL_HANDLE) {
        addTo(items, {"depth", MemoryUse::Device, true, 1, frame.depth.bytes - shared});
    }
    for (const auto& [name, buffer] : frame.buffers()) {
        addTo(items, name, *buffer);
    }
    if (state_->history != nullptr) {
        state_->history->addMemory(items);
    }
    for (const Buffer& table : state_->pipelines.tables) {
        addTo(items, "shader binding tables", table);
    }
    return items;
}

Renderer::Footprint Renderer::footprint() const {
    Footprint footprint;
    footprint.pipelines = static_cast<std::uint32_t>(state_->pipelines.owned.size());
    for (const MemoryItem& item : memory()) {
        (item.isImage ? footprint.images : footprint.buffers) += item.count;
        footprint.bytes += item.bytes;
    }
    footprint.allocatedBytes = (state_->history != nullptr ? state_->history->allocatedBytes() : 0) +
                               glint::allocatedBytes(state_->frame) + state_->pipelines.pool.bytes();
    return footprint;
}

}  // namespace glint
