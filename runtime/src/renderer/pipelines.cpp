#include "renderer/pipelines.h"

#include "context/device_objects.h"
#include "context/shader_modules.h"
#include "context/vulkan_table.h"
#include "frame/frame_resources.h"
#include "renderer/background_pipelines.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <functional>
#include <iterator>
#include <map>
#include <memory>
#include <utility>

namespace glint {
namespace {

using package::ModuleRole;

// Returns the part of the package's shape that decides which of its modules the choice needs.
package::PackageShape chosenShape(const Package& package, const PipelineChoice& choice) {
    package::PackageShape shape = package.shape();
    shape.strategies = choice.strategy;
    shape.tracers = choice.tracer;
    shape.deforms = false;  // the scene has that pass itself
    shape.maxBounces = choice.bounces;
    return shape;
}

// Returns the time at which pipelines of that role are made.
PipelineTurn turnOf(const PipelineChoice& choice, package::ModuleRole role) {
    // The hit shaders of a ray generation shader's pipeline have the code of its strategy's cases.
    const package::RoleInfo& info = *package::findRole(role);
    if (choice.background &&
        (info.fallback != ModuleRole::None || info.kind == package::ShaderKind::RayGeneration)) {
        return PipelineTurn::Case;
    }
    // A draft is rasterised, shaded and composed.
    const bool isOfDraft = info.purpose == package::Purpose::Draft || role == ModuleRole::Compose;
    return choice.draft && !isOfDraft ? PipelineTurn::Fixed : PipelineTurn::First;
}

// Returns whether the choice needs a pipeline of a fallback's role. It is true for other roles.
bool runsFallback(const PipelineChoice& choice, package::ModuleRole role) {
    // A fallback with a pass shades hits whose shader ID no case has. Shaders with a switch contain the
    // fallback.
    const package::RoleInfo& info = *package::findRole(role);
    return choice.background || info.purpose != package::Purpose::Fallback ||
           info.over != package::Over::Nothing;
}

SpirvWords rayWords(const Package& package, ModuleRole role, std::uint32_t index = 0) {
    return package.spirv({role, index, package::kTracerRayPipeline});
}

// Returns the source of passes that only trace. Other passes shade the hits of their rays.
RayPipelineSource tracingSource(const Package& package, SpirvWords rayGeneration) {
    RayPipelineSource source;
    source.rayGeneration = rayGeneration;
    source.miss = {rayWords(package, ModuleRole::TraceMiss)};
    source.closestHit = {rayWords(package, ModuleRole::TraceClosestHit)};
    source.anyHit = rayWords(package, ModuleRole::TraceAnyHit);
    return source;
}

// The roles of a strategy with a pipeline of its own.
struct HitShaderRoles {
    ModuleRole rayGeneration{};
    ModuleRole caseHit{};     // closest hit of a case
    ModuleRole unknownHit{};  // of a geometry whose shader ID no case has
    ModuleRole fallbackHit{};
    ModuleRole miss{};
    ModuleRole anyHit{};
};

HitShaderRoles hitShaderRoles(package::Strategy strategy) {
    HitShaderRoles roles;
    for (const package::RoleInfo& info : package::rolesOf(strategy)) {
        switch (info.kind) {
            case package::ShaderKind::RayGeneration:
                roles.rayGeneration = info.role;
                break;
            case package::ShaderKind::ClosestHit:
                if (info.fallback != ModuleRole::None) {
                    roles.caseHit = info.role;
                    roles.fallbackHit = info.fallback;
                } else if (info.purpose != package::Purpose::Fallback) {
                    roles.unknownHit = info.role;
                }
                break;
            case package::ShaderKind::Miss:
                roles.miss = info.role;
                break;
            case package::ShaderKind::AnyHit:
                roles.anyHit = info.role;
                break;
            default:
                break;
        }
    }
    return roles;
}

// Returns the source of a pipeline of a strategy's own, without closest-hit shaders.
RayPipelineSource hitShaderStart(const Package& package, const HitShaderRoles& roles) {
    RayPipelineSource source;
    source.rayGeneration = rayWords(package, roles.rayGeneration);
    // The miss indices are those of rays in the list and of shadow rays, in this order.
    source.miss = {rayWords(package, roles.miss), rayWords(package, ModuleRole::TraceMiss)};
    source.anyHit = rayWords(package, package.shape().shadowsApart ? roles.anyHit : ModuleRole::TraceAnyHit);
    return source;
}

// Returns the source of a strategy's own pipeline. Each geometry has a record, with the hit group of its
// shader ID.
RayPipelineSource hitShaderSource(const Package& package, const HitShaderRoles& roles,
                                  std::span<const std::uint32_t> shaderIds) {
    RayPipelineSource source = hitShaderStart(package, roles);
    std::map<std::uint32_t, std::uint32_t> groups;  // by shader ID; retired ones have none
    std::map<const std::uint32_t*, std::uint32_t> byWords;
    for (std::uint32_t shaderId = 0; shaderId < package.caseCount(); ++shaderId) {
        const SpirvWords words = rayWords(package, roles.caseHit, shaderId);
        if (words.empty()) {
            continue;
        }
        const auto [known, fresh] =
            byWords.emplace(words.data(), static_cast<std::uint32_t>(source.closestHit.size()));
        if (fresh) {
            source.closestHit.push_back(words);
        }
        groups[shaderId] = known->second;
    }
    const auto unknown = static_cast<std::uint32_t>(source.closestHit.size());
    const SpirvWords fallback = rayWords(package, roles.fallbackHit);
    source.closestHit.push_back(fallback.empty() ? rayWords(package, roles.unknownHit) : fallback);
    for (const std::uint32_t shaderId : shaderIds) {
        const auto group = groups.find(shaderId);
        source.hitRecords.push_back(group != groups.end() ? group->second : unknown);
    }
    return source;
}

// Returns the number of SPIR-V words of all stages.
std::size_t wordCount(const RayPipelineSource& source) {
    std::size_t count = source.rayGeneration.size() + source.anyHit.size();
    for (const auto* const stages : {&source.miss, &source.closestHit}) {
        for (const SpirvWords words : *stages) {
            count += words.size();
        }
    }
    return count;
}

// Returns the stages that push constants are for.
VkShaderStageFlags pushStages(const Context::State& context) {
    return VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT | passStages(context);
}

Status createLayout(Context::State& context, const LayoutSource& source, Pipelines& pipelines) {
    if (source.given != VK_NULL_HANDLE) {
        pipelines.layout = source.given;
        pipelines.pushStages = source.givenPushStages;
        return okStatus();
    }
    GLINT_TRY(auto layout, createPassLayout(context, source.sets, sizeof(gpu::PushConstants)));
    pipelines.pushStages = pushStages(context);
    pipelines.layout = layout.get();
    pipelines.ownLayout = std::make_shared<const UniquePipelineLayout>(std::move(layout));
    return okStatus();
}

// Shaders fetch vertices by address, so there is no vertex input. Depth is reversed. Each draw sets its front
// face.
Result<UniquePipeline> createGBuffer(Context::State& context, const Package& package, VkPipelineLayout layout,
                                     PipelineCreation& creation) {
    GLINT_TRY(auto vertex, createShaderModule(context, package.spirv({ModuleRole::GBufferVertex})));
    GLINT_TRY(auto fragment, createShaderModule(context, package.spirv({ModuleRole::GBufferFragment})));
    const std::array stages{stageOf(VK_SHADER_STAGE_VERTEX_BIT, vertex.get()),
                            stageOf(VK_SHADER_STAGE_FRAGMENT_BIT, fragment.get())};
    VkPipelineVertexInputStateCreateInfo vertexInput{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    VkPipelineInputAssemblyStateCreateInfo assembly{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
        .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST};
    VkPipelineViewportStateCreateInfo viewport{.sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO,
                                               .viewportCount = 1,
                                               .scissorCount = 1};
    VkPipelineRasterizationStateCreateInfo raster{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO, .lineWidth = 1.0F};
    VkPipelineMultisampleStateCreateInfo multisample{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
        .rasterizationSamples = VK_SAMPLE_COUNT_1_BIT};
    VkPipelineDepthStencilStateCreateInfo depth{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO,
        .depthTestEnable = VK_TRUE,
        .depthWriteEnable = VK_TRUE,
        .depthCompareOp = VK_COMPARE_OP_GREATER};
    VkPipelineColorBlendAttachmentState attachment{.colorWriteMask =
                                                       VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT};
    VkPipelineColorBlendStateCreateInfo blend{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO,
        .attachmentCount = 1,
        .pAttachments = &attachment};
    constexpr VkDynamicState kDynamic[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR,
                                           VK_DYNAMIC_STATE_CULL_MODE, VK_DYNAMIC_STATE_FRONT_FACE};
    VkPipelineDynamicStateCreateInfo dynamic{.sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO,
                                             .dynamicStateCount = std::size(kDynamic),
                                             .pDynamicStates = kDynamic};
    VkPipelineRenderingCreateInfo rendering{.sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO,
                                            .colorAttachmentCount = 1,
                                            .pColorAttachmentFormats = &kSurfaceFormat,
                                            .depthAttachmentFormat = kDepthFormat};

    const VkPipelineCreationFeedbackCreateInfo feedback = feedbackOf(creation, stages.size());
    rendering.pNext = &feedback;

    VkGraphicsPipelineCreateInfo info{.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
                                      .pNext = &rendering,
                                      .flags = creation.flags,
                                      .stageCount = stages.size(),
                                      .pStages = stages.data(),
                                      .pVertexInputState = &vertexInput,
                                      .pInputAssemblyState = &assembly,
                                      .pViewportState = &viewport,
                                      .pRasterizationState = &raster,
                                      .pMultisampleState = &multisample,
                                      .pDepthStencilState = &depth,
                                      .pColorBlendState = &blend,
                                      .pDynamicState = &dynamic,
                                      .layout = layout};
    VkPipeline pipeline = VK_NULL_HANDLE;
    const VkResult result = context.vk.CreateGraphicsPipelines(
        context.handles.device, context.pipelineCache, 1, &info, context.services.allocation, &pipeline);
    return ownPipeline(context, creation, "vkCreateGraphicsPipelines", result, pipeline);
}

bool isGraphics(const package::RoleInfo& info) {
    return info.kind == package::ShaderKind::Vertex || info.kind == package::ShaderKind::Fragment;
}

// Returns whether the choice runs a module of its shape.
bool runs(const Package& package, const PipelineChoice& choice, const package::RoleInfo& info,
          const package::ModuleKey& key) {
    if (info.repeated == package::Repeated::ByOrdering) {
        return key.index == static_cast<std::uint32_t>(choice.ordering);
    }
    if (key.role == ModuleRole::BucketOffset) {
        return package.passes() == package::Passes::Frame || choice.ordering != package::Ordering::TileSort;
    }
    if (!runsFallback(choice, key.role) || (info.purpose == package::Purpose::Draft && !choice.draft)) {
        return false;
    }
    return key.role != ModuleRole::OrderCheck || choice.checksOrder;
}

// Plans the pipelines of a choice.
class Planner {
public:
    // `shaderIds` are those of the scene's geometry records, in their order.
    Planner(Context::State& context, const Package& package, const PipelineChoice& choice,
            std::span<const std::uint32_t> shaderIds, VkPipelineLayout layout)
        : context_(context), package_(package), choice_(choice), shaderIds_(shaderIds), layout_(layout) {}

    std::vector<PlannedPipeline> plan() {
        if (package_.passes() == package::Passes::Frame) {
            addGBuffer();
        }
        for (const bool generatesRays : {false, true}) {
            for (const package::ModuleKey& key : package::requiredModules(chosenShape(package_, choice_))) {
                const package::RoleInfo& info = *package::findRole(key.role);
                if (hasPass(info) && (key.tracer == package::kTracerRayPipeline) == generatesRays &&
                    runs(package_, choice_, info, key)) {
                    add(info, key);
                }
            }
        }
        return std::move(plan_);
    }

private:
    // Returns whether a pipeline is named after modules of the role. They may be part of those of others.
    static bool hasPass(const package::RoleInfo& info) {
        return !isGraphics(info) && info.kind != package::ShaderKind::ClosestHit &&
               info.kind != package::ShaderKind::AnyHit && info.kind != package::ShaderKind::Miss;
    }

    void addGBuffer() {
        const SpirvWords vertex = package_.spirv({ModuleRole::GBufferVertex});
        const SpirvWords fragment = package_.spirv({ModuleRole::GBufferFragment});
        plan_.push_back(
            {{"GBuffer", vertex.size() + fragment.size(),
              [&context = context_, &package = package_, layout = layout_](PipelineCreation& creation) {
                  return createGBuffer(context, package, layout, creation);
              },
              identify(package_, VK_PIPELINE_BIND_POINT_GRAPHICS, 0, {vertex, fragment})},
             {{ModuleRole::GBufferVertex}}});
    }

    // Modules that share their words share a pipeline. Cases that differ have one each, so that threads can
    // make several at once: one pipeline for all took a driver six times as long for 256 cases
    // (docs/live.md).
    void add(const package::RoleInfo& info, const package::ModuleKey& key) {
        const PipelineTurn turn = turnOf(choice_, key.role);
        if (info.kind == package::ShaderKind::RayGeneration) {
            addHitShaders(key, turn);
            return;
        }
        const SpirvWords words = package_.spirv(key);
        const auto [known, fresh] = byWords_.emplace(words.data(), plan_.size());
        if (!fresh) {
            PlannedPipeline& shared = plan_[known->second];
            shared.keys.push_back(key);
            shared.turn = std::min(shared.turn, turn);
        } else if (key.tracer == package::kTracerRayPipeline) {
            addRays(pipelineName(package_, key), key, tracingSource(package_, words), turn);
        } else {
            addCompute(key, words, turn);
        }
    }

    void addCompute(const package::ModuleKey& key, SpirvWords words, PipelineTurn turn) {
        const std::uint32_t threads = chosenThreads(context_.limits, key, package_.bucketCount());
        plan_.push_back({{pipelineName(package_, key), words.size(),
                          withSettings(threads,
                                       [&context = context_, words, layout = layout_](auto& creation) {
                                           return createComputePipeline(context, words, layout, creation);
                                       }),
                          identify(package_, VK_PIPELINE_BIND_POINT_COMPUTE, threads, {words})},
                         {key},
                         {},
                         turn});
    }  // NOLINT(clang-analyzer-cplusplus.NewDeleteLeaks): std::function owns what it copies

    // The source points into the package.
    void addRays(std::string name, const package::ModuleKey& key, RayPipelineSource source,
                 PipelineTurn turn) {
        const auto rays = std::make_shared<const RayPipelineSource>(std::move(source));
        plan_.push_back({{std::move(name), wordCount(*rays),
                          withSettings(0,
                                       [&context = context_, rays, layout = layout_](auto& creation) {
                                           return createRayPipeline(context, layout, *rays, creation);
                                       }),
                          identify(package_, *rays)},
                         {key},
                         rays,
                         turn});
    }

    // Plans a strategy's own pipeline, and before it one with the fallback for every hit, if that is drawn
    // with meanwhile.
    void addHitShaders(const package::ModuleKey& key, PipelineTurn turn) {
        const HitShaderRoles roles = hitShaderRoles(choice_.strategy);
        if (choice_.background) {
            RayPipelineSource fallback = hitShaderStart(package_, roles);
            fallback.closestHit = {rayWords(package_, roles.fallbackHit)};
            addRays(pipelineName(package_, {roles.fallbackHit, 0, key.tracer}), key, std::move(fallback),
                    choice_.draft ? PipelineTurn::Fixed : PipelineTurn::First);
        }
        addRays(pipelineName(package_, key), key, hitShaderSource(package_, roles, shaderIds_), turn);
    }

    // Returns a job's function that calls create(creation) with the settings of the choice.
    template <typename Create>
    std::function<Result<UniquePipeline>(PipelineCreation&)> withSettings(std::uint32_t threads,
                                                                          const Create& create) const {
        return [create, constants = ShaderConstants{threads, choice_.countsLight},
                half = choice_.halfPicture](PipelineCreation& creation) {
            creation.constants = constants;
            creation.halfPicture = half;
            return create(creation);
        };
    }

    Context::State& context_;
    const Package& package_;
    const PipelineChoice& choice_;
    std::span<const std::uint32_t> shaderIds_;
    VkPipelineLayout layout_;
    std::vector<PlannedPipeline> plan_;
    std::map<const std::uint32_t*, std::size_t> byWords_;  // places in `plan_`
};

// Error "module-features" for the first module that the choice runs and the device can't.
Status checkFeatures(const Context::State& context, const Package& package, const PipelineChoice& choice) {
    for (const package::ModuleKey& key : package::requiredModules(chosenShape(package, choice))) {
        const package::RoleInfo& info = *package::findRole(key.role);
        const bool compute = !isGraphics(info) && key.tracer != package::kTracerRayPipeline;
        if (compute && !runs(package, choice, info, key)) {
            continue;
        }
        for (const std::string& feature : package::featuresOf(package.spirv(key))) {
            if (std::ranges::find(context.features, feature) == context.features.end()) {
                return makeError("module-features", "",
                                 "the module " + pipelineName(package, key) + " needs " + feature +
                                     ", which the device lacks or was not created with",
                                 "use another device, or compile the package without what needs it; "
                                 "manifest.json has the features of each module");
            }
        }
    }
    return okStatus();
}

}  // namespace

std::vector<PlannedPipeline> planPipelines(Context::State& context, const Package& package,
                                           const PipelineChoice& choice,
                                           std::span<const std::uint32_t> shaderIds,
                                           VkPipelineLayout layout) {
    return Planner(context, package, choice, shaderIds, layout).plan();
}

Status addPipeline(Context::State& context, const PlannedPipeline& planned, MadePipeline made,
                   Pipelines& pipelines) {
    PassPipeline pass{.pipeline = made.handle->get()};
    if (planned.rays != nullptr) {
        GLINT_TRY(auto table, createTable(context, pipelines.pool, pass.pipeline, *planned.rays));
        pass = {pass.pipeline, true, table.rayGeneration, table.miss, table.hit};
        pipelines.tables.push_back(std::move(table.buffer));
    }
    pipelines.owned.push_back(std::move(made));
    for (const package::ModuleKey& key : planned.keys) {
        if (key.role == ModuleRole::GBufferVertex) {
            pipelines.gbuffer = pass.pipeline;
        } else {
            pipelines.add(key, pass);
        }
    }
    return okStatus();
}

void addFallback(const Package& package, const PipelineChoice& choice, Pipelines& pipelines) {
    if (!choice.background) {
        return;
    }
    for (const package::RoleInfo& info : package::roles()) {
        const auto made = pipelines.passes.find(info.fallback);
        if ((info.strategies & choice.strategy) == 0 || made == pipelines.passes.end()) {
            continue;
        }
        if (info.over != package::Over::Buckets) {
            pipelines.passes[info.role] = made->second;
            continue;
        }
        for (std::uint32_t id = 0; id < package.caseCount(); ++id) {
            // A retired shader ID has no hits and no pipeline.
            if (package.cases()[id].keyCount > 0) {
                pipelines.add({info.role, id}, made->second);
            }
        }
    }
}

bool hasUnknown(const Package& package, std::span<const std::uint32_t> shaderIds) {
    return package.shape().fallback && std::ranges::any_of(shaderIds, [&](std::uint32_t id) {
               return id >= package.caseCount() || package.cases()[id].keyCount == 0;
           });
}

void Pipelines::makeRoom(const Package& made, package::Strategy strategy) {
    for (const package::RoleInfo& info : package::roles()) {
        if (info.over == package::Over::Buckets && (info.strategies & strategy) != 0) {
            cases[info.role].resize(made.caseCount());
        }
    }
}

void Pipelines::add(const package::ModuleKey& key, const PassPipeline& pass) {
    const package::RoleInfo& info = *package::findRole(key.role);
    const package::Repeated repeated = info.repeated;
    if (info.over == package::Over::Buckets) {
        cases.at(key.role)[key.index] = pass;
    } else if (repeated == package::Repeated::ByEffect || repeated == package::Repeated::ByWalk) {
        effectPasses[{key.role, key.index}] = pass;
    } else {
        passes[key.role] = pass;
    }
}

std::string pipelineName(const Package& package, const package::ModuleKey& key) {
    const package::RoleInfo& info = *package::findRole(key.role);
    std::string name(info.name);
    switch (info.repeated) {
        case package::Repeated::Once:
            return name;
        case package::Repeated::ByCase:
            return name + " " + std::string(package.string(package.cases()[key.index].name));
        case package::Repeated::ByOrdering:
            return name + " " + std::string(nameOf(static_cast<package::Ordering>(key.index)));
        case package::Repeated::ByEffect:
        case package::Repeated::ByWalk:
            for (const package::EffectInfo& effect : package.effects()) {
                if (package::effectNumber(effect.effect) == key.index) {
                    return name + " " + std::string(effect.name);
                }
            }
            break;
    }
    return name;
}

Result<UniquePipelineLayout> createPassLayout(Context::State& context,
                                              std::span<const VkDescriptorSetLayout> sets,
                                              std::uint32_t pushBytes) {
    return createPipelineLayout(context, sets, {pushStages(context), 0, pushBytes});
}

namespace {

VkPipelineCreateFlags flagsOf(const PipelineMaking& making) {
    return making.captureStatistics ? VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR : 0;
}

}  // namespace

Result<std::vector<BackgroundPipelines::Done>> makeNow(std::vector<PlannedPipeline> plan,
                                                       const PipelineMaking& making) {
    std::vector<PipelineJob> jobs;
    std::ranges::transform(plan, std::back_inserter(jobs), &PlannedPipeline::job);
    GLINT_TRY(auto made, makePipelines(jobs, flagsOf(making), pipelineThreads(making.threads, jobs.size())));
    std::vector<BackgroundPipelines::Done> done;
    for (std::size_t i = 0; i < plan.size(); ++i) {
        done.push_back({std::move(plan[i]), std::move(made[i])});
    }
    return done;
}

std::unique_ptr<BackgroundPipelines> makeLater(Context::State& context, std::vector<PlannedPipeline> plan,
                                               const PipelineMaking& making) {
    // One thread is the caller's.
    const std::uint32_t threads = pipelineThreads(making.threads, plan.size() + 1);
    return std::make_unique<BackgroundPipelines>(context.jobs, std::move(plan), flagsOf(making),
                                                 std::max(threads, 2U) - 1);
}

Result<Pipelines> createPipelines(Context::State& context, const Package& package,
                                  const PipelineChoice& choice, const PipelineMaking& making,
                                  std::span<const std::uint32_t> shaderIds, const LayoutSource& source) {
    const auto start = std::chrono::steady_clock::now();
    GLINT_TRY_DO(checkFeatures(context, package, choice));
    Pipelines pipelines(context);
    GLINT_TRY_DO(createLayout(context, source, pipelines));
    std::vector<PlannedPipeline> plan = planPipelines(context, package, choice, shaderIds, pipelines.layout);
    const auto later = std::stable_partition(plan.begin(), plan.end(), [](const PlannedPipeline& planned) {
        return planned.turn == PipelineTurn::First;
    });
    std::vector<PlannedPipeline> laterPlan(std::make_move_iterator(later),
                                           std::make_move_iterator(plan.end()));
    plan.erase(later, plan.end());
    pipelines.threads = pipelineThreads(making.threads, plan.size());
    pipelines.captureStatistics = making.captureStatistics;
    GLINT_TRY(auto made, makeNow(std::move(plan), making));
    pipelines.makeRoom(package, choice.strategy);
    for (BackgroundPipelines::Done& done : made) {
        GLINT_TRY_DO(addPipeline(context, done.planned, std::move(done.made), pipelines));
    }
    pipelines.draft = choice.draft;
    pipelines.drafted = &package;
    pipelines.choice = choice;
    if (!pipelines.draft) {
        addFallback(package, choice, pipelines);
    }
    pipelines.shadesUnknown = hasUnknown(package, shaderIds);
    if (!laterPlan.empty()) {
        pipelines.background = makeLater(context, std::move(laterPlan), making);
    }
    const std::chrono::duration<double, std::milli> elapsed = std::chrono::steady_clock::now() - start;
    pipelines.creationMs = elapsed.count();
    return pipelines;
}

namespace {

// Lets the passes use pipelines that were made. After an error those that are left wait for the next call.
Status useMade(Context::State& context, std::vector<BackgroundPipelines::Done> made, Pipelines& pipelines) {
    for (auto done = made.begin(); done != made.end(); ++done) {
        if (Status status = addPipeline(context, done->planned, done->made, pipelines); !status) {
            made.erase(made.begin(), done);
            pipelines.background->putBack(std::move(made));
            return status;
        }
    }
    return okStatus();
}

}  // namespace

Status adoptPipelines(Context::State& context, Pipelines& pipelines) {
    if (!pipelines.background) {
        return okStatus();
    }
    std::size_t most = pipelines.adoptedAtOnce;
    if (pipelines.draft && most > 0) {
        std::vector<BackgroundPipelines::Done> fixed = pipelines.background->takeFixed();
        if (fixed.empty()) {
            return okStatus();
        }
        // The fixed passes take the place of the draft together.
        GLINT_TRY_DO(useMade(context, std::move(fixed), pipelines));
        pipelines.draft = false;
        addFallback(*pipelines.drafted, pipelines.choice, pipelines);
        --most;
    }
    return pipelines.draft ? okStatus() : useMade(context, pipelines.background->take(most), pipelines);
}

}  // namespace glint
