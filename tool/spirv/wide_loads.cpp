#include "base/lists.h"
#include "spirv/optimize.h"
#include "spirv/reader.h"

#include <glslang/SPIRV/spirv.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <span>
#include <tuple>
#include <utility>

namespace glint::compiler {

namespace {

constexpr std::uint32_t kWordBytes = 4;
constexpr std::uint32_t kMostWords = 4;  // of a vector
// A load may include as many words between those that are needed.
constexpr std::uint32_t kMostUnused = 1;
// Loads that are further apart, in instructions, are not joined: the later value would wait in registers.
constexpr std::size_t kMostDistance = 64;
constexpr std::size_t kPointerOperand = 3;  // word of OpLoad and of OpAccessChain
constexpr std::size_t kAccessOperand = 4;   // word of OpLoad

// --- Types ----------------------------------------------------------------------------------------

// The types and constants of a module. Types that it lacks are added.
class Types {
public:
    explicit Types(const ParsedModule& module) : module_(module), bound_(module.bound()) {
        for (const SpirvInstruction& global : module.globals) {
            const std::span<const std::uint32_t> words = global.words();
            if (global.opcode == spv::OpTypeInt && words[2] == 32 && words[3] == kUnsigned) {
                unsignedInteger_ = global.result;
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

    // Types that were added have no words here.
    std::span<const std::uint32_t> operator[](std::uint32_t type) const {
        const SpirvInstruction* const definition = definitionOf(type);
        return definition == nullptr ? std::span<const std::uint32_t>() : definition->words();
    }
    std::uint32_t opcodeOf(std::uint32_t type) const {
        const SpirvInstruction* const definition = definitionOf(type);
        return definition == nullptr ? std::uint32_t{spv::OpNop} : definition->opcode;
    }
    bool isAddress(std::uint32_t type) const {
        return opcodeOf(type) == spv::OpTypePointer && (*this)[type][2] == kStorage;
    }
    std::optional<std::uint32_t> constant(std::uint32_t id) const {
        return opcodeOf(id) == spv::OpConstant ? std::optional((*this)[id][3]) : std::nullopt;
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
        if (unsignedInteger_ == 0) {
            unsignedInteger_ = bound_++;
            appendInstruction(added_, spv::OpTypeInt, {unsignedInteger_, 32, kUnsigned});
        }
        return unsignedInteger_;
    }
    std::uint32_t vectorOf(std::uint32_t scalar, std::uint32_t count) {
        if (count == 1) {
            return scalar;
        }
        std::uint32_t& id = vectors_[{scalar, count}];
        if (id == 0) {
            id = bound_++;
            appendInstruction(added_, spv::OpTypeVector, {id, scalar, count});
        }
        return id;
    }
    // Returns a structure of one member that nothing writes. Drivers read uniform values of such memory once
    // for all threads.
    std::uint32_t readOnlyOf(std::uint32_t type) {
        std::uint32_t& id = readOnly_[type];
        if (id == 0) {
            id = bound_++;
            appendInstruction(decorations_, spv::OpMemberDecorate, {id, 0, spv::DecorationNonWritable});
            appendInstruction(decorations_, spv::OpMemberDecorate, {id, 0, spv::DecorationOffset, 0});
            appendInstruction(added_, spv::OpTypeStruct, {id, type});
        }
        return id;
    }
    std::uint32_t addressOf(std::uint32_t type) {
        std::uint32_t& id = pointers_[type];
        if (id == 0) {
            id = bound_++;
            appendInstruction(added_, spv::OpTypePointer, {id, kStorage, type});
        }
        return id;
    }

    // Returns a constant.
    std::uint32_t index(std::uint32_t number) {
        std::uint32_t& id = indices_[number];
        if (id == 0) {
            id = bound_++;
            appendInstruction(added_, spv::OpConstant, {unsignedInteger(), id, number});
        }
        return id;
    }

    std::uint32_t newId() {
        return bound_++;
    }
    std::uint32_t bound() const {
        return bound_;
    }
    const SpirvWords& added() const {
        return added_;
    }
    const SpirvWords& decorations() const {
        return decorations_;
    }

private:
    static constexpr std::uint32_t kStorage = spv::StorageClassPhysicalStorageBuffer;
    static constexpr std::uint32_t kUnsigned = 0;  // of OpTypeInt

    const SpirvInstruction* definitionOf(std::uint32_t id) const {
        return id < module_.bound() ? module_.definitions[id] : nullptr;
    }

    const ParsedModule& module_;
    std::uint32_t bound_;
    std::uint32_t unsignedInteger_ = 0;                                         // 0: none yet
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> vectors_;  // by scalar and count
    std::map<std::uint32_t, std::uint32_t> pointers_;                           // by pointee
    std::map<std::uint32_t, std::uint32_t> indices_;                            // constants by value
    std::map<std::uint32_t, std::uint32_t> readOnly_;                           // structures by member
    SpirvWords added_;
    SpirvWords decorations_;
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
    SpirvInstruction load;
    SpirvInstruction value;           // the same, or the extraction
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
    explicit WideLoads(const ParsedModule& module) : module_(module), types_(module), uses_(module.bound()) {
        for (const SpirvInstruction& instruction : module.code) {
            module.forIds(instruction, [&](std::uint32_t id) {
                ++uses_[id];  // also of the result itself
                if (instruction.result != id && isComposite(module.typeOf(id))) {
                    users_[id].push_back(&instruction);
                }
            });
        }
    }

    SpirvWords make() {
        for (const ParsedFunction& function : module_.functions) {
            read(function);
        }
        return write();
    }

private:
    bool isComposite(std::uint32_t type) const {
        const std::uint32_t opcode = types_.opcodeOf(type);
        return opcode == spv::OpTypeStruct || opcode == spv::OpTypeArray;
    }

    // Returns the ID that stands for an ID.
    std::uint32_t renamed(std::uint32_t id) const {
        const auto found = renamed_.find(id);
        return found == renamed_.end() ? id : found->second;
    }

    // Removes an address that nothing else uses.
    void dropUse(std::uint32_t id) {
        constexpr std::uint32_t kOfItself = 1;
        const SpirvInstruction* const definition = module_.definitions[id];
        if (definition != nullptr && --uses_[id] == kOfItself && isAccessChain(definition->opcode) &&
            !moved_.contains(id) && isNameless(id)) {
            edits_[definition->at].removes = true;
            dropUse(renamed(definition->words()[kPointerOperand]));
        }
    }

    // Adds an index of an array. What is added to an index is a distance, because no index of memory
    // overflows.
    void addIndex(std::uint32_t index, std::uint32_t stride, Place& place) const {
        const SpirvInstruction* definition = module_.definitions[index];
        while (definition != nullptr && definition->opcode == spv::OpIAdd) {
            std::uint32_t rest = definition->words()[3];
            std::optional<std::uint32_t> added = types_.constant(definition->words()[4]);
            if (!added) {
                added = types_.constant(rest);
                rest = definition->words()[4];
            }
            if (!added) {
                break;
            }
            place.offset += *added * stride;
            index = rest;
            definition = module_.definitions[index];
        }
        if (const std::optional<std::uint32_t> number = types_.constant(index)) {
            place.offset += *number * stride;
        } else {
            place.terms.emplace_back(index, stride);
        }
    }

    std::uint32_t offsetOf(std::uint32_t structure, std::uint32_t member) const {
        return module_.decorationOf(structure, spv::DecorationOffset, member).value_or(0);
    }

    // Returns the distance of the elements of an array or a vector.
    std::optional<std::uint32_t> strideOf(std::uint32_t type) const {
        return types_.opcodeOf(type) == spv::OpTypeVector
                   ? std::optional(kWordBytes)
                   : module_.decorationOf(type, spv::DecorationArrayStride);
    }

    Place placeOf(std::uint32_t address) const {
        const SpirvInstruction* const definition = module_.definitions[address];
        if (definition == nullptr || !isAccessChain(definition->opcode) ||
            !types_.isAddress(definition->type)) {
            return {renamed(address), {}};
        }
        const std::span<const std::uint32_t> chain = definition->words();
        Place place = placeOf(renamed(chain[kPointerOperand]));
        std::uint32_t type = types_[module_.typeOf(chain[kPointerOperand])][3];
        for (const std::uint32_t index : chain.subspan(kPointerOperand + 1)) {
            const std::span<const std::uint32_t> words = types_[type];
            const std::optional<std::uint32_t> number = types_.constant(index);
            if (const std::optional<std::uint32_t> stride = strideOf(type)) {
                addIndex(index, *stride, place);
                type = words[2];
            } else if (types_.opcodeOf(type) == spv::OpTypeStruct && number) {
                place.offset += offsetOf(type, *number);
                place.isReadOnly =
                    place.isReadOnly || module_.decorationOf(type, spv::DecorationNonWritable, number);
                type = words[2 + *number];
            } else {
                return {renamed(address), {}};
            }
        }
        return place;
    }

    std::uint32_t addressOf(const SpirvInstruction& load) const {
        return renamed(load.words()[kPointerOperand]);
    }

    bool isPlainLoad(const SpirvInstruction& instruction) const {
        return instruction.opcode == spv::OpLoad && instruction.words().size() == kAccessOperand + 2 &&
               instruction.words()[kAccessOperand] == spv::MemoryAccessAlignedMask &&
               types_.isAddress(module_.typeOf(instruction.words()[kPointerOperand]));
    }

    bool mayWrite(const SpirvInstruction& instruction) const {
        switch (instruction.opcode) {
            case spv::OpStore:
                // Other memory holds nothing that these loads read.
                return types_.isAddress(module_.typeOf(instruction.words()[1]));
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
        for (const SpirvInstruction& instruction : function.body) {
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
                                instruction.words()[kAccessOperand + 1],
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
            users_.contains(id) ? users_.at(id) : Users(), [&](const SpirvInstruction* user) {
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
                for (const std::uint32_t index : user->words().subspan(kPointerOperand + 1)) {
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
        auto sorted = base::mapped<const Load*>(stretch, [](const Load& load) { return &load; });
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
        const SpirvInstruction* const definition = module_.definitions[id];
        // Only functions have an order.
        const auto place = order_.find(id);
        if (place == order_.end() || place->second < order ||
            std::ranges::find(hoisted, id) != hoisted.end()) {
            return true;
        }
        if (moved_.contains(id) ||
            (!isAccessChain(definition->opcode) && definition->opcode != spv::OpIAdd)) {
            return false;
        }
        bool possible = true;
        module_.forIds(
            *definition,
            [&](std::uint32_t operand) { possible = possible && hoist(renamed(operand), order, hoisted); },
            kPointerOperand);
        if (possible) {
            hoisted.push_back(id);
        }
        return possible;
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
        SpirvWords& before = edits_[first.load.at].before;
        for (const std::uint32_t id : hoisted) {
            module_.append(
                *module_.definitions[id], [this](std::uint32_t it) { return renamed(it); }, before);
            moved_.insert(id);
            edits_[module_.definitions[id]->at].removes = true;
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
        appendInstruction(before, spv::OpLoad,
                          {type, value, address, spv::MemoryAccessAlignedMask, lowest.alignment});
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
    std::uint32_t addressFor(const Load& load, std::uint32_t type, SpirvWords& before) {
        std::uint32_t address = addressOf(load.load);
        if (!load.path.empty()) {
            const std::uint32_t part = types_.newId();
            std::vector<std::uint32_t> indices;
            for (const std::uint32_t index : load.path) {
                indices.push_back(types_.index(index));
            }
            appendInstruction(before, spv::OpAccessChain, {types_.addressOf(load.value.type), part, address},
                              indices);
            address = part;
        }
        if (type == load.value.type) {
            return address;
        }
        const std::uint32_t cast = types_.newId();
        const std::uint32_t pointer = types_.addressOf(type);
        if (!load.place.isReadOnly) {
            appendInstruction(before, spv::OpBitcast, {pointer, cast, address});
            return cast;
        }
        const std::uint32_t member = types_.newId();
        appendInstruction(before, spv::OpBitcast, {types_.addressOf(types_.readOnlyOf(type)), cast, address});
        appendInstruction(before, spv::OpAccessChain, {pointer, member, cast, types_.index(0)});
        return member;
    }

    // Takes the value of a load out of a vector, from component `begin` on.
    void take(const Load& load, std::uint32_t value, std::uint32_t scalar, std::uint32_t begin) {
        // Parts of a structure may be extracted in another block than others of the same value.
        SpirvEdit& edit = edits_[load.load.at];
        const std::uint32_t type = load.value.type;
        const std::uint32_t part = types_.vectorOf(scalar, load.words);
        const bool converts = part != type;
        const std::uint32_t id = converts ? types_.newId() : load.value.result;
        if (load.words == 1) {
            appendInstruction(edit.before, spv::OpCompositeExtract, {part, id, value, begin});
        } else {
            std::array<std::uint32_t, kMostWords> components{};
            std::iota(components.begin(), components.end(), begin);
            appendInstruction(edit.before, spv::OpVectorShuffle, {part, id, value, value},
                              std::span(components).first(load.words));
        }
        if (converts) {
            appendInstruction(edit.before, spv::OpBitcast, {type, load.value.result, id});
        }
    }

    SpirvWords write() {
        // Decorations come before types (SPIR-V 2.4).
        const auto type = std::ranges::find_if(module_.globals, [](const SpirvInstruction& it) {
            return it.opcode >= spv::OpTypeVoid && it.opcode <= spv::OpTypeForwardPointer;
        });
        edits_[type->at].before = types_.decorations();
        edits_[module_.code.front().at].before = types_.added();
        return edited(module_, edits_, renamed_, types_.bound());
    }

    const ParsedModule& module_;
    Types types_;
    std::vector<std::uint32_t> uses_;  // by ID; in functions
    using Users = std::vector<const SpirvInstruction*>;
    std::map<std::uint32_t, Users> users_;            // of structures and arrays, by ID
    std::map<std::uint32_t, std::size_t> order_;      // by ID: number of the instruction in its function
    std::map<std::uint32_t, std::uint32_t> renamed_;  // IDs of loads that earlier ones stand for
    std::set<std::uint32_t> moved_;                   // IDs whose instructions stand earlier
    SpirvEdits edits_;
};

}  // namespace

Status widenLoads(std::vector<std::uint32_t>& words, const std::string& name) {
    GLINT_TRY(const ParsedModule module, parseModule(words, name));
    if (!module.functions.empty()) {
        SpirvWords wide = WideLoads(module).make();
        words = std::move(wide);
    }
    return okStatus();
}

}  // namespace glint::compiler
