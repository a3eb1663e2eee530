#include "materials/value_type.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <bit>
#include <cmath>
#include <vector>

namespace glint::materials {

namespace {

// The expression that gives a number of a kind, by NumberKind: of a float with its bits, and of a member.
struct Reading {
    const char* ofFloat;
    const char* ofField;
};
constexpr Reading kReadings[] = {
    {"{}", "{}"},                                   // Real
    {"floatBitsToInt({})", "{}"},                   // Signed
    {"floatBitsToUint({})", "{}"},                  // Unsigned
    {"(floatBitsToUint({}) != 0u)", "({} != 0u)"},  // Truth
    {"floatBitsToUint({})", "{}"},                  // Name
    {"floatBitsToUint({})", "{}"},                  // Word
};

const Reading& readingOf(const ValueType& type) {
    return kReadings[static_cast<std::size_t>(type.kind)];
}

std::string valueOf(const ValueType& type, const std::vector<std::string>& numbers) {
    return type.channels == 1 ? numbers[0] : fmt::format("{}({})", type.glsl, fmt::join(numbers, ", "));
}

std::string literalOf(NumberKind kind, double number) {
    switch (kind) {
        case NumberKind::Real:
            return fmt::format("{:#.9g}", std::isinf(number) ? 0.0F : static_cast<float>(number));
        case NumberKind::Signed:
            // The least number has no literal of its own.
            return fmt::format("int({:#x}u)", wordOf(kind, number));
        case NumberKind::Truth:
            return number != 0.0 ? "true" : "false";
        default:
            return fmt::format("{}u", wordOf(kind, number));
    }
}

}  // namespace

double leastOf(NumberKind kind) {
    return kind == NumberKind::Real     ? -kLargestFloat
           : kind == NumberKind::Signed ? std::numeric_limits<std::int32_t>::min()
                                        : 0.0;
}

double greatestOf(NumberKind kind, std::size_t names) {
    switch (kind) {
        case NumberKind::Real:
            return kLargestFloat;
        case NumberKind::Signed:
            return std::numeric_limits<std::int32_t>::max();
        case NumberKind::Unsigned:
        case NumberKind::Word:
            return std::numeric_limits<std::uint32_t>::max();
        case NumberKind::Truth:
            return 1.0;
        case NumberKind::Name:
            break;
    }
    return static_cast<double>(names) - 1.0;
}

std::uint32_t wordOf(NumberKind kind, double number) {
    return kind == NumberKind::Real     ? std::bit_cast<std::uint32_t>(static_cast<float>(number))
           : kind == NumberKind::Signed ? static_cast<std::uint32_t>(static_cast<std::int32_t>(number))
                                        : static_cast<std::uint32_t>(number);
}

std::string valueOfFloats(const ValueType& type, std::span<const std::string> floats) {
    std::vector<std::string> numbers;
    for (const std::string& number : floats) {
        numbers.push_back(fmt::format(fmt::runtime(readingOf(type).ofFloat), number));
    }
    return valueOf(type, numbers);
}

std::string valueOfField(const ValueType& type, const std::string& field) {
    return fmt::format(fmt::runtime(readingOf(type).ofField), field);
}

std::string literalOf(const ValueType& type, std::span<const double> numbers) {
    std::vector<std::string> literals;
    for (const double number : numbers) {
        literals.push_back(literalOf(type.kind, number));
    }
    return valueOf(type, literals);
}

}  // namespace glint::materials
