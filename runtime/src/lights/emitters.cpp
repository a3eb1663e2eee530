#include "lights/emitters.h"

#include "scene/instance_math.h"
#include "scene/material_table.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <set>
#include <span>
#include <tuple>
#include <utility>

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

namespace {

using Double3 = std::array<double, 3>;
using package::EmissionEntry;

Double3 differenceOf(const Double3& a, const Double3& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

Double3 crossOf(const Double3& a, const Double3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Double3 pointAt(const std::array<float, 12>& rows, const std::array<float, 3>& point) {
    Double3 result{};
    for (std::size_t row = 0; row < 3; ++row) {
        result[row] = rows[4 * row + 3];
        for (std::size_t column = 0; column < 3; ++column) {
            result[row] += static_cast<double>(rows[4 * row + column]) * point[column];
        }
    }
    return result;
}

EmitterBounds boundsOf(const std::array<Double3, 3>& corners, bool twoSided, bool mirrored,
                       double luminance) {
    EmitterBounds bounds;
    bounds.lower = bounds.upper = corners[0];
    for (const Double3& corner : corners) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            bounds.lower[axis] = std::min(bounds.lower[axis], corner[axis]);
            bounds.upper[axis] = std::max(bounds.upper[axis], corner[axis]);
        }
    }
    const Double3 normal =
        crossOf(differenceOf(corners[1], corners[0]), differenceOf(corners[2], corners[0]));
    const double length = std::hypot(normal[0], normal[1], normal[2]);
    bounds.twoSided = twoSided;
    if (std::isfinite(length) && length > 0.0) {
        bounds.intensity = 0.5 * length * luminance;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            bounds.normal[axis] = (mirrored ? -normal[axis] : normal[axis]) / length;
        }
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
    for (const EmitterPart& part : parts_) {
        for (std::uint32_t i = 0; i < part.count; ++i) {
            records.push_back({part.geometry, i, gpu::kNoEmitter});
        }
    }
}

std::vector<std::uint32_t> Emitters::firstsOf(std::size_t geometries) const {
    std::vector<std::uint32_t> firsts(geometries, gpu::kNoEmitter);
    std::uint32_t next = 0;
    for (const EmitterPart& part : parts_) {
        firsts[part.geometry] = next;
        next += part.count;
    }
    return firsts;
}

std::vector<EmitterBounds> Emitters::boundsAt(std::span<const InstanceView> instances) const {
    std::vector<EmitterBounds> all;
    all.reserve(records.size());
    for (const EmitterPart& part : parts_) {
        const InstanceView& instance = instances[part.instance];
        const std::array<float, 12>& rows = instance.objectToWorld;
        const bool shown = instance.visible && isInvertible(rows);
        const bool mirrored = (makeInstanceRecord(rows).flags & gpu::kInstanceMirrored) != 0;
        const Box box = part.motion != nullptr ? part.motion->at(instance) : Box::nothing();
        for (std::size_t i = part.first; i < std::size_t{part.first} + part.count; ++i) {
            std::array<Double3, 3> corners{};
            for (std::size_t corner = 0; corner < 3; ++corner) {
                corners[corner] = pointAt(rows, part.shape->positions[part.shape->indices[3 * i + corner]]);
            }
            const double texels = part.texels != nullptr ? (*part.texels)[i] : 1.0;
            const double luminance = shown ? part.luminance * texels : 0.0;
            all.push_back(boundsOf(corners, part.twoSided, mirrored, luminance));
            if (part.motion != nullptr) {
                // Only the device knows where in the box the triangle is, and where it faces.
                all.back().lower = box.min;
                all.back().upper = box.max;
                all.back().normal = {};
            }
        }
    }
    return all;
}

void Emitters::takeMaterials(std::span<const ChangingMaterial> changing) {
    for (EmitterPart& part : parts_) {
        const auto found = std::ranges::lower_bound(changing, part.material, {}, &ChangingMaterial::material);
        if (found != changing.end() && found->material == part.material) {
            part.luminance = emittedLuminance(found->record, emission_);
        }
    }
}

void Emitters::setLeaves(const LightTree& tree) {
    for (gpu::EmitterRecord& record : records) {
        record.leaf = gpu::kNoEmitter;
    }
    for (std::uint32_t node = 0; node < tree.treeNodes; ++node) {
        const std::uint32_t next = tree.nodes[node].next;
        if ((next & gpu::kLightLeaf) != 0 && (next & gpu::kLightEmitter) != 0) {
            records[next & ~(gpu::kLightLeaf | gpu::kLightEmitter)].leaf = node;
        }
    }
}

void Emitters::setLeaves(std::span<const EmitterBounds> bounds) {
    for (std::size_t i = 0; i < records.size(); ++i) {
        records[i].leaf = bounds[i].intensity > 0.0 ? 0 : gpu::kNoEmitter;
    }
}

namespace {

// Makes the parts of a scene that is not edited.
class PartsOfScene {
public:
    PartsOfScene(const EmissionEntry& emission, const PackageScene& known, const SceneView& scene,
                 std::span<const std::vector<std::uint32_t>> ordered, std::span<const std::uint8_t> materials)
        : emission_(emission),
          known_(known),
          scene_(scene),
          ordered_(ordered),
          materials_(tableWith(known.materials, materials)) {
        for (const MaterialView& material : scene.materials) {
            if (scene.moves) {
                changing_.insert(material.material);
            }
        }
    }

