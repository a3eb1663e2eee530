#include "spirv/finish.h"
#include "spirv/join/parsed_module.h"
#include "spirv/reader.h"

#include <glslang/SPIRV/spirv.hpp>

#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <tuple>
#include <utility>

namespace glint::compiler {

namespace {

using Words = std::vector<std::uint32_t>;

constexpr std::uint32_t kWordBytes = 4;
constexpr std::uint32_t kMostWords = 4;  // of a vector
// A load may include as many words between those that are needed.
constexpr std::uint32_t kMostUnused = 1;
// Loads that are further apart, in instructions, are not joined: the later value would wait in registers.
constexpr std::size_t kMostDistance = 64;
constexpr std::size_t kPointerOperand = 3;  // word of OpLoad and of OpAccessChain
constexpr std::size_t kAccessOperand = 4;   // word of OpLoad

void append(Words& words, spv::Op opcode, std::initializer_list<std::uint32_t> operands) {
    words.push_back(static_cast<std::uint32_t>(operands.size() + 1) << spv::WordCountShift | opcode);
    words.insert(words.end(), operands);
}

bool isAccessChain(std::uint32_t opcode) {
    return opcode == spv::OpAccessChain || opcode == spv::OpInBoundsAccessChain;
}

// --- Types ----------------------------------------------------------------------------------------

// The types and constants of a module. Types that it lacks are added.
class Types {
public:
    explicit Types(const ParsedModule& module) : module_(module), bound_(module.bound()) {
        for (const ParsedInstruction& global : module.globals) {
            globals_[global.result] = &global;
            const std::span<const std::uint32_t> words = module.wordsOf(global);
            if (global.opcode == spv::OpTypeInt || global.opcode == spv::OpTypeFloat) {
                scalars_.insert({{words[0] & spv::OpCodeMask, words[2]}, words[1]});
            } else if (global.opcode == spv::OpTypeVector) {
                vectors_[{words[2], words[3]}] = words[1];
            } else if (global.opcode == spv::OpTypePointer && words[2] == kStorage) {
                pointers_[words[3]] = words[1];
            } else if (global.opcode == spv::OpConstant && opcodeOf(words[1]) == spv::OpTypeInt &&
                       (*this)[words[1]][2] == 32) {
                indices_[words[3]] = words[2];
            }
        }
    }

    static constexpr std::uint32_t kStorage = spv::StorageClassPhysicalStorageBuffer;

    std::span<const std::uint32_t> operator[](std::uint32_t type) const {
        const auto found = globals_.find(type);
        return found == globals_.end() ? std::span<const std::uint32_t>() : module_.wordsOf(*found->second);
    }
    std::uint32_t opcodeOf(std::uint32_t type) const {
        const auto found = globals_.find(type);
        return found == globals_.end() ? std::uint32_t{spv::OpNop} : found->second->opcode;
    }
    bool isAddress(std::uint32_t type) const {
        return opcodeOf(type) == spv::OpTypePointer && (*this)[type][2] == kStorage;
    }
    std::optional<std::uint32_t> constant(std::uint32_t id) const {
        return opcodeOf(id) == spv::OpConstant ? std::optional((*this)[id][3]) : std::nullopt;
    }
    // Returns the literal of a decoration, of a member if there is one.
    std::optional<std::uint32_t> decoration(std::uint32_t id, spv::Decoration decoration,
                                            std::optional<std::uint32_t> member = std::nullopt) const {
        for (const ParsedInstruction& it : module_.decorations.of(id)) {
            const std::span<const std::uint32_t> words = module_.wordsOf(it);
            if (member ? it.opcode == spv::OpMemberDecorate && words[2] == *member && words[3] == decoration
                       : it.opcode == spv::OpDecorate && words[2] == decoration) {
                return words.back();
            }
        }
        return std::nullopt;
    }

