// The passes of a frame in order, with labels, timers and barriers.
#include "pass_dependencies.h"
#include "renderer_state.h"

#include <cstddef>

namespace glint {
namespace {

using package::ModuleRole;

constexpr VkStridedDeviceAddressRegionKHR kNoCallables{};

class FrameRecorder {
public:
    FrameRecorder(Renderer::State& state, VkCommandBuffer commands)
        : state_(state),
          vk_(state.context.vk),
          commands_(commands),
          pushStages_(pushStages(state.context)),
          dependencies_(stagesOf(state.choice)) {
        pushed_.frame = state.frame.constants.address;
    }

    void record(const FrameOptions& frame) {
        state_.passes.clear();
        state_.timer.recordReset(commands_);
        barrier(kAllToAll);
        clear(frame);
        barrier(dependencies_.clearToPasses);
        recordGBuffer();
        barrier(dependencies_.rasterToPasses);
        bindSets(VK_PIPELINE_BIND_POINT_COMPUTE);
        if (state_.choice.tracer == package::kTracerRayPipeline) {
            bindSets(VK_PIPELINE_BIND_POINT_RAY_TRACING_KHR);
        }
        dispatchPixels("lighting", ModuleRole::Lighting);
        barrier(dependencies_.passToPass);
        if (frame.reflections) {
            recordReflections();
        }
        dispatchPixels("compose", ModuleRole::Compose);
        barrier(dependencies_.passesToCopy);
        copyCounters();
        barrier(kCopyToHost);
    }

private:
    void barrier(const MemoryDependency& dependency) {
        recordDependency(state_.context, commands_, dependency);
    }

    void beginPass(const std::string& name) {
        if (vk_.CmdBeginDebugUtilsLabelEXT != nullptr) {
            VkDebugUtilsLabelEXT label{};
            label.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT;
            label.pLabelName = name.c_str();
            vk_.CmdBeginDebugUtilsLabelEXT(commands_, &label);
        }
        state_.timer.recordBegin(commands_, static_cast<std::uint32_t>(state_.passes.size()));
        state_.passes.push_back(name);
    }

    void endPass() {
        state_.timer.recordEnd(commands_, static_cast<std::uint32_t>(state_.passes.size() - 1));
        if (vk_.CmdEndDebugUtilsLabelEXT != nullptr) {
            vk_.CmdEndDebugUtilsLabelEXT(commands_);
        }
    }

    void bindSets(VkPipelineBindPoint point) {
        const VkDescriptorSet sets[] = {state_.scene.set, state_.frame.set};
        vk_.CmdBindDescriptorSets(commands_, point, state_.pipelines.layout.get(), gpu::kSetScene, 2, sets, 0,
                                  nullptr);
    }

    void push() {
        vk_.CmdPushConstants(commands_, state_.pipelines.layout.get(), pushStages_, 0, sizeof(pushed_),
                             &pushed_);
    }

    void clear(const FrameOptions& frame) {
        // The last counter is of the accumulated picture: it starts with it.
        static_assert(gpu::kCounterNonFinite + 1 == gpu::kCounterCount);
        const bool starts = frame.sampleIndex == 0 || !state_.recorded;
        vk_.CmdFillBuffer(commands_, state_.frame.counters.handle.get(), 0,
                          starts ? VK_WHOLE_SIZE : gpu::kCounterNonFinite * sizeof(std::uint32_t), 0);
        vk_.CmdFillBuffer(commands_, state_.frame.buckets.handle.get(), 0, VK_WHOLE_SIZE, 0);
        if (state_.choice.strategy == package::kStrategySortedUber) {
            // Slots between buckets hold no hit.
            vk_.CmdFillBuffer(commands_, state_.frame.orderedHits.handle.get(), 0, VK_WHOLE_SIZE,
                              gpu::kNoHit);
        }
        if (state_.size.checksOrder) {
            vk_.CmdFillBuffer(commands_, state_.frame.visitedHits.handle.get(), 0, VK_WHOLE_SIZE, 0);
        }
        if (!frame.reflections) {
            const VkClearColorValue black{};
            const VkImageSubresourceRange range = wholeImage();
            vk_.CmdClearColorImage(commands_, state_.frame.images[gpu::kBindingReflection].handle.get(),
                                   VK_IMAGE_LAYOUT_GENERAL, &black, 1, &range);
        }
    }

