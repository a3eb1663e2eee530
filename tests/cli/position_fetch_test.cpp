// Tests --position-fetch: the same picture, or the reason why this build or device can't do it.
#include "cli/command.h"
#include "cli/tiny_scene.h"
#include "spirv/compiler.h"

#include <filesystem>
#include <string>
#include <vector>

namespace glint::testing {
namespace {

class PositionFetch : public TinySceneTest, public ::testing::WithParamInterface<const char*> {
protected:
    Outcome render(const std::string& image, bool fetches) {
        std::vector<std::string> arguments{"render", scene_,       "-o",     image,        "--size",
                                           "64x36",  "--validate", "--json", "--strategy", GetParam()};
        if (fetches) {
            arguments.emplace_back("--position-fetch");
        }
        return run(arguments);
    }
};

TEST_P(PositionFetch, GivesTheSameImage) {
    const Outcome fetched = render("fetched.exr", true);
    if (!compiler::supportsPositionFetch()) {
        EXPECT_EQ(fetched.exit, 1);
        EXPECT_NE(fetched.err.find("GL_EXT_ray_tracing_position_fetch"), std::string::npos) << fetched.err;
        GTEST_SKIP() << "built with glslang " << compiler::glslangVersion()
                     << ", which has no position fetch";
    }
    if (fetched.err.find("VK_KHR_ray_tracing_position_fetch") != std::string::npos) {
        GTEST_SKIP() << "the device has no position fetch";
    }
    ASSERT_EQ(fetched.exit, 0) << fetched.err;
    const Outcome stored = must(render("stored.exr", false));
    EXPECT_EQ(run({"compare", "fetched.exr", "stored.exr", "--max-error", "0"}).exit, 0);
}

INSTANTIATE_TEST_SUITE_P(Strategies, PositionFetch, ::testing::Values("uber", "hit-shaders"),
                         [](const auto& instance) {
                             return std::string(instance.param) == "uber" ? "Uber" : "HitShaders";
                         });

class PositionFetchCompile : public CommandTest {};

// It is not a setting of a package in which no shader would use it.
TEST_F(PositionFetchCompile, IsRefusedWhereNoShaderCould) {
    const std::string scene = writeTinyScene(path("")).string();
    const Outcome outcome =
        run({"compile", scene, "-o", "package", "--strategy", "visibility", "--position-fetch"});
    EXPECT_EQ(outcome.exit, 1);
    EXPECT_NE(outcome.err.find("[position-fetch]"), std::string::npos) << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(path("package")));
}

// Only the modules that both trace and shade read positions from the acceleration structure.
TEST_F(PositionFetchCompile, IsInTheModulesThatCan) {
    const std::string scene = writeTinyScene(path("")).string();
    const Outcome outcome =
        run({"compile", scene, "-o", "package", "--strategy", "all", "--tracer", "all", "--position-fetch"});
    if (!compiler::supportsPositionFetch()) {
        EXPECT_EQ(outcome.exit, 1);
        GTEST_SKIP() << "built with glslang " << compiler::glslangVersion()
                     << ", which has no position fetch";
    }
    ASSERT_EQ(outcome.exit, 0) << outcome.err;
    const std::string extension = "SPV_KHR_ray_tracing_position_fetch";
    for (const std::string& file : filesBelow(path("package"))) {
        if (!file.ends_with(".spv")) {
            continue;
        }
        const bool fetches = readText(path("package") / file).find(extension) != std::string::npos;
        EXPECT_EQ(fetches, file == "uber.spv" || (file.starts_with("hit_") && file.ends_with(".rchit.spv")))
            << file;
    }
}

}  // namespace
}  // namespace glint::testing
