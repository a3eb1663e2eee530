#include "cli/command.h"
#include "cli/tiny_scene.h"

namespace glint::testing {
namespace {

class Explain : public TinySceneTest {};

TEST_F(Explain, EveryMaterialIsThere) {
    const Outcome outcome = must(run({"explain", scene_, "--json"}));
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

TEST_F(Explain, VariantsAreListedAndChosen) {
    writeTinyScene(path(""), {.variants = true});
    const nlohmann::json usual = run({"explain", scene_, "--json"}).json();
    EXPECT_EQ(usual.at("variants"), nlohmann::json({"Day", "Night"}));
    EXPECT_TRUE(usual.at("variant").is_null());
    EXPECT_FALSE(usual.at("materials")[0].at("keys").empty());
    EXPECT_TRUE(usual.at("materials")[2].at("keys").empty());
    const nlohmann::json day = run({"explain", scene_, "--variant", "Day", "--json"}).json();
    EXPECT_EQ(day.at("variant"), "Day");
    EXPECT_TRUE(day.at("materials")[0].at("keys").empty());
    EXPECT_FALSE(day.at("materials")[2].at("keys").empty());
    const Outcome text = run({"explain", scene_, "--variant", "Day"});
    EXPECT_NE(text.out.find("Day, Night"), std::string::npos) << text.out;
}

TEST_F(Explain, AnUnknownVariantFails) {
    for (const bool variants : {false, true}) {
        writeTinyScene(path(""), {.variants = variants});
        for (const std::vector<std::string>& line : {std::vector<std::string>{"explain", scene_},
                                                     {"compile", scene_, "-o", "package"},
                                                     {"render", scene_, "-o", "picture.png"}}) {
            std::vector<std::string> arguments = line;
            arguments.insert(arguments.end(), {"--variant", "Nihgt"});
            const Outcome outcome = run(arguments);
            EXPECT_EQ(outcome.exit, 1) << line[0];
            EXPECT_NE(outcome.err.find("[variant-unknown]"), std::string::npos) << outcome.err;
            EXPECT_EQ(outcome.err.find("did you mean Night?") != std::string::npos, variants) << outcome.err;
        }
    }
    EXPECT_FALSE(std::filesystem::exists(path("package")));
    EXPECT_FALSE(std::filesystem::exists(path("picture.png")));
}

class ScenesOfAFile : public Explain {
protected:
    // The scene has a second one, "Wall only", and a third without nodes.
    void SetUp() override {
        Explain::SetUp();
        nlohmann::json file = nlohmann::json::parse(readText(scene_));
        file["scenes"].push_back({{"name", "Wall only"}, {"nodes", {1}}});
        file["scenes"].push_back(nlohmann::json::object());
        writeText(scene_, file.dump());
    }
};

TEST_F(ScenesOfAFile, AreListedAndChosen) {
    const nlohmann::json usual = run({"explain", scene_, "--json"}).json();
    EXPECT_EQ(usual.at("scenesInFile"), nlohmann::json({nullptr, "Wall only", nullptr}));
    EXPECT_EQ(usual.at("sceneInFile").at("index"), 0);
    EXPECT_TRUE(usual.at("sceneInFile").at("name").is_null());
    for (const char* const chosen : {"1", "Wall only"}) {
        const nlohmann::json wall = run({"explain", scene_, "--scene", chosen, "--json"}).json();
        EXPECT_EQ(wall.at("sceneInFile"), nlohmann::json({{"index", 1}, {"name", "Wall only"}}));
    }
    const Outcome text = run({"explain", scene_, "--scene", "1"});
    EXPECT_NE(text.out.find("0, 1 \"Wall only\", 2"), std::string::npos) << text.out;
    const nlohmann::json compiled =
        run({"compile", scene_, "--dry-run", "--scene", "Wall only", "--json"}).json();
    EXPECT_EQ(compiled.at("scenes")[0].at("sceneInFile").at("index"), 1);
}

TEST_F(ScenesOfAFile, AnUnknownOneFailsAndAnEmptyOneIsWarnedOf) {
    for (const std::vector<std::string>& line : {std::vector<std::string>{"explain", scene_},
                                                 {"compile", scene_, "-o", "package"},
                                                 {"render", scene_, "-o", "picture.png"},
                                                 {"bench", scene_, "-o", "bench"}}) {
        std::vector<std::string> arguments = line;
        arguments.insert(arguments.end(), {"--scene", "Wall onyl"});
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.exit, 1) << line[0];
        EXPECT_NE(outcome.err.find("(it has 0, 1 \"Wall only\", 2); did you mean Wall only?"),
                  std::string::npos)
            << outcome.err;
    }
    const Outcome empty = must(run({"compile", scene_, "--dry-run", "--scene", "2"}));
    EXPECT_NE(empty.err.find("it has no nodes; choose the scene 0 by --scene 0 [nothing-drawn]"),
              std::string::npos)
        << empty.err;
}

TEST_F(Explain, ATextureWithoutItsUvsIsNamed) {
    nlohmann::json file = nlohmann::json::parse(readText(scene_));
    file["images"] = nlohmann::json::array({{{"uri", "none.png"}}});
    file["textures"] = nlohmann::json::array({{{"source", 0}}});
    file["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 0;
    writeText(scene_, file.dump());
    const Outcome outcome = run(
        {"explain", scene_, "--material", "Floor", "--trust-textures", "off" /* as --no-trust-textures */});
    EXPECT_NE(outcome.out.find("baseColorTexture: the primitive has no TEXCOORD_0"), std::string::npos)
        << outcome.out << outcome.err;
    EXPECT_NE(outcome.err.find("[input-missing]"), std::string::npos) << outcome.err;
}

TEST_F(Explain, HitLobesTellHitsFromPrimarySurfaces) {
    writeTinyScene(path(""), {.variants = true});
    const auto floorKey = [&](const char* lobes) {
        const nlohmann::json json = run({"explain", scene_, "--hit-lobes", lobes, "--json"}).json();
        return json.at("materials")[0].at("keys")[0];
    };
    const nlohmann::json coated{"clearcoat", "normals"};
    for (const char* lobes : {"all", "clearcoat", "base,clearcoat"}) {
        EXPECT_EQ(floorKey(lobes).at("features"), coated) << lobes;
        EXPECT_EQ(floorKey(lobes).at("onPrimarySurfaces"), nlohmann::json::array({coated})) << lobes;
    }
    EXPECT_EQ(floorKey("base").at("features"), nlohmann::json({"normals"}));
    EXPECT_EQ(floorKey("base").at("onPrimarySurfaces"), nlohmann::json::array({coated}));
    const Outcome text = run({"explain", scene_, "--hit-lobes", "base", "--material", "Floor"});
    EXPECT_NE(text.out.find("primary only  clearcoat"), std::string::npos) << text.out;
    EXPECT_NE(text.out.find("clearcoat: hits do not keep it (--hit-lobes)"), std::string::npos) << text.out;
}

// The names of packs' lobes are known once the packs are read.
TEST_F(Explain, KeepsLobesOfPacksForHits) {
    const std::string packs = GLINT_SOURCE_DIR "/examples/materials";
    const auto explained = [&](const std::string& lobes) {
        return run({"explain", packs + "/scene.gltf", "--materials", packs, "--material", "Satin",
                    "--hit-lobes", lobes, "--json"});
    };
    const auto keyOf = [&](const std::string& lobes) {
        const Outcome outcome = must(explained(lobes));
        return outcome.json().at("materials").at(0).at("keys").at(0).dump();
    };
    EXPECT_TRUE(has(keyOf("all"), "\"fibre\""));
    EXPECT_TRUE(has(keyOf("base,fibre"), "\"fibre\""));
    EXPECT_TRUE(has(explained("base,flakes").json().dump(), "hits do not keep it (--hit-lobes)"));
    const Outcome unknown = explained("base,fibbre");
    EXPECT_EQ(unknown.exit, 1);
    EXPECT_TRUE(has(unknown.err, "did you mean fibre?")) << unknown.err;
    EXPECT_TRUE(has(unknown.err, "[hit-lobe-unknown]")) << unknown.err;
}

}  // namespace
}  // namespace glint::testing
