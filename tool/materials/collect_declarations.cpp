// Collects everything that has a name in declarations: features, parameters, textures, attributes.
#include "materials/model_builder.h"

#include <algorithm>
#include <cctype>
#include <utility>

namespace glint::materials {

namespace {

constexpr std::string_view kTexelLetters = "rgba";

// The costs of features of packs that do not say it: the medians of Glint's own.
constexpr FeatureCost kUsualLobe{253.0, 0.0};
constexpr FeatureCost kUsualInput{35.0, 0.0};
constexpr FeatureCost kUsualTexture{39.0, 1.0};

// "clearcoatRoughnessTexture" becomes "CLEARCOAT_ROUGHNESS_TEXTURE", and "texCoord0" "TEX_COORD_0".
std::string macroCase(std::string_view name) {
    std::string macro;
    bool wasDigit = false;
    for (const char c : name) {
        const bool isDigit = std::isdigit(static_cast<unsigned char>(c)) != 0;
        const bool begins = std::isupper(static_cast<unsigned char>(c)) != 0 || (isDigit && !wasDigit);
        macro += begins ? "_" : "";
        macro += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
        wasDigit = isDigit;
    }
    return macro;
}

}  // namespace

int ModelBuilder::addFeature(const Members& members, Feature feature, Light light) {
    // Glint's shaders have many macros of their own, which a name of a pack must not meet.
    feature.macro = (isOfPack_ ? "GLINT_PACK" : "GLINT") + macroCase("_" + feature.name);
    feature.about = members.text("about", "");
    feature.isInDraft = members.flag("draft", false);
    std::string capital = feature.name;
    capital[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(capital[0])));
    feature.shortName = members.text("short", capital);
    readNeeds(members, feature);
    if (members.has("cost")) {
        const Members cost(members["cost"], members.at("cost"), Place::Cost);
        feature.cost = {cost.number("instructions", 0.0), cost.number("fetches", 0.0)};
        for (const auto& [member, value] : {std::pair("instructions", feature.cost.instructions),
                                            std::pair("fetches", feature.cost.fetches)}) {
            if (!(value >= 0.0 && value < kUnlimited)) {
                failAt(cost.at(member), "must be a finite number from 0");
            }
        }
    } else if (isOfPack_) {
        feature.cost = feature.texture >= 0 ? kUsualTexture : isLobe(feature) ? kUsualLobe : kUsualInput;
    }
    pending_.push_back(
        {std::move(feature), members.number("order", kNoOrder), members.where(), light, isOfPack_, base_});
    return static_cast<int>(pending_.size()) - 1;
}

void ModelBuilder::readNeeds(const Members& members, Feature& feature) {
    if (!members.has("needs")) {
        return;
    }
    const std::vector<std::string> needs =
        members["needs"].is_array() ? members.texts("needs") : std::vector{members.text("needs")};
    if (needs.empty()) {
        failAt(members.at("needs"), "names nothing");
    }
    for (const std::string& need : needs) {
        const int set = choose(kNeeds, members, "needs", need).texCoord;
        if (set >= 0 && feature.needsTexCoord >= 0 && feature.needsTexCoord != set) {
            failAt(members.at("needs"), "a feature can read one UV set beyond those of its textures");
        }
        feature.needsTangents = feature.needsTangents || set < 0;
        feature.needsTexCoord = std::max(feature.needsTexCoord, set);
    }
}

void ModelBuilder::checkOwn(const Members& members, const Feature& feature) {
    if (feature.object < 0 && members.list("neutral").empty()) {
        failAt(members.where(), "every material would have its feature, as no reason leaves it out",
               "give the declaration \"extension\", or a reason in \"neutral\"");
    }
    for (const char* const ofLobes : {"light", "ofBase"}) {
        if (members.has(ofLobes) && !isLobe(feature)) {
            failAt(members.at(ofLobes), "is for lobes", "make \"stage\" \"layer\" or \"base\"");
        }
    }
}

void ModelBuilder::collect(File& file) {
    isOfPack_ = file.isOfPack;
    base_ = -1;
    const Members members = membersOf(file);
    const std::string name = newName(members);
    const std::string stageName = members.text("stage");
    const Stage stage = choose(kStages, members, "stage", stageName).stage;
    file.object = members.has("extension") ? addObject(members.text("extension"), true)
                  : members.has("object")  ? addObject(members.text("object"), false)
                                           : 0;
    if (members.has("neutral") || members.has("extension")) {
        Feature feature;
        feature.name = name;
        feature.stage = stage;
        feature.object = members.has("extension") ? file.object : -1;
        feature.gltf = members.text("gltf", gltfPlace(file.object, ""));
        feature.isOfBase = members.flag("ofBase", false);
        checkOwn(members, feature);
        const Light light = choose(kLights, members, "light", members.text("light", "front")).light;
        base_ = isOfPack_ && stage == Stage::Base ? static_cast<int>(pending_.size()) : -1;
        file.mainFeature = addFeature(members, std::move(feature), light);
    }
    for (const auto& [json, where] : members.list("parameters")) {
        const Members parameter(*json, where, Place::Parameter);
        if (!parameter.has("is")) {
            addParameter(file, parameter);
        }
    }
    for (const auto& [json, where] : members.list("textures")) {
        const Members texture(*json, where, Place::Texture);
        if (!texture.has("is")) {
            addTexture(file, texture);
        }
    }
    for (const auto& [json, where] : members.list("attributes")) {
        addAttribute(file, Members(*json, where, Place::Attribute));
    }
    for (const auto& [json, where] : members.list("features")) {
        const Members further(*json, where, Place::Feature);
        Feature feature;
        feature.name = newName(further);
        feature.stage = further.has("stage") ? choose(kStages, further, "stage", further.text("stage")).stage
                        : stage == Stage::Layer || stage == Stage::Base ? Stage::Surface
                                                                        : stage;
        feature.gltf = further.text("gltf");
        addFeature(further, std::move(feature), Light::Front);
    }
}

