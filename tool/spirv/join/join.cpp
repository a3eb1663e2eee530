#include "spirv/join/join.h"

#include "spirv/join/global_table.h"
#include "spirv/join/parsed_module.h"
#include "spirv/reader.h"

#include <fmt/format.h>
#include <glslang/SPIRV/spirv.hpp>

#include <algorithm>
#include <map>
#include <set>
#include <unordered_map>
#include <utility>

namespace glint::compiler {

namespace {

using JoinedWords = std::vector<std::uint32_t>;

// In a key, marks the number of an ID that only its function has.
constexpr std::uint32_t kOwnId = 0x8000'0000U;
constexpr std::size_t kVersionWord = 1;  // words of a module's header
constexpr std::size_t kJoinedBound = 3;

void append(JoinedWords& to, std::span<const std::uint32_t> from) {
    to.insert(to.end(), from.begin(), from.end());
}

// A function in which its own IDs are numbers with kOwnId, 0 for itself, in the order of their appearance.
struct NumberedFunction {
    JoinedWords words;
    std::vector<std::uint32_t> ids;       // by number
    JoinedWords annotations;              // decorations of those IDs
    std::vector<std::size_t> ownWords;    // indices of `words` with kOwnId
    std::vector<std::size_t> ownTargets;  // indices of such `annotations`
};

class Joiner {
public:
    Joiner(std::string shader, bool keepNames)
        : shader_(std::move(shader)), keepNames_(keepNames), table_(keepNames) {}

    Result<JoinedWords> join(std::span<const std::span<const std::uint32_t>> modules);

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
    Status addSettings(const ParsedModule& module, bool isFirst);
    Status addFunctions(Member& member, JoinedWords& functions);
    Status addFunction(Member& member, const ParsedFunction& function, std::set<std::uint32_t>& open,
                       JoinedWords& functions);
    Status import(Member& member, const ParsedFunction& function);
    NumberedFunction number(Member& member, const ParsedFunction& function) const;
    void write(Member& member, const ParsedFunction& function, const NumberedFunction& numbered,
               JoinedWords& functions);
    void writeNames(const Member& member, std::uint32_t id, std::uint32_t joined);
    JoinedWords assemble(const Member& first, const JoinedWords& own, const JoinedWords& imported) const;

