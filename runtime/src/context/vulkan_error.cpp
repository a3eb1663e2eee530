#include "context/vulkan_error.h"

#include <string>

namespace glint {

std::string vulkanResultName(VkResult result) {
    switch (result) {
#define GLINT_RESULT(name) \
    case name:             \
        return #name;
        GLINT_RESULT(VK_SUCCESS)
        GLINT_RESULT(VK_NOT_READY)
        GLINT_RESULT(VK_TIMEOUT)
        GLINT_RESULT(VK_INCOMPLETE)
        GLINT_RESULT(VK_ERROR_OUT_OF_HOST_MEMORY)
        GLINT_RESULT(VK_ERROR_OUT_OF_DEVICE_MEMORY)
        GLINT_RESULT(VK_ERROR_INITIALIZATION_FAILED)
        GLINT_RESULT(VK_ERROR_DEVICE_LOST)
        GLINT_RESULT(VK_ERROR_MEMORY_MAP_FAILED)
        GLINT_RESULT(VK_ERROR_LAYER_NOT_PRESENT)
        GLINT_RESULT(VK_ERROR_EXTENSION_NOT_PRESENT)
        GLINT_RESULT(VK_ERROR_FEATURE_NOT_PRESENT)
        GLINT_RESULT(VK_ERROR_INCOMPATIBLE_DRIVER)
        GLINT_RESULT(VK_ERROR_TOO_MANY_OBJECTS)
        GLINT_RESULT(VK_ERROR_FORMAT_NOT_SUPPORTED)
        GLINT_RESULT(VK_ERROR_FRAGMENTED_POOL)
        GLINT_RESULT(VK_ERROR_UNKNOWN)
        GLINT_RESULT(VK_ERROR_OUT_OF_POOL_MEMORY)
        GLINT_RESULT(VK_ERROR_INVALID_EXTERNAL_HANDLE)
        GLINT_RESULT(VK_ERROR_FRAGMENTATION)
        GLINT_RESULT(VK_ERROR_INVALID_OPAQUE_CAPTURE_ADDRESS)
        GLINT_RESULT(VK_ERROR_INVALID_SHADER_NV)
#undef GLINT_RESULT
        default:
            return "VkResult " + std::to_string(static_cast<int>(result));
    }
}

Diagnostic vulkanError(const char* call, VkResult result) {
    std::string hint;
    if (result == VK_ERROR_OUT_OF_DEVICE_MEMORY || result == VK_ERROR_OUT_OF_HOST_MEMORY) {
        hint = "use a smaller scene, smaller textures or a smaller image";
    } else if (result == VK_ERROR_DEVICE_LOST) {
        hint = "update the driver, or try again with validation on";
    }
    return makeError("vulkan-call", "", std::string(call) + " failed with " + vulkanResultName(result),
                     std::move(hint));
}

}  // namespace glint
