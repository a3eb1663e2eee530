#include "gltf/trusted_textures.h"

#include "base/vectors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <vector>

namespace glint::gltf {

// ---- Tangents that say no more than the coordinates of textures ----

namespace {

// The error of rounding a unit vector to single precision.
constexpr double kDerivedError = 2.5e-7;

bool derivesOn(const Primitive& primitive, const std::vector<Float2>& texCoords,
               const std::uint32_t* corners) {
    const Float3& origin = primitive.positions[corners[0]];
    const glm::dvec3 edge1 = base::toVector(primitive.positions[corners[1]]) - base::toVector(origin);
    const glm::dvec3 edge2 = base::toVector(primitive.positions[corners[2]]) - base::toVector(origin);
    const glm::dvec3 plane = glm::cross(edge1, edge2);
    if (glm::dot(plane, plane) == 0.0) {
        return true;
    }
    const auto uvEdge = [&](int corner, std::size_t axis) {
        return double{texCoords[corners[corner]][axis]} - texCoords[corners[0]][axis];
    };
    const double determinant = uvEdge(1, 0) * uvEdge(2, 1) - uvEdge(1, 1) * uvEdge(2, 0);
    if (determinant == 0.0 || !std::isfinite(determinant)) {
        return false;
    }
    const double sign = determinant > 0.0 ? 1.0 : -1.0;
    const glm::dvec3 along = uvEdge(2, 1) * sign * edge1 - uvEdge(1, 1) * sign * edge2;
    const glm::dvec3 alongV = uvEdge(1, 0) * sign * edge2 - uvEdge(2, 0) * sign * edge1;
    const glm::dvec3 direction = along / std::sqrt(glm::dot(along, along));
    for (int i = 0; i < 3; ++i) {
        const Float4& tangent = primitive.tangents[corners[i]];
        const glm::dvec3 normal = base::toVector(primitive.normals[corners[i]]);
        for (glm::length_t axis = 0; axis < 3; ++axis) {
            // Not a number is no tangent that is derived.
            if (!(std::abs(tangent[static_cast<std::size_t>(axis)] - direction[axis]) <= kDerivedError)) {
                return false;
            }
        }
        const double turn = glm::dot(glm::cross(normal, along), alongV);
        if (turn == 0.0 || (turn > 0.0 ? -1.0F : 1.0F) != tangent[3]) {
            return false;
        }
    }
    return true;
}

bool derivesFrom(const Primitive& primitive, const std::vector<Float2>& texCoords) {
    for (std::size_t i = 0; i + 2 < primitive.indices.size(); i += 3) {
        if (!derivesOn(primitive, texCoords, &primitive.indices[i])) {
            return false;
        }
    }
    return true;
}

}  // namespace

bool derivesTangents(const Primitive& primitive) {
    const bool isDeformed = !primitive.targets.empty() || primitive.influences.count > 0;
    if (primitive.tangents.empty() || primitive.normals.empty() || isDeformed ||
        (primitive.texCoords0.empty() && primitive.texCoords1.empty())) {
        return false;
    }
    return (primitive.texCoords0.empty() || derivesFrom(primitive, primitive.texCoords0)) &&
           (primitive.texCoords1.empty() || derivesFrom(primitive, primitive.texCoords1));
}

// ---- Textures ----

namespace {

using Constant = std::array<double, 4>;

void renumber(materials::Material& material, const std::vector<int>& numbers) {
    for (auto& [slot, info] : material.textures) {
        info.texture = info.texture < 0 ? -1 : numbers[static_cast<std::size_t>(info.texture)];
    }
}

const materials::TextureContent& contentSeen(const materials::Material& material, const Primitive& primitive,
                                             int slot) {
    const auto seen = std::ranges::find(primitive.seen, slot, &materials::SeenTexture::slot);
    return seen != primitive.seen.end() ? seen->content
                                        : material.textures[static_cast<std::size_t>(slot)].content;
}

// Returns the channels that the texture's product with parameters takes in, or nothing if the texture does
// anything else.
std::optional<std::uint32_t> scaledChannels(const materials::Material& material, int slot) {
    std::uint32_t scaled = 0;
    for (const materials::Parameter& parameter : material.model().parameters) {
        if (parameter.scaledBy != slot || !material.reads(parameter.object)) {
            continue;
        }
        for (int i = 0; i < parameter.numbers; ++i) {
            const int channel = parameter.scaledByChannels[static_cast<std::size_t>(i)];
            if (channel < 0) {
                return std::nullopt;
            }
            scaled |= 1U << static_cast<unsigned>(channel);
        }
    }
    const std::uint32_t read = material.readsOf(slot).channels;
    return scaled != 0 && (read & ~scaled) == 0 ? std::optional(scaled) : std::nullopt;
}

// Returns the constant that all primitives see, with NaN in channels that nothing reads.
std::optional<Constant> constantOf(const materials::Material& material,
                                   const std::vector<const Primitive*>& primitives, int slot,
                                   std::uint32_t channels) {
    const materials::TextureInfo& info = material.textures[static_cast<std::size_t>(slot)];
    std::optional<Constant> constant;
    for (const Primitive* primitive : primitives) {
        const bool isReadable = info.texCoord < 2 &&
                                !(info.texCoord == 0 ? primitive->texCoords0 : primitive->texCoords1).empty();
        const materials::TextureContent& content = contentSeen(material, *primitive, slot);
        constant = constant ? constant : content.constant;
        for (std::size_t i = 0; i < 4; ++i) {
            const bool isRead = (channels >> i & 1U) != 0;
            // NaN equals nothing.
            if (isRead && (!isReadable || content.constant[i] != (*constant)[i])) {
                return std::nullopt;
            }
        }
    }
    return constant;
}

void fold(materials::Material& material, int slot, const Constant& constant) {
    std::vector<bool> isScaled(material.model().defaults.size());
    for (const materials::Parameter& parameter : material.model().parameters) {
        if (parameter.scaledBy != slot || !material.reads(parameter.object)) {
            continue;
        }
        for (int i = 0; i < parameter.numbers; ++i) {
            const auto place = static_cast<std::size_t>(parameter.first) + static_cast<std::size_t>(i);
            const int channel = parameter.scaledByChannels[static_cast<std::size_t>(i)];
            if (channel >= 0 && !isScaled[place]) {
                // As a device multiplies them.
                double& number = material.values.of(parameter)[static_cast<std::size_t>(i)];
                number = static_cast<float>(number) *
                         static_cast<float>(constant[static_cast<std::size_t>(channel)]);
                isScaled[place] = true;
            }
        }
    }
    materials::TextureInfo& info = material.textures[static_cast<std::size_t>(slot)];
    info.texture = -1;
    info.isFolded = true;
}

bool isOne(const Constant& constant, std::uint32_t channels) {
    for (std::size_t i = 0; i < 4; ++i) {
        if ((channels >> i & 1U) != 0 && constant[i] != 1.0) {
            return false;
        }
    }
    return true;
}

}  // namespace

void mergeSameTextures(Scene& scene) {
    std::vector<int> numbers(scene.textures.size());
    std::map<int, std::vector<std::size_t>> ofImage;  // different textures by what they show
    for (std::size_t i = 0; i < scene.textures.size(); ++i) {
        Texture& texture = scene.textures[i];
        const int same = scene.images[static_cast<std::size_t>(texture.image)].sameAs;
        texture.image = same >= 0 ? same : texture.image;
        std::vector<std::size_t>& known = ofImage[texture.image];
        const auto found = std::ranges::find_if(known, [&](std::size_t other) {
            return scene.samplers[static_cast<std::size_t>(scene.textures[other].sampler)] ==
                   scene.samplers[static_cast<std::size_t>(texture.sampler)];
        });
        numbers[i] = static_cast<int>(found == known.end() ? i : *found);
        if (found == known.end()) {
            known.push_back(i);
        }
    }
    std::ranges::for_each(scene.materials,
                          [&](materials::Material& material) { renumber(material, numbers); });
    for (AnimatedMaterial& animated : scene.animatedMaterials) {
        renumber(animated.rest, numbers);
        renumber(animated.planned, numbers);
    }
}

void foldConstantTextures(Scene& scene) {
    std::vector<std::vector<const Primitive*>> primitives(scene.materials.size());
    for (const Mesh& mesh : scene.meshes) {
        for (const Primitive& primitive : mesh.primitives) {
            primitives[static_cast<std::size_t>(primitive.material)].push_back(&primitive);
        }
    }
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        materials::Material& material = scene.materials[i];
        const bool isAnimated =
            std::ranges::find(scene.animatedMaterials, static_cast<int>(i), &AnimatedMaterial::material) !=
            scene.animatedMaterials.end();
        if (isAnimated || primitives[i].empty()) {
            continue;
        }
        for (const auto& [slot, info] : material.textures) {
            const auto texture = static_cast<int>(slot);
            const materials::MaterialModel& model = material.model();
            const auto feature = static_cast<std::size_t>(model.textures[slot].feature);
            if (info.texture < 0 || model.features[feature].hasOwnCoordinates) {
                continue;
            }
            const std::optional<std::uint32_t> channels = scaledChannels(material, texture);
            const std::optional<Constant> constant =
                channels ? constantOf(material, primitives[i], texture, *channels) : std::nullopt;
            if (constant && !isOne(*constant, *channels)) {
                fold(material, texture, *constant);
            }
        }
    }
}

}  // namespace glint::gltf
