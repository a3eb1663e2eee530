// Images and buffers of a frame, back to the host.
#pragma once

#include "renderer_state.h"

#include <array>
#include <cstdint>
#include <vector>

namespace glint {

// One of the rgba32f images, by binding; row by row from the top. Waits for the device.
Result<std::vector<std::array<float, 4>>> readFrameImage(Renderer::State& state, CommandRunner& runner,
                                                         std::uint32_t binding);

// A buffer of the frame whole. Waits for the device.
Result<std::vector<std::uint8_t>> readFrameBuffer(Renderer::State& state, CommandRunner& runner,
                                                  const Buffer& buffer);

// Error "frame-not-recorded".
Diagnostic frameNotRecorded();

}  // namespace glint
