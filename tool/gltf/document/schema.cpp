#include "gltf/document/schema.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace glint::gltf {

namespace {

std::string_view describe(Kind kind) {
    switch (kind) {
        case Kind::Integer:
        case Kind::Index:
            return "an integer";
        case Kind::Number:
            return "a number";
        case Kind::Numbers:
            return "an array of numbers";
        case Kind::Bool:
            return "true or false";
        case Kind::Text:
            return "a string";
        case Kind::Indices:
            return "an array of integers";
        case Kind::Integers:
        case Kind::Object:
            return "an object";
        case Kind::Objects:
            return "an array of objects";
    }
    return "another type";
}

// Returns what is wrong with a value of another type than the expected one.
SchemaError typeError(const Json& value, const std::string& pointer, std::string_view expected) {
    if (isHugeNumber(value)) {
        return {"json-range", pointer,
                fmt::format("is {}, which is too large for a number of 64 bits",
                            value.get_ref<const std::string&>().substr(kHugeNumberMark.size()))};
    }
    return {"json-type", pointer, fmt::format("must be {}", expected)};
}

std::optional<SchemaError> checkRange(const Json& value, const Rule& rule, const std::string& pointer) {
    const double number = value.get<double>();
    if (!std::isfinite(number) || number < rule.min || number > rule.max) {
        return SchemaError{"json-range", pointer,
                           fmt::format("is {}, outside of {} to {}", number, rule.min, rule.max)};
    }
    return std::nullopt;
}

// Turns 3.0 into 3. JSON has one type of number, but tinygltf distinguishes three.
bool makeInteger(Json& value) {
    // Above this value, a double need not represent every integer.
    constexpr double kExact = 9007199254740992.0;
    if (value.is_number_float()) {
        const double number = value.get<double>();
        if (std::trunc(number) == number && std::abs(number) <= kExact) {
            value = static_cast<std::int64_t>(number);
        }
    }
    if (value.is_number_integer() && !value.is_number_unsigned() && value.get<std::int64_t>() >= 0) {
        value = value.get<std::uint64_t>();
    }
    return value.is_number_integer();
}

std::optional<SchemaError> checkIndex(const Json& root, Json& value, const Rule& rule,
                                      const std::string& pointer) {
    if (!makeInteger(value)) {
        return typeError(value, pointer, describe(Kind::Index));
    }
    const std::size_t size = arraySize(root, rule.target);
    const bool inside = value.is_number_unsigned()
                            ? value.get<std::uint64_t>() < size
                            : value.get<std::int64_t>() >= 0 && value.get<std::uint64_t>() < size;
    if (!inside) {
        return SchemaError{
            "index-range", pointer,
            fmt::format("refers to {}/{}, but that array has {} elements", rule.target, value.dump(), size)};
    }
    return std::nullopt;
}

std::optional<SchemaError> checkNumbers(Json& value, const Rule& rule, const std::string& pointer) {
    if (!value.is_array() || (rule.length != 0 && value.size() != rule.length)) {
        return typeError(value, pointer,
                         rule.length == 0 ? std::string(describe(Kind::Numbers))
                                          : fmt::format("an array of {} numbers", rule.length));
    }
    for (std::size_t i = 0; i < value.size(); ++i) {
        const std::string element = fmt::format("{}/{}", pointer, i);
        if (!value[i].is_number()) {
            return typeError(value[i], element, describe(Kind::Number));
        }
        if (auto error = checkRange(value[i], rule, element)) {
            return error;
        }
    }
    return std::nullopt;
}

std::optional<SchemaError> checkIntegers(Json& value, const Rule& rule, const std::string& pointer) {
    if (!value.is_object()) {
        return typeError(value, pointer, describe(rule.kind));
    }
    for (auto member = value.begin(); member != value.end(); ++member) {
        const std::string place = fmt::format("{}/{}", pointer, member.key());
        if (!makeInteger(*member)) {
            return typeError(*member, place, describe(Kind::Integer));
        }
        if (auto error = checkRange(*member, rule, place)) {
            return error;
        }
    }
    return std::nullopt;
}

// Checks every element of an array by `check(element, pointer)`.
template <typename Check>
std::optional<SchemaError> checkElements(Json& value, Kind kind, const std::string& pointer,
                                         const Check& check) {
    if (!value.is_array()) {
        return typeError(value, pointer, describe(kind));
    }
    for (std::size_t i = 0; i < value.size(); ++i) {
        if (auto error = check(value[i], fmt::format("{}/{}", pointer, i))) {
            return error;
        }
    }
    return std::nullopt;
}

std::optional<SchemaError> checkValue(const Json& root, Json& value, const Rule& rule,
                                      const std::string& pointer) {
    const auto expect = [&](bool holds) -> std::optional<SchemaError> {
        return holds ? std::nullopt : std::optional(typeError(value, pointer, describe(rule.kind)));
    };
    switch (rule.kind) {
        case Kind::Integer:
            return makeInteger(value) ? checkRange(value, rule, pointer) : expect(false);
        case Kind::Number:
            return value.is_number() ? checkRange(value, rule, pointer) : expect(false);
        case Kind::Numbers:
            return checkNumbers(value, rule, pointer);
        case Kind::Bool:
            return expect(value.is_boolean());
        case Kind::Text:
            return expect(value.is_string() && !isHugeNumber(value));
        case Kind::Index:
            return checkIndex(root, value, rule, pointer);
        case Kind::Indices:
            return checkElements(value, rule.kind, pointer, [&](Json& element, const std::string& where) {
                return checkIndex(root, element, rule, where);
            });
        case Kind::Integers:
            return checkIntegers(value, rule, pointer);
        case Kind::Object:
            return checkObject(root, value, rule.rules, pointer);
        case Kind::Objects:
            return checkElements(value, rule.kind, pointer, [&](Json& element, const std::string& where) {
                return checkObject(root, element, rule.rules, where);
            });
    }
    return std::nullopt;
}

}  // namespace

