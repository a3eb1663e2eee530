// A scene as plain data: what the importer makes of a glTF file. Knows nothing of tinygltf or Vulkan.
#pragma once

#include "gltf/animation.h"
#include "plan/material.h"

#include <glint/result.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace glint {

using Float2 = std::array<float, 2>;
using Float3 = std::array<float, 3>;
using Float4 = std::array<float, 4>;

// Column-major 4 x 4, column vectors: element (row r, column c) is m[4 * c + r], as in glTF.
using Matrix4 = std::array<double, 16>;

// A triangle list. Attribute arrays are empty or as long as positions; indices are always filled.
struct Primitive {
    std::string pointer;  // JSON pointer, "/meshes/0/primitives/1"
    int material = 0;     // always valid: primitives without one use Scene::defaultMaterial
    std::vector<Float3> positions;
    std::vector<Float3> normals;   // unit; empty: flat shading
    std::vector<Float4> tangents;  // unit xyz; w = ±1; empty: the hit derives a frame from the UVs
    std::vector<Float2> texCoords0;
    std::vector<Float2> texCoords1;
    std::vector<Float4> colors;  // linear RGBA; empty where COLOR_0 is absent
    ColorContent colorContent = ColorContent::None;
    std::vector<std::uint32_t> indices;  // 3 a triangle, each < positions.size()
    std::vector<MorphTarget> targets;    // normals only if it has normals, tangents likewise
    SkinInfluences influences;
};

struct Mesh {
    std::string name;
    std::vector<Primitive> primitives;
    std::vector<double> weights{};  // of the morph targets, where a node gives none; one for each target
};

// T * R * S.
struct Transform {
    std::array<double, 3> translation{};
    std::array<double, 4> rotation{0.0, 0.0, 0.0, 1.0};  // unit quaternion x, y, z, w
    std::array<double, 3> scale{1.0, 1.0, 1.0};
};

// Placements of a node's mesh beside each other (EXT_mesh_gpu_instancing): the mesh is drawn once for each of
// them, and not for the node itself. Each array is empty, where the file leaves it out, or has `count`
// elements.
struct Instancing {
    std::size_t count = 0;
    std::vector<Float3> translations;
    std::vector<Float4> rotations;  // unit quaternions x, y, z, w
    std::vector<Float3> scales;
};

// A node of the default scene, parents before children. Transforms are those of the rest pose until
// applyPose() (motion/pose.h) puts the scene into another.
struct Node {
    std::string name;
    int parent = -1;  // index into Scene::nodes
    int mesh = -1;
    int camera = -1;
    int light = -1;
    Matrix4 world{};
    int source = -1;                  // its number in the file
    int skin = -1;                    // index into Scene::skins: then the mesh follows that, and not `world`
    std::optional<Matrix4> matrix{};  // where the file gives one; else `rest` is the local transform
    Transform rest{};
    std::vector<double> restWeights{};  // of the mesh's morph targets: one each, whoever gives them
    std::vector<double> weights{};      // likewise, as posed
    int instancing = -1;                // index into Scene::instancings
    bool visible = true;                // KHR_node_visibility at rest: hides the node and all below it
    bool shown = true;                  // it and all above it are visible, as posed
    bool canShow = true;                // `shown` at rest, or an animation can make it so
};

struct Camera {
    std::string name;
    bool orthographic = false;
    double yfov = 0.8;    // radians, perspective
    double xmag = 1.0;    // half width, orthographic
    double ymag = 1.0;    // half height, orthographic
    double znear = 0.01;  // metres
    double zfar = 0.0;    // 0 means infinite
    Matrix4 world{};      // looks along its -Z, +Y up
    int source = -1;      // its number in the file
};

enum class LightType : std::uint8_t { Directional, Point, Spot };

// A punctual light placed in the world (KHR_lights_punctual).
struct Light {
    std::string name;
    LightType type = LightType::Directional;
    Float3 color{1.0F, 1.0F, 1.0F};  // linear
    float intensity = 1.0F;          // lux or candela
    float range = 0.0F;              // metres; 0 means unlimited
    float innerConeAngle = 0.0F;     // radians
    float outerConeAngle = 0.7853982F;
    Float3 position{};
    Float3 direction{0.0F, 0.0F, -1.0F};  // unit, the way the light travels
    int source = -1;                      // its number in the file
    bool shown = true;                    // its node is, as posed
    // Whether it has an intensity at rest, or an animation can give it one.
    bool canShine = false;

