// Reads accessors as typed values. Every byte is checked to lie inside its buffer view.
#pragma once

#include "gltf/document/document.h"
#include "gltf/scene.h"

#include <glint/result.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace glint::gltf {

// Calls use(T()) with the type of a component type of glTF.
template <typename Use>
auto withComponentType(int componentType, const Use& use) {
    switch (componentType) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return use(std::int8_t{});
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return use(std::uint8_t{});
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return use(std::int16_t{});
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return use(std::uint16_t{});
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return use(std::uint32_t{});
        default:
            return use(float{});
    }
}

struct FloatElements {
    std::size_t components = 0;  // 1 to 4
    std::size_t count = 0;
    std::vector<float> values;  // components * count
};

// How integers become floats if the accessor does not mark them as normalised.
enum class Integers : std::uint8_t { AsValues, Normalized };

// The form of an accessor's elements.
struct ElementFormat {
    int componentType = TINYGLTF_COMPONENT_TYPE_FLOAT;
    std::size_t components = 0;
    std::size_t componentSize = 0;  // bytes
};

// Returns the format of a vector or scalar accessor. 32-bit integers are an error.
Result<ElementFormat> floatFormat(const Document& document, int accessor);

// Converts elements of that accessor's format, which are packed tightly.
FloatElements toFloats(const Document& document, int accessor, Integers integers,
                       const std::vector<std::uint8_t>& bytes);

// Reads an accessor that floatFormat() accepts. Normalised integers map to [0, 1] or [-1, 1]. Floats stay as
// they are stored, including NaN and infinities.
Result<FloatElements> readFloats(Document& document, int accessor, Integers integers = Integers::AsValues);

// Copies elements of `fewest` to N numbers to vectors, whose other numbers are `missing`. Any other elements
// are the error "attribute-type" at `pointer`.
template <std::size_t N>
Status toVectors(const Document& document, const FloatElements& elements, std::size_t fewest, float missing,
                 const std::string& pointer, const char* hint, std::vector<std::array<float, N>>& vectors) {
    if (elements.components < fewest || elements.components > N) {
        return document.error("attribute-type", pointer,
                              fmt::format("has {} components, not {}", elements.components, N), hint);
    }
    std::array<float, N> filled{};
    filled.fill(missing);
    vectors.assign(elements.count, filled);
    for (std::size_t i = 0; i < elements.count; ++i) {
        std::copy_n(&elements.values[i * elements.components], elements.components, vectors[i].begin());
    }
    return okStatus();
}

// Reads an accessor of 4 x 4 matrices of floats as they are stored. Any other accessor is the error
// "accessor-type".
Result<std::vector<Matrix4>> readMatrices(Document& document, int accessor);

struct IndexElements {
    std::vector<std::uint32_t> values;
    std::uint32_t restart = 0;  // the component type's largest value, which glTF forbids
};

// Reads a scalar accessor of unsigned integers.
Result<IndexElements> readIndices(Document& document, int accessor);

}  // namespace glint::gltf
