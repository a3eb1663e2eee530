// Images and buffers of a frame, and descriptor set 1.
#pragma once

#include "environment_state.h"
#include "interop/frame.h"
#include "resources.h"

#include <array>
#include <cstdint>
#include <utility>

namespace glint {

inline constexpr VkFormat kSurfaceFormat = VK_FORMAT_R32G32_UINT;
inline constexpr VkFormat kDepthFormat = VK_FORMAT_D32_SFLOAT;

// What counters() reads: the counters, then for each round of rays those of its lists, and its buckets.
inline constexpr VkDeviceSize kCounterBytes = sizeof(std::uint32_t) * gpu::kCounterCount;
inline constexpr VkDeviceSize kRoundCounterBytes = 2 * sizeof(std::uint32_t);

// Members are destroyed in reverse: the pool's memory last. What the frame's effects do not need has no
// handle.
struct FrameResources {
    explicit FrameResources(Context::State& context) : pool(context) {}

    MemoryPool pool;
    std::array<DeviceImage, gpu::kFrameImageCount> images;  // by binding; layout GENERAL from creation on
    DeviceImage depth;                                      // layout DEPTH_ATTACHMENT_OPTIMAL
    Buffer constants;  // FrameConstants: every pass reads it, so not host memory
    Buffer samples;    // of every effect with rays, as are the following
    Buffer radiance;
    Buffer rays;
    Buffer hits;         // full or packed; where hits are ordered
    Buffer orderedHits;  // likewise
    Buffer visitedHits;  // a bit a hit; where the order is checked
    Buffer shadows;      // where shadow rays are deferred
    Buffer shadowDispatch;
    Buffer bucketKeys;  // as hits; ends at a whole tile
    Buffer bucketCounts;
    Buffer bucketBegins;
    Buffer bucketCursors;
    Buffer rayDispatch;
    Buffer bucketDispatch;
    Buffer counters;
    Buffer readback;
    UniqueSetLayout setLayout;
    UniqueDescriptorPool descriptorPool;
    VkDescriptorSet set = VK_NULL_HANDLE;

    // All of them, with names for reports.
    std::array<std::pair<const char*, const Buffer*>, 17> buffers() const {
        return {{{"constants", &constants},
                 {"samples", &samples},
                 {"radiance of effects", &radiance},
                 {"rays", &rays},
                 {"hits", &hits},
                 {"ordered hits", &orderedHits},
                 {"visited hits", &visitedHits},
                 {"shadow rays", &shadows},
                 {"shadow dispatch", &shadowDispatch},
                 {"bucket keys", &bucketKeys},
                 {"bucket counts", &bucketCounts},
                 {"bucket begins", &bucketBegins},
                 {"bucket cursors", &bucketCursors},
                 {"ray dispatch", &rayDispatch},
                 {"bucket dispatch", &bucketDispatch},
                 {"counters", &counters},
                 {"read-back", &readback}}};
    }
};

struct FrameSize {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::uint32_t bucketCount = 0;
    std::uint32_t effects = 0;  // Effect bits
    // Samples of a pixel, and those of them whose rays are in the list at once.
    std::uint32_t sampleCount = 0;
    std::uint32_t batchCount = 0;
    bool ordered = false;  // hits are stored and ordered by bucket
    bool checksOrder = false;
    std::uint32_t bucketAlignment = 1;
    std::uint32_t hitBytes = sizeof(gpu::HitRecord);
    std::uint32_t keyBytes = 1;  // of a hit's bucket
    bool deferredShadows = false;
    bool environmentMap = false;
    bool rayPipeline = false;  // lists are dispatched as rays of a ray tracing pipeline

    std::uint32_t roundCount() const {
        return batchCount > 0 ? sampleCount / batchCount : 0;
    }
};

// Where a round of rays is read back; of the number of rounds, the end.
VkDeviceSize readbackRound(const FrameSize& size, std::uint32_t round);

// Rays of the list at most: one a pixel and effect of a round.
VkDeviceSize listRays(const FrameSize& size);

// Error "render-size": no pixels, or more than the device can do.
Status checkFrameSize(const Context::State& context, const FrameSize& size);

// Makes everything, clears the images and waits for the device.
Status createFrameResources(Context::State& context, const FrameSize& size, FrameResources& frame);

// Nothing that is recorded with the set may be in flight. Requires FrameSize::environmentMap.
void bindEnvironment(Context::State& context, const Environment::State& environment, FrameResources& frame);

}  // namespace glint
