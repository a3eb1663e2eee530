#include "plan/plan.h"
#include "plan/rules.h"

#include <algorithm>

namespace glint {

bool hasAlphaMasks(std::span<const Material> materials, std::span<const PrimitiveInputs> primitives) {
    return std::ranges::any_of(primitives, [&](const PrimitiveInputs& primitive) {
        return rules::isAlphaTested(materials[static_cast<std::size_t>(primitive.material)], primitive,
                                    {.alpha = AlphaPolicy::Tested});
    });
}

}  // namespace glint

namespace glint::rules {

namespace {

// Returns whether alpha can fall below the cut-off, that is, whether testing it can change anything.
bool canFailAlphaTest(const Material& material, const PrimitiveInputs& primitive) {
    if (material.alphaCutoff <= 0.0F) {
        return false;
    }
    return isReadable(material, primitive, TextureSlot::BaseColor) ||
           primitive.colors == ColorContent::Varying || material.baseColorFactor[3] < material.alphaCutoff;
}

}  // namespace

bool isAlphaTested(const Material& material, const PrimitiveInputs& primitive, const KeyOptions& options) {
    return options.alpha == AlphaPolicy::Tested && material.alphaMode == AlphaMode::Mask &&
           canFailAlphaTest(material, primitive);
}

// Every material has a metallicFactor, so a base that is all metal or all dielectric is not reported.
Presence partialMetal(const Material& material, const PrimitiveInputs& primitive, const KeyOptions&,
                      FeatureMask soFar) {
    if (has(soFar, Feature::SpecularGlossiness) || material.metallicFactor == 0.0F ||
        isMetal(material, primitive)) {
        return absent();
    }
    return has(soFar, Feature::Unlit) ? dropped(kUnlitReadsBaseColor) : present();
}

Presence emissiveStrength(const Material& material, const PrimitiveInputs&, const KeyOptions&,
                          FeatureMask soFar) {
    if (!material.hasEmissiveStrength && material.emissiveStrength == 1.0F) {
        return absent();
    }
    if (has(soFar, Feature::Unlit)) {
        return dropped(kUnlitReadsBaseColor);
    }
    if (material.emissiveStrength == 1.0F) {
        return dropped("emissiveStrength is 1");
    }
    // A strength of 0 is neutral only if the emissive factor is black already.
    const auto& factor = material.emissiveFactor;
    return factor[0] == 0.0F && factor[1] == 0.0F && factor[2] == 0.0F ? dropped("emissiveFactor is black")
                                                                       : present();
}

Presence vertexColor(const Material& material, const PrimitiveInputs& primitive, const KeyOptions& options,
                     FeatureMask) {
    if (primitive.colors == ColorContent::None) {
        return absent();
    }
    if (primitive.colors == ColorContent::White) {
        return dropped("COLOR_0 is white everywhere");
    }
    if (isBlack(material) && !isAlphaTested(material, primitive, options)) {
        return dropped("baseColorFactor is black");
    }
    return present();
}

Presence normals(const Material&, const PrimitiveInputs& primitive, const KeyOptions&, FeatureMask soFar) {
    if (!primitive.hasNormals) {
        return absent();
    }
    return has(soFar, Feature::Unlit) ? dropped(kUnlitReadsBaseColor) : present();
}

Presence tangents(const Material&, const PrimitiveInputs& primitive, const KeyOptions&, FeatureMask soFar) {
    if (!primitive.hasTangents) {
        return absent();
    }
    const bool read = has(soFar, Feature::NormalTexture) || has(soFar, Feature::ClearcoatNormalTexture) ||
                      has(soFar, Feature::Anisotropy);
    if (!read) {
        return dropped("neither a normal texture nor anisotropy reads them");
    }
    return has(soFar, Feature::Normals) ? present() : dropped("the primitive has no NORMAL");
}

Presence doubleSided(const Material& material, const PrimitiveInputs&, const KeyOptions&, FeatureMask soFar) {
    if (!material.doubleSided) {
        return absent();
    }
    return has(soFar, Feature::Unlit) ? dropped(kUnlitReadsBaseColor) : present();
}

Presence alphaMask(const Material& material, const PrimitiveInputs& primitive, const KeyOptions& options,
                   FeatureMask) {
    switch (material.alphaMode) {
        case AlphaMode::Opaque:
            return absent();
        case AlphaMode::Blend:
            return dropped("alphaMode BLEND is drawn opaque: rays see no blending order");
        case AlphaMode::Mask:
            break;
    }
    if (options.alpha == AlphaPolicy::Opaque) {
        return dropped("hits are forced opaque (--alpha opaque)");
    }
    return canFailAlphaTest(material, primitive) ? present() : dropped("alpha is never below alphaCutoff");
}

}  // namespace glint::rules
