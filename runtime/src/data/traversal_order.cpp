#include "data/traversal_order.h"

#include "context/parallel.h"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>

namespace glint {
namespace {

constexpr float kUnbounded = std::numeric_limits<float>::infinity();

// Nodes with fewer leaves take about a millisecond, which is not worth a thread.
constexpr std::size_t kLeavesPerThread = 1U << 13;

// Nodes with more leaves choose their key by a sample of this many. For such nodes the exact place of the
// split matters more, and it is found among all leaves.
constexpr std::size_t kSample = 1024;

struct Leaf {
    LeafBox box;
    std::uint32_t id = 0;
};

// The key by which a node's leaves are parted.
enum class Key : std::uint8_t { X, Y, Z, Size };

// Returns bits that order as the floats do. They are above 0 unless the float is the NaN with all bits set.
std::uint32_t sortable(float value) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    return (bits & 0x80000000U) != 0 ? ~bits : bits | 0x80000000U;
}

// Returns the rank by the key in the upper bits and the leaf's number in the lower ones, so that no two
// leaves are equal. Void leaves come first.
template <Key key>
std::uint64_t rankOf(const Leaf& leaf) {
    const std::array<float, 6>& sides = leaf.box.sides;
    if (leaf.box.isVoid()) {
        return leaf.id;
    }
    float value = 0.0F;
    if constexpr (key == Key::Size) {
        // The largest leaves come first, so that they share nodes and don't widen all others.
        value = (sides[0] + sides[3]) + (sides[1] + sides[4]) + (sides[2] + sides[5]);
    } else {
        constexpr auto kAxis = static_cast<std::size_t>(key);
        value = 0.5F * sides[kAxis] - 0.5F * sides[kAxis + 3];
    }
    return std::uint64_t{sortable(value)} << 32U | leaf.id;
}

LeafBox united(const Leaf& a, const Leaf& b) {
    LeafBox box = a.box;
    box.extend(b.box);
    return box;
}

// A way to part the leaves of a node.
struct Split {
    Key key = Key::X;
    std::uint64_t pivot = 0;  // the lowest rank of the second side
    double cost = std::numeric_limits<double>::infinity();
};

// Puts the best pair of three leaves first.
void orderThree(std::span<Leaf> leaves) {
    const double surfaces[] = {united(leaves[1], leaves[2]).surface(), united(leaves[0], leaves[2]).surface(),
                               united(leaves[0], leaves[1]).surface()};
    const auto alone = static_cast<std::size_t>(std::ranges::min_element(surfaces) - std::begin(surfaces));
    std::swap(leaves[alone], leaves[2]);
}

// Pairs four leaves so that the two pairs have the least surface.
void orderFour(std::span<Leaf> leaves) {
    std::size_t partner = 1;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 1; i < 4; ++i) {
        const std::size_t a = i == 1 ? 2 : 1;
        const std::size_t b = i == 3 ? 2 : 3;
        const double surface =
            united(leaves[0], leaves[i]).surface() + united(leaves[a], leaves[b]).surface();
        if (surface < least) {
            least = surface;
            partner = i;
        }
    }
    std::swap(leaves[1], leaves[partner]);
}

class Halver {
public:
    Halver(std::span<Leaf> leaves, std::span<std::uint64_t> ranks) : leaves_(leaves), ranks_(ranks) {}

    // Orders the leaves of a node and of all nodes below it.
    void order(std::size_t first, std::size_t count, std::uint32_t threads) {
        const std::span<Leaf> leaves = leaves_.subspan(first, count);
        if (count <= 4) {
            orderFew(leaves);
            return;
        }
        const std::size_t left = (count + 1) / 2;
        part(leaves, ranks_.subspan(first, count), left);
        const bool together = threads > 1 && count >= 2 * kLeavesPerThread;
        const std::uint32_t others = together ? threads / 2 : 1;
        callBoth(
            together, [&] { order(first + left, count - left, together ? threads - others : 1); },
            [&] { order(first, left, others); });
    }

private:
    static void orderFew(std::span<Leaf> leaves) {
        // This is not std::ranges, whose subrange Clang 14 can't read in libstdc++ 12.
        const auto sound = std::stable_partition(leaves.begin(), leaves.end(),
                                                 [](const Leaf& leaf) { return leaf.box.isVoid(); });
        if (sound != leaves.begin()) {
            return;
        }
        if (leaves.size() == 3) {
            orderThree(leaves);
        } else if (leaves.size() == 4) {
            orderFour(leaves);
        }
    }

