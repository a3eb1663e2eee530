#include "scene/emitters.h"

#include "scene/emission_texels.h"
#include "scene/instance_math.h"
#include "scene/material_table.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>

namespace glint {
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

// The luminance of what a record says, in linear Rec. 709, as in bsdf/constants.glsl.
double emittedLuminance(const std::uint8_t* record, const EmissionEntry& entry) {
    std::array<float, 3> color{};
    float strength = 1.0F;
    if (entry.factor != EmissionEntry::kNone) {
        std::memcpy(color.data(), record + entry.factor, sizeof color);
    }
    if (entry.strength != EmissionEntry::kNone) {
        std::memcpy(&strength, record + entry.strength, sizeof strength);
    }
    const double sum = 0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2];
    return std::isfinite(sum * strength) ? std::max(sum * strength, 0.0) : 0.0;
}

// Finds how bright the texture of an emissive material is on triangles.
class TexelFinder {
public:
    TexelFinder(const EmissionEntry& emission, const PackageScene& known, const SceneView& scene)
        : emission_(emission), known_(known), scene_(scene) {
        for (const MaterialView& material : scene.materials) {
            if (scene.moves) {
                changing_.insert(material.material);
            }
        }
    }

    // `corners` are vertices of the primitive.
    double mean(const package::PrimitiveEntry& entry, const PrimitiveView& view,
                const std::array<std::uint32_t, 3>& corners) {
        if ((entry.featureInputs & emission_.textureInput) == 0 ||
            emission_.texture == EmissionEntry::kNone) {
            return 1.0;
        }
        const gpu::TextureRecord texture =
            textureAt(known_.materials, entry.materialIndex, emission_.texture);
        const EmissionTexels& texels = texelsOf(texture.textureIndex);
        // As readsSecondSet() of hit/texture.glsl chooses.
        const bool second = (entry.featureInputs & emission_.texCoord1Input) != 0 &&
                            ((entry.featureInputs & emission_.texCoord0Input) == 0 || texture.texCoord == 1);
        const std::span<const std::array<float, 2>> set = second ? view.texCoords1 : view.texCoords0;
        // An animation may move the texture.
        if (set.empty() || changing_.contains(entry.materialIndex)) {
            return texels.mean();
        }
        TexelBox box{{INFINITY, INFINITY}, {-INFINITY, -INFINITY}};
        for (const std::uint32_t corner : corners) {
            const double u = set[corner][0];
            const double v = set[corner][1];
            const double at[2] = {texture.rowU.x * u + texture.rowU.y * v + texture.rowU.z,
                                  texture.rowV.x * u + texture.rowV.y * v + texture.rowV.z};
            for (std::size_t axis = 0; axis < 2; ++axis) {
                box.lower[axis] = std::min(box.lower[axis], at[axis]);
                box.upper[axis] = std::max(box.upper[axis], at[axis]);
            }
        }
        const package::SamplerEntry& sampler = known_.samplers[texture.samplerIndex];
        return texels.mean(box, sampler.wrapU, sampler.wrapV);
    }

private:
    const EmissionTexels& texelsOf(std::uint32_t texture) {
        const auto found = texels_.find(texture);
        if (found != texels_.end()) {
            return found->second;
        }
        const package::TextureEntry& entry = known_.textures[texture];
        return texels_.try_emplace(texture, scene_.images[entry.image], entry.srgb != 0).first->second;
    }

    const EmissionEntry& emission_;
    const PackageScene& known_;
    const SceneView& scene_;
    std::set<std::uint32_t> changing_;
    std::map<std::uint32_t, EmissionTexels> texels_;  // by texture
};

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

