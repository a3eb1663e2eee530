#include "render/order_buffers.h"

#include "render/order_problems.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>
#include <vector>

namespace glint::testing {

namespace {

constexpr VkDeviceSize kOrderBuffersWord = sizeof(std::uint32_t);

std::vector<std::uint8_t> hitBytes(const OrderProblem& problem, package::HitRecordFormat format) {
    const bool packed = format == package::HitRecordFormat::Packed;
    const std::size_t stride = packed ? sizeof(gpu::PackedHitRecord) : sizeof(gpu::HitRecord);
    std::vector<std::uint8_t> bytes(stride * problem.hits.size());
    for (std::size_t i = 0; i < problem.hits.size(); ++i) {
        const std::uint32_t geometry = problem.hits[i];
        if (packed) {
            gpu::PackedHitRecord record{};
            // The width of the cone must not affect the bucket.
            record.geometry24_coneLog8 =
                geometry == gpu::kMissGeometry ? geometry : geometry << 8U | static_cast<std::uint8_t>(i);
            std::memcpy(&bytes[i * stride], &record, stride);
        } else {
            gpu::HitRecord record{};
            record.geometry = geometry;
            std::memcpy(&bytes[i * stride], &record, stride);
        }
    }
    return bytes;
}

// Returns the keys as the trace pass leaves them, followed by bytes that tile-sort may read.
std::vector<std::uint8_t> keyBytes(const OrderProblem& problem, std::uint32_t bucketCount) {
    const std::size_t stride = bucketCount <= 0x100 ? 1 : bucketCount <= 0x10000 ? 2 : 4;
    const std::size_t keys =
        problem.hits.size() + std::size_t{gpu::kLargeTileThreads} * gpu::kTileHitsOfThread;
    std::vector<std::uint8_t> bytes(keys * stride, 0xFF);
    for (std::size_t i = 0; i < problem.hits.size(); ++i) {
        const std::uint32_t bucket = bucketOf(problem, i, bucketCount);
        for (std::size_t byte = 0; byte < stride; ++byte) {
            bytes[i * stride + byte] = static_cast<std::uint8_t>(bucket >> 8 * byte);
        }
    }
    return bytes;
}

std::vector<gpu::GeometryRecord> geometryRecords(const OrderProblem& problem) {
    std::vector<gpu::GeometryRecord> records(problem.shaderIds.size());
    for (std::size_t i = 0; i < records.size(); ++i) {
        records[i].shaderId = problem.shaderIds[i];
    }
    return records;
}

struct Copy {
    const Buffer& from;
    VkDeviceSize fromOffset;
    const Buffer& to;
    VkDeviceSize toOffset;
    VkDeviceSize bytes;
};

void recordCopy(const Context::State& context, VkCommandBuffer commands, const Copy& copy) {
    if (copy.bytes > 0) {
        const VkBufferCopy region{copy.fromOffset, copy.toOffset, copy.bytes};
        context.vk.CmdCopyBuffer(commands, copy.from.handle.get(), copy.to.handle.get(), 1, &region);
    }
}

}  // namespace

Result<std::unique_ptr<OrderBuffers>> createOrderBuffers(Context::State& context, const OrderProblem& problem,
                                                         std::uint32_t bucketCount,
                                                         package::HitRecordFormat hitRecord, bool withHits) {
    constexpr VkBufferUsageFlags kStorage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    constexpr VkBufferUsageFlags kCopied =
        kStorage | VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    constexpr VkBufferUsageFlags kIndirect = kCopied | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT;
    auto made = std::make_unique<OrderBuffers>(context);
    OrderBuffers& buffers = *made;
    const std::vector<std::uint8_t> keys = keyBytes(problem, bucketCount);
    const std::vector<std::uint8_t> hits =
        withHits ? hitBytes(problem, hitRecord) : std::vector<std::uint8_t>{};
    const std::vector<gpu::GeometryRecord> geometries = geometryRecords(problem);
    const VkDeviceSize geometryBytes = geometries.size() * sizeof(gpu::GeometryRecord);
    buffers.rays = static_cast<std::uint32_t>(problem.hits.size());
    const VkDeviceSize slotBytes =
        std::max<VkDeviceSize>(problem.hits.size() + VkDeviceSize{bucketCount} * (problem.alignment - 1), 1) *
        kOrderBuffersWord;
    const VkDeviceSize bucketBytes = VkDeviceSize{bucketCount} * kOrderBuffersWord;
    const VkDeviceSize dispatchBytes = (VkDeviceSize{bucketCount} + 1) * sizeof(gpu::DispatchArguments);
    constexpr VkDeviceSize kCounterBytes = gpu::kCounterEffects * kOrderBuffersWord;
    const struct {
        Buffer& target;
        VkDeviceSize bytes;
        VkBufferUsageFlags usage;
        MemoryUse use;
    } wanted[] = {
        {buffers.constants, sizeof(gpu::FrameConstants), kCopied, MemoryUse::Device},
        {buffers.staged, keys.size() + hits.size() + geometryBytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
         MemoryUse::Upload},
        {buffers.keys, keys.size(), kCopied, MemoryUse::Device},
        {buffers.hits, hits.size(), kCopied, MemoryUse::Device},
        {buffers.geometries, geometryBytes, kCopied, MemoryUse::Device},
        {buffers.slots, slotBytes, kCopied, MemoryUse::Device},
        {buffers.visited, (problem.hits.size() / 32 + 1) * kOrderBuffersWord, kCopied, MemoryUse::Device},
        {buffers.counts, bucketBytes, kCopied, MemoryUse::Device},
        {buffers.begins, bucketBytes, kCopied, MemoryUse::Device},
        {buffers.cursors, bucketBytes, kCopied, MemoryUse::Device},
        {buffers.rayDispatch, sizeof(gpu::DispatchArguments), kIndirect, MemoryUse::Device},
        {buffers.bucketDispatch, dispatchBytes, kIndirect, MemoryUse::Device},
        {buffers.counters, kCounterBytes, kCopied, MemoryUse::Device},
        {buffers.readback, 3 * bucketBytes + dispatchBytes + kCounterBytes + slotBytes,
         VK_BUFFER_USAGE_TRANSFER_DST_BIT, MemoryUse::Readback},
    };
    for (const auto& entry : wanted) {
        if (entry.bytes == 0) {
            continue;
        }
        GLINT_TRY(entry.target, createBuffer(context, buffers.pool, entry.bytes, entry.usage, entry.use));
    }
    std::uint8_t* staged = std::copy(keys.begin(), keys.end(), buffers.staged.mapped);
    staged = std::copy(hits.begin(), hits.end(), staged);
    if (!geometries.empty()) {
        std::memcpy(staged, geometries.data(), geometryBytes);
    }
    gpu::FrameConstants constants{};
    constants.bucketCount = bucketCount;
    constants.bucketAlignment = problem.alignment;
    constants.geometries = buffers.geometries.address;
    constants.hits = buffers.hits.address;
    constants.packedHits = buffers.hits.address;
    constants.orderedHits = buffers.slots.address;
    constants.visitedHits = buffers.visited.address;
    constants.bucketKeys = buffers.keys.address;
    constants.bucketCounts = buffers.counts.address;
    constants.bucketBegins = buffers.begins.address;
    constants.bucketCursors = buffers.cursors.address;
    constants.rayDispatch = buffers.rayDispatch.address;
    constants.bucketDispatch = buffers.bucketDispatch.address;
    constants.counters = buffers.counters.address;
    buffers.values = constants;
    return made;
}

void recordInput(Context::State& context, VkCommandBuffer commands, const OrderBuffers& buffers) {
    const DeviceTable& vk = context.vk;
    VkDeviceSize offset = 0;
    for (const Buffer* const to : {&buffers.keys, &buffers.hits, &buffers.geometries}) {
        recordCopy(context, commands, {buffers.staged, offset, *to, 0, to->bytes});
        offset += to->bytes;
    }
    vk.CmdUpdateBuffer(commands, buffers.constants.handle.get(), 0, sizeof(buffers.values), &buffers.values);
    vk.CmdFillBuffer(commands, buffers.visited.handle.get(), 0, VK_WHOLE_SIZE, 0);
    // A fill makes visible which words nobody writes.
    for (const Buffer* const buffer : {&buffers.slots, &buffers.begins, &buffers.bucketDispatch}) {
        vk.CmdFillBuffer(commands, buffer->handle.get(), 0, VK_WHOLE_SIZE, gpu::kNoHit - 1);
    }
    // The fills are adjacent, because two fills of one word would need a barrier in between.
    static_assert(gpu::kCounterRays == 0);
    vk.CmdFillBuffer(commands, buffers.counters.handle.get(), 0, kOrderBuffersWord, buffers.rays);
    vk.CmdFillBuffer(commands, buffers.counters.handle.get(), kOrderBuffersWord, VK_WHOLE_SIZE, 0);
    recordDependency(context, commands, kEverything);
}

// Copies in the order in which readResult() reads.
void recordOutput(Context::State& context, VkCommandBuffer commands, const OrderBuffers& buffers) {
    VkDeviceSize offset = 0;
    for (const Buffer* const from : {&buffers.counters, &buffers.counts, &buffers.begins, &buffers.cursors,
                                     &buffers.bucketDispatch, &buffers.slots}) {
        recordCopy(context, commands, {*from, 0, buffers.readback, offset, from->bytes});
        offset += from->bytes;
    }
    recordDependency(context, commands,
                     {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                      VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT});
}

OrderResult readResult(const OrderBuffers& buffers) {
    const std::size_t bucketCount = buffers.values.bucketCount;
    OrderResult result;
    std::array<std::uint32_t, gpu::kCounterEffects> counters{};
    result.counts.resize(bucketCount);
    result.begins.resize(bucketCount);
    result.cursors.resize(bucketCount);
    result.dispatches.resize(bucketCount + 1);
    result.slots.resize(buffers.slots.bytes / kOrderBuffersWord);
    const std::uint8_t* from = buffers.readback.mapped;
    const auto take = [&](auto& values) {
        const std::size_t bytes = values.size() * sizeof(values[0]);
        std::memcpy(values.data(), from, bytes);
        from += bytes;
    };
    take(counters);
    take(result.counts);
    take(result.begins);
    take(result.cursors);
    take(result.dispatches);
    take(result.slots);
    result.errors = counters[gpu::kCounterOrderErrors];
    return result;
}

}  // namespace glint::testing
