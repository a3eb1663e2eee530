#include "measure/features/checks.h"

#include "base/lists.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace glint::measure {

namespace {

// The tolerances for values outside of their range, for rounding.
constexpr double kShareTolerance = 1e-3;
constexpr double kUnitTolerance = 1e-3;
// Differences between f(v, l) and f(l, v), as a share of the larger. Near the peak of the sharpest lobes,
// alpha 1e-4, a unit vector of single precision decides about the value to 1e-3.
constexpr double kReciprocityLimit = 1e-2;
// The part of a lobe that is ignored when both are compared.
constexpr double kReciprocityFloor = 1e-4;
constexpr double kDensityLimit = 3e-3;
constexpr double kSignificanceLimit = 1e-6;
constexpr double kEnergyLimit = 1e-2;
constexpr double kAlbedoLimit = 0.1;

constexpr double kGrazing = std::numbers::pi / 2.0;

Direction toDirection(const float (&v)[3]) {
    return {v[0], v[1], v[2]};
}

bool isFinite(const compiler::FeatureKernelOutput& output) {
    const auto* const first = reinterpret_cast<const float*>(&output);
    return std::all_of(first, first + sizeof(output) / sizeof(float),
                       [](float value) { return std::isfinite(value); });
}

double largestOf(const float (&v)[3]) {
    return std::max({v[0], v[1], v[2]});
}

double smallestOf(const float (&v)[3]) {
    return std::min({v[0], v[1], v[2]});
}

// The distance of a result from its permitted range, with a message; 0 and no message if it is right.
struct Fault {
    double distance = 0.0;
    const char* what = "";
};

void noteFault(Fault& worst, double distance, const char* what) {
    if (distance > worst.distance) {
        worst = {distance, what};
    }
}

Fault faultOf(const compiler::FeatureKernelOutput& output, bool isLobe) {
    Fault worst;
    if (!isFinite(output)) {
        return {std::numeric_limits<double>::infinity(), "a value is NaN or infinite"};
    }
    noteFault(worst, -static_cast<double>(smallestOf(output.reflected)),
              "the light that is reflected is negative");
    noteFault(worst, -static_cast<double>(smallestOf(output.whole)),
              "the light of the whole material is negative");
    noteFault(worst, -static_cast<double>(smallestOf(output.emission)), "the emission is negative");
    noteFault(worst, -static_cast<double>(output.density), "the density is negative");
    noteFault(worst, -static_cast<double>(output.roughness), "the roughness is negative");
    if (isLobe) {
        noteFault(worst, std::max(-output.passed, output.passed - 1.0F) - kShareTolerance,
                  "the share that passes for one light is outside of [0, 1]");
        noteFault(worst, std::max(-output.albedoPassed, output.albedoPassed - 1.0F) - kShareTolerance,
                  "the share that passes of a white sky is outside of [0, 1]");
        noteFault(worst,
                  std::max(-smallestOf(output.albedo), largestOf(output.albedo) - 1.0F) - kShareTolerance,
                  "the share that is reflected of a white sky is outside of [0, 1]");
    }
    const Direction sampled = toDirection(output.sampled);
    const double length = std::hypot(sampled[0], sampled[1], sampled[2]);
    noteFault(worst, std::min(length, std::abs(length - 1.0)) - kUnitTolerance,
              "a sampled direction is neither a unit vector nor 0");
    return worst;
}

// Views from straight above to the plane itself.
std::vector<Direction> adverseViews() {
    std::vector<Direction> views;
    for (const double angle : {0.0, 1.0, kGrazing - 0.02, kGrazing - 1e-4, kGrazing - 1e-7}) {
        views.push_back(tiltedDirection(angle, 0.7));
    }
    views.push_back(tiltedDirection(kGrazing - 1e-4, std::numbers::pi));
    views.push_back(tiltedDirection(std::numbers::pi - 1.0, 0.7));
    return views;
}

// Lights that are difficult for formulas, for a view in the frame of the surface.
std::vector<Direction> adverseLights(const Direction& view) {
    std::vector<Direction> lights{{0, 0, 1},
                                  {0, 0, -1},
                                  view,
                                  {-view[0], -view[1], -view[2]},
                                  {-view[0], -view[1], view[2]},
                                  {view[0], view[1], -view[2]},
                                  {1, 0, 0},
                                  {0, -1, 0}};
    const double azimuth = std::atan2(view[1], view[0]);
    for (const double turn : {0.0, std::numbers::pi, 1.3}) {
        for (const double above : {1e-7, -1e-7, 1e-3}) {
            lights.push_back(tiltedDirection(kGrazing - above, azimuth + turn));
        }
    }
    for (std::uint64_t i = 0; i < 4; ++i) {
        const std::array<double, 3> u = randomNumbers(i, 3);
        lights.push_back(tiltedDirection(std::acos(2.0 * u[0] - 1.0), 2.0 * std::numbers::pi * u[1]));
    }
    return lights;
}

// The ends of the numbers that samples are made of, and some numbers between them.
std::array<float, 3> adverseRandom(std::size_t index) {
    constexpr float kLast = 0.99999994F;
    switch (index % 5) {
        case 0:
            return {0.0F, 0.0F, 0.0F};
        case 1:
            return {kLast, kLast, kLast};
        case 2:
            return {0.0F, kLast, 0.5F};
        case 3:
            return {kLast, 0.0F, 0.5F};
        default: {
            const std::array<double, 3> u = randomNumbers(index, 4);
            return {static_cast<float>(u[0]), static_cast<float>(u[1]), static_cast<float>(u[2])};
        }
    }
}

CheckPlace placeOf(const CheckedMaterial& material, const Direction& view, const Direction* light) {
    CheckPlace place = material.place;
    place.view = view;
    if (light != nullptr) {
        place.light = *light;
    }
    return place;
}

// Keeps the outcome that is farther beyond its limit. `message` is kept if `fails`.
void keepWorst(CheckOutcome& outcome, double value, bool isWorse, bool fails, std::string message,
               const CheckPlace& place) {
    const bool first = !outcome.place;
    if (first || isWorse || (fails && outcome.state != CheckState::Failed)) {
        outcome.worst = value;
        outcome.place = place;
        outcome.message = fails ? std::move(message) : std::string();
    }
    outcome.state = fails ? CheckState::Failed
                          : (outcome.state == CheckState::Failed ? CheckState::Failed : CheckState::Passed);
}

// Calls the evaluator once with the same material and views, to learn the views in the frame of the surface.
Result<std::vector<Direction>> surfaceViews(const FeatureOnDevice& on, const std::vector<Direction>& views) {
    std::vector<compiler::FeatureKernelInput> inputs;
    for (const CheckedMaterial& material : on.feature.materials) {
        for (const Direction& view : views) {
            inputs.push_back(inputOf(on, material, view, {0, 0, 1}));
        }
    }
    GLINT_TRY(const auto outputs, on.evaluator.run(inputs));
    return base::mapped<Direction>(
        outputs, [](const compiler::FeatureKernelOutput& output) { return toDirection(output.view); });
}

// A material of the feature, seen from somewhere.
struct SeenMaterial {
    const CheckedMaterial* material = nullptr;
    Direction view{};         // in the world
    Direction surfaceView{};  // in the frame of the surface
};

// Every combination from two views: one from the side, and one that changes from normal to grazing incidence;
// and from behind where it has two sides.
Result<std::vector<SeenMaterial>> seenMaterials(const FeatureOnDevice& on) {
    const std::vector<Direction> views{tiltedDirection(0.6, 0.4), tiltedDirection(0.0, 0.0),
                                       tiltedDirection(1.2, 2.0), tiltedDirection(1.52, 4.0),
                                       tiltedDirection(std::numbers::pi - 0.6, 0.4)};
    GLINT_TRY(const auto found, surfaceViews(on, views));
    std::vector<SeenMaterial> seen;
    for (std::size_t i = 0; i < on.feature.materials.size(); ++i) {
        for (const std::size_t view : {std::size_t{0}, 1 + i % 3, views.size() - 1}) {
            if (view == views.size() - 1 && !on.feature.materials[i].isTwoSided) {
                continue;
            }
            seen.push_back({&on.feature.materials[i], views[view], found[i * views.size() + view]});
        }
    }
    return seen;
}

Result<std::vector<std::vector<Direction>>> sampleAll(const FeatureOnDevice& on,
                                                      const std::vector<SeenMaterial>& seen) {
    std::vector<compiler::FeatureKernelInput> inputs;
    inputs.reserve(seen.size() * on.samples);
    for (std::size_t i = 0; i < seen.size(); ++i) {
        for (std::uint32_t k = 0; k < on.samples; ++k) {
            compiler::FeatureKernelInput input = inputOf(on, *seen[i].material, seen[i].view, {0, 0, 1});
            const std::array<double, 3> u = randomNumbers(i * on.samples + k, 5);
            std::ranges::transform(u, input.random, [](double value) { return static_cast<float>(value); });
            input.mode = compiler::kKernelSamples;
            inputs.push_back(input);
        }
    }
    GLINT_TRY(const auto outputs, on.evaluator.run(inputs));
    std::vector<std::vector<Direction>> samples(seen.size());
    for (std::size_t i = 0; i < outputs.size(); ++i) {
        const Direction direction = toDirection(outputs[i].sampled);
        const double length = std::hypot(direction[0], direction[1], direction[2]);
        // A sample without a direction fails the check of ranges.
        samples[i / on.samples].push_back(length > 0.5 && length < 2.0 ? direction : Direction{});
    }
    return samples;
}

LobeValues valuesOf(const compiler::FeatureKernelOutput& output) {
    LobeValues values;
    const auto number = [](float value) { return std::isfinite(value) ? static_cast<double>(value) : 0.0; };
    values.density = number(output.density);
    for (std::size_t channel = 0; channel < 3; ++channel) {
        values.reflected[channel] = number(output.reflected[channel]);
        values.whole[channel] = number(output.whole[channel]);
    }
    return values;
}

double largestOf(const std::array<double, 3>& v) {
    return std::max({v[0], v[1], v[2]});
}

// The light that each base alone reflects for a view; it exceeds 1 only by the errors of its tables.
Result<std::vector<double>> baseEnergies(const FeatureOnDevice& on, const std::vector<SeenMaterial>& seen) {
    std::vector<CheckedMaterial> bases(seen.size());
    for (std::size_t i = 0; i < seen.size(); ++i) {
        const int base = seen[i].material->base;
        bases[i] = {on.scene.bases[static_cast<std::size_t>(base)], base, true, {}};
    }
    const FeatureOnDevice whole{on.evaluator, on.scene, on.feature, 0, on.samples};
    const std::vector<std::vector<Direction>> none(seen.size());
    const Result<std::vector<LobeIntegrals>> integrals =
        integrateLobes(none, [&](std::span<const LobeQuery> queries) -> Result<std::vector<LobeValues>> {
            const auto inputs =
                base::mapped<compiler::FeatureKernelInput>(queries, [&](const LobeQuery& query) {
                    return inputOf(whole, bases[query.lobe], seen[query.lobe].view, query.direction);
                });
            GLINT_TRY(const auto outputs, on.evaluator.run(inputs));
            std::vector<LobeValues> values(outputs.size());
            for (std::size_t i = 0; i < values.size(); ++i) {
                values[i].whole = valuesOf(outputs[i]).whole;
            }
            return values;
        });
    if (!integrals) {
        return integrals.error();
    }
    return base::mapped<double>(*integrals,
                                [](const LobeIntegrals& integral) { return largestOf(integral.whole); });
}

// Judges one combination and view by each of the checks.
void judgeIntegrals(const LobeIntegrals& integrals, const compiler::FeatureKernelOutput& shares,
                    double baseEnergy, const CheckPlace& place, const FeatureOnDevice& on,
                    IntegralOutcomes& outcomes) {
    if (on.lobe != 0 || on.feature.isBase()) {
        const double total = integrals.density + integrals.lost;
        const double noise = 4.0 * std::sqrt(integrals.lost * (1.0 - integrals.lost) / on.samples);
        // A distance that noise and the quadrature's own error explain is no fault.
        const double distance = std::max(std::abs(total - 1.0) - noise - integrals.densityError, 0.0);
        const bool isNormalised = distance <= kDensityLimit;
        keepWorst(outcomes.density, distance, distance > outcomes.density.worst, !isNormalised,
                  fmt::format("integrates to {:.4f} and {:.4f} of the samples have no direction; the sum "
                              "should be 1",
                              integrals.density, integrals.lost),
                  place);
        if (isNormalised) {
            const bool fails = integrals.significance < kSignificanceLimit;
            keepWorst(outcomes.samples, integrals.significance,
                      integrals.significance < outcomes.samples.worst, fails,
                      fmt::format("samples would be as far from their density as these by chance with a "
                                  "probability of {:.1e}",
                                  integrals.significance),
                      place);
        } else if (outcomes.samples.state == CheckState::Absent) {
            outcomes.samples.state = CheckState::Unsure;
        }
    }
    if (on.lobe != 0) {
        double off = 0.0;
        for (std::size_t channel = 0; channel < 3; ++channel) {
            off = std::max(
                off, std::abs(integrals.reflected[channel] - static_cast<double>(shares.albedo[channel])));
        }
        off = std::max(off - integrals.wholeError, 0.0);
        keepWorst(
            outcomes.albedo, off, off > outcomes.albedo.worst, off > kAlbedoLimit,
            fmt::format("reflects {:.3f}, {:.3f}, {:.3f} of a white sky, and says {:.3f}, {:.3f}, {:.3f}",
                        integrals.reflected[0], integrals.reflected[1], integrals.reflected[2],
                        shares.albedo[0], shares.albedo[1], shares.albedo[2]),
            place);
    }
    const double energy = largestOf(integrals.whole);
    const double excess = std::max(energy - std::max(1.0, baseEnergy) - integrals.wholeError, 0.0);
    keepWorst(outcomes.energy, excess, excess > outcomes.energy.worst, excess > kEnergyLimit,
              fmt::format("{:.4f} of the light of a white furnace leaves the {}", energy, place.base), place);
}

}  // namespace

