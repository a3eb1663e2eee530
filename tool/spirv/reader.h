// Reads SPIR-V modules: their instructions (SPIR-V specification 1.6, section 2.3), the calls between their
// functions, and the words that are IDs.
#pragma once

#include <glint/result.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace glint::compiler {

using SpirvWords = std::vector<std::uint32_t>;

// Words before the first instruction.
inline constexpr std::size_t kSpirvHeaderWords = 5;
inline constexpr std::size_t kSpirvVersionWord = 1;
// The word of the header that is above all IDs.
inline constexpr std::size_t kSpirvBoundWord = 3;

struct SpirvInstruction {
    std::size_t at = 0;  // index of its first word in the module
    std::uint32_t opcode = 0;
    std::uint32_t result = 0;                 // ID, or 0
    std::uint32_t type = 0;                   // ID of the result's type, or 0
    std::span<const std::uint32_t> operands;  // every word after the first

    std::span<const std::uint32_t> words() const {
        return {operands.data() - 1, operands.size() + 1};
    }
};

// The instructions of a module, for loops. They end before one that runs past the end of the module.
class SpirvInstructions {
public:
    explicit SpirvInstructions(std::span<const std::uint32_t> words) : words_(words) {}

    class Iterator {
    public:
        explicit Iterator(std::span<const std::uint32_t> words) : words_(words) {}

        SpirvInstruction operator*() const;
        Iterator& operator++() {
            at_ += length();
            return *this;
        }
        bool operator==(std::default_sentinel_t /*end*/) const {
            return at_ >= words_.size() || length() == 0 || length() > words_.size() - at_;
        }

    private:
        std::size_t length() const {
            return words_[at_] >> 16U;
        }

        std::span<const std::uint32_t> words_;
        std::size_t at_ = kSpirvHeaderWords;
    };
    Iterator begin() const {
        return Iterator(words_);
    }
    static std::default_sentinel_t end() {
        return {};
    }

private:
    std::span<const std::uint32_t> words_;
};

// Calls `visit` for each instruction in order. Error "spirv-format" if `words` is no SPIR-V module or an
// instruction runs past its end; the instructions before it have then been visited.
Status visitSpirv(std::span<const std::uint32_t> words,
                  const std::function<void(const SpirvInstruction&)>& visit);

bool hasCapability(std::span<const std::uint32_t> words, std::uint32_t capability);
bool isSpirvDecoration(std::uint32_t opcode);
// Returns whether an instruction belongs before the debug instructions, and so before the decorations
// (section 2.4).
bool isSpirvPreamble(std::uint32_t opcode);
bool isAccessChain(std::uint32_t opcode);

// Decodes a literal string (UTF-8, four bytes a word, zero-terminated) at the start of `operands`. If the
// terminator is missing, the string ends with `operands`.
std::string spirvString(std::span<const std::uint32_t> operands);

void appendWords(SpirvWords& to, std::span<const std::uint32_t> words);
// `more` are operands behind those of `operands`.
void appendInstruction(SpirvWords& to, std::uint32_t opcode, std::initializer_list<std::uint32_t> operands,
                       std::span<const std::uint32_t> more = {});

// --- Finds the calls between functions of a SPIR-V module, and controls which functions may be inlined ---

struct SpirvFunction {
    std::uint32_t id = 0;
    std::string name;                  // without its parameters; empty if the module keeps no names
    std::size_t controlWord = 0;       // index in the module of the word with its function control
    std::vector<std::uint32_t> calls;  // IDs of called functions, in order, with repeats
};

// Requires a valid module.
std::vector<SpirvFunction> findFunctions(std::span<const std::uint32_t> words);

// Forbids inlining of the functions in `apart`, and allows it for the others.
void keepApart(SpirvWords& words, const std::vector<SpirvFunction>& functions,
               const std::set<std::uint32_t>& apart);

// Returns a function and those that it calls, also through others.
std::set<std::uint32_t> reachableFrom(std::uint32_t root, const std::vector<SpirvFunction>& functions);

// Returns a shader without the functions that its entry points do not reach. SPIRV-Tools' own pass removes
// instruction by instruction, which after inlining takes an eighth of all optimisation.
SpirvWords withoutUncalled(std::span<const std::uint32_t> words);

// --- A module with the words that are IDs, the annotations of IDs, and the starts of functions ---

