#include "spirv/join/live_members.h"

#include <glslang/SPIRV/spirv.hpp>

#include <algorithm>

namespace glint::compiler {

namespace {

// The word of an instruction with the pointer or composite, and the first that names a member. 0: none.
struct MemberWords {
    std::size_t object = 0;
    std::size_t first = 0;
};

MemberWords memberWordsOf(std::uint32_t opcode) {
    switch (opcode) {
        case spv::OpAccessChain:
        case spv::OpInBoundsAccessChain:
        case spv::OpCompositeExtract:
            return {3, 4};
        case spv::OpPtrAccessChain:
        case spv::OpInBoundsPtrAccessChain:
            return {3, 5};
        case spv::OpCompositeInsert:
            return {4, 5};
        default:
            return {};
    }
}

bool isChain(std::uint32_t opcode) {
    return opcode == spv::OpAccessChain || opcode == spv::OpInBoundsAccessChain ||
           opcode == spv::OpPtrAccessChain || opcode == spv::OpInBoundsPtrAccessChain;
}

constexpr std::size_t kFirstMember = 2;  // word of OpTypeStruct
constexpr std::size_t kPointee = 3;      // word of OpTypePointer
constexpr std::size_t kElement = 2;      // word of arrays, vectors and matrices
constexpr std::size_t kValue = 3;        // word of OpConstant

}  // namespace

LiveMembers::LiveMembers(const ParsedModule& module, const Definitions& definitions)
    : module_(module),
      definitions_(definitions),
      read_(module.bound()),
      places_(module.bound()),
      whole_(module.bound()),
      loses_(module.bound()) {
    for (const ParsedInstruction& global : module.globals) {
        if (global.opcode == spv::OpTypeStruct) {
            read_[global.result].resize(global.length - kFirstMember);
        }
    }
    for (const ParsedInstruction& global : module.globals) {
        readGlobal(global);
    }
    for (const ParsedFunction& function : module.functions) {
        for (const ParsedInstruction& instruction : function.body) {
            read(instruction);
        }
    }
    placeAll();
}

void LiveMembers::readGlobal(const ParsedInstruction& global) {
    const auto word = [&](std::size_t i) { return module_.words[global.at + i]; };
    if (global.opcode == spv::OpSpecConstantOp) {
        known_ = false;
    } else if (global.opcode == spv::OpVariable) {
        const std::uint32_t storage = word(3);
        const auto isOldBlock = [&](const ParsedInstruction& decoration) {
            return module_.words[decoration.at + 2] == spv::DecorationBufferBlock;
        };
        const bool isBuffer =
            storage == spv::StorageClassStorageBuffer ||
            (storage == spv::StorageClassUniform &&
             std::ranges::any_of(module_.decorations.of(wordOf(global.type, kPointee)), isOldBlock));
        if (isBuffer || storage == spv::StorageClassInput || storage == spv::StorageClassOutput) {
            readPointee(global.type);
        }
    }
}

void LiveMembers::read(const ParsedInstruction& instruction) {
    const auto word = [&](std::size_t i) { return module_.words[instruction.at + i]; };
    switch (instruction.opcode) {
        case spv::OpStore:
            readWhole(typeOf(word(2)));
            break;
        case spv::OpCopyMemory:
        case spv::OpCopyMemorySized:
            readPointee(typeOf(word(1)));
            break;
        case spv::OpReturnValue:
            readWhole(typeOf(word(1)));
            break;
        case spv::OpArrayLength:
            read_[wordOf(typeOf(word(3)), kPointee)][word(4)] = true;
            break;
        case spv::OpCompositeExtract:
        case spv::OpAccessChain:
        case spv::OpInBoundsAccessChain:
        case spv::OpPtrAccessChain:
        case spv::OpInBoundsPtrAccessChain:
            known_ = visitMembers(instruction,
                                  [this](std::uint32_t structure, std::size_t, std::uint32_t member) {
                                      read_[structure][member] = true;
                                  }) &&
                     known_;
            break;
        case spv::OpLoad:
        case spv::OpCompositeInsert:
        case spv::OpCompositeConstruct:
            break;
        default:
            readOperands(instruction);
            break;
    }
}

// An instruction that takes or gives structures as a whole.
void LiveMembers::readOperands(const ParsedInstruction& instruction) {
    readWhole(instruction.type);
    for (std::size_t i = instruction.at; i < instruction.at + instruction.length; ++i) {
        if (module_.isId[i]) {
            readWhole(typeOf(module_.words[i]));
        }
    }
}

void LiveMembers::readWhole(std::uint32_t type) {
    if (type == 0 || whole_[type] || definitions_[type] == nullptr) {
        return;
    }
    whole_[type] = true;
    if (is(type, spv::OpTypeStruct)) {
        std::vector<bool>& members = read_[type];
        for (std::size_t i = 0; i < members.size(); ++i) {
            members[i] = true;
            readWhole(wordOf(type, kFirstMember + i));
        }
    } else if (is(type, spv::OpTypeArray) || is(type, spv::OpTypeRuntimeArray)) {
        readWhole(wordOf(type, kElement));
    }
}

void LiveMembers::readPointee(std::uint32_t pointer) {
    readWhole(wordOf(pointer, kPointee));
}

bool LiveMembers::visitMembers(const ParsedInstruction& instruction, const Visit& visit) const {
    const MemberWords words = memberWordsOf(instruction.opcode);
    if (words.first == 0) {
        return true;
    }
    std::uint32_t type = typeOf(module_.words[instruction.at + words.object]);
    if (isChain(instruction.opcode)) {
        type = wordOf(type, kPointee);
    }
    for (std::size_t i = words.first; i < instruction.length; ++i) {
        const std::size_t place = instruction.at + i;
        if (is(type, spv::OpTypeStruct)) {
            std::uint32_t member = module_.words[place];
            if (isChain(instruction.opcode)) {
                if (!is(member, spv::OpConstant)) {
                    return false;
                }
                member = wordOf(member, kValue);
            }
            visit(type, place, member);
            type = wordOf(type, kFirstMember + member);
        } else if (is(type, spv::OpTypeArray) || is(type, spv::OpTypeRuntimeArray) ||
                   is(type, spv::OpTypeVector) || is(type, spv::OpTypeMatrix)) {
            type = wordOf(type, kElement);
        } else {
            return false;
        }
    }
    return true;
}

void LiveMembers::placeAll() {
    for (std::size_t id = 0; id < read_.size(); ++id) {
        std::uint32_t next = 0;
        for (const bool isRead : read_[id]) {
            places_[id].push_back(isRead ? next++ : kRemoved);
        }
        loses_[id] = next < read_[id].size();
    }
}

}  // namespace glint::compiler
