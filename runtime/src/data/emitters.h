// Triangles that emit light, as lights: their records, their bounds and their intensity.
#pragma once

#include "data/light_tree.h"
#include "data/materials.h"
#include "data/motion_bounds.h"
#include "interop/scene.h"

#include <glint/internal/package_format.h>
#include <glint/package.h>
#include <glint/scene_view.h>

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace glint {

// A box of texture coordinates.
struct TexelBox {
    std::array<double, 2> lower{};
    std::array<double, 2> upper{};
};

// Luminances of an image and of its halves, from 256 texels along the longer axis on. Takes at most 0.35 MB,
// and time in proportion to the image's texels.
class EmissionTexels {
public:
    // `isColor`: the values are in sRGB.
    EmissionTexels(const ImageView& image, bool isColor);

    // Returns an estimate of the mean luminance within the box, for a sampler with these wrap modes
    // (SamplerEntry). It is 0 only if every texel that the box and its filter reach is black.
    double mean(const TexelBox& box, std::uint32_t wrapU, std::uint32_t wrapV) const;
    // Returns an estimate of the mean luminance of the whole image.
    double mean() const {
        return levels_.back().values.front();
    }

private:
    struct Level {
        std::uint32_t width = 0;
        std::uint32_t height = 0;
        std::vector<float> values;
    };
    static Level halfOf(const Level& level);

    std::uint32_t width_ = 0;  // of the image
    std::uint32_t height_ = 0;
    std::uint32_t skipped_ = 0;  // levels of the image before the first of `levels_`
    std::vector<Level> levels_;
};

// The triangles of a primitive in its mesh's space. Takes 12 bytes for each triangle and each vertex, and 8
// for each UV set of a vertex.
struct EmitterShape {
    // `indices` are the view's, in the order of the triangles on the device. Texture coordinates are left out
    // unless an emission may have a texture.
    EmitterShape(const PrimitiveView& view, std::span<const std::uint32_t> indices, bool hasTexCoords);

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

// Triangles of one geometry record.
struct EmitterPart {
    std::uint32_t geometry = 0;   // GeometryRecord index
    std::uint32_t instance = 0;   // its number, by which InstancePoses knows it
    std::uint32_t primitive = 0;  // of the mesh
    std::uint32_t material = 0;
    std::uint32_t first = 0;  // triangle of the shape
    std::uint32_t count = 0;
    std::uint32_t record = 0;  // the first one in Emitters::records, which sets it
    bool twoSided = false;
    double luminance = 0.0;  // of the material, without its texture; cd/m²
    std::shared_ptr<const EmitterShape> shape;
    TexelMeans texels;                           // of the shape's triangles
    std::shared_ptr<const MotionBounds> motion;  // null unless the instance's mesh changes its shape
};

// Returns the luminance of the emission in a material's record, in linear Rec. 709, as in
// bsdf/constants.glsl.
double emittedLuminance(std::span<const std::uint8_t> record, const package::EmissionEntry& emission);

// Returns the pose of an instance by its number.
using InstancePoses = std::function<InstanceView(std::uint32_t)>;

class Emitters {
public:
    Emitters() = default;
    // The triangles come in the order of instances, of the primitives of a mesh, and of their triangles,
    // whatever the order of the parts. So the same content makes the same hierarchy of lights, wherever its
    // geometry records are.
    Emitters(const package::EmissionEntry& emission, std::vector<EmitterPart> parts);

    // The triangles of a geometry follow each other.
    std::vector<gpu::EmitterRecord> records;

    // Returns the first record of each geometry, or gpu::kNoEmitter.
    std::vector<std::uint32_t> firstsOf(std::size_t geometries) const;
    // Returns the bounds of each at a pose. Triangles of instances that change their shape have the
    // instance's box. Hidden ones are dark.
    std::vector<EmitterBounds> boundsAt(const InstancePoses& poses) const;
    // The same for the triangles of some instances, with the numbers of their records.
    std::vector<std::pair<std::uint32_t, EmitterBounds>> boundsOf(std::span<const std::uint32_t> instances,
                                                                  const InstancePoses& poses) const;
    // Takes the values of a material that has changed. Returns the instances with triangles that got darker
    // or brighter.
    std::vector<std::uint32_t> takeMaterial(const ChangingMaterial& material);
    // Stores where the tree has each triangle that shines.
    void setLeaves(const LightTree& tree, std::span<const EmitterBounds> bounds);

private:
    package::EmissionEntry emission_{};
    std::vector<EmitterPart> parts_;  // in the order of `records`
};

}  // namespace glint
