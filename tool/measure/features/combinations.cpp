#include "gltf/scene_list.h"
#include "measure/features/checks.h"
#include "plan/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace glint::measure {

namespace {

// Where a declaration gives no limit, a value this many times the usual one stands for a large one.
constexpr double kFarFactor = 1000.0;

// Indices into checkedValues() for each parameter.
using Choice = std::vector<std::size_t>;

// A stream of bits that is the same on every machine.
std::uint32_t scrambled(std::uint32_t number) {
    number = (number ^ number >> 16U) * 0x7feb352dU;
    number = (number ^ number >> 15U) * 0x846ca68bU;
    return number ^ number >> 16U;
}

// The numbers of a parameter: one value for all channels, first the usual one, then the ends; then each
// channel of a vector at the greatest with the others at the least, or numbers of an array or a matrix that
// differ.
struct CheckedNumbers {
    std::vector<std::vector<double>> of;
    std::size_t ends = 0;  // those before the channels
};

CheckedNumbers numbersOf(const materials::Parameter& parameter) {
    CheckedNumbers numbers;
    const std::vector<double> values = checkedValues(parameter);
    const auto count = static_cast<std::size_t>(parameter.numbers);
    if (parameter.isNamedByConditions()) {
        for (const double value : values) {
            numbers.of.emplace_back(count, value);
        }
    } else {
        // Equal numbers make matrices that no one has, and arrays that need not be arrays.
        numbers.of.push_back(parameter.fallback);
    }
    numbers.ends = numbers.of.size();
    const double least = *std::ranges::min_element(values);
    const double greatest = *std::ranges::max_element(values);
    if (parameter.isVector()) {
        for (std::size_t channel = 0; count > 1 && channel < count; ++channel) {
            numbers.of.emplace_back(count, least);
            numbers.of.back()[channel] = greatest;
        }
        return numbers;
    }
    constexpr std::uint32_t kDraws = 4;
    for (std::uint32_t draw = 0; !parameter.isNamedByConditions() && draw < kDraws; ++draw) {
        std::vector<double>& drawn = numbers.of.emplace_back();
        for (std::uint32_t i = 0; i < count; ++i) {
            const double share = scrambled(draw * 65536U + i + 1) / 4294967295.0;
            drawn.push_back(parameter.hold(least + share * (greatest - least)));
        }
    }
    return numbers;
}

// The usual values, then each parameter at its ends and each of its channels by itself, then corners of all
// ranges.
std::vector<Choice> choicesOf(const std::vector<CheckedNumbers>& values, std::uint32_t most) {
    const std::size_t count = values.size();
    std::vector<Choice> choices{Choice(count, 0)};
    for (const bool channels : {false, true}) {
        for (std::size_t parameter = 0; parameter < count; ++parameter) {
            const CheckedNumbers& numbers = values[parameter];
            const std::size_t end = channels ? numbers.of.size() : numbers.ends;
            for (std::size_t value = channels ? numbers.ends : 1; value < end; ++value) {
                Choice choice(count, 0);
                choice[parameter] = value;
                choices.push_back(std::move(choice));
            }
        }
    }
    for (std::uint32_t corner = 0; corner < most; ++corner) {
        // All at their greatest, all at their least, then others.
        const std::uint32_t bits = corner == 0 ? ~0U : corner == 1 ? 0U : scrambled(corner);
        Choice choice;
        for (std::size_t parameter = 0; parameter < count; ++parameter) {
            const std::size_t ends = values[parameter].ends - 1;
            choice.push_back(ends == 0 ? 0 : 1 + (bits >> parameter % 32 & 1U) % ends);
        }
        choices.push_back(std::move(choice));
    }
    return choices;
}

// The parts of one feature's combinations.
struct Ingredients {
    std::vector<const materials::Parameter*> parameters;
    std::vector<CheckedNumbers> values;
    std::vector<const materials::MaterialTexture*> textures;
};

Ingredients ingredientsOf(const materials::MaterialModel& model, const materials::FeatureCode& code) {
    Ingredients found;
    for (const materials::Parameter& parameter : model.parameters) {
        if (parameter.feature == code.feature && code.feature >= 0 && parameter.aliasOf < 0) {
            found.parameters.push_back(&parameter);
            found.values.push_back(numbersOf(parameter));
        }
    }
    for (const materials::MaterialTexture& texture : model.textures) {
        if (model.features[static_cast<std::size_t>(texture.feature)].lobe == code.feature) {
            found.textures.push_back(&texture);
        }
    }
    return found;
}

// The bases that layers of packs lie over, and Glint's own that is checked beside models, are glTF's.
constexpr const char* kMetallic = "metallicFactor";
constexpr const char* kRoughness = "roughnessFactor";

materials::Material baseMaterial(const materials::MaterialModel& model, int number) {
    const CheckedBase& base = kCheckedBases[number];
    materials::Material material(model);
    material[kMetallic] = base.metallic;
    material[kRoughness] = base.roughness;
    return material;
}

// Textures of each dimension, by its number, whose texels are at the ends of the range and between, as they
// come from files.
void addCheckedTextures(gltf::Scene& scene) {
    constexpr int kSide = 8;
    gltf::Image image;
    image.name = "checked";
    image.width = kSide;
    image.height = kSide;
    for (std::uint32_t i = 0; i < 4U * kSide * kSide; ++i) {
        const std::uint32_t bits = scrambled(i + 1);
        image.pixels.push_back(static_cast<std::uint8_t>(bits % 4 == 0   ? 0
                                                         : bits % 4 == 1 ? 255
                                                                         : bits >> 24U));
    }
    scene.images.push_back(std::move(image));
    gltf::Sampler sampler;
    sampler.mipmapped = false;
    scene.samplers.push_back(sampler);
    scene.textures.push_back({0, 0});
    // One of each other dimension with the same texels.
    using package::TextureEntry;
    for (const auto& [dimension, layers] : {std::pair(TextureEntry::Dimension::Array, 4),
                                            {TextureEntry::Dimension::Cube, 6},
                                            {TextureEntry::Dimension::Volume, 8}}) {
        gltf::Image other = scene.images.front();
        other.dimension = dimension;
        other.layers = layers;
        for (int layer = 1; layer < layers; ++layer) {
            const std::vector<std::uint8_t>& first = scene.images.front().pixels;
            other.pixels.insert(other.pixels.end(), first.begin(), first.end());
        }
        scene.textures.push_back({static_cast<int>(scene.images.size()), 0});
        scene.images.push_back(std::move(other));
    }
}

// A square of two metres in the plane z = 0, whose front faces +Z.
gltf::Primitive squareOf(int material, const materials::MaterialModel& model, bool isRich) {
    gltf::Primitive square;
    if (isRich) {
        square.texCoords1 = {{0.25F, 0.5F}, {0.75F, 0.5F}, {0.75F, 0.25F}, {0.25F, 0.25F}};
        square.colors = {{1, 1, 1, 1}, {0.5F, 1, 1, 1}, {1, 0.5F, 1, 1}, {1, 1, 0.5F, 1}};
    }
    for (const materials::VertexAttribute& attribute : model.attributes) {
        if (std::ranges::find(square.attributes, attribute.gltf, &gltf::VertexValues::name) !=
            square.attributes.end()) {
            continue;
        }
        gltf::VertexValues& given = square.attributes.emplace_back();
        given.name = attribute.gltf;
        given.channels = static_cast<std::uint32_t>(attribute.type->channels);
        for (std::uint32_t i = 0; i < 4 * given.channels; ++i) {
            given.values.push_back(static_cast<float>(scrambled(i + 1) % 5) / 4.0F);
        }
    }
    square.pointer = fmt::format("/meshes/{}/primitives/0", material);
    square.material = material;
    square.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    square.normals.assign(4, {0, 0, 1});
    square.tangents.assign(4, {1, 0, 0, 1});
    square.texCoords0 = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    square.indices = {0, 1, 2, 0, 2, 3};
    return square;
}

std::uint32_t addSquare(gltf::Scene& scene, const materials::Material& material, bool isRich = false) {
    const auto number = static_cast<int>(scene.materials.size());
    scene.materials.push_back(material);
    scene.meshes.push_back({{}, {squareOf(number, material.model(), isRich)}});
    gltf::Node node;
    node.mesh = number;
    for (const std::size_t diagonal : {0U, 5U, 10U, 15U}) {
        node.world[diagonal] = 1.0;
    }
    scene.nodes.push_back(std::move(node));
    return static_cast<std::uint32_t>(number);
}

// Returns whether the square's key has the feature.
bool hasFeature(const materials::Material& material, int feature, bool isRich) {
    materials::PrimitiveInputs inputs;
    inputs.hasNormals = true;
    inputs.hasTangents = true;
    inputs.hasTexCoords0 = true;
    inputs.hasTexCoords1 = isRich;
    inputs.colors = isRich ? materials::ColorContent::Varying : inputs.colors;
    inputs.attributes = ~std::uint64_t{0};
    return feature < 0 || compiler::makeKey(material, inputs, {})
                              .has(material.model().features[static_cast<std::size_t>(feature)].bit);
}

// One combination, before it is known whether its key has the feature.
struct Combined {
    materials::Material material;
    CheckPlace place;
};

Combined combine(const materials::MaterialModel& model, const materials::FeatureCode& code,
                 const Ingredients& ingredients, const Choice& choice, int base, bool textured, bool isRich) {
    Combined made{baseMaterial(model, base), {}};
    made.material.alphaMode = isRich                 ? materials::AlphaMode::Blend
                              : code.opacity.empty() ? materials::AlphaMode::Opaque
                                                     : materials::AlphaMode::Mask;
    made.material.doubleSided = isRich;
    made.place.base = fmt::format("{}{}{}", isRich ? "double-sided, blended " : "", kCheckedBases[base].name,
                                  isRich ? " with vertex colours and UV 1" : "");
    for (std::size_t i = 0; i < choice.size(); ++i) {
        const materials::Parameter& parameter = *ingredients.parameters[i];
        const std::vector<double>& numbers = ingredients.values[i].of[choice[i]];
        made.material[parameter.name] = std::span(numbers);
        made.place.parameters.emplace_back(parameter.name,
                                           std::vector<float>(numbers.begin(), numbers.end()));
    }
    const int object = code.feature < 0 ? -1 : model.features[static_cast<std::size_t>(code.feature)].object;
    if (object >= 0) {
        made.material.give(model.objects[static_cast<std::size_t>(object)].name);
    }
    if (textured) {
        for (const materials::MaterialTexture* const texture : ingredients.textures) {
            made.material.texture(texture->name).texture = static_cast<int>(texture->dimension);
            made.material.texture(texture->name).texCoord = isRich ? 1 : 0;
        }
        made.place.parameters.emplace_back("textures", std::vector<float>{1.0F});
    }
    return made;
}

std::vector<CheckedMaterial> addCombinations(const materials::MaterialModel& model,
                                             const materials::FeatureCode& code, std::uint32_t most,
                                             gltf::Scene& scene) {
    const Ingredients ingredients = ingredientsOf(model, code);
    std::vector<CheckedMaterial> made;
    std::set<Choice> known;
    for (const Choice& choice : choicesOf(ingredients.values, most)) {
        if (made.size() == most) {
            break;
        }
        if (!known.insert(choice).second) {
            continue;
        }
        // Bases take turns. Textures are there in every second pair. Where the feature would change nothing,
        // the other bases are tried.
        const int bases = static_cast<int>(std::size(kCheckedBases));
        const int firstBase = static_cast<int>(made.size()) % bases;
        const bool firstTextured = !ingredients.textures.empty() && made.size() / 2 % 2 == 1;
        bool found = false;
        for (int attempt = 0; attempt < 2 * bases && !found; ++attempt) {
            const int base = (firstBase + attempt) % bases;
            const bool textured = firstTextured != (attempt >= bases && !ingredients.textures.empty());
            const bool isRich = attempt == 0 && made.size() % 3 == 1;
            Combined combined = combine(model, code, ingredients, choice, base, textured, isRich);
            found = hasFeature(combined.material, code.feature, isRich);
            if (found) {
                made.push_back(
                    {addSquare(scene, combined.material, isRich), base, isRich, std::move(combined.place)});
            }
        }
    }
    return made;
}

// Glint's own base, in some of its shapes.
std::vector<CheckedMaterial> addBases(const materials::MaterialModel& model,
                                      const materials::FeatureCode& code, std::uint32_t most,
                                      gltf::Scene& scene) {
    constexpr std::array<std::array<float, 2>, 4> kShapes{
        {{0.0F, 0.3F}, {0.5F, 0.6F}, {1.0F, 0.2F}, {0.0F, 1.0F}}};
    std::vector<CheckedMaterial> made;
    for (const auto& [metallic, roughness] :
         std::span(kShapes).first(std::min<std::size_t>(most, kShapes.size()))) {
        const bool isRich = made.size() % 3 == 1;
        Combined combined = combine(model, code, {}, {}, 0, false, isRich);
        combined.material[kMetallic] = metallic;
        combined.material[kRoughness] = roughness;
        combined.place.parameters = {{kMetallic, {metallic}}, {kRoughness, {roughness}}};
        made.push_back({addSquare(scene, combined.material, isRich), 0, isRich, std::move(combined.place)});
    }
    return made;
}

}  // namespace

