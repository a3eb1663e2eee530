// Makes a document of glTF of a set of materials.
#include "base/text.h"
#include "gltf/document/material_list.h"
#include "materials/value_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <string_view>
#include <utility>

namespace glint::gltf {

using materials::MaterialModel;

namespace {

constexpr std::uint32_t kSegments = 24;
constexpr std::uint32_t kRings = 12;
constexpr double kGap = 2.3;  // of the centres of spheres, in largest radii

// ---- The sphere ----

// Arrays of floats of one buffer, and their accessors.
class Arrays {
public:
    // Adds a value of `channels` numbers for each vertex of a unit sphere. `value` takes the normal and the
    // UV.
    template <typename Value>
    int add(const char* type, Value value) {
        const std::size_t first = bytes_.size();
        std::size_t count = 0;
        for (std::uint32_t ring = 0; ring <= kRings; ++ring) {
            const double theta = std::numbers::pi * ring / kRings;
            for (std::uint32_t segment = 0; segment <= kSegments; ++segment, ++count) {
                const double phi = 2.0 * std::numbers::pi * segment / kSegments;
                const std::array<double, 3> normal{std::sin(theta) * std::cos(phi), std::cos(theta),
                                                   -std::sin(theta) * std::sin(phi)};
                for (const double number : value(normal, phi, theta)) {
                    append(static_cast<float>(number));
                }
            }
        }
        return accessor(first, count, 5126, type);
    }
    int addIndices() {
        const std::size_t first = bytes_.size();
        std::size_t count = 0;
        for (std::uint32_t ring = 0; ring < kRings; ++ring) {
            for (std::uint32_t segment = 0; segment < kSegments; ++segment) {
                const std::uint32_t a = ring * (kSegments + 1) + segment;
                const std::uint32_t b = a + kSegments + 1;
                // One of the two triangles at a pole has no area.
                const std::array<std::uint32_t, 6> corners{a, b, a + 1, a + 1, b, b + 1};
                for (std::size_t i = ring > 0 ? 0 : 3; i < (ring + 1 < kRings ? 6U : 3U); ++i, ++count) {
                    append(corners[i]);
                }
            }
        }
        return accessor(first, count, 5125, "SCALAR");
    }
    // glTF wants the bounds of positions.
    void setBounds(int accessor, const std::array<double, 3>& least, const std::array<double, 3>& most) {
        accessors_[static_cast<std::size_t>(accessor)]["min"] = least;
        accessors_[static_cast<std::size_t>(accessor)]["max"] = most;
    }
    const Json& accessors() const {
        return accessors_;
    }
    const Json& views() const {
        return views_;
    }
    const base::Bytes& bytes() const {
        return bytes_;
    }

private:
    template <typename Number>
    void append(Number number) {
        const auto* const bytes = reinterpret_cast<const std::uint8_t*>(&number);
        bytes_.insert(bytes_.end(), bytes, bytes + sizeof number);
    }
    int accessor(std::size_t first, std::size_t count, int component, const char* type) {
        views_.push_back({{"buffer", 0}, {"byteOffset", first}, {"byteLength", bytes_.size() - first}});
        accessors_.push_back({{"bufferView", accessors_.size()},
                              {"componentType", component},
                              {"count", count},
                              {"type", type}});
        return static_cast<int>(accessors_.size()) - 1;
    }

