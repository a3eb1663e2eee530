// For spv::HasResultAndType().
#define SPV_ENABLE_UTILITY_CODE

#include "spirv/reader.h"

#include <fmt/format.h>
#include <glslang/SPIRV/spirv.hpp>

#include <cstddef>
#include <map>
#include <utility>

namespace glint::compiler {

namespace {

constexpr std::uint32_t kSpirvMagic = 0x07230203;

Diagnostic formatError(std::string message) {
    return makeError("spirv-format", {}, std::move(message), "expected a SPIR-V module, little endian");
}

}  // namespace

Status visitSpirv(std::span<const std::uint32_t> words,
                  const std::function<void(const SpirvInstruction&)>& visit) {
    if (words.size() < kSpirvHeaderWords) {
        return formatError(fmt::format("has {} words; a module's header alone has 5", words.size()));
    }
    if (words[0] != kSpirvMagic) {
        return formatError("does not begin with the magic number of SPIR-V");
    }
    std::size_t at = kSpirvHeaderWords;
    for (const SpirvInstruction& instruction : SpirvInstructions(words)) {
        visit(instruction);
        at += instruction.words().size();
    }
    if (at < words.size()) {
        return formatError(fmt::format("the instruction at word {} claims {} words of {}", at,
                                       words[at] >> 16U, words.size() - at));
    }
    return okStatus();
}

bool isSpirvDecoration(std::uint32_t opcode) {
    return opcode == spv::OpDecorate || opcode == spv::OpMemberDecorate || opcode == spv::OpDecorateId ||
           opcode == spv::OpDecorateString || opcode == spv::OpMemberDecorateString;
}

bool isSpirvPreamble(std::uint32_t opcode) {
    switch (opcode) {
        case spv::OpCapability:
        case spv::OpExtension:
        case spv::OpExtInstImport:
        case spv::OpMemoryModel:
        case spv::OpEntryPoint:
        case spv::OpExecutionMode:
        case spv::OpExecutionModeId:
            return true;
        default:
            return false;
    }
}

std::uint32_t resultAt(std::span<const std::uint32_t> words, std::size_t at) {
    bool hasResult = false;
    bool hasType = false;
    spv::HasResultAndType(static_cast<spv::Op>(words[at] & spv::OpCodeMask), &hasResult, &hasType);
    return hasResult ? words[at + (hasType ? 2 : 1)] : 0;
}

std::string spirvString(std::span<const std::uint32_t> operands) {
    std::string text;
    for (const std::uint32_t word : operands) {
        for (unsigned shift = 0; shift < 32; shift += 8) {
            const auto character = static_cast<char>((word >> shift) & 0xFFU);
            if (character == '\0') {
                return text;
            }
            text += character;
        }
    }
    return text;
}

namespace {

// glslang names functions like this: "shade(struct-Hit…;vf3;".
std::string withoutParameters(const std::string& name) {
    return name.substr(0, name.find('('));
}

}  // namespace

std::vector<SpirvFunction> findFunctions(std::span<const std::uint32_t> words) {
    std::vector<SpirvFunction> functions;
    std::map<std::uint32_t, std::string> names;
    for (const SpirvInstruction& it : SpirvInstructions(words)) {
        if (it.opcode == spv::OpName) {
            names[it.operands[0]] = spirvString(it.operands.subspan(1));
        } else if (it.opcode == spv::OpFunction) {
            const std::uint32_t id = it.operands[1];
            functions.push_back({id, withoutParameters(names[id]), it.at + 3, {}});
        } else if (it.opcode == spv::OpFunctionCall) {
            functions.back().calls.push_back(it.operands[2]);
        }
    }
    return functions;
}

void keepApart(std::vector<std::uint32_t>& words, const std::vector<SpirvFunction>& functions,
               const std::set<std::uint32_t>& apart) {
    for (const SpirvFunction& function : functions) {
        words[function.controlWord] =
            apart.contains(function.id) ? spv::FunctionControlDontInlineMask : spv::FunctionControlMaskNone;
    }
}

}  // namespace glint::compiler
