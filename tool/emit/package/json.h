// JSON forms that the manifest shares with the output of commands.
#pragma once

#include "base/fields.h"
#include "gltf/import.h"
#include "plan/effects.h"
#include "plan/strategy_cost.h"
#include "spirv/statistics.h"

#include <glint/package_modules.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
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

}  // namespace glint::compiler
