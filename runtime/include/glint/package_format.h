// The binary table of a package, tables.bin. It is the only contract between compiler and runtime. All
// numbers are little endian.
//
//   PackageHeader, PackageSection[sectionCount], then the sections' elements at their offsets (8-byte
//   aligned).
//
// The runtime reads this file and the .spv files that it names. manifest.json has the same content for
// people and scripts.
#pragma once

#include <bit>
#include <cstdint>
#include <string_view>

namespace glint::package {

// --- Effects, the uses of rays in a picture ---
// Each is declared by a folder of shaders/effects or of a pack (docs/effects.md); a package says which it
// has.

// One bit of a set of effects. The compiler numbers the effects, and a package keeps the numbers. Effects of
// Glint's own have the same bit in every package. Package::effects() gives their names.
using Effect = std::uint32_t;

inline constexpr std::uint32_t kMostEffects = 32;
inline constexpr std::uint32_t kAllEffects = 0xFFFFFFFFU;

enum class EffectKind : std::uint32_t {
    Light = 0,    // decides how much of a light reaches a surface, primary or hit
    Surface = 1,  // decides how much of the sky's light reaches a primary surface
    Rays = 2,     // sends rays from primary surfaces whose hits the package shades
};

// The work that the renderer does for an effect beyond its kind, as bits of a set.
enum EffectAbility : std::uint32_t {
    kEffectStartsOnScreen = 1,  // its rays may find their end in the picture: it keeps positions of pixels
    kEffectWalks = 2,           // a pass of its own follows its rays before the list takes them
    kAllEffectAbilities = 3,
};

// An effect of a package.
struct EffectInfo {
    Effect effect = 0;
    EffectKind kind = EffectKind::Rays;
    std::uint32_t abilities = 0;  // EffectAbility bits
    std::string_view name{};      // on the command line, in the manifest and of passes
};

// The effects of a package as sets of bits, grouped by the renderer's work.
struct EffectSet {
    std::uint32_t all = 0;
    // The effects of each kind.
    std::uint32_t lights = 0;
    std::uint32_t surfaces = 0;
    std::uint32_t rays = 0;
    // The effects of each ability.
    std::uint32_t screenStarts = 0;
    std::uint32_t walks = 0;