    base::Bytes bytes_;
    Json accessors_ = Json::array();
    Json views_ = Json::array();
};

// The sphere of every material, with all attributes that a material may read.
struct Sphere {
    Arrays arrays;
    std::map<std::string, int> attributes;  // accessors, of those of glTF
    std::array<int, 4> ofChannels{};        // accessors for attributes of packs, by their channels
    int indices = 0;
};

Sphere makeSphere() {
    using Normal = std::array<double, 3>;
    Sphere sphere;
    Arrays& arrays = sphere.arrays;
    std::map<std::string, int>& of = sphere.attributes;
    of["POSITION"] = arrays.add("VEC3", [](const Normal& n, double, double) { return n; });
    arrays.setBounds(of["POSITION"], {-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0});
    of["NORMAL"] = of["POSITION"];
    of["TANGENT"] = arrays.add("VEC4", [](const Normal&, double phi, double) {
        return std::array{-std::sin(phi), 0.0, -std::cos(phi), 1.0};
    });
    of["TEXCOORD_0"] = arrays.add("VEC2", [](const Normal&, double phi, double theta) {
        return std::array{phi / std::numbers::pi, theta / std::numbers::pi};
    });
    of["TEXCOORD_1"] = of["TEXCOORD_0"];
    of["COLOR_0"] = arrays.add("VEC4", [](const Normal& n, double, double) {
        return std::array{0.5 + 0.5 * n[0], 0.5 + 0.5 * n[1], 0.5 + 0.5 * n[2], 1.0};
    });
    const int scalar =
        arrays.add("SCALAR", [](const Normal& n, double, double) { return std::array{0.5 + 0.5 * n[1]}; });
    sphere.ofChannels = {scalar, of["TEXCOORD_0"], of["POSITION"], of["COLOR_0"]};
    sphere.indices = arrays.addIndices();
    return sphere;
}

const Sphere& theSphere() {
    static const Sphere kSphere = makeSphere();
    return kSphere;
}

// ---- From names to places ----

class Expander {
public:
    Expander(const MaterialModel& model, base::JsonReader& reader)
        : model_(model), reader_(reader), accessors_(theSphere().attributes) {
        for (const materials::VertexAttribute& attribute : model_.attributes) {
            accessors_[attribute.gltf] =
                theSphere().ofChannels[static_cast<std::size_t>(attribute.type->channels - 1)];
        }
        for (const materials::Parameter& parameter : model_.parameters) {
            parameters_.emplace(std::pair(std::string_view(parameter.declared), parameter.object),
                                &parameter);
        }
        for (const materials::MaterialTexture& texture : model_.textures) {
            for (const materials::MaterialTexture::Place& place : texture.places) {
                places_.emplace(std::pair(std::string_view(place.member), place.object), &place);
            }
        }
    }

    ExpandedMaterials expand(const MaterialSet& list) {
        double largest = 0.0;
        for (const MaterialDescription& material : list.materials) {
            largest = std::max(largest, std::sqrt(material.weight));
        }
        const auto columns =
            static_cast<std::size_t>(std::ceil(std::sqrt(1.5 * static_cast<double>(list.materials.size()))));
        for (std::size_t i = 0; i < list.materials.size() && reader_.ok(); ++i) {
            addMaterial(list.materials[i], i);
            const double radius = std::sqrt(list.materials[i].weight);
            const double step = kGap * largest;
            const std::size_t column = i % columns;
            const std::size_t row = i / columns;
            nodes_.push_back(
                {{"name", list.materials[i].name},
                 {"mesh", i},
                 {"translation", {step * static_cast<double>(column), -step * static_cast<double>(row), 0.0}},
                 {"scale", {radius, radius, radius}}});
            shown_.push_back(i);
        }
        finish();
        return std::move(expanded_);
    }

private:
    using Place = std::string;

    void fail(const Place& place, const std::string& message) {
        reader_.fail(place, message);
    }

    std::vector<std::string> attributeNames() const {
        std::vector<std::string> names;
        for (const auto& [name, accessor] : accessors_) {
            names.push_back(name);
        }
        return names;
    }

    void addMesh(const MaterialDescription& material, std::size_t index) {
        Json attributes{{"POSITION", accessors_.at("POSITION")}};
        const std::vector<std::string> usual{"NORMAL", "TEXCOORD_0"};
        const std::vector<std::string>& names = material.attributes.empty() ? usual : material.attributes;
        for (std::size_t i = 0; i < names.size(); ++i) {
            const auto found = accessors_.find(names[i]);
            if (found == accessors_.end()) {
                fail(fmt::format("/materials/{}/attributes/{}", index, i),
                     fmt::format("no material reads an attribute \"{}\"{}", names[i],
                                 base::suggestion(names[i], attributeNames())));
                return;
            }
            attributes[names[i]] = found->second;
        }
        meshes_.push_back(
            {{"name", material.name},
             {"primitives",
              {{{"attributes", attributes}, {"indices", theSphere().indices}, {"material", index}}}}});
    }

    // Returns the JSON of an object of a material, which exists from then on.
    Json& objectOf(Json& material, int number) {
        const materials::MaterialObject& object = model_.objects[static_cast<std::size_t>(number)];
        if (object.name.empty()) {
            return material;
        }
        if (!object.isExtension) {
            return material[object.name].is_null() ? material[object.name] = Json::object()
                                                   : material[object.name];
        }
        extensions_.insert(object.name);
        Json& extension = material["extensions"][object.name];
        return extension.is_null() ? extension = Json::object() : extension;
    }

