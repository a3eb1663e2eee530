#include "oracle/traversal/orders.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <utility>

namespace glint::traversal {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::array<double, 3> centreOf(const LeafBox& leaf) {
    std::array<double, 3> centre{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        centre[axis] = 0.5 * (double{leaf.sides[axis]} - double{leaf.sides[axis + 3]});
    }
    return centre;
}

// The bounds of the centres of some leaves.
struct Extent {
    std::array<double, 3> low{kInfinity, kInfinity, kInfinity};
    std::array<double, 3> high{-kInfinity, -kInfinity, -kInfinity};
};

Extent extentOf(std::span<const LeafBox> leaves, std::span<const std::uint32_t> order) {
    Extent extent;
    for (const std::uint32_t leaf : order) {
        const std::array<double, 3> centre = centreOf(leaves[leaf]);
        for (std::size_t axis = 0; axis < 3 && !leaves[leaf].isVoid(); ++axis) {
            extent.low[axis] = std::min(extent.low[axis], centre[axis]);
            extent.high[axis] = std::max(extent.high[axis], centre[axis]);
        }
    }
    return extent;
}

// Returns which of `count` equal slices of the extent contains the centre.
std::uint32_t sliceOf(const Extent& extent, double centre, std::size_t axis, std::uint32_t count) {
    const double size = extent.high[axis] - extent.low[axis];
    const double share = size > 0.0 ? (centre - extent.low[axis]) / size : 0.0;
    return std::min(static_cast<std::uint32_t>(std::max(share, 0.0) * count), count - 1);
}

constexpr std::uint32_t kBins = 16;

struct SahSplit {
    std::size_t axis = 0;
    std::uint32_t bin = 0;  // the first bin of the second side
    double cost = kInfinity;
};

SahSplit bestSplit(std::span<const LeafBox> leaves, std::span<const std::uint32_t> order,
                   const Extent& extent) {
    SahSplit best;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        std::array<LeafBox, kBins> boxes;
        std::array<std::uint32_t, kBins> counts{};
        for (const std::uint32_t leaf : order) {
            const std::uint32_t bin = sliceOf(extent, centreOf(leaves[leaf])[axis], axis, kBins);
            boxes[bin].extend(leaves[leaf]);
            ++counts[bin];
        }
        std::array<double, kBins> right{};
        LeafBox box;
        std::uint32_t count = 0;
        for (std::uint32_t bin = kBins - 1; bin > 0; --bin) {
            box.extend(boxes[bin]);
            count += counts[bin];
            right[bin] = count * box.surface();
        }
        box = {};
        count = 0;
        for (std::uint32_t bin = 1; bin < kBins; ++bin) {
            box.extend(boxes[bin - 1]);
            count += counts[bin - 1];
            const double cost = count * box.surface() + right[bin];
            if (count > 0 && count < order.size() && cost < best.cost) {
                best = {axis, bin, cost};
            }
        }
    }
    return best;
}

void orderBySah(std::span<const LeafBox> leaves, std::span<std::uint32_t> order) {
    // A list of ranges replaces recursion, because such trees may be deep.
    std::vector<std::span<std::uint32_t>> open{order};
    while (!open.empty()) {
        const std::span<std::uint32_t> range = open.back();
        open.pop_back();
        if (range.size() < 3) {
            continue;
        }
        const Extent extent = extentOf(leaves, range);
        const SahSplit split = bestSplit(leaves, range, extent);
        std::size_t left = range.size() / 2;
        if (split.cost < kInfinity) {
            const auto second = std::ranges::partition(range, [&](std::uint32_t leaf) {
                return sliceOf(extent, centreOf(leaves[leaf])[split.axis], split.axis, kBins) < split.bin;
            });
            left = range.size() - second.size();
        }
        open.push_back(range.subspan(0, left));
        open.push_back(range.subspan(left));
    }
}

}  // namespace

std::vector<std::uint32_t> inputOrder(std::span<const LeafBox> leaves, std::uint32_t /*threads*/) {
    std::vector<std::uint32_t> order(leaves.size());
    std::iota(order.begin(), order.end(), 0U);
    return order;
}

std::vector<std::uint32_t> mortonOrder(std::span<const LeafBox> leaves, std::uint32_t threads) {
    std::vector<std::uint32_t> order = inputOrder(leaves, threads);
    const Extent extent = extentOf(leaves, order);
    std::vector<std::pair<std::uint64_t, std::uint32_t>> codes;
    codes.reserve(leaves.size());
    for (const std::uint32_t leaf : order) {
        std::uint64_t code = 0;
        for (std::size_t axis = 0; axis < 3 && !leaves[leaf].isVoid(); ++axis) {
            const std::uint64_t slice = sliceOf(extent, centreOf(leaves[leaf])[axis], axis, 1U << 21U);
            for (std::size_t bit = 0; bit < 21; ++bit) {
                code |= (slice >> bit & 1U) << (3 * bit + axis);
            }
        }
        codes.emplace_back(code, leaf);
    }
    std::ranges::sort(codes);
    std::ranges::transform(codes, order.begin(), &std::pair<std::uint64_t, std::uint32_t>::second);
    return order;
}

std::vector<std::uint32_t> sahOrder(std::span<const LeafBox> leaves, std::uint32_t threads) {
    std::vector<std::uint32_t> order = inputOrder(leaves, threads);
    orderBySah(leaves, order);
    return order;
}

}  // namespace glint::traversal
