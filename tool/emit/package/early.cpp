#include "emit/package/early.h"

#include "base/clock.h"
#include "emit/compile_modules.h"
#include "emit/modules.h"
#include "emit/package/manifest.h"
#include "emit/package/tables.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace glint::compiler {

namespace {

using Names = std::set<std::string, std::less<>>;

bool includes(std::string_view text, std::string_view name) {
    return text.find("#include \"" + std::string(name) + "\"") != std::string_view::npos;
}

// Returns the names of the packs' files that differ, or no value if files came or went.
std::optional<Names> differentFiles(const materials::MaterialModel& before,
                                    const materials::MaterialModel& after) {
    if (before.sources.size() != after.sources.size()) {
        return std::nullopt;
    }
    Names names;
    for (std::size_t i = 0; i < after.sources.size(); ++i) {
        if (before.sources[i].name != after.sources[i].name) {
            return std::nullopt;
        }
        if (before.sources[i].text != after.sources[i].text) {
            names.insert(after.sources[i].name);
        }
    }
    return names;
}

// Adds the files that include one of `names`, directly or not.
void addIncluding(const materials::MaterialModel& model, Names& names) {
    std::size_t known = 0;
    while (known != names.size()) {
        known = names.size();
        for (const materials::ModelSource& source : model.sources) {
            if (std::ranges::any_of(names,
                                    [&](const std::string& name) { return includes(source.text, name); })) {
                names.insert(source.name);
            }
        }
    }
}

}  // namespace

materials::FeatureMask editedFeatures(const materials::MaterialModel& before,
                                      const materials::MaterialModel& after) {
    const std::optional<Names> different = differentFiles(before, after);
    if (!different) {
        return 0;
    }
    materials::FeatureMask edited = 0;
    for (const std::string& name : *different) {
        // Each file on its own: one that no feature of a draft reads is a reason for the whole package.
        Names reading{name};
        addIncluding(after, reading);
        materials::FeatureMask ofFile = 0;
        for (const materials::FeatureCode& code : after.code) {
            const auto reads = [&](const std::string& file) { return reading.contains(file); };
            if (std::ranges::any_of(std::array{code.bsdf, code.layer, code.diffuse, code.opacity}, reads)) {
                return 0;
            }
            const bool shown =
                std::ranges::any_of(std::array{code.coordinates, code.surface, code.emission}, reads);
            if (shown && code.feature < 0) {
                return 0;
            }
            ofFile |= shown ? after.features[static_cast<std::size_t>(code.feature)].mask() : 0;
        }
        if (ofFile == 0) {
            return 0;
        }
        edited |= ofFile;
    }
    return edited;
}

Result<std::optional<CompiledPackage>> makeEarlyPackage(const gltf::SceneList& scenes, const Plan& plan,
                                                        const SourceSet& sources,
                                                        const CompileSettings& settings,
                                                        const CompiledPackage& before, WarmModules* warm) {
    using Early = std::optional<CompiledPackage>;
    const base::Clock::time_point start = base::Clock::now();
    if (settings.passes != package::Passes::Frame) {
        return Early();
    }
    const materials::FeatureMask edited =
        editedFeatures(*before.plan.model, *plan.model) & (plan.primaryAlways | plan.primarySometimes);
    const auto isTables = [](const PackageFile& file) { return file.name == package::kTablesFile; };
    const auto tables = std::ranges::find_if(before.files, isTables);
    if (edited == 0 || tables == before.files.end() ||
        makeTables(scenes, plan, before.modules, settings) != tables->bytes) {
        return Early();
    }
    GLINT_TRY(auto source, makeEditSource(scenes, plan, sources, settings, edited, warm));
    const base::Clock::time_point planned = base::Clock::now();
    std::vector<ModuleSource> only;
    only.push_back(std::move(source));
    GLINT_TRY(auto compiled, compileModules(std::move(only), 1, settings.debugInfo, nullptr, warm));
    const base::Clock::time_point haveSpirv = base::Clock::now();
    CompiledPackage early;
    early.plan = plan;
    for (const CompiledModule& module : before.modules) {
        CompiledModule& copy = early.modules.emplace_back();
        copy.key = module.key;
        copy.name = module.name;
        copy.file = module.file;
        copy.statistics = module.statistics;
        copy.hash = module.hash;
    }
    CompiledModule& edit = compiled.front();
    const auto place = std::ranges::lower_bound(early.modules, edit.key, {}, &CompiledModule::key);
    early.modules.insert(place, edit);
    for (const PackageFile& file : before.files) {
        if (!isTables(file) && file.name != package::kManifestFile) {
            early.files.push_back(file);
        }
    }
    const auto* const bytes = reinterpret_cast<const std::uint8_t*>(edit.spirv.data());
    early.files.push_back({edit.file, {bytes, bytes + edit.spirv.size() * sizeof(std::uint32_t)}});
    early.files.push_back({package::kTablesFile, makeTables(scenes, plan, early.modules, settings)});
    early.uniqueSpirv = before.uniqueSpirv + 1;
    early.spirvBytes = before.spirvBytes + edit.statistics.bytes;
    std::ranges::sort(early.files, {}, &PackageFile::name);
    const std::string manifest = makeManifest(scenes, early, settings);
    early.files.push_back({package::kManifestFile, {manifest.begin(), manifest.end()}});
    std::ranges::sort(early.files, {}, &PackageFile::name);
    early.planMs = base::millisecondsBetween(start, planned);
    early.compileMs = base::millisecondsBetween(planned, haveSpirv);
    early.tablesMs = base::millisecondsSince(haveSpirv);
    return Early(std::move(early));
}

}  // namespace glint::compiler
