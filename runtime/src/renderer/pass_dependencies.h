// Dependencies between the passes of a frame.
#pragma once

#include "context/commands.h"

namespace glint {

// Makes all later commands wait for all earlier ones. So frames run one after the other, whichever renderer
// recorded the previous one.
inline constexpr MemoryDependency kAllToAll{
    VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
    VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT};
// Orders fills and copies that write the same memory.
inline constexpr MemoryDependency kTransferToTransfer{
    VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
    VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT};
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

inline constexpr MemoryDependency kCopyToHost{VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                              VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT};

}  // namespace glint
