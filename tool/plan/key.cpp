#include "plan/plan.h"

namespace glint {

FeatureMask makeKey(const Material& material, const PrimitiveInputs& primitive, const KeyOptions& options,
                    std::vector<std::pair<std::string, std::string>>* dropped) {
    FeatureMask mask = 0;
    for (const FeatureInfo& info : featureTable()) {
        Presence presence = info.rule(material, primitive, options, mask);
        if (presence.present) {
            mask |= bit(info.feature);
        } else if (dropped != nullptr && !presence.droppedBecause.empty()) {
            dropped->emplace_back(info.name, std::move(presence.droppedBecause));
        }
    }
    if (dropped != nullptr) {
        for (const std::string& extension : material.unsupportedExtensions) {
            dropped->emplace_back(extension, "Glint does not shade this extension");
        }
    }
    return mask;
}

}  // namespace glint
