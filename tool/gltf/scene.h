// A scene as plain data, which the importer makes from a glTF file. It depends neither on JSON nor on
// Vulkan.
#pragma once

#include "gltf/animation.h"
#include "materials/material.h"

#include <glint/result.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace glint::gltf {

using Float2 = std::array<float, 2>;
using Float3 = std::array<float, 3>;
using Float4 = std::array<float, 4>;

// Column-major 4 x 4, column vectors: element (row r, column c) is m[4 * c + r], as in glTF.
using Matrix4 = std::array<double, 16>;

// Values of an attribute of vertices that a pack declares, vertex by vertex.
struct VertexValues {
    std::string name;  // in glTF: "_WEAR"
    std::uint32_t channels = 1;
    std::vector<float> values;
};

// A triangle list. Each attribute array is empty or as long as the positions; the indices are always filled.
struct Primitive {
    std::string pointer;  // JSON pointer, "/meshes/0/primitives/1"
    int material = 0;     // always valid: primitives without one use Scene::defaultMaterial
    // The materials of Scene::variants, in their order, and last that of no variant. Empty if the primitive
    // maps no variant.
    std::vector<int> variantMaterials;
    std::vector<Float3> positions;
    std::vector<Float3> normals;   // unit length; empty: flat shading
    std::vector<Float4> tangents;  // xyz has unit length, w = ±1; empty: the hit derives a frame from the UVs
    std::vector<Float2> texCoords0;
    std::vector<Float2> texCoords1;
    std::vector<Float4> colors;  // linear RGBA in [0, 1]; empty where COLOR_0 is absent
    materials::ColorContent colorContent = materials::ColorContent::None;
    std::vector<VertexValues>
        attributes;  // those of MaterialModel::attributes that the file gives, each name once
    std::vector<std::uint32_t> indices;  // 3 for each triangle, each < positions.size()
    // The parts of the material's textures that the triangles can see, with ImportOptions::trustTextures.
    std::vector<materials::SeenTexture> seen;
    bool derivesTangents = false;      // derivesTangents(), with ImportOptions::trustTextures
    std::vector<MorphTarget> targets;  // normals and tangents only if the primitive has them
    SkinInfluences influences;
};

struct Mesh {
    std::string name;
    std::vector<Primitive> primitives;
    std::vector<double> weights{};  // of the morph targets, one for each, for nodes that give none
    // The file's primitives without a triangle, and why: "/meshes/0/primitives/1: has no triangle".
    std::vector<std::string> leftOut{};
    // The mesh with the same vertices and other materials from which edits have made this one; -1: none.
    int copyOf = -1;
};

// The transform is the product T * R * S.
struct Transform {
    std::array<double, 3> translation{};
    std::array<double, 4> rotation{0.0, 0.0, 0.0, 1.0};  // unit quaternion x, y, z, w
    std::array<double, 3> scale{1.0, 1.0, 1.0};
};

// Placements of a node's mesh (EXT_mesh_gpu_instancing). The mesh is drawn once for each of them, and not for
// the node itself. Each array has `count` elements, or is empty if the file leaves it out.
struct Instancing {
    std::size_t count = 0;
    std::vector<Float3> translations;
    std::vector<Float4> rotations;  // unit quaternions x, y, z, w
    std::vector<Float3> scales;
};

// A node of the scene. An ancestor that the scene itself does not have has a transform and nothing else.
// Parents come before their children. Transforms are those of the rest pose
// until applyPose() (motion/pose.h) changes the scene's pose.
struct Node {
    std::string name;
    int parent = -1;  // index into Scene::nodes
    int mesh = -1;
    int camera = -1;
    int light = -1;
    Matrix4 world{};
    int source = -1;                  // its number in the file
    int skin = -1;                    // index into Scene::skins; a skin replaces `world`
    std::optional<Matrix4> matrix{};  // if the file gives one; else `rest` is the local transform
    Transform rest{};
    std::vector<double> restWeights{};  // one for each morph target of the mesh, from the node or the mesh
    std::vector<double> weights{};      // the same weights in the current pose
    int instancing = -1;                // index into Scene::instancings
    bool visible = true;                // KHR_node_visibility at rest; false hides all descendants, too
    bool shown = true;                  // the node and all its ancestors are visible in the current pose
    bool canShow = true;                // `shown` is true at rest, or an animation can make it true
};

struct Camera {
    std::string name;
    bool orthographic = false;
    double yfov = 0.8;    // radians, perspective
    double xmag = 1.0;    // half width, orthographic
    double ymag = 1.0;    // half height, orthographic
    double znear = 0.01;  // metres
    double zfar = 0.0;    // 0 means infinite
    Matrix4 world{};      // the camera looks along its -Z axis, with +Y up
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
    std::array<double, 3> position{};     // in the world
    Float3 direction{0.0F, 0.0F, -1.0F};  // unit, the way the light travels
    int source = -1;                      // its number in the file
    bool shown = true;                    // its node is shown in the current pose
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

// How an image file declares its colours to be stored.
enum class Transfer : std::uint8_t { Unknown, Linear, Srgb };

// The contents of an image file.
enum class Storage : std::uint8_t {
    Texels,
    Blocks,      // in a block format, which devices that have it read as it is
    Transcoded,  // data of Basis Universal, of which each device gets blocks of its own format
};

// The size of an image in pixels, and its levels. Each level has half the size of the one before, rounded
// down.
struct ImageShape {
    int width = 0;
    int height = 0;
    int levels = 1;
    package::TextureEntry::Dimension dimension = package::TextureEntry::Dimension::Flat;
    // The layers of an array, the faces +X, -X, +Y, -Y, +Z and -Z of a cube, or the slices of a 3D image,
    // whose number halves from level to level. They follow one another within a level.
    int layers = 1;