    // Returns the lowest rank of the second side if the first side has `left` leaves.
    template <Key key>
    static std::uint64_t pivotOf(std::span<const Leaf> leaves, std::span<std::uint64_t> ranks,
                                 std::size_t left) {
        for (std::size_t i = 0; i < leaves.size(); ++i) {
            ranks[i] = rankOf<key>(leaves[i]);
        }
        std::ranges::nth_element(ranks, ranks.begin() + static_cast<std::ptrdiff_t>(left));
        return ranks[left];
    }

    template <Key key>
    static void consider(std::span<const Leaf> leaves, std::span<std::uint64_t> ranks, std::size_t left,
                         Split& best) {
        const std::uint64_t pivot = pivotOf<key>(leaves, ranks, left);
        LeafBox boxes[2];
        for (const Leaf& leaf : leaves) {
            boxes[rankOf<key>(leaf) < pivot ? 0 : 1].extend(leaf.box);
        }
        const double cost = static_cast<double>(left) * boxes[0].surface() +
                            static_cast<double>(leaves.size() - left) * boxes[1].surface();
        if (cost < best.cost) {
            best = {key, pivot, cost};
        }
    }

    static Split bestOf(std::span<const Leaf> leaves, std::span<std::uint64_t> ranks, std::size_t left) {
        Split best;
        consider<Key::X>(leaves, ranks, left, best);
        consider<Key::Y>(leaves, ranks, left, best);
        consider<Key::Z>(leaves, ranks, left, best);
        consider<Key::Size>(leaves, ranks, left, best);
        return best;
    }

    // A `pivot` of 0 has not been found yet.
    template <Key key>
    static void partBy(std::span<Leaf> leaves, std::span<std::uint64_t> ranks, std::size_t left,
                       std::uint64_t pivot) {
        const std::uint64_t bound = pivot != 0 ? pivot : pivotOf<key>(leaves, ranks, left);
        std::partition(leaves.begin(), leaves.end(),
                       [&](const Leaf& leaf) { return rankOf<key>(leaf) < bound; });
    }

    static void part(std::span<Leaf> leaves, std::span<std::uint64_t> ranks, std::size_t left) {
        Split best;
        if (leaves.size() > 2 * kSample) {
            std::array<Leaf, kSample> sample;
            for (std::size_t i = 0; i < kSample; ++i) {
                sample[i] = leaves[i * leaves.size() / kSample];
            }
            best = bestOf(sample, ranks.first(kSample), kSample / 2);
            best.pivot = 0;
        } else {
            best = bestOf(leaves, ranks, left);
        }
        constexpr decltype(&partBy<Key::X>) kPartBy[] = {partBy<Key::X>, partBy<Key::Y>, partBy<Key::Z>,
                                                         partBy<Key::Size>};
        kPartBy[static_cast<std::size_t>(best.key)](leaves, ranks, left, best.pivot);
    }

    std::span<Leaf> leaves_;
    std::span<std::uint64_t> ranks_;
};

}  // namespace

LeafBox::LeafBox() {
    sides.fill(kUnbounded);
}

LeafBox::LeafBox(const Box& box) : LeafBox() {
    if (!box.isEmpty()) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            sides[axis] = static_cast<float>(box.min[axis]);
            sides[axis + 3] = static_cast<float>(-box.max[axis]);
        }
    }
}

void LeafBox::extend(const LeafBox& other) {
    for (std::size_t i = 0; i < sides.size(); ++i) {
        sides[i] = std::min(sides[i], other.sides[i]);
    }
}

void LeafBox::extend(const std::array<float, 3>& point) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        sides[axis] = std::min(sides[axis], point[axis]);
        sides[axis + 3] = std::min(sides[axis + 3], -point[axis]);
    }
    // The comparisons skip a NaN.
    const float sum = point[0] + point[1] + point[2];
    if (!(sum - sum == 0.0F)) {
        sides[0] = -kUnbounded;
    }
}

bool LeafBox::isVoid() const {
    // Infinity and NaN make the sum infinite or NaN. Huge boxes may do so too, and are as bad.
    const float sum = (sides[0] + sides[3]) + (sides[1] + sides[4]) + (sides[2] + sides[5]);
    return !(sum - sum == 0.0F);
}

double LeafBox::surface() const {
    if (isVoid()) {
        return 0.0;
    }
    const double x = -double{sides[0]} - double{sides[3]};
    const double y = -double{sides[1]} - double{sides[4]};
    const double z = -double{sides[2]} - double{sides[5]};
    return 2.0 * (x * y + y * z + z * x);
}

std::vector<std::uint32_t> halvingOrder(std::span<const LeafBox> leaves, std::uint32_t threads) {
    std::vector<Leaf> parted;
    parted.reserve(leaves.size());
    for (const LeafBox& box : leaves) {
        // A void box must not widen any node.
        parted.push_back({box.isVoid() ? LeafBox() : box, static_cast<std::uint32_t>(parted.size())});
    }
    std::vector<std::uint64_t> ranks(leaves.size());
    Halver(parted, ranks).order(0, parted.size(), threads);
    std::vector<std::uint32_t> order;
    order.reserve(parted.size());
    for (const Leaf& leaf : parted) {
        order.push_back(leaf.id);
    }
    return order;
}

