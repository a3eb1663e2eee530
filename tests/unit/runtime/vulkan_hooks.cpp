#include "vulkan_hooks.h"

#include <string_view>
#include <tuple>

namespace glint::test {

VulkanHooks* VulkanHooks::current_ = nullptr;
DeviceTable VulkanHooks::last_;
std::shared_mutex VulkanHooks::inside_;
thread_local int VulkanHooks::depth = 0;

template <typename A>
void VulkanHooks::look(const std::string& name, A argument) {
    const bool pipelines = name.find("Pipelines") != std::string::npos || name == "vkDestroyPipeline";
    if constexpr (std::is_same_v<A, const VkAllocationCallbacks*>) {
        if (allocation != nullptr && argument != allocation) {
            bypasses.insert(name);
        }
        if (pipelines && !pipelineThreads.empty() && !pipelineThreads.contains(std::this_thread::get_id())) {
            bypasses.insert(name);
        }
    } else if constexpr (std::is_same_v<A, VkPipelineCache>) {
        if (pipelineCache != VK_NULL_HANDLE && argument != pipelineCache) {
            bypasses.insert(name);
        }
    } else if constexpr (std::is_same_v<A, const VkDebugUtilsObjectNameInfoEXT*>) {
        if (std::string_view(argument->pObjectName).starts_with(namePrefix)) {
            named.insert(argument->objectHandle);
        }
    } else if constexpr (std::is_same_v<A, const VkDebugUtilsLabelEXT*>) {
        if (!std::string_view(argument->pLabelName).starts_with(namePrefix)) {
            bypasses.insert(name);
        }
    }
    if constexpr (std::is_same_v<A, VkQueue>) {
        if (isLocked && !isLocked()) {
            bypasses.insert(name);
        }
    }
}

VkResult VulkanHooks::strike(const std::string& name) {
    canFail.insert(name);
    const bool isLost = struck > 0 && failure == VK_ERROR_DEVICE_LOST;
    if (!failing.empty() && name != failing && !isLost) {
        return VK_SUCCESS;
    }
    ++calls;
    if (failAt == 0 || calls < failAt || (calls > failAt && !failsOn)) {
        return VK_SUCCESS;
    }
    if (struck++ == 0 && failure == VK_ERROR_DEVICE_LOST) {
        // A lost device executes nothing more.
        real_.DeviceWaitIdle(context_.handles().device);
    }
    return failure;
}

template <auto Member, typename R, typename... A>
R VKAPI_PTR VulkanHooks::hooked(A... arguments) {
    struct Depth {
        Depth() {
            ++depth;
        }
        ~Depth() {
            --depth;
        }
    } within;
    const std::shared_lock inside(inside_);
    if (current_ == nullptr) {
        return (last_.*Member)(arguments...);
    }
    VulkanHooks& hooks = *current_;
    const std::string name = nameOf<Member>;
    {
        const std::lock_guard lock(hooks.mutex_);
        ++hooks.callsOf[name];
        (hooks.look(name, arguments), ...);
        if constexpr (std::is_same_v<R, VkResult>) {
            const VkResult failed = hooks.strike(name);
            if (failed != VK_SUCCESS) {
                return failed;
            }
        }
    }
    if constexpr (std::is_same_v<R, VkResult>) {
        const VkResult result = (hooks.real_.*Member)(arguments...);
        using Last = std::tuple_element_t<sizeof...(A) - 1, std::tuple<A...>>;
        if constexpr (std::is_pointer_v<Last>) {
            using Handle = std::remove_pointer_t<Last>;
            const bool makes = name.starts_with("vkCreate") || name.starts_with("vkAllocate");
            if constexpr (std::is_pointer_v<Handle> && !std::is_const_v<Handle>) {
                if (makes && result == VK_SUCCESS) {
                    const auto handle = reinterpret_cast<std::uint64_t>(
                        *std::get<sizeof...(A) - 1>(std::tuple(arguments...)));
                    const std::lock_guard lock(hooks.mutex_);
                    hooks.made[handle] = name;
                    hooks.named.erase(handle);
                }
            }
        }
        return result;
    } else {
        return (hooks.real_.*Member)(arguments...);
    }
}

template <auto Member, typename R, typename... A>
void VulkanHooks::install(R (VKAPI_PTR* DeviceTable::* /*member*/)(A...), const char* name) {
    nameOf<Member> = name;
    if (real_.*Member != nullptr) {
        context_.state().vk.*Member = &hooked<Member, R, A...>;
    }
}

VulkanHooks::VulkanHooks(Context& context) : context_(context), real_(context.state().vk) {
    {
        const std::lock_guard alone(inside_);
        current_ = this;
        last_ = real_;
    }
#define GLINT_HOOK(name) install<&DeviceTable::name>(&DeviceTable::name, "vk" #name);
    GLINT_DEVICE_FUNCTIONS(GLINT_HOOK)
    GLINT_RAY_PIPELINE_FUNCTIONS(GLINT_HOOK)
    GLINT_HOOK(SetDebugUtilsObjectNameEXT)
    GLINT_HOOK(CmdBeginDebugUtilsLabelEXT)
#undef GLINT_HOOK
}

VulkanHooks::~VulkanHooks() {
    const std::lock_guard alone(inside_);
    context_.state().vk = real_;
    current_ = nullptr;
}

}  // namespace glint::test
