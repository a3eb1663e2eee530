// Whole pictures of the scene renderer.
#pragma once

#include "oracle/quadrature.h"
#include "oracle/scene/renderer.h"
#include "oracle/view.h"

#include <glint/renderer.h>
#include <glint/scene_view.h>

#include <cstdint>
#include <functional>
#include <vector>

namespace glint::oracle {

struct Pixel {
    Vec3 mean{0.0};
    Vec3 error{0.0};     // standard error of the mean
    Vec3 variance{0.0};  // of one sample of a renderer at a random place of the pixel
};

// Row by row from the top.
struct Picture {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<Pixel> pixels;

    const Pixel& at(std::uint32_t x, std::uint32_t y) const {
        return pixels[static_cast<std::size_t>(y) * width + x];
    }
};

// Returns the view as the device sees it.
View viewOf(const CameraView& camera, std::uint32_t width, std::uint32_t height);

// Renders the rays through the pixels' centres, where a first sample lies. This function and the next ones
// use all cores.
Picture centrePicture(const SceneRenderer& renderer, const View& view);
// Renders means over the pixels with random points.
Picture meanPicture(const SceneRenderer& renderer, const View& view, const Strata& strata);

// Renders means over `count` points of each pixel, the same points that the device's samples have: 1/g and
// 1/g², g³ = g + 1, from the centre on (Roberts, "The Unreasonable Effectiveness of Quasirandom Sequences",
// 2018). If light peaks within a pixel, both then see the same part of the peak.
Picture samplePicture(const SceneRenderer& renderer, const View& view, std::uint32_t count);

LinearImage toImage(const Picture& picture);

// Calls `row` for each of `count` rows, on all cores or that many threads.
void forRows(std::uint32_t count, const std::function<void(std::uint32_t)>& row, std::uint32_t threads = 0);

}  // namespace glint::oracle
