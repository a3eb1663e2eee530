// The words of a package: how its rays are traced, ordered and shaded, and where its shaders find a host's
// bindings. They have names, for command lines and panels.
#pragma once

#include <glint/result.h>

#include <array>
#include <bit>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <span>
#include <string_view>
#include <type_traits>

namespace glint::package {

// --- Effects, the uses of rays in a picture ---
// Each is declared by a folder of shaders/effects or of a pack (docs/effects.md); a package says which it
// has.

// One bit of a set of effects. The compiler numbers the effects, and a package keeps the numbers. Effects of
// Glint's own have the same bit in every package. Package::effects() gives their names.
using Effect = std::uint32_t;

inline constexpr std::uint32_t kMostEffects = 32;
inline constexpr std::uint32_t kAllEffects = 0xFFFFFFFFU;

// An effect of a package.
struct EffectInfo {
    enum class Kind : std::uint32_t {
        Light = 0,    // decides how much of a light reaches a surface, primary or hit
        Surface = 1,  // decides how much of the sky's light reaches a primary surface
        Rays = 2,     // sends rays from primary surfaces whose hits the package shades
    };

    Effect effect = 0;
    Kind kind = Kind::Rays;
    std::uint32_t abilities = 0;  // EffectAbility bits
    std::string_view name{};      // on the command line, in the manifest and of passes
};

// --- How hits are shaded ---

// A bit of a set of strategies, by the strategy's place in the table. These are names for programs; a
// strategy works without one, as findStrategy() finds it by its name.
enum Strategy : std::uint32_t {
    kStrategyUber = 1,
    kStrategyVisibility = 2,
    kStrategySortedUber = 4,
    kStrategyHitShaders = 8,
};

inline constexpr Strategy kDefaultStrategy = kStrategyVisibility;                         // of a renderer
inline constexpr std::uint32_t kDefaultStrategies = kStrategyUber | kStrategyVisibility;  // of a package

std::span<const Strategy> strategies();
std::span<const Named<Strategy>> namesOf(Strategy type);

// --- What a package was compiled for ---

// The ways to trace rays, as bits of a set. Strategies with a pipeline of their own always use the ray
// tracing pipeline, whichever tracers the package has for the others.
enum Tracer : std::uint32_t {
    kTracerRayQuery = 1,
    kTracerRayPipeline = 2,  // ray generation shaders: for devices without ray queries
    kAllTracers = 3,
};

// The pass that traces the shadow rays of hits.
enum class ShadowPlacement : std::uint32_t {
    Inline = 0,    // the shader that shades the hit
    Deferred = 1,  // a pass of its own, which reads the rays from memory
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
    Frame = 0,  // a whole frame: the raster pass, first hits, effects, and the hits of their rays
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

    // The value of `tlas` without a descriptor: RaySteps::Batch::tlas has the structure's device address.
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

// Returns the Tracer bits that strategies use. Those with a pipeline of their own use the ray tracing
// pipeline; the others use the package's tracers.
std::uint32_t tracersOf(std::uint32_t strategies, std::uint32_t tracers);

// --- Rows of its tables ---

// A text: Package::string() returns it.
struct StringRef {
    std::uint32_t offset;  // into the Strings section
    std::uint32_t length;
};

// A set of the features of a material: those that every base model may have in two words, and those of a base
// model that a pack declares in words of the model.
struct KeyWords {
    // A set of the features that a base model of a pack has for itself.
    struct Own {
        static constexpr std::size_t kWords = 4;
        static constexpr int kBits = 32 * static_cast<int>(kWords);

        std::array<std::uint32_t, kWords> words{};

        static constexpr Own all() {
            return ~Own{};
        }
        constexpr void add(int bit) {
            words[static_cast<std::size_t>(bit) / 32] |= 1U << static_cast<unsigned>(bit % 32);
        }
        constexpr bool has(int bit) const {
            return (words[static_cast<std::size_t>(bit) / 32] >> static_cast<unsigned>(bit % 32) & 1U) != 0;
        }
        constexpr bool isEmpty() const {
            return *this == Own{};
        }
        constexpr int count() const {
            int sum = 0;
            for (const std::uint32_t word : words) {
                sum += std::popcount(word);
            }
            return sum;
        }
        constexpr Own operator~() const {
            Own result;
            for (std::size_t i = 0; i < kWords; ++i) {
                result.words[i] = ~words[i];
            }
            return result;
        }
        friend constexpr Own operator&(Own a, const Own& b) {
            for (std::size_t i = 0; i < kWords; ++i) {
                a.words[i] &= b.words[i];
            }
            return a;
        }
        friend constexpr Own operator|(const Own& a, const Own& b) {
            return ~(~a & ~b);
        }
        // The compiler generates a comparison with 0 here. NOLINTNEXTLINE(modernize-use-nullptr)
        auto operator<=>(const Own&) const = default;
    };

    static constexpr std::uint32_t kAnyModel = 0xFFFFFFFF;

