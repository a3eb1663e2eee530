#include "plan/frame_rounds.h"

#include "plan/cost.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace glint::compiler {

namespace {

double coherenceOf(const materials::EffectDeclaration& effect, const materials::Material& material,
                   const materials::PrimitiveInputs& primitive) {
    const materials::EffectCoherence& coherence = effect.coherence;
    const bool differs = coherence.mirror != coherence.glossy;
    return differs && leastRoughness(material, primitive) <= kMirrorRoughness ? coherence.mirror
                                                                              : coherence.glossy;
}

// Returns each primitive's share of the surfaces in the picture. All shares are equal if nothing is known.
std::vector<double> surfaceShares(std::span<const materials::PrimitiveInputs> primitives) {
    std::vector<double> shares;
    for (const materials::PrimitiveInputs& inputs : primitives) {
        shares.push_back(std::max(0.0, inputs.expectedHits));
    }
    const double all = std::accumulate(shares.begin(), shares.end(), 0.0);
    for (double& share : shares) {
        share = all > 0.0 ? share / all : 1.0 / static_cast<double>(shares.size());
    }
    return shares;
}

// Joins the rays of both lists into one list.
void join(Round& all, const Round& round) {
    const double rays = all.rays + round.rays;
    if (rays > 0.0) {
        all.coherence = (all.rays * all.coherence + round.rays * round.coherence) / rays;
        all.scatter = (all.rays * all.scatter + round.rays * round.scatter) / rays;
    }
    all.rays = rays;
}

std::vector<RoundCase> casesOfPaths(std::vector<RoundCase> cases) {
    for (RoundCase& one : cases) {
        one.instructions *= kPathCode;
        for (PartialCode& part : one.parts) {
            part.instructions *= kPathCode;
        }
    }
    return cases;
}

// Adds the bounces of the rays that a round's hits send. Hits of the last one send none.
void addBounces(std::vector<Round>& rounds, Round round, std::uint32_t bounces) {
    constexpr std::uint32_t kFree = 3;  // bounces without roulette
    for (std::uint32_t bounce = 2; bounce <= bounces; ++bounce) {
        const double kept = bounce <= kFree       ? 1.0
                            : bounce == kFree + 1 ? std::pow(kPathAlbedo, kFree)
                                                  : kPathAlbedo;
        round.rays *= round.hitShare * kept;
        round.coherence = std::min(round.coherence, kPathCoherence);
        round.scatter = 1.0 - round.coherence;
        round.bounce = bounce;
        if (round.rays < 1.0) {
            return;
        }
        rounds.push_back(round);
    }
}

}  // namespace

std::vector<WeightedKey> keysOfScene(const Plan& plan, const PlanOptions& options,
                                     std::span<const materials::PrimitiveInputs> primitives,
                                     std::size_t first) {
    std::vector<WeightedKey> keys = weightedKeys(plan, options);
    for (WeightedKey& key : keys) {
        key.share = 0.0;
    }
    const bool counted = countsHits(options);
    for (std::size_t i = 0; i < primitives.size(); ++i) {
        const auto index = static_cast<std::size_t>(plan.keyOfPrimitive[first + i]);
        const Key& key = plan.keys[index];
        // A count belongs to a key, so the primitives of the key share it.
        const double share = key.share / static_cast<double>(key.primitives.size());
        keys[index].share += counted ? share : std::max(0.0, primitives[i].expectedHits);
    }
    return keys;
}

std::vector<KeySet> caseKeys(const Plan& plan, std::span<const WeightedKey> keys) {
    std::vector<KeySet> cases;
    for (const Case& shaderCase : plan.cases) {
        if (!shaderCase.isRetired()) {
            cases.push_back(toSet(shaderCase.keys, keys));
        }
    }
    return cases;
}

std::vector<KeySet> caseKeys(std::span<const CaseFeatures> cases, std::span<const CaseHits> hits,
                             const materials::MaterialModel& model) {
    std::vector<double> byCase(cases.size());
    for (const CaseHits& entry : hits) {
        byCase[static_cast<std::size_t>(entry.shaderId)] += entry.hits;
    }
    std::vector<KeySet> sets;
    for (std::size_t i = 0; i < cases.size(); ++i) {
        if (!cases[i].retired) {
            KeySet& set = sets.emplace_back(
                toSet(WeightedKey{cases[i].always | cases[i].sometimes, byCase[i], &model}));
            set.always = cases[i].always;
            // Being unlit is the feature that leaves code out.
            (model.unlit & cases[i].sometimes).forEach([&](int bit) { set.shareWith.remove(bit); });
        }
    }
    return sets;
}

std::vector<RoundCase> roundCases(std::span<const KeySet> cases) {
    double all = 0.0;
    for (const KeySet& keys : cases) {
        all += keys.share;
    }
    std::vector<RoundCase> result;
    for (const KeySet& keys : cases) {
        CaseCode code = codeOf(keys);
        result.push_back({all > 0.0 ? keys.share / all : 1.0 / static_cast<double>(cases.size()),
                          code.always.instructions, code.always.fetches, std::move(code.parts)});
    }
    return result;
}

std::vector<Round> frameRounds(std::span<const materials::Material> materials,
                               std::span<const materials::PrimitiveInputs> primitives,
                               const FrameShape& shape) {
    const std::vector<double> shares = surfaceShares(primitives);
    std::vector<Round> rounds;
    const materials::MaterialModel& model =
        materials.empty() ? materials::builtinMaterialModel() : materials.front().model();
    for (std::size_t number = 0; number < model.effects.size(); ++number) {
        const materials::EffectDeclaration& effect = model.effects[number];
        if ((shape.effects & infoOf(effect, number).effect) == 0 ||
            effect.kind != package::EffectInfo::Kind::Rays) {
            continue;
        }
        Round round{0.0, kRayHitShare, 0.0, 0.0, {}};
        double senders = 0.0;  // share of the surfaces in the picture that send rays
        for (std::size_t i = 0; i < primitives.size(); ++i) {
            const materials::Material& material = materials[static_cast<std::size_t>(primitives[i].material)];
            if (sendsRays(effect, material, primitives[i], shape.maxReflectionRoughness)) {
                senders += shares[i];
                round.coherence += shares[i] * coherenceOf(effect, material, primitives[i]);
            }
        }
        if (senders <= 0.0) {
            continue;
        }
        round.coherence /= senders;
        // Rays that spread apart hit surfaces as different as those of the whole scene.
        round.scatter = 1.0 - round.coherence;
        round.rays = shape.pixels * kSurfaceShare * std::min(senders, 1.0);
        if (shape.batchEffects && !rounds.empty()) {
            join(rounds.front(), round);
        } else {
            rounds.push_back(std::move(round));
        }
    }
    const std::size_t first = rounds.size();
    for (std::size_t i = 0; i < first; ++i) {
        addBounces(rounds, rounds[i], shape.bounces);
    }
    return rounds;
}

void setCases(std::vector<Round>& rounds, const std::vector<RoundCase>& cases, const FrameShape& shape) {
    for (Round& round : rounds) {
        round.cases = shape.bounces > 1 ? casesOfPaths(cases) : cases;
    }
}

}  // namespace glint::compiler
