#include "gltf/document/accessor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <string>
#include <type_traits>

namespace glint::gltf {

namespace {

constexpr const char* kDamaged = "the file is damaged: export it again";

// The elements in a run of bytes.
struct ElementLayout {
    ByteView bytes;
    std::size_t offset = 0;
    std::size_t stride = 0;
    std::size_t elementSize = 0;
};

bool fits(const ElementLayout& layout, std::size_t count) {
    if (count == 0) {
        return layout.offset <= layout.bytes.size();
    }
    if (layout.offset > layout.bytes.size() || layout.bytes.size() - layout.offset < layout.elementSize) {
        return false;
    }
    return (layout.bytes.size() - layout.offset - layout.elementSize) / layout.stride >= count - 1;
}

std::string accessorPointer(int accessor) {
    return fmt::format("/accessors/{}", accessor);
}

// Returns where `count` elements lie in a buffer view. A stride of 0 says that they follow each other.
// `pointer` is that of what has them.
Result<ElementLayout> layoutOf(Document& document, const std::string& pointer, int bufferView,
                               std::size_t offset, std::size_t stride, std::size_t elementSize,
                               std::size_t count) {
    GLINT_TRY(const auto bytes, document.bufferView(bufferView));
    const ElementLayout layout{bytes, offset, stride == 0 ? elementSize : stride, elementSize};
    if (layout.stride < elementSize) {
        return document.error(
            "accessor-stride", fmt::format("/bufferViews/{}/byteStride", bufferView),
            fmt::format("is {}, but the elements of {} have {} bytes", stride, pointer, elementSize),
            kDamaged);
    }
    if (!fits(layout, count)) {
        return document.error(
            "accessor-range", pointer,
            fmt::format("{} elements of {} bytes from byte {} at a stride of {} go beyond the {} "
                        "bytes of the buffer view",
                        count, elementSize, offset, layout.stride, bytes.size()),
            kDamaged);
    }
    return layout;
}

template <typename T>
T load(const std::uint8_t* bytes) {
    T value{};
    std::memcpy(&value, bytes, sizeof value);
    return value;
}

// Returns the largest value of an unsigned component type, or 0 for other types.
std::uint32_t largestUnsigned(int componentType) {
    return withComponentType(componentType, [](auto zero) -> std::uint32_t {
        using T = decltype(zero);
        return std::is_unsigned_v<T> ? static_cast<std::uint32_t>(std::numeric_limits<T>::max()) : 0;
    });
}

// Returns elements of an unsigned component type that are packed tightly.
std::vector<std::uint32_t> unsignedElements(int componentType, const std::uint8_t* bytes, std::size_t count) {
    std::vector<std::uint32_t> elements(count);
    withComponentType(componentType, [&](auto zero) {
        for (std::size_t i = 0; i < count; ++i) {
            // The caller gives unsigned types alone. NOLINTNEXTLINE(bugprone-signed-char-misuse)
            elements[i] = static_cast<std::uint32_t>(load<decltype(zero)>(bytes + i * sizeof zero));
        }
    });
    return elements;
}

// Copies the accessor's own elements, without substitutions, tightly packed.
Status gatherBase(Document& document, int index, std::size_t elementSize, base::Bytes& elements) {
    const tinygltf::Accessor& accessor = document.accessor(index);
    if (accessor.bufferView < 0) {
        if (!document.zeroElements().take(accessor.count)) {
            return document.error(
                "accessor-count", accessorPointer(index),
                fmt::format(
                    "with its {} elements that no buffer view holds, the scene passes the limit of {}",
                    accessor.count, Document::kMaxZeroElements),
                "store the elements in a buffer");
        }
        elements.assign(accessor.count * elementSize, 0);
        return okStatus();
    }
    GLINT_TRY(const auto layout,
              layoutOf(document, accessorPointer(index), accessor.bufferView, accessor.byteOffset,
                       document.stride(accessor.bufferView), elementSize, accessor.count));
    elements.resize(accessor.count * elementSize);
    for (std::size_t i = 0; i < accessor.count; ++i) {
        std::memcpy(&elements[i * elementSize], &layout.bytes[layout.offset + i * layout.stride],
                    elementSize);
    }
    return okStatus();
}

// Puts the substitutes of a sparse accessor into `elements`.
Status substituteSparse(Document& document, int index, std::size_t elementSize, base::Bytes& elements) {
    const tinygltf::Accessor& accessor = document.accessor(index);
    const auto& sparse = accessor.sparse;
    const auto count = static_cast<std::size_t>(sparse.count);
    const std::string pointer = accessorPointer(index) + "/sparse";
    if (count > accessor.count) {
        return document.error("sparse-count", pointer + "/count",
                              fmt::format("is {}, more than the {} elements", count, accessor.count),
                              kDamaged);
    }
    if (largestUnsigned(sparse.indices.componentType) == 0) {
        return document.error("accessor-component-type", pointer + "/indices/componentType",
                              fmt::format("{} is no unsigned integer", sparse.indices.componentType),
                              kDamaged);
    }
    const std::size_t indexSize = componentSizeOf(sparse.indices.componentType);
    GLINT_TRY(const auto indices,
              layoutOf(document, pointer + "/indices", sparse.indices.bufferView,
                       static_cast<std::size_t>(sparse.indices.byteOffset), 0, indexSize, count));
    GLINT_TRY(const auto values,
              layoutOf(document, pointer + "/values", sparse.values.bufferView,
                       static_cast<std::size_t>(sparse.values.byteOffset), 0, elementSize, count));
    const std::vector<std::uint32_t> targets =
        unsignedElements(sparse.indices.componentType, indices.bytes.data() + indices.offset, count);
    std::int64_t before = -1;
    bool increases = true;
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t target = targets[i];
        if (target >= accessor.count) {
            return document.error(
                "sparse-index", pointer + "/indices",
                fmt::format("index {} is {}, beyond the {} elements", i, target, accessor.count), kDamaged);
        }
        increases = increases && target > before;
        before = target;
        std::memcpy(&elements[target * elementSize], &values.bytes[values.offset + i * elementSize],
                    elementSize);
    }
    if (!increases) {
        document.warn("sparse-index", pointer + "/indices",
                      "do not strictly increase; of two values for one element the later one is used",
                      "export the scene again");
    }
    return okStatus();
}

// Returns all elements, tightly packed.
Result<base::Bytes> gather(Document& document, int index, std::size_t elementSize) {
    const tinygltf::Accessor& accessor = document.accessor(index);
    GLINT_TRY_DO(document.chargeVertices(accessor.count, accessorPointer(index)));
    base::Bytes elements;
    GLINT_TRY_DO(gatherBase(document, index, elementSize, elements));
    if (accessor.sparse.isSparse) {
        GLINT_TRY_DO(substituteSparse(document, index, elementSize, elements));
    }
    return elements;
}

}  // namespace

