// The names of enumerators, as people write them on the command line and in files. An enumeration declares
// them once, beside itself, as an array of Named and a function namesOf() that the templates here find by its
// argument.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

namespace glint {

template <typename Value>
struct Named {
    Value value{};
    std::string_view name;
    std::string_view what = {};  // a sentence without a full stop, for help and documents; may be empty
};

template <typename Value>
concept HasNames = requires(Value value) {
    { namesOf(value) } -> std::convertible_to<std::span<const Named<Value>>>;
};

// Returns "unknown" for a value that is not exactly one of the named ones.
template <HasNames Value>
constexpr std::string_view nameOf(Value value) {
    for (const Named<Value>& named : namesOf(value)) {
        if (named.value == value) {
            return named.name;
        }
    }
    return "unknown";
}

template <HasNames Value>
constexpr std::optional<Value> valueNamed(std::string_view name) {
    for (const Named<Value>& named : namesOf(Value{})) {
        if (named.name == name) {
            return named.value;
        }
    }
    return std::nullopt;
}

template <typename Value, std::size_t N>
constexpr std::array<Value, N> valuesOf(const Named<Value> (&names)[N]) {
    std::array<Value, N> values{};
    for (std::size_t i = 0; i < N; ++i) {
        values[i] = names[i].value;
    }
    return values;
}

}  // namespace glint
