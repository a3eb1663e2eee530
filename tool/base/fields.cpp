#include "base/fields.h"

#include "base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace glint::base {

namespace {

bool isNothing(const Json& value) {
    return (value.is_string() && value.get_ref<const std::string&>().empty()) ||
           (value.is_number_float() && !std::isfinite(value.get<double>()));
}

Json valueOf(const Field& field, const void* object) {
    if (field.write == nullptr) {
        return field.members.empty() ? field.constant : writeFields(field.members, object);
    }
    Json value = field.write(object);
    return field.traits.orNull && isNothing(value) ? Json(nullptr) : std::move(value);
}

void readField(const Field& field, void* object, JsonReader& reader, const Json& value,
               const std::string& place) {
    if (!field.constant.is_null() && value != field.constant) {
        if (field.constant.is_number()) {
            reader.fail(place, fmt::format("is {}; this glint reads {}",
                                           reader.count(value, place, UINT32_MAX), field.constant.dump()));
        } else {
            reader.fail(place, "is not " + field.constant.dump());
        }
    } else if (!field.members.empty()) {
        readFields(field.members, object, reader, value, place);
    } else if (field.read != nullptr && !(field.traits.orNull && value.is_null())) {
        field.read(object, reader, value, place, field.traits);
    }
}

// Output alone is not read, nor is an object of it.
bool isRead(const Field& field) {
    return field.read != nullptr || !field.constant.is_null() || std::ranges::any_of(field.members, isRead);
}

Json boundOf(double value) {
    return std::trunc(value) == value ? Json(static_cast<std::int64_t>(value)) : Json(value);
}

Json schemaOfField(const Field& field) {
    if (field.write == nullptr) {
        return field.members.empty() ? Json{{"const", field.constant}} : schemaOfFields(field.members);
    }
    Json schema = field.schema(field.traits);
    return field.traits.orNull ? schemaOrNull(std::move(schema)) : schema;
}

}  // namespace

Json writeFields(const Fields& fields, const void* object) {
    Json json = Json::object();
    for (const Field& field : fields) {
        Json value = valueOf(field, object);
        if (*field.name == '\0') {
            json.update(value);
        } else if (!value.is_null() || !field.traits.optional) {
            json[field.name] = std::move(value);
        }
    }
    return json;
}

void readFields(const Fields& fields, void* object, JsonReader& reader, const Json& json,
                const std::string& place) {
    if (!json.is_object()) {
        reader.fail(place, "is no JSON object");
    }
    for (const Field& field : fields) {
        if (!isRead(field)) {
            continue;
        }
        if (*field.name == '\0') {
            field.read(object, reader, json, place, field.traits);
        } else if (!(field.traits.optional && !json.contains(field.name))) {
            const Json* const value = reader.ok() ? reader.member(json, place, field.name) : nullptr;
            if (value != nullptr) {
                readField(field, object, reader, *value, place + "/" + field.name);
            }
        }
    }
}

void refuseOthers(const Fields& fields, JsonReader& reader, const Json& json, const std::string& place) {
    std::vector<std::string> names;
    for (const Field& field : fields) {
        names.emplace_back(field.name);
    }
    for (const auto& [name, value] : json.items()) {
        if (std::ranges::find(names, name) == names.end()) {
            reader.fail(fmt::format("{}/{}", place, name),
                        fmt::format("is no member{}", suggestion(name, names)));
        }
    }
}

Json schemaOfFields(const Fields& fields) {
    Json required = Json::array();
    Json properties = Json::object();
    for (const Field& field : fields) {
        Json schema = schemaOfField(field);
        if (*field.name == '\0') {
            required.insert(required.end(), schema["required"].begin(), schema["required"].end());
            properties.update(schema["properties"]);
            continue;
        }
        if (!field.traits.optional) {
            required.push_back(field.name);
        }
        properties[field.name] = {{"description", field.what}};
        properties[field.name].update(schema);
    }
    return {{"type", "object"},
            {"additionalProperties", false},
            {"required", std::move(required)},
            {"properties", std::move(properties)}};
}

Json schemaOfNumber(bool isWhole, const FieldTraits& traits) {
    Json schema{{"type", isWhole ? "integer" : "number"}};
    if (isWhole || traits.least) {
        schema["minimum"] = boundOf(traits.least.value_or(0.0));
    }
    if (traits.most) {
        schema["maximum"] = boundOf(*traits.most);
    }
    return schema;
}

Json schemaOfText(const FieldTraits& traits) {
    Json schema{{"type", "string"}};
    if (!traits.names.empty()) {
        schema["enum"] = traits.names;
    }
    if (traits.pattern != nullptr) {
        schema["pattern"] = traits.pattern;
    }
    return schema;
}

Json schemaOfList(Json elements, const FieldTraits& traits) {
    Json schema{{"type", "array"}, {"items", std::move(elements)}};
    if (traits.leastElements > 0) {
        schema["minItems"] = traits.leastElements;
    }
    if (traits.mostElements > 0) {
        schema["maxItems"] = traits.mostElements;
    }
    return schema;
}

Json schemaOrNull(Json schema) {
    if (schema.contains("type") && schema["type"].is_string() && !schema.contains("enum")) {
        schema["type"] = Json::array({schema["type"], "null"});
        return schema;
    }
    return schemaOfAny({{{"type", "null"}}, std::move(schema)});
}

Json schemaOfAny(std::vector<Json> schemas) {
    return {{"anyOf", std::move(schemas)}};
}

Field group(const char* name, const char* what, Fields members) {
    return {name, what, {}, nullptr, nullptr, nullptr, std::move(members), {}};
}

Field constant(const char* name, const char* what, Json value) {
    return {name, what, {}, nullptr, nullptr, nullptr, {}, std::move(value)};
}

}  // namespace glint::base
