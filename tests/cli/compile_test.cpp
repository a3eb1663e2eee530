#include "cli/command.h"
#include "cli/tiny_scene.h"

#include <algorithm>
#include <string>

namespace glint::testing {
namespace {

class CompileCommand : public TinySceneTest {};

TEST_F(CompileCommand, DryRunPlansAndWritesNothing) {
    const std::vector<std::string> before = filesBelow(path(""));
    const Outcome outcome = must(run({"compile", scene_, "--dry-run", "--json", "-o", "package"}));
    const nlohmann::json json = outcome.json();
    EXPECT_EQ(json.at("counts").at("materials"), 3);
    EXPECT_EQ(json.at("counts").at("keysPresent"), 2);
    EXPECT_EQ(json.at("counts").at("cases"), 2);
    EXPECT_TRUE(json.at("counts").at("uniqueSpirv").is_null());
    EXPECT_TRUE(json.at("output").is_null());
    EXPECT_EQ(json.at("shaders").size(), 2U);
    EXPECT_EQ(filesBelow(path("")), before);
}

TEST_F(CompileCommand, DryRunHonoursTheLimitOfShaders) {
    EXPECT_EQ(run({"compile", scene_, "--dry-run", "--max-shaders", "2"}).exit, 0);
    const Outcome refused = run({"compile", scene_, "--dry-run", "--max-shaders", "1"});
    EXPECT_EQ(refused.exit, 1);
    EXPECT_NE(refused.err.find("[max-shaders]"), std::string::npos) << refused.err;
    EXPECT_EQ(run({"compile", scene_, "--dry-run", "--max-shaders", "1", "--merge", "all"}).exit, 0);
}

TEST_F(CompileCommand, DryRunRefusesWhatIsRefusedWithoutIt) {
    std::filesystem::create_directories(path("precious"));
    writeText(path("precious/file"), "mine");
    const std::vector<std::vector<std::string>> lines{
        {"-o", "package", "--max-shaders", "1"},
        {"-o", "package", "--passes", "steps", "--answer", "surface", "--bounces", "2"},
        {"-o", "package", "--answer", "surface"},
        {"-o", "package", "--layers", "no-such-layer"},
        {"-o", "package", "--depfile", "a.d", "--depfile-target", "a*b"},
        {"-o", "precious"},
        {"--embed", "precious/file/a.cpp"}};
    for (const std::vector<std::string>& more : lines) {
        std::vector<std::string> line{"compile", scene_};
        line.insert(line.end(), more.begin(), more.end());
        const Outcome whole = run(line);
        line.emplace_back("--dry-run");
        const Outcome dry = run(line);
        EXPECT_NE(whole.exit, 0) << more.back();
        EXPECT_EQ(dry.exit, whole.exit) << more.back();
        EXPECT_EQ(dry.err, whole.err) << more.back();
    }
    EXPECT_FALSE(std::filesystem::exists(path("package")));
}

TEST_F(CompileCommand, ExplainWarnsOfSettingsThatChangeNothing) {
    const Outcome outcome = must(run({"explain", scene_, "--no-trust-textures"}));
    EXPECT_TRUE(has(outcome.err, "--no-trust-textures changes nothing: there are no textures"))
        << outcome.err;
    EXPECT_FALSE(has(run({"explain", scene_}).err, "setting-idle"));
}

TEST_F(CompileCommand, SettingsThatChangeNothingAreWarnedOf) {
    const auto warnings = [&](const std::vector<std::string>& more) {
        std::vector<std::string> found;
        const nlohmann::json report = runWith({"compile", scene_, "--dry-run", "--json"}, more).json();
        for (const nlohmann::json& diagnostic : report.at("diagnostics")) {
            if (diagnostic.at("id") == "setting-idle") {
                found.push_back(diagnostic.at("message"));
            }
        }
        return found;
    };
    using Found = std::vector<std::string>;
    EXPECT_EQ(
        warnings({"--hit-record", "packed", "--strategy", "uber"}),
        Found{"--hit-record packed changes nothing: --strategy uber sorts no hits and keeps no records"});
    EXPECT_EQ(warnings({"--hit-record", "packed"}), Found());
    EXPECT_EQ(warnings({"--hit-record", "full", "--texture-lod", "cones"}), Found());  // as usual
    EXPECT_EQ(warnings({"--texture-lod", "mip0", "--no-trust-textures"}),
              (Found{"--texture-lod mip0 changes nothing: there are no textures",
                     "--no-trust-textures changes nothing: there are no textures"}));
    EXPECT_EQ(warnings({"--precision-error", "0.5"}),
              Found{"--precision-error 0.5 changes nothing: only --precision auto reads it"});
    EXPECT_EQ(warnings({"--bounces", "4"}), Found());
    EXPECT_EQ(warnings({"--bounces", "4", "--effects", "shadow"}),
              Found{"--bounces 4 changes nothing: no effect sends rays whose hits are shaded"});
    EXPECT_EQ(warnings({"--lights", "4"}).size(), 1U);
    EXPECT_EQ(warnings({"--effects", "none"}), Found());
    writeText(path("device.json"), "{}");
    EXPECT_EQ(warnings({"--calibration", "device.json"}),
              Found{"--calibration changes nothing: only --strategy auto reads it"});
}

TEST_F(CompileCommand, JsonHasWhatIsPromised) {
    const Outcome outcome = must(run({"compile", scene_, "-o", "package", "--json"}));
    const nlohmann::json json = outcome.json();
    for (const char* name : {"materials", "keysPossible", "keysPresent", "cases", "uniqueSpirv"}) {
        EXPECT_TRUE(json.at("counts").at(name).is_number_integer()) << name;
    }
    EXPECT_GT(json.at("spirvBytes").get<int>(), 0);
    EXPECT_GT(json.at("packageBytes").get<int>(), json.at("spirvBytes").get<int>());
    EXPECT_GE(json.at("milliseconds").get<double>(), 0.0);
    EXPECT_EQ(json.at("output"), "package");
    EXPECT_TRUE(json.at("diagnostics").empty());
    for (const nlohmann::json& shader : json.at("shaders")) {
        EXPECT_TRUE(shader.at("name").is_string());
        ASSERT_FALSE(shader.at("stages").empty());
        for (const nlohmann::json& stage : shader.at("stages")) {
            EXPECT_GT(stage.at("bytes").get<int>(), 0);
        }
    }
    const std::vector<std::string> files = filesBelow(path("package"));
    for (const char* name : {"glint_tables.h", "manifest.json", "tables.bin"}) {
        EXPECT_TRUE(std::binary_search(files.begin(), files.end(), name)) << name;
    }
}

TEST_F(CompileCommand, JsonHasTheStagesOfTheManifest) {
    const Outcome outcome = must(run({"compile", scene_, "-o", "package", "--json", "--strategy", "all",
                                      "--tracer", "all", "--effects", "all"}));
    const nlohmann::json shaders = outcome.json().at("shaders");
    const nlohmann::json manifest = nlohmann::json::parse(readText(path("package/manifest.json")));
    ASSERT_EQ(shaders.size(), 2U);
    ASSERT_EQ(manifest.at("shaders").size(), shaders.size());
    for (std::size_t i = 0; i < shaders.size(); ++i) {
        const nlohmann::json& stages = shaders[i].at("stages");
        const nlohmann::json& expected = manifest.at("shaders")[i].at("stages");
        for (const char* stage : {"visibility", "visibility, ray-pipeline", "hit-shaders"}) {
            ASSERT_TRUE(stages.contains(stage)) << stages;
            for (const auto& [name, value] : stages.at(stage).items()) {
                EXPECT_EQ(value, expected.at(stage).at(name)) << stage << " " << name;
            }
        }
        EXPECT_EQ(stages.size(), expected.size());
    }
}

TEST_F(CompileCommand, HitShadersAloneAreOfThePipelineTracer) {
    ASSERT_EQ(run({"compile", scene_, "-o", "package", "--strategy", "hit-shaders"}).exit, 0);
    const nlohmann::json expected{"ray-pipeline"};
    EXPECT_EQ(nlohmann::json::parse(readText(path("package/manifest.json"))).at("tracers"), expected);
    EXPECT_EQ(run({"inspect", "package", "--json"}).json().at("tracers"), expected);
}

TEST_F(CompileCommand, ManifestHoldsSettingsAndVariant) {
    writeTinyScene(path(""), {.variants = true});
    ASSERT_EQ(
        run({"compile", scene_, "-o", "package", "--strategy", "uber", "--variant", "Day", "--hit-lobes",
             "base", "--no-energy-compensation", "--texture-lod", "mip0", "--precision", "16"})
            .exit,
        0);
    const nlohmann::json manifest = nlohmann::json::parse(readText(path("package/manifest.json")));
    EXPECT_EQ(manifest.at("scenes")[0].at("variant"), "Day");
    const nlohmann::json& settings = manifest.at("settings");
    EXPECT_EQ(settings.at("hitLobes"), nlohmann::json({"unlit", "specularGlossiness", "ior", "specular"}));
    EXPECT_EQ(settings.at("energyCompensation"), false);
    EXPECT_EQ(settings.at("textureLod"), "mip0");
    EXPECT_EQ(settings.at("precision"), 16);
    const nlohmann::json inspected = run({"inspect", "package", "--json"}).json();
    EXPECT_EQ(inspected.at("settings"), settings);
    EXPECT_EQ(inspected.at("scenes")[0].at("variant"), "Day");
}

TEST_F(CompileCommand, EmitChoosesWhatElseIsWritten) {
    ASSERT_EQ(run({"compile", scene_, "-o", "package", "--emit", "glsl"}).exit, 0);
    EXPECT_TRUE(std::filesystem::is_directory(path("package/glsl")));
    EXPECT_FALSE(std::filesystem::exists(path("package/glint_tables.h")));
}

TEST_F(CompileCommand, TextSummaryNamesWhatItDid) {
    const Outcome outcome = must(run({"compile", scene_, "-o", "package"}));
    EXPECT_TRUE(outcome.err.empty()) << outcome.err;
    for (const char* label : {"materials", "keys present", "cases", "unique SPIR-V", "package bytes"}) {
        EXPECT_NE(outcome.out.find(label), std::string::npos) << label;
    }
}

TEST_F(CompileCommand, WerrorRefusesBeforeAnythingIsWritten) {
    writeTinyScene(path(""), {.unknownExtension = true});
    const Outcome refused = run({"compile", scene_, "-o", "package", "--werror"});
    EXPECT_EQ(refused.exit, 1);
    EXPECT_NE(refused.err.find("error: the extension EXT_not_known_to_anyone"), std::string::npos)
        << refused.err;
    EXPECT_NE(refused.err.find("[werror]"), std::string::npos) << refused.err;
    EXPECT_FALSE(std::filesystem::exists(path("package")));

    const Outcome accepted = must(run({"compile", scene_, "--dry-run", "--json"}));
    EXPECT_EQ(accepted.json().at("diagnostics").size(), 1U);
    EXPECT_NE(accepted.err.find("EXT_not_known_to_anyone"), std::string::npos) << accepted.err;
}

TEST_F(CompileCommand, FailureLeavesTheOldPackage) {
    ASSERT_EQ(run({"compile", scene_, "-o", "package"}).exit, 0);
    const std::vector<std::string> files = filesBelow(path("package"));
    const std::string tables = readText(path("package/tables.bin"));
    writeText(scene_, "{ not JSON");
    const Outcome outcome = run({"compile", scene_, "-o", "package"});
    EXPECT_EQ(outcome.exit, 1);
    EXPECT_FALSE(outcome.err.empty());
    EXPECT_EQ(filesBelow(path("package")), files);
    EXPECT_EQ(readText(path("package/tables.bin")), tables);
}

TEST_F(CompileCommand, RefusesAFolderOfSomethingElse) {
    std::filesystem::create_directories(path("precious"));
    writeText(path("precious/thesis.tex"), "years of work");
    const Outcome outcome = run({"compile", scene_, "-o", "precious"});
    EXPECT_EQ(outcome.exit, 1);
    EXPECT_NE(outcome.err.find("precious"), std::string::npos) << outcome.err;
    EXPECT_EQ(filesBelow(path("precious")), std::vector<std::string>{"thesis.tex"});
}

TEST_F(CompileCommand, InspectShowsThePackage) {
    ASSERT_EQ(run({"compile", scene_, "-o", "package", "--merge", "none"}).exit, 0);
    const Outcome outcome = must(run({"inspect", "package", "--json"}));
    const nlohmann::json json = outcome.json();
    EXPECT_EQ(json.at("merge"), "none");
    EXPECT_EQ(json.at("alpha"), "opaque");
    EXPECT_EQ(json.at("strategies"), nlohmann::json({"uber", "visibility"}));
    EXPECT_EQ(json.at("counts").at("cases"), 2);
    EXPECT_EQ(json.at("counts").at("buckets"), 3);
    ASSERT_EQ(json.at("shaders").size(), 2U);
    std::vector<std::string> names;
    for (const nlohmann::json& shader : json.at("shaders")) {
        ASSERT_EQ(shader.at("materials").size(), 1U);
        names.push_back(shader.at("materials")[0].at("name"));
    }
    std::sort(names.begin(), names.end());
    EXPECT_EQ(names, (std::vector<std::string>{"Floor", "Wall"}));
    for (const nlohmann::json& module : json.at("modules")) {
        EXPECT_GT(module.at("instructions").get<int>(), 0) << module;
    }
    const Outcome text = must(run({"inspect", "package"}));
    EXPECT_NE(text.out.find("uber, visibility"), std::string::npos) << text.out;
}

TEST_F(CompileCommand, InspectRefusesADamagedPackage) {
    ASSERT_EQ(run({"compile", scene_, "-o", "package"}).exit, 0);
    const std::string tables = readText(path("package/tables.bin"));
    writeText(path("package/tables.bin"), tables.substr(0, tables.size() / 2));
    const Outcome cut = run({"inspect", "package"});
    EXPECT_EQ(cut.exit, 1);
    EXPECT_NE(cut.err.find("error: "), std::string::npos) << cut.err;

    writeText(path("package/tables.bin"), tables);
    writeText(path("package/manifest.json"), "[]");
    const Outcome manifest = run({"inspect", "package"});
    EXPECT_EQ(manifest.exit, 1);
    EXPECT_NE(manifest.err.find("[manifest-format]"), std::string::npos) << manifest.err;
}

}  // namespace
}  // namespace glint::testing
