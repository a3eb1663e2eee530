// Tests glint bench --calibrate with few cases and tiny pictures: its file, and what it refuses.
#include "cli/command.h"
#include "cli/schemas.h"
#include "cli/tiny_scene.h"

#include <algorithm>
#include <filesystem>
#include <regex>
#include <string>
#include <unistd.h>
#include <vector>

namespace glint::testing {
namespace {

using Json = nlohmann::json;

class Calibrate : public CommandTest {
protected:
    Outcome calibrate(const std::vector<std::string>& more) const {
        return runWith({"bench", "--calibrate", "-o", "out", "--rounds", "2", "--calibrate-rays", "1024"},
                       more);
    }
    void expectRefused(const std::vector<std::string>& arguments, const std::string& text) const {
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.exit, 2);
        EXPECT_TRUE(has(outcome.err, text)) << outcome.err;
        EXPECT_FALSE(std::filesystem::exists(path("out")));
    }
};

TEST_F(Calibrate, WritesWhatItMeasured) {
    const Outcome outcome = must(calibrate(
        {"--calibrate-cases", "1,3", "--calibrate-cost", "cheap", "--pictures", "pictures", "--json"}));
    const Json report = outcome.json();
    expectFits("calibration", report);
    Json file = Json::parse(readText(path("out/calibration.json")));
    // Four points are too few for the constants of a strategy.
    EXPECT_FALSE(std::filesystem::exists(path("out/device.json")));
    for (const Json& diagnostic : report.at("diagnostics")) {
        EXPECT_EQ(diagnostic.at("id"), "calibration-points");
        EXPECT_EQ(diagnostic.at("severity"), "note");
    }
    file["diagnostics"] = report.at("diagnostics");
    EXPECT_EQ(file, report);
    EXPECT_TRUE(report.at("complete").get<bool>());
    ASSERT_EQ(report.at("points").size(), 4U);
    for (const Json& point : report.at("points")) {
        const std::size_t cases = point.at("cases").get<std::size_t>();
        EXPECT_EQ(point.at("work").size(), cases);
        EXPECT_EQ(point.at("filledCases"), cases);
        EXPECT_EQ(point.at("rays"), point.at("width").get<int>() * point.at("height").get<int>());
        EXPECT_GT(point.at("hitShare"), 0.9);
        double shares = 0.0;
        for (const Json& one : point.at("work")) {
            shares += one.at("share").get<double>();
            EXPECT_GT(one.at("instructions"), 0.0);
        }
        EXPECT_NEAR(shares, 1.0, 1e-9);
        EXPECT_FALSE(point.at("fastest").empty());
        EXPECT_EQ(point.at("strategies").size(), 4U);
        for (const Json& one : point.at("strategies")) {
            ASSERT_FALSE(one.contains("skipped")) << one;
            EXPECT_EQ(one.at("difference").at("differing"), 0) << one;
            EXPECT_EQ(one.at("time").at("values").size(), 2U);
            const bool orders = one.at("strategy") == "visibility" || one.at("strategy") == "sorted-uber";
            EXPECT_EQ(one.at("ordering").is_null(), !orders);
            EXPECT_EQ(one.at("split").at("order") > 0.0, orders) << one;
            EXPECT_EQ(one.at("split").at("trace") > 0.0, orders) << one;
            EXPECT_GT(one.at("split").at("shade"), 0.0);
        }
        EXPECT_TRUE(std::filesystem::exists(path("pictures/" + std::to_string(cases) + "-cheap-" +
                                                 point.at("coherence").get<std::string>() + ".png")));
    }
    // Neighbours from a mirror are alike; others are random.
    EXPECT_GT(report.at("points")[2].at("coherentShare"), 0.5);
    EXPECT_LT(report.at("points")[3].at("coherentShare"), 0.1);
}

TEST_F(Calibrate, ShadesWithLightsAndTheirShadows) {
    const Outcome outcome =
        must(calibrate({"--calibrate-cases", "2", "--calibrate-cost", "expensive", "--calibrate-coherence",
                        "incoherent", "--calibrate-lights", "2", "--calibrate-shadows", "--shadows",
                        "deferred", "--calibrate-shares", "zipf", "--json"}));
    const Json report = outcome.json();
    expectFits("calibration", report);
    ASSERT_EQ(report.at("points").size(), 1U);
    const Json& point = report.at("points")[0];
    EXPECT_EQ(point.at("lights"), 2);
    for (const Json& one : point.at("strategies")) {
        EXPECT_EQ(one.at("difference").at("differing"), 0) << one;
        EXPECT_GT(one.at("split").at("shadow"), 0.0) << one;
    }
    // The shares are 1 : 1/2, in random places.
    const double first = point.at("work")[0].at("share");
    EXPECT_NEAR(std::max(first, 1.0 - first), 2.0 / 3.0, 0.06);
}

TEST_F(Calibrate, SaysWhatItFoundAsATable) {
    const Outcome outcome =
        must(calibrate({"--calibrate-cases", "1", "--calibrate-cost", "cheap", "--calibrate-coherence",
                        "coherent", "--tracer", "ray-pipeline"}));
    EXPECT_TRUE(has(outcome.out, "| cases | cost  | hits "));
    EXPECT_TRUE(has(outcome.out, "hit-shaders / uber"));
    EXPECT_TRUE(has(outcome.out, "out/calibration.json"));
}

TEST_F(Calibrate, RefusesWhatHasNoPlace) {
    expectRefused({"bench", "-o", "out"}, "SCENE is missing");
    expectRefused({"bench", "scene.gltf", "--calibrate", "-o", "out"}, "makes its own scenes");
    expectRefused({"bench", "--calibrate", "-o", "out", "--strategy", "uber"}, "--strategy");
    expectRefused({"bench", "scene.gltf", "-o", "out", "--calibrate-cases", "4"}, "needs --calibrate");
    expectRefused({"bench", "--calibrate", "-o", "out", "--calibrate-cases", "0"}, "from 1 to 256");
    expectRefused({"bench", "--calibrate", "-o", "out", "--calibrate-cases", "4,,"}, "from 1 to 256");
    expectRefused({"bench", "--calibrate", "-o", "out", "--calibrate-rays", "65M"}, "64000000");
    expectRefused({"bench", "--calibrate", "-o", "out", "--calibrate-rays", "99999999999999999999"},
                  "64000000");
    expectRefused({"bench", "--calibrate", "-o", "out", "--calibrate-shadows"}, "--calibrate-lights");
}

TEST_F(Calibrate, KeepsWhatElseIsInTheFolder) {
    std::filesystem::create_directories(path("out"));
    writeText(path("out/bench.json"), "{}");
    const Outcome outcome = calibrate({"--calibrate-cases", "1"});
    EXPECT_EQ(outcome.exit, 1);
    EXPECT_TRUE(has(outcome.err, "bench-folder")) << outcome.err;
    EXPECT_EQ(readText(path("out/bench.json")), "{}");
    EXPECT_FALSE(std::filesystem::exists(path("out/calibration.json")));
}

// A report that a person sends must not tell who it is.
TEST_F(Calibrate, ReportsTheDeviceWithoutNamesOfPeople) {
    std::filesystem::create_directory(path("secret"));
    writeTinyScene(path("secret"));
    const Outcome outcome = run({"bench", "secret/scene.gltf", "--device-report", "report.json", "--quick",
                                 "--size", "16x16", "--spp", "1", "--json"},
                                {{"USER", "somebody"}, {"LOGNAME", "somebody"}});
    ASSERT_EQ(outcome.exit, 2) << "sizes of pictures are fixed";
    const Outcome made =
        must(run({"bench", "secret/scene.gltf", "--device-report", "report.json", "--quick", "--json"},
                 {{"USER", "somebody"}, {"LOGNAME", "somebody"}}));
    Json report = made.json();
    expectFits("device-report", report);
    const std::string text = readText(path("report.json"));
    report.erase("diagnostics");
    EXPECT_EQ(Json::parse(text), report);
    char host[256] = {};
    ASSERT_EQ(gethostname(host, sizeof(host) - 1), 0);
    for (const std::string& name : {std::string("somebody"), std::string("secret"), std::string(host),
                                    path("").parent_path().string(), std::string("scene.gltf")}) {
        // Whole words alone: a host may be called as a part of a driver's name is.
        EXPECT_FALSE(std::regex_search(text, std::regex("\\b" + name + "\\b"))) << name;
    }
    ASSERT_EQ(report.at("generated").size(), 5U);
    for (const Json& point : report.at("generated")) {
        EXPECT_EQ(point.at("strategies").size(), 4U);
        EXPECT_FALSE(point.at("fastest").empty());
    }
    EXPECT_EQ(report.at("scene").at("strategies").size(), 4U);
    EXPECT_EQ(report.at("pipelines").size(), 7U) << "of three generated packages and four of the scene";
    expectRefused({"bench", "--device-report", "report.json", "--calibrate"}, "--device-report");
    expectRefused({"bench"}, "SCENE");
}

}  // namespace
}  // namespace glint::testing
