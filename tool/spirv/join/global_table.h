// The types, constants and variables of several modules, each once.
#pragma once

#include "spirv/join/parsed_module.h"

#include <glint/result.h>

#include <cstdint>
#include <map>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace glint::compiler {

// Two globals are the same if their words are, with IDs replaced by those of the table, and their
// decorations; structures and variables must also have the same names. If a module has several equal globals,
// they stay apart: the first of one module is the first of another.
class GlobalTable {
public:
    using Words = std::vector<std::uint32_t>;
    struct HashWords {
        std::size_t operator()(const Words& words) const;
    };

    // `keepNames` writes the names of added globals.
    explicit GlobalTable(bool keepNames) : keepNames_(keepNames) {}

    // Adds the globals of a module except its settings (capabilities to entry points). Returns the table's ID
    // for each of the module's, 0 for those that are no globals. Error "spirv-join" if the module declares a
    // resource in another way than an earlier module: other types or decorations of the same binding and
    // name, or of the same built-in variable, or a second block of push constants.
    Result<std::vector<std::uint32_t>> add(const ParsedModule& module, const std::string& shader);

    // Takes `count` IDs that nothing has and returns the first.
    std::uint32_t takeIds(std::uint32_t count) {
        return std::exchange(bound_, bound_ + count);
    }

    std::uint32_t bound() const {
        return bound_;
    }
    // The instructions that have been added, by section.
    const Words& imports() const {
        return imports_;
    }
    const Words& names() const {
        return names_;
    }
    const Words& decorations() const {
        return decorations_;
    }
    const Words& globals() const {
        return globals_;
    }
    // IDs of the variables, in order.
    const std::vector<std::uint32_t>& variables() const {
        return variables_;
    }

private:
    struct Added;

    static Words describePointer(const ParsedModule& module, const Added& added, std::uint32_t id);
    Words keyOf(const ParsedModule& module, const Added& added, const ParsedInstruction& global) const;
    Status checkResource(const ParsedModule& module, const ParsedInstruction& global,
                         const std::string& shader);
    void addForward(const ParsedModule& module, Added& added, const ParsedInstruction& global);
    void write(const ParsedModule& module, const Added& added, const ParsedInstruction& global);

    bool keepNames_;
    std::uint32_t bound_ = 1;
    std::unordered_map<Words, std::uint32_t, HashWords> known_;
    std::unordered_map<Words, std::uint32_t, HashWords>
        pointers_;               // to physical storage, by what they lead to
    std::vector<bool> written_;  // by ID of the table
    std::map<std::string, std::uint32_t> resources_;
    Words imports_;
    Words names_;
    Words decorations_;
    Words globals_;
    std::vector<std::uint32_t> variables_;
};

// Appends an instruction of the module with its IDs replaced.
void appendMapped(const ParsedModule& module, const ParsedInstruction& instruction,
                  const std::vector<std::uint32_t>& ids, std::vector<std::uint32_t>& words);

}  // namespace glint::compiler
