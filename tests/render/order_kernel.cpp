#include "render/order_kernel.h"

#include "context/context.h"
#include "context/shader_modules.h"
#include "context/vulkan_table.h"
#include "emit/context.h"
#include "emit/modules.h"
#include "renderer/pipeline_jobs.h"
#include "support/effect_bits.h"
#include "support/shared_modules.h"

#include <fmt/format.h>

#include <algorithm>

namespace glint::testing {

namespace {

using package::ModuleRole;

constexpr ModuleRole kRoles[] = {ModuleRole::RayDispatch, ModuleRole::BucketCount, ModuleRole::BucketOffset,
                                 ModuleRole::BucketCopy, ModuleRole::OrderCheck};

// Each thread copies 16 bytes from one address to another.
constexpr const char* kPlainCopy = R"(#version 460
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
layout(local_size_x = 256) in;
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer Words { uvec4 data[]; };
layout(push_constant, scalar) uniform Push {
    Words from;
    Words to;
    uint vectors;
} pushed;
void main() {
    uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    uint index = group * 256u + gl_LocalInvocationIndex;
    if (index < pushed.vectors) {
        pushed.to.data[index] = pushed.from.data[index];
    }
}
)";

// Compiles the modules of a plan with that many cases, whatever they shade.
Result<std::vector<compiler::CompiledModule>> compileOrdering(std::uint32_t caseCount,
                                                              package::HitRecordFormat hitRecord) {
    compiler::Plan plan;
    plan.keys.resize(1);
    for (std::uint32_t i = 0; i < caseCount; ++i) {
        compiler::Case shaderCase;
        shaderCase.shaderId = static_cast<int>(i);
        // All others are retired: they have a bucket, and no code that would have to be put together.
        if (i == 0) {
            shaderCase.keys = {0};
        }
        shaderCase.name = fmt::format("Case{}", i);
        plan.cases.push_back(std::move(shaderCase));
    }
    // Without an effect that sends rays nothing is ordered.
    plan.effects.effects.add({package::kEffectReflection, package::EffectInfo::Kind::Rays});
    const gltf::Scene scene;
    const gltf::SceneList scenes({&scene, 1});
    compiler::CompileSettings settings;
    settings.strategies = package::kStrategySortedUber;
    settings.hitRecord = hitRecord;
    GLINT_TRY(auto sources, makeSourceSet(scenes, plan, settings));
    GLINT_TRY(auto modules,
              makeModuleSources(scenes, plan, std::make_shared<const compiler::SourceSet>(std::move(sources)),
                                settings));
    std::erase_if(modules, [](const compiler::ModuleSource& module) {
        return std::ranges::find(kRoles, module.key.role) == std::end(kRoles);
    });
    return compileModules(std::move(modules), 0, {}, &sharedModules());
}

}  // namespace

Result<std::unique_ptr<OrderKernel>> OrderKernel::create(Context& context, std::uint32_t caseCount,
                                                         package::HitRecordFormat hitRecord) {
    std::unique_ptr<OrderKernel> kernel(new OrderKernel(context.state(), caseCount, hitRecord));
    GLINT_TRY_DO(kernel->createPipelines());
    GLINT_TRY(kernel->timer_, Timer::create(context.state(), kTimesOfRun * kMaxCopies));
    GLINT_TRY(kernel->runner_, CommandRunner::create(context.state()));
    return kernel;
}

Status OrderKernel::createPipelines() {
    const VkPushConstantRange range{VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(gpu::PushConstants)};
    GLINT_TRY(layout_, createPipelineLayout(context_, {}, range));
    GLINT_TRY(const auto modules, compileOrdering(caseCount_, hitRecord_));
    for (const compiler::CompiledModule& module : modules) {
        PipelineCreation creation;
        creation.constants.threads = chosenThreads(context_.limits, module.key, caseCount_ + 1);
        GLINT_TRY(auto pipeline, createComputePipeline(context_, module.spirv, layout_.get(), creation));
        pipelines_.emplace(module.key, std::move(pipeline));
    }
    GLINT_TRY(const auto copy, compileComputeOnce("plain copy", kPlainCopy));
    GLINT_TRY(plainCopy_, createComputePipeline(context_, copy, layout_.get()));
    return okStatus();
}

}  // namespace glint::testing
