// An instance and a device that the test owns, as a host application would.
#pragma once

#include "context/vulkan_table.h"

#include <glint/context.h>

#include <memory>
#include <string>
#include <vector>

namespace glint::test {

// Uses the validation layer and collects its messages, if the layer is installed.
class HostDevice {
public:
    HostDevice() = default;
    ~HostDevice() {
        destroy();
    }
    HostDevice(const HostDevice&) = delete;
    HostDevice& operator=(const HostDevice&) = delete;

    // Creates the device with these tracers (package::Tracer bits) enabled. Returns false if no device has
    // what Glint requires.
    bool create(std::uint32_t tracers = package::kTracerRayQuery);
    void destroy();

    const DeviceHandles& handles() const {
        return handles_;
    }
    const std::vector<std::string>& messages() const {
        return messages_;
    }

private:
    bool createInstance();
    bool createDevice();

    std::shared_ptr<VulkanLibrary> library_;
    InstanceTable instance_;
    DeviceTable device_;
    DeviceHandles handles_;
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
    std::vector<std::string> messages_;
};

}  // namespace glint::test
