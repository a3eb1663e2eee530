#include "spirv/optimize.h"

#include "spirv/reader.h"

#include <glslang/SPIRV/spirv.hpp>
#include <spirv-tools/libspirv.hpp>
#include <spirv-tools/optimizer.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <utility>
#include <vector>

namespace glint::compiler {

namespace {

// --- Arithmetic with relaxed precision in 16 bits ---

// A hidden extraction has the layout of an extraction by one index: type, result, structure, one literal.
constexpr spv::Op kHidden = spv::OpArrayLength;
constexpr std::uint32_t kHiddenWords = 5;

// The member types of structures and arrays, and the type of each result.
struct MemberTypes {
    std::map<std::uint32_t, std::vector<std::uint32_t>> members;  // an array has one
    std::map<std::uint32_t, std::uint32_t> ofResult;

    // Returns 0 unless `type` is a structure or an array.
    std::uint32_t member(std::uint32_t type, std::uint32_t index) const {
        const auto found = members.find(type);
        return found == members.end() ? 0 : found->second[found->second.size() == 1 ? 0 : index];
    }
};

MemberTypes readTypes(std::span<const std::uint32_t> words) {
    MemberTypes types;
    for (const SpirvInstruction& it : SpirvInstructions(words)) {
        if (it.opcode == spv::OpTypeStruct) {
            types.members[it.operands[0]].assign(it.operands.begin() + 1, it.operands.end());
        } else if (it.opcode == spv::OpTypeArray) {
            types.members[it.operands[0]] = {it.operands[1]};
        } else if (it.type != 0) {
            types.ofResult[it.result] = it.type;
        }
    }
    return types;
}

// Appends the extraction step by step. Each step that extracts from a structure or an array is hidden.
void appendHidden(std::span<const std::uint32_t> extract, const MemberTypes& types, std::uint32_t& bound,
                  std::vector<std::uint32_t>& words) {
    constexpr std::size_t kFirstIndex = 4;
    std::uint32_t composite = extract[3];
    std::uint32_t type = types.ofResult.at(composite);
    std::size_t index = kFirstIndex;
    while (index < extract.size() && types.member(type, extract[index]) != 0) {
        type = types.member(type, extract[index]);
        const bool isLast = index + 1 == extract.size();
        const std::uint32_t result = isLast ? extract[2] : bound++;
        appendInstruction(words, kHidden, {type, result, composite, extract[index]});
        composite = result;
        ++index;
    }
    if (index < extract.size()) {
        appendInstruction(words, spv::OpCompositeExtract, {extract[1], extract[2], composite},
                          extract.subspan(index));
    }
}

// SPIRV-Tools 2023.1 treats every float that OpCompositeExtract takes out of a structure or an array as
// relaxed, even the positions of lights: its pass asks whether all float operands are relaxed, and there is
// none. hideExtractions() hides such instructions from that pass as instructions with the same layout that it
// ignores, and showExtractions() brings them back. No other pass may run in between, because the hidden
// instructions mean nothing.
void hideExtractions(std::vector<std::uint32_t>& words) {
    const MemberTypes types = readTypes(words);
    std::vector<std::uint32_t> hidden(words.begin(), words.begin() + kSpirvHeaderWords);
    for (const SpirvInstruction& it : SpirvInstructions(words)) {
        if (it.opcode == spv::OpCompositeExtract) {
            appendHidden(it.words(), types, hidden[kSpirvBoundWord], hidden);
        } else {
            appendWords(hidden, it.words());
        }
    }
    words = std::move(hidden);
}

void showExtractions(std::vector<std::uint32_t>& words) {
    for (const SpirvInstruction& it : SpirvInstructions(words)) {
        if (it.opcode == kHidden) {
            words[it.at] = kHiddenWords << spv::WordCountShift | spv::OpCompositeExtract;
        }
    }
}

constexpr spv_target_env kTarget = SPV_ENV_VULKAN_1_2;

// Keeps only the first error that SPIRV-Tools reports, because later ones are mostly its consequences.
spvtools::MessageConsumer keepFirstError(std::string& message) {
    return [&message](spv_message_level_t level, const char*, const spv_position_t&, const char* text) {
        if (level <= SPV_MSG_ERROR && message.empty()) {
            message = text;
        }
    };
}

// Folds code that depends on literals, one function at a time. This is cheap, because it does not look into
// callees.
void registerFolding(spvtools::Optimizer& optimizer) {
    optimizer.RegisterPass(spvtools::CreateCCPPass())
        .RegisterPass(spvtools::CreateSimplificationPass())
        .RegisterPass(spvtools::CreateDeadBranchElimPass())
        .RegisterPass(spvtools::CreateBlockMergePass());
}

// Inlines one level of calls, and folds the result.
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

// Folds and shortens functions, one at a time, and inlines them. A function that is short before it is
// inlined is short wherever it is inlined: inlining every lobe of the BSDF and removing it afterwards takes
// several times as long.
void registerInlining(spvtools::Optimizer& optimizer, bool keepNames) {
    if (!keepNames) {
        optimizer.RegisterPass(spvtools::CreateStripDebugInfoPass());
    }
    optimizer.RegisterPass(spvtools::CreateWrapOpKillPass())
        .RegisterPass(spvtools::CreateDeadBranchElimPass())
        .RegisterPass(spvtools::CreateBlockMergePass())
        .RegisterPass(spvtools::CreateLocalSingleBlockLoadStoreElimPass())
        .RegisterPass(spvtools::CreateLocalSingleStoreElimPass())
        .RegisterPass(spvtools::CreateSimplificationPass())
        .RegisterPass(spvtools::CreateBlockMergePass())
        .RegisterPass(spvtools::CreateEliminateDeadFunctionsPass())
        .RegisterPass(spvtools::CreateDeadBranchElimPass())
        .RegisterPass(spvtools::CreateMergeReturnPass())
        .RegisterPass(spvtools::CreateInlineExhaustivePass());
}

// Replaces loads by what the same block, or the only store of a variable, has stored.
void registerPlainValues(spvtools::Optimizer& optimizer) {
    optimizer.RegisterPass(spvtools::CreateLocalSingleBlockLoadStoreElimPass())
        .RegisterPass(spvtools::CreateLocalSingleStoreElimPass())
        .RegisterPass(spvtools::CreateAggressiveDCEPass());
}

// Replaces all variables by values, also members of structures.
void registerValues(spvtools::Optimizer& optimizer) {
    optimizer.RegisterPass(spvtools::CreateScalarReplacementPass())
        .RegisterPass(spvtools::CreateLocalAccessChainConvertPass());
    registerPlainValues(optimizer);
    optimizer.RegisterPass(spvtools::CreateSSARewritePass());
}

// Optimises functions into which all else was inlined. These are the passes of RegisterPerformancePasses()
// without those that change nothing in modules of cases, found by leaving out each in turn: the code is as
// long, and optimising takes 0.8 times as long.
void registerPerformance(spvtools::Optimizer& optimizer) {
    optimizer.RegisterPass(spvtools::CreateAggressiveDCEPass())
        .RegisterPass(spvtools::CreatePrivateToLocalPass());
    registerPlainValues(optimizer);
    registerValues(optimizer);
    optimizer.RegisterPass(spvtools::CreateCCPPass())
        .RegisterPass(spvtools::CreateAggressiveDCEPass())
        .RegisterPass(spvtools::CreateLoopUnrollPass(true))
        .RegisterPass(spvtools::CreateDeadBranchElimPass())
        .RegisterPass(spvtools::CreateCombineAccessChainsPass())
        .RegisterPass(spvtools::CreateSimplificationPass());
    registerValues(optimizer);
    optimizer.RegisterPass(spvtools::CreateVectorDCEPass())
        .RegisterPass(spvtools::CreateDeadInsertElimPass())
        .RegisterPass(spvtools::CreateDeadBranchElimPass())
        .RegisterPass(spvtools::CreateIfConversionPass())
        .RegisterPass(spvtools::CreateCopyPropagateArraysPass())
        .RegisterPass(spvtools::CreateAggressiveDCEPass())
        .RegisterPass(spvtools::CreateRedundancyEliminationPass())
        .RegisterPass(spvtools::CreateDeadBranchElimPass())
        .RegisterPass(spvtools::CreateBlockMergePass())
        .RegisterPass(spvtools::CreateSimplificationPass());
}

void registerDeadDeclarations(spvtools::Optimizer& optimizer, bool keepMembers) {
    if (!keepMembers) {
        // Every module declares the whole scene. Only the members that the module reads are kept, at their
        // offsets.
        optimizer.RegisterPass(spvtools::CreateEliminateDeadMembersPass());
    }
    optimizer.RegisterPass(spvtools::CreateAggressiveDCEPass())
        .RegisterPass(spvtools::CreateEliminateDeadConstantPass())
        .RegisterPass(spvtools::CreateCompactIdsPass());
}

void registerClearing(spvtools::Optimizer& optimizer, bool keepMembers) {
    // Features are decided through two masks, so what comes before uncovers more to fold.
    registerFolding(optimizer);
    registerDeadDeclarations(optimizer, keepMembers);
}

// Runs the passes that `registerInto` registers over `words`.
template <typename Register>
Status runPasses(std::vector<std::uint32_t>& words, const std::string& name, const Register& registerInto) {
    std::string message;
    spvtools::Optimizer optimizer(kTarget);
    optimizer.SetMessageConsumer(keepFirstError(message));
    registerInto(optimizer);
    spvtools::ValidatorOptions layout;
    layout.SetScalarBlockLayout(true);
    spvtools::OptimizerOptions options;
    // The result is validated later, which finds defects of either side.
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

// Returns the functions that those of `roots` call and that are not inlined yet. The roots stay apart from
// each other.
std::set<std::uint32_t> callsOf(const std::vector<SpirvFunction>& functions,
                                const std::set<std::uint32_t>& roots) {
    std::set<std::uint32_t> calls;
    for (const SpirvFunction& function : functions) {
        if (roots.contains(function.id)) {
            calls.insert(function.calls.begin(), function.calls.end());
        }
    }
    for (const std::uint32_t root : roots) {
        calls.erase(root);
    }
    return calls;
}

// Inlines calls into the functions named in `apart`, one level at a time, until those call nothing.
Status inlineByLevel(std::vector<std::uint32_t>& words, const std::string& name,
                     const std::vector<std::string>& apart) {
    // This is deeper than any chain of calls; registerInlining() inlines the rest.
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
        GLINT_TRY_DO(runPasses(words, name, registerLevel));
    }
    const std::vector<SpirvFunction> functions = findFunctions(words);
    keepApart(words, functions, idsOf(functions, apart));
    return okStatus();
}

// Makes operations of relaxed precision, or all operations on floats, 16-bit. It runs after inlining, so that
// neighbours share conversions, and before dead code is removed.
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
    GLINT_TRY_DO(runPasses(words, name, fold));
    hideExtractions(words);
    GLINT_TRY_DO(runPasses(words, name, convert));
    showExtractions(words);
    return runPasses(words, name, share);
}

// Inlines all permitted calls, and removes unneeded code.
Status inlineAndClear(std::vector<std::uint32_t>& words, const std::string& name, bool keepNames,
                      bool halvesAll) {
    // Payloads have no offsets, and the stages of a pipeline must agree on their members, so members stay.
    // Debuggers show them all.
    const bool keepMembers = keepNames || tracesByPipeline(words);
    const auto inlineAll = [&](spvtools::Optimizer& optimizer) { registerInlining(optimizer, keepNames); };
    const auto clearUp = [&](spvtools::Optimizer& optimizer) { registerClearing(optimizer, keepMembers); };
    GLINT_TRY_DO(runPasses(words, name, inlineAll));
    words = withoutUncalled(words);
    GLINT_TRY_DO(runPasses(words, name, registerPerformance));
    if (halvesAll || relaxesPrecision(words)) {
        GLINT_TRY_DO(makeHalves(words, name, halvesAll));
    }
    GLINT_TRY_DO(runPasses(words, name, clearUp));
    // Drivers may inline as they like, so the marks are removed.
    keepApart(words, findFunctions(words), {});
    return finishSpirv(words, name);
}

}  // namespace

