// Collects everything that has a name in declarations: features, parameters, textures, attributes.
#include "materials/model_builder.h"
#include "materials/value_json.h"

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

// Whether a default is that of every element of an array.
bool isOneElement(const Parameter& parameter, const DeclarationJson& json) {
    return parameter.type->channels == 1 ? !json.is_array()
                                         : json.is_array() && !json.empty() && !json[0].is_array();
}

}  // namespace

void ModelBuilder::findRoles() {
    for (const bool isOfPack : {false, true}) {
        for (const File& file : files_) {
            if (file->isOfPack != isOfPack) {
                continue;
            }
            for (const Members& parameter : file->parameters) {
                findRole(parameter, Place::Parameter);
            }
            for (const Members& texture : file->textures) {
                findRole(texture, Place::Texture);
            }
            for (const Members& feature : file->features) {
                findRole(feature, Place::Feature);
            }
        }
    }
}

void ModelBuilder::findRole(const Members& members, Place place) {
    const package::Role role = roleOf(members);
    if (role == package::Role::None) {
        return;
    }
    const NamedRole& row = *std::ranges::find(kRoles, role, &NamedRole::role);
    if ((row.places & placeBit(place)) == 0) {
        failAt(members.at("role"), fmt::format("\"{}\" is the role of something else", row.name));
    }
    const auto [holder, isFirst] = roles_.try_emplace({role, place}, members.where());
    if (isFirst && place == Place::Parameter && members.text("type", "") != row.type) {
        failAt(members.at("role"),
               fmt::format("a parameter with the role \"{}\" has the type {}", row.name, row.type));
    }
    if (!isFirst && place == Place::Feature) {
        failAt(members.at("role"), fmt::format("{} has the role already", holder->second));
    }
}

package::Role ModelBuilder::roleOf(const Members& members) {
    return members.has("role") ? choose(kRoles, members, "role", members.text("role")).role
                               : package::Role::None;
}

bool ModelBuilder::fills(const Members& members, Place place) const {
    const package::Role role = roleOf(members);
    const bool byRole = role != package::Role::None && roles_.at({role, place}) != members.where();
    if (!byRole) {
        return members.has("is");
    }
    for (const MemberRule& rule : memberRules()) {
        // A role that fills refuses the members that "is" refuses.
        for (const MemberRow& row : memberRows()) {
            if (rule.place == place && rule.without == "is" && hasWord(rule.members, row.name) &&
                members.has(row.name)) {
                failAt(members.at(row.name), std::string(rule.message), std::string(rule.hint));
            }
        }
    }
    return true;
}

int ModelBuilder::addFeature(const Members& members, Feature feature, Light light) {
    // Glint's shaders have many macros of their own, which a name of a pack must not meet.
    feature.macro = (isOfPack_ ? "GLINT_PACK" : "GLINT") + macroCase("_" + feature.name);
    feature.about = members.text("about", "");
    feature.isInDraft = members.flag("draft", false);
    feature.shortName = members.text("short", capitalized(feature.name));
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
    model_.indexNames();
    isOfPack_ = file->isOfPack;
    base_ = -1;
    scope_.clear();
    const Members& members = *file->members;
    const std::string name = newName(members);
    const std::string stageName = members.text("stage");
    const Stage stage = choose(kStages, members, "stage", stageName).stage;
    file.object = members.has("extension") ? addObject(members.text("extension"), true)
                  : members.has("object")  ? addObject(members.text("object"), false)
                                           : 0;
    if (members.has("object") && !isOfPack_) {
        model_.plainBase = name;
    }
    if (members.has("neutral") || members.has("extension")) {
        Feature feature;
        feature.name = name;
        feature.stage = stage;
        feature.object = members.has("extension") ? file.object : -1;
        feature.gltf = members.text("gltf", gltfPlace(file.object, ""));
        feature.isOfBase = members.flag("ofBase", false);
        checkOwn(members, feature);
        const Light light = choose(kLights, members, "light", members.text("light", "front")).light;
        const bool isModel = isOfPack_ && stage == Stage::Base;
        base_ = isModel ? static_cast<int>(pending_.size()) : -1;
        file.scope = scope_ = isModel ? name : "";
        file.mainFeature = addFeature(members, std::move(feature), light);
    }
    for (const Members& parameter : file->parameters) {
        if (!fills(parameter, Place::Parameter)) {
            addParameter(file, parameter);
        }
    }
    for (const Members& texture : file->textures) {
        if (!fills(texture, Place::Texture)) {
            addTexture(file, texture);
        }
    }
    for (const Members& attribute : file->attributes) {
        addAttribute(file, attribute);
    }
    for (const Members& further : file->features) {
        Feature feature;
        feature.name = newName(further);
        feature.role = roleOf(further);
        feature.stage = further.has("stage") ? choose(kStages, further, "stage", further.text("stage")).stage
                        : stage == Stage::Layer || stage == Stage::Base ? Stage::Surface
                                                                        : stage;
        feature.gltf = further.text("gltf");
        addFeature(further, std::move(feature), Light::Front);
    }
}

