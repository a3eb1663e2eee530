#include "spirv/optimize.h"

#include "spirv/call_graph.h"
#include "spirv/half.h"

#include <glslang/SPIRV/spirv.hpp>
#include <spirv-tools/libspirv.hpp>
#include <spirv-tools/optimizer.hpp>

#include <algorithm>
#include <set>
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

// Of a function at a time: what literals decide. Cheap, as it looks into no callee.
void registerFolding(spvtools::Optimizer& optimizer) {
    optimizer.RegisterPass(spvtools::CreateCCPPass())
        .RegisterPass(spvtools::CreateSimplificationPass())
        .RegisterPass(spvtools::CreateDeadBranchElimPass())
        .RegisterPass(spvtools::CreateBlockMergePass());
}

// One level of calls into their callers, and what that decides.
void registerLevel(spvtools::Optimizer& optimizer) {
    optimizer.RegisterPass(spvtools::CreateDeadBranchElimPass())
        .RegisterPass(spvtools::CreateMergeReturnPass())
        .RegisterPass(spvtools::CreateInlineExhaustivePass())
        .RegisterPass(spvtools::CreateEliminateDeadFunctionsPass())
        .RegisterPass(spvtools::CreateScalarReplacementPass(0))
        .RegisterPass(spvtools::CreateLocalAccessChainConvertPass())
        .RegisterPass(spvtools::CreateLocalSingleBlockLoadStoreElimPass())
        .RegisterPass(spvtools::CreateLocalSingleStoreElimPass())
        .RegisterPass(spvtools::CreateSSARewritePass());
    registerFolding(optimizer);
    optimizer.RegisterPass(spvtools::CreateAggressiveDCEPass())
        .RegisterPass(spvtools::CreateEliminateDeadFunctionsPass());
}

// Whether the module belongs to a ray tracing pipeline. Capabilities come first in a module: SPIR-V 2.4.
bool tracesByPipeline(const std::vector<std::uint32_t>& words) {
    constexpr std::size_t kHeaderWords = 5;
    constexpr std::uint32_t kOpcodeMask = 0xFFFF;
    for (std::size_t i = kHeaderWords; i + 1 < words.size() && (words[i] & kOpcodeMask) == spv::OpCapability;
         i += words[i] >> 16U) {
        if (words[i + 1] == spv::CapabilityRayTracingKHR) {
            return true;
        }
    }
    return false;
}

void registerInlining(spvtools::Optimizer& optimizer, bool keepNames) {
    if (!keepNames) {
        optimizer.RegisterPass(spvtools::CreateStripDebugInfoPass());
    }
    // What literals decide within a function goes before anything is inlined: inlining every lobe of the BSDF
    // to drop it afterwards takes several times as long.
    registerFolding(optimizer);
    optimizer.RegisterPass(spvtools::CreateEliminateDeadFunctionsPass());
    optimizer.RegisterPerformancePasses();
}

void registerClearing(spvtools::Optimizer& optimizer, bool keepMembers) {
    // What the performance passes uncover late, folded once more: features are decided through two masks.
    registerFolding(optimizer);
    optimizer.RegisterPass(spvtools::CreateVectorDCEPass());
    if (!keepMembers) {
        // Every module declares the whole scene; what is left of it are the members that the module reads, at
        // their offsets.
        optimizer.RegisterPass(spvtools::CreateEliminateDeadMembersPass());
    }
    optimizer.RegisterPass(spvtools::CreateAggressiveDCEPass())
        .RegisterPass(spvtools::CreateEliminateDeadConstantPass())
        .RegisterPass(spvtools::CreateCompactIdsPass());
}

// Runs what `registerInto` asks for over `words`.
template <typename Register>
Status runPasses(std::vector<std::uint32_t>& words, const std::string& name, const Register& registerInto) {
    std::string message;
    spvtools::Optimizer optimizer(kTarget);
    optimizer.SetMessageConsumer(keepFirstError(message));
    registerInto(optimizer);
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
    words = std::move(optimized);
    return okStatus();
}

