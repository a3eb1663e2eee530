// The images and buffers of a frame, and descriptor set 1.
#pragma once

#include "context/resources.h"
#include "interop/frame.h"
#include "sky/environment.h"

#include <glint/internal/package_format.h>
#include <glint/internal/package_modules.h>
#include <glint/layers.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace glint {

inline constexpr VkFormat kSurfaceFormat = VK_FORMAT_R32G32_UINT;
inline constexpr VkFormat kDepthFormat = VK_FORMAT_D32_SFLOAT;
inline constexpr VkFormat kLightFormat = VK_FORMAT_R32G32B32A32_SFLOAT;
inline constexpr VkFormat kHalfLightFormat = VK_FORMAT_R16G16B16A16_SFLOAT;

// The layout of the data that counters() reads: the counters first, then for each band the buckets of its
// first hits, then for each round of rays the counters of its lists and its buckets.
inline constexpr VkDeviceSize kRoundCounterBytes = 2 * sizeof(std::uint32_t);

// Members are destroyed in reverse order: the pool's memory last. Resources that the frame's effects do not
// need have no handle.
struct FrameResources {
    explicit FrameResources(Context::State& context) : pool(context, "frame") {}

    MemoryPool pool;
    // The images by binding, in the layout GENERAL. Bindings that share an image have it in one place
    // (imageOf()).
    std::array<DeviceImage, gpu::kFrameImageCount> images;
    std::vector<DeviceImage> layers;  // FrameSize::layers; layout GENERAL
    // Buffers may lie in its memory, so each frame gives it the layout DEPTH_ATTACHMENT_OPTIMAL anew.
    DeviceImage depth;
    Buffer constants;  // FrameConstants; every pass reads them, so this is not host memory
    // These and the following buffers serve all effects with rays. They have room for the samples of a band.
    Buffer sampleStarts;
    Buffer sampleAims;
    Buffer sampleWeights;  // present if samples are not packed
    Buffer listed;         // the list of rays: the numbers of their samples
    Buffer radiance;       // present if paths have several bounces, unless a host has the answers
    Buffer nextListed;     // this buffer and the next are present if paths have several bounces
    Buffer paths;
    Buffer lobeRays;     // present if the package has emissive lights, and Glint chooses rays
    Buffer skyShares;    // present if the sky is a light of the package
    Buffer rayHits;      // present if layers need the hits of rays
    Buffer bounceLight;  // present if layers need the light of bounces
    Buffer walkedLight;  // present if layers need the lights that walks find
    Buffer hits;         // full or packed records; present if hits are ordered and samples don't hold them
    Buffer orderedHits;  // the numbers of first hits or of `hits`, in the order of the buckets
    Buffer visitedHits;  // one bit for each hit; present if the order is checked
    Buffer shadows;      // present if shadow rays are deferred, of first hits or of hits of rays
    Buffer shadowDispatch;
    Buffer firstShadowCounts;  // present if shadow rays of first hits are deferred
    Buffer bucketKeys;         // one key for each hit; ends at a whole tile
    Buffer bucketCounts;
    Buffer bucketBegins;
    Buffer bucketCursors;
    Buffer rayDispatch;
    Buffer bucketDispatch;
    Buffer counters;
    Buffer readback;
    UniqueSetLayout setLayout;
    DescriptorSet set;
    bool prepared = false;  // by prepareImages()
};

struct FrameSize {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::uint32_t bucketCount = 0;
    package::EffectSet effects;
    // The number of samples of a pixel, and how many of them have their rays in the list at once.
    std::uint32_t sampleCount = 0;
    std::uint32_t batchCount = 0;
    bool ordered = false;  // hits of rays are stored and ordered by bucket
    bool checksOrder = false;
    std::uint32_t bucketAlignment = 1;
    bool packedSamples = false;                       // those of a host's rays never are
    std::uint32_t hitBytes = sizeof(gpu::HitRecord);  // 0: the samples hold their hits
    std::uint32_t keyBytes = 1;                       // size of the key of a hit's bucket
    bool deferredShadows = false;
    std::uint32_t lightSamples = 0;     // lights that a surface chooses by the hierarchy; 0: all
    std::uint32_t firstShadowRays = 0;  // of a round
    // Bytes of a shadow ray of a first hit that waits in memory; 0: such rays are traced inline.
    std::uint32_t firstShadowBytes = 0;
    bool environmentMap = false;
    std::uint32_t textureLevels = 0;  // textures whose finest level is noted
    bool hostRays = false;            // the host owns the list of rays and their results
    bool rayPipeline = false;         // a ray tracing pipeline dispatches lists as rays

    bool paths = false;  // the package's shaders keep the state of paths
    bool emissiveLights = false;
    bool skyLight = false;
    bool sizedLights = false;   // walks write into the image of light that leaves primary surfaces
    std::uint32_t bounces = 1;  // the most of a path

    std::vector<package::PackageLayer> layers{};  // images beside the picture
    bool layerRays = false;                       // layers need the hits of rays
    std::uint32_t layerBounces = 0;               // bounces that have layers of their own
    bool layerWalks = false;                      // layers need the lights that walks find

    bool accumulates = true;     // the picture is a mean over frames
    bool halfPicture = false;    // the picture has 16-bit floats; it is no mean then
    bool marchesScreen = false;  // frames may look for the ends of rays in screen space
    // The frame is lit in bands of that many rows, one after the other; 0 if it is lit as a whole.
    std::uint32_t bandRows = 0;

