#include "spirv/link.h"

#include "spirv/join.h"
#include "spirv/optimize.h"

#include <fmt/format.h>
#include <glslang/SPIRV/spirv.hpp>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <map>
#include <set>
#include <utility>

namespace glint::compiler {

namespace {

// The sections of a module, in the order of the specification (2.4).
struct Sections {
    SpirvWords capabilities;
    SpirvWords settings;  // extensions, imports of instructions, memory model, entry points
    SpirvWords names;
    SpirvWords decorations;
    SpirvWords globals;
    SpirvWords declarations;
    SpirvWords definitions;
};

// The treatment of a function.
enum class Fate { Defined, Declared, Removed };

std::map<std::uint32_t, Fate> fatesOf(std::span<const std::uint32_t> words,
                                      const std::vector<SpirvFunction>& functions, const LinkNames& names) {
    std::map<std::uint32_t, Fate> fates;
    for (const SpirvFunction& function : functions) {
        const bool imported = std::ranges::find(names.imported, function.name) != names.imported.end();
        fates[function.id] = imported ? Fate::Declared : Fate::Defined;
    }
    for (const SpirvInstruction& it : SpirvInstructions(words)) {
        if (it.opcode == spv::OpEntryPoint && !names.keepsEntryPoint) {
            fates[it.operands[1]] = Fate::Removed;
        }
    }
    return fates;
}

// Returns whether the instruction of a function with this fate stays.
bool stays(Fate fate, std::uint32_t opcode) {
    return fate == Fate::Defined ||
           (fate == Fate::Declared && (opcode == spv::OpFunction || opcode == spv::OpFunctionParameter ||
                                       opcode == spv::OpFunctionEnd));
}

std::set<std::uint32_t> removedResults(std::span<const std::uint32_t> words,
                                       const std::map<std::uint32_t, Fate>& fates) {
    std::set<std::uint32_t> removed;
    Fate fate = Fate::Defined;
    for (const SpirvInstruction& it : SpirvInstructions(words)) {
        if (it.opcode == spv::OpFunction) {
            fate = fates.at(it.operands[1]);
        }
        if (!stays(fate, it.opcode)) {
            removed.insert(it.result);
        }
        if (it.opcode == spv::OpFunctionEnd) {
            fate = Fate::Defined;
        }
    }
    removed.erase(0);
    return removed;
}

void addLinkage(SpirvWords& decorations, std::uint32_t function, const std::string& name,
                spv::LinkageType type) {
    SpirvWords text(name.size() / 4 + 1);
    for (std::size_t i = 0; i < name.size(); ++i) {
        text[i / 4] |= std::uint32_t{static_cast<std::uint8_t>(name[i])} << (8 * (i % 4));
    }
    text.push_back(static_cast<std::uint32_t>(type));
    appendInstruction(decorations, spv::OpDecorate, {function, spv::DecorationLinkageAttributes}, text);
}

bool isSetting(std::uint32_t opcode) {
    return opcode == spv::OpExtension || opcode == spv::OpExtInstImport || opcode == spv::OpMemoryModel ||
           opcode == spv::OpString || opcode == spv::OpSource || opcode == spv::OpSourceExtension ||
           opcode == spv::OpSourceContinued || opcode == spv::OpModuleProcessed;
}

Sections splitModule(std::span<const std::uint32_t> words, const std::map<std::uint32_t, Fate>& fates,
                     bool keepsEntryPoint, bool keepNames) {
    const std::set<std::uint32_t> removed = removedResults(words, fates);
    Sections sections;
    Fate fate = Fate::Defined;
    bool inFunction = false;
    for (const SpirvInstruction& it : SpirvInstructions(words)) {
        const std::uint32_t opcode = it.opcode;
        if (opcode == spv::OpFunction) {
            inFunction = true;
            fate = fates.at(it.operands[1]);
        }
        if (inFunction) {
            if (stays(fate, opcode)) {
                appendWords(fate == Fate::Declared ? sections.declarations : sections.definitions,
                            it.words());
            }
            inFunction = opcode != spv::OpFunctionEnd;
        } else if (opcode == spv::OpCapability) {
            appendWords(sections.capabilities, it.words());
        } else if (opcode == spv::OpName || opcode == spv::OpMemberName) {
            if (keepNames && !removed.contains(it.operands[0])) {
                appendWords(sections.names, it.words());
            }
        } else if (isSetting(opcode)) {
            appendWords(sections.settings, it.words());
        } else if (isSpirvDecoration(opcode)) {
            if (!removed.contains(it.operands[0])) {
                appendWords(sections.decorations, it.words());
            }
        } else if (opcode == spv::OpEntryPoint || opcode == spv::OpExecutionMode ||
                   opcode == spv::OpExecutionModeId) {
            if (keepsEntryPoint) {
                appendWords(sections.settings, it.words());
            }
        } else {
            appendWords(sections.globals, it.words());
        }
    }
    return sections;
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
    Sections sections =
        splitModule(words, fatesOf(words, functions, names), names.keepsEntryPoint, keepNames);
    appendInstruction(sections.capabilities, spv::OpCapability, {spv::CapabilityLinkage});
    for (const SpirvFunction& function : functions) {
        if (std::ranges::find(names.exported, function.name) != names.exported.end()) {
            addLinkage(sections.decorations, function.id, function.name, spv::LinkageTypeExport);
        } else if (std::ranges::find(names.imported, function.name) != names.imported.end()) {
            addLinkage(sections.decorations, function.id, function.name, spv::LinkageTypeImport);
        }
    }
    SpirvWords module(words.begin(), words.begin() + kSpirvHeaderWords);
    for (const SpirvWords* const part :
         {&sections.capabilities, &sections.settings, &sections.names, &sections.decorations,
          &sections.globals, &sections.declarations, &sections.definitions}) {
        appendWords(module, *part);
    }
    return module;
}

namespace {

constexpr std::string_view kLineStart = "#pragma glint_spirv ";
constexpr std::size_t kDigits = 8;  // of a word

// --- GLSL ---

std::vector<std::string> functionNames(const SpirvWords& words) {
    std::vector<std::string> exported;
    for (const SpirvInstruction& it : SpirvInstructions(words)) {
        if (it.opcode == spv::OpDecorate && it.operands[1] == spv::DecorationLinkageAttributes &&
            it.operands.back() == spv::LinkageTypeExport) {
            exported.push_back(spirvString(it.operands.subspan(2)));
        }
    }
    if (!exported.empty()) {
        return exported;
    }
    std::vector<std::string> named;
    for (const SpirvFunction& function : findFunctions(words)) {
        if (!function.name.empty()) {
            named.push_back(function.name);
        }
    }
    return named;
}

bool isWord(char character) {
    return std::isalnum(static_cast<unsigned char>(character)) != 0 || character == '_';
}

// Returns the word that ends before `at` and the blanks before it, or "".
std::string_view wordBefore(std::string_view text, std::size_t at) {
    const std::size_t last = text.substr(0, at).find_last_not_of(" \t\r\n");
    if (last == std::string_view::npos) {
        return {};
    }
    std::size_t first = last + 1;
    while (first > 0 && isWord(text[first - 1])) {
        --first;
    }
    return text.substr(first, last + 1 - first);
}

// Gives each declaration of the function that has no body one. Returns whether there was any.
bool giveBody(std::string& glsl, const std::string& function) {
    bool gave = false;
    for (std::size_t at = glsl.find(function); at != std::string::npos; at = glsl.find(function, at + 1)) {
        const std::size_t open = glsl.find_first_not_of(" \t\r\n", at + function.size());
        if (open == std::string::npos || glsl[open] != '(' || (at > 0 && isWord(glsl[at - 1]))) {
            continue;
        }
        // Types of parameters have no parentheses.
        const std::size_t close = glsl.find_first_of("()", open + 1);
        const std::size_t end =
            close == std::string::npos ? close : glsl.find_first_not_of(" \t\r\n", close + 1);
        const std::string type(wordBefore(glsl, at));
        if (end == std::string::npos || glsl[close] != ')' || glsl[end] != ';' || type.empty() ||
            type == "return" || type == "else") {
            continue;
        }
        glsl.replace(end, 1, type == "void" ? " {}" : fmt::format(" {{ {} unset; return unset; }}", type));
        gave = true;
    }
    return gave;
}

// --- Types ---

// Compares types of the caller with those of a library, and finds the structures that are the same.
class TypeMatch {
public:
    TypeMatch(const ParsedModule& caller, const ParsedModule& library) : caller_(caller), library_(library) {}

