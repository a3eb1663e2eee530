// Filters for a picture after its last sample, such as a denoiser. The tool has no filter of its own:
// programs pass theirs to a bench.
#pragma once

#include <glint/context.h>
#include <glint/renderer.h>
#include <glint/result.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace glint::measure {

// Filters the pictures of one renderer.
class PictureFilter {
public:
    PictureFilter() = default;
    virtual ~PictureFilter() = default;
    PictureFilter(const PictureFilter&) = delete;
    PictureFilter& operator=(const PictureFilter&) = delete;

    // Filters the renderer's last picture, with the history that it keeps of earlier ones.
    virtual Result<LinearImage> filter() = 0;
    // Device time of the last filter(), milliseconds.
    virtual double milliseconds() const = 0;
    // Forgets the earlier pictures.
    virtual void restart() = 0;
};

struct FilterMaker {
    std::vector<std::string> layers;       // layers that a package needs
    std::vector<std::string> imageLayers;  // layers that are read if an effect of the package has them
    // Makes the filter of a renderer with pictures of that size, which have `samples` samples a pixel.
    std::function<Result<std::unique_ptr<PictureFilter>>(const Context& context, const Renderer& renderer,
                                                         std::uint32_t width, std::uint32_t height,
                                                         std::uint32_t samples)>
        make;
};

}  // namespace glint::measure
