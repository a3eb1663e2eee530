#include "emit/package/json.h"

#include <cmath>

namespace glint::gltf {

base::Fields fieldsOf(const SceneInFile*) {
    return {base::field<&SceneInFile::index>("index", "Its number in the file, from 0."),
            base::field<&SceneInFile::name>("name", "Its name; null if it has none.", {.orNull = true})};
}

}  // namespace glint::gltf

namespace glint::compiler {

using base::field;
using base::output;

namespace {

// Rounds an estimate to four digits. That is more than its accuracy, and gives the same text on every
// machine.
double rounded(double value) {
    if (value == 0.0 || !std::isfinite(value)) {
        return 0.0;
    }
    const double scale = std::pow(10.0, 3.0 - std::floor(std::log10(std::abs(value))));
    return scale >= 1.0 ? std::round(value * scale) / scale : std::round(value);
}

template <double FrameFacts::*Member>
double fact(const StrategyAdvice& advice) {
    return rounded(advice.choice.facts.*Member);
}

std::vector<std::pair<std::string_view, double>> partsOf(const StrategyEstimate& estimate) {
    std::vector<std::pair<std::string_view, double>> parts;
    for (const CostTermInfo& info : costTerms()) {
        if (hasTerm(estimate.strategy, info.term)) {
            parts.emplace_back(info.name, rounded(estimate.parts[static_cast<std::size_t>(info.term)]));
        }
    }
    return parts;
}

}  // namespace

std::optional<gltf::SceneInFile> orNone(const gltf::SceneInFile& scene) {
    return scene.index < 0 ? std::nullopt : std::optional(scene);
}

std::vector<std::string_view> strategyWords() {
    return {simplestFirst().begin(), simplestFirst().end()};
}

static base::Fields fieldsOf(const StrategyEstimate*) {
    using T = StrategyEstimate;
    return {
        output<&T::strategy>("strategy", "Name of the strategy.", {.names = strategyWords()}),
        output<&T::available>("available",
                              "Whether it could be chosen, that is, device, package and tracer can run it."),
        output("milliseconds", "Expected time of all rounds of rays, from the list to the shaded hits.",
               [](const T& estimate) { return rounded(estimate.ms); }),
        output<partsOf>("parts", "Milliseconds of each term of the model that the strategy has, by name.")};
}

base::Fields fieldsOf(const StrategyAdvice*) {
    using T = StrategyAdvice;
    using Choice = StrategyChoice;
    using Facts = FrameFacts;
    return {
        output<&T::choice, &Choice::strategy>("strategy", "The strategy that was chosen.",
                                              {.names = strategyWords()}),
        output<&T::choice, &Choice::why>("why", "Sentences that name the numbers."),
        output<&T::device>("device", "Device whose constants the estimates use."),
        output<&T::builtIn>("builtIn", "Whether these constants are built in and not from --calibration."),
        output<&T::pixels>("pixels", "Number of pixels of the frame.", {.least = 0}),
        output<&T::choice, &Choice::facts, &Facts::bounces>(
            "bounces", "The most bounces of a path that are expected to have rays."),
        output<fact<&Facts::rays>>("rays", "Expected number of rays of all effects whose hits are shaded."),
        output<fact<&Facts::laterRays>>("laterRays", "Those of them that hits send, after the first bounce."),
        output<fact<&Facts::hits>>("hits", "Expected number of hits of these rays."),
        output<&T::choice, &Choice::facts, &Facts::cases>("cases", "Number of shaders."),
        output<fact<&Facts::instructions>>(
            "instructions",
            "SPIR-V instructions that shading a hit takes on average, 20 for each texture fetch beside "
            "its own."),
        output("coherence",
               "How alike the hits of neighbouring rays are expected to be: 0 as drawn at random, 1 all of "
               "one case.",
               [](const T& advice) { return roundedShare(advice.choice.facts.coherence); }),
        output<fact<&Facts::casesRun>>(
            "casesRun", "Cases that a subgroup of unsorted hits is expected to run one after another."),
        output<&T::choice, &Choice::estimates>("estimates", "Strategies whose constants are known.")};
}

base::Fields fieldsOf(const EffectDecision*) {
    using T = EffectDecision;
    return {field<&T::name>("name", "Name of the effect."),
            field<&T::chosen>("chosen", "Whether it is in the package."),
            field<&T::usable>("usable", "Whether the scenes call for it."),
            field<&T::reason>("reason", "The reason.")};
}

base::Fields fieldsOf(const SpirvStatistics*) {
    using T = SpirvStatistics;
    return {
        field<&T::bytes>("bytes", "Size of the module."),
        field<&T::instructions>("instructions", "Instructions in functions, without labels and debug lines."),
        field<&T::textureFetches>("textureFetches", "Texture fetches and samples."),
        field<&T::rayQueries>("rayQueries", "Initialisations of ray queries."),
        field<&T::branches>("branches", "Conditional branches and switches.")};
}

std::variant<std::uint64_t, double> wholeNumber(double count) {
    constexpr double kLargest = 9007199254740992.0;  // 2^53
    if (count <= kLargest) {
        return static_cast<std::uint64_t>(count);
    }
    return count;
}

double roundedShare(double share) {
    return std::round(share * 1e4) / 1e4;
}

std::string stageName(const package::ModuleKey& key) {
    const auto strategy = static_cast<package::Strategy>(package::findRole(key.role)->strategies);
    const bool alone = (strategy & package::pipelineStrategies()) != 0;
    const std::string name(package::nameOf(strategy));
    return alone || key.tracer != package::kTracerRayPipeline ? name : name + ", ray-pipeline";
}

}  // namespace glint::compiler