    bool shines() const {
        return shown && intensity > 0.0F && (color[0] > 0.0F || color[1] > 0.0F || color[2] > 0.0F);
    }
};

enum class Wrap : std::uint8_t { Repeat, ClampToEdge, MirroredRepeat };
enum class Filter : std::uint8_t { Nearest, Linear };

struct Sampler {
    Wrap wrapU = Wrap::Repeat;
    Wrap wrapV = Wrap::Repeat;
    Filter magnification = Filter::Linear;
    Filter minification = Filter::Linear;
    Filter mip = Filter::Linear;
    bool mipmapped = true;

    bool operator==(const Sampler&) const = default;
};

enum class PixelFormat : std::uint8_t {
    Rgba8,
    Rgba16  // native byte order
};

constexpr std::size_t bytesPerPixel(PixelFormat format) {
    return format == PixelFormat::Rgba16 ? 8 : 4;
}

// How an image file says that its colours are stored.
enum class Transfer : std::uint8_t { Unknown, Linear, Srgb };

// Pixels are empty unless ImportOptions::decodeImages.
struct Image {
    std::string name;     // glTF name, else the file's name, else "image N"
    std::string pointer;  // JSON pointer
    int width = 0;
    int height = 0;
    PixelFormat format = PixelFormat::Rgba8;  // Rgba16 where the file has 16 bits
    // Above 1 where the file has mips. Each level has half the size of the one before, rounded down.
    int levels = 1;
    Transfer transfer = Transfer::Unknown;  // known of KTX2 alone; what reads a texture decides how
    // byteCount() bytes: the levels from the largest on, first row on top, as stored (not linearised).
    std::vector<std::uint8_t> pixels;
};

constexpr std::uint64_t pixelCount(const Image& image, int level) {
    const auto sizeOf = [level](int size) { return static_cast<std::uint64_t>(size >> level); };
    const std::uint64_t width = sizeOf(image.width);
    const std::uint64_t height = sizeOf(image.height);
    return (width == 0 ? 1 : width) * (height == 0 ? 1 : height);
}

// The bytes of all levels.
constexpr std::uint64_t byteCount(const Image& image) {
    std::uint64_t pixels = 0;
    for (int level = 0; level < image.levels; ++level) {
        pixels += pixelCount(image, level);
    }
    return bytesPerPixel(image.format) * pixels;
}

struct Texture {
    int image = 0;
    int sampler = 0;  // index into Scene::samplers; a default one is appended where glTF names none
};

// A file that the scene was read from, for hashes and dependency files.
struct SourceFile {
    std::string path;  // as opened
    std::uint64_t bytes = 0;
    std::uint64_t hash = 0;  // XXH3, 64 bits
};

// A material whose values animations change (KHR_animation_pointer). Which features it needs is decided once
// for all times, by two materials that stand for every value between the least and the greatest that it takes
// at rest or in a keyframe.
struct AnimatedMaterial {
    int material = 0;  // index into Scene::materials
    Material rest;     // as the file has it
    // A value that varies is between its bounds, and none at which a feature changes nothing.
    Material generic;
    Material smoothest;                // the same, but as smooth as it gets
    std::vector<std::string> changes;  // "metallicFactor 0 to 1": those that vary
};

struct Scene {
    std::string path;  // the .gltf or .glb
    std::vector<Material> materials;
    int defaultMaterial = -1;  // index of the appended glTF default material, or -1 if no primitive needs it
    std::vector<Mesh> meshes;
    std::vector<Node> nodes;
    std::vector<Camera> cameras;  // those that a node places
    std::vector<Light> lights;    // those that a node places
    std::vector<Skin> skins;      // those of nodes of the scene
    std::vector<Animation> animations;
    std::vector<Instancing> instancings;
    std::vector<AnimatedMaterial> animatedMaterials;
    // As the file has them; empty where no animation changes more of them than their place.
    std::vector<Light> restLights;
    std::vector<Camera> restCameras;
    std::vector<Texture> textures;
    std::vector<Sampler> samplers;
    std::vector<Image> images;
    std::vector<SourceFile> files;
    std::vector<std::string> variants;  // names that KHR_materials_variants gives, in the file's order
    std::string variant;               // the one whose materials the primitives have; empty: the default ones
    std::vector<Diagnostic> warnings;  // and notes
};

}  // namespace glint
