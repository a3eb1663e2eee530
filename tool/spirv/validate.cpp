#include "base/parallel.h"
#include "spirv/join.h"
#include "spirv/optimize.h"
#include "spirv/reader.h"

#include <glslang/SPIRV/spirv.hpp>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <span>
#include <thread>

namespace glint::compiler {

namespace {

// A group of fewer words takes little more time than the declarations that each copy has.
constexpr std::size_t kLeastGroup = 20'000;

struct FunctionWords {
    std::uint32_t id = 0;
    std::size_t begin = 0;
    std::size_t label = 0;  // its first
    std::size_t end = 0;
    std::vector<std::uint32_t> calls;

    std::size_t size() const {
        return end - begin;
    }
};

class ValidationCopies {
public:
    explicit ValidationCopies(std::span<const std::uint32_t> words) : words_(words), ownerOf_(words[3]) {
        for (const SpirvInstruction& instruction : SpirvInstructions(words)) {
            read(instruction);
        }
    }

    // Divides functions among groups of similar size. Those that the entry point does not call itself are in
    // all copies, like the entry point, so that something in the copy calls them.
    std::size_t divide(std::size_t most) {
        groupOf_.assign(functions_.size(), kEveryGroup);
        const auto entry = std::ranges::find(functions_, entry_, &FunctionWords::id);
        if (entry == functions_.end()) {
            return 1;
        }
        std::size_t total = 0;
        for (std::size_t i = 0; i < functions_.size(); ++i) {
            if (functions_[i].id != entry_ &&
                std::ranges::find(entry->calls, functions_[i].id) != entry->calls.end()) {
                groupOf_[i] = 0;
                total += functions_[i].size();
            }
        }
        const std::size_t count = std::clamp<std::size_t>(total / kLeastGroup, 1, most);
        std::size_t before = 0;
        for (std::size_t i = 0; i < functions_.size(); ++i) {
            if (groupOf_[i] != kEveryGroup) {
                // The middle of a function decides, so that halves of any size are two groups.
                groupOf_[i] = (2 * before + functions_[i].size()) * count / (2 * total);
                before += functions_[i].size();
            }
        }
        return count;
    }

    // Returns the module with the code of one group.
    std::vector<std::uint32_t> copy(std::size_t group) const {
        std::vector<std::uint32_t> words(words_.begin(), words_.begin() + kSpirvHeaderWords);
        for (const SpirvInstruction& it : SpirvInstructions(words_.first(globalsEnd()))) {
            if (!isAnnotation(it.opcode) || hasCode(ownerOf_[it.operands[0]], group)) {
                appendWords(words, it.words());
            }
        }
        for (std::size_t i = 0; i < functions_.size(); ++i) {
            const FunctionWords& function = functions_[i];
            if (hasCode(i + 1, group)) {
                appendWords(words, words_.subspan(function.begin, function.size()));
            } else {
                appendWords(words, words_.subspan(function.begin, function.label + 2 - function.begin));
                appendInstruction(words, spv::OpUnreachable, {});
                appendInstruction(words, spv::OpFunctionEnd, {});
            }
        }
        return words;
    }

private:
    static constexpr std::size_t kEveryGroup = SIZE_MAX;

    static bool isAnnotation(std::uint32_t opcode) {
        return opcode == spv::OpName || opcode == spv::OpMemberName || isSpirvDecoration(opcode);
    }
    std::size_t globalsEnd() const {
        return functions_.empty() ? words_.size() : functions_.front().begin;
    }
    // `owner`: number of a function, counted from 1, or 0.
    bool hasCode(std::size_t owner, std::size_t group) const {
        return owner == 0 || groupOf_[owner - 1] == kEveryGroup || groupOf_[owner - 1] == group;
    }

    void read(const SpirvInstruction& it) {
        if (it.opcode == spv::OpEntryPoint) {
            entry_ = it.operands[1];
        } else if (it.opcode == spv::OpFunction) {
            functions_.push_back({it.result, it.at, 0, 0, {}});
        } else if (!functions_.empty()) {
            FunctionWords& function = functions_.back();
            if (function.label == 0) {
                function.label = it.opcode == spv::OpLabel ? it.at : 0;
            } else if (it.opcode == spv::OpFunctionEnd) {
                function.end = it.at + it.words().size();
            } else {
                ownerOf_[it.result] = functions_.size();
            }
            if (it.opcode == spv::OpFunctionCall) {
                function.calls.push_back(it.operands[2]);
            }
        }
        ownerOf_[0] = 0;
    }

    std::span<const std::uint32_t> words_;
    std::vector<std::size_t> ownerOf_;  // by ID of code: number of its function, counted from 1
    std::vector<FunctionWords> functions_;
    std::uint32_t entry_ = 0;
    std::vector<std::size_t> groupOf_;  // by function
};

}  // namespace

std::vector<std::vector<std::uint32_t>> validationCopies(const std::vector<std::uint32_t>& words,
                                                         std::size_t most) {
    std::vector<std::vector<std::uint32_t>> made;
    if (most > 1 && words.size() >= 2 * kLeastGroup) {
        ValidationCopies copies(words);
        const std::size_t count = copies.divide(most);
        for (std::size_t group = 0; count > 1 && group < count; ++group) {
            made.push_back(copies.copy(group));
        }
    }
    return made;
}

Status validateJoined(const std::vector<std::uint32_t>& words, const std::string& name, int jobs) {
    const std::size_t threads =
        jobs > 0 ? static_cast<std::size_t>(jobs) : std::max(1U, std::thread::hardware_concurrency());
    const std::vector<std::vector<std::uint32_t>> copies = validationCopies(words, threads);
    std::atomic<bool> valid{!copies.empty()};
    base::runParallel(copies.size(), jobs, [&](std::size_t group) {
        if (!validateSpirv(copies[group], name)) {
            valid = false;
        }
        return valid.load();
    });
    // The message is that about the whole.
    return valid ? okStatus() : validateSpirv(words, name);
}

}  // namespace glint::compiler
