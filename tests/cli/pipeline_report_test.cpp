// Tests the output about pipelines and memory, as text and JSON.
#include "cli/render/device_report.h"

#include <gtest/gtest.h>

namespace glint {
namespace {

TEST(PipelineColumns, AreFoundInNamesOfSeveralDrivers) {
    using enum cli::PipelineColumn;
    const std::pair<const char*, cli::PipelineColumn> kExpected[] = {
        {"Register Count", Registers},
        {"Binary Size", CodeBytes},
        {"Stack Size", LocalMemory},
        {"Local Memory Size", LocalMemory},  // NVIDIA
        {"SGPRs", Registers},
        {"VGPRs", Registers},
        {"Spilled VGPRs", Spills},
        {"Code size", CodeBytes},
        {"Scratch size", LocalMemory},
        {"Instructions", Instructions},
        {"LDS size", None},  // RADV
        {"Instruction Count", Instructions},
        {"Spill Count", Spills},
        {"Fill Count", Spills},
        {"Scratch Memory Size", LocalMemory},
        {"Max live registers", Registers},
        {"Loop Count", None},  // ANV
    };
    for (const auto& [name, column] : kExpected) {
        EXPECT_EQ(cli::columnOf(name), column) << name;
    }
}

PipelineStatistics sample() {
    PipelineExecutable executable{"main", "the code", VK_SHADER_STAGE_COMPUTE_BIT, 32, {}};
    executable.statistics = {{"VGPRs", "", std::uint64_t{48}},
                             {"SGPRs", "", std::uint64_t{16}},
                             {"Instruction Count", "all", std::int64_t{-1}},
                             {"Share", "", 0.5},
                             {"Spilled", "", true}};
    return {"ShadeCase Glass", 1.5, true, {executable}};
}

TEST(PipelineTable, GathersWhatFitsAColumn) {
    const PipelineStatistics pipelines[] = {sample()};
    EXPECT_EQ(
        cli::tableOf(pipelines),
        "pipeline         executable  subgroup  registers  spills  local memory  instructions  code bytes\n"
        "ShadeCase Glass  main              32    48 + 16  true               -  -1                     -\n");
}

TEST(PipelineJson, HasEveryStatisticWithItsType) {
    cli::PipelineReport report;
    EXPECT_TRUE(statisticsToJson(report).is_null());
    EXPECT_TRUE(cacheToJson(report).is_null());
    report.statistics = {sample()};
    const base::Json json = statisticsToJson(report);
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
    const base::Json json = toJson(memory);
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
