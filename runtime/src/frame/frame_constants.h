// Fills FrameConstants: the camera, the light from outside, the lists of the frame.
#pragma once

#include "frame/frame_resources.h"
#include "interop/frame.h"
#include "sky/environment.h"

#include <glint/renderer_options.h>
#include <glint/result.h>
#include <glint/scene_view.h>

#include <array>
#include <cstdint>

namespace glint {

// Error "camera": a value is not finite, the view has no extent, or the planes make no range.
Status checkCamera(const CameraView& camera);

// Returns the offset of a sample from its pixel's centre, in pixels. It is 0 for sample 0 and then follows
// Roberts' R2 sequence ("The Unreasonable Effectiveness of Quasirandom Sequences", 2018) in [-0.5, 0.5). A
// seed other than 0 starts the sequence elsewhere: it shifts all of it, with wrap-around (Cranley and
// Patterson 1976).
gpu::vec2 sampleJitter(std::uint32_t sampleIndex, std::uint32_t seed = 0);

// Returns the width of the cone that stands for one of `averagedSamples` samples of a pixel, as a share of
// the pixel's cone. It is 1 / sqrt(n), so that n cones together cover the pixel's area once. In mip levels
// that is a bias of -0.5 log2(n). A number of 0 counts as 1.
float sampleConeScale(std::uint32_t averagedSamples);

// Fills worldToClip, the fields from position to pixelWidth and the unit of lengths, for an image of width x
// height pixels. The constants are relative to the scene's `origin` (SceneView::origin). The
// ray of pixel (x, y) goes through the point p = (2 (x + 0.5 + jitter.x) / width - 1, 1 - 2 (y + 0.5 +
// jitter.y) / height) of the view. Points that worldToClip takes to that pixel's centre lie on this ray.
void fillCamera(const CameraView& camera, const std::array<double, 3>& origin, std::uint32_t width,
                std::uint32_t height, gpu::vec2 jitter, gpu::FrameConstants& constants);

// The light from outside of the scene.
struct Outside {
    const SkyView& sky;
    const Environment* environment = nullptr;
    float rotation = 0.0F;
    float intensity = 1.0F;
};

// Errors: "sky", "environment-missing", "environment-unread", "frame-options".
Status checkOutside(const FrameSize& size, const Outside& outside);
void fillOutside(const Outside& outside, gpu::FrameConstants& constants);

// Sets the addresses of the frame's own lists, and the description of their buckets.
void fillLists(const FrameResources& frame, const FrameSize& size, gpu::FrameConstants& constants);

// Sets the rows of a band.
void setBand(const FrameSize& size, std::uint32_t band, gpu::FrameConstants& constants);

}  // namespace glint
