// For spv::HasResultAndType().
#define SPV_ENABLE_UTILITY_CODE

#include "spirv/reader.h"

#include <fmt/format.h>
#include <glslang/SPIRV/spirv.hpp>
#include <spirv-tools/libspirv.h>

#include <algorithm>
#include <memory>
#include <numeric>
#include <type_traits>

namespace glint::compiler {

namespace {

constexpr std::uint32_t kSpirvMagic = 0x07230203;

Diagnostic formatError(std::string message) {
    return makeError("spirv-format", {}, std::move(message), "expected a SPIR-V module, little endian");
}

}  // namespace

SpirvInstruction SpirvInstructions::Iterator::operator*() const {
    SpirvInstruction made{.at = at_,
                          .opcode = words_[at_] & spv::OpCodeMask,
                          .operands = words_.subspan(at_ + 1, length() - 1)};
    bool hasResult = false;
    bool hasType = false;
    spv::HasResultAndType(static_cast<spv::Op>(made.opcode), &hasResult, &hasType);
    // The module may not be valid.
    if (hasResult && made.operands.size() > (hasType ? 1U : 0U)) {
        made.result = made.operands[hasType ? 1 : 0];
        made.type = hasType ? made.operands[0] : 0;
    }
    return made;
}

Status visitSpirv(std::span<const std::uint32_t> words,
                  const std::function<void(const SpirvInstruction&)>& visit) {
    if (words.size() < kSpirvHeaderWords) {
        return formatError(fmt::format("has {} words; a module's header alone has 5", words.size()));
    }
    if (words[0] != kSpirvMagic) {
        return formatError("does not begin with the magic number of SPIR-V");
    }
    std::size_t at = kSpirvHeaderWords;
    for (const SpirvInstruction& instruction : SpirvInstructions(words)) {
        visit(instruction);
        at += instruction.words().size();
    }
    if (at < words.size()) {
        return formatError(fmt::format("the instruction at word {} claims {} words of {}", at,
                                       words[at] >> 16U, words.size() - at));
    }
    return okStatus();
}

// Capabilities come first in a module (SPIR-V 2.4).
bool hasCapability(std::span<const std::uint32_t> words, std::uint32_t capability) {
    for (const SpirvInstruction& it : SpirvInstructions(words)) {
        if (it.opcode != spv::OpCapability) {
            break;
        }
        if (it.operands[0] == capability) {
            return true;
        }
    }
    return false;
}

bool isSpirvDecoration(std::uint32_t opcode) {
    return opcode == spv::OpDecorate || opcode == spv::OpMemberDecorate || opcode == spv::OpDecorateId ||
           opcode == spv::OpDecorateString || opcode == spv::OpMemberDecorateString;
}

bool isSpirvPreamble(std::uint32_t opcode) {
    switch (opcode) {
        case spv::OpCapability:
        case spv::OpExtension:
        case spv::OpExtInstImport:
        case spv::OpMemoryModel:
        case spv::OpEntryPoint:
        case spv::OpExecutionMode:
        case spv::OpExecutionModeId:
            return true;
        default:
            return false;
    }
}

bool isAccessChain(std::uint32_t opcode) {
    return opcode == spv::OpAccessChain || opcode == spv::OpInBoundsAccessChain;
}

std::string spirvString(std::span<const std::uint32_t> operands) {
    std::string text;
    for (const std::uint32_t word : operands) {
        for (unsigned shift = 0; shift < 32; shift += 8) {
            const auto character = static_cast<char>((word >> shift) & 0xFFU);
            if (character == '\0') {
                return text;
            }
            text += character;
        }
    }
    return text;
}

void appendWords(SpirvWords& to, std::span<const std::uint32_t> words) {
    to.insert(to.end(), words.begin(), words.end());
}

void appendInstruction(SpirvWords& to, std::uint32_t opcode, std::initializer_list<std::uint32_t> operands,
                       std::span<const std::uint32_t> more) {
    const std::size_t length = 1 + operands.size() + more.size();
    to.push_back(static_cast<std::uint32_t>(length) << spv::WordCountShift | opcode);
    to.insert(to.end(), operands);
    appendWords(to, more);
}

// --- Functions ---

namespace {

// glslang names functions like this: "shade(struct-Hit…;vf3;".
std::string withoutParameters(const std::string& name) {
    return name.substr(0, name.find('('));
}

}  // namespace

std::vector<SpirvFunction> findFunctions(std::span<const std::uint32_t> words) {
    std::vector<SpirvFunction> functions;
    std::map<std::uint32_t, std::string> names;
    for (const SpirvInstruction& it : SpirvInstructions(words)) {
        if (it.opcode == spv::OpName) {
            names[it.operands[0]] = spirvString(it.operands.subspan(1));
        } else if (it.opcode == spv::OpFunction) {
            functions.push_back({it.result, withoutParameters(names[it.result]), it.at + 3, {}});
        } else if (it.opcode == spv::OpFunctionCall) {
            functions.back().calls.push_back(it.operands[2]);
        }
    }
    return functions;
}

void keepApart(SpirvWords& words, const std::vector<SpirvFunction>& functions,
               const std::set<std::uint32_t>& apart) {
    for (const SpirvFunction& function : functions) {
        words[function.controlWord] =
            apart.contains(function.id) ? spv::FunctionControlDontInlineMask : spv::FunctionControlMaskNone;
    }
}

std::set<std::uint32_t> reachableFrom(std::uint32_t root, const std::vector<SpirvFunction>& functions) {
    std::set<std::uint32_t> reached{root};
    std::vector<std::uint32_t> pending{root};
    while (!pending.empty()) {
        const auto function = std::ranges::find(functions, pending.back(), &SpirvFunction::id);
        pending.pop_back();
        if (function == functions.end()) {
            continue;
        }
        for (const std::uint32_t callee : function->calls) {
            if (reached.insert(callee).second) {
                pending.push_back(callee);
            }
        }
    }
    return reached;
}

SpirvWords withoutUncalled(std::span<const std::uint32_t> words) {
    const std::vector<SpirvFunction> functions = findFunctions(words);
    std::set<std::uint32_t> called;
    for (const SpirvInstruction& it : SpirvInstructions(words)) {
        if (it.opcode == spv::OpEntryPoint) {
            called.merge(reachableFrom(it.operands[1], functions));
        }
    }
    // Names and decorations of what goes come before it.
    std::vector<bool> goes(words[kSpirvBoundWord]);
    std::vector<bool> stays;  // by instruction
    bool uncalled = false;
    for (const SpirvInstruction& it : SpirvInstructions(words)) {
        uncalled = it.opcode == spv::OpFunction ? !called.contains(it.result) : uncalled;
        goes[it.result] = uncalled;
        stays.push_back(!uncalled);
        uncalled = uncalled && it.opcode != spv::OpFunctionEnd;
    }
    SpirvWords left(words.begin(), words.begin() + kSpirvHeaderWords);
    auto own = stays.begin();
    for (const SpirvInstruction& it : SpirvInstructions(words)) {
        const bool annotates = it.opcode == spv::OpName || isSpirvDecoration(it.opcode);
        if (*own++ && !(annotates && goes[it.operands[0]])) {
            appendWords(left, it.words());
        }
    }
    return left;
}

// --- Parsed modules ---

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
    const auto name = std::ranges::find(names.of(id), std::uint32_t{spv::OpName}, &SpirvInstruction::opcode);
    return name == names.of(id).end() ? std::string() : spirvString(name->operands.subspan(1));
}

