// The host's data about a primitive whose triangles may be lights.
#pragma once

#include "interop/scene.h"
#include "lights/emission_texels.h"

#include <glint/package.h>
#include <glint/scene_view.h>

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace glint {

// The triangles of a primitive in its mesh's space. Takes 12 bytes for each triangle and each vertex, and 8
// for each UV set of a vertex.
struct EmitterShape {
    // `indices` are the view's, in the order of the triangles on the device. Texture coordinates are left out
    // if no emission has a texture.
    EmitterShape(const package::EmissionEntry& emission, const PrimitiveView& view,
                 std::span<const std::uint32_t> indices);

    std::vector<std::array<float, 3>> positions;
    std::array<std::vector<std::array<float, 2>>, 2> texCoords;  // by UV set; may be empty
    std::vector<std::uint32_t> indices;
};

// The texture of an emissive material, with the way in which the material reads it.
struct EmitterTexture {
    std::shared_ptr<const EmissionTexels> texels;
    gpu::TextureRecord record{};
    package::SamplerEntry sampler{};
    bool second = false;    // reads the second UV set
    bool animated = false;  // the texture moves on the triangles, which so show all of it
};

// Returns nothing if the key has no emissive texture, or nothing is known of its texels. `featureInputs` is
// that of the key. `record` is the material's texture in the emission's slot.
std::optional<EmitterTexture> emitterTexture(const package::EmissionEntry& emission,
                                             std::uint32_t featureInputs, const gpu::TextureRecord& record,
                                             std::span<const package::SamplerEntry> samplers,
                                             std::shared_ptr<const EmissionTexels> texels);

// The mean luminance of the texels that each triangle of a shape shows. Null stands for 1.
using TexelMeans = std::shared_ptr<const std::vector<float>>;

// Computes the means for shapes with materials, and keeps them.
class EmitterMeans {
public:
    TexelMeans find(const std::shared_ptr<const EmitterShape>& shape, std::uint32_t material,
                    const std::optional<EmitterTexture>& texture);
    // Forgets the means that find() was not asked for since the last call.
    void forgetUnused();

private:
    struct Known {
        std::shared_ptr<const EmitterShape> shape;
        EmitterTexture texture;
        TexelMeans means;
        bool used = true;
    };
    std::map<std::pair<const EmitterShape*, std::uint32_t>, Known> known_;  // by shape and material
};

}  // namespace glint
