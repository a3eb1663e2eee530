// Buffers, commands and results of an OrderKernel.
#include "context_state.h"
#include "render/order_kernel.h"
#include "resources.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace glint::testing {

namespace {

using package::ModuleRole;

// Stretches of the timer.
constexpr std::uint32_t kCountTime = 0;
constexpr std::uint32_t kOffsetTime = 1;
constexpr std::uint32_t kCopyTime = 2;

// Workgroups of the check: it takes any number.
constexpr std::uint32_t kCheckGroups = 64;

constexpr MemoryDependency kEverything{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT,
                                       VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                       VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT};

std::vector<std::uint8_t> hitBytes(const OrderProblem& problem, package::HitRecordFormat format) {
    const bool packed = format == package::HitRecordFormat::Packed;
    const std::size_t stride = packed ? sizeof(gpu::PackedHitRecord) : sizeof(gpu::HitRecord);
    std::vector<std::uint8_t> bytes(stride * problem.hits.size());
    for (std::size_t i = 0; i < problem.hits.size(); ++i) {
        const std::uint32_t geometry = problem.hits[i];
        if (packed) {
            gpu::PackedHitRecord record{};
            // The width of the cone is not of the bucket's business.
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

std::vector<gpu::GeometryRecord> geometryRecords(const OrderProblem& problem) {
    std::vector<gpu::GeometryRecord> records(problem.shaderIds.size());
    for (std::size_t i = 0; i < records.size(); ++i) {
        records[i].shaderId = problem.shaderIds[i];
    }
    return records;
}

}  // namespace

struct OrderKernel::Buffers {
    explicit Buffers(Context::State& context) : pool(context) {}

    MemoryPool pool;
    Buffer constants;
    Buffer staged;  // hits, then geometries
    Buffer hits;
    Buffer geometries;
    Buffer slots;
    Buffer visited;
    Buffer buckets;
    Buffer rayDispatch;
    Buffer bucketDispatch;
    Buffer counters;
    Buffer readback;
    VkDeviceSize hitBytes = 0;
    VkDeviceSize geometryBytes = 0;
    std::uint32_t rays = 0;
};

Status OrderKernel::createBuffers(const OrderProblem& problem, Buffers& buffers) const {
    constexpr VkBufferUsageFlags kStorage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    constexpr VkBufferUsageFlags kCopied =
        kStorage | VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    constexpr VkBufferUsageFlags kIndirect = kCopied | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT;
    const std::vector<std::uint8_t> hits = hitBytes(problem, hitRecord_);
    const std::vector<gpu::GeometryRecord> geometries = geometryRecords(problem);
    buffers.rays = static_cast<std::uint32_t>(problem.hits.size());
    buffers.hitBytes = hits.size();
    buffers.geometryBytes = geometries.size() * sizeof(gpu::GeometryRecord);
    const VkDeviceSize bucketCount = caseCount_ + 1;
    const VkDeviceSize slotBytes =
        std::max<VkDeviceSize>(problem.hits.size() + bucketCount * (problem.alignment - 1), 1) *
        sizeof(std::uint32_t);
    const VkDeviceSize bucketBytes = bucketCount * sizeof(gpu::BucketRecord);
    const VkDeviceSize dispatchBytes = (bucketCount + 1) * sizeof(gpu::DispatchArguments);
    constexpr VkDeviceSize kCounterBytes = gpu::kCounterCount * sizeof(std::uint32_t);
    const struct {
        Buffer& target;
        VkDeviceSize bytes;
        VkBufferUsageFlags usage;
        MemoryUse use;
    } wanted[] = {
        {buffers.constants, sizeof(gpu::FrameConstants), kStorage, MemoryUse::Upload},
        {buffers.staged, buffers.hitBytes + buffers.geometryBytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
         MemoryUse::Upload},
        {buffers.hits, buffers.hitBytes, kCopied, MemoryUse::Device},
        {buffers.geometries, buffers.geometryBytes, kCopied, MemoryUse::Device},
        {buffers.slots, slotBytes, kCopied, MemoryUse::Device},
        {buffers.visited, (problem.hits.size() / 32 + 1) * sizeof(std::uint32_t), kCopied, MemoryUse::Device},
        {buffers.buckets, bucketBytes, kCopied, MemoryUse::Device},
        {buffers.rayDispatch, sizeof(gpu::DispatchArguments), kIndirect, MemoryUse::Device},
        {buffers.bucketDispatch, dispatchBytes, kIndirect, MemoryUse::Device},
        {buffers.counters, kCounterBytes, kCopied, MemoryUse::Device},
        {buffers.readback, bucketBytes + dispatchBytes + kCounterBytes + slotBytes,
         VK_BUFFER_USAGE_TRANSFER_DST_BIT, MemoryUse::Readback},
    };
    for (const auto& entry : wanted) {
        Result<Buffer> buffer = createBuffer(context_, buffers.pool, entry.bytes, entry.usage, entry.use);
        if (!buffer) {
            return buffer.error();
        }
        entry.target = std::move(*buffer);
    }
    std::copy(hits.begin(), hits.end(), buffers.staged.mapped);
    if (!geometries.empty()) {
        std::memcpy(buffers.staged.mapped + hits.size(), geometries.data(), buffers.geometryBytes);
    }
    gpu::FrameConstants constants{};
    constants.bucketCount = caseCount_ + 1;
    constants.bucketAlignment = problem.alignment;
    constants.geometries = buffers.geometries.address;
    constants.hits = buffers.hits.address;
    constants.packedHits = buffers.hits.address;
    constants.orderedHits = buffers.slots.address;
    constants.visitedHits = buffers.visited.address;
    constants.buckets = buffers.buckets.address;
    constants.rayDispatch = buffers.rayDispatch.address;
    constants.bucketDispatch = buffers.bucketDispatch.address;
    constants.counters = buffers.counters.address;
    std::memcpy(buffers.constants.mapped, &constants, sizeof(constants));
    return okStatus();
}

void OrderKernel::bind(VkCommandBuffer commands, package::ModuleKey key) const {
    context_.vk.CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipelines_.at(key).get());
}

void OrderKernel::recordPasses(VkCommandBuffer commands, package::Ordering ordering, const Buffers& buffers,
                               std::span<const OrderFault> faults) const {
    const DeviceTable& vk = context_.vk;
    const auto index = static_cast<std::uint32_t>(ordering);
    const auto wait = [&] { recordDependency(context_, commands, kEverything); };
    gpu::PushConstants pushed{};
    pushed.frame = buffers.constants.address;
    vk.CmdPushConstants(commands, layout_.get(), VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(pushed), &pushed);
    timer_->recordReset(commands);
    bind(commands, {ModuleRole::RayDispatch});
    vk.CmdDispatch(commands, 1, 1, 1);
    wait();
    timer_->recordBegin(commands, kCountTime);
    bind(commands, {ModuleRole::BucketCount, index});
    vk.CmdDispatchIndirect(commands, buffers.rayDispatch.handle.get(), 0);
    timer_->recordEnd(commands, kCountTime);
    wait();
    timer_->recordBegin(commands, kOffsetTime);
    bind(commands, {ModuleRole::BucketOffset});
    vk.CmdDispatch(commands, 1, 1, 1);
    timer_->recordEnd(commands, kOffsetTime);
    wait();
    timer_->recordBegin(commands, kCopyTime);
    bind(commands, {ModuleRole::BucketCopy, index});
    vk.CmdDispatchIndirect(commands, buffers.rayDispatch.handle.get(), 0);
    timer_->recordEnd(commands, kCopyTime);
    wait();
    for (const OrderFault& fault : faults) {
        const Buffer& target = fault.where == OrderFault::Where::Slots ? buffers.slots : buffers.buckets;
        vk.CmdFillBuffer(commands, target.handle.get(), fault.word * sizeof(std::uint32_t),
                         sizeof(std::uint32_t), fault.value);
        wait();
    }
    bind(commands, {ModuleRole::OrderCheck});
    vk.CmdDispatch(commands, kCheckGroups, 1, 1);
    wait();
}

namespace {

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

void OrderKernel::recordInput(VkCommandBuffer commands, const Buffers& buffers) const {
    const DeviceTable& vk = context_.vk;
    recordCopy(context_, commands, {buffers.staged, 0, buffers.hits, 0, buffers.hitBytes});
    recordCopy(context_, commands,
               {buffers.staged, buffers.hitBytes, buffers.geometries, 0, buffers.geometryBytes});
    vk.CmdFillBuffer(commands, buffers.buckets.handle.get(), 0, VK_WHOLE_SIZE, 0);
    vk.CmdFillBuffer(commands, buffers.visited.handle.get(), 0, VK_WHOLE_SIZE, 0);
    vk.CmdFillBuffer(commands, buffers.slots.handle.get(), 0, VK_WHOLE_SIZE, gpu::kNoHit);
    // Side by side: two fills of one word would need a barrier in between.
    static_assert(gpu::kCounterRays == 0);
    constexpr VkDeviceSize kWord = sizeof(std::uint32_t);
    vk.CmdFillBuffer(commands, buffers.counters.handle.get(), 0, kWord, buffers.rays);
    vk.CmdFillBuffer(commands, buffers.counters.handle.get(), kWord, VK_WHOLE_SIZE, 0);
    recordDependency(context_, commands, kEverything);
}

// In the order in which readResult() takes them.
void OrderKernel::recordOutput(VkCommandBuffer commands, const Buffers& buffers) const {
    VkDeviceSize offset = 0;
    for (const Buffer* const from :
         {&buffers.counters, &buffers.buckets, &buffers.bucketDispatch, &buffers.slots}) {
        recordCopy(context_, commands, {*from, 0, buffers.readback, offset, from->bytes});
        offset += from->bytes;
    }
    recordDependency(context_, commands,
                     {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                      VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT});
}

OrderResult OrderKernel::readResult(const Buffers& buffers) const {
    OrderResult result;
    std::array<std::uint32_t, gpu::kCounterCount> counters{};
    result.buckets.resize(caseCount_ + 1);
    result.dispatches.resize(caseCount_ + 2);
    result.slots.resize(buffers.slots.bytes / sizeof(std::uint32_t));
    const std::uint8_t* from = buffers.readback.mapped;
    const auto take = [&](auto& values) {
        const std::size_t bytes = values.size() * sizeof(values[0]);
        std::memcpy(values.data(), from, bytes);
        from += bytes;
    };
    take(counters);
    take(result.buckets);
    take(result.dispatches);
    take(result.slots);
    result.errors = counters[gpu::kCounterOrderErrors];
    return result;
}

OrderKernel::OrderKernel(Context::State& context, std::uint32_t caseCount, package::HitRecordFormat hitRecord)
    : context_(context), caseCount_(caseCount), hitRecord_(hitRecord) {}

OrderKernel::~OrderKernel() = default;

Status OrderKernel::load(const OrderProblem& problem) {
    buffers_ = std::make_unique<Buffers>(context_);
    return createBuffers(problem, *buffers_);
}

Result<OrderResult> OrderKernel::run(package::Ordering ordering, std::span<const OrderFault> faults) {
    Result<VkCommandBuffer> commands = runner_->begin();
    if (!commands) {
        return commands.error();
    }
    recordInput(*commands, *buffers_);
    recordPasses(*commands, ordering, *buffers_, faults);
    recordOutput(*commands, *buffers_);
    if (Status status = runner_->submitAndWait(); !status) {
        return status.error();
    }
    OrderResult result = readResult(*buffers_);
    if (timer_->available()) {
        const Result<std::vector<double>> times = timer_->read(kTimes);
        if (!times) {
            return times.error();
        }
        result.countMs = (*times)[kCountTime];
        result.offsetMs = (*times)[kOffsetTime];
        result.copyMs = (*times)[kCopyTime];
    }
    return result;
}

}  // namespace glint::testing
