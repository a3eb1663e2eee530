#include "emit/module_text.h"

#include "base/files.h"
#include "emit/glsl/prune.h"

#include <fmt/format.h>

#include <memory>
#include <optional>
#include <utility>

namespace glint::compiler {

namespace {

constexpr std::string_view kFirstLine = "// glint module 2";
constexpr std::string_view kStage = "// stage ";
constexpr std::string_view kApart = "// apart ";
constexpr std::string_view kExport = "// export ";
constexpr std::string_view kImport = "// import ";
constexpr std::string_view kEntry = "// entry point";
constexpr std::string_view kPart = "// part ";
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
    } else if (line.starts_with(kNamed)) {
        module.source.name = rest(kNamed);
        module.options.debugInfo = true;
    } else {
        return false;
    }
    return true;
}

}  // namespace

std::string makeModuleText(const ModuleSource& source, bool debugInfo) {
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
        text += fmt::format("{}{}\n", kPart, nameOfModuleText(makeModuleText(*part, debugInfo)));
    }
    if (debugInfo) {
        text += fmt::format("{}{}\n", kNamed, source.name);
    }
    text += kLastLine;
    text += '\n';
    if (debugInfo) {
        return text + source.glsl.withPlaces();
    }
    return text + (source.prepared ? source.prepared->essential : essentialText(source.glsl.text()));
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
    return base::hexHash(base::hashBytes(base::asBytes(text))) +
           base::hexHash(base::hashBytes(base::asBytes(text), 1));
}

}  // namespace glint::compiler