    bool operator==(const ImageShape&) const = default;
};

constexpr bool isVolume(const ImageShape& shape) {
    return shape.dimension == package::TextureEntry::Dimension::Volume;
}

constexpr int sizeOfLevel(int size, int level) {
    return size >> level > 1 ? size >> level : 1;
}

constexpr int layersOfLevel(const ImageShape& shape, int level) {
    return isVolume(shape) ? sizeOfLevel(shape.layers, level) : shape.layers;
}

// Returns the pixels of a level with all of its layers.
constexpr std::uint64_t pixelCount(const ImageShape& shape, int level) {
    return static_cast<std::uint64_t>(sizeOfLevel(shape.width, level)) *
           static_cast<std::uint64_t>(sizeOfLevel(shape.height, level)) *
           static_cast<std::uint64_t>(layersOfLevel(shape, level));
}

// The pixels are empty unless ImportOptions::decodeImages is set. Images at run time have the dimension and
// the layers of the slots that show them.
struct Image : ImageShape {
    std::string name;                         // glTF name, else the file's name, else "image N"
    std::string pointer;                      // JSON pointer
    PixelFormat format = PixelFormat::Rgba8;  // Rgba16 if the file has 16 bits for each channel
    Transfer transfer = Transfer::Unknown;    // only KTX2 files give it; the texture's use decides
    Storage storage = Storage::Texels;
    // There are byteCount() bytes. Levels start with the largest, and rows with the top one. Values stay as
    // they are stored and are not linearised.
    std::vector<std::uint8_t> pixels;
    // The bytes of the image's file, with ImportOptions::keepImageFiles. Its header was checked.
    std::vector<std::uint8_t> file;
    // The image that stands for all with the same texels, or -1 if this one does. Textures show that one.
    int sameAs = -1;
    bool isAtRunTime = false;  // a program gives its texels; until then it is white
};

// Returns the number of bytes of all levels.
constexpr std::uint64_t byteCount(const Image& image) {
    std::uint64_t pixels = 0;
    for (int level = 0; level < image.levels; ++level) {
        pixels += pixelCount(image, level);
    }
    return bytesPerPixel(image.format) * pixels;
}

struct Texture {
    int image = 0;
    int sampler = 0;  // index into Scene::samplers; a default sampler is appended for textures that name none
};

// A file from which the scene was read; used for hashes and dependency files.
struct SourceFile {
    std::string path;  // as opened
    std::uint64_t bytes = 0;
    std::uint64_t hash = 0;  // XXH3, 64 bits
};

// A material whose values animations change (KHR_animation_pointer), or a program at run time. Its features
// are decided once for all of them.
struct AnimatedMaterial {
    int material = 0;          // index into Scene::materials
    materials::Material rest;  // as the file gives it
    // The same, with the ranges of what varies. A feature is only left out if it is neutral over the whole
    // range.
    materials::Material planned;
    std::vector<std::string> changes;   // by animations, such as "metallicFactor 0 to 1"
    std::vector<std::string> edited{};  // that a program may set, in the same form
};

struct Scene {
    std::string path;  // the .gltf or .glb
    // The names of the file's scenes, empty where one has none, and the number of the one that was read. -1:
    // the file has no scenes, and all its nodes were read.
    std::vector<std::string> scenesInFile;
    int sceneInFile = -1;
    std::vector<materials::Material> materials;
    int defaultMaterial = -1;  // index of the default material, which is appended; -1 if none needs it
    std::vector<Mesh> meshes;
    std::vector<Node> nodes;
    std::vector<Camera> cameras;  // those that a node places
    std::vector<Light> lights;    // those that a node places
    std::vector<Skin> skins;      // those that nodes of the scene use
    std::vector<Animation> animations;
    std::vector<Instancing> instancings;
    std::vector<AnimatedMaterial> animatedMaterials;
    // These are the file's values. They are empty unless an animation changes more of them than their place.
    std::vector<Light> restLights;
    std::vector<Camera> restCameras;
    std::vector<Texture> textures;
    std::vector<Sampler> samplers;
    std::vector<Image> images;
    bool trustsTextures = false;  // with ImportOptions::trustTextures: materials rely on what images hold
    std::vector<SourceFile> files;
    std::vector<std::string> variants;  // the names in KHR_materials_variants, in the file's order
    std::string variant;                // its materials are in use; empty: the default materials
    std::vector<Diagnostic> warnings;   // and notes
};

}  // namespace glint::gltf
