// Tests the way from counted hits to a package: render --profile, then --merge profile.
#include "cli/render_command.h"

#include <string>
#include <vector>

namespace glint::testing {
namespace {

class RenderProfile : public RenderCommand {};

TEST_F(RenderProfile, CountsTheHitsOfEveryKeyOverAllSamples) {
    const Outcome one = must(render("one.exr", {"--profile", "one.json", "--json"}));
    const nlohmann::json profile = nlohmann::json::parse(readText(path("one.json")));
    EXPECT_EQ(profile.at("format"), "glint-profile");
    EXPECT_EQ(profile.at("version"), 1);
    EXPECT_EQ(profile.at("alpha"), "opaque");
    EXPECT_EQ(profile.at("sources")[0].at("file"), "scene.gltf");
    ASSERT_EQ(profile.at("keys").size(), 2U);
    EXPECT_EQ(profile.at("keys")[0].at("features"), nlohmann::json({"unlit"}));
    EXPECT_EQ(profile.at("keys")[0].at("materials"), nlohmann::json({"Wall"}));
    const nlohmann::json report = one.json();
    EXPECT_EQ(report.at("merge"), "none");
    for (std::size_t key = 0; key < 2; ++key) {
        EXPECT_EQ(profile.at("keys")[key].at("hits"), report.at("counters").at("buckets")[1 + key]);
    }
    EXPECT_GT(profile.at("keys")[0].at("hits").get<int>(), 0);

    // In this scene the random numbers of a sample only decide where in its pixel a ray starts.
    const Outcome four = must(render("four.exr", {"--profile", "four.json", "--spp", "4"}));
    const nlohmann::json more = nlohmann::json::parse(readText(path("four.json")));
    const double ratio =
        more.at("keys")[0].at("hits").get<double>() / profile.at("keys")[0].at("hits").get<double>();
    EXPECT_NEAR(ratio, 4.0, 0.5);
}

TEST_F(RenderProfile, DecidesHowKeysAreMerged) {
    ASSERT_EQ(render("a.exr", {"--profile", "hits.json"}).exit, 0);
    const Outcome compiled = must(
        run({"compile", scene_, "-o", "package", "--merge", "profile", "--profile", "hits.json", "--json"}));
    EXPECT_TRUE(compiled.json().at("diagnostics").empty()) << compiled.err;
    const nlohmann::json wall = compiled.json().at("shaders")[0];
    EXPECT_EQ(wall.at("always"), nlohmann::json({"unlit"}));
    EXPECT_EQ(wall.at("reason"), "hot");
    const nlohmann::json manifest = nlohmann::json::parse(readText(path("package/manifest.json")));
    EXPECT_EQ(manifest.at("merge"), "profile");
    EXPECT_EQ(manifest.at("maxShaders"), 32);
    EXPECT_EQ(manifest.at("shaders")[0].at("reason"), "hot");
    EXPECT_EQ(manifest.at("shaders")[0].at("share"), wall.at("share"));

    // Package and policy give the same picture as any other.
    ASSERT_EQ(render("b.exr", {"--package", "package"}).exit, 0);
    ASSERT_EQ(render("c.exr", {"--merge", "profile:hits.json"}).exit, 0);
    for (const char* image : {"b.exr", "c.exr"}) {
        EXPECT_EQ(run({"compare", "a.exr", image, "--max-error", "1e-4"}).exit, 0) << image;
    }
}

TEST_F(RenderProfile, WithoutHitsIsWarnedOf) {
    const Outcome outcome = must(render("a.png", {"--profile", "hits.json", "--effects", "none"}));
    EXPECT_NE(outcome.err.find("[profile-empty]"), std::string::npos) << outcome.err;
}

TEST_F(RenderProfile, IsNotWrittenIntoAFolderThatIsNotThere) {
    const Outcome outcome = render("a.png", {"--profile", "missing/hits.json"});
    EXPECT_EQ(outcome.exit, 1);
    EXPECT_NE(outcome.err.find("[output-folder]"), std::string::npos) << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(path("a.png")));
}

}  // namespace
}  // namespace glint::testing
