// Compiles the sources of --emit glsl with a compiler that knows nothing of Glint.
#include "cli/command.h"
#include "cli/shell.h"
#include "cli/tiny_scene.h"

#include <filesystem>
#include <string>
#include <vector>

namespace glint::testing {
namespace {

class EmittedGlsl : public CommandTest, public ::testing::WithParamInterface<const char*> {};

TEST_P(EmittedGlsl, CompilesOnItsOwn) {
    if (!hasProgram("glslangValidator")) {
        GTEST_SKIP() << "glslangValidator is not installed";
    }
    writeTinyScene(path(""), {.variants = true});
    must(run({"compile", "scene.gltf", "-o", "package", "--emit", "glsl", "--merge", "none", "--strategy",
              GetParam(), "--tracer", "all"}));
    // Only the sources are kept, because they must not need anything else.
    std::filesystem::rename(path("package/glsl"), path("alone"));
    std::filesystem::remove_all(path("package"));
    const std::vector<std::string> files = filesBelow(path("alone"));
    EXPECT_GT(files.size(), 5U);
    for (const std::string& file : files) {
        const Outcome compiled =
            runShell(path("alone"), "glslangValidator --target-env vulkan1.2 " + quoteForShell(file) +
                                        " -o " + quoteForShell(path("out.spv").string()));
        EXPECT_EQ(compiled.exit, 0) << file << "\n" << compiled.out;
        EXPECT_EQ(compiled.out.find("WARNING"), std::string::npos) << compiled.out;
    }
}

std::string testName(const ::testing::TestParamInfo<const char*>& strategy) {
    std::string name = strategy.param;
    std::erase(name, '-');
    return name;
}

INSTANTIATE_TEST_SUITE_P(Strategies, EmittedGlsl,
                         ::testing::Values("uber", "visibility", "sorted-uber", "hit-shaders"), testName);

}  // namespace
}  // namespace glint::testing
