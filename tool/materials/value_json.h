// Reads values of parameters from JSON, wherever they stand: in declarations, in glTF, in lists of materials.
#pragma once

#include "base/text.h"
#include "materials/material_model.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace glint::materials {

// What is wrong with a value: the JSON pointer below it, and words.
struct ValueFault {
    std::string place;
    std::string message;
};

// Appends the numbers of a value to `numbers`: those of an array's elements follow each other. Ranges are the
// caller's to check, but every whole number is one of 32 bits. Both types of JSON are read.
template <typename Json>
class ValueReader {
public:
    ValueReader(const Parameter& parameter, std::vector<double>& numbers)
        : parameter_(parameter), numbers_(numbers) {}

    std::optional<ValueFault> read(const Json& json) {
        if (parameter_.type->isAddress()) {
            return ValueFault{"", "is the address of a buffer, which only a program can give, at run time"};
        }
        if (!parameter_.isArray()) {
            return readOne(json, "");
        }
        const auto count = static_cast<std::size_t>(parameter_.count);
        if (!json.is_array()) {
            return ValueFault{"", fmt::format("must be an array of {} values", count)};
        }
        if (json.size() != count) {
            return ValueFault{"",
                              fmt::format("has {} values; it must be an array of {}", json.size(), count)};
        }
        for (std::size_t i = 0; i < count; ++i) {
            if (auto fault = readOne(json[i], fmt::format("/{}", i))) {
                return fault;
            }
        }
        return std::nullopt;
    }

private:
    std::optional<ValueFault> readOne(const Json& json, const std::string& place) {
        if (parameter_.type->channels == 1) {
            return readNumber(json, place);
        }
        const auto channels = static_cast<std::size_t>(parameter_.type->channels);
        if (!json.is_array() || json.size() != channels) {
            return ValueFault{place, fmt::format("must be an array of {} numbers", channels)};
        }
        for (std::size_t i = 0; i < channels; ++i) {
            if (auto fault = readNumber(json[i], fmt::format("{}/{}", place, i))) {
                return fault;
            }
        }
        return std::nullopt;
    }

    std::optional<ValueFault> readNumber(const Json& json, const std::string& place) {
        const NumberKind kind = parameter_.type->kind;
        if (kind == NumberKind::Name) {
            return readName(json, place);
        }
        if (kind == NumberKind::Truth) {
            numbers_.push_back(json.is_boolean() && json.template get<bool>() ? 1.0 : 0.0);
            return json.is_boolean() ? std::nullopt
                                     : std::optional(ValueFault{place, "must be true or false"});
        }
        const bool isWhole = kind != NumberKind::Real;
        if (!json.is_number()) {
            return ValueFault{place, isWhole ? "must be a whole number" : "must be a number"};
        }
        const auto number = json.template get<double>();
        if (isWhole && std::trunc(number) != number) {
            return ValueFault{place, fmt::format("is {}; it must be a whole number", number)};
        }
        numbers_.push_back(number);
        return std::nullopt;
    }

    std::optional<ValueFault> readName(const Json& json, const std::string& place) {
        const std::vector<std::string>& names = parameter_.names;
        if (!json.is_string()) {
            return ValueFault{place, fmt::format("must be one of the names {}", fmt::join(names, ", "))};
        }
        const auto name = json.template get<std::string>();
        for (std::size_t i = 0; i < names.size(); ++i) {
            if (names[i] == name) {
                numbers_.push_back(static_cast<double>(i));
                return std::nullopt;
            }
        }
        return ValueFault{place, fmt::format("\"{}\" is none of {}{}", name, fmt::join(names, ", "),
                                             base::suggestion(name, names))};
    }

    const Parameter& parameter_;
    std::vector<double>& numbers_;
};

template <typename Json>
std::optional<ValueFault> readValue(const Parameter& parameter, const Json& json,
                                    std::vector<double>& numbers) {
    return ValueReader<Json>(parameter, numbers).read(json);
}

// Returns the JSON pointer, below a value, of its number of that index.
inline std::string placeOfNumber(const Parameter& parameter, int number) {
    const int channels = parameter.type->channels;
    return (parameter.isArray() ? fmt::format("/{}", number / channels) : "") +
           (channels > 1 ? fmt::format("/{}", number % channels) : "");
}

}  // namespace glint::materials
