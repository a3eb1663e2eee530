#include "emit/package/tables.h"
#include "plan/effects.h"
#include "plan/plan.h"

#include <glint/session/material_source.h>

#include <cstddef>
#include <interop/scene.h>

namespace glint::session {

namespace {

materials::PrimitiveInputs inputsOf(const Package& package, const materials::MaterialModel& model,
                                    AttributeMask attributes) {
    materials::PrimitiveInputs inputs;
    inputs.hasNormals = (attributes & kAttributeNormals) != 0;
    inputs.hasTangents = (attributes & kAttributeTangents) != 0;
    inputs.hasTexCoords0 = (attributes & kAttributeTexCoords0) != 0;
    inputs.hasTexCoords1 = (attributes & kAttributeTexCoords1) != 0;
    inputs.colors = (attributes & kAttributeColors) != 0 ? materials::ColorContent::Varying
                                                         : materials::ColorContent::None;
    for (std::size_t row = 0; row < package.attributes().size(); ++row) {
        const bool given = (attributes >> (kDeclaredAttributesShift + row) & 1U) != 0;
        for (std::size_t i = 0; i < model.attributes.size() && given; ++i) {
            if (model.attributes[i].gltf == package.string(package.attributes()[row].name)) {
                inputs.attributes |= std::uint64_t{1} << i;
            }
        }
    }
    return inputs;
}

SceneEditor::MaterialKey keyFor(const Package& package, const materials::Material& material,
                                AttributeMask attributes, const materials::FeatureMask& keptLobes) {
    const materials::PrimitiveInputs inputs = inputsOf(package, material.model(), attributes);
    // The runtime leaves out what the package does not ask for.
    constexpr package::AlphaPolicy kAlpha = package::AlphaPolicy::Stochastic;
    const materials::KeyOptions options{kAlpha, keptLobes};
    SceneEditor::MaterialKey key;
    key.attributes = attributes;
    const materials::FeatureMask hitKey = compiler::makeKey(material, inputs, options);
    key.features =
        material.model().words(compiler::makeKey(material, inputs, compiler::keepAllLobes(options)));
    key.hitFeatures = material.model().words(hitKey);
    key.geometryFlags =
        compiler::geometryFlags(material, inputs, hitKey, kAlpha, package::ShadowThrough::Alpha) |
        (compiler::passesLight(material, inputs) ? gpu::kGeometryPassesLight : 0U) |
        (compiler::isEmitter(material, inputs) ? gpu::kGeometryEmitter : 0U);
    return key;
}

}  // namespace

std::vector<EditedTextures> uploadedTextures(const SceneEditor& editor, const PackageScene& known,
                                             const gltf::Scene& scene) {
    std::vector<EditedTextures> textures(scene.textures.size());
    for (std::size_t i = 0; i < textures.size(); ++i) {
        for (std::uint32_t number = 0; number < known.textures.size(); ++number) {
            const package::TextureEntry& entry = known.textures[number];
            if (entry.image == static_cast<std::uint32_t>(scene.textures[i].image)) {
                (entry.srgb != 0 ? textures[i].color : textures[i].data) = editor.texture(number);
            }
        }
    }
    return textures;
}

MaterialSourceData makeMaterialSource(const Package& package, const compiler::MaterialLayout& layout,
                                      const gltf::Scene& scene, const materials::Material& material,
                                      std::span<const EditedTextures> textures,
                                      std::span<const AttributeMask> attributes,
                                      const materials::FeatureMask& keptLobes) {
    MaterialSourceData data;
    data.record = compiler::makeMaterialRecord(material, layout);
    const int model = modelOf(material);
    for (const auto& [i, info] : material.textures) {
        const int slot = layout.slotOf(static_cast<int>(i), model);
        if (info.texture < 0 || info.texCoord > 1 || slot < 0) {
            continue;
        }
        const EditedTextures& handles = textures[static_cast<std::size_t>(info.texture)];
        const gltf::Texture& texture = scene.textures[static_cast<std::size_t>(info.texture)];
        data.textures.push_back(
            {static_cast<std::uint32_t>(slot),
             material.isColor(static_cast<int>(i)) ? handles.color : handles.data,
             compiler::samplerEntry(scene.samplers[static_cast<std::size_t>(texture.sampler)]),
             static_cast<std::uint32_t>(info.texCoord)});
    }
    constexpr AttributeMask kSets = 2 * kAttributeColors;
    for (AttributeMask set = 0; set < kSets && attributes.empty(); ++set) {
        data.keys.push_back(keyFor(package, material, set, keptLobes));
    }
    for (const AttributeMask set : attributes) {
        data.keys.push_back(keyFor(package, material, set, keptLobes));
    }
    return data;
}

}  // namespace glint::session
