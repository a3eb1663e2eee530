// Checks JSON that needs a device against docs/schemas.
#include "cli/render_command.h"
#include "cli/schemas.h"
#include "support/hdr_writer.h"

#include <filesystem>
#include <string>
#include <vector>

namespace glint::testing {
namespace {

using Json = nlohmann::json;

class RenderSchemas : public RenderCommand {};

TEST_F(RenderSchemas, HoldRenderAndItsStatistics) {
    const Outcome outcome = must(render("a.exr", {"--json", "--stats", "stats.json"}));
    expectFits("render", outcome.json());
    EXPECT_GT(outcome.json().size(), 1U);
    Json statistics = Json::parse(readText(path("stats.json")));
    EXPECT_FALSE(statistics.contains("diagnostics"));
    statistics["diagnostics"] = Json::array();
    expectFits("render", statistics);
}

// The folder of packs, the pictures and what is reported of a fault.
TEST_F(RenderSchemas, HoldTheChecksOfMaterials) {
    const std::filesystem::path pack = path("pack");
    std::filesystem::copy(GLINT_SOURCE_DIR "/examples/materials/retroreflection", pack);
    const std::string file = readText(pack / "retroreflection.glsl");
    const std::string density = "return l.z > 0.0 ? mirroredPdf(";
    ASSERT_TRUE(has(file, density));
    std::string broken = file;
    broken.replace(broken.find(density), density.size(), "return l.z > 0.0 ? 2.0 * mirroredPdf(");
    writeText(pack / "retroreflection.glsl", broken);
    const Outcome outcome =
        run({"check-materials", "pack", "--json", "--combinations", "4", "--pictures", "pictures"});
    EXPECT_EQ(outcome.exit, 1);
    EXPECT_TRUE(has(outcome.err, "retroreflectionDensity(): integrates to ")) << outcome.err;
    EXPECT_TRUE(has(outcome.err, "[check-density]")) << outcome.err;
    const Json report = outcome.json();
    expectFits("check-materials", report);
    // Beside the pack's feature stands Glint's own base.
    std::vector<std::string> failed;
    for (const Json& feature : report.at("features")) {
        if (feature.at("failed") == true) {
            failed.push_back(feature.at("feature").get<std::string>());
        }
    }
    EXPECT_EQ(failed, std::vector<std::string>{"retroreflection"});
    for (const Json& picture : report.at("pictures")) {
        EXPECT_TRUE(std::filesystem::exists(path(picture.get<std::string>()))) << picture;
    }
    EXPECT_EQ(report.at("pictures").size(), 4U);

    writeText(pack / "retroreflection.glsl", file);
    const Outcome sound = must(run({"check-materials", "pack", "--combinations", "4"}));
    expectFitsTerminal(sound.out);
}

TEST_F(RenderSchemas, HoldPackagesAndStrategiesWithoutOrder) {
    ASSERT_EQ(run({"compile", scene_, "-o", "package", "--strategy", "uber"}).exit, 0);
    const Outcome outcome = must(render("a.exr", {"--json", "--package", "package", "--strategy", "uber"}));
    expectFits("render", outcome.json());
}

TEST_F(RenderSchemas, HoldEnvironments) {
    const std::vector<std::array<float, 3>> pixels(64 * 32, {0.5F, 2.0F, 0.25F});
    const std::vector<std::uint8_t> bytes = encodeHdr(64, 32, pixels, HdrEncoding::Flat);
    writeText(path("sky.hdr"), std::string(bytes.begin(), bytes.end()));
    const Outcome outcome = must(render("a.exr", {"--json", "--environment", "sky.hdr"}));
    expectFits("render", outcome.json());
    EXPECT_TRUE(outcome.json().at("environment").is_object());
}

TEST_F(RenderSchemas, HoldProfiles) {
    ASSERT_EQ(render("a.exr", {"--profile", "profile.json"}).exit, 0);
    expectFits("profile", Json::parse(readText(path("profile.json"))));
}

TEST_F(RenderSchemas, HoldComparisons) {
    ASSERT_EQ(render("a.exr").exit, 0);
    ASSERT_EQ(render("b.exr", {"--seed", "1", "--no-sun"}).exit, 0);
    const Outcome equal = run({"compare", "a.exr", "a.exr", "--json"});
    expectFits("compare", equal.json());
    EXPECT_TRUE(equal.json().at("psnr").is_null());
    const Outcome different = run({"compare", "a.exr", "b.exr", "--json", "--max-error", "0"});
    EXPECT_EQ(different.exit, 1);
    expectFits("compare", different.json());
    EXPECT_EQ(different.json().at("diagnostics").at(0).at("id"), "max-error");
}

}  // namespace
}  // namespace glint::testing
