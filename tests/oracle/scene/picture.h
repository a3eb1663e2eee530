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

// As the device sees it.
View viewOf(const CameraView& camera, std::uint32_t width, std::uint32_t height);

// Of the rays through the pixels' centres, on which a first sample lies. These take all cores.
Picture centrePicture(const SceneRenderer& renderer, const View& view);
// Means over the pixels by points at random.
Picture meanPicture(const SceneRenderer& renderer, const View& view, const Strata& strata);

// Means over `count` points of each pixel, those that a device's samples have: 1/g and 1/g², g³ = g + 1, from
// the centre on (Roberts, "The Unreasonable Effectiveness of Quasirandom Sequences", 2018). Where light peaks
// within a pixel both then see the same of it.
Picture samplePicture(const SceneRenderer& renderer, const View& view, std::uint32_t count);

LinearImage toImage(const Picture& picture);

// Calls `row` for each of `count` rows, on all cores.
void forRows(std::uint32_t count, const std::function<void(std::uint32_t)>& row);

}  // namespace glint::oracle
