#include "emit/context.h"
#include "emit/material_layout.h"
#include "resolve/light.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <interop/frame.h>
#include <iterator>
#include <set>
#include <tuple>
#include <vector>

namespace glint::compiler {

namespace mustache = kainjow::mustache;

using package::LayerInfo;

namespace {

// "geometric-normal" gives geometricNormal, "reflection.radiance" reflectionRadiance.
std::string variableNamed(std::string_view layer) {
    std::string variable;
    bool raises = false;
    for (const char character : layer) {
        const bool isLetter = std::isalnum(static_cast<unsigned char>(character)) != 0;
        if (isLetter) {
            variable +=
                raises ? static_cast<char>(std::toupper(static_cast<unsigned char>(character))) : character;
        }
        raises = !isLetter;
    }
    return variable;
}

// The fields of one layer.
mustache::data fieldsOf(const LayerInfo::Entry& entry, const Plan& plan) {
    const LayerInfo& info = infoOf(entry);
    const package::LayerInfo::FormatInfo& format = package::infoOf(info.format);
    const auto place = std::ranges::find(plan.layers, entry) - plan.layers.begin();
    const std::string variable = variableNamed(layerNameOf(entry, *plan.model));
    return mustache::object{
        {"binding", fmt::format("kBindingLayers + {}u", place)},
        {"qualifier", std::string(format.qualifier)},
        {"image", info.format == package::LayerInfo::Format::Integer ? "uimage2D" : "image2D"},
        {"value", variable},
        {"variable", variable + "Layer"},
        {"function", std::string(info.function)},
        {"absent", std::string(info.absent)},
        {"isMean", info.mean == package::LayerInfo::Mean::Mean}};
}

const LayerInfo::Entry* findEntry(const Plan& plan, std::string_view layer, package::Effect effect,
                                  std::uint32_t bounce = 0) {
    const LayerInfo::Entry entry{package::findLayer(layer)->number, effect, bounce};
    const auto found = std::ranges::find(plan.layers, entry);
    return found == plan.layers.end() ? nullptr : &*found;
}

std::string variableOf(const LayerInfo::Entry& entry, const Plan& plan) {
    return fieldsOf(entry, plan).get("variable")->string_value();
}

std::string albedoVariable(const Plan& plan, package::Effect effect) {
    return variableOf({albedoOf(effect, *plan.model).number, 0, 0}, plan);
}

// The fields of the layers of light: of a source, or of one bounce of its paths; false if it has none.
mustache::data lightFields(const Plan& plan, package::Effect effect, std::uint32_t bounce = 0) {
    const std::string prefix = bounce == 0 ? "" : "bounce-";
    const LayerInfo::Entry* const radiance = findEntry(plan, prefix + "radiance", effect, bounce);
    if (radiance == nullptr) {
        return false;
    }
    mustache::data fields;
    fields.set("radiance", variableOf(*radiance, plan));
    for (const char* const name : {"demodulated", "variance"}) {
        const LayerInfo::Entry* const entry = findEntry(plan, prefix + name, effect, bounce);
        fields.set(name,
                   entry == nullptr
                       ? mustache::data(false)
                       : mustache::data(mustache::object{
                             {"variable", variableOf(*entry, plan)},
                             {"albedo", demodulates(infoOf(*entry)) ? albedoVariable(plan, effect) : ""}}));
    }
    return fields;
}

// The fields of a layer alone; false if the package lacks it.
mustache::data imageFields(const Plan& plan, std::string_view layer, package::Effect effect,
                           std::uint32_t bounce = 0) {
    const LayerInfo::Entry* const found = findEntry(plan, layer, effect, bounce);
    if (found == nullptr) {
        return false;
    }
    return mustache::object{{"variable", variableOf(*found, plan)},
                            {"shows", declarationOf(*plan.model, effect).shows}};
}

// The macro GLINT_SLOTS_READ(features): a bit for each texture of a record that a surface with these features
// reads.
std::string slotsRead(const Plan& plan) {
    const MaterialLayout layout = materialLayoutOf(plan);
    std::vector<std::string> bits;
    for (const TextureSlot& slot : layout.textures) {
        const materials::MaterialTexture& texture =
            plan.model->textures[static_cast<std::size_t>(slot.texture)];
        const materials::Feature& feature = plan.model->features[static_cast<std::size_t>(texture.feature)];
        bits.push_back(fmt::format("(GLINT_HAS_{}(features) ? {}u : 0u)", feature.macroEnd(),
                                   std::uint64_t{1} << static_cast<unsigned>(slot.slot)));
    }
    return fmt::format("#define GLINT_SLOTS_READ(features) ({})\n",
                       bits.empty() ? "0u" : fmt::format("{}", fmt::join(bits, " | ")));
}

}  // namespace

std::string layerDefines(const Plan& plan, bool deforms, bool findsSizedLights) {
    std::uint32_t demands = 0;
    bool ofSurfaces = false;
    bool ofEffects = false;
    std::uint32_t bounces = 0;
    bool walks = false;
    bool groups = false;
    std::set<std::string_view> tallies;
    for (const LayerInfo::Entry& entry : plan.layers) {
        const LayerInfo& info = infoOf(entry);
        demands |= info.demands;
        ofSurfaces = ofSurfaces || passOf(entry) == package::LayerInfo::Pass::FirstHits;
        ofEffects = ofEffects || passOf(entry) == package::LayerInfo::Pass::Compose;
        groups = groups || (!info.tally.empty() && package::hasSources(info));
        tallies.insert(info.tally);
        bounces = std::max(bounces, entry.bounce);
        walks = walks || package::showsWalkedLight(entry, plan.effects.effects.walks);
    }
    tallies.erase("");
    const bool history = (demands & package::LayerInfo::kHistory) != 0;
    const auto flag = [](bool value) { return value ? 1 : 0; };
    std::string text = fmt::format(
        "// Layers beside the picture\n"
        "#define GLINT_LAYER_MEMBERS {}\n"
        "#define GLINT_SURFACE_LAYERS {}\n"
        "#define GLINT_EFFECT_LAYERS {}\n"
        "#define GLINT_LAYER_HISTORY {}\n"
        "#define GLINT_LAYER_DEFORMS {}\n"
        "#define GLINT_LAYER_RAYS {}\n"
        "#define GLINT_LAYER_BOUNCES {}\n"
        "#define GLINT_LAYER_WALKS {}\n"
        "#define GLINT_LAYER_CLOCK {}\n"
        "#define GLINT_LAYER_BRANCHES {}\n"
        "#define GLINT_LAYER_GROUPS {}\n"
        "#define GLINT_LAYER_TEXTURE_LEVEL {}\n"
        "#define GLINT_TALLIES {}\n",
        flag(!plan.layers.empty()), flag(ofSurfaces), flag(ofEffects), flag(history),
        flag(history && deforms), flag((demands & package::LayerInfo::kRays) != 0), bounces,
        flag(walks && findsSizedLights), flag((demands & package::LayerInfo::kClock) != 0),
        flag(findEntry(plan, "branches", 0) != nullptr), flag(groups),
        flag(findEntry(plan, "texture-level", 0) != nullptr), flag(!tallies.empty()));
    if (findEntry(plan, "texture-level", 0) != nullptr) {
        text += slotsRead(plan);
    }
    // Tallies that no layer shows leave no code.
    for (const LayerInfo& info : package::layerTable()) {
        if (!info.tally.empty() && !tallies.contains(info.tally)) {
            text += fmt::format("#define {}({})\n", info.tally,
                                package::hasSources(info) ? "target, value" : "amount");
        }
    }
    if ((demands & package::LayerInfo::kClock) == 0) {
        text += "#define GLINT_CLOCK_START\n#define GLINT_CLOCK_STOP\n";
    }
    return text;
}

namespace {

// The fields of tallies.glsl.mustache.
void addTallies(mustache::data& context, const Plan& plan) {
    mustache::data tallies(mustache::data::type::list);
    mustache::data added(mustache::data::type::list);
    std::vector<std::pair<const LayerInfo*, mustache::data>> images;  // of each kind that samples have
    for (const LayerInfo::Entry& entry : plan.layers) {
        const LayerInfo& info = infoOf(entry);
        if (info.tally.empty()) {
            continue;
        }
        mustache::data fields = fieldsOf(entry, plan);
        fields.set("macro", std::string(info.tally));
        fields.set("slot", fmt::format("{}", package::effectSlot(plan.effects.effects, entry.effect)));
        tallies.push_back(fields);
        if (!package::hasSources(info)) {
            added.push_back(fields);
            continue;
        }
        auto found = std::ranges::find(images, &info, [](const auto& pair) { return pair.first; });
        if (found == images.end()) {
            images.emplace_back(&info, mustache::data(mustache::data::type::list));
            found = images.end() - 1;
        }
        found->second.push_back(fields);
    }
    mustache::data kept(mustache::data::type::list);
    for (const auto& [info, ofSources] : images) {
        std::string name = variableNamed(info->name);
        name.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(name.front())));
        kept.push_back(
            mustache::object{{"macro", std::string(info->tally)}, {"name", name}, {"images", ofSources}});
    }
    context.set("tallies", tallies);
    context.set("added", added);
    context.set("kept", kept);
    context.set("hasClock", mustache::data(findEntry(plan, "clocks", 0) != nullptr));
}

}  // namespace

