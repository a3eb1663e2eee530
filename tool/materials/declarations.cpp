#include "materials/declarations.h"

#include "base/json_depth.h"
#include "materials/declaration_json.h"
#include "materials/effect_reader.h"
#include "materials/feature_code.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cctype>
#include <initializer_list>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>

namespace glint {

namespace {

constexpr double kNoOrder = 1e6;
constexpr double kLargestFloat = std::numeric_limits<float>::max();

constexpr struct {
    std::string_view name;
    Stage stage;
} kStages[] = {
    {"attributes", Stage::Attributes},
    {"coordinates", Stage::Coordinates},
    {"base", Stage::Base},
    {"surface", Stage::Surface},
    {"layer", Stage::Layer},
    {"emission", Stage::Emission},
    {"opacity", Stage::Opacity},
};

constexpr struct {
    std::string_view name;
    Behaviour behaviour;
} kBehaviours[] = {
    {"reflects", Behaviour::Reflects},
    {"transmits", Behaviour::Transmits},
    {"scatters", Behaviour::Scatters},
    {"emits", Behaviour::Emits},
};

constexpr struct {
    std::string_view name;
    std::string_view glsl;
    int channels;
} kTypes[] = {{"float", "float", 1},
              {"vec2", "vec2", 2},
              {"vec3", "vec3", 3},
              {"color", "vec3", 3},
              {"vec4", "vec4", 4}};

constexpr struct {
    std::string_view function;
    std::string_view name;
    Fact fact;
    bool isNumber;
} kFacts[] = {
    {"", "NORMAL", Fact::Normal, false},
    {"", "TANGENT", Fact::Tangent, false},
    {"", "TEXCOORD_0", Fact::TexCoord0, false},
    {"", "TEXCOORD_1", Fact::TexCoord1, false},
    {"", "COLOR_0", Fact::Color, true},
    {"", "givesColors", Fact::GivesColors, false},
    {"", "doubleSided", Fact::DoubleSided, false},
    {"", "MASK", Fact::Mask, false},
    {"", "BLEND", Fact::Blend, false},
    {"", "raysTestAlpha", Fact::RaysTestAlpha, false},
    {"reads", "TEXCOORD_0", Fact::ReadsTexCoord0, false},
    {"reads", "TEXCOORD_1", Fact::ReadsTexCoord1, false},
    {"", "movesTextures", Fact::MovesTextures, false},
    {"", "givesTransforms", Fact::GivesTransforms, false},
    {"needed", "tangents", Fact::NeedsTangents, false},
    {"", "changesOpacity", Fact::ChangesOpacity, false},
};

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

bool isIdentifier(std::string_view name) {
    return !name.empty() && std::islower(static_cast<unsigned char>(name.front())) != 0 &&
           std::ranges::all_of(name, [](unsigned char c) { return std::isalnum(c) != 0; });
}

// Builds the model in two passes over the files: the first collects what has a name, the second reads the
// expressions, which may use any of the names.
class ModelBuilder {
public:
    explicit ModelBuilder(std::span<const DeclarationFile> files) {
        addObject("", false);
        std::vector<DeclarationFile> sorted(files.begin(), files.end());
        std::ranges::sort(sorted, {}, &DeclarationFile::name);
        for (const DeclarationFile& file : sorted) {
            parse(file);
        }
        readEffects();
        // The core comes before the extensions. This is not std::ranges, whose subrange Clang 14 can't read
        // in libstdc++ 12.
        std::stable_partition(files_.begin(), files_.end(),
                              [](const File& file) { return !file.json.contains("extension"); });
    }

