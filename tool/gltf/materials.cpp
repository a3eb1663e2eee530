#include "gltf/materials.h"

#include "gltf/material_extensions.h"
#include "gltf/object_reader.h"
#include "gltf/texture_places.h"
#include "gltf/textures.h"

#include <fmt/format.h>

#include <string>
#include <utility>

namespace glint::gltf {

namespace {

constexpr TexturePlace kTextures[] = {
    {"pbrMetallicRoughness", "baseColorTexture", TextureSlot::BaseColor},
    {"pbrMetallicRoughness", "metallicRoughnessTexture", TextureSlot::MetallicRoughness},
    {"KHR_materials_pbrSpecularGlossiness", "diffuseTexture", TextureSlot::BaseColor},
    {"KHR_materials_pbrSpecularGlossiness", "specularGlossinessTexture", TextureSlot::MetallicRoughness},
    {"", "normalTexture", TextureSlot::Normal},
    {"", "occlusionTexture", TextureSlot::Occlusion},
    {"", "emissiveTexture", TextureSlot::Emissive},
    {"KHR_materials_clearcoat", "clearcoatTexture", TextureSlot::Clearcoat},
    {"KHR_materials_clearcoat", "clearcoatRoughnessTexture", TextureSlot::ClearcoatRoughness},
    {"KHR_materials_clearcoat", "clearcoatNormalTexture", TextureSlot::ClearcoatNormal},
    {"KHR_materials_sheen", "sheenColorTexture", TextureSlot::SheenColor},
    {"KHR_materials_sheen", "sheenRoughnessTexture", TextureSlot::SheenRoughness},
    {"KHR_materials_anisotropy", "anisotropyTexture", TextureSlot::Anisotropy},
    {"KHR_materials_specular", "specularTexture", TextureSlot::Specular},
    {"KHR_materials_specular", "specularColorTexture", TextureSlot::SpecularColor},
    {"KHR_materials_iridescence", "iridescenceTexture", TextureSlot::Iridescence},
    {"KHR_materials_iridescence", "iridescenceThicknessTexture", TextureSlot::IridescenceThickness},
    {"KHR_materials_transmission", "transmissionTexture", TextureSlot::Transmission},
    {"KHR_materials_volume", "thicknessTexture", TextureSlot::Thickness},
    {"KHR_materials_diffuse_transmission", "diffuseTransmissionTexture", TextureSlot::DiffuseTransmission},
    {"KHR_materials_diffuse_transmission", "diffuseTransmissionColorTexture",
     TextureSlot::DiffuseTransmissionColor},
};

// Returns the base model whose textures the material does not read.
const char* ignoredModel(const Material& material) {
    return material.specularGlossiness.given && !material.unlit ? "pbrMetallicRoughness"
                                                                : "KHR_materials_pbrSpecularGlossiness";
}

Status readTextures(Document& document, TextureTable& textures, const Json& json, const std::string& pointer,
                    Material& material) {
    const std::string_view ignored = ignoredModel(material);
    for (const auto& [owner, member, slot] : kTextures) {
        const std::string_view name = owner;
        const bool isExtension = name.starts_with("KHR_");
        const Json* object = name.empty()  ? &json
                             : isExtension ? findExtension(json, name)
                                           : find(json, name);
        if (object == nullptr || name == ignored) {
            continue;
        }
        const std::string place = name.empty()  ? pointer
                                  : isExtension ? fmt::format("{}/extensions/{}", pointer, name)
                                                : fmt::format("{}/{}", pointer, name);
        const ObjectReader reader(document, *object, place);
        if (Status status = reader.texture(member, textures, material.texture(slot)); !status) {
            return status;
        }
    }
    return okStatus();
}

// glTF decides by the slot which textures are colours. A KTX2 file declares this itself, and the two should
// agree.
void checkTransfer(Document& document, const Scene& scene, const Material& material,
                   const std::string& pointer) {
    for (std::size_t slot = 0; slot < kTextureSlots; ++slot) {
        if (material.textures[slot].texture < 0) {
            continue;
        }
        const Texture& texture = scene.textures[static_cast<std::size_t>(material.textures[slot].texture)];
        const Image& image = scene.images[static_cast<std::size_t>(texture.image)];
        const bool color = isColor(material, static_cast<TextureSlot>(slot));
        if (image.transfer == (color ? Transfer::Linear : Transfer::Srgb)) {
            document.warn("ktx2-metadata", pointer,
                          fmt::format("{} says that it is {}, but is used as {}; it is read as the latter",
                                      image.pointer, color ? "linear data" : "colour in sRGB",
                                      color ? "colour in sRGB" : "linear data"),
                          "make the KTX2 file with the transfer function of its use");
        }
    }
}

AlphaMode readAlphaMode(Document& document, const std::string& mode, const std::string& pointer) {
    if (mode == "MASK") {
        return AlphaMode::Mask;
    }
    if (mode == "BLEND") {
        return AlphaMode::Blend;
    }
    if (!mode.empty() && mode != "OPAQUE") {
        document.warn("alpha-mode", pointer + "/alphaMode",
                      fmt::format("\"{}\" is no alpha mode; OPAQUE is used", mode),
                      "use OPAQUE, MASK or BLEND");
    }
    return AlphaMode::Opaque;
}

void readFactors(Document& document, const Json& json, const std::string& pointer, Material& material) {
    const ObjectReader reader(document, json, pointer);
    reader.numbers("emissiveFactor", material.emissiveFactor, kUnit);
    // A value above 1 is legal, and means that nothing is opaque.
    material.alphaCutoff = reader.number("alphaCutoff", 0.5, kNotNegative);
    if (const Json* core = find(json, "pbrMetallicRoughness")) {
        const ObjectReader coreReader(document, *core, reader.pointerTo("pbrMetallicRoughness"));
        coreReader.numbers("baseColorFactor", material.baseColorFactor, kUnit);
        material.metallicFactor = coreReader.number("metallicFactor", 1.0, kUnit);
        material.roughnessFactor = coreReader.number("roughnessFactor", 1.0, kUnit);
    }
    if (const Json* normal = find(json, "normalTexture")) {
        const ObjectReader normalReader(document, *normal, reader.pointerTo("normalTexture"));
        material.normalScale = static_cast<float>(normalReader.number("scale", 1.0));
    }
    if (const Json* occlusion = find(json, "occlusionTexture")) {
        const ObjectReader occlusionReader(document, *occlusion, reader.pointerTo("occlusionTexture"));
        material.occlusionStrength = occlusionReader.number("strength", 1.0, kUnit);
    }
}

}  // namespace

std::span<const TexturePlace> texturePlaces() {
    return kTextures;
}

Status importMaterials(Document& document, Scene& scene) {
    importSamplers(document, scene);
    TextureTable textures(document, scene);
    for (std::size_t i = 0; i < document.model().materials.size(); ++i) {
        const Json& json = document.json()["materials"][i];
        const std::string pointer = fmt::format("/materials/{}", i);
        Material material;
        material.name = document.model().materials[i].name;
        const tinygltf::Material& source = document.model().materials[i];
        material.alphaMode = readAlphaMode(document, source.alphaMode, pointer);
        material.doubleSided = source.doubleSided;
        readFactors(document, json, pointer, material);
        readMaterialExtensions(document, json, pointer, material);
        if (Status status = readTextures(document, textures, json, pointer, material); !status) {
            return status;
        }
        checkTransfer(document, scene, material, pointer);
        scene.materials.push_back(std::move(material));
    }
    return okStatus();
}

}  // namespace glint::gltf
