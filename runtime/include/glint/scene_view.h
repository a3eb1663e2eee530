// A scene as the runtime takes it: spans over the caller's memory, read during upload and not kept.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

namespace glint {

// Differences to the attributes of a primitive; each empty or as long as its positions.
struct MorphTargetView {
    std::span<const std::array<float, 3>> positions;
    std::span<const std::array<float, 3>> normals;   // only if the primitive has normals
    std::span<const std::array<float, 3>> tangents;  // likewise
};

// A triangle list. Attribute spans are empty or as long as positions; a missing span must agree with the
// package's key for this primitive (upload reports where it does not).
struct PrimitiveView {
    std::uint32_t mesh = 0;       // as in the package's PrimitiveEntry
    std::uint32_t primitive = 0;  // within the mesh
    std::span<const std::array<float, 3>> positions;
    std::span<const std::array<float, 3>> normals;
    std::span<const std::array<float, 4>> tangents;
    std::span<const std::array<float, 2>> texCoords0;
    std::span<const std::array<float, 2>> texCoords1;
    std::span<const std::array<float, 4>> colors;  // linear RGBA
    std::span<const std::uint32_t> indices;        // 3 a triangle
    std::span<const MorphTargetView> targets{};
    // Of a primitive that follows a skin: as many a vertex for all of them, vertex by vertex. The joints
    // index InstanceView::joints; the weights of a vertex are at least 0 and sum to 1.
    std::span<const std::uint16_t> joints{};
    std::span<const float> jointWeights{};
};

// A mesh placed in the world.
struct InstanceView {
    std::uint32_t mesh = 0;
    std::array<float, 12> objectToWorld{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};  // three rows of four
    // Of a mesh that follows a skin: from the mesh's space to that which objectToWorld starts from, three
    // rows of four a joint. Empty: the mesh keeps its shape.
    std::span<const std::array<float, 12>> joints{};
    // Of a mesh with morph targets: one a target, missing ones are 0. Empty: likewise.
    std::span<const float> morphWeights{};
    // A hidden instance is neither drawn nor hit. One that may be shown later needs SceneView::moves.
    bool visible = true;
};

// RGBA, first row on top, as stored: where the package reads an image as colour, it is taken to be in sRGB.
struct ImageView {
    enum class Format : std::uint32_t {
        Rgba8,
        Rgba16,  // native byte order
    };
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::span<const std::uint8_t> pixels;  // byteCount(levels) bytes
    Format format = Format::Rgba8;
    // In `pixels`, one after another from the largest on, each of half the size of the one before, rounded
    // down. Upload makes the others of a full pyramid from the last.
    std::uint32_t levels = 1;

    std::uint32_t bytesPerPixel() const {
        return format == Format::Rgba16 ? 8 : 4;
    }
    // The bytes of the first `count` levels.
    std::uint64_t byteCount(std::uint32_t count) const {
        std::uint64_t texels = 0;
        for (std::uint32_t level = 0; level < count; ++level) {
            texels += std::max(std::uint64_t{width} >> level, std::uint64_t{1}) *
                      std::max(std::uint64_t{height} >> level, std::uint64_t{1});
        }
        return bytesPerPixel() * texels;
    }
};

struct LightView {
    enum class Type : std::uint32_t { Directional, Point, Spot };
    Type type = Type::Directional;
    std::array<float, 3> intensity{1, 1, 1};  // colour times intensity, lux or candela
    std::array<float, 3> position{};
    std::array<float, 3> direction{0, -1, 0};  // unit, the way the light travels
    float range = 0.0F;                        // metres; 0 means unlimited
    float innerConeAngle = 0.0F;               // radians
    float outerConeAngle = 0.7853982F;
    // Of soft shadows: the radius of a point or spot light, metres; half the angular diameter of a
    // directional one, radians, below a quarter turn. 0: hard.
    float size = 0.0F;
};

// The values of a material in the place of the package's: a gpu::MaterialRecord (shaders/interop/scene.h).
// Its textures and samplers stay those of the package, whatever the record says; their transforms are taken.
struct MaterialView {
    std::uint32_t material = 0;  // as in the package's PrimitiveEntry::materialIndex
    std::span<const std::uint8_t> record;
};

// The order in which the driver gets the triangles of each primitive and the instances of the scene. Mesa's
// lavapipe makes its trees by halving what it is given: without an order rays may take a hundred times as
// long. Shaders see triangles by the number that they have in that order.
enum class TraversalOrder : std::uint32_t {
    Auto,     // Halving on CPUs, Input on other devices
    Input,    // as the scene has them
    Halving,  // so that each half of the order is small, and each half of a half
};

struct SceneView {
    std::span<const PrimitiveView> primitives;  // sorted by (mesh, primitive), all meshes that instances use
    std::span<const InstanceView> instances;
    std::span<const ImageView> images;  // by the package's TextureEntry::image
    std::span<const LightView> lights;
    std::uint32_t packageScene = 0;  // which of the package's scenes it is
    // Whether GpuScene::update() will move it. What only that needs is there only if so.
    bool moves = false;
    // Materials with other values than the package's, by ascending number. Where the scene moves, these are
    // the materials that GpuScene::update() may change.
    std::span<const MaterialView> materials{};
    TraversalOrder traversalOrder = TraversalOrder::Auto;
};

// A scene that moved: instances, lights and materials as at upload, in their order and number, each of the
// same mesh, type or number, with as many joints and weights.
struct MotionView {
    // What becomes of acceleration structures that no longer fit.
    enum class Builds : std::uint32_t {
        ByRule,   // as GpuScene::update() says
        Refit,    // refitted and updated, whatever that costs rays
        Rebuild,  // built anew
    };
    std::span<const InstanceView> instances;
    std::span<const LightView> lights;
    Builds builds = Builds::ByRule;
    std::span<const MaterialView> materials{};  // those of the upload, in their order
};

// Where a frame is seen from, in world space, right-handed.
struct CameraView {
    std::array<float, 3> position{};
    std::array<float, 3> forward{0, 0, -1};  // unit
    std::array<float, 3> up{0, 1, 0};        // unit, orthogonal to forward
    bool orthographic = false;
    float halfHeight = 0.4F;  // tan(yfov / 2), or half the height of the view in metres
    float halfWidth = 0.4F;   // likewise; halfWidth / halfHeight should be width / height
    float near = 0.01F;       // metres
    float far = 0.0F;         // metres; 0 means infinite (perspective only)
};

}  // namespace glint
