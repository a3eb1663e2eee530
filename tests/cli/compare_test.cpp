#include "cli/command.h"
#include "image/image_file.h"
#include "support/must.h"

#include <limits>

namespace glint::testing {
namespace {

class CompareCommand : public CommandTest {
protected:
    void SetUp() override {
        CommandTest::SetUp();
        LinearImage image{4, 2, {}};
        image.pixels.assign(8, {0.5F, 0.5F, 0.5F, 1.0F});
        write("a.exr", image);
        image.pixels[6][1] = 0.75F;
        write("b.exr", image);
        image.pixels[0][0] = std::numeric_limits<float>::quiet_NaN();
        write("nan.exr", image);
        write("small.exr", {1, 1, {{0.0F, 0.0F, 0.0F, 1.0F}}});
    }
    void write(const std::string& name, const LinearImage& image) const {
        must(image::writeImage(path(name), image, 0.0));
    }
};

TEST_F(CompareCommand, EqualImages) {
    const Outcome outcome = must(run({"compare", "a.exr", "a.exr", "--json", "--max-error", "0"}));
    const nlohmann::json json = outcome.json();
    EXPECT_EQ(json.at("maxAbsolute").at("value"), 0.0);
    EXPECT_EQ(json.at("differing"), 0);
    EXPECT_TRUE(json.at("psnr").is_null());
    EXPECT_EQ(json.at("flip"), 0.0);
}

TEST_F(CompareCommand, SaysHowFarAndWhere) {
    const Outcome outcome = must(run({"compare", "b.exr", "a.exr", "--json"}));
    const nlohmann::json json = outcome.json();
    EXPECT_EQ(json.at("maxRelative").at("value"), 0.25);
    EXPECT_EQ(json.at("maxRelative").at("x"), 2);
    EXPECT_EQ(json.at("maxRelative").at("y"), 1);
    EXPECT_EQ(json.at("maxRelative").at("channel"), "green");
    for (const char* name : {"mean", "rmse", "relMse", "psnr", "flip"}) {
        EXPECT_GT(json.at(name).get<double>(), 0.0) << name;
    }
    const Outcome text = run({"compare", "b.exr", "a.exr"});
    EXPECT_NE(text.out.find("0.25 at (2, 1) green"), std::string::npos) << text.out;
}

// With the exposure that brings the reference to mid-grey, an image of half its radiance looks the same
// whatever that radiance is. A PNG is already in display form and keeps its own exposure.
TEST_F(CompareCommand, FlipIsOfWhatADisplayShows) {
    const auto flip = [this](const std::string& image, const std::string& reference) {
        return run({"compare", image, reference, "--json"}).json().at("flip").get<double>();
    };
    LinearImage grey{4, 2, {}};
    for (const float level : {1.0F, 0.5F, 1000.0F, 500.0F}) {
        grey.pixels.assign(8, {level, level, level, 1.0F});
        write(std::to_string(static_cast<int>(level * 10.0F)) + ".exr", grey);
    }
    EXPECT_GT(flip("5.exr", "10.exr"), 0.1);
    EXPECT_NEAR(flip("5000.exr", "10000.exr"), flip("5.exr", "10.exr"), 1e-4);

    write("shown.png", grey);
    EXPECT_EQ(flip("shown.png", "shown.png"), 0.0);
    // This compares white beyond the display's range with mid-grey.
    EXPECT_GT(flip("5000.exr", "shown.png"), 0.1);
}

TEST_F(CompareCommand, LimitDecidesTheExit) {
    EXPECT_EQ(run({"compare", "b.exr", "a.exr", "--max-error", "0.25"}).exit, 0);
    const Outcome outcome = run({"compare", "b.exr", "a.exr", "--max-error", "0.2"});
    EXPECT_EQ(outcome.exit, 1);
    EXPECT_NE(outcome.err.find("[max-error]"), std::string::npos) << outcome.err;
    EXPECT_EQ(run({"compare", "nan.exr", "nan.exr"}).exit, 0);
    EXPECT_EQ(run({"compare", "nan.exr", "nan.exr", "--max-error", "100"}).exit, 1);
}

TEST_F(CompareCommand, WritesADifferenceMap) {
    ASSERT_EQ(run({"compare", "b.exr", "a.exr", "--diff", "d.png"}).exit, 0);
    const LinearImage map = must(image::readImage(path("d.png")));
    EXPECT_EQ(map.width, 4U);
    EXPECT_EQ(map.pixels[0][0], 0.0F);
    EXPECT_GT(map.pixels[6][0], 0.0F);
}

TEST_F(CompareCommand, RefusesWhatItCantCompare) {
    const Outcome sizes = run({"compare", "a.exr", "small.exr"});
    EXPECT_EQ(sizes.exit, 1);
    EXPECT_NE(sizes.err.find("[image-mismatch]"), std::string::npos) << sizes.err;
    writeText(path("c.png"), "text");
    EXPECT_EQ(run({"compare", "a.exr", "c.png"}).exit, 1);
    const Outcome extension = run({"compare", "a.jpg", "a.exr"});
    EXPECT_EQ(extension.exit, 1);
    EXPECT_NE(extension.err.find("[image-extension]"), std::string::npos) << extension.err;
}

TEST_F(CompareCommand, FailureLeavesTheOldMap) {
    writeText(path("d.png"), "old");
    EXPECT_EQ(run({"compare", "a.exr", "small.exr", "--diff", "d.png"}).exit, 1);
    EXPECT_EQ(readText(path("d.png")), "old");
}

}  // namespace
}  // namespace glint::testing
