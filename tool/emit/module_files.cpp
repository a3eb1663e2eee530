#include "emit/module_files.h"

#include "base/files.h"
#include "base/lists.h"
#include "cache/store.h"
#include "emit/context.h"
#include "emit/glsl/passes.h"
#include "emit/warm_modules.h"
#include "spirv/statistics.h"

#include <fmt/format.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <system_error>
#include <utility>
#include <vector>

namespace glint::compiler {

namespace {

Result<CachedModule> measured(Result<std::vector<std::uint32_t>> spirv) {
    if (!spirv) {
        return spirv.error();
    }
    const Result<SpirvStatistics> statistics = measureSpirv(*spirv);
    return statistics ? Result<CachedModule>(CachedModule{std::move(*spirv), *statistics})
                      : statistics.error();
}

}  // namespace

Result<CachedModule> compileMeasured(const ShaderSource& source, const ShaderCompileOptions& options,
                                     const std::optional<LinkNames>& link) {
    const auto compile = [&](const ShaderSource& shader) {
        return measured(link ? compilePart(shader, *link, options) : compileShader(shader, options));
    };
    // Functions that cross the border of a module have the same type on both sides.
    std::vector<std::string> fixed = source.functionsApart;
    if (link) {
        fixed.insert(fixed.end(), link->exported.begin(), link->exported.end());
        fixed.insert(fixed.end(), link->imported.begin(), link->imported.end());
    }
    ShaderSource shorter = source;
    shorter.glsl = withConstParameters(source.glsl, fixed);
    Result<CachedModule> compiled = compile(shorter);
    // A macro may write a parameter. Other errors are those of the text as it is, too.
    return compiled ? std::move(compiled) : compile(source);
}

Result<CachedModule> joinMeasured(const ShaderSource& source, const ShaderCompileOptions& options,
                                  std::span<const CachedModule* const> parts, int jobs) {
    std::vector<std::span<const std::uint32_t>> words;
    for (const CachedModule* const part : parts) {
        if (!isJoinable(part->spirv)) {
            return measured(compileShader(source, options));
        }
        words.emplace_back(part->spirv);
    }
    return measured(joinParts(words, source.name, options, jobs));
}

std::string moduleCompiler() {
    return fmt::format("glint {}; {}", toolVersion(), compilerIdentity());
}

namespace {

constexpr std::string_view kFirstLine = "// glint module 2";
constexpr std::string_view kStage = "// stage ";
constexpr std::string_view kApart = "// apart ";
constexpr std::string_view kExport = "// export ";
constexpr std::string_view kImport = "// import ";
constexpr std::string_view kEntry = "// entry point";
constexpr std::string_view kPart = "// part ";
constexpr std::string_view kFolded = "// folded";  // it is not optimised
constexpr std::string_view kNamed = "// names of ";
constexpr std::string_view kLastLine = "//";

struct StageName {
    ShaderStage stage;
    std::string_view name;
};

// The names are those that glslang's command uses.
constexpr StageName kStages[] = {
    {ShaderStage::Vertex, "vert"},        {ShaderStage::Fragment, "frag"},    {ShaderStage::Compute, "comp"},
    {ShaderStage::RayGeneration, "rgen"}, {ShaderStage::ClosestHit, "rchit"}, {ShaderStage::AnyHit, "rahit"},
    {ShaderStage::Miss, "rmiss"},
};

std::string_view nameInText(ShaderStage stage) {
    for (const StageName& entry : kStages) {
        if (entry.stage == stage) {
            return entry.name;
        }
    }
    return "comp";
}

std::optional<ShaderStage> findStage(std::string_view name) {
    for (const StageName& entry : kStages) {
        if (entry.name == name) {
            return entry.stage;
        }
    }
    return std::nullopt;
}

Diagnostic formatError(const std::string& name, const std::string& why) {
    return makeError("module-format", name, why,
                     "give a file that `glint compile --plan-only` of this version wrote");
}

// Reads a line about another input than the stage. Returns false if it is no such line.
bool takeInput(std::string_view line, ModuleText& module) {
    const auto rest = [&](std::string_view key) { return std::string(line.substr(key.size())); };
    const auto link = [&]() -> LinkNames& {
        if (!module.link) {
            module.link.emplace();
        }
        return *module.link;
    };
    if (line.starts_with(kApart)) {
        module.source.functionsApart.push_back(rest(kApart));
    } else if (line.starts_with(kExport)) {
        link().exported.push_back(rest(kExport));
    } else if (line.starts_with(kImport)) {
        link().imported.push_back(rest(kImport));
    } else if (line == kEntry) {
        link().keepsEntryPoint = true;
    } else if (line.starts_with(kPart)) {
        module.parts.push_back(rest(kPart));
    } else if (line == kFolded) {
        module.options.optimize = false;
    } else if (line.starts_with(kNamed)) {
        module.source.name = rest(kNamed);
        module.options.debugInfo = true;
    } else {
        return false;
    }
    return true;
}

}  // namespace

namespace {

// Returns the comments above the GLSL. `nameOfPart` returns a text that stands for that of a part.
template <typename NameOfPart>
std::string headOfText(const ModuleSource& source, const ShaderCompileOptions& options,
                       const NameOfPart& nameOfPart) {
    std::string text = fmt::format("{}\n{}{}\n", kFirstLine, kStage, nameInText(source.stage));
    for (const std::string& function : source.functionsApart) {
        text += fmt::format("{}{}\n", kApart, function);
    }
    if (source.link) {
        for (const std::string& function : source.link->exported) {
            text += fmt::format("{}{}\n", kExport, function);
        }
        for (const std::string& function : source.link->imported) {
            text += fmt::format("{}{}\n", kImport, function);
        }
        if (source.link->keepsEntryPoint) {
            text += fmt::format("{}\n", kEntry);
        }
    }
    for (const std::shared_ptr<const ModuleSource>& part : source.parts) {
        text += fmt::format("{}{}\n", kPart, nameOfPart(*part));
    }
    if (!options.optimize) {
        text += fmt::format("{}\n", kFolded);
    }
    if (options.debugInfo) {
        text += fmt::format("{}{}\n", kNamed, source.name);
    }
    text += kLastLine;
    text += '\n';
    return text;
}

std::string hexText(const TextHash& hash) {
    return base::hexHash(hash.first) + base::hexHash(hash.second);
}

}  // namespace

std::string makeModuleText(const ModuleSource& source, const ShaderCompileOptions& options) {
    const std::string head = headOfText(source, options, [&](const ModuleSource& part) {
        return nameOfModuleText(makeModuleText(part, options));
    });
    const GlslUnit& unit = source.glsl->made();
    return head + (options.debugInfo ? unit.withPlaces() : essentialText(unit.text()));
}

TextHash hashOfModuleText(const ModuleSource& source, const ShaderCompileOptions& options) {
    const std::string head = headOfText(
        source, options, [&](const ModuleSource& part) { return hexText(hashOfModuleText(part, options)); });
    return hashOfText(head + hexText(options.debugInfo ? hashOfText(source.glsl->made().withPlaces())
                                                       : source.glsl->hash()));
}

Result<ModuleText> readModuleText(std::string_view text, const std::string& name) {
    ModuleText module;
    module.source.name = name;
    module.source.glsl = text;
    std::string_view rest = text;
    const auto takeLine = [&]() -> std::optional<std::string_view> {
        const std::size_t end = rest.find('\n');
        if (end == std::string_view::npos) {
            return std::nullopt;
        }
        const std::string_view line = rest.substr(0, end);
        rest.remove_prefix(end + 1);
        return line;
    };
    if (takeLine() != kFirstLine) {
        return formatError(name, "is no module of this version of glint: its first line is another");
    }
    std::optional<ShaderStage> stage;
    for (std::optional<std::string_view> line = takeLine(); line != kLastLine; line = takeLine()) {
        if (!line) {
            return formatError(name, "ends before its GLSL begins");
        }
        if (line->starts_with(kStage)) {
            stage = findStage(line->substr(kStage.size()));
        } else if (!takeInput(*line, module)) {
            return formatError(name, fmt::format("has an unknown line: {}", *line));
        }
    }
    if (!stage) {
        return formatError(name, "names no stage that there is");
    }
    module.source.stage = *stage;
    return module;
}

std::string nameOfModuleText(std::string_view text) {
    return hexText(hashOfText(text));
}

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kModuleMagic = "glint compiled module 1\n";
constexpr std::uint64_t kMaxModuleFileBytes = 1ULL << 30;
constexpr const char* kBuildAgain =
    "run Ninja on the file that `glint compile --plan-only` wrote, with the scenes and the glint of now";

std::string packFile(std::string_view text, const CachedModule& module) {
    const std::string body = Packer()
                                 .add(std::string_view(moduleCompiler()))
                                 .add(text)
                                 .add(std::string_view(packModule(module)))
                                 .take();
    return std::string(kModuleMagic) + Packer().add(base::hashBytes(body)).take() + body;
}

struct ModuleFile {
    std::string text;
    CachedModule module;
};

// Reads a file that packFile() made with this compiler. `name` is for messages.
Result<ModuleFile> readModuleFile(const fs::path& file, const std::string& name) {
    std::error_code error;
    if (!fs::exists(file, error)) {
        return makeError("module-missing", file.string(), fmt::format("there is no compiled {}", name),
                         kBuildAgain);
    }
    GLINT_TRY(const auto bytes, base::readFile(file, kMaxModuleFileBytes));
    const auto damaged = [&] {
        return makeError("module-format", file.string(),
                         fmt::format("is no compiled module, or a damaged one; it should be {}", name),
                         "delete it and run Ninja again");
    };
    if (!base::asText(bytes).starts_with(kModuleMagic)) {
        return damaged();
    }
    std::string_view rest = base::asText(bytes).substr(kModuleMagic.size());
    const std::optional<std::uint64_t> sum = Unpacker(rest).number();
    if (!sum || base::hashBytes(rest.substr(sizeof *sum)) != *sum) {
        return damaged();
    }
    rest.remove_prefix(sizeof *sum);
    Unpacker body(rest);
    const std::optional<std::string_view> compiler = body.text();
    const std::optional<std::string_view> held = body.text();
    const std::optional<std::string_view> words = body.text();
    std::optional<CachedModule> module = words && body.atEnd() ? unpackModule(*words) : std::nullopt;
    if (!module) {
        return damaged();
    }
    if (*compiler != moduleCompiler()) {
        return makeError("module-stale", file.string(),
                         fmt::format("{} was compiled by another compiler: {}", name, *compiler),
                         kBuildAgain);
    }
    return ModuleFile{std::string(*held), std::move(*module)};
}

// Joins the modules that lie beside `output`.
Status joinModuleFile(const ModuleText& source, std::string_view text, const fs::path& output) {
    std::vector<CachedModule> parts;
    for (const std::string& name : source.parts) {
        const fs::path file = output.parent_path() / (name + std::string(kCompiledModuleSuffix));
        GLINT_TRY(auto part, readModuleFile(file, "part of " + source.source.name));
        if (nameOfModuleText(part.text) != name) {
            return makeError("module-stale", file.string(), "was compiled from another text", kBuildAgain);
        }
        parts.push_back(std::move(part.module));
    }
    const auto pointers =
        base::mapped<const CachedModule*>(parts, [](const CachedModule& part) { return &part; });
    const Result<CachedModule> joined = joinMeasured(source.source, source.options, pointers);
    return joined ? base::writeFile(output, packFile(text, *joined)) : Status(joined.error());
}

}  // namespace

