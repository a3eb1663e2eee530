#include "data/emitters.h"

#include "data/instance_math.h"
#include "package/package.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>
#include <tuple>
#include <utility>

namespace glint {
namespace {

// A triangle's texels are looked up on a level where its box has no more than so many in each axis.
constexpr std::uint32_t kMostCells = 16;
// Levels that are larger than this along an axis are not kept.
constexpr std::uint32_t kMostKept = 256;
// SamplerEntry::wrapU.
constexpr std::uint32_t kWrapRepeat = 0;
constexpr std::uint32_t kWrapClamp = 1;

// Returns the linear value of each number that a channel may have.
std::vector<float> channelValues(bool isWide, bool isColor) {
    const std::size_t count = isWide ? 65536 : 256;
    std::vector<float> values(count);
    for (std::size_t i = 0; i < count; ++i) {
        const double value = static_cast<double>(i) / static_cast<double>(count - 1);
        values[i] = static_cast<float>(isColor ? decodeSrgb(value) : value);
    }
    return values;
}

// Texels [first, last] of an axis.
struct TexelRange {
    std::uint32_t first = 0;
    std::uint32_t last = 0;
};

TexelRange rangeOf(double lower, double upper, std::uint32_t size, std::uint32_t wrap) {
    const TexelRange whole{0, size - 1};
    // A linear filter reaches half a texel further, and coordinates are rounded.
    double first = std::floor(lower * size - 1.0);
    double last = std::floor(upper * size + 1.0);
    if (!(last - first < size)) {
        return whole;
    }
    const double end = size - 1.0;
    if (wrap == kWrapClamp) {
        first = std::clamp(first, 0.0, end);
        last = std::clamp(last, 0.0, end);
    } else if (wrap == kWrapRepeat) {
        const double turns = std::floor(first / size) * size;
        first -= turns;
        last -= turns;
    }
    if (first < 0.0 || last > end) {
        return whole;
    }
    return {static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(last)};
}

}  // namespace

EmissionTexels::Level EmissionTexels::halfOf(const Level& level) {
    Level half{(level.width + 1) / 2, (level.height + 1) / 2, {}};
    half.values.reserve(std::size_t{half.width} * half.height);
    for (std::uint32_t y = 0; y < half.height; ++y) {
        for (std::uint32_t x = 0; x < half.width; ++x) {
            double sum = 0.0;
            int count = 0;
            for (std::uint32_t row = 2 * y; row < std::min(2 * y + 2, level.height); ++row) {
                for (std::uint32_t column = 2 * x; column < std::min(2 * x + 2, level.width); ++column) {
                    sum += level.values[std::size_t{row} * level.width + column];
                    ++count;
                }
            }
            half.values.push_back(static_cast<float>(sum / count));
        }
    }
    return half;
}

EmissionTexels::EmissionTexels(const ImageView& image, bool isColor)
    : width_(image.width), height_(image.height) {
    const bool isWide = image.format == ImageView::Format::Rgba16;
    const std::span<const std::uint8_t> pixels = isBlockFormat(image.format) ? image.decoded : image.pixels;
    const std::vector<float> values = channelValues(isWide, isColor);
    const auto channelAt = [&](std::size_t index) {
        if (!isWide) {
            return values[pixels[index]];
        }
        std::uint16_t number = 0;
        std::memcpy(&number, &pixels[2 * index], sizeof number);
        return values[number];
    };
    while (((std::max(width_, height_) - 1) >> skipped_) >= kMostKept) {
        ++skipped_;
    }
    const std::uint32_t side = 1U << skipped_;
    Level level{((width_ - 1) >> skipped_) + 1, ((height_ - 1) >> skipped_) + 1, {}};
    level.values.reserve(std::size_t{level.width} * level.height);
    for (std::uint32_t top = 0; top < height_; top += side) {
        const std::uint32_t rows = std::min(side, height_ - top);
        std::vector<double> sums(level.width);
        for (std::uint32_t y = top; y < top + rows; ++y) {
            for (std::uint32_t x = 0; x < width_; ++x) {
                const std::size_t texel = 4 * (std::size_t{y} * width_ + x);
                sums[x >> skipped_] += 0.2126F * channelAt(texel) + 0.7152F * channelAt(texel + 1) +
                                       0.0722F * channelAt(texel + 2);
            }
        }
        for (std::uint32_t x = 0; x < level.width; ++x) {
            const std::uint32_t columns = std::min(side, width_ - (x << skipped_));
            level.values.push_back(static_cast<float>(sums[x] / (static_cast<double>(rows) * columns)));
        }
    }
    while (level.values.size() > 1) {
        Level half = halfOf(level);
        levels_.push_back(std::move(level));
        level = std::move(half);
    }
    levels_.push_back(std::move(level));
}

double EmissionTexels::mean(const TexelBox& box, std::uint32_t wrapU, std::uint32_t wrapV) const {
    const TexelRange u = rangeOf(box.lower[0], box.upper[0], width_, wrapU);
    const TexelRange v = rangeOf(box.lower[1], box.upper[1], height_, wrapV);
    std::uint32_t number = skipped_;
    while ((u.last >> number) - (u.first >> number) >= kMostCells ||
           (v.last >> number) - (v.first >> number) >= kMostCells) {
        ++number;
    }
    const Level& level = levels_[number - skipped_];
    double sum = 0.0;
    int count = 0;
    for (std::uint32_t y = v.first >> number; y <= v.last >> number; ++y) {
        for (std::uint32_t x = u.first >> number; x <= u.last >> number; ++x) {
            sum += level.values[std::size_t{y} * level.width + x];
            ++count;
        }
    }
    return sum / count;
}

namespace {

using package::EmissionEntry;

// Two NaNs count as the same, too.
bool same(const gpu::vec3& a, const gpu::vec3& b) {
    return std::ranges::equal(std::as_bytes(std::span(&a, 1)), std::as_bytes(std::span(&b, 1)));
}

bool showsSame(const EmitterTexture& a, const EmitterTexture& b) {
    return a.texels == b.texels && same(a.record.rowU, b.record.rowU) && same(a.record.rowV, b.record.rowV) &&
           a.sampler.wrapU == b.sampler.wrapU && a.sampler.wrapV == b.sampler.wrapV && a.second == b.second &&
           a.animated == b.animated;
}

double meanOf(const EmitterShape& shape, const EmitterTexture& texture, std::size_t triangle) {
    const std::vector<std::array<float, 2>>& set = shape.texCoords[texture.second ? 1 : 0];
    if (set.empty() || texture.animated) {
        return texture.texels->mean();
    }
    const gpu::TextureRecord& record = texture.record;
    TexelBox box{{INFINITY, INFINITY}, {-INFINITY, -INFINITY}};
    for (std::size_t corner = 0; corner < 3; ++corner) {
        const std::array<float, 2>& place = set[shape.indices[3 * triangle + corner]];
        const double u = place[0];
        const double v = place[1];
        const double at[2] = {record.rowU.x * u + record.rowU.y * v + record.rowU.z,
                              record.rowV.x * u + record.rowV.y * v + record.rowV.z};
        for (std::size_t axis = 0; axis < 2; ++axis) {
            box.lower[axis] = std::min(box.lower[axis], at[axis]);
            box.upper[axis] = std::max(box.upper[axis], at[axis]);
        }
    }
    return texture.texels->mean(box, texture.sampler.wrapU, texture.sampler.wrapV);
}

}  // namespace

EmitterShape::EmitterShape(const PrimitiveView& view, std::span<const std::uint32_t> ordered,
                           bool hasTexCoords)
    : positions(view.positions.begin(), view.positions.end()), indices(ordered.begin(), ordered.end()) {
    if (hasTexCoords) {
        texCoords[0].assign(view.texCoords0.begin(), view.texCoords0.end());
        texCoords[1].assign(view.texCoords1.begin(), view.texCoords1.end());
    }
}

std::optional<EmitterTexture> emitterTexture(const EmissionEntry& emission, std::uint32_t featureInputs,
                                             const gpu::TextureRecord& record,
                                             std::span<const package::SamplerEntry> samplers,
                                             std::shared_ptr<const EmissionTexels> texels) {
    if (texels == nullptr || (featureInputs & emission.textureInput) == 0 ||
        emission.texture == EmissionEntry::kNone) {
        return std::nullopt;
    }
    // This is the choice of readsSecondSet() in hit/texture.glsl.
    const bool second = (featureInputs & emission.texCoord1Input) != 0 &&
                        ((featureInputs & emission.texCoord0Input) == 0 || record.texCoord == 1);
    return EmitterTexture{std::move(texels), record, samplers[record.samplerIndex], second, false};
}

TexelMeans EmitterMeans::find(const std::shared_ptr<const EmitterShape>& shape, std::uint32_t material,
                              const std::optional<EmitterTexture>& texture) {
    if (!texture) {
        return nullptr;
    }
    const std::pair key(shape.get(), material);
    const auto known = known_.find(key);
    if (known != known_.end() && showsSame(known->second.texture, *texture)) {
        known->second.used = true;
        return known->second.means;
    }
    auto means = std::make_shared<std::vector<float>>(shape->indices.size() / 3);
    for (std::size_t i = 0; i < means->size(); ++i) {
        (*means)[i] = static_cast<float>(meanOf(*shape, *texture, i));
    }
    known_[key] = {shape, *texture, means, true};
    return means;
}

void EmitterMeans::forgetUnused() {
    std::erase_if(known_, [](const auto& entry) { return !entry.second.used; });
    for (auto& [key, known] : known_) {
        known.used = false;
    }
}

namespace {

glm::dvec3 pointAt(const std::array<float, 12>& rows, const std::array<float, 3>& point) {
    glm::dvec3 result{};
    for (std::size_t row = 0; row < 3; ++row) {
        double& sum = result[static_cast<glm::length_t>(row)];
        sum = rows[4 * row + 3];
        for (std::size_t column = 0; column < 3; ++column) {
            sum += static_cast<double>(rows[4 * row + column]) * point[column];
        }
    }
    return result;
}

std::array<double, 3> toArray(const glm::dvec3& v) {
    return {v.x, v.y, v.z};
}

EmitterBounds boundsOf(const std::array<glm::dvec3, 3>& corners, bool twoSided, bool mirrored,
                       double luminance) {
    EmitterBounds bounds;
    bounds.lower = toArray(glm::min(glm::min(corners[0], corners[1]), corners[2]));
    bounds.upper = toArray(glm::max(glm::max(corners[0], corners[1]), corners[2]));
    const glm::dvec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
    const double length = std::hypot(normal.x, normal.y, normal.z);
    bounds.twoSided = twoSided;
    if (std::isfinite(length) && length > 0.0) {
        bounds.intensity = 0.5 * length * luminance;
        bounds.normal = toArray((mirrored ? -normal : normal) / length);
    }
    return bounds;
}

}  // namespace

double emittedLuminance(std::span<const std::uint8_t> record, const EmissionEntry& emission) {
    std::array<float, 3> color{};
    float strength = 1.0F;
    if (emission.factor != EmissionEntry::kNone) {
        std::memcpy(color.data(), &record[emission.factor], sizeof color);
    }
    if (emission.strength != EmissionEntry::kNone) {
        std::memcpy(&strength, &record[emission.strength], sizeof strength);
    }
    const double sum = 0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2];
    return std::isfinite(sum * strength) ? std::max(sum * strength, 0.0) : 0.0;
}