void addLayers(mustache::data& context, const Plan& plan) {
    mustache::data ofFirstHits(mustache::data::type::list);
    mustache::data surface(mustache::data::type::list);
    for (const LayerInfo::Entry& entry : plan.layers) {
        if (passOf(entry) != package::LayerInfo::Pass::FirstHits) {
            continue;
        }
        const LayerInfo& info = infoOf(entry);
        mustache::data fields = fieldsOf(entry, plan);
        fields.set("access", info.continues ? "" : "writeonly ");
        ofFirstHits.push_back(fields);
        if (info.subject == LayerInfo::Subject::Surface) {
            surface.push_back(fields);
        }
    }
    context.set("firstLayers", ofFirstHits);
    context.set("surfaceLayers", surface);
    context.set("directLight", lightFields(plan, 0));

    // Those that compose writes, and the albedos that it reads.
    mustache::data effects(mustache::data::type::list);
    std::set<std::string> read;
    for (const LayerInfo::Entry& entry : plan.layers) {
        if (passOf(entry) != package::LayerInfo::Pass::Compose) {
            continue;
        }
        const LayerInfo& info = infoOf(entry);
        mustache::data fields = fieldsOf(entry, plan);
        fields.set("access", info.continues ? "" : "writeonly ");
        effects.push_back(fields);
        if (demodulates(info) && read.insert(albedoVariable(plan, entry.effect)).second) {
            mustache::data albedo = fieldsOf({albedoOf(entry.effect, *plan.model).number, 0, 0}, plan);
            albedo.set("access", "readonly ");
            effects.push_back(albedo);
        }
    }
    addTallies(context, plan);
    context.set("hasRayLayers",
                mustache::data(std::ranges::any_of(plan.layers, [](const LayerInfo::Entry& entry) {
                    return infoOf(entry).subject == LayerInfo::Subject::Ray &&
                           passOf(entry) == package::LayerInfo::Pass::Compose;
                })));
    context.set("hasEffectLayers", mustache::data(effects.is_non_empty_list()));
    context.set("effectLayers", effects);
}

