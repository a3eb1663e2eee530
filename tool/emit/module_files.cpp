#include "emit/module_files.h"

#include "base/files.h"
#include "cache/packing.h"
#include "emit/measured_module.h"
#include "emit/module_text.h"
#include "spirv/statistics.h"

#include <fmt/format.h>

#include <memory>
#include <optional>
#include <set>
#include <system_error>
#include <utility>

namespace glint::compiler {

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
    std::vector<const CachedModule*> pointers;
    for (const CachedModule& part : parts) {
        pointers.push_back(&part);
    }
    const Result<CachedModule> joined = joinMeasured(source.source, source.options, pointers);
    return joined ? base::writeFile(output, packFile(text, *joined)) : Status(joined.error());
}

}  // namespace

std::vector<PlannedModule> planModules(std::span<const ModuleSource> sources, bool debugInfo) {
    std::vector<PlannedModule> modules;
    std::set<std::string> known;
    const auto add = [&](const auto& self, const ModuleSource& source) -> std::string {
        std::vector<std::string> parts;
        for (const std::shared_ptr<const ModuleSource>& part : source.parts) {
            parts.push_back(self(self, *part));
        }
        std::string text = makeModuleText(source, debugInfo);
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