    MaterialModel build() {
        for (File& file : files_) {
            collect(file);
        }
        for (const File& file : files_) {
            collectAliases(file);
        }
        assignBits();
        for (const File& file : files_) {
            link(file);
        }
        for (const File& file : files_) {
            linkAliases(file);
        }
        for (Parameter& parameter : model_.parameters) {
            if (parameter.aliasOf >= 0) {
                parameter.scaledBy = model_.parameters[static_cast<std::size_t>(parameter.aliasOf)].scaledBy;
            }
        }
        keepPlacesOfUnlit();
        std::vector<DeclaredCode> code;
        for (const File& file : files_) {
            const Members members = membersOf(file);
            if (members.has("glsl")) {
                code.push_back(readFeatureCode(members, file.name, file.mainFeature));
                code.back().code.unless = replacing(file.object);
                code.back().code.isOfPack = file.isOfPack;
            }
        }
        model_.code = orderCode(std::move(code));
        orderByDependence();
        return std::move(model_);
    }

private:
    struct File {
        std::string name;
        DeclarationJson json;
        int object = 0;
        int mainFeature = -1;  // index into pending_, until bits are assigned
        bool isOfPack = false;
    };
    // A feature before bits are assigned.
    struct Pending {
        Feature feature;
        double order = kNoOrder;
        std::string where;
        bool isLit = true;
        bool isOfPack = false;
    };

    static constexpr std::string_view kFileMembers[] = {
        "$schema", "name",     "about",    "extension", "object",     "stage",   "short",    "order",
        "needs",   "lit",      "replaces", "excludes",  "parameters", "derived", "textures", "given",
        "neutral", "features", "effects",  "gltf",      "cost",       "ofBase",  "glsl",     "attributes"};
    static constexpr std::string_view kAttributeMembers[] = {"name", "at", "type", "default", "about"};
    static constexpr std::string_view kFeatureMembers[] = {"name",  "about", "stage", "short",   "order",
                                                           "needs", "gltf",  "given", "neutral", "cost"};
    static constexpr std::string_view kTextureMembers[] = {"name",  "about",   "short",  "order",
                                                           "needs", "color",   "scales", "of",
                                                           "is",    "neutral", "cost",   "coordinates"};
    static constexpr std::string_view kParameterMembers[] = {"name", "at", "type", "default", "range", "also",
                                                             "unit", "of", "is",   "about",   "record"};

    // Returns the feature whose object a material has in place of this one, or -1.
    int replacing(int object) const {
        for (const File& file : files_) {
            const int replaced = model_.objects[static_cast<std::size_t>(file.object)].replaces;
            if (object > 0 && replaced == object) {
                return file.mainFeature;
            }
        }
        return -1;
    }

    void parse(const DeclarationFile& file) {
        File parsed{std::string(file.name), {}, 0, -1, file.isOfPack};
        const auto* const bytes = reinterpret_cast<const std::uint8_t*>(file.text.data());
        if (nestsTooDeep({bytes, file.text.size()})) {
            failAt(parsed.name, "nests too deep");
        }
        parsed.json = DeclarationJson::parse(file.text, nullptr, false);
        if (parsed.json.is_discarded()) {
            failAt(parsed.name, "is no JSON", "look for a missing comma or bracket");
        }
        files_.push_back(std::move(parsed));
    }

    // Declarations of effects have a kind; those of features have none.
    void readEffects() {
        const auto isEffect = [](const File& file) {
            return file.json.is_object() && file.json.contains("kind");
        };
        for (const File& file : files_) {
            if (isEffect(file)) {
                model_.effects.push_back(
                    readEffect({file.json, file.name + "#", effectMembers()}, file.name, file.isOfPack));
            }
        }
        std::erase_if(files_, isEffect);
        numberEffects(model_.effects);
    }

    Members membersOf(const File& file) const {
        return {file.json, file.name + "#", kFileMembers};
    }

    int addObject(const std::string& name, bool isExtension) {
        const int known = model_.findObject(name);
        if (known >= 0) {
            return known;
        }
        model_.objects.push_back({name, isExtension});
        return static_cast<int>(model_.objects.size()) - 1;
    }

