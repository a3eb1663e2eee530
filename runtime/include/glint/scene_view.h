// A scene as the runtime takes it. Its spans refer to the caller's memory; upload reads them and does not
// keep them.
//
// A scene has an origin: the point of the world from which places in single precision are counted. Transforms
// of instances, joints and lights are relative to it, and all that shaders compute is, too. So a scene a
// million metres away is as exact as one that is close. A camera has its place in the world, in double
// precision. The difference of the two is all that a frame needs.
#pragma once

#include <glint/package_shape.h>
#include <glint/result.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace glint {

// --- The storage of an image's texels: as they are, or in blocks that GPUs read without unpacking them ---

// Values are within [0, 1]. Sources of the block formats: Khronos Data Format Specification 1.3, sections 18
// (BC1 to BC5), 19 (BC7), 21 (ETC2 and EAC) and 23 (ASTC).
enum class TexelFormat : std::uint32_t {
    Rgba8,
    Rgba16,  // native byte order
    Bc1,     // RGB, and alpha of 0 or 1
    Bc2,
    Bc3,
    Bc4,  // R
    Bc5,  // RG
    Bc7,
    Etc2Rgb,
    Etc2Rgba1,  // alpha of 0 or 1
    Etc2Rgba,
    EacR,
    EacRg,
    Astc4x4,
    Astc5x4,
    Astc5x5,
    Astc6x5,
    Astc6x6,
    Astc8x5,
    Astc8x6,
    Astc8x8,
    Astc10x5,
    Astc10x6,
    Astc10x8,
    Astc10x10,
    Astc12x10,
    Astc12x12,
};

struct TexelFormatInfo {
    const char* name;
    std::uint32_t blockWidth;  // texels
    std::uint32_t blockHeight;
    std::uint32_t blockBytes;
    std::uint32_t channels;  // red first; a shader reads 0 for the other colours and 1 for alpha
    bool hasSrgb;            // there is such a format with colours in sRGB
};

// Indexed by TexelFormat.
inline constexpr TexelFormatInfo kTexelFormats[] = {
    {"RGBA8", 1, 1, 4, 4, true},         {"RGBA16", 1, 1, 8, 4, false},
    {"BC1", 4, 4, 8, 4, true},           {"BC2", 4, 4, 16, 4, true},
    {"BC3", 4, 4, 16, 4, true},          {"BC4", 4, 4, 8, 1, false},
    {"BC5", 4, 4, 16, 2, false},         {"BC7", 4, 4, 16, 4, true},
    {"ETC2 RGB", 4, 4, 8, 3, true},      {"ETC2 RGBA1", 4, 4, 8, 4, true},
    {"ETC2 RGBA", 4, 4, 16, 4, true},    {"EAC R", 4, 4, 8, 1, false},
    {"EAC RG", 4, 4, 16, 2, false},      {"ASTC 4x4", 4, 4, 16, 4, true},
    {"ASTC 5x4", 5, 4, 16, 4, true},     {"ASTC 5x5", 5, 5, 16, 4, true},
    {"ASTC 6x5", 6, 5, 16, 4, true},     {"ASTC 6x6", 6, 6, 16, 4, true},
    {"ASTC 8x5", 8, 5, 16, 4, true},     {"ASTC 8x6", 8, 6, 16, 4, true},
    {"ASTC 8x8", 8, 8, 16, 4, true},     {"ASTC 10x5", 10, 5, 16, 4, true},
    {"ASTC 10x6", 10, 6, 16, 4, true},   {"ASTC 10x8", 10, 8, 16, 4, true},
    {"ASTC 10x10", 10, 10, 16, 4, true}, {"ASTC 12x10", 12, 10, 16, 4, true},
    {"ASTC 12x12", 12, 12, 16, 4, true},
};
inline constexpr std::size_t kTexelFormatCount = std::size(kTexelFormats);
static_assert(kTexelFormatCount == static_cast<std::size_t>(TexelFormat::Astc12x12) + 1);

