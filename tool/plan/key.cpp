#include "plan/key.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace glint::compiler {

namespace {

// Texels of the finest level need no word about their level.
std::string placeText(const materials::TexelPlace& place) {
    return place.level == 0 ? fmt::format("({}, {})", place.x, place.y)
                            : fmt::format("({}, {}) of level {}", place.x, place.y, place.level);
}

std::string channelText(const std::string& name, const materials::TextureContent& content,
                        std::size_t channel) {
    const materials::ValueInterval held = content.of[channel];
    if (held.isExact() || !std::isnan(content.constant[channel])) {
        const double number = held.isExact() ? held.low : content.constant[channel];
        return fmt::format("{}.{} is {:.3g}{}", name, "rgba"[channel], number,
                           content.image.empty() ? "" : " in " + content.image);
    }
    std::string text = fmt::format("{}.{} is {:.3g} to {:.3g}", name, "rgba"[channel], held.low, held.high);
    const materials::TexelPlace& least = content.leastAt[channel];
    const materials::TexelPlace& greatest = content.greatestAt[channel];
    if (least.level >= 0 && greatest.level >= 0) {
        text +=
            fmt::format(", at texels {} and {} of {}", placeText(least), placeText(greatest), content.image);
    }
    return text;
}

bool isKnown(const materials::TextureContent& content, std::size_t channel) {
    return content.of[channel] != materials::kUnitInterval || !content.image.empty();
}

}  // namespace

std::string heldText(const materials::Material& material, const materials::PrimitiveInputs& primitive,
                     int texture, std::uint32_t channels) {
    const std::string& name = material.model().textures[static_cast<std::size_t>(texture)].name;
    const materials::TextureContent& content = contentOf(material, primitive, texture);
    std::string text;
    for (std::size_t i = 0; i < 4; ++i) {
        if ((channels >> i & 1U) != 0 && isKnown(content, i)) {
            text += (text.empty() ? "" : "; ") + channelText(name, content, i);
        }
    }
    return text;
}

std::string whatTexturesHold(const materials::Material& material, const materials::PrimitiveInputs& primitive,
                             const materials::Expression& when, HeldBy which) {
    const materials::MaterialModel& model = material.model();
    const auto isRead = [&](int texture) {
        return material.textures[static_cast<std::size_t>(texture)].isFolded ||
               (which == HeldBy::All && isReadable(material, primitive, texture));
    };
    std::map<int, std::uint32_t> channels;  // by texture
    for (const int symbol : when.symbols()) {
        const int texel = symbol - model.symbolOfTexel(0);
        if (texel >= 0 && texel < static_cast<int>(model.textures.size())) {
            channels[texel] |= isRead(texel) ? material.readsOf(texel).channels : 0;
            continue;
        }
        if (symbol < 0 || symbol >= static_cast<int>(model.parameters.size())) {
            continue;
        }
        const materials::Parameter& parameter = model.parameters[static_cast<std::size_t>(symbol)];
        if (parameter.scaledBy < 0 || !isRead(parameter.scaledBy)) {
            continue;
        }
        for (int i = 0; i < parameter.numbers; ++i) {
            const int channel = parameter.scaledByChannels[static_cast<std::size_t>(i)];
            channels[parameter.scaledBy] |= channel >= 0 ? 1U << static_cast<unsigned>(channel) : 0U;
        }
    }
    std::string text;
    for (const auto& [texture, read] : channels) {
        const std::string held = heldText(material, primitive, texture, read);
        text += (text.empty() || held.empty() ? "" : "; ") + held;
    }
    return text;
}

namespace {

using Drops = std::vector<std::pair<std::string, std::string>>;

// The presence of a feature in a key.
struct Presence {
    bool present = false;
    // If not empty, the file asks for the feature, and this is the reason why the key lacks it.
    std::string droppedBecause;
};

// Decides about the features of one key, in the model's order. When lobes are left out
// (KeyOptions::keptLobes), a key may have fewer features, never more, because hits need a part of the
// features that primary surfaces need. So a declared reason may ask whether the key lacks a feature, but not
// whether it has one, except for the base models, which are always kept.
class KeyMaker {
public:
    KeyMaker(const materials::Material& material, const materials::PrimitiveInputs& primitive,
             const materials::KeyOptions& options)
        : model_(material.model()),
          material_(material),
          primitive_(primitive),
          options_(options),
          kept_(~model_.lobes | options.keptLobes | model_.bases),
          facts_(material, primitive, options, key_),
          texels_(material, primitive, options, key_, materials::MaterialFacts::Textures::Texels),
          blind_(material, primitive, options, key_, materials::MaterialFacts::Textures::Unknown) {}

