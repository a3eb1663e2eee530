// A denoiser of a host's own. It reads the layers of a renderer and nothing else of it.
#pragma once

#include <glint/context.h>
#include <glint/renderer.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace denoise {

// Writes a message to stderr and ends the program with 1.
[[noreturn]] void fail(const std::string& message);

// The layers that a package needs for the filter: `glint compile --layers` takes them, separated by commas.
std::vector<std::string> wantedLayers();

struct FilterSettings {
    float alpha = 0.2F;              // least weight of a new frame: the paper's, for motion and light
    std::uint32_t samples = 1;       // of a pixel in a frame
    std::uint32_t wavelets = 5;      // passes, each with twice the stride
    std::uint32_t historyAfter = 1;  // the pass whose result the next frame continues with
};

// Filters the light of each source by itself: the direct light and that of every effect. Vulkan's objects are
// the host's; the renderer must outlive this.
class Denoiser {
public:
    // `shaders` is the folder of this example's compiled shaders. Ends the program if a layer or a file is
    // missing.
    Denoiser(const glint::DeviceHandles& device, const glint::Renderer& renderer, std::uint32_t width,
             std::uint32_t height, const std::filesystem::path& shaders, FilterSettings settings = {});
    ~Denoiser();
    Denoiser(const Denoiser&) = delete;
    Denoiser& operator=(const Denoiser&) = delete;

    // Records the filter after the last sample of a frame.
    void record(VkCommandBuffer commands);
    // Forgets the frames before.
    void restart();

    // The picture: RGBA, 32-bit float, in the layout GENERAL. A compute shader writes it last.
    VkImage output() const;
    // The size of all images of the filter, bytes.
    std::uint64_t bytes() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace denoise
