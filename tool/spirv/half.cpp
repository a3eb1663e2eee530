#include "spirv/half.h"

#include "spirv/reader.h"

// This defines HasResultAndType().
#define SPV_ENABLE_UTILITY_CODE
#include <glslang/SPIRV/spirv.hpp>

#include <cstddef>
#include <map>
#include <span>
#include <utility>

namespace glint::compiler {

namespace {

constexpr std::size_t kBound = 3;  // index of the word that holds the first free ID
constexpr std::uint32_t kOpcodeMask = 0xFFFF;
constexpr std::uint32_t kLengthShift = 16;
// A hidden extraction has the layout of an extraction by one index: type, result, structure, one literal.
constexpr spv::Op kHidden = spv::OpArrayLength;
constexpr std::size_t kHiddenWords = 5;

std::uint32_t head(spv::Op opcode, std::size_t length) {
    return static_cast<std::uint32_t>(opcode) | static_cast<std::uint32_t>(length << kLengthShift);
}

// Calls visit(instruction) for each instruction until it returns false. Requires a valid module.
template <typename Visit>
void forEachInstruction(std::span<const std::uint32_t> words, const Visit& visit) {
    for (std::size_t i = kSpirvHeaderWords; i < words.size(); i += words[i] >> kLengthShift) {
        if (!visit(words.subspan(i, words[i] >> kLengthShift))) {
            break;
        }
    }
}

// The member types of structures and arrays, and the type of each result.
struct Types {
    std::map<std::uint32_t, std::vector<std::uint32_t>> members;  // an array has one
    std::map<std::uint32_t, std::uint32_t> ofResult;

    // Returns 0 unless `type` is a structure or an array.
    std::uint32_t member(std::uint32_t type, std::uint32_t index) const {
        const auto found = members.find(type);
        return found == members.end() ? 0 : found->second[found->second.size() == 1 ? 0 : index];
    }
};

Types readTypes(std::span<const std::uint32_t> words) {
    Types types;
    forEachInstruction(words, [&](std::span<const std::uint32_t> instruction) {
        const std::uint32_t opcode = instruction[0] & kOpcodeMask;
        if (opcode == spv::OpTypeStruct) {
            types.members[instruction[1]].assign(instruction.begin() + 2, instruction.end());
        } else if (opcode == spv::OpTypeArray) {
            types.members[instruction[1]] = {instruction[2]};
        } else {
            bool hasResult = false;
            bool hasType = false;
            spv::HasResultAndType(static_cast<spv::Op>(opcode), &hasResult, &hasType);
            if (hasResult && hasType) {
                types.ofResult[instruction[2]] = instruction[1];
            }
        }
        return true;
    });
    return types;
}

// Appends the extraction step by step. Each step that extracts from a structure or an array is hidden.
void appendHidden(std::span<const std::uint32_t> extract, const Types& types, std::uint32_t& bound,
                  std::vector<std::uint32_t>& words) {
    constexpr std::size_t kFirstIndex = 4;
    std::uint32_t composite = extract[3];
    std::uint32_t type = types.ofResult.at(composite);
    std::size_t index = kFirstIndex;
    while (index < extract.size() && types.member(type, extract[index]) != 0) {
        type = types.member(type, extract[index]);
        const bool isLast = index + 1 == extract.size();
        const std::uint32_t result = isLast ? extract[2] : bound++;
        words.insert(words.end(), {head(kHidden, kHiddenWords), type, result, composite, extract[index]});
        composite = result;
        ++index;
    }
    if (index < extract.size()) {
        words.insert(words.end(), {head(spv::OpCompositeExtract, kFirstIndex + extract.size() - index),
                                   extract[1], extract[2], composite});
        words.insert(words.end(), extract.begin() + static_cast<std::ptrdiff_t>(index), extract.end());
    }
}

}  // namespace

bool relaxesPrecision(const std::vector<std::uint32_t>& words) {
    bool relaxes = false;
    forEachInstruction(words, [&](std::span<const std::uint32_t> instruction) {
        const std::uint32_t opcode = instruction[0] & kOpcodeMask;
        relaxes = (opcode == spv::OpDecorate && instruction[2] == spv::DecorationRelaxedPrecision) ||
                  (opcode == spv::OpMemberDecorate && instruction[3] == spv::DecorationRelaxedPrecision);
        // Decorations come before functions (SPIR-V 2.4).
        return !relaxes && opcode != spv::OpFunction;
    });
    return relaxes;
}

void hideExtractions(std::vector<std::uint32_t>& words) {
    const Types types = readTypes(words);
    std::vector<std::uint32_t> hidden(words.begin(), words.begin() + kSpirvHeaderWords);
    forEachInstruction(words, [&](std::span<const std::uint32_t> instruction) {
        if ((instruction[0] & kOpcodeMask) == spv::OpCompositeExtract) {
            appendHidden(instruction, types, hidden[kBound], hidden);
        } else {
            hidden.insert(hidden.end(), instruction.begin(), instruction.end());
        }
        return true;
    });
    words = std::move(hidden);
}

void showExtractions(std::vector<std::uint32_t>& words) {
    for (std::size_t i = kSpirvHeaderWords; i < words.size(); i += words[i] >> kLengthShift) {
        if ((words[i] & kOpcodeMask) == kHidden) {
            words[i] = head(spv::OpCompositeExtract, kHiddenWords);
        }
    }
}

}  // namespace glint::compiler
