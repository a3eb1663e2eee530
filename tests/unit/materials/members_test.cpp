// Every member of declarations at every place where it may stand, and where it may not: it changes the model,
// or there is a diagnostic at its place.
#include "materials/declaration_json.h"
#include "materials/declaration_members.h"
#include "materials/declarations.h"
#include "support/must.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace glint::materials {
namespace {

using base::Json;

// Everything in a model that declarations decide, as a text.
class Listing {
public:
    explicit Listing(const MaterialModel& model) {
        add(model.unlit, model.bothSides, model.ownModels, model.lobes);
        for (const FeatureStep& one : model.order) {
            add(one.feature, one.needs);
        }
        add(model.commonSteps);
        for (const MaterialObject& one : model.objects) {
            add(one.name, one.isExtension, one.replaces, one.feature, one.base, one.isUnlit, one.steps);
            for (const MaterialObject::Setting& setting : one.settings) {
                add(setting.parameter, setting.numbers);
            }
        }
        for (const Parameter& one : model.parameters) {
            add(one.name, one.declared, one.object, one.place, one.typeText(), one.unit, one.about,
                one.fallback, one.low, one.high, one.also.value_or(-99.0), one.isAngle, one.aliasOf,
                one.scaledBy, one.scaledByChannels, one.feature, one.inRecord, static_cast<int>(one.role));
        }
        for (const DerivedField& one : model.derived) {
            add(one.name, one.type->name, one.unit, one.about, one.feature, one.channels.size());
            for (const Expression& channel : one.channels) {
                add(channel.symbols());
            }
        }
        for (const MaterialTexture& one : model.textures) {
            add(one.name, one.feature, static_cast<int>(one.role), static_cast<int>(one.dimension));
            for (const MaterialTexture::Place& place : one.places) {
                add(place.object, place.member, place.isColor, place.reads.channels, place.reads.isNormals,
                    place.reads.roughness, place.reads.glossiness);
            }
        }
        for (const VertexAttribute& one : model.attributes) {
            add(one.name, one.gltf, one.type->name, one.about,
                one.fallback.value_or(std::array<float, 4>{-99.0F}), one.fallback.has_value(), one.feature);
        }
        for (const Exclusion& one : model.exclusions) {
            add(one.by, one.excluded, one.because);
        }
        for (const BehaviourRule& one : model.behaviours) {
            add(static_cast<int>(one.does), one.object, one.when.symbols(), one.text, one.textureText);
            for (const auto& value : {one.roughness, one.value}) {
                add(value ? value->symbols() : std::vector{-1});
            }
        }
        for (const FeatureCode& one : model.code) {
            add(one.name, one.feature, one.surface, one.bsdf, one.layer, one.model, one.diffuse, one.emission,
                one.coordinates, one.opacity, one.coversEmission, one.isTraced, one.isReciprocal,
                one.isSampled, one.shadesAll, one.gains);
        }
        for (const Feature& one : model.features) {
            add(one.name, one.shortName, one.bit, one.gltf, one.about, static_cast<int>(one.stage),
                static_cast<int>(one.role), one.object, one.given.has_value(), one.neutralText(), one.texture,
                one.lobe, one.needsTangents, one.needsTexCoord, one.hasOwnCoordinates, one.isOfBase,
                one.isInDraft, one.cost.instructions, one.cost.fetches);
            for (const NeutralReason& reason : one.neutral) {
                add(reason.when.symbols(), reason.onlyWith, reason.onlyWithout);
            }
        }
    }

    const std::string& text() const {
        return text_;
    }

private:
    static std::string textOf(const FeatureMask& mask) {
        return toHex(mask);
    }
    template <typename Value>
    static std::string textOf(const Value& value) {
        return fmt::format("{}", value);
    }
    template <typename... Values>
    void add(const Values&... values) {
        ((text_ += textOf(values) + ';'), ...);
        text_ += '\n';
    }

    std::string text_;
};

constexpr const char* kFile = "packs/wet/wet.json";

// Glint's own declarations with one of a pack.
Result<MaterialModel> modelOf(const Json& declaration) {
    const std::string text = declaration.dump();
    std::vector<DeclarationFile> files;
    for (const base::BuiltinFile& file : declarationFiles()) {
        files.push_back({file.name, file.text});
    }
    files.push_back({kFile, text, true});
    return readDeclarations(files);
}

// Declarations to which a member is added at one place. Together they accept every member where it may stand.
struct Case {
    Place place;
    const char* pointer;
    const char* declaration;
};
constexpr const char* kFeature = R"({"name": "amber", "extension": "EXT_wet", "stage": "layer",
    "parameters": [{"name": "wetness", "type": "float", "default": 0.5},
                   {"name": "damp", "is": "ior", "default": 1},
                   {"name": "rim", "type": "enum", "values": ["soft", "hard"], "default": "hard"}],
    "textures": [{"name": "wetTexture"}, {"name": "dampTexture", "is": "specularTexture"}],
    "attributes": [{"name": "wear", "at": "_WEAR", "type": "float"}],
    "derived": [{"name": "wetTwice", "type": "float", "value": "2 * wetness"}],
    "features": [{"name": "zinc", "gltf": "wetness"}, {"name": "birch", "gltf": "wetness"}, {"name": "acid", "stage": "layer", "gltf": "dryness"}],
    "neutral": [{"when": "doubleSided", "because": "it is thin"}],
    "excludes": {"stage": "surface", "because": "it is wet"},
    "replaces": {"object": "KHR_materials_sheen"},
    "cost": {"instructions": 3, "fetches": 4},
    "effects": [{"does": "scatters", "when": "doubleSided", "text": "is {} wet"},
                {"does": "reflects", "when": "doubleSided", "roughness": "wetness"}],
    "glsl": {"bsdf": "wet.glsl", "layer": "wet.glsl"}})";
