#include "renderer/hit_passes.h"

#include "renderer/pipeline_jobs.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace glint {

Status checkRecorded(const PassState& state) {
    return state.recorded ? okStatus()
                          : Status(makeError("frame-not-recorded", "", "no frame has been recorded",
                                             "record a frame, submit it and wait for it first"));
}

Result<std::vector<PassTiming>> passTimings(PassState& state) {
    GLINT_TRY_DO(checkRecorded(state));
    const auto count = static_cast<std::uint32_t>(state.timed.size());
    GLINT_TRY(auto milliseconds, state.timer.read(count));
    std::vector<PassTiming> timings;
    for (std::uint32_t i = 0; i < count; ++i) {
        const PassLabel& label = state.timed[i];
        timings.push_back({label.name, milliseconds[i], label.pass, label.shaderId});
    }
    return timings;
}

namespace {

constexpr VkStridedDeviceAddressRegionKHR kNoCallables{};

}  // namespace

PassRecorder::PassRecorder(PassState& state, VkCommandBuffer commands, Timing timing)
    : state_(state),
      vk_(state.context.vk),
      commands_(commands),
      pushStages_(state.pipelines.pushStages),
      dependencies_(stagesOf(state.choice)),
      timesPasses_(timing == Timing::Passes),
      rows_(state.size.height) {
    pushed_.frame = state.frame.constants.address;
}

void PassRecorder::barrier(const MemoryDependency& dependency) {
    recordDependency(state_.context, commands_, dependency);
}

void PassRecorder::fill(const Buffer& buffer, std::uint32_t value, VkDeviceSize bytes, VkDeviceSize from) {
    if (buffer.bytes > from) {
        vk_.CmdFillBuffer(commands_, buffer.handle.get(), from, bytes, value);
    }
}

void PassRecorder::clearLists() {
    fill(state_.frame.bucketCounts, 0);
    fill(state_.frame.bucketCursors, 0);
    fill(state_.frame.visitedHits, 0);
}

void PassRecorder::readBack(const Buffer& source, VkDeviceSize bytes, VkDeviceSize to, VkDeviceSize from) {
    const VkBufferCopy region{from, to, bytes};
    vk_.CmdCopyBuffer(commands_, source.handle.get(), state_.frame.readback.handle.get(), 1, &region);
}

void PassRecorder::beginPass(const PassLabel& label) {
    beginLabel(state_.context, commands_, label.name);
    if (timesPasses_) {
        state_.timer.recordBegin(commands_, static_cast<std::uint32_t>(state_.timed.size()));
        state_.timed.push_back(label);
    }
}

void PassRecorder::endPass() {
    if (timesPasses_) {
        state_.timer.recordEnd(commands_, static_cast<std::uint32_t>(state_.timed.size() - 1));
    }
    endLabel(state_.context, commands_);
}

std::uint32_t PassRecorder::beginStretch(const PassLabel& label) {
    const auto stretch = static_cast<std::uint32_t>(state_.timed.size());
    if (!timesPasses_) {
        state_.timer.recordBegin(commands_, stretch);
        state_.timed.push_back(label);
    }
    return stretch;
}

void PassRecorder::endStretch(std::uint32_t stretch) {
    if (!timesPasses_) {
        state_.timer.recordEnd(commands_, stretch);
    }
}

void PassRecorder::beginTogether(const PassLabel& label) {
    beginPass(label);
    timesTogether_ = std::exchange(timesPasses_, false);
}

void PassRecorder::endTogether() {
    timesPasses_ = timesTogether_;
    endPass();
}

void PassRecorder::bindSets(VkPipelineBindPoint point, std::span<const VkDescriptorSet> sets) {
    vk_.CmdBindDescriptorSets(commands_, point, state_.pipelines.layout, gpu::kSetScene,
                              static_cast<std::uint32_t>(sets.size()), sets.data(), 0, nullptr);
}

void PassRecorder::push() {
    vk_.CmdPushConstants(commands_, state_.pipelines.layout, pushStages_, state_.pushOffset, sizeof(pushed_),
                         &pushed_);
}

