#include "renderer/pipeline_jobs.h"

#include "context/parallel.h"
#include "context/resources.h"
#include "context/vulkan_table.h"
#include "interop/frame.h"
#include "package/package.h"

#include <xxhash.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <numeric>
#include <utility>

namespace glint {
namespace {

// Stages and groups of a pipeline that is being made. Groups are in the order of the source: ray generation,
// miss, hit.
struct Parts {
    std::vector<UniqueShaderModule> modules;
    std::vector<VkPipelineShaderStageCreateInfo> stages;
    std::vector<VkRayTracingShaderGroupCreateInfoKHR> groups;
};

// Returns the index of the new stage.
Result<std::uint32_t> addStage(Context::State& context, VkShaderStageFlagBits stage, SpirvWords words,
                               Parts& parts) {
    GLINT_TRY(auto module, createShaderModule(context, words));
    parts.stages.push_back(stageOf(stage, module.get()));
    parts.modules.push_back(std::move(module));
    return static_cast<std::uint32_t>(parts.stages.size() - 1);
}

VkRayTracingShaderGroupCreateInfoKHR emptyGroup(VkRayTracingShaderGroupTypeKHR type) {
    VkRayTracingShaderGroupCreateInfoKHR group{
        .sType = VK_STRUCTURE_TYPE_RAY_TRACING_SHADER_GROUP_CREATE_INFO_KHR,
        .type = type,
        .generalShader = VK_SHADER_UNUSED_KHR,
        .closestHitShader = VK_SHADER_UNUSED_KHR,
        .anyHitShader = VK_SHADER_UNUSED_KHR,
        .intersectionShader = VK_SHADER_UNUSED_KHR};
    return group;
}

Status addGeneral(Context::State& context, VkShaderStageFlagBits stage, std::span<const SpirvWords> shaders,
                  Parts& parts) {
    for (const SpirvWords words : shaders) {
        GLINT_TRY(auto index, addStage(context, stage, words, parts));
        VkRayTracingShaderGroupCreateInfoKHR group = emptyGroup(VK_RAY_TRACING_SHADER_GROUP_TYPE_GENERAL_KHR);
        group.generalShader = index;
        parts.groups.push_back(group);
    }
    return okStatus();
}

Status addHitGroups(Context::State& context, const RayPipelineSource& source, Parts& parts) {
    std::uint32_t anyHit = VK_SHADER_UNUSED_KHR;
    if (!source.anyHit.empty()) {
        GLINT_TRY(anyHit, addStage(context, VK_SHADER_STAGE_ANY_HIT_BIT_KHR, source.anyHit, parts));
    }
    for (const SpirvWords words : source.closestHit) {
        GLINT_TRY(auto index, addStage(context, VK_SHADER_STAGE_CLOSEST_HIT_BIT_KHR, words, parts));
        VkRayTracingShaderGroupCreateInfoKHR group =
            emptyGroup(VK_RAY_TRACING_SHADER_GROUP_TYPE_TRIANGLES_HIT_GROUP_KHR);
        group.closestHitShader = index;
        group.anyHitShader = anyHit;
        parts.groups.push_back(group);
    }
    return okStatus();
}

Result<Parts> makeParts(Context::State& context, const RayPipelineSource& source, bool halfPicture) {
    Parts parts;
    // The other stages use no images of light.
    std::vector<std::uint32_t> withHalf;
    SpirvWords rayGeneration = source.rayGeneration;
    if (halfPicture) {
        withHalf = withHalfImages(rayGeneration);
        rayGeneration = withHalf;
    }
    GLINT_TRY_DO(addGeneral(context, VK_SHADER_STAGE_RAYGEN_BIT_KHR, std::span(&rayGeneration, 1), parts));
    GLINT_TRY_DO(addGeneral(context, VK_SHADER_STAGE_MISS_BIT_KHR, source.miss, parts));
    GLINT_TRY_DO(addHitGroups(context, source, parts));
    return parts;
}

// The offsets of a table's records from its start.
struct TableLayout {
    // By the limits of the specification, handles have 32 bytes, alignments are at most 32 and 64, and the
    // largest stride is at least 4096. No stride is therefore above the device's limit.
    VkDeviceSize handleBytes = 0;
    VkDeviceSize stride = 0;
    VkDeviceSize missOffset = 0;
    VkDeviceSize hitOffset = 0;
    VkDeviceSize bytes = 0;
};

TableLayout layOutTable(const Context::State& context, const RayPipelineSource& source) {
    const VkPhysicalDeviceRayTracingPipelinePropertiesKHR& limits = context.limits.rayPipeline;
    TableLayout layout;
    layout.handleBytes = limits.shaderGroupHandleSize;
    layout.stride = alignUp(layout.handleBytes, limits.shaderGroupHandleAlignment);
    layout.missOffset = alignUp(layout.stride, limits.shaderGroupBaseAlignment);
    layout.hitOffset =
        alignUp(layout.missOffset + layout.stride * source.miss.size(), limits.shaderGroupBaseAlignment);
    layout.bytes = layout.hitOffset + layout.stride * std::max<std::size_t>(source.hitRecords.size(), 1);
    return layout;
}

// Returns the table's bytes, made from the handles of all groups.
std::vector<std::uint8_t> fillTable(const RayPipelineSource& source, const TableLayout& layout,
                                    const std::vector<std::uint8_t>& handles) {
    std::vector<std::uint8_t> bytes(layout.bytes);
    const auto put = [&](VkDeviceSize offset, std::size_t group) {
        std::memcpy(bytes.data() + offset, handles.data() + group * layout.handleBytes, layout.handleBytes);
    };
    const std::size_t firstHit = 1 + source.miss.size();
    put(0, 0);
    for (std::size_t i = 0; i < source.miss.size(); ++i) {
        put(layout.missOffset + i * layout.stride, 1 + i);
    }
    put(layout.hitOffset, firstHit);
    for (std::size_t i = 0; i < source.hitRecords.size(); ++i) {
        put(layout.hitOffset + i * layout.stride, firstHit + source.hitRecords[i]);
    }
    return bytes;
}

Result<std::vector<std::uint8_t>> groupHandles(Context::State& context, VkPipeline pipeline,
                                               std::size_t groupCount) {
    std::vector<std::uint8_t> handles(groupCount * context.limits.rayPipeline.shaderGroupHandleSize);
    GLINT_TRY_DO(statusOf("vkGetRayTracingShaderGroupHandlesKHR",
                          context.vk.GetRayTracingShaderGroupHandlesKHR(
                              context.handles.device, pipeline, 0, static_cast<std::uint32_t>(groupCount),
                              handles.size(), handles.data())));
    return handles;
}

}  // namespace

Result<UniquePipeline> createRayPipeline(Context::State& context, VkPipelineLayout layout,
                                         const RayPipelineSource& source, PipelineCreation& creation) {
    GLINT_TRY(auto parts, makeParts(context, source, creation.halfPicture));
    const VkSpecializationInfo specialization = specializationOf(creation.constants);
    for (VkPipelineShaderStageCreateInfo& stage : parts.stages) {
        stage.pSpecializationInfo = &specialization;
    }
    const VkPipelineCreationFeedbackCreateInfo feedback = feedbackOf(creation, parts.stages.size());
    VkRayTracingPipelineCreateInfoKHR info{
        .sType = VK_STRUCTURE_TYPE_RAY_TRACING_PIPELINE_CREATE_INFO_KHR,
        .pNext = &feedback,
        // Without this flag rays must not meet structures with micromaps. Ray queries need no flag.
        .flags = creation.flags |
                 (context.handles.opacityMicromaps
                      ? VkPipelineCreateFlags{VK_PIPELINE_CREATE_RAY_TRACING_OPACITY_MICROMAP_BIT_EXT}
                      : 0U),
        .stageCount = static_cast<std::uint32_t>(parts.stages.size()),
        .pStages = parts.stages.data(),
        .groupCount = static_cast<std::uint32_t>(parts.groups.size()),
        .pGroups = parts.groups.data(),
        .maxPipelineRayRecursionDepth = 1,
        .layout = layout};
    VkPipeline pipeline = VK_NULL_HANDLE;
    const VkResult result =
        context.vk.CreateRayTracingPipelinesKHR(context.handles.device, VK_NULL_HANDLE, context.pipelineCache,
                                                1, &info, context.services.allocation, &pipeline);
    return ownPipeline(context, creation, "vkCreateRayTracingPipelinesKHR", result, pipeline);
}

Result<ShaderBindingTable> createTable(Context::State& context, MemoryPool& pool, VkPipeline pipeline,
                                       const RayPipelineSource& source) {
    const std::size_t groupCount = 1 + source.miss.size() + source.closestHit.size();
    GLINT_TRY(auto handles, groupHandles(context, pipeline, groupCount));
    const TableLayout layout = layOutTable(context, source);
    const VkDeviceSize alignment = context.limits.rayPipeline.shaderGroupBaseAlignment;
    GLINT_TRY(auto made, createAligned(context, pool, layout.bytes, alignment,
                                       VK_BUFFER_USAGE_SHADER_BINDING_TABLE_BIT_KHR, MemoryUse::Shared));
    const VkDeviceAddress start = made.address;
    const std::vector<std::uint8_t> bytes = fillTable(source, layout, handles);
    std::memcpy(made.buffer.mapped + made.offset(), bytes.data(), bytes.size());
    ShaderBindingTable table;
    table.buffer = std::move(made.buffer);
    table.rayGeneration = {start, layout.missOffset, layout.missOffset};
    table.miss = {start + layout.missOffset, layout.stride, layout.stride * source.miss.size()};
    table.hit = {start + layout.hitOffset, layout.stride, layout.bytes - layout.hitOffset};
    if (source.hitRecords.empty()) {
        // Instances have record offsets. With a stride of 0 all of them use the only record.
        table.hit.stride = 0;
    }
    return table;
}

PipelineIdentity identify(const Package& package, VkPipelineBindPoint point, std::uint64_t number,
                          const std::vector<std::span<const std::uint32_t>>& stages) {
    std::vector<std::uint64_t> parts{static_cast<std::uint64_t>(point), number};
    const auto& hashes = package.state().hashes;
    for (const std::span<const std::uint32_t> words : stages) {
        // A stage that the pipeline lacks has no words.
        const auto hash = hashes.find(words.data());
        const std::array<std::uint64_t, 2> ofStage =
            hash == hashes.end() ? std::array<std::uint64_t, 2>{} : hash->second;
        parts.insert(parts.end(), ofStage.begin(), ofStage.end());
    }
    const XXH128_hash_t all = XXH3_128bits(parts.data(), parts.size() * sizeof(parts[0]));
    return {all.low64, all.high64};
}

PipelineIdentity identify(const Package& package, const RayPipelineSource& source) {
    std::vector<SpirvWords> stages{source.rayGeneration, source.anyHit};
    stages.insert(stages.end(), source.miss.begin(), source.miss.end());
    stages.insert(stages.end(), source.closestHit.begin(), source.closestHit.end());
    // The number of miss shaders, together with the number of stages, tells the kind of each stage.
    return identify(package, VK_PIPELINE_BIND_POINT_RAY_TRACING_KHR, source.miss.size(), stages);
}

Result<MadePipeline> makePipeline(const PipelineJob& job, VkPipelineCreateFlags flags) {
    PipelineCreation creation{.flags = flags, .name = job.name};
    GLINT_TRY(auto pipeline, job.make(creation));
    return MadePipeline{job.name, std::make_shared<const UniquePipeline>(std::move(pipeline)),
                        creation.feedback, job.identity};
}

std::uint32_t pipelineThreads(std::uint32_t wanted, std::size_t jobCount) {
    const std::uint32_t most = wanted > 0 ? wanted : threadsOfMachine();
    return static_cast<std::uint32_t>(std::clamp<std::size_t>(jobCount, 1, most));
}

std::vector<Result<MadePipeline>> tryPipelines(std::span<const PipelineJob> jobs, VkPipelineCreateFlags flags,
                                               std::uint32_t threads) {
    // The longest job must not begin last, as the others would then wait for it.
    std::vector<std::size_t> order(jobs.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, std::greater(), [&](std::size_t job) { return jobs[job].wordCount; });

    std::vector<Result<MadePipeline>> made(jobs.size(), Result<MadePipeline>(MadePipeline{}));
    forEach(
        order.size(),
        [&](std::size_t taken) { made[order[taken]] = makePipeline(jobs[order[taken]], flags); }, threads);
    return made;
}

Result<std::vector<MadePipeline>> makePipelines(std::span<const PipelineJob> jobs,
                                                VkPipelineCreateFlags flags, std::uint32_t threads) {
    std::vector<MadePipeline> made;
    made.reserve(jobs.size());
    for (Result<MadePipeline>& result : tryPipelines(jobs, flags, threads)) {
        if (!result) {
            return result.error();
        }
        made.push_back(std::move(*result));
    }
    return made;
}

namespace {

// A driver need not terminate a text that fills its field.
std::string textOf(const char (&field)[VK_MAX_DESCRIPTION_SIZE]) {
    return {field, strnlen(field, sizeof(field))};
}

Renderer::PipelineStatistics::Statistic statisticOf(const VkPipelineExecutableStatisticKHR& raw) {
    Renderer::PipelineStatistics::Statistic statistic{textOf(raw.name), textOf(raw.description),
                                                      raw.value.u64};
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

Result<std::vector<Renderer::PipelineStatistics::Executable>> readExecutables(const Context::State& context,
                                                                              VkPipeline pipeline) {
    const DeviceTable& vk = context.vk;
    const VkDevice device = context.handles.device;
    VkPipelineInfoKHR info{.sType = VK_STRUCTURE_TYPE_PIPELINE_INFO_KHR, .pipeline = pipeline};
    std::vector<VkPipelineExecutablePropertiesKHR> properties;
    GLINT_TRY_DO(listAll("vkGetPipelineExecutablePropertiesKHR", properties,
                         [&](std::uint32_t* count, VkPipelineExecutablePropertiesKHR* list) {
                             return vk.GetPipelineExecutablePropertiesKHR(device, &info, count, list);
                         },
                         {.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_PROPERTIES_KHR}));
    std::vector<Renderer::PipelineStatistics::Executable> executables;
    for (std::uint32_t i = 0; i < properties.size(); ++i) {
        Renderer::PipelineStatistics::Executable executable{textOf(properties[i].name),
                                                            textOf(properties[i].description),
                                                            properties[i].stages,
                                                            properties[i].subgroupSize,
                                                            {}};
        VkPipelineExecutableInfoKHR which{.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INFO_KHR,
                                          .pipeline = pipeline,
                                          .executableIndex = i};
        std::vector<VkPipelineExecutableStatisticKHR> statistics;
        GLINT_TRY_DO(listAll("vkGetPipelineExecutableStatisticsKHR", statistics,
                             [&](std::uint32_t* count, VkPipelineExecutableStatisticKHR* list) {
                                 return vk.GetPipelineExecutableStatisticsKHR(device, &which, count, list);
                             },
                             {.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_STATISTIC_KHR}));
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

Renderer::PipelineStatistics describe(const MadePipeline& pipeline) {
    Renderer::PipelineStatistics statistics{pipeline.name, {}, {}, {}};
    if (isKnown(pipeline.feedback)) {
        statistics.creationMs = static_cast<double>(pipeline.feedback.duration) / kNanosecondsInMs;
        statistics.cacheHit = isCacheHit(pipeline.feedback);
    }
    return statistics;
}

namespace {

// The number for devices that do not report theirs. It is between those of a small GPU and of a large one.
constexpr std::uint32_t kGuessedMultiprocessors = 64;

// The number of workgroups that a multiprocessor runs at once, given the shared memory of an H200:
// docs/performance.md.
constexpr std::uint32_t kCountGroups = 2;
constexpr std::uint32_t kSmallCopyGroups = 3;
constexpr std::uint32_t kCopyGroups = 2;
constexpr std::uint32_t kLargeCopyGroups = 1;

// Scans need subgroups of at least this size: they have a word of shared memory for every fourth thread.
constexpr std::uint32_t kLeastSubgroup = 4;

std::uint32_t groupsFor(std::uint64_t hits, std::uint32_t hitsOfGroup, std::uint32_t atOnce) {
    return static_cast<std::uint32_t>(
        std::clamp<std::uint64_t>((hits + hitsOfGroup - 1) / hitsOfGroup, 1, atOnce));
}

}  // namespace

bool sortsTiles(const DeviceLimits& limits) {
    constexpr std::uint32_t kThreads = std::max(gpu::kTileThreads, gpu::kCountGroupSize);
    return limits.core.maxComputeSharedMemorySize >= gpu::kTileSharedBytes &&
           limits.core.maxComputeWorkGroupInvocations >= kThreads &&
           limits.core.maxComputeWorkGroupSize[0] >= kThreads && limits.subgroupSize >= kLeastSubgroup &&
           gpu::kSmallTileThreads % limits.subgroupSize == 0 &&
           (limits.subgroupOperations & VK_SUBGROUP_FEATURE_SHUFFLE_RELATIVE_BIT) != 0;
}

std::uint32_t tileSortThreads(const DeviceLimits& limits, std::uint32_t bucketCount) {
    if (bucketCount <= gpu::kSmallTileBuckets) {
        return gpu::kSmallTileThreads;
    }
    const bool large = bucketCount > gpu::kTileBuckets &&
                       limits.core.maxComputeSharedMemorySize >= gpu::kLargeTileSharedBytes &&
                       limits.core.maxComputeWorkGroupInvocations >= gpu::kLargeTileThreads &&
                       limits.core.maxComputeWorkGroupSize[0] >= gpu::kLargeTileThreads;
    return large ? gpu::kLargeTileThreads : gpu::kTileThreads;
}

std::uint32_t chosenThreads(const DeviceLimits& limits, const package::ModuleKey& key,
                            std::uint32_t bucketCount) {
    constexpr auto kTileSort = static_cast<std::uint32_t>(package::Ordering::TileSort);
    const bool copiesTiles = key.role == package::ModuleRole::BucketCopy && key.index == kTileSort;
    return copiesTiles ? tileSortThreads(limits, bucketCount) : 0;
}

TileSortGroups tileSortGroups(const DeviceLimits& limits, std::uint32_t bucketCount, std::uint64_t maxHits) {
    const std::uint32_t processors =
        limits.multiprocessors > 0 ? limits.multiprocessors : kGuessedMultiprocessors;
    const std::uint32_t threads = tileSortThreads(limits, bucketCount);
    const std::uint32_t copyGroups = threads < gpu::kTileThreads   ? kSmallCopyGroups
                                     : threads > gpu::kTileThreads ? kLargeCopyGroups
                                                                   : kCopyGroups;
    // A thread counts at least four keys at a time, which is the number for keys of four bytes.
    return {groupsFor(maxHits, gpu::kCountGroupSize * 4, processors * kCountGroups),
            groupsFor(maxHits, threads * gpu::kTileHitsOfThread, processors * copyGroups)};
}

}  // namespace glint
