#include "spirv/lint_places.h"

#include "spirv/call_graph.h"

#include <fmt/format.h>
#include <glslang/SPIRV/spirv.hpp>

#include <cassert>

namespace glint::compiler {

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

bool hasResult(std::uint32_t opcode) {
    switch (opcode) {
        case spv::OpRayQueryInitializeKHR:
        case spv::OpRayQueryTerminateKHR:
        case spv::OpRayQueryGenerateIntersectionKHR:
        case spv::OpRayQueryConfirmIntersectionKHR:
            return false;
        default:
            return isRayQueryInstruction(opcode);
    }
}

}  // namespace

void forEachInstruction(std::span<const std::uint32_t> words,
                        const std::function<void(const SpirvInstruction&)>& visit) {
    const Status visited = visitSpirv(words, visit);
    assert(visited.ok());
    static_cast<void>(visited);
}

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
    forEachInstruction(words, [&](const SpirvInstruction& instruction) {
        if (instruction.opcode == spv::OpEntryPoint) {
            entries.push_back({instruction.operands[0], instruction.operands[1],
                               spirvString(instruction.operands.subspan(2))});
        }
    });
    return entries;
}

std::map<std::size_t, SpirvPlace> findPlaces(std::span<const std::uint32_t> words) {
    std::map<std::uint32_t, std::string> names = nameFunctions(words);
    std::map<std::size_t, SpirvPlace> places;
    LineTracker lines;
    std::string function;
    forEachInstruction(words, [&](const SpirvInstruction& instruction) {
        const std::uint32_t opcode = instruction.opcode;
        lines.visit(instruction);
        if (opcode == spv::OpFunction) {
            function = names[instruction.operands[1]];
        }
        if (isRayQueryInstruction(opcode) || isTraceInstruction(opcode)) {
            const std::size_t offset = offsetOf(words, instruction);
            places[offset] = {function, lines.source(), hasResult(opcode) ? instruction.operands[1] : 0,
                              offset};
        }
        lines.leave(opcode);
    });
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
