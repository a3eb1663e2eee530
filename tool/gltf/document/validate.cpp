#include "gltf/document/validate.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace glint::gltf {

namespace {

using namespace rules;

// Makes a rule of each name, as `make` makes one.
template <std::size_t N, typename Make>
constexpr std::array<Rule, N> rulesOf(const char* const (&names)[N], const Make& make) {
    std::array<Rule, N> rules{};
    for (std::size_t i = 0; i < N; ++i) {
        rules[i] = make(names[i]);
    }
    return rules;
}
template <std::size_t N>
constexpr std::array<Rule, N> objectsOf(const char* const (&names)[N], std::span<const Rule> members) {
    return rulesOf(names, [&](const char* name) { return object(name, members); });
}
template <std::size_t N>
constexpr std::array<Rule, N> accessorIndices(const char* const (&names)[N]) {
    return rulesOf(names, [](const char* name) { return index(name, "/accessors"); });
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
    Rule rule{.name = name, .kind = Kind::Value, .parameter = &parameter};
    if (std::isinf(parameter.high)) {
        // Exporters write the largest number they know for an infinite one. A float need not be able to hold
        // it.
        rule.min = std::numeric_limits<double>::lowest();
        rule.max = std::numeric_limits<double>::max();
    }
    return rule;
}

// The rules of a whole document whose materials and attributes are those of a model, which must outlive them.
class RootRules {
public:
    explicit RootRules(const materials::MaterialModel& model) : model_(model) {
        std::vector<Rule> attributes(kAttributeRules.begin(), kAttributeRules.end());
        for (const materials::VertexAttribute& attribute : model.attributes) {
            attributes.push_back(index(attribute.gltf, "/accessors"));
        }
        std::vector<Rule> primitive(kPrimitive.begin(), kPrimitive.end());
        primitive.push_back(object("attributes", keep(std::move(attributes)), true));
        std::vector<Rule> mesh(kMesh.begin(), kMesh.end());
        mesh.push_back(objects("primitives", keep(std::move(primitive))));
        root_ = keep({
            object("extensions", kRootExtensions),
            objects("buffers", kBuffer),
            objects("bufferViews", kBufferView),
            objects("accessors", {}),
            objects("meshes", keep(std::move(mesh))),
            objects("materials", keep(materialRules())),
            objects("textures", kTexture),
            objects("samplers", kSampler),
            objects("images", kImage),
            objects("nodes", kNode),
            objects("scenes", kScene),
            objects("cameras", kCamera),
            objects("animations", kAnimation),
            objects("skins", kSkin),
            index("scene", "/scenes"),
        });
    }
    RootRules(const RootRules&) = delete;
    RootRules& operator=(const RootRules&) = delete;

    std::span<const Rule> rules() const {
        return root_;
    }

private:
    std::span<const Rule> keep(std::vector<Rule> rules) {
        return kept_.emplace_back(std::move(rules));
    }

    // The rules for the JSON of a material, as the declarations give them. They check only types, because
    // values out of range are clamped while reading.
    std::vector<Rule> materialRules() {
        std::vector<Rule> extensions;
        std::vector<Rule> material = rulesOfObject(0);
        for (std::size_t i = 1; i < model_.objects.size(); ++i) {
            const materials::MaterialObject& object = model_.objects[i];
            (object.isExtension ? extensions : material)
                .push_back(rules::object(object.name, keep(rulesOfObject(static_cast<int>(i)))));
        }
        std::ranges::sort(extensions, {}, &Rule::name);
        material.insert(
            material.end(),
            {text("name"),
             text("alphaMode"),
             boolean("doubleSided"),
             {.name = "extensions", .kind = Kind::Extensions, .rules = keep(std::move(extensions))}});
        return material;
    }

    std::vector<Rule> rulesOfObject(int object) {
        std::vector<Rule> found;
        const materials::MaterialObject& owner = model_.objects[static_cast<std::size_t>(object)];
        for (const int index : owner.parameters) {
            const materials::Parameter& parameter = model_.parameters[static_cast<std::size_t>(index)];
            if (parameter.place.find('/') == std::string::npos) {
                found.push_back(parameterRule(parameter, parameter.place));
            }
        }
        for (const int index : owner.textures) {
            for (const materials::MaterialTexture::Place& place :
                 model_.textures[static_cast<std::size_t>(index)].places) {
                if (place.object == object) {
                    found.push_back(rules::object(place.member, keep(infoRules(place))));
                }
            }
        }
        return found;
    }

