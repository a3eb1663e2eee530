// The floor, walls, gate, beams and sea; and the lights and cameras.
#include "builder.h"
#include "shapes.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <cmath>

namespace gallery {

namespace {

constexpr float kHalfWidth = 5.0F;
constexpr float kFrontZ = 6.0F;
constexpr float kWallHeight = 4.2F;
constexpr float kWallThickness = 0.24F;
// Places a camera or light at `from` so that it looks at `to`.
Placement lookAt(const glm::vec3& from, const glm::vec3& to) {
    const glm::vec3 forward = glm::normalize(to - from);
    return {from, glm::quatLookAt(forward, std::abs(forward.y) > 0.99F ? kX : kY)};
}

void addGround(GltfWriter& writer, const MaterialSet& materials) {
    const float depth = kFrontZ + 4.0F - kBackWallZ;
    const int floor = writer.addMesh(
        "Floor",
        {{writer.addGeometry(panel({2.0F * kHalfWidth + 1.0F, depth}), kTextured), materials.floor}});
    writer.addMeshNode("Floor", floor, {{0.0F, 0.0F, kBackWallZ - 1.5F + 0.5F * depth}, turn(-90.0F, kX)});
    const int edge = writer.addMesh(
        "Terrace", {{writer.addGeometry(box({2.0F * kHalfWidth + 1.02F, 0.5F, depth + 0.02F}), kPlain),
                     materials.stone}});
    writer.addMeshNode("Terrace", edge, {{0.0F, -0.252F, kBackWallZ - 1.5F + 0.5F * depth}});
    const int sea =
        writer.addMesh("Sea", {{writer.addGeometry(panel({400.0F, 400.0F}), kBumped), materials.water}});
    writer.addMeshNode("Sea", sea, {{0.0F, -0.9F, 0.0F}, turn(-90.0F, kX)});
}

void addWalls(GltfWriter& writer, const MaterialSet& materials) {
    const MeshData wall =
        gateWall({2.0F * kHalfWidth, kWallHeight, kWallThickness}, {0.0F, kGateHeight}, kGateRadius);
    const int back = writer.addMesh("Back wall", {{writer.addGeometry(wall, kBumped), materials.brick}});
    writer.addMeshNode("Back wall", back, {{0.0F, 0.0F, kBackWallZ}});

    // The ring hides the cut edge of the wall, because its tube is wider than the wall is thick.
    const int ring = writer.addMesh(
        "Gate ring", {{writer.addGeometry(torus(kGateRadius, 0.15F, 128, 24), kPlain), materials.copper}});
    writer.addMeshNode("Gate ring", ring,
                       {{0.0F, kGateHeight, kBackWallZ}, turn(90.0F, kX), {1.0F, 1.15F, 1.0F}});

    const float length = kFrontZ - kBackWallZ;
    const int side = writer.addGeometry(box({kWallThickness, kWallHeight, length}), kTextured);
    const float middle = 0.5F * (kFrontZ + kBackWallZ);
    writer.addMeshNode("Left wall", writer.addMesh("Left wall", {{side, materials.plasterLeft}}),
                       {{-kHalfWidth, 0.5F * kWallHeight, middle}});
    writer.addMeshNode("Right wall", writer.addMesh("Right wall", {{side, materials.plasterRight}}),
                       {{kHalfWidth, 0.5F * kWallHeight, middle}});
    const int skirting = writer.addMesh(
        "Skirting", {{writer.addGeometry(box({0.06F, 0.16F, length}), kPlain), materials.stone}});
    for (const float sideX : {-1.0F, 1.0F}) {
        writer.addMeshNode("Skirting", skirting,
                           {{sideX * (kHalfWidth - 0.5F * kWallThickness - 0.03F), 0.08F, middle}});
    }
}

void addBeams(GltfWriter& writer, const MaterialSet& materials) {
    const int beam = writer.addMesh(
        "Beam",
        {{writer.addGeometry(box({2.0F * kHalfWidth + 0.8F, 0.22F, 0.14F}), kTextured), materials.beamWood}});
    for (int index = 0; index < 6; ++index) {
        writer.addMeshNode(
            "Beam", beam,
            {{0.0F, kWallHeight + 0.11F, kBackWallZ + 0.4F + 1.85F * static_cast<float>(index)}});
    }
}

// The direction to the evening's sun, over the left wall and behind the gate.
const glm::vec3 kEveningSun(-7.0F, 4.6F, -3.0F);

}  // namespace

void addRoom(GltfWriter& writer, const MaterialSet& materials) {
    addGround(writer, materials);
    addWalls(writer, materials);
    addBeams(writer, materials);
}

void addLightsAndCameras(GltfWriter& writer, TimeOfDay time) {
    const bool evening = time == TimeOfDay::Evening;
    const std::array<double, 3> warm{1.0, 0.72, 0.45};
    if (evening) {
        writer.addLightNode({"Sun", "directional", {1.0, 0.62, 0.33}, 5.0}, lookAt(kEveningSun, {}));
    } else {
        writer.addLightNode({"Sun", "directional", {1.0, 0.94, 0.84}, 2.6},
                            lookAt({3.0F, 6.0F, 4.5F}, {0.0F, 0.0F, 0.0F}));
    }
    writer.addLightNode({"Lantern light", "point", warm, evening ? 10.0 : 7.0}, {{-1.75F, 2.75F, -1.3F}});
    writer.addLightNode({"Lamp light", "point", warm, evening ? 14.0 : 9.0}, {kPaperShade});
    writer.addLightNode({"Fill light", "point", {1.0, 0.80, 0.62}, evening ? 2.0 : 6.0},
                        {{-1.5F, 3.6F, 3.0F}});
    writer.addLightNode({"Knot spot", "spot", {1.0, 0.92, 0.80}, 40.0, std::array{0.16, 0.30}},
                        lookAt({1.2F, 4.1F, 1.2F}, {0.0F, 1.95F, -2.2F}));
    if (evening) {
        writer.addCameraNode("evening", 0.65, lookAt({1.85F, 1.2F, 6.1F}, {-0.1F, 1.12F, -1.5F}));
    }
    writer.addCameraNode("main", 0.70, lookAt({0.9F, 1.85F, 7.3F}, {0.05F, 1.40F, -2.0F}));
    writer.addCameraNode("detail", 0.62, lookAt({2.6F, 1.35F, 3.6F}, {0.4F, 0.75F, 0.4F}));
}

Environment eveningSky() {
    const glm::vec3 zenith(0.09F, 0.16F, 0.36F);
    const glm::vec3 middle(0.40F, 0.34F, 0.50F);
    const glm::vec3 horizon(1.05F, 0.54F, 0.34F);
    const glm::vec3 glow(1.6F, 0.75F, 0.30F);
    const glm::vec3 ground(0.12F, 0.11F, 0.12F);
    const glm::vec3 sun = glm::normalize(kEveningSun);
    return paintEnvironment(512, 256, [&](const glm::vec3& direction) {
        if (direction.y < 0.0F) {
            return ground;
        }
        const float height = glm::min(direction.y / 0.35F, 1.0F);
        const float towardsSun = glm::dot(direction, sun);
        const float side = 0.35F + 0.65F * std::pow(glm::clamp(0.5F * (towardsSun + 1.0F), 0.0F, 1.0F), 1.5F);
        return side * (horizon * std::pow(1.0F - height, 1.6F) + 2.0F * middle * height * (1.0F - height) +
                       zenith * height) +
               glow * std::exp(18.0F * (towardsSun - 1.0F));
    });
}

}  // namespace gallery
