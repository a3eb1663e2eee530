// Tests --precision 16: which shaders compute in 16-bit float, and that they render pictures.
#include "cli/render_command.h"
#include "cli/tiny_scene.h"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace glint::testing {
namespace {

class PrecisionOption : public TinySceneTest {};

// Capabilities come first in a module, three words after the version: OpCapability Float16.
bool computesHalf(const std::string& spirv) {
    const std::string capability{"\x11\x00\x02\x00\x09\x00\x00\x00", 8};
    return spirv.find(capability) != std::string::npos;
}

TEST_F(PrecisionOption, IsInTheModulesThatShade) {
    ASSERT_EQ(
        run({"compile", scene_, "-o", "half", "--strategy", "all", "--tracer", "all", "--precision", "16"})
            .exit,
        0);
    int halves = 0;
    int firstHalves = 0;  // of first hits; those of unlit cases have nothing in 16 bits
    for (const std::string& file : filesBelow(path("half"))) {
        if (!file.ends_with(".spv")) {
            continue;
        }
        const bool half = computesHalf(readText(path("half") / file));
        halves += half ? 1 : 0;
        firstHalves += half && file.starts_with("first_") ? 1 : 0;
        const bool shades = file.starts_with("uber") || file.starts_with("sorted_shade");
        const bool never = file.starts_with("gbuffer") || file.starts_with("trace") ||
                           file.starts_with("bucket") || file.starts_with("first_c") ||
                           file.starts_with("compose");
        EXPECT_TRUE(half || !shades) << file;
        EXPECT_FALSE(half && never) << file;
    }
    EXPECT_GT(halves, 5);
    EXPECT_GT(firstHalves, 0);
    EXPECT_NE(run({"inspect", "half"}).out.find("precision            16"), std::string::npos)
        << run({"inspect", "half"}).out;
}

TEST_F(PrecisionOption, OfThirtyTwoIsTheDefault) {
    ASSERT_EQ(run({"compile", scene_, "-o", "usual"}).exit, 0);
    ASSERT_EQ(run({"compile", scene_, "-o", "single", "--precision", "32"}).exit, 0);
    int modules = 0;
    for (const std::string& file : filesBelow(path("usual"))) {
        const std::string bytes = readText(path("usual") / file);
        EXPECT_EQ(bytes, readText(path("single") / file)) << file;
        if (file.ends_with(".spv")) {
            ++modules;
            EXPECT_FALSE(computesHalf(bytes)) << file;
        }
    }
    EXPECT_GT(modules, 5);
}

}  // namespace
}  // namespace glint::testing