    std::string shader_;
    bool keepNames_;
    GlobalTable table_;
    JoinedWords capabilities_;
    JoinedWords extensions_;
    JoinedWords memoryModel_;
    std::set<JoinedWords> settings_;  // capabilities and extensions that were added
    JoinedWords decorations_;         // of the functions' definitions
    JoinedWords names_;
    std::unordered_map<JoinedWords, std::uint32_t, GlobalTable::HashWords> functions_;
    struct Export {
        std::uint32_t id = 0;
        std::uint32_t type = 0;
    };
    std::map<std::string, Export> exports_;
};

Status Joiner::addSettings(const ParsedModule& module, bool isFirst) {
    for (const ParsedInstruction& global : module.globals) {
        const auto words = module.wordsOf(global);
        if (global.opcode == spv::OpCapability || global.opcode == spv::OpExtension) {
            const bool links = global.opcode == spv::OpCapability && words[1] == spv::CapabilityLinkage;
            if (!links && settings_.emplace(words.begin(), words.end()).second) {
                append(global.opcode == spv::OpCapability ? capabilities_ : extensions_, words);
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

NumberedFunction Joiner::number(Member& member, const ParsedFunction& function) const {
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
    const auto add = [&](const ParsedInstruction& instruction, JoinedWords& to,
                         std::vector<std::size_t>& own) {
        for (std::size_t i = instruction.at; i < instruction.at + instruction.length; ++i) {
            const std::uint32_t word = module.words[i];
            if (module.isId[i] && member.ids[word] == 0) {
                own.push_back(to.size());
                to.push_back(numberOf(word));
            } else {
                to.push_back(module.isId[i] ? member.ids[word] : word);
            }
        }
    };
    for (const ParsedInstruction& instruction : function.body) {
        add(instruction, numbered.words, numbered.ownWords);
    }
    const std::size_t count = numbered.ids.size();
    for (std::size_t i = 0; i < count; ++i) {
        for (const ParsedInstruction& decoration : module.decorations.of(numbered.ids[i])) {
            add(decoration, numbered.annotations, numbered.ownTargets);
        }
    }
    for (const std::uint32_t id : numbered.ids) {
        member.numbers[id] = 0;
    }
    return numbered;
}

void Joiner::writeNames(const Member& member, std::uint32_t id, std::uint32_t joined) {
    if (!keepNames_) {
        return;
    }
    for (const ParsedInstruction& name : member.module.names.of(id)) {
        const std::size_t target = names_.size() + 1;
        append(names_, member.module.wordsOf(name));
        names_[target] = joined;
    }
}

void Joiner::write(Member& member, const ParsedFunction& function, const NumberedFunction& numbered,
                   JoinedWords& functions) {
    const std::uint32_t first = table_.takeIds(static_cast<std::uint32_t>(numbered.ids.size()));
    const auto place = [&](const JoinedWords& words, const std::vector<std::size_t>& own, JoinedWords& to) {
        const std::size_t begin = to.size();
        append(to, words);
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

Status Joiner::import(Member& member, const ParsedFunction& function) {
    const std::string& name = member.module.imports.at(function.id);
    const auto found = exports_.find(name);
    if (found == exports_.end()) {
        return refuse(fmt::format("no part has the function {}", name));
    }
    const std::uint32_t type = member.ids[member.module.words[function.body.front().at + 4]];
    if (type != found->second.type) {
        return refuse(fmt::format("the part with the function {} takes or returns something else", name));
    }
    member.ids[function.id] = found->second.id;
    return okStatus();
}

// Adds the function after those that it calls. `open` has those that wait for this one.
Status Joiner::addFunction(Member& member, const ParsedFunction& function, std::set<std::uint32_t>& open,
                           JoinedWords& functions) {
    if (member.ids[function.id] != 0) {
        return okStatus();
    }
    if (member.module.imports.contains(function.id)) {
        return import(member, function);
    }
    if (!open.insert(function.id).second) {
        return refuse("a part has a function that calls itself");
    }
    for (const ParsedInstruction& instruction : function.body) {
        if (instruction.opcode == spv::OpFunctionCall) {
            const auto called = std::ranges::find(
                member.module.functions, member.module.words[instruction.at + 3], &ParsedFunction::id);
            if (called == member.module.functions.end()) {
                return refuse("a part calls a function that it does not have");
            }
            GLINT_TRY_DO(addFunction(member, *called, open, functions));
        }
    }
    const NumberedFunction numbered = number(member, function);
    JoinedWords key = numbered.words;
    append(key, numbered.annotations);
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
        const std::uint32_t type = member.ids[member.module.words[function.body.front().at + 4]];
        if (!exports_.emplace(exported->second, Export{member.ids[function.id], type}).second) {
            return refuse(fmt::format("two parts have a function {}", exported->second));
        }
    }
    return okStatus();
}

Status Joiner::addFunctions(Member& member, JoinedWords& functions) {
    for (const ParsedFunction& function : member.module.functions) {
        std::set<std::uint32_t> open;
        GLINT_TRY_DO(addFunction(member, function, open, functions));
    }
    return okStatus();
}

// Writes the sections in the order of the specification (2.4). `own` has the functions of the first module.
JoinedWords Joiner::assemble(const Member& first, const JoinedWords& own, const JoinedWords& imported) const {
    const ParsedModule& module = first.module;
    JoinedWords entry;
    JoinedWords modes;
    JoinedWords source;
    for (const ParsedInstruction& global : module.globals) {
        if (global.opcode == spv::OpEntryPoint) {
            const std::size_t begin = entry.size();
            appendMapped(module, global, first.ids, entry);
            // Since SPIR-V 1.4 an entry point names every variable that it, or a function that it calls,
            // uses.
            std::set<std::uint32_t> named;
            for (std::size_t i = 0; i < global.length; ++i) {
                if (module.isId[global.at + i]) {
                    named.insert(entry[begin + i]);
                }
            }
            for (const std::uint32_t variable : table_.variables()) {
                if (!named.contains(variable)) {
                    entry.push_back(variable);
                }
            }
            entry[begin] =
                static_cast<std::uint32_t>((entry.size() - begin) << spv::WordCountShift) | spv::OpEntryPoint;
        } else if (global.opcode == spv::OpExecutionMode || global.opcode == spv::OpExecutionModeId) {
            appendMapped(module, global, first.ids, modes);
        } else if (keepNames_ && global.opcode == spv::OpSource) {
            // The file is left out, because it would need an OpString.
            append(source, JoinedWords{3U << spv::WordCountShift | spv::OpSource, module.words[global.at + 1],
                                       module.words[global.at + 2]});
        }
    }
    JoinedWords words(module.words.begin(), module.words.begin() + kSpirvHeaderWords);
    words[kJoinedBound] = table_.bound();
    for (const JoinedWords* const section :
         {&capabilities_, &extensions_, &table_.imports(), &memoryModel_, &std::as_const(entry),
          &std::as_const(modes), &std::as_const(source), &table_.names(), &names_, &table_.decorations(),
          &decorations_, &table_.globals(), &own, &imported}) {
        append(words, *section);
    }
    return words;
}

Result<JoinedWords> Joiner::join(std::span<const std::span<const std::uint32_t>> modules) {
    std::vector<Member> members;
    for (const std::span<const std::uint32_t> words : modules) {
        GLINT_TRY(auto parsed, parseModule(words, shader_));
        if (!members.empty() && words[kVersionWord] != modules.front()[kVersionWord]) {
            return refuse("two parts have different versions of SPIR-V");
        }
        GLINT_TRY_DO(addSettings(parsed, members.empty()));
        GLINT_TRY(auto ids, table_.add(parsed, shader_));
        const std::uint32_t bound = parsed.bound();
        members.push_back({std::move(parsed), std::move(ids), std::vector<std::uint32_t>(bound)});
    }
    JoinedWords own;
    JoinedWords imported;
    for (std::size_t i = 1; i < members.size(); ++i) {
        GLINT_TRY_DO(addFunctions(members[i], imported));
    }
    GLINT_TRY_DO(addFunctions(members.front(), own));
    return assemble(members.front(), own, imported);
}

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
