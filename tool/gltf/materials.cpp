// Imports materials: core metallic-roughness, the extensions that Glint shades, and the choice between
// variants (KHR_materials_variants).
#include "base/text.h"
#include "gltf/document/validate.h"
#include "gltf/steps.h"
#include "gltf/textures.h"
#include "materials/value_json.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

namespace glint::gltf {

namespace {

// One object of a checked document.
struct ObjectSource {
    Document& document;
    const Json& json;
    std::string pointer;

    std::string pointerTo(std::string_view member) const {
        return fmt::format("{}/{}", pointer, member);
    }
};

std::array<float, 2> pairAt(const Json& object, std::string_view name, std::array<float, 2> fallback) {
    const Json* member = find(object, name);
    return member == nullptr ? fallback
                             : std::array{static_cast<float>((*member)[0].get<double>()),
                                          static_cast<float>((*member)[1].get<double>())};
}

// Reads the texture info of that name into the slot. If there is none, or none that can be used, the slot
// stays as it is.
Status readTexture(const ObjectSource& object, std::string_view member, TextureTable& textures,
                   package::TextureEntry::Dimension dimension, materials::TextureSlots& slots,
                   std::size_t slot) {
    const Json* json = find(object.json, member);
    if (json == nullptr) {
        return okStatus();
    }
    const Json* texCoord = find(*json, "texCoord");
    materials::TextureInfo read;
    if (const Json* transform = findExtension(*json, "KHR_texture_transform")) {
        read.hasTransform = true;
        read.transform.offset = pairAt(*transform, "offset", read.transform.offset);
        read.transform.scale = pairAt(*transform, "scale", read.transform.scale);
        if (const Json* rotation = find(*transform, "rotation")) {
            read.transform.rotation = static_cast<float>(rotation->get<double>());
        }
        if (const Json* override = find(*transform, "texCoord")) {
            texCoord = override;
        }
    }
    read.texCoord = texCoord == nullptr ? 0 : texCoord->get<int>();
    if (read.texCoord > 1) {
        object.document.warn(
            "texture-uv-set", object.pointerTo(member),
            fmt::format("uses UV set {}; Glint reads sets 0 and 1, and leaves the texture out",
                        read.texCoord),
            "move the coordinates to TEXCOORD_0 or TEXCOORD_1");
        slots[slot].texCoord = read.texCoord;  // planning says why there is no texture
        return okStatus();
    }
    GLINT_TRY(const auto texture, textures.use((*json)["index"].get<int>()));
    if (texture < 0) {
        return okStatus();
    }
    const Image& image = textures.imageOf(texture);
    const bool isRead = !image.isAtRunTime && image.width > 0;
    if (isRead && image.dimension != dimension) {
        const auto nameOf = [](package::TextureEntry::Dimension one) {
            return namesOf(one)[static_cast<std::size_t>(one)].what;
        };
        return object.document.error(
            "texture-dimension", object.pointerTo(member),
            fmt::format("the texture is declared as {}, and {} ({}) is {}", nameOf(dimension), image.pointer,
                        image.name, nameOf(image.dimension)),
            "give a file with the declared dimension; layers, faces and depths are read of KTX2");
    }
    read.texture = texture;
    slots[slot] = read;
    return okStatus();
}

// The objects of a material's JSON that the model knows, by their indices.
using Objects = std::map<int, const Json*>;

Objects objectsOf(const Json& json, const materials::MaterialModel& model) {
    Objects objects{{0, &json}};
    const auto add = [&](const Json& members, bool areExtensions) {
        for (const auto& [name, member] : members.items()) {
            const int object = model.findObject(name);
            if (object > 0 && model.objects[static_cast<std::size_t>(object)].isExtension == areExtensions) {
                objects.emplace(object, &member);
            }
        }
    };
    add(json, false);
    if (const Json* const extensions = find(json, "extensions")) {
        add(*extensions, true);
    }
    return objects;
}

// Returns the ascending elements of `list` of the objects.
std::vector<int> allOf(const Objects& objects, const materials::MaterialModel& model,
                       std::vector<int> materials::MaterialObject::*list) {
    std::set<int> all;
    for (const auto& [object, json] : objects) {
        const std::vector<int>& some = model.objects[static_cast<std::size_t>(object)].*list;
        all.insert(some.begin(), some.end());
    }
    return {all.begin(), all.end()};
}

std::string pointerOf(const std::string& pointer, const materials::MaterialObject& object) {
    return object.name.empty()
               ? pointer
               : fmt::format("{}{}/{}", pointer, object.isExtension ? "/extensions" : "", object.name);
}

Status readTextures(Document& document, TextureTable& textures, const Objects& objects,
                    const std::string& pointer, materials::Material& material) {
    const materials::MaterialModel& model = material.model();
    for (const int index : allOf(objects, model, &materials::MaterialObject::textures)) {
        const auto slot = static_cast<std::size_t>(index);
        for (const materials::MaterialTexture::Place& place : model.textures[slot].places) {
            const auto object = objects.find(place.object);
            if (object == objects.end() || !material.reads(place.object)) {
                continue;
            }
            const materials::MaterialObject& owner = model.objects[static_cast<std::size_t>(place.object)];
            GLINT_TRY_DO(readTexture({document, *object->second, pointerOf(pointer, owner)}, place.member,
                                     textures, model.textures[slot].dimension, material.textures, slot));
        }
    }
    return okStatus();
}

// glTF decides by the slot which textures are colours. A KTX2 file declares this itself, and the two should
// agree.
void checkTransfer(Document& document, const Scene& scene, const materials::Material& material,
                   const std::string& pointer) {
    for (const auto& [slot, info] : material.textures) {
        if (info.texture < 0) {
            continue;
        }
        const Texture& texture = scene.textures[static_cast<std::size_t>(info.texture)];
        const Image& image = scene.images[static_cast<std::size_t>(texture.image)];
        const bool color = material.isColor(static_cast<int>(slot));
        if (image.transfer == (color ? Transfer::Linear : Transfer::Srgb)) {
            document.warn("ktx2-metadata", pointer,
                          fmt::format("{} says that it is {}, but is used as {}; it is read as the latter",
                                      image.pointer, color ? "linear data" : "colour in sRGB",
                                      color ? "colour in sRGB" : "linear data"),
                          "make the KTX2 file with the transfer function of its use");
        }
    }
}

materials::AlphaMode readAlphaMode(Document& document, const std::string& mode, const std::string& pointer) {
    if (mode == "MASK") {
        return materials::AlphaMode::Mask;
    }
    if (mode == "BLEND") {
        return materials::AlphaMode::Blend;
    }
    if (!mode.empty() && mode != "OPAQUE") {
        document.warn("alpha-mode", pointer + "/alphaMode",
                      fmt::format("\"{}\" is no alpha mode; OPAQUE is used", mode),
                      "use OPAQUE, MASK or BLEND");
    }
    return materials::AlphaMode::Opaque;
}

// Returns the value at a place below an object, such as "normalTexture/scale", or null.
const Json* findBelow(const Json& object, std::string_view place) {
    const Json* value = &object;
    while (value != nullptr && !place.empty()) {
        const std::string_view member = place.substr(0, place.find('/'));
        value = find(*value, member);
        place.remove_prefix(std::min(place.size(), member.size() + 1));
    }
    return value;
}

// The value's range is told to the user as the declaration gives it.
std::string rangeHint(const materials::Parameter& parameter) {
    const std::string also = parameter.also ? fmt::format("{}, or ", *parameter.also) : "";
    return parameter.high >= std::numeric_limits<float>::max()
               ? fmt::format("use {}{} or more", also, parameter.low)
               : fmt::format("use {}{} to {}", also, parameter.low, parameter.high);
}

void readParameter(const ObjectSource& object, const materials::Parameter& parameter,
                   materials::Material& material) {
    const Json* const json = findBelow(object.json, parameter.place);
    if (json == nullptr) {
        // An object that replaces another one has defaults of its own.
        if (parameter.aliasOf >= 0) {
            std::ranges::copy(parameter.fallback, material.values.of(parameter).begin());
        }
        return;
    }
    const std::span<double> target = material.values.of(parameter);
    std::vector<double> numbers;
    readValue(parameter, *json, numbers);  // checkDocument() has checked it
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        const double number = numbers[i];
        target[i] = parameter.hold(number);
        if (!parameter.isValid(number)) {
            object.document.warn(
                "material-range",
                object.pointerTo(parameter.place + placeOfNumber(parameter, static_cast<int>(i))),
                fmt::format("is {}; {} is used", number, std::clamp(number, parameter.low, parameter.high)),
                rangeHint(parameter));
        }
    }
}

// Warns of extensions that another one of the material excludes.
void warnOfConflicts(Document& document, const std::string& pointer, const materials::Material& material) {
    const materials::MaterialModel& model = material.model();
    // The features that the material's objects ask for, and what these exclude.
    std::set<int> asked;
    std::set<int> exclusions;
    for (const int object : material.given) {
        for (const int feature : model.objects[static_cast<std::size_t>(object)].asksFor) {
            const std::vector<int>& own = model.features[static_cast<std::size_t>(feature)].exclusions;
            asked.insert(feature);
            exclusions.insert(own.begin(), own.end());
        }
    }
    std::set<int> told;
    for (const int place : exclusions) {
        const materials::Exclusion& exclusion = model.exclusions[static_cast<std::size_t>(place)];
        const int by = model.features[static_cast<std::size_t>(exclusion.by)].object;
        for (const int index : asked) {
            const materials::Feature& feature = model.features[static_cast<std::size_t>(index)];
            const int object = feature.object;
            if (!exclusion.excluded.has(feature.bit) || object == by || !told.insert(object).second) {
                continue;
            }
            document.warn("material-conflict",
                          pointerOf(pointer, model.objects[static_cast<std::size_t>(object)]),
                          fmt::format("must not be on a material that has {}; it changes nothing",
                                      model.objects[static_cast<std::size_t>(by)].name),
                          "leave one of the two extensions out");
        }
    }
}

void readParameters(Document& document, const Json& json, const Objects& objects, const std::string& pointer,
                    materials::Material& material) {
    const materials::MaterialModel& model = material.model();
    for (const auto& [object, ignored] : objects) {
        material.given.add(object);
    }
    // Objects that replace others are read where they are given.
    for (const auto& [object, ignored] : objects) {
        for (const materials::MaterialObject::Setting& setting :
             model.objects[static_cast<std::size_t>(object)].settings) {
            if (material.reads(object)) {
                const materials::Parameter& parameter =
                    model.parameters[static_cast<std::size_t>(setting.parameter)];
                std::ranges::copy(setting.numbers, material.values.of(parameter).begin());
            }
        }
    }
    for (const int index : allOf(objects, model, &materials::MaterialObject::parameters)) {
        const materials::Parameter& parameter = model.parameters[static_cast<std::size_t>(index)];
        const materials::MaterialObject& owner = model.objects[static_cast<std::size_t>(parameter.object)];
        if (material.reads(parameter.object)) {
            if (parameter.aliasOf >= 0) {
                // The value is that of an extension whose feature multiplies by it.
                const auto own = static_cast<std::size_t>(parameter.aliasOf);
                const int its = model.parameters[own].object;
                if (model.objects[static_cast<std::size_t>(its)].isExtension) {
                    material.given.add(its);
                }
            }
            readParameter({document, *objects.at(parameter.object), pointerOf(pointer, owner)}, parameter,
                          material);
        }
    }
    warnOfConflicts(document, pointer, material);
    if (const Json* extensions = find(json, "extensions")) {
        for (const auto& [name, ignored] : extensions->items()) {
            if (!isSupportedExtension(model, name) && !changesNoPicture(name)) {
                material.unsupportedExtensions.push_back(name);
            }
        }
    }
}

}  // namespace

