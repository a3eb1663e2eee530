// glint inspect --pipelines: on the device of the tests, and on RADV's null device, which compiles for GPUs
// that are not there.
#include "cli/command.h"
#include "cli/many_keys.h"
#include "cli/schemas.h"
#include "cli/tiny_scene.h"

#include <filesystem>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace glint::testing {
namespace {

using Json = nlohmann::json;
using Variables = std::vector<std::pair<std::string, std::string>>;

// Returns the variables that make Mesa's driver of Radeon GPUs compile for that family, whatever is in the
// machine; empty where the driver is not installed.
Variables nullDevice(const std::string& family) {
    for (const char* const file :
         {"/usr/share/vulkan/icd.d/radeon_icd.json", "/usr/share/vulkan/icd.d/radeon_icd.x86_64.json"}) {
        if (std::filesystem::exists(file)) {
            return {{"VK_DRIVER_FILES", file},
                    {"VK_ICD_FILENAMES", file},
                    {"RADV_FORCE_FAMILY", family},
                    {"MESA_SHADER_CACHE_DISABLE", "true"}};
        }
    }
    return {};
}

class Pipelines : public CommandTest {
protected:
    void compile(const std::string& scene, const std::string& package,
                 const std::vector<std::string>& options) const {
        must(runWith({"compile", scene, "-o", package}, options));
    }
    Json report(const std::vector<std::string>& options, const Variables& variables = {}) const {
        std::vector<std::string> line{"inspect", "package", "--pipelines", "--json"};
        line.insert(line.end(), options.begin(), options.end());
        const Outcome outcome = must(run(line, variables));
        Json printed = outcome.json();
        expectFits("inspect", printed);
        return printed;
    }
};

// A module that no pipeline has would never run.
TEST_F(Pipelines, HaveEveryModuleOfThePackage) {
    writeTinyScene(path(""), {.masked = true, .animated = true});
    compile("scene.gltf", "package", {"--strategy", "all", "--tracer", "all", "--fallback"});
    const Json all = report({"--validate"});
    std::set<std::string> made;
    std::set<std::string> names;
    for (const Json& pipeline : all.at("pipelines")) {
        EXPECT_TRUE(pipeline.at("failure").is_null()) << pipeline;
        names.insert(pipeline.at("name").get<std::string>() + " " + pipeline.at("tracer").dump());
        for (const Json& module : pipeline.at("modules")) {
            made.insert(module.at("file").get<std::string>());
        }
    }
    EXPECT_EQ(names.size(), all.at("pipelines").size()) << "names and tracers tell pipelines apart";
    for (const Json& module : run({"inspect", "package", "--json"}).json().at("modules")) {
        const std::string file = module.at("file").get<std::string>();
        EXPECT_TRUE(made.contains(file) || file.ends_with("gbuffer.frag.spv")) << file;
    }
}

TEST_F(Pipelines, OfAHostNeedNoSceneEither) {
    writeTinyScene(path(""));
    compile("scene.gltf", "package", {"--passes", "steps", "--tracer", "all", "--strategy", "all"});
    const Json all = report({"--validate"});
    EXPECT_GT(all.at("pipelines").size(), 4U);
}

TEST_F(Pipelines, RefuseFilesThatAreNoReports) {
    writeTinyScene(path(""));
    compile("scene.gltf", "package", {"--strategy", "uber"});
    writeText(path("wrong.json"), R"({"format": "glint-pipelines", "version": 2})");
    writeText(path("budget.json"), R"({"format": "glint-pipeline-budget",
                                       "budgets": [{"pipelines": "*", "spils": 0}]})");
    const std::pair<std::vector<std::string>, const char*> wrong[] = {
        {{"--compare", "wrong.json"}, "wrong.json#/version: error"},
        {{"--compare", "none.json"}, "[file-open]"},
        {{"--budget", "budget.json"}, "budget.json#/budgets/0/spils: error"}};
    for (const auto& [options, message] : wrong) {
        const Outcome outcome = runWith({"inspect", "package", "--pipelines"}, options);
        EXPECT_EQ(outcome.exit, 1) << outcome.err;
        EXPECT_TRUE(has(outcome.err, message)) << outcome.err;
    }
    EXPECT_EQ(run({"inspect", "package", "--budget", "budget.json"}).exit, 2) << "needs --pipelines";
}

// Compiles three packages with the compilers of GPUs. The limits are those of today's shaders (5 of 16
// subgroups in flight; 10 are the aim): a shader that needs more registers, that spills or that takes memory
// for them is slower on every GPU of the family.
class PipelineBudgets : public Pipelines {
protected:
    void SetUp() override {
        Pipelines::SetUp();
        radeon_ = nullDevice("navi31");
        if (radeon_.empty()) {
            GTEST_SKIP() << "Mesa's driver of Radeon GPUs is not installed";
        }
    }
    // Checks "package" against rules of --budget.
    Outcome check(const Json& rules) const {
        writeText(path("budget.json"), Json{{"format", "glint-pipeline-budget"}, {"budgets", rules}}.dump());
        return run({"inspect", "package", "--pipelines", "--budget", "budget.json", "--werror"}, radeon_);
    }
    void expectWithin(const Json& rules) const {
        must(check(rules));
    }