Emitters::Emitters(const Package& package, const PackageScene& known, const SceneView& scene,
                   const SceneLayout& layout, const DeformedAddresses& deformed,
                   std::span<const std::vector<std::uint32_t>> ordered,
                   std::span<const std::uint8_t> materials) {
    if (package.emission() == nullptr) {
        return;
    }
    emission_ = *package.emission();
    for (std::size_t i = 0; i < known.materials.size(); ++i) {
        luminances_.push_back(emittedLuminance(&materials[i * known.materials.recordBytes], emission_));
    }
    TexelFinder texels(emission_, known, scene);
    firsts.assign(layout.geometries.size(), gpu::kNoEmitter);
    for (const PartInstance& placed : layout.partInstances) {
        std::uint32_t geometry = placed.customIndex;
        for (const TriangleRange& range : layout.parts[placed.part].ranges) {
            const PrimitiveView& view = scene.primitives[range.primitive];
            const package::PrimitiveEntry& entry = *known.findPrimitive(view.mesh, view.primitive);
            const std::uint32_t own = geometry++;
            if ((entry.geometryFlags & gpu::kGeometryEmitter) == 0) {
                continue;
            }
            const MotionBounds* shapes = nullptr;
            if (deformed.contains({placed.instance, range.primitive})) {
                std::unique_ptr<MotionBounds>& bounds = shapes_[view.mesh];
                if (bounds == nullptr) {
                    const PrimitiveRange mesh = primitivesOf(scene.primitives, view.mesh);
                    bounds = std::make_unique<MotionBounds>(
                        scene.primitives.subspan(mesh.first, mesh.end - mesh.first));
                }
                shapes = bounds.get();
            }
            addPart(entry, placed.instance, own, shapes);
            parts_.back().count = range.count;
            const std::span<const std::uint32_t> indices = ordered.empty() || ordered[range.primitive].empty()
                                                               ? view.indices
                                                               : std::span(ordered[range.primitive]);
            for (std::uint32_t i = 0; i < range.count; ++i) {
                Triangle triangle;
                std::array<std::uint32_t, 3> corners{};
                for (std::size_t corner = 0; corner < 3; ++corner) {
                    corners[corner] = indices[std::size_t{3} * (range.first + i) + corner];
                    triangle.corners[corner] = view.positions[corners[corner]];
                }
                triangle.texels = static_cast<float>(texels.mean(entry, view, corners));
                triangles_.push_back(triangle);
                records.push_back({own, i, gpu::kNoEmitter});
            }
        }
    }
}

void Emitters::addPart(const package::PrimitiveEntry& entry, std::uint32_t instance, std::uint32_t geometry,
                       const MotionBounds* shapes) {
    Part part;
    part.instance = instance;
    part.material = entry.materialIndex;
    part.first = static_cast<std::uint32_t>(records.size());
    part.twoSided = (entry.geometryFlags & gpu::kGeometryDoubleSided) != 0;
    part.shapes = shapes;
    firsts[geometry] = part.first;
    parts_.push_back(part);
}

std::vector<EmitterBounds> Emitters::boundsAt(std::span<const InstanceView> instances) const {
    std::vector<EmitterBounds> all;
    all.reserve(records.size());
    for (const Part& part : parts_) {
        const InstanceView& instance = instances[part.instance];
        const std::array<float, 12>& rows = instance.objectToWorld;
        const bool shown = instance.visible && isInvertible(rows);
        const bool mirrored = (makeInstanceRecord(rows).flags & gpu::kInstanceMirrored) != 0;
        const Box box = part.shapes != nullptr ? part.shapes->at(instance) : Box::nothing();
        for (std::uint32_t i = 0; i < part.count; ++i) {
            const Triangle& triangle = triangles_[part.first + i];
            std::array<Double3, 3> corners{};
            for (std::size_t corner = 0; corner < 3; ++corner) {
                corners[corner] = pointAt(rows, triangle.corners[corner]);
            }
            const double luminance = shown ? luminances_[part.material] * triangle.texels : 0.0;
            all.push_back(boundsOf(corners, part.twoSided, mirrored, luminance));
            if (part.shapes != nullptr) {
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
    for (const ChangingMaterial& one : changing) {
        if (one.material < luminances_.size()) {
            luminances_[one.material] = emittedLuminance(one.record.data(), emission_);
        }
    }
}

void Emitters::setLeaves(const LightTree& tree) {
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

}  // namespace glint
