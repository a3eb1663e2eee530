// Tests what glint diff finds between packages.
#include "cli/command.h"
#include "cli/tiny_scene.h"

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

namespace glint::testing {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

// Returns the elements whose member "change" has this value.
std::vector<Json> changesOf(const Json& list, const std::string& change) {
    std::vector<Json> found;
    std::ranges::copy_if(list, std::back_inserter(found),
                         [&](const Json& entry) { return entry.at("change") == change; });
    return found;
}

class Diff : public TinySceneTest {
protected:
    // Returns how many modules were compiled and not taken from a cache.
    int compile(const std::string& folder, const std::vector<std::string>& more) const {
        const Outcome outcome =
            must(runWith({"compile", scene_, "-o", folder, "--strategy", "visibility", "--json"}, more));
        return outcome.json().at("modules").at("compiled").get<int>();
    }
    Json diff() const {
        const Outcome outcome = must(run({"diff", "a", "b", "--json"}));
        return outcome.json();
    }
};

TEST_F(Diff, EqualPackagesAreTheSame) {
    compile("a", {});
    compile("b", {});
    const Json same = diff();
    EXPECT_EQ(same.at("differ"), false);
    EXPECT_EQ(same.at("same").at("shaders"), 2);
    EXPECT_EQ(same.at("same").at("materials"), 2);
    EXPECT_EQ(same.at("same").at("modules"), run({"inspect", "a", "--json"}).json().at("modules").size());
    const Outcome outcome = must(run({"diff", "a", "b", "--exit-code"}));
    EXPECT_TRUE(outcome.out.starts_with("the same: 2 shaders, ")) << outcome.out;
}

TEST_F(Diff, MergedAndSplitShaders) {
    compile("a", {"--merge", "none"});
    compile("b", {"--merge", "all"});
    const Json merged = diff();
    EXPECT_EQ(merged.at("differ"), true);
    ASSERT_EQ(merged.at("shaders").size(), 1U);
    const Json& change = merged.at("shaders")[0];
    EXPECT_EQ(change.at("change"), "merged");
    EXPECT_EQ(change.at("before").size(), 2U);
    EXPECT_EQ(change.at("after")[0].at("name"), "AllMaterials");
    EXPECT_EQ(change.at("after")[0].at("keys"), 2);
    EXPECT_TRUE(change.at("keysAdded").empty());
    // ID 0 stays with other code, and ID 1 is gone; the floor had ID 1.
    const std::vector<Json> changed = changesOf(merged.at("modules"), "changed");
    const auto ofCase =
        std::ranges::find_if(changed, [](const Json& e) { return e.at("role") == "ShadeCase"; });
    ASSERT_NE(ofCase, changed.end());
    EXPECT_EQ(ofCase->at("before").at("shaderId"), 0);
    EXPECT_GT(ofCase->at("after").at("instructions"), ofCase->at("before").at("instructions"));
    const std::vector<Json> removed = changesOf(merged.at("modules"), "removed");
    ASSERT_EQ(removed.size(), 2U);  // for first hits and for hits of rays
    for (const Json& module : removed) {
        EXPECT_EQ(module.at("before").at("shaderId"), 1);
        EXPECT_TRUE(module.at("after").is_null());
    }
    ASSERT_EQ(merged.at("materials").size(), 1U);
    EXPECT_EQ(merged.at("materials")[0].at("name"), "Floor");
    EXPECT_EQ(merged.at("materials")[0].at("before"), Json::array({1}));
    EXPECT_EQ(merged.at("materials")[0].at("after"), Json::array({0}));

    const Outcome text = run({"diff", "b", "a", "--exit-code"});
    EXPECT_EQ(text.exit, 1);
    EXPECT_TRUE(has(text.out, "merge    all  none")) << text.out;
    EXPECT_TRUE(has(text.out, "split")) << text.out;
    EXPECT_TRUE(has(text.out, "0 AllMaterials")) << text.out;
}

TEST_F(Diff, MovedShadersKeepTheirCode) {
    compile("a", {"--merge", "none"});
    writeText(path("glint.lock"), "version 1\n5 normals\n0 unlit\n");
    compile("b", {"--merge", "none", "--lock", "glint.lock"});
    const Json moved = diff();
    ASSERT_EQ(moved.at("shaders").size(), 1U);
    EXPECT_EQ(moved.at("shaders")[0].at("change"), "moved");
    EXPECT_EQ(moved.at("shaders")[0].at("before")[0].at("id"), 1);
    EXPECT_EQ(moved.at("shaders")[0].at("after")[0].at("id"), 5);
    for (const Json& module : moved.at("modules")) {
        EXPECT_NE(module.at("role"), "ShadeCase") << "IDs are no part of a case's code";
    }
    EXPECT_EQ(moved.at("same").at("shaders"), 1);
    EXPECT_EQ(moved.at("tablesDiffer"), true);
}

TEST_F(Diff, AddedAndRemovedShaders) {
    compile("a", {"--merge", "none"});
    writeTinyScene(path(""), {.variants = true});
    compile("b", {"--merge", "none"});
    const Json changed = diff();
    ASSERT_EQ(changed.at("shaders").size(), 2U);
    const std::vector<Json> added = changesOf(changed.at("shaders"), "added");
    ASSERT_EQ(added.size(), 1U);
    EXPECT_EQ(added[0].at("keysAdded"), Json::array({Json::array({"clearcoat", "normals"})}));
    EXPECT_TRUE(added[0].at("before").empty());
    ASSERT_EQ(changesOf(changed.at("shaders"), "removed").size(), 1U);
    EXPECT_EQ(changed.at("same").at("shaders"), 1);
    EXPECT_GT(changed.at("totals").size(), 0U);
    const Outcome text = run({"diff", "a", "b"});
    EXPECT_TRUE(has(text.out, "+1: clearcoat normals")) << text.out;
}

TEST_F(Diff, ValuesChangeTheTablesOnly) {
    compile("a", {"--emit", "header", "--effects", "all"});
    Json gltf = Json::parse(readText(scene_));
    gltf["materials"][0]["pbrMetallicRoughness"]["roughnessFactor"] = 0.7;
    writeText(scene_, gltf.dump());
    compile("b", {"--emit", "header", "--effects", "all"});
    const Json changed = diff();
    EXPECT_EQ(changed.at("differ"), true);
    EXPECT_EQ(changed.at("tablesDiffer"), true);
    for (const char* member : {"settings", "shaders", "modules", "materials"}) {
        EXPECT_TRUE(changed.at(member).empty()) << member;
    }
    const Outcome text = run({"diff", "a", "b"});
    EXPECT_TRUE(text.out.starts_with("tables.bin differs\nthe same: 2 shaders")) << text.out;
}

// Materials are identified by name, not by their places.
TEST_F(Diff, InsertedMaterialsMoveNoOthers) {
    compile("a", {});
    Json gltf = Json::parse(readText(scene_));
    gltf["materials"].insert(gltf["materials"].begin(), Json{{"name", "New"}});
    for (Json& mesh : gltf["meshes"]) {
        Json& material = mesh["primitives"][0]["material"];
        material = material.get<int>() + 1;
    }
    writeText(scene_, gltf.dump());
    compile("b", {});
    const Json changed = diff();
    EXPECT_TRUE(changed.at("materials").empty());
    EXPECT_TRUE(changed.at("shaders").empty());
    EXPECT_EQ(changed.at("same").at("materials"), 2);
}

TEST_F(Diff, FoldersThatAreNoPackagesAreRefused) {
    compile("a", {});
    fs::copy(path("a"), path("b"));
    fs::create_directory(path("empty"));
    EXPECT_TRUE(has(run({"diff", "a", "empty"}).err, "[package-missing]"));
    EXPECT_EQ(run({"diff", "none", "a"}).exit, 1);
    for (const char* text : {"", "[]", "{}", R"({"settings": 3})"}) {
        writeText(path("b/manifest.json"), text);
        const Outcome outcome = run({"diff", "a", "b", "--json"});
        EXPECT_EQ(outcome.exit, 1) << text;
        EXPECT_TRUE(has(outcome.err, "[manifest-format]")) << outcome.err;
    }
    Json manifest = Json::parse(readText(path("a/manifest.json")));
    manifest["shaders"][0]["materials"][0]["scene"] = 7;
    writeText(path("b/manifest.json"), manifest.dump());
    EXPECT_EQ(run({"diff", "a", "b"}).exit, 1);
    fs::remove(path("b/manifest.json"));
    EXPECT_TRUE(has(run({"diff", "a", "b"}).err, "manifest.json: error: no such file"));
}

// A change of a pack's GLSL changes the modules that have it; a change of its values changes keys.
TEST_F(Diff, PacksChangeTheirShadersAndNoOther) {
    compile("plain", {"--cache", "cache", "--merge", "none"});
    addMud(scene_, 0.5);
    writeMudPack(path("pack"), 0.25);
    const int all = compile("a", {"--cache", "cache", "--materials", "pack", "--merge", "none"});
    writeMudPack(path("pack"), 0.5);
    // The case of the floor, for first hits and for hits of rays.
    EXPECT_EQ(compile("b", {"--cache", "cache", "--materials", "pack", "--merge", "none"}), 2);
    EXPECT_GT(all, 2);
    const Json changed = diff();
    EXPECT_EQ(changed.at("differ"), true);
    EXPECT_TRUE(changed.at("shaders").empty()) << changed.at("shaders");
    std::vector<std::string> roles;
    for (const Json& module : changesOf(changed.at("modules"), "changed")) {
        roles.push_back(module.at("role"));
    }
    std::ranges::sort(roles);
    EXPECT_EQ(roles, (std::vector<std::string>{"FirstHit", "ShadeCase"})) << changed.at("modules");
    EXPECT_EQ(changed.at("modules").size(), 2U);
    EXPECT_TRUE(changed.at("settings").empty()) << changed.at("settings");
    const Json added = run({"diff", "plain", "a", "--json"}).json().at("settings");
    EXPECT_EQ(added, Json::parse(R"([{"name": "packs", "before": "none", "after": "mud"}])"));
    EXPECT_EQ(run({"inspect", "a", "--json"}).json().at("packs"), Json::array({"mud"}));
    EXPECT_TRUE(has(run({"inspect", "a"}).out, "packs                mud\n"));
    EXPECT_TRUE(has(run({"inspect", "plain"}).out, "packs                none\n"));

    addMud(scene_, 0.0);
    compile("b", {"--cache", "cache", "--materials", "pack", "--merge", "none"});
    EXPECT_FALSE(diff().at("shaders").empty());
}

}  // namespace
}  // namespace glint::testing
