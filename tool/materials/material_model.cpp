#include "materials/material_model.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace glint::materials {

namespace {

template <typename Rows>
int indexOf(const Rows& rows, std::string_view name) {
    const auto found = std::ranges::find_if(rows, [name](const auto& row) { return row.name == name; });
    return found == rows.end() ? -1 : static_cast<int>(found - rows.begin());
}

}  // namespace

std::string Feature::neutralText() const {
    std::vector<std::string_view> reasons;
    for (const NeutralReason& reason : neutral) {
        reasons.emplace_back(reason.because);
    }
    return reasons.empty() ? "never" : fmt::format("{}", fmt::join(reasons, "; or "));
}

bool Parameter::isValid(double value) const {
    return value == also || (value >= low && value <= high);
}

float Parameter::hold(double value) const {
    if (value == also) {
        return static_cast<float>(value);
    }
    if (isAngle) {
        // Sine and cosine keep their digits if the angle is reduced in double precision.
        return static_cast<float>(std::remainder(value, 2.0 * std::numbers::pi));
    }
    // A value beyond the range of floats is infinite where that is allowed.
    const bool overflows = std::isinf(high) && value >= std::numeric_limits<float>::max();
    return static_cast<float>(overflows ? kUnlimited : std::clamp(value, low, high));
}

int MaterialModel::findParameter(std::string_view name) const {
    return indexOf(parameters, name);
}

int MaterialModel::findTexture(std::string_view name) const {
    return indexOf(textures, name);
}

int MaterialModel::findFeature(std::string_view name) const {
    return indexOf(features, name);
}

int MaterialModel::findObject(std::string_view name) const {
    return indexOf(objects, name);
}

int MaterialModel::findAttribute(std::string_view name) const {
    return indexOf(attributes, name);
}

FeatureMask MaterialModel::opacityFeatures() const {
    FeatureMask mask = 0;
    for (const FeatureCode& row : code) {
        mask |= row.opacity.empty() || row.feature < 0
                    ? 0
                    : features[static_cast<std::size_t>(row.feature)].mask();
    }
    return mask;
}

FeatureMask MaterialModel::mask(std::string_view feature) const {
    const int index = findFeature(feature);
    return index < 0 ? 0 : features[static_cast<std::size_t>(index)].mask();
}

std::vector<std::string_view> MaterialModel::names(FeatureMask mask) const {
    std::vector<std::string_view> names;
    for (const Feature& feature : features) {
        if ((mask & feature.mask()) != 0) {
            names.emplace_back(feature.name);
        }
    }
    return names;
}

FeatureMask MaterialModel::baseModels() const {
    FeatureMask mask = 0;
    for (const Feature& feature : features) {
        mask |= feature.stage == Stage::Base ? feature.mask() : 0;
    }
    return mask;
}

std::string MaterialModel::featureDefines() const {
    FeatureMask sampledModels = 0;
    for (const FeatureCode& one : code) {
        sampledModels |= one.isSampled ? features[static_cast<std::size_t>(one.feature)].mask() : 0;
    }
    std::string text = fmt::format(
        "#define GLINT_LOBES 0x{:x}u\n#define GLINT_UNLIT_LOBES 0x{:x}u\n"
        "#define GLINT_BOTH_SIDES_LOBES 0x{:x}u\n#define GLINT_MODEL_LOBES 0x{:x}u\n"
        "#define GLINT_SAMPLED_MODEL_LOBES 0x{:x}u\n",
        lobes, unlit, bothSides, ownModels, sampledModels);
    for (const Feature& feature : features) {
        const std::string name = feature.macro.substr(feature.macro.starts_with("GLINT_PACK_") ? 11 : 6);
        text += fmt::format("#define {} 0x{:x}u\n", feature.macro,
                            1U << (static_cast<unsigned>(feature.bit) % 32U));
        text += fmt::format("#define GLINT_HAS_{}(features) {}(features, {})\n", name,
                            feature.bit < kFirstInput ? "hasLobe" : "hasInput", feature.macro);
        text += fmt::format("#define GLINT_KEY_HAS_{}(features) {}(features, {})\n", name,
                            feature.bit < kFirstInput ? "lobeOfKey" : "inputOfKey", feature.macro);
    }
    return text;
}

int MaterialModel::symbolOf(Fact fact) const {
    return static_cast<int>(parameters.size()) + static_cast<int>(fact);
}

int MaterialModel::symbolOfFeature(int feature) const {
    return symbolOf(Fact::Count) + feature;
}

int MaterialModel::symbolOfTexture(int texture) const {
    return symbolOfFeature(static_cast<int>(features.size())) + texture;
}

int MaterialModel::symbolOfTexel(int texture) const {
    return symbolOfTexture(static_cast<int>(textures.size())) + texture;
}

int MaterialModel::symbolOfAttribute(int attribute) const {
    return symbolOfTexel(static_cast<int>(textures.size())) + attribute;
}

int MaterialModel::symbolOfPair(int pair) const {
    return symbolOfAttribute(static_cast<int>(attributes.size())) + pair;
}

}  // namespace glint::materials