std::vector<PlannedModule> planModules(std::span<const ModuleSource> sources,
                                       const ShaderCompileOptions& options) {
    std::vector<PlannedModule> modules;
    std::set<std::string> known;
    const auto add = [&](const auto& self, const ModuleSource& source) -> std::string {
        std::vector<std::string> parts;
        for (const std::shared_ptr<const ModuleSource>& part : source.parts) {
            parts.push_back(self(self, *part));
        }
        std::string text = makeModuleText(source, options);
        std::string file = nameOfModuleText(text);
        if (known.insert(file).second) {
            modules.push_back({file, source.name, std::move(text), std::move(parts)});
        }
        return file;
    };
    for (const ModuleSource& source : sources) {
        add(add, source);
    }
    return modules;
}

Status compileModuleFile(const fs::path& input, const fs::path& output) {
    GLINT_TRY(const auto bytes, base::readFile(input, kMaxModuleFileBytes));
    const std::string_view text = base::asText(bytes);
    GLINT_TRY(const auto module, readModuleText(text, input.string()));
    if (!module.parts.empty()) {
        return joinModuleFile(module, text, output);
    }
    const Result<CachedModule> compiled = compileMeasured(module.source, module.options, module.link);
    return compiled ? base::writeFile(output, packFile(text, *compiled)) : Status(compiled.error());
}

Result<CachedModule> readCompiledModule(const fs::path& file, std::string_view text,
                                        const std::string& name) {
    GLINT_TRY(auto read, readModuleFile(file, name));
    if (read.text != text) {
        return makeError("module-stale", file.string(),
                         fmt::format("was compiled from another text than that of {}", name), kBuildAgain);
    }
    return std::move(read.module);
}

}  // namespace glint::compiler
