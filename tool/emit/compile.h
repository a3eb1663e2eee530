// Compiles scenes to a package: plan, GLSL, SPIR-V, tables. Only writePackage() writes files.
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

// How the level of a texture that hits read is chosen.
enum class TextureLod : std::uint8_t {
    Cones,  // by the width of a ray cone
    Mip0    // always the finest level
};

struct CompileSettings {
    std::uint32_t strategies = package::kStrategyUber | package::kStrategyVisibility;
    std::uint32_t tracers = package::kTracerRayQuery;
    package::ShadowPlacement shadows = package::ShadowPlacement::Inline;
    package::HitRecordFormat hitRecord = package::HitRecordFormat::Full;
    bool environmentMap = false;  // Rays that leave the scene read an environment map instead of a gradient.
    // With this, the strategies uber with ray queries and hit-shaders read the positions of hit triangles
    // from the acceleration structure instead of the vertex buffer.
    bool positionFetch = false;
    PlanOptions plan;
    EffectRequest effects{false, package::kEffectShadow | package::kEffectReflection};
    // The renderer adds a light to those of the scenes, which --effects auto takes into account.
    bool addsLight = false;
    bool energyCompensation = true;  // Compensates light that bounces between microfacets more than once.
    TextureLod textureLod = TextureLod::Cones;
    package::ShadingPrecision precision = package::ShadingPrecision::Single;
    int jobs = 0;            // threads; 0 means one for each core
    bool emitHeader = true;  // glint_tables.h
    bool emitGlsl = false;   // writes the flattened sources, in glsl/
    bool debugInfo = false;  // keeps names in the SPIR-V
    // How `strategies` was chosen, for the manifest. Empty if the user named the strategies.
    std::optional<StrategyAdvice> strategyChoice{};
    // The folder in which `glint compile-module` left the modules. If it is empty, modules are compiled here.
    std::filesystem::path modules{};
};

std::string_view toString(TextureLod lod);
// Returns the names of the strategies, or tracers, in a set of bits.
std::vector<std::string> strategyNames(std::uint32_t strategies);
std::vector<std::string> tracerNames(std::uint32_t tracers);

// One SPIR-V module of the package. Modules with equal bytes share `file`.
struct CompiledModule {
    package::ModuleKey key;
    std::string name;  // "uber.comp", "shade_2_BaseTex.comp"; the GLSL file has the same name
    std::string file;  // name within the package: "uber.spv"
    std::vector<std::uint32_t> spirv;
    std::string glsl;  // flattened
    SpirvStatistics statistics;
    std::uint64_t hash = 0;
    bool compiled = true;  // in this run; false if it was cached or has the text of another module
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
    std::uint64_t spirvBytes = 0;  // sum over the distinct modules
};

// A text to compile. Several modules of a package may have the same text.
struct PlannedModule {
    std::string file;  // without a suffix; no other text of the package has this name
    std::string name;  // name of the first module that has the text, for people
    std::string text;  // as made by makeModuleText()
};

// What a package will consist of, known before anything is compiled.
struct PackagePlan {
    Plan plan;
    std::vector<PlannedModule> modules;
};
// Plans a package. Has the errors of compilePackage(), except those of compiling.
Result<PackagePlan> planPackage(std::span<const Scene> scenes, const CompileSettings& settings);

// Compiles one package for `scenes` (at least one): they share the cases, and each has its own tables.
// Modules that `cache` has are not compiled; others are compiled and added to it. `cache` may be null.
// Errors: too many cases ("max-shaders"); GLSL or SPIR-V that does not compile or validate, with file and
// line (a defect of Glint itself); with settings.modules, also those of takeModules().
Result<CompiledPackage> compilePackage(std::span<const Scene> scenes, const CompileSettings& settings,
                                       ModuleCache* cache = nullptr);
inline Result<CompiledPackage> compilePackage(const Scene& scene, const CompileSettings& settings,
                                              ModuleCache* cache = nullptr) {
    return compilePackage(std::span(&scene, 1), settings, cache);
}

// Replaces the contents of `folder` by the package. Files that did not change keep their time stamps, and
// files of the earlier package that are no longer part of it are removed. tables.bin is written last, so that
// a reader never sees a mixture that passes its checks. A failure leaves the earlier package whole. It is an
// error if the folder holds something other than a package.
Status writePackage(const CompiledPackage& package, const std::filesystem::path& folder);

}  // namespace glint
