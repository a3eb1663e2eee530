#include "spirv/lint_flow.h"

#include <fmt/format.h>
#include <glslang/SPIRV/spirv.hpp>
#include <spirv-tools/libspirv.hpp>
#include <spirv-tools/optimizer.hpp>

#include <set>
#include <string>

namespace glint::compiler {

namespace {

// This accepts everything that any Vulkan version accepts, because lint is about speed, not about
// environments.
constexpr spv_target_env kEnvironment = SPV_ENV_UNIVERSAL_1_6;

// Replaces the line numbers of the module by the offsets of its ray query instructions.
SpirvWords markOffsets(std::span<const std::uint32_t> words) {
    SpirvWords marked(words.begin(), words.begin() + kSpirvHeaderWords);
    const std::uint32_t file = marked[kSpirvBoundWord]++;
    bool named = false;
    for (const SpirvInstruction& instruction : SpirvInstructions(words)) {
        const std::uint32_t opcode = instruction.opcode;
        if (opcode == spv::OpLine || opcode == spv::OpNoLine) {
            continue;
        }
        if (!named && !isSpirvPreamble(opcode)) {
            appendInstruction(marked, spv::OpString, {file, 0});
            named = true;
        }
        if (isRayQueryInstruction(opcode)) {
            appendInstruction(marked, spv::OpLine, {file, static_cast<std::uint32_t>(instruction.at), 0});
        }
        appendWords(marked, instruction.words());
    }
    return marked;
}

struct FunctionContents {
    std::size_t words = 0;
    bool hasRayQueries = false;
};

std::map<std::uint32_t, FunctionContents> weighFunctions(std::span<const std::uint32_t> words) {
    std::map<std::uint32_t, FunctionContents> functions;
    std::uint32_t current = 0;
    for (const SpirvInstruction& instruction : SpirvInstructions(words)) {
        if (instruction.opcode == spv::OpFunction) {
            current = instruction.operands[1];
        }
        FunctionContents& function = functions[current];
        function.words += instruction.words().size();
        function.hasRayQueries = function.hasRayQueries || isRayQueryInstruction(instruction.opcode);
    }
    return functions;
}

// Finds large functions that neither use ray queries nor call a function that does. Inlining them would cost
// time and show nothing.
std::set<std::uint32_t> findApart(std::span<const std::uint32_t> words,
                                  const std::vector<SpirvFunction>& functions) {
    constexpr std::size_t kSmallWords = 256;
    std::map<std::uint32_t, FunctionContents> contents = weighFunctions(words);
    // Each round reaches one further caller, and no chain of calls is longer than the number of functions.
    bool changed = true;
    while (changed) {
        changed = false;
        for (const SpirvFunction& function : functions) {
            for (const std::uint32_t callee : function.calls) {
                if (contents[callee].hasRayQueries && !contents[function.id].hasRayQueries) {
                    contents[function.id].hasRayQueries = true;
                    changed = true;
                }
            }
        }
    }
    std::set<std::uint32_t> apart;
    for (const SpirvFunction& function : functions) {
        const FunctionContents& it = contents[function.id];
        if (!it.hasRayQueries && it.words > kSmallWords) {
            apart.insert(function.id);
        }
    }
    return apart;
}

// Returns whether inlining every call would make the module unreasonably large. If each function of a chain
// calls the next one twice, even a module of a kilobyte would outgrow any memory.
bool outgrows(std::span<const std::uint32_t> words, const std::vector<SpirvFunction>& functions) {
    constexpr std::size_t kMaxWords = std::size_t{1} << 22;  // The largest shaders have a tenth of that.
    const std::map<std::uint32_t, FunctionContents> contents = weighFunctions(words);
    std::map<std::uint32_t, std::size_t> inlined;
    // Callees may stand behind their callers, so it takes a round for each link of the longest chain. A size
    // that still grows after that belongs to a recursive function, which is allowed if no entry point reaches
    // it.
    for (std::size_t round = 0; round <= functions.size(); ++round) {
        bool changed = false;
        for (const SpirvFunction& function : functions) {
            std::size_t size = contents.at(function.id).words;
            for (const std::uint32_t callee : function.calls) {
                size += inlined[callee];
            }
            if (size > kMaxWords) {
                return true;
            }
            changed = changed || inlined[function.id] != size;
            inlined[function.id] = size;
        }
        if (!changed) {
            return false;
        }
    }
    return true;
}

void registerPasses(spvtools::Optimizer& optimizer) {
    // An array becomes as many variables as it has elements, whatever the module's size. Arrays of ray
    // queries are small.
    constexpr std::uint32_t kMaxScalars = 1024;
    optimizer.RegisterPass(spvtools::CreateMergeReturnPass())
        .RegisterPass(spvtools::CreateInlineExhaustivePass())
        .RegisterPass(spvtools::CreateEliminateDeadFunctionsPass())
        .RegisterPass(spvtools::CreateScalarReplacementPass(kMaxScalars))
        .RegisterPass(spvtools::CreateLocalAccessChainConvertPass())
        .RegisterPass(spvtools::CreateLocalSingleBlockLoadStoreElimPass())
        .RegisterPass(spvtools::CreateLocalSingleStoreElimPass())
        .RegisterPass(spvtools::CreateSSARewritePass())
        .RegisterPass(spvtools::CreateCCPPass())
        .RegisterPass(spvtools::CreateSimplificationPass())
        .RegisterPass(spvtools::CreateDeadBranchElimPass());
}

}  // namespace

Status checkSpirv(std::span<const std::uint32_t> words) {
    std::string message;
    spvtools::SpirvTools tools(kEnvironment);
    tools.SetMessageConsumer([&](spv_message_level_t, const char*, const spv_position_t&, const char* text) {
        message = message.empty() ? text : message;
    });
    spvtools::ValidatorOptions options;
    options.SetSkipBlockLayout(true);
    if (tools.Validate(words.data(), words.size(), options)) {
        return okStatus();
    }
    // Some messages continue with a disassembly, which is cut off.
    message = message.substr(0, message.find('\n'));
    return makeError("spirv-invalid", {},
                     "is not valid SPIR-V: " + (message.empty() ? "no reason given" : message),
                     "compile it again; spirv-val says more");
}

std::vector<std::uint32_t> prepareForLint(std::span<const std::uint32_t> words) {
    SpirvWords marked = markOffsets(words);
    const std::vector<SpirvFunction> functions = findFunctions(marked);
    if (outgrows(marked, functions)) {
        return marked;
    }
    keepApart(marked, functions, findApart(marked, functions));
    spvtools::Optimizer optimizer(kEnvironment);
    optimizer.SetMessageConsumer([](spv_message_level_t, const char*, const spv_position_t&, const char*) {});
    registerPasses(optimizer);
    spvtools::OptimizerOptions options;
    options.set_run_validator(false);  // checkSpirv() has already validated it.
    SpirvWords prepared;
    // If SPIRV-Tools can't inline a module, it is judged function by function, as are modules that would
    // outgrow memory.
    return optimizer.Run(marked.data(), marked.size(), &prepared, options) ? prepared : marked;
}

namespace {

// This is OpRayQueryGetIntersectionTriangleVertexPositionsKHR, which older headers lack.
constexpr std::uint32_t kOpTrianglePositions = 5340;
// This is OpTraceNV, whose number differs from that of OpTraceRayKHR.
constexpr std::uint32_t kOpTraceNv = 5337;

std::map<std::uint32_t, std::string> nameFunctions(std::span<const std::uint32_t> words) {
    std::map<std::uint32_t, std::string> names;
    for (const SpirvFunction& function : findFunctions(words)) {
        names[function.id] = function.name.empty() ? fmt::format("%{}", function.id) : function.name;
    }
    for (const SpirvEntryPoint& entry : findEntryPoints(words)) {
        if (names[entry.function].starts_with('%')) {
            names[entry.function] = entry.name;
        }
    }
    return names;
}

bool endsBlock(std::uint32_t opcode) {
    return opcode == spv::OpFunctionEnd || (opcode >= spv::OpBranch && opcode <= spv::OpUnreachable);
}

// Follows OpLine, which is valid to the end of its block.
class LineTracker {
public:
    void visit(const SpirvInstruction& instruction) {
        switch (instruction.opcode) {
            case spv::OpString:
                files_[instruction.operands[0]] = spirvString(instruction.operands.subspan(1));
                break;
            case spv::OpLine:
                source_ = fmt::format("{}:{}", files_[instruction.operands[0]], instruction.operands[1]);
                break;
            case spv::OpNoLine:
                source_.clear();
                break;
            default:
                break;
        }
    }
    void leave(std::uint32_t opcode) {
        if (endsBlock(opcode)) {
            source_.clear();
        }
    }
    const std::string& source() const {
        return source_;
    }

private:
    std::map<std::uint32_t, std::string> files_;
    std::string source_;
};

}  // namespace

bool isRayQueryInstruction(std::uint32_t opcode) {
    switch (opcode) {
        case spv::OpRayQueryInitializeKHR:
        case spv::OpRayQueryTerminateKHR:
        case spv::OpRayQueryGenerateIntersectionKHR:
        case spv::OpRayQueryConfirmIntersectionKHR:
        case spv::OpRayQueryProceedKHR:
        case spv::OpRayQueryGetIntersectionTypeKHR:
        case kOpTrianglePositions:
            return true;
        default:
            return opcode >= spv::OpRayQueryGetRayTMinKHR &&
                   opcode <= spv::OpRayQueryGetIntersectionWorldToObjectKHR;
    }
}

bool isTraceInstruction(std::uint32_t opcode) {
    return opcode == spv::OpTraceRayKHR || opcode == kOpTraceNv;
}

std::vector<SpirvEntryPoint> findEntryPoints(std::span<const std::uint32_t> words) {
    std::vector<SpirvEntryPoint> entries;
    for (const SpirvInstruction& instruction : SpirvInstructions(words)) {
        if (instruction.opcode == spv::OpEntryPoint) {
            entries.push_back({instruction.operands[0], instruction.operands[1],
                               spirvString(instruction.operands.subspan(2))});
        }
    }
    return entries;
}

std::map<std::size_t, SpirvPlace> findPlaces(std::span<const std::uint32_t> words) {
    std::map<std::uint32_t, std::string> names = nameFunctions(words);
    std::map<std::size_t, SpirvPlace> places;
    LineTracker lines;
    std::string function;
    for (const SpirvInstruction& instruction : SpirvInstructions(words)) {
        const std::uint32_t opcode = instruction.opcode;
        lines.visit(instruction);
        if (opcode == spv::OpFunction) {
            function = names[instruction.operands[1]];
        }
        if (isRayQueryInstruction(opcode) || isTraceInstruction(opcode)) {
            const bool isNew = opcode == kOpTrianglePositions;
            places[instruction.at] = {function, lines.source(),
                                      isNew ? instruction.operands[1] : instruction.result, instruction.at};
        }
        lines.leave(opcode);
    }
    return places;
}

std::string toString(const SpirvPlace& place) {
    if (place.offset == 0) {
        return {};
    }
    const std::string function = place.function.empty() ? "" : "in " + place.function + " ";
    const std::string source = place.source.empty() ? "" : place.source + ", ";
    const std::string id = place.id == 0 ? "" : fmt::format("%{}, ", place.id);
    return fmt::format("{}({}{}word {})", function, source, id, place.offset);
}

}  // namespace glint::compiler
