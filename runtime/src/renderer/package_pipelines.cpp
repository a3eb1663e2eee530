// Makes all pipelines of a package, for reports.
#include "context/device_objects.h"
#include "context/vulkan_table.h"
#include "data/deformer.h"
#include "renderer/pipeline_jobs.h"
#include "renderer/pipelines.h"
#include "scene/gpu_scene_state.h"

#include <glint/internal/package_pipelines.h>

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

namespace glint {
namespace {

// Returns the options of a renderer for each strategy, tracer and ordering of the package.
std::vector<RendererOptions> allOptions(const Package& package) {
    std::vector<RendererOptions> list;
    for (const package::StrategyInfo& info : package::strategyTable()) {
        for (const package::Tracer tracer : package::kTracers) {
            const bool has = package.supports(info.strategy) &&
                             (package::tracersOf(info.strategy, package.shape().tracers) & tracer) != 0;
            const auto orderings =
                info.ordersHits ? static_cast<std::uint32_t>(package::Ordering::Count) : 1U;
            for (std::uint32_t ordering = 0; has && ordering < orderings; ++ordering) {
                RendererOptions options;
                options.strategy = info.strategy;
                options.tracer = tracer;
                options.ordering = static_cast<package::Ordering>(ordering);
                options.checkOrder = true;
                options.bounces = package.shape().maxBounces;
                options.backgroundPipelines = package.shape().fallback;
                list.push_back(options);
            }
        }
    }
    return list;
}

// Returns the choices that the device can run. If there are none, the error is that of the first.
Result<std::vector<PipelineChoice>> allChoices(const Context::State& context, const Package& package) {
    std::vector<PipelineChoice> choices;
    std::optional<Diagnostic> error;
    for (const RendererOptions& options : allOptions(package)) {
        Result<PipelineChoice> choice = choosePipelines(context, package, options);
        if (choice) {
            choices.push_back(*choice);
        } else if (!error) {
            error = choice.error();
        }
    }
    if (choices.empty() && error) {
        return *error;
    }
    return choices;
}

// The descriptor set layouts of a package's pipelines, and the layout that has them. Members are destroyed in
// reverse order.
struct Layout {
    std::vector<UniqueSetLayout> sets;
    UniquePipelineLayout pipeline;
};

Result<Layout> joinSets(Context::State& context, std::vector<UniqueSetLayout> sets, std::uint32_t pushBytes) {
    std::vector<VkDescriptorSetLayout> handles;
    handles.reserve(sets.size());
    for (const UniqueSetLayout& set : sets) {
        handles.push_back(set.get());
    }
    GLINT_TRY(auto pipeline, createPassLayout(context, handles, pushBytes));
    return Layout{std::move(sets), std::move(pipeline)};
}

// The layout of a Renderer with the package's first scene.
Result<Layout> frameLayout(Context::State& context, const Package& package, const PipelineChoice& choice) {
    const PackageScene scene = package.scene(0);
    const SceneSetSize counts{std::max(static_cast<std::uint32_t>(scene.textures.size()), 1U),
                              std::max(static_cast<std::uint32_t>(scene.samplers.size()), 1U)};
    std::vector<UniqueSetLayout> sets;
    GLINT_TRY(auto ofScene, createSceneSetLayout(context, counts));
    sets.push_back(std::move(ofScene));
    GLINT_TRY(auto ofFrame, createFrameSetLayout(context, frameSize(package, choice, {}, counts.textures)));
    sets.push_back(std::move(ofFrame));
    return joinSets(context, std::move(sets), sizeof(gpu::PushConstants));
}

struct Descriptor {
    VkDescriptorType type{};
    bool isArray = false;
};
using Descriptors = std::map<std::uint32_t, std::map<std::uint32_t, Descriptor>>;  // by set and binding

// Adds the descriptors that a module declares. The module was validated by the compiler. Numbers are those of
// the SPIR-V specification, "Instructions" and "Decoration".
void addDescriptors(std::span<const std::uint32_t> words, Descriptors& descriptors) {
    constexpr std::size_t kHeaderWords = 5;
    enum Operation : std::uint32_t {
        TypeImage = 25,
        TypeSampler = 26,
        TypeSampledImage = 27,
        TypeArray = 28,
        TypeRuntimeArray = 29,
        TypePointer = 32,
        Function = 54,
        Variable = 59,
        Decorate = 71,
        TypeAccelerationStructure = 5341
    };
    constexpr std::uint32_t kBinding = 33;
    constexpr std::uint32_t kDescriptorSet = 34;
    constexpr std::uint32_t kStorageImage = 2;  // "Sampled" of TypeImage
    constexpr std::uint32_t kUniform = 2;       // storage class
    constexpr std::size_t kSampledOperand = 7;
    std::map<std::uint32_t, std::span<const std::uint32_t>> types;
    std::map<std::uint32_t, std::map<std::uint32_t, std::uint32_t>> decorations;
    for (std::size_t at = kHeaderWords; at < words.size();) {
        const std::uint32_t operation = words[at] & 0xFFFFU;
        const std::size_t length = words[at] >> 16U;
        if (length == 0 || at + length > words.size() || operation == Function) {
            return;
        }
        const std::span<const std::uint32_t> all = words.subspan(at, length);
        at += length;
        if (operation == Decorate && length > 3) {
            decorations[all[1]][all[2]] = all[3];
        } else if (operation != Variable && length > 1) {
            types[all[1]] = all;
        }
        const auto places = operation == Variable ? decorations.find(all[2]) : decorations.end();
        if (places == decorations.end() || !places->second.contains(kDescriptorSet)) {
            continue;
        }
        std::span<const std::uint32_t> type = types[types[all[1]][3]];
        Descriptor found;
        while ((type[0] & 0xFFFFU) == TypeArray || (type[0] & 0xFFFFU) == TypeRuntimeArray) {
            found.isArray = true;
            type = types[type[2]];
        }
        switch (type[0] & 0xFFFFU) {
            case TypeAccelerationStructure:
                found.type = VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR;
                break;
            case TypeImage:
                found.type = type[kSampledOperand] == kStorageImage ? VK_DESCRIPTOR_TYPE_STORAGE_IMAGE
                                                                    : VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
                break;
            case TypeSampler:
                found.type = VK_DESCRIPTOR_TYPE_SAMPLER;
                break;
            case TypeSampledImage:
                found.type = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
                break;
            default:
                found.type = all[3] == kUniform ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER
                                                : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
                break;
        }
        descriptors[places->second[kDescriptorSet]][places->second[kBinding]] = found;
    }
}

Result<UniqueSetLayout> hostSetLayout(Context::State& context,
                                      const std::map<std::uint32_t, Descriptor>& descriptors) {
    constexpr std::uint32_t kArrayLength = 64;  // a host may have any; the code does not depend on it
    std::vector<VkDescriptorSetLayoutBinding> bindings;
    std::vector<VkDescriptorBindingFlags> bindingFlags;
    for (const auto& [binding, descriptor] : descriptors) {
        const std::uint32_t count = descriptor.isArray ? kArrayLength : 1U;
        bindings.push_back({binding, descriptor.type, count, passStages(context), nullptr});
        bindingFlags.push_back(descriptor.isArray ? VK_DESCRIPTOR_BINDING_UPDATE_AFTER_BIND_BIT |
                                                        VK_DESCRIPTOR_BINDING_PARTIALLY_BOUND_BIT
                                                  : 0);
    }
    return createSetLayout(context, bindings, bindingFlags);
}

// A layout as a host might have, whose pipelines the package's steps join.
Result<Layout> hostLayout(Context::State& context, const Package& package) {
    Descriptors descriptors;
    for (const package::ModuleEntry& entry : package.modules()) {
        addDescriptors(package.spirv({entry.role, entry.index, entry.tracer}), descriptors);
    }
    const std::uint32_t count = descriptors.empty() ? 0 : descriptors.rbegin()->first + 1;
    std::vector<UniqueSetLayout> sets;
    for (std::uint32_t set = 0; set < count; ++set) {
        GLINT_TRY(auto layout, hostSetLayout(context, descriptors[set]));
        sets.push_back(std::move(layout));
    }
    return joinSets(context, std::move(sets), package.bindings().pushOffset + sizeof(gpu::PushConstants));
}

// The distinct pipelines of all choices.
struct Planned {
    std::vector<PipelineJob> jobs;
    std::vector<PackagePipeline> pipelines;  // by job
    std::map<PipelineIdentity, std::size_t> known;

