#include "spirv/lint_pipelines.h"

#include "spirv/call_graph.h"
#include "spirv/lint_places.h"
#include "spirv/reader.h"

#include <fmt/format.h>
#include <glslang/SPIRV/spirv.hpp>

#include <algorithm>
#include <limits>
#include <optional>
#include <set>
#include <unordered_map>

namespace glint::compiler {

namespace {

// Names the stages that a trace starts: a trace in one of them is nested in another trace.
const char* nameHitStage(std::uint32_t model) {
    switch (model) {
        case spv::ExecutionModelClosestHitKHR:
            return "closest-hit";
        case spv::ExecutionModelAnyHitKHR:
            return "any-hit";
        case spv::ExecutionModelMissKHR:
            return "miss";
        default:
            return nullptr;
    }
}

std::set<std::uint32_t> reachableFrom(std::uint32_t root, const std::vector<SpirvFunction>& functions) {
    std::set<std::uint32_t> reached{root};
    std::vector<std::uint32_t> pending{root};
    while (!pending.empty()) {
        const auto function = std::ranges::find(functions, pending.back(), &SpirvFunction::id);
        pending.pop_back();
        if (function == functions.end()) {
            continue;
        }
        for (const std::uint32_t callee : function->calls) {
            if (reached.insert(callee).second) {
                pending.push_back(callee);
            }
        }
    }
    return reached;
}

// Returns the offsets of traces, by function.
std::map<std::uint32_t, std::vector<std::size_t>> findTraces(std::span<const std::uint32_t> words) {
    std::map<std::uint32_t, std::vector<std::size_t>> traces;
    std::uint32_t function = 0;
    forEachInstruction(words, [&](const SpirvInstruction& instruction) {
        if (instruction.opcode == spv::OpFunction) {
            function = instruction.operands[1];
        } else if (isTraceInstruction(instruction.opcode)) {
            traces[function].push_back(offsetOf(words, instruction));
        }
    });
    return traces;
}

void judgeTraces(std::span<const std::uint32_t> words, const std::map<std::size_t, SpirvPlace>& places,
                 std::vector<LintFinding>& findings) {
    const std::map<std::uint32_t, std::vector<std::size_t>> traces = findTraces(words);
    if (traces.empty()) {
        return;
    }
    const std::vector<SpirvFunction> functions = findFunctions(words);
    for (const SpirvEntryPoint& entry : findEntryPoints(words)) {
        const char* const stage = nameHitStage(entry.model);
        if (stage == nullptr) {
            continue;
        }
        for (const std::uint32_t function : reachableFrom(entry.function, functions)) {
            const auto found = traces.find(function);
            for (const std::size_t offset :
                 found == traces.end() ? std::vector<std::size_t>() : found->second) {
                findings.push_back(
                    {Severity::Warning, "trace-from-hit", places.at(offset),
                     fmt::format("a {} shader traces a ray: recursion", stage),
                     "return what the next ray needs, and trace it in the ray generation shader"});
            }
        }
    }
}

// The sizes of types in bytes, without padding: the least that the driver has to carry. A bool counts as one
// word.
class TypeSizes {
public:
    void visit(const SpirvInstruction& it) {
        constexpr std::uint64_t kBitsPerByte = 8;
        constexpr std::uint64_t kBoolBytes = 4;
        constexpr std::uint64_t kPointerBytes = 8;
        switch (it.opcode) {
            case spv::OpTypeBool:
                bytes_[it.operands[0]] = kBoolBytes;
                break;
            case spv::OpTypeInt:
            case spv::OpTypeFloat:
                bytes_[it.operands[0]] = it.operands[1] / kBitsPerByte;
                break;
            case spv::OpTypeVector:
            case spv::OpTypeMatrix:
                bytes_[it.operands[0]] = multiply(bytes_[it.operands[1]], it.operands[2]);
                break;
            case spv::OpConstant:
            case spv::OpSpecConstant:
                constants_[it.operands[1]] = it.operands[2];
                break;
            case spv::OpTypeArray:
                bytes_[it.operands[0]] = multiply(bytes_[it.operands[1]], constants_[it.operands[2]]);
                break;
            case spv::OpTypeStruct:
                bytes_[it.operands[0]] = 0;
                for (const std::uint32_t member : it.operands.subspan(1)) {
                    // The sum can't overflow: each term is below 2^48, and there are fewer than 2^16 terms.
                    bytes_[it.operands[0]] += std::min(bytes_[member], kLimit);
                }
                break;
            case spv::OpTypePointer:
                bytes_[it.operands[0]] = kPointerBytes;
                pointees_[it.operands[0]] = it.operands[2];
                break;
            default:
                break;
        }
    }
    std::uint64_t pointeeBytes(std::uint32_t pointerType) {
        return bytes_[pointees_[pointerType]];
    }

private:
    static constexpr std::uint64_t kLimit = 1ULL << 48U;

    static std::uint64_t multiply(std::uint64_t bytes, std::uint64_t count) {
        return count != 0 && bytes > kLimit / count ? kLimit : bytes * count;
    }

    std::unordered_map<std::uint32_t, std::uint64_t> bytes_;
    std::unordered_map<std::uint32_t, std::uint64_t> constants_;
    std::unordered_map<std::uint32_t, std::uint32_t> pointees_;
};

void judgePayloads(std::span<const std::uint32_t> words, std::vector<LintFinding>& findings) {
    constexpr std::uint64_t kMaxBytes = 64;
    TypeSizes sizes;
    forEachInstruction(words, [&](const SpirvInstruction& it) {
        sizes.visit(it);
        if (it.opcode != spv::OpVariable) {
            return;
        }
        const std::uint32_t storage = it.operands[2];
        const bool own = storage == spv::StorageClassRayPayloadKHR;
        if (!own && storage != spv::StorageClassIncomingRayPayloadKHR) {
            return;
        }
        const std::uint64_t bytes = sizes.pointeeBytes(it.operands[0]);
        // The payload of a hit shader is declared by the shader that traces, and reported there, unless it is
        // large.
        if (own || bytes > kMaxBytes) {
            findings.push_back({bytes > kMaxBytes ? Severity::Warning : Severity::Note, "payload-bytes",
                                SpirvPlace{{}, {}, it.operands[1], offsetOf(words, it)},
                                fmt::format("the ray payload has {} bytes", bytes),
                                bytes > kMaxBytes ? fmt::format("pack it into {} bytes or fewer", kMaxBytes)
                                                  : std::string()});
        }
    });
}

}  // namespace

void lintPipelines(std::span<const std::uint32_t> words, const std::map<std::size_t, SpirvPlace>& places,
                   std::vector<LintFinding>& findings) {
    judgeTraces(words, places, findings);
    judgePayloads(words, findings);
}

}  // namespace glint::compiler
