#include "spirv/join/global_table.h"

#include "base/files.h"

#include <fmt/format.h>
#include <glslang/SPIRV/spirv.hpp>

#include <algorithm>
#include <optional>

namespace glint::compiler {

namespace {

using TableWords = GlobalTable::Words;

bool isGlobalSetting(std::uint32_t opcode) {
    switch (opcode) {
        case spv::OpCapability:
        case spv::OpExtension:
        case spv::OpMemoryModel:
        case spv::OpEntryPoint:
        case spv::OpExecutionMode:
        case spv::OpExecutionModeId:
        case spv::OpSource:
        case spv::OpSourceExtension:
        case spv::OpSourceContinued:
            return true;
        default:
            return false;
    }
}

bool pointsToPhysicalStorage(const ParsedModule& module, const ParsedInstruction& global) {
    return global.opcode == spv::OpTypePointer &&
           module.words[global.at + 2] == spv::StorageClassPhysicalStorageBuffer;
}

// Appends the annotations of an ID that tell it from others, in an order of their own and without the ID.
void appendIdentity(const ParsedModule& module, const ParsedInstruction& global, TableWords& key) {
    const std::span<const ParsedInstruction> decorations = module.decorations.of(global.result);
    const bool hasNames = global.opcode == spv::OpTypeStruct || global.opcode == spv::OpVariable;
    const std::span<const ParsedInstruction> names =
        hasNames ? module.names.of(global.result) : std::span<const ParsedInstruction>();
    std::vector<std::span<const std::uint32_t>> identity;
    identity.reserve(decorations.size() + names.size());
    for (const std::span<const ParsedInstruction> annotations : {decorations, names}) {
        for (const ParsedInstruction& annotation : annotations) {
            identity.push_back(module.wordsOf(annotation));
        }
    }
    // The second word is the ID, the same in all of them.
    std::ranges::sort(
        identity, [](const auto& a, const auto& b) { return std::ranges::lexicographical_compare(a, b); });
    for (const std::span<const std::uint32_t> words : identity) {
        key.push_back(words.front());
        key.insert(key.end(), words.begin() + 2, words.end());
    }
}

// Returns the value of a decoration of the ID.
std::optional<std::uint32_t> decorationOf(const ParsedModule& module, std::uint32_t id,
                                          spv::Decoration decoration) {
    for (const ParsedInstruction& instruction : module.decorations.of(id)) {
        const auto words = module.wordsOf(instruction);
        if (instruction.opcode == spv::OpDecorate && words[2] == decoration && words.size() > 3) {
            return words[3];
        }
    }
    return std::nullopt;
}

}  // namespace

// The state while a module is added.
struct GlobalTable::Added {
    std::vector<std::uint32_t> ids;
    std::vector<const ParsedInstruction*> definitions;           // by the module's ID
    std::unordered_map<Words, std::uint32_t, HashWords> counts;  // occurrences of each key so far
};

void appendMapped(const ParsedModule& module, const ParsedInstruction& instruction,
                  const std::vector<std::uint32_t>& ids, std::vector<std::uint32_t>& words) {
    for (std::size_t i = instruction.at; i < instruction.at + instruction.length; ++i) {
        words.push_back(module.isId[i] ? ids[module.words[i]] : module.words[i]);
    }
}

std::size_t GlobalTable::HashWords::operator()(const Words& words) const {
    return static_cast<std::size_t>(base::hashBytes(
        {reinterpret_cast<const std::uint8_t*>(words.data()), words.size() * sizeof(std::uint32_t)}));
}

// Describes everything that a pointer leads to. Types that lead back to themselves are named by their order
// of appearance.
GlobalTable::Words GlobalTable::describePointer(const ParsedModule& module, const Added& added,
                                                std::uint32_t id) {
    std::map<std::uint32_t, std::uint32_t> seen;
    Words description;
    const auto describe = [&](const auto& self, std::uint32_t next) -> void {
        const auto [place, isNew] = seen.emplace(next, static_cast<std::uint32_t>(seen.size()));
        description.push_back(place->second);
        if (!isNew || added.definitions[next] == nullptr) {
            return;
        }
        // A description starts with as many words as its first word tells. Its annotations follow.
        const ParsedInstruction& global = *added.definitions[next];
        for (std::size_t i = global.at; i < global.at + global.length; ++i) {
            if (!module.isId[i]) {
                description.push_back(module.words[i]);
            } else if (module.words[i] != next) {
                self(self, module.words[i]);
            }
        }
        const std::size_t length = description.size();
        description.push_back(0);
        appendIdentity(module, global, description);
        description[length] = static_cast<std::uint32_t>(description.size() - length);
    };
    describe(describe, id);
    return description;
}

GlobalTable::Words GlobalTable::keyOf(const ParsedModule& module, const Added& added,
                                      const ParsedInstruction& global) const {
    Words key;
    key.reserve(global.length + 1);
    for (std::size_t i = global.at; i < global.at + global.length; ++i) {
        const bool isResult = module.isId[i] && module.words[i] == global.result;
        key.push_back(isResult ? 0 : module.isId[i] ? added.ids[module.words[i]] : module.words[i]);
    }
    appendIdentity(module, global, key);
    return key;
}

Status GlobalTable::checkResource(const ParsedModule& module, const ParsedInstruction& global,
                                  const std::string& shader) {
    if (global.opcode != spv::OpVariable) {
        return okStatus();
    }
    const std::uint32_t storage = module.words[global.at + 3];
    std::string resource;
    const auto builtIn = decorationOf(module, global.result, spv::DecorationBuiltIn);
    const auto binding = decorationOf(module, global.result, spv::DecorationBinding);
    if (storage == spv::StorageClassPushConstant) {
        resource = "push constants";
    } else if (builtIn) {
        resource = fmt::format("built-in variable {}", *builtIn);
    } else if (binding) {
        const auto set = decorationOf(module, global.result, spv::DecorationDescriptorSet).value_or(0);
        resource = fmt::format("{} at set {}, binding {}", module.nameOf(global.result), set, *binding);
    } else {
        return okStatus();
    }
    if (!resources_.emplace(resource, global.result).second) {
        return makeError("spirv-join", shader,
                         fmt::format("two parts declare different things: {}", resource),
                         "this is a defect of Glint; please report it with the scene");
    }
    return okStatus();
}

void GlobalTable::write(const ParsedModule& module, const Added& added, const ParsedInstruction& global) {
    const std::uint32_t id = added.ids[global.result];
    if (written_.size() <= id) {
        written_.resize(id + 1);
    }
    written_[id] = true;
    appendMapped(module, global, added.ids, global.opcode == spv::OpExtInstImport ? imports_ : globals_);
    for (const ParsedInstruction& decoration : module.decorations.of(global.result)) {
        appendMapped(module, decoration, added.ids, decorations_);
    }
    if (keepNames_) {
        for (const ParsedInstruction& name : module.names.of(global.result)) {
            appendMapped(module, name, added.ids, names_);
        }
    }
    if (global.opcode == spv::OpVariable) {
        variables_.push_back(id);
    }
}

// A pointer that a structure has before its own type is known.
void GlobalTable::addForward(const ParsedModule& module, Added& added, const ParsedInstruction& global) {
    const std::uint32_t pointer = module.words[global.at + 1];
    const auto [known, isNew] = pointers_.emplace(describePointer(module, added, pointer), bound_);
    bound_ += isNew ? 1 : 0;
    added.ids[pointer] = known->second;
    if (isNew) {
        appendMapped(module, global, added.ids, globals_);
    }
}

Result<std::vector<std::uint32_t>> GlobalTable::add(const ParsedModule& module, const std::string& shader) {
    Added added;
    added.ids.resize(module.bound());
    added.definitions.resize(module.bound());
    for (const ParsedInstruction& global : module.globals) {
        if (global.result != 0) {
            added.definitions[global.result] = &global;
        }
    }
    for (const ParsedInstruction& global : module.globals) {
        if (isGlobalSetting(global.opcode)) {
            continue;
        }
        if (global.opcode == spv::OpTypeForwardPointer) {
            addForward(module, added, global);
            continue;
        }
        std::uint32_t& id = added.ids[global.result];
        if (pointsToPhysicalStorage(module, global)) {
            if (id == 0) {
                const auto [known, isNew] =
                    pointers_.emplace(describePointer(module, added, global.result), bound_);
                bound_ += isNew ? 1 : 0;
                id = known->second;
            }
            if (written_.size() <= id || !written_[id]) {
                write(module, added, global);
            }
            continue;
        }
        Words key = keyOf(module, added, global);
        key.push_back(added.counts[key]++);
        const auto [known, isNew] = known_.emplace(std::move(key), bound_);
        id = known->second;
        if (isNew) {
            ++bound_;
            GLINT_TRY_DO(checkResource(module, global, shader));
            write(module, added, global);
        }
    }
    return std::move(added.ids);
}

}  // namespace glint::compiler
