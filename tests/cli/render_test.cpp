#include "cli/render_command.h"
#include "cli/tiny_scene.h"
#include "image/image_file.h"
#include "image/tone.h"
#include "support/must.h"
#include "support/nightly.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace glint::testing {
namespace {

// Returns the report's entry for an effect, or null if the package lacks it.
nlohmann::json effectOf(const nlohmann::json& report, const std::string& name) {
    for (const nlohmann::json& effect : report.at("effects")) {
        if (effect.at("name") == name) {
            return effect;
        }
    }
    return nullptr;
}

TEST_F(RenderCommand, CompileInspectRenderCompare) {
    ASSERT_EQ(run({"compile", scene_, "-o", "package"}).exit, 0);
    ASSERT_EQ(run({"inspect", "package"}).exit, 0);
    const Outcome uber = must(render("uber.exr", {"--strategy", "uber", "--package", "package"}));
    const Outcome visibility = must(render("visibility.exr", {"--strategy", "visibility"}));
    must(run({"compare", "uber.exr", "visibility.exr", "--max-error", "1e-4"}));
}

TEST_F(RenderCommand, DenoisesOnlyWhereOpenImageDenoiseIsLinked) {
    const Outcome viewed = run({"render", scene_, "-o", "a.png", "--denoise", "--view", "key"});
    EXPECT_EQ(viewed.exit, 2);
    EXPECT_NE(viewed.err.find("--view"), std::string::npos) << viewed.err;
    const Outcome denoised = render("a.png", {"--denoise"});
    if (denoised.exit == 0) {
        EXPECT_TRUE(image::readImage(path("a.png")).ok());
        return;
    }
    EXPECT_EQ(denoised.exit, 1);
    EXPECT_NE(denoised.err.find("[denoise-missing]"), std::string::npos) << denoised.err;
    EXPECT_NE(denoised.err.find("OpenImageDenoise_ROOT"), std::string::npos) << denoised.err;
    EXPECT_FALSE(std::filesystem::exists(path("a.png")));
}

TEST_F(RenderCommand, LayersAreInTheFileOfThePicture) {
    must(render("a.exr", {"--layers", "depth,direct.demodulated"}));
    std::ifstream file(path("a.exr"), std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    for (const char* const channel : {"depth.Z", "direct.radiance.R", "direct.demodulated.G", "albedo.B"}) {
        EXPECT_NE(bytes.find(channel), std::string::npos) << channel;
    }
    const Outcome withoutRoom = render("a.png", {"--layers", "depth"});
    EXPECT_EQ(withoutRoom.exit, 2);
    EXPECT_NE(withoutRoom.err.find(".exr"), std::string::npos) << withoutRoom.err;
    const Outcome misspelt = render("a.exr", {"--layers", "depht"});
    EXPECT_EQ(misspelt.exit, 2);
    EXPECT_NE(misspelt.err.find("did you mean depth?"), std::string::npos) << misspelt.err;
    const Outcome unknown = render("a.exr", {"--layers", "reflexion.radiance"});
    EXPECT_EQ(unknown.exit, 1);
    EXPECT_NE(unknown.err.find("did you mean reflection?"), std::string::npos) << unknown.err;
    const Outcome none = render("a.exr", {"--layers", "bounce-radiance"});
    EXPECT_EQ(none.exit, 1);
    EXPECT_NE(none.err.find("--bounces"), std::string::npos) << none.err;
}

TEST_F(RenderCommand, ViewsAreDrawnWithALegendAndTheirNumbers) {
    const Outcome drawn = must(render("a.png", {"--view", "rays", "--stats", "stats.json"}));
    const nlohmann::json stats = nlohmann::json::parse(readText(path("stats.json")));
    EXPECT_EQ(stats["view"]["name"], "rays");
    EXPECT_EQ(stats["view"]["numbers"], stats["width"].get<int>() * stats["height"].get<int>());
    const LinearImage picture = must(image::readImage(path("a.png")));
    EXPECT_EQ(picture.width, stats["width"]);
    EXPECT_GT(picture.height, stats["height"]);

    ASSERT_EQ(run({"compile", scene_, "-o", "package"}).exit, 0);
    const Outcome lacking = render("b.png", {"--view", "rays", "--package", "package"});
    EXPECT_EQ(lacking.exit, 1);
    EXPECT_NE(lacking.err.find("--layers rays"), std::string::npos) << lacking.err;
    // The legend makes the view higher than a picture, which is found before anything is drawn.
    const Outcome sized =
        render("b.png", {"--view", "difference", "--view-reference", path("a.png").string()});
    EXPECT_EQ(sized.exit, 1);
    EXPECT_NE(sized.err.find("[view-reference]"), std::string::npos) << sized.err;
    EXPECT_FALSE(std::filesystem::exists(path("b.png")));
}

class GalleryPackage : public RenderCommand {
protected:
    const std::string kGallery = GLINT_BINARY_DIR "/tests/render/gallery/gallery.gltf";

    // Renders a scene from a package with lobes at hits, and compares the strategies.
    void expectStrategiesAgree(const std::string& scene, const std::string& lobes) {
        if (!std::filesystem::exists(scene)) {
            GTEST_SKIP() << "the gallery is not built: " << scene;
        }
        ASSERT_EQ(run({"compile", scene, "-o", "package", "--hit-lobes", lobes}).exit, 0);
        const Outcome inspected = must(run({"inspect", "package"}));
        expectFitsTerminal(inspected.out);
        for (const char* strategy : {"uber", "visibility"}) {
            const Outcome outcome = must(run({"render", scene, "-o", std::string(strategy) + ".exr", "--size",
                                              "64x36", "--package", "package", "--strategy", strategy}));
            expectFitsTerminal(outcome.out);
        }
        must(run({"compare", "uber.exr", "visibility.exr", "--max-error", "1e-4"}));
    }
};

TEST_F(GalleryPackage, InBothStrategies) {
    expectStrategiesAgree(kGallery, "all");
}

// Primary surfaces have lobes that no case has. By day it is the coat of the tiny scene's floor.
TEST_F(GalleryPackage, InBothStrategiesWithFewerLobesAtHits) {
    const std::string tiny = writeTinyScene(path(""), {.variants = true}).string();
    expectStrategiesAgree(test::nightly() ? kGallery : tiny, "base");
}

TEST_F(RenderCommand, StatsAreWrittenAndPrinted) {
    const Outcome outcome = must(render("a.png", {"--stats", "stats.json", "--json", "--spp", "2"}));
    const nlohmann::json stats = nlohmann::json::parse(readText(path("stats.json")));
    nlohmann::json printed = outcome.json();
    printed.erase("diagnostics");
    EXPECT_EQ(stats, printed);
    EXPECT_EQ(stats.at("width"), 64);
    EXPECT_EQ(stats.at("height"), 36);
    EXPECT_EQ(stats.at("spp"), 2);
    EXPECT_EQ(stats.at("camera"), "Front");
    EXPECT_EQ(stats.at("merge"), "family");
    EXPECT_EQ(stats.at("sceneStatistics").at("triangles"), 4);
    EXPECT_FALSE(stats.at("device").get<std::string>().empty());
    std::uint64_t bytes = 0;
    for (const nlohmann::json& item : stats.at("memory").at("frame")) {
        bytes += item.at("bytes").get<std::uint64_t>();
    }
    EXPECT_EQ(bytes, stats.at("footprint").at("bytes"));
    EXPECT_EQ(bytes, stats.at("memory").at("frameBytes"));
    EXPECT_TRUE(stats.at("pipelineStatistics").is_null());
    ASSERT_FALSE(stats.at("passes").empty());
    for (const nlohmann::json& pass : stats.at("passes")) {
        EXPECT_GE(pass.at("milliseconds").get<double>(), 0.0) << pass;
    }
    // The buckets are misses, the floor's case and the wall's case.
    const nlohmann::json& counters = stats.at("counters");
    ASSERT_EQ(counters.at("buckets").size(), 3U);
    std::uint64_t hits = 0;
    for (const nlohmann::json& bucket : counters.at("buckets")) {
        hits += bucket.get<std::uint64_t>();
    }
    EXPECT_GT(hits, 0U);
    EXPECT_EQ(counters.at("rays"), hits);
    const nlohmann::json reflection = effectOf(stats, "reflection");
    EXPECT_EQ(reflection.at("rays"), hits);
    EXPECT_EQ(reflection.at("hits").get<std::uint64_t>() + reflection.at("misses").get<std::uint64_t>(),
              hits);
    EXPECT_GT(reflection.at("skipped").at("sky").get<int>(), 0);
    EXPECT_GT(reflection.at("skipped").at("unlit").get<int>(), 0);
    EXPECT_EQ(counters.at("nonFinite"), 0);
}

// The light is so bright that its inverse square law overflows.
TEST_F(RenderCommand, SamplesThatAreNoNumberAreWarnedOf) {
    std::ifstream file(scene_);
    nlohmann::json gltf = nlohmann::json::parse(file);
    gltf["extensionsUsed"].push_back("KHR_lights_punctual");
    gltf["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"intensity", 3e38}}};
    gltf["scenes"][0]["nodes"].push_back(gltf["nodes"].size());
    gltf["nodes"].push_back(
        {{"translation", {0.0, 0.1, 0.0}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    std::ofstream(scene_) << gltf;
    const Outcome outcome = must(render("a.png", {"--json"}));
    EXPECT_GT(outcome.json().at("counters").at("nonFinite").get<int>(), 0);
    EXPECT_NE(outcome.err.find("were NaN or infinite and count as black"), std::string::npos) << outcome.err;
}

// The tiny scene with both surfaces lit, by a lamp above it.
class LampScene : public RenderCommand {
protected:
    void hangLamp(double candela) {
        nlohmann::json gltf = nlohmann::json::parse(readText(scene_));
        gltf["meshes"][1]["primitives"][0]["material"] = 0;
        if (!gltf["extensions"].contains("KHR_lights_punctual")) {
            gltf["extensionsUsed"].push_back("KHR_lights_punctual");
            gltf["scenes"][0]["nodes"].push_back(gltf["nodes"].size());
            gltf["nodes"].push_back({{"translation", {0.5, 3.0, 1.0}},
                                     {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
        }
        gltf["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"intensity", candela}}};
        writeText(scene_, gltf.dump());
    }
    // How bright 1, 5 and 9 of 10 pixels of a picture are at most: 0, black, to 1, white.
    std::array<double, 3> quantiles(const std::string& picture) const {
        const Result<LinearImage> image = image::readImage(path(picture));
        EXPECT_TRUE(image) << picture;
        std::vector<double> values;
        for (const std::array<float, 4>& pixel :
             image ? image->pixels : std::vector<std::array<float, 4>>(10)) {
            values.push_back(image::luminance({pixel[0], pixel[1], pixel[2]}));
        }
        std::ranges::sort(values);
        return {values[values.size() / 10], values[values.size() / 2], values[9 * values.size() / 10]};
    }
};

TEST_F(LampScene, PicturesOfAnyLightAreNeitherWhiteNorBlack) {
    for (const double candela : {0.001, 40000.0, 1e9}) {
        SCOPED_TRACE(candela);
        hangLamp(candela);
        const Outcome outcome = must(render("a.png", {"--json"}));
        const std::array<double, 3> q = quantiles("a.png");
        EXPECT_GT(q[0], 0.03);
        EXPECT_GT(q[1], 0.08);
        EXPECT_LT(q[1], 0.6);
        EXPECT_LT(q[2], 0.9);
        const nlohmann::json report = outcome.json();
        EXPECT_TRUE(report.at("sky").at("automatic").get<bool>());
        EXPECT_TRUE(report.at("exposureAutomatic").get<bool>());
        // The sky's mean illuminance is that of the lamp.
        EXPECT_NEAR(report.at("sky").at("luminance").get<double>() * 3.14159265 /
                        report.at("sky").at("lightIlluminance").get<double>(),
                    1.0, 1e-4);
        // A few metres from the lamp.
        EXPECT_NEAR(report.at("sky").at("lightIlluminance").get<double>() / candela, 0.06, 0.04);
    }
}

TEST_F(LampScene, TheSkyAndTheExposureThatAreAskedForWin) {
    hangLamp(40000.0);
    const Outcome outcome = must(render("a.png", {"--sky", "1", "--exposure", "0", "--json"}));
    EXPECT_EQ(outcome.json().at("sky").at("scale"), 1.0);
    EXPECT_FALSE(outcome.json().at("sky").at("automatic").get<bool>());
    EXPECT_EQ(outcome.json().at("exposure"), 0.0);
    // At least one channel of the surface is at its limit.
    EXPECT_GT(quantiles("a.png")[1], 0.65) << "too bright, as asked for";
    EXPECT_TRUE(has(render("a.png", {"--sky", "1"}).out, "(--sky)"));
    EXPECT_EQ(render("b.png", {"--sky", "-1"}).exit, 2);
    EXPECT_EQ(render("b.png", {"--sky", "bright"}).exit, 2);
    EXPECT_EQ(render("b.png", {"--sky", "1", "--environment", "sky.hdr"}).exit, 2);
}

TEST_F(LampScene, WithoutLightTheSkyIsTheDefaultOne) {
    hangLamp(0.0);
    const Outcome black = must(render("a.png", {"--json"}));
    EXPECT_EQ(black.json().at("sky").at("scale"), 1.0);
    EXPECT_TRUE(black.json().at("sky").at("lightIlluminance").is_null());
}

TEST_F(LampScene, TheLightThatIsAddedIsReported) {
    const Outcome added = must(render("a.png", {"--json"}));
    EXPECT_EQ(added.json().at("sun").at("illuminance").at(0), 3.0);
    EXPECT_TRUE(added.json().at("sun").at("automatic").get<bool>());
    EXPECT_TRUE(has(render("a.png").out, "3 lux, added because the scene has no light"));
    EXPECT_TRUE(render("a.png", {"--no-sun", "--json"}).json().at("sun").is_null());
    hangLamp(100.0);
    EXPECT_TRUE(render("a.png", {"--json"}).json().at("sun").is_null());
    EXPECT_TRUE(has(render("a.png", {"--sun"}).out, "3 lux (--sun)"));
}

TEST_F(RenderCommand, OptionsThatChangeNothingAreWarnedOf) {
    const Outcome idle =
        must(render("a.exr", {"--strategy", "uber", "--ordering", "local-histogram", "--ssr-thickness", "0.1",
                              "--light-radius", "0.1", "--exposure", "1"}));
    for (const char* const message :
         {"--ordering local-histogram changes nothing: --strategy uber sorts no hits and keeps no records",
          "--ssr-thickness 0.1 changes nothing: --ssr is off",
          "--light-radius 0.1 changes nothing: the picture has no point or spot light",
          "--exposure 1 changes nothing: an EXR file keeps the light as it is"}) {
        EXPECT_TRUE(has(idle.err, message)) << idle.err;
    }
    const Outcome used =
        must(render("a.png", {"--ordering", "local-histogram", "--strategy", "visibility", "--ssr", "8",
                              "--ssr-thickness", "0.1", "--sun-angle", "1", "--exposure", "1"}));
    EXPECT_FALSE(has(used.err, "setting-idle")) << used.err;
}

TEST_F(RenderCommand, CompiledShadersAreKept) {
    ASSERT_EQ(render("a.png", {"--cache", "cache", "--pipeline-cache", "none", "-j", "1"}).exit, 0);
    EXPECT_FALSE(filesBelow(path("cache")).empty());
    must(render("b.png", {"--cache", "cache", "--pipeline-cache", "none", "--verbose", "--no-json"}));
    EXPECT_EQ(readText(path("a.png")), readText(path("b.png")));
}

// The lamp nears the wall with the animation; sky and exposure are those of the first picture.
TEST_F(LampScene, ASequenceDoesNotFlicker) {
    scene_ = writeTinyScene(path(""), {.animated = true}).string();
    hangLamp(500.0);
    nlohmann::json gltf = nlohmann::json::parse(readText(scene_));
    gltf["animations"][0]["channels"][0]["target"]["node"] = gltf["nodes"].size() - 1;
    writeText(scene_, gltf.dump());
    const std::vector<std::string> frames{"--frames", "0:1", "--fps", "1", "--json"};
    must(render("a.exr", frames));
    const Result<LinearImage> first = image::readImage(path("a.0000.exr"));
    const Result<LinearImage> second = image::readImage(path("a.0001.exr"));
    ASSERT_TRUE(first && second);
    EXPECT_NE(first->pixels, second->pixels) << "the lamp moves";
    EXPECT_EQ(first->pixels[0], second->pixels[0]) << "the sky stays";
}

TEST_F(RenderCommand, APictureWithoutASurfaceIsWarnedOf) {
    const Outcome seen = render("seen.exr");
    EXPECT_EQ(seen.err.find("[nothing-seen]"), std::string::npos) << seen.err;
    const Outcome behind = must(render("behind.exr", {"--camera", "0,1,9/0,1,10"}));
    EXPECT_NE(behind.err.find("2 instances are behind the camera (/nodes/0, /nodes/1); use --camera auto"),
              std::string::npos)
        << behind.err;
    // Only the picture shows that this is less than a pixel.
    const Outcome far = render("far.exr", {"--camera", "0,1e7,1/0,0,0"});
    EXPECT_NE(far.err.find("smaller than a pixel"), std::string::npos) << far.err;
}

TEST_F(RenderCommand, ReflectionsCanBeTurnedOff) {
    const Outcome off = must(render("a.png", {"--effects", "shadow", "--json"}));
    EXPECT_EQ(off.json().at("counters").at("rays"), 0);
    const Outcome rough = must(render("b.png", {"--effects", "auto", "--max-roughness", "0.05", "--json"}));
    EXPECT_EQ(rough.json().at("counters").at("rays"), 0);
    const Outcome forced =
        must(render("c.png", {"--effects", "auto,reflection", "--max-roughness", "0.05", "--json"}));
    EXPECT_NE(forced.err.find("effect-unused"), std::string::npos) << forced.err;
    EXPECT_EQ(forced.json().at("counters").at("rays"), 0);
    EXPECT_GT(effectOf(forced.json(), "reflection").at("skipped").at("rough").get<int>(), 0);
}

TEST_F(RenderCommand, SeedsAndExposureChangeThePicture) {
    ASSERT_EQ(render("a.png", {"--exposure", "0"}).exit, 0);
    ASSERT_EQ(render("again.png", {"--exposure", "0"}).exit, 0);
    ASSERT_EQ(render("bright.png", {"--exposure", "2"}).exit, 0);
    EXPECT_EQ(readText(path("a.png")), readText(path("again.png")));
    EXPECT_NE(readText(path("a.png")), readText(path("bright.png")));
}

TEST_F(RenderCommand, ValidationFindsNothing) {
    must(render("a.png", {"--validate", "--camera", "auto"}));
}

TEST_F(RenderCommand, FailuresLeaveTheOldPicture) {
    writeText(path("a.png"), "old");
    const Outcome camera = render("a.png", {"--camera", "Frnt"});
    EXPECT_EQ(camera.exit, 1);
    EXPECT_NE(camera.err.find("did you mean Front?"), std::string::npos) << camera.err;
    EXPECT_EQ(render("a.png", {"--device", "no such device"}).exit, 1);
    EXPECT_EQ(render("a.png", {"--package", "no-such-folder"}).exit, 1);
    EXPECT_EQ(render("missing/a.png").exit, 1);
    EXPECT_EQ(readText(path("a.png")), "old");
}

TEST_F(RenderCommand, PackageMustMatch) {
    ASSERT_EQ(run({"compile", scene_, "-o", "package", "--strategy", "uber"}).exit, 0);
    const Outcome strategy = render("a.png", {"--package", "package", "--strategy", "visibility"});
    EXPECT_EQ(strategy.exit, 1);
    EXPECT_NE(strategy.err.find("[package-mismatch]"), std::string::npos) << strategy.err;

    // The wall gets the floor's material.
    std::string text = readText(scene_);
    const std::size_t place = text.find("\"material\":1");
    ASSERT_NE(place, std::string::npos);
    text.replace(place, 12, "\"material\":0");
    writeText(scene_, text);
    const Outcome scene = render("a.png", {"--package", "package", "--strategy", "uber"});
    EXPECT_EQ(scene.exit, 1);
    EXPECT_NE(scene.err.find("/meshes/1/primitives/0"), std::string::npos) << scene.err;
    EXPECT_FALSE(std::filesystem::exists(path("a.png")));
}

// The package that it compiles stays in memory.
TEST_F(RenderCommand, NeedsNoTemporaryFolder) {
    const std::vector<std::pair<std::string, std::string>> variables{{"TMPDIR", path("absent").string()}};
    must(run({"render", scene_, "-o", "a.png", "--size", "16x9"}, variables));
    EXPECT_FALSE(std::filesystem::exists(path("absent")));
}

}  // namespace
}  // namespace glint::testing
