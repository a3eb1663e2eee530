// Light from all directions around a scene. It is an equirectangular map of radiance, filtered for diffuse
// and for rough surfaces.
#pragma once

#include <glint/context.h>
#include <glint/image.h>
#include <glint/result.h>

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <memory>

namespace glint {

// Environments may be made and destroyed on any thread. An environment is made once. The frames of any number
// of renderers can share it, and it may be destroyed before they are. The Context must outlive it.
class Environment {
public:
    struct Options {
        // Packages whose sky is a light (Package::skyLight()) need the distribution of the map's light, which
        // takes up to 2 MiB on the device.
        bool sampled = false;
    };

    // Filters the image on the host, and records the upload of the result. Nothing waits for the device. The
    // requirements of `commands` and `frame`, and when the environment may be used and destroyed, are as in
    // GpuScene::record(). `image` holds radiance in the units of the lights: red, green and blue in linear
    // Rec. 709. Alpha is not read. The first row is up (+Y). The middle of the image faces +X, and +Z is a
    // quarter of the width to the right of it, as in the Khronos viewers. Any size and aspect ratio is
    // allowed, since the whole image covers the whole sphere. Negative channels count as 0. Errors:
    // "environment-size" for an image without pixels; "environment-radiance", with the pixel, for NaN,
    // infinity and anything above 1e18.
    static Result<std::unique_ptr<Environment>> record(Context& context, const LinearImage& image,
                                                       const Options& options, VkCommandBuffer commands,
                                                       std::uint64_t frame);
    // Says that the device has completed all commands of frames up to `frame`, and frees the staging memory.
    void complete(std::uint64_t frame);
    // Records the same into a command buffer of its own, submits it to DeviceHandles::queue under
    // HostServices::lockQueue, and waits for the device.
    static Result<std::unique_ptr<Environment>> create(Context& context, const LinearImage& image,
                                                       const Options& options);
    ~Environment();
    Environment(const Environment&) = delete;
    Environment& operator=(const Environment&) = delete;

    // The map with its sampler, for a host that binds it for RaySteps: a combined image sampler.
    VkDescriptorImageInfo image() const;

    struct Statistics {
        // The size of the map on the device, which mirrors and the background show. It is between 256 x 128
        // and 2048 x 1024. Images outside of that range are resampled, which keeps their light.
        std::uint32_t width = 0;
        std::uint32_t height = 0;
        std::uint32_t levels = 0;          // levels of roughness, the map itself included
        std::uint64_t negativePixels = 0;  // pixels with a channel below 0
        // True if texels have 16 bits a channel because this device can't filter 32-bit images.
        bool halfFloat = false;
        bool sampled = false;   // as Options::sampled
        double filterMs = 0.0;  // host time
    };
    const Statistics& statistics() const;

    struct State;  // for the runtime's own sources
    const std::shared_ptr<const State>& state() const {
        return state_;
    }

private:
    explicit Environment(std::shared_ptr<const State> state);
    std::shared_ptr<const State> state_;
    struct Upload;
    std::unique_ptr<Upload> upload_;  // null when the device has completed it
};

}  // namespace glint
