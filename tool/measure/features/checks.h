// The scene in which features are checked, a square for each combination of parameters; its evaluation on the
// device; and the checks of one feature.
#pragma once

#include "emit/feature_kernel.h"
#include "gltf/scene.h"
#include "materials/material_model.h"

#include <glint/context.h>
#include <glint/internal/scene_kernel.h>
#include <glint/measure/check_materials.h>
#include <glint/session/session.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace glint::measure {

using Direction = std::array<double, 3>;

// --- Integrals of lobes over all directions, by squares that are split where a lobe is sharp. Samples are
// compared with the squares' shares. They use only a lobe's values and samples ---

// The values of one lobe for one direction.
struct LobeValues {
    double density = 0.0;
    std::array<double, 3> reflected{};  // of the lobe, times the cosine
    std::array<double, 3> whole{};      // of the whole BSDF, times the cosine
};

// One direction at which one of the lobes is wanted.
struct LobeQuery {
    std::size_t lobe = 0;
    Direction direction{};
};
using LobeFunction = std::function<Result<std::vector<LobeValues>>(std::span<const LobeQuery>)>;

struct LobeIntegrals {
    double density = 0.0;
    std::array<double, 3> reflected{};
    std::array<double, 3> whole{};
    // The sum of the changes by the last splits: an upper estimate of the errors.
    double densityError = 0.0;
    double wholeError = 0.0;
    double lost = 0.0;  // share of the samples that have no direction
    // The probability of a deviation at least as large as this one, if samples follow the density.
    double significance = 1.0;
    std::uint64_t evaluations = 0;
};

// `samples` has the sampled directions of each lobe, (0, 0, 0) where there is none. Lobes without samples are
// integrated all the same. Has the errors of `function`.
Result<std::vector<LobeIntegrals>> integrateLobes(std::span<const std::vector<Direction>> samples,
                                                  const LobeFunction& function);

// --- The scene and its features ---

// The material on which a feature is checked.
struct CheckedMaterial {
    std::uint32_t geometry = 0;  // number of its square, and of its material
    int base = 0;                // index into kCheckedBases
    bool isTwoSided = false;     // It is seen from behind, too.
    CheckPlace place;            // parameters and base
};

struct CheckedFeature {
    const materials::FeatureCode* code = nullptr;
    std::vector<CheckedMaterial> materials;

    // Glint's own base, whose samples are checked like those of a lobe.
    bool isBase() const {
        return !code->isOfPack;
    }
};

// The materials below the features. Their colour is white, so that a gain of energy is visible.
struct CheckedBase {
    const char* name;
    float metallic;
    float roughness;
};
inline constexpr CheckedBase kCheckedBases[] = {{"white dielectric", 0.0F, 1.0F},
                                                {"white metal", 1.0F, 0.5F}};

struct CheckedScene {
    gltf::Scene scene;
    std::vector<CheckedFeature> features;
    std::vector<std::uint32_t> bases;  // the squares that have a base alone
};

// Makes a square with normals, tangents, UVs and all declared attributes for up to `combinations`
// combinations of the parameters of each feature of a pack, and for some of Glint's own base. Every third one
// is double-sided and blended, and has vertex colours and textures that read the second UV set. Combinations
// for which the feature changes nothing are left out. Error "check-unreachable" if none is left.
Result<CheckedScene> makeCheckedScene(const materials::MaterialModel& model, std::uint32_t combinations);

// The numbers at which a parameter is checked: a usual one, the least and the greatest; of a bool or an enum
// all.
std::vector<double> checkedValues(const materials::Parameter& parameter);

class FeatureEvaluator {
public:
    // Compiles the scene as pictures of it would be, and the kernel. Reports the device. Has the errors of
    // compilePackage(), Context::createHeadless() and GpuScene::upload().
    static Result<std::unique_ptr<FeatureEvaluator>> create(const gltf::Scene& scene,
                                                            const CheckMaterialsOptions& options,
                                                            const Observer& observer);

    // Returns the number of a layer or a model for FeatureKernelInput::lobe; 0, the whole BSDF, if the
    // feature is neither.
    std::uint32_t lobeOf(const std::string& feature) const;
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
    std::vector<std::string> lobes_;
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

// Checks reciprocity: that layers and models which claim it give the same value if view and light are
// exchanged.
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