std::optional<std::uint32_t> ParsedModule::decorationOf(std::uint32_t id, std::uint32_t decoration,
                                                        std::optional<std::uint32_t> member) const {
    for (const SpirvInstruction& it : decorations.of(id)) {
        if (member ? it.opcode == spv::OpMemberDecorate && it.operands[1] == *member &&
                         it.operands[2] == decoration
                   : it.opcode == spv::OpDecorate && it.operands[1] == decoration) {
            return it.operands.back();
        }
    }
    return std::nullopt;
}

namespace {

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

class ModuleParser {
public:
    ModuleParser(std::span<const std::uint32_t> words, std::string shader) : shader_(std::move(shader)) {
        module_.words = words;
        module_.isId.resize(words.size());
    }

    Result<ParsedModule> parse() {
        const std::unique_ptr<std::remove_pointer_t<spv_context>, decltype(&spvContextDestroy)> context(
            spvContextCreate(SPV_ENV_UNIVERSAL_1_5), &spvContextDestroy);
        spv_diagnostic diagnostic = nullptr;
        const auto read = [](void* data, const spv_parsed_instruction_t* parsed) {
            static_cast<ModuleParser*>(data)->read(*parsed);
            return SPV_SUCCESS;
        };
        const spv_result_t result = spvBinaryParse(context.get(), this, module_.words.data(),
                                                   module_.words.size(), nullptr, read, &diagnostic);
        const std::string why = diagnostic != nullptr ? diagnostic->error : "no reason given";
        spvDiagnosticDestroy(diagnostic);
        if (result != SPV_SUCCESS) {
            return refuse("a part is no SPIR-V module: " + why);
        }
        if (hasGroups_) {
            return refuse("a part has groups of decorations, which can't be joined");
        }
        finish();
        return std::move(module_);
    }

private:
    Diagnostic refuse(const std::string& why) const {
        return makeError("spirv-join", shader_, why,
                         "this is a defect of Glint; please report it with the scene");
    }

