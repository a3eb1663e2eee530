// Evaluates the lobes of a scene's materials on the device.
#pragma once

#include "emit/feature_kernel.h"

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

}  // namespace glint::measure