    constexpr void add(const EffectInfo& info) {
        all |= info.effect;
        (info.kind == EffectKind::Light     ? lights
         : info.kind == EffectKind::Surface ? surfaces
                                            : rays) |= info.effect;
        screenStarts |= (info.abilities & kEffectStartsOnScreen) != 0 ? info.effect : 0U;
        walks |= (info.abilities & kEffectWalks) != 0 ? info.effect : 0U;
    }
    // Returns whether a pass other than those that shade hits traces rays.
    constexpr bool tracesAtSurfaces() const {
        return (lights | surfaces) != 0;
    }
    friend bool operator==(const EffectSet&, const EffectSet&) = default;
};

// Returns the number of an effect's bit.
constexpr std::uint32_t effectNumber(Effect effect) {
    return static_cast<std::uint32_t>(std::countr_zero(effect));
}

// effectSlot() is the index of an effect that sends rays among those of the package. effectSlots() is their
// number.
constexpr std::uint32_t effectSlot(const EffectSet& effects, Effect effect) {
    return static_cast<std::uint32_t>(std::popcount(effects.rays & (effect - 1U)));
}
constexpr std::uint32_t effectSlots(const EffectSet& effects) {
    return static_cast<std::uint32_t>(std::popcount(effects.rays));
}

// The number of effects that have counters: up to the last one of the package.
constexpr std::uint32_t countedEffects(const EffectSet& effects) {
    return static_cast<std::uint32_t>(std::bit_width(effects.all));
}

// Calls `visit` with the number of each effect of a set, ascending.
template <typename Visit>
constexpr void forEachEffect(std::uint32_t effects, const Visit& visit) {
    for (std::uint32_t rest = effects; rest != 0; rest &= rest - 1) {
        visit(effectNumber(rest));
    }
}

// --- The file ---

inline constexpr char kMagic[8] = {'G', 'L', 'I', 'N', 'T', 'P', 'K', 'G'};
inline constexpr std::uint32_t kVersion = 21;
inline constexpr const char* kTablesFile = "tables.bin";
inline constexpr const char* kManifestFile = "manifest.json";
inline constexpr const char* kHeaderFile = "glint_tables.h";

// The ways to trace rays, as bits of a set. Strategies with a pipeline of their own always use the ray
// tracing pipeline, whichever tracers the package has for the others.
enum Tracer : std::uint32_t {
    kTracerRayQuery = 1,
    kTracerRayPipeline = 2,  // ray generation shaders: for devices without ray queries
    kAllTracers = 3,
};

// The pass that traces the shadow rays of hits.
enum class ShadowPlacement : std::uint32_t {
    Inline = 0,    // by the shader that shades the hit
    Deferred = 1,  // by a pass of their own, from a list
};

// The treatment of a material's alpha by rays.
enum class AlphaPolicy : std::uint32_t {
    Opaque = 0,      // nothing: whatever they hit is opaque
    Tested = 1,      // alphaMode MASK is tested, and BLEND is opaque
    Stochastic = 2,  // as above, but a ray stops at BLEND with the probability alpha
};

// The ways in which the light of punctual lights passes through alpha and glass.
enum class ShadowThrough : std::uint32_t {
    Alpha = 0,   // as AlphaPolicy treats all rays; glass blocks it
    Opaque = 1,  // glass and alphaMode BLEND block it
    Glass = 2,   // a share of each colour
};

// The storage format of a hit between passes.
enum class HitRecordFormat : std::uint32_t {
    Full = 0,    // 20 bytes, gpu::HitRecord
    Packed = 1,  // 12 bytes, gpu::PackedHitRecord
};

// The storage format of effects' samples between passes.
enum class SampleRecordFormat : std::uint32_t {
    Full = 0,    // 48 bytes, gpu::SampleStart, SampleAim and SampleWeight
    Packed = 1,  // 24 bytes, gpu::SampleStart and gpu::uvec2
};

// The most bounces that a path may have. It stands for "unlimited": paths that carry little light end
// earlier.
inline constexpr std::uint32_t kMaxBounces = 64;

// The passes that a package has.
enum class Passes : std::uint32_t {
    Frame = 0,  // a whole frame: the raster pass, lighting, effects, and the hits of their rays
    Steps = 1,  // the passes that trace, order and shade a host's own rays (RaySteps)
};

// The answer that RaySteps returns for a host's ray.
enum class HitAnswer : std::uint32_t {
    Radiance = 0,  // the light that comes back along the ray
    Surface = 1,   // gpu::SurfaceRecord: the surface that it hit, for a host that lights it
};

// Where shaders find a host's bindings. Renderer accepts the defaults only.
struct Bindings {
    std::uint32_t sceneSet = 0;        // descriptor set of the next three
    std::uint32_t tlas = 0;            // accelerationStructureEXT
    std::uint32_t textures = 1;        // texture2D[]
    std::uint32_t samplers = 2;        // sampler[]
    std::uint32_t environmentSet = 1;  // descriptor set of the next
    std::uint32_t environment = 5;     // sampler2D, in packages that read an environment map
    std::uint32_t pushOffset = 0;      // of gpu::PushConstants in the range of push constants, bytes

    // The value of `tlas` without a descriptor: RayBatch::tlas has the structure's device address.
    static constexpr std::uint32_t kByAddress = 0xFFFFFFFF;

