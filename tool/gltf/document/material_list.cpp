#include "gltf/document/material_list.h"

#include "base/fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace glint::gltf {

using base::field;

namespace {

constexpr const char* kMarker = "materialList";
constexpr double kMost = 1e9;
constexpr base::FieldTraits kMayBeMissing{.orNull = true, .optional = true};

base::Field readBy(base::Field field, base::FieldReader read, base::FieldSchema schema) {
    field.read = read;
    field.schema = schema;
    return field;
}

// Two numbers, which may be missing.
template <auto Member>
base::Field pair(const char* name, const char* what) {
    base::Field field = base::output<Member>(
        name, what,
        {.least = -kMost, .most = kMost, .optional = true, .leastElements = 2, .mostElements = 2});
    field.read = [](void* object, base::JsonReader& reader, const base::Json& json, const std::string& place,
                    const base::FieldTraits& traits) {
        if (json.is_null()) {
            return;
        }
        std::vector<double> numbers;
        base::detail::read(numbers, reader, json, place, {.least = traits.least, .most = traits.most});
        if (reader.ok() && numbers.size() != 2) {
            reader.fail(
                place, fmt::format("has {} number{}, not 2", numbers.size(), numbers.size() == 1 ? "" : "s"));
        } else if (reader.ok()) {
            static_cast<base::detail::ObjectOf<Member>*>(object)->*Member =
                std::array<double, 2>{numbers[0], numbers[1]};
        }
    };
    return field;
}

// An object of which most have one member alone: then its text may stand for it.
template <typename T, auto Member>
T readShort(base::JsonReader& reader, const base::Json& json, const std::string& place) {
    if (!json.is_string()) {
        T value = base::readAs<T>(reader, json, place);
        if (reader.ok()) {
            base::refuseOthers(base::fields<T>(), reader, json, place);
        }
        return value;
    }
    T value;
    value.*Member = json.get<std::string>();
    return value;
}

template <typename T>
base::Json schemaOfShort() {
    return base::schemaOfAny({base::schemaOfText({}), base::schemaOf<T>()});
}

base::Json mapOf(base::Json values) {
    return {{"type", "object"}, {"additionalProperties", std::move(values)}};
}

// ---- The members of a material with a short form ----

using M = MaterialDescription;

// The depth of an array of matrices.
constexpr int kDeepest = 2;

ParameterInput readInput(base::JsonReader& reader, const base::Json& json, const std::string& place,
                         int depth) {
    if (json.is_boolean()) {
        return json.get<bool>();
    }
    if (json.is_string()) {
        return json.get<std::string>();
    }
    if (!json.is_array() || depth == kDeepest) {
        constexpr double kLargest = std::numeric_limits<float>::max();
        return reader.number(json, place, -kLargest, kLargest);
    }
    ParameterInput::List list;
    reader.each(json, place, [&](const base::Json& one, const auto& there) {
        list.push_back(readInput(reader, one, there, depth + 1));
    });
    return ParameterInput(std::move(list));
}

base::Json writeValues(const void* object) {
    base::Json values = base::Json::object();
    for (const auto& [name, input] : static_cast<const M*>(object)->values) {
        values[name] = toJson<base::Json>(input);
    }
    return values;
}

void readValues(void* object, base::JsonReader& reader, const base::Json& json, const std::string& place,
                const base::FieldTraits& /*traits*/) {
    reader.eachMember(json, place, [&](const std::string& name, const base::Json& one, const auto& there) {
        static_cast<M*>(object)->values[name] = readInput(reader, one, there, 0);
    });
}

base::Json schemaOfValues(const base::FieldTraits& /*traits*/) {
    base::Json one = base::schemaOfAny(
        {base::schemaOfNumber(false, {.least = -kMost}), {{"type", "boolean"}}, base::schemaOfText({})});
    base::Json value = one;
    for (int depth = 0; depth < kDeepest; ++depth) {
        value = base::schemaOfAny({one, base::schemaOfList(value, {.leastElements = 1})});
    }
    return mapOf(value);
}

void readTextures(void* object, base::JsonReader& reader, const base::Json& json, const std::string& place,
                  const base::FieldTraits& /*traits*/) {
    reader.eachMember(json, place, [&](const std::string& name, const base::Json& one, const auto& there) {
        static_cast<M*>(object)->textures[name] =
            readShort<TextureDescription, &TextureDescription::file>(reader, one, there);
    });
}

base::Json schemaOfTextures(const base::FieldTraits& /*traits*/) {
    return mapOf(schemaOfShort<TextureDescription>());
}

void readEdited(void* object, base::JsonReader& reader, const base::Json& json, const std::string& place,
                const base::FieldTraits& /*traits*/) {
    reader.each(json, place, [&](const base::Json& one, const auto& there) {
        static_cast<M*>(object)->edited.push_back(
            readShort<EditedParameter, &EditedParameter::parameter>(reader, one, there));
    });
}

base::Json schemaOfEdited(const base::FieldTraits& /*traits*/) {
    return base::schemaOfList(schemaOfShort<EditedParameter>(), {});
}

}  // namespace

