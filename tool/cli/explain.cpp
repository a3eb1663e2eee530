// glint explain: shows which key and which case each material gets, and why.
#include "base/suggest.h"
#include "cli/command_line.h"
#include "cli/commands.h"
#include "cli/explain/motion_text.h"
#include "cli/explain/plan_text.h"
#include "cli/options/effect_options.h"
#include "cli/options/lock_option.h"
#include "cli/options/setting_options.h"
#include "cli/report.h"
#include "cli/table.h"
#include "emit/package/json.h"
#include "gltf/import.h"

#include <glint/measure/profile.h>
#include <glint/measure/strategy_advice.h>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <memory>
#include <optional>
#include <set>
#include <utility>

namespace glint::cli {

namespace {

struct ExplainArguments {
    std::string scene;
    std::string material;
    bool wholePlan = false;
    compiler::Settings settings;
    LockArguments lock;
};

// The scene, and its plan.
struct Planned {
    const gltf::SceneList& scenes;
    compiler::PlanOptions options;
    compiler::Plan plan;
};

using Drop = std::pair<std::string, std::string>;  // feature, reason

// Returns the features that a material asks for and does not get, over all of its primitives.
std::set<Drop> dropsOf(const Planned& planned, int material) {
    std::set<Drop> drops;
    for (const materials::PrimitiveInputs& inputs : planned.scenes.primitives()) {
        if (inputs.material == material) {
            std::vector<Drop> found;
            compiler::makeKey(planned.scenes.materials()[static_cast<std::size_t>(material)], inputs,
                              planned.options.keys, &found);
            drops.insert(found.begin(), found.end());
        }
    }
    return drops;
}

std::vector<const compiler::Key*> keysOf(const Planned& planned, int material) {
    std::vector<const compiler::Key*> keys;
    for (const compiler::Key& key : planned.plan.keys) {
        if (std::binary_search(key.materials.begin(), key.materials.end(), material)) {
            keys.push_back(&key);
        }
    }
    return keys;
}

// Returns JSON pointers of the primitives of one material that have this key.
std::vector<std::string> primitivesOf(const Planned& planned, const compiler::Key& key, int material) {
    std::vector<std::string> pointers;
    for (const int index : key.primitives) {
        const materials::PrimitiveInputs& inputs =
            planned.scenes.primitives()[static_cast<std::size_t>(index)];
        if (inputs.material == material) {
            pointers.push_back(fmt::format("/meshes/{}/primitives/{}", inputs.mesh, inputs.primitive));
        }
    }
    return pointers;
}

const compiler::Case& caseOf(const Planned& planned, const compiler::Key& key) {
    return planned.plan.cases[static_cast<std::size_t>(key.shaderId)];
}

// Returns the masks of primary surfaces of one material whose hits have this key. If hits keep all lobes, it
// is only the key itself.
std::set<materials::FeatureMask> primaryMasksOf(const Planned& planned, const compiler::Key& key,
                                                int material) {
    std::set<materials::FeatureMask> masks;
    for (const int index : key.primitives) {
        const auto primitive = static_cast<std::size_t>(index);
        if (planned.scenes.primitives()[primitive].material == material) {
            masks.insert(planned.plan.primaryMaskOfPrimitive[primitive]);
        }
    }
    return masks;
}

base::Json primaryToJson(const Planned& planned, const compiler::Key& key, int material) {
    base::Json list = base::Json::array();
    for (const materials::FeatureMask mask : primaryMasksOf(planned, key, material)) {
        list.push_back(featuresToJson(*planned.plan.model, mask));
    }
    return list;
}

// What animations change of the material: planning drops no feature for a value that passes.
std::vector<std::string> changesOf(const gltf::SceneList& scenes, int material) {
    const gltf::SceneList::Place place = scenes.place(material);
    const std::vector<gltf::AnimatedMaterial>& all = scenes.scenes()[place.scene].animatedMaterials;
    const auto found = std::ranges::find(all, place.index, &gltf::AnimatedMaterial::material);
    return found == all.end() ? std::vector<std::string>() : found->changes;
}

base::Json toJson(const Planned& planned, int material) {
    base::Json keys = base::Json::array();
    for (const compiler::Key* key : keysOf(planned, material)) {
        const compiler::Case& shader = caseOf(planned, *key);
        keys.push_back(base::Json{{"mask", fmt::format("0x{:016x}", key->mask)},
                                  {"features", featuresToJson(*planned.plan.model, key->mask)},
                                  {"onPrimarySurfaces", primaryToJson(planned, *key, material)},
                                  {"share", compiler::shareToJson(key->share)},
                                  {"case",
                                   {{"id", shader.shaderId},
                                    {"name", shader.name},
                                    {"keys", shader.keys.size()},
                                    {"share", compiler::shareToJson(shader.share)},
                                    {"reason", toString(shader.reason)},
                                    {"always", featuresToJson(*planned.plan.model, shader.always)},
                                    {"sometimes", featuresToJson(*planned.plan.model, shader.sometimes)}}},
                                  {"primitives", primitivesOf(planned, *key, material)}});
    }
    base::Json dropped = base::Json::array();
    for (const auto& [feature, reason] : dropsOf(planned, material)) {
        dropped.push_back(base::Json{{"feature", feature}, {"reason", reason}});
    }
    return {{"index", material},
            {"name", planned.scenes.materialName(material)},
            {"keys", keys},
            {"dropped", dropped},
            {"animated", changesOf(planned.scenes, material)}};
}

std::string whyText(const compiler::Case& shader) {
    const std::size_t keys = shader.keys.size();
    return fmt::format("{}: {}{}", toString(shader.reason), explain(shader.reason),
                       keys > 1 ? fmt::format(" ({} keys)", keys) : std::string());
}

std::string sharesText(const Planned& planned, const compiler::Key& key, const compiler::Case& shader) {
    const bool counted = countsHits(planned.options);
    const std::string ofCase =
        shader.keys.size() > 1 ? fmt::format(", its case {:.2f} %", 100.0 * shader.share) : std::string();
    return fmt::format("{:.2f} %{}, {}", 100.0 * key.share, ofCase,
                       counted ? "counted by the profile" : "expected from areas");
}

std::string toText(const Planned& planned, int material, Detail detail) {
    std::string text = fmt::format("material {}: {}\n", material, planned.scenes.materialName(material));
    const std::vector<const compiler::Key*> keys = keysOf(planned, material);
    if (keys.empty()) {
        return text + "  no primitive uses it: no key, no shader\n";
    }
    std::vector<std::vector<std::string>> rows;
    for (const compiler::Key* key : keys) {
        const compiler::Case& shader = caseOf(planned, *key);
        const std::vector<std::string> primitives = primitivesOf(planned, *key, material);
        const std::string more =
            primitives.size() > 1 ? fmt::format(" and {} more", primitives.size() - 1) : std::string();
        rows.push_back({"  key", fmt::format("0x{:016x}", key->mask)});
        rows.push_back({"    features", featureList(*planned.plan.model, key->mask)});
        for (const materials::FeatureMask mask : primaryMasksOf(planned, *key, material)) {
            if (mask != key->mask) {
                rows.push_back({"    primary only", featureList(*planned.plan.model, mask & ~key->mask)});
            }
        }
        rows.push_back(
            {"    case", shaderTitle(static_cast<std::uint64_t>(shader.shaderId), shader.name, detail)});
        rows.push_back({"    why", whyText(shader)});
        rows.push_back({"    hits", sharesText(planned, *key, shader)});
        rows.push_back({"    branches on", featureList(*planned.plan.model, shader.sometimes)});
        rows.push_back({"    primitives", primitives.front() + more});
    }
    for (const auto& [feature, reason] : dropsOf(planned, material)) {
        rows.push_back({"  dropped", fmt::format("{}: {}", feature, reason)});
    }
    for (const std::string& change : changesOf(planned.scenes, material)) {
        rows.push_back({"  animated", fmt::format("{}: kept for all values between", change)});
    }
    return text + formatFields(rows, detail);
}

// Returns an empty text if the scene has no variants.
std::string variantsText(const gltf::Scene& scene) {
    if (scene.variants.empty()) {
        return {};
    }
    return formatFields({{"variants", base::join(scene.variants)},
                         {"materials of", scene.variant.empty() ? "no variant (--variant)" : scene.variant}});
}

// Returns every material with that number, else those with that name; all if none is asked for.
Result<std::vector<int>> chooseMaterials(const gltf::SceneList& scenes, const std::string& wanted) {
    const int count = static_cast<int>(scenes.materials().size());
    int number = -1;
    const char* end = wanted.data() + wanted.size();
    const auto parsed = std::from_chars(wanted.data(), end, number);
    if (parsed.ec == std::errc() && parsed.ptr == end && number >= 0 && number < count) {
        return std::vector<int>{number};
    }
    std::vector<int> chosen;
    std::vector<std::string> names;
    for (int i = 0; i < count; ++i) {
        names.push_back(scenes.materialName(i));
        if (wanted.empty() || names.back() == wanted) {
            chosen.push_back(i);
        }
    }
    if (chosen.empty() && !wanted.empty()) {
        return makeError("material-unknown", scenes.path(),
                         fmt::format("has no material \"{}\"{}{}", wanted, base::enumeration(names),
                                     base::suggestion(wanted, names)),
                         "use a name, or a number from 0");
    }
    return chosen;
}

// Advises for a frame of the usual size, with the effects that the scene calls for.
Result<compiler::StrategyAdvice> advise(const measure::KnownCosts& costs, const Planned& planned,
                                        const compiler::EffectPlan& effects, std::uint32_t bounces) {
    compiler::FrameShape shape;
    shape.effects = effects.effects.all;
    shape.bounces = bounces;
    return measure::adviseStrategy(
        costs, measure::roundsOf(planned.scenes, planned.plan, planned.options, shape),
        measure::runnableStrategies(package::kAllTracers, std::nullopt, nullptr), shape.pixels);
}

int explain(const Console& console, const ExplainArguments& arguments) {
    const Result<gltf::ImportOptions> import = importOptions(arguments.settings, ImageReading::None);
    if (!import) {
        console.report(import.error());
        return kExitFailed;
    }
    const Result<gltf::Scene> scene = importScene(arguments.scene, *import);
    if (!scene) {
        console.report(scene.error());
        return kExitFailed;
    }
    console.report(scene->warnings);
    const Result<measure::KnownCosts> costs = measure::knownCosts(arguments.settings.calibration, false);
    if (!costs) {
        console.report(costs.error());
        return kExitFailed;
    }
    const gltf::SceneList scenes({&*scene, 1});
    const Result<std::vector<int>> materials = chooseMaterials(scenes, arguments.material);
    if (!materials) {
        console.report(materials.error());
        return kExitFailed;
    }
    Result<measure::PlanChoice> choice = measure::choosePlan(arguments.settings, scenes);
    if (!choice) {
        console.report(choice.error());
        return kExitFailed;
    }
    console.report(choice->warnings);
    console.report(choice->notes);
    const Result<LockChoice> lock = applyLock(arguments.lock, scenes, choice->options);
    if (!lock) {
        console.report(lock.error());
        return kExitFailed;
    }
    console.report(lock->warnings);
    console.report(lock->notes);
    Planned planned{scenes, std::move(choice->options), {}};
    planned.plan =
        lock->plan ? *lock->plan : makePlan(scenes.materials(), scenes.primitives(), planned.options);
    if (const std::optional<std::string> excess = describeExcess(planned.plan, planned.options)) {
        console.report(makeWarning("max-shaders", scene->path, *excess));
    }

    const Detail detail = console.isVerbose() ? Detail::Whole : Detail::Short;
    const PlannedScenes whole{scenes, planned.options, planned.plan};
    if (arguments.wholePlan && !console.isJson()) {
        console.print(planText(whole, detail));
        return kExitDone;
    }
    const compiler::EffectPlan effects = automaticEffects(scenes);
    const Result<compiler::StrategyAdvice> advice =
        advise(*costs, planned, effects, arguments.settings.compile.maxBounces);
    if (!advice) {
        console.report(advice.error());
        return kExitFailed;
    }
    if (console.isJson()) {
        base::Json result{{"scene", arguments.scene},
                          {"merge", nameOf(planned.options.merge)},
                          {"alpha", nameOf(planned.options.keys.alpha)},
                          {"hitLobes", featuresToJson(*planned.plan.model, planned.options.keys.keptLobes)},
                          {"variant", base::textOrNull(scene->variant)},
                          {"variants", scene->variants}};
        if (arguments.wholePlan) {
            result["plan"] = planToJson(whole);
        } else {
            result["effects"] = effectsToJson(effects);
            result["strategies"] = strategyChoiceToJson(*advice);
            result["motion"] = motionToJson(*scene);
            result["materials"] = base::Json::array();
            for (const int material : *materials) {
                result["materials"].push_back(toJson(planned, material));
            }
        }
        console.result(result);
        return kExitDone;
    }
    console.print(variantsText(*scene));
    if (arguments.material.empty()) {
        console.print(effectsText(effects));
        console.print(strategiesText(*advice));
        console.print(motionText(*scene));
    }
    for (const int material : *materials) {
        console.print(toText(planned, material, detail));
    }
    if (materials->empty()) {
        console.print("no materials\n");
    }
    return kExitDone;
}

}  // namespace

void addExplain(CLI::App& app, Action& chosen) {
    auto arguments = std::make_shared<ExplainArguments>();
    CLI::App& command =
        addCommand(app, "explain", "Show which key and which shader each material gets, and what was dropped",
                   "glint explain scene.gltf --material Leaves --alpha tested");
    addText(command, "SCENE", arguments->scene, "FILE", "the scene, .gltf or .glb").required();
    CLI::Option& material = addText(command, "--material", arguments->material, "NAME|INDEX",
                                    "show only this material; numbers count from 0 (default:\n"
                                    "all)");
    addFlag(command, "--plan", arguments->wholePlan,
            "show the shaders instead of the materials: what each\n"
            "costs by the cost model of --merge auto, which keys share\n"
            "it, and why")
        .excludes(&material);
    addReadingOptions(command, arguments->settings);
    addCalibration(command, arguments->settings);
    addSettings(command, compiler::kOfExplain, arguments->settings);
    addProfileInput(command, arguments->settings);
    addLockInput(command, arguments->lock);
    command.callback([arguments, &command, &chosen] {
        settleSettings(command, arguments->settings);
        checkProfile(command, arguments->settings);
        chosen = [arguments](const Console& console) { return explain(console, *arguments); };
    });
}

}  // namespace glint::cli
