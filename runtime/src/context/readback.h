// Reads images and buffers of a frame back to the host.
#pragma once

#include "renderer/renderer_state.h"

#include <array>
#include <cstdint>
#include <vector>

namespace glint {

// Reads one of the rgba32f images, given by its binding, row by row from the top. Waits for the device.
Result<std::vector<std::array<float, 4>>> readFrameImage(Renderer::State& state, CommandRunner& runner,
                                                         std::uint32_t binding);

// Reads a whole buffer of the frame. Waits for the device.
Result<std::vector<std::uint8_t>> readFrameBuffer(Renderer::State& state, CommandRunner& runner,
                                                  const Buffer& buffer);

// Makes the error "frame-not-recorded".
Diagnostic frameNotRecorded();

}  // namespace glint