    bool same(std::uint32_t ofCaller, std::uint32_t ofLibrary) {
        const SpirvInstruction* const a = caller_.definitions[ofCaller];
        const SpirvInstruction* const b = library_.definitions[ofLibrary];
        if (a == nullptr || b == nullptr || a->opcode != b->opcode ||
            a->words().size() != b->words().size() || pointsToBuffer(*a)) {
            return false;
        }
        for (std::size_t i = 1; i < a->words().size(); ++i) {
            const std::uint32_t first = a->words()[i];
            const std::uint32_t second = b->words()[i];
            const bool isResult = first == ofCaller && second == ofLibrary;
            if (!isResult && (caller_.isId[a->at + i] ? !same(first, second) : first != second)) {
                return false;
            }
        }
        return a->opcode != spv::OpTypeStruct ||
               structures_.emplace(ofLibrary, ofCaller).first->second == ofCaller;
    }
    // Returns whether the caller's type is a pointer to a variable of the library's type.
    bool pointsTo(std::uint32_t ofCaller, std::uint32_t ofLibrary) {
        const SpirvInstruction* const pointer = caller_.definitions[ofCaller];
        return pointer != nullptr && pointer->opcode == spv::OpTypePointer &&
               pointer->words()[2] == spv::StorageClassFunction && same(pointer->words()[3], ofLibrary);
    }
    // By the library's type.
    const std::map<std::uint32_t, std::uint32_t>& structures() const {
        return structures_;
    }

private:
    // Such pointers may lead back to themselves.
    static bool pointsToBuffer(const SpirvInstruction& type) {
        return type.opcode == spv::OpTypePointer && type.words()[2] == spv::StorageClassPhysicalStorageBuffer;
    }