    void beginRendering() {
        VkRenderingAttachmentInfo color{};
        color.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO;
        color.imageView = state_.frame.images[gpu::kBindingSurface].view.get();
        color.imageLayout = VK_IMAGE_LAYOUT_GENERAL;
        color.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
        color.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
        color.clearValue.color.uint32[0] = gpu::kNoSurface;
        VkRenderingAttachmentInfo depth{};
        depth.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO;
        depth.imageView = state_.frame.depth.view.get();
        depth.imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
        depth.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
        depth.storeOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
        depth.clearValue.depthStencil.depth = 0.0F;  // far, as depth is reversed
        VkRenderingInfo info{};
        info.sType = VK_STRUCTURE_TYPE_RENDERING_INFO;
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

    void recordGBuffer() {
        beginPass("gbuffer");
        beginRendering();
        vk_.CmdBindPipeline(commands_, VK_PIPELINE_BIND_POINT_GRAPHICS, state_.pipelines.gbuffer);
        bindSets(VK_PIPELINE_BIND_POINT_GRAPHICS);
        for (const Draw& draw : state_.scene.draws) {
            vk_.CmdSetCullMode(commands_, draw.doubleSided ? VK_CULL_MODE_NONE : VK_CULL_MODE_BACK_BIT);
            // glTF's fronts are counter-clockwise on screen, unless a mirroring transform turns them.
            vk_.CmdSetFrontFace(commands_,
                                draw.mirrored ? VK_FRONT_FACE_CLOCKWISE : VK_FRONT_FACE_COUNTER_CLOCKWISE);
            pushed_.geometry = draw.geometry;
            push();
            vk_.CmdDraw(commands_, draw.vertexCount, 1, 0, 0);
        }
        vk_.CmdEndRendering(commands_);
        endPass();
    }

    const PassPipeline& pass(ModuleRole role) const {
        return state_.pipelines.passes.at(role);
    }

    void bindPass(const PassPipeline& pass) {
        vk_.CmdBindPipeline(
            commands_, pass.traces ? VK_PIPELINE_BIND_POINT_RAY_TRACING_KHR : VK_PIPELINE_BIND_POINT_COMPUTE,
            pass.pipeline);
        push();
    }

    void dispatchPixels(const std::string& name, ModuleRole role) {
        const PassPipeline& dispatched = pass(role);
        beginPass(name);
        bindPass(dispatched);
        if (dispatched.traces) {
            vk_.CmdTraceRaysKHR(commands_, &dispatched.rayGeneration, &dispatched.miss, &dispatched.hit,
                                &kNoCallables, state_.size.width, state_.size.height, 1);
        } else {
            constexpr std::uint32_t kTile = gpu::kPixelGroupSize;
            vk_.CmdDispatch(commands_, (state_.size.width + kTile - 1) / kTile,
                            (state_.size.height + kTile - 1) / kTile, 1);
        }
        endPass();
    }

    void dispatchOnce(const std::string& name, ModuleRole role) {
        beginPass(name);
        bindPass(pass(role));
        vk_.CmdDispatch(commands_, 1, 1, 1);
        endPass();
        barrier(dependencies_.passToPass);
    }

    // Over a list whose length the device knows: entry `index` of the arguments.
    void dispatchList(const std::string& name, const PassPipeline& pass, const Buffer& arguments,
                      std::uint32_t index) {
        beginPass(name);
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

    void dispatchRays(const std::string& name, ModuleRole role) {
        dispatchList(name, pass(role), state_.frame.rayDispatch, 0);
        barrier(dependencies_.passToPass);
    }

    void recordOrder() {
        dispatchRays("trace", ModuleRole::Trace);
        dispatchRays("count", ModuleRole::BucketCount);
        dispatchOnce("offset", ModuleRole::BucketOffset);
        dispatchRays("copy", ModuleRole::BucketCopy);
        if (state_.choice.checksOrder) {
            // Not by the number of rays: without any, buckets have to be empty.
            dispatchPixels("check order", ModuleRole::OrderCheck);
            barrier(dependencies_.passToPass);
        }
    }

    void recordBuckets() {
        // Buckets write different pixels: they need no order among themselves.
        const Buffer& arguments = state_.frame.bucketDispatch;
        pushed_.bucket = 0;
        dispatchList("shade miss", pass(ModuleRole::ShadeMiss), arguments, 0);
        for (std::uint32_t shaderId = 0; shaderId < state_.pipelines.cases.size(); ++shaderId) {
            if (state_.pipelines.cases[shaderId].pipeline == VK_NULL_HANDLE) {
                continue;  // a retired shader ID, whose bucket stays empty
            }
            pushed_.bucket = 1 + shaderId;
            dispatchList("shade " + state_.caseNames[shaderId], state_.pipelines.cases[shaderId], arguments,
                         1 + shaderId);
        }
        barrier(dependencies_.passToPass);
    }

    void recordReflections() {
        dispatchPixels("reflection rays", ModuleRole::ReflectionRays);
        barrier(dependencies_.passToPass);
        dispatchOnce("ray dispatch", ModuleRole::RayDispatch);
        switch (state_.choice.strategy) {
            case package::kStrategyUber:
                dispatchRays("uber", ModuleRole::UberShade);
                break;
            case package::kStrategySortedUber:
                recordOrder();
                dispatchList("sorted uber", pass(ModuleRole::SortedShade), state_.frame.bucketDispatch,
                             state_.size.bucketCount);
                barrier(dependencies_.passToPass);
                break;
            case package::kStrategyHitShaders:
                dispatchRays("hit shaders", ModuleRole::HitTrace);
                break;
            default:
                recordOrder();
                recordBuckets();
        }
        if (state_.pipelines.passes.contains(ModuleRole::ShadowTrace)) {
            dispatchOnce("shadow dispatch", ModuleRole::ShadowDispatch);
            dispatchList("shadow", pass(ModuleRole::ShadowTrace), state_.frame.shadowDispatch, 0);
            barrier(dependencies_.passToPass);
        }
    }

    void copyCounters() {
        const VkBuffer readback = state_.frame.readback.handle.get();
        const VkBufferCopy counters{0, 0, state_.frame.counters.bytes};
        vk_.CmdCopyBuffer(commands_, state_.frame.counters.handle.get(), readback, 1, &counters);
        const VkBufferCopy buckets{0, kReadbackBucketOffset, state_.frame.buckets.bytes};
        vk_.CmdCopyBuffer(commands_, state_.frame.buckets.handle.get(), readback, 1, &buckets);
    }

    Renderer::State& state_;
    const DeviceTable& vk_;
    VkCommandBuffer commands_;
    VkShaderStageFlags pushStages_;
    PassDependencies dependencies_;
    gpu::PushConstants pushed_{};
};

}  // namespace

void recordFrame(Renderer::State& state, VkCommandBuffer commands, const FrameOptions& frame) {
    FrameRecorder(state, commands).record(frame);
}

}  // namespace glint