Emitters::Emitters(const EmissionEntry& emission, std::vector<EmitterPart> parts)
    : emission_(emission), parts_(std::move(parts)) {
    std::ranges::sort(parts_, {}, [](const EmitterPart& part) {
        return std::tuple(part.instance, part.primitive, part.first);
    });
    for (EmitterPart& part : parts_) {
        part.record = static_cast<std::uint32_t>(records.size());
        for (std::uint32_t i = 0; i < part.count; ++i) {
            records.push_back({part.geometry, i, gpu::kNoEmitter});
        }
    }
}

std::vector<std::uint32_t> Emitters::firstsOf(std::size_t geometries) const {
    std::vector<std::uint32_t> firsts(geometries, gpu::kNoEmitter);
    for (const EmitterPart& part : parts_) {
        firsts[part.geometry] = part.record;
    }
    return firsts;
}

namespace {

// Calls visit(record, bounds) for the triangles of a part.
template <typename Visit>
void forEachBounds(const EmitterPart& part, const InstancePoses& poses, const Visit& visit) {
    const InstanceView instance = poses(part.instance);
    const std::array<float, 12>& rows = instance.objectToWorld;
    const bool shown = instance.visible && isInvertible(rows);
    const bool mirrored = (makeInstanceRecord(rows).flags & gpu::kInstanceMirrored) != 0;
    const Box box = part.motion != nullptr ? part.motion->at(instance) : Box::nothing();
    for (std::uint32_t triangle = 0; triangle < part.count; ++triangle) {
        const std::size_t i = std::size_t{part.first} + triangle;
        std::array<glm::dvec3, 3> corners{};
        for (std::size_t corner = 0; corner < 3; ++corner) {
            corners[corner] = pointAt(rows, part.shape->positions[part.shape->indices[3 * i + corner]]);
        }
        const double texels = part.texels != nullptr ? (*part.texels)[i] : 1.0;
        EmitterBounds bounds =
            boundsOf(corners, part.twoSided, mirrored, shown ? part.luminance * texels : 0.0);
        if (part.motion != nullptr) {
            // Only the device knows where in the box the triangle is, and where it faces.
            bounds.lower = box.min;
            bounds.upper = box.max;
            bounds.normal = {};
        }
        visit(part.record + triangle, bounds);
    }
}

}  // namespace