constexpr const TexelFormatInfo& infoOf(TexelFormat format) {
    return kTexelFormats[static_cast<std::size_t>(format)];
}
constexpr bool isBlockFormat(TexelFormat format) {
    return format != TexelFormat::Rgba8 && format != TexelFormat::Rgba16;
}
// Returns whether devices that have the format have 3D images of it: slices of blocks in the case of BC.
constexpr bool hasVolumes(TexelFormat format) {
    return format <= TexelFormat::Bc7;
}

// The size of a level in texels, of one axis.
constexpr std::uint32_t sizeAtLevel(std::uint32_t size, std::uint32_t level) {
    return level < 32 ? std::max(size >> level, 1U) : 1U;
}
// The blocks of a row of texels, the last of which may be cut.
constexpr std::uint32_t blocksAcross(std::uint32_t texels, std::uint32_t blockSize) {
    return texels / blockSize + (texels % blockSize == 0 ? 0U : 1U);
}
constexpr std::uint64_t bytesOfLevel(TexelFormat format, std::uint32_t width, std::uint32_t height,
                                     std::uint32_t level) {
    const TexelFormatInfo& info = infoOf(format);
    return std::uint64_t{blocksAcross(sizeAtLevel(width, level), info.blockWidth)} *
           blocksAcross(sizeAtLevel(height, level), info.blockHeight) * info.blockBytes;
}
// Returns the bytes of the levels [0, count) together.
constexpr std::uint64_t bytesOfLevels(TexelFormat format, std::uint32_t width, std::uint32_t height,
                                      std::uint32_t count) {
    std::uint64_t bytes = 0;
    for (std::uint32_t level = 0; level < count; ++level) {
        bytes += bytesOfLevel(format, width, height, level);
    }
    return bytes;
}

// A set of formats, each as it is and with colours in sRGB.
class TexelFormats {
public:
    constexpr void add(TexelFormat format, bool srgb) {
        bits_[srgb ? 1 : 0] |= bitOf(format);
    }
    constexpr bool has(TexelFormat format, bool srgb) const {
        return (bits_[srgb ? 1 : 0] & bitOf(format)) != 0;
    }

private:
    static constexpr std::uint32_t bitOf(TexelFormat format) {
        return std::uint32_t{1} << static_cast<std::uint32_t>(format);
    }
    std::array<std::uint32_t, 2> bits_{};
};
static_assert(kTexelFormatCount <= 32);

// The value that a shader reads as a channel of an image.
enum class TexelChannel : std::uint32_t { R, G, B, A, Zero, One };
using TexelChannels = std::array<TexelChannel, 4>;
inline constexpr TexelChannels kChannelsAsStored{TexelChannel::R, TexelChannel::G, TexelChannel::B,
                                                 TexelChannel::A};

// --- The scene ---

// A triangle list. Attribute spans are empty or as long as `positions`. A missing span must agree with the
// package's key for this primitive; upload reports an error otherwise.
struct PrimitiveView {
    // Differences to the attributes of a primitive. Each span is empty or as long as the primitive's
    // positions.
    struct MorphTarget {
        std::span<const std::array<float, 3>> positions;
        std::span<const std::array<float, 3>> normals;   // only if the primitive has normals
        std::span<const std::array<float, 3>> tangents;  // only if the primitive has tangents
    };

    // An attribute of vertices of an application's own, which materials of packs read.
    struct Attribute {
        std::string_view name;          // as in glTF: "_WEAR"
        std::uint32_t channels = 1;     // 1 to 4
        std::span<const float> values;  // `channels` for each position
    };

    std::uint32_t mesh = 0;       // mesh number, as in the package's PrimitiveEntry
    std::uint32_t primitive = 0;  // within the mesh
    std::span<const std::array<float, 3>> positions;
    std::span<const std::array<float, 3>> normals;
    std::span<const std::array<float, 4>> tangents;
    std::span<const std::array<float, 2>> texCoords0;
    std::span<const std::array<float, 2>> texCoords1;
    std::span<const std::array<float, 4>> colors;  // linear RGBA
    std::span<const std::uint32_t> indices;        // three indices for each triangle
    // Attributes that the package does not read (Package::attributes()) are ignored.
    std::span<const Attribute> attributes{};
    std::span<const MorphTarget> targets{};
    // Joints and weights of a primitive that follows a skin, vertex by vertex. Every vertex has the same
    // number of them. Joints are indices into InstanceView::joints. The weights of a vertex are at least 0
    // and sum to 1.
    std::span<const std::uint16_t> joints{};
    std::span<const float> jointWeights{};
};