    // Returns the number of words of a value that loads may be joined to, or 0.
    std::uint32_t wordsOf(std::uint32_t type) const {
        if (isAddress(type)) {
            return 2;
        }
        const std::uint32_t opcode = opcodeOf(type);
        if (opcode == spv::OpTypeVector) {
            return wordsOf((*this)[type][2]) == 1 ? (*this)[type][3] : 0;
        }
        return (opcode == spv::OpTypeInt || opcode == spv::OpTypeFloat) && (*this)[type][2] == 32 ? 1 : 0;
    }
    // Returns the scalar of a scalar or of a vector; of an address the unsigned integer.
    std::uint32_t scalarOf(std::uint32_t type) {
        const std::uint32_t opcode = opcodeOf(type);
        return isAddress(type) ? unsignedInteger() : opcode == spv::OpTypeVector ? (*this)[type][2] : type;
    }
    std::uint32_t unsignedInteger() {
        constexpr std::uint32_t kUnsigned = 0;
        for (auto [it, end] = scalars_.equal_range({spv::OpTypeInt, 32}); it != end; ++it) {
            if ((*this)[it->second].empty() || (*this)[it->second][3] == kUnsigned) {
                return it->second;
            }
        }
        const std::uint32_t id = bound_++;
        append(added_, spv::OpTypeInt, {id, 32, kUnsigned});
        scalars_.insert({{spv::OpTypeInt, 32}, id});
        return id;
    }
    std::uint32_t vectorOf(std::uint32_t scalar, std::uint32_t count) {
        if (count == 1) {
            return scalar;
        }
        std::uint32_t& id = vectors_[{scalar, count}];
        if (id == 0) {
            id = bound_++;
            append(added_, spv::OpTypeVector, {id, scalar, count});
        }
        return id;
    }
    // Returns a structure of one member that nothing writes. Drivers read uniform values of such memory once
    // for all threads.
    std::uint32_t readOnlyOf(std::uint32_t type) {
        std::uint32_t& id = readOnly_[type];
        if (id == 0) {
            id = bound_++;
            append(decorations_, spv::OpMemberDecorate, {id, 0, spv::DecorationNonWritable});
            append(decorations_, spv::OpMemberDecorate, {id, 0, spv::DecorationOffset, 0});
            append(added_, spv::OpTypeStruct, {id, type});
        }
        return id;
    }
    std::uint32_t addressOf(std::uint32_t type) {
        std::uint32_t& id = pointers_[type];
        if (id == 0) {
            id = bound_++;
            append(added_, spv::OpTypePointer, {id, kStorage, type});
        }
        return id;
    }

    // Returns a constant.
    std::uint32_t index(std::uint32_t number) {
        std::uint32_t& id = indices_[number];
        if (id == 0) {
            id = bound_++;
            append(added_, spv::OpConstant, {unsignedInteger(), id, number});
        }
        return id;
    }

    std::uint32_t newId() {
        return bound_++;
    }
    std::uint32_t bound() const {
        return bound_;
    }
    const Words& added() const {
        return added_;
    }
    const Words& decorations() const {
        return decorations_;
    }

private:
    const ParsedModule& module_;
    std::uint32_t bound_;
    std::map<std::uint32_t, const ParsedInstruction*> globals_;
    std::multimap<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> scalars_;  // by opcode and bits
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> vectors_;       // by scalar and count
    std::map<std::uint32_t, std::uint32_t> pointers_;                                // by pointee
    std::map<std::uint32_t, std::uint32_t> indices_;                                 // constants by value
    std::map<std::uint32_t, std::uint32_t> readOnly_;                                // structures by member
    Words added_;
    Words decorations_;
};

// --- Addresses ------------------------------------------------------------------------------------

// A place in memory: bytes behind an address.
struct Place {
    std::uint32_t base = 0;                                      // ID of the address
    std::vector<std::pair<std::uint32_t, std::uint32_t>> terms;  // IDs of indices and their strides
    std::uint32_t offset = 0;
    bool isReadOnly = false;  // nothing writes there while the shader runs

