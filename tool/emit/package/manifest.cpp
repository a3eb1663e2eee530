#include "emit/package/manifest.h"

#include "base/fields.h"
#include "emit/context.h"
#include "resolve/host.h"
#include "resolve/resolve.h"
#include "settings/descriptor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <utility>
#include <vector>

namespace glint::gltf {

base::Fields fieldsOf(const SceneInFile*) {
    return {base::field<&SceneInFile::index>("index", "Its number in the file, from 0."),
            base::field<&SceneInFile::name>("name", "Its name; null if it has none.", {.orNull = true})};
}

}  // namespace glint::gltf

namespace glint::compiler {

using base::field;
using base::output;

namespace {

// Rounds an estimate to four digits. That is more than its accuracy, and gives the same text on every
// machine.
double rounded(double value) {
    if (value == 0.0 || !std::isfinite(value)) {
        return 0.0;
    }
    const double scale = std::pow(10.0, 3.0 - std::floor(std::log10(std::abs(value))));
    return scale >= 1.0 ? std::round(value * scale) / scale : std::round(value);
}

template <double FrameFacts::*Member>
double fact(const StrategyAdvice& advice) {
    return rounded(advice.choice.facts.*Member);
}

std::vector<std::pair<std::string_view, double>> timesOfTerms(const StrategyEstimate& estimate) {
    std::vector<std::pair<std::string_view, double>> parts;
    for (const CostTermInfo& info : costTerms()) {
        if (hasTerm(estimate.strategy, info.term)) {
            parts.emplace_back(info.name, rounded(estimate.parts[static_cast<std::size_t>(info.term)]));
        }
    }
    return parts;
}

}  // namespace

std::optional<gltf::SceneInFile> orNone(const gltf::SceneInFile& scene) {
    return scene.index < 0 ? std::nullopt : std::optional(scene);
}

std::vector<std::string_view> strategyWords() {
    return {simplestFirst().begin(), simplestFirst().end()};
}

static base::Fields fieldsOf(const StrategyEstimate*) {
    using T = StrategyEstimate;
    return {output<&T::strategy>("strategy", "Name of the strategy.", {.names = strategyWords()}),
            output<&T::available>(
                "available", "Whether it could be chosen, that is, device, package and tracer can run it."),
            output("milliseconds", "Expected time of all rounds of rays, from the list to the shaded hits.",
                   [](const T& estimate) { return rounded(estimate.ms); }),
            output<timesOfTerms>("parts",
                                 "Milliseconds of each term of the model that the strategy has, by name.")};
}

base::Fields fieldsOf(const StrategyAdvice*) {
    using T = StrategyAdvice;
    using Choice = StrategyChoice;
    using Facts = FrameFacts;
    return {
        output<&T::choice, &Choice::strategy>("strategy", "The strategy that was chosen.",
                                              {.names = strategyWords()}),
        output<&T::choice, &Choice::why>("why", "Sentences that name the numbers."),
        output<&T::device>("device", "Device whose constants the estimates use."),
        output<&T::builtIn>("builtIn", "Whether these constants are built in and not from --calibration."),
        output<&T::pixels>("pixels", "Number of pixels of the frame.", {.least = 0}),
        output<&T::choice, &Choice::facts, &Facts::bounces>(
            "bounces", "The most bounces of a path that are expected to have rays."),
        output<fact<&Facts::rays>>("rays", "Expected number of rays of all effects whose hits are shaded."),
        output<fact<&Facts::laterRays>>("laterRays", "Those of them that hits send, after the first bounce."),
        output<fact<&Facts::hits>>("hits", "Expected number of hits of these rays."),
        output<&T::choice, &Choice::facts, &Facts::cases>("cases", "Number of shaders."),
        output<fact<&Facts::instructions>>(
            "instructions",
            "SPIR-V instructions that shading a hit takes on average, 20 for each texture fetch beside "
            "its own."),
        output("coherence",
               "How alike the hits of neighbouring rays are expected to be: 0 as drawn at random, 1 all of "
               "one case.",
               [](const T& advice) { return roundedShare(advice.choice.facts.coherence); }),
        output<fact<&Facts::casesRun>>(
            "casesRun", "Cases that a subgroup of unsorted hits is expected to run one after another."),
        output<&T::choice, &Choice::estimates>("estimates", "Strategies whose constants are known.")};
}

base::Fields fieldsOf(const EffectDecision*) {
    using T = EffectDecision;
    return {field<&T::name>("name", "Name of the effect."),
            field<&T::chosen>("chosen", "Whether it is in the package."),
            field<&T::usable>("usable", "Whether the scenes call for it."),
            field<&T::reason>("reason", "The reason.")};
}

base::Fields fieldsOf(const SpirvStatistics*) {
    using T = SpirvStatistics;
    return {
        field<&T::bytes>("bytes", "Size of the module."),
        field<&T::instructions>("instructions", "Instructions in functions, without labels and debug lines."),
        field<&T::textureFetches>("textureFetches", "Texture fetches and samples."),
        field<&T::rayQueries>("rayQueries", "Initialisations of ray queries."),
        field<&T::branches>("branches", "Conditional branches and switches.")};
}

std::variant<std::uint64_t, double> wholeNumber(double count) {
    constexpr double kLargest = 9007199254740992.0;  // 2^53
    if (count <= kLargest) {
        return static_cast<std::uint64_t>(count);
    }
    return count;
}

double roundedShare(double share) {
    return std::round(share * 1e4) / 1e4;
}

std::string stageName(const package::ModuleKey& key) {
    const package::RoleInfo& info = *package::findRole(key.role);
    const bool alone = info.kind == package::ShaderKind::ClosestHit;
    const std::string name(
        info.shadesFirst() ? "first hits" : package::nameOf(static_cast<package::Strategy>(info.strategies)));
    return alone || key.tracer != package::kTracerRayPipeline ? name : name + ", ray-pipeline";
}

namespace {

// Returns the path relative to the scene's folder, because a package must not tell where it was built.
std::string relativeName(const std::string& path, const std::string& scenePath) {
    const std::filesystem::path folder = std::filesystem::path(scenePath).parent_path().lexically_normal();
    const std::filesystem::path file = std::filesystem::path(path).lexically_normal();
    const std::filesystem::path relative = folder.empty() ? file : file.lexically_relative(folder);
    const bool isBelow = !relative.empty() && relative.is_relative() && *relative.begin() != "..";
    return (isBelow ? relative : file.filename()).generic_string();
}

ManifestFile fileOf(std::string name, std::uint64_t bytes, std::uint64_t hash) {
    return {std::move(name), bytes, base::hexHash(hash)};
}

// Returns "textureLod" for "texture-lod".
std::string memberName(std::string_view setting) {
    std::string name;
    for (std::size_t i = 0; i < setting.size(); ++i) {
        const bool starts = i > 0 && setting[i - 1] == '-';
        if (setting[i] != '-') {
            name += starts ? static_cast<char>(setting[i] - 'a' + 'A') : setting[i];
        }
    }
    return name;
}

// The settings that the table records, and the sky.
std::vector<std::pair<std::string, std::string>> settingsOf(const CompileSettings& compile) {
    Settings settings;
    settings.compile = compile;
    settings.choosesFirstShadows = false;  // resolve() has chosen
    std::vector<std::pair<std::string, std::string>> list;
    for (const Descriptor& row : settingsTable()) {
        if (row.recorded) {
            list.emplace_back(memberName(row.name), row.values.text(settings));
        }
    }
    list.emplace_back("sky", compile.environmentMap ? "map" : "gradient");
    return list;
}

// Returns the JSON of settings: switches as booleans, numbers as numbers.
std::vector<std::pair<std::string, base::Json>> settingsJson(const Manifest& manifest) {
    std::vector<std::pair<std::string, base::Json>> list{{"hitLobes", base::jsonOf(manifest.hitLobes)}};
    for (const auto& [name, text] : manifest.settings) {
        base::Json number = base::Json::parse(text, nullptr, false);
        const bool isSwitch = text == "on" || text == "off";
        list.emplace_back(name, isSwitch             ? base::Json(text == "on")
                                : number.is_number() ? std::move(number)
                                                     : base::Json(text));
    }
    return list;
}

void setSettings(Manifest& manifest, const std::vector<std::pair<std::string, base::Json>>& settings,
                 base::JsonReader& reader, const std::string& place) {
    for (const auto& [name, value] : settings) {
        if (name == "hitLobes") {
            reader.each(value, place + "/hitLobes", [&](const base::Json& lobe, const std::string& there) {
                manifest.hitLobes.push_back(reader.text(lobe, there));
            });
        } else {
            manifest.settings.emplace_back(name, value.is_boolean()  ? (value.get<bool>() ? "on" : "off")
                                                 : value.is_string() ? value.get<std::string>()
                                                                     : value.dump());
        }
    }
}

// Returns the names of the declarations of packs.
std::vector<std::string> packNames(const materials::MaterialModel& model) {
    std::set<std::string> names;
    for (const materials::FeatureCode& code : model.code) {
        if (code.isOfPack) {
            names.insert(code.name);
        }
    }
    return {names.begin(), names.end()};
}

std::vector<ManifestPlace> placesOf(const gltf::SceneList& scenes, const std::vector<int>& materials) {
    std::vector<ManifestPlace> places;
    for (const int material : materials) {
        const gltf::SceneList::Place place = scenes.place(material);
        places.push_back({static_cast<std::uint32_t>(place.scene), static_cast<std::uint32_t>(place.index)});
    }
    return places;
}

std::vector<ManifestScene> scenesOf(const gltf::SceneList& scenes) {
    std::vector<ManifestScene> list;
    for (std::size_t i = 0; i < scenes.scenes().size(); ++i) {
        const gltf::Scene& scene = scenes.scenes()[i];
        list.push_back({scenes.name(i),
                        std::filesystem::path(scene.path).filename().string(),
                        scene.variant,
                        scene.materials.size(),
                        scenes.primitivesOf(i).count,
                        {}});
        for (const gltf::SourceFile& file : scene.files) {
            list.back().sources.push_back(fileOf(relativeName(file.path, scene.path), file.bytes, file.hash));
        }
    }
    return list;
}

ManifestModule moduleOf(const CompiledModule& module) {
    return {module.name, module.file, module.statistics, package::featuresOf(module.spirv),
            base::hexHash(module.hash)};
}

// Lists a case's own modules by strategy. In the uber shader a case is a function, which is listed under
// passes.
std::vector<ManifestCase> casesOf(const gltf::SceneList& scenes, const CompiledPackage& package) {
    std::vector<ManifestCase> list;
    std::map<std::uint32_t, std::size_t> entries;  // in the list, by ID
    for (const Case& shaderCase : package.plan.cases) {
        if (shaderCase.isRetired()) {
            continue;
        }
        entries.emplace(shaderCase.shaderId, list.size());
        ManifestCase& entry = list.emplace_back();
        entry.id = static_cast<std::uint32_t>(shaderCase.shaderId);
        entry.name = shaderCase.name;
        entry.always = package.plan.model->names(shaderCase.always);
        entry.sometimes = package.plan.model->names(shaderCase.sometimes);
        entry.keys = shaderCase.keys.size();
        entry.share = roundedShare(shaderCase.share);
        entry.reason = toString(shaderCase.reason);
        const std::vector<ManifestPlace> places = placesOf(scenes, shaderCase.materials);
        for (std::size_t i = 0; i < places.size(); ++i) {
            const auto material = static_cast<std::size_t>(shaderCase.materials[i]);
            entry.materials.push_back({places[i], scenes.materials()[material].name});
        }
    }
    for (const CompiledModule& module : package.modules) {
        if (package::findRole(module.key.role)->repeated == package::Repeated::ByCase) {
            list[entries.at(module.key.index)].stages.emplace_back(stageName(module.key), moduleOf(module));
        }
    }
    return list;
}

// The attributes of packs that shaders read, in the order of their values.
std::vector<ManifestAttribute> attributesOf(const Plan& plan) {
    const materials::FeatureMask used = usedFeatures(plan);
    std::vector<ManifestAttribute> list;
    for (const materials::VertexAttribute& attribute : plan.model->attributes) {
        const materials::Feature& feature = plan.model->features[static_cast<std::size_t>(attribute.feature)];
        if (!used.has(feature.bit)) {
            continue;
        }
        list.push_back({attribute.name, attribute.gltf, feature.name, attribute.type->channels, {}});
        if (attribute.fallback) {
            list.back().fallback.emplace(attribute.fallback->begin(),
                                         attribute.fallback->begin() + attribute.type->channels);
        }
    }
    return list;
}

Manifest manifestOf(const gltf::SceneList& scenes, const CompiledPackage& package,
                    const CompileSettings& settings) {
    const Plan& plan = package.plan;
    const materials::MaterialModel& model = *plan.model;
    Manifest manifest;
    manifest.toolVersion = toolVersion();
    manifest.scenes = scenesOf(scenes);
    manifest.strategies = strategyNames(settings.strategies);
    manifest.strategyChoice = settings.strategyChoice;
    manifest.tracers = tracerNames(settings.tracers);
    manifest.merge = nameOf(settings.plan.merge);
    const int budget = budgetOf(settings.plan);
    manifest.maxShaders = budget > 0 ? std::optional(budget) : std::nullopt;
    manifest.alpha = nameOf(settings.plan.keys.alpha);
    // The files were read when the modules were made, so they are there.
    if (const Result<std::vector<std::string>> host = replacedHostFiles(settings.host)) {
        manifest.host = *host;
    }
    manifest.packs = packNames(model);
    manifest.hitLobes = model.names(settings.plan.keys.keptLobes & model.lobes);
    manifest.settings = settingsOf(settings);
    manifest.counts = {scenes.materials().size(), plan.keysPossible,
                       plan.keys.size(),          static_cast<std::size_t>(caseCount(plan)),
                       package.modules.size(),    static_cast<std::size_t>(package.uniqueSpirv),
                       package.spirvBytes};
    manifest.buckets = 1 + plan.cases.size();
    manifest.effects = plan.effects;
    for (const materials::Feature& feature : model.features) {
        manifest.features.push_back(
            {feature.name, feature.bit, feature.isLobe, feature.macro, feature.gltf, feature.neutralText()});
    }
    manifest.vertexAttributes = attributesOf(plan);
    manifest.shaders = casesOf(scenes, package);
    for (const CompiledModule& module : package.modules) {
        if (package::findRole(module.key.role)->repeated != package::Repeated::ByCase) {
            manifest.passes.push_back({std::string(package::roleName(module.key.role)), moduleOf(module)});
        }
    }
    for (const Key& key : plan.keys) {
        manifest.keys.push_back({model.names(key.mask), toHex(key.mask), key.primitives.size(),
                                 placesOf(scenes, key.materials), roundedShare(key.share),
                                 static_cast<std::uint32_t>(key.shaderId)});
    }
    for (const DroppedFeature& feature : plan.dropped) {
        manifest.dropped.push_back({feature.feature, placesOf(scenes, feature.materials), feature.reason});
    }
    for (const PackageFile& file : package.files) {
        manifest.files.push_back(fileOf(file.name, file.bytes.size(), file.hash));
    }
    return manifest;
}

// The manifest may come from anywhere, so its names must not lead out of the package's folder.
bool staysInside(const std::filesystem::path& name) {
    return !name.empty() && name.is_relative() &&
           std::ranges::all_of(name, [](const std::filesystem::path& part) {
               return !part.empty() && part != "." && part != "..";
           });
}

}  // namespace

static base::Fields fieldsOf(const ManifestPlace*) {
    return {field<&ManifestPlace::scene>("scene", "Number of the scene, from 0."),
            field<&ManifestPlace::index>("index", "Number of the material in its scene, from 0.")};
}

static base::Fields fieldsOf(const ManifestMaterial*) {
    return {field<&ManifestMaterial::place>("", ""),
            field<&ManifestMaterial::name>("name", "Name in the file; may be empty.")};
}

static base::Fields fieldsOf(const ManifestFile*) {
    using T = ManifestFile;
    return {field<&T::file>("file", "File relative to the folder of the package, or of the scene."),
            field<&T::bytes>("bytes", "Size of the file."),
            field<&T::hash>("hash", "XXH3, 64 bits, hexadecimal.", {.pattern = "^[0-9a-f]{16}$"})};
}

static base::Fields fieldsOf(const ManifestScene*) {
    using T = ManifestScene;
    return {field<&T::name>("name", "The name by which programs find the scene."),
            output<&T::source>("source", "File name."),
            field<&T::variant>("variant", "The variant whose materials the scene has.", {.orNull = true}),
            output<&T::materials>("materials", "Number of materials."),
            output<&T::primitives>("primitives", "Number of primitives."),
            output<&T::sources>("sources", "Files of the scene that were read.")};
}

static base::Fields fieldsOf(const ManifestFeature*) {
    using T = ManifestFeature;
    return {field<&T::name>("name", "Name of the feature."),
            field<&T::bit>("bit", "The feature's bit in masks."),
            field<&T::lobe>("lobe", "Whether it is a lobe; else it is an input."),
            output<&T::macro>("macro", "Name of the GLSL macro."),
            output<&T::gltf>("gltf", "Property of glTF that holds it."),
            output<&T::neutral>("neutral", "Value that changes nothing.")};
}

static base::Fields fieldsOf(const ManifestAttribute*) {
    using T = ManifestAttribute;
    return {output<&T::name>("name", "The name in GLSL."), output<&T::gltf>("gltf", "The name in glTF."),
            output<&T::feature>("feature", "The feature whose code reads it."),
            output<&T::channels>("channels", "Floats of a vertex.", {.least = 1, .most = 4}),
            output<&T::fallback>("default", "Its value where it is missing; null: no feature there.")};
}

static base::Fields fieldsOf(const ManifestModule*) {
    using T = ManifestModule;
    return {
        output<&T::name>("name", "Name of the entry point in messages and captures."),
        output<&T::file>("file", "File relative to the package's folder."), output<&T::statistics>("", ""),
        output<&T::features>("features",
                             "What the module demands of a device beyond Vulkan 1.3 and scalarBlockLayout: "
                             "names of features and of subgroup operations."),
        output<&T::hash>("hash", "XXH3, 64 bits, hexadecimal.", {.pattern = "^[0-9a-f]{16}$"})};
}

static base::Fields fieldsOf(const ManifestPass*) {
    return {output<&ManifestPass::role>("role", "Role of the module."),
            output<&ManifestPass::module>("", "")};
}

static base::Fields fieldsOf(const ManifestCase*) {
    using T = ManifestCase;
    return {field<&T::id>("id", "Shader ID."),
            field<&T::name>("name", "Name of the shader."),
            output<&T::always>("always", "Names of features, by bit."),
            output<&T::sometimes>("sometimes", "Names of features, by bit."),
            output<&T::keys>("keys", "How many keys share it."),
            field<&T::share>("share", "Share of all hits.", {.least = 0, .most = 1}),
            output<&T::reason>("reason", "Why the keys of a case share it."),
            field<&T::materials>("materials", "Materials that it shades."),
            output<&T::stages>("stages", "Its modules by purpose.")};
}

static base::Fields fieldsOf(const ManifestKey*) {
    using T = ManifestKey;
    return {field<&T::features>("features", "Names of features, by bit."),
            output<&T::mask>("mask", "Bits of features, hexadecimal.", {.pattern = "^0x[0-9a-f]{16}$"}),
            output<&T::primitives>("primitives", "Number of primitives that have the key."),
            output<&T::materials>("materials", "Materials that have the key."),
            output<&T::share>("share", "Share of all hits.", {.least = 0, .most = 1}),
            field<&T::shaderId>("shaderId", "Shader ID of the case that shades it.")};
}

static base::Fields fieldsOf(const ManifestDrop*) {
    using T = ManifestDrop;
    return {output<&T::feature>("feature", "Name of the feature."),
            output<&T::materials>("materials", "Materials whose shaders leave it out."),
            output<&T::reason>("reason", "The reason.")};
}

static base::Fields fieldsOf(const ManifestCounts*) {
    using T = ManifestCounts;
    return {field<&T::materials>("materials", "Number of materials of all scenes."),
            output("keysPossible", "Permutations that files may have.",
                   [](const T& counts) { return wholeNumber(counts.keysPossible); }),
            field<&T::keysPresent>("keysPresent", "Permutations that the scenes have."),
            field<&T::cases>("cases", "Number of shaders."),
            field<&T::modules>("modules", "SPIR-V modules."),
            field<&T::uniqueSpirv>("uniqueSpirv", "SPIR-V files."),
            field<&T::spirvBytes>("spirvBytes", "Size of these files.")};
}

base::Fields fieldsOf(const Manifest*) {
    using T = Manifest;
    base::Field settings = field(
        "settings", "Further choices of the compilation.", [](const T& it) { return settingsJson(it); },
        [](T& it, const std::vector<std::pair<std::string, base::Json>>& list, base::JsonReader& reader,
           const std::string& place) { setSettings(it, list, reader, place); });
    settings.schema = [](const base::FieldTraits&) -> base::Json {
        return {{"$ref", "common.json#/definitions/settings"}};
    };
    return {
        base::constant("format", "Names the kind of file.", std::string(kManifestFormat)),
        output("version", "Version of the format.", [](const T&) { return package::kVersion; }),
        field<&T::toolVersion>("toolVersion", "Version of the glint that made it."),
        field<&T::scenes>("scenes", "The scenes, in the order of the command line.", {.leastElements = 1}),
        field<&T::strategies>("strategies", "Strategies that the package can run.",
                              {.names = strategyWords()}),
        output<&T::strategyChoice>("strategyChoice",
                                   "How --strategy auto chose; null where strategies were named."),
        field<&T::tracers>("tracers", "Tracers that the package can use.",
                           {.names = base::wordsFor<package::Tracer>()}),
        field<&T::merge>("merge", "Policy by which keys share cases.",
                         {.names = base::wordsFor<MergePolicy>()}),
        field<&T::maxShaders>("maxShaders", "The budget of cases; null for none."),
        field<&T::alpha>("alpha", "What rays do with the alpha of what they hit.",
                         {.names = base::wordsFor<package::AlphaPolicy>()}),
        field<&T::host>("host", "Files of shaders/host that --host replaced."),
        field<&T::packs>("packs", "Names of the declarations that packs of materials brought."),
        settings,
        field<&T::counts>("counts", "Counts."),
        output<&T::buckets>("buckets", "Buckets of hits: one for misses, and one for each shader ID."),
        output<&T::effects, &EffectPlan::decisions>(
            "effects", "Every effect that there is, and whether the package has it."),
        field<&T::features>("features", "Every feature that there is, by bit."),
        output<&T::vertexAttributes>("vertexAttributes",
                                     "The attributes of vertices that shaders read beside those of glTF's "
                                     "core, in the order of their values."),
        field<&T::shaders>("shaders", "The cases, by ID."),
        output<&T::passes>("passes", "All other modules."),
        field<&T::keys>("keys", "The permutations."),
        output<&T::dropped>("dropped", "Features that files ask for and shaders leave out."),
        field<&T::files>("files", "All files in the folder except this one.")};
}

std::string_view Manifest::setting(std::string_view name) const {
    const auto found = std::ranges::find(settings, name, &std::pair<std::string, std::string>::first);
    return found != settings.end() ? std::string_view(found->second) : std::string_view();
}

std::string makeManifest(const gltf::SceneList& scenes, const CompiledPackage& package,
                         const CompileSettings& settings) {
    return base::toText(base::jsonOf(manifestOf(scenes, package, settings)));
}

Result<Manifest> readManifest(const std::filesystem::path& folder) {
    constexpr std::uint64_t kMostBytes = 1ULL << 32;
    return base::readFileAs<Manifest>(
        {folder / package::kManifestFile, "manifest-format", "compile the package again"}, kMostBytes);
}

std::set<std::string, std::less<>> manifestFiles(std::string_view text) {
    if (base::nestsTooDeep({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()})) {
        return {};
    }
    const base::Json manifest = base::Json::parse(text, nullptr, false);
    if (!manifest.is_object() || manifest.value("format", base::Json()) != base::Json(kManifestFormat)) {
        return {};
    }
    std::set<std::string, std::less<>> names{package::kManifestFile, package::kTablesFile};
    const base::Json list = manifest.value("files", base::Json::array());
    for (const base::Json& file : list) {
        const base::Json name = file.is_object() ? file.value("file", base::Json()) : base::Json();
        if (name.is_string() && staysInside(name.get<std::string>())) {
            names.insert(name.get<std::string>());
        }
    }
    return names;
}

}  // namespace glint::compiler