// A mesh placed in the world.
struct InstanceView {
    std::uint32_t mesh = 0;
    std::array<float, 12> objectToWorld{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};  // three rows of four
    // One transform for each joint of a mesh that follows a skin, in three rows of four. It leads from the
    // mesh's space to the space that objectToWorld starts from. If empty, no skin changes the mesh's shape.
    std::span<const std::array<float, 12>> joints{};
    // One weight for each morph target of the mesh; missing ones are 0. If empty, no morph target changes the
    // mesh's shape.
    std::span<const float> morphWeights{};
    // A hidden instance is neither drawn nor hit. An instance that may be shown later needs SceneView::moves.
    bool visible = true;
};

// An image as it is stored, the first row on top. If the package reads an image as colour, its red, green and
// blue are taken to be in sRGB.
struct ImageView {
    using Format = TexelFormat;
    using Dimension = package::TextureEntry::Dimension;
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::span<const std::uint8_t> pixels;  // byteCount(levels) bytes: texels, or blocks row by row
    // A block format must be one that the device reads for each use of the image (Context::texelFormats()).
    Format format = Format::Rgba8;
    // The number of mip levels in `pixels`. They follow one another from the largest on; each has half the
    // size of the one before, rounded down. Upload makes the remaining levels of a full pyramid from the last
    // one. It makes none for block formats: a texture then has these levels alone.
    std::uint32_t levels = 1;
    // The channels that shaders read as red, green, blue and alpha.
    TexelChannels channels = kChannelsAsStored;
    // The first level in RGBA of 8 bits. Only images in a block format need it, and only if triangles that
    // are lights (--emissive-lights) have it as their emission.
    std::span<const std::uint8_t> decoded{};
    // As the package's textures with the image say (TextureEntry::dimension). Each level has its layers one
    // after the other: 1 of a 2D image; the faces +X, -X, +Y, -Y, +Z and -Z of a cube; the slices of a 3D
    // image, whose number halves from level to level. 3D images are in a format for which hasVolumes() is
    // true.
    Dimension dimension = Dimension::Flat;
    std::uint32_t layers = 1;

    std::uint32_t layersAt(std::uint32_t level) const {
        return dimension == Dimension::Volume ? sizeAtLevel(layers, level) : layers;
    }
    // Returns the number of levels of a full pyramid.
    std::uint32_t mostLevels() const {
        const std::uint32_t depth = dimension == Dimension::Volume ? layers : 1;
        return static_cast<std::uint32_t>(std::bit_width(std::max({width, height, depth})));
    }
    // Returns the size in bytes of one level, with all of its layers.
    std::uint64_t bytesAt(std::uint32_t level) const {
        return bytesOfLevel(format, width, height, level) * layersAt(level);
    }
    // Returns the size in bytes of the first `count` levels.
    std::uint64_t byteCount(std::uint32_t count) const {
        std::uint64_t bytes = 0;
        for (std::uint32_t level = 0; level < count; ++level) {
            bytes += bytesAt(level);
        }
        return bytes;
    }
};

struct LightView {
    // A disk shines on one side, equally in all directions (Lambert's law). Its intensity is that along its
    // normal: its radiance times its area.
    enum class Type : std::uint32_t { Directional, Point, Spot, Disk };
    Type type = Type::Directional;
    std::array<float, 3> intensity{1, 1, 1};  // colour times intensity, lux (directional) or candela
    std::array<float, 3> position{};          // of a disk, its centre
    // Unit vector along which the light travels; of a disk, its normal.
    std::array<float, 3> direction{0, -1, 0};
    float range = 0.0F;           // metres; 0 means unlimited
    float innerConeAngle = 0.0F;  // radians
    float outerConeAngle = 0.7853982F;
    // The size of the light, for soft shadows. It is the radius in metres of a point or spot light, which is
    // then a sphere, or of a disk. For a directional light it is half the angular diameter in radians, below
    // a quarter turn. 0 makes hard shadows.
    float size = 0.0F;
};