    std::string pointerOf(std::size_t index, int number, const std::string& member) const {
        const materials::MaterialObject& object = model_.objects[static_cast<std::size_t>(number)];
        return fmt::format("/materials/{}{}{}{}/{}", index, object.isExtension ? "/extensions" : "",
                           object.name.empty() ? "" : "/", object.name, member);
    }

    // Returns whether the material's base stands in place of the object.
    bool isReplaced(int object) const {
        const bool isOther = base_ >= 0 && model_.objects[static_cast<std::size_t>(base_)].replaces == object;
        const bool isBaseOfOthers =
            base_ != object && model_.objects[static_cast<std::size_t>(object)].replaces >= 0;
        return isOther || isBaseOfOthers;
    }

    void readModel(const MaterialDescription& listed, std::size_t index, Json& material) {
        base_ = -1;
        baseName_ = listed.model.empty() ? model_.plainBase : listed.model;
        if (baseName_ == model_.plainBase) {
            return;
        }
        const auto isBase = [](const materials::Feature& feature) {
            return feature.stage == materials::Stage::Base && feature.object >= 0;
        };
        const int found = model_.findFeature(baseName_);
        if (found < 0 || !isBase(model_.features[static_cast<std::size_t>(found)])) {
            std::vector<std::string> names{model_.plainBase};
            for (const materials::Feature& feature : model_.features) {
                if (isBase(feature)) {
                    names.push_back(feature.name);
                }
            }
            fail(fmt::format("/materials/{}/model", index),
                 fmt::format("no declaration of a base is called \"{}\"{}", baseName_,
                             base::suggestion(baseName_, names)));
            return;
        }
        base_ = model_.features[static_cast<std::size_t>(found)].object;
        objectOf(material, base_);
    }

    void readFeatures(const MaterialDescription& listed, std::size_t index, Json& material) {
        for (std::size_t i = 0; i < listed.features.size(); ++i) {
            const int found = model_.findFeature(listed.features[i]);
            const int object = found < 0 ? -1 : model_.features[static_cast<std::size_t>(found)].object;
            if (object < 0) {
                std::vector<std::string> names;
                for (const materials::Feature& feature : model_.features) {
                    if (feature.object >= 0) {
                        names.push_back(feature.name);
                    }
                }
                fail(fmt::format("/materials/{}/features/{}", index, i),
                     fmt::format("no feature that a material can ask for is called \"{}\"{}",
                                 listed.features[i], base::suggestion(listed.features[i], names)));
                return;
            }
            if (model_.objects[static_cast<std::size_t>(object)].replaces >= 0) {
                fail(fmt::format("/materials/{}/features/{}", index, i),
                     fmt::format("{} is a base: name it as the material's \"model\"", listed.features[i]));
                return;
            }
            objectOf(material, object);
        }
    }

    // Returns how well a thing of the object fits a name in a list: 2 if it is of the material's model, 1 if
    // materials with that model may have it, 0 if it is of another base.
    int fitOf(int object) const {
        return object == base_ && base_ >= 0 ? 2 : isReplaced(object) ? 0 : 1;
    }

    // By name and object; thousands of models may have the same names.
    template <typename Row>
    using Rows = std::multimap<std::pair<std::string_view, int>, const Row*>;

    // Returns the row of that name that fits best, the first of several, or null. Names of a model stand
    // before those that all models share.
    template <typename Row>
    const Row* bestOf(const Rows<Row>& rows, std::string_view name) const {
        if (const auto own = rows.lower_bound({name, base_});
            base_ >= 0 && own != rows.end() && own->first == std::pair(name, base_)) {
            return own->second;
        }
        const Row* found = nullptr;
        for (auto row = rows.lower_bound({name, 0}); row != rows.end() && row->first.first == name; ++row) {
            const bool isBetter = found == nullptr || fitOf(row->first.second) > fitOf(found->object);
            found = isBetter ? row->second : found;
        }
        return found;
    }

    const materials::Parameter* parameterNamed(const std::string& name, const Place& place) {
        const materials::Parameter* found = bestOf(parameters_, name);
        if (found == nullptr) {
            std::vector<std::string> names;
            for (const materials::Parameter& parameter : model_.parameters) {
                names.push_back(parameter.declared);
            }
            fail(place, fmt::format("no parameter is called \"{}\"{}", name, base::suggestion(name, names)));
        } else if (fitOf(found->object) == 0) {
            fail(place,
                 fmt::format("{} is of another base: the model of the material is {}", name, baseName_));
            found = nullptr;
        }
        return found;
    }

