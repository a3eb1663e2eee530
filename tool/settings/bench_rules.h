// Rules for when settings matter. They are the members `idle`, `against` and `triedFor` of rows of the table
// of settings.
#pragma once

#include "settings/descriptor.h"

#include <string>
#include <string_view>
#include <vector>

namespace glint::compiler {

// The reasons why settings are not worth trying. Each returns a reason for all values, or nothing.
std::string withoutRays(std::string_view value, const BenchFacts& facts, const Configuration& base);
std::string withoutPaths(std::string_view value, const BenchFacts& facts, const Configuration& base);
std::string withoutOrder(std::string_view value, const BenchFacts& facts, const Configuration& base);
std::string withoutChoice(std::string_view value, const BenchFacts& facts, const Configuration& base);
std::string withoutEmission(std::string_view value, const BenchFacts& facts, const Configuration& base);
std::string withoutSkyLight(std::string_view value, const BenchFacts& facts, const Configuration& base);
std::string withoutSizedLights(std::string_view value, const BenchFacts& facts, const Configuration& base);

// The reasons why settings change nothing, for rows with other reasons than those above.
std::string neverIdle(const BenchFacts& facts, const Configuration& base);
std::string idleReflections(const BenchFacts& facts, const Configuration& base);
std::string idleMarch(const BenchFacts& facts, const Configuration& base);
std::string idleLightRadius(const BenchFacts& facts, const Configuration& base);
std::string idleSunAngle(const BenchFacts& facts, const Configuration& base);
std::string idleChoice(const BenchFacts& facts, const Configuration& base);
std::string idleTextures(const BenchFacts& facts, const Configuration& base);
std::string idleAlpha(const BenchFacts& facts, const Configuration& base);
std::string idleTracer(const BenchFacts& facts, const Configuration& base);

// The values to try, for rows that have no fixed list. `base` is the value of the default.
std::vector<std::string> strategiesToTry(const BenchFacts& facts, const std::string& base, bool quick);
std::vector<std::string> effectsToTry(const BenchFacts& facts, const std::string& base, bool quick);
std::vector<std::string> clampsToTry(const BenchFacts& facts, const std::string& base, bool quick);

}  // namespace glint::compiler
