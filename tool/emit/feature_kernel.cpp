#include "emit/feature_kernel.h"

#include "emit/context.h"
#include "emit/glsl/passes.h"
#include "emit/material_code.h"
#include "spirv/compiler.h"

#include <utility>

namespace glint::compiler {

namespace {

constexpr const char* kKernelTemplate = "check_features.comp.mustache";
constexpr const char* kKernelName = "check_features.comp";

static_assert(sizeof(FeatureKernelInput) == 14 * sizeof(std::uint32_t));
static_assert(sizeof(FeatureKernelOutput) == 28 * sizeof(float));

std::vector<const materials::FeatureCode*> lobesOf(const Plan& plan) {
    const materials::FeatureMask used = plan.primaryAlways | plan.primarySometimes;
    std::vector<const materials::FeatureCode*> lobes;
    for (const materials::FeatureCode& code : plan.model->code) {
        if (!(code.layer.empty() && code.model.empty()) &&
            used.has(plan.model->features[static_cast<std::size_t>(code.feature)].bit)) {
            lobes.push_back(&code);
        }
    }
    return lobes;
}

}  // namespace

Result<FeatureKernel> compileFeatureKernel(const Build& build) {
    const Plan& plan = build.plan;
    const CompileSettings& settings = build.settings.compile;
    GLINT_TRY(auto sources, makeSourceSet(*build.scenes, plan, settings));
    FeatureKernel kernel;
    kainjow::mustache::data layers(kainjow::mustache::data::type::list);
    kainjow::mustache::data models(kainjow::mustache::data::type::list);
    for (const materials::FeatureCode* const lobe : lobesOf(plan)) {
        kernel.lobes.push_back(lobe->name);
        (lobe->model.empty() ? layers : models)
            .push_back(kainjow::mustache::object{
                {"name", lobe->name},
                {"has",
                 "GLINT_HAS_" + plan.model->features[static_cast<std::size_t>(lobe->feature)].macroEnd()},
                {"lobe", std::to_string(kernel.lobes.size())}});
    }
    kainjow::mustache::data context;
    context.set("layers", layers);
    context.set("models", models);
    context.set("wordsIn", std::to_string(sizeof(FeatureKernelInput) / sizeof(std::uint32_t)));
    context.set("wordsOut", std::to_string(sizeof(FeatureKernelOutput) / sizeof(float)));
    GLINT_TRY(const auto text, renderTemplate(sources, kKernelTemplate, context));
    GLINT_TRY(const auto glsl, flatten(kKernelName, text, sources.lookup(), FlattenSide::Glsl));
    Result<std::vector<std::uint32_t>> words =
        compileShader({kKernelName, ShaderStage::Compute, dropUnused(glsl).withPlaces(), {}}, {});
    if (!words) {
        return explainGlslError(words.error(), *plan.model, settings.host);
    }
    kernel.spirv = std::move(*words);
    return kernel;
}

}  // namespace glint::compiler
