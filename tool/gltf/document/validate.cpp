#include "gltf/document/validate.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <deque>
#include <limits>
#include <span>
#include <vector>

namespace glint::gltf {

namespace {

using namespace rules;

// Makes a rule of each name for an object with those members.
template <std::size_t N>
constexpr std::array<Rule, N> objectsOf(const char* const (&names)[N], std::span<const Rule> members) {
    std::array<Rule, N> rules{};
    for (std::size_t i = 0; i < N; ++i) {
        rules[i] = object(names[i], members);
    }
    return rules;
}

// These are the rules of buffers, views and accessors.
constexpr std::array kBuffer{text("uri"), size("byteLength", 0.0, true)};
// The largest vertex that the extension allows has 256 bytes.
constexpr std::array kMeshopt{index("buffer", "/buffers", true),
                              size("byteOffset"),
                              size("byteLength", 0.0, true),
                              integer("byteStride", 1.0, 256.0, true),
                              size("count", 0.0, true),
                              text("mode", true),
                              text("filter")};
constexpr std::array kBufferViewExtensions = objectsOf(kMeshoptExtensions, kMeshopt);
constexpr std::array kBufferView{index("buffer", "/buffers", true), size("byteOffset"),
                                 size("byteLength", 0.0, true), integer("byteStride", 0.0, 252.0),
                                 object("extensions", kBufferViewExtensions)};
constexpr std::array kSparseIndices{index("bufferView", "/bufferViews", true),
                                    integer("byteOffset", 0.0, kMaxInt),
                                    integer("componentType", 0.0, kMaxInt, true)};
constexpr std::array kSparseValues{index("bufferView", "/bufferViews", true),
                                   integer("byteOffset", 0.0, kMaxInt)};
constexpr std::array kSparse{integer("count", 0.0, kMaxInt, true), object("indices", kSparseIndices, true),
                             object("values", kSparseValues, true)};
constexpr std::array kAccessor{index("bufferView", "/bufferViews"),
                               size("byteOffset"),
                               integer("componentType", 0.0, kMaxInt, true),
                               size("count", 1.0, true),
                               text("type", true),
                               boolean("normalized"),
                               object("sparse", kSparse)};

// These are the rules of meshes.
template <std::size_t N>
constexpr std::array<Rule, N> accessorIndices(const char* const (&names)[N]) {
    std::array<Rule, N> rules{};
    for (std::size_t i = 0; i < N; ++i) {
        rules[i] = index(names[i], "/accessors");
    }
    return rules;
}
constexpr std::array kAttributeRules = accessorIndices(kAttributes);
constexpr std::array kTargetRules = accessorIndices(kTargetAttributes);
constexpr std::array kVariantMapping{indices("variants", "/extensions/KHR_materials_variants/variants", true),
                                     index("material", "/materials", true)};
constexpr std::array kVariantMappings{objects("mappings", kVariantMapping, true)};
constexpr double kMaxAttributeId = 4294967295.0;
constexpr std::array kDracoMembers{index("bufferView", "/bufferViews", true),
                                   integers("attributes", 0.0, kMaxAttributeId, true)};
constexpr std::array kPrimitiveExtensions{object(kDracoExtension, kDracoMembers),
                                          object("KHR_materials_variants", kVariantMappings)};
// The rules of the attributes come before these, because packs add to them.
constexpr std::array kPrimitive{index("indices", "/accessors"), index("material", "/materials"),
                                integer("mode", 0.0, kMaxInt), objects("targets", kTargetRules),
                                object("extensions", kPrimitiveExtensions)};
constexpr std::array kMesh{text("name"), numbers("weights", 0)};

// These are the rules of animations and skins. Samplers are checked where the animation is read, because
// their index is into an array of the animation itself.
constexpr std::array kAnimationPointer{text("pointer", true)};
constexpr std::array kAnimationExtensions{object("KHR_animation_pointer", kAnimationPointer)};
constexpr std::array kAnimationTarget{index("node", "/nodes"), text("path", true),
                                      object("extensions", kAnimationExtensions)};
constexpr std::array kChannel{integer("sampler", 0.0, kMaxInt, true),
                              object("target", kAnimationTarget, true)};
constexpr std::array kAnimationSampler{index("input", "/accessors", true),
                                       index("output", "/accessors", true), text("interpolation")};
constexpr std::array kAnimation{text("name"), objects("channels", kChannel, true),
                                objects("samplers", kAnimationSampler, true)};
constexpr std::array kSkin{text("name"), index("inverseBindMatrices", "/accessors"),
                           index("skeleton", "/nodes"), indices("joints", "/nodes", true)};

// These are the rules of textures.
constexpr std::array kTextureSource{index("source", "/images", true)};
constexpr std::array kTextureExtensions = objectsOf(kImageExtensions, kTextureSource);
constexpr std::array kTexture{text("name"), index("source", "/images"), index("sampler", "/samplers"),
                              object("extensions", kTextureExtensions)};
constexpr std::array kSampler{integer("magFilter", 0.0, kMaxInt), integer("minFilter", 0.0, kMaxInt),
                              integer("wrapS", 0.0, kMaxInt), integer("wrapT", 0.0, kMaxInt)};
constexpr std::array kImage{text("name"), text("uri"), text("mimeType"), index("bufferView", "/bufferViews")};

// These are the rules of nodes, cameras and lights.
constexpr std::array kNodeLight{index("light", "/extensions/KHR_lights_punctual/lights", true)};
constexpr std::array kNodeVisibility{boolean("visible")};
constexpr std::array kInstanceRules = accessorIndices(kInstanceAttributes);
constexpr std::array kInstancing{object("attributes", kInstanceRules, true)};
constexpr std::array kNodeExtensions{object("KHR_lights_punctual", kNodeLight),
                                     object("KHR_node_visibility", kNodeVisibility),
                                     object("EXT_mesh_gpu_instancing", kInstancing)};
constexpr std::array kNode{text("name"),
                           index("mesh", "/meshes"),
                           index("skin", "/skins"),
                           numbers("weights", 0),
                           index("camera", "/cameras"),
                           indices("children", "/nodes"),
                           numbers("matrix", 16),
                           numbers("translation", 3),
                           numbers("rotation", 4),
                           numbers("scale", 3),
                           object("extensions", kNodeExtensions)};
constexpr std::array kScene{text("name"), indices("nodes", "/nodes")};
constexpr std::array kPerspective{number("yfov", true), number("znear", true), number("zfar")};
constexpr std::array kOrthographic{number("xmag", true), number("ymag", true), number("znear", true),
                                   number("zfar", true)};
constexpr std::array kCamera{text("name"), text("type", true), object("perspective", kPerspective),
                             object("orthographic", kOrthographic)};
constexpr std::array kSpot{number("innerConeAngle"), number("outerConeAngle")};
constexpr std::array kLight{text("name"),        text("type", true), numbers("color", 3),
                            number("intensity"), number("range"),    object("spot", kSpot)};
constexpr std::array kLights{objects("lights", kLight)};
constexpr std::array kVariant{text("name", true)};
constexpr std::array kVariants{objects("variants", kVariant, true)};
constexpr std::array kRootExtensions{object("KHR_lights_punctual", kLights),
                                     object("KHR_materials_variants", kVariants)};

// ---- Rules of materials ----

constexpr std::array kTransformRules{numbers("offset", 2), number("rotation"), numbers("scale", 2),
                                     integer("texCoord", 0.0, kMaxInt)};
constexpr std::array kTextureInfoExtensions{object("KHR_texture_transform", kTransformRules)};

Rule parameterRule(const materials::Parameter& parameter, std::string_view name) {
    Rule rule =
        parameter.channels == 1 ? number(name) : numbers(name, static_cast<std::size_t>(parameter.channels));
    if (std::isinf(parameter.high)) {
        // Exporters write the largest number they know for an infinite one. A float need not be able to hold
        // it.
        rule.min = std::numeric_limits<double>::lowest();
        rule.max = std::numeric_limits<double>::max();
    }
    return rule;
}

// Rules for the JSON of a material, as the declarations give them. They check only types, because values out
// of range are clamped while reading. The model must outlive the rules.
class MaterialRules {
public:
    explicit MaterialRules(const materials::MaterialModel& model);
    MaterialRules(const MaterialRules&) = delete;
    MaterialRules& operator=(const MaterialRules&) = delete;

