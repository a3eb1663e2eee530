#include "gltf/texels/texture_use.h"

namespace glint::gltf {

std::vector<ImageUse> imageUses(const Scene& scene) {
    std::vector<ImageUse> uses(scene.images.size());
    std::vector<bool> isUsed(scene.images.size(), false);
    for (const materials::Material& material : scene.materials) {
        const int emission = material.model().findTexture("emissiveTexture");
        for (std::size_t slot = 0; slot < material.textures.size(); ++slot) {
            if (material.textures[slot].texture < 0) {
                continue;
            }
            const int texture = static_cast<int>(slot);
            const auto image = static_cast<std::size_t>(
                scene.textures[static_cast<std::size_t>(material.textures[slot].texture)].image);
            const materials::TextureReads reads = material.readsOf(texture);
            ImageUse& use = uses[image];
            use.isNormals = reads.isNormals && (!isUsed[image] || use.isNormals);
            isUsed[image] = true;
            (material.isColor(texture) ? use.isColor : use.isData) = true;
            use.isEmission = use.isEmission || texture == emission;
            use.channels |= reads.channels;
        }
    }
    return uses;
}

}  // namespace glint::gltf
