// Reads numbers and textures from the JSON objects of a material.
#pragma once

#include "gltf/document.h"
#include "gltf/textures.h"

#include <array>
#include <limits>
#include <string>
#include <string_view>

namespace glint::gltf {

struct Range {
    double low = 0.0;
    double high = 1.0;
};
inline constexpr Range kUnit{0.0, 1.0};
// The upper bound is the largest number that a float can hold.
inline constexpr Range kNotNegative{0.0, std::numeric_limits<float>::max()};

// One object of a checked document, and its JSON pointer.
class ObjectReader {
public:
    ObjectReader(Document& document, const Json& object, std::string pointer)
        : document_(document), object_(object), pointer_(std::move(pointer)) {}

    const Json& json() const {
        return object_;
    }
    // Returns the JSON pointer of a member.
    std::string pointerTo(std::string_view member) const;
    // Returns the member as it is; any value is allowed.
    double number(std::string_view member, double fallback) const;
    // Returns the member clamped to the range, with the warning "material-range".
    float number(std::string_view member, double fallback, Range range) const;
    template <std::size_t N>
    void numbers(std::string_view member, std::array<float, N>& values, Range range) const {
        const Json* array = find(object_, member);
        for (std::size_t i = 0; array != nullptr && i < N; ++i) {
            values[i] = clamp(elementPointer(member, i), (*array)[i].get<double>(), range);
        }
    }
    // Reads the texture info of that name into `info`. If there is none, or none that can be used, `info`
    // stays as it is.
    Status texture(std::string_view member, TextureTable& textures, TextureInfo& info) const;
    void warn(std::string_view member, std::string message, std::string hint) const;

private:
    float clamp(const std::string& pointer, double value, Range range) const;
    std::string elementPointer(std::string_view member, std::size_t index) const;

    Document& document_;
    const Json& object_;
    std::string pointer_;
};

}  // namespace glint::gltf
