#include "resolve/layers.h"

#include "base/text.h"
#include "settings/settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <tuple>

namespace glint::compiler {

using package::LayerEntry;
using package::LayerInfo;
using package::LayerSubject;

const LayerInfo& infoOf(const LayerEntry& entry) {
    return *package::findLayer(entry.layer);
}

const materials::EffectDeclaration& declarationOf(const materials::MaterialModel& model,
                                                  package::Effect effect) {
    return model.effects[package::effectNumber(effect)];
}

const LayerInfo& albedoOf(package::Effect effect, const materials::MaterialModel& model) {
    const std::string lobes = effect == 0 ? std::string() : declarationOf(model, effect).albedo;
    return *package::findLayer(lobes.empty() ? std::string("albedo") : "albedo-" + lobes);
}

bool demodulates(const LayerInfo& info) {
    return info.name.ends_with("demodulated");
}

namespace {

// The words of --layers for several layers at once.
constexpr std::string_view kEveryLayer = "all";
constexpr std::string_view kSurfaceLayers = "surface";

// The images of a layer that the package may have. `bounces` have layers of their own.
std::vector<LayerEntry> entriesOf(const LayerInfo& info, const Plan& plan, std::uint32_t bounces) {
    std::vector<LayerEntry> entries;
    if (!package::hasSources(info) || info.subject == LayerSubject::Light) {
        entries.push_back({info.number, 0, 0});
    }
    package::forEachEffect(plan.effects.effects.rays, [&](std::uint32_t number) {
        const package::Effect effect = 1U << number;
        const bool moves = info.subject == LayerSubject::Ray && (info.demands & package::kLayerHistory) != 0;
        if (info.subject == LayerSubject::Bounce) {
            for (std::uint32_t bounce = 1; bounce <= bounces; ++bounce) {
                entries.push_back({info.number, effect, bounce});
            }
        } else if (package::hasSources(info) && (!moves || !plan.model->effects[number].shows.empty())) {
            entries.push_back({info.number, effect, 0});
        }
    });
    return entries;
}

// Returns the number of bounces of the package's paths that have layers of their own; 0 if paths have one
// bounce.
std::uint32_t layerBouncesOf(const Plan& plan, const CompileSettings& settings) {
    const bool hasPaths = plan.effects.effects.rays != 0 && settings.maxBounces > 1;
    return hasPaths ? std::min(settings.maxBounces, package::kMostLayerBounces) : 0;
}

// The layers that a word stands for, with all their sources. Empty if it is "SOURCE.LAYER".
std::vector<const LayerInfo*> layersNamed(std::string_view word) {
    std::vector<const LayerInfo*> named;
    for (const LayerInfo& info : package::layerTable()) {
        const bool isSurface = info.subject == LayerSubject::Surface;
        const bool inGroup =
            !info.isDiagnostic && (word == kEveryLayer || (word == kSurfaceLayers && isSurface));
        if (inGroup || word == info.name) {
            named.push_back(&info);
        }
    }
    return named;
}

// Resolves "reflection.radiance", or "reflection" for all layers of the effect.
Status addOfSource(std::string_view word, const Plan& plan, std::uint32_t bounces, const std::string& where,
                   std::vector<LayerEntry>& entries) {
    const std::size_t dot = std::min(word.find('.'), word.size());
    const std::string source(word.substr(0, dot));
    const std::string_view layer = word.substr(std::min(dot + 1, word.size()));
    std::vector<std::string> known{std::string(package::kDirectLight)};
    package::forEachEffect(plan.effects.effects.rays,
                           [&](std::uint32_t number) { known.push_back(plan.model->effects[number].name); });
    if (std::ranges::find(known, source) == known.end()) {
        const bool exists = findEffect(plan.model->effects, source) != 0;
        return makeError(
            "layer-effect", where,
            exists
                ? fmt::format("the package has no effect {} with rays, so there is no layer {}", source, word)
                : fmt::format("there is no effect {}{}", source, base::suggestion(source, known)),
            fmt::format("layers are of {}; --effects decides which effects the package has",
                        fmt::join(known, ", ")));
    }
    // 0 for the direct light, which no effect is called.
    const package::Effect effect = findEffect(plan.model->effects, source);
    const std::size_t before = entries.size();
    for (const LayerInfo& info : package::layerTable()) {
        const bool wanted = layer.empty() ? !info.isDiagnostic : layer == info.name;
        if (!wanted || !package::hasSources(info)) {
            continue;
        }
        for (const LayerEntry& entry : entriesOf(info, plan, bounces)) {
            if (entry.effect == effect) {
                entries.push_back(entry);
            }
        }
    }
    return entries.size() > before
               ? okStatus()
               : Status(
                     makeError("layer-effect", where, fmt::format("{} has no layer {}", source, layer),
                               "see docs/layers.md for which layers a source of light has; those of bounces "
                               "need --bounces"));
}

// Adds what others are computed from.
void addNeeded(const Plan& plan, std::vector<LayerEntry>& entries) {
    for (std::size_t i = 0; i < entries.size(); ++i) {
        const LayerEntry entry = entries[i];
        const LayerInfo& info = infoOf(entry);
        if (!info.from.empty()) {
            entries.push_back({package::findLayer(info.from)->number, entry.effect, entry.bounce});
        }
        if (demodulates(info)) {
            entries.push_back({albedoOf(entry.effect, *plan.model).number, 0, 0});
        }
    }
    const auto place = [](const LayerEntry& entry) {
        const auto row = std::ranges::find(package::layerTable(), entry.layer, &LayerInfo::number);
        return std::tuple(row - package::layerTable().begin(), entry.effect, entry.bounce);
    };
    std::ranges::sort(entries, {}, place);
    entries.erase(std::unique(entries.begin(), entries.end()), entries.end());
}

}  // namespace

Result<std::vector<LayerEntry>> resolveLayers(const Plan& plan, const CompileSettings& settings,
                                              const std::string& where) {
    std::vector<LayerEntry> entries;
    const std::uint32_t bounces = layerBouncesOf(plan, settings);
    for (const std::string& asked : settings.layers) {
        const bool isOptional = asked.ends_with(kOptionalLayer);
        const std::string word = asked.substr(0, asked.size() - (isOptional ? 1 : 0));
        const std::vector<const LayerInfo*> named = layersNamed(word);
        const std::size_t before = entries.size();
        for (const LayerInfo* const info : named) {
            std::ranges::copy(entriesOf(*info, plan, bounces), std::back_inserter(entries));
        }
        if (named.empty()) {
            GLINT_TRY_DO(addOfSource(word, plan, bounces, where, entries));
        } else if (entries.size() == before && !isOptional) {
            return makeError("layer-effect", where,
                             fmt::format("nothing in the package has the layer {}", word),
                             named.front()->subject == LayerSubject::Bounce
                                 ? "add an effect with rays by --effects, and --bounces"
                                 : "add an effect with rays by --effects");
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
    const std::string_view source =
        entry.effect == 0 ? package::kDirectLight : declarationOf(model, entry.effect).name;
    return package::layerName(infoOf(entry), source, entry.bounce);
}

}  // namespace glint::compiler