    std::span<const Rule> rules() const {
        return material_;
    }

private:
    std::vector<Rule> rulesOf(const materials::MaterialModel& model, int object);

    std::deque<std::vector<Rule>> nested_;  // Rule::rules point into it.
    std::vector<Rule> material_;
};

MaterialRules::MaterialRules(const materials::MaterialModel& model) {
    std::vector<Rule> extensions;
    material_ = rulesOf(model, 0);
    for (std::size_t i = 1; i < model.objects.size(); ++i) {
        const materials::MaterialObject& object = model.objects[i];
        nested_.push_back(rulesOf(model, static_cast<int>(i)));
        (object.isExtension ? extensions : material_).push_back(rules::object(object.name, nested_.back()));
    }
    nested_.push_back(std::move(extensions));
    for (const Rule& rule :
         {text("name"), text("alphaMode"), boolean("doubleSided"), object("extensions", nested_.back())}) {
        material_.push_back(rule);
    }
}

std::vector<Rule> MaterialRules::rulesOf(const materials::MaterialModel& model, int object) {
    std::vector<Rule> found;
    for (const materials::Parameter& parameter : model.parameters) {
        if (parameter.object == object && parameter.place.find('/') == std::string::npos) {
            found.push_back(parameterRule(parameter, parameter.place));
        }
    }
    for (const materials::MaterialTexture& texture : model.textures) {
        for (const materials::MaterialTexture::Place& place : texture.places) {
            if (place.object != object) {
                continue;
            }
            std::vector<Rule>& info = nested_.emplace_back();
            info = {index("index", "/textures", true), integer("texCoord", 0.0, kMaxInt),
                    rules::object("extensions", kTextureInfoExtensions)};
            for (const materials::Parameter& parameter : model.parameters) {
                // A parameter beside a texture: "normalTexture/scale".
                const std::string_view where = parameter.place;
                if (parameter.object == object && where.starts_with(place.member + "/")) {
                    info.push_back(parameterRule(parameter, where.substr(place.member.size() + 1)));
                }
            }
            found.push_back(rules::object(place.member, info));
        }
    }
    return found;
}

// The rules of a whole document whose materials are made as `model` says.
class RootRules {
public:
    explicit RootRules(const materials::MaterialModel& model)
        : material_(model),
          attributes_(attributeRules(model)),
          primitive_(with(kPrimitive, object("attributes", attributes_, true))),
          mesh_(with(kMesh, objects("primitives", primitive_))),
          root_{
              object("extensions", kRootExtensions),
              objects("buffers", kBuffer),
              objects("bufferViews", kBufferView),
              objects("accessors", {}),
              objects("meshes", mesh_),
              objects("materials", material_.rules()),
              objects("textures", kTexture),
              objects("samplers", kSampler),
              objects("images", kImage),
              objects("nodes", kNode),
              objects("scenes", kScene),
              objects("cameras", kCamera),
              objects("animations", kAnimation),
              objects("skins", kSkin),
              index("scene", "/scenes"),
          } {}

