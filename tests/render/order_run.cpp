// The runs and timings of an OrderKernel.
#include "context/context.h"
#include "render/order_buffers.h"
#include "render/order_kernel.h"
#include "renderer/hit_passes.h"
#include "renderer/pipeline_jobs.h"

#include <algorithm>
#include <utility>

namespace glint::testing {

namespace {

using package::ModuleRole;
using package::Ordering;

// The passes of an ordering.
constexpr std::uint32_t kCountPass = 0;
constexpr std::uint32_t kOffsetPass = 1;
constexpr std::uint32_t kCopyPass = 2;
constexpr std::uint32_t kPasses = 3;

// The number of workgroups of the check, which works with any number.
constexpr std::uint32_t kCheckGroups = 64;
constexpr VkDeviceSize kWord = sizeof(std::uint32_t);

}  // namespace

void OrderKernel::bind(VkCommandBuffer commands, package::ModuleKey key) const {
    context_.vk.CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipelines_.at(key).get());
}

void OrderKernel::wait(VkCommandBuffer commands) const {
    recordDependency(context_, commands, kEverything);
}

// Records the clearing of buckets and the arguments of the passes.
void OrderKernel::recordStart(VkCommandBuffer commands, const OrderBuffers& buffers) const {
    const DeviceTable& vk = context_.vk;
    for (const Buffer* const buffer : {&buffers.counts, &buffers.cursors}) {
        vk.CmdFillBuffer(commands, buffer->handle.get(), 0, VK_WHOLE_SIZE, 0);
    }
    gpu::PushConstants pushed{};
    pushed.frame = buffers.constants.address;
    vk.CmdPushConstants(commands, layout_.get(), VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(pushed), &pushed);
    bind(commands, {ModuleRole::RayDispatch});
    vk.CmdDispatch(commands, 1, 1, 1);
    wait(commands);
}

// Calls `between` with 0 before the first pass, and with 1 + its number after each pass.
void OrderKernel::recordPasses(VkCommandBuffer commands, Ordering ordering, const OrderBuffers& buffers,
                               const std::function<void(std::uint32_t)>& between) const {
    const DeviceTable& vk = context_.vk;
    const auto index = static_cast<std::uint32_t>(ordering);
    const bool sortsTiles = ordering == Ordering::TileSort;
    const TileSortGroups groups = tileSortGroups(context_.limits, caseCount_ + 1, buffers.rays);
    const PassDependencies dependencies(VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT);
    const auto dispatch = [&](ModuleRole role, std::uint32_t groupsOfTiles) {
        bind(commands, {role, index});
        if (sortsTiles) {
            vk.CmdDispatch(commands, groupsOfTiles, 1, 1);
        } else {
            vk.CmdDispatchIndirect(commands, buffers.rayDispatch.handle.get(), 0);
        }
    };
    between(kCountPass);
    dispatch(ModuleRole::BucketCount, groups.count);
    recordDependency(context_, commands, dependencies.passToPass);
    between(1 + kCountPass);
    if (!sortsTiles) {
        bind(commands, {ModuleRole::BucketOffset});
        vk.CmdDispatch(commands, 1, 1, 1);
        recordDependency(context_, commands, dependencies.passToDispatch);
    }
    between(1 + kOffsetPass);
    dispatch(ModuleRole::BucketCopy, groups.copy);
    // The dependency is the same as after the plain copy. Reads of the indirect arguments that tile-sort's
    // last pass writes must wait for those too.
    recordDependency(context_, commands, dependencies.passToPass);
    between(1 + kCopyPass);
}

