#include "renderer/pipeline_statistics.h"

#include "context/vulkan_error.h"
#include "renderer/renderer_state.h"

#include <cstring>
#include <utility>

namespace glint {
namespace {

// A driver need not terminate a text that fills its field.
std::string textOf(const char (&field)[VK_MAX_DESCRIPTION_SIZE]) {
    return {field, strnlen(field, sizeof(field))};
}

// Collects everything that `ask(count, list)` lists. The first call returns the number.
template <typename Structure, typename Ask>
VkResult listAll(const Structure& empty, const Ask& ask, std::vector<Structure>& list) {
    VkResult result = VK_INCOMPLETE;
    while (result == VK_INCOMPLETE) {
        std::uint32_t count = 0;
        result = ask(&count, nullptr);
        if (result == VK_SUCCESS) {
            list.assign(count, empty);
            result = ask(&count, list.data());
            list.resize(count, empty);
        }
    }
    return result;
}

PipelineStatistic statisticOf(const VkPipelineExecutableStatisticKHR& raw) {
    PipelineStatistic statistic{textOf(raw.name), textOf(raw.description), raw.value.u64};
    switch (raw.format) {
        case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_BOOL32_KHR:
            statistic.value = raw.value.b32 != VK_FALSE;
            break;
        case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_INT64_KHR:
            statistic.value = raw.value.i64;
            break;
        case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_FLOAT64_KHR:
            statistic.value = raw.value.f64;
            break;
        default:
            break;
    }
    return statistic;
}

}  // namespace

Result<std::vector<PipelineExecutable>> readExecutables(const Context::State& context, VkPipeline pipeline) {
    const DeviceTable& vk = context.vk;
    const VkDevice device = context.handles.device;
    VkPipelineInfoKHR info{};
    info.sType = VK_STRUCTURE_TYPE_PIPELINE_INFO_KHR;
    info.pipeline = pipeline;
    VkPipelineExecutablePropertiesKHR noProperties{};
    noProperties.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_PROPERTIES_KHR;
    std::vector<VkPipelineExecutablePropertiesKHR> properties;
    VkResult result = listAll(
        noProperties,
        [&](std::uint32_t* count, VkPipelineExecutablePropertiesKHR* list) {
            return vk.GetPipelineExecutablePropertiesKHR(device, &info, count, list);
        },
        properties);
    if (result != VK_SUCCESS) {
        return vulkanError("vkGetPipelineExecutablePropertiesKHR", result);
    }
    std::vector<PipelineExecutable> executables;
    for (std::uint32_t i = 0; i < properties.size(); ++i) {
        PipelineExecutable executable{textOf(properties[i].name),
                                      textOf(properties[i].description),
                                      properties[i].stages,
                                      properties[i].subgroupSize,
                                      {}};
        VkPipelineExecutableInfoKHR which{};
        which.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INFO_KHR;
        which.pipeline = pipeline;
        which.executableIndex = i;
        VkPipelineExecutableStatisticKHR noStatistic{};
        noStatistic.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_STATISTIC_KHR;
        std::vector<VkPipelineExecutableStatisticKHR> statistics;
        result = listAll(
            noStatistic,
            [&](std::uint32_t* count, VkPipelineExecutableStatisticKHR* list) {
                return vk.GetPipelineExecutableStatisticsKHR(device, &which, count, list);
            },
            statistics);
        if (result != VK_SUCCESS) {
            return vulkanError("vkGetPipelineExecutableStatisticsKHR", result);
        }
        for (const VkPipelineExecutableStatisticKHR& raw : statistics) {
            executable.statistics.push_back(statisticOf(raw));
        }
        executables.push_back(std::move(executable));
    }
    return executables;
}

namespace {

constexpr double kNanosecondsInMs = 1e6;

bool isKnown(const VkPipelineCreationFeedback& feedback) {
    return (feedback.flags & VK_PIPELINE_CREATION_FEEDBACK_VALID_BIT) != 0;
}

bool isCacheHit(const VkPipelineCreationFeedback& feedback) {
    return (feedback.flags & VK_PIPELINE_CREATION_FEEDBACK_APPLICATION_PIPELINE_CACHE_HIT_BIT) != 0;
}

}  // namespace

PipelineStatistics describe(const MadePipeline& pipeline) {
    PipelineStatistics statistics{pipeline.name, {}, {}, {}};
    if (isKnown(pipeline.feedback)) {
        statistics.creationMs = static_cast<double>(pipeline.feedback.duration) / kNanosecondsInMs;
        statistics.cacheHit = isCacheHit(pipeline.feedback);
    }
    return statistics;
}

Renderer::PipelineMaking Renderer::pipelineMaking() const {
    const Pipelines& pipelines = state_->pipelines;
    PipelineMaking making{pipelines.threads, pipelines.creationMs, 0};
    for (const MadePipeline& pipeline : pipelines.owned) {
        if (!isKnown(pipeline.feedback)) {
            making.cacheHits.reset();
            break;
        }
        *making.cacheHits += isCacheHit(pipeline.feedback) ? 1 : 0;
    }
    return making;
}

Result<std::vector<PipelineStatistics>> Renderer::pipelineStatistics() const {
    if (!state_->pipelines.captureStatistics) {
        return makeError("pipeline-statistics", "",
                         "the renderer was made without statistics of its pipelines",
                         "set RendererOptions::pipelineStatistics");
    }
    std::vector<PipelineStatistics> list;
    for (const MadePipeline& pipeline : state_->pipelines.owned) {
        GLINT_TRY(auto executables, readExecutables(state_->context, pipeline.handle->get()));
        list.push_back(describe(pipeline));
        list.back().executables = std::move(executables);
    }
    return list;
}

}  // namespace glint