Direction tiltedDirection(double angle, double azimuth) {
    return {std::sin(angle) * std::cos(azimuth), std::sin(angle) * std::sin(azimuth), std::cos(angle)};
}

std::array<double, 3> randomNumbers(std::uint64_t index, std::uint32_t stream) {
    // SplitMix64: Steele, Lea and Flood, "Fast Splittable Pseudorandom Number Generators" (2014).
    std::uint64_t state = (index * 3 + 1) * 0x9e3779b97f4a7c15ULL + (std::uint64_t{stream} << 40U);
    std::array<double, 3> numbers{};
    for (double& number : numbers) {
        state += 0x9e3779b97f4a7c15ULL;
        std::uint64_t z = state;
        z = (z ^ z >> 30U) * 0xbf58476d1ce4e5b9ULL;
        z = (z ^ z >> 27U) * 0x94d049bb133111ebULL;
        // The number has as many bits as a float below 1 keeps.
        number = std::ldexp(static_cast<double>((z ^ z >> 31U) >> 40U), -24);
    }
    return numbers;
}

compiler::FeatureKernelInput inputOf(const FeatureOnDevice& on, const CheckedMaterial& material,
                                     const Direction& view, const Direction& light) {
    compiler::FeatureKernelInput input;
    input.geometry = material.geometry;
    input.lobe = on.lobe;
    // Each combination is looked at in a place of its own, because some features depend on it.
    const std::array<double, 3> u = randomNumbers(material.geometry, 1);
    input.place[0] = static_cast<float>(0.9 * std::min(u[0], 1.0 - u[1]) + 0.02);
    input.place[1] = static_cast<float>(0.9 * std::min(u[1], 1.0 - u[0]) + 0.02);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        input.view[axis] = static_cast<float>(view[axis]);
        input.light[axis] = static_cast<float>(light[axis]);
    }
    return input;
}