std::vector<double> checkedValues(const materials::Parameter& parameter) {
    const double fallback = parameter.fallback[0];
    if (parameter.type->isAddress()) {
        return {fallback};
    }
    if (parameter.type->kind == materials::NumberKind::Truth ||
        parameter.type->kind == materials::NumberKind::Name) {
        std::vector<double> values{fallback};
        for (int i = 0; parameter.low + i <= parameter.high; ++i) {
            if (parameter.low + i != fallback) {
                values.push_back(parameter.low + i);
            }
        }
        return values;
    }
    const bool hasLow = std::isfinite(parameter.low) && parameter.low > -1e30;
    const bool hasHigh = std::isfinite(parameter.high) && parameter.high < 1e30;
    if (parameter.isAngle && !hasLow && !hasHigh) {
        return {0.4F, 0.0, 2.5};
    }
    double usual = fallback;
    if (hasLow && hasHigh && (fallback <= parameter.low || fallback >= parameter.high)) {
        usual = 0.5 * (parameter.low + parameter.high);
    } else if (!std::isfinite(fallback) || (fallback == 0.0 && !(hasLow && hasHigh))) {
        usual = hasLow ? parameter.low + 1.0 : hasHigh ? parameter.high - 1.0 : 1.0;
    }
    const double least = hasLow ? parameter.low : -kFarFactor * std::max(std::abs(usual), 1.0);
    const double greatest = hasHigh ? parameter.high : kFarFactor * std::max(std::abs(usual), 1.0);
    std::vector<double> values{parameter.hold(usual)};
    for (const double end : {least, greatest}) {
        if (std::ranges::find(values, parameter.hold(end)) == values.end()) {
            values.push_back(parameter.hold(end));
        }
    }
    return values;
}

Result<CheckedScene> makeCheckedScene(const materials::MaterialModel& model, std::uint32_t combinations) {
    CheckedScene made;
    made.scene.path = "check-materials";
    addCheckedTextures(made.scene);
    for (int base = 0; base < static_cast<int>(std::size(kCheckedBases)); ++base) {
        materials::Material material = baseMaterial(model, base);
        material.doubleSided = true;  // It is also seen from behind.
        made.bases.push_back(addSquare(made.scene, material));
    }
    const auto base = std::ranges::find(model.code, model.plainBase, &materials::FeatureCode::name);
    if (base != model.code.end()) {
        made.features.push_back({&*base, addBases(model, *base, combinations, made.scene)});
    }
    for (const materials::FeatureCode& code : model.code) {
        if (!code.isOfPack) {
            continue;
        }
        CheckedFeature feature{&code, addCombinations(model, code, combinations, made.scene)};
        if (feature.materials.empty()) {
            return makeError(
                "check-unreachable", code.declaration,
                fmt::format("{} changes nothing for any combination of its parameters' values that was tried",
                            code.name),
                "look at its \"neutral\" and the ranges of its parameters");
        }
        made.features.push_back(std::move(feature));
    }
    return made;
}

}  // namespace glint::measure