const ValueType& ModelBuilder::vectorType(const Members& members) {
    const ValueType& type = choose(kTypes, members, "type", members.text("type"));
    if (!type.isVector()) {
        failAt(members.at("type"),
               fmt::format("must be a number or a vector of floats, and not \"{}\"", type.name),
               "use float, vec2, vec3, color or vec4");
    }
    return type;
}

void ModelBuilder::readType(const Members& members, Parameter& parameter) {
    parameter.type = &choose(kTypes, members, "type", members.text("type"));
    const bool isEnum = parameter.type->kind == NumberKind::Name;
    parameter.names = members.texts("values");
    if (isEnum == parameter.names.empty()) {
        failAt(
            members.has("values") ? members.at("values") : members.where(),
            isEnum ? "an enum has names: \"values\" must list them" : "lists names, which enums alone have",
            isEnum ? "write \"values\": [\"soft\", \"hard\"]" : "make the type \"enum\", or leave them out");
    }
    if (members.has("count")) {
        const double count = members.number("count", 0.0);
        if (!(count >= 1.0 && count <= kMostElements) || count != std::trunc(count)) {
            failAt(members.at("count"), fmt::format("must be a whole number from 1 to {}", kMostElements));
        }
        parameter.count = static_cast<int>(count);
    }
    parameter.numbers = parameter.type->channels * std::max(parameter.count, 1);
    if (parameter.isAngle && !parameter.type->isVector()) {
        failAt(members.at("unit"), "angles are numbers or vectors of floats");
    }
}

