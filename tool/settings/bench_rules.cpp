#include "settings/bench_rules.h"

#include "settings/values.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace glint::compiler {

using namespace values;

namespace {

bool ordersHits(const Configuration& base) {
    const std::optional<package::Strategy> strategy =
        valueNamed<package::Strategy>(base.find("strategy")->second);
    return strategy && (*strategy & package::orderedStrategies()) != 0;
}

}  // namespace

std::string withoutRays(std::string_view value, const BenchFacts& facts, const Configuration& /*base*/) {
    return value.empty() && !facts.sendsRays ? "no effect sends rays whose hits are shaded" : "";
}

// The effects of a full reference send rays, even if those of the default don't. Some lights are there in
// packages for several bounces alone.
std::string withoutPaths(std::string_view value, const BenchFacts& facts, const Configuration& base) {
    return facts.fullTransport || facts.bouncesLight ? std::string() : withoutRays(value, facts, base);
}

std::string withoutOrder(std::string_view value, const BenchFacts& facts, const Configuration& base) {
    const std::string reason = withoutRays(value, facts, base);
    return !reason.empty() || !value.empty() || ordersHits(base)
               ? reason
               : fmt::format("--strategy {} sorts no hits and keeps no records",
                             base.find("strategy")->second);
}

// A hierarchy that may choose every light has nothing to choose.
std::string withoutChoice(std::string_view value, const BenchFacts& facts, const Configuration& base) {
    const std::string& own = base.find("lights")->second;
    if (value == kAll) {
        return own == kAuto && !facts.manyLights ? "auto takes all of so few lights" : "";
    }
    std::int64_t chosen = 1;
    if (!value.empty() && !parseWhole(value, 1, package::kMaxLightSamples, chosen)) {
        return "";
    }
    return static_cast<std::size_t>(chosen) < facts.lights
               ? ""
               : fmt::format("there are no more lights with a position: {}", facts.lights);
}

std::string neverIdle(const BenchFacts& /*facts*/, const Configuration& /*base*/) {
    return "";
}

// A higher limit of roughness may call for reflections itself, and a lower one may have removed them.
std::string idleReflections(const BenchFacts& facts, const Configuration& /*base*/) {
    BenchFacts any = facts;
    any.effects = facts.effectsOfAnyRoughness;
    return withoutEffect("max-roughness", any);
}

std::string idleMarch(const BenchFacts& facts, const Configuration& base) {
    const std::string reason = withoutEffect("ssr", facts);
    return reason.empty() && base.find("ssr")->second == "off" ? "--ssr is off" : reason;
}

std::string idleLightRadius(const BenchFacts& facts, const Configuration& /*base*/) {
    return facts.placedLights ? "" : "the picture has no point or spot light";
}

std::string idleSunAngle(const BenchFacts& facts, const Configuration& /*base*/) {
    return facts.directionalLights ? "" : "the picture has no directional light";
}

// A number of samples above the number of lights takes every light, and so does any number if there is one
// light.
std::string idleChoice(const BenchFacts& facts, const Configuration& base) {
    const std::string& own = base.find("lights")->second;
    return own == kAll ? "" : withoutChoice(own, facts, base);
}

std::string idleTextures(const BenchFacts& facts, const Configuration& /*base*/) {
    return facts.textures ? "" : "there are no textures";
}

std::string idleAlpha(const BenchFacts& facts, const Configuration& /*base*/) {
    return facts.masks ? "" : "no material has alpha";
}

std::string idleTracer(const BenchFacts& facts, const Configuration& /*base*/) {
    return facts.effects.empty() ? "no effect traces rays" : "";
}

std::string withoutEmission(std::string_view value, const BenchFacts& facts, const Configuration& /*base*/) {
    if (!facts.emits) {
        return "no material emits light";
    }
    return value == "on" && !facts.lightsMayEmit ? "the default has no shadow rays" : "";
}

std::string withoutSkyLight(std::string_view value, const BenchFacts& facts, const Configuration& /*base*/) {
    return value == "on" && !facts.skyMayLight ? "the default has no shadow rays" : "";
}

std::string withoutSizedLights(std::string_view value, const BenchFacts& facts,
                               const Configuration& /*base*/) {
    if (!facts.sizedLights) {
        return "no light has a size (--light-radius, --sun-angle)";
    }
    return value == "on" && !facts.sizedMayShow ? "the default has no shadow rays" : "";
}

std::vector<std::string> strategiesToTry(const BenchFacts& /*facts*/, const std::string& /*base*/,
                                         bool /*quick*/) {
    std::vector<std::string> names;
    for (const package::StrategyInfo& info : package::strategyTable()) {
        names.emplace_back(info.name);
    }
    return names;
}

// Returns the default's effects, those of a reference of all transport, and values that leave out one effect
// each.
std::vector<std::string> effectsToTry(const BenchFacts& facts, const std::string& base, bool /*quick*/) {
    std::vector<std::string> values{base};
    if (facts.fullTransport && facts.rayEffects != base) {
        values.push_back(facts.rayEffects);
    }
    for (const std::string& without : facts.effects) {
        std::vector<std::string> rest(facts.effects.begin(), facts.effects.end());
        std::erase(rest, without);
        values.push_back(rest.empty() ? std::string(kNone) : fmt::format("{}", fmt::join(rest, ",")));
    }
    return values;
}

// Returns multiples of white, rounded to three digits.
std::vector<std::string> clampsToTry(const BenchFacts& facts, const std::string& /*base*/, bool quick) {
    std::vector<std::string> values{"0"};
    for (const double times : {16.0, 4.0, 1.0}) {
        if (facts.white > 0.0 && (!quick || times == 1.0)) {
            values.push_back(fmt::format("{:.3g}", times * facts.white));
        }
    }
    return values;
}

}  // namespace glint::compiler