Status importMaterials(Document& document, Scene& scene) {
    importSamplers(document, scene);
    TextureTable textures(document, scene);
    for (std::size_t i = 0; i < arraySize(document.json(), "/materials"); ++i) {
        const Json& json = document.json()["materials"][i];
        const std::string pointer = fmt::format("/materials/{}", i);
        materials::Material material(*document.options().materialModel);
        material.name = memberOr<std::string>(json, "name", "");
        material.alphaMode = readAlphaMode(document, memberOr<std::string>(json, "alphaMode", ""), pointer);
        material.doubleSided = memberOr(json, "doubleSided", false);
        const Objects objects = objectsOf(json, material.model());
        readParameters(document, json, objects, pointer, material);
        GLINT_TRY_DO(readTextures(document, textures, objects, pointer, material));
        checkTransfer(document, scene, material, pointer);
        scene.materials.push_back(std::move(material));
    }
    return okStatus();
}

// ---- KHR_materials_variants ----

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

// Calls visit(variant, material) for each variant that a primitive maps.
template <typename Visit>
void visitMappings(const tinygltf::Primitive& primitive, const Visit& visit) {
    if (const Value* const extension = extensionOf(primitive.extensions, kName)) {
        for (const Value& mapping : extension->Get("mappings").Get<Value::Array>()) {
            for (const Value& variant : mapping.Get("variants").Get<Value::Array>()) {
                visit(variant.GetNumberAsInt(), memberOr(mapping, "material", -1));
            }
        }
    }
}

