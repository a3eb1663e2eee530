// The lists of rays that a frame is expected to send: what the model of strategy_cost.h needs to know of a
// scene before anything is rendered.
//
// A pixel that shows a material sends a ray of each effect that the material calls for (sendsRays()). How
// much of the picture shows a material is taken from its primitives' expected hits (gltf/expected_hits.h): a
// surface that rays find is one that is seen. What is hit has the shares of the plan's cases, as counted by a
// profile or expected likewise.
#pragma once

#include "plan/plan.h"
#include "plan/strategy_cost.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace glint {

// Pixels that show a surface, and rays of effects that hit one. Choices: of outdoor scenes less, of rooms
// all. They scale the times of every strategy alike but for the launches.
inline constexpr double kSurfaceShare = 0.8;
inline constexpr double kRayHitShare = 0.7;

// How alike the hits of neighbouring rays are (Round::coherence). Choices between what the calibration's
// coherent scenes (mirrors) and incoherent ones (diffuse rays) are found to be, which is near 1 and 0.
inline constexpr double kMirrorCoherence = 0.9;      // neighbours meet one surface until its border
inline constexpr double kGlossyCoherence = 0.5;      // a lobe that is some ten degrees wide
inline constexpr double kRefractionCoherence = 0.7;  // bent and scattered by what lies between
inline constexpr double kDiffuseCoherence = 0.1;     // any direction of a hemisphere; a large floor is alike
// Rougher surfaces are glossy: the default of FrameOptions::mirrorRoughness.
inline constexpr float kMirrorRoughness = 0.05F;

struct FrameShape {
    double pixels = 1920.0 * 1080.0;  // times samples; what is compiled for a size that is not known
    std::uint32_t effects = 0;        // Effect bits
    float maxReflectionRoughness = 0.3F;
    bool batchEffects = false;  // all effects' rays are one list
};

// Which features the shader of a case has; a retired one has none, and no code.
struct CaseFeatures {
    FeatureMask always = 0;
    FeatureMask sometimes = 0;
    bool retired = false;
};
std::vector<CaseFeatures> caseFeatures(const Plan& plan);

// Hits that go to a case, in proportion to others.
struct CaseHits {
    int shaderId = 0;  // of a case that is not retired
    double hits = 0.0;
};
// Of the primitives of the plan with indices from `first` on, as many as `primitives` has: as counted by the
// profile where options has hits, else as the primitives expect them.
std::vector<CaseHits> caseHits(const Plan& plan, const PlanOptions& options,
                               std::span<const PrimitiveInputs> primitives, std::size_t first);

// Every case that is not retired, with its share of the hits and its estimated code; equal shares where
// nothing is known. `cases`: by shader ID.
std::vector<RoundCase> roundCases(std::span<const CaseFeatures> cases, std::span<const CaseHits> hits);

// A round for each effect that sends rays, in the order of package::kEffects, or one for all. `primitives`:
// those of a scene, with materials that index `materials`.
std::vector<Round> frameRounds(std::span<const Material> materials,
                               std::span<const PrimitiveInputs> primitives,
                               const std::vector<RoundCase>& cases, const FrameShape& shape);

}  // namespace glint
