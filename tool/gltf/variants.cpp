#include "gltf/variants.h"

#include "base/suggest.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <set>
#include <string>

namespace glint::gltf {

namespace {

constexpr const char* kName = "KHR_materials_variants";

Diagnostic unknownVariant(const Document& document, const Scene& scene) {
    const std::string& wanted = document.options().variant;
    if (scene.variants.empty()) {
        return document.error("variant-unknown", "",
                              fmt::format("has no variant \"{}\": it has no {}", wanted, kName),
                              "leave the variant out");
    }
    return document.error(
        "variant-unknown", fmt::format("/extensions/{}/variants", kName),
        fmt::format("has no variant \"{}\"{}", wanted, base::suggestion(wanted, scene.variants)),
        fmt::format("use one of: {}", fmt::join(scene.variants, ", ")));
}

// Returns the material that a primitive has in a variant.
std::optional<int> materialIn(const Json& primitive, std::size_t variant) {
    const Json* extension = findExtension(primitive, kName);
    if (extension == nullptr) {
        return std::nullopt;
    }
    for (const Json& mapping : arrayMember(*extension, "mappings")) {
        const Json& variants = arrayMember(mapping, "variants");
        if (std::ranges::find(variants, Json(variant)) != variants.end()) {
            return mapping["material"].get<int>();
        }
    }
    return std::nullopt;
}

// Warns of primitives that map one variant to several materials, of which the first holds.
void checkMappings(Document& document) {
    const Json& meshes = arrayMember(document.json(), "meshes");
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        const Json& primitives = arrayMember(meshes[i], "primitives");
        for (std::size_t k = 0; k < primitives.size(); ++k) {
            const Json* const extension = findExtension(primitives[k], kName);
            std::set<std::size_t> seen;
            if (extension == nullptr) {
                continue;
            }
            for (const Json& mapping : arrayMember(*extension, "mappings")) {
                for (const Json& variant : arrayMember(mapping, "variants")) {
                    if (!seen.insert(variant.get<std::size_t>()).second) {
                        document.warn("variant-repeated",
                                      fmt::format("/meshes/{}/primitives/{}/extensions/{}", i, k, kName),
                                      fmt::format("maps variant {} more than once; the first material is "
                                                  "used",
                                                  variant.get<std::size_t>()),
                                      "give the primitive one material for each variant");
                    }
                }
            }
        }
    }
}

}  // namespace

Status applyVariant(Document& document, Scene& scene) {
    if (const Json* extension = findExtension(document.json(), kName)) {
        for (const Json& variant : arrayMember(*extension, "variants")) {
            scene.variants.push_back(variant["name"].get<std::string>());
        }
    }
    checkMappings(document);
    scene.variant = document.options().variant;
    if (scene.variant.empty()) {
        return okStatus();
    }
    const auto found = std::ranges::find(scene.variants, scene.variant);
    if (found == scene.variants.end()) {
        return unknownVariant(document, scene);
    }
    const auto index = static_cast<std::size_t>(found - scene.variants.begin());
    for (Mesh& mesh : scene.meshes) {
        for (Primitive& primitive : mesh.primitives) {
            const Json& json = document.json().at(Json::json_pointer(primitive.pointer));
            primitive.material = materialIn(json, index).value_or(primitive.material);
        }
    }
    return okStatus();
}

}  // namespace glint::gltf
