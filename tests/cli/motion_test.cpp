// Tests glint render with moving scenes: its files, its pictures, and its messages.
#include "cli/render/arguments.h"
#include "cli/render_command.h"
#include "cli/schemas.h"
#include "cli/tiny_scene.h"

#include <set>
#include <string>
#include <vector>

namespace glint::testing {
namespace {

using Json = nlohmann::json;

TEST(MotionOptions, ReadFrames) {
    const std::optional<cli::FrameRange> range = cli::parseFrames("3:17");
    ASSERT_TRUE(range.has_value());
    EXPECT_EQ(range->first, 3);
    EXPECT_EQ(range->last, 17);
    const std::optional<cli::FrameRange> one = cli::parseFrames("7");
    ASSERT_TRUE(one.has_value());
    EXPECT_EQ(one->first, one->last);
    for (const char* text :
         {"", ":", "1:", ":1", "2:1", "-1:3", "1:2:3", "a:b", "1.5", "0:1000001", "0x1", " 1"}) {
        EXPECT_FALSE(cli::parseFrames(text).has_value()) << text;
    }
}

TEST(MotionOptions, NumberFiles) {
    EXPECT_EQ(cli::numberedFile("a/out.png", 7), "a/out.0007.png");
    EXPECT_EQ(cli::numberedFile("out.v2.exr", 12345), "out.v2.12345.exr");
}

class MovingScene : public RenderCommand {
protected:
    MovingScene() : RenderCommand({.animated = true}) {}