    const ParsedModule& caller_;
    const ParsedModule& library_;
    std::map<std::uint32_t, std::uint32_t> structures_;
};

// --- A library made fit for its caller ---

class Adapter {
public:
    Adapter(const ParsedModule& caller, const ParsedModule& library, const SpirvLibrary& source)
        : caller_(caller),
          library_(library),
          source_(source),
          types_(caller, library),
          bound_(library.bound()) {}

    Result<SpirvWords> adapt() {
        for (const auto& [function, name] : library_.exports) {
            const auto import = std::ranges::find_if(
                caller_.imports, [&name = name](const auto& entry) { return entry.second == name; });
            if (import != caller_.imports.end()) {
                GLINT_TRY_DO(adaptFunction(function, import->first, name));
            }
        }
        return write();
    }

private:
    static const SpirvInstruction& startOf(const ParsedModule& module, std::uint32_t function) {
        return std::ranges::find(module.functions, function, &ParsedFunction::id)->body.front();
    }

    Status adaptFunction(std::uint32_t function, std::uint32_t import, const std::string& name) {
        const std::span<const std::uint32_t> wanted =
            caller_.definitions[startOf(caller_, import).words()[4]]->words();
        const std::span<const std::uint32_t> given =
            library_.definitions[startOf(library_, function).words()[4]]->words();
        bool fits = wanted.size() == given.size() && types_.same(wanted[2], given[2]);
        std::vector<bool> byValue;
        for (std::size_t i = 3; fits && i < given.size(); ++i) {
            byValue.push_back(types_.pointsTo(wanted[i], given[i]));
            fits = byValue.back() || types_.same(wanted[i], given[i]);
        }
        if (!fits) {
            return makeError(
                "spirv-functions", source_.file,
                fmt::format("{} takes or returns something else than its declaration in GLSL", name),
                "give both the same types; structures need the same members in the same order");
        }
        if (std::ranges::find(byValue, true) != byValue.end()) {
            addWrapper(function, given, byValue);
        }
        return okStatus();
    }