    friend bool operator==(const Bindings&, const Bindings&) = default;
};

// The precision of shading.
enum class ShadingPrecision : std::uint32_t {
    Single = 0,  // everything in 32-bit float
    Half = 1,    // 16-bit float where that is exact enough; the device needs shaderFloat16
};

// The methods of counting hits into buckets and copying them in the order of the buckets. Each method gives
// each hit one slot. Which one is fastest depends on the device and on the number of buckets.
enum class Ordering : std::uint32_t {
    GlobalAtomics = 0,  // one atomic for each hit
    WaveLoop = 1,       // an atomic for each distinct bucket in a subgroup, found one after the other
    WaveAggregated =
        2,  // a loop over all buckets, with an atomic for each that the subgroup has: few buckets only
    WaveBallot = 3,      // lanes of equal buckets by a ballot a bit; an atomic for each distinct bucket
    LocalHistogram = 4,  // counts in shared memory, then an atomic for each bucket that the workgroup has
    TileSort = 5,        // sorts thousands of hits in shared memory, then an atomic for each bucket they have
    Count = 6,
};

// The most lights that a surface chooses by a hierarchy.
inline constexpr std::uint32_t kMaxLightSamples = 64;

struct PackageHeader {
    char magic[8];
    std::uint32_t version;
    std::uint32_t sectionCount;
    std::uint64_t fileBytes;  // size of the whole file
    // The 64-bit XXH3 hash of every byte after this header. Its seed is the hash of this header with a
    // contentHash of 0.
    std::uint64_t contentHash;
    std::uint32_t strategies;  // Strategy bits
    AlphaPolicy alpha;
    std::uint32_t caseCount;
    std::uint32_t interopHash;  // low 32 bits of the hash of the interop headers the shaders were built with
    std::uint32_t tracers;      // Tracer bits
    ShadowPlacement shadows;
    HitRecordFormat hitRecord;
    std::uint32_t environmentMap;  // 1: the sky is an environment map, 0: a gradient
    std::uint32_t positionFetch;   // 1: shaders read positions of hit triangles from acceleration structures
    std::uint32_t deforms;         // 1: a scene has meshes that follow skins or morph targets
    ShadingPrecision precision;
    // A record of a material ends with its gpu::TextureRecords. Of its other fields the runtime knows names
    // and places only.
    std::uint32_t materialTextureOffset;  // bytes
    std::uint32_t materialTextureCount;
    Passes passes;
    HitAnswer answer;
    Bindings bindings;
    std::uint32_t maxBounces;  // of paths: 1 to kMaxBounces
    std::uint32_t
        lightSamples;        // lights that a surface chooses by the hierarchy; 0: it takes all, without one
    std::uint32_t fallback;  // 1: the package has shaders for every material beside those of its cases
    ShadowThrough shadowThrough;
    std::uint32_t textureLevels;  // 1: shaders record the finest level that they read of each texture
    std::uint32_t trustTextures;  // 1: shaders rely on the contents of the scenes' textures
    std::uint32_t skyLight;       // 1: surfaces sample the sky as a light
    std::uint32_t early;          // 1: shows an edit; its other modules are those before it
    SampleRecordFormat sampleRecord;
    std::uint32_t sizedLights;  // 1: rays of lobes find punctual lights that have a size, too
};

enum class SectionKind : std::uint32_t {
    Modules = 1,     // ModuleEntry
    Materials = 2,   // records in the layout of the package's shaders, scene by scene
    Primitives = 3,  // PrimitiveEntry, scene by scene
    Textures = 4,    // TextureEntry: the bindless images that materials refer to, scene by scene
    Samplers = 5,    // SamplerEntry, scene by scene
    Strings = 6,     // bytes, UTF-8
    Cases = 7,       // CaseEntry
    Scenes = 8,      // SceneEntry
    Attributes = 9,  // AttributeEntry: attributes of vertices that packs declare
    Effects = 10,    // EffectEntry, by ascending bits
    Emission = 11,   // one EmissionEntry, in packages with emissive lights
    Features = 12,   // FeatureEntry: every feature of materials that the compiler knew, by ascending bits
    Opacity = 13,    // one OpacityEntry, in packages that test alpha by Glint's own code
    Layers = 14,     // LayerEntry (glint/layers.h), by the index of their images, in packages with layers
    Fields = 15,     // FieldEntry: every field and every texture of a material's record, by ascending offsets
};

struct PackageSection {
    SectionKind kind;
    std::uint32_t elementBytes;
    std::uint64_t offset;  // from the start of the file
    std::uint64_t count;   // elements
};

struct StringRef {
    std::uint32_t offset;  // into the Strings section
    std::uint32_t length;
};

// The purpose of a SPIR-V module. The values are stable. Each strategy has roles of its own, which follow
// these (package_modules.h).
enum class ModuleRole : std::uint32_t {
    None = 0,
    GBufferVertex = 1,
    GBufferFragment = 2,
    Lighting = 3,
    EffectRays = 4,  // one entry for each effect that sends rays
    RayDispatch = 5,
    Trace = 6,
    BucketCount = 7,
    BucketOffset = 8,
    BucketCopy = 9,
    OrderCheck = 10,
    Compose = 11,
    ShadowDispatch = 12,
    ShadowTrace = 13,
    TraceClosestHit = 14,  // of ray tracing pipelines that only trace: other passes shade their hits
    TraceAnyHit = 15,      // alpha tests
    TraceMiss = 16,
    EffectWalk = 17,     // one entry for each effect that follows its rays
    PathRays = 18,       // puts the next rays of paths on the list, in packages with several bounces
    Deform = 19,         // applies skins and morph targets to vertices; used by GpuScene, not by Renderer
    LightingDraft = 20,  // stands in for Lighting until that is made
    LightingEdit = 21,   // shades surfaces with edited features, after Lighting
};

struct ModuleEntry {
    ModuleRole role;
    std::uint32_t index;   // of a case: shader ID; BucketCount and BucketCopy: Ordering; EffectRays and
                           // EffectWalk: effectNumber(); 0 otherwise
    std::uint32_t tracer;  // the Tracer that it traces with; 0: it traces no rays
    std::uint32_t pad;
    StringRef file;  // relative to the package's folder; several entries may name one file
    std::uint64_t bytes;
    std::uint64_t hash;  // XXH3, 64 bits
};

// A shader ID. It is retired if a lock file keeps it and no material has it. A retired one has no keys, no
// primitives and no modules.
struct CaseEntry {
    std::uint64_t always;
    std::uint64_t sometimes;
    StringRef name;
    std::uint32_t keyCount;  // 0: retired
    std::uint32_t pad;
};

// One of the scenes that share the package's cases. It names the scene's ranges in the sections that are
// stored scene by scene; these ranges follow each other without gaps. Indices in their elements count from
// the scene's own first element.
struct SceneEntry {
    StringRef name;  // unique in the package: the scene file's name without folder and extension
    std::uint32_t firstMaterial;
    std::uint32_t materialCount;
    std::uint32_t firstPrimitive;
    std::uint32_t primitiveCount;
    std::uint32_t firstTexture;
    std::uint32_t textureCount;
    std::uint32_t firstSampler;
    std::uint32_t samplerCount;
};

// One primitive of one mesh. The entries of each scene are sorted by (mesh, primitive).
struct PrimitiveEntry {
    std::uint32_t mesh;
    std::uint32_t primitive;
    std::uint32_t shaderId;
    std::uint32_t materialIndex;
    std::uint32_t featureLobes;
    std::uint32_t featureInputs;
    std::uint32_t geometryFlags;  // kGeometry* of shaders/interop/scene.h
    std::uint32_t alphaMode;      // 0 opaque, 1 mask, 2 blend, as in the file
};

// An image viewed in one colour space. A glTF image that is used both as colour and as data has two entries.
struct TextureEntry {
    std::uint32_t image;  // index into the scene's images
    std::uint32_t srgb;   // 1: 8-bit sRGB format, 0: 8-bit linear format
};

// An attribute of vertices that shaders read beside those of glTF's core. Each vertex of a primitive has the
// values of all entries, one after the other, if the primitive's key has one of their features.
struct AttributeEntry {
    StringRef name;             // in glTF: "_WEAR"
    std::uint32_t channels;     // 1 to 4
    std::uint32_t hasFallback;  // 1: primitives may lack it
    float fallback[4];
    std::uint64_t feature;  // the bit of keys whose shaders read it
};

// An effect that the package has.
struct EffectEntry {
    StringRef name;
    Effect effect;  // one bit
    EffectKind kind;
    std::uint32_t abilities;  // EffectAbility bits
    std::uint32_t pad;
};

// The facts about a material's record by which the runtime bounds the light that its triangles emit.
struct EmissionEntry {
    static constexpr std::uint32_t kNone = 0xFFFFFFFF;

