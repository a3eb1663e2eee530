// Random scenes as glTF files: node trees that share meshes, with mirrored and stretched nodes, lights,
// cameras and materials. Each file can be written in several ways that show the same picture.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>

namespace glint::testing {

// The decades that scenes are drawn from: their scale, metres from the origin, and metres from the origin for
// each metre of the scene.
inline constexpr int kLeastScaleDecade = -4;
inline constexpr int kMostScaleDecade = 5;
inline constexpr int kMostOffsetDecade = 6;
inline constexpr int kMostOffsetOverScaleDecade = 10;

// Where a scene is put. Everything in it grows by `scale`, its lights and its camera included, and then
// moves.
struct ScenePlace {
    double scale = 1.0;
    std::array<double, 3> offset{};  // metres
};

enum class SceneForm : std::uint8_t {
    Tree,   // as drawn
    Baked,  // each mesh that a node draws, with the transforms of the tree in its vertices
};

class RandomScene {
public:
    // Draws a scene. Every number is a scene of its own, on each machine the same.
    explicit RandomScene(std::uint64_t seed);
    ~RandomScene();

    // Returns the text of a .gltf file without other files.
    std::string file(const ScenePlace& place, SceneForm form) const;
    // A random place.
    const ScenePlace& place() const;

    struct State;

private:
    std::unique_ptr<const State> state_;
};

// Returns a file with every material of random scenes on primitives with each choice of their attributes. A
// package that was compiled from it has the keys of all random scenes, whose textures and materials have the
// same numbers.
std::string everyRandomMaterial();

}  // namespace glint::testing
