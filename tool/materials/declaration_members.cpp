#include "materials/declaration_members.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace glint::materials {

// Places have the names of types of a model, so they are used in a namespace of their own.
namespace members {

using base::Json;
using enum Place;

constexpr std::uint32_t at(std::initializer_list<Place> places) {
    std::uint32_t bits = 0;
    for (const Place place : places) {
        bits |= placeBit(place);
    }
    return bits;
}

// --- The schemas of values ---

Json schemaOfPlace(Place place);

Json text() {
    return {{"type", "string"}, {"minLength", 1}};
}
template <const char* const& Pattern>
Json matching() {
    return {{"type", "string"}, {"pattern", Pattern}};
}
constexpr const char* kNamePattern = "^[a-z][A-Za-z0-9]*$";
constexpr const char* kFilePattern = "^[A-Za-z0-9_-][A-Za-z0-9_.-]*\\.glsl$";
constexpr const char* kAttributePattern = "^_.";
constexpr const char* kReadsPattern = "^(normal|r?g?b?a?)$";
constexpr const char* kRoughnessPattern = "^(1 - )?[rgba]$";
constexpr const char* kScalesPattern = "^[a-z][A-Za-z0-9]*(\\.[rgba]{1,4})?$";

Json flag() {
    return {{"type", "boolean"}};
}
Json finite() {
    return {{"type", "number"}};
}
Json positive() {
    return {{"type", "number"}, {"minimum", 0}};
}
Json number() {
    return {{"oneOf", {finite(), {{"enum", {"infinity"}}}}}};
}
Json numberOrNull() {
    return {{"oneOf", {finite(), {{"type", "null"}}, {{"enum", {"infinity"}}}}}};
}
template <Json (*Element)(), int Least = 0, int Most = 0>
Json list() {
    Json schema{{"type", "array"}, {"items", Element()}};
    if (Least > 0) {
        schema["minItems"] = Least;
    }
    if (Most > 0) {
        schema["maxItems"] = Most;
    }
    return schema;
}
template <Json (*Element)()>
Json oneOrList() {
    return {{"oneOf", {Element(), list<Element, 1>()}}};
}
// A value, or lists of values of that depth.
Json oneOrNested(Json one, int depth) {
    return depth == 0
               ? one
               : Json{{"oneOf",
                       {one, {{"type", "array"}, {"items", oneOrNested(one, depth - 1)}, {"minItems", 1}}}}};
}
template <Json (*Element)()>
Json byName() {
    return {{"type", "object"}, {"additionalProperties", Element()}};
}
template <Place Of>
Json object() {
    return schemaOfPlace(Of);
}
// A value of any type; the names of enums are texts, and so is "infinity".
Json plainValue() {
    return {{"type", {"number", "boolean", "string"}}};
}
Json value() {
    return oneOrNested(plainValue(), 2);
}
Json elements() {
    return {{"type", "integer"}, {"minimum", 1}, {"maximum", kMostElements}};
}
Json vectorType() {
    Json names = Json::array();
    for (const ValueType& type : kVectorTypes) {
        names.push_back(type.name);
    }
    return {{"enum", std::move(names)}};
}
template <const auto& Rows>
Json nameOf() {
    Json names = Json::array();
    for (const auto& row : Rows) {
        names.push_back(row.name);
    }
    return {{"enum", std::move(names)}};
}
template <Place Of>
Json roleOf() {
    Json names = Json::array();
    for (const NamedRole& row : kRoles) {
        if ((row.places & placeBit(Of)) != 0) {
            names.push_back(row.name);
        }
    }
    return {{"enum", std::move(names)}};
}
Json own() {
    return {{"enum", {"own"}}};
}
constexpr auto kName = matching<kNamePattern>;
constexpr auto kFile = matching<kFilePattern>;

// --- The members ---

constexpr MemberRow kRows[] = {
    {"$schema", at({File}), text, "This schema, for editors."},
    {"name", at({File, Parameter, Texture, Attribute, Derived, Feature}), kName,
     "The name, unique in all declarations; in a model of a pack, unique in the model.",
     at({File, Parameter, Texture, Attribute, Derived, Feature})},
    {"about", at({File, Parameter, Texture, Attribute, Derived, Feature}), text, "One sentence about it."},
    {"extension", at({File}), text, "The material extension that holds the parameters and textures."},
    {"object", at({File, Replaces}), text, "The object of the core that holds them.", at({Replaces})},
    {"stage", at({File, Feature, Excludes}), nameOf<kStages>, "The stage at which its GLSL runs.",
     at({File})},
    {"short", at({File, Texture, Feature}), text, "Part of the names of cases."},
    {"order", at({File, Texture, Feature}), finite,
     "The place among the bits; without it, after all that have one."},
    {"needs", at({File, Texture, Feature}), oneOrList<nameOf<kNeeds>>,
     "What it reads beyond its own values: the frame of a texture, or a UV set that its GLSL reads."},
    {"light", at({File}), nameOf<kLights>,
     "Where such a surface takes light from: nowhere, the viewer's side, or both."},
    {"draft", at({File, Texture, Feature}), flag,
     "True: the draft of the lighting pass shows it, which is drawn until that pass is made."},
    {"ofBase", at({File}), flag, "True: hits keep it with --hit-lobes base."},
    {"gltf", at({File, Feature}), text, "Its place in glTF, for people.", at({Feature})},
    {"given", at({File, Feature}), text, "The condition under which the file asks for it."},
    {"cost", at({File, Texture, Feature}), object<Cost>, "How much a shader grows with it."},
    {"neutral", at({File, Texture, Feature}), list<object<Reason>>, "Reasons why it changes nothing."},
    {"replaces", at({File}), object<Replaces>,
     "The base model that a material with this object does not read."},
    {"excludes", at({File}), object<Excludes>, "The features that this one leaves out of its keys."},
    {"glsl", at({File}), object<Glsl>,
     "The files beside the declaration that hold its GLSL, by the stage at which it runs."},
    {"parameters", at({File}), list<object<Parameter>>, "Numbers of a material."},
    {"textures", at({File}), list<object<Texture>>, "Textures of a material."},
    {"attributes", at({File}), list<object<Attribute>>,
     "Attributes of vertices that its GLSL reads beside those of glTF's core."},
    {"derived", at({File}), list<object<Derived>>, "Fields of the record that follow from parameters."},
    {"features", at({File}), list<object<Feature>>, "Further bits of the key."},
    {"effects", at({File}), list<object<Effect>>, "What the surface may do with light."},

    {"instructions", at({Cost}), positive, "SPIR-V instructions.", at({Cost})},
    {"fetches", at({Cost}), positive, "Texture fetches.", at({Cost})},
    {"when", at({Reason, Effect}), text, "A condition.", at({Reason, Effect})},
    {"because", at({Reason, Excludes}), text, "The condition in words.", at({Reason, Excludes})},
    {"sets", at({Replaces}), byName<value>, "Values that the replaced parameters have."},
    {"but", at({Excludes}), list<kName>, "The features that stay."},

    {"surface", at({Glsl}), kFile, "The file of nameSurface(), which changes colour, normal and roughness."},
    {"bsdf", at({Glsl}), kFile,
     "The file of nameBsdf(), which changes the BSDF of the base and sets the layer."},
    {"layer", at({Glsl}), kFile,
     "The file of a layer over the base: its struct, and the functions that evaluate, sample and weigh it."},
    {"model", at({Glsl}), kFile,
     "The file of a model in place of the base: its struct, and the functions that evaluate and sample it."},
    {"diffuse", at({Glsl}), kFile,
     "The file of nameDiffuse(), which stands in for Lambert's law in the base's diffuse lobe, and of its "
     "struct."},
    {"emission", at({Glsl}), kFile,
     "The file of nameEmission(), which changes the light that the surface emits."},
    {"coordinates", at({Glsl}), kFile,
     "The file of nameCoordinates(), which changes the coordinates at which textures are read."},
    {"opacity", at({Glsl}), kFile,
     "The file of nameOpacity(), which changes the alpha that masks are tested by."},
    {"after", at({Glsl}), list<kName>,
     "Names of declarations whose GLSL runs before, at each stage; the layer lies over theirs."},
    {"coversEmission", at({Glsl}), flag, "True: the layer takes what it reflects from the emission, too."},
    {"traced", at({Glsl}), flag, "True: rays may trace the layer's reflection."},
    {"sampled", at({Glsl}), flag,
     "True: the model has nameSample() and nameDensity(); otherwise directions are cosine-weighted."},
    {"shadesAll", at({Glsl}), flag,
     "True: the model has nameShadeAll(), which changes the light of all lights together."},
    {"reciprocal", at({Glsl}), flag,
     "True: the layer or the model claims that view and light may change places, which check-materials "
     "checks."},

    {"gainsEnergy", at({Glsl}), text,
     "Why more light may leave the surface than reaches it; check-materials then reports how much, and no "
     "failure."},

    {"at", at({Parameter}), text, "The place below the object."},
    {"at", at({Attribute}), matching<kAttributePattern>, "Its name in glTF.", at({Attribute})},
    {"type", at({Parameter}), nameOf<kTypes>, "The type of the value."},
    {"type", at({Attribute, Derived}), vectorType, "The type of the value.", at({Attribute, Derived})},
    {"count", at({Parameter}), elements, "Makes it an array of so many values."},
    {"values", at({Parameter}), list<kName, 1>, "The names that a value of an enum may be."},
    {"default", at({Parameter}), value,
     "The value of a material whose file gives none; every type but address needs it."},
    {"default", at({Attribute}), oneOrList<finite>,
     "The value on primitives that lack it; without one they do not have the feature."},
    {"range", at({Parameter}), list<numberOrNull, 2, 2>,
     "The least and the greatest value; null means no limit."},
    {"also", at({Parameter}), list<number, 1, 1>, "One further valid value."},
    {"unit", at({Parameter, Derived}), text, "The unit; the range of radians is a turn."},
    {"record", at({Parameter}), flag, "False: records do not have it."},
    {"of", at({Parameter, Texture, Derived}), kName, "The feature whose keys need it."},
    {"role", at({Parameter}), roleOf<Parameter>,
     "What Glint itself reads it for. If a parameter has the role already, this one fills it."},
    {"role", at({Texture}), roleOf<Texture>,
     "What Glint itself reads it for. If a texture has the role already, this one fills it."},
    {"role", at({Feature}), roleOf<Feature>, "What Glint itself has to know it for."},
    {"is", at({Parameter, Texture}), kName, "The parameter or texture of another base model that it fills."},
    {"value", at({Derived}), oneOrList<text>, "An expression.", at({Derived})},

    {"color", at({Texture}), flag, "True: sRGB."},
    {"reads", at({Texture}), matching<kReadsPattern>,
     "The channels that shading reads, in the order rgba; normal: unit vectors in tangent space. Without it "
     "all "
     "channels count as read."},
    {"roughness", at({Texture}), matching<kRoughnessPattern>,
     "The channel that holds the roughness of a lobe, whose square is alpha: g; or 1 - roughness: 1 - a. Mip "
     "levels "
     "average its square."},
    {"dimension", at({Texture}), nameOf<package::kTextureDimensionNames>,
     "What a lookup takes: UVs; UVs and the number of a layer; a direction; a place in space."},
    {"coordinates", at({Texture}), own, "own: its GLSL makes its coordinates, so that it needs no UV set."},
    {"scales", at({Texture}), list<matching<kScalesPattern>>,
     "The parameters that it multiplies by numbers in [0, 1], each with the texture's channels that do so, "
     "if that is "
     "all that the texture does to it: roughnessFactor.g."},

    {"does", at({Effect}), nameOf<kBehaviours>, "The behaviour.", at({Effect})},
    {"roughness", at({Effect}), text, "The roughness of what reflects, as an expression."},
    {"value", at({Effect}), text, "An expression, in place of {} in the text."},
    {"text", at({Effect}), text, "Words for explain."},
    {"textureText", at({Effect}), text, "Words where only a texture can make it so."},
};

constexpr MemberRule kRules[] = {
    {File, "short light given needs draft ofBase cost order gltf excludes attributes", "extension neutral",
     "", "is of a feature of the declaration's own, and it has none",
     "give the declaration \"extension\" or \"neutral\""},
    {File, "replaces", "extension object", "", "every material would lose what it replaces",
     "give the declaration \"extension\" or \"object\""},
    {File, "object", "", "extension", "a feature has an extension or an object of the core, not both", ""},
    {Parameter, "range also type count values unit record of", "", "is",
     "is that of the parameter whose value this is", "leave it out"},
    {Parameter, "is", "", "role", "says what the role says: what this fills", "leave one of the two out"},
    {Texture, "is", "", "role", "says what the role says: what this fills", "leave one of the two out"},
    {Parameter, "record", "", "role", "would keep shaders from reading it, which is what a role is for",
     "leave it out"},
    {Parameter, "also", "range", "", "says nothing without a range", "give the parameter \"range\""},
    {Texture, "short order draft needs cost of coordinates dimension", "", "is",
     "is that of the texture whose place this fills", "leave it out"},
    {Glsl, "coversEmission traced", "layer", "", "is for layers; there is no \"layer\"", ""},
    {Glsl, "reciprocal", "layer model", "", "is for layers and models; there is no \"layer\" or \"model\"",
     ""},
    {Glsl, "sampled shadesAll", "model", "", "is for models; there is no \"model\"", ""},
    {Glsl, "layer model diffuse", "bsdf", "", "needs \"bsdf\", which sets its parameters", ""},
    {Glsl, "layer", "", "model diffuse", "can be neither a model nor a diffuse lobe", ""},
    {Glsl, "model", "", "diffuse", "can't be a diffuse lobe", ""},
    {Effect, "textureText", "roughness", "",
     "says why a texture makes a reflection smooth; there is no \"roughness\"", ""},
    {Effect, "value", "text", "", "is written in a text; there is no \"text\"", ""},
    {Effect, "value", "", "roughness", "is written in the text of what does not reflect", ""},
};

// --- The schema of a declaration ---

// Takes the first word from a text of words.
std::string_view takeWord(std::string_view& words) {
    const std::string_view word = words.substr(0, words.find(' '));
    words.remove_prefix(std::min(word.size() + 1, words.size()));
    return word;
}

// The condition that one of the members is there.
Json hasOneOf(std::string_view members) {
    Json any = Json::array();
    while (!members.empty()) {
        any.push_back({{"required", Json::array({takeWord(members)})}});
    }
    return {{"anyOf", std::move(any)}};
}

Json schemaOfPlace(Place place) {
    Json needed = Json::array();
    Json properties = Json::object();
    for (const MemberRow& row : kRows) {
        if (!row.standsAt(place)) {
            continue;
        }
        if (row.isNeededAt(place)) {
            needed.push_back(row.name);
        }
        Json& member = properties[std::string(row.name)] = {{"description", row.about}};
        member.update(row.schema());
    }
    Json dependencies = Json::object();
    for (const MemberRule& rule : kRules) {
        for (std::string_view left = rule.place == place ? rule.members : ""; !left.empty();) {
            const Json condition =
                rule.with.empty() ? Json{{"not", hasOneOf(rule.without)}} : hasOneOf(rule.with);
            Json& all = dependencies[std::string(takeWord(left))];
            all = all.is_null() ? condition : Json{{"allOf", {all, condition}}};
        }
    }
    Json schema{{"type", "object"}};
    if (!needed.empty()) {
        schema["required"] = std::move(needed);
    }
    if (!dependencies.empty()) {
        schema["dependencies"] = std::move(dependencies);
    }
    schema["additionalProperties"] = false;
    schema["properties"] = std::move(properties);
    return schema;
}

}  // namespace members

bool hasWord(std::string_view words, std::string_view word) {
    while (!words.empty()) {
        if (members::takeWord(words) == word) {
            return true;
        }
    }
    return false;
}

std::span<const MemberRow> memberRows() {
    return members::kRows;
}

std::span<const MemberRule> memberRules() {
    return members::kRules;
}

base::Json declarationSchema() {
    return members::schemaOfPlace(Place::File);
}

}  // namespace glint::materials
