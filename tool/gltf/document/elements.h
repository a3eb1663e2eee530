// Buffer views and accessors of a checked document as plain data.
#pragma once

#include "gltf/document/schema.h"

#include <cstddef>
#include <cstdint>
#include <optional>

namespace glint::gltf {

struct BufferView {
    int buffer = -1;
    std::uint64_t offset = 0;  // bytes
    std::uint64_t length = 0;  // bytes
    std::size_t stride = 0;    // bytes; 0 means that elements follow each other
};

// The numbers are glTF's.
enum class ComponentType : std::uint16_t {
    Byte = 5120,
    UnsignedByte = 5121,
    Short = 5122,
    UnsignedShort = 5123,
    UnsignedInt = 5125,
    Float = 5126,
};

// Returns how many bytes a component has.
std::size_t sizeOf(ComponentType type);

struct Accessor {
    // Elements that replace some of the others.
    struct Sparse {
        std::size_t count = 0;
        int indicesView = -1;
        std::size_t indicesOffset = 0;  // bytes
        ComponentType indicesType = ComponentType::UnsignedInt;
        int valuesView = -1;
        std::size_t valuesOffset = 0;  // bytes
    };

    int bufferView = -1;  // -1: all elements are 0
    std::size_t offset = 0;
    ComponentType componentType = ComponentType::Float;
    std::size_t count = 0;
    std::size_t components = 1;
    bool isMatrix = false;
    bool normalized = false;
    std::optional<Sparse> sparse;
};

// The objects have been checked (validate.h).
BufferView readBufferView(const Json& json);
Accessor readAccessor(const Json& json);

}  // namespace glint::gltf
