#include "materials/material.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace glint::materials {

namespace {

bool isMoved(const TextureInfo& info) {
    return info.moves || info.transform != TextureTransform{};
}

// Returns whether the directions of U and V differ from those of the UV set by more than the rounding of
// single precision. A scale of 0 counts as one just above 0.
bool turnsFrame(const TextureInfo& info) {
    constexpr double kTolerance = 2.5e-7;
    const TransformRows rows = rowsOf(info.transform);
    return info.turns || rows[0][0] < 0.0 || rows[1][1] < 0.0 ||
           std::abs(rows[1][0]) > kTolerance * std::abs(rows[1][1]);
}

bool sameTexture(const TextureInfo& a, const TextureInfo& b) {
    return a.texture == b.texture && a.texCoord == b.texCoord && a.transform == b.transform && !a.moves &&
           !b.moves;
}

const Parameter& parameterOf(const Material& material, std::string_view name) {
    const int index = material.model().findParameter(name, modelOf(material));
    assert(index >= 0);
    return material.model().parameters[static_cast<std::size_t>(index)];
}

}  // namespace

TransformRows rowsOf(const TextureTransform& transform) {
    const double sine = std::sin(static_cast<double>(transform.rotation));
    const double cosine = std::cos(static_cast<double>(transform.rotation));
    const double scaleU = transform.scale[0];
    const double scaleV = transform.scale[1];
    return {{{cosine * scaleU, sine * scaleV, transform.offset[0]},
             {-sine * scaleU, cosine * scaleV, transform.offset[1]}}};
}

double MaterialValues::operator[](std::size_t place) const {
    const auto after = set_.upper_bound(place);
    if (after != set_.begin()) {
        const auto& [first, numbers] = *std::prev(after);
        if (place - first < numbers.size()) {
            return numbers[place - first];
        }
    }
    return model_->defaults[place];
}

std::span<const double> MaterialValues::of(const Parameter& parameter) const {
    const auto first = static_cast<std::size_t>(parameter.first);
    const auto found = set_.find(first);
    return found != set_.end()
               ? std::span<const double>(found->second)
               : std::span(model_->defaults).subspan(first, static_cast<std::size_t>(parameter.numbers));
}

std::span<double> MaterialValues::of(const Parameter& parameter) {
    const auto [place, isNew] = set_.try_emplace(static_cast<std::size_t>(parameter.first));
    if (isNew) {
        const auto first = model_->defaults.begin() + parameter.first;
        place->second.assign(first, first + parameter.numbers);
    }
    return place->second;
}

bool MaterialValues::operator==(const MaterialValues& other) const {
    return std::ranges::all_of(model_->parameters, [&](const Parameter& parameter) {
        return std::ranges::equal(of(parameter), other.of(parameter));
    });
}

std::vector<ValueInterval> rangesOf(const Material& material) {
    std::vector<ValueInterval> ranges;
    for (std::size_t place = 0; place < material.model().defaults.size(); ++place) {
        const double value = material.values[place];
        ranges.push_back({value, value});
    }
    return ranges;
}

Material::Material(const MaterialModel& model) : values(model), model_(&model) {}

ParameterValue Material::operator[](std::string_view parameter) {
    return ParameterValue(values.of(parameterOf(*this, parameter)));
}

ConstParameterValue Material::operator[](std::string_view parameter) const {
    return ConstParameterValue(values.of(parameterOf(*this, parameter)));
}

const TextureInfo& TextureSlots::operator[](std::size_t slot) const {
    static const TextureInfo empty;
    const auto found = slots_.find(slot);
    return found == slots_.end() ? empty : found->second;
}

TextureInfo& Material::texture(std::string_view texture) {
    const int index = model_->findTexture(texture, modelOf(*this));
    assert(index >= 0);
    return textures[static_cast<std::size_t>(index)];
}

const TextureInfo& Material::texture(std::string_view texture) const {
    const int index = model_->findTexture(texture, modelOf(*this));
    assert(index >= 0);
    return textures[static_cast<std::size_t>(index)];
}

