// Tests reading what a driver reports about a pipeline, with a made-up driver, because few real ones report
// anything.
#include "device_fixture.h"
#include "renderer/pipeline_jobs.h"
#include "renderer/pipelines.h"
#include "renderer/renderer.h"
#include "support/must.h"

#include <algorithm>
#include <cstring>

namespace glint::test {
namespace {

// The calls that the made-up driver received.
std::uint32_t askedExecutables = 0;
// Behaves like a pipeline that is compiled further between the two calls.
bool isIncompleteOnce = false;

void fill(char (&field)[VK_MAX_DESCRIPTION_SIZE], const char* text) {
    std::strncpy(field, text, sizeof(field) - 1);
}

VKAPI_ATTR VkResult VKAPI_CALL properties(VkDevice /*device*/, const VkPipelineInfoKHR* /*info*/,
                                          std::uint32_t* count, VkPipelineExecutablePropertiesKHR* list) {
    if (list == nullptr) {
        *count = 2;
        return VK_SUCCESS;
    }
    if (isIncompleteOnce) {
        isIncompleteOnce = false;
        return VK_INCOMPLETE;
    }
    ++askedExecutables;
    fill(list[0].name, "main");
    fill(list[0].description, "the code");
    list[0].stages = VK_SHADER_STAGE_COMPUTE_BIT;
    list[0].subgroupSize = 32;
    // The name fills its field and has no terminator.
    std::memset(list[1].name, 'x', sizeof(list[1].name));
    return VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL statistics(VkDevice /*device*/, const VkPipelineExecutableInfoKHR* info,
                                          std::uint32_t* count, VkPipelineExecutableStatisticKHR* list) {
    if (info->executableIndex == 1) {
        *count = 0;
        return VK_SUCCESS;
    }
    if (list == nullptr) {
        *count = 4;
        return VK_SUCCESS;
    }
    fill(list[0].name, "Register Count");
    fill(list[0].description, "a thread");
    list[0].format = VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_UINT64_KHR;
    list[0].value.u64 = 0xFFFFFFFFFFFFFFFFULL;
    list[1].format = VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_INT64_KHR;
    list[1].value.i64 = -5;
    list[2].format = VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_FLOAT64_KHR;
    list[2].value.f64 = 0.25;
    list[3].format = VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_BOOL32_KHR;
    list[3].value.b32 = VK_TRUE;
    return VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL lost(VkDevice /*device*/, const VkPipelineInfoKHR* /*info*/,
                                    std::uint32_t* /*count*/, VkPipelineExecutablePropertiesKHR* /*list*/) {
    return VK_ERROR_OUT_OF_HOST_MEMORY;
}

void pretend(Context::State& context) {
    context.vk.GetPipelineExecutablePropertiesKHR = properties;
    context.vk.GetPipelineExecutableStatisticsKHR = statistics;
    askedExecutables = 0;
    isIncompleteOnce = false;
}

TEST(PipelineExecutables, AreReadWhole) {
    Context::State context;
    pretend(context);
    for (const bool incomplete : {false, true}) {
        isIncompleteOnce = incomplete;
        const auto read = must(readExecutables(context, VK_NULL_HANDLE));
        ASSERT_EQ(read.size(), 2U);
        const Renderer::PipelineStatistics::Executable& first = read.front();
        EXPECT_EQ(first.name, "main");
        EXPECT_EQ(first.description, "the code");
        EXPECT_EQ(first.stages, VK_SHADER_STAGE_COMPUTE_BIT);
        EXPECT_EQ(first.subgroupSize, 32U);
        ASSERT_EQ(first.statistics.size(), 4U);
        EXPECT_EQ(first.statistics[0].name, "Register Count");
        EXPECT_EQ(first.statistics[0].description, "a thread");
        EXPECT_EQ(std::get<std::uint64_t>(first.statistics[0].value), 0xFFFFFFFFFFFFFFFFULL);
        EXPECT_EQ(std::get<std::int64_t>(first.statistics[1].value), -5);
        EXPECT_EQ(std::get<double>(first.statistics[2].value), 0.25);
        EXPECT_TRUE(std::get<bool>(first.statistics[3].value));
        EXPECT_EQ(read.back().name, std::string(VK_MAX_DESCRIPTION_SIZE, 'x'));
        EXPECT_TRUE(read.back().statistics.empty());
    }
    EXPECT_EQ(askedExecutables, 2U);
    context.vk.GetPipelineExecutablePropertiesKHR = lost;
    EXPECT_EQ(mustFail(readExecutables(context, VK_NULL_HANDLE)).id, "vulkan-call");
}

TEST(PipelineExecutables, AreAskedOfTheDeviceWithTheRest) {
    for (const bool wanted : {false, true}) {
        const DeviceRequirements requirements(package::kAllTracers, false, false, wanted);
        EXPECT_EQ(std::ranges::count_if(requirements.extensions,
                                        [](const char* name) {
                                            return std::strcmp(name,
                                                               "VK_KHR_pipeline_executable_properties") == 0;
                                        }),
                  wanted ? 1 : 0);
        std::vector<VkStructureType> chain;
        for (const auto* link = static_cast<const VkBaseInStructure*>(requirements.features.pNext);
             link != nullptr; link = link->pNext) {
            chain.push_back(link->sType);
        }
        const auto has = [&](VkStructureType type) { return std::ranges::count(chain, type) == 1; };
        EXPECT_EQ(has(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PIPELINE_EXECUTABLE_PROPERTIES_FEATURES_KHR), wanted);
        EXPECT_TRUE(has(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_QUERY_FEATURES_KHR));
        EXPECT_TRUE(has(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_FEATURES_KHR));
        EXPECT_EQ(requirements.pipelineExecutables.pipelineExecutableInfo, wanted ? VK_TRUE : VK_FALSE);
    }
}

using StatisticsOfARenderer = DeviceTest;

TEST_F(StatisticsOfARenderer, NameEveryPipeline) {
    const Package package = load(makeDeviceSpec());
    TestScene scene = squareScene();
    const auto gpuScene = upload(package, scene);
    ASSERT_NE(gpuScene, nullptr);
    const auto renderer = makeRenderer(package, *gpuScene, package::kStrategyVisibility, 8, 8);
    ASSERT_NE(renderer, nullptr);
    EXPECT_EQ(mustFail(renderer->pipelineStatistics()).id, "pipeline-statistics");

    pretend(context().state());
    renderer->state().pipelines.captureStatistics = true;
    const auto told = must(renderer->pipelineStatistics());
    EXPECT_EQ(told.size(), renderer->footprint().pipelines);
    EXPECT_EQ(askedExecutables, told.size());
    std::vector<std::string> names;
    for (const Renderer::PipelineStatistics& pipeline : told) {
        EXPECT_EQ(pipeline.executables.size(), 2U);
        names.push_back(pipeline.name);
    }
    EXPECT_EQ(names.front(), "GBuffer");
    for (const char* name : {"FirstCount", "Trace", "Compose"}) {
        EXPECT_EQ(std::ranges::count(names, name), 1) << name;
    }
    std::ranges::sort(names);
    EXPECT_EQ(std::ranges::adjacent_find(names), names.end());
}

TEST_F(StatisticsOfARenderer, AreRefusedWhereTheDeviceHasNone) {
    const Package package = load(makeDeviceSpec());
    TestScene scene = squareScene();
    const auto gpuScene = upload(package, scene);
    ASSERT_NE(gpuScene, nullptr);
    ASSERT_FALSE(context().handles().pipelineStatistics);  // not asked for
    RendererOptions options;
    options.width = 8;
    options.height = 8;
    options.pipelineStatistics = true;
    EXPECT_EQ(mustFail(Renderer::create(context(), package, *gpuScene, options)).id, "pipeline-statistics");
}

}  // namespace
}  // namespace glint::test
