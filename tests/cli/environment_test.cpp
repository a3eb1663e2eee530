#include "cli/command.h"
#include "cli/tiny_scene.h"
#include "image/image_file.h"
#include "support/hdr_writer.h"
#include "support/must.h"

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace glint::testing {
namespace {

class EnvironmentCommand : public TinySceneTest {
protected:
    void SetUp() override {
        TinySceneTest::SetUp();
        const std::vector<std::array<float, 3>> pixels(64 * 32, {0.5F, 2.0F, 0.25F});
        const std::vector<std::uint8_t> bytes = encodeHdr(64, 32, pixels, HdrEncoding::Flat);
        writeText(path("sky.hdr"), std::string(bytes.begin(), bytes.end()));
    }
    Outcome render(const std::string& image, const std::vector<std::string>& more) const {
        return runWith({"render", scene_, "-o", image, "--size", "64x36", "--merge", "all"}, more);
    }
    // Writes a map with the value 1 in all pixels except one.
    void writeExr(const std::string& name, std::uint32_t width, std::uint32_t height, float odd) const {
        LinearImage image{width, height, {}};
        image.pixels.assign(std::size_t{width} * height, {1.0F, 1.0F, 1.0F, 1.0F});
        image.pixels[width + 2][1] = odd;
        ASSERT_TRUE(image::writeImage(path(name), image, 0.0));
    }
};

TEST_F(EnvironmentCommand, LightsTheScene) {
    const Outcome outcome = must(render("a.exr", {"--environment", "sky.hdr", "--environment-intensity", "2",
                                                  "--environment-rotation", "-90", "--json", "--validate"}));
    const nlohmann::json map = outcome.json().at("environment");
    EXPECT_EQ(map.at("file"), "sky.hdr");
    EXPECT_EQ(map.at("width"), 256);
    EXPECT_EQ(map.at("levels"), 4);
    EXPECT_NE(outcome.err.find("note: is 64 x 32, and resampled to 256 x 128"), std::string::npos)
        << outcome.err;
    const LinearImage image = must(image::readImage(path("a.exr")));
    // The top left shows the sky.
    EXPECT_NEAR(image.pixels[0][0], 1.0F, 1e-3F);
    EXPECT_NEAR(image.pixels[0][1], 4.0F, 1e-3F);
    const Outcome none = must(render("b.png", {"--json"}));
    EXPECT_TRUE(none.json().at("environment").is_null());
}

TEST_F(EnvironmentCommand, PackageMustHaveTheSameSky) {
    ASSERT_EQ(run({"compile", scene_, "-o", "map", "--environment-map", "--merge", "all"}).exit, 0);
    ASSERT_EQ(run({"compile", scene_, "-o", "gradient", "--merge", "all"}).exit, 0);
    const auto withPackage = [&](const std::string& package, bool map) {
        std::vector<std::string> arguments{"render", scene_,  "-o",        "a.png",
                                           "--size", "64x36", "--package", package};
        if (map) {
            arguments.insert(arguments.end(), {"--environment", "sky.hdr"});
        }
        return run(arguments);
    };
    EXPECT_EQ(withPackage("map", true).exit, 0);
    const Outcome without = withPackage("map", false);
    EXPECT_EQ(without.exit, 1);
    EXPECT_NE(without.err.find("give one by --environment"), std::string::npos) << without.err;
    const Outcome unread = withPackage("gradient", true);
    EXPECT_EQ(unread.exit, 1);
    EXPECT_NE(unread.err.find("compile it with --environment-map"), std::string::npos) << unread.err;
}

TEST_F(EnvironmentCommand, SaysWhatIsWrongWithAMap) {
    writeExr("nan.exr", 8, 4, std::numeric_limits<float>::quiet_NaN());
    const Outcome nan = render("a.png", {"--environment", "nan.exr"});
    EXPECT_EQ(nan.exit, 1);
    EXPECT_NE(nan.err.find("nan.exr: error: the pixel at column 2, row 1 from the top left is NaN"),
              std::string::npos)
        << nan.err;
    writeExr("infinite.exr", 8, 4, std::numeric_limits<float>::infinity());
    EXPECT_NE(render("a.png", {"--environment", "infinite.exr"}).err.find("is infinite"), std::string::npos);
    writeText(path("cut.hdr"), readText(path("sky.hdr")).substr(0, 5000));
    EXPECT_NE(render("a.png", {"--environment", "cut.hdr"}).err.find("ends early"), std::string::npos);
    EXPECT_EQ(render("a.png", {"--environment", "none.exr"}).exit, 1);
    EXPECT_FALSE(std::filesystem::exists(path("a.png")));

    writeExr("odd.exr", 8, 8, -1.0F);
    const Outcome odd = must(render("a.png", {"--environment", "odd.exr"}));
    EXPECT_NE(odd.err.find("[environment-aspect]"), std::string::npos) << odd.err;
    EXPECT_NE(odd.err.find("1 pixels have negative radiance"), std::string::npos) << odd.err;
}

TEST_F(EnvironmentCommand, OptionsAreChecked) {
    EXPECT_EQ(render("a.png", {"--environment", "sky.png"}).exit, 2);
    EXPECT_EQ(render("a.png", {"--environment-rotation", "90"}).exit, 2);
    EXPECT_EQ(render("a.png", {"--environment", "sky.hdr", "--environment-intensity", "-1"}).exit, 2);
    EXPECT_EQ(render("a.png", {"--environment", "sky.hdr", "--environment-rotation", "nan"}).exit, 2);
}

}  // namespace
}  // namespace glint::testing
