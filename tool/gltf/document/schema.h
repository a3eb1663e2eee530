// Checks JSON objects against tables of rules: types, ranges and references. Each failure has its JSON
// pointer.
#pragma once

#include <glint/result.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace glint::materials {
struct Parameter;
}

namespace glint::gltf {

using Json = nlohmann::json;

enum class Kind : std::uint8_t {
    Integer,
    Number,
    Numbers,  // array of Rule::length numbers, or of any number of them if the length is 0
    Bool,
    Text,
    Index,     // integer that indexes the array at Rule::target
    Indices,   // array of such integers
    Integers,  // object whose members are integers of any names
    Object,
    Objects,     // array of objects
    Extensions,  // object of which few members are there: `rules` are sorted by name, and none is required
    Value,       // of the parameter Rule::parameter; its range is not checked
};

// A rule for one member of an object. Members without a rule are not checked.
struct Rule {
    std::string_view name;
    Kind kind = Kind::Number;
    bool required = false;
    // Range of Integer, Integers, Number and Numbers. A number that does not fit into a float would become an
    // infinity.
    double min = -static_cast<double>(std::numeric_limits<float>::max());
    double max = static_cast<double>(std::numeric_limits<float>::max());
    std::size_t length = 0;
    std::string_view target{};      // JSON pointer of the array into which an index points
    std::span<const Rule> rules{};  // for Object, Objects and Extensions
    const materials::Parameter* parameter = nullptr;
};

// Short forms for the tables of rules.
namespace rules {

// A larger value does not fit into an int.
inline constexpr double kMaxInt = 2147483647.0;
// Above this value, doubles no longer represent every integer.
inline constexpr double kMaxSize = 9007199254740991.0;

constexpr Rule text(std::string_view name, bool required = false) {
    return {.name = name, .kind = Kind::Text, .required = required};
}
constexpr Rule boolean(std::string_view name) {
    return {.name = name, .kind = Kind::Bool};
}
constexpr Rule number(std::string_view name, bool required = false) {
    return {.name = name, .kind = Kind::Number, .required = required};
}
constexpr Rule numbers(std::string_view name, std::size_t length) {
    return {.name = name, .kind = Kind::Numbers, .length = length};
}
constexpr Rule integer(std::string_view name, double min, double max, bool required = false) {
    return {.name = name, .kind = Kind::Integer, .required = required, .min = min, .max = max};
}
constexpr Rule integers(std::string_view name, double min, double max, bool required = false) {
    return {.name = name, .kind = Kind::Integers, .required = required, .min = min, .max = max};
}
constexpr Rule size(std::string_view name, double min = 0.0, bool required = false) {
    return integer(name, min, kMaxSize, required);
}
constexpr Rule index(std::string_view name, std::string_view target, bool required = false) {
    return {.name = name, .kind = Kind::Index, .required = required, .target = target};
}
constexpr Rule indices(std::string_view name, std::string_view target, bool required = false) {
    return {.name = name, .kind = Kind::Indices, .required = required, .target = target};
}
constexpr Rule object(std::string_view name, std::span<const Rule> rules, bool required = false) {
    return {.name = name, .kind = Kind::Object, .required = required, .rules = rules};
}
constexpr Rule objects(std::string_view name, std::span<const Rule> rules, bool required = false) {
    return {.name = name, .kind = Kind::Objects, .required = required, .rules = rules};
}

}  // namespace rules

// Checks `object` and everything that its rules reach. A number such as 3.0 becomes an integer if the rule
// asks for one, and an integer that is not negative an unsigned one, because tinygltf tells them apart.
// Rule::target is looked up in `root`, which may contain `object`. The place of an error is a JSON pointer
// that starts at `object`.
Status checkObject(const Json& root, Json& object, std::span<const Rule> rules);

// Returns the error of a document that breaks a rule.
Diagnostic schemaError(std::string id, std::string pointer, std::string message);
// Puts the place of an object before the place in it that an error names.
Status within(std::string_view pointer, const Status& status);

// Begins the text that stands for a number which a double can't hold. The rest of the text is the number.
inline constexpr std::string_view kHugeNumberMark("\0number ", 8);
bool isHugeNumber(const Json& value);

// Returns the member of that name, or null if it is absent or `object` is not an object.
const Json* find(const Json& object, std::string_view name);
// Returns the extension of that name if it is an object, and null otherwise.
const Json* findExtension(const Json& object, std::string_view name);
// Returns the array of that name, or an empty one if there is none.
const Json& arrayMember(const Json& object, std::string_view name);
// Returns the member of a checked object, or `fallback` where it is absent.
template <typename T>
T memberOr(const Json& object, std::string_view name, T fallback) {
    const Json* const member = find(object, name);
    return member == nullptr ? std::move(fallback) : member->get<T>();
}
// Calls visit(element, pointer) for each element of the array of that name. `pointer` is that of the object.
template <typename Visit>
void visitElements(const Json& object, std::string_view name, std::string_view pointer, const Visit& visit) {
    std::size_t index = 0;
    for (const Json& element : arrayMember(object, name)) {
        visit(element, fmt::format("{}/{}/{}", pointer, name, index++));
    }
}
// Calls visit(primitive, pointer) for each primitive of the document's meshes.
template <typename Visit>
void visitPrimitives(const Json& root, const Visit& visit) {
    visitElements(root, "meshes", "", [&](const Json& mesh, const std::string& pointer) {
        visitElements(mesh, "primitives", pointer, visit);
    });
}
// Returns how many elements the array at that JSON pointer has, or 0 if there is no array.
std::size_t arraySize(const Json& root, std::string_view pointer);

}  // namespace glint::gltf