    auto sum() const {
        return std::tie(base, terms, isReadOnly);
    }
};

// A value that is read from memory: a load, or what is extracted from the load of a structure.
struct Load {
    ParsedInstruction load;
    ParsedInstruction value;          // the same, or the extraction
    std::vector<std::uint32_t> path;  // of the extraction
    Place place;
    std::uint32_t words = 0;
    std::uint32_t alignment = 0;  // bytes
    std::size_t order = 0;        // number of the load in its function
};

// Loads that one load of a vector replaces, by their places.
using Window = std::vector<const Load*>;

class WideLoads {
public:
    explicit WideLoads(const ParsedModule& module)
        : module_(module), types_(module), definitions_(module.bound()), uses_(module.bound()) {
        for (const ParsedFunction& function : module.functions) {
            for (const ParsedInstruction& instruction : function.body) {
                definitions_[instruction.result] = &instruction;
                for (std::size_t at = instruction.at + 1; at < instruction.at + instruction.length; ++at) {
                    if (module.isId[at]) {
                        ++uses_[module.words[at]];  // also of the result itself
                        noteUser(module.words[at], instruction);
                    }
                }
            }
        }
    }

    Words make() {
        for (const ParsedFunction& function : module_.functions) {
            read(function);
        }
        return write();
    }

private:
    struct Edit {
        Words before;
        bool removes = false;
    };

    void noteUser(std::uint32_t id, const ParsedInstruction& user) {
        if (user.result != id && isComposite(typeOf(id))) {
            users_[id].push_back(&user);
        }
    }

    bool isComposite(std::uint32_t type) const {
        const std::uint32_t opcode = types_.opcodeOf(type);
        return opcode == spv::OpTypeStruct || opcode == spv::OpTypeArray;
    }

    std::uint32_t typeOf(std::uint32_t id) const {
        const ParsedInstruction* const definition = definitions_[id];
        return definition != nullptr ? definition->type : 0;
    }

    // Returns the ID that stands for an ID.
    std::uint32_t renamed(std::uint32_t id) const {
        const auto found = renamed_.find(id);
        return found == renamed_.end() ? id : found->second;
    }

    // Appends an instruction with the IDs that stand for its own.
    void copy(const ParsedInstruction& instruction, Words& to) const {
        for (std::size_t at = instruction.at; at < instruction.at + instruction.length; ++at) {
            to.push_back(module_.isId[at] ? renamed(module_.words[at]) : module_.words[at]);
        }
    }

    // Removes an address that nothing else uses.
    void dropUse(std::uint32_t id) {
        constexpr std::uint32_t kOfItself = 1;
        const ParsedInstruction* const definition = definitions_[id];
        if (definition != nullptr && --uses_[id] == kOfItself && isAccessChain(definition->opcode) &&
            !moved_.contains(id) && isNameless(id)) {
            edits_[definition->at].removes = true;
            dropUse(renamed(module_.words[definition->at + kPointerOperand]));
        }
    }

    // Adds an index of an array. What is added to an index is a distance, because no index of memory
    // overflows.
    void addIndex(std::uint32_t index, std::uint32_t stride, Place& place) const {
        const ParsedInstruction* definition = definitions_[index];
        while (definition != nullptr && definition->opcode == spv::OpIAdd) {
            std::uint32_t rest = module_.words[definition->at + 3];
            std::optional<std::uint32_t> added = types_.constant(module_.words[definition->at + 4]);
            if (!added) {
                added = types_.constant(rest);
                rest = module_.words[definition->at + 4];
            }
            if (!added) {
                break;
            }
            place.offset += *added * stride;
            index = rest;
            definition = definitions_[index];
        }
        if (const std::optional<std::uint32_t> number = types_.constant(index)) {
            place.offset += *number * stride;
        } else {
            place.terms.emplace_back(index, stride);
        }
    }

