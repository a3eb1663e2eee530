#include "spirv/join/clear.h"

#include "spirv/join/live_members.h"
#include "spirv/reader.h"

#include <glslang/SPIRV/spirv.hpp>

#include <algorithm>
#include <map>
#include <optional>
#include <span>
#include <utility>

namespace glint::compiler {

namespace {

using ClearedWords = std::vector<std::uint32_t>;

constexpr std::size_t kEntryInterface = 3;    // word of OpEntryPoint from which variables can follow
constexpr std::size_t kCompositeMembers = 3;  // first word of a composite's members

bool isComposite(std::uint32_t opcode) {
    return opcode == spv::OpCompositeConstruct || opcode == spv::OpConstantComposite ||
           opcode == spv::OpSpecConstantComposite;
}

class Clearing {
public:
    Clearing(const ParsedModule& module, bool keepMembers)
        : module_(module),
          words_(module.words.begin(), module.words.end()),
          definitions_(module.bound()),
          live_(module.bound()),
          bodies_(module.functions.empty() ? module.words.size() : module.functions.front().body.front().at),
          keepMembers_(keepMembers) {}

    std::optional<ClearedWords> clear() {
        if (!module_.names.all().empty() || !hasKnownDecorations()) {
            return std::nullopt;
        }
        define();
        if (!callsAllFunctions()) {
            return std::nullopt;
        }
        if (!keepMembers_) {
            members_.emplace(module_, definitions_);
            if (!members_->isKnown() || !renameMembers()) {
                return std::nullopt;
            }
        }
        findLive();
        return write();
    }

private:
    bool hasKnownDecorations() const {
        return std::ranges::none_of(module_.decorations.all(), [&](const auto& entry) {
            const auto words = module_.wordsOf(entry.second);
            return entry.second.opcode == spv::OpDecorateId ||
                   (entry.second.opcode == spv::OpDecorate && words[2] == spv::DecorationBuiltIn &&
                    words[3] == spv::BuiltInWorkgroupSize);
        });
    }

    void define() {
        for (const ParsedInstruction& global : module_.globals) {
            definitions_[global.result] = &global;
        }
        for (const ParsedFunction& function : module_.functions) {
            for (const ParsedInstruction& instruction : function.body) {
                definitions_[instruction.result] = &instruction;
            }
        }
        definitions_[0] = nullptr;
    }

    bool callsAllFunctions() const;
    bool renameMembers();
    std::optional<std::uint32_t> constantOf(std::uint32_t value);
    void findLive();
    void addLive(const ParsedInstruction& instruction);
    void addLive(std::uint32_t id) {
        if (!live_[id]) {
            live_[id] = true;
            found_.push_back(id);
        }
    }
    bool isLive(const ParsedInstruction& global) const;
    bool isGlobal(std::uint32_t id) const {
        return definitions_[id] != nullptr && definitions_[id]->at < bodies_;
    }
    // The structure whose members the instruction names one after the other from word `first` on, if some of
    // them are removed; otherwise 0.
    std::uint32_t structureOf(const ParsedInstruction& instruction, std::size_t& first) const;
    ClearedWords write();
    void write(const ParsedInstruction& instruction, ClearedWords& to);
    void writeDecoration(std::uint32_t target, const ParsedInstruction& decoration, ClearedWords& to);
    void writeMapped(std::size_t at, ClearedWords& to) {
        to.push_back(module_.isId[at] ? number(words_[at]) : words_[at]);
    }
    std::uint32_t number(std::uint32_t id) {
        if (numbers_[id] == 0) {
            numbers_[id] = next_++;
        }
        return numbers_[id];
    }

