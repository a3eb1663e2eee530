#include "lights/emitter_shape.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace glint {
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

EmitterShape::EmitterShape(const EmissionEntry& emission, const PrimitiveView& view,
                           std::span<const std::uint32_t> ordered)
    : positions(view.positions.begin(), view.positions.end()), indices(ordered.begin(), ordered.end()) {
    if (emission.texture != EmissionEntry::kNone) {
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

}  // namespace glint