    std::uint32_t offsetOf(std::uint32_t structure, std::uint32_t member) const {
        return types_.decoration(structure, spv::DecorationOffset, member).value_or(0);
    }

    // Returns the distance of the elements of an array or a vector.
    std::optional<std::uint32_t> strideOf(std::uint32_t type) const {
        return types_.opcodeOf(type) == spv::OpTypeVector
                   ? std::optional(kWordBytes)
                   : types_.decoration(type, spv::DecorationArrayStride);
    }

    Place placeOf(std::uint32_t address) const {
        const ParsedInstruction* const definition = definitions_[address];
        if (definition == nullptr || !isAccessChain(definition->opcode) ||
            !types_.isAddress(definition->type)) {
            return {renamed(address), {}};
        }
        const std::span<const std::uint32_t> chain = module_.wordsOf(*definition);
        Place place = placeOf(renamed(chain[kPointerOperand]));
        std::uint32_t type = types_[typeOf(chain[kPointerOperand])][3];
        for (const std::uint32_t index : chain.subspan(kPointerOperand + 1)) {
            const std::span<const std::uint32_t> words = types_[type];
            const std::optional<std::uint32_t> number = types_.constant(index);
            if (const std::optional<std::uint32_t> stride = strideOf(type)) {
                addIndex(index, *stride, place);
                type = words[2];
            } else if (types_.opcodeOf(type) == spv::OpTypeStruct && number) {
                place.offset += offsetOf(type, *number);
                place.isReadOnly =
                    place.isReadOnly || types_.decoration(type, spv::DecorationNonWritable, number);
                type = words[2 + *number];
            } else {
                return {renamed(address), {}};
            }
        }
        return place;
    }

    std::uint32_t addressOf(const ParsedInstruction& load) const {
        return renamed(module_.words[load.at + kPointerOperand]);
    }

    bool isPlainLoad(const ParsedInstruction& instruction) const {
        return instruction.opcode == spv::OpLoad && instruction.length == kAccessOperand + 2 &&
               module_.words[instruction.at + kAccessOperand] == spv::MemoryAccessAlignedMask &&
               types_.isAddress(typeOf(module_.words[instruction.at + kPointerOperand]));
    }

    bool mayWrite(const ParsedInstruction& instruction) const {
        switch (instruction.opcode) {
            case spv::OpStore:
                // Other memory holds nothing that these loads read.
                return types_.isAddress(typeOf(module_.words[instruction.at + 1]));
            case spv::OpCopyMemory:
            case spv::OpFunctionCall:
            case spv::OpControlBarrier:
            case spv::OpMemoryBarrier:
            case spv::OpTraceRayKHR:
            case spv::OpExecuteCallableKHR:
            case spv::OpLabel:
                return true;
            default:
                return instruction.opcode >= spv::OpAtomicLoad && instruction.opcode <= spv::OpAtomicXor;
        }
    }

    void read(const ParsedFunction& function) {
        std::vector<Load> stretch;
        std::size_t order = 0;
        for (const ParsedInstruction& instruction : function.body) {
            order_[instruction.result] = ++order;
            if (mayWrite(instruction)) {
                join(stretch);
                stretch.clear();
            } else if (isPlainLoad(instruction)) {
                const std::uint32_t address = addressOf(instruction);
                const Load load{instruction,
                                instruction,
                                {},
                                placeOf(address),
                                types_.wordsOf(instruction.type),
                                module_.words[instruction.at + kAccessOperand + 1],
                                order};
                if (load.words > 0) {
                    add(load, stretch);
                } else if (isComposite(instruction.type)) {
                    split(load, stretch);
                }
            }
        }
        join(stretch);
    }