void addLayersOf(mustache::data& entry, const Plan& plan, package::Effect effect) {
    const mustache::data light = lightFields(plan, effect);
    entry.set("lightLayers", light);
    const mustache::data distance = imageFields(plan, "distance", effect);
    const mustache::data motion = imageFields(plan, "virtual-motion", effect);
    const mustache::data shader = imageFields(plan, "hit-shader", effect);
    mustache::data rays(!distance.is_false() || !motion.is_false() || !shader.is_false());
    if (rays.is_true()) {
        rays = mustache::object{{"distance", distance}, {"motion", motion}, {"shader", shader}};
    }
    entry.set("rayLayers", rays);

    mustache::data bounces(mustache::data::type::list);
    for (std::uint32_t bounce = 1; bounce <= package::kMostLayerBounces; ++bounce) {
        const mustache::data ofBounce = lightFields(plan, effect, bounce);
        const mustache::data length = imageFields(plan, "bounce-distance", effect, bounce);
        if (!ofBounce.is_false() || !length.is_false()) {
            bounces.push_back(mustache::object{{"bounce", std::to_string(bounce)},
                                               {"slice", std::to_string(bounce - 1)},
                                               {"isFirst", bounce == 1},
                                               {"light", ofBounce},
                                               {"distance", length}});
        }
    }
    entry.set("bounceLayers", bounces);
    entry.set("storesLight", mustache::data(!light.is_false() || bounces.is_non_empty_list()));
}