Result<CheckOutcome> checkRanges(const FeatureOnDevice& on) {
    CheckOutcome outcome{.check = MaterialCheck::Range};
    const std::vector<Direction> views = adverseViews();
    GLINT_TRY(const auto surfaceView, surfaceViews(on, views));
    std::vector<compiler::FeatureKernelInput> inputs;
    std::vector<CheckPlace> places;
    for (std::size_t i = 0; i < on.feature.materials.size(); ++i) {
        const CheckedMaterial& material = on.feature.materials[i];
        for (std::size_t k = 0; k + (material.isTwoSided ? 0 : 1) < views.size(); ++k) {
            const Direction& seen = surfaceView[i * views.size() + k];
            for (const Direction& light : adverseLights(seen)) {
                compiler::FeatureKernelInput input = inputOf(on, material, views[k], light);
                input.mode = compiler::kKernelSamples;
                std::ranges::copy(adverseRandom(inputs.size()), input.random);
                inputs.push_back(input);
                places.push_back(placeOf(material, seen, &light));
            }
        }
    }
    GLINT_TRY(const auto outputs, on.evaluator.run(inputs));
    outcome.evaluations = inputs.size();
    outcome.state = CheckState::Passed;
    for (std::size_t i = 0; i < outputs.size(); ++i) {
        const Fault fault = faultOf(outputs[i], on.lobe != 0);
        if (fault.distance > outcome.worst) {
            outcome.worst = fault.distance;
            outcome.state = CheckState::Failed;
            outcome.place = places[i];
            outcome.message = fault.what;
        }
    }
    return outcome;
}

