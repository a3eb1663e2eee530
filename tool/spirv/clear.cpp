#include "spirv/join.h"
#include "spirv/reader.h"

#include <glslang/SPIRV/spirv.hpp>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

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

// Finds the members that SPIRV-Tools' pass EliminateDeadMembers keeps (version 2023.1): those that an
// instruction names, and all of structures that are written, returned or passed as a whole.
class LiveMembers {
public:
    static constexpr std::uint32_t kRemoved = 0xFFFF'FFFF;

    // The module must outlive this.
    explicit LiveMembers(const ParsedModule& module)
        : module_(module),
          read_(module.bound()),
          places_(module.bound()),
          whole_(module.bound()),
          loses_(module.bound()) {
        for (const SpirvInstruction& global : module.globals) {
            if (global.opcode == spv::OpTypeStruct) {
                read_[global.result].resize(global.words().size() - kFirstMember);
            }
        }
        for (const SpirvInstruction& global : module.globals) {
            readGlobal(global);
        }
        for (const SpirvInstruction& instruction : module.code) {
            read(instruction);
        }
        placeAll();
    }

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

    bool visitMembers(const SpirvInstruction& instruction, const Visit& visit) const {
        const MemberWords words = memberWordsOf(instruction.opcode);
        if (words.first == 0) {
            return true;
        }
        std::uint32_t type = module_.typeOf(instruction.words()[words.object]);
        if (isChain(instruction.opcode)) {
            type = wordOf(type, kPointee);
        }
        for (std::size_t i = words.first; i < instruction.words().size(); ++i) {
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

private:
    std::uint32_t wordOf(std::uint32_t id, std::size_t word) const {
        return module_.definitions[id]->words()[word];
    }
    bool is(std::uint32_t id, std::uint32_t opcode) const {
        return module_.definitions[id] != nullptr && module_.definitions[id]->opcode == opcode;
    }

    void readGlobal(const SpirvInstruction& global) {
        const auto word = [&](std::size_t i) { return global.words()[i]; };
        if (global.opcode == spv::OpSpecConstantOp) {
            known_ = false;
        } else if (global.opcode == spv::OpVariable) {
            const std::uint32_t storage = word(3);
            const auto isOldBlock = [&](const SpirvInstruction& decoration) {
                return decoration.words()[2] == spv::DecorationBufferBlock;
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

    void read(const SpirvInstruction& instruction) {
        const auto word = [&](std::size_t i) { return instruction.words()[i]; };
        switch (instruction.opcode) {
            case spv::OpStore:
                readWhole(module_.typeOf(word(2)));
                break;
            case spv::OpCopyMemory:
            case spv::OpCopyMemorySized:
                readPointee(module_.typeOf(word(1)));
                break;
            case spv::OpReturnValue:
                readWhole(module_.typeOf(word(1)));
                break;
            case spv::OpArrayLength:
                read_[wordOf(module_.typeOf(word(3)), kPointee)][word(4)] = true;
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

    void readWhole(std::uint32_t type) {
        if (type == 0 || whole_[type] || module_.definitions[type] == nullptr) {
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

    void readPointee(std::uint32_t pointer) {
        readWhole(wordOf(pointer, kPointee));
    }

    // An instruction that takes or gives structures as a whole.
    void readOperands(const SpirvInstruction& instruction) {
        readWhole(instruction.type);
        module_.forIds(instruction, [this](std::uint32_t id) { readWhole(module_.typeOf(id)); });
    }

    void placeAll() {
        for (std::size_t id = 0; id < read_.size(); ++id) {
            std::uint32_t next = 0;
            for (const bool isRead : read_[id]) {
                places_[id].push_back(isRead ? next++ : kRemoved);
            }
            loses_[id] = next < read_[id].size();
        }
    }

    const ParsedModule& module_;
    std::vector<std::vector<bool>> read_;             // by structure and member
    std::vector<std::vector<std::uint32_t>> places_;  // the same
    std::vector<bool> whole_;                         // types that were read as a whole
    std::vector<bool> loses_;
    bool known_ = true;
};

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
          live_(module.bound()),
          bodies_(module.functions.empty() ? module.words.size() : module.functions.front().body.front().at),
          keepMembers_(keepMembers) {}

    std::optional<SpirvWords> clear() {
        if (!module_.names.all().empty() || !hasKnownDecorations()) {
            return std::nullopt;
        }
        if (!callsAllFunctions()) {
            return std::nullopt;
        }
        if (!keepMembers_) {
            members_.emplace(module_);
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
            const auto words = entry.second.words();
            return entry.second.opcode == spv::OpDecorateId ||
                   (entry.second.opcode == spv::OpDecorate && words[2] == spv::DecorationBuiltIn &&
                    words[3] == spv::BuiltInWorkgroupSize);
        });
    }

    bool callsAllFunctions() const {
        const std::vector<SpirvFunction> functions = findFunctions(module_.words);
        const auto entry =
            std::ranges::find(module_.globals, std::uint32_t{spv::OpEntryPoint}, &SpirvInstruction::opcode);
        return entry != module_.globals.end() &&
               reachableFrom(entry->operands[1], functions).size() == functions.size();
    }

    // Returns false where code would be dead afterwards.
    bool renameMembers() {
        for (const SpirvInstruction& instruction : module_.code) {
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
        live_.resize(module_.bound() + added_.size());
        return true;
    }

    // Returns a constant of type uint.
    std::optional<std::uint32_t> constantOf(std::uint32_t value) {
        if (uintType_ == 0) {
            for (const SpirvInstruction& global : module_.globals) {
                const auto words = global.words();
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

    void findLive() {
        for (const SpirvInstruction& global : module_.globals) {
            const bool isMode =
                global.opcode == spv::OpExecutionMode || global.opcode == spv::OpExecutionModeId;
            const bool crossesStages =
                global.opcode == spv::OpVariable &&
                (global.words()[3] == spv::StorageClassInput || global.words()[3] == spv::StorageClassOutput);
            if (isMode || crossesStages) {
                addLive(global);
            }
        }
        for (const SpirvInstruction& instruction : module_.code) {
            addLive(instruction);
        }
        while (!found_.empty()) {
            const std::uint32_t id = found_.back();
            found_.pop_back();
            if (id >= module_.bound()) {
                addLive(uintType_);
            } else if (isGlobal(id)) {
                addLive(*module_.definitions[id]);
            }
        }
    }

    void addLive(const SpirvInstruction& instruction) {
        std::size_t first = 0;
        const std::uint32_t structure = structureOf(instruction, first);
        for (std::size_t i = 0; i < instruction.words().size(); ++i) {
            if (module_.isId[instruction.at + i] &&
                (structure == 0 || i < first ||
                 members_->placeOf(structure, static_cast<std::uint32_t>(i - first)) !=
                     LiveMembers::kRemoved)) {
                addLive(words_[instruction.at + i]);
            }
        }
    }

    void addLive(std::uint32_t id) {
        if (!live_[id]) {
            live_[id] = true;
            found_.push_back(id);
        }
    }

    bool isLive(const SpirvInstruction& global) const {
        if (isSpirvPreamble(global.opcode)) {
            return true;
        }
        return live_[global.opcode == spv::OpTypeForwardPointer ? global.words()[1] : global.result];
    }

    bool isGlobal(std::uint32_t id) const {
        return module_.definitions[id] != nullptr && module_.definitions[id]->at < bodies_;
    }
    // The structure whose members the instruction names one after the other from word `first` on, if some of
    // them are removed; otherwise 0.
    std::uint32_t structureOf(const SpirvInstruction& instruction, std::size_t& first) const {
        const bool isType = instruction.opcode == spv::OpTypeStruct;
        if (!members_ || !(isType || isComposite(instruction.opcode))) {
            return 0;
        }
        first = isType ? 2 : kCompositeMembers;
        const std::uint32_t structure = isType ? instruction.result : instruction.type;
        return members_->loses(structure) ? structure : 0;
    }

    SpirvWords write() {
        numbers_.resize(module_.bound() + added_.size());
        SpirvWords to(words_.begin(), words_.begin() + kSpirvHeaderWords);
        to.reserve(words_.size());
        const auto writeGlobals = [&](bool beforeDecorations) {
            for (const SpirvInstruction& global : module_.globals) {
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
            const std::uint32_t type = number(uintType_);
            appendInstruction(to, spv::OpConstant, {type, number(module_.bound() + i), added_[i]});
        }
        for (const SpirvInstruction& instruction : module_.code) {
            write(instruction, to);
        }
        to[kSpirvBoundWord] = next_;
        return to;
    }

    void write(const SpirvInstruction& instruction, SpirvWords& to) {
        const std::size_t begin = to.size();
        std::size_t first = 0;
        const std::uint32_t structure = structureOf(instruction, first);
        const bool isEntry = instruction.opcode == spv::OpEntryPoint;
        for (std::size_t i = 0; i < instruction.words().size(); ++i) {
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
        to[begin] =
            static_cast<std::uint32_t>((to.size() - begin) << spv::WordCountShift) | instruction.opcode;
    }

    void writeDecoration(std::uint32_t target, const SpirvInstruction& decoration, SpirvWords& to) {
        if (isGlobal(target) && !live_[target]) {
            return;
        }
        const std::size_t begin = to.size();
        for (std::size_t at = decoration.at; at < decoration.at + decoration.words().size(); ++at) {
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

    void writeMapped(std::size_t at, SpirvWords& to) {
        to.push_back(module_.isId[at] ? number(words_[at]) : words_[at]);
    }
    std::uint32_t number(std::uint32_t id) {
        if (numbers_[id] == 0) {
            numbers_[id] = next_++;
        }
        return numbers_[id];
    }

    const ParsedModule& module_;
    SpirvWords words_;                  // of the module, with members renamed
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

}  // namespace

std::optional<std::vector<std::uint32_t>> clearGlobals(const ParsedModule& module, bool keepMembers) {
    return Clearing(module, keepMembers).clear();
}

}  // namespace glint::compiler
