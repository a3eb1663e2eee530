#include "context/context.h"
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

Result<std::vector<std::uint8_t>> Context::pipelineCacheData() const {
    const DeviceTable& vk = state_->vk;
    const VkDevice device = state_->handles.device;
    std::vector<std::uint8_t> data;
    VkResult result = VK_INCOMPLETE;
    // Other threads may add to the cache between the two calls.
    while (result == VK_INCOMPLETE) {
        std::size_t bytes = 0;
        result = vk.GetPipelineCacheData(device, state_->pipelineCache, &bytes, nullptr);
        if (result == VK_SUCCESS) {
            data.resize(bytes);
            result = vk.GetPipelineCacheData(device, state_->pipelineCache, &bytes, data.data());
            data.resize(bytes);
        }
    }
    if (result != VK_SUCCESS) {
        return vulkanError("vkGetPipelineCacheData", result);
    }
    return wrapPipelineCache(state_->limits.cacheOwner, data);
}

Status Context::addPipelineCache(std::span<const std::uint8_t> data) {
    GLINT_TRY(const auto known, unwrapPipelineCache(state_->limits.cacheOwner, data));
    const DeviceTable& vk = state_->vk;
    const VkDevice device = state_->handles.device;
    VkPipelineCacheCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO;
    info.initialDataSize = known.size();
    info.pInitialData = known.data();
    VkPipelineCache added = VK_NULL_HANDLE;
    VkResult result = vk.CreatePipelineCache(device, &info, nullptr, &added);
    if (result != VK_SUCCESS) {
        return vulkanError("vkCreatePipelineCache", result);
    }
    // The existing cache is merged into the added one, which is usually larger.
    result = vk.MergePipelineCaches(device, added, 1, &state_->pipelineCache);
    if (result != VK_SUCCESS) {
        vk.DestroyPipelineCache(device, added, nullptr);
        return vulkanError("vkMergePipelineCaches", result);
    }
    vk.DestroyPipelineCache(device, state_->pipelineCache, nullptr);
    state_->pipelineCache = added;
    return okStatus();
}

std::string Context::pipelineCacheName() const {
    return nameOf(state_->limits.cacheOwner);
}

}  // namespace glint
