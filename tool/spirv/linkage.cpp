#include "spirv/linkage.h"

#include "spirv/call_graph.h"
#include "spirv/reader.h"

#include <glslang/SPIRV/spirv.hpp>

#include <algorithm>
#include <map>
#include <set>

namespace glint::compiler {

namespace {

using Words = std::vector<std::uint32_t>;

// The parts of a module, in the order of the specification (2.4).
struct Parts {
    Words capabilities;
    Words settings;  // extensions, imports of instructions, memory model, entry points
    Words names;
    Words decorations;
    Words globals;
    Words declarations;
    Words definitions;
};

// The treatment of a function.
enum class Fate { Defined, Declared, Removed };

std::size_t lengthAt(std::span<const std::uint32_t> words, std::size_t at) {
    return words[at] >> spv::WordCountShift;
}

// Calls visit(at, opcode) for each instruction of a valid module.
template <typename Visit>
void forEachInstruction(std::span<const std::uint32_t> words, const Visit& visit) {
    for (std::size_t at = kSpirvHeaderWords; at < words.size(); at += lengthAt(words, at)) {
        visit(at, static_cast<spv::Op>(words[at] & spv::OpCodeMask));
    }
}

std::map<std::uint32_t, Fate> fatesOf(std::span<const std::uint32_t> words,
                                      const std::vector<SpirvFunction>& functions, const LinkNames& names) {
    std::map<std::uint32_t, Fate> fates;
    for (const SpirvFunction& function : functions) {
        const bool imported = std::ranges::find(names.imported, function.name) != names.imported.end();
        fates[function.id] = imported ? Fate::Declared : Fate::Defined;
    }
    forEachInstruction(words, [&](std::size_t at, spv::Op opcode) {
        if (opcode == spv::OpEntryPoint && !names.keepsEntryPoint) {
            fates[words[at + 2]] = Fate::Removed;
        }
    });
    return fates;
}

// Returns whether the instruction of a function with this fate stays.
bool stays(Fate fate, spv::Op opcode) {
    return fate == Fate::Defined ||
           (fate == Fate::Declared && (opcode == spv::OpFunction || opcode == spv::OpFunctionParameter ||
                                       opcode == spv::OpFunctionEnd));
}

std::set<std::uint32_t> removedResults(std::span<const std::uint32_t> words,
                                       const std::map<std::uint32_t, Fate>& fates) {
    std::set<std::uint32_t> removed;
    Fate fate = Fate::Defined;
    forEachInstruction(words, [&](std::size_t at, spv::Op opcode) {
        if (opcode == spv::OpFunction) {
            fate = fates.at(words[at + 2]);
        }
        if (!stays(fate, opcode)) {
            removed.insert(resultAt(words, at));
        }
        if (opcode == spv::OpFunctionEnd) {
            fate = Fate::Defined;
        }
    });
    removed.erase(0);
    return removed;
}

void appendWords(Words& to, std::span<const std::uint32_t> from) {
    to.insert(to.end(), from.begin(), from.end());
}

void addLinkage(Words& decorations, std::uint32_t function, const std::string& name, spv::LinkageType type) {
    Words text(name.size() / 4 + 1);
    for (std::size_t i = 0; i < name.size(); ++i) {
        text[i / 4] |= std::uint32_t{static_cast<std::uint8_t>(name[i])} << (8 * (i % 4));
    }
    const auto length = static_cast<std::uint32_t>(4 + text.size());
    appendWords(decorations, std::vector<std::uint32_t>{length << spv::WordCountShift | spv::OpDecorate,
                                                        function, spv::DecorationLinkageAttributes});
    appendWords(decorations, text);
    decorations.push_back(static_cast<std::uint32_t>(type));
}

bool isDecoration(spv::Op opcode) {
    return opcode == spv::OpDecorate || opcode == spv::OpMemberDecorate || opcode == spv::OpDecorateId ||
           opcode == spv::OpDecorateString || opcode == spv::OpMemberDecorateString;
}

bool isSetting(spv::Op opcode) {
    return opcode == spv::OpExtension || opcode == spv::OpExtInstImport || opcode == spv::OpMemoryModel ||
           opcode == spv::OpString || opcode == spv::OpSource || opcode == spv::OpSourceExtension ||
           opcode == spv::OpSourceContinued || opcode == spv::OpModuleProcessed;
}

Parts splitModule(std::span<const std::uint32_t> words, const std::map<std::uint32_t, Fate>& fates,
                  bool keepsEntryPoint, bool keepNames) {
    const std::set<std::uint32_t> removed = removedResults(words, fates);
    Parts parts;
    Fate fate = Fate::Defined;
    bool inFunction = false;
    forEachInstruction(words, [&](std::size_t at, spv::Op opcode) {
        const std::span<const std::uint32_t> instruction = words.subspan(at, lengthAt(words, at));
        if (opcode == spv::OpFunction) {
            inFunction = true;
            fate = fates.at(words[at + 2]);
        }
        if (inFunction) {
            if (stays(fate, opcode)) {
                appendWords(fate == Fate::Declared ? parts.declarations : parts.definitions, instruction);
            }
            inFunction = opcode != spv::OpFunctionEnd;
        } else if (opcode == spv::OpCapability) {
            appendWords(parts.capabilities, instruction);
        } else if (opcode == spv::OpName || opcode == spv::OpMemberName) {
            if (keepNames && !removed.contains(words[at + 1])) {
                appendWords(parts.names, instruction);
            }
        } else if (isSetting(opcode)) {
            appendWords(parts.settings, instruction);
        } else if (isDecoration(opcode)) {
            if (!removed.contains(words[at + 1])) {
                appendWords(parts.decorations, instruction);
            }
        } else if (opcode == spv::OpEntryPoint || opcode == spv::OpExecutionMode ||
                   opcode == spv::OpExecutionModeId) {
            if (keepsEntryPoint) {
                appendWords(parts.settings, instruction);
            }
        } else {
            appendWords(parts.globals, instruction);
        }
    });
    return parts;
}

}  // namespace

Result<std::vector<std::uint32_t>> makeLinkable(std::span<const std::uint32_t> words, const LinkNames& names,
                                                const std::string& shader, bool keepNames) {
    const std::vector<SpirvFunction> functions = findFunctions(words);
    for (const std::string& name : names.exported) {
        if (std::ranges::find(functions, name, &SpirvFunction::name) == functions.end()) {
            return makeError("spirv-linkage", shader, "has no function " + name + " to export",
                             "its entry point must call every function that it exports");
        }
    }
    Parts parts = splitModule(words, fatesOf(words, functions, names), names.keepsEntryPoint, keepNames);
    appendWords(parts.capabilities, std::vector<std::uint32_t>{2U << spv::WordCountShift | spv::OpCapability,
                                                               spv::CapabilityLinkage});
    for (const SpirvFunction& function : functions) {
        if (std::ranges::find(names.exported, function.name) != names.exported.end()) {
            addLinkage(parts.decorations, function.id, function.name, spv::LinkageTypeExport);
        } else if (std::ranges::find(names.imported, function.name) != names.imported.end()) {
            addLinkage(parts.decorations, function.id, function.name, spv::LinkageTypeImport);
        }
    }
    Words module(words.begin(), words.begin() + kSpirvHeaderWords);
    for (const Words* const part : {&parts.capabilities, &parts.settings, &parts.names, &parts.decorations,
                                    &parts.globals, &parts.declarations, &parts.definitions}) {
        appendWords(module, *part);
    }
    return module;
}

}  // namespace glint::compiler