    Variables radeon_;
};

const Json kNoSpills{{"pipelines", "*"}, {"spills", 0}, {"scratchBytes", 0}};

TEST_F(PipelineBudgets, HoldForMaskedGeometryAndMotion) {
    writeTinyScene(path(""), {.masked = true, .animated = true});
    compile("scene.gltf", "package", {"--strategy", "uber,visibility", "--tracer", "ray-query"});
    expectWithin(Json::array({{{"pipelines", "ShadeCase*"}, {"occupancy", 0.3}}, kNoSpills}));
}

TEST_F(PipelineBudgets, HoldForCasesOfSeveralLobes) {
    writeManyKeys(path("keys"), {{}, {"clearcoat"}, {"sheen"}, {"textured"}, {"clearcoat", "sheen"}});
    compile("keys/scene.gltf", "package", {"--strategy", "visibility", "--merge", "none"});
    expectWithin(Json::array({{{"pipelines", "ShadeCase*"}, {"occupancy", 0.3}}, kNoSpills}));
}

TEST_F(PipelineBudgets, HoldForAMergedCaseWithDeferredShadows) {
    writeManyKeys(path("keys"));
    compile("keys/scene.gltf", "package",
            {"--strategy", "sorted-uber,visibility", "--merge", "all", "--shadows", "deferred"});
    expectWithin(Json::array({{{"pipelines", "ShadeCase*"}, {"occupancy", 0.3}}, kNoSpills}));
}

TEST_F(PipelineBudgets, NameWhatExceedsThem) {
    writeTinyScene(path(""));
    compile("scene.gltf", "package", {"--strategy", "uber"});
    const Outcome outcome = check(Json::array({{{"pipelines", "Compose"}, {"registers", 100}},
                                               {{"pipelines", "*"}, {"registers", 1}, {"occupancy", 1.1}}}));
    EXPECT_EQ(outcome.exit, 1);
    EXPECT_TRUE(has(outcome.err, "error: UberShade (uber.spv) on ")) << outcome.err;
    EXPECT_TRUE(has(outcome.err, "registers is ")) << outcome.err;
    EXPECT_TRUE(has(outcome.err, "and the budget is at most 1")) << outcome.err;
    EXPECT_TRUE(has(outcome.err, "and the budget is at least 1.1")) << outcome.err;
    EXPECT_FALSE(has(outcome.err, "Compose (compose.spv) on Null hardware (RADV NAVI31): registers"))
        << "the first rule decides: " << outcome.err;
    const Outcome other = check(Json::array({{{"pipelines", "Nothing"}, {"spills", 0}},
                                             {{"pipelines", "*"}, {"device", "Adreno"}, {"spills", 0}}}));
    EXPECT_EQ(other.exit, 1);
    EXPECT_TRUE(has(other.err, "budget.json#/budgets/0: error: fits no pipeline")) << other.err;
    EXPECT_FALSE(has(other.err, "budgets/1")) << other.err;
}

TEST_F(PipelineBudgets, AndReportsOfTwoDevicesSideBySide) {
    writeTinyScene(path(""));
    compile("scene.gltf", "package", {"--strategy", "uber,visibility"});
    const Json before = report({"--sort", "registers"}, nullDevice("navi21"));
    const Json& device = before.at("device");
    EXPECT_EQ(device.at("type"), "gpu");
    EXPECT_EQ(device.at("statistics"), true);
    for (const Json& pipeline : before.at("pipelines")) {
        const Json& facts = pipeline.at("facts");
        EXPECT_GT(facts.at("registers"), 0) << pipeline;
        EXPECT_GT(facts.at("codeBytes"), 0) << pipeline;
        EXPECT_GT(facts.at("cost"), 0) << pipeline;
        EXPECT_GT(facts.at("occupancy"), 0.05) << pipeline;
        EXPECT_LE(facts.at("occupancy"), 1.0) << pipeline;
    }
    EXPECT_GE(before.at("pipelines")[0].at("facts").at("registers"),
              before.at("pipelines")[1].at("facts").at("registers"));
    writeText(path("before.json"), before.dump());
    const Json both = report({"--compare", "before.json"}, radeon_);
    EXPECT_EQ(both.at("compared").at("device").at("name"), device.at("name"));
    EXPECT_NE(both.at("device").at("name"), device.at("name"));
    const Outcome text =
        must(run({"inspect", "package", "--pipelines", "--compare", "before.json"}, radeon_));
    EXPECT_TRUE(has(text.out, " → ")) << text.out;
}

}  // namespace
}  // namespace glint::testing
