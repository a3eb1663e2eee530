// Checks of JSON objects against tables of rules: types, ranges and references, each failure with its
// pointer.
#pragma once

#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace glint::gltf {

using Json = nlohmann::json;

enum class Kind : std::uint8_t {
    Integer,
    Number,
    Numbers,  // array of Rule::length numbers; of any number of them where that is 0
    Bool,
    Text,
    Index,    // integer that indexes the array at Rule::target
    Indices,  // array of such integers
    Object,
    Objects,  // array of objects
};

// One member of an object. Members without a rule are not looked at.
struct Rule {
    std::string_view name;
    Kind kind = Kind::Number;
    bool required = false;
    // Range of Integer, Number and Numbers. A number that a float can't hold would turn into an infinity.
    double min = -static_cast<double>(std::numeric_limits<float>::max());
    double max = static_cast<double>(std::numeric_limits<float>::max());
    std::size_t length = 0;
    std::string_view target{};      // JSON pointer of the array that an index goes into
    std::span<const Rule> rules{};  // of Object and Objects
};

struct SchemaError {
    std::string id;
    std::string pointer;
    std::string message;
};

// Checks `object` and what its rules reach; numbers such as 3.0 in the place of an integer become integers.
// `root` is where Rule::target is looked up; it may hold `object`.
std::optional<SchemaError> checkObject(const Json& root, Json& object, std::span<const Rule> rules,
                                       const std::string& pointer);

// The member of that name, or null where it is absent or `object` is no object.
const Json* find(const Json& object, std::string_view name);
// The extension of that name, where it is an object; null otherwise.
const Json* findExtension(const Json& object, std::string_view name);
// The array of that name; an empty one where there is none.
const Json& arrayMember(const Json& object, std::string_view name);
// Elements of the array at that JSON pointer; 0 where there is none.
std::size_t arraySize(const Json& root, std::string_view pointer);

}  // namespace glint::gltf
