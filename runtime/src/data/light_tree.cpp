#include "data/light_tree.h"

#include "context/parallel.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <set>
#include <utility>

namespace glint {
namespace {

using Double3 = glm::dvec3;

constexpr double kLightPi = std::numbers::pi;
constexpr std::size_t kLightBins = 12;
// Trees of fewer lights are built by one thread, because a thread costs more than it saves.
constexpr std::size_t kLightsOfThread = 8192;
// Keeps sums of importances finite on the device, where squared distances are at least 1e-20 m².
constexpr double kMaxIntensity = 1e16;
// The bounds are rounded to float. A range grows by this factor, so that they stay bounds.
constexpr double kReachSlack = 1.0 + 1e-5;

Double3 doublesOf(const gpu::vec3& v) {
    return {v.x, v.y, v.z};
}

// Returns a cone that holds both: pbrt-v4, "Direction Cone" (DirectionCone::Union).
LightCone unite(const LightCone& a, const LightCone& b) {
    if (a.angle < b.angle) {
        return unite(b, a);
    }
    if (a.angle >= kLightPi) {
        return a;
    }
    const double between = std::acos(std::clamp(glm::dot(a.axis, b.axis), -1.0, 1.0));
    if (std::min(between + b.angle, kLightPi) <= a.angle) {
        return a;
    }
    const double angle = (a.angle + between + b.angle) / 2.0;
    const Double3 across = b.axis - glm::dot(a.axis, b.axis) * a.axis;
    const double length = std::sqrt(glm::dot(across, across));
    if (angle >= kLightPi || length < 1e-9) {
        return {};
    }
    const double turn = angle - a.angle;
    return {std::cos(turn) * a.axis + std::sin(turn) * across / length, angle};
}

void extend(LightExtent& all, const LightExtent& other) {
    if (all.isEmpty || other.isEmpty) {
        all = all.isEmpty ? other : all;
        return;
    }
    all.lower = glm::min(all.lower, other.lower);
    all.upper = glm::max(all.upper, other.upper);
    all.axes = unite(all.axes, other.axes);
    all.emission = std::max(all.emission, other.emission);
    all.intensity += other.intensity;
}

LightBounds unite(const LightBounds& a, const LightBounds& b) {
    if (a.isEmpty || b.isEmpty) {
        return a.isEmpty ? b : a;
    }
    LightBounds both;
    static_cast<LightExtent&>(both) = static_cast<const LightExtent&>(a);
    extend(both, b);
    const double whole = a.intensity + b.intensity;
    const double share = whole > 0.0 ? b.intensity / whole : 0.5;
    const Double3 apart = b.mean - a.mean;
    both.mean = a.mean + share * apart;
    both.variance = (1.0 - share) * a.variance + share * b.variance + share * (1.0 - share) * apart * apart;
    both.reach = std::max(a.reach, b.reach);
    both.twoSided = a.twoSided || b.twoSided;
    return both;
}

// The light comes from everywhere in the box alike.
void fillBox(LightBounds& bounds) {
    const Double3 size = bounds.upper - bounds.lower;
    bounds.mean = bounds.lower + 0.5 * size;
    bounds.variance = size * size / 12.0;
}

LightBounds boundsOfLight(const gpu::LightRecord& light) {
    LightBounds bounds;
    bounds.isEmpty = false;
    bounds.lower = bounds.upper = doublesOf(light.position);
    // The upper part of a light may shine on a surface that its centre is below.
    bounds.lower -= static_cast<double>(light.size);
    bounds.upper += static_cast<double>(light.size);
    fillBox(bounds);
    bounds.emission = kLightPi / 2.0;
    const Double3 color = doublesOf(light.intensity);
    // The luminance of linear Rec. 709, as in bsdf/constants.glsl.
    bounds.intensity = std::clamp(glm::dot(Double3(0.2126, 0.7152, 0.0722), color), 0.0, kMaxIntensity);
    bounds.reach = light.range > 0.0F ? light.range * kReachSlack : std::numeric_limits<double>::infinity();
    const Double3 axis = doublesOf(light.direction);
    const double length = std::sqrt(glm::dot(axis, axis));
    if (light.type == gpu::kLightSpot && length > 0.5 && light.spotScale > 0.0F) {
        const double cosOuter = -static_cast<double>(light.spotOffset) / light.spotScale;
        bounds.axes = {axis / length, 0.0};
        bounds.emission = std::acos(std::clamp(cosOuter, -1.0, 1.0));
    } else if (light.type == gpu::kLightDisk && length > 0.5) {
        bounds.axes = {axis / length, 0.0};
    }
    return bounds;
}

LightBounds boundsOfEmitter(const EmitterBounds& emitter) {
    LightBounds bounds;
    bounds.isEmpty = false;
    bounds.lower = glm::make_vec3(emitter.lower.data());
    bounds.upper = glm::make_vec3(emitter.upper.data());
    fillBox(bounds);
    bounds.emission = kLightPi / 2.0;
    bounds.intensity = std::clamp(emitter.intensity, 0.0, kMaxIntensity);
    bounds.reach = std::numeric_limits<double>::infinity();
    const Double3 normal = glm::make_vec3(emitter.normal.data());
    if (glm::dot(normal, normal) > 0.5) {
        bounds.axes = {normal, 0.0};
        bounds.twoSided = emitter.twoSided;
    }
    return bounds;
}

gpu::vec3 floatsOf(const Double3& v) {
    return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

// Numbers in [0, 1], one for each axis, in 10 bits each.
std::uint32_t packShares(const Double3& shares) {
    std::uint32_t packed = 0;
    for (glm::length_t i = 0; i < 3; ++i) {
        const double share = std::clamp(shares[i], 0.0, 1.0) * gpu::kLightShares;
        packed |= static_cast<std::uint32_t>(std::lround(share)) << (10 * i);
    }
    return packed;
}

gpu::LightNode makeLightNode(const LightBounds& bounds, std::uint32_t next) {
    gpu::LightNode node{};
    node.lower = floatsOf(bounds.lower);
    node.upper = floatsOf(bounds.upper);
    node.intensity = static_cast<float>(bounds.intensity);
    node.reach = static_cast<float>(bounds.twoSided ? -bounds.reach : bounds.reach);
    node.axis = floatsOf(bounds.axes.axis);
    node.cosAxes = static_cast<float>(std::cos(bounds.axes.angle));
    node.cosEmission = static_cast<float>(std::cos(bounds.emission));
    node.next = next;
    Double3 mean{};
    Double3 deviation{};
    for (glm::length_t i = 0; i < 3; ++i) {
        const double size = bounds.upper[i] - bounds.lower[i];
        mean[i] = size > 0.0 ? (bounds.mean[i] - bounds.lower[i]) / size : 0.5;
        deviation[i] = size > 0.0 ? 2.0 * std::sqrt(std::max(bounds.variance[i], 0.0)) / size : 0.0;
    }
    node.mean3x10 = packShares(mean);
    node.deviation3x10 = packShares(deviation);
    return node;
}

struct LightMember {
    std::uint32_t light = 0;
    LightBounds bounds;
};

// The cost of a set of lights: intensity, times the measure of the directions in which they shine, times the
// area of their box. The measure is pbrt-v4's closed form of Conty Estevez and Kulla's integral. `stretch`
// prefers splits across the longest axis.
double costOf(const LightExtent& bounds, double stretch) {
    if (bounds.isEmpty) {
        return 0.0;
    }
    const double axes = bounds.axes.angle;
    const double whole = std::min(axes + bounds.emission, kLightPi);
    const double directions = 2.0 * kLightPi * (1.0 - std::cos(axes)) +
                              kLightPi / 2.0 *
                                  (2.0 * whole * std::sin(axes) - std::cos(axes - 2.0 * whole) -
                                   2.0 * axes * std::sin(axes) + std::cos(axes));
    const Double3 size = bounds.upper - bounds.lower;
    const double area = 2.0 * (size[0] * size[1] + size[1] * size[2] + size[2] * size[0]);
    return bounds.intensity * directions * stretch * area;
}

struct LightSplit {
    glm::length_t axis = 0;
    std::size_t bin = 0;  // the last one of the first child
    double cost = std::numeric_limits<double>::infinity();
};

class LightTreeBuilder {
public:
    LightTreeBuilder(std::vector<LightMember> members, std::vector<gpu::LightNode>& nodes)
        : members_(std::move(members)), nodes_(nodes) {}

    // Builds the nodes of members [begin, end), which are 2 (end - begin) - 1, from `node` on. `depth` is the
    // number of nodes above them.
    LightBounds build(std::size_t begin, std::size_t end, std::size_t node, std::uint32_t depth,
                      int threads) {
        if (end - begin == 1) {
            nodes_[node] = makeLightNode(members_[begin].bounds, gpu::kLightLeaf | members_[begin].light);
            return members_[begin].bounds;
        }
        const std::size_t middle = split(begin, end, std::uint64_t{1} << (gpu::kLightTreeDepth - depth - 1));
        const std::size_t second = node + 2 * (middle - begin);
        LightBounds first;
        LightBounds last;
        const bool together = threads > 1 && end - begin > kLightsOfThread;
        const int others = together ? threads / 2 : 1;
        callBoth(
            together, [&] { last = build(middle, end, second, depth + 1, together ? threads - others : 1); },
            [&] { first = build(begin, middle, node + 1, depth + 1, others); });
        const LightBounds both = unite(first, last);
        nodes_[node] = makeLightNode(both, static_cast<std::uint32_t>(second));
        return both;
    }

private:
    static std::size_t binOf(const LightExtent& bounds, const LightExtent& centres, glm::length_t axis) {
        const double size = centres.upper[axis] - centres.lower[axis];
        const double middle = 0.5 * (bounds.lower[axis] + bounds.upper[axis]);
        const double place = (middle - centres.lower[axis]) / size * static_cast<double>(kLightBins);
        return std::min(static_cast<std::size_t>(std::max(place, 0.0)), kLightBins - 1);
    }

    LightSplit bestSplit(std::size_t begin, std::size_t end, const LightExtent& all) const {
        const Double3 size = all.upper - all.lower;
        const double longest = std::max({size.x, size.y, size.z});
        LightSplit best;
        for (glm::length_t axis = 0; axis < 3; ++axis) {
            if (!(size[axis] > 0.0)) {
                continue;
            }
            std::array<LightExtent, kLightBins> bins{};
            for (std::size_t i = begin; i < end; ++i) {
                extend(bins[binOf(members_[i].bounds, all, axis)], members_[i].bounds);
            }
            std::array<LightExtent, kLightBins> above{};
            for (std::size_t i = kLightBins - 1; i > 0; --i) {
                above[i - 1] = above[i];
                extend(above[i - 1], bins[i]);
            }
            LightExtent below;
            for (std::size_t i = 0; i + 1 < kLightBins; ++i) {
                // An empty bin parts the lights as the one before it does.
                if (bins[i].isEmpty || above[i].isEmpty) {
                    continue;
                }
                extend(below, bins[i]);
                const double stretch = longest / size[axis];
                const double cost = costOf(below, stretch) + costOf(above[i], stretch);
                if (cost < best.cost) {
                    best = {axis, i, cost};
                }
            }
        }
        return best;
    }

    // Halves the members by their place along the longest axis. Lights at one place are halved by number.
    std::size_t halve(std::size_t begin, std::size_t end, const LightExtent& all) {
        const Double3 size = all.upper - all.lower;
        glm::length_t axis = 0;
        for (glm::length_t i = 1; i < 3; ++i) {
            axis = size[i] > size[axis] ? i : axis;
        }
        const auto first = members_.begin();
        std::stable_sort(first + static_cast<std::ptrdiff_t>(begin), first + static_cast<std::ptrdiff_t>(end),
                         [&](const LightMember& a, const LightMember& b) {
                             return a.bounds.lower[axis] + a.bounds.upper[axis] <
                                    b.bounds.lower[axis] + b.bounds.upper[axis];
                         });
        return begin + (end - begin) / 2;
    }

    // Returns where the second part begins. No part has more than `most` members.
    std::size_t split(std::size_t begin, std::size_t end, std::uint64_t most) {
        // Only the box matters.
        LightExtent all;
        all.lower = members_[begin].bounds.lower;
        all.upper = members_[begin].bounds.upper;
        for (std::size_t i = begin + 1; i < end; ++i) {
            all.lower = glm::min(all.lower, members_[i].bounds.lower);
            all.upper = glm::max(all.upper, members_[i].bounds.upper);
        }
        const LightSplit best = bestSplit(begin, end, all);
        if (!std::isfinite(best.cost)) {
            return halve(begin, end, all);
        }
        const auto first = members_.begin();
        const auto middle = std::stable_partition(
            first + static_cast<std::ptrdiff_t>(begin), first + static_cast<std::ptrdiff_t>(end),
            [&](const LightMember& member) { return binOf(member.bounds, all, best.axis) <= best.bin; });
        const auto place = static_cast<std::size_t>(middle - first);
        return std::max(place - begin, end - place) <= most ? place : halve(begin, end, all);
    }

    std::vector<LightMember> members_;
    std::vector<gpu::LightNode>& nodes_;
};

}  // namespace

LightTree buildLightTree(std::span<const gpu::LightRecord> lights, std::span<const EmitterBounds> emitters,
                         bool keepsDark) {
    LightTree tree;
    std::vector<LightMember> members;
    std::vector<gpu::LightNode> apart;
    const auto isDirectional = [](const gpu::LightRecord& light) {
        return light.type == gpu::kLightDirectional;
    };
    const auto positions =
        lights.size() - static_cast<std::size_t>(std::ranges::count_if(lights, isDirectional));
    const bool allApart = !emitters.empty() && positions <= gpu::kMostLightsApart;
    for (std::uint32_t i = 0; i < lights.size(); ++i) {
        if (allApart || isDirectional(lights[i])) {
            gpu::LightNode leaf{};
            leaf.next = gpu::kLightLeaf | i;
            apart.push_back(leaf);
        } else {
            members.push_back({i, boundsOfLight(lights[i])});
        }
    }
    for (std::uint32_t i = 0; i < emitters.size(); ++i) {
        if (keepsDark || emitters[i].intensity > 0.0) {
            members.push_back({gpu::kLightEmitter | i, boundsOfEmitter(emitters[i])});
        }
    }
    tree.apart = static_cast<std::uint32_t>(apart.size());
    if (!members.empty()) {
        const std::size_t count = members.size();
        tree.treeNodes = static_cast<std::uint32_t>(2 * count - 1);
        tree.nodes.resize(tree.treeNodes);
        LightTreeBuilder(std::move(members), tree.nodes)
            .build(0, count, 0, 0, static_cast<int>(std::min(threadsOfMachine(), 16U)));
    }
    tree.nodes.insert(tree.nodes.end(), apart.begin(), apart.end());
    return tree;
}

void refitLightTree(LightTree& tree, std::span<const gpu::LightRecord> lights,
                    std::span<const EmitterBounds> emitters) {
    constexpr std::uint32_t kNoLeaf = LightTree::Refits::kNoLeaf;
    LightTree::Refits refits{std::vector<LightBounds>(tree.treeNodes),
                             std::vector<std::uint32_t>(tree.treeNodes),
                             std::vector<std::uint32_t>(lights.size(), kNoLeaf),
                             std::vector<std::uint32_t>(emitters.size(), kNoLeaf)};
    // Children come after their parent.
    for (std::uint32_t i = tree.treeNodes; i-- > 0;) {
        const std::uint32_t next = tree.nodes[i].next;
        const std::uint32_t number = next & ~(gpu::kLightLeaf | gpu::kLightEmitter);
        if ((next & gpu::kLightLeaf) == 0) {
            refits.parents[i + 1] = refits.parents[next] = i;
            refits.bounds[i] = unite(refits.bounds[i + 1], refits.bounds[next]);
        } else if ((next & gpu::kLightEmitter) != 0) {
            refits.emitterLeaves[number] = i;
            refits.bounds[i] = boundsOfEmitter(emitters[number]);
        } else {
            refits.lightLeaves[number] = i;
            refits.bounds[i] = boundsOfLight(lights[number]);
        }
        tree.nodes[i] = makeLightNode(refits.bounds[i], next);
    }
    tree.refits = std::move(refits);
}

std::vector<std::uint32_t> refitLightTree(LightTree& tree,
                                          std::span<const std::pair<std::uint32_t, gpu::LightRecord>> lights,
                                          std::span<const std::pair<std::uint32_t, EmitterBounds>> emitters) {
    LightTree::Refits& refits = *tree.refits;
    std::set<std::uint32_t, std::greater<>> changed;  // children before their parent
    const auto change = [&](std::uint32_t leaf, const LightBounds& bounds) {
        refits.bounds[leaf] = bounds;
        for (std::uint32_t node = leaf; changed.insert(node).second; node = refits.parents[node]) {
        }
    };
    for (const auto& [number, light] : lights) {
        if (const std::uint32_t leaf = refits.lightLeaves[number]; leaf != LightTree::Refits::kNoLeaf) {
            change(leaf, boundsOfLight(light));
        }
    }
    for (const auto& [number, emitter] : emitters) {
        if (const std::uint32_t leaf = refits.emitterLeaves[number]; leaf != LightTree::Refits::kNoLeaf) {
            change(leaf, boundsOfEmitter(emitter));
        }
    }
    for (const std::uint32_t node : changed) {
        const std::uint32_t next = tree.nodes[node].next;
        if ((next & gpu::kLightLeaf) == 0) {
            refits.bounds[node] = unite(refits.bounds[node + 1], refits.bounds[next]);
        }
        tree.nodes[node] = makeLightNode(refits.bounds[node], next);
    }
    return {changed.begin(), changed.end()};
}

}  // namespace glint