    void add(const Load& load, std::vector<Load>& stretch) {
        const auto same = std::ranges::find_if(stretch, [&](const Load& other) {
            return other.place.sum() == load.place.sum() && other.place.offset == load.place.offset &&
                   other.value.type == load.value.type;
        });
        if (same == stretch.end() || !merge(load, same->value.result)) {
            stretch.push_back(load);
        }
    }

    // Reads of a structure what is extracted from it.
    void split(const Load& load, std::vector<Load>& stretch) {
        std::vector<Load> parts;
        std::vector<std::size_t> copies;
        if (!collectParts(load, load.load.result, parts, copies)) {
            return;
        }
        edits_[load.load.at].removes = true;
        for (const std::size_t copy : copies) {
            edits_[copy].removes = true;
        }
        for (const Load& part : parts) {
            add(part, stretch);
        }
    }

    bool collectParts(const Load& whole, std::uint32_t id, std::vector<Load>& parts,
                      std::vector<std::size_t>& copies) const {
        if (!isNameless(id)) {
            return false;
        }
        return std::ranges::all_of(
            users_.contains(id) ? users_.at(id) : Users(), [&](const ParsedInstruction* user) {
                if (user->opcode == spv::OpCopyLogical) {
                    copies.push_back(user->at);
                    return collectParts(whole, user->result, parts, copies);
                }
                if (user->opcode != spv::OpCompositeExtract) {
                    return false;
                }
                Load part = whole;
                part.value = *user;
                std::uint32_t type = whole.load.type;
                std::uint32_t offset = 0;
                for (const std::uint32_t index : module_.wordsOf(*user).subspan(kPointerOperand + 1)) {
                    const std::optional<std::uint32_t> stride = strideOf(type);
                    offset += stride ? *stride * index : offsetOf(type, index);
                    type = types_[type][stride ? 2 : 2 + index];
                    part.path.push_back(index);
                }
                part.place.offset += offset;
                part.words = types_.wordsOf(type);
                part.alignment =
                    std::min(part.alignment, offset == 0 ? part.alignment : offset & (~offset + 1));
                parts.push_back(std::move(part));
                return parts.back().words > 0;
            });
    }

    bool isNameless(std::uint32_t id) const {
        return module_.names.of(id).empty() && module_.decorations.of(id).empty();
    }

    // Removes a load whose value is known.
    bool merge(const Load& load, std::uint32_t value) {
        const std::uint32_t id = load.value.result;
        if (!isNameless(id)) {
            return false;
        }
        renamed_[id] = value;
        uses_[value] += uses_[id] - 1;
        edits_[load.value.at].removes = true;
        dropUseOf(load);
        return true;
    }

    void dropUseOf(const Load& load) {
        // The parts of a structure have its address once.
        if (load.path.empty()) {
            dropUse(addressOf(load.load));
        }
    }

    // Joins the loads of a stretch of a block in which nothing writes memory.
    void join(const std::vector<Load>& stretch) {
        std::vector<const Load*> sorted;
        for (const Load& load : stretch) {
            sorted.push_back(&load);
        }
        std::ranges::stable_sort(sorted, [](const Load* a, const Load* b) {
            return std::tuple(a->place.sum(), a->place.offset) < std::tuple(b->place.sum(), b->place.offset);
        });
        Window window;
        std::uint32_t end = 0;
        for (const Load* load : sorted) {
            if (!window.empty() && !fits(window, end, *load)) {
                replace(window);
                window.clear();
            }
            end = window.empty() ? 0 : end;
            window.push_back(load);
            end = std::max(end, load->place.offset + kWordBytes * load->words);
        }
        replace(window);
    }

    static bool fits(const Window& window, std::uint32_t end, const Load& load) {
        const Place& first = window.front()->place;
        const auto [least, most] = std::ranges::minmax(window, {}, [](const Load* it) { return it->order; });
        return load.place.sum() == first.sum() && (load.place.offset - first.offset) % kWordBytes == 0 &&
               load.place.offset <= end + kWordBytes * kMostUnused &&
               load.place.offset + kWordBytes * load.words <= first.offset + kWordBytes * kMostWords &&
               load.order < least->order + kMostDistance && most->order < load.order + kMostDistance;
    }

