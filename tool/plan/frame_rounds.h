// Estimates the lists of rays that a frame will send: the model of strategy_cost.h needs them before anything
// is rendered.
//
// A pixel that shows a material sends a ray for each effect that the material calls for (sendsRays()). The
// part of the picture that shows a material is taken from its primitives' expected hits
// (gltf/expected_hits.h), because surfaces that rays often find are surfaces that are often seen. Hits are
// distributed over the plan's cases by the counts of a profile, or by the same expectation.
#pragma once

#include "plan/plan.h"
#include "plan/strategy_cost.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace glint::compiler {

// The share of pixels that show a surface, and the share of effects' rays that hit one. Both are chosen:
// outdoor scenes have less, rooms have 1. They scale the times of all strategies alike, except for the
// launches.
inline constexpr double kSurfaceShare = 0.8;
inline constexpr double kRayHitShare = 0.7;

// Declarations of effects give the similarity of neighbouring rays' hits (Round::coherence). The values are
// chosen between those of the calibration's coherent scenes (mirrors), near 1, and its incoherent scenes
// (diffuse rays), near 0. Mirrors have 0.9, as neighbours hit one surface up to its border; glossy lobes,
// some ten degrees wide, have 0.5; refraction has 0.7, as the surfaces in between bend and scatter the rays;
// diffuse rays have 0.1, as they take any direction of a hemisphere, but a large floor is alike.
//
// Surfaces that are rougher are glossy. This is the default of FrameOptions::mirrorRoughness.
inline constexpr float kMirrorRoughness = 0.05F;

// Paths (--bounces above 1). A hit's next ray may take any lobe, and neighbours have parted at least once
// before, so the hits of later bounces are as unlike as those of diffuse rays.
inline constexpr double kPathCoherence = 0.1;
// The shaders of packages with paths also choose and weigh the next ray over all lobes of a hit. Instructions
// of a case's SPIR-V over those in a package for one bounce (docs/performance.md says how it was measured).
inline constexpr double kPathCode = 1.9;
// The similarity of the hits of neighbouring pixels: a surface ends at its silhouette alone.
inline constexpr double kScreenCoherence = 0.9;

// The share of light that remains after a bounce. Russian roulette keeps a path with the probability of its
// throughput: once after three bounces, for all three, and then after each further bounce for that one
// (docs/paths.md).
inline constexpr double kPathAlbedo = 0.5;

struct FrameShape {
    double pixels = 1920.0 * 1080.0;  // times samples; the default is for an unknown size
    std::uint32_t effects = 0;        // Effect bits
    float maxReflectionRoughness = 0.3F;
    bool batchEffects = false;  // The rays of all effects form one list.
    std::uint32_t bounces = 1;  // the most of a path
};

// Returns the plan's keys with their hits in one scene: those of the plan's primitives from index `first` on,
// as many as `primitives` has. They are counted by the profile if options has hits; otherwise they are those
// that the primitives expect.
std::vector<WeightedKey> keysOfScene(const Plan& plan, const PlanOptions& options,
                                     std::span<const materials::PrimitiveInputs> primitives,
                                     std::size_t first);
// Returns the keys of each case that is not retired, with their hits.
std::vector<KeySet> caseKeys(const Plan& plan, std::span<const WeightedKey> keys);

// The features of a case of a finished package, whose keys are not known. A retired case has no code.
struct CaseFeatures {
    materials::FeatureMask always = 0;
    materials::FeatureMask sometimes = 0;
    bool retired = false;
};
// The hits of a case, in proportion to those of others.
struct CaseHits {
    int shaderId = 0;  // the ID of a case that is not retired
    double hits = 0.0;
};
// Returns each case that is not retired. All of its hits run all of its code, as nothing else is known.
// `cases` is indexed by shader ID.
std::vector<KeySet> caseKeys(std::span<const CaseFeatures> cases, std::span<const CaseHits> hits,
                             const materials::MaterialModel& model);

// Returns the cases with their shares of the hits and their estimated code. Shares are equal if nothing is
// known.
std::vector<RoundCase> roundCases(std::span<const KeySet> cases);

// Returns one round for each effect that sends rays, in the order of the effects, or one round for all
// effects; then one round for each further bounce of these rounds. They have no cases yet. `primitives` are
// those of one scene; their materials index `materials`.
std::vector<Round> frameRounds(std::span<const materials::Material> materials,
                               std::span<const materials::PrimitiveInputs> primitives,
                               const FrameShape& shape);
// Gives rounds of a frame of that shape their cases.
void setCases(std::vector<Round>& rounds, const std::vector<RoundCase>& cases, const FrameShape& shape);

}  // namespace glint::compiler