constexpr const char* kBare = R"({"name": "amber", "stage": "layer", "parameters": [
    {"name": "wetness", "type": "float", "default": 0.5, "range": [0, 1]}]})";
constexpr const char* kObject = R"({"name": "amber", "stage": "layer", "object": "wet",
    "features": [{"name": "acid", "stage": "layer", "gltf": "dryness"}], "neutral": [
    {"when": "doubleSided", "because": "it is thin"}]})";
constexpr const char* kModel = R"({"name": "amber", "extension": "EXT_wet", "stage": "base",
    "replaces": {"object": "pbrMetallicRoughness"}, "glsl": {"bsdf": "wet.glsl", "model": "wet.glsl"}})";
constexpr const char* kRoles = R"({"name": "amber", "extension": "EXT_wet", "stage": "base",
    "replaces": {"object": "pbrMetallicRoughness"},
    "parameters": [{"name": "cut", "role": "alphaCutoff", "default": 0.5}],
    "textures": [{"name": "wetTexture", "role": "emission"}],
    "glsl": {"bsdf": "wet.glsl", "model": "wet.glsl"}})";
constexpr const char* kBsdf = R"({"name": "amber", "extension": "EXT_wet", "stage": "surface",
    "parameters": [{"name": "tint", "type": "vec3", "default": [1, 1, 1]}], "glsl": {"bsdf": "wet.glsl"}})";
constexpr Case kCases[] = {
    {Place::File, "", R"({"name": "amber", "extension": "EXT_wet", "stage": "layer",
        "features": [{"name": "acid", "stage": "layer", "gltf": "dryness"}]})"},
    {Place::File, "", kBare},
    {Place::File, "", kObject},
    {Place::Glsl, "/glsl", kFeature},
    {Place::Glsl, "/glsl", kModel},
    {Place::Glsl, "/glsl", kBsdf},
    {Place::Parameter, "/parameters/0", kFeature},
    {Place::Parameter, "/parameters/1", kFeature},
    {Place::Parameter, "/parameters/2", kFeature},
    {Place::Parameter, "/parameters/0", kBare},
    {Place::Parameter, "/parameters/0", kBsdf},
    {Place::Texture, "/textures/0", kFeature},
    {Place::Texture, "/textures/1", kFeature},
    {Place::Parameter, "/parameters/0", kRoles},
    {Place::Texture, "/textures/0", kRoles},
    {Place::Attribute, "/attributes/0", kFeature},
    {Place::Derived, "/derived/0", kFeature},
    {Place::Feature, "/features/0", kFeature},
    {Place::Reason, "/neutral/0", kFeature},
    {Place::Effect, "/effects/0", kFeature},
    {Place::Effect, "/effects/1", kFeature},
    {Place::Replaces, "/replaces", kFeature},
    {Place::Excludes, "/excludes", kFeature},
    {Place::Cost, "/cost", kFeature},
};

