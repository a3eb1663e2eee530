// Tests glint compile --embed: a package as a C++ source.
#include "cli/command.h"
#include "cli/tiny_scene.h"

#include <filesystem>
#include <string>

namespace glint::testing {
namespace {

class Embed : public TinySceneTest {};

TEST_F(Embed, AloneWritesASourceAndItsHeader) {
    const Outcome outcome = must(run({"compile", "scene.gltf", "--embed", "made/scene_package.cpp",
                                      "--strategy", "visibility", "--json"}));
    EXPECT_TRUE(outcome.json().at("output").is_null());
    EXPECT_EQ(outcome.json().at("embedded"), "made/scene_package.cpp");
    EXPECT_EQ(filesBelow(path("made")), (std::vector<std::string>{"scene_package.cpp", "scene_package.h"}));
    EXPECT_NE(readText(path("made/scene_package.cpp")).find("#include \"scene_package.h\""),
              std::string::npos);
    EXPECT_NE(readText(path("made/scene_package.h")).find("namespace glint::scene_scene"), std::string::npos);
}

TEST_F(Embed, ComesWithTheFolder) {
    ASSERT_EQ(run({"compile", "scene.gltf", "-o", "scene.glint", "--embed", "a.cpp"}).exit, 0);
    EXPECT_TRUE(std::filesystem::exists(path("scene.glint/tables.bin")));
    EXPECT_TRUE(std::filesystem::exists(path("a.cpp")));
    EXPECT_FALSE(std::filesystem::exists(path("scene.glint/a.cpp")));
}

// The second time nothing has to be compiled, but the file is written again.
TEST_F(Embed, IsMadeAgainWhereItIsGone) {
    const std::vector<std::string> command{"compile", "scene.gltf", "-o", "scene.glint", "--embed", "a.cpp"};
    ASSERT_EQ(run(command).exit, 0);
    const std::string first = readText(path("a.cpp"));
    writeText(path("a.cpp"), "altered");
    std::filesystem::remove(path("a.h"));
    ASSERT_EQ(run(command).exit, 0);
    EXPECT_EQ(readText(path("a.cpp")), first);
    EXPECT_TRUE(std::filesystem::exists(path("a.h")));
}

TEST_F(Embed, ABadSceneLeavesTheEarlierSource) {
    writeText(path("a.cpp"), "earlier");
    writeText(path("scene.gltf"), "{");
    EXPECT_EQ(run({"compile", "scene.gltf", "--embed", "a.cpp"}).exit, 1);
    EXPECT_EQ(readText(path("a.cpp")), "earlier");
    EXPECT_FALSE(std::filesystem::exists(path("a.h")));
}

TEST_F(Embed, TheFileMustBeASource) {
    const Outcome outcome = run({"compile", "scene.gltf", "--embed", "a.hpp"});
    EXPECT_EQ(outcome.exit, 2);
    EXPECT_NE(outcome.err.find(".cpp"), std::string::npos) << outcome.err;
    const Outcome nowhere = run({"compile", "scene.gltf"});
    EXPECT_EQ(nowhere.exit, 2);
    EXPECT_NE(nowhere.err.find("--embed"), std::string::npos) << nowhere.err;
}

}  // namespace
}  // namespace glint::testing