    // Returns the ID of a type of the library, which is added if it has none.
    std::uint32_t typeOf(std::uint32_t opcode, const SpirvWords& operands) {
        for (const SpirvInstruction& global : library_.globals) {
            if (global.opcode == opcode && std::ranges::equal(global.operands.subspan(1), operands)) {
                return global.result;
            }
        }
        std::uint32_t& id = added_[{opcode, operands}];
        if (id == 0) {
            id = bound_++;
            appendInstruction(globals_, opcode, {id}, operands);
        }
        return id;
    }

    // Adds a function that takes pointers, as the caller's do, and passes on values. It is exported instead.
    void addWrapper(std::uint32_t function, std::span<const std::uint32_t> given,
                    const std::vector<bool>& byValue) {
        SpirvWords types{given[2]};
        for (std::size_t i = 0; i < byValue.size(); ++i) {
            types.push_back(byValue[i] ? typeOf(spv::OpTypePointer, {spv::StorageClassFunction, given[3 + i]})
                                       : given[3 + i]);
        }
        const std::uint32_t type = typeOf(spv::OpTypeFunction, types);
        const std::uint32_t wrapper = bound_++;
        SpirvWords loads;
        SpirvWords arguments;
        appendInstruction(functions_, spv::OpFunction,
                          {given[2], wrapper, spv::FunctionControlMaskNone, type});
        for (std::size_t i = 0; i < byValue.size(); ++i) {
            const std::uint32_t parameter = bound_++;
            appendInstruction(functions_, spv::OpFunctionParameter, {types[1 + i], parameter});
            arguments.push_back(parameter);
            if (byValue[i]) {
                arguments.back() = bound_++;
                appendInstruction(loads, spv::OpLoad, {given[3 + i], arguments.back(), parameter});
            }
        }
        appendInstruction(functions_, spv::OpLabel, {bound_++});
        appendWords(functions_, loads);
        const std::uint32_t result = bound_++;
        appendInstruction(functions_, spv::OpFunctionCall, {given[2], result, function}, arguments);
        if (library_.definitions[given[2]]->opcode == spv::OpTypeVoid) {
            appendInstruction(functions_, spv::OpReturn, {});
        } else {
            appendInstruction(functions_, spv::OpReturnValue, {result});
        }
        appendInstruction(functions_, spv::OpFunctionEnd, {});
        wrappers_.emplace(function, wrapper);
    }

    // Structures of parameters get the caller's names and decorations, by which joinModules() knows them.
    SpirvWords annotationsOf(const Annotations& annotations) const {
        SpirvWords words;
        for (const auto& [own, ofCaller] : types_.structures()) {
            for (const SpirvInstruction& annotation : annotations.of(ofCaller)) {
                const std::size_t target = words.size() + 1;
                appendWords(words, annotation.words());
                words[target] = own;
            }
        }
        return words;
    }

    SpirvWords write() const {
        SpirvWords preamble(library_.words.begin(), library_.words.begin() + kSpirvHeaderWords);
        preamble[kSpirvVersionWord] = caller_.words[kSpirvVersionWord];
        preamble[kSpirvBoundWord] = bound_;
        SpirvWords decorations;
        SpirvWords rest;
        bool inFunctions = false;
        for (const SpirvInstruction& it : SpirvInstructions(library_.words)) {
            if (it.opcode == spv::OpFunction && !std::exchange(inFunctions, true)) {
                appendWords(rest, globals_);
            }
            if (it.opcode == spv::OpMemoryModel) {
                const auto own =
                    std::ranges::find(caller_.globals, spv::OpMemoryModel, &SpirvInstruction::opcode);
                appendWords(preamble, own->words());
            } else if (isSpirvPreamble(it.opcode)) {
                appendWords(preamble, it.words());
            } else if (!isSpirvDecoration(it.opcode)) {
                appendWords(rest, it.words());
            } else if (!types_.structures().contains(it.operands[0])) {
                const std::size_t target = decorations.size() + 1;
                appendWords(decorations, it.words());
                const auto wrapper = wrappers_.find(it.operands[0]);
                if (wrapper != wrappers_.end() && it.operands[1] == spv::DecorationLinkageAttributes) {
                    decorations[target] = wrapper->second;
                }
            }
        }
        appendWords(preamble, annotationsOf(caller_.names));
        appendWords(preamble, decorations);
        appendWords(preamble, annotationsOf(caller_.decorations));
        appendWords(preamble, rest);
        appendWords(preamble, functions_);
        return preamble;
    }