    std::span<const Rule> rules() const {
        return root_;
    }

private:
    static std::vector<Rule> with(std::span<const Rule> rules, Rule further) {
        std::vector<Rule> all(rules.begin(), rules.end());
        all.push_back(further);
        return all;
    }
    static std::vector<Rule> attributeRules(const materials::MaterialModel& model) {
        std::vector<Rule> rules(kAttributeRules.begin(), kAttributeRules.end());
        for (const materials::VertexAttribute& attribute : model.attributes) {
            rules.push_back(index(attribute.gltf, "/accessors"));
        }
        return rules;
    }

    MaterialRules material_;
    // Rule::rules point into these.
    std::vector<Rule> attributes_;
    std::vector<Rule> primitive_;
    std::vector<Rule> mesh_;
    std::vector<Rule> root_;
};

bool isOneOf(std::string_view value, std::initializer_list<std::string_view> values) {
    for (const std::string_view candidate : values) {
        if (candidate == value) {
            return true;
        }
    }
    return false;
}

std::optional<SchemaError> checkAccessor(const Json& root, Json& accessor, const std::string& pointer) {
    if (auto error = checkObject(root, accessor, kAccessor, pointer)) {
        return error;
    }
    const std::string& type = accessor["type"].get_ref<const std::string&>();
    if (!isOneOf(type, {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"})) {
        return SchemaError{"accessor-type", pointer + "/type", fmt::format("\"{}\" is no type", type)};
    }
    const auto componentType = accessor["componentType"].get<std::int64_t>();
    if (componentType < 5120 || componentType > 5126 || componentType == 5124) {
        return SchemaError{"accessor-component-type", pointer + "/componentType",
                           fmt::format("{} is no component type", componentType)};
    }
    return std::nullopt;
}

std::optional<SchemaError> checkCameras(const Json& root) {
    const Json& cameras = arrayMember(root, "cameras");
    for (std::size_t i = 0; i < cameras.size(); ++i) {
        const std::string pointer = fmt::format("/cameras/{}", i);
        const std::string& type = cameras[i]["type"].get_ref<const std::string&>();
        if (!isOneOf(type, {"perspective", "orthographic"})) {
            return SchemaError{"camera-type", pointer + "/type", fmt::format("\"{}\" is no type", type)};
        }
        if (find(cameras[i], type) == nullptr) {
            return SchemaError{"json-missing", pointer, fmt::format("has no \"{}\"", type)};
        }
    }
    return std::nullopt;
}

}  // namespace

std::optional<SchemaError> checkDocument(Json& root, const materials::MaterialModel& model) {
    const RootRules rules(model);
    if (auto error = checkObject(root, root, rules.rules(), "")) {
        return error;
    }
    if (auto error = checkCameras(root)) {
        return error;
    }
    const std::vector<bool> used = usedAccessors(root, model);
    for (std::size_t i = 0; i < used.size(); ++i) {
        if (used[i]) {
            if (auto error = checkAccessor(root, root["accessors"][i], fmt::format("/accessors/{}", i))) {
                return error;
            }
        }
    }
    return std::nullopt;
}

void visitAccessors(const Json& root, const materials::MaterialModel& model, const AccessorVisitor& visit) {
    // Visits the accessor that the object's member of that name refers to, if it has one.
    const auto use = [&](const Json& object, std::string_view name, AccessorUse how,
                         const std::string& pointer) {
        if (const Json* accessor = find(object, name)) {
            visit({accessor->get<int>(), how, name, fmt::format("{}/{}", pointer, name)});
        }
    };
    const Json& meshes = arrayMember(root, "meshes");
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        const Json& primitives = arrayMember(meshes[i], "primitives");
        for (std::size_t k = 0; k < primitives.size(); ++k) {
            const std::string pointer = fmt::format("/meshes/{}/primitives/{}", i, k);
            for (const char* name : kAttributes) {
                use(primitives[k]["attributes"], name, AccessorUse::Attribute, pointer + "/attributes");
            }
            for (const materials::VertexAttribute& attribute : model.attributes) {
                use(primitives[k]["attributes"], attribute.gltf, AccessorUse::Attribute,
                    pointer + "/attributes");
            }
            const Json& targets = arrayMember(primitives[k], "targets");
            for (std::size_t t = 0; t < targets.size(); ++t) {
                for (const char* name : kTargetAttributes) {
                    use(targets[t], name, AccessorUse::Target, fmt::format("{}/targets/{}", pointer, t));
                }
            }
            use(primitives[k], "indices", AccessorUse::Indices, pointer);
        }
    }
    const Json& nodes = arrayMember(root, "nodes");
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (const Json* const instancing = findExtension(nodes[i], "EXT_mesh_gpu_instancing")) {
            for (const char* name : kInstanceAttributes) {
                use((*instancing)["attributes"], name, AccessorUse::Instances,
                    fmt::format("/nodes/{}/extensions/EXT_mesh_gpu_instancing/attributes", i));
            }
        }
    }
    const Json& animations = arrayMember(root, "animations");
    for (std::size_t i = 0; i < animations.size(); ++i) {
        const Json& samplers = arrayMember(animations[i], "samplers");
        for (std::size_t k = 0; k < samplers.size(); ++k) {
            const std::string pointer = fmt::format("/animations/{}/samplers/{}", i, k);
            use(samplers[k], "input", AccessorUse::Times, pointer);
            use(samplers[k], "output", AccessorUse::Keyframes, pointer);
        }
    }
    const Json& skins = arrayMember(root, "skins");
    for (std::size_t i = 0; i < skins.size(); ++i) {
        use(skins[i], "inverseBindMatrices", AccessorUse::InverseBinds, fmt::format("/skins/{}", i));
    }
}

std::vector<bool> usedAccessors(const Json& root, const materials::MaterialModel& model) {
    std::vector<bool> used(arraySize(root, "/accessors"));
    visitAccessors(root, model,
                   [&](const UsedAccessor& one) { used[static_cast<std::size_t>(one.accessor)] = true; });
    return used;
}

}  // namespace glint::gltf