void OrderKernel::recordCheck(VkCommandBuffer commands, const OrderBuffers& buffers,
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

OrderKernel::OrderKernel(Context::State& context, std::uint32_t caseCount, package::HitRecordFormat hitRecord)
    : context_(context), caseCount_(caseCount), hitRecord_(hitRecord) {}

OrderKernel::~OrderKernel() = default;

Status OrderKernel::load(const OrderProblem& problem) {
    buffers_.clear();
    GLINT_TRY(auto buffers, createOrderBuffers(context_, problem, caseCount_ + 1, hitRecord_, true));
    buffers_.push_back(std::move(buffers));
    return okStatus();
}

Result<OrderResult> OrderKernel::run(Ordering ordering, std::span<const OrderFault> faults) {
    GLINT_TRY(const auto commands, runner_->begin());
    const OrderBuffers& buffers = *buffers_.front();
    recordInput(context_, commands, buffers);
    recordStart(commands, buffers);
    recordPasses(commands, ordering, buffers, [](std::uint32_t) {});
    wait(commands);
    recordCheck(commands, buffers, faults);
    recordOutput(context_, commands, buffers);
    GLINT_TRY_DO(runner_->submitAndWait());
    return readResult(buffers);
}

Status OrderKernel::loadForTimes(const OrderProblem& problem, std::uint32_t copies) {
    buffers_.clear();
    GLINT_TRY(const auto commands, runner_->begin());
    for (std::uint32_t i = 0; i < std::clamp(copies, 1U, kMaxCopies); ++i) {
        GLINT_TRY(auto buffers, createOrderBuffers(context_, problem, caseCount_ + 1, hitRecord_, false));
        recordInput(context_, commands, *buffers);
        buffers_.push_back(std::move(buffers));
    }
    return runner_->submitAndWait();
}

Result<std::vector<double>> OrderKernel::readTimes(std::uint32_t count) const {
    return timer_->read(count);
}

Result<std::vector<OrderTime>> OrderKernel::times(Ordering ordering) {
    GLINT_TRY(const auto commands, runner_->begin());
    timer_->recordReset(commands);
    for (const bool whole : {false, true}) {
        std::uint32_t stretch = 0;
        for (const std::unique_ptr<OrderBuffers>& buffers : buffers_) {
            recordStart(commands, *buffers);
            recordPasses(commands, ordering, *buffers, [&](std::uint32_t pass) {
                if (whole) {
                    if (pass == 0) {
                        timer_->recordBegin(commands, stretch + kPasses);
                    } else if (pass == kPasses) {
                        timer_->recordEnd(commands, stretch + kPasses);
                    }
                    return;
                }
                if (pass > 0) {
                    timer_->recordEnd(commands, stretch + pass - 1);
                }
                if (pass < kPasses) {
                    timer_->recordBegin(commands, stretch + pass);
                }
            });
            wait(commands);
            stretch += kTimesOfRun;
        }
    }
    GLINT_TRY_DO(runner_->submitAndWait());
    const auto runs = static_cast<std::uint32_t>(buffers_.size());
    GLINT_TRY(const auto read, readTimes(runs * kTimesOfRun));
    std::vector<OrderTime> times;
    for (std::uint32_t i = 0; i < runs; ++i) {
        const double* const values = &read[std::size_t{i} * kTimesOfRun];
        const bool hasOffset = ordering != Ordering::TileSort;
        times.push_back(
            {values[kCountPass], hasOffset ? values[kOffsetPass] : 0.0, values[kCopyPass], values[kPasses]});
    }
    return times;
}

Result<std::vector<double>> OrderKernel::copyTimes() {
    GLINT_TRY(const auto commands, runner_->begin());
    timer_->recordReset(commands);
    const auto runs = static_cast<std::uint32_t>(buffers_.size());
    const PassDependencies dependencies(VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT);
    context_.vk.CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, plainCopy_.get());
    for (std::uint32_t i = 0; i < runs; ++i) {
        const OrderBuffers& from = *buffers_[i];
        // The remainder after the last whole vector is ignored.
        const struct {
            VkDeviceAddress from;
            VkDeviceAddress to;
            std::uint32_t vectors;
        } pushed{from.slots.address, buffers_[(i + 1) % runs]->slots.address, from.rays / 4};
        static_assert(sizeof(pushed) <= sizeof(gpu::PushConstants));
        context_.vk.CmdPushConstants(commands, layout_.get(), VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(pushed),
                                     &pushed);
        wait(commands);
        timer_->recordBegin(commands, i);
        const std::uint32_t groups = (pushed.vectors + 255) / 256;
        const std::uint32_t rows = groups / gpu::kMaxRayGroupsX + 1;
        context_.vk.CmdDispatch(commands, (groups + rows - 1) / rows, rows, 1);
        recordDependency(context_, commands, dependencies.passToPass);
        timer_->recordEnd(commands, i);
    }
    GLINT_TRY_DO(runner_->submitAndWait());
    return readTimes(runs);
}

Result<OrderResult> OrderKernel::result() {
    GLINT_TRY(const auto commands, runner_->begin());
    recordOutput(context_, commands, *buffers_.back());
    GLINT_TRY_DO(runner_->submitAndWait());
    return readResult(*buffers_.back());
}

}  // namespace glint::testing
