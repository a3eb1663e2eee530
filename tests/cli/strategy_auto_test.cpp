// Tests --strategy auto, --calibration and the output of explain about strategies, with planted costs of
// devices.
#include "cli/command.h"
#include "cli/planted_device.h"
#include "cli/schemas.h"
#include "cli/tiny_scene.h"

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace glint::testing {
namespace {

using Json = nlohmann::json;

// A table of a GPU on which a case costs 1000 cycles, or `deferred` without its shadow ray, which costs 300,
// or `half` in 16 bits.
Json plantedTable(double deferred, double half) {
    const auto module = [](const char* role, double cost) {
        return Json{{"role", role},     {"tracer", "ray-query"}, {"modules", 1},  {"cost", cost},
                    {"weight", 1000.0}, {"occupancy", 0.5},      {"spills", 0.0}, {"scratchBytes", 0.0}};
    };
    const auto package = [](const char* shadows, int precision, std::vector<Json> summary) {
        return Json{{"package", "planted"},
                    {"merge", "none"},
                    {"shadows", shadows},
                    {"precision", precision},
                    {"summary", std::move(summary)}};
    };
    return {{"format", "glint-gpu"},
            {"version", 1},
            {"name", "planted"},
            {"device", "Planted"},
            {"driver", "none"},
            {"subgroupSize", 32},
            {"packages",
             {package("inline", 32, {module("ShadeCase", 1000.0)}),
              package("deferred", 32, {module("ShadeCase", deferred), module("ShadowTrace", 300.0)}),
              package("inline", 16, {module("ShadeCase", half)})}}};
}

class StrategyAuto : public TinySceneTest {
protected:
    // Writes the file of a device on which only `strategy` is fast.
    std::string device(const std::string& strategy) const {
        const std::filesystem::path file = path(strategy + ".json");
        writeText(file, plantedDevice(strategy).dump());
        return file.string();
    }
    Json compile(std::vector<std::string> options) const {
        options.insert(options.begin(), {"compile", "scene.gltf", "-o", "package", "--json"});
        const Outcome outcome = must(run(options));
        return outcome.json();
    }
    Json manifest() const {
        return Json::parse(readText(path("package/manifest.json")));
    }
    void expectRefused(const Json& file, const std::string& message) const {
        writeText(path("bad.json"), file.dump());
        const Outcome outcome = run({"explain", "scene.gltf", "--calibration", "bad.json"});
        EXPECT_EQ(outcome.exit, 1);
        EXPECT_TRUE(outcome.out.empty()) << outcome.out;
        EXPECT_NE(outcome.err.find("[calibration-format]"), std::string::npos) << outcome.err;
        EXPECT_NE(outcome.err.find(message), std::string::npos) << outcome.err;
    }
};

TEST_F(StrategyAuto, PackagesGetTheStrategyThatIsFastest) {
    for (const char* const strategy : {"uber", "visibility", "sorted-uber"}) {
        const Json made = compile({"--strategy", "auto", "--calibration", device(strategy)});
        EXPECT_EQ(made.at("strategyChoice").at("strategy"), strategy);
        EXPECT_EQ(made.at("strategyChoice").at("builtIn"), false);
        EXPECT_EQ(made.at("strategyChoice").at("device"), "Planted");
        expectFits("compile", made);
        const Json written = manifest();
        expectFits("manifest", written);
        EXPECT_EQ(written.at("strategies"), Json({strategy}));
        EXPECT_EQ(written.at("strategyChoice"), made.at("strategyChoice"));
    }
}

TEST_F(StrategyAuto, PackagesOfHitShadersRunWithoutThem) {
    compile({"--strategy", "auto", "--calibration", device("hit-shaders")});
    EXPECT_EQ(manifest().at("strategies"), Json({"uber", "hit-shaders"}));
}

TEST_F(StrategyAuto, JoinsNamedStrategies) {
    compile({"--strategy", "visibility,auto", "--calibration", device("uber")});
    EXPECT_EQ(manifest().at("strategies"), Json({"uber", "visibility"}));
    compile({"--strategy", "visibility"});
    EXPECT_TRUE(manifest().at("strategyChoice").is_null());
}

TEST_F(StrategyAuto, AnotherCalibrationIsAnotherPackage) {
    const std::string file = path("device.json").string();
    writeText(file, plantedDevice("uber").dump());
    const std::vector<std::string> options{"--strategy", "auto", "--calibration", file};
    compile(options);
    EXPECT_EQ(compile(options).at("upToDate"), true);
    writeText(file, plantedDevice("visibility").dump());
    const Json made = compile(options);
    EXPECT_EQ(made.at("upToDate"), false);
    EXPECT_EQ(made.at("strategyChoice").at("strategy"), "visibility");
}

TEST_F(StrategyAuto, VerboseSaysWhy) {
    const Outcome outcome = run({"compile", "scene.gltf", "-o", "package", "--verbose", "--strategy", "auto",
                                 "--calibration", device("visibility")});
    EXPECT_NE(outcome.err.find("strategy visibility: "), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("is expected to take"), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.out.find("visibility (auto)"), std::string::npos) << outcome.out;
}

TEST_F(StrategyAuto, ExplainListsWhatEachStrategyTakes) {
    const std::vector<std::string> line{"explain", "scene.gltf", "--calibration", device("sorted-uber")};
    const Outcome text = must(run(line));
    EXPECT_NE(text.out.find("of the calibration of Planted"), std::string::npos) << text.out;
    EXPECT_NE(text.out.find("--strategy sorted-uber: "), std::string::npos) << text.out;
    std::vector<std::string> asJson = line;
    asJson.emplace_back("--json");
    const Json explained = run(asJson).json();
    expectFits("explain", explained);
    const Json& strategies = explained.at("strategies");
    EXPECT_EQ(strategies.at("strategy"), "sorted-uber");
    EXPECT_EQ(strategies.at("pixels"), 1920.0 * 1080.0);
    ASSERT_EQ(strategies.at("estimates").size(), 4U);
    for (const Json& estimate : strategies.at("estimates")) {
        double sum = 0.0;
        for (const auto& [name, part] : estimate.at("parts").items()) {
            sum += part.get<double>();
        }
        // Each number has four digits.
        EXPECT_NEAR(sum, estimate.at("milliseconds").get<double>(), 2e-3 * sum);
    }
}

TEST_F(StrategyAuto, KnowsADeviceWithoutACalibration) {
    const Json strategies = run({"explain", "scene.gltf", "--json"}).json().at("strategies");
    EXPECT_EQ(strategies.at("builtIn"), true);
    EXPECT_FALSE(strategies.at("estimates").empty());
}

TEST_F(StrategyAuto, WithoutRaysStrategiesAreAlike) {
    const Json made =
        compile({"--strategy", "auto", "--effects", "none", "--calibration", device("visibility")});
    EXPECT_EQ(made.at("strategyChoice").at("strategy"), "uber");
    EXPECT_EQ(made.at("strategyChoice").at("rays"), 0.0);
}

TEST_F(StrategyAuto, DeviceFilesFitTheirSchema) {
    expectFits("device", plantedDevice("uber"));
    for (const char* const kind : {"cpu", "gpu"}) {
        const std::string file =
            std::string(GLINT_SOURCE_DIR "/benchmarks/data/strategy_costs_") + kind + ".json";
        if (std::filesystem::exists(file)) {
            expectFits("device", Json::parse(readText(file)));
        }
    }
}

TEST_F(StrategyAuto, ReportsOfDevicesFitTheirSchema) {
    std::size_t reports = 0;
    for (const auto& entry :
         std::filesystem::directory_iterator(GLINT_SOURCE_DIR "/benchmarks/data/devices")) {
        if (entry.path().extension() == ".json") {
            expectFits("device-report", Json::parse(readText(entry.path())));
            ++reports;
        }
    }
    EXPECT_GT(reports, 0U);
}

TEST_F(StrategyAuto, BadDeviceFilesAreRefused) {
    const Json good = plantedDevice("uber");
    expectRefused(Json::array(), "bad.json: error: is no JSON object");
    Json bad = good;
    bad["version"] = 2;
    expectRefused(bad, "bad.json#/version: error: is 2; this glint reads 1");
    bad = good;
    bad.erase("subgroupSize");
    expectRefused(bad, "has no member \"subgroupSize\"");
    bad = good;
    bad["deviceType"] = "tpu";
    expectRefused(bad, "bad.json#/deviceType");
    bad = good;
    bad["strategies"][0]["constants"]["raysNs"] = -1.0;
    expectRefused(bad, "bad.json#/strategies/0/constants/raysNs: error: is no number from 0");
    bad = good;
    bad["strategies"][1]["strategy"] = bad["strategies"][0]["strategy"];
    expectRefused(bad, "bad.json#/strategies/1/strategy: error: is there twice");
    bad = good;
    bad["strategies"][2]["strategy"] = "magic";
    expectRefused(bad, "is none of uber, sorted-uber, visibility, hit-shaders");
    bad = good;
    bad["strategies"] = Json::array();
    expectRefused(bad, "bad.json#/strategies: error: is empty");
    writeText(path("bad.json"), "{\"format\": ");
    const Outcome broken = run({"explain", "scene.gltf", "--calibration", "bad.json"});
    EXPECT_EQ(broken.exit, 1);
    EXPECT_NE(broken.err.find("is not valid JSON"), std::string::npos) << broken.err;
    const Outcome absent =
        run({"compile", "scene.gltf", "-o", "package", "--strategy", "auto", "--calibration", "none.json"});
    EXPECT_EQ(absent.exit, 1);
    EXPECT_NE(absent.err.find("[file-open]"), std::string::npos) << absent.err;
    EXPECT_FALSE(std::filesystem::exists(path("package")));
}

TEST_F(StrategyAuto, GoesByTheCodeOfAGpu) {
    const Json usual = run({"explain", "scene.gltf", "--merge", "auto", "--json"}).json();
    EXPECT_TRUE(usual.at("gpu").is_null());
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(GLINT_SOURCE_DIR "/benchmarks/data/gpus")) {
        expectFits("gpu", Json::parse(readText(entry.path())));
        names.push_back(entry.path().stem().string());
    }
    ASSERT_GE(names.size(), 6U);
    for (const std::string& name : names) {
        const Json explained =
            run({"explain", "scene.gltf", "--gpu", name, "--merge", "auto", "--json"}).json();
        expectFits("explain", explained);
        const Json& gpu = explained.at("gpu");
        EXPECT_EQ(gpu.at("name"), name);
        EXPECT_GE(gpu.at("branchFactor"), 1.0) << name;
        EXPECT_GE(gpu.at("strategies").size(), 3U) << name;
        for (const Json& choice : gpu.at("choices")) {
            EXPECT_TRUE(choice.at("known").get<bool>()) << name << ": " << choice;
        }
        EXPECT_NE(explained.at("strategies").at("estimates"), usual.at("strategies").at("estimates")) << name;
    }
    EXPECT_TRUE(has(run({"explain", "scene.gltf", "--gpu", "navi31"}).out, "navi31 (")) << "says why";
    const Outcome unknown = run({"explain", "scene.gltf", "--gpu", "navi3"});
    EXPECT_EQ(unknown.exit, 1);
    EXPECT_TRUE(has(unknown.err, "navi31")) << unknown.err;
    EXPECT_TRUE(has(unknown.err, "[gpu-unknown]")) << unknown.err;
}

TEST_F(StrategyAuto, RefusesBrokenTablesOfGpus) {
    const Json good = plantedTable(400.0, 700.0);
    const auto expectBroken = [&](const Json& table, const std::string& message) {
        writeText(path("gpu.json"), table.dump());
        const Outcome outcome = run({"explain", "scene.gltf", "--gpu", "gpu.json"});
        EXPECT_EQ(outcome.exit, 1);
        EXPECT_TRUE(has(outcome.err, "[gpu-table]")) << outcome.err;
        EXPECT_TRUE(has(outcome.err, message)) << outcome.err;
    };
    Json bad = good;
    bad.erase("device");
    expectBroken(bad, "gpu.json: error: has no member \"device\"");
    bad = good;
    bad["packages"] = Json::array();
    expectBroken(bad, "gpu.json#/packages: error: is empty");
    bad = good;
    bad["packages"][1]["shadows"] = "late";
    expectBroken(bad, "gpu.json#/packages/1/shadows: error: is neither \"inline\" nor \"deferred\"");
    bad = good;
    bad["packages"][2]["precision"] = 24;
    expectBroken(bad, "gpu.json#/packages/2/precision: error: is neither 16 nor 32");
    bad = good;
    bad["packages"][0]["summary"][0]["occupancy"] = 1.5;
    expectBroken(bad, "gpu.json#/packages/0/summary/0/occupancy: error: is no number from 0 to 1");
}

// A table by itself changes what is compiled, and each setting that it decides is told with its reason.
TEST_F(StrategyAuto, TablesDecideAboutShadowsAndPrecision) {
    const auto settingsWith = [&](const std::vector<std::string>& options, std::string& told) {
        const Outcome outcome = must(runWith(
            {"compile", "scene.gltf", "-o", "package", "--shadows", "auto", "--precision", "auto"}, options));
        told = outcome.err;
        const Json settings = manifest().at("settings");
        return std::pair(settings.at("shadows").get<std::string>(), settings.at("precision").get<int>());
    };
    using Chosen = std::pair<std::string, int>;
    std::string told;
    EXPECT_EQ(settingsWith({}, told), Chosen("inline", 32));
    EXPECT_TRUE(has(told, "--shadows auto is inline: No table of a GPU is given")) << told;
    writeText(path("gpu.json"), plantedTable(400.0, 700.0).dump());
    EXPECT_EQ(settingsWith({"--gpu", "gpu.json"}, told), Chosen("deferred", 32));
    EXPECT_TRUE(has(told, "--shadows auto is deferred: On planted")) << told;
    EXPECT_TRUE(has(told, "--precision-error accepts 0")) << told;
    EXPECT_EQ(settingsWith({"--gpu", "gpu.json", "--precision-error", "1e-5"}, told), Chosen("deferred", 16));
    writeText(path("gpu.json"), plantedTable(900.0, 990.0).dump());
    EXPECT_EQ(settingsWith({"--gpu", "gpu.json", "--precision-error", "1e-5"}, told), Chosen("inline", 32));
    // Settings that are no `auto` stay as they were given.
    EXPECT_EQ(
        run({"compile", "scene.gltf", "-o", "package", "--gpu", "gpu.json", "--shadows", "deferred"}).exit,
        0);
    EXPECT_EQ(manifest().at("settings").at("shadows"), "deferred");
}

}  // namespace
}  // namespace glint::testing