// Values of members, of which one at least fits wherever the member may stand.
const std::map<std::string_view, std::vector<const char*>> kValues{
    {"name", {R"("moist")"}},
    {"about", {R"("It is wet.")"}},
    {"extension", {R"("EXT_moist")"}},
    {"object", {R"("moist")", R"("KHR_materials_clearcoat")"}},
    {"stage", {R"("emission")", R"("layer")"}},
    {"short", {R"("Moist")"}},
    {"order", {"3"}},
    {"needs", {R"("tangents")", R"(["texCoord1"])"}},
    {"light", {R"("both")"}},
    {"draft", {"true"}},
    {"ofBase", {"true"}},
    {"gltf", {R"("somewhere")"}},
    {"given", {R"("MASK")"}},
    {"cost", {R"({"instructions": 7, "fetches": 2})"}},
    {"neutral", {R"([{"when": "MASK", "because": "it has holes"}])"}},
    {"replaces", {R"({"object": "KHR_materials_sheen"})"}},
    {"excludes", {R"({"stage": "layer", "because": "it is wet"})"}},
    {"glsl", {R"({"surface": "moist.glsl"})"}},
    {"parameters", {R"([{"name": "moisture", "type": "float", "default": 1}])"}},
    {"textures", {R"([{"name": "moistTexture"}])"}},
    {"attributes", {R"([{"name": "moisture", "at": "_MOIST", "type": "float"}])"}},
    {"derived", {R"([{"name": "moisture", "type": "float", "value": "ior"}])"}},
    {"features", {R"([{"name": "moist", "gltf": "somewhere"}])"}},
    {"effects", {R"([{"does": "emits", "when": "MASK"}])"}},
    {"instructions", {"9"}},
    {"fetches", {"9"}},
    {"when", {R"("MASK")"}},
    {"because", {R"("it has holes")"}},
    {"sets", {R"({"sheenRoughnessFactor": 1})"}},
    {"but", {R"(["zinc"])"}},
    {"surface", {R"("moist.glsl")"}},
    {"bsdf", {R"("moist.glsl")"}},
    {"layer", {R"("moist.glsl")"}},
    {"model", {R"("moist.glsl")"}},
    {"diffuse", {R"("moist.glsl")"}},
    {"emission", {R"("moist.glsl")"}},
    {"coordinates", {R"("moist.glsl")", R"("own")"}},
    {"dimension", {R"("cube")"}},
    {"opacity", {R"("moist.glsl")"}},
    {"after", {R"(["specularGlossiness"])"}},
    {"coversEmission", {"true"}},
    {"traced", {"true"}},
    {"sampled", {"true"}},
    {"shadesAll", {"true"}},
    {"reciprocal", {"true"}},
    {"gainsEnergy", {R"("it is drawn")"}},
    {"at", {R"("moist")", R"("_MOIST")"}},
    {"type", {R"("vec2")", R"("float")", R"("color")"}},
    {"default", {"0.75", "1.75", "[1, 2]"}},
    {"count", {"1"}},
    {"values", {R"(["hard"])"}},
    {"range", {"[0, 2]"}},
    {"also", {"[7]"}},
    {"unit", {R"("metres")"}},
    {"record", {"false"}},
    {"of", {R"("clearcoat")"}},
    {"role", {R"("emissionStrength")", R"("baseColor")", R"("alphaTest")"}},
    {"is", {R"("metallicFactor")", R"("normalTexture")"}},
    {"value", {R"("3 * ior")"}},
    {"color", {"true"}},
    {"reads", {R"("rg")"}},
    {"roughness", {R"("g")", R"("0.3")"}},
    {"scales", {R"(["iridescenceThicknessMinimum"])"}},
    {"does", {R"("emits")", R"("reflects")"}},
    {"text", {R"("drips {}")"}},
    {"textureText", {R"("drips")"}},
};

TEST(DeclarationMembers, ChangeTheModelOrAreRefusedWhereverTheyStand) {
    std::set<std::pair<std::string_view, Place>> listed;
    for (const MemberRow& row : memberRows()) {
        for (int place = 0; row.name != "$schema" && place < static_cast<int>(Place::Count); ++place) {
            if (row.standsAt(static_cast<Place>(place))) {
                listed.emplace(row.name, static_cast<Place>(place));
            }
        }
    }
    std::set<std::pair<std::string_view, Place>> accepted;
    for (const Case& one : kCases) {
        const Json declaration = Json::parse(one.declaration);
        const MaterialModel plain = must(modelOf(declaration));
        const std::string before = Listing(plain).text();
        for (const auto& [member, values] : kValues) {
            for (const char* const value : values) {
                Json changed = declaration;
                Json& object = changed[Json::json_pointer(one.pointer)];
                object[std::string(member)] = Json::parse(value);
                if (changed == declaration) {
                    continue;
                }
                SCOPED_TRACE(changed.dump());
                if (!listed.contains({member, one.place})) {
                    EXPECT_THROW(Members(object, "", one.place), DeclarationFault);
                    continue;
                }
                const Result<MaterialModel> model = modelOf(changed);
                if (model) {
                    accepted.emplace(member, one.place);
                    // Words for people, and two names of one type.
                    const bool isComment =
                        (one.declaration == kBare && one.place == Place::File &&
                         (member == "about" || member == "name" || member == "stage")) ||
                        (member == "about" &&
                         (std::string_view(one.pointer).ends_with("/1") ||
                          declaration[Json::json_pointer(one.pointer)].contains("role"))) ||
                        (member == "type" && one.declaration == kBsdf);
                    EXPECT_TRUE(isComment || Listing(*model).text() != before)
                        << member << " is ignored at " << one.pointer;
                    continue;
                }
                EXPECT_EQ(model.error().id, "declaration");
                EXPECT_TRUE(model.error().where.starts_with(kFile)) << toString(model.error());
            }
        }
    }
    // Glint's own features have every role of features.
    EXPECT_EQ(listed.erase({"role", Place::Feature}), 1U);
    for (const auto& [member, place] : listed) {
        EXPECT_TRUE(accepted.contains({member, place})) << member << " at " << static_cast<int>(place);
    }
}

}  // namespace
}  // namespace glint::materials