Parameter ModelBuilder::makeParameter(const File& file, const Members& members, const std::string& name,
                                      int channels) {
    Parameter parameter;
    parameter.name = name;
    parameter.object = file.object;
    parameter.place = members.text("at", name);
    parameter.unit = members.text("unit", "");
    parameter.about = members.text("about", "");
    parameter.isAngle = parameter.unit == "radians";
    parameter.channels = channels;
    parameter.inRecord = members.flag("record", true);
    parameter.low = -kLargestFloat;
    parameter.high = kLargestFloat;
    if (members.has("range")) {
        if (parameter.isAngle) {
            failAt(members.at("range"), "angles are held between half a turn either way, whatever the range",
                   "leave it out");
        }
        const auto range = members.list("range");
        if (range.size() != 2) {
            failAt(members.at("range"), "must be the least and the greatest value; null means no limit");
        }
        parameter.low =
            range[0].first->is_null() ? -kLargestFloat : Members::toNumber(*range[0].first, range[0].second);
        parameter.high =
            range[1].first->is_null() ? kLargestFloat : Members::toNumber(*range[1].first, range[1].second);
        if (!(parameter.low <= parameter.high)) {
            failAt(members.at("range"), "the least value is above the greatest");
        }
    }
    if (members.has("also")) {
        const auto also = members.list("also");
        if (also.size() != 1) {
            failAt(members.at("also"), "must be one further value");
        }
        parameter.also = Members::toNumber(*also[0].first, also[0].second);
        if (*parameter.also >= parameter.low && *parameter.also <= parameter.high) {
            failAt(members.at("also"), "is within the range, so that it is valid anyway", "leave it out");
        }
    }
    readDefault(members, parameter);
    return parameter;
}

void ModelBuilder::readDefault(const Members& members, Parameter& parameter) {
    const DeclarationJson& fallback = members["default"];
    const bool isList = fallback.is_array();
    if (isList ? fallback.size() != static_cast<std::size_t>(parameter.channels) : parameter.channels != 1) {
        failAt(members.at("default"), fmt::format("must have {} numbers", parameter.channels));
    }
    for (int i = 0; i < parameter.channels; ++i) {
        const DeclarationJson& value = isList ? fallback[static_cast<std::size_t>(i)] : fallback;
        const double number = Members::toNumber(value, members.at("default"));
        if (number != parameter.also && !(number >= parameter.low && number <= parameter.high)) {
            failAt(members.at("default"), "is outside of the range");
        }
        parameter.fallback[static_cast<std::size_t>(i)] = static_cast<float>(number);
    }
}

void ModelBuilder::addParameter(const File& file, const Members& members) {
    // A parameter may have the name of its feature: "dispersion". The JSON stands on the left, because
    // nlohmann-json 3.11.3 (Debian 13) compares it with a string in that order only.
    std::string name = members.text("name");
    if (file.json["name"] != name) {
        name = newName(members);
    }
    refuseWordOfGlsl(members);
    const auto& type = choose(kTypes, members, "type", members.text("type"));
    Parameter parameter = makeParameter(file, members, name, type.channels);
    parameter.type = type.glsl;
    parameter.first = model_.valueCount;
    model_.valueCount += parameter.channels;
    if (model_.findParameter(name) >= 0) {
        failAt(members.at("name"), fmt::format("\"{}\" is declared twice", name));
    }
    model_.parameters.push_back(std::move(parameter));
}

void ModelBuilder::addAttribute(const File& file, const Members& members) {
    VertexAttribute attribute;
    attribute.name = newName(members);
    refuseWordOfGlsl(members);
    attribute.gltf = members.text("at");
    attribute.about = members.text("about", "");
    const auto& type = choose(kTypes, members, "type", members.text("type"));
    attribute.type = type.glsl;
    attribute.channels = type.channels;
    attribute.feature = file.mainFeature;
    // Attributes of an application begin with an underscore: glTF 2.0, section 3.7.2.1.
    if (attribute.gltf.size() < 2 || attribute.gltf.front() != '_') {
        failAt(members.at("at"),
               fmt::format("\"{}\" must begin with an underscore, as glTF wants it of attributes "
                           "that are not its own",
                           attribute.gltf));
    }
    if (members.has("default")) {
        Parameter value;
        value.channels = attribute.channels;
        value.low = -kLargestFloat;
        value.high = kLargestFloat;
        readDefault(members, value);
        attribute.fallback = value.fallback;
    }
    for (const VertexAttribute& other : model_.attributes) {
        if (other.gltf == attribute.gltf && other.channels != attribute.channels) {
            failAt(members.at("type"),
                   fmt::format("{} has {} channels here and {} for \"{}\"", attribute.gltf,
                               attribute.channels, other.channels, other.name));
        }
    }
    if (model_.attributes.size() == kMostVertexAttributes) {
        failAt(members.where(),
               fmt::format("there are more than {} attributes of vertices", kMostVertexAttributes));
    }
    model_.attributes.push_back(std::move(attribute));
}

