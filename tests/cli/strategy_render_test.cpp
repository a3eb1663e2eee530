// Tests glint render --strategy auto, and the device file as the program writes and reads it.
#include "cli/bench/bench.h"
#include "cli/planted_device.h"
#include "cli/render_command.h"
#include "cli/schemas.h"
#include "support/must.h"

#include <glint/internal/package_modules.h>
#include <glint/measure/device_file.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <string>
#include <vector>

namespace glint::testing {
namespace {

using Json = nlohmann::json;

class StrategyRender : public RenderCommand {
protected:
    std::string device(const std::string& strategy) const {
        const std::filesystem::path file = path(strategy + ".json");
        writeText(file, plantedDevice(strategy).dump());
        return file.string();
    }
    Json rendered(std::vector<std::string> options) const {
        options.insert(options.end(), {"--strategy", "auto", "--json"});
        const Outcome outcome = must(render("a.png", options));
        Json report = outcome.json();
        expectFits("render", report);
        return report;
    }
};

TEST_F(StrategyRender, TakesWhatTheCalibrationSays) {
    for (const char* const strategy : {"uber", "visibility"}) {
        const Json report = rendered({"--calibration", device(strategy)});
        EXPECT_EQ(report.at("strategy"), strategy);
        EXPECT_EQ(report.at("strategyChoice").at("strategy"), strategy);
        EXPECT_EQ(report.at("diagnostics")[0].at("id"), "calibration-device");
    }
    const Json report = rendered({});
    EXPECT_EQ(report.at("strategyChoice").at("builtIn"), true);
    EXPECT_TRUE(report.at("diagnostics").empty());
}

TEST_F(StrategyRender, ChoosesAmongWhatCanRun) {
    const Json queries = rendered({"--calibration", device("hit-shaders"), "--tracer", "ray-query"});
    EXPECT_NE(queries.at("strategy"), "hit-shaders");
    ASSERT_EQ(run({"compile", scene_, "-o", "package", "--strategy", "sorted-uber"}).exit, 0);
    const Json packaged = rendered({"--calibration", device("uber"), "--package", "package"});
    EXPECT_EQ(packaged.at("strategy"), "sorted-uber");
    for (const Json& estimate : packaged.at("strategyChoice").at("estimates")) {
        EXPECT_EQ(estimate.at("available"), estimate.at("strategy") == "sorted-uber");
    }
}

TEST_F(StrategyRender, FilesSayWhyWhereNothingCanBeChosen) {
    Json file = plantedDevice("visibility");
    for (std::size_t i : {3U, 1U, 0U}) {
        file.at("strategies").erase(i);
    }
    writeText(path("device.json"), file.dump());
    ASSERT_EQ(run({"compile", scene_, "-o", "package", "--strategy", "uber"}).exit, 0);
    const Outcome outcome = render("a.png", {"--package", "package", "--strategy", "auto", "--calibration",
                                             path("device.json").string()});
    EXPECT_EQ(outcome.exit, 1);
    EXPECT_NE(outcome.err.find("[calibration-strategies]"), std::string::npos) << outcome.err;
}

TEST_F(StrategyRender, DeviceFilesAreReadAsTheyAreWritten) {
    writeText(path("planted.json"), plantedDevice("uber").dump());
    const Result<measure::DeviceFile> planted = measure::readDeviceFile(path("planted.json"));
    ASSERT_TRUE(planted) << planted.error().message;
    // These are the points that such a device would give.
    Json points = Json::array();
    for (const std::uint32_t cases : {1U, 8U, 64U}) {
        for (const double coherence : {0.1, 0.9}) {
            for (const double rays : {1e5, 4e6}) {
                measure::CalibrationPoint point{cases, "cheap", coherence > 0.5 ? "coherent" : "incoherent",
                                                rays,  0.8,     coherence,
                                                {},    {}};
                Json work = Json::array();
                for (std::uint32_t i = 0; i < cases; ++i) {
                    point.work.push_back({1.0 / cases, 500.0, 2.0});
                    work.push_back({{"share", 1.0 / cases}, {"instructions", 500}, {"fetches", 2}});
                }
                Json times = Json::array();
                const double first =
                    estimatedMs(measure::roundOf(point), planted->costs.strategies.front(), 32.0);
                for (const compiler::StrategyCosts& costs : planted->costs.strategies) {
                    const double ms = estimatedMs(measure::roundOf(point), costs, 32.0);
                    times.push_back({{"strategy", costs.strategy},
                                     // The times are like those of a device whose clock changes from round to
                                     // round.
                                     {"time", {{"median", times.empty() ? ms : 3.0 * ms}}},
                                     {"ratio", {{"median", ms / first}}},
                                     {"difference", {{"differing", 0}, {"pixels", 100}}}});
                }
                times.push_back({{"strategy", "uber"},
                                 {"time", {{"median", 99.0}}},
                                 {"ratio", {{"median", 99.0}}},
                                 {"difference", {{"differing", 100}, {"pixels", 100}}}});
                times.push_back({{"strategy", "uber"}, {"skipped", "too large"}});
                points.push_back({{"cases", cases},
                                  {"cost", point.cost},
                                  {"coherence", point.coherence},
                                  {"rays", static_cast<std::uint64_t>(rays)},
                                  {"hitShare", 0.8},
                                  {"coherentShare", coherence},
                                  {"work", work},
                                  {"strategies", times}});
            }
        }
    }
    const Json measured{{"format", "glint-calibration"},
                        {"version", 1},
                        {"command", "glint bench --calibrate -o out"},
                        {"machine",
                         {{"device", "Planted"},
                          {"driver", "Planted 1.0"},
                          {"deviceType", "gpu"},
                          {"tracers", {"ray-pipeline"}}}},
                        {"points", points}};
    writeText(path("calibration.json"), measured.dump());
    Result<measure::CalibrationPoints> read = measure::readCalibrationPoints(path("calibration.json"));
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->device.tracer, "ray-pipeline");
    EXPECT_EQ(read->device.subgroupSize, 32.0);
    std::vector<Diagnostic> notes;
    const Result<measure::DeviceFile> fitted = measure::fitDevice(read->device, read->points, notes);
    ASSERT_TRUE(fitted) << fitted.error().message;
    EXPECT_TRUE(notes.empty());
    const std::string text = toText(*fitted);
    expectFits("device", Json::parse(text));
    writeText(path("device.json"), text);
    const Result<measure::DeviceFile> again = measure::readDeviceFile(path("device.json"));
    ASSERT_TRUE(again) << again.error().message;
    EXPECT_EQ(toText(*again), text);
    EXPECT_NE(cli::describe(*again).find("within 5 % at 100.0 %"), std::string::npos)
        << cli::describe(*again);

    EXPECT_EQ(mustFail(measure::fitDevice(read->device, {}, notes)).id, "calibration-points");
}

TEST_F(StrategyRender, ConstantsAreOfTheStrategiesThatThereAre) {
    EXPECT_EQ(compiler::simplestFirst().size(), std::size(package::strategies()));
    for (const package::Strategy strategy : package::strategies()) {
        EXPECT_NE(std::ranges::find(compiler::simplestFirst(), package::nameOf(strategy)),
                  compiler::simplestFirst().end());
    }
}

}  // namespace
}  // namespace glint::testing
