// Buffers, commands and results of an OrderKernel.
#include "context_state.h"
#include "render/order_kernel.h"
#include "render/order_problems.h"
#include "resources.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

namespace glint::testing {

namespace {

using package::ModuleRole;
using package::Ordering;

// Passes of an ordering.
constexpr std::uint32_t kCountPass = 0;
constexpr std::uint32_t kOffsetPass = 1;
constexpr std::uint32_t kCopyPass = 2;
constexpr std::uint32_t kPasses = 3;

// Workgroups of the check: it takes any number.
constexpr std::uint32_t kCheckGroups = 64;
constexpr VkDeviceSize kWord = sizeof(std::uint32_t);

constexpr MemoryDependency kEverything{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT,
                                       VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                       VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT};
// As between the passes of a frame.
constexpr MemoryDependency kPassToPass{
    VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_WRITE_BIT,
    VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT,
    VK_ACCESS_2_SHADER_READ_BIT | VK_ACCESS_2_SHADER_WRITE_BIT | VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT};

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

// As the trace pass leaves them, up to the end of the last tile.
std::vector<std::uint8_t> keyBytes(const OrderProblem& problem, std::uint32_t bucketCount) {
    const std::size_t stride = bucketCount <= 0x100 ? 1 : bucketCount <= 0x10000 ? 2 : 4;
    const std::size_t tiles = problem.hits.size() / gpu::kTileHits + 1;
    std::vector<std::uint8_t> bytes(tiles * gpu::kTileHits * stride, 0xFF);
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

struct OrderKernel::Buffers {
    explicit Buffers(Context::State& context) : pool(context) {}

    MemoryPool pool;
    Buffer constants;
    Buffer staged;  // keys, hits, geometries
    Buffer keys;
    Buffer hits;
    Buffer geometries;
    Buffer slots;
    Buffer visited;
    Buffer counts;
    Buffer begins;
    Buffer cursors;
    Buffer rayDispatch;
    Buffer bucketDispatch;
    Buffer counters;
    Buffer readback;
    gpu::FrameConstants values{};  // of the constants
    std::uint32_t rays = 0;
};

Result<std::unique_ptr<OrderKernel::Buffers>> OrderKernel::createBuffers(const OrderProblem& problem,
                                                                         bool withHits) const {
    constexpr VkBufferUsageFlags kStorage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    constexpr VkBufferUsageFlags kCopied =
        kStorage | VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    constexpr VkBufferUsageFlags kIndirect = kCopied | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT;
    auto made = std::make_unique<Buffers>(context_);
    Buffers& buffers = *made;
    const VkDeviceSize bucketCount = caseCount_ + 1;
    const std::vector<std::uint8_t> keys = keyBytes(problem, caseCount_ + 1);
    const std::vector<std::uint8_t> hits =
        withHits ? hitBytes(problem, hitRecord_) : std::vector<std::uint8_t>{};
    const std::vector<gpu::GeometryRecord> geometries = geometryRecords(problem);
    const VkDeviceSize geometryBytes = geometries.size() * sizeof(gpu::GeometryRecord);
    buffers.rays = static_cast<std::uint32_t>(problem.hits.size());
    const VkDeviceSize slotBytes =
        std::max<VkDeviceSize>(problem.hits.size() + bucketCount * (problem.alignment - 1), 1) * kWord;
    const VkDeviceSize bucketBytes = bucketCount * kWord;
    const VkDeviceSize dispatchBytes = (bucketCount + 1) * sizeof(gpu::DispatchArguments);
    constexpr VkDeviceSize kCounterBytes = gpu::kCounterCount * kWord;
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
        {buffers.visited, (problem.hits.size() / 32 + 1) * kWord, kCopied, MemoryUse::Device},
        {buffers.counts, bucketBytes + kWord, kCopied, MemoryUse::Device},
        {buffers.begins, bucketBytes, kCopied, MemoryUse::Device},
        {buffers.cursors, bucketBytes, kCopied, MemoryUse::Device},
        {buffers.rayDispatch, gpu::kDispatchCountOfRays * sizeof(gpu::DispatchArguments), kIndirect,
         MemoryUse::Device},
        {buffers.bucketDispatch, dispatchBytes, kIndirect, MemoryUse::Device},
        {buffers.counters, kCounterBytes, kCopied, MemoryUse::Device},
        {buffers.readback, 3 * bucketBytes + kWord + dispatchBytes + kCounterBytes + slotBytes,
         VK_BUFFER_USAGE_TRANSFER_DST_BIT, MemoryUse::Readback},
    };
    for (const auto& entry : wanted) {
        if (entry.bytes == 0) {
            continue;
        }
        Result<Buffer> buffer = createBuffer(context_, buffers.pool, entry.bytes, entry.usage, entry.use);
        if (!buffer) {
            return buffer.error();
        }
        entry.target = std::move(*buffer);
    }
    std::uint8_t* staged = std::copy(keys.begin(), keys.end(), buffers.staged.mapped);
    staged = std::copy(hits.begin(), hits.end(), staged);
    if (!geometries.empty()) {
        std::memcpy(staged, geometries.data(), geometryBytes);
    }
    gpu::FrameConstants constants{};
    constants.bucketCount = caseCount_ + 1;
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

void OrderKernel::bind(VkCommandBuffer commands, package::ModuleKey key) const {
    context_.vk.CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipelines_.at(key).get());
}

void OrderKernel::wait(VkCommandBuffer commands) const {
    recordDependency(context_, commands, kEverything);
}

// Empty buckets, and the arguments of the passes.
void OrderKernel::recordStart(VkCommandBuffer commands, const Buffers& buffers) const {
    const DeviceTable& vk = context_.vk;
    vk.CmdFillBuffer(commands, buffers.counts.handle.get(), 0, VK_WHOLE_SIZE, 0);
    gpu::PushConstants pushed{};
    pushed.frame = buffers.constants.address;
    vk.CmdPushConstants(commands, layout_.get(), VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(pushed), &pushed);
    bind(commands, {ModuleRole::RayDispatch});
    vk.CmdDispatch(commands, 1, 1, 1);
    wait(commands);
}

// Calls `between` with 0 before the first pass, and with 1 + its number behind each.
void OrderKernel::recordPasses(VkCommandBuffer commands, Ordering ordering, const Buffers& buffers,
                               const std::function<void(std::uint32_t)>& between) const {
    const DeviceTable& vk = context_.vk;
    const auto index = static_cast<std::uint32_t>(ordering);
    const bool sortsTiles = ordering == Ordering::TileSort;
    const auto dispatch = [&](ModuleRole role, std::uint32_t arguments) {
        bind(commands, {role, index});
        vk.CmdDispatchIndirect(commands, buffers.rayDispatch.handle.get(),
                               arguments * sizeof(gpu::DispatchArguments));
        recordDependency(context_, commands, kPassToPass);
    };
    between(kCountPass);
    dispatch(ModuleRole::BucketCount, sortsTiles ? gpu::kDispatchCount : gpu::kDispatchRays);
    between(1 + kCountPass);
    if (!sortsTiles) {
        bind(commands, {ModuleRole::BucketOffset});
        vk.CmdDispatch(commands, 1, 1, 1);
        recordDependency(context_, commands, kPassToPass);
    }
    between(1 + kOffsetPass);
    dispatch(ModuleRole::BucketCopy, sortsTiles ? gpu::kDispatchTiles : gpu::kDispatchRays);
    between(1 + kCopyPass);
}

void OrderKernel::recordCheck(VkCommandBuffer commands, const Buffers& buffers,
                              std::span<const OrderFault> faults) const {
    const DeviceTable& vk = context_.vk;
    const Buffer* const targets[] = {&buffers.slots, &buffers.counts, &buffers.begins, &buffers.cursors};
    for (const OrderFault& fault : faults) {
        const Buffer& target = *targets[static_cast<std::size_t>(fault.where)];
        vk.CmdFillBuffer(commands, target.handle.get(), fault.word * kWord, kWord, fault.value);
        wait(commands);
    }
    bind(commands, {ModuleRole::OrderCheck});
    vk.CmdDispatch(commands, kCheckGroups, 1, 1);
    wait(commands);
}

void OrderKernel::recordInput(VkCommandBuffer commands, const Buffers& buffers) const {
    const DeviceTable& vk = context_.vk;
    VkDeviceSize offset = 0;
    for (const Buffer* const to : {&buffers.keys, &buffers.hits, &buffers.geometries}) {
        recordCopy(context_, commands, {buffers.staged, offset, *to, 0, to->bytes});
        offset += to->bytes;
    }
    vk.CmdUpdateBuffer(commands, buffers.constants.handle.get(), 0, sizeof(buffers.values), &buffers.values);
    vk.CmdFillBuffer(commands, buffers.visited.handle.get(), 0, VK_WHOLE_SIZE, 0);
    // What nobody writes is seen.
    for (const Buffer* const buffer :
         {&buffers.slots, &buffers.begins, &buffers.cursors, &buffers.bucketDispatch}) {
        vk.CmdFillBuffer(commands, buffer->handle.get(), 0, VK_WHOLE_SIZE, gpu::kNoHit - 1);
    }
    // Side by side: two fills of one word would need a barrier in between.
    static_assert(gpu::kCounterRays == 0);
    vk.CmdFillBuffer(commands, buffers.counters.handle.get(), 0, kWord, buffers.rays);
    vk.CmdFillBuffer(commands, buffers.counters.handle.get(), kWord, VK_WHOLE_SIZE, 0);
    wait(commands);
}

// In the order in which readResult() takes them.
void OrderKernel::recordOutput(VkCommandBuffer commands, const Buffers& buffers) const {
    VkDeviceSize offset = 0;
    for (const Buffer* const from : {&buffers.counters, &buffers.counts, &buffers.begins, &buffers.cursors,
                                     &buffers.bucketDispatch, &buffers.slots}) {
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
    result.counts.resize(caseCount_ + 2);
    result.begins.resize(caseCount_ + 1);
    result.cursors.resize(caseCount_ + 1);
    result.dispatches.resize(caseCount_ + 2);
    result.slots.resize(buffers.slots.bytes / kWord);
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
    result.counts.pop_back();  // of workgroups
    result.errors = counters[gpu::kCounterOrderErrors];
    return result;
}

OrderKernel::OrderKernel(Context::State& context, std::uint32_t caseCount, package::HitRecordFormat hitRecord)
    : context_(context), caseCount_(caseCount), hitRecord_(hitRecord) {}

OrderKernel::~OrderKernel() = default;

Status OrderKernel::load(const OrderProblem& problem) {
    buffers_.clear();
    Result<std::unique_ptr<Buffers>> buffers = createBuffers(problem, true);
    if (!buffers) {
        return buffers.error();
    }
    buffers_.push_back(std::move(*buffers));
    return okStatus();
}

Result<OrderResult> OrderKernel::run(Ordering ordering, std::span<const OrderFault> faults) {
    Result<VkCommandBuffer> commands = runner_->begin();
    if (!commands) {
        return commands.error();
    }
    const Buffers& buffers = *buffers_.front();
    recordInput(*commands, buffers);
    recordStart(*commands, buffers);
    recordPasses(*commands, ordering, buffers, [](std::uint32_t) {});
    wait(*commands);
    recordCheck(*commands, buffers, faults);
    recordOutput(*commands, buffers);
    if (Status status = runner_->submitAndWait(); !status) {
        return status.error();
    }
    return readResult(buffers);
}

Status OrderKernel::loadForTimes(const OrderProblem& problem, std::uint32_t copies) {
    buffers_.clear();
    Result<VkCommandBuffer> commands = runner_->begin();
    if (!commands) {
        return commands.error();
    }
    for (std::uint32_t i = 0; i < std::clamp(copies, 1U, kMaxCopies); ++i) {
        Result<std::unique_ptr<Buffers>> buffers = createBuffers(problem, false);
        if (!buffers) {
            return buffers.error();
        }
        recordInput(*commands, **buffers);
        buffers_.push_back(std::move(*buffers));
    }
    return runner_->submitAndWait();
}

Result<std::vector<double>> OrderKernel::readTimes(std::uint32_t count) const {
    return timer_->read(count);
}

Result<std::vector<OrderTime>> OrderKernel::times(Ordering ordering) {
    Result<VkCommandBuffer> commands = runner_->begin();
    if (!commands) {
        return commands.error();
    }
    timer_->recordReset(*commands);
    for (const bool whole : {false, true}) {
        std::uint32_t stretch = 0;
        for (const std::unique_ptr<Buffers>& buffers : buffers_) {
            recordStart(*commands, *buffers);
            recordPasses(*commands, ordering, *buffers, [&](std::uint32_t pass) {
                if (whole) {
                    if (pass == 0) {
                        timer_->recordBegin(*commands, stretch + kPasses);
                    } else if (pass == kPasses) {
                        timer_->recordEnd(*commands, stretch + kPasses);
                    }
                    return;
                }
                if (pass > 0) {
                    timer_->recordEnd(*commands, stretch + pass - 1);
                }
                if (pass < kPasses) {
                    timer_->recordBegin(*commands, stretch + pass);
                }
            });
            wait(*commands);
            stretch += kTimesOfRun;
        }
    }
    if (Status status = runner_->submitAndWait(); !status) {
        return status.error();
    }
    const auto runs = static_cast<std::uint32_t>(buffers_.size());
    Result<std::vector<double>> read = readTimes(runs * kTimesOfRun);
    if (!read) {
        return read.error();
    }
    std::vector<OrderTime> times;
    for (std::uint32_t i = 0; i < runs; ++i) {
        const double* const values = &(*read)[std::size_t{i} * kTimesOfRun];
        const bool hasOffset = ordering != Ordering::TileSort;
        times.push_back(
            {values[kCountPass], hasOffset ? values[kOffsetPass] : 0.0, values[kCopyPass], values[kPasses]});
    }
    return times;
}

Result<std::vector<double>> OrderKernel::copyTimes() {
    Result<VkCommandBuffer> commands = runner_->begin();
    if (!commands) {
        return commands.error();
    }
    timer_->recordReset(*commands);
    const auto runs = static_cast<std::uint32_t>(buffers_.size());
    context_.vk.CmdBindPipeline(*commands, VK_PIPELINE_BIND_POINT_COMPUTE, plainCopy_.get());
    for (std::uint32_t i = 0; i < runs; ++i) {
        const Buffers& from = *buffers_[i];
        // What is behind the last whole vector does not count.
        const struct {
            VkDeviceAddress from;
            VkDeviceAddress to;
            std::uint32_t vectors;
        } pushed{from.slots.address, buffers_[(i + 1) % runs]->slots.address, from.rays / 4};
        static_assert(sizeof(pushed) <= sizeof(gpu::PushConstants));
        context_.vk.CmdPushConstants(*commands, layout_.get(), VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(pushed),
                                     &pushed);
        wait(*commands);
        timer_->recordBegin(*commands, i);
        const std::uint32_t groups = (pushed.vectors + 255) / 256;
        const std::uint32_t rows = groups / gpu::kMaxRayGroupsX + 1;
        context_.vk.CmdDispatch(*commands, (groups + rows - 1) / rows, rows, 1);
        recordDependency(context_, *commands, kPassToPass);
        timer_->recordEnd(*commands, i);
    }
    if (Status status = runner_->submitAndWait(); !status) {
        return status.error();
    }
    return readTimes(runs);
}

Result<OrderResult> OrderKernel::result() {
    Result<VkCommandBuffer> commands = runner_->begin();
    if (!commands) {
        return commands.error();
    }
    recordOutput(*commands, *buffers_.back());
    if (Status status = runner_->submitAndWait(); !status) {
        return status.error();
    }
    return readResult(*buffers_.back());
}

}  // namespace glint::testing
