#include "emit/module_files.h"

#include "base/files.h"
#include "cache/packing.h"
#include "emit/compile_modules.h"
#include "emit/module_text.h"
#include "spirv/statistics.h"

#include <fmt/format.h>

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

}  // namespace

std::vector<PlannedModule> planModules(std::span<const ModuleSource> sources, bool debugInfo) {
    std::vector<PlannedModule> modules;
    std::set<std::string> known;
    std::vector<const std::string*> texts;
    for (const ModuleSource& source : sources) {
        const auto [text, added] = known.insert(makeModuleText(source, debugInfo));
        if (added) {
            modules.push_back({{}, source.name, *text});
            texts.push_back(&*text);
        }
    }
    const std::vector<std::string> names = nameModuleTexts(texts);
    for (std::size_t i = 0; i < modules.size(); ++i) {
        modules[i].file = names[i];
    }
    return modules;
}

Status compileModuleFile(const fs::path& input, const fs::path& output) {
    const Result<base::Bytes> bytes = base::readFile(input, kMaxModuleFileBytes);
    if (!bytes) {
        return bytes.error();
    }
    const std::string_view text = base::asText(*bytes);
    const Result<ModuleText> module = readModuleText(text, input.string());
    if (!module) {
        return module.error();
    }
    const Result<CachedModule> compiled = compileMeasured(module->source, module->options);
    return compiled ? base::writeFile(output, packFile(text, *compiled)) : Status(compiled.error());
}

Result<CachedModule> readCompiledModule(const fs::path& file, std::string_view text,
                                        const std::string& name) {
    std::error_code error;
    if (!fs::exists(file, error)) {
        return makeError("module-missing", file.string(), fmt::format("there is no compiled {}", name),
                         kBuildAgain);
    }
    const Result<base::Bytes> bytes = base::readFile(file, kMaxModuleFileBytes);
    if (!bytes) {
        return bytes.error();
    }
    const auto damaged = [&] {
        return makeError("module-format", file.string(),
                         fmt::format("is no compiled module, or a damaged one; it should be {}", name),
                         "delete it and run Ninja again");
    };
    if (!base::asText(*bytes).starts_with(kModuleMagic)) {
        return damaged();
    }
    std::string_view rest = base::asText(*bytes).substr(kModuleMagic.size());
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
    if (*held != text) {
        return makeError("module-stale", file.string(),
                         fmt::format("was compiled from another text than that of {}", name), kBuildAgain);
    }
    return std::move(*module);
}

}  // namespace glint::compiler
