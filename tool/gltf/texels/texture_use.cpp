#include "gltf/texels/texture_use.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace glint::gltf {

LevelFilters levelFiltersOf(const ImageUse& use) {
    LevelFilters filters = filtersOf(use.isNormals ? LevelFilter::Normals
                                     : use.isColor ? LevelFilter::Color
                                                   : LevelFilter::Data);
    for (std::size_t i = 0; i < filters.size(); ++i) {
        const std::uint32_t channel = 1U << i;
        filters[i] = (use.roughness & channel) != 0    ? LevelFilter::Roughness
                     : (use.glossiness & channel) != 0 ? LevelFilter::Glossiness
                                                       : filters[i];
    }
    return filters;
}

bool blitsSuit(const ImageUse& use) {
    return !use.isNormals && (use.roughness | use.glossiness) == 0;
}

std::vector<ImageUse> imageUses(const Scene& scene) {
    std::vector<ImageUse> uses(scene.images.size());
    std::vector<bool> isUsed(scene.images.size(), false);
    // Channels that some texture reads as no roughness, and as no glossiness.
    std::vector<std::array<std::uint32_t, 2>> others(scene.images.size());
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
            use.roughness |= reads.roughness;
            use.glossiness |= reads.glossiness;
            others[image][0] |= reads.channels & ~reads.roughness;
            others[image][1] |= reads.channels & ~reads.glossiness;
        }
    }
    for (std::size_t i = 0; i < uses.size(); ++i) {
        uses[i].roughness &= ~others[i][0];
        uses[i].glossiness &= ~others[i][1];
    }
    return uses;
}

namespace {

using materials::ValueInterval;

ValueInterval widened(ValueInterval value, double share) {
    const bool isWhite = value.low == 1.0;
    const bool isBlack = value.high == 0.0;
    return {isWhite ? 1.0 : value.low * (1.0 - share),
            isBlack ? 0.0 : std::min(value.high * (1.0 + share), 1.0)};
}

}  // namespace

double numberAsRead(double stored, bool isColor) {
    return isColor ? decodeSrgb(stored) : stored;
}

std::array<ValueInterval, 4> contentAsRead(const std::array<ValueInterval, 4>& stored, bool isColor) {
    // Filters in single precision, and llvmpipe's sRGB, which is off by up to 0.7 %.
    constexpr double kFilter = 1e-5;
    constexpr double kSrgb = 0.01;
    std::array<ValueInterval, 4> read{};
    for (std::size_t channel = 0; channel < 4; ++channel) {
        const ValueInterval& value = stored[channel];
        read[channel] = isColor && channel < 3
                            ? widened({decodeSrgb(value.low), decodeSrgb(value.high)}, kSrgb)
                            : widened(value, kFilter);
    }
    return read;
}

}  // namespace glint::gltf
