// A SPIR-V module as the join reads it: the words that are IDs, the annotations of IDs, and the starts of
// functions.
#pragma once

#include <glint/result.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace glint::compiler {

struct ParsedInstruction {
    std::size_t at = 0;  // index of its first word
    std::size_t length = 0;
    std::uint32_t opcode = 0;
    std::uint32_t result = 0;  // ID, or 0
    std::uint32_t type = 0;    // ID of the result's type, or 0
};

// Instructions that say something about an ID, by that ID.
class Annotations {
public:
    void add(std::uint32_t target, const ParsedInstruction& instruction) {
        entries_.emplace_back(target, instruction);
    }
    // To be called once, after the last add(). IDs are less than `bound`.
    void finish(std::uint32_t bound);
    // Returns the annotations of an ID, in the order of the module.
    std::span<const ParsedInstruction> of(std::uint32_t id) const {
        return std::span(sorted_).subspan(begins_[id], begins_[id + 1] - begins_[id]);
    }
    // All of them with their targets, in the order of the module.
    const std::vector<std::pair<std::uint32_t, ParsedInstruction>>& all() const {
        return entries_;
    }

private:
    std::vector<std::pair<std::uint32_t, ParsedInstruction>> entries_;
    std::vector<ParsedInstruction> sorted_;
    std::vector<std::uint32_t> begins_;  // by ID: of its place in sorted_
};

struct ParsedFunction {
    std::uint32_t id = 0;
    std::vector<ParsedInstruction> body;  // from OpFunction to OpFunctionEnd, without places in the source
};

struct ParsedModule {
    std::span<const std::uint32_t> words;    // those that were parsed, which must live as long
    std::vector<bool> isId;                  // by word
    std::vector<ParsedInstruction> globals;  // before the functions, without annotations
    std::vector<ParsedFunction> functions;
    Annotations decorations;  // without linkage
    Annotations names;
    // The names under which functions are linked, by their IDs.
    std::map<std::uint32_t, std::string> exports;
    std::map<std::uint32_t, std::string> imports;

    std::uint32_t bound() const {
        return words[3];
    }
    std::span<const std::uint32_t> wordsOf(const ParsedInstruction& instruction) const {
        return words.subspan(instruction.at, instruction.length);
    }
    // Returns the name of an ID, or "".
    std::string nameOf(std::uint32_t id) const;
};

// `shader` is for messages. Error "spirv-join" if this is no module, or has groups of decorations.
Result<ParsedModule> parseModule(std::span<const std::uint32_t> words, const std::string& shader);

// Returns whether a function of the module uses a variable that the functions of an invocation or of a
// workgroup share (a global variable of GLSL), and the entry point does not. An optimiser that sees one
// function use such a variable makes it the function's own. A variable that the entry point uses as well
// stays, and joined modules have it once, by its name.
bool sharesVariables(const ParsedModule& module);

}  // namespace glint::compiler