    const ParsedModule& module_;
    ClearedWords words_;  // of the module, with members renamed
    Definitions definitions_;
    std::vector<bool> live_;            // by ID
    std::vector<std::uint32_t> found_;  // live IDs that were not looked at
    std::size_t bodies_;                // where the functions begin
    std::optional<LiveMembers> members_;
    std::map<std::uint32_t, std::uint32_t> constants_;  // of type uint, by value
    std::vector<std::uint32_t> added_;                  // values of constants with IDs after the module's
    std::uint32_t uintType_ = 0;
    std::vector<std::uint32_t> numbers_;
    std::uint32_t next_ = 1;
    bool keepMembers_;
};

bool Clearing::callsAllFunctions() const {
    std::vector<const ParsedFunction*> functions(module_.bound());
    for (const ParsedFunction& function : module_.functions) {
        functions[function.id] = &function;
    }
    std::vector<std::uint32_t> called;
    for (const ParsedInstruction& global : module_.globals) {
        if (global.opcode == spv::OpEntryPoint) {
            called.push_back(module_.words[global.at + 2]);
        }
    }
    std::size_t count = 0;
    while (!called.empty()) {
        const ParsedFunction* const function = std::exchange(functions[called.back()], nullptr);
        called.pop_back();
        if (function == nullptr) {
            continue;
        }
        ++count;
        for (const ParsedInstruction& instruction : function->body) {
            if (instruction.opcode == spv::OpFunctionCall) {
                called.push_back(module_.words[instruction.at + 3]);
            }
        }
    }
    return count == module_.functions.size();
}

// Returns a constant of type uint.
std::optional<std::uint32_t> Clearing::constantOf(std::uint32_t value) {
    if (uintType_ == 0) {
        for (const ParsedInstruction& global : module_.globals) {
            const auto words = module_.wordsOf(global);
            if (global.opcode == spv::OpTypeInt && words[2] == 32 && words[3] == 0) {
                uintType_ = global.result;
            } else if (global.opcode == spv::OpConstant && global.type == uintType_) {
                constants_.emplace(words[3], global.result);
            }
        }
        if (uintType_ == 0) {
            return std::nullopt;
        }
    }
    const auto [place, isNew] =
        constants_.emplace(value, module_.bound() + static_cast<std::uint32_t>(added_.size()));
    if (isNew) {
        added_.push_back(value);
    }
    return place->second;
}

// Returns false where code would be dead afterwards.
bool Clearing::renameMembers() {
    for (const ParsedFunction& function : module_.functions) {
        for (const ParsedInstruction& instruction : function.body) {
            if (isComposite(instruction.opcode) && members_->loses(instruction.type)) {
                return false;
            }
            if (instruction.opcode == spv::OpArrayLength) {
                // The member belongs to a buffer, which keeps all members.
                continue;
            }
            bool done = true;
            const bool known = members_->visitMembers(
                instruction, [&](std::uint32_t structure, std::size_t word, std::uint32_t member) {
                    const std::uint32_t place = members_->placeOf(structure, member);
                    if (place == LiveMembers::kRemoved) {
                        done = false;
                    } else if (place != member && module_.isId[word]) {
                        const std::optional<std::uint32_t> constant = constantOf(place);
                        done = done && constant.has_value();
                        words_[word] = constant.value_or(0);
                    } else {
                        words_[word] = module_.isId[word] ? words_[word] : place;
                    }
                });
            if (!known || !done) {
                return false;
            }
        }
    }
    live_.resize(module_.bound() + added_.size());
    return true;
}

void Clearing::addLive(const ParsedInstruction& instruction) {
    std::size_t first = 0;
    const std::uint32_t structure = structureOf(instruction, first);
    for (std::size_t i = 0; i < instruction.length; ++i) {
        if (module_.isId[instruction.at + i] &&
            (structure == 0 || i < first ||
             members_->placeOf(structure, static_cast<std::uint32_t>(i - first)) != LiveMembers::kRemoved)) {
            addLive(words_[instruction.at + i]);
        }
    }
}

void Clearing::findLive() {
    for (const ParsedInstruction& global : module_.globals) {
        const bool isMode = global.opcode == spv::OpExecutionMode || global.opcode == spv::OpExecutionModeId;
        const bool crossesStages =
            global.opcode == spv::OpVariable && (module_.words[global.at + 3] == spv::StorageClassInput ||
                                                 module_.words[global.at + 3] == spv::StorageClassOutput);
        if (isMode || crossesStages) {
            addLive(global);
        }
    }
    for (const ParsedFunction& function : module_.functions) {
        for (const ParsedInstruction& instruction : function.body) {
            addLive(instruction);
        }
    }
    while (!found_.empty()) {
        const std::uint32_t id = found_.back();
        found_.pop_back();
        if (id >= module_.bound()) {
            addLive(uintType_);
        } else if (isGlobal(id)) {
            addLive(*definitions_[id]);
        }
    }
}

bool Clearing::isLive(const ParsedInstruction& global) const {
    if (isSpirvPreamble(global.opcode)) {
        return true;
    }
    return live_[global.opcode == spv::OpTypeForwardPointer ? module_.words[global.at + 1] : global.result];
}

std::uint32_t Clearing::structureOf(const ParsedInstruction& instruction, std::size_t& first) const {
    const bool isType = instruction.opcode == spv::OpTypeStruct;
    if (!members_ || !(isType || isComposite(instruction.opcode))) {
        return 0;
    }
    first = isType ? 2 : kCompositeMembers;
    const std::uint32_t structure = isType ? instruction.result : instruction.type;
    return members_->loses(structure) ? structure : 0;
}

void Clearing::write(const ParsedInstruction& instruction, ClearedWords& to) {
    const std::size_t begin = to.size();
    std::size_t first = 0;
    const std::uint32_t structure = structureOf(instruction, first);
    const bool isEntry = instruction.opcode == spv::OpEntryPoint;
    for (std::size_t i = 0; i < instruction.length; ++i) {
        const std::size_t at = instruction.at + i;
        const bool isRemovedMember =
            structure != 0 && i >= first &&
            members_->placeOf(structure, static_cast<std::uint32_t>(i - first)) == LiveMembers::kRemoved;
        const bool isRemovedVariable =
            isEntry && i >= kEntryInterface && module_.isId[at] && !live_[words_[at]];
        if (!isRemovedMember && !isRemovedVariable) {
            writeMapped(at, to);
        }
    }
    to[begin] = static_cast<std::uint32_t>((to.size() - begin) << spv::WordCountShift) | instruction.opcode;
}

void Clearing::writeDecoration(std::uint32_t target, const ParsedInstruction& decoration, ClearedWords& to) {
    if (isGlobal(target) && !live_[target]) {
        return;
    }
    const std::size_t begin = to.size();
    for (std::size_t at = decoration.at; at < decoration.at + decoration.length; ++at) {
        writeMapped(at, to);
    }
    const bool isOfMember =
        decoration.opcode == spv::OpMemberDecorate || decoration.opcode == spv::OpMemberDecorateString;
    if (isOfMember && members_) {
        const std::uint32_t place = members_->placeOf(target, words_[decoration.at + 2]);
        if (place == LiveMembers::kRemoved) {
            to.resize(begin);
        } else {
            to[begin + 2] = place;
        }
    }
}

ClearedWords Clearing::write() {
    numbers_.resize(module_.bound() + added_.size());
    ClearedWords to(words_.begin(), words_.begin() + kSpirvHeaderWords);
    to.reserve(words_.size());
    const auto writeGlobals = [&](bool beforeDecorations) {
        for (const ParsedInstruction& global : module_.globals) {
            if (isSpirvPreamble(global.opcode) == beforeDecorations && isLive(global)) {
                write(global, to);
            }
        }
    };
    writeGlobals(true);
    for (const auto& [target, decoration] : module_.decorations.all()) {
        writeDecoration(target, decoration, to);
    }
    writeGlobals(false);
    for (std::uint32_t i = 0; i < added_.size(); ++i) {
        to.push_back(4U << spv::WordCountShift | spv::OpConstant);
        to.push_back(number(uintType_));
        to.push_back(number(module_.bound() + i));
        to.push_back(added_[i]);
    }
    for (const ParsedFunction& function : module_.functions) {
        for (const ParsedInstruction& instruction : function.body) {
            write(instruction, to);
        }
    }
    to[kSpirvBoundWord] = next_;
    return to;
}

}  // namespace

std::optional<std::vector<std::uint32_t>> clearGlobals(const ParsedModule& module, bool keepMembers) {
    return Clearing(module, keepMembers).clear();
}

}  // namespace glint::compiler
