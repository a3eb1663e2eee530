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

using UsageCounts = std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t>;

std::vector<MicromapUsage> listOf(const UsageCounts& counts) {
    std::vector<MicromapUsage> usages;
    for (const auto& [kind, count] : counts) {
        usages.push_back({count, kind.first, kind.second});
    }
    return usages;
}

UsageCounts countRecords(const MicromapArray& array) {
    UsageCounts counts;
    for (const MicromapRecord& record : array.records) {
        ++counts[{record.subdivisionLevel, record.format}];
    }
    return counts;
}

bool overlap(const MicromapArray& array) {
    std::vector<std::pair<std::uint64_t, std::uint64_t>> regions;
    for (const MicromapRecord& record : array.records) {
        const std::uint64_t first = record.dataOffset;
        regions.emplace_back(first, first + bytesOfStates(record.subdivisionLevel, record.format));
    }
    std::ranges::sort(regions);
    for (std::size_t i = 1; i < regions.size(); ++i) {
        if (regions[i].first < regions[i - 1].second) {
            return true;
        }
    }
    return false;
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

MicroTriangle microTriangleAt(float u, float v, std::uint32_t level) {
    const std::uint32_t steps = 1U << level;
    const float alongU = std::clamp(u, 0.0F, 1.0F) * static_cast<float>(steps);
    const float alongV = std::clamp(v, 0.0F, 1.0F) * static_cast<float>(steps);
    auto cellU = static_cast<std::uint32_t>(alongU);
    auto cellV = static_cast<std::uint32_t>(alongV);
    const float restU = alongU - static_cast<float>(cellU);
    const float restV = alongV - static_cast<float>(cellV);
    cellU = std::min(cellU, steps - 1);
    cellV = std::min(cellV, steps - 1);
    const std::uint32_t sum = cellU + cellV;
    if (sum >= steps) {
        cellU -= sum - steps + 1;
    }
    return {cellU, cellV, restU + restV >= 1.0F && sum < steps - 1};
}

MicromapArray packMicromaps(std::span<const TriangleStates> triangles, bool twoStates) {
    MicromapArray array;
    std::map<std::tuple<std::uint32_t, std::uint16_t, std::vector<std::uint8_t>>, std::int32_t> known;
    array.indices.reserve(triangles.size());
    for (const TriangleStates& triangle : triangles) {
        if (isUniform(triangle)) {
            array.indices.push_back(specialIndex(triangle.states[0]));
            continue;
        }
        const std::uint16_t format =
            twoStates || std::ranges::all_of(triangle.states, isKnown) ? kTwoStates : kFourStates;
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
    array.usages = listOf(countRecords(array));
    return array;
}

std::vector<MicromapUsage> usagesOf(const MicromapArray& array) {
    UsageCounts counts;
    for (const std::int32_t index : array.indices) {
        if (index >= 0) {
            const MicromapRecord& record = array.records[static_cast<std::size_t>(index)];
            ++counts[{record.subdivisionLevel, record.format}];
        }
    }
    return listOf(counts);
}

State stateAt(const MicromapArray& array, std::size_t triangle, std::uint32_t place, std::uint32_t level) {
    const std::int32_t index = array.indices[triangle];
    if (index < 0) {
        return static_cast<State>(~index);
    }
    const MicromapRecord& record = array.records[static_cast<std::size_t>(index)];
    const std::uint32_t own = place >> (2 * (level - record.subdivisionLevel));
    const std::size_t bit = std::size_t{own} * record.format;
    const std::uint32_t value = array.data[record.dataOffset + bit / 8] >> (bit % 8);
    return static_cast<State>(value & ((1U << record.format) - 1U));
}

std::optional<const char*> faultIn(const MicromapArray& array, std::uint32_t maxLevel) {
    for (const MicromapRecord& record : array.records) {
        if (record.format != kTwoStates && record.format != kFourStates) {
            return "a record has a format that is neither 1 nor 2";
        }
        if (record.subdivisionLevel > maxLevel) {
            return "a record has a subdivision level above the limit";
        }
        if (record.dataOffset + bytesOfStates(record.subdivisionLevel, record.format) > array.data.size()) {
            return "the states of a record are outside of the data";
        }
    }
    if (overlap(array)) {
        return "the states of two records overlap";
    }
    for (const std::int32_t index : array.indices) {
        if (index < specialIndex(State::UnknownOpaque) ||
            (index >= 0 && static_cast<std::size_t>(index) >= array.records.size())) {
            return "an index is neither that of a record nor a special one";
        }
    }
    UsageCounts declared;
    for (const MicromapUsage& usage : array.usages) {
        declared[{usage.subdivisionLevel, usage.format}] += usage.count;
    }
    if (declared != countRecords(array)) {
        return "the usages do not count the records";
    }
    return std::nullopt;
}

}  // namespace glint::opacity
