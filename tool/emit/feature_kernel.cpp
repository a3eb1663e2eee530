#include "emit/feature_kernel.h"

#include "emit/context.h"
#include "emit/glsl/passes.h"
#include "emit/material_code.h"
#include "emit/sources.h"
#include "spirv/compiler.h"

#include <utility>

namespace glint::compiler {

namespace {

constexpr const char* kTemplate = "check_features.comp.mustache";
constexpr const char* kName = "check_features.comp";

static_assert(sizeof(FeatureKernelInput) == 14 * sizeof(std::uint32_t));
static_assert(sizeof(FeatureKernelOutput) == 28 * sizeof(float));

std::vector<const materials::FeatureCode*> layersOf(const Plan& plan) {
    const materials::FeatureMask used = plan.primaryAlways | plan.primarySometimes;
    std::vector<const materials::FeatureCode*> layers;
    for (const materials::FeatureCode& code : plan.model->code) {
        if (!code.layer.empty() &&
            (plan.model->features[static_cast<std::size_t>(code.feature)].mask() & used) != 0) {
            layers.push_back(&code);
        }
    }
    return layers;
}

}  // namespace

Result<FeatureKernel> compileFeatureKernel(const Build& build) {
    const Plan& plan = build.plan;
    const CompileSettings& settings = build.settings.compile;
    GLINT_TRY(auto sources, makeSourceSet(*build.scenes, plan, settings));
    FeatureKernel kernel;
    kainjow::mustache::data layers(kainjow::mustache::data::type::list);
    for (const materials::FeatureCode* const layer : layersOf(plan)) {
        kernel.layers.push_back(layer->name);
        kainjow::mustache::data entry;
        entry.set("name", layer->name);
        entry.set("macro", plan.model->features[static_cast<std::size_t>(layer->feature)].macro);
        entry.set("lobe", std::to_string(kernel.layers.size()));
        layers.push_back(std::move(entry));
    }
    kainjow::mustache::data context;
    context.set("layers", layers);
    context.set("wordsIn", std::to_string(sizeof(FeatureKernelInput) / sizeof(std::uint32_t)));
    context.set("wordsOut", std::to_string(sizeof(FeatureKernelOutput) / sizeof(float)));
    GLINT_TRY(const auto text, renderTemplate(sources, kTemplate, context));
    GLINT_TRY(const auto glsl, flatten(kName, text, sources.lookup(), FlattenSide::Glsl));
    Result<std::vector<std::uint32_t>> words =
        compileShader({kName, ShaderStage::Compute, dropUnused(glsl).withPlaces(), {}}, {});
    if (!words) {
        return explainGlslError(words.error(), *plan.model, settings.host);
    }
    kernel.spirv = std::move(*words);
    return kernel;
}

}  // namespace glint::compiler
