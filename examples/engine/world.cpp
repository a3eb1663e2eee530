#include "world.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace engine {
namespace {

template <typename T>
void append(std::vector<std::uint8_t>& bytes, const T& value) {
    const auto* const first = reinterpret_cast<const std::uint8_t*>(&value);
    bytes.insert(bytes.end(), first, first + sizeof value);
}

std::int16_t snorm16(float value) {
    return static_cast<std::int16_t>(std::lround(std::clamp(value, -1.0F, 1.0F) * 32767.0F));
}

// The octahedral mapping (Cigolle et al. 2014).
std::array<std::int16_t, 2> octahedral(const std::array<float, 3>& n) {
    const float sum = std::abs(n[0]) + std::abs(n[1]) + std::abs(n[2]);
    if (sum == 0.0F) {
        return {};
    }
    float x = n[0] / sum;
    float y = n[1] / sum;
    if (n[2] < 0.0F) {
        const float folded = (1.0F - std::abs(y)) * (x >= 0.0F ? 1.0F : -1.0F);
        y = (1.0F - std::abs(x)) * (y >= 0.0F ? 1.0F : -1.0F);
        x = folded;
    }
    return {snorm16(x), snorm16(y)};
}

// Rounds to the nearest half float. UVs beyond its range become its largest number.
std::uint16_t half(float value) {
    const float clamped = std::clamp(value, -65504.0F, 65504.0F);
    const auto sign = static_cast<std::uint16_t>(std::signbit(clamped) ? 0x8000U : 0U);
    const float magnitude = std::abs(clamped);
    if (magnitude < 6.103515625e-5F) {
        return sign | static_cast<std::uint16_t>(std::lround(magnitude * 16777216.0F));
    }
    const auto bits = std::bit_cast<std::uint32_t>(magnitude) + 0xFFFU +
                      (std::bit_cast<std::uint32_t>(magnitude) >> 13U & 1U);
    return sign | static_cast<std::uint16_t>((bits >> 13U) - (112U << 10U));
}

std::uint8_t unorm8(float value) {
    return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0F, 1.0F) * 255.0F));
}

void appendCompact(std::vector<std::uint8_t>& bytes, const Mesh& mesh, const Vertex& vertex) {
    for (std::size_t i = 0; i < 3; ++i) {
        append(bytes, snorm16((vertex.position[i] - mesh.offset[i]) / mesh.scale));
    }
    append(bytes, snorm16(vertex.tangent[3]));
    append(bytes, octahedral(vertex.normal));
    append(bytes, octahedral({vertex.tangent[0], vertex.tangent[1], vertex.tangent[2]}));
    for (const std::array<float, 2>& uv : {vertex.uv0, vertex.uv1}) {
        append(bytes, std::array{half(uv[0]), half(uv[1])});
    }
    for (const float channel : vertex.color) {
        append(bytes, unorm8(channel));
    }
}

}  // namespace

void addGeometry(World& world, Mesh& mesh, std::uint32_t meshNumber, std::uint32_t primitive,
                 std::span<const Vertex> vertices, std::span<const std::uint32_t> indices) {
    Geometry geometry{meshNumber,
                      primitive,
                      {},
                      {},
                      static_cast<std::uint32_t>(vertices.size()),
                      static_cast<std::uint32_t>(indices.size())};
    for (const Vertex& vertex : vertices) {
        if (world.format == Format::Full) {
            append(geometry.vertices, vertex);
        } else {
            appendCompact(geometry.vertices, mesh, vertex);
        }
    }
    for (const std::uint32_t index : indices) {
        if (world.format == Format::Full) {
            append(geometry.indices, index);
        } else {
            append(geometry.indices, static_cast<std::uint16_t>(index));
        }
    }
    mesh.geometries.push_back(std::move(geometry));
}

std::array<float, 12> storedToWorld(const World& world, const Instance& instance) {
    const Mesh& mesh = world.meshes[instance.mesh];
    std::array<float, 12> result = instance.objectToWorld;
    for (std::size_t row = 0; row < 3; ++row) {
        for (std::size_t column = 0; column < 3; ++column) {
            result[4 * row + 3] += result[4 * row + column] * mesh.offset[column];
        }
        for (std::size_t column = 0; column < 3; ++column) {
            result[4 * row + column] *= mesh.scale;
        }
    }
    return result;
}

}  // namespace engine
