// The gallery: a roofless room by the sea, whose exhibits have more materials than most scenes.
#pragma once

#include "gltf_writer.h"
#include "image.h"

#include <glint/result.h>

#include <filesystem>

namespace gallery {

// The indices of materials in the file, named after what they cover.
struct MaterialSet {
    int floor;
    int brick;
    int plasterLeft;
    int plasterRight;
    int beamWood;
    int benchWood;
    int water;
    int stone;
    int marblePlinth;
    int marbleTable;
    int gold;
    int copper;
    int mirror;
    int redRubber;
    int bluePlastic;
    int whitePlastic;
    int vase;
    int ruby;
    int emerald;
    int paintedStairs;
    int agave;
    int screen;
    int lantern;
    int lanternCore;
    int glass;
    int neonPink;
    int neonCyan;
    int lampPanel;
    int sign;
    int painting;
    int frame;
    int brushedSteel;
    int hammeredCopper;
    int globe;
    int tintedMarble;
    // One material for each extension, and more where a second one is worth a key.
    int carbon;
    int lacquer;
    int enamel;
    int velvetCrimson;
    int velvetPeacock;
    int amberGlass;
    int frostedGlass;
    int stainedGlass;
    int diamond;
    int filmedSteel;
    int porcelain;
    int turnedSteel;
    int paper;
    int celadon;
};

MaterialSet addMaterials(GltfWriter& writer);

void addRoom(GltfWriter& writer, const MaterialSet& materials);
// Adds the materials of all extensions except unlit and emissive strength.
void addLayeredMaterials(GltfWriter& writer, MaterialSet& set);

void addExhibits(GltfWriter& writer, const MaterialSet& materials);
// Adds the exhibits that have the materials of addLayeredMaterials().
void addShowcase(GltfWriter& writer, const MaterialSet& materials);
enum class TimeOfDay { Noon, Evening };
void addLightsAndCameras(GltfWriter& writer, TimeOfDay time);
Environment eveningSky();

// The place of the gate in the back wall.
inline constexpr float kBackWallZ = -4.0F;
inline constexpr float kGateHeight = 2.15F;
inline constexpr float kGateRadius = 1.65F;

// The position of the lamp in the paper shade.
inline const glm::vec3 kPaperShade(1.95F, 2.55F, -2.6F);

// Writes gallery.gltf, gallery.bin and the textures into `folder`; in the evening, evening.gltf, evening.bin
// and the environment map evening.hdr. Errors: "gallery-write", "png-encode", "hdr-encode".
glint::Status writeGallery(const std::filesystem::path& folder, TimeOfDay time = TimeOfDay::Noon);

}  // namespace gallery
