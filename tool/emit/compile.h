// From a Scene to a package: plan, GLSL, SPIR-V, tables. No file is written here but by writePackage().
#pragma once

#include "base/files.h"
#include "gltf/scene.h"
#include "plan/effects.h"
#include "plan/plan.h"
#include "plan/strategy_choice.h"
#include "spirv/statistics.h"

#include <glint/package_modules.h>
#include <glint/result.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glint {

class ModuleCache;

// Which level of a texture hits read.
enum class TextureLod : std::uint8_t {
    Cones,  // by the width of a ray cone
    Mip0    // the finest
};

struct CompileSettings {
    std::uint32_t strategies = package::kStrategyUber | package::kStrategyVisibility;
    std::uint32_t tracers = package::kTracerRayQuery;
    package::ShadowPlacement shadows = package::ShadowPlacement::Inline;
    package::HitRecordFormat hitRecord = package::HitRecordFormat::Full;
    bool environmentMap = false;  // rays that leave the scene read an environment map instead of a gradient
    // The strategies uber with ray queries and hit-shaders read positions of hit triangles from the
    // acceleration structure instead of the vertex buffer.
    bool positionFetch = false;
    PlanOptions plan;
    EffectRequest effects{false, package::kEffectShadow | package::kEffectReflection};
    // The renderer adds a light to the scenes' own: counts for --effects auto.
    bool addsLight = false;
    bool energyCompensation = true;  // of light that bounces between microfacets more than once
    TextureLod textureLod = TextureLod::Cones;
    package::ShadingPrecision precision = package::ShadingPrecision::Single;
    int jobs = 0;            // threads; 0: one a core
    bool emitHeader = true;  // glint_tables.h
    bool emitGlsl = false;   // the flattened sources, in glsl/
    bool debugInfo = false;  // keep names in the SPIR-V
    // How `strategies` came about, for the manifest; absent: they were named.
    std::optional<StrategyAdvice> strategyChoice{};
    // Where `glint compile-module` left the modules; empty: they are compiled.
    std::filesystem::path modules{};
};

std::string_view toString(TextureLod lod);
// Of a set of bits.
std::vector<std::string> strategyNames(std::uint32_t strategies);
std::vector<std::string> tracerNames(std::uint32_t tracers);

// One SPIR-V module of the package. Modules with equal bytes share `file`.
struct CompiledModule {
    package::ModuleKey key;
    std::string name;  // "uber.comp", "shade_2_BaseTex.comp": also the name of the GLSL file
    std::string file;  // "uber.spv": within the package
    std::vector<std::uint32_t> spirv;
    std::string glsl;  // flattened
    SpirvStatistics statistics;
    std::uint64_t hash = 0;
    bool compiled = true;  // now; else it was cached, or has the text of another module
};

struct PackageFile {
    std::string name;  // relative, '/' between folders
    Bytes bytes;
};

struct CompiledPackage {
    Plan plan;
    std::vector<CompiledModule> modules;  // in order of their keys
    std::vector<PackageFile> files;       // everything that writePackage() writes, sorted by name
    int uniqueSpirv = 0;
    std::uint64_t spirvBytes = 0;  // of the unique modules
};

// A text to compile, which several modules of a package may have.
struct PlannedModule {
    std::string file;  // without a suffix: a name that no other text of the package has
    std::string name;  // of the first module that has it, for people
    std::string text;  // see makeModuleText()
};

// What a package will be of, before anything is compiled.
struct PackagePlan {
    Plan plan;
    std::vector<PlannedModule> modules;
};
// Errors as compilePackage(), but for those of compiling.
Result<PackagePlan> planPackage(std::span<const Scene> scenes, const CompileSettings& settings);

// `scenes`: at least one; they share the cases, and each has its own tables. Errors: too many cases
// ("max-shaders"); GLSL or SPIR-V that does not compile or validate, with file and line (a defect of Glint
// itself); those of takeModules() with settings.modules. Modules that `cache` has are not compiled, others
// are added to it; null: there is none.
Result<CompiledPackage> compilePackage(std::span<const Scene> scenes, const CompileSettings& settings,
                                       ModuleCache* cache = nullptr);
inline Result<CompiledPackage> compilePackage(const Scene& scene, const CompileSettings& settings,
                                              ModuleCache* cache = nullptr) {
    return compilePackage(std::span(&scene, 1), settings, cache);
}

// Replaces the contents of `folder` by the package: files that did not change keep their time stamps, files
// of the earlier package that are no longer part of it go, tables.bin goes last so that a reader never sees a
// mixture that passes its checks. A failure leaves the earlier package whole. Refuses a folder that holds
// something else.
Status writePackage(const CompiledPackage& package, const std::filesystem::path& folder);

}  // namespace glint