void Material::give(std::string_view object) {
    const int index = model_->findObject(object);
    assert(index >= 0);
    given.add(index);
}

bool Material::gives(std::string_view object) const {
    const int index = model_->findObject(object);
    return index >= 0 && given.has(index);
}

bool Material::isColor(int texture) const {
    return std::ranges::any_of(
        model_->textures[static_cast<std::size_t>(texture)].places,
        [this](const MaterialTexture::Place& place) { return place.isColor && reads(place.object); });
}

TextureReads Material::readsOf(int texture) const {
    TextureReads all{.channels = 0, .isNormals = true};
    for (const MaterialTexture::Place& place : model_->textures[static_cast<std::size_t>(texture)].places) {
        if (reads(place.object)) {
            all.channels |= place.reads.channels;
            all.isNormals = all.isNormals && place.reads.isNormals;
            all.roughness |= place.reads.roughness;
            all.glossiness |= place.reads.glossiness;
        }
    }
    return all;
}

bool Material::isUnlit() const {
    return std::ranges::any_of(
        given, [this](int object) { return model_->objects[static_cast<std::size_t>(object)].isUnlit; });
}

bool Material::reads(int object) const {
    if (model_->objects[static_cast<std::size_t>(object)].replaces >= 0 && !given.has(object)) {
        return false;
    }
    // An unlit material reads the plain base, whatever replaces it.
    const bool unlit = isUnlit();
    const auto rowOf = [this](int one) -> const MaterialObject& {
        return model_->objects[static_cast<std::size_t>(one)];
    };
    // Returns the object that the material has in place of the replaced one, or -1. Of several models it has
    // the first by bits, as in keys; objects without a feature come last.
    const auto chosen = [&](int replaced) {
        int first = -1;
        for (const int one : given) {
            const bool isEarlier = first < 0 || static_cast<unsigned>(rowOf(one).feature) <
                                                    static_cast<unsigned>(rowOf(first).feature);
            first = rowOf(one).replaces == replaced && isEarlier ? one : first;
        }
        return first;
    };
    const int replaced = rowOf(object).replaces;
    return replaced >= 0 ? !unlit && chosen(replaced) == object : unlit || chosen(object) < 0;
}

int modelOf(const Material& material) {
    const MaterialModel& model = material.model();
    int base = -1;
    for (const int object : material.given) {
        const MaterialObject& row = model.objects[static_cast<std::size_t>(object)];
        const bool isChosen = row.base >= 0 && (row.isUnlit || material.reads(object));
        base = isChosen && (base < 0 || row.base < base) ? row.base : base;
    }
    return base < 0 ? -1 : model.features[static_cast<std::size_t>(base)].model;
}

bool isReadable(const Material& material, const PrimitiveInputs& primitive, int texture) {
    const TextureInfo& info = material.textures[static_cast<std::size_t>(texture)];
    const MaterialModel& model = material.model();
    const MaterialTexture& slot = model.textures[static_cast<std::size_t>(texture)];
    return info.texture >= 0 && (model.features[static_cast<std::size_t>(slot.feature)].hasOwnCoordinates ||
                                 primitive.hasTexCoords(info.texCoord));
}

PrimitiveInputs withEveryAttribute(PrimitiveInputs primitive) {
    primitive.hasNormals = primitive.hasTangents = primitive.hasTexCoords0 = primitive.hasTexCoords1 = true;
    primitive.attributes = ~std::uint64_t{0};
    return primitive;
}