    const ParsedModule& caller_;
    const ParsedModule& library_;
    const SpirvLibrary& source_;
    TypeMatch types_;
    std::uint32_t bound_;
    std::map<std::pair<std::uint32_t, SpirvWords>, std::uint32_t> added_;  // types
    std::map<std::uint32_t, std::uint32_t> wrappers_;                      // by the function that they call
    SpirvWords globals_;
    SpirvWords functions_;
};

Result<SpirvWords> adapted(const SpirvLibrary& library, const ParsedModule& caller) {
    SpirvWords words = library.words;
    if (!hasCapability(words, spv::CapabilityLinkage)) {
        LinkNames names;
        for (const auto& [id, name] : caller.imports) {
            if (std::ranges::find(library.functions, name) != library.functions.end()) {
                names.exported.push_back(name);
            }
        }
        GLINT_TRY(words, makeLinkable(library.words, names, library.file, true));
    }
    GLINT_TRY_DO(stripLibrary(words, library.file));
    GLINT_TRY(const auto parsed, parseModule(words, library.file));
    return Adapter(caller, parsed, library).adapt();
}

}  // namespace

Result<std::string> libraryLine(std::string_view file, std::string_view bytes) {
    SpirvWords words(bytes.size() / sizeof(std::uint32_t));
    std::memcpy(words.data(), bytes.data(), words.size() * sizeof(std::uint32_t));
    if (const Status valid = validateSpirv(words, std::string(file), SpirvUse::Link); !valid) {
        return makeError("spirv-functions", std::string(file), valid.error().message,
                         "compile it again, for Vulkan 1.2 or SPIR-V 1.5");
    }
    std::string line = fmt::format("{}{} ", kLineStart, file);
    for (const std::uint32_t word : words) {
        line += fmt::format("{:08x}", word);
    }
    return line;
}

LinkedGlsl takeLibraries(std::string_view glsl) {
    LinkedGlsl linked{std::string(glsl), {}};
    std::string& text = linked.glsl;
    for (std::size_t at = text.find(kLineStart); at != std::string::npos; at = text.find(kLineStart, at)) {
        const std::size_t end = std::min(text.find('\n', at), text.size());
        const std::string_view line = std::string_view(text).substr(at, end - at);
        const std::size_t digits = line.rfind(' ') + 1;
        SpirvLibrary library{
            std::string(line.substr(kLineStart.size(), digits - 1 - kLineStart.size())), {}, {}};
        for (std::size_t i = digits; i < line.size(); i += kDigits) {
            library.words.push_back(
                static_cast<std::uint32_t>(std::stoul(std::string(line.substr(i, kDigits)), nullptr, 16)));
        }
        library.functions = functionNames(library.words);
        linked.libraries.push_back(std::move(library));
        text.erase(at, end - at);
    }
    for (SpirvLibrary& library : linked.libraries) {
        std::erase_if(library.functions,
                      [&](const std::string& function) { return !giveBody(text, function); });
    }
    return linked;
}

Result<SpirvWords> linkFunctions(SpirvWords words, std::span<const SpirvLibrary> libraries,
                                 const std::string& shader) {
    LinkNames names{{}, {}, true};
    for (const SpirvLibrary& library : libraries) {
        names.imported.insert(names.imported.end(), library.functions.begin(), library.functions.end());
    }
    GLINT_TRY(const auto caller, makeLinkable(words, names, shader, true));
    GLINT_TRY(const auto parsed, parseModule(caller, shader));
    std::vector<SpirvWords> modules{caller};
    for (const SpirvLibrary& library : libraries) {
        GLINT_TRY(auto module, adapted(library, parsed));
        modules.push_back(std::move(module));
    }
    return joinModules(std::vector<std::span<const std::uint32_t>>(modules.begin(), modules.end()), shader,
                       true);
}

}  // namespace glint::compiler
