// The types of values. This table alone says what a type is: its name in declarations, its numbers, what GLSL
// gets of it, and how a record of a material holds it.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>

namespace glint::materials {

// What a number of a value is. Materials hold every number as a double, records as 32 bits.
enum class NumberKind : std::uint8_t {
    Real,      // a float
    Signed,    // a whole number
    Unsigned,  // one from 0
    Truth,     // 0: false, 1: true
    Name,      // the index of a name that the declaration lists
    Word,      // half of a device address, which only a program can give; the low half comes first
};

struct ValueType {
    std::string_view name;   // in declarations
    std::string_view glsl;   // of what GLSL reads
    std::string_view field;  // in GLSL, of a member of a record; matrices are arrays of it, by columns
    std::string_view cpp;    // the same in C++, below the namespace glint
    NumberKind kind = NumberKind::Real;
    int channels = 1;  // the numbers of a value

    constexpr bool isVector() const {
        return kind == NumberKind::Real && !isMatrix();
    }
    constexpr bool isMatrix() const {
        return channels > 4;
    }
    constexpr bool isAddress() const {
        return kind == NumberKind::Word;
    }
    // Returns whether values lie within a range. The others are compared by name, or not at all.
    constexpr bool hasRange() const {
        return kind == NumberKind::Real || kind == NumberKind::Signed || kind == NumberKind::Unsigned;
    }
};
inline constexpr ValueType kTypes[] = {
    {"float", "float", "float", "float"},
    {"vec2", "vec2", "vec2", "gpu::vec2", NumberKind::Real, 2},
    {"vec3", "vec3", "vec3", "gpu::vec3", NumberKind::Real, 3},
    {"color", "vec3", "vec3", "gpu::vec3", NumberKind::Real, 3},
    {"vec4", "vec4", "vec4", "gpu::vec4", NumberKind::Real, 4},
    {"int", "int", "int", "std::int32_t", NumberKind::Signed},
    {"uint", "uint", "uint", "std::uint32_t", NumberKind::Unsigned},
    {"bool", "bool", "uint", "std::uint32_t", NumberKind::Truth},
    {"enum", "uint", "uint", "std::uint32_t", NumberKind::Name},
    {"mat3", "mat3", "float", "float", NumberKind::Real, 9},
    {"mat4", "mat4", "float", "float", NumberKind::Real, 16},
    {"address", "uvec2", "uvec2", "gpu::uvec2", NumberKind::Word, 2},
};
// A number or a vector in floating point: what vertices have, derived fields are, textures scale and
// animations change.
inline constexpr std::span kVectorTypes(kTypes, 5);

inline constexpr std::uint32_t kNumberBytes = 4;  // of a number in a record
inline constexpr double kLargestFloat = std::numeric_limits<float>::max();

// The least and the greatest number of the kind. `names`: how many names there are, for NumberKind::Name.
double leastOf(NumberKind kind);
double greatestOf(NumberKind kind, std::size_t names);

// Returns the 32 bits by which a record holds a number.
std::uint32_t wordOf(NumberKind kind, double number);

// Each returns the expression of one value in GLSL: of the expressions of numbers in a record's floats, which
// hold the bits of any kind; of the member of a record with the type ValueType::field; and of numbers.
std::string valueOfFloats(const ValueType& type, std::span<const std::string> floats);
std::string valueOfField(const ValueType& type, const std::string& field);
std::string literalOf(const ValueType& type, std::span<const double> numbers);

}  // namespace glint::materials