std::set<std::uint32_t> idsOf(const std::vector<SpirvFunction>& functions,
                              const std::vector<std::string>& names) {
    std::set<std::uint32_t> ids;
    for (const SpirvFunction& function : functions) {
        if (std::ranges::find(names, function.name) != names.end()) {
            ids.insert(function.id);
        }
    }
    return ids;
}

// What the functions of `roots` call and have not taken in yet.
std::set<std::uint32_t> callsOf(const std::vector<SpirvFunction>& functions,
                                const std::set<std::uint32_t>& roots) {
    std::set<std::uint32_t> calls;
    for (const SpirvFunction& function : functions) {
        if (roots.contains(function.id)) {
            calls.insert(function.calls.begin(), function.calls.end());
        }
    }
    return calls;
}

// Inlines into the functions named in `apart`, a level of calls at a time, until they call nothing.
Status inlineByLevel(std::vector<std::uint32_t>& words, const std::string& name,
                     const std::vector<std::string>& apart) {
    // Deeper than any chain of calls; the performance passes take in the rest.
    constexpr int kMaxLevels = 24;
    for (int level = 0; level < kMaxLevels; ++level) {
        const std::vector<SpirvFunction> functions = findFunctions(words);
        const std::set<std::uint32_t> next = callsOf(functions, idsOf(functions, apart));
        if (next.empty()) {
            break;
        }
        std::set<std::uint32_t> others;
        for (const SpirvFunction& function : functions) {
            if (!next.contains(function.id)) {
                others.insert(function.id);
            }
        }
        keepApart(words, functions, others);
        if (Status status = runPasses(words, name, registerLevel); !status) {
            return status;
        }
    }
    const std::vector<SpirvFunction> functions = findFunctions(words);
    keepApart(words, functions, idsOf(functions, apart));
    return okStatus();
}

// What is of relaxed precision, or every operation on floats, in 16 bits. Between inlining, so that
// neighbours share what is converted, and clearing away.
Status makeHalves(std::vector<std::uint32_t>& words, const std::string& name, bool all) {
    const auto fold = [](spvtools::Optimizer& optimizer) {
        registerFolding(optimizer);
        optimizer.RegisterPass(spvtools::CreateAggressiveDCEPass());
    };
    const auto convert = [all](spvtools::Optimizer& optimizer) {
        if (all) {
            optimizer.RegisterPass(spvtools::CreateRelaxFloatOpsPass());
        }
        optimizer.RegisterPass(spvtools::CreateConvertRelaxedToHalfPass());
    };
    const auto share = [](spvtools::Optimizer& optimizer) {
        optimizer.RegisterPass(spvtools::CreateSimplificationPass())
            .RegisterPass(spvtools::CreateRedundancyEliminationPass());
    };
    if (Status status = runPasses(words, name, fold); !status) {
        return status;
    }
    hideExtractions(words);
    Status status = runPasses(words, name, convert);
    showExtractions(words);
    return status ? runPasses(words, name, share) : status;
}

}  // namespace

Result<std::vector<std::uint32_t>> optimizeSpirv(const std::vector<std::uint32_t>& words,
                                                 const std::string& name,
                                                 const std::vector<std::string>& apart, bool keepNames,
                                                 bool halvesAll) {
    std::vector<std::uint32_t> optimized = words;
    if (!apart.empty()) {
        if (Status status = inlineByLevel(optimized, name, apart); !status) {
            return status.error();
        }
    }
    // Payloads have no offsets: the stages of a pipeline must agree on their members. Debuggers show them
    // all.
    const bool keepMembers = keepNames || tracesByPipeline(optimized);
    const auto inlineAll = [&](spvtools::Optimizer& optimizer) { registerInlining(optimizer, keepNames); };
    const auto clearUp = [&](spvtools::Optimizer& optimizer) { registerClearing(optimizer, keepMembers); };
    Status status = runPasses(optimized, name, inlineAll);
    if (status && (halvesAll || relaxesPrecision(optimized))) {
        status = makeHalves(optimized, name, halvesAll);
    }
    if (status) {
        status = runPasses(optimized, name, clearUp);
    }
    if (!status) {
        return status.error();
    }
    // Drivers may inline as they like.
    keepApart(optimized, findFunctions(optimized), {});
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
