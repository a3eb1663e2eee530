// manifest.json describes the contents of a package for people and scripts (docs/package.md).
#pragma once

#include "base/fields.h"
#include "base/fields_fwd.h"
#include "emit/package/compiled_package.h"
#include "gltf/import.h"
#include "gltf/scene_list.h"
#include "plan/effects.h"
#include "plan/strategy_cost.h"
#include "settings/settings.h"
#include "spirv/statistics.h"

#include <glint/internal/package_modules.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace glint::gltf {

base::Fields fieldsOf(const SceneInFile*);

}  // namespace glint::gltf

namespace glint::compiler {

// Returns nothing if the file has no scenes.
std::optional<gltf::SceneInFile> orNone(const gltf::SceneInFile& scene);

base::Fields fieldsOf(const StrategyAdvice*);
base::Fields fieldsOf(const EffectDecision*);
// bytes, instructions, textureFetches, rayQueries, branches
base::Fields fieldsOf(const SpirvStatistics*);

// Returns the names of all strategies.
std::vector<std::string_view> strategyWords();

// Returns 2^n for n bits, as a whole number if every JSON reader takes it exactly.
std::variant<std::uint64_t, double> wholeNumber(double count);

// Rounds a share of hits to four decimals, which is more than its accuracy.
double roundedShare(double share);

// Names one of a case's modules by its purpose.
std::string stageName(const package::ModuleKey& key);

// A material by its scene and its number there.
struct ManifestPlace {
    std::uint32_t scene = 0;
    std::uint32_t index = 0;
};

struct ManifestMaterial {
    ManifestPlace place;
    std::string name;  // may be empty
};

struct ManifestFile {
    std::string file;
    std::uint64_t bytes = 0;
    std::string hash;
};

struct ManifestScene {
    std::string name;
    std::string source;
    std::string variant;  // empty: none
    std::size_t materials = 0;
    std::size_t primitives = 0;
    std::vector<ManifestFile> sources;
};

struct ManifestFeature {
    std::string name;
    int bit = 0;
    bool lobe = false;
    std::string macro;
    std::string gltf;
    std::string neutral;
};

struct ManifestAttribute {
    std::string name;
    std::string gltf;
    std::string feature;
    int channels = 1;
    std::optional<std::vector<float>> fallback;
};

struct ManifestModule {
    std::string name;
    std::string file;
    SpirvStatistics statistics;
    std::vector<std::string> features;  // demands of the device
    std::string hash;
};

struct ManifestPass {
    std::string role;
    ManifestModule module;
};

struct ManifestCase {
    std::uint32_t id = 0;
    std::string name;
    std::vector<std::string> always;
    std::vector<std::string> sometimes;
    std::size_t keys = 0;
    double share = 0.0;
    std::string reason;
    std::vector<ManifestMaterial> materials;
    std::vector<std::pair<std::string, ManifestModule>> stages;
};

struct ManifestKey {
    std::vector<std::string> features;
    std::string mask;
    std::size_t primitives = 0;
    std::vector<ManifestPlace> materials;
    double share = 0.0;
    std::uint32_t shaderId = 0;
};

struct ManifestDrop {
    std::string feature;
    std::vector<ManifestPlace> materials;
    std::string reason;
};

struct ManifestCounts {
    std::size_t materials = 0;
    double keysPossible = 0.0;
    std::size_t keysPresent = 0;
    std::size_t cases = 0;
    std::size_t modules = 0;
    std::size_t uniqueSpirv = 0;
    std::uint64_t spirvBytes = 0;
};

// The contents of a manifest. What describes a package in more detail than readers need is not read.
struct Manifest {
    std::string toolVersion;
    std::vector<ManifestScene> scenes;
    std::vector<std::string> strategies;
    std::optional<StrategyAdvice> strategyChoice;
    std::vector<std::string> tracers;
    std::string merge;
    std::optional<int> maxShaders;
    std::string alpha;
    std::vector<std::string> host;   // files that --host replaced
    std::vector<std::string> packs;  // names of the declarations of packs
    std::vector<std::string> hitLobes;
    std::vector<std::pair<std::string, std::string>> settings;  // as on the command line
    ManifestCounts counts;
    std::size_t buckets = 0;
    EffectPlan effects;
    std::vector<ManifestFeature> features;
    std::vector<ManifestAttribute> vertexAttributes;
    std::vector<ManifestCase> shaders;
    std::vector<ManifestPass> passes;
    std::vector<ManifestKey> keys;
    std::vector<ManifestDrop> dropped;
    std::vector<ManifestFile> files;

    // Returns an empty text if there is no such setting.
    std::string_view setting(std::string_view name) const;
};
base::Fields fieldsOf(const Manifest*);

// Has the errors of readFile(), and "manifest-format" if the file lacks a member.
Result<Manifest> readManifest(const std::filesystem::path& folder);

inline constexpr std::string_view kManifestFormat = "glint-package";

// Returns the text of the manifest. `package` must be complete except for the manifest itself.
std::string makeManifest(const gltf::SceneList& scenes, const CompiledPackage& package,
                         const CompileSettings& settings);

// Returns the names of the files that a manifest lists, itself included. Names that lead out of the folder
// are left out. Empty if `text` is not the manifest of a package.
std::set<std::string, std::less<>> manifestFiles(std::string_view text);

}  // namespace glint::compiler
