// Tests the output about pipelines and memory, as text and JSON.
#include "cli/render/report.h"

#include <gtest/gtest.h>

namespace glint {
namespace {

Renderer::PipelineStatistics::Statistic number(const char* name, double value) {
    return {name, "", value};
}

// The names are those of the drivers.
TEST(PipelineFacts, MeanTheSameOnEveryDevice) {
    using inspect::factsOf;
    const Renderer::PipelineStatistics::Executable radv{
        "compute",
        "",
        VK_SHADER_STAGE_COMPUTE_BIT,
        64,
        {number("SGPRs", 128), number("VGPRs", 192), number("Spilled SGPRs", 1), number("Spilled VGPRs", 2),
         number("Code size", 4096), number("LDS size", 512), number("Scratch size", 640),
         number("Subgroups per SIMD", 8), number("Latency", 4000), number("Inverse Throughput", 1000)}};
    const inspect::PipelineFacts amd = factsOf(radv);
    EXPECT_EQ(amd.registers, 192.0);
    EXPECT_EQ(amd.spills, 3.0);
    EXPECT_EQ(amd.scratchBytes, 10.0);
    EXPECT_EQ(amd.codeBytes, 4096.0);
    EXPECT_EQ(amd.occupancy, 0.25);  // 4 of 16 subgroups of 64 lanes
    EXPECT_EQ(amd.cost, 1000.0);

    const Renderer::PipelineStatistics::Executable turnip{
        "main",
        "",
        VK_SHADER_STAGE_COMPUTE_BIT,
        128,
        {number("Max Waves Per Core", 8), number("Instruction Count", 1000), number("Code size", 500),
         number("Registers used", 24), number("STP Count", 3), number("LDP Count", 4),
         number("Estimated cycles stalled on SS", 800), number("Estimated cycles stalled on SY", 1600)}};
    const inspect::PipelineFacts adreno = factsOf(turnip);
    EXPECT_EQ(adreno.registers, 96.0);
    EXPECT_EQ(adreno.spills, 7.0);
    EXPECT_FALSE(adreno.scratchBytes);
    EXPECT_EQ(adreno.codeBytes, 4.0 * (500 + 65536)) << "the driver's number wraps";
    EXPECT_EQ(adreno.occupancy, 0.5);
    EXPECT_EQ(adreno.cost, 650.0);

    const Renderer::PipelineStatistics::Executable anv{
        "SIMD16 compute",
        "",
        VK_SHADER_STAGE_COMPUTE_BIT,
        16,
        {number("Instruction Count", 100), number("Cycle Count", 500), number("Spill Count", 7),
         number("Fill Count", 9), number("Scratch Memory Size", 1024), number("Max live registers", 120)}};
    const inspect::PipelineFacts arc = factsOf(anv);
    EXPECT_EQ(arc.registers, 60.0);
    EXPECT_EQ(arc.spills, 7.0);
    EXPECT_EQ(arc.scratchBytes, 64.0);
    EXPECT_EQ(arc.codeBytes, 1600.0);
    EXPECT_EQ(arc.occupancy, 0.5);
    EXPECT_EQ(arc.cost, 2000.0);

    const Renderer::PipelineStatistics::Executable nvidia{
        "main",
        "",
        VK_SHADER_STAGE_COMPUTE_BIT,
        32,
        {number("Register Count", 96), number("Binary Size", 5000), number("Stack Size", 0),
         number("Local Memory Size", 16)}};
    const inspect::PipelineFacts other = factsOf(nvidia);
    EXPECT_EQ(other.registers, 96.0);
    EXPECT_EQ(other.codeBytes, 5000.0);
    EXPECT_EQ(other.scratchBytes, 16.0);
    EXPECT_FALSE(other.spills);
    EXPECT_FALSE(other.occupancy);
    EXPECT_FALSE(other.cost);

    const Renderer::PipelineStatistics::Executable parts[] = {radv, radv};
    const inspect::PipelineFacts pipeline = factsOf(parts);
    EXPECT_EQ(pipeline.registers, 192.0);
    EXPECT_EQ(pipeline.spills, 6.0);
    EXPECT_EQ(pipeline.occupancy, 0.25);
}

Renderer::PipelineStatistics sample() {
    Renderer::PipelineStatistics::Executable executable{
        "main", "the code", VK_SHADER_STAGE_COMPUTE_BIT, 32, {}};
    executable.statistics = {{"VGPRs", "", std::uint64_t{48}},
                             {"SGPRs", "", std::uint64_t{16}},
                             {"Instruction Count", "all", std::int64_t{-1}},
                             {"Share", "", 0.5},
                             {"Spilled", "", true}};
    return {"ShadeCase Glass", 1.5, true, {executable}};
}

TEST(PipelineTable, HasTheFacts) {
    const Renderer::PipelineStatistics pipelines[] = {sample()};
    EXPECT_EQ(cli::tableOf(pipelines),
              "pipeline         executable  subgroup  registers  spills  scratch  code  occupancy  cost\n"
              "ShadeCase Glass  main              32         48       1        -     -          -     -\n");
}

TEST(PipelineJson, HasEveryStatisticWithItsType) {
    cli::PipelineReport report;
    EXPECT_TRUE(base::jsonOf(report.statistics).is_null());
    report.statistics = {sample()};
    const base::Json json = base::jsonOf(report.statistics);
    ASSERT_EQ(json.size(), 1U);
    EXPECT_EQ(json[0].at("name"), "ShadeCase Glass");
    EXPECT_EQ(json[0].at("creationMs"), 1.5);
    EXPECT_EQ(json[0].at("cacheHit"), true);
    const base::Json& executable = json[0].at("executables").at(0);
    EXPECT_EQ(executable.at("stages"), base::Json::array({"compute"}));
    EXPECT_EQ(executable.at("subgroupSize"), 32);
    const base::Json& statistics = executable.at("statistics");
    ASSERT_EQ(statistics.size(), 5U);
    EXPECT_EQ(statistics[0].dump(), R"({"name":"VGPRs","description":"","format":"uint64","value":48})");
    EXPECT_EQ(statistics[2].dump(),
              R"({"name":"Instruction Count","description":"all","format":"int64","value":-1})");
    EXPECT_EQ(statistics[3].dump(), R"({"name":"Share","description":"","format":"float64","value":0.5})");
    EXPECT_EQ(statistics[4].dump(), R"({"name":"Spilled","description":"","format":"bool","value":true})");
}

TEST(MemoryTable, SumsWhatItLists) {
    cli::MemoryReport memory;
    memory.frame = {{"surface", MemoryUse::Device, true, 1, 1000},
                    {"constants", MemoryUse::Upload, false, 1, 24}};
    memory.scene = {{"textures", MemoryUse::Device, true, 3, 500},
                    {"poses on their way", MemoryUse::Upload, false, 1, 8}};
    const base::Json json = base::jsonOf(memory);
    EXPECT_EQ(json.at("frameBytes"), 1024);
    EXPECT_EQ(json.at("sceneBytes"), 508);
    EXPECT_EQ(json.at("bytes"), 1532);
    EXPECT_EQ(json.at("scene").at(0).dump(),
              R"({"name":"textures","kind":"image","use":"device","count":3,"bytes":500})");
    const std::string text = toText(memory);
    EXPECT_NE(text.find("3 images"), std::string::npos) << text;
    EXPECT_NE(text.find("1532"), std::string::npos) << text;
}

}  // namespace
}  // namespace glint
