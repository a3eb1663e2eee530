// Finds the members of structures that a module reads.
#pragma once

#include "spirv/join/parsed_module.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace glint::compiler {

// The definition of each ID of a module, or nullptr.
using Definitions = std::vector<const ParsedInstruction*>;

// Finds the members that SPIRV-Tools' pass EliminateDeadMembers keeps (version 2023.1): those that an
// instruction names, and all of structures that are written, returned or passed as a whole.
class LiveMembers {
public:
    static constexpr std::uint32_t kRemoved = 0xFFFF'FFFF;

    // Both must outlive this.
    LiveMembers(const ParsedModule& module, const Definitions& definitions);

    // Returns false if the module has an instruction that this can't follow.
    bool isKnown() const {
        return known_;
    }
    // Returns the place of a member among those that stay, or kRemoved.
    std::uint32_t placeOf(std::uint32_t structure, std::uint32_t member) const {
        return places_[structure][member];
    }
    // Returns whether the ID is a structure that loses members.
    bool loses(std::uint32_t structure) const {
        return loses_[structure];
    }

    // Visits the operands of an access chain, extraction or insertion that name members of structures: the
    // structure, the place of the operand in the module's words, and the member. Returns false if it can't
    // follow them.
    using Visit = std::function<void(std::uint32_t structure, std::size_t word, std::uint32_t member)>;
    bool visitMembers(const ParsedInstruction& instruction, const Visit& visit) const;

private:
    std::uint32_t typeOf(std::uint32_t id) const {
        return definitions_[id] == nullptr ? 0 : definitions_[id]->type;
    }
    std::uint32_t wordOf(std::uint32_t id, std::size_t word) const {
        return module_.words[definitions_[id]->at + word];
    }
    bool is(std::uint32_t id, std::uint32_t opcode) const {
        return definitions_[id] != nullptr && definitions_[id]->opcode == opcode;
    }
    void readGlobal(const ParsedInstruction& global);
    void read(const ParsedInstruction& instruction);
    void readWhole(std::uint32_t type);
    void readPointee(std::uint32_t pointer);
    void readOperands(const ParsedInstruction& instruction);
    void placeAll();

    const ParsedModule& module_;
    const Definitions& definitions_;
    std::vector<std::vector<bool>> read_;             // by structure and member
    std::vector<std::vector<std::uint32_t>> places_;  // the same
    std::vector<bool> whole_;                         // types that were read as a whole
    std::vector<bool> loses_;
    bool known_ = true;
};

}  // namespace glint::compiler
