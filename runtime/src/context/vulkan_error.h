// Turns Vulkan's result codes into diagnostics.
#pragma once

#include <glint/result.h>

#include <vulkan/vulkan_core.h>

namespace glint {

// Returns a name such as "VK_ERROR_DEVICE_LOST", or "VkResult -1234" for a code that this version does not
// know.
std::string vulkanResultName(VkResult result);

// Makes the error "vulkan-call", which says which call failed and how.
Diagnostic vulkanError(const char* call, VkResult result);

}  // namespace glint
