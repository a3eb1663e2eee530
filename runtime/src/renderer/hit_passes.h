// The state on which recordings of passes work, of renderers and of RaySteps, the dependencies between
// passes, and the passes that shade the rays of the list.
#pragma once

#include "context/commands.h"
#include "data/geometry.h"
#include "frame/frame_resources.h"
#include "renderer/pipelines.h"

#include <glint/renderer_options.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace glint {

// The largest number of passes of first hits and of a round, beside one for each case.
inline constexpr std::uint32_t kMaxFirstPasses = 7;
inline constexpr std::uint32_t kMaxFixedPasses = 27;

// The label of a timer's stretch.
struct PassLabel {
    std::string name;  // for people
    Pass pass = Pass::Frame;
    std::uint32_t shaderId = 0;  // of Pass::FirstCase and Pass::ShadeCase
};

struct PassState {
    PassState(Context::State& contextState, Timer passTimer)
        : context(contextState), timer(std::move(passTimer)), frame(contextState), pipelines(contextState) {}

    Context::State& context;
    PipelineChoice choice;
    FrameSize size;
    std::vector<std::string> caseNames;
    Timer timer;
    FrameResources frame;
    Pipelines pipelines;
    std::uint32_t pushOffset = 0;  // bytes
    std::vector<PassLabel> timed;  // the last recording's label of each stretch of the timer
    bool recorded = false;
};

// Returns the times of the last recording. Errors: "frame-not-recorded", and those of reading device times.
Result<std::vector<PassTiming>> passTimings(PassState& state);

// Error "frame-not-recorded".
Status checkRecorded(const PassState& state);

inline constexpr VkPipelineStageFlags2 kRasterStage = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;
inline constexpr VkPipelineStageFlags2 kDepthStages =
    VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT;
inline constexpr VkPipelineStageFlags2 kRasterShaders =
    VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;

// The dependencies between passes, which run in `stages`.
struct PassDependencies {
    explicit PassDependencies(VkPipelineStageFlags2 stages)
        // Fills count as clears or as copies, depending on the edition of the specification.
        : clearToPasses{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                        kRasterStage | kRasterShaders | stages,
                        VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_SHADER_READ_BIT |
                            VK_ACCESS_2_SHADER_WRITE_BIT},
          // Passes may write to the memory of the depth.
          rasterToPasses{
              kRasterStage | kDepthStages,
              VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT, stages,
              VK_ACCESS_2_SHADER_READ_BIT | VK_ACCESS_2_SHADER_WRITE_BIT},
          passToPass{stages, VK_ACCESS_2_SHADER_WRITE_BIT, stages,
                     VK_ACCESS_2_SHADER_READ_BIT | VK_ACCESS_2_SHADER_WRITE_BIT},
          passToDispatch{stages, VK_ACCESS_2_SHADER_WRITE_BIT, stages | VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT,
                         VK_ACCESS_2_SHADER_READ_BIT | VK_ACCESS_2_SHADER_WRITE_BIT |
                             VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT},
          passToClear{
              stages | VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT | VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
              VK_ACCESS_2_SHADER_READ_BIT | VK_ACCESS_2_SHADER_WRITE_BIT | VK_ACCESS_2_TRANSFER_READ_BIT,
              VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT},
          passesToCopy{stages | VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
                       VK_ACCESS_2_SHADER_WRITE_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT,
                       VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT} {}

    MemoryDependency clearToPasses;
    MemoryDependency rasterToPasses;
    MemoryDependency passToPass;
    MemoryDependency passToDispatch;  // after a pass that writes indirect arguments
    MemoryDependency passToClear;     // before lists are filled anew
    MemoryDependency passesToCopy;    // a fill wrote the counters that no pass changed
};

class PassRecorder {
public:
    PassRecorder(PassState& state, VkCommandBuffer commands, Timing timing);

    // Begins a stretch of several passes, which is timed if passes are not. Returns its number for
    // endStretch().
    std::uint32_t beginStretch(const PassLabel& label);
    void endStretch(std::uint32_t stretch);

    // Where passes are timed, times those until endTogether() as one.
    void beginTogether(const PassLabel& label);
    void endTogether();