    std::uint32_t lobes = 0;   // what light does at the surface
    std::uint32_t inputs = 0;  // where its values are read from
    // The model, as shaders/interop/models.h describes it; 0: one of glTF's. A set of the features of several
    // models has kAnyModel, and all bits of `own`.
    std::uint32_t model = 0;
    Own own{};  // the model's own features, which it numbers by itself

    bool operator==(const KeyWords&) const = default;
    // Adds the features of another set. A set without a model takes that of the other.
    constexpr KeyWords& operator|=(const KeyWords& other) {
        const bool isMixed = model != 0 && other.model != 0 && model != other.model;
        lobes |= other.lobes;
        inputs |= other.inputs;
        own = isMixed ? Own::all() : own | other.own;
        model = isMixed ? kAnyModel : model | other.model;
        return *this;
    }
    // Returns whether the set has one of `features`, which are of one model at most. Those of a model without
    // bits in `own` are the model itself.
    constexpr bool hasAny(const KeyWords& features) const {
        const bool isOfModel = features.model != 0 && (features.model == model || model == kAnyModel);
        return ((lobes & features.lobes) | (inputs & features.inputs)) != 0 ||
               (isOfModel && (features.own.isEmpty() || !(own & features.own).isEmpty()));
    }
};

// A shader ID. It is retired if a lock file keeps it and no material has it. A retired one has no keys, no
// primitives and no modules.
struct CaseEntry {
    KeyWords always;
    KeyWords sometimes;  // of the same model
    StringRef name;
    std::uint32_t keyCount;  // 0: retired

    // Returns whether the case's shaders compute all features of the key.
    constexpr bool fits(const KeyWords& key) const {
        const auto within = [](const auto& least, const auto& some, const auto& bits) {
            using Set = std::remove_cvref_t<decltype(bits)>;
            return (least & ~bits) == Set{} && (bits & ~(least | some)) == Set{};
        };
        return within(always.lobes, sometimes.lobes, key.lobes) &&
               within(always.inputs, sometimes.inputs, key.inputs) &&
               (always.model == key.model || always.model == KeyWords::kAnyModel) &&
               within(always.own, sometimes.own, key.own);
    }
};

// One primitive of one mesh. The entries of each scene are sorted by (mesh, primitive).
struct PrimitiveEntry {
    std::uint32_t mesh;
    std::uint32_t primitive;
    std::uint32_t shaderId;
    std::uint32_t materialIndex;
    KeyWords key;                 // with all lobes
    std::uint32_t geometryFlags;  // kGeometry* of shaders/interop/scene.h
    std::uint32_t alphaMode;      // 0 opaque, 1 mask, 2 blend, as in the file
};

// An image viewed in one colour space. A glTF image that is used both as colour and as data has two entries.
struct TextureEntry {
    // The coordinates that a lookup of a texture takes, and so the type of its image view.
    enum class Dimension : std::uint16_t {
        Flat,    // UVs: a 2D view
        Array,   // UVs and the number of a layer: a 2D array view
        Cube,    // a direction: a cube view
        Volume,  // a place in space: a 3D view
    };

