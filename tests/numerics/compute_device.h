// A Vulkan device with compute shaders, even if it can't trace rays. Glint's own contexts do not create such
// devices.
#pragma once

#include "context/context.h"

#include <memory>
#include <string>

namespace glint::numerics {

// `deviceName` is a part of the wanted device's name; if it is empty, the first suitable device is used.
// There are no validation layers. 16-bit float arithmetic is enabled if the device has it
// (DeviceHandles::shaderFloat16). Everything of ray tracing is missing: its functions are null. Errors:
// "vulkan-loader", "device-missing", "device-features", "vulkan-call".
Result<std::unique_ptr<Context::State>> createComputeDevice(const std::string& deviceName);

}  // namespace glint::numerics
