#include "inspect/lint.h"

#include "base/files.h"
#include "inspect/manifest_file.h"

#include <glint/package_format.h>

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <set>
#include <system_error>

namespace glint::inspect {

namespace fs = std::filesystem;

namespace {

constexpr const char* kExtension = ".spv";

std::string textOf(const base::Json& object, const char* member) {
    const auto found = object.find(member);
    return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

// Finds every object with a "file" that is SPIR-V, wherever it is in the manifest, so that future strategies
// need no change here.
class ManifestWalk {
public:
    explicit ManifestWalk(fs::path folder) : folder_(std::move(folder)) {}

    void visit(const base::Json& value, const std::string& name) {
        if (value.is_array()) {
            for (const auto& element : value) {
                visit(element, name);
            }
        } else if (value.is_object()) {
            visitObject(value, name);
        }
    }
    std::vector<LintFile> take() {
        return std::move(files_);
    }

private:
    void visitObject(const base::Json& object, std::string name) {
        if (const std::string role = textOf(object, "role"); !role.empty()) {
            name = role;
        }
        const std::string file = textOf(object, "file");
        if (fs::path(file).extension() == kExtension && seen_.insert(file).second) {
            files_.push_back({folder_ / file, name});
        }
        const bool isShader = object.contains("stages");
        for (const auto& [key, member] : object.items()) {
            if (isShader && key == "stages" && member.is_object()) {
                for (const auto& [stage, module] : member.items()) {
                    visit(module, textOf(object, "name") + " " + stage);
                }
            } else {
                visit(member, name);
            }
        }
    }

    fs::path folder_;
    std::vector<LintFile> files_;
    std::set<std::string> seen_;
};

Result<std::vector<LintFile>> filesOfPackage(const fs::path& folder) {
    GLINT_TRY(const auto manifest, readManifestFile(folder));
    ManifestWalk walk(folder);
    // The list of all files comes after those that have a name.
    walk.visit(manifest, "");
    return walk.take();
}

Result<std::vector<LintFile>> filesBelow(const fs::path& folder) {
    std::vector<LintFile> files;
    std::error_code error;
    for (fs::recursive_directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
        std::error_code ignored;
        if (it->path().extension() == kExtension && it->is_regular_file(ignored)) {
            files.push_back({it->path(), ""});
        }
    }
    if (error) {
        return makeError("lint-path", folder.string(), "can't be listed: " + error.message());
    }
    std::ranges::sort(files, {}, &LintFile::path);
    return files;
}

Result<compiler::SpirvLint> lintFile(const std::filesystem::path& path) {
    GLINT_TRY(const auto bytes, base::readFile(path));
    if (bytes.size() % sizeof(std::uint32_t) != 0) {
        return makeError("spirv-format", path.string(),
                         fmt::format("has {} bytes, which is no multiple of 4", bytes.size()),
                         "expected a SPIR-V module; this one may be cut short");
    }
    std::vector<std::uint32_t> words(bytes.size() / sizeof(std::uint32_t));
    if (!words.empty()) {
        std::memcpy(words.data(), bytes.data(), bytes.size());
    }
    return compiler::lintSpirv(words);
}

void checkBudget(const std::optional<std::int64_t>& budget, std::uint32_t count, const char* rule,
                 const char* what, std::vector<compiler::LintFinding>& findings) {
    if (budget && count > *budget) {
        findings.push_back({Severity::Error,
                            rule,
                            {},
                            fmt::format("has {} {}; the budget is {}", count, what, *budget),
                            "drop features or accuracy, or raise the budget"});
    }
}

void checkBudgets(const LintBudgets& budgets, LintedModule& module) {
    const compiler::SpirvStatistics& it = module.lint->statistics;
    checkBudget(budgets.instructions, it.instructions, "budget-instructions", "instructions",
                module.findings);
    checkBudget(budgets.textureFetches, it.textureFetches, "budget-texture-fetches", "texture fetches",
                module.findings);
    checkBudget(budgets.rayQueries, it.rayQueries, "budget-ray-queries", "ray queries", module.findings);
}

// Makes a finding of an error, with `severity` instead of the error's own.
compiler::LintFinding toFinding(const Diagnostic& error, Severity severity) {
    return {severity, error.id, {}, error.message, error.hint};
}

bool isStage(const LintedModule& module, const char* stage) {
    return module.lint && std::ranges::find(module.lint->stages, stage) != module.lint->stages.end();
}

std::size_t countIn(const std::vector<compiler::LintFinding>& findings, Severity severity) {
    return static_cast<std::size_t>(std::ranges::count(findings, severity, &compiler::LintFinding::severity));
}

}  // namespace

Result<LintFiles> findLintFiles(const fs::path& path) {
    std::error_code error;
    if (!fs::is_directory(path, error)) {
        if (!fs::exists(path, error)) {
            return makeError("lint-path", path.string(), "is not there",
                             "name a SPIR-V file, a package or a folder of SPIR-V files");
        }
        return LintFiles{false, {{path, ""}}};
    }
    GLINT_TRY(auto files,
              fs::exists(path / package::kManifestFile, error) ? filesOfPackage(path) : filesBelow(path));
    if (files.empty()) {
        return makeError("lint-path", path.string(), "holds no SPIR-V file",
                         "name a package or a folder of .spv files");
    }
    return LintFiles{true, std::move(files)};
}

LintedModule lintModule(const LintFile& file, const LintBudgets& budgets,
                        const std::optional<fs::path>& malioc, const std::string& core) {
    LintedModule module;
    module.file = file;
    Result<compiler::SpirvLint> lint = lintFile(file.path);
    if (!lint) {
        module.findings.push_back(toFinding(lint.error(), Severity::Error));
        return module;
    }
    module.lint = std::move(*lint);
    module.findings = module.lint->findings;
    checkBudgets(budgets, module);
    if (malioc && isStage(module, "GLCompute")) {
        Result<MaliocReport> estimate = runMalioc(*malioc, core, file.path);
        if (estimate) {
            module.malioc = std::move(*estimate);
        } else {
            module.findings.push_back(toFinding(estimate.error(), Severity::Warning));
        }
    }
    return module;
}

std::vector<compiler::LintFinding> judgeTogether(std::span<const LintedModule> modules) {
    // Mobile linkers inline the hit shaders of a pipeline up to about this number.
    constexpr std::ptrdiff_t kMaxClosestHits = 10;
    const auto closestHits = std::ranges::count_if(
        modules, [](const LintedModule& module) { return isStage(module, "ClosestHitKHR"); });
    if (closestHits <= kMaxClosestHits) {
        return {};
    }
    return {{Severity::Warning,
             "ray-pipeline-shaders",
             {},
             fmt::format("has {} closest-hit shaders; mobile drivers inline up to {}", closestHits,
                         kMaxClosestHits),
             "merge cases (--merge family or all), or use ray queries"}};
}

std::size_t LintReport::count(Severity severity) const {
    std::size_t total = 0;
    for (const LintedModule& module : modules) {
        total += countIn(module.findings, severity);
    }
    for (const LintedFolder& folder : folders) {
        total += countIn(folder.findings, severity);
    }
    return total;
}

Diagnostic toDiagnostic(const compiler::LintFinding& finding, const std::string& where) {
    const std::string place = toString(finding.place);
    return {finding.severity, finding.rule, where, (place.empty() ? "" : place + ": ") + finding.message,
            finding.hint};
}

}  // namespace glint::inspect