    std::uint32_t rowsOfBand() const {
        return bandRows > 0 ? bandRows : height;
    }
    std::uint32_t bandCount() const {
        return (height + rowsOfBand() - 1) / rowsOfBand();
    }
    // The pixels that samples have memory for.
    VkDeviceSize pixelsOfBand() const {
        return VkDeviceSize{width} * rowsOfBand();
    }

    // The length of a band's list of first hits: its pixels, in whole tiles (first/first_list.glsl). A host
    // sees its first hits itself.
    VkDeviceSize firstHits() const {
        const auto tiles = [](std::uint32_t pixels) {
            return VkDeviceSize{(pixels + gpu::kPixelGroupSize - 1) / gpu::kPixelGroupSize};
        };
        return hostRays ? 0
                        : tiles(width) * tiles(rowsOfBand()) * gpu::kPixelGroupSize * gpu::kPixelGroupSize;
    }

    // The number of lists of rays in a frame: one for each bounce of each round of effects of each band.
    std::uint32_t roundCount() const {
        return batchCount > 0 ? sampleCount / batchCount * bounces * bandCount() : 0;
    }
};

// Returns the size of a hit's key. It agrees with order/bucket_key.glsl.
inline std::uint32_t keyBytesOf(std::uint32_t bucketCount) {
    return bucketCount <= 0x100 ? 1 : bucketCount <= 0x10000 ? 2 : 4;
}

// Returns the size of the counters.
VkDeviceSize counterBytes(const FrameSize& size);

// Returns the size of the counts of all buckets.
VkDeviceSize bucketBytes(const FrameSize& size);
// Returns the offset at which the buckets of a band's first hits are read back. For the number of bands it
// returns the end.
VkDeviceSize readbackFirst(const FrameSize& size, std::uint32_t band);
// Returns the offset at which a round of rays is read back. For the number of rounds it returns the end.
VkDeviceSize readbackRound(const FrameSize& size, std::uint32_t round);

// Returns the offset at which the depth of a recording's paths is read back (BounceLevels). Packages without
// paths have none.
VkDeviceSize readbackDepth(const FrameSize& size, std::uint32_t slot);

// Returns the largest number of rays in the list: one for each pixel of a band and effect of a round.
VkDeviceSize listRays(const FrameSize& size);

// Error "render-size": the frame has no pixels, or more than the device supports.
Status checkFrameSize(const Context::State& context, const FrameSize& size);

// Returns the number of elements of a list of hits in order, where each bucket may leave all but one slot of
// its last group empty. `hits` is the length of the list before.
VkDeviceSize orderedSlots(const FrameSize& size, VkDeviceSize hits);
// Returns that of the longest list.
VkDeviceSize listSlots(const FrameSize& size);

// Returns the largest number of rays that one dispatch of a list can have.
std::uint64_t maxRayDispatch(const DeviceLimits& limits);

// Returns the format of a layer's images.
VkFormat vulkanFormat(package::LayerInfo::Format format);

// Returns the image that a binding leads to: its own, or that of the picture. Frames that do not accumulate
// write the light of the primary surfaces there, and compose() adds to it.
const DeviceImage& imageOf(const FrameResources& frame, std::uint32_t binding);

// Makes the layout of set 1, which follows from the package alone. Error "vulkan-call".
Result<UniqueSetLayout> createFrameSetLayout(Context::State& context, const FrameSize& size);

// Makes all resources, or with FrameSize::hostRays the lists and counters alone. The first commands that use
// the images must come after those of prepareImages().
Status createFrameResources(Context::State& context, const FrameSize& size, FrameResources& frame);

// Before the first frame moves the images into the layouts that they keep, and clears them to black.
void prepareImages(Context::State& context, VkCommandBuffer commands, FrameResources& frame);

// Buffers for frames of another size in memory, which replace those that have another size now.
struct NextBuffers {
    struct Exchange {
        Buffer FrameResources::*member = nullptr;
        Buffer buffer;  // without a handle if the frame no longer needs it
    };
    std::vector<Exchange> exchanges;
    std::uint32_t kept = 0;  // buffers that stay
    std::uint32_t made = 0;
};

// Returns the bytes of the images that keep what they hold: all but the depth. Pure.
VkDeviceSize imageBytes(const FrameSize& size);

// Returns the bytes of the images and buffers of a frame of that size, without the padding that a device adds
// to images. Pure.
VkDeviceSize frameBytes(const FrameSize& size);

// Returns whether frames of both sizes have the same images and the same layout of set 1.
bool haveSameImages(const FrameSize& first, const FrameSize& second);

// Makes the buffers that frames of the size `next` need and frames of the size `now` lack, in memory of their
// own, so that another thread may destroy them. Errors: those of buffers.
Result<NextBuffers> createNextBuffers(Context::State& context, const FrameSize& now, const FrameSize& next);

// Returns the buffers that were exchanged, which commands in flight may still use.
std::vector<Buffer> replaceBuffers(NextBuffers&& next, FrameResources& frame);

// Returns all buffers, with names for reports.
std::vector<std::pair<const char*, const Buffer*>> buffersOf(const FrameResources& frame,
                                                             const FrameSize& size);

// Returns the size of the memory of all images and buffers.
VkDeviceSize allocatedBytes(const FrameResources& frame, const FrameSize& size);

// Makes a set 1 of the frame's images and, with FrameSize::environmentMap, of an environment, which may be
// null until a frame needs it. Errors: "vulkan-call".
Result<DescriptorSet> createFrameSet(Context::State& context, const FrameSize& size,
                                     const FrameResources& frame, const Environment::State* environment);

}  // namespace glint