std::string missingAttribute(const Material& material, const PrimitiveInputs& primitive,
                             const Feature& feature) {
    const MaterialModel& model = material.model();
    const auto index = static_cast<int>(&feature - model.features.data());
    for (std::size_t i = 0; i < model.attributes.size(); ++i) {
        const VertexAttribute& attribute = model.attributes[i];
        if (attribute.feature == index && !attribute.fallback && (primitive.attributes >> i & 1U) == 0) {
            return fmt::format("the primitive has no {}", attribute.gltf);
        }
    }
    const bool hasUvs = feature.texture >= 0 && !feature.hasOwnCoordinates;
    const int set = hasUvs ? material.textures[static_cast<std::size_t>(feature.texture)].texCoord : 0;
    if (set > 1) {
        return fmt::format("it reads TEXCOORD_{}; Glint reads sets 0 and 1", set);
    }
    for (const int needed : {feature.needsTexCoord, hasUvs ? set : -1}) {
        if (needed >= 0 && !primitive.hasTexCoords(needed)) {
            return fmt::format("the primitive has no TEXCOORD_{}", needed);
        }
    }
    return {};
}

std::vector<std::pair<int, std::string>> lostInputs(const Material& material,
                                                    const PrimitiveInputs& primitive) {
    const MaterialModel& model = material.model();
    const auto featureAt = [&](int index) -> const Feature& {
        return model.features[static_cast<std::size_t>(index)];
    };
    FeatureMask asked = 0;
    for (const auto& [slot, info] : material.textures) {
        asked |= info.texture >= 0 ? featureAt(model.textures[slot].feature).mask() : FeatureMask();
    }
    for (const int object : material.given) {
        for (const int one : model.objects[static_cast<std::size_t>(object)].asksFor) {
            asked |= featureAt(one).mask();
        }
    }
    const std::vector<int> candidates = model.indicesOf(asked);
    FeatureMask excluded = 0;
    for (const int by : candidates) {
        for (const int exclusion : featureAt(by).exclusions) {
            excluded |= model.exclusions[static_cast<std::size_t>(exclusion)].excluded;
        }
    }
    const PrimitiveInputs whole = withEveryAttribute(primitive);
    const KeyOptions options{.alpha = package::AlphaPolicy::Stochastic};
    const MaterialFacts here(material, primitive, options, asked);
    const MaterialFacts there(material, whole, options, asked);
    const auto isNeutral = [&](const Feature& one, const MaterialFacts& facts) {
        return std::ranges::find_if(one.neutral, [&](const NeutralReason& reason) {
            return reason.countsIn(asked) && reason.when.holds(facts) == Certainty::True;
        });
    };
    std::vector<std::pair<int, std::string>> lost;
    for (const int index : candidates) {
        const Feature& feature = featureAt(index);
        const int texture = feature.texture;
        const bool isRead =
            texture < 0 || (material.textures[static_cast<std::size_t>(texture)].texture >= 0 &&
                            material.readsOf(texture).channels != 0);
        if (!isRead || excluded.has(feature.bit) || isNeutral(feature, there) != feature.neutral.end() ||
            (feature.lobe >= 0 &&
             isNeutral(featureAt(feature.lobe), there) != featureAt(feature.lobe).neutral.end())) {
            continue;
        }
        std::string missing = missingAttribute(material, primitive, feature);
        const auto reason = isNeutral(feature, here);
        if (missing.empty() && reason != feature.neutral.end()) {
            missing = reason->because;
        }
        if (!missing.empty()) {
            lost.emplace_back(index, std::move(missing));
        }
    }
    return lost;
}

const TextureContent& contentOf(const Material& material, const PrimitiveInputs& primitive, int texture) {
    static const TextureContent anything{.of = {kAnything, kAnything, kAnything, kAnything}};
    if (material.model().textures[static_cast<std::size_t>(texture)].dimension !=
        package::TextureEntry::Dimension::Flat) {
        return anything;
    }
    const auto seen = std::ranges::find(primitive.seen, texture, &SeenTexture::slot);
    return seen != primitive.seen.end() ? seen->content
                                        : material.textures[static_cast<std::size_t>(texture)].content;
}

MaterialFacts::MaterialFacts(const Material& material, const PrimitiveInputs& primitive,
                             const KeyOptions& options, const FeatureMask& key, Textures textures)
    : material_(material), primitive_(primitive), options_(options), key_(key), textures_(textures) {}

