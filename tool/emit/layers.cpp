#include "emit/layers.h"

#include "base/suggest.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <interop/frame.h>
#include <set>
#include <tuple>

namespace glint::compiler {

namespace mustache = kainjow::mustache;

using package::LayerEntry;
using package::LayerInfo;
using package::LayerSubject;

namespace {

// The words of --layers for several layers at once.
constexpr std::string_view kEveryLayer = "all";
constexpr std::string_view kSurfaceLayers = "surface";

const LayerInfo& infoOf(const LayerEntry& entry) {
    return *package::findLayer(entry.layer);
}

const materials::EffectDeclaration& declarationOf(const materials::MaterialModel& model,
                                                  package::Effect effect) {
    return model.effects[package::effectNumber(effect)];
}

// The albedo that a source's light is divided by: that of the lobes that bring it.
const LayerInfo& albedoOf(package::Effect effect, const materials::MaterialModel& model) {
    const std::string lobes = effect == 0 ? std::string() : declarationOf(model, effect).albedo;
    return *package::findLayer(lobes.empty() ? std::string("albedo") : "albedo-" + lobes);
}

bool demodulates(const LayerInfo& info) {
    return info.name == "demodulated";
}

// The sources that a layer may have in the package.
std::vector<package::Effect> sourcesOf(const LayerInfo& info, const Plan& plan) {
    std::vector<package::Effect> sources;
    if (info.subject != LayerSubject::Ray) {
        sources.push_back(0);
    }
    if (info.subject != LayerSubject::Surface) {
        package::forEachEffect(plan.effects.effects.rays, [&](std::uint32_t number) {
            const package::Effect effect = 1U << number;
            const bool shows = !plan.model->effects[number].shows.empty();
            if (shows || (info.demands & package::kLayerHistory) == 0) {
                sources.push_back(effect);
            }
        });
    }
    return sources;
}

// The layers that a word stands for, with all their sources. Empty if it is "SOURCE.LAYER".
std::vector<const LayerInfo*> layersNamed(std::string_view word) {
    std::vector<const LayerInfo*> named;
    for (const LayerInfo& info : package::layerTable()) {
        const bool isSurface = info.subject == LayerSubject::Surface;
        if (word == kEveryLayer || word == info.name || (word == kSurfaceLayers && isSurface)) {
            named.push_back(&info);
        }
    }
    return named;
}

// Resolves "reflection.radiance", or "reflection" for all layers of the effect.
Status addOfSource(std::string_view word, const Plan& plan, const std::string& where,
                   std::vector<LayerEntry>& entries) {
    const std::size_t dot = std::min(word.find('.'), word.size());
    const std::string source(word.substr(0, dot));
    const std::string_view layer = word.substr(std::min(dot + 1, word.size()));
    package::Effect effect = 0;
    if (source != package::kDirectLight) {
        std::vector<std::string> known{std::string(package::kDirectLight)};
        package::forEachEffect(plan.effects.effects.rays, [&](std::uint32_t number) {
            known.push_back(plan.model->effects[number].name);
        });
        if (std::ranges::find(known, source) == known.end()) {
            const bool exists = findEffect(plan.model->effects, source) != 0;
            return makeError(
                "layer-effect", where,
                exists ? fmt::format("the package has no effect {} with rays, so there is no layer {}",
                                     source, word)
                       : fmt::format("there is no effect {}{}", source, base::suggestion(source, known)),
                fmt::format("layers are of {}; --effects decides which effects the package has",
                            fmt::join(known, ", ")));
        }
        effect = findEffect(plan.model->effects, source);
    }
    bool found = false;
    for (const LayerInfo& info : package::layerTable()) {
        const std::vector<package::Effect> sources = sourcesOf(info, plan);
        const bool wanted = info.subject != LayerSubject::Surface && (layer.empty() || layer == info.name);
        if (wanted && std::ranges::find(sources, effect) != sources.end()) {
            entries.push_back({info.number, effect});
            found = true;
        }
    }
    return found ? okStatus()
                 : Status(makeError("layer-effect", where, fmt::format("{} has no layer {}", source, layer),
                                    "see docs/layers.md for which layers a source of light has"));
}

// Adds what others are computed from.
void addNeeded(const Plan& plan, std::vector<LayerEntry>& entries) {
    for (std::size_t i = 0; i < entries.size(); ++i) {
        const LayerEntry entry = entries[i];
        const LayerInfo& info = infoOf(entry);
        if (!info.from.empty()) {
            entries.push_back({package::findLayer(info.from)->number, entry.effect});
        }
        if (demodulates(info)) {
            entries.push_back({albedoOf(entry.effect, *plan.model).number, 0});
        }
    }
    const auto place = [](const LayerEntry& entry) {
        const auto row = std::ranges::find(package::layerTable(), entry.layer, &LayerInfo::number);
        return std::tuple(row - package::layerTable().begin(), entry.effect);
    };
    std::ranges::sort(entries, {}, place);
    const auto again = std::ranges::unique(entries);
    entries.erase(again.begin(), again.end());
}

// The fields of one layer.
mustache::data fieldsOf(const LayerEntry& entry, const Plan& plan) {
    const LayerInfo& info = infoOf(entry);
    const package::LayerFormatInfo& format = package::infoOf(info.format);
    const auto place = std::ranges::find(plan.layers, entry) - plan.layers.begin();
    // "geometric-normal" gives geometricNormal, "reflection.radiance" reflectionRadiance.
    std::string variable;
    bool raises = false;
    for (const char character : layerNameOf(entry, *plan.model)) {
        const bool isLetter = std::isalnum(static_cast<unsigned char>(character)) != 0;
        if (isLetter) {
            variable +=
                raises ? static_cast<char>(std::toupper(static_cast<unsigned char>(character))) : character;
        }
        raises = !isLetter;
    }
    mustache::data fields;
    fields.set("binding", fmt::format("kBindingLayers + {}u", place));
    fields.set("qualifier", std::string(format.qualifier));
    fields.set("image", info.format == package::LayerFormat::Integer ? "uimage2D" : "image2D");
    fields.set("value", variable);
    fields.set("variable", variable + "Layer");
    fields.set("function", std::string(info.function));
    fields.set("absent", std::string(info.absent));
    fields.set("isMean", mustache::data(info.mean == package::LayerMean::Mean));
    return fields;
}

const LayerEntry* findEntry(const Plan& plan, std::string_view layer, package::Effect effect) {
    const auto found = std::ranges::find(plan.layers, LayerEntry{package::findLayer(layer)->number, effect});
    return found == plan.layers.end() ? nullptr : &*found;
}

std::string variableOf(const LayerEntry& entry, const Plan& plan) {
    return fieldsOf(entry, plan).get("variable")->string_value();
}

std::string albedoVariable(const Plan& plan, package::Effect effect) {
    return variableOf({albedoOf(effect, *plan.model).number, 0}, plan);
}

// The fields of the layers of a source's light; false if it has none.
mustache::data lightFields(const Plan& plan, package::Effect effect) {
    const LayerEntry* const radiance = findEntry(plan, "radiance", effect);
    if (radiance == nullptr) {
        return false;
    }
    mustache::data fields;
    fields.set("radiance", variableOf(*radiance, plan));
    for (const char* const name : {"demodulated", "variance"}) {
        const LayerEntry* const entry = findEntry(plan, name, effect);
        mustache::data own(false);
        if (entry != nullptr) {
            own = mustache::data();
            own.set("variable", variableOf(*entry, plan));
            own.set("albedo", demodulates(infoOf(*entry)) ? albedoVariable(plan, effect) : std::string());
        }
        fields.set(name, own);
    }
    return fields;
}

}  // namespace

Result<std::vector<LayerEntry>> resolveLayers(const Plan& plan, const CompileSettings& settings,
                                              const std::string& where) {
    std::vector<LayerEntry> entries;
    for (const std::string& word : settings.layers) {
        const std::vector<const LayerInfo*> named = layersNamed(word);
        for (const LayerInfo* const info : named) {
            for (const package::Effect effect : sourcesOf(*info, plan)) {
                entries.push_back({info->number, effect});
            }
        }
        if (named.empty()) {
            if (Status added = addOfSource(word, plan, where, entries); !added) {
                return added.error();
            }
        }
    }
    if (!entries.empty() && settings.passes != package::Passes::Frame) {
        return makeError("passes", where, "--layers is about frames, and --passes steps draws none",
                         "leave out --layers, or --passes steps");
    }
    addNeeded(plan, entries);
    return entries;
}

std::string layerNameOf(const LayerEntry& entry, const materials::MaterialModel& model) {
    return package::layerName(
        infoOf(entry), entry.effect == 0 ? package::kDirectLight : declarationOf(model, entry.effect).name);
}

std::string layerDefines(const Plan& plan, bool deforms) {
    std::uint32_t demands = 0;
    bool ofSurfaces = false;
    bool ofEffects = false;
    for (const LayerEntry& entry : plan.layers) {
        demands |= infoOf(entry).demands;
        const bool lighting = passOf(entry) == package::LayerPass::Lighting;
        ofSurfaces = ofSurfaces || lighting;
        ofEffects = ofEffects || !lighting;
    }
    const bool history = (demands & package::kLayerHistory) != 0;
    const auto flag = [](bool value) { return value ? 1 : 0; };
    return fmt::format(
        "// Layers beside the picture\n"
        "#define GLINT_LAYER_MEMBERS {}\n"
        "#define GLINT_SURFACE_LAYERS {}\n"
        "#define GLINT_EFFECT_LAYERS {}\n"
        "#define GLINT_LAYER_HISTORY {}\n"
        "#define GLINT_LAYER_DEFORMS {}\n"
        "#define GLINT_LAYER_RAYS {}\n",
        flag(!plan.layers.empty()), flag(ofSurfaces), flag(ofEffects), flag(history),
        flag(history && deforms), flag((demands & package::kLayerRays) != 0));
}

void addLayers(mustache::data& context, const Plan& plan) {
    mustache::data lighting(mustache::data::type::list);
    mustache::data surface(mustache::data::type::list);
    for (const LayerEntry& entry : plan.layers) {
        if (passOf(entry) != package::LayerPass::Lighting) {
            continue;
        }
        const LayerInfo& info = infoOf(entry);
        mustache::data fields = fieldsOf(entry, plan);
        fields.set("access", info.continues ? "" : "writeonly ");
        lighting.push_back(fields);
        if (info.subject == LayerSubject::Surface) {
            surface.push_back(fields);
        }
    }
    context.set("lightingLayers", lighting);
    context.set("surfaceLayers", surface);
    context.set("directLight", lightFields(plan, 0));

    // Those that compose writes, and the albedos that it reads.
    mustache::data effects(mustache::data::type::list);
    std::set<std::string> read;
    for (const LayerEntry& entry : plan.layers) {
        if (passOf(entry) != package::LayerPass::Compose) {
            continue;
        }
        const LayerInfo& info = infoOf(entry);
        mustache::data fields = fieldsOf(entry, plan);
        fields.set("access", info.continues ? "" : "writeonly ");
        effects.push_back(fields);
        if (demodulates(info) && read.insert(albedoVariable(plan, entry.effect)).second) {
            mustache::data albedo = fieldsOf({albedoOf(entry.effect, *plan.model).number, 0}, plan);
            albedo.set("access", "readonly ");
            effects.push_back(albedo);
        }
    }
    context.set("hasRayLayers", mustache::data(std::ranges::any_of(plan.layers, [](const LayerEntry& entry) {
                    return infoOf(entry).subject == LayerSubject::Ray;
                })));
    context.set("hasEffectLayers", mustache::data(effects.is_non_empty_list()));
    context.set("effectLayers", effects);
}

void addLayersOf(mustache::data& entry, const Plan& plan, package::Effect effect) {
    entry.set("lightLayers", lightFields(plan, effect));
    mustache::data rays;
    bool any = false;
    for (const auto& [name, field] :
         {std::pair("distance", "distance"), std::pair("virtual-motion", "motion")}) {
        const LayerEntry* const found = findEntry(plan, name, effect);
        mustache::data own(false);
        if (found != nullptr) {
            own = mustache::data();
            own.set("variable", variableOf(*found, plan));
            own.set("shows", declarationOf(*plan.model, effect).shows);
        }
        rays.set(field, own);
        any = any || found != nullptr;
    }
    entry.set("rayLayers", any ? rays : mustache::data(false));
}

}  // namespace glint::compiler
