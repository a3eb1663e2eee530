// The parts of FrameConstants that all recordings share, and checks of their inputs.
#pragma once

#include "renderer/pass_state.h"
#include "sky/environment_state.h"

#include <glint/renderer_options.h>

namespace glint {

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