// "g" is a channel of roughness, "1 - a" one of glossiness.
void ModelBuilder::readRoughness(const Members& members, TextureReads& reads) {
    if (!members.has("roughness")) {
        return;
    }
    const std::string text = members.text("roughness");
    constexpr std::string_view kInverse = "1 - ";
    const bool isInverse = text.starts_with(kInverse);
    const std::string_view letter = std::string_view(text).substr(isInverse ? kInverse.size() : 0);
    const std::size_t channel = letter.size() == 1 ? kTexelLetters.find(letter) : std::string_view::npos;
    if (channel == std::string_view::npos) {
        failAt(
            members.at("roughness"),
            fmt::format("\"{}\" is neither one of the channels \"rgba\" nor \"1 - \" and a channel", text));
    }
    const std::uint32_t bit = 1U << channel;
    if ((reads.channels & bit) == 0 || reads.isNormals) {
        failAt(members.at("roughness"), "must be a channel that \"reads\" names");
    }
    if (members.flag("color", false) && channel < 3) {
        failAt(members.at("roughness"),
               "must be alpha in a texture of colours, because the others are in sRGB");
    }
    (isInverse ? reads.glossiness : reads.roughness) = bit;
}

TextureReads ModelBuilder::readsOfTexture(const Members& members) {
    TextureReads reads;
    if (!members.has("reads")) {
        readRoughness(members, reads);
        return reads;
    }
    const std::string text = members.text("reads");
    if (text == "normal") {
        reads.channels = 7;
        reads.isNormals = true;
        readRoughness(members, reads);
        return reads;
    }
    reads.channels = 0;
    for (const char letter : text) {
        const std::size_t channel = kTexelLetters.find(letter);
        const std::uint32_t bit = channel == std::string_view::npos ? 0U : 1U << channel;
        if (bit == 0 || bit <= reads.channels) {
            failAt(members.at("reads"),
                   fmt::format("\"{}\" is neither \"normal\" nor some of the channels \"rgba\" in this order",
                               text));
        }
        reads.channels |= bit;
    }
    readRoughness(members, reads);
    return reads;
}

void ModelBuilder::addTexture(const File& file, const Members& members) {
    MaterialTexture texture;
    texture.name = newName(members);
    texture.places.push_back(
        {file.object, texture.name, members.flag("color", false), readsOfTexture(members)});
    Feature feature;
    feature.name = texture.name;
    feature.gltf = gltfPlace(file.object, texture.name);
    feature.texture = static_cast<int>(model_.textures.size());
    if (members.has("coordinates")) {
        if (members.text("coordinates") != "own") {
            failAt(members.at("coordinates"), "the only other coordinates are \"own\"");
        }
        feature.hasOwnCoordinates = true;
    }
    texture.feature = addFeature(members, std::move(feature), Light::Front);
    model_.textures.push_back(std::move(texture));
}

void ModelBuilder::collectAliases(const File& file) {
    const Members members = membersOf(file);
    for (const auto& [json, where] : members.list("parameters")) {
        const Members alias(*json, where, Place::Parameter);
        if (!alias.has("is")) {
            continue;
        }
        const std::string name = newName(alias);
        const int target = model_.findParameter(alias.text("is"));
        if (target < 0) {
            failAt(alias.at("is"), fmt::format("there is no parameter \"{}\"", alias.text("is")));
        }
        const Parameter& original = model_.parameters[static_cast<std::size_t>(target)];
        Parameter parameter = original;
        parameter.name = name;
        parameter.object = file.object;
        parameter.place = alias.text("at", name);
        parameter.aliasOf = target;
        parameter.inRecord = false;
        readDefault(alias, parameter);
        model_.parameters.push_back(std::move(parameter));
    }
    for (const auto& [json, where] : members.list("textures")) {
        const Members alias(*json, where, Place::Texture);
        if (alias.has("is")) {
            const std::string name = newName(alias);
            textureNamed(alias, "is")
                .places.push_back({file.object, name, alias.flag("color", false), readsOfTexture(alias)});
        }
    }
}

MaterialTexture& ModelBuilder::textureNamed(const Members& members, std::string_view member) {
    const int found = model_.findTexture(members.text(member));
    if (found < 0) {
        failAt(members.at(member), fmt::format("there is no texture \"{}\"", members.text(member)));
    }
    return model_.textures[static_cast<std::size_t>(found)];
}

}  // namespace glint::materials
