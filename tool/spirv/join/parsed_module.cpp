#include "spirv/join/parsed_module.h"

#include "spirv/reader.h"

#include <glslang/SPIRV/spirv.hpp>
#include <spirv-tools/libspirv.h>

#include <algorithm>
#include <memory>
#include <numeric>
#include <type_traits>
#include <utility>

namespace glint::compiler {

namespace {

constexpr std::size_t kLinkageName = 3;  // word of OpDecorate … LinkageAttributes

struct Reading {
    ParsedModule* module = nullptr;
    std::size_t at = kSpirvHeaderWords;
    bool hasGroups = false;
};

bool isIdOperand(spv_operand_type_t type) {
    return type == SPV_OPERAND_TYPE_ID || type == SPV_OPERAND_TYPE_TYPE_ID ||
           type == SPV_OPERAND_TYPE_RESULT_ID || type == SPV_OPERAND_TYPE_MEMORY_SEMANTICS_ID ||
           type == SPV_OPERAND_TYPE_SCOPE_ID;
}

// Places in the source do not change the work of a module.
bool isPlace(std::uint32_t opcode) {
    return opcode == spv::OpLine || opcode == spv::OpNoLine || opcode == spv::OpString ||
           opcode == spv::OpModuleProcessed;
}

void addDecoration(ParsedModule& module, const ParsedInstruction& instruction) {
    const std::span<const std::uint32_t> words = module.wordsOf(instruction);
    if (instruction.opcode == spv::OpDecorate && words[2] == spv::DecorationLinkageAttributes) {
        const bool exported = words.back() == spv::LinkageTypeExport;
        (exported ? module.exports : module.imports)[words[1]] = spirvString(words.subspan(kLinkageName));
    } else {
        module.decorations.add(words[1], instruction);
    }
}

void add(Reading& reading, const ParsedInstruction& instruction) {
    ParsedModule& module = *reading.module;
    const std::uint32_t opcode = instruction.opcode;
    const bool inFunction =
        !module.functions.empty() && (module.functions.back().body.empty() ||
                                      module.functions.back().body.back().opcode != spv::OpFunctionEnd);
    if (opcode == spv::OpFunction) {
        module.functions.push_back({instruction.result, {instruction}});
    } else if (isPlace(opcode)) {
        return;
    } else if (inFunction) {
        module.functions.back().body.push_back(instruction);
    } else if (opcode == spv::OpName || opcode == spv::OpMemberName) {
        module.names.add(module.words[instruction.at + 1], instruction);
    } else if (isSpirvDecoration(opcode)) {
        addDecoration(module, instruction);
    } else if (opcode == spv::OpDecorationGroup || opcode == spv::OpGroupDecorate ||
               opcode == spv::OpGroupMemberDecorate) {
        reading.hasGroups = true;
    } else {
        module.globals.push_back(instruction);
    }
}

spv_result_t readInstruction(void* data, const spv_parsed_instruction_t* parsed) {
    Reading& reading = *static_cast<Reading*>(data);
    for (std::size_t i = 0; i < parsed->num_operands; ++i) {
        const spv_parsed_operand_t& operand = parsed->operands[i];
        if (isIdOperand(operand.type)) {
            reading.module->isId[reading.at + operand.offset] = true;
        }
    }
    add(reading, {reading.at, parsed->num_words, parsed->opcode, parsed->result_id, parsed->type_id});
    reading.at += parsed->num_words;
    return SPV_SUCCESS;
}

}  // namespace

void Annotations::finish(std::uint32_t bound) {
    begins_.assign(bound + 1, 0);
    for (const auto& [target, instruction] : entries_) {
        ++begins_[target + 1];
    }
    std::partial_sum(begins_.begin(), begins_.end(), begins_.begin());
    std::vector<std::uint32_t> next(begins_.begin(), begins_.end() - 1);
    sorted_.resize(entries_.size());
    for (const auto& [target, instruction] : entries_) {
        sorted_[next[target]++] = instruction;
    }
}

std::string ParsedModule::nameOf(std::uint32_t id) const {
    for (const ParsedInstruction& name : names.of(id)) {
        if (name.opcode == spv::OpName) {
            return spirvString(wordsOf(name).subspan(2));
        }
    }
    return {};
}

Result<ParsedModule> parseModule(std::span<const std::uint32_t> words, const std::string& shader) {
    const auto refuse = [&](const std::string& why) {
        return makeError("spirv-join", shader, why,
                         "this is a defect of Glint; please report it with the scene");
    };
    ParsedModule module;
    module.words = words;
    module.isId.resize(words.size());
    Reading reading{&module};
    const std::unique_ptr<std::remove_pointer_t<spv_context>, decltype(&spvContextDestroy)> context(
        spvContextCreate(SPV_ENV_UNIVERSAL_1_5), &spvContextDestroy);
    spv_diagnostic diagnostic = nullptr;
    const spv_result_t result = spvBinaryParse(context.get(), &reading, words.data(), words.size(), nullptr,
                                               readInstruction, &diagnostic);
    const std::string why = diagnostic != nullptr ? diagnostic->error : "no reason given";
    spvDiagnosticDestroy(diagnostic);
    if (result != SPV_SUCCESS) {
        return refuse("a part is no SPIR-V module: " + why);
    }
    if (reading.hasGroups) {
        return refuse("a part has groups of decorations, which can't be joined");
    }
    module.decorations.finish(module.bound());
    module.names.finish(module.bound());
    return module;
}

bool sharesVariables(const ParsedModule& module) {
    std::vector<bool> shared(module.bound());
    std::uint32_t entryPoint = 0;
    for (const ParsedInstruction& global : module.globals) {
        if (global.opcode == spv::OpVariable) {
            const std::uint32_t storage = module.words[global.at + 3];
            shared[global.result] =
                storage == spv::StorageClassPrivate || storage == spv::StorageClassWorkgroup;
        } else if (global.opcode == spv::OpEntryPoint) {
            entryPoint = module.words[global.at + 2];
        }
    }
    const auto usedBy = [&](const ParsedFunction& function) {
        std::vector<bool> used(module.bound());
        for (const ParsedInstruction& instruction : function.body) {
            for (std::size_t i = instruction.at; i < instruction.at + instruction.length; ++i) {
                if (module.isId[i]) {
                    used[module.words[i]] = shared[module.words[i]];
                }
            }
        }
        return used;
    };
    std::vector<bool> known(module.bound());
    for (const ParsedFunction& function : module.functions) {
        if (function.id == entryPoint) {
            known = usedBy(function);
        }
    }
    return std::ranges::any_of(module.functions, [&](const ParsedFunction& function) {
        const std::vector<bool> used = usedBy(function);
        for (std::size_t id = 0; id < used.size(); ++id) {
            if (used[id] && !known[id]) {
                return true;
            }
        }
        return false;
    });
}

}  // namespace glint::compiler
