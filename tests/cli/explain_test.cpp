#include "cli/command.h"
#include "cli/tiny_scene.h"

namespace glint::testing {
namespace {

class Explain : public CommandTest {
protected:
    void SetUp() override {
        CommandTest::SetUp();
        scene_ = writeTinyScene(path("")).string();
    }
    std::string scene_;
};

TEST_F(Explain, EveryMaterialIsThere) {
    const Outcome outcome = run({"explain", scene_, "--json"});
    ASSERT_EQ(outcome.exit, 0) << outcome.err;
    const nlohmann::json materials = outcome.json().at("materials");
    ASSERT_EQ(materials.size(), 3U);
    EXPECT_EQ(materials[0].at("name"), "Floor");
    EXPECT_EQ(materials[0].at("keys").size(), 1U);
    EXPECT_EQ(materials[0].at("keys")[0].at("features"), nlohmann::json({"normals"}));
    EXPECT_EQ(materials[1].at("keys")[0].at("features"), nlohmann::json({"unlit"}));
    EXPECT_NE(materials[0].at("keys")[0].at("case").at("id"), materials[1].at("keys")[0].at("case").at("id"));
    EXPECT_TRUE(materials[2].at("keys").empty());
}

TEST_F(Explain, DroppedFeaturesHaveReasons) {
    const nlohmann::json wall = run({"explain", scene_, "--material", "Wall", "--json"}).json();
    const nlohmann::json& dropped = wall.at("materials")[0].at("dropped");
    ASSERT_EQ(dropped.size(), 1U);
    EXPECT_EQ(dropped[0].at("feature"), "normals");
    EXPECT_FALSE(dropped[0].at("reason").get<std::string>().empty());
}

TEST_F(Explain, MaterialsAreFoundByNameAndNumber) {
    EXPECT_EQ(run({"explain", scene_, "--material", "Wall"}).out,
              run({"explain", scene_, "--material", "1"}).out);
    const Outcome spare = run({"explain", scene_, "--material", "Spare"});
    EXPECT_NE(spare.out.find("no primitive uses it"), std::string::npos) << spare.out;
}

TEST_F(Explain, UnknownMaterialSuggestsTheNearest) {
    const Outcome outcome = run({"explain", scene_, "--material", "Flor"});
    EXPECT_EQ(outcome.exit, 1);
    EXPECT_NE(outcome.err.find("did you mean Floor?"), std::string::npos) << outcome.err;
    EXPECT_EQ(run({"explain", scene_, "--material", "3"}).exit, 1);
}

TEST_F(Explain, MergeAllMakesOneCase) {
    const nlohmann::json materials =
        run({"explain", scene_, "--merge", "all", "--json"}).json().at("materials");
    EXPECT_EQ(materials[0].at("keys")[0].at("case"), materials[1].at("keys")[0].at("case"));
}

}  // namespace
}  // namespace glint::testing