bool relaxesPrecision(std::span<const std::uint32_t> words) {
    for (const SpirvInstruction& it : SpirvInstructions(words)) {
        if ((it.opcode == spv::OpDecorate && it.operands[1] == spv::DecorationRelaxedPrecision) ||
            (it.opcode == spv::OpMemberDecorate && it.operands[2] == spv::DecorationRelaxedPrecision)) {
            return true;
        }
        // Decorations come before functions (SPIR-V 2.4).
        if (it.opcode == spv::OpFunction) {
            break;
        }
    }
    return false;
}

bool tracesByPipeline(std::span<const std::uint32_t> words) {
    return hasCapability(words, spv::CapabilityRayTracingKHR);
}

Result<std::vector<std::uint32_t>> optimizeSpirv(const std::vector<std::uint32_t>& words,
                                                 const std::string& name,
                                                 const std::vector<std::string>& apart, bool keepNames,
                                                 bool halvesAll) {
    std::vector<std::uint32_t> optimized = words;
    if (!apart.empty()) {
        GLINT_TRY_DO(inlineByLevel(optimized, name, apart));
    }
    GLINT_TRY_DO(inlineAndClear(optimized, name, keepNames, halvesAll));
    return optimized;
}

Result<std::vector<std::uint32_t>> foldSpirv(const std::vector<std::uint32_t>& words, const std::string& name,
                                             bool keepNames) {
    std::vector<std::uint32_t> folded = words;
    GLINT_TRY_DO(runPasses(folded, name, [&](spvtools::Optimizer& optimizer) {
        if (!keepNames) {
            optimizer.RegisterPass(spvtools::CreateStripDebugInfoPass());
        }
        registerFolding(optimizer);
        optimizer.RegisterPass(spvtools::CreateEliminateDeadFunctionsPass())
            .RegisterPass(spvtools::CreateCompactIdsPass());
    }));
    GLINT_TRY_DO(finishSpirv(folded, name));
    return folded;
}