void PassRecorder::beginRendering() {
    VkRenderingAttachmentInfo color{.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                    .imageView = state_.frame.images[gpu::kBindingSurface].view.get(),
                                    .imageLayout = VK_IMAGE_LAYOUT_GENERAL,
                                    .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                    .storeOp = VK_ATTACHMENT_STORE_OP_STORE};
    color.clearValue.color.uint32[0] = gpu::kNoSurface;
    VkRenderingAttachmentInfo depth{.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
    depth.imageView = state_.frame.depth.view.get();
    depth.imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
    depth.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    depth.storeOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
    depth.clearValue.depthStencil.depth = 0.0F;  // far, as depth is reversed
    VkRenderingInfo info{.sType = VK_STRUCTURE_TYPE_RENDERING_INFO};
    info.renderArea.extent = {state_.size.width, state_.size.height};
    info.layerCount = 1;
    info.colorAttachmentCount = 1;
    info.pColorAttachments = &color;
    info.pDepthAttachment = &depth;
    vk_.CmdBeginRendering(commands_, &info);
    const VkViewport viewport{
        0.0F, 0.0F, static_cast<float>(state_.size.width), static_cast<float>(state_.size.height),
        0.0F, 1.0F};
    vk_.CmdSetViewport(commands_, 0, 1, &viewport);
    vk_.CmdSetScissor(commands_, 0, 1, &info.renderArea);
}

void PassRecorder::drawScene(std::span<const DrawBatch> batches, std::span<const VkDescriptorSet> sets) {
    beginPass({"gbuffer", Pass::Gbuffer});
    recordTransition(
        state_.context, commands_,
        {state_.frame.depth.handle.get(),
         VK_IMAGE_LAYOUT_UNDEFINED,
         VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
         {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT, kDepthStages,
          VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT},
         0,
         VK_REMAINING_MIP_LEVELS,
         VK_IMAGE_ASPECT_DEPTH_BIT});
    beginRendering();
    vk_.CmdBindPipeline(commands_, VK_PIPELINE_BIND_POINT_GRAPHICS, state_.pipelines.gbuffer);
    bindSets(VK_PIPELINE_BIND_POINT_GRAPHICS, sets);
    for (const DrawBatch& draw : batches) {
        vk_.CmdSetCullMode(commands_, draw.doubleSided ? VK_CULL_MODE_NONE : VK_CULL_MODE_BACK_BIT);
        // A front is counter-clockwise on screen in glTF, unless a mirroring transform turns it.
        vk_.CmdSetFrontFace(commands_,
                            draw.mirrored ? VK_FRONT_FACE_CLOCKWISE : VK_FRONT_FACE_COUNTER_CLOCKWISE);
        pushed_.geometry = draw.geometry;
        pushed_.geometryStride = draw.stride;
        push();
        vk_.CmdDraw(commands_, draw.vertexCount, draw.count, 0, 0);
    }
    vk_.CmdEndRendering(commands_);
    endPass();
}

void PassRecorder::bindPass(const PassPipeline& pass) {
    vk_.CmdBindPipeline(commands_,
                        pass.traces ? VK_PIPELINE_BIND_POINT_RAY_TRACING_KHR : VK_PIPELINE_BIND_POINT_COMPUTE,
                        pass.pipeline);
    push();
}

void PassRecorder::bindSets(std::span<const VkDescriptorSet> sets) {
    bindSets(VK_PIPELINE_BIND_POINT_COMPUTE, sets);
    if (state_.choice.tracer == package::kTracerRayPipeline) {
        bindSets(VK_PIPELINE_BIND_POINT_RAY_TRACING_KHR, sets);
    }
}

void PassRecorder::dispatchPixels(const PassLabel& label, const PassPipeline& pass) {
    beginPass(label);
    bindPass(pass);
    if (pass.traces) {
        vk_.CmdTraceRaysKHR(commands_, &pass.rayGeneration, &pass.miss, &pass.hit, &kNoCallables,
                            state_.size.width, rows_, 1);
    } else {
        constexpr std::uint32_t kTile = gpu::kPixelGroupSize;
        vk_.CmdDispatch(commands_, (state_.size.width + kTile - 1) / kTile, (rows_ + kTile - 1) / kTile, 1);
    }
    endPass();
}

void PassRecorder::dispatchGroups(const PassLabel& label, const PassPipeline& pass, std::uint32_t groups) {
    beginPass(label);
    bindPass(pass);
    vk_.CmdDispatch(commands_, groups, 1, 1);
    endPass();
}

void PassRecorder::dispatchList(const PassLabel& label, const PassPipeline& pass, const Buffer& arguments,
                                std::uint32_t index) {
    beginPass(label);
    bindPass(pass);
    const VkDeviceSize offset = index * sizeof(gpu::DispatchArguments);
    if (pass.traces) {
        vk_.CmdTraceRaysIndirectKHR(
            commands_, &pass.rayGeneration, &pass.miss, &pass.hit, &kNoCallables,
            arguments.address + offset + offsetof(gpu::DispatchArguments, traceWidth));
    } else {
        vk_.CmdDispatchIndirect(commands_, arguments.handle.get(), offset);
    }
    endPass();
}

using package::ModuleRole;

void HitPasses::dispatchRays(const PassLabel& label, ModuleRole role) {
    passes_.dispatchList(label, pass(role), state_.frame.rayDispatch, 0);
    passes_.barrier(dependencies().passToPass);
}

void HitPasses::clearRound() {
    // The previous round read these lists. Their counts are the first counters.
    static_assert(gpu::kCounterRays == 0 && gpu::kCounterShadowRays == 1);
    passes_.barrier(dependencies().passToClear);
    passes_.fill(state_.frame.counters, 0, kRoundCounterBytes);
    passes_.clearLists();
    passes_.barrier(dependencies().clearToPasses);
}

void HitPasses::setBounce(std::uint32_t bounce, float weight) {
    std::uint64_t listed = state_.frame.listed.address;
    std::uint64_t next = state_.frame.nextListed.address;
    if (bounce > 0 && bounce % 2 == 0) {
        std::swap(listed, next);
    }
    passes_.barrier(dependencies().passToClear);
    passes_.setConstants(listed, offsetof(gpu::FrameConstants, listed));
    passes_.setConstants(next, offsetof(gpu::FrameConstants, nextListed));
    passes_.setConstants(bounce, offsetof(gpu::FrameConstants, bounce));
    passes_.setConstants(weight, offsetof(gpu::FrameConstants, bounceWeight));
    passes_.barrier(dependencies().clearToPasses);
    passes_.barrier(dependencies().passToPass);
}

void HitPasses::listPathRays(std::uint32_t bounce, float weight) {
    clearRound();
    passes_.dispatchList({"path rays", Pass::PathRays}, pass(ModuleRole::PathRays), state_.frame.rayDispatch,
                         0);
    setBounce(bounce, weight);
}

void HitPasses::readBackRound(std::uint32_t round) {
    passes_.barrier(dependencies().passesToCopy);
    // The list's own counts follow the other counters, round by round.
    const VkDeviceSize place = readbackRound(state_.size, round);
    passes_.readBack(state_.frame.counters, kRoundCounterBytes, place);
    if (state_.size.ordered) {
        passes_.readBack(state_.frame.bucketCounts, bucketBytes(state_.size), place + kRoundCounterBytes);
    }
}

void HitPasses::dispatchOfList() {
    passes_.dispatchGroups({"ray dispatch", Pass::RayDispatch}, pass(ModuleRole::RayDispatch), 1);
    passes_.barrier(dependencies().passToDispatch);
}

void HitPasses::traceVisibility() {
    dispatchRays({"ray visibility", Pass::Trace}, ModuleRole::RayVisibility);
}

void HitPasses::trace() {
    if (ordersHits()) {
        dispatchRays({"trace", Pass::Trace}, ModuleRole::Trace);
    }
}

void HitPasses::orderFirst() {
    constexpr VkDeviceSize kBlock = gpu::kFirstGroupSize * gpu::kFirstPixelsOfThread;
    const auto blocks = static_cast<std::uint32_t>((state_.size.firstHits() + kBlock - 1) / kBlock);
    passes_.dispatchGroups({"first count", Pass::FirstOrder}, pass(ModuleRole::FirstCount), blocks);
    passes_.barrier(dependencies().passToPass);
    passes_.dispatchGroups({"first offset", Pass::FirstOrder}, pass(ModuleRole::BucketOffset), 1);
    passes_.barrier(dependencies().passToDispatch);
    passes_.dispatchGroups({"first copy", Pass::FirstOrder}, pass(ModuleRole::FirstCopy), blocks);
    passes_.barrier(dependencies().passToDispatch);
}

void HitPasses::shadeFirst(std::uint32_t shadowRounds) {
    for (std::uint32_t round = 0; round < std::max(shadowRounds, 1U); ++round) {
        if (round == 1) {
            // The lights of a frame decide their number, and the timer was made before.
            passes_.beginTogether({"further shadow rounds", Pass::FirstShade});
        }
        passes_.setShadowRound(round);
        std::ranges::for_each(package::firstRoles(), [&](const package::RoleInfo& info) { dispatch(info); });
        passes_.barrier(dependencies().passToPass);
        if (shadowRounds > 0) {
            passes_.dispatchPixels({"first shadows", Pass::FirstShade}, pass(ModuleRole::FirstShadows));
            passes_.barrier(dependencies().passToPass);
        }
    }
    if (shadowRounds > 1) {
        passes_.endTogether();
    }
}

void HitPasses::order() {
    if (!ordersHits()) {
        return;
    }
    if (state_.choice.ordering == package::Ordering::TileSort) {
        const TileSortGroups groups =
            tileSortGroups(state_.context.limits, state_.size.bucketCount, listRays(state_.size));
        passes_.dispatchGroups({"count", Pass::Count}, pass(ModuleRole::BucketCount), groups.count);
        passes_.barrier(dependencies().passToPass);
        passes_.dispatchGroups({"copy", Pass::Copy}, pass(ModuleRole::BucketCopy), groups.copy);
        passes_.barrier(dependencies().passToDispatch);
    } else {
        dispatchRays({"count", Pass::Count}, ModuleRole::BucketCount);
        passes_.dispatchGroups({"offset", Pass::Offset}, pass(ModuleRole::BucketOffset), 1);
        passes_.barrier(dependencies().passToDispatch);
        dispatchRays({"copy", Pass::Copy}, ModuleRole::BucketCopy);
    }
    if (state_.choice.checksOrder) {
        // This does not dispatch by the number of rays: if there are none, it must check that buckets are
        // empty.
        passes_.dispatchPixels({"check order", Pass::CheckOrder}, pass(ModuleRole::OrderCheck));
        passes_.barrier(dependencies().passToPass);
    }
}

void HitPasses::shadeCases(const package::RoleInfo& info) {
    const std::vector<PassPipeline>& cases = state_.pipelines.cases.at(info.role);
    const Pass kind = info.shadesFirst() ? Pass::FirstCase : Pass::ShadeCase;
    for (std::uint32_t shaderId = 0; shaderId < cases.size(); ++shaderId) {
        if (cases[shaderId].pipeline == VK_NULL_HANDLE) {
            continue;  // the bucket of a retired shader ID stays empty
        }
        passes_.setBucket(1 + shaderId);
        passes_.dispatchList({std::string(info.pass) + " " + state_.caseNames[shaderId], kind, shaderId},
                             cases[shaderId], state_.frame.bucketDispatch, 1 + shaderId);
    }
}

void HitPasses::dispatch(const package::RoleInfo& info) {
    const bool ofFallback = info.purpose == package::Purpose::Fallback;
    const bool ofStrategy = info.declared != nullptr;
    const PassLabel label{std::string(info.pass) + (ofFallback ? " fallback" : ""),
                          ofStrategy ? Pass::Shade : Pass::FirstShade};
    switch (info.over) {
        case package::Over::Nothing:
            break;
        case package::Over::Rays:
            passes_.dispatchList(label, pass(info.role), state_.frame.rayDispatch, 0);
            break;
        case package::Over::OrderedHits:
            passes_.dispatchList(label, pass(info.role), state_.frame.bucketDispatch,
                                 state_.size.bucketCount);
            break;
        case package::Over::Misses:
            if (!ofFallback || state_.pipelines.shadesUnknown) {
                passes_.setBucket(0);
                passes_.dispatchList(label, pass(info.role), state_.frame.bucketDispatch, 0);
            }
            break;
        case package::Over::Buckets:
            shadeCases(info);
            break;
    }
}

void HitPasses::shade() {
    for (const package::RoleInfo& info : package::rolesOf(state_.choice.strategy)) {
        dispatch(info);
    }
    passes_.barrier(dependencies().passToPass);
    if (state_.pipelines.passes.contains(ModuleRole::ShadowTrace)) {
        passes_.dispatchGroups({"shadow dispatch", Pass::ShadowDispatch}, pass(ModuleRole::ShadowDispatch),
                               1);
        passes_.barrier(dependencies().passToDispatch);
        passes_.dispatchList({"shadow", Pass::Shadow}, pass(ModuleRole::ShadowTrace),
                             state_.frame.shadowDispatch, 0);
        passes_.barrier(dependencies().passToPass);
    }
}

}  // namespace glint
