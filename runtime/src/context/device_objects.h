// Types that own device objects, layouts of descriptor sets and pipelines, and sets with a pool of their own.
#pragma once

#include "context/context.h"
#include "context/vulkan_table.h"

#include <glint/result.h>

#include <cstdint>
#include <span>
#include <string_view>
#include <utility>

namespace glint {

// Names an object of Vulkan for debuggers, with DeviceHandles::debugUtils. Requires no lock.
void nameObject(const Context::State& context, VkObjectType type, std::uint64_t handle,
                std::string_view name);

// A device object that the function `Destroy` of the table destroys. The Context must outlive it.
template <typename Handle, auto Destroy, VkObjectType Type>
class DeviceHandle {
public:
    static constexpr VkObjectType kType = Type;
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
            (context_->vk.*Destroy)(context_->handles.device, handle_, context_->services.allocation);
            handle_ = VK_NULL_HANDLE;
        }
    }

    Context::State* context_ = nullptr;
    Handle handle_ = VK_NULL_HANDLE;
};

// Makes a device object with a function of the table that creates one, such as `context.vk.CreateSampler`.
// `call` is that function's name in Vulkan, for the error, and `name` the object's for debuggers.
template <typename Unique, typename Info, typename Handle>
Result<Unique> createHandle(Context::State& context,
                            VkResult(VKAPI_PTR* create)(VkDevice, const Info*, const VkAllocationCallbacks*,
                                                        Handle*),
                            const char* call, const Info& info, std::string_view name = {}) {
    Handle handle = VK_NULL_HANDLE;
    const VkResult result = create(context.handles.device, &info, context.services.allocation, &handle);
    if (result != VK_SUCCESS) {
        return vulkanError(call, result);
    }
    Unique made(context, handle);
    constexpr std::string_view kCreate = "vkCreate";
    nameObject(context, Unique::kType, (std::uint64_t)handle,  // NOLINT: a pointer, or a number
               name.empty() ? std::string_view(call).substr(kCreate.size()) : name);
    return made;
}

using UniqueBuffer = DeviceHandle<VkBuffer, &DeviceTable::DestroyBuffer, VK_OBJECT_TYPE_BUFFER>;
using UniqueImage = DeviceHandle<VkImage, &DeviceTable::DestroyImage, VK_OBJECT_TYPE_IMAGE>;
using UniqueImageView = DeviceHandle<VkImageView, &DeviceTable::DestroyImageView, VK_OBJECT_TYPE_IMAGE_VIEW>;
using UniqueSampler = DeviceHandle<VkSampler, &DeviceTable::DestroySampler, VK_OBJECT_TYPE_SAMPLER>;
using UniqueSetLayout = DeviceHandle<VkDescriptorSetLayout, &DeviceTable::DestroyDescriptorSetLayout,
                                     VK_OBJECT_TYPE_DESCRIPTOR_SET_LAYOUT>;
using UniqueDescriptorPool =
    DeviceHandle<VkDescriptorPool, &DeviceTable::DestroyDescriptorPool, VK_OBJECT_TYPE_DESCRIPTOR_POOL>;
using UniqueShaderModule =
    DeviceHandle<VkShaderModule, &DeviceTable::DestroyShaderModule, VK_OBJECT_TYPE_SHADER_MODULE>;
using UniquePipelineLayout =
    DeviceHandle<VkPipelineLayout, &DeviceTable::DestroyPipelineLayout, VK_OBJECT_TYPE_PIPELINE_LAYOUT>;
using UniquePipeline = DeviceHandle<VkPipeline, &DeviceTable::DestroyPipeline, VK_OBJECT_TYPE_PIPELINE>;
using UniqueCommandPool =
    DeviceHandle<VkCommandPool, &DeviceTable::DestroyCommandPool, VK_OBJECT_TYPE_COMMAND_POOL>;
using UniqueFence = DeviceHandle<VkFence, &DeviceTable::DestroyFence, VK_OBJECT_TYPE_FENCE>;
using UniqueQueryPool = DeviceHandle<VkQueryPool, &DeviceTable::DestroyQueryPool, VK_OBJECT_TYPE_QUERY_POOL>;
using UniqueAccelerationStructure =
    DeviceHandle<VkAccelerationStructureKHR, &DeviceTable::DestroyAccelerationStructureKHR,
                 VK_OBJECT_TYPE_ACCELERATION_STRUCTURE_KHR>;
using UniqueMicromap =
    DeviceHandle<VkMicromapEXT, &DeviceTable::DestroyMicromapEXT, VK_OBJECT_TYPE_MICROMAP_EXT>;

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

// Writes the images or samplers of a binding, from its first element on.
void writeImages(const Context::State& context, VkDescriptorSet set, std::uint32_t binding,
                 VkDescriptorType type, std::span<const VkDescriptorImageInfo> images);

// Errors: "vulkan-call".
Result<UniquePipelineLayout> createPipelineLayout(Context::State& context,
                                                  std::span<const VkDescriptorSetLayout> sets,
                                                  const VkPushConstantRange& range);

}  // namespace glint