base::Fields fieldsOf(const TextureDescription*) {
    using T = TextureDescription;
    return {
        field<&T::file>(
            "file", "The image, relative to the list. Without it, a program gives the texture at run time.",
            kMayBeMissing),
        field<&T::name>("name", "A name for programs that give it; that of the texture without it.",
                        kMayBeMissing),
        field<&T::texCoord>("texCoord", "The UV set.", {.most = 1, .optional = true}),
        pair<&T::offset>("offset", "Of the UVs."),
        pair<&T::scale>("scale", "Of the UVs."),
        field<&T::rotation>("rotation", "Of the UVs, radians.",
                            {.least = -kMost, .most = kMost, .optional = true}),
    };
}

base::Fields fieldsOf(const EditedParameter*) {
    using T = EditedParameter;
    return {
        field<&T::parameter>("parameter", "Its name."),
        pair<&T::range>("range", "Its least and its greatest value; those of the declaration without it.")};
}

base::Fields fieldsOf(const MaterialDescription*) {
    return {
        field<&M::name>("name", "Of the material, for people and programs."),
        field<&M::model>("model",
                         "Name of the declaration of its base; without it, glTF's metallic-roughness.",
                         kMayBeMissing),
        field<&M::features>("features", "Names of features that it asks for and gives no value of.",
                            kMayBeMissing),
        {"values", "A value, or a list of them, by the names of parameters.", kMayBeMissing, writeValues,
         readValues, schemaOfValues},
        readBy(
            base::output<&M::textures>(
                "textures", "An image's file relative to the list, or an object, by the names of textures.",
                kMayBeMissing),
            readTextures, schemaOfTextures),
        readBy(base::output<&M::edited>(
                   "edited",
                   "Parameters that a program may set to anything in their range: the name of one, or an "
                   "object.",
                   kMayBeMissing),
               readEdited, schemaOfEdited),
        field<&M::attributes>(
            "attributes",
            "Attributes of vertices that all its surfaces have; NORMAL and TEXCOORD_0 without it.",
            kMayBeMissing),
        field(
            "alphaMode", "As in glTF.",
            [](const M& it) { return std::string(kAlphaModes[static_cast<std::size_t>(it.alphaMode)]); },
            [](M& it, const std::string& name) {
                it.alphaMode = static_cast<materials::AlphaMode>(std::ranges::find(kAlphaModes, name) -
                                                                 std::begin(kAlphaModes));
            },
            {.optional = true, .names = {std::begin(kAlphaModes), std::end(kAlphaModes)}}),
        field<&M::doubleSided>("doubleSided", "Whether both sides of its triangles are seen.",
                               {.optional = true}),
        field<&M::weight>("weight",
                          "Share of the hits in pictures, relative to that of others; 1 without it.",
                          {.least = 1e-6, .most = 1e6, .optional = true}),
    };
}

base::Fields fieldsOf(const MaterialSet*) {
    base::Field schema{"$schema", "This schema, for editors.", {.orNull = true, .optional = true}};
    schema.write = [](const void*) { return base::Json(nullptr); };
    schema.read = [](void*, base::JsonReader&, const base::Json&, const std::string&,
                     const base::FieldTraits&) {};
    schema.schema = base::schemaOfText;
    return {schema, base::constant(kMarker, "Version of the format.", 1),
            field<&MaterialSet::materials>("materials", "The materials.", {.leastElements = 1})};
}

bool isMaterialList(const Json& json) {
    return json.is_object() && json.contains(kMarker);
}

base::JsonReader materialListReader(const std::filesystem::path& path) {
    return {path, "material-list", "docs/material_lists.md describes materials without a scene"};
}

Result<MaterialSet> readMaterialList(ByteView text, const std::filesystem::path& path) {
    base::JsonReader reader = materialListReader(path);
    const base::Json json = base::Json::parse(text.begin(), text.end(), nullptr, false);
    auto set = base::readAs<MaterialSet>(reader, json);
    set.path = path;
    if (reader.ok()) {
        base::refuseOthers(base::fields<MaterialSet>(), reader, json, "");
        for (std::size_t i = 0; i < set.materials.size(); ++i) {
            base::refuseOthers(base::fields<MaterialDescription>(), reader, json["materials"][i],
                               fmt::format("/materials/{}", i));
        }
    }
    return reader.ok() ? Result<MaterialSet>(std::move(set)) : reader.error();
}

Status checkMaterialSet(const MaterialSet& set) {
    base::JsonReader reader = materialListReader(set.path);
    base::readAs<MaterialSet>(reader, base::jsonOf(set));
    return reader.ok() ? okStatus() : Status(reader.error());
}

}  // namespace glint::gltf