    void readTextures(const MaterialDescription& listed, std::size_t index, Json& material) {
        for (const auto& [name, texture] : listed.textures) {
            const Place place = fmt::format("/materials/{}/textures/{}", index, name);
            const materials::MaterialTexture::Place* const found = bestOf(places_, name);
            if (found == nullptr || fitOf(found->object) == 0) {
                std::vector<std::string> names;
                for (const materials::MaterialTexture& slot : model_.textures) {
                    for (const materials::MaterialTexture::Place& one : slot.places) {
                        if (fitOf(one.object) > 0) {
                            names.push_back(one.member);
                        }
                    }
                }
                fail(place, fmt::format("no texture of such a material is called \"{}\"{}", name,
                                        base::suggestion(name, names)));
                return;
            }
            objectOf(material, found->object)[found->member] = textureInfo(texture, name, place);
            const std::string pointer = pointerOf(index, found->object, found->member);
            expanded_.places[pointer] = place;
        }
    }

    Json textureInfo(const TextureDescription& texture, const std::string& name, const Place& place) {
        Json info{{"index", textures_.size()}, {"texCoord", texture.texCoord}};
        Json transform = Json::object();
        const TextureDescription usual;
        if (texture.offset != usual.offset) {
            transform["offset"] = texture.offset;
        }
        if (texture.scale != usual.scale) {
            transform["scale"] = texture.scale;
        }
        if (texture.rotation != usual.rotation) {
            transform["rotation"] = texture.rotation;
        }
        if (!transform.empty()) {
            info["extensions"]["KHR_texture_transform"] = transform;
            extensions_.insert("KHR_texture_transform");
        }
        // Every texture has an image of its own if its texels come at run time, since others may be given to
        // each.
        const auto known = texture.file.empty() ? images_.end() : images_.find(texture.file);
        std::size_t image = imageJson_.size();
        if (known != images_.end()) {
            image = known->second;
        } else {
            expanded_.places[fmt::format("/images/{}", image)] = place;
            if (texture.file.empty()) {
                imageJson_.push_back(
                    {{"name", texture.name.empty() ? name : texture.name}, {kAtRunTime, true}});
            } else {
                images_[texture.file] = image;
                imageJson_.push_back({{"uri", texture.file}});
            }
        }
        textures_.push_back({{"source", image}});
        return info;
    }

    bool isTexture(int object, const std::string& member) const {
        return std::ranges::any_of(model_.textures, [&](const materials::MaterialTexture& texture) {
            return std::ranges::any_of(texture.places, [&](const materials::MaterialTexture::Place& place) {
                return place.object == object && place.member == member;
            });
        });
    }

    void readValues(const MaterialDescription& listed, std::size_t index, Json& material) {
        for (const auto& [name, input] : listed.values) {
            const Place place = fmt::format("/materials/{}/values/{}", index, name);
            const materials::Parameter* const parameter = parameterNamed(name, place);
            if (parameter == nullptr) {
                return;
            }
            Json value = toJson<Json>(input);
            if (value.is_array() && value.size() == 1 && !parameter->isArray() && parameter->numbers == 1) {
                value = Json(value[0]);
            }
            std::vector<double> numbers;
            if (const auto fault = materials::readValue(*parameter, value, numbers)) {
                fail(place + fault->place, fault->message);
                return;
            }
            Json* target = &objectOf(material, parameter->object);
            expanded_.places[pointerOf(index, parameter->object, parameter->place)] = place;
            std::string_view rest = parameter->place;
            for (std::size_t slash = rest.find('/'); slash != std::string_view::npos;
                 slash = rest.find('/')) {
                const std::string member(rest.substr(0, slash));
                if (isTexture(parameter->object, member) && !target->contains(member)) {
                    fail(place, fmt::format("changes nothing without the texture {}", member));
                    return;
                }
                target = &(*target)[member];
                rest.remove_prefix(slash + 1);
            }
            (*target)[std::string(rest)] = std::move(value);
        }
    }

