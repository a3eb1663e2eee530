#include "synthetic/tiles.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <random>
#include <utility>

namespace glint::synthetic {

namespace {

// Tiles a side. Coherent: at most cases, 4 tiles a case, each a dozen pixels wide in a picture of 400.
// Incoherent: so many that cosine-weighted rays of neighbours spread over hundreds of tiles.
constexpr int kCoherentTiles = 32;
constexpr int kIncoherentTiles = 64;

// The distance by which an incoherent ceiling extends beyond the floor, in heights of the ceiling.
// Cosine-weighted rays miss it with a chance of about 1 / (1 + 5²).
constexpr double kReach = 5.0;

// Returns every second bit of `code`, starting with the lowest.
std::uint32_t compacted(std::uint32_t code) {
    std::uint32_t bits = 0;
    for (std::uint32_t i = 0; i < 16; ++i) {
        bits |= (code >> (2 * i) & 1U) << i;
    }
    return bits;
}

// Returns places of tiles, row * tiles + column, along a Morton curve: places that are near on the curve are
// near on the ceiling.
std::vector<std::size_t> alongCurve(int tiles) {
    std::vector<std::size_t> places(static_cast<std::size_t>(tiles) * static_cast<std::size_t>(tiles));
    for (std::uint32_t i = 0; i < places.size(); ++i) {
        places[i] = std::size_t{compacted(i >> 1)} * static_cast<std::size_t>(tiles) + compacted(i);
    }
    return places;
}

// The shuffle of Fisher and Yates, because std::shuffle differs between libraries.
void shuffle(std::vector<std::size_t>& places) {
    std::mt19937_64 random(1);
    for (std::size_t i = places.size(); i > 1; --i) {
        std::swap(places[i - 1], places[random() % i]);
    }
}

// Gives each case one tile, and distributes the rest by largest remainders.
std::vector<std::size_t> tilesOfCases(const std::vector<double>& shares, std::size_t tiles) {
    const auto all = static_cast<double>(tiles);
    std::vector<std::size_t> counts;
    counts.reserve(shares.size());
    for (const double share : shares) {
        counts.push_back(std::max<std::size_t>(1, static_cast<std::size_t>(share * all)));
    }
    std::vector<std::size_t> order(shares.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto lacks = [&](std::size_t i) { return shares[i] * all - static_cast<double>(counts[i]); };
    std::size_t given = std::accumulate(counts.begin(), counts.end(), std::size_t{0});
    while (given < tiles) {
        ++counts[*std::ranges::max_element(order, {}, lacks)];
        ++given;
    }
    // If a minimum of one tile exceeded some shares, the surplus is taken from the largest counts.
    for (; given > tiles; --given) {
        --*std::ranges::max_element(counts);
    }
    return counts;
}

}  // namespace

Extent viewExtent(double distance, double aspect) {
    const double half = distance * std::tan(kFieldOfView / 2.0);
    return {half * aspect, half};
}

int Ceiling::caseAt(double x, double z) const {
    const double column = std::floor((x / extent.x + 1.0) / 2.0 * tiles);
    const double row = std::floor((z / extent.z + 1.0) / 2.0 * tiles);
    if (!(column >= 0.0 && column < tiles && row >= 0.0 && row < tiles)) {
        return -1;
    }
    return cases[place(static_cast<int>(row), static_cast<int>(column))];
}

std::vector<double> sharesOf(const CasesOptions& options) {
    std::vector<double> shares(static_cast<std::size_t>(options.cases), 1.0);
    if (options.shares == Shares::Zipf) {
        for (std::size_t i = 0; i < shares.size(); ++i) {
            shares[i] = 1.0 / static_cast<double>(i + 1);
        }
    }
    const double sum = std::accumulate(shares.begin(), shares.end(), 0.0);
    for (double& share : shares) {
        share /= sum;
    }
    return shares;
}

Ceiling makeCeiling(const CasesOptions& options) {
    const bool coherent = options.coherence == Coherence::Coherent;
    Ceiling ceiling;
    ceiling.tiles = coherent ? kCoherentTiles : kIncoherentTiles;
    if (coherent) {
        // The mirror shows the view of a camera as far below the floor as the real one is above it.
        ceiling.extent = viewExtent(kCameraHeight + kCeilingHeight, options.aspect);
    } else {
        const Extent floor = viewExtent(kCameraHeight, options.aspect);
        ceiling.extent = {floor.x + kReach * kCeilingHeight, floor.z + kReach * kCeilingHeight};
    }
    std::vector<std::size_t> places = alongCurve(ceiling.tiles);
    if (!coherent) {
        shuffle(places);
    }
    ceiling.cases.resize(places.size());
    std::size_t next = 0;
    const std::vector<std::size_t> counts = tilesOfCases(sharesOf(options), places.size());
    for (std::size_t i = 0; i < counts.size(); ++i) {
        for (std::size_t n = 0; n < counts[i]; ++n) {
            ceiling.cases[places[next++]] = static_cast<int>(i);
        }
    }
    return ceiling;
}

}  // namespace glint::synthetic
