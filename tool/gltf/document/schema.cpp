#include "gltf/document/schema.h"

#include "materials/value_json.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace glint::gltf {

namespace {

// By Kind.
constexpr std::string_view kExpected[] = {
    "an integer",           "a number",  "an array of numbers",
    "true or false",        "a string",  "an integer",
    "an array of integers", "an object", "an object",
    "an array of objects",  "an object", "",
};

std::string_view expectedOf(Kind kind) {
    return kExpected[static_cast<std::size_t>(kind)];
}

// Returns the error of a value of another type than the expected one.
Diagnostic typeError(const Json& value, std::string_view expected) {
    return isHugeNumber(value)
               ? schemaError("json-range", "",
                             fmt::format("is {}, which is too large for a number of 64 bits",
                                         value.get_ref<const std::string&>().substr(kHugeNumberMark.size())))
               : schemaError("json-type", "", fmt::format("must be {}", expected));
}

Status checkRange(const Json& value, const Rule& rule) {
    const double number = value.get<double>();
    const bool isInside = std::isfinite(number) && number >= rule.min && number <= rule.max;
    return isInside ? okStatus()
                    : schemaError("json-range", "",
                                  fmt::format("is {}, outside of {} to {}", number, rule.min, rule.max));
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

Status checkIndex(const Json& root, Json& value, const Rule& rule) {
    if (!makeInteger(value)) {
        return typeError(value, expectedOf(Kind::Index));
    }
    const std::size_t size = arraySize(root, rule.target);
    if (value.is_number_unsigned() && value.get<std::uint64_t>() < size) {
        return okStatus();
    }
    Diagnostic error = schemaError(
        "index-range", "",
        fmt::format("refers to {}/{}, but that array has {} elements", rule.target, value.dump(), size));
    error.hint = "the file refers to something it does not hold: export it again";
    return error;
}

Status checkNumber(const Json& value, const Rule& rule) {
    return value.is_number() ? checkRange(value, rule) : typeError(value, expectedOf(Kind::Number));
}

Status checkInteger(Json& value, const Rule& rule) {
    return makeInteger(value) ? checkRange(value, rule) : typeError(value, expectedOf(Kind::Integer));
}

// Checks every element of an array by `check(element)`.
template <typename Check>
Status checkElements(Json& value, std::string_view expected, const Check& check) {
    if (!value.is_array()) {
        return typeError(value, expected);
    }
    for (std::size_t i = 0; i < value.size(); ++i) {
        if (const Status status = check(value[i]); !status) {
            return within(fmt::format("/{}", i), status);
        }
    }
    return okStatus();
}

Status checkNumbers(Json& value, const Rule& rule) {
    const std::string expected = rule.length == 0 ? std::string(expectedOf(Kind::Numbers))
                                                  : fmt::format("an array of {} numbers", rule.length);
    return value.is_array() && rule.length != 0 && value.size() != rule.length
               ? typeError(value, expected)
               : checkElements(value, expected,
                               [&](const Json& element) { return checkNumber(element, rule); });
}

Status checkIntegers(Json& value, const Rule& rule) {
    if (!value.is_object()) {
        return typeError(value, expectedOf(rule.kind));
    }
    for (auto member = value.begin(); member != value.end(); ++member) {
        if (const Status status = checkInteger(*member, rule); !status) {
            return within("/" + member.key(), status);
        }
    }
    return okStatus();
}

Status checkParameter(const Json& value, const Rule& rule) {
    std::vector<double> numbers;
    if (const auto fault = readValue(*rule.parameter, value, numbers)) {
        const Json::json_pointer place(fault->place);
        return isHugeNumber(value.at(place)) ? within(fault->place, typeError(value.at(place), ""))
                                             : schemaError("json-type", fault->place, fault->message);
    }
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        if (!(numbers[i] >= rule.min && numbers[i] <= rule.max)) {
            return within(
                placeOfNumber(*rule.parameter, static_cast<int>(i)),
                schemaError("json-range", "",
                            fmt::format("is {}, outside of {} to {}", numbers[i], rule.min, rule.max)));
        }
    }
    return okStatus();
}

Status checkValue(const Json& root, Json& value, const Rule& rule);

Status checkExtensions(const Json& root, Json& object, const Rule& rule) {
    if (!object.is_object()) {
        return typeError(object, expectedOf(rule.kind));
    }
    for (auto member = object.begin(); member != object.end(); ++member) {
        const auto found = std::ranges::lower_bound(rule.rules, member.key(), {}, &Rule::name);
        if (found == rule.rules.end() || found->name != member.key()) {
            continue;
        }
        if (const Status status = checkValue(root, *member, *found); !status) {
            return within("/" + member.key(), status);
        }
    }
    return okStatus();
}

Status checkValue(const Json& root, Json& value, const Rule& rule) {
    const auto expect = [&](bool holds) {
        return holds ? okStatus() : typeError(value, expectedOf(rule.kind));
    };
    switch (rule.kind) {
        case Kind::Integer:
            return checkInteger(value, rule);
        case Kind::Number:
            return checkNumber(value, rule);
        case Kind::Numbers:
            return checkNumbers(value, rule);
        case Kind::Bool:
            return expect(value.is_boolean());
        case Kind::Text:
            return expect(value.is_string() && !isHugeNumber(value));
        case Kind::Index:
            return checkIndex(root, value, rule);
        case Kind::Indices:
            return checkElements(value, expectedOf(rule.kind),
                                 [&](Json& element) { return checkIndex(root, element, rule); });
        case Kind::Integers:
            return checkIntegers(value, rule);
        case Kind::Object:
            return checkObject(root, value, rule.rules);
        case Kind::Objects:
            return checkElements(value, expectedOf(rule.kind),
                                 [&](Json& element) { return checkObject(root, element, rule.rules); });
        case Kind::Extensions:
            return checkExtensions(root, value, rule);
        case Kind::Value:
            return checkParameter(value, rule);
    }
    return okStatus();
}

}  // namespace

// The depth of the recursion is that of the tables, whatever the file contains.
Status checkObject(const Json& root, Json& object, std::span<const Rule> rules) {
    if (!object.is_object()) {
        return typeError(object, expectedOf(Kind::Object));
    }
    for (const Rule& rule : rules) {
        const auto member = object.find(rule.name);
        if (member == object.end() && rule.required) {
            return schemaError("json-missing", "", fmt::format("has no \"{}\"", rule.name));
        }
        if (member == object.end()) {
            continue;
        }
        if (const Status status = checkValue(root, *member, rule); !status) {
            return within(fmt::format("/{}", rule.name), status);
        }
    }
    return okStatus();
}

Diagnostic schemaError(std::string id, std::string pointer, std::string message) {
    return makeError(
        std::move(id), std::move(pointer), std::move(message),
        "correct the value, or export the file again; the Khronos glTF validator explains the rules");
}

Status within(std::string_view pointer, const Status& status) {
    if (status) {
        return status;
    }
    Diagnostic error = status.error();
    error.where.insert(0, pointer);
    return error;
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