    void readEdited(const MaterialDescription& listed, std::size_t index, Json& material) {
        for (std::size_t i = 0; i < listed.edited.size(); ++i) {
            const EditedParameter& edited = listed.edited[i];
            const Place place = fmt::format("/materials/{}/edited/{}", index, i);
            const materials::Parameter* const parameter = parameterNamed(edited.parameter, place);
            if (parameter == nullptr) {
                return;
            }
            if (edited.range && !parameter->type->hasRange()) {
                fail(place + "/range", fmt::format("is for numbers; {} has the type {}", edited.parameter,
                                                   parameter->typeText()));
                return;
            }
            const materials::ValueInterval whole =
                parameter->isAngle ? materials::ValueInterval{-std::numbers::pi, std::numbers::pi}
                                   : materials::ValueInterval{parameter->hold(parameter->low),
                                                              parameter->hold(parameter->high)};
            materials::ValueInterval range = whole;
            if (edited.range) {
                range = {(*edited.range)[0], (*edited.range)[1]};
                const bool isWhole =
                    range.low == std::trunc(range.low) && range.high == std::trunc(range.high);
                if (parameter->type->kind != materials::NumberKind::Real && !isWhole) {
                    fail(place, fmt::format("{} to {} is no range of whole numbers", range.low, range.high));
                    return;
                }
                if (!(whole.low <= range.low && range.low <= range.high && range.high <= whole.high)) {
                    fail(place, fmt::format("{} to {} is no range within that of {}, which is {} to {}",
                                            range.low, range.high, edited.parameter, whole.low, whole.high));
                    return;
                }
            }
            objectOf(material, parameter->object);
            expanded_.edited.push_back({static_cast<int>(index),
                                        static_cast<int>(parameter - model_.parameters.data()), range,
                                        place});
        }
    }

    void addMaterial(const MaterialDescription& listed, std::size_t index) {
        Json material{{"name", listed.name},
                      {"alphaMode", kAlphaModes[static_cast<std::size_t>(listed.alphaMode)]},
                      {"doubleSided", listed.doubleSided}};
        readModel(listed, index, material);
        readFeatures(listed, index, material);
        readTextures(listed, index, material);
        readValues(listed, index, material);
        readEdited(listed, index, material);
        addMesh(listed, index);
        materials_.push_back(std::move(material));
        for (const char* const made : {"/meshes/{}/primitives/0", "/meshes/{}", "/nodes/{}"}) {
            expanded_.places[fmt::format(fmt::runtime(made), index)] = fmt::format("/materials/{}", index);
        }
    }

    // The engine brings the lights; one here stands for them in the choice of effects, and in pictures.
    void addLight() {
        constexpr const char* kLights = "KHR_lights_punctual";
        extensions_.insert(kLights);
        expanded_.document["extensions"][kLights]["lights"] = {{{"type", "directional"}, {"intensity", 3.0}}};
        shown_.push_back(nodes_.size());
        nodes_.push_back({{"name", "light"},
                          {"rotation", {-0.5, 0.2, 0.1, std::sqrt(0.7)}},
                          {"extensions", {{kLights, {{"light", 0}}}}}});
    }

    void finish() {
        addLight();
        Json& document = expanded_.document;
        document.update({{"asset", {{"version", "2.0"}, {"generator", "glint"}}},
                         {"extensionsUsed", Json(extensions_)},
                         {"scene", 0},
                         {"scenes", {{{"nodes", shown_}}}},
                         {"nodes", nodes_},
                         {"meshes", meshes_},
                         {"materials", materials_},
                         {"accessors", theSphere().arrays.accessors()},
                         {"bufferViews", theSphere().arrays.views()}});
        if (!textures_.empty()) {
            document["textures"] = textures_;
            document["images"] = imageJson_;
        }
        expanded_.buffer = theSphere().arrays.bytes();
        document["buffers"] = {{{"byteLength", expanded_.buffer.size()}}};
    }

    const MaterialModel& model_;
    base::JsonReader& reader_;
    ExpandedMaterials expanded_;
    std::map<std::string, int> accessors_;  // of the sphere, by attribute
    int base_ = -1;                         // the object of the material's model, or -1
    std::string baseName_;
    Rows<materials::Parameter> parameters_;           // by declared name
    Rows<materials::MaterialTexture::Place> places_;  // by member
    std::set<std::string> extensions_;
    std::map<std::string, std::size_t> images_;  // by file
    Json imageJson_ = Json::array();
    Json textures_ = Json::array();
    Json materials_ = Json::array();
    Json meshes_ = Json::array();
    Json nodes_ = Json::array();
    Json shown_ = Json::array();
};

}  // namespace

Result<ExpandedMaterials> expandMaterials(const MaterialSet& set, const MaterialModel& model) {
    base::JsonReader reader = materialListReader(set.path);
    ExpandedMaterials expanded = Expander(model, reader).expand(set);
    return reader.ok() ? Result<ExpandedMaterials>(std::move(expanded)) : reader.error();
}

}  // namespace glint::gltf
