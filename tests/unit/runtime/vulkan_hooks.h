// Watches a Context's calls of Vulkan, and lets some of them fail.
#pragma once

#include "context/context.h"

#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <set>
#include <shared_mutex>
#include <string>
#include <thread>
#include <type_traits>
#include <utility>

namespace glint::test {

// Replaces the functions in the table of a context as long as it lives. There is one at a time.
class VulkanHooks {
public:
    explicit VulkanHooks(Context& context);
    ~VulkanHooks();
    VulkanHooks(const VulkanHooks&) = delete;
    VulkanHooks& operator=(const VulkanHooks&) = delete;

    // The call that fails with `failure`, by its number from 1 among those that return a VkResult, or among
    // those of the function `failing`. 0: none does. A lost device stays lost for all functions.
    std::uint64_t failAt = 0;
    std::string failing;
    VkResult failure = VK_ERROR_DEVICE_LOST;
    bool failsOn = false;  // all calls after it fail, too
    std::uint64_t struck = 0;
    std::uint64_t calls = 0;  // that could fail

    // What bypasses the services of a caller, if these are set.
    const VkAllocationCallbacks* allocation = nullptr;
    VkPipelineCache pipelineCache = VK_NULL_HANDLE;
    std::string namePrefix;
    std::function<bool()> isLocked;             // the queue
    std::set<std::thread::id> pipelineThreads;  // that may make and destroy pipelines
    std::multiset<std::string> bypasses;        // the functions that did

    std::map<std::string, std::uint64_t> callsOf;
    std::set<std::string> canFail;
    // The handles of objects that were made, with the functions that made them, and of those that were named.
    std::map<std::uint64_t, std::string> made;
    std::set<std::uint64_t> named;

    // Whether the calling thread is in a function of Vulkan.
    static thread_local int depth;

    const DeviceTable& real() const {
        return real_;
    }

private:
    template <auto Member, typename R, typename... A>
    void install(R (VKAPI_PTR* DeviceTable::* /*member*/)(A...), const char* name);
    template <auto Member, typename R, typename... A>
    static R VKAPI_PTR hooked(A... arguments);
    template <auto Member>
    static inline const char* nameOf = "";

    template <typename A>
    void look(const std::string& name, A argument);
    // Returns the error of the call, or VK_SUCCESS.
    VkResult strike(const std::string& name);

    static VulkanHooks* current_;
    // Calls of threads that outlive the hooks end before these do, and those that come after go past them.
    static std::shared_mutex inside_;
    static DeviceTable last_;
    Context& context_;
    DeviceTable real_;
    std::recursive_mutex mutex_;
};

}  // namespace glint::test
