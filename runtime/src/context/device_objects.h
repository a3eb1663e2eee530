// Types that own device objects, layouts of descriptor sets and pipelines, and sets with a pool of their own.
#pragma once

#include "context/context.h"
#include "context/vulkan_table.h"

#include <glint/result.h>

#include <span>
#include <utility>

namespace glint {

// A device object that the function `Destroy` of the table destroys. The Context must outlive it.
template <typename Handle, auto Destroy>
class DeviceHandle {
public:
    DeviceHandle() = default;
    DeviceHandle(Context::State& context, Handle handle) : context_(&context), handle_(handle) {}
    ~DeviceHandle() {
        reset();
    }
    DeviceHandle(DeviceHandle&& other) noexcept
        : context_(other.context_), handle_(std::exchange(other.handle_, VK_NULL_HANDLE)) {}
    DeviceHandle& operator=(DeviceHandle&& other) noexcept {
        if (this != &other) {
            reset();
            context_ = other.context_;
            handle_ = std::exchange(other.handle_, VK_NULL_HANDLE);
        }
        return *this;
    }
    DeviceHandle(const DeviceHandle&) = delete;
    DeviceHandle& operator=(const DeviceHandle&) = delete;

    Handle get() const {
        return handle_;
    }

private:
    void reset() {
        if (handle_ != VK_NULL_HANDLE) {
            (context_->vk.*Destroy)(context_->handles.device, handle_, nullptr);
            handle_ = VK_NULL_HANDLE;
        }
    }

    Context::State* context_ = nullptr;
    Handle handle_ = VK_NULL_HANDLE;
};

// Makes a device object with a function of the table that creates one, such as `context.vk.CreateSampler`.
// `name` is that function's name in Vulkan, for the error.
template <typename Unique, typename Info, typename Handle>
Result<Unique> createHandle(Context::State& context,
                            VkResult(VKAPI_PTR* create)(VkDevice, const Info*, const VkAllocationCallbacks*,
                                                        Handle*),
                            const char* name, const Info& info) {
    Handle handle = VK_NULL_HANDLE;
    const VkResult result = create(context.handles.device, &info, nullptr, &handle);
    if (result != VK_SUCCESS) {
        return vulkanError(name, result);
    }
    return Unique(context, handle);
}

using UniqueBuffer = DeviceHandle<VkBuffer, &DeviceTable::DestroyBuffer>;
using UniqueImage = DeviceHandle<VkImage, &DeviceTable::DestroyImage>;
using UniqueImageView = DeviceHandle<VkImageView, &DeviceTable::DestroyImageView>;
using UniqueSampler = DeviceHandle<VkSampler, &DeviceTable::DestroySampler>;
using UniqueMemory = DeviceHandle<VkDeviceMemory, &DeviceTable::FreeMemory>;
using UniqueSetLayout = DeviceHandle<VkDescriptorSetLayout, &DeviceTable::DestroyDescriptorSetLayout>;
using UniqueDescriptorPool = DeviceHandle<VkDescriptorPool, &DeviceTable::DestroyDescriptorPool>;
using UniqueShaderModule = DeviceHandle<VkShaderModule, &DeviceTable::DestroyShaderModule>;
using UniquePipelineLayout = DeviceHandle<VkPipelineLayout, &DeviceTable::DestroyPipelineLayout>;
using UniquePipeline = DeviceHandle<VkPipeline, &DeviceTable::DestroyPipeline>;
using UniqueCommandPool = DeviceHandle<VkCommandPool, &DeviceTable::DestroyCommandPool>;
using UniqueFence = DeviceHandle<VkFence, &DeviceTable::DestroyFence>;
using UniqueQueryPool = DeviceHandle<VkQueryPool, &DeviceTable::DestroyQueryPool>;
using UniqueAccelerationStructure =
    DeviceHandle<VkAccelerationStructureKHR, &DeviceTable::DestroyAccelerationStructureKHR>;
using UniqueMicromap = DeviceHandle<VkMicromapEXT, &DeviceTable::DestroyMicromapEXT>;

// `flags` are those of each binding, or empty. Errors: "vulkan-call".
Result<UniqueSetLayout> createSetLayout(Context::State& context,
                                        std::span<const VkDescriptorSetLayoutBinding> bindings,
                                        std::span<const VkDescriptorBindingFlags> flags = {});

struct DescriptorSet {
    UniqueDescriptorPool pool;
    VkDescriptorSet set = VK_NULL_HANDLE;
};

// Makes a pool that has exactly one set. With `updates` the set may be written after it is bound. Errors:
// "vulkan-call".
Result<DescriptorSet> createSet(Context::State& context, VkDescriptorSetLayout layout,
                                std::span<const VkDescriptorSetLayoutBinding> bindings, bool updates);

// Errors: "vulkan-call".
Result<UniquePipelineLayout> createPipelineLayout(Context::State& context,
                                                  std::span<const VkDescriptorSetLayout> sets,
                                                  const VkPushConstantRange& range);

}  // namespace glint
