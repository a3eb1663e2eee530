// The checks of one feature, and its evaluation on the device.
#pragma once

#include "emit/feature_kernel.h"
#include "measure/features/combinations.h"
#include "measure/features/integrals.h"

#include <glint/context.h>
#include <glint/internal/scene_kernel.h>
#include <glint/measure/check_materials.h>
#include <glint/session/session.h>

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace glint::measure {

class FeatureEvaluator {
public:
    // Compiles the scene as pictures of it would be, and the kernel. Reports the device. Has the errors of
    // compilePackage(), Context::createHeadless() and GpuScene::upload().
    static Result<std::unique_ptr<FeatureEvaluator>> create(const gltf::Scene& scene,
                                                            const CheckMaterialsOptions& options,
                                                            const Observer& observer);

    // Returns the number of a layer for FeatureKernelInput::lobe; 0, the whole BSDF, if there is no such
    // layer.
    std::uint32_t lobeOf(const std::string& layer) const;
    // Has the errors of SceneKernel::run().
    Result<std::vector<compiler::FeatureKernelOutput>> run(
        std::span<const compiler::FeatureKernelInput> inputs) const;
    std::string deviceName() const;
    // Has the errors of checkValidation().
    Status validate(const Observer& observer) const;

private:
    FeatureEvaluator() = default;

    std::unique_ptr<Context> context_;
    session::DeviceScene scene_;
    std::unique_ptr<SceneKernel> kernel_;
    std::vector<std::string> layers_;
};

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