    bool exists(const std::string& file) const {
        return std::filesystem::exists(path(file));
    }
};

TEST_F(MovingScene, WritesASequence) {
    const Outcome outcome =
        must(render("out.exr", {"--frames", "1:3", "--fps", "4", "--json", "--validate"}));
    EXPECT_FALSE(exists("out.exr"));
    EXPECT_FALSE(exists("out.0000.exr"));
    EXPECT_FALSE(exists("out.0004.exr"));
    const Json frames = outcome.json().at("frames");
    ASSERT_EQ(frames.size(), 3U);
    expectFits("render", outcome.json());
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(frames[i].at("frame"), i + 1);
        EXPECT_EQ(frames[i].at("seconds"), 0.25 * static_cast<double>(i + 1));
        EXPECT_EQ(frames[i].at("image"), "out.000" + std::to_string(i + 1) + ".exr");
        EXPECT_EQ(frames[i].at("deformed"), i == 0 ? 0 : 1);
        EXPECT_EQ(frames[i].at("topLevel"), i == 0 ? "kept" : "updated");
    }
    // Each frame equals a single picture of that moment.
    ASSERT_EQ(render("time.exr", {"--time", "0.5"}).exit, 0);
    expectSame("out.0002.exr", "time.exr");
    expectOther("out.0001.exr", "out.0003.exr");
    ASSERT_EQ(render("again.exr", {"--frames", "2", "--fps", "4"}).exit, 0);
    expectSame("out.0002.exr", "again.0002.exr");
}

TEST_F(MovingScene, NamesTheFilesOfASequence) {
    const Outcome outcome = must(render("out.png", {"--frames", "0:1"}));
    EXPECT_NE(outcome.out.find("out.0000.png to out.0001.png"), std::string::npos) << outcome.out;
}

TEST_F(MovingScene, RefitsOrRebuildsToTheSamePicture) {
    ASSERT_EQ(render("a.exr", {"--frames", "0:1", "--fps", "2", "--refit", "always"}).exit, 0);
    const Outcome outcome =
        must(render("b.exr", {"--frames", "0:1", "--fps", "2", "--refit", "never", "--json"}));
    EXPECT_EQ(outcome.json().at("frames")[1].at("rebuilds"), 1);
    EXPECT_EQ(outcome.json().at("frames")[1].at("topLevel"), "rebuilt");
    expectSame("a.0001.exr", "b.0001.exr");
}

TEST_F(MovingScene, IsTheSameToEveryStrategyAndTracer) {
    ASSERT_EQ(render("query.exr", {"--frames", "0:1", "--fps", "2"}).exit, 0);
    for (const char* strategy : {"uber", "hit-shaders"}) {
        must(render("pipeline.exr", {"--frames", "0:1", "--fps", "2", "--strategy", strategy, "--tracer",
                                     "ray-pipeline", "--validate"}));
        expectSame("query.0001.exr", "pipeline.0001.exr");
    }
}

TEST_F(MovingScene, PlaysTheAnimationThatIsAskedFor) {
    ASSERT_EQ(render("rest.exr").exit, 0);
    ASSERT_EQ(render("start.exr", {"--time", "0"}).exit, 0);
    expectSame("rest.exr", "start.exr");
    ASSERT_EQ(render("slide.exr", {"--time", "1", "--animation", "Slide"}).exit, 0);
    ASSERT_EQ(render("look.exr", {"--time", "1", "--animation", "Look"}).exit, 0);
    ASSERT_EQ(render("one.exr", {"--time", "1", "--animation", "1"}).exit, 0);
    ASSERT_EQ(render("all.exr", {"--time", "1", "--animation", "all"}).exit, 0);
    expectOther("slide.exr", "rest.exr");
    expectOther("look.exr", "rest.exr");
    expectOther("all.exr", "slide.exr");
    expectOther("all.exr", "look.exr");
    expectSame("look.exr", "one.exr");
    // After the end, the last pose remains.
    ASSERT_EQ(render("later.exr", {"--time", "9"}).exit, 0);
    expectSame("slide.exr", "later.exr");
    const Outcome unknown = render("x.exr", {"--time", "1", "--animation", "Slid"});
    EXPECT_EQ(unknown.exit, 1);
    EXPECT_NE(unknown.err.find("did you mean Slide?"), std::string::npos) << unknown.err;
    EXPECT_NE(unknown.err.find("[animation-unknown]"), std::string::npos) << unknown.err;
    EXPECT_FALSE(exists("x.exr"));
}

TEST_F(MovingScene, AnAutomaticCameraFramesAllOfIt) {
    ASSERT_EQ(render("out.exr", {"--frames", "0:2", "--fps", "2", "--camera", "auto"}).exit, 0);
    expectOther("out.0000.exr", "out.0002.exr");
}

TEST_F(MovingScene, UsesPackagesThatCanDeform) {
    ASSERT_EQ(run({"compile", scene_, "-o", "package"}).exit, 0);
    must(render("out.exr", {"--frames", "0:1", "--package", "package"}));
    EXPECT_NE(run({"inspect", "package"}).out.find("deform.spv"), std::string::npos);
    // A package of the same scene without its morph target lacks the pass.
    const std::string still = writeTinyScene(path("")).string();
    ASSERT_EQ(run({"compile", still, "-o", "other"}).exit, 0);
    EXPECT_EQ(run({"inspect", "other"}).out.find("deform.spv"), std::string::npos);
    scene_ = writeTinyScene(path(""), {.animated = true}).string();
    const Outcome refused = render("out.exr", {"--package", "other"});
    EXPECT_EQ(refused.exit, 1);
    EXPECT_NE(refused.err.find("[package-mismatch]"), std::string::npos) << refused.err;
}

TEST_F(MovingScene, IsExplained) {
    const Outcome outcome = must(run({"explain", scene_, "--json"}));
    expectFits("explain", outcome.json());
    const Json motion = outcome.json().at("motion");
    ASSERT_EQ(motion.at("animations").size(), 2U);
    EXPECT_EQ(motion.at("animations")[0].at("name"), "Slide");
    EXPECT_EQ(motion.at("animations")[0].at("duration"), 1.0);
    EXPECT_EQ(motion.at("animations")[0].at("channels").at("weights"), 1);
    ASSERT_EQ(motion.at("deformedMeshes").size(), 1U);
    EXPECT_EQ(motion.at("deformedMeshes")[0].at("morphTargets"), 1);
    EXPECT_EQ(motion.at("deformedMeshes")[0].at("node"), 1);
    EXPECT_NE(run({"explain", scene_}).out.find("Slide"), std::string::npos);
}

// Returns the names of the effects that `explain` reports as chosen.
std::set<std::string> chosenEffects(const Json& explained) {
    std::set<std::string> names;
    for (const Json& effect : explained.at("effects")) {
        if (effect.at("chosen").get<bool>()) {
            names.insert(effect.at("name").get<std::string>());
        }
    }
    return names;
}

// If values change over time, effects and keys include everything that any of the values needs.
TEST_F(MovingScene, PointersArePlannedFor) {
    Json gltf = Json::parse(readText(scene_));
    Json& floor = gltf["materials"][0];
    floor["pbrMetallicRoughness"]["metallicFactor"] = 0.0;
    floor["pbrMetallicRoughness"]["roughnessFactor"] = 1.0;
    floor["extensions"]["KHR_materials_transmission"] = Json::object();
    gltf["extensions"]["KHR_lights_punctual"]["lights"].push_back({{"type", "point"}, {"intensity", 0}});
    gltf["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 0;
    writeText(scene_, gltf.dump());
    const Json still = run({"explain", scene_, "--json"}).json();
    EXPECT_EQ(chosenEffects(still), std::set<std::string>());
    EXPECT_TRUE(still.at("materials")[0].at("animated").empty());

    // Each value goes from 0 to 1. The channels use the sampler of the weights.
    Json& animation = gltf["animations"][0];
    for (const char* pointer :
         {"/materials/0/pbrMetallicRoughness/roughnessFactor",
          "/materials/0/extensions/KHR_materials_transmission/transmissionFactor",
          "/extensions/KHR_lights_punctual/lights/0/intensity", "/cameras/0/perspective/aspectRatio"}) {
        Json channel{{"sampler", 1}};
        channel["target"]["path"] = "pointer";
        channel["target"]["extensions"]["KHR_animation_pointer"]["pointer"] = pointer;
        animation["channels"].push_back(channel);
    }
    writeText(scene_, gltf.dump());
    const Outcome outcome = must(run({"explain", scene_, "--json"}));
    const Json moving = outcome.json();
    expectFits("explain", moving);
    EXPECT_EQ(chosenEffects(moving), (std::set<std::string>{"shadow", "reflection", "refraction"}));
    EXPECT_EQ(moving.at("materials")[0].at("animated").size(), 2U);
    EXPECT_EQ(moving.at("motion").at("animations")[0].at("channels").at("material"), 2);
    EXPECT_EQ(moving.at("motion").at("animations")[0].at("channels").at("light"), 1);
    EXPECT_NE(outcome.err.find("note: \"/cameras/0/perspective/aspectRatio\""), std::string::npos)
        << outcome.err;
}

TEST_F(RenderCommand, SaysThatNothingMoves) {
    const Outcome outcome = render("out.png", {"--frames", "0:3"});
    EXPECT_EQ(outcome.exit, 1);
    EXPECT_NE(outcome.err.find("[animation-missing]"), std::string::npos) << outcome.err;
}

TEST_F(MovingScene, BadOptionsAreUsageErrors) {
    const std::vector<std::vector<std::string>> bad{
        {"--frames", "3:1"},
        {"--frames", "x"},
        {"--frames", "0:1", "--fps", "0"},
        {"--fps", "24"},
        {"--refit", "never"},
        {"--animation", "Slide"},
        {"--frames", "0:1", "--time", "1"},
        {"--frames", "0:1", "--coverage", "c.png"},
        {"--time", "-1"},
        {"--time", "nan"},
        {"--frames", "0:1", "--refit", "sometimes"},
    };
    for (const std::vector<std::string>& options : bad) {
        EXPECT_EQ(render("out.png", options).exit, 2) << options.front() << " " << options[1];
    }
}

}  // namespace
}  // namespace glint::testing
