// Walks the instructions of a SPIR-V module (SPIR-V specification 1.6, section 2.3) with bounds checks.
#pragma once

#include <glint/result.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <iterator>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace glint::compiler {

// Words before the first instruction.
inline constexpr std::size_t kSpirvHeaderWords = 5;
// The word of the header that is above all IDs.
inline constexpr std::size_t kSpirvBoundWord = 3;

struct SpirvInstruction {
    std::size_t at = 0;  // index of its first word in the module
    std::uint32_t opcode = 0;
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

        SpirvInstruction operator*() const {
            return {at_, words_[at_] & 0xFFFFU, words_.subspan(at_ + 1, length() - 1)};
        }
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

bool isSpirvDecoration(std::uint32_t opcode);
// Returns whether an instruction belongs before the debug instructions, and so before the decorations
// (section 2.4).
bool isSpirvPreamble(std::uint32_t opcode);

// Returns the result of the instruction at word `at` of a valid module, or 0.
std::uint32_t resultAt(std::span<const std::uint32_t> words, std::size_t at);

// Decodes a literal string (UTF-8, four bytes a word, zero-terminated) at the start of `operands`. If the
// terminator is missing, the string ends with `operands`.
std::string spirvString(std::span<const std::uint32_t> operands);

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
void keepApart(std::vector<std::uint32_t>& words, const std::vector<SpirvFunction>& functions,
               const std::set<std::uint32_t>& apart);

}  // namespace glint::compiler