    materials::FeatureMask make(Drops* dropped) {
        for (const int place : steps()) {
            const materials::FeatureStep& step = model_.order[static_cast<std::size_t>(place)];
            if (step.needs >= 0 && !key_.has(step.needs)) {
                continue;
            }
            const materials::Feature& feature = model_.features[static_cast<std::size_t>(step.feature)];
            Presence presence = decide(feature);
            if (presence.present) {
                add(feature);
            } else if (dropped != nullptr && !presence.droppedBecause.empty()) {
                dropped->emplace_back(feature.name, std::move(presence.droppedBecause));
            }
        }
        return key_;
    }

private:
    // Returns the steps for the material, in their order.
    std::vector<int> steps() const {
        std::vector<int> steps = model_.commonSteps;
        for (const int object : material_.given) {
            const std::vector<int>& own = model_.objects[static_cast<std::size_t>(object)].steps;
            steps.insert(steps.end(), own.begin(), own.end());
        }
        std::ranges::sort(steps);
        return steps;
    }

    bool has(int feature) const {
        return key_.has(model_.features[static_cast<std::size_t>(feature)].bit);
    }

    // A file requests only textures that it has. A lobe is present by its values, whether or not the file
    // gives its extension.
    Presence decide(const materials::Feature& feature) const {
        const materials::TextureInfo* const info =
            feature.texture < 0 ? nullptr : &material_.textures[static_cast<std::size_t>(feature.texture)];
        if (info != nullptr && info->texture < 0) {
            const bool isBeyond = info->texCoord > 1;  // reading has left it out
            return {false, info->isFolded ? foldedReason(feature.texture)
                           : isBeyond     ? materials::missingAttribute(material_, primitive_, feature)
                                          : ""};
        }
        // The presence of an extension without reasons changes the shading by itself.
        const bool asksByValue = feature.object < 0 || !feature.neutral.empty();
        const bool given = isGiven(feature);
        if (!given && !asksByValue) {
            return {};
        }
        const std::optional<std::string> neutral = findNeutral(feature);
        const std::optional<std::string> excluded = findExclusion(feature);
        if (!neutral && !excluded) {
            return {true, {}};
        }
        const bool reports = given || !neutral;
        return {false, !reports ? "" : excluded ? *excluded : neutral.value_or("")};
    }

    bool isGiven(const materials::Feature& feature) const {
        if (feature.texture >= 0) {
            return true;
        }
        if (feature.given) {
            return feature.given->holds(facts_) != materials::Certainty::False;
        }
        return feature.object >= 0 && material_.given.has(feature.object);
    }

    void add(const materials::Feature& feature) {
        if (kept_.has(feature.bit)) {
            key_ |= feature.mask();
            exclusions_.insert(exclusions_.end(), feature.exclusions.begin(), feature.exclusions.end());
            std::ranges::sort(exclusions_);
        }
    }

    std::optional<std::string> findExclusion(const materials::Feature& feature) const {
        for (const int place : exclusions_) {
            const materials::Exclusion& exclusion = model_.exclusions[static_cast<std::size_t>(place)];
            if (exclusion.excluded.has(feature.bit)) {
                return exclusion.because;
            }
        }
        return std::nullopt;
    }

