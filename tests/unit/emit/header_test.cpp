#include "emit/package/header.h"

#include "support/must.h"
#include "unit/emit/sample_scene.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <string>

namespace glint {
namespace {

using namespace glint::testing;

// This is what a consumer would write. The static_asserts of the header are part of the test.
constexpr const char* kConsumer = R"(
namespace tables = glint::scene_sample_scene;
static_assert(tables::kSceneCount == 1 && tables::kScenes[0].materialCount == 4);
static_assert(tables::kBucketCount == 1 + tables::kShaderCount);
static_assert(tables::kShaderCount == 4);
static_assert(static_cast<unsigned>(tables::ShaderId::kUnlit_BaseTex_Uv0) < tables::kShaderCount);
static_assert((tables::kShaderFeatures[static_cast<unsigned>(tables::ShaderId::kUnlit_BaseTex_Uv0)].always &
               tables::kFeatureUnlit) != 0);
static_assert(tables::kMaterialNames0[1][8] == '\n' && tables::kMaterialNames0[1][9] == '"');
static_assert(sizeof(glint::gpu::HitRecord) == 20);
int main() { return 0; }
)";

int compileWith(const std::filesystem::path& folder, const std::string& before, const std::string& options) {
    const std::filesystem::path source = folder / "consumer.cpp";
    std::ofstream(source) << before << "#include \"glint_tables.h\"\n" << kConsumer;
    const std::string command = std::string(GLINT_CXX_COMPILER) +
                                " -std=c++17 -Wall -Wextra -Wpedantic -Werror -fsyntax-only " + options +
                                " \"" + source.string() + "\"";
    return std::system(command.c_str());
}

TEST(Header, CompilesOnItsOwnAndBesideTheInteropHeaders) {
    compiler::CompileSettings settings;
    settings.strategies = package::kStrategyUber;
    settings.plan.merge = compiler::MergePolicy::None;
    const compiler::CompiledPackage package = compileSample(settings);
    const compiler::PackageFile* const header = findFile(package, "glint_tables.h");
    ASSERT_NE(header, nullptr);
    const TemporaryFolder folder;
    std::ofstream(folder.path() / "glint_tables.h") << textOf(header);
    EXPECT_EQ(compileWith(folder.path(), "", ""), 0);
    const std::string interop = std::string("-I\"") + GLINT_SOURCE_DIR + "/shaders\"";
    EXPECT_EQ(compileWith(folder.path(), "#include <interop/frame.h>\n", interop), 0);
    EXPECT_EQ(compileWith(folder.path(), "#include <interop/types.h>\n", interop), 0);
    // This checks that the compiler really ran: a wrong expectation fails.
    EXPECT_NE(compileWith(folder.path(), "static_assert(sizeof(int) == 3);\n", "2>/dev/null"), 0);
}

TEST(Header, CompilesForASceneWithoutPrimitives) {
    gltf::Scene scene;
    scene.path = "9 empty.gltf";
    const compiler::CompiledPackage package = must(compiler::compilePackage(scene, {}, &sharedModules()));
    const TemporaryFolder folder;
    std::ofstream(folder.path() / "glint_tables.h") << textOf(findFile(package, "glint_tables.h"));
    const std::string command =
        std::string(GLINT_CXX_COMPILER) +
        " -std=c++17 -Wall -Wextra -Wpedantic -Werror -fsyntax-only -x c++ -include \"" +
        (folder.path() / "glint_tables.h").string() + "\" /dev/null";
    EXPECT_EQ(std::system(command.c_str()), 0);
}

TEST(HeaderNamespace, IsAnIdentifier) {
    EXPECT_EQ(compiler::headerNamespace("a/b/Duck.gltf"), "scene_Duck");
    EXPECT_EQ(compiler::headerNamespace("2-Cylinder  Engine.glb"), "scene_2_Cylinder_Engine");
    EXPECT_EQ(compiler::headerNamespace("__.gltf"), "scene_");
    EXPECT_EQ(compiler::headerNamespace("default.gltf"), "scene_default");
}

}  // namespace
}  // namespace glint
