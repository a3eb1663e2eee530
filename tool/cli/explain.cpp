// glint explain: shows which key and which case each material gets, and why.
#include "base/text.h"
#include "cli/cache.h"
#include "cli/command_line.h"
#include "cli/options/options.h"
#include "cli/options/setting_options.h"
#include "cli/report.h"
#include "emit/package/manifest.h"
#include "gltf/import.h"
#include "plan/gpu_costs.h"
#include "scene/deformed.h"

#include <glint/measure/target.h>
#include <glint/session/session.h>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <memory>
#include <set>
#include <utility>

namespace glint::cli {

namespace {

// --- What moves in a scene ---

// The properties that animations move, in the order of the JSON. One weight counts with all weights.
constexpr Named<gltf::AnimationPath> kPaths[] = {{gltf::AnimationPath::Translation, "translation"},
                                                 {gltf::AnimationPath::Rotation, "rotation"},
                                                 {gltf::AnimationPath::Scale, "scale"},
                                                 {gltf::AnimationPath::Weights, "weights"},
                                                 {gltf::AnimationPath::Visible, "visible"},
                                                 {gltf::AnimationPath::Material, "material"},
                                                 {gltf::AnimationPath::Light, "light"},
                                                 {gltf::AnimationPath::Camera, "camera"}};

std::string nameOfPath(gltf::AnimationPath path) {
    return std::string(std::ranges::find(kPaths, path, &Named<gltf::AnimationPath>::value)->name);
}

// Counts channels by the property that they move.
std::map<gltf::AnimationPath, std::size_t> channelsOf(const gltf::Animation& animation) {
    std::map<gltf::AnimationPath, std::size_t> counts;
    for (const gltf::AnimationChannel& channel : animation.channels) {
        ++counts[channel.path == gltf::AnimationPath::Weight ? gltf::AnimationPath::Weights : channel.path];
    }
    return counts;
}

std::size_t nodesOf(const gltf::Animation& animation) {
    std::set<int> nodes;
    for (const gltf::AnimationChannel& channel : animation.channels) {
        if (drivesNode(channel.path)) {
            nodes.insert(channel.target);
        }
    }
    return nodes.size();
}

// A mesh, and a node that draws it.
struct Deformed {
    const gltf::Node* node = nullptr;
    std::size_t joints = 0;      // joints of its skin; 0 if it follows none
    std::size_t influences = 0;  // the most joints that a vertex follows
    std::size_t targets = 0;
    std::size_t vertices = 0;
};

std::vector<Deformed> deformedOf(const gltf::Scene& scene) {
    std::vector<Deformed> all;
    for (const gltf::Node& node : scene.nodes) {
        if (!compiler::isDeformed(scene, node)) {
            continue;
        }
        Deformed deformed{&node};
        for (const gltf::Primitive& primitive :
             scene.meshes[static_cast<std::size_t>(node.mesh)].primitives) {
            deformed.vertices += primitive.positions.size();
            deformed.targets = std::max(deformed.targets, primitive.targets.size());
            deformed.influences = std::max(deformed.influences, primitive.influences.count);
        }
        if (node.skin >= 0 && deformed.influences > 0) {
            deformed.joints = scene.skins[static_cast<std::size_t>(node.skin)].joints.size();
        } else {
            deformed.influences = 0;
        }
        all.push_back(deformed);
    }
    return all;
}

std::string meshName(const gltf::Scene& scene, int mesh) {
    const std::string& name = scene.meshes[static_cast<std::size_t>(mesh)].name;
    return name.empty() ? fmt::format("mesh {}", mesh) : name;
}

// Describes animations, and the meshes that follow joints or morph targets.
base::Json motionToJson(const gltf::Scene& scene) {
    base::Json animations = base::Json::array();
    for (const gltf::Animation& animation : scene.animations) {
        base::Json channels = base::Json::object();
        for (const Named<gltf::AnimationPath>& path : kPaths) {
            channels[std::string(path.name)] = 0;
        }
        for (const auto& [path, count] : channelsOf(animation)) {
            channels[nameOfPath(path)] = count;
        }
        animations.push_back({{"index", animations.size()},
                              {"name", animation.name},
                              {"duration", animation.duration},
                              {"nodes", nodesOf(animation)},
                              {"channels", channels}});
    }
    const auto meshToJson = [&](const Deformed& deformed) -> base::Json {
        return {{"node", deformed.node->source},
                {"mesh", deformed.node->mesh},
                {"name", scene.meshes[static_cast<std::size_t>(deformed.node->mesh)].name},
                {"vertices", deformed.vertices},
                {"joints", deformed.joints},
                {"influences", deformed.influences},
                {"morphTargets", deformed.targets}};
    };
    return {{"animations", animations}, {"deformedMeshes", listOf(deformedOf(scene), meshToJson)}};
}

// Returns an empty text if nothing moves.
std::string motionText(const gltf::Scene& scene) {
    Rows rows;
    for (std::size_t i = 0; i < scene.animations.size(); ++i) {
        const gltf::Animation& animation = scene.animations[i];
        std::string channels;
        for (const auto& [path, count] : channelsOf(animation)) {
            channels += fmt::format("{}{} of {}", channels.empty() ? "" : ", ", count, nameOfPath(path));
        }
        rows.push_back({fmt::format("animation {}", i),
                        fmt::format("{}{:.3f} s, {} nodes, channels: {}",
                                    animation.name.empty() ? "" : animation.name + ", ", animation.duration,
                                    nodesOf(animation), channels.empty() ? "none" : channels)});
    }
    for (const Deformed& deformed : deformedOf(scene)) {
        std::string follows;
        if (deformed.joints > 0) {
            follows = fmt::format("{} joints, up to {} a vertex", deformed.joints, deformed.influences);
        }
        if (deformed.targets > 0) {
            follows += fmt::format("{}{} morph targets", follows.empty() ? "" : "; ", deformed.targets);
        }
        rows.push_back(
            {"deformed", fmt::format("{} (/nodes/{}), {} vertices: {}", meshName(scene, deformed.node->mesh),
                                     deformed.node->source, deformed.vertices, follows)});
    }
    return formatFields(rows);
}

// --- The command ---

struct ExplainArguments {
    std::string scene;
    std::string material;
    bool wholePlan = false;
    compiler::Settings settings;
};

std::string toText(const compiler::Build& build, int material, Detail detail) {
    const std::string text = fmt::format("material {}: {}\n", material, build.scenes->materialName(material));
    const Rows rows = materialRows(build, material, detail);
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

// Returns an empty text if the scene has no variants.
std::string variantsText(const gltf::Scene& scene) {
    if (scene.variants.empty()) {
        return {};
    }
    return formatFields({{"variants", base::join(scene.variants)},
                         {"materials of", scene.variant.empty() ? "no variant (--variant)" : scene.variant}});
}

// Returns for each image with the texels of another one that image's pointer and the other's.
std::vector<std::pair<std::string, std::string>> sameImagesOf(const gltf::Scene& scene) {
    std::vector<std::pair<std::string, std::string>> same;
    for (const gltf::Image& image : scene.images) {
        if (image.sameAs >= 0) {
            same.emplace_back(image.pointer, scene.images[static_cast<std::size_t>(image.sameAs)].pointer);
        }
    }
    return same;
}

std::string sameImagesText(const gltf::Scene& scene) {
    Rows rows;
    for (const auto& [image, other] : sameImagesOf(scene)) {
        rows.push_back({"same texels", fmt::format("{} as {}, which takes its place", image, other)});
    }
    return formatFields(rows);
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
    Rows rows{{"effect", "auto", "why"}};
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
    const auto strategyToJson = [](const compiler::StrategyFactor& factor) -> base::Json {
        return {{"strategy", factor.strategy},
                {"factor", factor.factor},
                {"occupancy", factor.module->occupancy},
                {"spills", factor.module->spills},
                {"scratchBytes", factor.module->scratchBytes}};
    };
    const auto choiceToJson = [](const compiler::GpuChoice& choice) -> base::Json {
        return {{"setting", choice.setting},
                {"value", choice.value},
                {"known", choice.known},
                {"why", choice.why}};
    };
    return {{"name", costs.gpu->name},
            {"device", costs.gpu->device},
            {"driver", costs.gpu->driver},
            {"branchFactor", base::orNull(branchFactor(*costs.gpu))},
            {"strategies", listOf(strategyFactors(*costs.gpu), strategyToJson)},
            {"choices", listOf(chooseSettings(&*costs.gpu, acceptedError), choiceToJson)}};
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
                      {"scenesInFile", listOf(scene.scenesInFile, base::textOrNull)},
                      {"merge", nameOf(options.merge)},
                      {"alpha", nameOf(options.keys.alpha)},
                      {"hitLobes", build.plan.model->names(options.keys.keptLobes & build.plan.model->lobes)},
                      {"variant", base::textOrNull(scene.variant)},
                      {"variants", scene.variants}};
    if (arguments.wholePlan) {
        result["plan"] = planToJson(build);
        return result;
    }
    result["sameImages"] = listOf(sameImagesOf(scene), [](const auto& same) -> base::Json {
        return {{"image", same.first}, {"as", same.second}};
    });
    result["effects"] = base::jsonOf(build.plan.effects.decisions);
    result["strategies"] = base::jsonOf(*build.settings.compile.strategyChoice);
    result["gpu"] = gpuToJson(costs, build.asked.precisionError);
    result["motion"] = motionToJson(scene);
    result["materials"] = listOf(materials, [&](int material) { return materialToJson(build, material); });
    return result;
}

std::string toText(const ExplainArguments& arguments, const compiler::Build& build,
                   const compiler::KnownCosts& costs, const std::vector<int>& materials, Detail detail) {
    if (arguments.wholePlan) {
        return planText(build, detail);
    }
    const gltf::Scene& scene = build.scenes->scenes().front();
    std::string text = scenesText(scene) + variantsText(scene);
    if (arguments.material.empty()) {
        text += effectsText(build.plan.effects) + strategiesText(*build.settings.compile.strategyChoice) +
                gpuText(costs, build.asked.precisionError) + motionText(scene) + sameImagesText(scene);
    }
    for (const int material : materials) {
        text += toText(build, material, detail);
    }
    return materials.empty() ? text + "no materials\n" : text;
}

Result<int> explain(const Console& console, const ExplainArguments& arguments) {
    CompileCache known(CacheArguments{}, "");
    GLINT_TRY(const auto import,
              session::importOptions(arguments.settings, session::ImageReading::None, known.store()));
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
    answer(
        console, [&] { return toJson(arguments, build, target.costs, materials); },
        [&](Detail detail) { return toText(arguments, build, target.costs, materials, detail); });
    return kExitDone;
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
    addText(command, "SCENE", arguments->scene, "FILE", "the scene, .gltf or .glb, or a list of materials")
        .required();
    CLI::Option& material = addText(command, "--material", arguments->material, "NAME|INDEX",
                                    "show only this material; numbers count from 0 (default: all)");
    addFlag(command, "--plan", arguments->wholePlan,
            "show the shaders instead of the materials: what each costs by the cost model of --merge auto, "
            "which keys share it, and why")
        .excludes(&material);
    addReadingOptions(command, arguments->settings);
    addCalibration(command, arguments->settings);
    addSettings(command, compiler::kOfExplain, arguments->settings);
    addProfileInput(command, arguments->settings);
    addLockOptions(command, arguments->settings.lock, false);
    command.callback([arguments, &command, &chosen] {
        checkSettings(command, arguments->settings);
        checkProfile(command, arguments->settings);
        chosen = [arguments](const Console& console) { return explain(console, *arguments); };
    });
}

}  // namespace glint::cli