    std::optional<std::string> findNeutral(const materials::Feature& feature) const {
        if (feature.lobe >= 0 && !has(feature.lobe)) {
            return fmt::format("the key has no {}",
                               model_.features[static_cast<std::size_t>(feature.lobe)].name);
        }
        // A texture that the primitive can't read counts as 1, which is no reason of its own. Only reasons
        // count that would hold on a primitive with the missing attribute.
        std::string missing = materials::missingAttribute(material_, primitive_, feature);
        std::optional<materials::PrimitiveInputs> whole;
        std::optional<materials::MaterialFacts> ofWhole;
        if (!missing.empty()) {
            whole = materials::withEveryAttribute(primitive_);
            ofWhole.emplace(material_, *whole, options_, key_, materials::MaterialFacts::Textures::Unknown);
        }
        for (const materials::NeutralReason& reason : feature.neutral) {
            if (!reason.countsIn(key_) ||
                (ofWhole && reason.when.holds(*ofWhole) != materials::Certainty::True)) {
                continue;
            }
            if (reason.when.holds(blind_) == materials::Certainty::True) {
                return because(reason, HeldBy::Folded);
            }
            // A texture whose product is known has to be read anyway, because it makes the product.
            const materials::MaterialFacts& seen = feature.texture < 0 ? facts_ : texels_;
            if (reason.when.holds(seen) == materials::Certainty::True) {
                return because(reason, HeldBy::All);
            }
        }
        return missing.empty() ? std::nullopt : std::optional(std::move(missing));
    }

    std::string because(const materials::NeutralReason& reason, HeldBy which) const {
        const std::string held = whatTexturesHold(material_, primitive_, reason.when, which);
        return held.empty() ? reason.because
                            : fmt::format("{} (by what textures hold: {})", reason.because, held);
    }

    std::string foldedReason(int texture) const {
        const auto channels = material_.readsOf(texture).channels;
        return fmt::format("it is constant, so the parameters that it scales hold the product ({})",
                           heldText(material_, primitive_, texture, channels));
    }

    const materials::MaterialModel& model_;
    const materials::Material& material_;
    const materials::PrimitiveInputs& primitive_;
    const materials::KeyOptions& options_;
    materials::FeatureMask kept_;
    materials::FeatureMask key_ = 0;
    std::vector<int> exclusions_;  // of the features of the key, ascending
    materials::MaterialFacts facts_;
    materials::MaterialFacts texels_;  // knows them, but not their products with parameters
    materials::MaterialFacts blind_;   // ignores the contents of textures
};

}  // namespace

materials::FeatureMask makeKey(const materials::Material& material,
                               const materials::PrimitiveInputs& primitive,
                               const materials::KeyOptions& options, Drops* dropped) {
    // First drop neutral features, and record the reasons. Then drop the lobes that hits leave out.
    const materials::MaterialModel& model = material.model();
    const materials::FeatureMask whole = KeyMaker(material, primitive, keepAllLobes(options)).make(dropped);
    const bool keepsAll = (options.keptLobes & model.lobes) == model.lobes;
    materials::FeatureMask kept = keepsAll ? whole : KeyMaker(material, primitive, options).make(nullptr);
    if (dropped != nullptr) {
        for (const int index : model.indicesOf(whole)) {
            const materials::Feature& feature = model.features[static_cast<std::size_t>(index)];
            if (!kept.has(feature.bit)) {
                dropped->emplace_back(feature.name, feature.isLobe
                                                        ? "hits do not keep it (--hit-lobes)"
                                                        : "nothing that hits keep reads it (--hit-lobes)");
            }
        }
        for (const std::string& extension : material.unsupportedExtensions) {
            dropped->emplace_back(extension, "Glint does not shade this extension");
        }
    }
    return kept;
}

materials::KeyOptions keepAllLobes(materials::KeyOptions options) {
    options.keptLobes = materials::kAllFeatures;
    return options;
}

package::AlphaPolicy neededAlphaPolicy(std::span<const materials::Material> materials,
                                       std::span<const materials::PrimitiveInputs> primitives) {
    package::AlphaPolicy needed = package::AlphaPolicy::Opaque;
    for (const materials::PrimitiveInputs& primitive : primitives) {
        const materials::Material& material = materials[static_cast<std::size_t>(primitive.material)];
        if ((makeKey(material, primitive, {.alpha = package::AlphaPolicy::Stochastic}) &
             material.model().mask(package::Role::AlphaTest)) != 0) {
            needed = std::max(needed, material.alphaMode == materials::AlphaMode::Blend
                                          ? package::AlphaPolicy::Stochastic
                                          : package::AlphaPolicy::Tested);
        }
    }
    return needed;
}

}  // namespace glint::compiler
