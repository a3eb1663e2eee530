// Where the materials of a comparison stand, and from where they are seen.
#pragma once

#include "oracle/spec/rows.h"
#include "oracle/spec/sky.h"

#include <vector>

namespace glint::spec {

// A material's plane: its middle, and its tangent, bitangent and normal. Planes are a thousand times their
// size apart, so that next to no ray of one meets another, and each is turned in its own way about normals
// that are within 40° of +Y.
struct Plane {
    Vec3 center{0.0};
    glm::dmat3 frame{1.0};
};
Plane planeOf(std::size_t row);

enum class Zone : std::uint8_t { Steep, Middle, Grazing };  // n·v above 0.7, above 0.3, below
inline constexpr const char* kZoneNames[] = {"steep", "middle", "grazing"};

struct View {
    Vec3 local{0.0, 0.0, 1.0};  // in the frame of the plane, towards the viewer
    Zone zone = Zone::Steep;
};
// Parallel views of a plane: one for each zone, or two if `many` is set.
std::vector<View> viewsOf(bool many);

// Whether the normals of base and coat, textures included, face the view.
bool faces(const Material& material, const View& view);

// Eight lights around the planes; three are below them.
std::vector<Light> lightsOfScene();

// A coloured map whose radiance changes little within a radian, one with a disk of 10° that is 60 times as
// bright, and a white one.
enum class MapKind : std::uint8_t { Smooth, Spot, White };
inline constexpr const char* kMapNames[] = {"smooth", "spot", "white"};
Vec3 radianceOf(MapKind kind, const Vec3& direction);

}  // namespace glint::spec