Channels MaterialFacts::number(int symbol) const {
    const MaterialModel& model = material_.model();
    if (symbol == model.symbolOf(Fact::Color)) {
        const bool varies = primitive_.colors == ColorContent::Varying;
        return {{ValueInterval{varies ? 0.0 : 1.0, 1.0}}, 1};
    }
    Channels number;
    if (symbol >= model.symbolOfTexel(0)) {
        const int texture = symbol - model.symbolOfTexel(0);
        number.count = 4;
        number.of.fill({1.0, 1.0});
        if (isReadable(material_, primitive_, texture)) {
            number.of.fill(model.anyTexel(texture));
            if (textures_ != Textures::Unknown) {
                number.of = contentOf(material_, primitive_, texture).of;
            }
        }
        return number;
    }
    const Parameter& parameter = model.parameters[static_cast<std::size_t>(symbol)];
    const bool scaled = textures_ != Textures::Ignored && parameter.scaledBy >= 0 &&
                        isReadable(material_, primitive_, parameter.scaledBy);
    assert(parameter.isNamedByConditions());
    number.count = parameter.numbers;
    const std::span<const double> values = material_.values.of(parameter);
    for (int i = 0; i < parameter.numbers; ++i) {
        const auto channelOfValue = static_cast<std::size_t>(i);
        ValueInterval& target = number.of[channelOfValue];
        target = material_.ranges.empty()
                     ? ValueInterval{values[channelOfValue], values[channelOfValue]}
                     : material_.ranges[static_cast<std::size_t>(parameter.first) + channelOfValue];
        const int channel = parameter.scaledByChannels[static_cast<std::size_t>(i)];
        if (scaled && textures_ == Textures::Scale && channel >= 0) {
            const TextureContent& content = contentOf(material_, primitive_, parameter.scaledBy);
            target = multiply(target, content.of[static_cast<std::size_t>(channel)]);
        } else if (scaled) {
            target = multiply(target, model.anyTexel(parameter.scaledBy));
        }
    }
    return number;
}

Certainty MaterialFacts::condition(int symbol) const {
    const MaterialModel& model = material_.model();
    if (symbol < model.symbolOfFeature(0)) {
        return fact(static_cast<Fact>(symbol - model.symbolOf(Fact::Normal)));
    }
    if (symbol < model.symbolOfTexture(0)) {
        const Feature& feature = model.features[static_cast<std::size_t>(symbol - model.symbolOfFeature(0))];
        return certain(key_.has(feature.bit));
    }
    if (symbol < model.symbolOfAttribute(0)) {
        return certain(isReadable(material_, primitive_, symbol - model.symbolOfTexture(0)));
    }
    if (symbol < model.symbolOfPair(0)) {
        const int attribute = symbol - model.symbolOfAttribute(0);
        return certain((primitive_.attributes >> static_cast<unsigned>(attribute) & 1U) != 0);
    }
    const std::array<int, 2>& pair = model.pairs[static_cast<std::size_t>(symbol - model.symbolOfPair(0))];
    return certain(sameTexture(material_.textures[static_cast<std::size_t>(pair[0])],
                               material_.textures[static_cast<std::size_t>(pair[1])]));
}

bool MaterialFacts::hasTangents() const {
    return primitive_.hasTangents && primitive_.hasNormals && !primitive_.derivesTangents;
}

// The frame of such a feature is that of the coordinates of the texture with the role TangentFrame, even if
// this texture changes nothing and is not in the key. Without a readable one, the frame is that of the first
// UV set that exists.
bool MaterialFacts::takesPlainFrame(const Feature& feature) const {
    const MaterialModel& model = material_.model();
    const int index = static_cast<int>(&feature - model.features.data());
    return feature.needsTangents && feature.texture < 0 && !anyInKey([&](const Feature& other) {
               return other.texture >= 0 && other.needsTangents && (other.lobe < 0 || other.lobe == index);
           });
}

