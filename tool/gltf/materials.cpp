#include "gltf/materials.h"

#include "gltf/extensions.h"
#include "gltf/textures.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

namespace glint::gltf {

namespace {

constexpr double kNoLimit = std::numeric_limits<float>::max();

float clampFactor(Document& document, const std::string& pointer, double value, double low, double high) {
    const double clamped = std::clamp(value, low, high);
    if (clamped != value) {
        document.warn(
            "material-range", pointer, fmt::format("is {}; {} is used", value, clamped),
            high == kNoLimit ? fmt::format("use {} or more", low) : fmt::format("use {} to {}", low, high));
    }
    return static_cast<float>(clamped);
}

template <std::size_t N>
void clampFactors(Document& document, const std::string& pointer, const std::vector<double>& values,
                  std::array<float, N>& factors) {
    for (std::size_t i = 0; i < N && i < values.size(); ++i) {
        factors[i] = clampFactor(document, fmt::format("{}/{}", pointer, i), values[i], 0.0, 1.0);
    }
}

float numberAt(const Json& object, std::string_view name, float fallback) {
    const Json* member = find(object, name);
    return member == nullptr ? fallback : static_cast<float>(member->get<double>());
}

std::array<float, 2> pairAt(const Json& object, std::string_view name, std::array<float, 2> fallback) {
    const Json* member = find(object, name);
    return member == nullptr ? fallback
                             : std::array{static_cast<float>((*member)[0].get<double>()),
                                          static_cast<float>((*member)[1].get<double>())};
}

// Reads the texture info at `owner[member]` into a slot.
Status readTextureInfo(Document& document, TextureTable& textures, const Json& owner, std::string_view member,
                       const std::string& ownerPointer, TextureInfo& info) {
    const Json* json = find(owner, member);
    if (json == nullptr) {
        return okStatus();
    }
    const std::string pointer = fmt::format("{}/{}", ownerPointer, member);
    const Json* texCoord = find(*json, "texCoord");
    TextureInfo read;
    if (const Json* transform = findExtension(*json, "KHR_texture_transform")) {
        read.hasTransform = true;
        read.transform.offset = pairAt(*transform, "offset", read.transform.offset);
        read.transform.scale = pairAt(*transform, "scale", read.transform.scale);
        read.transform.rotation = numberAt(*transform, "rotation", 0.0F);
        if (const Json* override = find(*transform, "texCoord")) {
            texCoord = override;
        }
    }
    read.texCoord = texCoord == nullptr ? 0 : texCoord->get<int>();
    if (read.texCoord > 1) {
        document.warn("texture-uv-set", pointer,
                      fmt::format("uses UV set {}; Glint reads sets 0 and 1, and leaves the texture out",
                                  read.texCoord),
                      "move the coordinates to TEXCOORD_0 or TEXCOORD_1");
        return okStatus();
    }
    const Result<int> texture = textures.use((*json)["index"].get<int>());
    if (!texture) {
        return texture.error();
    }
    if (*texture >= 0) {
        read.texture = *texture;
        info = read;
    }
    return okStatus();
}

Status readTextures(Document& document, TextureTable& textures, const Json& json, const std::string& pointer,
                    Material& material) {
    const Json empty = Json::object();
    const Json* found = find(json, "pbrMetallicRoughness");
    const Json& core = found == nullptr ? empty : *found;
    const std::string corePointer = pointer + "/pbrMetallicRoughness";
    const auto read = [&](const Json& owner, const char* member, const std::string& ownerPointer,
                          TextureSlot slot) {
        return readTextureInfo(document, textures, owner, member, ownerPointer, material.texture(slot));
    };
    if (Status s = read(core, "baseColorTexture", corePointer, TextureSlot::BaseColor); !s) {
        return s;
    }
    if (Status s = read(core, "metallicRoughnessTexture", corePointer, TextureSlot::MetallicRoughness); !s) {
        return s;
    }
    if (Status s = read(json, "normalTexture", pointer, TextureSlot::Normal); !s) {
        return s;
    }
    if (Status s = read(json, "occlusionTexture", pointer, TextureSlot::Occlusion); !s) {
        return s;
    }
    return read(json, "emissiveTexture", pointer, TextureSlot::Emissive);
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

void readFactors(Document& document, const tinygltf::Material& source, const std::string& pointer,
                 Material& material) {
    const tinygltf::PbrMetallicRoughness& core = source.pbrMetallicRoughness;
    const std::string corePointer = pointer + "/pbrMetallicRoughness";
    const auto clampUnit = [&](const std::string& where, double value) {
        return clampFactor(document, where, value, 0.0, 1.0);
    };
    clampFactors(document, corePointer + "/baseColorFactor", core.baseColorFactor, material.baseColorFactor);
    clampFactors(document, pointer + "/emissiveFactor", source.emissiveFactor, material.emissiveFactor);
    material.metallicFactor = clampUnit(corePointer + "/metallicFactor", core.metallicFactor);
    material.roughnessFactor = clampUnit(corePointer + "/roughnessFactor", core.roughnessFactor);
    material.normalScale = static_cast<float>(source.normalTexture.scale);
    material.occlusionStrength =
        clampUnit(pointer + "/occlusionTexture/strength", source.occlusionTexture.strength);
    // Above 1 is legal, and means that nothing is opaque.
    material.alphaCutoff = clampFactor(document, pointer + "/alphaCutoff", source.alphaCutoff, 0.0, kNoLimit);
    material.alphaMode = readAlphaMode(document, source.alphaMode, pointer);
    material.doubleSided = source.doubleSided;
}

void readExtensions(Document& document, const Json& json, const std::string& pointer, Material& material) {
    material.unlit = findExtension(json, "KHR_materials_unlit") != nullptr;
    if (const Json* emission = findExtension(json, "KHR_materials_emissive_strength")) {
        material.hasEmissiveStrength = true;
        material.emissiveStrength =
            clampFactor(document, pointer + "/extensions/KHR_materials_emissive_strength/emissiveStrength",
                        static_cast<double>(numberAt(*emission, "emissiveStrength", 1.0F)), 0.0, kNoLimit);
    }
    const Json* extensions = find(json, "extensions");
    if (extensions != nullptr) {
        for (const auto& [name, ignored] : extensions->items()) {
            if (!isSupportedExtension(name)) {
                material.unsupportedExtensions.push_back(name);
            }
        }
    }
}

}  // namespace

Status importMaterials(Document& document, Scene& scene) {
    importSamplers(document, scene);
    TextureTable textures(document, scene);
    for (std::size_t i = 0; i < document.model().materials.size(); ++i) {
        const Json& json = document.json()["materials"][i];
        const std::string pointer = fmt::format("/materials/{}", i);
        Material material;
        material.name = document.model().materials[i].name;
        readFactors(document, document.model().materials[i], pointer, material);
        readExtensions(document, json, pointer, material);
        if (Status status = readTextures(document, textures, json, pointer, material); !status) {
            return status;
        }
        scene.materials.push_back(std::move(material));
    }
    return okStatus();
}

}  // namespace glint::gltf