// The depth of the recursion is that of the tables, whatever the file contains.
std::optional<SchemaError> checkObject(const Json& root, Json& object, std::span<const Rule> rules,
                                       const std::string& pointer) {
    if (!object.is_object()) {
        return typeError(object, pointer, describe(Kind::Object));
    }
    for (const Rule& rule : rules) {
        const auto member = object.find(rule.name);
        if (member == object.end()) {
            if (rule.required) {
                return SchemaError{"json-missing", pointer, fmt::format("has no \"{}\"", rule.name)};
            }
            continue;
        }
        if (auto error = checkValue(root, *member, rule, fmt::format("{}/{}", pointer, rule.name))) {
            return error;
        }
    }
    return std::nullopt;
}

bool isHugeNumber(const Json& value) {
    return value.is_string() && value.get_ref<const std::string&>().starts_with(kHugeNumberMark);
}

const Json* find(const Json& object, std::string_view name) {
    if (!object.is_object()) {
        return nullptr;
    }
    const auto member = object.find(name);
    return member == object.end() ? nullptr : &*member;
}

const Json* findExtension(const Json& object, std::string_view name) {
    const Json* extensions = find(object, "extensions");
    const Json* extension = extensions == nullptr ? nullptr : find(*extensions, name);
    return extension != nullptr && extension->is_object() ? extension : nullptr;
}

const Json& arrayMember(const Json& object, std::string_view name) {
    static const Json kNone = Json::array();
    const Json* member = find(object, name);
    return member != nullptr && member->is_array() ? *member : kNone;
}

namespace {

template <typename T>
T memberOr(const Json& object, std::string_view name, T fallback) {
    const Json* const member = find(object, name);
    return member == nullptr ? std::move(fallback) : member->get<T>();
}

}  // namespace

std::uint64_t sizeMember(const Json& object, std::string_view name) {
    return memberOr<std::uint64_t>(object, name, 0);
}

std::string textMember(const Json& object, std::string_view name) {
    return memberOr<std::string>(object, name, {});
}

bool boolMember(const Json& object, std::string_view name, bool fallback) {
    return memberOr(object, name, fallback);
}

std::size_t arraySize(const Json& root, std::string_view pointer) {
    const Json* value = &root;
    while (value != nullptr && !pointer.empty()) {
        pointer.remove_prefix(1);
        const std::string_view token = pointer.substr(0, pointer.find('/'));
        value = find(*value, token);
        pointer.remove_prefix(token.size());
    }
    return value != nullptr && value->is_array() ? value->size() : 0;
}

}  // namespace glint::gltf
