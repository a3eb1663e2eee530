// The binary table of a package, tables.bin. It is the only contract between compiler and runtime. All
// numbers are little endian.
//
//   PackageHeader, PackageSection[sectionCount], then the sections' elements at their offsets (8-byte
//   aligned).
//
// The runtime reads this file and the .spv files that it names. manifest.json has the same content for
// people and scripts.
#pragma once

#include <glint/package_shape.h>

#include <bit>
#include <cstdint>

namespace glint::package {

// --- Sets of effects ---

// The work that the renderer does for an effect beyond its kind, as bits of a set.
enum EffectAbility : std::uint32_t {
    kEffectStartsOnScreen = 1,  // its rays may find their end in the picture: it keeps positions of pixels
    kEffectWalks = 2,           // a pass of its own follows its rays before the list takes them
    kAllEffectAbilities = 3,
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
        (info.kind == EffectInfo::Kind::Light     ? lights
         : info.kind == EffectInfo::Kind::Surface ? surfaces
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
inline constexpr std::uint32_t kVersion = 27;
inline constexpr const char* kTablesFile = "tables.bin";
inline constexpr const char* kManifestFile = "manifest.json";
inline constexpr const char* kHeaderFile = "glint_tables.h";

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
    std::uint32_t textureLevels;    // 1: shaders record the finest level that they read of each texture
    std::uint32_t trustTextures;    // 1: shaders rely on the contents of the scenes' textures
    std::uint32_t skyLight;         // 1: surfaces sample the sky as a light
    std::uint32_t firstShadowRays;  // of a round, which wait for a pass of their own; 0: traced inline
    SampleRecordFormat sampleRecord;
    std::uint32_t sizedLights;  // 1: rays of lobes find punctual lights that have a size, too
    std::uint32_t diskLights;   // 1: shaders know disks among the lights
    std::uint32_t pad;
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
    Layers = 14,  // LayerInfo::Entry (glint/layers.h), by the index of their images, in packages with layers
    Fields = 15,  // FieldEntry: the fields and textures of records, by model and ascending offsets
};

struct PackageSection {
    SectionKind kind;
    std::uint32_t elementBytes;
    std::uint64_t offset;  // from the start of the file
    std::uint64_t count;   // elements
};

// The purpose of a SPIR-V module. The values are stable. Each strategy has roles of its own, which follow
// these (package_modules.h).
enum class ModuleRole : std::uint32_t {
    None = 0,
    GBufferVertex = 1,
    GBufferFragment = 2,
    FirstHit = 3,    // one entry for each case: shades the pixels that see it
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
    FirstDraft = 20,     // shades all pixels until the other modules are made
    FirstCount = 21,     // finds the bucket of each pixel
    FirstCopy = 22,      // orders pixels by bucket
    FirstMiss = 23,      // shades pixels without a surface
    FirstFallback = 24,  // shades pixels whose shader ID no case has
    FirstShadows = 25,   // traces the shadow rays of first hits that are not traced inline
    RayVisibility = 26,  // answers a host's rays that only ask for visibility
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

// An effect that the package has.
struct EffectEntry {
    StringRef name;
    Effect effect;  // one bit
    EffectInfo::Kind kind;
    std::uint32_t abilities;  // EffectAbility bits
    std::uint32_t pad;
};

// The facts about a material's record by which the runtime bounds the light that its triangles emit.
struct EmissionEntry {
    static constexpr std::uint32_t kNone = 0xFFFFFFFF;

    std::uint32_t factor;    // offset of three floats; kNone: they are 0
    std::uint32_t strength;  // offset of a float; kNone: it is 1
    std::uint32_t texture;   // slot of the texture; kNone if no record has one
    // Bits of KeyWords::inputs: the key reads the texture; it reads UV set 0 or 1.
    std::uint32_t textureInput;
    std::uint32_t texCoord0Input;
    std::uint32_t texCoord1Input;
    // Shaders that compute the emission of a triangle use the features of `read` only; its model is 0 if they
    // use none of a model's own. They take those of `always` for granted, and decide about those of
    // `sometimes` by the key.
    KeyWords read;
    KeyWords always;
    KeyWords sometimes;
};

// The facts about a material's record by which the runtime proves where its alpha test lets rays through.
struct OpacityEntry {
    static constexpr std::uint32_t kNone = 0xFFFFFFFF;

    std::uint32_t factor;   // offset of the float that scales alpha
    std::uint32_t cutoff;   // offset of a float
    std::uint32_t texture;  // slot of the texture whose alpha counts; kNone if no record has one
    // Bits of KeyWords::inputs: the key reads the texture; it reads UV set 0 or 1; it transforms
    // UVs; it reads the vertices' alpha.
    std::uint32_t textureInput;
    std::uint32_t texCoord0Input;
    std::uint32_t texCoord1Input;
    std::uint32_t transformInput;
    std::uint32_t vertexColorInput;
    // Features whose code changes UVs or opacity. The alpha of a key that has one is unknown, as is that of a
    // model with kModelChangesAlpha or without kModelBaseColor.
    KeyWords code;
};

// The uses that Glint itself has for a parameter, a texture or a feature of materials. Declarations name them
// by the words of kRoleNames in tool/materials.
enum class Role : std::uint32_t {
    None,
    // Parameters and textures.
    BaseColor,
    AlphaCutoff,
    Emission,
    EmissionStrength,
    TangentFrame,
    // Features.
    AlphaTest,
    Emits,
    Normals,
    Tangents,
    TexCoord0,
    TexCoord1,
    TextureTransform,
    TurnedFrames,
    VertexColor,
    DoubleSided,
    Count
};
inline constexpr Role kFirstFeatureRole = Role::AlphaTest;

// The name of a feature of materials, for messages about keys, and its role.
struct FeatureEntry {
    KeyWords feature;  // one bit, or a model alone
    StringRef name;    // in the manifest: "baseColorTexture"
    Role role;         // None, or a role of features, which no other feature has
};

// A field of the records of a model's materials, or one of their textures, by which values find their place
// in the records of another package.
struct FieldEntry {
    StringRef name;        // of the parameter or the texture: "clearcoatFactor"
    std::uint32_t offset;  // in a record, bytes
    std::uint32_t bytes;
    // The model whose records have it, as in keys; 0: glTF's bases. Several models have it by an entry each.
    // Fields of different models share their places.
    std::uint32_t model;
    // A hash of the type and of an enum's names: other values have another meaning. Of a texture: its
    // TextureDimension.
    std::uint32_t type;
};

static_assert(sizeof(PackageHeader) == 168);
static_assert(sizeof(PackageSection) == 24);
static_assert(sizeof(ModuleEntry) == 40);
static_assert(sizeof(CaseEntry) == 68);
static_assert(sizeof(SceneEntry) == 40);
static_assert(sizeof(PrimitiveEntry) == 52);
static_assert(sizeof(TextureEntry) == 8);
static_assert(sizeof(SamplerEntry) == 24);
static_assert(sizeof(AttributeEntry) == 60);
static_assert(sizeof(EffectEntry) == 24);
static_assert(sizeof(EmissionEntry) == 108);
static_assert(sizeof(FeatureEntry) == 40);
static_assert(sizeof(FieldEntry) == 24);
static_assert(sizeof(OpacityEntry) == 60);

}  // namespace glint::package