const TextureInfo* MaterialFacts::plainFrameTexture() const {
    const int texture = material_.model().textureOf(package::Role::TangentFrame);
    return texture >= 0 && isReadable(material_, primitive_, texture)
               ? &material_.textures[static_cast<std::size_t>(texture)]
               : nullptr;
}

bool MaterialFacts::turnsTangents() const {
    const MaterialModel& model = material_.model();
    return anyInKey([&](const Feature& feature) {
        if (feature.texture >= 0) {
            // A lobe that needs a frame may take it from its own texture.
            const bool framed =
                feature.needsTangents ||
                (feature.lobe >= 0 && model.features[static_cast<std::size_t>(feature.lobe)].needsTangents);
            return framed && turnsFrame(material_.textures[static_cast<std::size_t>(feature.texture)]);
        }
        const TextureInfo* const plain = takesPlainFrame(feature) ? plainFrameTexture() : nullptr;
        return plain != nullptr && turnsFrame(*plain);
    });
}

template <typename Is>
bool MaterialFacts::anyInKey(const Is& is) const {
    const MaterialModel& model = material_.model();
    return std::ranges::any_of(model.indicesOf(key_), [&](int index) {
        return is(model.features[static_cast<std::size_t>(index)]);
    });
}

bool MaterialFacts::readsTexCoord(int set) const {
    return anyInKey([&](const Feature& feature) {
        if (feature.needsTexCoord == set) {
            return true;
        }
        if (feature.texture >= 0) {
            return !feature.hasOwnCoordinates &&
                   material_.textures[static_cast<std::size_t>(feature.texture)].texCoord == set;
        }
        if (!takesPlainFrame(feature) || hasTangents()) {
            return false;
        }
        const TextureInfo* const plain = plainFrameTexture();
        return set == (plain != nullptr ? plain->texCoord : primitive_.hasTexCoords0 ? 0 : 1);
    });
}

Certainty MaterialFacts::fact(Fact fact) const {
    const MaterialModel& model = material_.model();
    switch (fact) {
        case Fact::Normal:
            return certain(primitive_.hasNormals);
        case Fact::Tangent:
            return certain(primitive_.hasTangents);
        case Fact::TexCoord0:
            return certain(primitive_.hasTexCoords0);
        case Fact::TexCoord1:
            return certain(primitive_.hasTexCoords1);
        case Fact::GivesColors:
            return certain(primitive_.colors != ColorContent::None);
        case Fact::DoubleSided:
            return certain(material_.doubleSided);
        case Fact::Mask:
            return certain(material_.alphaMode == AlphaMode::Mask);
        case Fact::Blend:
            return certain(material_.alphaMode == AlphaMode::Blend);
        case Fact::RaysTestAlpha:
            return certain(options_.alpha != package::AlphaPolicy::Opaque);
        case Fact::RaysBlend:
            return certain(options_.alpha == package::AlphaPolicy::Stochastic);
        case Fact::ReadsTexCoord0:
            return certain(readsTexCoord(0));
        case Fact::ReadsTexCoord1:
            return certain(readsTexCoord(1));
        case Fact::MovesTextures:
            return certain(anyInKey([&](const Feature& feature) {
                return feature.texture >= 0 &&
                       isMoved(material_.textures[static_cast<std::size_t>(feature.texture)]);
            }));
        case Fact::GivesTransforms:
            return certain(std::ranges::any_of(material_.textures, [](const auto& slot) {
                return slot.second.hasTransform || isMoved(slot.second);
            }));
        case Fact::NeedsTangents:
            return certain(anyInKey([](const Feature& feature) { return feature.needsTangents; }));
        case Fact::DerivesTangents:
            return certain(primitive_.derivesTangents);
        case Fact::TurnsTangents:
            return certain(turnsTangents());
        case Fact::ChangesOpacity:
            return certain((key_ & model.opacity) != 0);
        case Fact::ModelOfPack:
            return certain(model.modelOf(key_) >= 0);
        case Fact::Color:
        case Fact::Count:
            break;
    }
    return Certainty::Unknown;
}

}  // namespace glint::materials