// Values of a material that replace the package's, as the bytes of a record in the package's layout
// (MaterialRecord of its C++ header). Texture transforms are taken from the record, but the textures and
// samplers stay those of the package.
struct MaterialView {
    std::uint32_t material = 0;  // material number, as in the package's PrimitiveEntry::materialIndex
    std::span<const std::uint8_t> record;
};

struct SceneView {
    // The order in which the driver gets the triangles of each primitive and the instances of the scene.
    // Mesa's lavapipe makes its trees by halving its input, so without an order rays may take a hundred times
    // as long. Shaders number triangles by their place in that order.
    enum class TraversalOrder : std::uint32_t {
        Auto,     // Halving on CPUs, Input on other devices
        Input,    // the scene's own order
        Halving,  // an order in which each half is small, and each half of a half
    };

    // The storage form of a scene's vertices on the device.
    enum class VertexForm : std::uint32_t {
        Compact,
        Full,
        Quantized,
    };

    // When the alpha tests of alphaMode MASK are decided.
    enum class OpacityUse : std::uint32_t {
        Proved,
        Tested,
    };

    std::span<const PrimitiveView> primitives;  // sorted by (mesh, primitive); all meshes of instances
    std::span<const InstanceView> instances;    // relative to `origin`, as `lights` are
    std::span<const ImageView> images;          // indexed by the package's TextureEntry::image
    std::span<const LightView> lights;
    std::uint32_t packageScene = 0;  // index of the scene in the package
    // True if GpuScene::update() will move the scene. The resources for it are only made if so, or if the
    // scene is edited.
    bool moves = false;
    // Materials whose values differ from the package's, by ascending number. If the scene moves,
    // GpuScene::update() may change these materials and no others.
    std::span<const MaterialView> materials{};
    TraversalOrder traversalOrder = TraversalOrder::Auto;
    // A vertex takes at most 36 bytes in the compact form, at most 30 in the quantized one and up to 72 in
    // the full one. docs/memory.md states the errors.
    VertexForm vertices = VertexForm::Compact;
    // Proved triangles are tested by no ray: opaque ones are in opaque geometry, transparent ones in none
    // (docs/alpha.md). In scenes that can be edited, rays test all triangles of instances that are not
    // sealed, because materials may change at any time.
    OpacityUse opacity = OpacityUse::Proved;
    // True if GpuScene::editor() will edit the scene. The Package must outlive it. With `moves` poses and
    // edits come side by side.
    bool editable = false;
    // True if the instances of an editable scene begin sealed, as by SceneEditor::seal(), with the alpha
    // tests that `opacity` decides. BLASes of single primitives are built when an instance needs them.
    bool sealed = false;
    // The number of textures and samplers that an editable scene may have at a time, those of the upload
    // included. The pipelines of its renderers are made for these numbers, so they can't grow. A texture
    // takes a descriptor in each version of the scene's descriptor set.
    std::uint32_t textureRoom = 1024;
    std::uint32_t samplerRoom = 64;
    // If true, the upload takes only the levels of at most `firstTexels` texels a side of images that have a
    // full pyramid, and GpuScene::textureStream() brings the others while frames are drawn. The texels of
    // `images` must then stay in memory until it has brought them or the scene is destroyed. This also holds
    // for images that SceneEditor gets.
    bool streamsTextures = false;
    std::uint32_t firstTexels = 64;
    // The place in the world, in metres, where the scene's own coordinates are 0. It should be close to the
    // visible things.
    std::array<double, 3> origin{};
};
inline constexpr Named<SceneView::TraversalOrder> kTraversalOrderNames[] = {
    {SceneView::TraversalOrder::Auto, "auto", "halving on a CPU, input on a GPU"},
    {SceneView::TraversalOrder::Input, "input", "that of the scene"},
    {SceneView::TraversalOrder::Halving, "halving", "for drivers that build trees by halving their input"},
};
constexpr std::span<const Named<SceneView::TraversalOrder>> namesOf(SceneView::TraversalOrder /*type*/) {
    return kTraversalOrderNames;
}
inline constexpr Named<SceneView::VertexForm> kVertexFormNames[] = {
    {SceneView::VertexForm::Compact, "compact",
     "16 bits for normals, tangents and UVs, and 8 or 16 for colours, where that is exact enough; for "
     "positions "
     "and indices, where that is exact"},
    {SceneView::VertexForm::Full, "full", "32 bits"},
    {SceneView::VertexForm::Quantized, "quantized", "as compact, with 16 bits for all positions"},
};
constexpr std::span<const Named<SceneView::VertexForm>> namesOf(SceneView::VertexForm /*type*/) {
    return kVertexFormNames;
}
inline constexpr Named<SceneView::OpacityUse> kOpacityUseNames[] = {
    {SceneView::OpacityUse::Proved, "proved", "at upload for triangles that are proved to have one answer"},
    {SceneView::OpacityUse::Tested, "tested", "by each ray"},
};
constexpr std::span<const Named<SceneView::OpacityUse>> namesOf(SceneView::OpacityUse /*type*/) {
    return kOpacityUseNames;
}

