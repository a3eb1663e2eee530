// The shader with which `glint check-materials` evaluates the lobes of materials one by one.
#pragma once

#include "resolve/build.h"

#include <glint/result.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace glint::compiler {

// The words that a thread of the kernel reads: templates/check_features.comp.mustache has the same order.
// Vectors of the world are unit vectors; the surface's own frame has its normal as z.
struct FeatureKernelInput {
    std::uint32_t geometry = 0;
    std::uint32_t lobe = 0;  // 0: the whole BSDF; else 1 + an index into FeatureKernel::lobes
    std::uint32_t mode = 0;  // kKernelSamples, kKernelSwaps
    float place[2]{};        // barycentrics on the first triangle
    float view[3]{};         // in the world
    float light[3]{};        // in the frame of the surface
    float random[3]{};       // in [0, 1)
};
inline constexpr std::uint32_t kKernelSamples = 1;  // sampled and weight are wanted
inline constexpr std::uint32_t kKernelSwaps = 2;    // view and light change places

// The floats that it writes. A layer's members are those that shaders/bsdf/layer.glsl describes.
struct FeatureKernelOutput {
    float reflected[3]{};  // of the lobe, times the cosine
    float passed = 0.0F;
    float side = 0.0F;
    float density = 0.0F;
    float sampled[3]{};  // unit, or 0
    float albedo[3]{};   // what the layer says that it reflects of a white sky
    float whole[3]{};    // the whole BSDF times the cosine
    float emission[3]{};
    float view[3]{};    // in the frame of the surface, as the lobe gets it
    float weight[3]{};  // of a sample of the whole BSDF
    float albedoPassed = 0.0F;
    float roughness = 0.0F;
    float occlusion = 0.0F;
    float alpha = 0.0F;  // what the stage opacity makes of 1
};

struct FeatureKernel {
    std::vector<std::uint32_t> spirv;
    std::vector<std::string> lobes;  // names of the declarations of layers and models
};

// Compiles the kernel for the package of a build. Has the errors of compilePackage() that concern GLSL.
Result<FeatureKernel> compileFeatureKernel(const Build& build);

}  // namespace glint::compiler