    // Every name stands for one thing in the whole model.
    std::string newName(const Members& members) {
        std::string name = members.text("name");
        if (!isIdentifier(name)) {
            failAt(members.at("name"),
                   fmt::format("\"{}\" must be letters and digits that begin with a small letter", name));
        }
        const auto [place, isNew] = named_.try_emplace(name, members.at("name"));
        if (!isNew) {
            failAt(members.at("name"),
                   fmt::format("\"{}\" is declared twice; {} declares it, too", name, place->second));
        }
        return name;
    }

    std::string gltfPlace(int object, std::string_view member) const {
        const MaterialObject& owner = model_.objects[static_cast<std::size_t>(object)];
        std::string place = "materials[]";
        place += owner.isExtension ? ".extensions" : "";
        place += owner.name.empty() ? "" : "." + owner.name;
        return member.empty() ? place : fmt::format("{}.{}", place, member);
    }

    int addFeature(const Members& members, Feature feature, bool isLit) {
        feature.macro = "GLINT" + macroCase("_" + feature.name);
        feature.about = members.text("about", "");
        std::string capital = feature.name;
        capital[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(capital[0])));
        feature.shortName = members.text("short", capital);
        readNeeds(members, feature);
        if (members.has("cost")) {
            const Members cost(members["cost"], members.at("cost"), {"instructions", "fetches"});
            feature.cost = {cost.number("instructions", 0.0), cost.number("fetches", 0.0)};
        }
        pending_.push_back(
            {std::move(feature), members.number("order", kNoOrder), members.where(), isLit, isOfPack_});
        return static_cast<int>(pending_.size()) - 1;
    }

    static void readNeeds(const Members& members, Feature& feature) {
        if (!members.has("needs")) {
            return;
        }
        const std::vector<std::string> needs =
            members["needs"].is_array() ? members.texts("needs") : std::vector{members.text("needs")};
        for (const std::string& need : needs) {
            if (need == "tangents") {
                feature.needsTangents = true;
            } else if (need == "texCoord0" || need == "texCoord1") {
                feature.needsTexCoord = need == "texCoord1" ? 1 : 0;
            } else {
                failAt(members.at("needs"),
                       fmt::format("\"{}\" is none of \"tangents\", \"texCoord0\" and \"texCoord1\"", need));
            }
        }
    }

    void collect(File& file) {
        isOfPack_ = file.isOfPack;
        const Members members = membersOf(file);
        const std::string name = newName(members);
        const std::string stageName = members.text("stage");
        const Stage stage = choose(kStages, members, "stage", stageName).stage;
        if (members.has("extension") && members.has("object")) {
            failAt(members.at("object"), "a feature has an extension or an object of the core, not both");
        }
        file.object = members.has("extension") ? addObject(members.text("extension"), true)
                      : members.has("object")  ? addObject(members.text("object"), false)
                                               : 0;
        const bool hasOwn = members.has("short") || members.has("neutral") || members.has("extension");
        if (hasOwn) {
            Feature feature;
            feature.name = name;
            feature.stage = stage;
            feature.object = members.has("extension") ? file.object : -1;
            feature.gltf = members.text("gltf", gltfPlace(file.object, ""));
            feature.isOfBase = members.flag("ofBase", false);
            file.mainFeature = addFeature(members, std::move(feature), members.flag("lit", true));
        }
        for (const auto& [json, where] : members.list("parameters")) {
            const Members parameter(*json, where, kParameterMembers);
            if (!parameter.has("is")) {
                addParameter(file, parameter);
            }
        }
        for (const auto& [json, where] : members.list("textures")) {
            const Members texture(*json, where, kTextureMembers);
            if (!texture.has("is")) {
                addTexture(file, texture);
            }
        }
        for (const auto& [json, where] : members.list("attributes")) {
            addAttribute(file, Members(*json, where, kAttributeMembers));
        }
        for (const auto& [json, where] : members.list("features")) {
            const Members further(*json, where, kFeatureMembers);
            Feature feature;
            feature.name = newName(further);
            feature.stage = further.has("stage")
                                ? choose(kStages, further, "stage", further.text("stage")).stage
                            : stage == Stage::Layer ? Stage::Surface
                                                    : stage;
            feature.gltf = further.text("gltf");
            addFeature(further, std::move(feature), true);
        }
    }

