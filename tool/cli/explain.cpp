// glint explain: shows which key and which case each material gets, and why.
#include "base/suggest.h"
#include "cli/command_line.h"
#include "cli/commands.h"
#include "cli/compile/cache.h"
#include "cli/explain/material_text.h"
#include "cli/explain/motion_text.h"
#include "cli/explain/plan_text.h"
#include "cli/options/setting_options.h"
#include "cli/report.h"
#include "cli/table.h"
#include "emit/package/json.h"
#include "gltf/import.h"
#include "plan/gpu_costs.h"

#include <glint/measure/target.h>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <memory>
#include <optional>
#include <span>

namespace glint::cli {

namespace {

struct ExplainArguments {
    std::string scene;
    std::string material;
    bool wholePlan = false;
    compiler::Settings settings;
};

std::string toText(const compiler::Build& build, int material, Detail detail) {
    const std::string text = fmt::format("material {}: {}\n", material, build.scenes->materialName(material));
    const std::vector<std::vector<std::string>> rows = materialRows(build, material, detail);
    return text + (rows.empty() ? "  no primitive uses it: no key, no shader\n" : formatFields(rows, detail));
}

// Returns an empty text unless the file has several scenes.
std::string scenesText(const gltf::Scene& scene) {
    if (scene.scenesInFile.size() < 2) {
        return {};
    }
    std::vector<std::string> labels;
    for (std::size_t i = 0; i < scene.scenesInFile.size(); ++i) {
        labels.push_back(sceneLabel(scene, i));
    }
    return formatFields({{"scenes of the file", base::join(labels)},
                         {"this one", labels[static_cast<std::size_t>(scene.sceneInFile)] + " (--scene)"}});
}

base::Json scenesInFileToJson(const gltf::Scene& scene) {
    base::Json names = base::Json::array();
    for (const std::string& name : scene.scenesInFile) {
        names.push_back(base::textOrNull(name));
    }
    return names;
}

// Returns an empty text if the scene has no variants.
std::string variantsText(const gltf::Scene& scene) {
    if (scene.variants.empty()) {
        return {};
    }
    return formatFields({{"variants", base::join(scene.variants)},
                         {"materials of", scene.variant.empty() ? "no variant (--variant)" : scene.variant}});
}

base::Json sameImagesToJson(const gltf::Scene& scene) {
    base::Json list = base::Json::array();
    for (const gltf::Image& image : scene.images) {
        if (image.sameAs >= 0) {
            const gltf::Image& other = scene.images[static_cast<std::size_t>(image.sameAs)];
            list.push_back(base::Json{{"image", image.pointer}, {"as", other.pointer}});
        }
    }
    return list;
}

// Returns an empty text if no image has the texels of another one.
std::string sameImagesText(const gltf::Scene& scene) {
    std::vector<std::vector<std::string>> rows;
    for (const gltf::Image& image : scene.images) {
        if (image.sameAs >= 0) {
            rows.push_back(
                {"same texels", fmt::format("{} as {}, which takes its place", image.pointer,
                                            scene.images[static_cast<std::size_t>(image.sameAs)].pointer)});
        }
    }
    return rows.empty() ? std::string() : formatFields(rows);
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

// Returns a line for each effect: whether it is chosen, and why.
std::string effectsText(const compiler::EffectPlan& plan) {
    std::vector<std::vector<std::string>> rows{{"effect", "auto", "why"}};
    for (const compiler::EffectDecision& decision : plan.decisions) {
        rows.push_back({decision.name, decision.chosen ? "yes" : "no", decision.reason});
    }
    return formatTable(rows);
}

// Returns what the table of --gpu says; null without one.
base::Json gpuToJson(const compiler::KnownCosts& costs, double acceptedError) {
    if (!costs.gpu) {
        return nullptr;
    }
    base::Json strategies = base::Json::array();
    for (const compiler::StrategyFactor& factor : strategyFactors(*costs.gpu)) {
        strategies.push_back({{"strategy", factor.strategy},
                              {"factor", factor.factor},
                              {"occupancy", factor.module->occupancy},
                              {"spills", factor.module->spills},
                              {"scratchBytes", factor.module->scratchBytes}});
    }
    base::Json choices = base::Json::array();
    for (const compiler::GpuChoice& choice : chooseSettings(&*costs.gpu, acceptedError)) {
        choices.push_back({{"setting", choice.setting},
                           {"value", choice.value},
                           {"known", choice.known},
                           {"why", choice.why}});
    }
    return {{"name", costs.gpu->name},
            {"device", costs.gpu->device},
            {"driver", costs.gpu->driver},
            {"branchFactor", base::orNull(branchFactor(*costs.gpu))},
            {"strategies", std::move(strategies)},
            {"choices", std::move(choices)}};
}

std::string gpuText(const compiler::KnownCosts& costs, double acceptedError) {
    if (!costs.gpu) {
        return {};
    }
    const compiler::GpuCosts& gpu = *costs.gpu;
    std::string text = fmt::format("{} ({}): {}", gpu.name, gpu.device, describe(gpu));
    for (const compiler::GpuChoice& choice : chooseSettings(&gpu, acceptedError)) {
        text += fmt::format("\n--{} auto is {}: {}", choice.setting, choice.value, choice.why);
    }
    return wrapped(text) + "\n\n";
}

base::Json toJson(const ExplainArguments& arguments, const compiler::Build& build,
                  const compiler::KnownCosts& costs, const std::vector<int>& materials) {
    const gltf::Scene& scene = build.scenes->scenes().front();
    const compiler::PlanOptions& options = build.settings.compile.plan;
    base::Json result{{"scene", arguments.scene},
                      {"sceneInFile", base::jsonOf(compiler::orNone(gltf::sceneInFile(scene)))},
                      {"scenesInFile", scenesInFileToJson(scene)},
                      {"merge", nameOf(options.merge)},
                      {"alpha", nameOf(options.keys.alpha)},
                      {"hitLobes", featuresToJson(*build.plan.model, options.keys.keptLobes)},
                      {"variant", base::textOrNull(scene.variant)},
                      {"variants", scene.variants}};
    if (arguments.wholePlan) {
        result["plan"] = planToJson(build);
        return result;
    }
    result["sameImages"] = sameImagesToJson(scene);
    result["effects"] = base::jsonOf(build.plan.effects.decisions);
    result["strategies"] = base::jsonOf(*build.settings.compile.strategyChoice);
    result["gpu"] = gpuToJson(costs, build.asked.precisionError);
    result["motion"] = motionToJson(scene);
    result["materials"] = base::Json::array();
    for (const int material : materials) {
        result["materials"].push_back(materialToJson(build, material));
    }
    return result;
}

void print(const Console& console, const ExplainArguments& arguments, const compiler::Build& build,
           const compiler::KnownCosts& costs, const std::vector<int>& materials) {
    const Detail detail = console.isVerbose() ? Detail::Whole : Detail::Short;
    if (arguments.wholePlan) {
        console.print(planText(build, detail));
        return;
    }
    const gltf::Scene& scene = build.scenes->scenes().front();
    console.print(scenesText(scene));
    console.print(variantsText(scene));
    if (arguments.material.empty()) {
        console.print(effectsText(build.plan.effects));
        console.print(strategiesText(*build.settings.compile.strategyChoice));
        console.print(gpuText(costs, build.asked.precisionError));
        console.print(motionText(scene));
        console.print(sameImagesText(scene));
    }
    for (const int material : materials) {
        console.print(toText(build, material, detail));
    }
    if (materials.empty()) {
        console.print("no materials\n");
    }
}

Status explain(const Console& console, const ExplainArguments& arguments) {
    CompileCache known(CacheArguments{}, "");
    GLINT_TRY(const auto import, importOptions(arguments.settings, ImageReading::None, known.store()));
    GLINT_TRY(const auto scene, importScene(arguments.scene, import));
    console.report(scene.warnings);
    compiler::Settings asked = arguments.settings;
    asked.advisesStrategy = true;
    GLINT_TRY(const auto target, measure::targetOf(asked));
    const auto scenes = std::make_shared<const gltf::SceneList>(std::span(&scene, 1));
    GLINT_TRY(const auto materials, chooseMaterials(*scenes, arguments.material));
    GLINT_TRY(const auto build, compiler::resolve(scenes, asked, target));
    console.report(build.messages);
    console.report(idleSettings(build));
    if (build.excess) {
        console.report(makeWarning("max-shaders", scene.path, *build.excess));
    }
    if (console.isJson()) {
        console.result(toJson(arguments, build, target.costs, materials));
    } else {
        print(console, arguments, build, target.costs, materials);
    }
    return okStatus();
}

}  // namespace

void addExplain(CLI::App& app, Action& chosen) {
    auto arguments = std::make_shared<ExplainArguments>();
    CLI::App& command =
        addCommand(app, {.name = "explain",
                         .what = "Show which key and which shader each material gets, and what was dropped",
                         .examples = {"glint explain scene.gltf",
                                      "glint explain scene.gltf --material Leaves --alpha tested"},
                         .usual = {"--material", "--plan", "--merge", "--alpha", "--hit-lobes", "--bounces",
                                   "--variant", "--verbose", "--json"}});
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
    addLockOptions(command, arguments->settings.lock, false);
    command.callback([arguments, &command, &chosen] {
        checkSettings(command, arguments->settings);
        checkProfile(command, arguments->settings);
        chosen = [arguments](const Console& console) {
            const Status explained = explain(console, *arguments);
            return explained ? kExitDone : fail(console, explained.error());
        };
    });
}

}  // namespace glint::cli