    std::uint32_t factor;    // offset of three floats; kNone: they are 0
    std::uint32_t strength;  // offset of a float; kNone: it is 1
    std::uint32_t texture;   // slot of the texture; kNone if no record has one
    // Bits of PrimitiveEntry::featureInputs: the key reads the texture; it reads UV set 0 or 1.
    std::uint32_t textureInput;
    std::uint32_t texCoord0Input;
    std::uint32_t texCoord1Input;
    // Features, inputs in the high half and lobes in the low one. Shaders that compute the emission of a
    // triangle use the features of `read` only. They take those of `always` for granted, and decide about
    // those of `sometimes` by the key.
    std::uint64_t read;
    std::uint64_t always;
    std::uint64_t sometimes;
};

// The facts about a material's record by which the runtime proves where its alpha test lets rays through.
struct OpacityEntry {
    static constexpr std::uint32_t kNone = 0xFFFFFFFF;

    std::uint32_t factor;   // offset of the float that scales alpha
    std::uint32_t cutoff;   // offset of a float
    std::uint32_t texture;  // slot of the texture whose alpha counts; kNone if no record has one
    // Bits of PrimitiveEntry::featureInputs: the key reads the texture; it reads UV set 0 or 1; it transforms
    // UVs; it reads the vertices' alpha.
    std::uint32_t textureInput;
    std::uint32_t texCoord0Input;
    std::uint32_t texCoord1Input;
    std::uint32_t transformInput;
    std::uint32_t vertexColorInput;
    // Features whose code changes UVs or opacity. The alpha of a key that has one is unknown.
    std::uint64_t code;
};

// The name of a feature of materials, for messages about keys.
struct FeatureEntry {
    std::uint64_t mask;  // one bit of keys
    StringRef name;      // in the manifest: "baseColorTexture"
};

// A field of the records of materials, or one of their textures, by which values find their place in the
// records of another package.
struct FieldEntry {
    StringRef name;        // of the parameter or the texture: "clearcoatFactor"
    std::uint32_t offset;  // in a record, bytes
    std::uint32_t bytes;
};

struct SamplerEntry {
    std::uint32_t wrapU;  // 0 repeat, 1 clamp to edge, 2 mirrored repeat
    std::uint32_t wrapV;
    std::uint32_t magnification;  // 0 nearest, 1 linear
    std::uint32_t minification;
    std::uint32_t mip;
    std::uint32_t mipmapped;
};

static_assert(sizeof(PackageHeader) == 160);
static_assert(sizeof(PackageSection) == 24);
static_assert(sizeof(ModuleEntry) == 40);
static_assert(sizeof(CaseEntry) == 32);
static_assert(sizeof(SceneEntry) == 40);
static_assert(sizeof(PrimitiveEntry) == 32);
static_assert(sizeof(TextureEntry) == 8);
static_assert(sizeof(SamplerEntry) == 24);
static_assert(sizeof(AttributeEntry) == 40);
static_assert(sizeof(EffectEntry) == 24);
static_assert(sizeof(EmissionEntry) == 48);
static_assert(sizeof(FeatureEntry) == 16);
static_assert(sizeof(FieldEntry) == 16);
static_assert(sizeof(OpacityEntry) == 40);

}  // namespace glint::package
