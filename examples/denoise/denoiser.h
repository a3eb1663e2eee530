// A denoiser of a host's own. It reads the layers of a renderer and nothing else of it (docs/layers.md).
#pragma once

#include <glint/context.h>
#include <glint/renderer.h>
#include <glint/result.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace denoise {

// The layers that a package needs for the filter: `glint compile --layers` takes them, separated by commas.
std::vector<std::string> wantedLayers();

struct FilterSettings {
    // Least weight of a new frame. The paper's 0.2 suits frames of one sample and lights that change; the
    // mean of more frames has less noise.
    float alpha = 0.04F;
    std::uint32_t samples = 1;   // of a pixel in a frame
    std::uint32_t wavelets = 5;  // passes, each with twice the stride
    std::uint32_t historyAfter =
        1;  // passes until the result with which the next frame continues; at least 1
};

// Filters the light of each source by itself: the direct light and that of every effect. The renderer and the
// context must outlive this.
class Denoiser {
public:
    // The renderer's pictures have `width` * `height` pixels. Errors: "layer-missing" names a layer that the
    // package lacks; "vulkan-function" and "vulkan-call".
    static glint::Result<std::unique_ptr<Denoiser>> create(const glint::Context& context,
                                                           const glint::Renderer& renderer,
                                                           std::uint32_t width, std::uint32_t height,
                                                           const FilterSettings& settings = {});
    ~Denoiser();
    Denoiser(const Denoiser&) = delete;
    Denoiser& operator=(const Denoiser&) = delete;

    // Records the filter into a host's commands, after those of a frame's last sample.
    void record(VkCommandBuffer commands);
    // Forgets the frames before.
    void restart();
    // The picture: RGB, 32-bit float, in the layout GENERAL; its alpha counts frames. A compute shader
    // writes it last.
    VkImage output() const;

    // Filters the renderer's last picture, waits for the device and reads the result back: for tools. Error
    // "vulkan-call".
    glint::Result<glint::LinearImage> filter();
    // Device time of the last filter(), milliseconds, without reading back. 0 where the device counts none.
    double milliseconds() const;

    // The size of all images of the filter, bytes.
    std::uint64_t bytes() const;

private:
    struct State;
    explicit Denoiser(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace denoise
