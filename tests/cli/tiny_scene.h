// A scene of a few triangles, written as .gltf and .bin.
#pragma once

#include "cli/command.h"

#include <filesystem>
#include <string>

namespace glint::testing {

struct TinyScene {
    bool unknownExtension = false;  // in extensionsUsed: a warning
    bool camera = true;
    bool masked = false;    // "Wall" has holes: alphaMode MASK with an alpha below the cut-off
    bool blended = false;   // "Floor" has alphaMode BLEND
    bool variants = false;  // "Day" gives the floor "Spare"; "Floor" gets a clearcoat
    // In "Slide" the wall moves by 1 m along X in a second, and its morph target lifts its top edge by 1 m.
    // In "Look" the camera moves by 1 m along X.
    bool animated = false;
};

// Writes scene.gltf and scene.bin into `folder`, and returns the path of the former. The scene has a smooth
// metal floor ("Floor"), an unlit wall ("Wall") and an unused material ("Spare").
std::filesystem::path writeTinyScene(const std::filesystem::path& folder, const TinyScene& options = {});

// Tests of commands with the scene in their folder.
class TinySceneTest : public CommandTest {
protected:
    explicit TinySceneTest(const TinyScene& options = {}) : options_(options) {}

    void SetUp() override {
        CommandTest::SetUp();
        scene_ = writeTinyScene(path(""), options_).string();
    }

    std::string scene_;  // its path

private:
    TinyScene options_;
};

// Writes a pack with one feature, "mud": the floor becomes as brown as `shade` times the material's
// extras.mud, and as rough. Gives the floor of the scene so much of it.
void writeMudPack(const std::filesystem::path& folder, double shade);
void addMud(const std::filesystem::path& scene, double amount);

}  // namespace glint::testing