void ModelBuilder::readRange(const Members& members, Parameter& parameter) {
    const NumberKind kind = parameter.type->kind;
    const double least = leastOf(kind);
    const double greatest = greatestOf(kind, parameter.names.size());
    parameter.low = least;
    parameter.high = greatest;
    if (members.has("range")) {
        if (!parameter.type->hasRange()) {
            failAt(members.at("range"),
                   fmt::format("is for numbers, and this is a value of \"{}\"", parameter.type->name),
                   "leave it out");
        }
        if (parameter.isAngle) {
            failAt(members.at("range"), "angles are held between half a turn either way, whatever the range",
                   "leave it out");
        }
        const auto range = members.list("range");
        if (range.size() != 2) {
            failAt(members.at("range"), "must be the least and the greatest value; null means no limit");
        }
        parameter.low =
            range[0].first->is_null() ? least : Members::toNumber(*range[0].first, range[0].second);
        parameter.high =
            range[1].first->is_null() ? greatest : Members::toNumber(*range[1].first, range[1].second);
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
    if (kind == NumberKind::Real) {
        return;
    }
    for (const double end : {parameter.low, parameter.high, parameter.also.value_or(least)}) {
        if (end != std::trunc(end) || !(end >= least && end <= greatest)) {
            failAt(members.at("range"), fmt::format("{} is no value of {}", end, parameter.type->name));
        }
    }
}

Parameter ModelBuilder::makeParameter(const File& file, const Members& members, const std::string& name) {
    Parameter parameter;
    parameter.name = name;
    parameter.declared = members.text("name");
    parameter.object = file.object;
    parameter.place = members.text("at", parameter.declared);
    parameter.unit = members.text("unit", "");
    parameter.about = members.text("about", "");
    parameter.isAngle = parameter.unit == "radians";
    parameter.role = roleOf(members);
    parameter.inRecord = members.flag("record", true);
    readType(members, parameter);
    readRange(members, parameter);
    readDefault(members, parameter);
    return parameter;
}

void ModelBuilder::readDefault(const Members& members, Parameter& parameter) {
    parameter.fallback.clear();
    if (parameter.type->isAddress()) {
        if (members.has("default")) {
            failAt(members.at("default"), "is for values, and a program gives addresses at run time",
                   "leave it out: without an address the parameter is 0");
        }
        parameter.fallback.resize(static_cast<std::size_t>(parameter.numbers));
        return;
    }
    const DeclarationJson& fallback = members["default"];
    if (parameter.isVector() && parameter.numbers == 1 && fallback.is_string()) {
        parameter.fallback.push_back(Members::toNumber(fallback, members.at("default")));  // "infinity"
    } else if (parameter.isArray() && isOneElement(parameter, fallback)) {
        // The place of a fault is that in the first element.
        const DeclarationJson all(static_cast<std::size_t>(parameter.count), fallback);
        if (const auto fault = readValue(parameter, all, parameter.fallback)) {
            failAt(members.at("default") + fault->place.substr(2), fault->message);
        }
    } else if (const auto fault = readValue(parameter, fallback, parameter.fallback)) {
        failAt(members.at("default") + fault->place, fault->message);
    }
    for (int i = 0; i < parameter.numbers; ++i) {
        double& number = parameter.fallback[static_cast<std::size_t>(i)];
        if (!parameter.isValid(number)) {
            failAt(members.at("default") + placeOfNumber(parameter, i), "is outside of the range");
        }
        number = parameter.type->kind == NumberKind::Real ? static_cast<float>(number) : number;
    }
}

void ModelBuilder::addParameter(const File& file, const Members& members) {
    // A parameter may have the name of its feature: "dispersion". The JSON stands on the left, because
    // nlohmann-json 3.11.3 (Debian 13) compares it with a string in that order only.
    std::string name = members.text("name");
    if (file->json["name"] != name) {
        name = newName(members);
    }
    refuseWordOfGlsl(members, name);
    Parameter parameter = makeParameter(file, members, name);
    parameter.first = static_cast<int>(model_.defaults.size());
    model_.defaults.insert(model_.defaults.end(), parameter.fallback.begin(), parameter.fallback.end());
    if (model_.findParameter(name) >= 0) {
        failAt(members.at("name"), fmt::format("\"{}\" is declared twice", name));
    }
    for (std::size_t i = 0; i < parameter.names.size(); ++i) {
        // GLSL has a constant of each.
        const std::string where = fmt::format("{}/{}", members.at("values"), i);
        checkName(parameter.names[i], where);
        claimName(name + capitalized(parameter.names[i]), where);
    }
    model_.parameters.push_back(std::move(parameter));
}

void ModelBuilder::addAttribute(const File& file, const Members& members) {
    VertexAttribute attribute;
    attribute.name = newName(members);
    refuseWordOfGlsl(members, attribute.name);
    attribute.gltf = members.text("at");
    attribute.about = members.text("about", "");
    attribute.type = &vectorType(members);
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
        value.type = attribute.type;
        value.numbers = attribute.type->channels;
        value.low = -kLargestFloat;
        value.high = kLargestFloat;
        readDefault(members, value);
        std::ranges::transform(value.fallback, attribute.fallback.emplace().begin(),
                               [](double number) { return static_cast<float>(number); });
    }
    for (const VertexAttribute& other : model_.attributes) {
        if (other.gltf == attribute.gltf && other.type->channels != attribute.type->channels) {
            failAt(members.at("type"),
                   fmt::format("{} has {} channels here and {} for \"{}\"", attribute.gltf,
                               attribute.type->channels, other.type->channels, other.name));
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

// Glint makes levels and chooses formats of flat textures alone. A direction and a place in space are no UVs.
void ModelBuilder::readDimension(const Members& members, MaterialTexture& texture, Feature& feature) {
    using package::TextureEntry;
    const std::string name = members.text("dimension", "2d");
    texture.dimension = choose(package::kTextureDimensionNames, members, "dimension", name).value;
    if (texture.dimension == TextureEntry::Dimension::Flat) {
        return;
    }
    const bool takesUvs = texture.dimension == TextureEntry::Dimension::Array;
    for (const char* const member : {"reads", "roughness", "coordinates"}) {
        const bool isOfCoordinates = std::string_view(member) == "coordinates";
        if (members.has(member) && !(isOfCoordinates && takesUvs)) {
            failAt(members.at(member),
                   isOfCoordinates
                       ? fmt::format("a texture with the dimension {} has no UVs", name)
                       : fmt::format("is for 2D textures, and this one has the dimension {}", name),
                   "leave it out");
        }
    }
    feature.hasOwnCoordinates = feature.hasOwnCoordinates || !takesUvs;
}

void ModelBuilder::addTexture(const File& file, const Members& members) {
    MaterialTexture texture;
    texture.name = newName(members);
    texture.role = roleOf(members);
    const std::string declared = members.text("name");
    texture.places.push_back({file.object, declared, members.flag("color", false), readsOfTexture(members)});
    Feature feature;
    feature.name = texture.name;
    feature.gltf = gltfPlace(file.object, declared);
    feature.texture = static_cast<int>(model_.textures.size());
    if (members.has("coordinates")) {
        if (members.text("coordinates") != "own") {
            failAt(members.at("coordinates"), "the only other coordinates are \"own\"");
        }
        feature.hasOwnCoordinates = true;
    }
    readDimension(members, texture, feature);
    texture.feature = addFeature(members, std::move(feature), Light::Front);
    model_.textures.push_back(std::move(texture));
}

void ModelBuilder::collectAliases(const File& file) {
    scope_ = file.scope;
    for (const Members& alias : file->parameters) {
        if (!fills(alias, Place::Parameter)) {
            continue;
        }
        const std::string name = newName(alias);
        const int target = alias.has("is") ? named(&MaterialModel::findParameter, alias.text("is"))
                                           : model_.parameterOf(roleOf(alias));
        if (target < 0) {
            failAt(alias.at("is"), fmt::format("there is no parameter \"{}\"", alias.text("is")));
        }
        const Parameter& original = model_.parameters[static_cast<std::size_t>(target)];
        Parameter parameter = original;
        parameter.name = name;
        parameter.declared = alias.text("name");
        parameter.object = file.object;
        parameter.place = alias.text("at", parameter.declared);
        parameter.aliasOf = target;
        parameter.inRecord = false;
        readDefault(alias, parameter);
        model_.parameters.push_back(std::move(parameter));
    }
    for (const Members& alias : file->textures) {
        if (fills(alias, Place::Texture)) {
            newName(alias);
            model_.textures[static_cast<std::size_t>(filledTexture(alias))].places.push_back(
                {file.object, alias.text("name"), alias.flag("color", false), readsOfTexture(alias)});
        }
    }
}

int ModelBuilder::filledTexture(const Members& members) const {
    const int found = members.has("is") ? named(&MaterialModel::findTexture, members.text("is"))
                                        : model_.textureOf(roleOf(members));
    if (found < 0) {
        failAt(members.at("is"), fmt::format("there is no texture \"{}\"", members.text("is")));
    }
    return found;
}

}  // namespace glint::materials
