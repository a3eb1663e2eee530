// Light from all around a scene: an equirectangular map of radiance, filtered for diffuse and for rough
// surfaces.
#pragma once

#include <glint/context.h>
#include <glint/renderer.h>
#include <glint/result.h>

#include <cstdint>
#include <memory>

namespace glint {

// Made once, used by the frames of any number of renderers, and shared by them: it may go before they do. The
// Context must outlive it.
class Environment {
public:
    // Filters on the host and uploads; waits for the queue. `image` holds radiance in the units of the
    // lights, red, green and blue in linear Rec. 709; alpha is not read. Its first row is up (+Y); its middle
    // faces +X, and from there +Z is a quarter to the right, as in the Khronos viewers. Any size and aspect:
    // the whole image is the whole sphere. Negative channels count as 0. Errors: "environment-size" for an
    // image without pixels, "environment-radiance" for NaN, infinity, and anything above 1e18, with the
    // pixel.
    static Result<std::unique_ptr<Environment>> create(Context& context, const LinearImage& image);
    ~Environment();
    Environment(const Environment&) = delete;
    Environment& operator=(const Environment&) = delete;

    struct Statistics {
        // Of the map on the device, which mirrors and the background show: from 256 x 128 to 2048 x 1024.
        // Images outside of that are resampled; their light is kept.
        std::uint32_t width = 0;
        std::uint32_t height = 0;
        std::uint32_t levels = 0;          // by roughness, the map itself included
        std::uint64_t negativePixels = 0;  // with a channel below 0
        // Texels have 16 bits a channel, as this device filters no 32-bit images.
        bool halfFloat = false;
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
};

}  // namespace glint