    void barrier(const MemoryDependency& dependency);
    // Fills the bytes of a buffer from an offset on; one that the frame lacks is left out.
    void fill(const Buffer& buffer, std::uint32_t value, VkDeviceSize bytes = VK_WHOLE_SIZE,
              VkDeviceSize from = 0);
    // Clears the buckets of the list of rays.
    void clearLists();
    // Copies bytes into the read-back buffer, at the offset `to`.
    void readBack(const Buffer& source, VkDeviceSize bytes, VkDeviceSize to, VkDeviceSize from = 0);
    // Sets FrameConstants, or the bytes from an offset on.
    template <typename Value>
    void setConstants(const Value& value, std::size_t offset = 0) {
        static_assert(sizeof(value) <= 65536 && sizeof(value) % 4 == 0, "limits of the command");
        vk_.CmdUpdateBuffer(commands_, state_.frame.constants.handle.get(), offset, sizeof(value), &value);
    }
    // Binds descriptor sets for every kind of pass except the raster pass.
    void bindSets(std::span<const VkDescriptorSet> sets);
    // Draws a scene into the G-buffer's visibility image.
    void drawScene(std::span<const DrawBatch> batches, std::span<const VkDescriptorSet> sets);
    // Sets the number of rows that passes over pixels have. The default is the height of the image.
    void setRows(std::uint32_t rows) {
        rows_ = rows;
    }
    // Dispatches the pass over the pixels of these rows.
    void dispatchPixels(const PassLabel& label, const PassPipeline& pass);
    // Dispatches `groups` workgroups.
    void dispatchGroups(const PassLabel& label, const PassPipeline& pass, std::uint32_t groups);
    // Dispatches over a list whose length the device knows. `index` is the entry of the arguments.
    void dispatchList(const PassLabel& label, const PassPipeline& pass, const Buffer& arguments,
                      std::uint32_t index);
    // Sets the bucket that the next dispatch shades.
    void setBucket(std::uint32_t bucket) {
        pushed_.bucket = bucket;
    }
    // Sets PushConstants::shadowRound of the next dispatches.
    void setShadowRound(std::uint32_t round) {
        pushed_.shadowRound = round;
    }

    const PassDependencies& dependencies() const {
        return dependencies_;
    }
    VkCommandBuffer commands() const {
        return commands_;
    }

private:
    void beginPass(const PassLabel& label);
    void endPass();
    void bindSets(VkPipelineBindPoint point, std::span<const VkDescriptorSet> sets);
    void bindPass(const PassPipeline& pass);
    void push();
    void beginRendering();

    PassState& state_;
    const DeviceTable& vk_;
    VkCommandBuffer commands_;
    VkShaderStageFlags pushStages_;
    PassDependencies dependencies_;
    gpu::PushConstants pushed_{};
    bool timesPasses_;
    bool timesTogether_ = false;
    std::uint32_t rows_;
};

class HitPasses {
public:
    HitPasses(PassState& state, PassRecorder& passes) : state_(state), passes_(passes) {}

    // Orders the pixels of a band by the case of what they see, and shades them.
    void orderFirst();
    // `shadowRounds` is 0 if the shadow rays of first hits are traced inline.
    void shadeFirst(std::uint32_t shadowRounds);

    // Clears the lists of the round before, and their counters.
    void clearRound();
    // Tells the passes which bounce they shade, and which list has its rays: odd bounces use the list that
    // the first rays are in. `weight` is the factor of the light that paths find after the bounce. Makes the
    // writes of the earlier passes visible to the later ones.
    void setBounce(std::uint32_t bounce, float weight);
    // Puts the rays that the hits of the bounce before sent on the next list, and makes it that of `bounce`.
    void listPathRays(std::uint32_t bounce, float weight);
    // Copies the counters of a round into the read-back buffer, before the next round clears them.
    void readBackRound(std::uint32_t round);

    // Sets the indirect arguments of the list of rays, from its counter.
    void dispatchOfList();
    // Answers a host's rays that only ask for visibility.
    void traceVisibility();
    // Strategies that shade where they trace have nothing to do in these two.
    void trace();
    void order();
    void shade();

private:
    const PassDependencies& dependencies() const {
        return passes_.dependencies();
    }
    const PassPipeline& pass(package::ModuleRole role) const {
        return state_.pipelines.passes.at(role);
    }
    bool ordersHits() const {
        return (state_.choice.strategy & package::orderedStrategies()) != 0;
    }
    void dispatchRays(const PassLabel& label, package::ModuleRole role);
    // Dispatches the pass of a role that shades hits, if it has one.
    void dispatch(const package::RoleInfo& info);
    void shadeCases(const package::RoleInfo& info);

    PassState& state_;
    PassRecorder& passes_;
};

}  // namespace glint
