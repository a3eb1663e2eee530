#include "gltf_writer.h"

namespace gallery {

namespace {

Json textureJson(const TextureUse& use) {
    Json json = {{"index", use.texture}};
    if (use.texCoord != 0) {
        json["texCoord"] = use.texCoord;
    }
    if (use.transform) {
        Json transform = Json::object();
        const TextureTransform identity;
        if (use.transform->offset != identity.offset) {
            transform["offset"] = use.transform->offset;
        }
        if (use.transform->rotation != identity.rotation) {
            transform["rotation"] = use.transform->rotation;
        }
        if (use.transform->scale != identity.scale) {
            transform["scale"] = use.transform->scale;
        }
        json["extensions"]["KHR_texture_transform"] = std::move(transform);
    }
    return json;
}

Json pbrJson(const MaterialSpec& material) {
    Json pbr = Json::object();
    const MaterialSpec defaults;
    if (material.baseColor != defaults.baseColor) {
        pbr["baseColorFactor"] = material.baseColor;
    }
    if (material.baseColorTexture.texture >= 0) {
        pbr["baseColorTexture"] = textureJson(material.baseColorTexture);
    }
    if (material.metallic != defaults.metallic) {
        pbr["metallicFactor"] = material.metallic;
    }
    if (material.roughness != defaults.roughness) {
        pbr["roughnessFactor"] = material.roughness;
    }
    if (material.metallicRoughnessTexture.texture >= 0) {
        pbr["metallicRoughnessTexture"] = textureJson(material.metallicRoughnessTexture);
    }
    return pbr;
}

Json extensionJson(const ExtensionSpec& extension) {
    Json json = Json::object();
    for (const auto& [name, value] : extension.values) {
        json[name] = value;
    }
    for (const auto& [name, use] : extension.textures) {
        json[name] = textureJson(use);
        // Among the extensions' textures, only clearcoat's normals have an amount.
        if (use.amount != 1.0) {
            json[name]["scale"] = use.amount;
        }
    }
    return json;
}

}  // namespace

Json toJson(const MaterialSpec& material) {
    Json json = {{"name", material.name}, {"pbrMetallicRoughness", pbrJson(material)}};
    if (material.normalTexture.texture >= 0) {
        json["normalTexture"] = textureJson(material.normalTexture);
        if (material.normalTexture.amount != 1.0) {
            json["normalTexture"]["scale"] = material.normalTexture.amount;
        }
    }
    if (material.occlusionTexture.texture >= 0) {
        json["occlusionTexture"] = textureJson(material.occlusionTexture);
        if (material.occlusionTexture.amount != 1.0) {
            json["occlusionTexture"]["strength"] = material.occlusionTexture.amount;
        }
    }
    if (material.emissiveTexture.texture >= 0) {
        json["emissiveTexture"] = textureJson(material.emissiveTexture);
    }
    if (material.emissive != std::array<double, 3>{0.0, 0.0, 0.0}) {
        json["emissiveFactor"] = material.emissive;
    }
    if (material.alphaMode != "OPAQUE") {
        json["alphaMode"] = material.alphaMode;
    }
    if (material.doubleSided) {
        json["doubleSided"] = true;
    }
    if (material.unlit) {
        json["extensions"]["KHR_materials_unlit"] = Json::object();
    }
    if (material.emissiveStrength) {
        json["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] =
            *material.emissiveStrength;
    }
    for (const ExtensionSpec& extension : material.extensions) {
        json["extensions"][extension.name] = extensionJson(extension);
    }
    return json;
}

}  // namespace gallery