    // Appends what makes an address before the instruction of number `order`: instructions that stand behind
    // it and may stand before it. Returns whether that is possible.
    bool hoist(std::uint32_t id, std::size_t order, std::vector<std::uint32_t>& hoisted) const {
        const ParsedInstruction* const definition = definitions_[id];
        if (definition == nullptr || order_.at(id) < order ||
            std::ranges::find(hoisted, id) != hoisted.end()) {
            return true;
        }
        if (moved_.contains(id) ||
            (!isAccessChain(definition->opcode) && definition->opcode != spv::OpIAdd)) {
            return false;
        }
        for (std::size_t at = definition->at + kPointerOperand; at < definition->at + definition->length;
             ++at) {
            if (module_.isId[at] && !hoist(renamed(module_.words[at]), order, hoisted)) {
                return false;
            }
        }
        hoisted.push_back(id);
        return true;
    }

    void replace(Window window) {
        if (window.empty() || (window.size() == 1 && window.front()->path.empty())) {
            return;
        }
        const Load& lowest = *window.front();
        const Load& first = **std::ranges::min_element(window, {}, [](const Load* it) { return it->order; });
        std::vector<std::uint32_t> hoisted;
        if (!hoist(addressOf(lowest.load), first.order, hoisted)) {
            // Without the lowest one, the others may still be joined.
            replace({window.begin(), window.begin() + 1});
            replace({window.begin() + 1, window.end()});
            return;
        }
        Words& before = edits_[first.load.at].before;
        for (const std::uint32_t id : hoisted) {
            copy(*definitions_[id], before);
            moved_.insert(id);
            edits_[definitions_[id]->at].removes = true;
            order_[id] = first.order - 1;
        }
        std::uint32_t count = 0;
        for (const Load* load : window) {
            count = std::max(count, beginIn(window, *load) + load->words);
        }
        const std::uint32_t ofLowest = types_.scalarOf(lowest.value.type);
        const bool isAlike = std::ranges::all_of(
            window, [&](const Load* load) { return types_.scalarOf(load->value.type) == ofLowest; });
        const bool isAlone = window.size() == 1;
        const std::uint32_t scalar = isAlike ? ofLowest : types_.unsignedInteger();
        const std::uint32_t type = isAlone ? lowest.value.type : types_.vectorOf(scalar, count);
        const std::uint32_t value = isAlone ? lowest.value.result : types_.newId();
        const std::uint32_t address = addressFor(lowest, type, before);
        append(before, spv::OpLoad, {type, value, address, spv::MemoryAccessAlignedMask, lowest.alignment});
        for (const Load* load : window) {
            edits_[load->value.at].removes = true;
            if (load != &lowest) {
                dropUseOf(*load);
            }
            if (!isAlone) {
                take(*load, value, scalar, beginIn(window, *load));
            }
        }
    }

    static std::uint32_t beginIn(const Window& window, const Load& load) {
        return (load.place.offset - window.front()->place.offset) / kWordBytes;
    }

    // Returns the address of a value as that of a value of another type.
    std::uint32_t addressFor(const Load& load, std::uint32_t type, Words& before) {
        std::uint32_t address = addressOf(load.load);
        if (!load.path.empty()) {
            const std::uint32_t part = types_.newId();
            std::vector<std::uint32_t> indices;
            for (const std::uint32_t index : load.path) {
                indices.push_back(types_.index(index));
            }
            before.push_back(static_cast<std::uint32_t>(4 + indices.size()) << spv::WordCountShift |
                             spv::OpAccessChain);
            before.insert(before.end(), {types_.addressOf(load.value.type), part, address});
            before.insert(before.end(), indices.begin(), indices.end());
            address = part;
        }
        if (type == load.value.type) {
            return address;
        }
        const std::uint32_t cast = types_.newId();
        const std::uint32_t pointer = types_.addressOf(type);
        if (!load.place.isReadOnly) {
            append(before, spv::OpBitcast, {pointer, cast, address});
            return cast;
        }
        const std::uint32_t member = types_.newId();
        append(before, spv::OpBitcast, {types_.addressOf(types_.readOnlyOf(type)), cast, address});
        append(before, spv::OpAccessChain, {pointer, member, cast, types_.index(0)});
        return member;
    }

