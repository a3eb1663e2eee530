// The checks of one feature. Each returns its outcome, and the place where it came closest to its limit.
#pragma once

#include "measure/features/combinations.h"
#include "measure/features/evaluator.h"
#include "measure/features/hemispheres.h"

#include <glint/measure/check_materials.h>

#include <cstdint>
#include <vector>

namespace glint::measure {

// One feature on the device.
struct FeatureOnDevice {
    const FeatureEvaluator& evaluator;
    const CheckedScene& scene;
    const CheckedFeature& feature;
    std::uint32_t lobe = 0;     // of FeatureKernelInput
    std::uint32_t samples = 0;  // directions for each combination and view
};

// Checks that all results of functions are finite and within their ranges, for directions and numbers at the
// ends of the permitted ones. Errors here and below are those of FeatureEvaluator::run().
Result<CheckOutcome> checkRanges(const FeatureOnDevice& on);

// Checks reciprocity: that layers which claim it give the same value if view and light are exchanged.
Result<CheckOutcome> checkReciprocity(const FeatureOnDevice& on);

// Density, samples, energy and albedo, from integrals over all directions.
struct IntegralOutcomes {
    CheckOutcome density;
    CheckOutcome samples;
    CheckOutcome energy;
    CheckOutcome albedo;
};
Result<IntegralOutcomes> checkIntegrals(const FeatureOnDevice& on);

// A lobe over all directions for three views, and a sphere in a white furnace.
Result<std::vector<FeaturePicture>> paintFeature(const FeatureOnDevice& on);

// The direction to +Z under so many radians, at an azimuth.
Direction tiltedDirection(double angle, double azimuth);
// Numbers in [0, 1) that are the same on every machine: two or three for each index.
std::array<double, 3> randomNumbers(std::uint64_t index, std::uint32_t stream);
// Makes the input for one evaluation. `light` is in the frame of the surface, `view` in the world.
compiler::FeatureKernelInput inputOf(const FeatureOnDevice& on, const CheckedMaterial& material,
                                     const Direction& view, const Direction& light);

}  // namespace glint::measure
