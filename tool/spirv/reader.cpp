// For spv::HasResultAndType().
#define SPV_ENABLE_UTILITY_CODE

#include "spirv/reader.h"

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
        return formatError("has " + std::to_string(words.size()) + " words; a module's header alone has 5");
    }
    if (words[0] != kSpirvMagic) {
        return formatError("does not begin with the magic number of SPIR-V");
    }
    for (std::size_t at = kSpirvHeaderWords; at < words.size();) {
        const std::size_t length = words[at] >> 16U;
        if (length == 0 || length > words.size() - at) {
            return formatError("the instruction at word " + std::to_string(at) + " claims " +
                               std::to_string(length) + " words of " + std::to_string(words.size() - at));
        }
        visit({words[at] & 0xFFFFU, words.subspan(at + 1, length - 1)});
        at += length;
    }
    return okStatus();
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
    for (std::size_t at = kSpirvHeaderWords; at < words.size() && words[at] >> spv::WordCountShift != 0;
         at += words[at] >> spv::WordCountShift) {
        switch (words[at] & spv::OpCodeMask) {
            case spv::OpName:
                names[words[at + 1]] =
                    spirvString(words.subspan(at + 2, (words[at] >> spv::WordCountShift) - 2));
                break;
            case spv::OpFunction: {
                SpirvFunction function;
                function.id = words[at + 2];
                function.name = withoutParameters(names[function.id]);
                function.controlWord = at + 3;
                functions.push_back(std::move(function));
                break;
            }
            case spv::OpFunctionCall:
                functions.back().calls.push_back(words[at + 3]);
                break;
            default:
                break;
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
