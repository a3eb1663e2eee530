#include "plan/plan.h"

namespace glint {

namespace {

using Drops = std::vector<std::pair<std::string, std::string>>;

// These replace the base model, so no hit can do without them.
constexpr FeatureMask kBaseModels = bit(Feature::Unlit) | bit(Feature::SpecularGlossiness);

FeatureMask evaluate(const Material& material, const PrimitiveInputs& primitive, const KeyOptions& options,
                     Drops* dropped) {
    const FeatureMask left = kLobeMask & ~(options.keptLobes | kBaseModels);
    FeatureMask mask = 0;
    for (const FeatureInfo& info : featureTable()) {
        Presence presence = info.rule(material, primitive, options, mask);
        if (presence.present) {
            mask |= bit(info.feature) & ~left;
        } else if (dropped != nullptr && !presence.droppedBecause.empty()) {
            dropped->emplace_back(info.name, std::move(presence.droppedBecause));
        }
    }
    return mask;
}

}  // namespace

FeatureMask makeKey(const Material& material, const PrimitiveInputs& primitive, const KeyOptions& options,
                    Drops* dropped) {
    // First drop what is neutral, and record the reasons. Then drop the lobes that hits leave out.
    const FeatureMask whole = evaluate(material, primitive, keepAllLobes(options), dropped);
    const FeatureMask kept = evaluate(material, primitive, options, nullptr);
    if (dropped != nullptr) {
        for (const FeatureInfo& info : featureTable()) {
            if ((whole & ~kept & bit(info.feature)) != 0) {
                const bool isLobe = (bit(info.feature) & kLobeMask) != 0;
                dropped->emplace_back(info.name, isLobe ? "hits do not keep it (--hit-lobes)"
                                                        : "nothing that hits keep reads it (--hit-lobes)");
            }
        }
        for (const std::string& extension : material.unsupportedExtensions) {
            dropped->emplace_back(extension, "Glint does not shade this extension");
        }
    }
    return kept;
}

KeyOptions keepAllLobes(KeyOptions options) {
    options.keptLobes = kLobeMask;
    return options;
}

}  // namespace glint
