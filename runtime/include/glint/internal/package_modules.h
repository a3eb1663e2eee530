// The strategies, and the list of the modules that a package has. The compiler fills the list, the loader
// checks it and the renderer draws from it.
#pragma once

#include <glint/internal/package_format.h>
#include <glint/result.h>

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glint::package {

// --- The strategies: how the hits of rays are shaded ---
// A strategy is one row of the table in runtime/src/modules/strategies.cpp and one folder with its GLSL,
// shaders/strategies/<strategy>/. The compiler, the loader, the renderer, the cost model and the tools act on
// the row's fields.

enum class ShaderKind : std::uint8_t {
    Vertex,
    Fragment,
    Compute,
    Tracing,  // compute with ray queries, or ray generation
    Shading,  // as Tracing if it traces the shadow rays of hits, and else as Compute
    RayGeneration,
    ClosestHit,
    AnyHit,
    Miss,
};

// The cases that a module has code for.
enum class CaseCode : std::uint8_t {
    None,
    Switch,  // for all, with a switch over them
    Own,     // for one: each case has a module of its own
};

// The elements over which the pass of a module is dispatched.
enum class Over : std::uint8_t {
    Nothing,      // it has no pass: a ray tracing pipeline of its strategy runs it
    Rays,         // every ray of the list
    OrderedHits,  // every slot of the ordered hits; buckets begin at multiples of a workgroup
    Misses,       // bucket 0: rays that hit nothing, and hits whose shader ID no case has
    Buckets,      // the bucket of its case
};

// A module of a strategy, which packages with rays have. The passes of a strategy write different samples,
// so they follow each other without a barrier.
struct StrategyModule {
    std::string_view name;    // stable; the name in the manifest
    std::string_view source;  // a file below shaders/, or a template (".mustache")
    ShaderKind kind{};
    Over over = Over::Nothing;
    std::string_view pass{};  // the name of its pass, for people; the name of the case follows for Buckets
    CaseCode cases = CaseCode::None;
    // The name of the module that packages with a fallback have beside it: the same source, with code for
    // every material and for no case. Modules with code for cases have one.
    std::string_view fallback{};
};

struct StrategyInfo {
    Strategy strategy{};
    std::string_view name;  // on the command line and in the manifest
    std::string_view what;  // a sentence without a full stop
    std::span<const StrategyModule> modules{};

    // These follow from the modules. A strategy that orders hits stores them and orders them by shader before
    // it shades them. The others shade a hit where they find it, so that they can read its positions from the
    // acceleration structure.
    bool ordersHits = false;
    bool dispatchesCases = false;  // one dispatch for each case, so that no shader holds all cases
    bool fillsWorkgroups = false;  // workgroups have hits of one case, so that the switch is uniform in each
    bool ownPipeline = false;      // a ray tracing pipeline of its own, whatever traces for the others
};

// The rows in their order. The others are measured against the first, which every device can run.
std::span<const StrategyInfo> strategyTable();

// Returns null for a name that no strategy has.
const StrategyInfo* findStrategy(std::string_view name);
// `strategy` must be the bit of a row.
const StrategyInfo& infoOf(Strategy strategy);

// Return sets of strategies as bits: all of them, and those whose row says so.
std::uint32_t allStrategies();
std::uint32_t strategiesThat(bool StrategyInfo::*says);
inline std::uint32_t orderedStrategies() {
    return strategiesThat(&StrategyInfo::ordersHits);
}
inline std::uint32_t pipelineStrategies() {
    return strategiesThat(&StrategyInfo::ownPipeline);
}

// --- The modules of a package ---

// The properties of a package that decide which modules it has.
struct PackageShape {
    std::uint32_t strategies = kDefaultStrategies;  // Strategy bits
    std::uint32_t tracers = kTracerRayQuery;        // Tracer bits
    ShadowPlacement shadows = ShadowPlacement::Inline;
    EffectSet effects{};
    bool alphaTested = false;
    std::uint32_t caseCount = 0;
    std::vector<std::uint32_t> retired{};  // ascending shader IDs below caseCount that have no modules
    bool deforms = false;                  // a scene has meshes that follow skins or morph targets
    Passes passes = Passes::Frame;
    std::uint32_t maxBounces = 1;
    bool fallback = false;              // it has shaders for every material beside those of its cases
    bool shadowsApart = false;          // candidates of shadow rays are not treated as those of other rays
    std::uint32_t firstShadowRays = 0;  // PackageHeader::firstShadowRays

    // Returns whether the shadow rays of first hits wait for a pass of their own.
    bool defersFirstShadows() const {
        return passes == Passes::Frame && effects.tracesAtSurfaces() && firstShadowRays > 0;
    }
};

// One module of a package. The fields are those of ModuleEntry.
struct ModuleKey {
    ModuleRole role{};
    std::uint32_t index = 0;
    std::uint32_t tracer = 0;

    friend bool operator==(const ModuleKey&, const ModuleKey&) = default;
    // NOLINTNEXTLINE(modernize-use-nullptr): a comparison against 0 that the compiler writes.
    friend auto operator<=>(const ModuleKey&, const ModuleKey&) = default;
};

enum class Repeated : std::uint8_t { Once, ByCase, ByOrdering, ByEffect, ByWalk };

// The packages that have a role.
enum class Purpose : std::uint8_t {
    Picture,       // packages that draw a frame
    Order,         // packages that order hits of rays or, as those that draw a frame do, first hits
    Hits,          // packages that shade hits: for a host, or with an effect that sends rays
    Shadows,       // those among them that defer shadow rays
    FirstShadows,  // packages that defer the shadow rays of first hits
    Visibility,    // packages that answer rays of a host's own
    Walks,         // packages with effects that follow their rays in a pass of their own
    Tracing,       // packages in which a ray tracing pipeline traces
    Paths,         // packages whose paths have several bounces
    Motion,        // packages with meshes that follow skins or morph targets
    Fallback,      // packages that shade such hits, with shaders for every material
    Draft,         // packages that draw a frame and may do so before all pipelines are made
};

struct RoleInfo {
    ModuleRole role{};
    std::uint32_t strategies = 0;  // Strategy bits; one bit if it is a role of a strategy
    std::string_view name;         // stable; the name in the manifest
    std::string_view source;       // a file below shaders/, or a template (".mustache")
    ShaderKind kind{};
    Purpose purpose = Purpose::Hits;
    Repeated repeated = Repeated::Once;

    // Roles of strategies, whose row declares these members, and roles of first hits have them.
    const StrategyModule* declared = nullptr;  // of a strategy
    Over over = Over::Nothing;  // of the fallback of Buckets: Misses; other fallbacks have no pass
    std::string_view pass{};    // the name of its pass, as in StrategyModule
    ModuleRole fallback{};      // the role of its fallback

    // Returns whether it shades first hits, with the features of primary surfaces.
    bool shadesFirst() const {
        return role == ModuleRole::FirstHit || role == ModuleRole::FirstFallback;
    }
    // Returns whether its code chooses among cases.
    bool hasSwitch() const {
        return declared != nullptr && declared->cases == CaseCode::Switch;
    }
};

// The members of Bindings by name.
struct NamedBinding {
    std::string_view name;
    std::uint32_t Bindings::*member;
};
inline constexpr NamedBinding kBindingNames[] = {
    {"scene-set", &Bindings::sceneSet},
    {"tlas", &Bindings::tlas},
    {"textures", &Bindings::textures},
    {"samplers", &Bindings::samplers},
    {"environment-set", &Bindings::environmentSet},
    {"environment", &Bindings::environment},
    {"push-offset", &Bindings::pushOffset},
};

// Returns every role, in the order of the list of modules: those that strategies share, then those of each
// strategy.
std::span<const RoleInfo> roles();
// Returns the roles that only this strategy has, in the order of its row.
std::span<const RoleInfo> rolesOf(Strategy strategy);
// Returns the roles whose passes shade first hits, which all strategies share, in the order of their passes.
std::span<const RoleInfo> firstRoles();

// Returns null for a number that is no role.
const RoleInfo* findRole(ModuleRole role);
// Returns "unknown" for a number that is no role.
std::string_view roleName(ModuleRole role);
// Returns ModuleRole::None for a name that no role has.
ModuleRole roleNamed(std::string_view name);

// Returns whether hits send rays further.
bool hasPaths(const PackageShape& shape);

// Returns every module of a package, in the order of role, index, tracer.
std::vector<ModuleKey> requiredModules(const PackageShape& shape);

// Returns the features that a module demands of a device beyond Vulkan 1.3, from the capabilities of its
// SPIR-V: names of features, and of subgroup operations (VK_SUBGROUP_FEATURE_…), each once and sorted.
// `words` is a module.
std::vector<std::string> featuresOf(std::span<const std::uint32_t> words);

}  // namespace glint::package
