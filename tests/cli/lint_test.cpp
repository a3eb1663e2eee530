#include "cli/command.h"
#include "cli/tiny_scene.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

namespace glint::testing {
namespace {

namespace fs = std::filesystem;

// Returns a module with one compute entry point that does nothing, or of another stage with `model`.
std::string emptyModule(std::uint32_t model = 5) {
    constexpr std::uint32_t kShader = 1;
    constexpr std::uint32_t kRayTracing = 4479;
    const std::vector<std::uint32_t> words = {
        0x07230203,
        0x00010500,
        0,
        5,
        0,  //
        2U << 16U | 17,
        model == 5 ? kShader : kRayTracing,  // OpCapability
        6U << 16U | 10,
        0x5F565053,
        0x5F52484B,
        0x5F796172,
        0x63617274,
        0x00676E69,  // OpExtension "SPV_KHR_ray_tracing"
        3U << 16U | 14,
        0,
        1,  // OpMemoryModel
        5U << 16U | 15,
        model,
        1,
        0x6E69616D,
        0,  // OpEntryPoint "main"
        2U << 16U | 19,
        2,  // OpTypeVoid
        3U << 16U | 33,
        3,
        2,  // OpTypeFunction
        5U << 16U | 54,
        2,
        1,
        0,
        3,  // OpFunction
        2U << 16U | 248,
        4,  // OpLabel
        1U << 16U | 253,
        1U << 16U | 56,  // OpReturn, OpFunctionEnd
    };
    return {reinterpret_cast<const char*>(words.data()), words.size() * sizeof(std::uint32_t)};
}

// Replaces Arm's program: it prints a report like malioc 8, with its own arguments as the core.
constexpr const char* kMalioc = R"(#!/bin/sh
cat <<END
{"schema": {"name": "performance", "version": 0},
 "shaders": [{
  "filename": "x", "hardware": {"architecture": "Valhall", "core": "$*", "revision": "r0p0"},
  "shader": {"api": "Vulkan", "type": "Compute"},
  "properties": [{"name": "has_side_effects", "value": true}, {"name": "has_slow_ray_traversal", "value": true}],
  "variants": [{
   "name": "Main",
   "performance": {
    "pipelines": ["arith_total", "load_store", "texture"],
    "longest_path_cycles": {"bound_pipelines": ["load_store"], "cycle_count": [2.5, 7.25, null]}},
   "properties": [{"name": "work_registers_used", "value": 42}, {"name": "stack_spill_bytes", "value": 16}]}]}]}
END
)";

class LintCommand : public CommandTest {
protected:
    // Makes an executable `malioc` in its own folder, and returns PATH with that folder first.
    std::string writeMalioc(const std::string& script) const {
        fs::create_directories(path("bin"));
        writeText(path("bin/malioc"), script);
        fs::permissions(path("bin/malioc"), fs::perms::owner_all);
        const char* const rest = std::getenv("PATH");
        return path("bin").string() + ":" + (rest == nullptr ? "/usr/bin:/bin" : rest);
    }
    // Runs without any malioc that this machine may have.
    Outcome runWithout(const std::vector<std::string>& arguments) const {
        return run(arguments, {{"PATH", path("nowhere").string()}});
    }
};

TEST_F(LintCommand, OwnPackagesAreClean) {
    const std::string scene = writeTinyScene(path("")).string();
    ASSERT_EQ(
        run({"compile", scene, "-o", "package", "--strategy", "all", "--merge", "none", "--effects", "all"})
            .exit,
        0);
    const Outcome outcome = must(runWithout({"lint", "package", "--json", "--werror"}));
    const nlohmann::json json = outcome.json();
    EXPECT_EQ(json.at("errors"), 0);
    EXPECT_EQ(json.at("warnings"), 0) << outcome.err;
    EXPECT_TRUE(json.at("malioc").is_null());
    const nlohmann::json manifest = nlohmann::json::parse(readText(path("package/manifest.json")));
    EXPECT_EQ(json.at("modules").size(), manifest.at("counts").at("uniqueSpirv").get<std::size_t>());
    int rayQueries = 0;
    std::vector<std::string> names;
    for (const nlohmann::json& module : json.at("modules")) {
        rayQueries += module.at("statistics").at("rayQueries").get<int>();
        names.push_back(module.at("name"));
        EXPECT_EQ(module.at("stages").size(), 1U);
    }
    EXPECT_GE(rayQueries, 4);
    EXPECT_NE(std::ranges::find(names, "UberShade"), names.end());
    const std::string shader = manifest.at("shaders").at(0).at("name");
    EXPECT_NE(std::ranges::find(names, shader + " visibility"), names.end());
}

TEST_F(LintCommand, LoopsOfAlphaTestsAreWarnings) {
    const std::string scene = writeTinyScene(path("")).string();
    ASSERT_EQ(run({"compile", scene, "-o", "package", "--strategy", "uber", "--alpha", "tested"}).exit, 0);
    const Outcome outcome = must(runWithout({"lint", "package"}));
    EXPECT_TRUE(has(outcome.err, "uber.spv: warning: ")) << outcome.err;
    EXPECT_TRUE(has(outcome.err, "[query-proceed-loop]")) << outcome.err;
    EXPECT_FALSE(has(outcome.err, "[query-flags]")) << outcome.err;
    EXPECT_FALSE(has(outcome.out, "UberShade")) << outcome.out;
    EXPECT_TRUE(has(runWithout({"lint", "package", "--verbose"}).out, "UberShade"));
    EXPECT_TRUE(has(outcome.out, "malioc not found: no cycle estimates")) << outcome.out;
    EXPECT_EQ(runWithout({"lint", "package", "--werror"}).exit, 1);
}

TEST_F(LintCommand, BudgetsAreErrorsAbove) {
    const std::string scene = writeTinyScene(path("")).string();
    ASSERT_EQ(run({"compile", scene, "-o", "package", "--strategy", "uber"}).exit, 0);
    const std::string uber = "package/uber.spv";
    const nlohmann::json statistics =
        runWithout({"lint", uber, "--json"}).json().at("modules").at(0).at("statistics");
    const auto limit = [&](const char* option, const char* name, int offset) {
        const int count = statistics.at(name).get<int>();
        return runWithout({"lint", uber, option, std::to_string(count + offset)});
    };
    EXPECT_EQ(limit("--max-instructions", "instructions", 0).exit, 0);
    EXPECT_EQ(limit("--max-ray-queries", "rayQueries", 0).exit, 0);
    EXPECT_EQ(limit("--max-texture-fetches", "textureFetches", 0).exit, 0);
    const Outcome instructions = limit("--max-instructions", "instructions", -1);
    EXPECT_EQ(instructions.exit, 1);
    EXPECT_TRUE(has(instructions.err, "uber.spv: error: has ")) << instructions.err;
    EXPECT_TRUE(has(instructions.err, "[budget-instructions]")) << instructions.err;
    const Outcome queries = limit("--max-ray-queries", "rayQueries", -1);
    EXPECT_EQ(queries.exit, 1);
    EXPECT_TRUE(has(queries.err, "[budget-ray-queries]")) << queries.err;
}

TEST_F(LintCommand, BadFilesAreNamedAndTheOthersLinted) {
    const std::string good = emptyModule();
    fs::create_directories(path("set"));
    writeText(path("set/a_good.spv"), good);
    writeText(path("set/b_empty.spv"), "");
    writeText(path("set/c_bytes.spv"), good.substr(0, good.size() - 2));
    writeText(path("set/d_magic.spv"), std::string(good).replace(0, 4, "abcd"));
    writeText(path("set/e_cut.spv"), good.substr(0, good.size() - 12));
    writeText(path("set/f_end.spv"), good.substr(0, good.size() - 4));
    std::string bound = good;
    bound[12] = 2;
    writeText(path("set/g_bound.spv"), bound);
    const Outcome outcome = runWithout({"lint", "set", "--json"});
    EXPECT_EQ(outcome.exit, 1);
    const nlohmann::json modules = outcome.json().at("modules");
    ASSERT_EQ(modules.size(), 7U);
    EXPECT_EQ(modules.at(0).at("statistics").at("functions"), 1) << outcome.err;
    for (std::size_t i = 1; i < modules.size(); ++i) {
        const nlohmann::json& module = modules.at(i);
        EXPECT_TRUE(module.at("statistics").is_null()) << module;
        ASSERT_EQ(module.at("findings").size(), 1U) << module;
        const nlohmann::json& finding = module.at("findings").at(0);
        EXPECT_EQ(finding.at("severity"), "error");
        EXPECT_EQ(finding.at("id"), i < 5 ? "spirv-format" : "spirv-invalid") << finding;
        EXPECT_EQ(finding.at("where"), module.at("file"));
        EXPECT_FALSE(finding.at("hint").get<std::string>().empty());
    }
}

TEST_F(LintCommand, PathsThatHoldNothingFail) {
    fs::create_directories(path("none"));
    const Outcome missing = runWithout({"lint", "absent.spv"});
    EXPECT_EQ(missing.exit, 1);
    EXPECT_TRUE(missing.err.starts_with("absent.spv: error: is not there")) << missing.err;
    EXPECT_TRUE(has(runWithout({"lint", "none"}).err, "none: error: holds no SPIR-V file"));
    writeText(path("none/manifest.json"), "[");
    EXPECT_TRUE(has(runWithout({"lint", "none"}).err, "[manifest-format]"));
    writeText(path("none/manifest.json"), R"({"passes": [{"role": "Gone", "file": "gone.spv"}]})");
    const Outcome gone = runWithout({"lint", "none"});
    EXPECT_EQ(gone.exit, 1);
    EXPECT_TRUE(has(gone.err, "none/gone.spv: error: ")) << gone.err;
}

TEST_F(LintCommand, ManyClosestHitShadersAreAWarning) {
    constexpr std::uint32_t kClosestHit = 5316;
    fs::create_directories(path("pipeline"));
    for (int i = 0; i < 10; ++i) {
        writeText(path("pipeline/" + std::to_string(i) + ".spv"), emptyModule(kClosestHit));
    }
    EXPECT_EQ(runWithout({"lint", "pipeline", "--werror"}).exit, 0);
    writeText(path("pipeline/eleventh.spv"), emptyModule(kClosestHit));
    const Outcome outcome = must(runWithout({"lint", "pipeline", "--json"}));
    const nlohmann::json findings = outcome.json().at("findings");
    ASSERT_EQ(findings.size(), 1U) << outcome.err;
    EXPECT_EQ(findings.at(0).at("id"), "ray-pipeline-shaders");
    EXPECT_EQ(findings.at(0).at("where"), "pipeline");
    EXPECT_TRUE(has(findings.at(0).at("message"), "11 closest-hit shaders"));
}

TEST_F(LintCommand, MaliocEstimatesComputeShaders) {
    constexpr std::uint32_t kClosestHit = 5316;
    const std::string variable = writeMalioc(kMalioc);
    writeText(path("compute.spv"), emptyModule());
    writeText(path("hit.spv"), emptyModule(kClosestHit));
    const std::vector<std::string> arguments{"lint", "compute.spv", "hit.spv", "--core", "Mali-G710"};
    std::vector<std::string> asJson = arguments;
    asJson.emplace_back("--json");
    const Outcome outcome = must(run(asJson, {{"PATH", variable}}));
    const nlohmann::json json = outcome.json();
    EXPECT_EQ(json.at("malioc"), path("bin/malioc").string());
    const nlohmann::json& estimate = json.at("modules").at(0).at("malioc");
    EXPECT_EQ(estimate.at("longestCycles"), 7.25);
    EXPECT_EQ(estimate.at("boundPipelines"), nlohmann::json({"load_store"}));
    EXPECT_EQ(estimate.at("cycles"), nlohmann::json({{"arith_total", 2.5}, {"load_store", 7.25}}));
    EXPECT_EQ(estimate.at("workRegisters"), 42);
    EXPECT_EQ(estimate.at("spills"), true);
    EXPECT_EQ(estimate.at("spillBytes"), 16);
    EXPECT_EQ(estimate.at("slowRayTraversal"), true);
    EXPECT_TRUE(estimate.at("occupancy").is_null());
    EXPECT_EQ(estimate.at("core"),
              "--vulkan --compute --format json --core Mali-G710 " + path("compute.spv").string());
    EXPECT_TRUE(json.at("modules").at(1).at("malioc").is_null());
    const Outcome text = run(arguments, {{"PATH", variable}});
    EXPECT_TRUE(has(text.out, "7.25")) << text.out;
    EXPECT_TRUE(has(text.out, "traversal") && has(text.out, "slow")) << text.out;
    EXPECT_FALSE(has(text.out, "malioc not found")) << text.out;
    const Outcome named = runWithout({"lint", "compute.spv", "--malioc", path("bin/malioc").string()});
    // The script's own cat is not in that PATH, so malioc is found but prints no report.
    EXPECT_TRUE(has(named.err, "compute.spv: warning: malioc ")) << named.err;
}

TEST_F(LintCommand, MaliocThatFailsIsAWarning) {
    writeText(path("compute.spv"), emptyModule());
    const auto lintWith = [&](const std::string& script) {
        return run({"lint", "compute.spv"}, {{"PATH", writeMalioc(script)}});
    };
    const Outcome error = must(lintWith(R"(#!/bin/sh
echo '{"shaders": [{"errors": ["no such core"]}]}'; exit 1
)"));
    EXPECT_TRUE(has(error.err, "compute.spv: warning: malioc: no such core")) << error.err;
    EXPECT_TRUE(has(lintWith("#!/bin/sh\necho Segmentation fault\n").err, "no report: Segmentation fault"));
    EXPECT_TRUE(has(lintWith("#!/bin/sh\n").err, "[malioc]"));
    EXPECT_TRUE(has(lintWith("#!/nonexistent\n").err, "can't be run")) << "an interpreter that is not there";
    // Members that a version leaves out cause no error.
    const Outcome bare = lintWith("#!/bin/sh\necho '{\"shaders\": [{\"variants\": [{}]}]}'\n");
    EXPECT_TRUE(bare.err.empty()) << bare.err;
    EXPECT_EQ(runWithout({"lint", "compute.spv", "--malioc", "./absent"}).exit, 1);
}

TEST_F(LintCommand, MistakesOfTheCommandLineExitWithTwo) {
    EXPECT_EQ(run({"lint"}).exit, 2);
    EXPECT_EQ(run({"lint", ""}).exit, 2);
    EXPECT_EQ(run({"lint", "a.spv", "--max-instructions", "-1"}).exit, 2);
    const Outcome slip = run({"lint", "a.spv", "--max-ray-querys", "1"});
    EXPECT_EQ(slip.exit, 2);
    EXPECT_TRUE(has(slip.err, "did you mean --max-ray-queries?")) << slip.err;
}

}  // namespace
}  // namespace glint::testing