// Instructions that say something about an ID, by that ID.
class Annotations {
public:
    void add(std::uint32_t target, const SpirvInstruction& instruction) {
        entries_.emplace_back(target, instruction);
    }
    // To be called once, after the last add(). IDs are less than `bound`.
    void finish(std::uint32_t bound);
    // Returns the annotations of an ID, in the order of the module.
    std::span<const SpirvInstruction> of(std::uint32_t id) const {
        return std::span(sorted_).subspan(begins_[id], begins_[id + 1] - begins_[id]);
    }
    // All of them with their targets, in the order of the module.
    const std::vector<std::pair<std::uint32_t, SpirvInstruction>>& all() const {
        return entries_;
    }

private:
    std::vector<std::pair<std::uint32_t, SpirvInstruction>> entries_;
    std::vector<SpirvInstruction> sorted_;
    std::vector<std::uint32_t> begins_;  // by ID: of its place in sorted_
};

struct ParsedFunction {
    std::uint32_t id = 0;
    std::span<const SpirvInstruction> body;  // from OpFunction to OpFunctionEnd, without places in the source
};

// It can be moved, but a copy would refer to the instructions of the original.
struct ParsedModule {
    std::span<const std::uint32_t> words;   // those that were parsed, which must live as long
    std::vector<bool> isId;                 // by word
    std::vector<SpirvInstruction> globals;  // before the functions, without annotations
    std::vector<SpirvInstruction> code;     // the bodies of all functions
    std::vector<ParsedFunction> functions;
    std::vector<const SpirvInstruction*> definitions;  // by ID; null for those that have none
    Annotations decorations;                           // without linkage
    Annotations names;
    // The names under which functions are linked, by their IDs.
    std::map<std::uint32_t, std::string> exports;
    std::map<std::uint32_t, std::string> imports;

    ParsedModule() = default;
    ParsedModule(ParsedModule&&) = default;
    ParsedModule& operator=(ParsedModule&&) = default;

    std::uint32_t bound() const {
        return words[kSpirvBoundWord];
    }
    // Returns the type of an ID's value, or 0.
    std::uint32_t typeOf(std::uint32_t id) const {
        return definitions[id] == nullptr ? 0 : definitions[id]->type;
    }
    // Returns the name of an ID, or "".
    std::string nameOf(std::uint32_t id) const;
    // Returns the last literal of a decoration of an ID, or of a member if there is one.
    std::optional<std::uint32_t> decorationOf(std::uint32_t id, std::uint32_t decoration,
                                              std::optional<std::uint32_t> member = std::nullopt) const;

    // Visits the words of an instruction that are IDs, from its word `from` on.
    template <typename Visit>
    void forIds(const SpirvInstruction& instruction, const Visit& visit, std::size_t from = 0) const {
        for (std::size_t i = from; i <= instruction.operands.size(); ++i) {
            if (isId[instruction.at + i]) {
                visit(words[instruction.at + i]);
            }
        }
    }
    // Appends an instruction. `map` gives the ID to write for each of its IDs.
    template <typename Map>
    void append(const SpirvInstruction& instruction, const Map& map, SpirvWords& to) const {
        for (std::size_t i = 0; i <= instruction.operands.size(); ++i) {
            const std::uint32_t word = words[instruction.at + i];
            to.push_back(isId[instruction.at + i] ? map(word) : word);
        }
    }
};

// `shader` is for messages. Error "spirv-join" if this is no module, or has groups of decorations.
Result<ParsedModule> parseModule(std::span<const std::uint32_t> words, const std::string& shader);

// Returns whether a function of the module uses a variable that the functions of an invocation or of a
// workgroup share (a global variable of GLSL), and the entry point does not. An optimiser that sees one
// function use such a variable makes it the function's own. A variable that the entry point uses as well
// stays, and joined modules have it once, by its name.
bool sharesVariables(const ParsedModule& module);

// A change at an instruction.
struct SpirvEdit {
    SpirvWords before;  // instructions that are inserted before it
    bool removes = false;
};
using SpirvEdits = std::map<std::size_t, SpirvEdit>;  // by the instruction's first word

// Returns the words of a module with changes. `renamed` has IDs that others stand for; inserted instructions
// are taken as they are.
SpirvWords edited(const ParsedModule& module, const SpirvEdits& edits,
                  const std::map<std::uint32_t, std::uint32_t>& renamed, std::uint32_t bound);

}  // namespace glint::compiler
