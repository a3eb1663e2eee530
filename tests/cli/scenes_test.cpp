// Tests several scenes in one package, which share cases and have their own tables.
#include "cli/command.h"
#include "cli/tiny_scene.h"

#include <filesystem>
#include <string>
#include <vector>

namespace glint::testing {
namespace {

class Scenes : public CommandTest {
protected:
    // Both scenes have the same materials, except that "night" has a clearcoat on its floor in the variant
    // Day.
    void SetUp() override {
        CommandTest::SetUp();
        for (const char* name : {"day", "night"}) {
            std::filesystem::create_directories(path(name));
            writeTinyScene(path(name), {.variants = std::string(name) == "night"});
            std::filesystem::rename(path(name) / "scene.gltf", path(name) / (std::string(name) + ".gltf"));
        }
    }
};

TEST_F(Scenes, ShareTheirCases) {
    std::filesystem::copy(path("day"), path("dusk"), std::filesystem::copy_options::recursive);
    const Outcome one = run({"compile", "day/day.gltf", "-o", "one", "--json"});
    const Outcome two = must(run({"compile", "day/day.gltf", "dusk/day.gltf", "-o", "two", "--json"}));
    EXPECT_EQ(two.json().at("counts").at("scenes"), 2);
    EXPECT_EQ(two.json().at("counts").at("materials"),
              2 * one.json().at("counts").at("materials").get<int>());
    EXPECT_EQ(two.json().at("counts").at("cases"), one.json().at("counts").at("cases"));
    // Only comments name materials; the code is the same.
    EXPECT_EQ(two.json().at("spirvBytes"), one.json().at("spirvBytes"));
    const nlohmann::json inspected = run({"inspect", "two", "--json"}).json();
    EXPECT_EQ(inspected.at("scenes")[0].at("name"), "day");
    EXPECT_EQ(inspected.at("scenes")[1].at("name"), "day_2");
}

// Only one of the scenes has the variant.
TEST_F(Scenes, AVariantIsUsedWhereThereIsOne) {
    must(run({"compile", "day/day.gltf", "night/night.gltf", "-o", "two", "--variant", "Day", "--json"}));
    const nlohmann::json scenes = run({"inspect", "two", "--json"}).json().at("scenes");
    EXPECT_TRUE(scenes[0].at("variant").is_null());
    EXPECT_EQ(scenes[1].at("variant"), "Day");
    const Outcome unknown =
        run({"compile", "day/day.gltf", "night/night.gltf", "--dry-run", "--variant", "Dawn"});
    EXPECT_EQ(unknown.exit, 1);
    EXPECT_NE(unknown.err.find("[variant-unknown]"), std::string::npos) << unknown.err;
}

// Links into a store are followed, as build systems make them, unless the caller forbids it.
TEST_F(Scenes, LinksThatLeadOutAreAChoice) {
    std::filesystem::rename(path("day") / "scene.bin", path("store.bin"));
    std::filesystem::create_symlink(path("store.bin"), path("day") / "scene.bin");
    for (const std::vector<std::string>& command :
         {std::vector<std::string>{"compile", "day/day.gltf", "--dry-run"}, {"explain", "day/day.gltf"}}) {
        must(run(command));
        std::vector<std::string> strict = command;
        strict.emplace_back("--strict-paths");
        const Outcome refused = run(strict);
        EXPECT_EQ(refused.exit, 1);
        EXPECT_NE(refused.err.find("[uri-unsafe]"), std::string::npos) << refused.err;
    }
}

// The second scene's tables lie behind the first's.
TEST_F(Scenes, RenderAsFromPackagesOfTheirOwn) {
    ASSERT_EQ(run({"compile", "day/day.gltf", "night/night.gltf", "-o", "two"}).exit, 0);
    const std::vector<std::string> frame{"--size", "32x18", "--validate"};
    const auto render = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), {"render", "night/night.gltf"});
        arguments.insert(arguments.end(), frame.begin(), frame.end());
        return run(arguments);
    };
    must(render({"-o", "a.exr", "--package", "two"}));
    ASSERT_EQ(render({"-o", "b.exr"}).exit, 0);
    EXPECT_EQ(run({"compare", "a.exr", "b.exr", "--max-error", "0"}).exit, 0);

    std::filesystem::rename(path("night/night.gltf"), path("night/dusk.gltf"));
    const Outcome stranger = run({"render", "night/dusk.gltf", "-o", "c.exr", "--package", "two"});
    EXPECT_EQ(stranger.exit, 1);
    EXPECT_NE(stranger.err.find("dusk"), std::string::npos) << stranger.err;
}

}  // namespace
}  // namespace glint::testing