    EmitterPart part(const TriangleRange& range, const package::PrimitiveEntry& entry, bool deforms) {
        EmitterPart part;
        part.primitive = entry.primitive;
        part.material = entry.materialIndex;
        part.first = range.first;
        part.count = range.count;
        part.twoSided = (entry.geometryFlags & gpu::kGeometryDoubleSided) != 0;
        part.luminance = emittedLuminance(
            materials_.bytes.subspan(std::size_t{entry.materialIndex} * materials_.recordBytes,
                                     materials_.recordBytes),
            emission_);
        std::shared_ptr<const EmitterShape>& shape = shapes_[range.primitive];
        if (shape == nullptr) {
            const PrimitiveView& view = scene_.primitives[range.primitive];
            const bool sorted = !ordered_.empty() && !ordered_[range.primitive].empty();
            shape = std::make_shared<EmitterShape>(
                emission_, view, sorted ? std::span(ordered_[range.primitive]) : view.indices);
        }
        part.shape = shape;
        part.texels = means_.find(shape, entry.materialIndex, textureOf(entry));
        if (deforms) {
            std::shared_ptr<const MotionBounds>& bounds = motions_[entry.mesh];
            if (bounds == nullptr) {
                const PrimitiveRange mesh = primitivesOf(scene_.primitives, entry.mesh);
                bounds = std::make_shared<MotionBounds>(
                    scene_.primitives.subspan(mesh.first, mesh.end - mesh.first));
            }
            part.motion = bounds;
        }
        return part;
    }

private:
    std::optional<EmitterTexture> textureOf(const package::PrimitiveEntry& entry) {
        if ((entry.featureInputs & emission_.textureInput) == 0 ||
            emission_.texture == EmissionEntry::kNone) {
            return std::nullopt;
        }
        const gpu::TextureRecord record = textureAt(materials_, entry.materialIndex, emission_.texture);
        std::shared_ptr<const EmissionTexels>& texels = texels_[record.textureIndex];
        if (texels == nullptr) {
            const package::TextureEntry& texture = known_.textures[record.textureIndex];
            texels = std::make_shared<EmissionTexels>(scene_.images[texture.image], texture.srgb != 0);
        }
        std::optional<EmitterTexture> result =
            emitterTexture(emission_, entry.featureInputs, record, known_.samplers, texels);
        // An animation may move the texture.
        result->animated = changing_.contains(entry.materialIndex);
        return result;
    }

    const EmissionEntry& emission_;
    const PackageScene& known_;
    const SceneView& scene_;
    std::span<const std::vector<std::uint32_t>> ordered_;
    MaterialTable materials_;
    std::set<std::uint32_t> changing_;
    std::map<std::uint32_t, std::shared_ptr<const EmitterShape>> shapes_;    // by primitive of the scene
    std::map<std::uint32_t, std::shared_ptr<const EmissionTexels>> texels_;  // by texture
    std::map<std::uint32_t, std::shared_ptr<const MotionBounds>> motions_;   // by mesh
    EmitterMeans means_;
};

}  // namespace

Emitters emittersOf(const Package& package, const PackageScene& known, const SceneView& scene,
                    const SceneLayout& layout, const DeformedAddresses& deformed,
                    std::span<const std::vector<std::uint32_t>> ordered,
                    std::span<const std::uint8_t> materials) {
    PartsOfScene maker(*package.emission(), known, scene, ordered, materials);
    std::vector<EmitterPart> parts;
    for (const PartInstance& placed : layout.partInstances) {
        std::uint32_t geometry = placed.customIndex;
        for (const TriangleRange& range : layout.parts[placed.part].ranges) {
            const std::uint32_t own = geometry++;
            const PrimitiveView& view = scene.primitives[range.primitive];
            const package::PrimitiveEntry& entry = *known.findPrimitive(view.mesh, view.primitive);
            if ((entry.geometryFlags & gpu::kGeometryEmitter) != 0) {
                parts.push_back(
                    maker.part(range, entry, deformed.contains({placed.instance, range.primitive})));
                parts.back().geometry = own;
                parts.back().instance = placed.instance;
            }
        }
    }
    return {*package.emission(), std::move(parts)};
}

}  // namespace glint