    // Takes the value of a load out of a vector, from component `begin` on.
    void take(const Load& load, std::uint32_t value, std::uint32_t scalar, std::uint32_t begin) {
        // Parts of a structure may be extracted in another block than others of the same value.
        Edit& edit = edits_[load.load.at];
        const std::uint32_t type = load.value.type;
        const std::uint32_t part = types_.vectorOf(scalar, load.words);
        const bool converts = part != type;
        const std::uint32_t id = converts ? types_.newId() : load.value.result;
        if (load.words == 1) {
            append(edit.before, spv::OpCompositeExtract, {part, id, value, begin});
        } else {
            edit.before.push_back((5 + load.words) << spv::WordCountShift | spv::OpVectorShuffle);
            edit.before.insert(edit.before.end(), {part, id, value, value});
            for (std::uint32_t i = 0; i < load.words; ++i) {
                edit.before.push_back(begin + i);
            }
        }
        if (converts) {
            append(edit.before, spv::OpBitcast, {type, load.value.result, id});
        }
    }

    Words write() {
        Words to;
        to.reserve(module_.words.size());
        std::size_t from = 0;
        const auto keepUntil = [&](std::size_t end) {
            for (; from < end; ++from) {
                to.push_back(module_.isId[from] ? renamed(module_.words[from]) : module_.words[from]);
            }
        };
        // Decorations come before types (SPIR-V 2.4).
        const auto type = std::ranges::find_if(module_.globals, [](const ParsedInstruction& it) {
            return it.opcode >= spv::OpTypeVoid && it.opcode <= spv::OpTypeForwardPointer;
        });
        keepUntil(type->at);
        to.insert(to.end(), types_.decorations().begin(), types_.decorations().end());
        keepUntil(module_.functions.front().body.front().at);
        to.insert(to.end(), types_.added().begin(), types_.added().end());
        for (const auto& [at, edit] : edits_) {
            keepUntil(at);
            to.insert(to.end(), edit.before.begin(), edit.before.end());
            from += edit.removes ? module_.words[at] >> spv::WordCountShift : 0;
        }
        keepUntil(module_.words.size());
        to[kSpirvBoundWord] = types_.bound();
        return to;
    }

    const ParsedModule& module_;
    Types types_;
    std::vector<const ParsedInstruction*> definitions_;  // by ID; of functions
    std::vector<std::uint32_t> uses_;                    // by ID; in functions
    using Users = std::vector<const ParsedInstruction*>;
    std::map<std::uint32_t, Users> users_;            // of structures and arrays, by ID
    std::map<std::uint32_t, std::size_t> order_;      // by ID: number of the instruction in its function
    std::map<std::uint32_t, std::uint32_t> renamed_;  // IDs of loads that earlier ones stand for
    std::set<std::uint32_t> moved_;                   // IDs whose instructions stand earlier
    std::map<std::size_t, Edit> edits_;               // by the word of an instruction
};

}  // namespace

Status widenLoads(std::vector<std::uint32_t>& words, const std::string& name) {
    GLINT_TRY(const ParsedModule module, parseModule(words, name));
    if (!module.functions.empty()) {
        Words wide = WideLoads(module).make();
        words = std::move(wide);
    }
    return okStatus();
}

}  // namespace glint::compiler