Result<ElementFormat> floatFormat(const Document& document, int index) {
    const tinygltf::Accessor& accessor = document.accessor(index);
    if (isMatrix(accessor)) {
        return document.error("accessor-type", accessorPointer(index) + "/type",
                              "a vertex attribute can't be a matrix", "export the scene again");
    }
    if (accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT) {
        return document.error("accessor-component-type", accessorPointer(index) + "/componentType",
                              "a vertex attribute can't have 32-bit integers", "export the scene again");
    }
    return ElementFormat{accessor.componentType, componentsOf(accessor),
                         componentSizeOf(accessor.componentType)};
}

FloatElements toFloats(const Document& document, int index, Integers integers, const base::Bytes& bytes) {
    const tinygltf::Accessor& accessor = document.accessor(index);
    FloatElements result;
    result.components = componentsOf(accessor);
    const bool normalized = accessor.normalized || integers == Integers::Normalized;
    withComponentType(accessor.componentType, [&](auto zero) {
        using T = decltype(zero);
        result.values.resize(bytes.size() / sizeof(T));
        for (std::size_t i = 0; i < result.values.size(); ++i) {
            const auto value = static_cast<float>(load<T>(&bytes[i * sizeof(T)]));
            // This divides instead of multiplying by the reciprocal, because the largest integer must give
            // exactly 1.
            result.values[i] =
                normalized && std::is_integral_v<T>
                    ? std::max(value / static_cast<float>(std::numeric_limits<T>::max()), -1.0F)
                    : value;
        }
    });
    result.count = result.values.size() / result.components;
    return result;
}

Result<FloatElements> readFloats(Document& document, int index, Integers integers) {
    GLINT_TRY(const auto format, floatFormat(document, index));
    GLINT_TRY(const auto bytes, gather(document, index, format.components * format.componentSize));
    return toFloats(document, index, integers, bytes);
}

Result<std::vector<Matrix4>> readMatrices(Document& document, int index) {
    const tinygltf::Accessor& accessor = document.accessor(index);
    if (!isMatrix(accessor) || componentsOf(accessor) != 16 ||
        accessor.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT) {
        return document.error("accessor-type", accessorPointer(index), "must have 4 x 4 matrices of floats",
                              "export the scene again");
    }
    constexpr std::size_t kElements = std::tuple_size_v<Matrix4>;
    GLINT_TRY(const auto bytes, gather(document, index, kElements * sizeof(float)));
    std::vector<Matrix4> matrices(accessor.count);
    for (std::size_t i = 0; i < kElements * accessor.count; ++i) {
        matrices[i / kElements][i % kElements] = load<float>(&bytes[i * sizeof(float)]);
    }
    return matrices;
}

Result<IndexElements> readIndices(Document& document, int index) {
    const tinygltf::Accessor& accessor = document.accessor(index);
    const std::uint32_t restart = largestUnsigned(accessor.componentType);
    if (componentsOf(accessor) != 1 || restart == 0) {
        return document.error("accessor-component-type", accessorPointer(index),
                              "indices must be scalars of unsigned integers", "export the scene again");
    }
    const std::size_t size = componentSizeOf(accessor.componentType);
    GLINT_TRY(const auto bytes, gather(document, index, size));
    return IndexElements{unsignedElements(accessor.componentType, bytes.data(), accessor.count), restart};
}

}  // namespace glint::gltf