    std::uint32_t image;  // index into the scene's images
    std::uint16_t srgb;   // 1: 8-bit sRGB format, 0: 8-bit linear format
    Dimension dimension;
};
inline constexpr Named<TextureEntry::Dimension> kTextureDimensionNames[] = {
    {TextureEntry::Dimension::Flat, "2d", "2D"},
    {TextureEntry::Dimension::Array, "2d-array", "2D with layers"},
    {TextureEntry::Dimension::Cube, "cube", "a cube"},
    {TextureEntry::Dimension::Volume, "3d", "3D"},
};
constexpr std::span<const Named<TextureEntry::Dimension>> namesOf(TextureEntry::Dimension /*type*/) {
    return kTextureDimensionNames;
}

// The filter and the wrapping of a texture.
struct SamplerEntry {
    std::uint32_t wrapU;  // 0 repeat, 1 clamp to edge, 2 mirrored repeat
    std::uint32_t wrapV;
    std::uint32_t magnification;  // 0 nearest, 1 linear
    std::uint32_t minification;
    std::uint32_t mip;
    std::uint32_t mipmapped;
};

// An attribute of vertices that shaders read beside those of glTF's core. Each vertex of a primitive has the
// values of all entries, one after the other, if the primitive's key has one of their features.
struct AttributeEntry {
    StringRef name;             // in glTF: "_WEAR"
    std::uint32_t channels;     // 1 to 4
    std::uint32_t hasFallback;  // 1: primitives may lack it
    float fallback[4];
    KeyWords feature;  // of the keys whose shaders read it: one
};

// A file of a package in memory. `glint compile --embed` makes such files, and Package::load() reads them.
struct EmbeddedFile {
    std::string_view name;                // file name in the package's folder: "tables.bin", "uber.spv"
    std::span<const std::uint8_t> bytes;  // any alignment; not owned
};

// --- Names ---

// On the command line and in the manifest.
inline constexpr Named<Tracer> kTracerNames[] = {
    {kTracerRayQuery, "ray-query", "compute shaders trace"},
    {kTracerRayPipeline, "ray-pipeline", "ray generation shaders trace, for devices without ray queries"},
};
inline constexpr Named<ShadowPlacement> kShadowNames[] = {
    {ShadowPlacement::Inline, "inline", "by the shader that shades the hit"},
    {ShadowPlacement::Deferred, "deferred", "from a list, by a pass of their own"},
};
inline constexpr Named<AlphaPolicy> kAlphaNames[] = {
    {AlphaPolicy::Opaque, "opaque", "ignored"},
    {AlphaPolicy::Tested, "tested", "each candidate hit is tested; BLEND is opaque"},
    {AlphaPolicy::Stochastic, "stochastic", "tested, and a ray stops at BLEND with the probability alpha"},
};
inline constexpr Named<ShadowThrough> kShadowThroughNames[] = {
    {ShadowThrough::Opaque, "opaque", "glass and BLEND block"},
    {ShadowThrough::Alpha, "alpha", "as --alpha says; glass blocks"},
    {ShadowThrough::Glass, "glass", "coloured light passes glass and BLEND"},
};
inline constexpr Named<HitRecordFormat> kHitRecordNames[] = {
    {HitRecordFormat::Full, "full", "20 bytes"},
    {HitRecordFormat::Packed, "packed", "12 bytes, with less precision"},
};
inline constexpr Named<SampleRecordFormat> kSampleRecordNames[] = {
    {SampleRecordFormat::Full, "full", "48 bytes"},
    {SampleRecordFormat::Packed, "packed",
     "24 bytes, with less precision, which hold the hit as well where that is possible"},
};
inline constexpr Named<ShadingPrecision> kPrecisionNames[] = {
    {ShadingPrecision::Single, "32", "everything in 32-bit float"},
    {ShadingPrecision::Half, "16",
     "parameters of materials, Fresnel and weights of lobes in 16-bit float; geometry, densities and light "
     "keep 32"},
};
inline constexpr Named<Ordering> kOrderingNames[] = {
    {Ordering::GlobalAtomics, "global-atomics", "one atomic for each hit"},
    {Ordering::WaveLoop, "wave-loop", "an atomic for each shader in a subgroup, found one after the other"},
    {Ordering::WaveAggregated, "wave-aggregated", "a loop over all shaders, for few shaders only"},
    {Ordering::WaveBallot, "wave-ballot", "an atomic for each shader in a subgroup, found by ballots"},
    {Ordering::LocalHistogram, "local-histogram", "counts in shared memory, an atomic for each shader"},
    {Ordering::TileSort, "tile-sort", "sorts thousands of hits in shared memory"},
};
static_assert(std::size(kOrderingNames) == static_cast<std::size_t>(Ordering::Count));

inline constexpr Named<Passes> kPassesNames[] = {
    {Passes::Frame, "frame", "a whole frame, for Renderer"},
    {Passes::Steps, "steps", "passes that trace, order and shade an engine's own rays, for RaySteps"},
};
inline constexpr Named<HitAnswer> kAnswerNames[] = {
    {HitAnswer::Radiance, "radiance", "the light that comes back along the ray"},
    {HitAnswer::Surface, "surface", "the surface that the ray hits, which the engine lights"},
};

constexpr std::span<const Named<Tracer>> namesOf(Tracer /*type*/) {
    return kTracerNames;
}
constexpr std::span<const Named<ShadowPlacement>> namesOf(ShadowPlacement /*type*/) {
    return kShadowNames;
}
constexpr std::span<const Named<AlphaPolicy>> namesOf(AlphaPolicy /*type*/) {
    return kAlphaNames;
}
constexpr std::span<const Named<ShadowThrough>> namesOf(ShadowThrough /*type*/) {
    return kShadowThroughNames;
}
constexpr std::span<const Named<HitRecordFormat>> namesOf(HitRecordFormat /*type*/) {
    return kHitRecordNames;
}
constexpr std::span<const Named<SampleRecordFormat>> namesOf(SampleRecordFormat /*type*/) {
    return kSampleRecordNames;
}
constexpr std::span<const Named<ShadingPrecision>> namesOf(ShadingPrecision /*type*/) {
    return kPrecisionNames;
}
constexpr std::span<const Named<Ordering>> namesOf(Ordering /*type*/) {
    return kOrderingNames;
}
constexpr std::span<const Named<Passes>> namesOf(Passes /*type*/) {
    return kPassesNames;
}
constexpr std::span<const Named<HitAnswer>> namesOf(HitAnswer /*type*/) {
    return kAnswerNames;
}

using glint::nameOf;

constexpr std::uint32_t bitsOf(ShadingPrecision precision) {
    return precision == ShadingPrecision::Single ? 32 : 16;
}

inline constexpr auto kTracers = valuesOf(kTracerNames);

}  // namespace glint::package