Result<std::vector<std::uint32_t>> optimizePart(const std::vector<std::uint32_t>& words,
                                                const std::string& name,
                                                const std::vector<std::string>& apart, bool halvesAll) {
    std::vector<std::uint32_t> optimized = words;
    const std::vector<SpirvFunction> functions = findFunctions(optimized);
    keepApart(optimized, functions, idsOf(functions, apart));
    GLINT_TRY_DO(inlineAndClear(optimized, name, true, halvesAll));
    return optimized;
}

Status clearJoined(std::vector<std::uint32_t>& words, const std::string& name, bool keepNames) {
    const bool keepMembers = keepNames || tracesByPipeline(words);
    return runPasses(words, name, [&](spvtools::Optimizer& optimizer) {
        optimizer.RegisterPass(spvtools::CreateEliminateDeadFunctionsPass());
        registerDeadDeclarations(optimizer, keepMembers);
    });
}

Status stripLibrary(std::vector<std::uint32_t>& words, const std::string& name) {
    return runPasses(words, name, [](spvtools::Optimizer& optimizer) {
        optimizer.RegisterPass(spvtools::CreateEliminateDeadFunctionsPass())
            .RegisterPass(spvtools::CreateDeadVariableEliminationPass())
            .RegisterPass(spvtools::CreateStripDebugInfoPass());
    });
}

Status validateSpirv(const std::vector<std::uint32_t>& words, const std::string& name, SpirvUse use) {
    std::string message;
    spvtools::SpirvTools tools(use == SpirvUse::Link ? SPV_ENV_UNIVERSAL_1_5 : kTarget);
    tools.SetMessageConsumer(keepFirstError(message));
    spvtools::ValidatorOptions options;
    options.SetScalarBlockLayout(true);
    // Making unique names of all ids can take longer than the validation, and only messages need them.
    options.SetFriendlyNames(false);
    if (!tools.Validate(words.data(), words.size(), options)) {
        message.clear();
        options.SetFriendlyNames(true);
        tools.Validate(words.data(), words.size(), options);
        return makeError("spirv-validate", name,
                         "the SPIR-V is not valid: " + (message.empty() ? "no reason given" : message),
                         "this is a defect of Glint; please report it with the scene");
    }
    return okStatus();
}

}  // namespace glint::compiler