// A new pose of a scene. Instances, lights and materials have the same number and order as at upload. Each
// instance keeps its mesh and its number of joints and weights, each light its type, and each material its
// number.
struct MotionView {
    // The treatment of acceleration structures that no longer fit.
    enum class Builds : std::uint32_t {
        ByRule,   // refit or rebuild by the rules of GpuScene::update()
        Refit,    // refit and update, however slow rays become
        Rebuild,  // build anew
    };
    std::span<const InstanceView> instances;
    std::span<const LightView> lights;
    Builds builds = Builds::ByRule;
    std::span<const MaterialView> materials{};  // the materials of the upload, in their order
    // The origin of these instances and lights, as SceneView::origin. It may differ between poses. Instances
    // that keep their place in the world then get other transforms, so the TLAS is built anew.
    std::array<double, 3> origin{};
};
inline constexpr Named<MotionView::Builds> kBuildsNames[] = {
    {MotionView::Builds::ByRule, "auto", "they are refitted, and rebuilt by rule"},
    {MotionView::Builds::Refit, "always", "only refitted"},
    {MotionView::Builds::Rebuild, "never", "rebuilt in each frame"},
};
constexpr std::span<const Named<MotionView::Builds>> namesOf(MotionView::Builds /*type*/) {
    return kBuildsNames;
}

// A sky with a linear gradient: zenith above, ground below, horizon in between. Radiance is in the units of
// the lights.
struct SkyView {
    std::array<float, 3> zenith{0.25F, 0.45F, 0.85F};
    std::array<float, 3> horizon{0.75F, 0.80F, 0.85F};
    std::array<float, 3> ground{0.20F, 0.18F, 0.16F};
};

// The camera of a frame, in world space, right-handed. Its place is in the world's own coordinates, whichever
// origin the scene has.
struct CameraView {
    std::array<double, 3> position{};
    std::array<float, 3> forward{0, 0, -1};  // unit
    std::array<float, 3> up{0, 1, 0};        // unit, orthogonal to forward
    bool orthographic = false;
    float halfHeight = 0.4F;  // tan(yfov / 2), or half the height of the view in metres
    float halfWidth = 0.4F;   // the same for the width; halfWidth / halfHeight should be width / height
    float near = 0.01F;       // metres
    float far = 0.0F;         // metres; 0 means infinite (perspective only)
};

// The times that Renderer::timings() and RaySteps::timings() return.
enum class Timing : std::uint32_t {
    // "frame" is the time of the whole frame. "hits" is the time of a round of rays, from the finished list
    // of rays to the shaded hits.
    Frame,
    // Every pass has a time of its own. To measure it, a pass waits for the passes before it, so that passes
    // do not overlap. The sum is therefore longer than the frame takes otherwise.
    Passes,
};

}  // namespace glint