namespace {

using Corners = std::array<std::uint32_t, 3>;

std::vector<Corners> cornersOf(std::span<const std::uint32_t> indices) {
    std::vector<Corners> triangles;
    triangles.reserve(indices.size() / 3);
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
        triangles.push_back({indices[i], indices[i + 1], indices[i + 2]});
    }
    return triangles;
}

std::vector<std::uint32_t> indicesOf(std::span<const Corners> triangles) {
    std::vector<std::uint32_t> indices;
    indices.reserve(3 * triangles.size());
    for (const Corners& corners : triangles) {
        indices.insert(indices.end(), corners.begin(), corners.end());
    }
    return indices;
}

void orderPiece(const PrimitiveView& view, std::span<Corners> triangles, LeafOrder leafOrder,
                std::uint32_t threads) {
    std::vector<LeafBox> boxes(triangles.size());
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        for (const std::uint32_t corner : triangles[i]) {
            boxes[i].extend(view.positions[corner]);
        }
    }
    const std::vector<std::uint32_t> order = leafOrder(boxes, threads);
    std::ranges::copy(permuted<Corners>(triangles, order), triangles.begin());
}

std::vector<std::uint32_t> orderPrimitive(const PrimitiveView& view, std::uint64_t capacity,
                                          LeafOrder leafOrder, std::uint32_t threads) {
    std::vector<Corners> triangles = cornersOf(view.indices);
    orderPiece(view, triangles, leafOrder, threads);
    // Pieces of a primitive have trees of their own, which are halved at other places than the tree of the
    // whole would be.
    for (std::size_t first = 0; first < triangles.size() && capacity < triangles.size(); first += capacity) {
        const std::size_t count = std::min<std::size_t>(triangles.size() - first, capacity);
        orderPiece(view, std::span(triangles).subspan(first, count), leafOrder, threads);
    }
    return indicesOf(triangles);
}

// Orders the tested triangles and the opaque ones. The others are in no structure.
std::vector<std::uint32_t> orderSplit(const PrimitiveView& view, std::span<const std::uint32_t> sorted,
                                      const OpacitySplit& split, LeafOrder leafOrder, std::uint32_t threads) {
    std::vector<Corners> triangles = cornersOf(sorted);
    orderPiece(view, std::span(triangles).first(split.tested), leafOrder, threads);
    orderPiece(view, std::span(triangles).subspan(split.tested, split.opaque), leafOrder, threads);
    return indicesOf(triangles);
}

}  // namespace

LeafOrder leafOrderFor(const Context::State& context, SceneView::TraversalOrder wanted) {
    const bool isCpu = context.limits.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    if (wanted == SceneView::TraversalOrder::Input || (wanted == SceneView::TraversalOrder::Auto && !isCpu)) {
        return nullptr;
    }
    return context.leafOrder != nullptr ? context.leafOrder : halvingOrder;
}

BlasCapacity orderedCapacity(BlasCapacity capacity) {
    return {capacity.triangles, 1};
}

std::vector<std::vector<std::uint32_t>> orderedTriangles(
    std::span<const PrimitiveView> primitives, const BlasCapacity& capacity, LeafOrder order,
    std::span<const std::vector<std::uint32_t>> sorted, const std::map<std::uint32_t, OpacitySplit>& splits) {
    std::vector<std::vector<std::uint32_t>> ordered(primitives.size());
    // If there are many primitives, one thread orders each of them. If there are few, each one gets more
    // threads.
    const std::uint32_t threads =
        primitives.size() < 4 * std::size_t{threadsOfMachine()} ? threadsOfMachine() : 1;
    forEach(primitives.size(), [&](std::size_t i) {
        const auto split = splits.find(static_cast<std::uint32_t>(i));
        ordered[i] = split == splits.end()
                         ? orderPrimitive(primitives[i], capacity.triangles, order, threads)
                         : orderSplit(primitives[i], sorted[i], split->second, order, threads);
    });
    return ordered;
}

Box boxOf(const PrimitiveView& view, std::span<const std::uint32_t> indices) {
    LeafBox box;
    for (const std::uint32_t corner : indices) {
        box.extend(view.positions[corner]);
    }
    if (box.isVoid()) {
        return Box::nothing();
    }
    return {{box.sides[0], box.sides[1], box.sides[2]}, {-box.sides[3], -box.sides[4], -box.sides[5]}};
}

}  // namespace glint
