#include "gltf/document/extensions.h"

#include "gltf/document/document.h"
#include "gltf/document/schema.h"
#include "materials/material_model.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <set>

namespace glint::gltf {

namespace {

// Extensions of materials are declared (shaders/materials). KHR_texture_basisu is listed even if this build
// does not decode it. textures.cpp decides about each texture.
constexpr auto kSupported = std::to_array<std::string_view>(
    {"EXT_mesh_gpu_instancing", "EXT_meshopt_compression", "EXT_texture_webp", "KHR_animation_pointer",
     "KHR_draco_mesh_compression", "KHR_lights_punctual", "KHR_materials_variants", "KHR_mesh_quantization",
     "KHR_meshopt_compression", "KHR_node_visibility", "KHR_texture_basisu", "KHR_texture_transform",
     "MSFT_texture_dds"});

// Ratified or registered extensions whose data a renderer may ignore even if a file requires them.
constexpr auto kNoPicture = std::to_array<std::string_view>(
    {"AGI_stk_metadata", "EXT_instance_features", "EXT_mesh_features", "EXT_mesh_manifold",
     "EXT_mesh_opacity_micromap", "EXT_structural_metadata", "FB_geometry_metadata", "GODOT_single_root",
     "KHR_node_hoverability", "KHR_node_selectability", "KHR_xmp", "KHR_xmp_json_ld"});

// Returns the extensions in either list of a document that change no picture, in alphabetical order.
std::set<std::string> unreadOf(const Document& document) {
    std::set<std::string> names;
    for (const char* list : {"extensionsRequired", "extensionsUsed"}) {
        for (const Json& name : arrayMember(document.json(), list)) {
            if (changesNoPicture(name.get_ref<const std::string&>())) {
                names.insert(name.get<std::string>());
            }
        }
    }
    return names;
}

std::string extensionHint(std::string_view name) {
    if (name == "EXT_texture_avif") {
        return "store the textures as PNG, JPEG or WebP";
    }
    if (name.starts_with("KHR_materials_")) {
        return fmt::format("move {} from extensionsRequired to extensionsUsed to render without it", name);
    }
    return "export the scene without this extension";
}

}  // namespace

bool isSupportedExtension(const materials::MaterialModel& model, std::string_view name) {
    const int object = model.findObject(name);
    return (object >= 0 && model.objects[static_cast<std::size_t>(object)].isExtension) ||
           std::find(kSupported.begin(), kSupported.end(), name) != kSupported.end();
}

bool changesNoPicture(std::string_view name) {
    return std::find(kNoPicture.begin(), kNoPicture.end(), name) != kNoPicture.end();
}

bool requiresExtension(const Document& document, std::string_view name) {
    const Json& required = arrayMember(document.json(), "extensionsRequired");
    return std::find(required.begin(), required.end(), name) != required.end();
}

Diagnostic unsupportedExtension(const Document& document, std::string_view name, std::string_view pointer) {
    return document.error("extension-unsupported", pointer,
                          fmt::format("needs the extension {}, which Glint does not support", name),
                          extensionHint(name));
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
        if (!isSupportedExtension(*document.options().materialModel, name) && !changesNoPicture(name)) {
            return unsupportedExtension(document, name, fmt::format("/extensionsRequired/{}", i));
        }
    }
    std::set<std::string> warned;
    const Json& used = arrayMember(document.json(), "extensionsUsed");
    for (std::size_t i = 0; i < used.size(); ++i) {
        const std::string& name = used[i].get_ref<const std::string&>();
        if (!isSupportedExtension(*document.options().materialModel, name) && !changesNoPicture(name) &&
            warned.insert(name).second) {
            document.warn("extension-ignored", fmt::format("/extensionsUsed/{}", i),
                          fmt::format("the extension {} is not supported; what it adds is left out", name));
        }
    }
    if (const std::set<std::string> unread = unreadOf(document); !unread.empty()) {
        document.note("extension-no-picture", "/extensionsUsed",
                      fmt::format("{} change{} no picture and {} not read", fmt::join(unread, ", "),
                                  unread.size() == 1 ? "s" : "", unread.size() == 1 ? "is" : "are"));
    }
    return okStatus();
}

}  // namespace glint::gltf
