#include "spirv/optimize.h"

#include <spirv-tools/libspirv.hpp>
#include <spirv-tools/optimizer.hpp>

#include <utility>

namespace glint {

namespace {

constexpr spv_target_env kTarget = SPV_ENV_VULKAN_1_2;

// Keeps the first error that SPIRV-Tools reports; the ones after it are mostly its consequences.
spvtools::MessageConsumer keepFirstError(std::string& message) {
    return [&message](spv_message_level_t level, const char*, const spv_position_t&, const char* text) {
        if (level <= SPV_MSG_ERROR && message.empty()) {
            message = text;
        }
    };
}

void registerPasses(spvtools::Optimizer& optimizer, bool keepNames) {
    if (!keepNames) {
        optimizer.RegisterPass(spvtools::CreateStripDebugInfoPass());
    }
    // What literals decide within a function goes before anything is inlined: inlining every lobe of the BSDF to drop
    // it afterwards takes several times as long.
    optimizer.RegisterPass(spvtools::CreateCCPPass())
        .RegisterPass(spvtools::CreateDeadBranchElimPass())
        .RegisterPass(spvtools::CreateBlockMergePass())
        .RegisterPass(spvtools::CreateEliminateDeadFunctionsPass());
    optimizer.RegisterPerformancePasses();
    // What the performance passes uncover late, folded once more: features are decided through two masks.
    optimizer.RegisterPass(spvtools::CreateCCPPass())
        .RegisterPass(spvtools::CreateSimplificationPass())
        .RegisterPass(spvtools::CreateDeadBranchElimPass())
        .RegisterPass(spvtools::CreateBlockMergePass())
        .RegisterPass(spvtools::CreateVectorDCEPass())
        .RegisterPass(spvtools::CreateAggressiveDCEPass())
        .RegisterPass(spvtools::CreateEliminateDeadConstantPass())
        .RegisterPass(spvtools::CreateCompactIdsPass());
}

}  // namespace

Result<std::vector<std::uint32_t>> optimizeSpirv(const std::vector<std::uint32_t>& words,
                                                 const std::string& name, bool keepNames) {
    std::string message;
    spvtools::Optimizer optimizer(kTarget);
    optimizer.SetMessageConsumer(keepFirstError(message));
    registerPasses(optimizer, keepNames);
    spvtools::ValidatorOptions layout;
    layout.SetScalarBlockLayout(true);
    spvtools::OptimizerOptions options;
    // The result is validated, which is where a defect of either side shows.
    options.set_run_validator(false);
    options.set_validator_options(layout);
    std::vector<std::uint32_t> optimized;
    if (!optimizer.Run(words.data(), words.size(), &optimized, options)) {
        return makeError(
            "spirv-optimize", name,
            "SPIRV-Tools can't optimise the shader: " + (message.empty() ? "no reason given" : message),
            "this is a defect of Glint; please report it with the scene");
    }
    return optimized;
}

Status validateSpirv(const std::vector<std::uint32_t>& words, const std::string& name) {
    std::string message;
    spvtools::SpirvTools tools(kTarget);
    tools.SetMessageConsumer(keepFirstError(message));
    spvtools::ValidatorOptions options;
    options.SetScalarBlockLayout(true);
    if (!tools.Validate(words.data(), words.size(), options)) {
        return makeError("spirv-validate", name,
                         "the SPIR-V is not valid: " + (message.empty() ? "no reason given" : message),
                         "this is a defect of Glint; please report it with the scene");
    }
    return okStatus();
}

}  // namespace glint
