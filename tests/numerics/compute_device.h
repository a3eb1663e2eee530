// A Vulkan device with compute shaders, whether or not it traces rays: what Glint's own contexts don't ask
// for.
#pragma once

#include "context_state.h"

#include <memory>
#include <string>

namespace glint::numerics {

// `deviceName`: part of the wanted device's name; empty: the first that will do. Without validation layers.
// 16-bit float arithmetic is enabled where there is any (DeviceHandles::shaderFloat16), everything of ray
// tracing is missing: its functions are null. Errors: "vulkan-loader", "device-missing", "device-features",
// "vulkan-call".
Result<std::unique_ptr<Context::State>> createComputeDevice(const std::string& deviceName);

}  // namespace glint::numerics
