// Short forms for the tables of rules against which a document is checked.
#pragma once

#include "gltf/document/schema.h"

namespace glint::gltf::rules {

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

}  // namespace glint::gltf::rules
