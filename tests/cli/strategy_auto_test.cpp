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

class StrategyAuto : public CommandTest {
protected:
    void SetUp() override {
        CommandTest::SetUp();
        writeTinyScene(path(""));
    }
    // Writes the file of a device on which only `strategy` is fast.
    std::string device(const std::string& strategy) const {
        const std::filesystem::path file = path(strategy + ".json");
        writeText(file, plantedDevice(strategy).dump());
        return file.string();
    }
    Json compile(std::vector<std::string> options) const {
        options.insert(options.begin(), {"compile", "scene.gltf", "-o", "package", "--json"});
        const Outcome outcome = run(options);
        EXPECT_EQ(outcome.exit, 0) << outcome.err;
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
    const std::vector<std::string> options{"--strategy", "auto", "--calibration", file, "--cache", "cache"};
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
    const Outcome text = run(line);
    ASSERT_EQ(text.exit, 0) << text.err;
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

TEST_F(StrategyAuto, BadDeviceFilesAreRefused) {
    const Json good = plantedDevice("uber");
    expectRefused(Json::array(), "bad.json: error: is no device file");
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
    const Json explained =
        run({"explain", "scene.gltf", "--gpu", "navi31", "--merge", "auto", "--json"}).json();
    expectFits("explain", explained);
    const Json& gpu = explained.at("gpu");
    EXPECT_EQ(gpu.at("name"), "navi31");
    EXPECT_GE(gpu.at("branchFactor"), 1.0);
    EXPECT_GE(gpu.at("strategies").size(), 3U);
    EXPECT_NE(
        explained.at("strategies").at("estimates"),
        run({"explain", "scene.gltf", "--merge", "auto", "--json"}).json().at("strategies").at("estimates"));
    EXPECT_TRUE(has(run({"explain", "scene.gltf", "--gpu", "navi31"}).out, "navi31 (")) << "says why";
    for (const auto& entry : std::filesystem::directory_iterator(GLINT_SOURCE_DIR "/benchmarks/data/gpus")) {
        expectFits("gpu", Json::parse(readText(entry.path())));
    }
    const Outcome unknown = run({"explain", "scene.gltf", "--gpu", "navi3"});
    EXPECT_EQ(unknown.exit, 1);
    EXPECT_TRUE(has(unknown.err, "navi31")) << unknown.err;
    EXPECT_TRUE(has(unknown.err, "[gpu-unknown]")) << unknown.err;
    writeText(path("gpu.json"), R"({"format": "glint-gpu", "version": 1, "name": "x"})");
    const Outcome wrong = run({"explain", "scene.gltf", "--gpu", "gpu.json"});
    EXPECT_EQ(wrong.exit, 1);
    EXPECT_TRUE(has(wrong.err, "gpu.json: error: has no member \"device\"")) << wrong.err;
}

}  // namespace
}  // namespace glint::testing