Result<CheckOutcome> checkReciprocity(const FeatureOnDevice& on) {
    CheckOutcome outcome{.check = MaterialCheck::Reciprocity, .limit = kReciprocityLimit};
    if (on.lobe == 0 || !on.feature.code->isReciprocal) {
        outcome.state = on.lobe == 0 ? CheckState::Absent : CheckState::Unasked;
        return outcome;
    }
    GLINT_TRY(const auto seen, seenMaterials(on));
    constexpr std::size_t kPairs = 64;
    FeatureOnDevice few = on;
    few.samples = kPairs / 2;
    GLINT_TRY(const auto samples, sampleAll(few, seen));
    // Half of the lights follow the lobe; the others are anywhere above the surface.
    std::vector<compiler::FeatureKernelInput> inputs;
    for (std::size_t i = 0; i < seen.size(); ++i) {
        for (std::size_t k = 0; k < kPairs; ++k) {
            const std::array<double, 3> u = randomNumbers(k, 6);
            Direction light = tiltedDirection(std::acos(std::max(u[0], 1e-3)), 2.0 * std::numbers::pi * u[1]);
            if (k < kPairs / 2 && samples[i][k][2] > 1e-3) {
                light = samples[i][k];
            }
            for (const std::uint32_t mode : {0U, compiler::kKernelSwaps}) {
                compiler::FeatureKernelInput input = inputOf(on, *seen[i].material, seen[i].view, light);
                input.mode = mode;
                inputs.push_back(input);
            }
        }
    }
    GLINT_TRY(const auto outputs, on.evaluator.run(inputs));
    outcome.evaluations = inputs.size();
    for (std::size_t i = 0; i + 1 < outputs.size(); i += 2) {
        const compiler::FeatureKernelOutput& there = outputs[i];
        const compiler::FeatureKernelOutput& back = outputs[i + 1];
        if (!isFinite(there) || !isFinite(back)) {
            continue;  // The check of ranges fails.
        }
        double difference = std::abs(static_cast<double>(there.passed) - static_cast<double>(back.passed));
        double forth = 0.0;
        double other = 0.0;
        for (std::size_t channel = 0; channel < 3; ++channel) {
            const auto value = [channel](const compiler::FeatureKernelOutput& output) {
                return output.reflected[channel] > 0.0F ? static_cast<double>(output.reflected[channel]) /
                                                              std::abs(static_cast<double>(output.side))
                                                        : 0.0;
            };
            const double a = value(there);
            const double b = value(back);
            const double relative = std::abs(a - b) / std::max({a, b, kReciprocityFloor});
            if (relative >= difference) {
                difference = relative;
                forth = a;
                other = b;
            }
        }
        const Direction light{inputs[i].light[0], inputs[i].light[1], inputs[i].light[2]};
        keepWorst(outcome, difference, difference > outcome.worst, difference > kReciprocityLimit,
                  fmt::format("the lobe is {:.5g}, and {:.5g} with view and light in each other's place",
                              forth, other),
                  placeOf(*seen[i / (2 * kPairs)].material, toDirection(there.view), &light));
    }
    return outcome;
}