// Warns of primitives that map one variant to several materials, of which the first holds.
void checkMappings(Document& document) {
    const std::vector<tinygltf::Mesh>& meshes = document.model().meshes;
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        for (std::size_t k = 0; k < meshes[i].primitives.size(); ++k) {
            std::set<int> seen;
            visitMappings(meshes[i].primitives[k], [&](int variant, int /*material*/) {
                if (!seen.insert(variant).second) {
                    document.warn(
                        "variant-repeated",
                        fmt::format("/meshes/{}/primitives/{}/extensions/{}", i, k, kName),
                        fmt::format("maps variant {} more than once; the first material is used", variant),
                        "give the primitive one material for each variant");
                }
            });
        }
    }
}

// Fills Primitive::variantMaterials of a primitive with its own material. The first mapping of a variant
// holds.
void mapVariants(const tinygltf::Primitive& inFile, std::size_t variants, Primitive& primitive) {
    std::vector<std::optional<int>> chosen(variants);
    bool maps = false;
    visitMappings(inFile, [&](int variant, int material) {
        std::optional<int>& one = chosen[static_cast<std::size_t>(variant)];
        one = one.value_or(material);
        maps = true;
    });
    if (!maps) {
        return;
    }
    for (const std::optional<int>& one : chosen) {
        primitive.variantMaterials.push_back(one.value_or(primitive.material));
    }
    primitive.variantMaterials.push_back(primitive.material);
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
    const auto found = std::ranges::find(scene.variants, scene.variant);
    if (!scene.variant.empty() && found == scene.variants.end()) {
        return unknownVariant(document, scene);
    }
    const auto index = static_cast<std::size_t>(found - scene.variants.begin());
    for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
        // The scene's mesh lacks the primitives that have nothing to draw.
        auto primitive = scene.meshes[m].primitives.begin();
        const std::vector<tinygltf::Primitive>& inFile = document.model().meshes[m].primitives;
        for (std::size_t i = 0; i < inFile.size() && primitive != scene.meshes[m].primitives.end(); ++i) {
            if (primitive->pointer == fmt::format("/meshes/{}/primitives/{}", m, i)) {
                mapVariants(inFile[i], scene.variants.size(), *primitive);
                if (!scene.variant.empty() && !primitive->variantMaterials.empty()) {
                    primitive->material = primitive->variantMaterials[index];
                }
                ++primitive;
            }
        }
    }
    return okStatus();
}

}  // namespace glint::gltf
