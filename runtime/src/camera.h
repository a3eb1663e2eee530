// The camera as FrameConstants has it. Pure functions.
#pragma once

#include "interop/frame.h"

#include <glint/result.h>
#include <glint/scene_view.h>

#include <cstdint>

namespace glint {

// Error "camera": a value that is not finite, a view without extent, planes that do not make a range.
Status checkCamera(const CameraView& camera);

// Offset of a sample from its pixel's centre, in pixels: 0 for sample 0, then Roberts' R2 sequence ("The
// Unreasonable Effectiveness of Quasirandom Sequences", 2018) in [-0.5, 0.5). With a seed other than 0 the
// sequence starts elsewhere, by a shift of the whole that wraps around (Cranley and Patterson 1976).
gpu::vec2 sampleJitter(std::uint32_t sampleIndex, std::uint32_t seed = 0);

// Width of the cone that stands for one of `averagedSamples` samples of a pixel, as a share of the pixel's:
// 1 / sqrt(n), so that n cones together cover the pixel's area once. In mip levels that is a bias of
// -0.5 log2(n). A number of 0 counts as 1.
float sampleConeScale(std::uint32_t averagedSamples);

// Fills position to pixelWidth, and worldToClip, for an image of width x height pixels. The ray of pixel
// (x, y) goes through p = (2 (x + 0.5 + jitter.x) / width - 1, 1 - 2 (y + 0.5 + jitter.y) / height) of the
// view, and what worldToClip takes to that pixel's centre lies on it.
void fillCamera(const CameraView& camera, std::uint32_t width, std::uint32_t height, gpu::vec2 jitter,
                gpu::FrameConstants& constants);

}  // namespace glint