    void add(const Package& package, const PlannedPipeline& planned, std::uint32_t strategies) {
        const auto [found, fresh] = known.emplace(planned.job.identity, jobs.size());
        if (fresh) {
            jobs.push_back(planned.job);
            pipelines.emplace_back().statistics.name = planned.job.name;
        }
        PackagePipeline& pipeline = pipelines[found->second];
        pipeline.strategies |= strategies;
        for (const package::ModuleKey& key : modulesOf(package, planned)) {
            if (std::ranges::find(pipeline.modules, key) == pipeline.modules.end()) {
                pipeline.modules.push_back(key);
            }
        }
    }

    static std::vector<package::ModuleKey> modulesOf(const Package& package, const PlannedPipeline& planned) {
        if (planned.rays == nullptr) {
            return planned.keys;
        }
        std::vector<package::ModuleKey> keys;
        const RayPipelineSource& source = *planned.rays;
        std::vector<SpirvWords> stages{source.rayGeneration, source.anyHit};
        stages.insert(stages.end(), source.miss.begin(), source.miss.end());
        stages.insert(stages.end(), source.closestHit.begin(), source.closestHit.end());
        // The loader gives the same words to entries that name the same file.
        for (const SpirvWords words : stages) {
            for (const package::ModuleEntry& entry : package.modules()) {
                const package::ModuleKey key{entry.role, entry.index, entry.tracer};
                if (!words.empty() && package.spirv(key).data() == words.data()) {
                    keys.push_back(key);
                }
            }
        }
        return keys;
    }
};

// Adds the pass that deforms meshes, which belongs to scenes.
void planDeform(Context::State& context, const Package& package, VkPipelineLayout layout, Planned& all) {
    const package::ModuleKey key{package::ModuleRole::Deform};
    const std::span<const std::uint32_t> words = package.spirv(key);
    if (words.empty()) {
        return;
    }
    PipelineJob job{pipelineName(package, key), words.size(),
                    [&context, words, layout](PipelineCreation& creation) {
                        return createComputePipeline(context, words, layout, creation);
                    },
                    identify(package, VK_PIPELINE_BIND_POINT_COMPUTE, 0, {words})};
    all.add(package, {std::move(job), {key}}, package.shape().strategies);
}

}  // namespace

Result<std::vector<PackagePipeline>> makePackagePipelines(Context& context, const Package& package,
                                                          std::uint32_t threads) try {
    Context::State& state = context.state();
    GLINT_TRY(auto choices, allChoices(state, package));
    GLINT_TRY(auto layout, package.passes() == package::Passes::Frame
                               ? frameLayout(state, package, choices.front())
                               : hostLayout(state, package));
    GLINT_TRY(auto deformLayout, createDeformLayout(state));
    Planned all;
    for (const PipelineChoice& choice : choices) {
        for (const PlannedPipeline& planned :
             planPipelines(state, package, choice, {}, layout.pipeline.get())) {
            all.add(package, planned, choice.strategy);
        }
    }
    planDeform(state, package, deformLayout.get(), all);

    const bool captures = state.handles.pipelineStatistics;
    const std::vector<Result<MadePipeline>> made =
        tryPipelines(all.jobs, captures ? VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR : 0,
                     pipelineThreads(threads, all.jobs.size()));
    for (std::size_t i = 0; i < made.size(); ++i) {
        PackagePipeline& pipeline = all.pipelines[i];
        if (!made[i]) {
            pipeline.failure = made[i].error();
            continue;
        }
        pipeline.statistics = describe(*made[i]);
        if (!captures) {
            continue;
        }
        GLINT_TRY(pipeline.statistics.executables, readExecutables(state, made[i]->handle->get()));
    }
    return std::move(all.pipelines);
}
GLINT_CATCH

}  // namespace glint
