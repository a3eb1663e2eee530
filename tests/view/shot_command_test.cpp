#include "resolve/resolve.h"
#include "settings/descriptor.h"
#include "view/controls.h"
#include "view/request.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace {

namespace compiler = glint::compiler;
using glint::view::PassHistory;
using glint::view::shotWords;
using Words = std::vector<std::string>;

const compiler::Descriptor& rowOf(std::string_view name) {
    for (const compiler::Descriptor& row : compiler::settingsTable()) {
        if (row.name == name && (row.commands & compiler::kOfRender) != 0) {
            return row;
        }
    }
    ADD_FAILURE() << name;
    return compiler::settingsTable().front();
}

compiler::Settings with(std::string_view name, std::string_view value) {
    compiler::Settings settings;
    rowOf(name).values.set(settings, value);
    return settings;
}

TEST(ShotCommand, HasWhatDiffersFromTheDefaults) {
    compiler::Settings settings = with("spp", "8");
    rowOf("effects").values.set(settings, "auto,ambient-occlusion");
    rowOf("batch-effects").values.set(settings, "on");
    settings.materials = {"packs"};
    const Words words = shotWords(
        settings, {"a b.gltf", "out.png", "1,2,3/0,0,0/30", -0.5, "1.5", "all", "", "", "edits.json"});
    EXPECT_EQ(words, (Words{"glint",
                            "render",
                            "a b.gltf",
                            "-o",
                            "out.png",
                            "--spp",
                            "8",
                            "--effects",
                            "auto,ambient-occlusion",
                            "--batch-effects",
                            "--camera",
                            "1,2,3/0,0,0/30",
                            "--time",
                            "1.5",
                            "--edits",
                            "edits.json",
                            "--animation",
                            "all",
                            "--materials",
                            "packs",
                            "--exposure",
                            "-0.5"}));
}

TEST(ShotCommand, LeavesToAPackageWhatItHasDecided) {
    compiler::Settings settings = with("merge", "none");
    settings.package = "room.glint";
    const Words words = shotWords(settings, {"a.gltf", "out.png", "", 0.0, "", "0"});
    EXPECT_EQ(std::ranges::find(words, "--merge"), words.end());
    EXPECT_NE(std::ranges::find(words, "--package"), words.end());
    EXPECT_EQ(std::ranges::find(words, "--animation"), words.end());
}

TEST(Change, FollowsFromTheTable) {
    const compiler::Settings usual;
    EXPECT_EQ(changeBetween(usual, usual), 0U);
    EXPECT_EQ(changeBetween(usual, with("clamp", "2")), compiler::kChangesFrame);
    EXPECT_EQ(changeBetween(usual, with("batch-effects", "on")), compiler::kChangesRenderer);
    EXPECT_EQ(changeBetween(usual, with("size", "64x36")), compiler::kChangesRenderer);
    EXPECT_EQ(changeBetween(usual, with("sun-angle", "1")), compiler::kChangesUpload);  // lights
    EXPECT_EQ(changeBetween(usual, with("merge", "none")), compiler::kChangesPackage);
    // Which effects a package has depends on it.
    EXPECT_EQ(changeBetween(usual, with("max-roughness", "0.5")), compiler::kChangesPackage);
    compiler::Settings lit;
    lit.environment = "sky.hdr";
    EXPECT_EQ(changeBetween(usual, lit), compiler::kChangesPackage);
}

TEST(PassHistory, KeepsFramesWithDifferentPasses) {
    PassHistory history;
    history.add({{"a", 1.0}, {"b", 2.0}});
    history.add({{"b", 4.0}, {"c", 3.0}, {"b", 1.0}});
    EXPECT_EQ(history.names(), (Words{"a", "b", "c"}));
    EXPECT_EQ(history.frames().back(), (std::vector<double>{0.0, 5.0, 3.0}));
    EXPECT_EQ(history.median(2), 3.0);
    EXPECT_EQ(history.medianFrame(), 8.0);
    for (std::size_t i = 0; i < 2 * PassHistory::kFrames; ++i) {
        history.add({{"a", 1.0}});
    }
    EXPECT_EQ(history.frames().size(), PassHistory::kFrames);
}

}  // namespace