    void read(const spv_parsed_instruction_t& parsed) {
        for (std::size_t i = 0; i < parsed.num_operands; ++i) {
            const spv_parsed_operand_t& operand = parsed.operands[i];
            if (isIdOperand(operand.type)) {
                module_.isId[at_ + operand.offset] = true;
            }
        }
        add({at_, parsed.opcode, parsed.result_id, parsed.type_id,
             module_.words.subspan(at_ + 1, parsed.num_words - 1U)});
        at_ += parsed.num_words;
    }

    void add(const SpirvInstruction& it) {
        if (it.opcode == spv::OpFunction) {
            inFunction_ = true;
            begins_.push_back(module_.code.size());
        }
        if (isPlace(it.opcode)) {
            return;
        }
        if (inFunction_) {
            module_.code.push_back(it);
            inFunction_ = it.opcode != spv::OpFunctionEnd;
        } else if (it.opcode == spv::OpName || it.opcode == spv::OpMemberName) {
            module_.names.add(it.operands[0], it);
        } else if (isSpirvDecoration(it.opcode)) {
            addDecoration(it);
        } else if (it.opcode == spv::OpDecorationGroup || it.opcode == spv::OpGroupDecorate ||
                   it.opcode == spv::OpGroupMemberDecorate) {
            hasGroups_ = true;
        } else {
            module_.globals.push_back(it);
        }
    }

    void addDecoration(const SpirvInstruction& it) {
        if (it.opcode == spv::OpDecorate && it.operands[1] == spv::DecorationLinkageAttributes) {
            const bool exported = it.operands.back() == spv::LinkageTypeExport;
            (exported ? module_.exports : module_.imports)[it.operands[0]] =
                spirvString(it.operands.subspan(2));
        } else {
            module_.decorations.add(it.operands[0], it);
        }
    }

    // Adds what refers to the instructions, once they have their places in memory.
    void finish() {
        begins_.push_back(module_.code.size());
        for (std::size_t i = 0; i + 1 < begins_.size(); ++i) {
            const auto body = std::span(module_.code).subspan(begins_[i], begins_[i + 1] - begins_[i]);
            module_.functions.push_back({body.front().result, body});
        }
        module_.definitions.resize(module_.bound());
        for (const std::vector<SpirvInstruction>* const part : {&module_.globals, &module_.code}) {
            for (const SpirvInstruction& instruction : *part) {
                module_.definitions[instruction.result] = &instruction;
            }
        }
        module_.definitions[0] = nullptr;
        module_.decorations.finish(module_.bound());
        module_.names.finish(module_.bound());
    }

    std::string shader_;
    ParsedModule module_;
    std::size_t at_ = kSpirvHeaderWords;
    bool inFunction_ = false;
    bool hasGroups_ = false;
    std::vector<std::size_t> begins_;  // of functions, in the code
};

}  // namespace

Result<ParsedModule> parseModule(std::span<const std::uint32_t> words, const std::string& shader) {
    return ModuleParser(words, shader).parse();
}

bool sharesVariables(const ParsedModule& module) {
    std::vector<bool> shared(module.bound());
    std::uint32_t entryPoint = 0;
    for (const SpirvInstruction& global : module.globals) {
        if (global.opcode == spv::OpVariable) {
            const std::uint32_t storage = global.operands[2];
            shared[global.result] =
                storage == spv::StorageClassPrivate || storage == spv::StorageClassWorkgroup;
        } else if (global.opcode == spv::OpEntryPoint) {
            entryPoint = global.operands[1];
        }
    }
    std::set<std::uint32_t> known;   // used by the entry point
    std::set<std::uint32_t> others;  // used by other functions
    for (const ParsedFunction& function : module.functions) {
        std::set<std::uint32_t>& used = function.id == entryPoint ? known : others;
        for (const SpirvInstruction& instruction : function.body) {
            module.forIds(instruction, [&](std::uint32_t id) {
                if (shared[id]) {
                    used.insert(id);
                }
            });
        }
    }
    return !std::ranges::includes(known, others);
}

SpirvWords edited(const ParsedModule& module, const SpirvEdits& edits,
                  const std::map<std::uint32_t, std::uint32_t>& renamed, std::uint32_t bound) {
    SpirvWords to;
    to.reserve(module.words.size());
    std::size_t from = 0;
    const auto keepUntil = [&](std::size_t end) {
        for (; from < end; ++from) {
            const std::uint32_t word = module.words[from];
            const auto found = module.isId[from] ? renamed.find(word) : renamed.end();
            to.push_back(found == renamed.end() ? word : found->second);
        }
    };
    for (const auto& [at, edit] : edits) {
        keepUntil(at);
        appendWords(to, edit.before);
        from += edit.removes ? module.words[at] >> spv::WordCountShift : 0;
    }
    keepUntil(module.words.size());
    to[kSpirvBoundWord] = bound;
    return to;
}

}  // namespace glint::compiler
