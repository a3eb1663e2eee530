// Opacity micromaps in the layout that VK_EXT_opacity_micromap builds from and that EXT_mesh_opacity_micromap
// (draft of 2026, KhronosGroup/glTF, pull request 2623) stores.
//
// A micromap of level n divides a triangle into 4^n micro-triangles. Their states follow each other along a
// space-filling curve, least significant bits first, with 1 bit (two states) or 2 bits (four states) each.
#pragma once

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <span>
#include <vector>

namespace glint::opacity {

// The values of the four-state format. The two-state format has the lowest bit.
enum class State : std::uint8_t {
    Transparent = 0,
    Opaque = 1,
    UnknownTransparent = 2,  // must be tested; transparent where only two states are used
    UnknownOpaque = 3,       // must be tested; opaque where only two states are used
};

constexpr bool isKnown(State state) {
    return state == State::Transparent || state == State::Opaque;
}

// Subdivision levels that are made here. Devices may allow more.
inline constexpr std::uint32_t kMaxLevel = 6;

constexpr std::uint32_t microTriangles(std::uint32_t level) {
    return 1U << (2 * level);
}

// A micro-triangle in a lattice of 2^level steps along each edge of its triangle: u counts along the edge
// from corner 0 to corner 1, v along that from corner 0 to corner 2. An upright one has the corners (u, v),
// (u + 1, v) and (u, v + 1), an inverted one (u + 1, v + 1), (u, v + 1) and (u + 1, v).
struct MicroTriangle {
    std::uint32_t u = 0;
    std::uint32_t v = 0;
    bool inverted = false;

    friend bool operator==(const MicroTriangle&, const MicroTriangle&) = default;
};

// Returns the place of a micro-triangle on the curve: the reference code of VK_EXT_opacity_micromap, from the
// point on where it has quantised the barycentrics. Requires level <= 16.
std::uint32_t curveIndex(const MicroTriangle& micro, std::uint32_t level);

// The formats of a record (VkOpacityMicromapFormatEXT).
inline constexpr std::uint16_t kTwoStates = 1;
inline constexpr std::uint16_t kFourStates = 2;

using MicromapRecord = VkMicromapTriangleEXT;
using MicromapUsage = VkMicromapUsageEXT;

// An index of a triangle is that of its record, or ~state for a triangle that has one state everywhere
// (VK_OPACITY_MICROMAP_SPECIAL_INDEX_*: -1 fully transparent to -4 fully unknown opaque).
constexpr std::int32_t specialIndex(State state) {
    return ~static_cast<std::int32_t>(state);
}

struct MicromapArray {
    std::vector<std::uint8_t> data;
    std::vector<MicromapRecord> records;  // no two have equal states
    std::vector<std::int32_t> indices;    // one for each triangle
    std::vector<MicromapUsage> usages;    // of records, by level and format
};

// The states of a triangle: one, or 4^level along the curve. `level` is 0 if there is one.
struct TriangleStates {
    std::uint32_t level = 0;
    std::vector<State> states;
};

// Packs the states of triangles in their order. A triangle with one state everywhere gets a special index.
// Triangles with equal states share a record. A record has two states if none of its own is unknown.
MicromapArray packMicromaps(std::span<const TriangleStates> triangles);

// Returns how many triangles have the records of each level and format. A BLAS asks for that
// (VkAccelerationStructureTrianglesOpacityMicromapEXT::pUsageCounts). Requires valid indices.
std::vector<MicromapUsage> usagesOf(const MicromapArray& array);

// Returns the number of bytes of a record's states.
constexpr std::uint64_t bytesOfStates(std::uint32_t level, std::uint32_t format) {
    return (std::uint64_t{microTriangles(level)} * format + 7) / 8;
}

}  // namespace glint::opacity