    std::vector<Rule> infoRules(const materials::MaterialTexture::Place& place) const {
        std::vector<Rule> info{index("index", "/textures", true), integer("texCoord", 0.0, kMaxInt),
                               object("extensions", kTextureInfoExtensions)};
        for (const int number : model_.objects[static_cast<std::size_t>(place.object)].parameters) {
            // A parameter beside a texture: "normalTexture/scale".
            const materials::Parameter& parameter = model_.parameters[static_cast<std::size_t>(number)];
            const std::string_view where = parameter.place;
            if (where.starts_with(place.member + "/")) {
                info.push_back(parameterRule(parameter, where.substr(place.member.size() + 1)));
            }
        }
        return info;
    }

    const materials::MaterialModel& model_;
    std::deque<std::vector<Rule>> kept_;  // Rule::rules point into it.
    std::span<const Rule> root_;
};

bool isOneOf(std::string_view value, std::initializer_list<std::string_view> values) {
    return std::ranges::find(values, value) != values.end();
}

Status checkAccessor(const Json& root, Json& accessor) {
    GLINT_TRY_DO(checkObject(root, accessor, kAccessor));
    const std::string& type = accessor["type"].get_ref<const std::string&>();
    if (!isOneOf(type, {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"})) {
        return schemaError("accessor-type", "/type", fmt::format("\"{}\" is no type", type));
    }
    const auto componentType = accessor["componentType"].get<std::int64_t>();
    return componentType < 5120 || componentType > 5126 || componentType == 5124
               ? schemaError("accessor-component-type", "/componentType",
                             fmt::format("{} is no component type", componentType))
               : okStatus();
}

Status checkCamera(const Json& camera) {
    const std::string& type = camera["type"].get_ref<const std::string&>();
    if (!isOneOf(type, {"perspective", "orthographic"})) {
        return schemaError("camera-type", "/type", fmt::format("\"{}\" is no type", type));
    }
    return find(camera, type) == nullptr ? schemaError("json-missing", "", fmt::format("has no \"{}\"", type))
                                         : okStatus();
}

}  // namespace

Status checkDocument(Json& root, const materials::MaterialModel& model) {
    GLINT_TRY_DO(checkObject(root, root, RootRules(model).rules()));
    Status status = okStatus();
    visitElements(root, "cameras", "", [&](const Json& camera, const std::string& pointer) {
        status = status ? within(pointer, checkCamera(camera)) : status;
    });
    const std::vector<bool> used = usedAccessors(root, model);
    for (std::size_t i = 0; i < used.size() && status; ++i) {
        if (used[i]) {
            status = within(fmt::format("/accessors/{}", i), checkAccessor(root, root["accessors"][i]));
        }
    }
    return status;
}

void visitAccessors(const Json& root, const materials::MaterialModel& model, const AccessorVisitor& visit) {
    // Visits the accessor that the object's member of that name refers to, if it has one.
    const auto use = [&](const Json& object, std::string_view name, AccessorUse how,
                         const std::string& pointer) {
        if (const Json* accessor = find(object, name)) {
            visit({accessor->get<int>(), how, name, fmt::format("{}/{}", pointer, name)});
        }
    };
    visitPrimitives(root, [&](const Json& primitive, const std::string& pointer) {
        const std::string attributes = pointer + "/attributes";
        for (const char* name : kAttributes) {
            use(primitive["attributes"], name, AccessorUse::Attribute, attributes);
        }
        for (const materials::VertexAttribute& attribute : model.attributes) {
            use(primitive["attributes"], attribute.gltf, AccessorUse::Attribute, attributes);
        }
        visitElements(primitive, "targets", pointer, [&](const Json& target, const std::string& place) {
            for (const char* name : kTargetAttributes) {
                use(target, name, AccessorUse::Target, place);
            }
        });
        use(primitive, "indices", AccessorUse::Indices, pointer);
    });
    visitElements(root, "nodes", "", [&](const Json& node, const std::string& pointer) {
        if (const Json* const instancing = findExtension(node, "EXT_mesh_gpu_instancing")) {
            for (const char* name : kInstanceAttributes) {
                use((*instancing)["attributes"], name, AccessorUse::Instances,
                    pointer + "/extensions/EXT_mesh_gpu_instancing/attributes");
            }
        }
    });
    visitElements(root, "animations", "", [&](const Json& animation, const std::string& pointer) {
        visitElements(animation, "samplers", pointer, [&](const Json& sampler, const std::string& place) {
            use(sampler, "input", AccessorUse::Times, place);
            use(sampler, "output", AccessorUse::Keyframes, place);
        });
    });
    visitElements(root, "skins", "", [&](const Json& skin, const std::string& pointer) {
        use(skin, "inverseBindMatrices", AccessorUse::InverseBinds, pointer);
    });
}

std::vector<bool> usedAccessors(const Json& root, const materials::MaterialModel& model) {
    std::vector<bool> used(arraySize(root, "/accessors"));
    visitAccessors(root, model,
                   [&](const UsedAccessor& one) { used[static_cast<std::size_t>(one.accessor)] = true; });
    return used;
}

}  // namespace glint::gltf
