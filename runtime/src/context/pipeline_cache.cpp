#include "context/context.h"
#include "context/device_objects.h"
#include "context/vulkan_table.h"

#include <xxhash.h>

#include <cstddef>
#include <cstring>

namespace glint {
namespace {

constexpr std::array<char, 8> kMagic{'G', 'l', 'i', 'n', 't', 'P', 'L', 'C'};
constexpr std::uint32_t kVersion = 1;

// The header is in the byte order of the machine, because the driver's data is valid on that machine only.
struct Header {
    std::array<char, 8> magic = kMagic;
    std::uint32_t version = kVersion;
    PipelineCacheOwner owner;
    std::uint32_t reserved = 0;
    std::uint64_t bytes = 0;     // size of the data, which follows
    std::uint64_t checksum = 0;  // of the header with a checksum of 0, and of the data
};
static_assert(sizeof(PipelineCacheOwner) == 4 * sizeof(std::uint32_t) + VK_UUID_SIZE);
static_assert(sizeof(Header) == 64 && offsetof(Header, bytes) == 48, "there would be padding to hash");

std::uint64_t checksum(Header header, std::span<const std::uint8_t> data) {
    header.checksum = 0;
    const std::uint64_t seed = XXH3_64bits(&header, sizeof(header));
    return XXH3_64bits_withSeed(data.data(), data.size(), seed);
}

Diagnostic refusal(const char* why) {
    return makeError("pipeline-cache", "", why, "delete it: pipelines are made without it");
}

// Compares the fields that the driver itself should check (Vulkan 1.3 specification, "Pipeline Cache
// Header").
bool isOf(const PipelineCacheOwner& owner, std::span<const std::uint8_t> data) {
    VkPipelineCacheHeaderVersionOne header{};
    if (data.size() < sizeof(header)) {
        return false;
    }
    std::memcpy(&header, data.data(), sizeof(header));
    return header.headerSize >= sizeof(header) && header.headerSize <= data.size() &&
           header.headerVersion == VK_PIPELINE_CACHE_HEADER_VERSION_ONE &&
           header.vendorID == owner.vendorId && header.deviceID == owner.deviceId &&
           std::memcmp(header.pipelineCacheUUID, owner.cacheUuid.data(), VK_UUID_SIZE) == 0;
}

void appendHex(std::string& text, std::uint64_t value, int digits) {
    constexpr char kDigits[] = "0123456789abcdef";
    for (int shift = 4 * (digits - 1); shift >= 0; shift -= 4) {
        text += kDigits[(value >> shift) & 0xFU];
    }
}

}  // namespace

std::string nameOf(const PipelineCacheOwner& owner) {
    std::string text;
    for (const std::uint32_t number : {owner.vendorId, owner.deviceId, owner.driverId, owner.driverVersion}) {
        appendHex(text, number, 8);
        text += '-';
    }
    for (const std::uint8_t byte : owner.cacheUuid) {
        appendHex(text, byte, 2);
    }
    return text;
}

std::vector<std::uint8_t> wrapPipelineCache(const PipelineCacheOwner& owner,
                                            std::span<const std::uint8_t> data) {
    Header header;
    header.owner = owner;
    header.bytes = data.size();
    header.checksum = checksum(header, data);
    std::vector<std::uint8_t> wrapped(sizeof(header) + data.size());
    std::memcpy(wrapped.data(), &header, sizeof(header));
    if (!data.empty()) {
        std::memcpy(wrapped.data() + sizeof(header), data.data(), data.size());
    }
    return wrapped;
}

Result<std::span<const std::uint8_t>> unwrapPipelineCache(const PipelineCacheOwner& owner,
                                                          std::span<const std::uint8_t> wrapped) {
    Header header;
    if (wrapped.size() < sizeof(header)) {
        return refusal("the pipeline cache is shorter than its header");
    }
    std::memcpy(&header, wrapped.data(), sizeof(header));
    if (header.magic != kMagic || header.version != kVersion) {
        return refusal("this is no pipeline cache of this version of Glint");
    }
    const std::span<const std::uint8_t> data = wrapped.subspan(sizeof(header));
    if (header.bytes != data.size() || header.checksum != checksum(header, data)) {
        return refusal("the pipeline cache is damaged");
    }
    if (header.owner != owner || !isOf(owner, data)) {
        return refusal("the pipeline cache is of another device or driver");
    }
    return data;
}

Result<VkPipelineCache> createPipelineCache(const Context::State& state, std::span<const std::uint8_t> data) {
    const VkPipelineCacheCreateInfo info{.sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO,
                                         .initialDataSize = data.size(),
                                         .pInitialData = data.data()};
    VkPipelineCache cache = VK_NULL_HANDLE;
    GLINT_TRY_DO(statusOf(
        "vkCreatePipelineCache",
        state.vk.CreatePipelineCache(state.handles.device, &info, state.services.allocation, &cache)));
    nameObject(state, VK_OBJECT_TYPE_PIPELINE_CACHE, (std::uint64_t)cache,  // NOLINT: pointer or number
               "pipeline cache");
    return cache;
}

namespace {

Result<std::vector<std::uint8_t>> readCache(const Context::State& state, VkPipelineCache cache) {
    std::vector<std::uint8_t> data;
    // Other threads may add to the cache meanwhile.
    GLINT_TRY_DO(listAll(
        "vkGetPipelineCacheData", data,
        [&](std::size_t* bytes, void* place) {
            return state.vk.GetPipelineCacheData(state.handles.device, cache, bytes, place);
        },
        std::uint8_t{0}, std::size_t{0}));
    return data;
}

// Makes a cache of the data and of everything that the context's caches have so far. Threads may use those
// meanwhile. Requires the lock of caches.
Result<VkPipelineCache> mergeCaches(const Context::State& state, std::span<const std::uint8_t> data) {
    GLINT_TRY(const auto merged, createPipelineCache(state, data));
    std::vector<VkPipelineCache> sources = state.replacedCaches;
    sources.push_back(state.pipelineCache);
    const VkResult result = state.vk.MergePipelineCaches(
        state.handles.device, merged, static_cast<std::uint32_t>(sources.size()), sources.data());
    if (result != VK_SUCCESS) {
        state.vk.DestroyPipelineCache(state.handles.device, merged, state.services.allocation);
        return vulkanError("vkMergePipelineCaches", result);
    }
    return merged;
}

}  // namespace

Result<std::vector<std::uint8_t>> Context::pipelineCacheData() const try {
    const std::lock_guard lock(state_->cacheMutex);
    Result<std::vector<std::uint8_t>> data = std::vector<std::uint8_t>();
    if (state_->replacedCaches.empty()) {
        data = readCache(*state_, state_->pipelineCache);
    } else {
        // Pipelines may have gone to a cache that was being replaced.
        GLINT_TRY(const auto merged, mergeCaches(*state_, {}));
        data = readCache(*state_, merged);
        state_->vk.DestroyPipelineCache(state_->handles.device, merged, state_->services.allocation);
    }
    if (!data) {
        return data.error();
    }
    return wrapPipelineCache(state_->limits.cacheOwner, *data);
}
GLINT_CATCH

Status Context::addPipelineCache(std::span<const std::uint8_t> data) try {
    GLINT_TRY(const auto known, unwrapPipelineCache(state_->limits.cacheOwner, data));
    if (state_->services.pipelineCache != VK_NULL_HANDLE) {
        return makeError("pipeline-cache", "", "the pipeline cache is the caller's own",
                         "create HostServices::pipelineCache with the data");
    }
    const std::lock_guard lock(state_->cacheMutex);
    state_->replacedCaches.reserve(state_->replacedCaches.size() + 1);
    GLINT_TRY(const auto merged, mergeCaches(*state_, known));
    state_->replacedCaches.push_back(state_->pipelineCache.exchange(merged));
    return okStatus();
}
GLINT_CATCH

std::string Context::pipelineCacheName() const {
    return nameOf(state_->limits.cacheOwner);
}

}  // namespace glint
