// Numbers the features, and orders them by the features that their conditions need.
#include "materials/model_builder.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace glint::materials {

void ModelBuilder::assignBits() {
    std::vector<int> sorted(pending_.size());
    for (std::size_t i = 0; i < sorted.size(); ++i) {
        sorted[i] = static_cast<int>(i);
    }
    std::ranges::sort(sorted, {}, [this](int i) {
        const Pending& row = pending_[static_cast<std::size_t>(i)];
        // The bits of Glint's own features are the same with packs as without.
        return std::tuple(row.isOfPack, !isLobe(row.feature), row.order, std::string_view(row.feature.name));
    });
    std::vector<int> indexOf(pending_.size());
    int lobe = 0;
    int input = kFirstInput;
    int further = kFirstInput;  // inputs that find no place in their word go down from here
    for (const int i : sorted) {
        Pending& row = pending_[static_cast<std::size_t>(i)];
        row.feature.isLobe = isLobe(row.feature);
        row.feature.bit = row.feature.isLobe ? lobe++ : input < kFeatureBits ? input++ : --further;
        if (lobe > further) {
            failAt(row.where, fmt::format("there are more features than the {} bits of a key", kFeatureBits));
        }
        model_.lobes |= row.feature.isLobe ? row.feature.mask() : 0;
        indexOf[static_cast<std::size_t>(i)] = static_cast<int>(model_.features.size());
        if (!row.isLit) {
            model_.unlit |= row.feature.mask();
        }
        model_.features.push_back(std::move(row.feature));
    }
    for (MaterialTexture& texture : model_.textures) {
        texture.feature = indexOf[static_cast<std::size_t>(texture.feature)];
    }
    for (File& file : files_) {
        file.mainFeature = file.mainFeature < 0 ? -1 : indexOf[static_cast<std::size_t>(file.mainFeature)];
    }
    for (VertexAttribute& attribute : model_.attributes) {
        attribute.feature = indexOf[static_cast<std::size_t>(attribute.feature)];
    }
    // Slots have the order of their bits.
    std::ranges::sort(model_.textures, {}, &MaterialTexture::feature);
    for (std::size_t i = 0; i < model_.textures.size(); ++i) {
        featureAt(model_.textures[i].feature).texture = static_cast<int>(i);
    }
}

bool ModelBuilder::isLobe(const Feature& feature) {
    return feature.texture < 0 && (feature.stage == Stage::Base || feature.stage == Stage::Layer);
}

void ModelBuilder::orderByDependence() {
    const std::size_t count = model_.features.size();
    std::vector<std::set<int>> needs(count);
    const auto isLate = [&](const Feature& feature) {
        return feature.stage == Stage::Attributes || feature.stage == Stage::Coordinates;
    };
    for (std::size_t i = 0; i < count; ++i) {
        const Feature& feature = model_.features[i];
        for (const NeutralReason& reason : feature.neutral) {
            addNeeds(reason.when, needs[i]);
        }
        if (feature.given) {
            addNeeds(*feature.given, needs[i]);
        }
        if (feature.lobe >= 0) {
            needs[i].insert(feature.lobe);
        }
        for (const Exclusion& exclusion : model_.exclusions) {
            if ((exclusion.excluded & feature.mask()) != 0) {
                needs[i].insert(exclusion.by);
            }
        }
        if (asksForOpacity(feature)) {
            for (const FeatureCode& code : model_.code) {
                if (!code.opacity.empty() && code.feature != static_cast<int>(i)) {
                    needs[i].insert(code.feature);
                }
            }
        }
        for (std::size_t other = 0; isLate(feature) && other < count; ++other) {
            if (!isLate(model_.features[other])) {
                needs[i].insert(static_cast<int>(other));
            }
        }
    }
    std::vector<bool> placed(count);
    while (model_.order.size() < count) {
        const auto next = std::ranges::find_if(indices(count), [&](int i) {
            return !placed[static_cast<std::size_t>(i)] &&
                   std::ranges::all_of(needs[static_cast<std::size_t>(i)],
                                       [&](int need) { return placed[static_cast<std::size_t>(need)]; });
        });
        if (next == indices(count).end()) {
            const auto left = std::ranges::find(placed, false);
            const Feature& feature = model_.features[static_cast<std::size_t>(left - placed.begin())];
            failAt(named_[feature.name],
                   fmt::format("the conditions of \"{}\" lead back to it", feature.name));
        }
        placed[static_cast<std::size_t>(*next)] = true;
        model_.order.push_back(*next);
    }
}

void ModelBuilder::keepPlacesOfUnlit() {
    FeatureMask kept = 0;
    for (const Feature& feature : model_.features) {
        const Feature& owner = feature.lobe < 0 ? feature : featureAt(feature.lobe);
        const bool isPlace = owner.stage == Stage::Coordinates || owner.stage == Stage::Opacity;
        kept |= isPlace ? feature.mask() : 0;
    }
    for (Exclusion& exclusion : model_.exclusions) {
        if ((featureAt(exclusion.by).mask() & model_.unlit) != 0) {
            exclusion.excluded &= ~kept;
        }
    }
}

bool ModelBuilder::asksForOpacity(const Feature& feature) const {
    return std::ranges::any_of(feature.neutral, [&](const NeutralReason& reason) {
        const auto& symbols = reason.when.symbols();
        return std::ranges::find(symbols, model_.symbolOf(Fact::ChangesOpacity)) != symbols.end();
    });
}

const std::vector<int>& ModelBuilder::indices(std::size_t count) {
    for (std::size_t i = indices_.size(); i < count; ++i) {
        indices_.push_back(static_cast<int>(i));
    }
    return indices_;
}

void ModelBuilder::addNeeds(const Expression& expression, std::set<int>& needs) const {
    const int first = model_.symbolOfFeature(0);
    for (const int symbol : expression.symbols()) {
        if (symbol >= first && symbol < first + static_cast<int>(model_.features.size())) {
            needs.insert(symbol - first);
        }
    }
}

}  // namespace glint::materials
