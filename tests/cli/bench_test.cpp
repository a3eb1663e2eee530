// Tests glint bench on the tiny scene: its files, that it repeats itself, and what it refuses.
#include "cli/render_command.h"
#include "cli/schemas.h"
#include "cli/tiny_scene.h"

#include <algorithm>
#include <string>
#include <vector>

namespace glint::testing {
namespace {

using Json = nlohmann::json;

class Bench : public RenderCommand {
protected:
    Outcome bench(const std::vector<std::string>& more) const {
        return runWith({"bench", scene_, "-o", "out", "--quick", "--size", "32x18", "--spp", "2",
                        "--reference-error", "0.1", "--json"},
                       more);
    }
    static const Json* point(const Json& report, const std::string& name) {
        for (const Json& candidate : report.at("points")) {
            if (candidate.at("name") == name) {
                return &candidate;
            }
        }
        ADD_FAILURE() << "no point " << name;
        return nullptr;
    }
};

// The shaders of packs are measured as Glint's own are.
TEST_F(Bench, MeasuresPacks) {
    addMud(scene_, 0.5);
    writeMudPack(path("pack"), 0.25);
    const Outcome outcome = must(bench({"--only", "strategy", "--max-error", "1000", "--materials", "pack"}));
    const Json report = outcome.json();
    for (const char* const strategy : {"uber", "sorted-uber"}) {
        const Json* const one = point(report, std::string("strategy ") + strategy);
        ASSERT_NE(one, nullptr);
        EXPECT_TRUE(one->at("sameImage").get<bool>()) << strategy;
        EXPECT_TRUE(has(one->at("command").dump(), "--materials")) << one->at("command");
    }
}

// A denoised picture is a row beside the default's and one of 64 samples; it is no offer of settings.
TEST_F(Bench, MeasuresTheFilterOfTheExample) {
    const Outcome outcome =
        bench({"--only", "denoise", "--rounds", "2", "--depth", "singles", "--max-error", "1000"});
    if (outcome.exit == 2) {
        EXPECT_NE(outcome.err.find("GLINT_BUILD_EXAMPLES"), std::string::npos) << outcome.err;
        return;
    }
    ASSERT_EQ(outcome.exit, 0) << outcome.err;
    const Json report = outcome.json();
    expectFits("bench", report);
    ASSERT_NE(point(report, "spp 64"), nullptr);
    for (const auto& [name, frames] : {std::pair("denoised", 1), std::pair("denoised, frame 16", 16)}) {
        const Json* const one = point(report, name);
        ASSERT_NE(one, nullptr);
        EXPECT_EQ(one->at("kind"), "filtered");
        EXPECT_EQ(one->at("filteredFrames"), frames);
        EXPECT_FALSE(one->at("sameImage").get<bool>());
        EXPECT_TRUE(has(one->at("passes").dump(), "denoise"));
        EXPECT_NE(report.at("advice").at("point"), one->at("id"));
    }
}

TEST_F(Bench, WritesWhatItMeasured) {
    const Outcome outcome = must(bench({"--only", "spp,strategy,max-roughness,ssr", "--max-error", "1000"}));
    const Json report = outcome.json();
    expectFits("bench", report);
    Json file = Json::parse(readText(path("out/bench.json")));
    file["diagnostics"] = Json::array();
    expectFits("bench", file);
    file["diagnostics"] = report.at("diagnostics");
    EXPECT_EQ(file, report);

    const Json& points = report.at("points");
    EXPECT_EQ(points[0].at("kind"), "default");
    for (const Json& one : points) {
        EXPECT_EQ(one.at("time").at("values").size() % 6, 0U);
        EXPECT_TRUE(std::filesystem::exists(path("out/" + one.at("image").get<std::string>())));
        EXPECT_TRUE(std::filesystem::exists(path("out/" + one.at("errorImage").get<std::string>())));
    }
    // How hits are shaded does not change the picture; the number of samples does.
    for (const char* const strategy : {"uber", "sorted-uber", "hit-shaders"}) {
        const Json* const one = point(report, std::string("strategy ") + strategy);
        ASSERT_NE(one, nullptr);
        EXPECT_TRUE(one->at("sameImage").get<bool>()) << strategy;
        EXPECT_EQ(one->at("error"), points[0].at("error")) << strategy;
    }
    ASSERT_NE(point(report, "spp 8"), nullptr);
    EXPECT_FALSE(point(report, "spp 8")->at("sameImage").get<bool>());
    EXPECT_LT(point(report, "spp 8")->at("error").at("trimmed").at("median"),
              point(report, "spp 1")->at("error").at("trimmed").at("median"));
    EXPECT_EQ(report.at("strategies").at("rows").size(), 4U);
    for (const Json& row : report.at("strategies").at("rows")) {
        EXPECT_GT(row.at("hits").at("low"), 0.0) << row;
        // The strategy with which all are compared equals itself.
        EXPECT_TRUE(row.at("point") != 0 || row.at("hitRatio").at("high") == 1.0) << row;
    }

    // The front is in order, and no measured point beats it by more than a tie.
    double error = 1e300;
    double time = 0.0;
    for (const Json& id : report.at("front")) {
        const Json& one = points[id.get<std::size_t>()];
        EXPECT_TRUE(one.at("front").get<bool>());
        EXPECT_GE(one.at("ratio").at("median").get<double>() + (one.at("timeTie") ? 1.0 : 0.0), time);
        EXPECT_LT(one.at("error").at("trimmed").at("median").get<double>(), error * 1.0001);
        time = one.at("timeTie") ? 1.0 : one.at("ratio").at("median").get<double>();
        error = one.at("error").at("trimmed").at("median").get<double>();
    }

    // The page and the settings.
    const std::string page = readText(path("out/index.html"));
    EXPECT_TRUE(has(page, "data:image/png;base64,"));
    EXPECT_TRUE(has(page, "strategy hit-shaders"));
    const Json settings = Json::parse(readText(path("out/settings.json")));
    EXPECT_EQ(settings.at("format"), "glint-settings");
    const Outcome again = must(render("advised.exr", {"--settings", "out/settings.json", "--json"}));
    const Json& advice = report.at("advice");
    EXPECT_EQ(std::to_string(again.json().at("spp").get<int>()), advice.at("render").at("spp"));
    EXPECT_EQ(again.json().at("strategy"), advice.at("compile").at("strategy"));
    EXPECT_EQ(run({"compile", scene_, "-o", "package", "--settings", "out/settings.json"}).exit, 0);
}

// The default leaves out most of what surfaces reflect to each other. That is an error against all of light
// transport, and none against a reference that leaves out the same.
TEST_F(Bench, MeasuresAgainstAllOfTransport) {
    const std::vector<std::string> options{
        "--only", "effects,bounces,max-roughness,alpha", "--depth", "singles", "--rounds", "3", "--sky", "1"};
    // A rough, white floor before a rough, white wall.
    Json gltf = Json::parse(readText(scene_));
    for (const int i : {0, 1}) {
        gltf["materials"][i] = {
            {"pbrMetallicRoughness", {{"metallicFactor", 0.0}, {"roughnessFactor", 0.9}}}};
    }
    gltf.erase("extensionsUsed");
    writeText(scene_, gltf.dump());
    const auto errorOf = [](const Json& one) {
        return one.at("error").at("trimmed").at("median").get<double>();
    };
    const Json full = bench(options).json();
    expectFits("bench", full);
    const Json& reference = full.at("reference");
    EXPECT_EQ(reference.at("transport"), "full");
    EXPECT_EQ(reference.at("settings").at("bounces"), "unlimited");
    EXPECT_EQ(reference.at("settings").at("effects"), "auto,indirect-diffuse");
    EXPECT_TRUE(has(reference.at("what"), "--bounces unlimited")) << reference.at("what");
    const Json& parts = full.at("errorParts");
    std::vector<std::string> settings;
    double largest = 0.0;
    for (const Json& part : parts.at("parts")) {
        settings.push_back(part.at("setting"));
        const Json& one = full.at("points").at(part.at("point").get<std::size_t>());
        EXPECT_EQ(one.at("settings"), Json({{settings.back(), part.at("to")}}));
        largest = std::max(largest, part.at("bias").get<double>());
    }
    std::ranges::sort(settings);
    EXPECT_EQ(settings, (std::vector<std::string>{"bounces", "effects", "max-roughness"}));
    const Json& exact = full.at("points").at(parts.at("exact").at("point").get<std::size_t>());
    EXPECT_EQ(exact.at("kind"), "exact");
    // Nearly all of the error is bias, and all exact values together take it away.
    const double bias = 1.0 - parts.at("noise").get<double>();
    EXPECT_GT(bias, 0.7);
    EXPECT_NEAR(parts.at("exact").at("bias").get<double>(), bias, 0.1);
    // With more bounces the sky's light is traced, too, so that this setting alone takes nearly all of it
    // away.
    EXPECT_GT(parts.at("exact").at("bias").get<double>(), largest - 0.05);
    EXPECT_NE(point(full, "bounces 2"), nullptr);

    std::vector<std::string> more = options;
    more.insert(more.end(), {"--reference", "same"});
    const Json same = bench(more).json();
    EXPECT_EQ(same.at("reference").at("transport"), "same");
    EXPECT_FALSE(same.at("reference").at("settings").contains("bounces"));
    EXPECT_LT(errorOf(same.at("points")[0]), 0.5 * errorOf(full.at("points")[0]));
}

TEST_F(Bench, TellsACommandThatMakesThePicture) {
    const Json report = bench({"--only", "spp", "--depth", "singles", "--camera", "auto"}).json();
    const Json* const one = point(report, "spp 4");
    ASSERT_NE(one, nullptr);
    const std::string command = one->at("command");
    ASSERT_TRUE(command.starts_with("glint ")) << command;
    must(runProgram({"sh", "-c", commandPath() + command.substr(5)}));
    const std::string image = "out/" + one->at("image").get<std::string>();
    EXPECT_EQ(readText(path("picture.png")), readText(path(image)));
}

TEST_F(Bench, RepeatsItsErrorsAndKeepsItsReference) {
    const std::vector<std::string> options{"--only", "spp", "--depth", "singles", "--cache", "cache"};
    const Json first = bench(options).json();
    EXPECT_FALSE(first.at("reference").at("cached").get<bool>());
    const Json second = bench(options).json();
    EXPECT_TRUE(second.at("reference").at("cached").get<bool>());
    EXPECT_EQ(first.at("reference").at("samples"), second.at("reference").at("samples"));
    ASSERT_EQ(first.at("points").size(), second.at("points").size());
    for (std::size_t i = 0; i < first.at("points").size(); ++i) {
        EXPECT_EQ(first.at("points")[i].at("error"), second.at("points")[i].at("error"));
    }
    // Another view has another reference.
    std::vector<std::string> other = options;
    other.insert(other.end(), {"--no-sun"});
    EXPECT_FALSE(bench(other).json().at("reference").at("cached").get<bool>());
    // A reference that must be more accurate continues from what is stored.
    other = options;
    other[1] = "spp";
    const Json third = runWith({"bench", scene_, "-o", "more", "--quick", "--size", "32x18", "--spp", "2",
                                "--reference-error", "1e-9", "--reference-spp", "512", "--json"},
                               options)
                           .json();
    EXPECT_TRUE(third.at("reference").at("cached").get<bool>());
    EXPECT_EQ(third.at("reference").at("samples"), 512);
    EXPECT_FALSE(third.at("reference").at("reached").get<bool>());
    EXPECT_EQ(third.at("diagnostics")[0].at("id"), "bench-reference");
}

TEST_F(Bench, SaysWhereNothingIsWithinABudget) {
    const Outcome outcome = bench({"--only", "spp", "--depth", "singles", "--budget-ms", "1e-6"});
    EXPECT_EQ(outcome.exit, 1);
    const Json report = outcome.json();
    expectFits("bench", report);
    EXPECT_TRUE(report.at("advice").at("point").is_null());
    EXPECT_EQ(report.at("diagnostics").back().at("id"), "bench-advice");
    EXPECT_TRUE(std::filesystem::exists(path("out/bench.json")));
    EXPECT_FALSE(std::filesystem::exists(path("out/settings.json")));
}

TEST_F(Bench, RefusesFoldersThatAreNotItsOwn) {
    writeText(path("file"), "mine");
    std::filesystem::create_directories(path("folder"));
    writeText(path("folder/mine.txt"), "mine");
    for (const char* const folder : {"file", "folder", "file/below"}) {
        const Outcome outcome = run({"bench", scene_, "-o", folder});
        EXPECT_EQ(outcome.exit, 1) << folder;
        EXPECT_TRUE(has(outcome.err, "[bench-folder]")) << outcome.err;
    }
    EXPECT_EQ(filesBelow(path("folder")), std::vector<std::string>{"mine.txt"});
    EXPECT_EQ(run({"bench", "none.gltf", "-o", "out"}).exit, 1);
    EXPECT_FALSE(std::filesystem::exists(path("out")));
}

TEST_F(Bench, RefusesLinesThatMakeNoSense) {
    for (const std::vector<std::string>& more : std::vector<std::vector<std::string>>{
             {"--budget-ms", "0"}, {"--candidate", "name"}, {"--only", "sp"}, {"--metric", "psnr"}}) {
        EXPECT_EQ(bench(more).exit, 2) << more[0];
    }
    const Outcome missing =
        must(bench({"--only", "spp", "--depth", "singles", "--candidate", "mine=nowhere"}));
    EXPECT_TRUE(has(missing.err, "[bench-point]")) << missing.err;
}

TEST_F(Bench, IsCleanUnderValidation) {
    must(bench(
        {"--only", "spp,texture-lod,hit-record,merge", "--depth", "singles", "--rounds", "2", "--validate"}));
}

}  // namespace
}  // namespace glint::testing
