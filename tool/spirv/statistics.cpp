#include "spirv/statistics.h"

#include "spirv/reader.h"

#include <glslang/SPIRV/spirv.hpp>

namespace glint::compiler {

namespace {

bool isTextureFetch(std::uint32_t opcode) {
    switch (opcode) {
        case spv::OpImageSampleImplicitLod:
        case spv::OpImageSampleExplicitLod:
        case spv::OpImageSampleDrefImplicitLod:
        case spv::OpImageSampleDrefExplicitLod:
        case spv::OpImageSampleProjImplicitLod:
        case spv::OpImageSampleProjExplicitLod:
        case spv::OpImageSampleProjDrefImplicitLod:
        case spv::OpImageSampleProjDrefExplicitLod:
        case spv::OpImageFetch:
        case spv::OpImageGather:
        case spv::OpImageDrefGather:
            return true;
        default:
            return false;
    }
}

bool isBookkeeping(std::uint32_t opcode) {
    return opcode == spv::OpLabel || opcode == spv::OpLine || opcode == spv::OpNoLine;
}

}  // namespace

Result<SpirvStatistics> measureSpirv(std::span<const std::uint32_t> words) {
    SpirvStatistics statistics;
    statistics.bytes = words.size_bytes();
    bool inFunction = false;
    GLINT_TRY_DO(visitSpirv(words, [&](const SpirvInstruction& instruction) {
        const std::uint32_t opcode = instruction.opcode;
        inFunction = inFunction || opcode == spv::OpFunction;
        if (inFunction && !isBookkeeping(opcode)) {
            ++statistics.instructions;
            statistics.textureFetches += isTextureFetch(opcode) ? 1 : 0;
            statistics.rayQueries += opcode == spv::OpRayQueryInitializeKHR ? 1 : 0;
            statistics.branches += opcode == spv::OpBranchConditional || opcode == spv::OpSwitch ? 1 : 0;
            statistics.traces += opcode == spv::OpTraceRayKHR ? 1 : 0;
            statistics.functions += opcode == spv::OpFunction ? 1 : 0;
        }
        inFunction = inFunction && opcode != spv::OpFunctionEnd;
    }));
    return statistics;
}

}  // namespace glint::compiler