Result<IntegralOutcomes> checkIntegrals(const FeatureOnDevice& on) {
    IntegralOutcomes outcomes{
        {.check = MaterialCheck::Density, .limit = kDensityLimit},
        {.check = MaterialCheck::Samples, .worst = 1.0, .limit = kSignificanceLimit},
        {.check = MaterialCheck::Energy, .limit = kEnergyLimit},
        {.check = MaterialCheck::Albedo, .limit = kAlbedoLimit},
    };
    GLINT_TRY(const auto seen, seenMaterials(on));
    GLINT_TRY(const auto samples, sampleAll(on, seen));
    const Result<std::vector<LobeIntegrals>> integrals =
        integrateLobes(samples, [&](std::span<const LobeQuery> queries) -> Result<std::vector<LobeValues>> {
            const auto inputs =
                base::mapped<compiler::FeatureKernelInput>(queries, [&](const LobeQuery& query) {
                    const SeenMaterial& one = seen[query.lobe];
                    return inputOf(on, *one.material, one.view, query.direction);
                });
            GLINT_TRY(const auto outputs, on.evaluator.run(inputs));
            return base::mapped<LobeValues>(outputs, valuesOf);
        });
    if (!integrals) {
        return integrals.error();
    }
    const auto straight = base::mapped<compiler::FeatureKernelInput>(seen, [&](const SeenMaterial& one) {
        return inputOf(on, *one.material, one.view, {0, 0, 1});
    });
    GLINT_TRY(const auto shares, on.evaluator.run(straight));
    GLINT_TRY(const auto bases, baseEnergies(on, seen));
    std::uint64_t evaluations = 0;
    for (std::size_t i = 0; i < seen.size(); ++i) {
        judgeIntegrals((*integrals)[i], shares[i], bases[i],
                       placeOf(*seen[i].material, seen[i].surfaceView, nullptr), on, outcomes);
        evaluations += (*integrals)[i].evaluations;
    }
    outcomes.energy.evaluations = evaluations;
    for (CheckOutcome* const outcome : {&outcomes.density, &outcomes.albedo}) {
        outcome->evaluations = outcome->place ? evaluations : 0;
    }
    outcomes.samples.evaluations = outcomes.density.place ? seen.size() * on.samples : 0;
    return outcomes;
}

}  // namespace glint::measure
