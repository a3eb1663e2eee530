#include "gltf/extensions.h"

#include "gltf/document.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

namespace glint::gltf {

namespace {

constexpr std::array<std::string_view, 5> kSupported{"KHR_lights_punctual", "KHR_materials_emissive_strength",
                                                     "KHR_materials_unlit", "KHR_mesh_quantization",
                                                     "KHR_texture_transform"};

constexpr std::array kCompressions{"KHR_draco_mesh_compression", "EXT_meshopt_compression",
                                   "KHR_meshopt_compression"};

std::string hintFor(std::string_view name) {
    if (std::find(kCompressions.begin(), kCompressions.end(), name) != kCompressions.end()) {
        return "store the geometry uncompressed: export the scene without mesh compression";
    }
    if (name == "KHR_texture_basisu" || name == "EXT_texture_webp" || name == "MSFT_texture_dds" ||
        name == "EXT_texture_avif") {
        return "store the textures as PNG or JPEG";
    }
    if (name.starts_with("KHR_materials_")) {
        return fmt::format("move {} from extensionsRequired to extensionsUsed to render without it", name);
    }
    return "export the scene without this extension";
}

}  // namespace

bool isSupportedExtension(std::string_view name) {
    return std::find(kSupported.begin(), kSupported.end(), name) != kSupported.end();
}

Diagnostic unsupportedExtension(const Document& document, std::string_view name, std::string_view pointer) {
    return document.error("extension-unsupported", pointer,
                          fmt::format("needs the extension {}, which Glint does not support", name),
                          hintFor(name));
}

Status checkExtensions(Document& document) {
    for (const char* list : {"extensionsRequired", "extensionsUsed"}) {
        const Json* names = find(document.json(), list);
        if (names != nullptr &&
            (!names->is_array() ||
             !std::all_of(names->begin(), names->end(), [](auto& name) { return name.is_string(); }))) {
            return document.error("json-type", fmt::format("/{}", list), "must be an array of strings",
                                  "export the scene again");
        }
    }
    const Json& required = arrayMember(document.json(), "extensionsRequired");
    for (std::size_t i = 0; i < required.size(); ++i) {
        const std::string& name = required[i].get_ref<const std::string&>();
        if (!isSupportedExtension(name)) {
            return unsupportedExtension(document, name, fmt::format("/extensionsRequired/{}", i));
        }
    }
    std::set<std::string> warned;
    const Json& used = arrayMember(document.json(), "extensionsUsed");
    for (std::size_t i = 0; i < used.size(); ++i) {
        const std::string& name = used[i].get_ref<const std::string&>();
        if (!isSupportedExtension(name) && warned.insert(name).second) {
            document.warn("extension-ignored", fmt::format("/extensionsUsed/{}", i),
                          fmt::format("the extension {} is not supported; what it adds is left out", name));
        }
    }
    return okStatus();
}

const char* compressionOf(const Json& object) {
    for (const char* name : kCompressions) {
        if (findExtension(object, name) != nullptr) {
            return name;
        }
    }
    return nullptr;
}

}  // namespace glint::gltf
