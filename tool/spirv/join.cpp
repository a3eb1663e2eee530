#include "spirv/join.h"

#include "base/files.h"
#include "spirv/reader.h"

#include <glint/result.h>

#include <fmt/format.h>
#include <glslang/SPIRV/spirv.hpp>

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace glint::compiler {

namespace {

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

bool pointsToPhysicalStorage(const SpirvInstruction& global) {
    return global.opcode == spv::OpTypePointer && global.words()[2] == spv::StorageClassPhysicalStorageBuffer;
}

// Appends the annotations of an ID that tell it from others, in an order of their own and without the ID.
void appendIdentity(const ParsedModule& module, const SpirvInstruction& global, SpirvWords& key) {
    const std::span<const SpirvInstruction> decorations = module.decorations.of(global.result);
    const bool hasNames = global.opcode == spv::OpTypeStruct || global.opcode == spv::OpVariable;
    const std::span<const SpirvInstruction> names =
        hasNames ? module.names.of(global.result) : std::span<const SpirvInstruction>();
    std::vector<std::span<const std::uint32_t>> identity;
    identity.reserve(decorations.size() + names.size());
    for (const std::span<const SpirvInstruction> annotations : {decorations, names}) {
        for (const SpirvInstruction& annotation : annotations) {
            identity.push_back(annotation.words());
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

// Appends an instruction of the module with its IDs replaced.
void appendMapped(const ParsedModule& module, const SpirvInstruction& instruction,
                  const std::vector<std::uint32_t>& ids, SpirvWords& words) {
    module.append(
        instruction, [&](std::uint32_t id) { return ids[id]; }, words);
}

// Two globals are the same if their words are, with IDs replaced by those of the table, and their
// decorations; structures and variables must also have the same names. If a module has several equal globals,
// they stay apart: the first of one module is the first of another.
class GlobalTable {
public:
    using Words = SpirvWords;
    struct HashWords {
        std::size_t operator()(const Words& words) const {
            return static_cast<std::size_t>(base::hashBytes(
                {reinterpret_cast<const std::uint8_t*>(words.data()), words.size() * sizeof(std::uint32_t)}));
        }
    };

    // `keepNames` writes the names of added globals.
    explicit GlobalTable(bool keepNames) : keepNames_(keepNames) {}

    // Adds the globals of a module except its settings (capabilities to entry points). Returns the table's ID
    // for each of the module's, 0 for those that are no globals. Error "spirv-join" if the module declares a
    // resource in another way than an earlier module: other types or decorations of the same binding and
    // name, or of the same built-in variable, or a second block of push constants.
    Result<std::vector<std::uint32_t>> add(const ParsedModule& module, const std::string& shader) {
        Added added;
        added.ids.resize(module.bound());
        for (const SpirvInstruction& global : module.globals) {
            if (isGlobalSetting(global.opcode)) {
                continue;
            }
            if (global.opcode == spv::OpTypeForwardPointer) {
                addForward(module, added, global);
                continue;
            }
            std::uint32_t& id = added.ids[global.result];
            if (pointsToPhysicalStorage(global)) {
                if (id == 0) {
                    const auto [known, isNew] =
                        pointers_.emplace(describePointer(module, global.result), bound_);
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
    // The state while a module is added.
    struct Added {
        std::vector<std::uint32_t> ids;
        std::unordered_map<Words, std::uint32_t, HashWords> counts;  // occurrences of each key so far
    };

    // Describes everything that a pointer leads to. Types that lead back to themselves are named by their
    // order of appearance.
    static Words describePointer(const ParsedModule& module, std::uint32_t id) {
        std::map<std::uint32_t, std::uint32_t> seen;
        Words description;
        const auto describe = [&](const auto& self, std::uint32_t next) -> void {
            const auto [place, isNew] = seen.emplace(next, static_cast<std::uint32_t>(seen.size()));
            description.push_back(place->second);
            if (!isNew || module.definitions[next] == nullptr) {
                return;
            }
            // A description starts with as many words as its first word tells. Its annotations follow.
            const SpirvInstruction& global = *module.definitions[next];
            for (std::size_t i = global.at; i < global.at + global.words().size(); ++i) {
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

    Words keyOf(const ParsedModule& module, const Added& added, const SpirvInstruction& global) const {
        Words key;
        key.reserve(global.words().size() + 1);
        module.append(
            global, [&](std::uint32_t id) { return id == global.result ? 0 : added.ids[id]; }, key);
        appendIdentity(module, global, key);
        return key;
    }

    Status checkResource(const ParsedModule& module, const SpirvInstruction& global,
                         const std::string& shader) {
        if (global.opcode != spv::OpVariable) {
            return okStatus();
        }
        const std::uint32_t storage = global.words()[3];
        std::string resource;
        const auto builtIn = module.decorationOf(global.result, spv::DecorationBuiltIn);
        const auto binding = module.decorationOf(global.result, spv::DecorationBinding);
        if (storage == spv::StorageClassPushConstant) {
            resource = "push constants";
        } else if (builtIn) {
            resource = fmt::format("built-in variable {}", *builtIn);
        } else if (binding) {
            const auto set = module.decorationOf(global.result, spv::DecorationDescriptorSet).value_or(0);
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

    // A pointer that a structure has before its own type is known.
    void addForward(const ParsedModule& module, Added& added, const SpirvInstruction& global) {
        const std::uint32_t pointer = global.words()[1];
        const auto [known, isNew] = pointers_.emplace(describePointer(module, pointer), bound_);
        bound_ += isNew ? 1 : 0;
        added.ids[pointer] = known->second;
        if (isNew) {
            appendMapped(module, global, added.ids, globals_);
        }
    }

    void write(const ParsedModule& module, const Added& added, const SpirvInstruction& global) {
        const std::uint32_t id = added.ids[global.result];
        if (written_.size() <= id) {
            written_.resize(id + 1);
        }
        written_[id] = true;
        appendMapped(module, global, added.ids, global.opcode == spv::OpExtInstImport ? imports_ : globals_);
        for (const SpirvInstruction& decoration : module.decorations.of(global.result)) {
            appendMapped(module, decoration, added.ids, decorations_);
        }
        if (keepNames_) {
            for (const SpirvInstruction& name : module.names.of(global.result)) {
                appendMapped(module, name, added.ids, names_);
            }
        }
        if (global.opcode == spv::OpVariable) {
            variables_.push_back(id);
        }
    }

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

// In a key, marks the number of an ID that only its function has.
constexpr std::uint32_t kOwnId = 0x8000'0000U;

// A function in which its own IDs are numbers with kOwnId, 0 for itself, in the order of their appearance.
struct NumberedFunction {
    SpirvWords words;
    std::vector<std::uint32_t> ids;       // by number
    SpirvWords annotations;               // decorations of those IDs
    std::vector<std::size_t> ownWords;    // indices of `words` with kOwnId
    std::vector<std::size_t> ownTargets;  // indices of such `annotations`
};

class Joiner {
public:
    Joiner(std::string shader, bool keepNames)
        : shader_(std::move(shader)), keepNames_(keepNames), table_(keepNames) {}

    Result<SpirvWords> join(std::span<const std::span<const std::uint32_t>> modules) {
        std::vector<Member> members;
        for (const std::span<const std::uint32_t> words : modules) {
            GLINT_TRY(auto parsed, parseModule(words, shader_));
            if (!members.empty() && words[kSpirvVersionWord] != modules.front()[kSpirvVersionWord]) {
                return refuse("two parts have different versions of SPIR-V");
            }
            GLINT_TRY_DO(addSettings(parsed, members.empty()));
            GLINT_TRY(auto ids, table_.add(parsed, shader_));
            const std::uint32_t bound = parsed.bound();
            members.push_back({std::move(parsed), std::move(ids), std::vector<std::uint32_t>(bound)});
        }
        SpirvWords own;
        SpirvWords imported;
        for (std::size_t i = 1; i < members.size(); ++i) {
            GLINT_TRY_DO(addFunctions(members[i], imported));
        }
        GLINT_TRY_DO(addFunctions(members.front(), own));
        return assemble(members.front(), own, imported);
    }

private:
    // A module and the IDs of the joined module for its own: globals, then functions.
    struct Member {
        ParsedModule module;
        std::vector<std::uint32_t> ids;
        std::vector<std::uint32_t> numbers;  // all 0; for number()
    };

    Diagnostic refuse(const std::string& why) const {
        return makeError("spirv-join", shader_, why,
                         "this is a defect of Glint; please report it with the scene");
    }

    Status addSettings(const ParsedModule& module, bool isFirst) {
        for (const SpirvInstruction& global : module.globals) {
            const auto words = global.words();
            if (global.opcode == spv::OpCapability || global.opcode == spv::OpExtension) {
                const bool links = global.opcode == spv::OpCapability && words[1] == spv::CapabilityLinkage;
                if (!links && settings_.emplace(words.begin(), words.end()).second) {
                    appendWords(global.opcode == spv::OpCapability ? capabilities_ : extensions_, words);
                }
            } else if (global.opcode == spv::OpMemoryModel) {
                if (!isFirst && !std::ranges::equal(words, memoryModel_)) {
                    return refuse("two parts have different memory models");
                }
                memoryModel_.assign(words.begin(), words.end());
            } else if (global.opcode == spv::OpEntryPoint && !isFirst) {
                return refuse("a part has an entry point of its own");
            }
        }
        return okStatus();
    }

    Status addFunctions(Member& member, SpirvWords& functions) {
        for (const ParsedFunction& function : member.module.functions) {
            std::set<std::uint32_t> open;
            GLINT_TRY_DO(addFunction(member, function, open, functions));
        }
        return okStatus();
    }

    // Adds the function after those that it calls. `open` has those that wait for this one.
    Status addFunction(Member& member, const ParsedFunction& function, std::set<std::uint32_t>& open,
                       SpirvWords& functions) {
        if (member.ids[function.id] != 0) {
            return okStatus();
        }
        if (member.module.imports.contains(function.id)) {
            return import(member, function);
        }
        if (!open.insert(function.id).second) {
            return refuse("a part has a function that calls itself");
        }
        for (const SpirvInstruction& instruction : function.body) {
            if (instruction.opcode == spv::OpFunctionCall) {
                const auto called =
                    std::ranges::find(member.module.functions, instruction.words()[3], &ParsedFunction::id);
                if (called == member.module.functions.end()) {
                    return refuse("a part calls a function that it does not have");
                }
                GLINT_TRY_DO(addFunction(member, *called, open, functions));
            }
        }
        const NumberedFunction numbered = number(member, function);
        SpirvWords key = numbered.words;
        appendWords(key, numbered.annotations);
        if (keepNames_) {
            // Functions of different names stay apart, so that each keeps its name.
            const std::string name = member.module.nameOf(function.id);
            key.insert(key.end(), name.begin(), name.end());
        }
        if (const auto known = functions_.find(key); known != functions_.end()) {
            member.ids[function.id] = known->second;
        } else {
            write(member, function, numbered, functions);
            functions_.emplace(std::move(key), member.ids[function.id]);
        }
        if (const auto exported = member.module.exports.find(function.id);
            exported != member.module.exports.end()) {
            const std::uint32_t type = member.ids[function.body.front().words()[4]];
            if (!exports_.emplace(exported->second, Export{member.ids[function.id], type}).second) {
                return refuse(fmt::format("two parts have a function {}", exported->second));
            }
        }
        return okStatus();
    }

    Status import(Member& member, const ParsedFunction& function) {
        const std::string& name = member.module.imports.at(function.id);
        const auto found = exports_.find(name);
        if (found == exports_.end()) {
            return refuse(fmt::format("no part has the function {}", name));
        }
        const std::uint32_t type = member.ids[function.body.front().words()[4]];
        if (type != found->second.type) {
            return refuse(fmt::format("the part with the function {} takes or returns something else", name));
        }
        member.ids[function.id] = found->second.id;
        return okStatus();
    }

    NumberedFunction number(Member& member, const ParsedFunction& function) const {
        const ParsedModule& module = member.module;
        NumberedFunction numbered;
        const auto numberOf = [&](std::uint32_t id) {
            std::uint32_t& number = member.numbers[id];
            if (number == 0) {
                number = kOwnId | static_cast<std::uint32_t>(numbered.ids.size());
                numbered.ids.push_back(id);
            }
            return number;
        };
        numberOf(function.id);
        const auto add = [&](const SpirvInstruction& instruction, SpirvWords& to,
                             std::vector<std::size_t>& own) {
            for (std::size_t i = instruction.at; i < instruction.at + instruction.words().size(); ++i) {
                const std::uint32_t word = module.words[i];
                if (module.isId[i] && member.ids[word] == 0) {
                    own.push_back(to.size());
                    to.push_back(numberOf(word));
                } else {
                    to.push_back(module.isId[i] ? member.ids[word] : word);
                }
            }
        };
        for (const SpirvInstruction& instruction : function.body) {
            add(instruction, numbered.words, numbered.ownWords);
        }
        const std::size_t count = numbered.ids.size();
        for (std::size_t i = 0; i < count; ++i) {
            for (const SpirvInstruction& decoration : module.decorations.of(numbered.ids[i])) {
                add(decoration, numbered.annotations, numbered.ownTargets);
            }
        }
        for (const std::uint32_t id : numbered.ids) {
            member.numbers[id] = 0;
        }
        return numbered;
    }

    void write(Member& member, const ParsedFunction& function, const NumberedFunction& numbered,
               SpirvWords& functions) {
        const std::uint32_t first = table_.takeIds(static_cast<std::uint32_t>(numbered.ids.size()));
        const auto place = [&](const SpirvWords& words, const std::vector<std::size_t>& own, SpirvWords& to) {
            const std::size_t begin = to.size();
            appendWords(to, words);
            for (const std::size_t word : own) {
                to[begin + word] = first + (words[word] & ~kOwnId);
            }
        };
        place(numbered.words, numbered.ownWords, functions);
        place(numbered.annotations, numbered.ownTargets, decorations_);
        for (std::size_t i = 0; i < numbered.ids.size(); ++i) {
            writeNames(member, numbered.ids[i], first + static_cast<std::uint32_t>(i));
        }
        member.ids[function.id] = first;
    }

    void writeNames(const Member& member, std::uint32_t id, std::uint32_t joined) {
        if (!keepNames_) {
            return;
        }
        for (const SpirvInstruction& name : member.module.names.of(id)) {
            const std::size_t target = names_.size() + 1;
            appendWords(names_, name.words());
            names_[target] = joined;
        }
    }

    // Writes the sections in the order of the specification (2.4). `own` has the functions of the first
    // module.
    SpirvWords assemble(const Member& first, const SpirvWords& own, const SpirvWords& imported) const {
        const ParsedModule& module = first.module;
        SpirvWords entry;
        SpirvWords modes;
        SpirvWords source;
        for (const SpirvInstruction& global : module.globals) {
            if (global.opcode == spv::OpEntryPoint) {
                const std::size_t begin = entry.size();
                appendMapped(module, global, first.ids, entry);
                // Since SPIR-V 1.4 an entry point names every variable that it, or a function that it calls,
                // uses.
                std::set<std::uint32_t> named;
                module.forIds(global, [&](std::uint32_t id) { named.insert(first.ids[id]); });
                for (const std::uint32_t variable : table_.variables()) {
                    if (!named.contains(variable)) {
                        entry.push_back(variable);
                    }
                }
                entry[begin] = static_cast<std::uint32_t>((entry.size() - begin) << spv::WordCountShift) |
                               spv::OpEntryPoint;
            } else if (global.opcode == spv::OpExecutionMode || global.opcode == spv::OpExecutionModeId) {
                appendMapped(module, global, first.ids, modes);
            } else if (keepNames_ && global.opcode == spv::OpSource) {
                // The file is left out, because it would need an OpString.
                appendInstruction(source, spv::OpSource, {global.words()[1], global.words()[2]});
            }
        }
        SpirvWords words(module.words.begin(), module.words.begin() + kSpirvHeaderWords);
        words[kSpirvBoundWord] = table_.bound();
        for (const SpirvWords* const section :
             {&capabilities_, &extensions_, &table_.imports(), &memoryModel_, &std::as_const(entry),
              &std::as_const(modes), &std::as_const(source), &table_.names(), &names_, &table_.decorations(),
              &decorations_, &table_.globals(), &own, &imported}) {
            appendWords(words, *section);
        }
        return words;
    }

    std::string shader_;
    bool keepNames_;
    GlobalTable table_;
    SpirvWords capabilities_;
    SpirvWords extensions_;
    SpirvWords memoryModel_;
    std::set<SpirvWords> settings_;  // capabilities and extensions that were added
    SpirvWords decorations_;         // of the functions' definitions
    SpirvWords names_;
    std::unordered_map<SpirvWords, std::uint32_t, GlobalTable::HashWords> functions_;
    struct Export {
        std::uint32_t id = 0;
        std::uint32_t type = 0;
    };
    std::map<std::string, Export> exports_;
};

}  // namespace

Result<std::vector<std::uint32_t>> joinModules(std::span<const std::span<const std::uint32_t>> modules,
                                               const std::string& shader, bool keepNames) {
    if (modules.empty()) {
        return makeError("spirv-join", shader, "there is nothing to join",
                         "this is a defect of Glint; please report it with the scene");
    }
    return Joiner(shader, keepNames).join(modules);
}

}  // namespace glint::compiler