namespace {

// Each effect has pairs of dimensions of the sequence (hit/sequence.glsl) of its own. Those below belong to
// Glint's shaders.
constexpr std::size_t kFirstPair = 1024;
constexpr std::size_t kPairsOfEffect = 4;

}  // namespace

std::string effectDefines(const materials::MaterialModel& model, const package::EffectSet& effects) {
    std::string text;
    std::string bits;
    for (std::size_t i = 0; i < model.effects.size(); ++i) {
        const materials::EffectDeclaration& effect = model.effects[i];
        const package::Effect bit = infoOf(effect, i).effect;
        text += fmt::format("#define GLINT_EFFECT_{} {}\n", effect.macro(), (effects.all & bit) != 0 ? 1 : 0);
        if ((effects.rays & bit) != 0) {
            text +=
                fmt::format("#define GLINT_SLOT_{} {}u\n", effect.macro(), package::effectSlot(effects, bit));
        }
        if ((effects.all & bit) != 0) {
            text +=
                fmt::format("#define GLINT_PAIRS_{} {}u\n", effect.macro(), kFirstPair + kPairsOfEffect * i);
        }
        bits += fmt::format("const uint kEffect{} = {}u;\n", effect.function(), bit);
    }
    text += fmt::format("#define GLINT_EFFECT_COUNT {}u\n", package::countedEffects(effects));
    text += fmt::format("#define GLINT_RAY_EFFECTS {}\n", package::effectSlots(effects));
    text += fmt::format("#define GLINT_STARTS_ON_SCREEN {}\n", effects.screenStarts != 0 ? 1 : 0);
    return text + bits;
}

void addEffect(mustache::data& context, const materials::MaterialModel& model,
               const package::EffectSet& effects, std::size_t number) {
    const materials::EffectDeclaration& effect = model.effects[number];
    const auto file = [](const std::string& name) {
        return name.empty() ? mustache::data(false) : mustache::data(name);
    };
    context.set("name", effect.name);
    context.set("function", effect.function());
    context.set("bit", fmt::format("kEffect{}", effect.function()));
    context.set("main", effect.main());
    context.set("sharesLights", mustache::data(effect.sharesLights));
    context.set("walk", mustache::data((effects.walks & infoOf(effect, number).effect) != 0));
    context.set("compose", file(effect.compose));
    context.set("hit", file(effect.hit));
    context.set("start", effect.start.empty() ? "effects/plain_start.glsl" : effect.start);
    context.set("slot", fmt::format("{}", package::effectSlot(effects, infoOf(effect, number).effect)));
}

void addEffects(mustache::data& context, const Plan& plan) {
    const package::EffectSet& effects = plan.effects.effects;
    const auto list = [&](std::uint32_t bits) {
        mustache::data entries(mustache::data::type::list);
        package::forEachEffect(bits, [&](std::uint32_t number) {
            mustache::data entry;
            addEffect(entry, *plan.model, effects, number);
            addLayersOf(entry, plan, 1U << number);
            entries.push_back(entry);
        });
        return entries;
    };
    context.set("effects", list(effects.all));
    context.set("surfaceEffects", list(effects.surfaces));
    context.set("rayEffects", list(effects.rays));
}

}  // namespace glint::compiler