std::vector<EmitterBounds> Emitters::boundsAt(const InstancePoses& poses) const {
    std::vector<EmitterBounds> all;
    all.reserve(records.size());
    for (const EmitterPart& part : parts_) {
        forEachBounds(part, poses,
                      [&](std::uint32_t /*record*/, const EmitterBounds& bounds) { all.push_back(bounds); });
    }
    return all;
}

std::vector<std::pair<std::uint32_t, EmitterBounds>> Emitters::boundsOf(
    std::span<const std::uint32_t> instances, const InstancePoses& poses) const {
    std::vector<std::pair<std::uint32_t, EmitterBounds>> some;
    for (const std::uint32_t instance : instances) {
        for (auto part = std::ranges::lower_bound(parts_, instance, {}, &EmitterPart::instance);
             part != parts_.end() && part->instance == instance; ++part) {
            forEachBounds(*part, poses, [&](std::uint32_t record, const EmitterBounds& bounds) {
                some.emplace_back(record, bounds);
            });
        }
    }
    return some;
}

std::vector<std::uint32_t> Emitters::takeMaterial(const ChangingMaterial& material) {
    const double luminance = emittedLuminance(material.record, emission_);
    std::vector<std::uint32_t> instances;
    for (EmitterPart& part : parts_) {
        if (part.material == material.material && std::exchange(part.luminance, luminance) != luminance) {
            instances.push_back(part.instance);
        }
    }
    return instances;
}

void Emitters::setLeaves(const LightTree& tree, std::span<const EmitterBounds> bounds) {
    for (gpu::EmitterRecord& record : records) {
        record.leaf = gpu::kNoEmitter;
    }
    for (std::uint32_t node = 0; node < tree.treeNodes; ++node) {
        const std::uint32_t next = tree.nodes[node].next;
        if ((next & gpu::kLightLeaf) != 0 && (next & gpu::kLightEmitter) != 0) {
            const std::uint32_t emitter = next & ~(gpu::kLightLeaf | gpu::kLightEmitter);
            records[emitter].leaf = bounds[emitter].intensity > 0.0 ? node : gpu::kNoEmitter;
        }
    }
}

}  // namespace glint