    Parameter makeParameter(const File& file, const Members& members, const std::string& name, int channels) {
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
            const auto range = members.list("range");
            if (range.size() != 2) {
                failAt(members.at("range"), "must be the least and the greatest value; null means no limit");
            }
            parameter.low = range[0].first->is_null() ? -kLargestFloat
                                                      : Members::toNumber(*range[0].first, range[0].second);
            parameter.high = range[1].first->is_null() ? kLargestFloat
                                                       : Members::toNumber(*range[1].first, range[1].second);
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
        }
        readDefault(members, parameter);
        return parameter;
    }

    static void readDefault(const Members& members, Parameter& parameter) {
        const DeclarationJson& fallback = members["default"];
        const bool isList = fallback.is_array();
        if (isList ? fallback.size() != static_cast<std::size_t>(parameter.channels)
                   : parameter.channels != 1) {
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

    void addParameter(const File& file, const Members& members) {
        // A parameter may be called as its feature is: "dispersion".
        std::string name = members.text("name");
        if (name != file.json["name"]) {
            name = newName(members);
        }
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

    void addAttribute(const File& file, const Members& members) {
        VertexAttribute attribute;
        attribute.name = newName(members);
        attribute.gltf = members.text("at");
        attribute.about = members.text("about", "");
        const auto& type = choose(kTypes, members, "type", members.text("type"));
        attribute.type = type.glsl;
        attribute.channels = type.channels;
        attribute.feature = file.mainFeature;
        if (file.mainFeature < 0) {
            failAt(members.where(), "needs a feature that reads it: give the declaration \"neutral\"");
        }
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

    void addTexture(const File& file, const Members& members) {
        MaterialTexture texture;
        texture.name = newName(members);
        texture.places.push_back({file.object, texture.name, members.flag("color", false)});
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
        texture.feature = addFeature(members, std::move(feature), true);
        model_.textures.push_back(std::move(texture));
    }

    // Parameters and textures that fill those of another base model.
    void collectAliases(const File& file) {
        const Members members = membersOf(file);
        for (const auto& [json, where] : members.list("parameters")) {
            const Members alias(*json, where, kParameterMembers);
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
            const Members alias(*json, where, kTextureMembers);
            if (alias.has("is")) {
                const std::string name = newName(alias);
                textureNamed(alias, "is").places.push_back({file.object, name, alias.flag("color", false)});
            }
        }
    }

    MaterialTexture& textureNamed(const Members& members, std::string_view member) {
        const int found = model_.findTexture(members.text(member));
        if (found < 0) {
            failAt(members.at(member), fmt::format("there is no texture \"{}\"", members.text(member)));
        }
        return model_.textures[static_cast<std::size_t>(found)];
    }

    // Lobes and inputs have words of their own. In each, bits follow the declared order, then the names.
    void assignBits() {
        std::vector<int> sorted(pending_.size());
        for (std::size_t i = 0; i < sorted.size(); ++i) {
            sorted[i] = static_cast<int>(i);
        }
        std::ranges::sort(sorted, {}, [this](int i) {
            const Pending& row = pending_[static_cast<std::size_t>(i)];
            // The bits of Glint's own features are the same with packs as without.
            return std::tuple(row.isOfPack, !isLobe(row.feature), row.order,
                              std::string_view(row.feature.name));
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
                failAt(row.where,
                       fmt::format("there are more features than the {} bits of a key", kFeatureBits));
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
            file.mainFeature =
                file.mainFeature < 0 ? -1 : indexOf[static_cast<std::size_t>(file.mainFeature)];
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

    static bool isLobe(const Feature& feature) {
        return feature.texture < 0 && (feature.stage == Stage::Base || feature.stage == Stage::Layer);
    }

    Feature& featureAt(int index) {
        return model_.features[static_cast<std::size_t>(index)];
    }

    int featureNamed(const std::string& name, const std::string& where) const {
        const int found = model_.findFeature(name);
        if (found < 0) {
            failAt(where, fmt::format("there is no feature \"{}\"", name));
        }
        return found;
    }

    std::optional<Symbol> resolve(std::string_view function, const std::vector<std::string_view>& names) {
        for (const auto& row : kFacts) {
            if (row.function == function && names.size() == 1 && row.name == names[0]) {
                return Symbol{model_.symbolOf(row.fact), !row.isNumber, 1};
            }
        }
        const auto condition = [](int index, int symbol) {
            return index < 0 ? std::nullopt : std::optional(Symbol{symbol, true, 1});
        };
        if (function.empty()) {
            const int index = model_.findParameter(names[0]);
            return index < 0
                       ? std::nullopt
                       : std::optional(Symbol{index, false,
                                              model_.parameters[static_cast<std::size_t>(index)].channels});
        }
        if (function == "has" && names.size() == 1) {
            const int index = model_.findFeature(names[0]);
            return condition(index, model_.symbolOfFeature(index));
        }
        if (function == "readable" && names.size() == 1) {
            const int index = model_.findTexture(names[0]);
            return condition(index, model_.symbolOfTexture(index));
        }
        if (function == "attribute" && names.size() == 1) {
            const int index = model_.findAttribute(names[0]);
            return condition(index, model_.symbolOfAttribute(index));
        }
        if (function == "same" && names.size() == 2) {
            const std::array<int, 2> pair{model_.findTexture(names[0]), model_.findTexture(names[1])};
            if (pair[0] < 0 || pair[1] < 0) {
                return std::nullopt;
            }
            model_.pairs.push_back(pair);
            return Symbol{model_.symbolOfPair(static_cast<int>(model_.pairs.size()) - 1), true, 1};
        }
        return std::nullopt;
    }

    Expression expression(const DeclarationJson& json, const std::string& where, bool isCondition) {
        if (!json.is_string()) {
            failAt(where, "must be an expression, as a text");
        }
        ExpressionError error;
        const auto& text = json.get_ref<const std::string&>();
        std::optional<Expression> parsed = Expression::parse(
            text, [this](auto function, const auto& names) { return resolve(function, names); }, error);
        if (!parsed) {
            failAt(where,
                   fmt::format("{}, at character {} of \"{}\"", error.message, error.offset + 1, text));
        }
        if (parsed->isCondition() != isCondition) {
            failAt(where, isCondition ? "must be a condition" : "must be a number");
        }
        return std::move(*parsed);
    }

    void linkFeature(const Members& members, int index, int onlyWith) {
        if (members.has("given")) {
            featureAt(index).given = expression(members["given"], members.at("given"), true);
        }
        for (const auto& [json, where] : members.list("neutral")) {
            const Members reason(*json, where, {"when", "because"});
            NeutralReason neutral{expression(reason["when"], reason.at("when"), true),
                                  reason.text("because")};
            neutral.onlyWith = onlyWith;
            featureAt(index).neutral.push_back(std::move(neutral));
        }
    }

    void link(const File& file) {
        const Members members = membersOf(file);
        if (file.mainFeature >= 0) {
            linkFeature(members, file.mainFeature, -1);
        }
        for (const auto& [json, where] : members.list("features")) {
            const Members further(*json, where, kFeatureMembers);
            linkFeature(further, model_.findFeature(further.text("name")), -1);
        }
        for (const auto& [json, where] : members.list("textures")) {
            const Members texture(*json, where, kTextureMembers);
            if (!texture.has("is")) {
                linkTexture(file, texture);
            }
        }
        linkParameters(file, members);
        for (const auto& [json, where] : members.list("derived")) {
            linkDerived(file, Members(*json, where, {"name", "type", "value", "unit", "about", "of"}));
        }
        linkBase(file, members);
        for (const auto& [json, where] : members.list("effects")) {
            linkBehaviour(
                file, Members(*json, where, {"does", "when", "roughness", "value", "text", "textureText"}));
        }
    }

    void linkTexture(const File& file, const Members& members) {
        const int slot = model_.findTexture(members.text("name"));
        const int feature = model_.textures[static_cast<std::size_t>(slot)].feature;
        linkFeature(members, feature, -1);
        const bool ofLayer = file.mainFeature >= 0 && featureAt(file.mainFeature).isLobe;
        featureAt(feature).lobe = members.has("of") ? featureNamed(members.text("of"), members.at("of"))
                                  : ofLayer         ? file.mainFeature
                                                    : -1;
        linkScales(members, slot);
    }

    // In keys of another base model, the texture's reasons are those that this model gives, if it gives any.
    void linkAliases(const File& file) {
        const Members members = membersOf(file);
        for (const auto& [json, where] : members.list("textures")) {
            const Members texture(*json, where, kTextureMembers);
            if (!texture.has("is")) {
                continue;
            }
            const int slot = model_.findTexture(texture.text("is"));
            const int feature = model_.textures[static_cast<std::size_t>(slot)].feature;
            for (NeutralReason& reason : featureAt(feature).neutral) {
                reason.onlyWithout = texture.has("neutral") ? file.mainFeature : reason.onlyWithout;
            }
            linkFeature(texture, feature, file.mainFeature);
            linkScales(texture, slot);
        }
    }

    void linkScales(const Members& members, int slot) {
        for (const std::string& name : members.texts("scales")) {
            const int parameter = model_.findParameter(name);
            if (parameter < 0) {
                failAt(members.at("scales"), fmt::format("there is no parameter \"{}\"", name));
            }
            model_.parameters[static_cast<std::size_t>(parameter)].scaledBy = slot;
        }
    }

    void linkParameters(const File& file, const Members& members) {
        for (const auto& [json, where] : members.list("parameters")) {
            const Members row(*json, where, kParameterMembers);
            Parameter& parameter =
                model_.parameters[static_cast<std::size_t>(model_.findParameter(row.text("name")))];
            parameter.feature = row.has("of") ? featureNamed(row.text("of"), row.at("of")) : file.mainFeature;
        }
    }

    void linkDerived(const File& file, const Members& members) {
        DerivedField field;
        field.name = newName(members);
        const auto& type = choose(kTypes, members, "type", members.text("type"));
        field.type = type.glsl;
        field.count = type.channels;
        field.unit = members.text("unit", "");
        field.about = members.text("about", "");
        field.feature =
            members.has("of") ? featureNamed(members.text("of"), members.at("of")) : file.mainFeature;
        if (members["value"].is_array()) {
            for (const auto& [json, where] : members.list("value")) {
                field.channels.push_back(expression(*json, where, false));
            }
        } else {
            field.channels.push_back(expression(members["value"], members.at("value"), false));
        }
        const bool fits =
            field.channels.size() == 1
                ? field.channels[0].channels() == field.count || field.channels[0].channels() == 1
                : field.channels.size() == static_cast<std::size_t>(field.count);
        if (!fits) {
            failAt(members.at("value"), fmt::format("must give {} channels", field.count));
        }
        model_.derived.push_back(std::move(field));
    }

    void linkBase(const File& file, const Members& members) {
        if (members.has("replaces")) {
            const Members replaces(members["replaces"], members.at("replaces"), {"object", "sets"});
            const int object = model_.findObject(replaces.text("object"));
            if (object < 0) {
                failAt(replaces.at("object"), "no declaration has this object");
            }
            MaterialObject& owner = model_.objects[static_cast<std::size_t>(file.object)];
            owner.replaces = object;
            if (replaces.has("sets")) {
                for (const auto& [name, value] : replaces["sets"].items()) {
                    const int parameter = model_.findParameter(name);
                    if (parameter < 0) {
                        failAt(replaces.at("sets"), fmt::format("there is no parameter \"{}\"", name));
                    }
                    owner.settings.push_back(
                        {parameter, static_cast<float>(Members::toNumber(value, replaces.at("sets")))});
                }
            }
        }
        if (members.has("excludes")) {
            const Members excludes(members["excludes"], members.at("excludes"), {"but", "stage", "because"});
            Exclusion exclusion{file.mainFeature, 0, excludes.text("because")};
            std::set<int> kept{file.mainFeature};
            for (const std::string& name : excludes.texts("but")) {
                kept.insert(featureNamed(name, excludes.at("but")));
            }
            for (std::size_t i = 0; i < model_.features.size(); ++i) {
                const Feature& feature = model_.features[i];
                const bool isOfStage =
                    !excludes.has("stage") ||
                    (feature.texture < 0 &&
                     feature.stage == choose(kStages, excludes, "stage", excludes.text("stage")).stage);
                exclusion.excluded |= isOfStage && !kept.contains(static_cast<int>(i)) ? feature.mask() : 0;
            }
            model_.exclusions.push_back(std::move(exclusion));
        }
    }

    void linkBehaviour(const File& file, const Members& members) {
        BehaviourRule rule{choose(kBehaviours, members, "does", members.text("does")).behaviour, file.object,
                           expression(members["when"], members.at("when"), true)};
        if (members.has("roughness")) {
            rule.roughness = expression(members["roughness"], members.at("roughness"), false);
        }
        if (members.has("value")) {
            rule.value = expression(members["value"], members.at("value"), false);
        }
        if ((rule.does == Behaviour::Reflects) != rule.roughness.has_value()) {
            failAt(members.where(), "\"roughness\" stands where \"does\" is \"reflects\", and there alone");
        }
        rule.text = members.text("text", "");
        rule.textureText = members.text("textureText", "");
        // The base speaks before the layers.
        const bool isLayer = file.mainFeature >= 0 && featureAt(file.mainFeature).stage == Stage::Layer;
        const auto place = isLayer ? model_.behaviours.end() : model_.behaviours.begin() + baseBehaviours_++;
        model_.behaviours.insert(place, std::move(rule));
    }

    // A feature is evaluated after those that its conditions ask for. What vertices bring comes last, because
    // all textures and lobes may ask for it.
    void orderByDependence() {
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

    // Unlit surfaces read a texture and have an opacity, so packs may change where and how much.
    void keepPlacesOfUnlit() {
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

    bool asksForOpacity(const Feature& feature) const {
        return std::ranges::any_of(feature.neutral, [&](const NeutralReason& reason) {
            const auto& symbols = reason.when.symbols();
            return std::ranges::find(symbols, model_.symbolOf(Fact::ChangesOpacity)) != symbols.end();
        });
    }

    const std::vector<int>& indices(std::size_t count) {
        for (std::size_t i = indices_.size(); i < count; ++i) {
            indices_.push_back(static_cast<int>(i));
        }
        return indices_;
    }

    void addNeeds(const Expression& expression, std::set<int>& needs) const {
        const int first = model_.symbolOfFeature(0);
        for (const int symbol : expression.symbols()) {
            if (symbol >= first && symbol < first + static_cast<int>(model_.features.size())) {
                needs.insert(symbol - first);
            }
        }
    }

    MaterialModel model_;
    bool isOfPack_ = false;  // of the file that collect() reads
    std::vector<File> files_;
    std::vector<Pending> pending_;
    std::map<std::string, std::string> named_;  // where each name is declared
    std::vector<int> indices_;
    std::ptrdiff_t baseBehaviours_ = 0;
};

}  // namespace

Result<MaterialModel> readDeclarations(std::span<const DeclarationFile> files) {
    try {
        return ModelBuilder(files).build();
    } catch (const DeclarationFault& fault) {
        return fault.diagnostic;
    } catch (const DeclarationJson::exception& error) {
        return makeError("declaration", "", error.what());
    }
}

}  // namespace glint
