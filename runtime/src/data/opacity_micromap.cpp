#include "data/opacity_micromap.h"

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

namespace glint::opacity {
namespace {

// Puts a zero bit before each of the low 16 bits.
std::uint32_t spreadBits(std::uint32_t bits) {
    bits = (bits | (bits << 8U)) & 0x00ff00ffU;
    bits = (bits | (bits << 4U)) & 0x0f0f0f0fU;
    bits = (bits | (bits << 2U)) & 0x33333333U;
    return (bits | (bits << 1U)) & 0x55555555U;
}

bool isUniform(const TriangleStates& triangle) {
    return std::ranges::all_of(triangle.states, [&](State state) { return state == triangle.states[0]; });
}

std::vector<std::uint8_t> packStates(const TriangleStates& triangle, std::uint16_t format) {
    std::vector<std::uint8_t> bytes(bytesOfStates(triangle.level, format));
    const std::uint32_t mask = (1U << format) - 1U;
    for (std::size_t i = 0; i < triangle.states.size(); ++i) {
        const std::size_t bit = i * format;
        const std::uint32_t value = static_cast<std::uint32_t>(triangle.states[i]) & mask;
        bytes[bit / 8] = static_cast<std::uint8_t>(bytes[bit / 8] | value << (bit % 8));
    }
    return bytes;
}

// Counts records by level and format.
std::vector<MicromapUsage> countUsages(std::span<const MicromapRecord> records) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> counts;
    for (const MicromapRecord& record : records) {
        ++counts[{record.subdivisionLevel, record.format}];
    }
    std::vector<MicromapUsage> usages;
    usages.reserve(counts.size());
    for (const auto& [kind, count] : counts) {
        usages.push_back({count, kind.first, kind.second});
    }
    return usages;
}

}  // namespace

std::uint32_t curveIndex(const MicroTriangle& micro, std::uint32_t level) {
    const std::uint32_t u = micro.u;
    const std::uint32_t v = micro.v;
    const std::uint32_t w = ~(u + v) - (micro.inverted ? 1U : 0U);
    const std::uint32_t even = ~(u ^ w) & ((1U << level) - 1U);
    const std::uint32_t turned = (u ^ v) & even;
    std::uint32_t parity = turned;
    parity ^= parity >> 1U;
    parity ^= parity >> 2U;
    parity ^= parity >> 4U;
    parity ^= parity >> 8U;
    const std::uint32_t odd = ((parity ^ u) & ~even) | turned;
    return spreadBits(even) | (spreadBits(odd) << 1U);
}

MicromapArray packMicromaps(std::span<const TriangleStates> triangles) {
    MicromapArray array;
    std::map<std::tuple<std::uint32_t, std::uint16_t, std::vector<std::uint8_t>>, std::int32_t> known;
    array.indices.reserve(triangles.size());
    for (const TriangleStates& triangle : triangles) {
        if (isUniform(triangle)) {
            array.indices.push_back(specialIndex(triangle.states[0]));
            continue;
        }
        const std::uint16_t format = std::ranges::all_of(triangle.states, isKnown) ? kTwoStates : kFourStates;
        std::vector<std::uint8_t> bytes = packStates(triangle, format);
        const auto next = static_cast<std::int32_t>(array.records.size());
        const auto [place, isNew] = known.try_emplace({triangle.level, format, std::move(bytes)}, next);
        if (isNew) {
            const std::vector<std::uint8_t>& added = std::get<2>(place->first);
            array.records.push_back({static_cast<std::uint32_t>(array.data.size()),
                                     static_cast<std::uint16_t>(triangle.level), format});
            array.data.insert(array.data.end(), added.begin(), added.end());
        }
        array.indices.push_back(place->second);
    }
    array.usages = countUsages(array.records);
    return array;
}

std::vector<MicromapUsage> usagesOf(const MicromapArray& array) {
    std::vector<MicromapRecord> used;
    for (const std::int32_t index : array.indices) {
        if (index >= 0) {
            used.push_back(array.records[static_cast<std::size_t>(index)]);
        }
    }
    return countUsages(used);
}

}  // namespace glint::opacity
