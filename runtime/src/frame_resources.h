// Images and buffers of a frame, and descriptor set 1.
#pragma once

#include "environment_state.h"
#include "interop/frame.h"
#include "resources.h"

#include <array>
#include <cstdint>

namespace glint {

inline constexpr VkFormat kSurfaceFormat = VK_FORMAT_R32G32_UINT;
inline constexpr VkFormat kDepthFormat = VK_FORMAT_D32_SFLOAT;

// What counters() reads: the counters, then the buckets.
inline constexpr VkDeviceSize kReadbackBucketOffset = sizeof(std::uint32_t) * gpu::kCounterCount;

// Members are destroyed in reverse: the pool's memory last.
struct FrameResources {
    explicit FrameResources(Context::State& context) : pool(context) {}

    MemoryPool pool;
    std::array<DeviceImage, gpu::kFrameImageCount> images;  // by binding; layout GENERAL from creation on
    DeviceImage depth;                                      // layout DEPTH_ATTACHMENT_OPTIMAL
    Buffer constants;                                       // FrameConstants, host-visible
    Buffer rays;
    Buffer hits;         // full or packed; one element unless hits are ordered
    Buffer orderedHits;  // likewise
    Buffer visitedHits;  // a bit a hit; one element unless the order is checked
    Buffer shadows;      // one element unless shadow rays are deferred
    Buffer shadowDispatch;
    Buffer buckets;
    Buffer rayDispatch;
    Buffer bucketDispatch;
    Buffer counters;
    Buffer readback;
    UniqueSetLayout setLayout;
    UniqueDescriptorPool descriptorPool;
    VkDescriptorSet set = VK_NULL_HANDLE;
};

struct FrameSize {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::uint32_t bucketCount = 0;
    bool ordered = false;  // hits are stored and ordered by bucket
    bool checksOrder = false;
    std::uint32_t bucketAlignment = 1;
    std::uint32_t hitBytes = sizeof(gpu::HitRecord);
    bool deferredShadows = false;
    bool environmentMap = false;
    bool rayPipeline = false;  // lists are dispatched as rays of a ray tracing pipeline
};

// Error "render-size": no pixels, or more than the device can do.
Status checkFrameSize(const Context::State& context, const FrameSize& size);

// Makes everything, clears the images and waits for the device.
Status createFrameResources(Context::State& context, const FrameSize& size, FrameResources& frame);

// Nothing that is recorded with the set may be in flight. Requires FrameSize::environmentMap.
void bindEnvironment(Context::State& context, const Environment::State& environment, FrameResources& frame);

}  // namespace glint
