#include "gltf_writer.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <future>
#include <set>
#include <span>
#include <system_error>

namespace gallery {

namespace {

// These values are from the glTF specification.
constexpr int kArrayBuffer = 34962;
constexpr int kElementArrayBuffer = 34963;
constexpr int kUnsignedByte = 5121;
constexpr int kUnsignedShort = 5123;
constexpr int kUnsignedInt = 5125;
constexpr int kFloat = 5126;

const char* typeName(int components) {
    static constexpr std::array<const char*, 4> kNames{"SCALAR", "VEC2", "VEC3", "VEC4"};
    return kNames.at(static_cast<std::size_t>(components - 1));
}

template <typename Vector>
std::vector<float> flatten(const std::vector<Vector>& vectors, int components) {
    std::vector<float> values;
    values.reserve(vectors.size() * static_cast<std::size_t>(components));
    for (const Vector& vector : vectors) {
        for (int component = 0; component < components; ++component) {
            values.push_back(vector[component]);
        }
    }
    return values;
}

template <typename Integer>
std::vector<Integer> normalize(const std::vector<float>& values, float maximum) {
    std::vector<Integer> result;
    result.reserve(values.size());
    for (const float value : values) {
        result.push_back(static_cast<Integer>(std::lround(glm::clamp(value, 0.0F, 1.0F) * maximum)));
    }
    return result;
}

// Collects every key under an "extensions" object.
void collectExtensions(const Json& json, std::set<std::string>& names) {
    for (const auto& [key, value] : json.items()) {
        if (json.is_object() && key == "extensions") {
            for (const auto& extension : value.items()) {
                names.insert(extension.key());
            }
        }
        if (value.is_structured()) {
            collectExtensions(value, names);
        }
    }
}

Json placementJson(const Placement& placement) {
    Json json = Json::object();
    if (placement.translation != glm::vec3(0.0F)) {
        json["translation"] = {placement.translation.x, placement.translation.y, placement.translation.z};
    }
    if (placement.rotation != glm::quat(1.0F, 0.0F, 0.0F, 0.0F)) {
        const glm::quat& q = placement.rotation;
        json["rotation"] = {q.x, q.y, q.z, q.w};
    }
    if (placement.scale != glm::vec3(1.0F)) {
        json["scale"] = {placement.scale.x, placement.scale.y, placement.scale.z};
    }
    return json;
}

}  // namespace

int GltfWriter::addTexture(const std::string& name, Image image) {
    images_.push_back({name + ".png", std::move(image)});
    return static_cast<int>(images_.size()) - 1;
}

int GltfWriter::addMaterial(const MaterialSpec& material) {
    materials_.push_back(toJson(material));
    return static_cast<int>(materials_.size()) - 1;
}

int GltfWriter::addAccessor(const void* data, std::size_t bytes, int target, Json accessor) {
    // Every view starts at a multiple of four bytes, because the widest component needs that.
    binary_.resize((binary_.size() + 3) / 4 * 4);
    accessor["bufferView"] = bufferViews_.size();
    bufferViews_.push_back(
        {{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", bytes}, {"target", target}});
    const auto* begin = static_cast<const std::uint8_t*>(data);
    binary_.insert(binary_.end(), begin, begin + bytes);
    accessors_.push_back(std::move(accessor));
    return static_cast<int>(accessors_.size()) - 1;
}

int GltfWriter::addFloats(const std::vector<float>& values, int components, bool bounds) {
    const auto stride = static_cast<std::size_t>(components);
    Json accessor = {
        {"componentType", kFloat}, {"count", values.size() / stride}, {"type", typeName(components)}};
    if (bounds) {
        std::vector<float> low(values.begin(), values.begin() + components);
        std::vector<float> high = low;
        for (std::size_t index = 0; index < values.size(); ++index) {
            low[index % stride] = std::min(low[index % stride], values[index]);
            high[index % stride] = std::max(high[index % stride], values[index]);
        }
        accessor["min"] = low;
        accessor["max"] = high;
    }
    return addAccessor(values.data(), values.size() * sizeof(float), kArrayBuffer, std::move(accessor));
}

int GltfWriter::addIndices(const std::vector<std::uint32_t>& indices, std::size_t vertexCount) {
    Json accessor = {{"componentType", kUnsignedInt}, {"count", indices.size()}, {"type", "SCALAR"}};
    // The index 65535 is reserved for primitive restart.
    if (vertexCount > 65535) {
        return addAccessor(indices.data(), indices.size() * 4, kElementArrayBuffer, std::move(accessor));
    }
    accessor["componentType"] = kUnsignedShort;
    const std::vector<std::uint16_t> narrow(indices.begin(), indices.end());
    return addAccessor(narrow.data(), narrow.size() * 2, kElementArrayBuffer, std::move(accessor));
}

int GltfWriter::addGeometry(const MeshData& mesh, unsigned attributes) {
    Json json = Json::object();
    json["POSITION"] = addFloats(flatten(mesh.positions, 3), 3, true);
    if ((attributes & kNormals) != 0) {
        json["NORMAL"] = addFloats(flatten(mesh.normals, 3), 3, false);
    }
    if ((attributes & kTangents) != 0) {
        json["TANGENT"] = addFloats(flatten(mesh.tangents, 4), 4, false);
    }
    if ((attributes & kTexCoord0) != 0) {
        json["TEXCOORD_0"] = addFloats(flatten(mesh.texCoords0, 2), 2, false);
    }
    const std::size_t count = mesh.positions.size();
    if ((attributes & kTexCoord1) != 0) {
        const auto values = normalize<std::uint16_t>(flatten(mesh.texCoords1, 2), 65535.0F);
        json["TEXCOORD_1"] = addAccessor(
            values.data(), values.size() * 2, kArrayBuffer,
            {{"componentType", kUnsignedShort}, {"normalized", true}, {"count", count}, {"type", "VEC2"}});
    }
    if ((attributes & kColorsByte4) != 0) {
        const auto values = normalize<std::uint8_t>(flatten(mesh.colors, 4), 255.0F);
        json["COLOR_0"] = addAccessor(
            values.data(), values.size(), kArrayBuffer,
            {{"componentType", kUnsignedByte}, {"normalized", true}, {"count", count}, {"type", "VEC4"}});
    }
    if ((attributes & kColorsFloat3) != 0) {
        json["COLOR_0"] = addFloats(flatten(mesh.colors, 3), 3, false);
    }
    geometries_.push_back({{"attributes", json}, {"indices", addIndices(mesh.indices, count)}});
    return static_cast<int>(geometries_.size()) - 1;
}

int GltfWriter::addVariant(const std::string& name) {
    variants_.push_back({{"name", name}});
    return static_cast<int>(variants_.size()) - 1;
}

int GltfWriter::addMesh(const std::string& name, const std::vector<Part>& parts) {
    Json primitives = Json::array();
    for (const Part& part : parts) {
        Json primitive = geometries_.at(static_cast<std::size_t>(part.geometry));
        primitive["material"] = part.material;
        for (const VariantMaterial& variant : part.variants) {
            primitive["extensions"]["KHR_materials_variants"]["mappings"].push_back(
                {{"material", variant.material}, {"variants", {variant.variant}}});
        }
        primitives.push_back(std::move(primitive));
    }
    meshes_.push_back({{"name", name}, {"primitives", std::move(primitives)}});
    return static_cast<int>(meshes_.size()) - 1;
}

void GltfWriter::addNode(const std::string& name, const Placement& placement, const Json& node) {
    Json json = {{"name", name}};
    json.update(node);
    json.update(placementJson(placement));
    nodes_.push_back(std::move(json));
}

void GltfWriter::addMeshNode(const std::string& name, int mesh, const Placement& placement) {
    addNode(name, placement, {{"mesh", mesh}});
}

void GltfWriter::addLightNode(const LightSpec& light, const Placement& placement) {
    Json json = {
        {"name", light.name}, {"type", light.type}, {"color", light.color}, {"intensity", light.intensity}};
    if (light.coneAngles) {
        json["spot"] = {{"innerConeAngle", (*light.coneAngles)[0]},
                        {"outerConeAngle", (*light.coneAngles)[1]}};
    }
    Json node = Json::object();
    node["extensions"]["KHR_lights_punctual"]["light"] = lights_.size();
    lights_.push_back(std::move(json));
    addNode(light.name, placement, node);
}

void GltfWriter::addCameraNode(const std::string& name, double yfov, const Placement& placement) {
    const Json perspective = {{"aspectRatio", 16.0 / 9.0}, {"yfov", yfov}, {"znear", 0.05}};
    addNode(name, placement, {{"camera", cameras_.size()}});
    cameras_.push_back({{"name", name}, {"type", "perspective"}, {"perspective", perspective}});
}

Json GltfWriter::document(const std::string& name) const {
    Json json = Json::object();
    json["asset"] = {{"version", "2.0"}, {"generator", "Glint gallery"}};
    json["extensionsUsed"] = Json::array();
    json["extensions"]["KHR_lights_punctual"]["lights"] = lights_;
    if (!variants_.empty()) {
        json["extensions"]["KHR_materials_variants"]["variants"] = variants_;
    }
    json["scene"] = 0;
    Json roots = Json::array();
    for (std::size_t node = 0; node < nodes_.size(); ++node) {
        roots.push_back(node);
    }
    json["scenes"] = Json::array({{{"name", name}, {"nodes", roots}}});
    json["nodes"] = nodes_;
    json["cameras"] = cameras_;
    json["meshes"] = meshes_;
    json["materials"] = materials_;
    json["textures"] = Json::array();
    json["samplers"] =
        Json::array({{{"magFilter", 9729}, {"minFilter", 9987}, {"wrapS", 10497}, {"wrapT", 10497}}});
    json["images"] = Json::array();
    for (std::size_t index = 0; index < images_.size(); ++index) {
        json["textures"].push_back({{"sampler", 0}, {"source", index}});
        json["images"].push_back({{"uri", images_[index].uri}});
    }
    json["accessors"] = accessors_;
    json["bufferViews"] = bufferViews_;
    json["buffers"] = Json::array({{{"uri", name + ".bin"}, {"byteLength", binary_.size()}}});
    std::set<std::string> extensions;
    collectExtensions(json, extensions);
    json["extensionsUsed"] = extensions;
    return json;
}

glint::Status writeBytes(const std::filesystem::path& path, std::span<const std::uint8_t> bytes) {
    std::ofstream file(path, std::ios::binary | std::ios::trunc);
    file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    file.close();
    if (!file) {
        return glint::makeError("gallery-write", path.string(), "cannot write the file",
                                "check that the folder can be written to and has space left");
    }
    return glint::okStatus();
}

glint::Status GltfWriter::write(const std::filesystem::path& folder, const std::string& name) const {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) {
        return glint::makeError("gallery-write", folder.string(),
                                "cannot make the folder: " + error.message(),
                                "name a folder that can be made");
    }
    // Compression takes most of the time, so each image is a task of its own.
    std::vector<std::future<glint::Status>> tasks;
    for (const NamedImage& image : images_) {
        tasks.push_back(std::async(std::launch::async, [&image, &folder]() -> glint::Status {
            const auto png = encodePng(image.image);
            return png.ok() ? writeBytes(folder / image.uri, *png) : png.error();
        }));
    }
    glint::Status result = glint::okStatus();
    for (std::future<glint::Status>& task : tasks) {
        if (auto status = task.get(); !status.ok() && result.ok()) {
            result = status;
        }
    }
    if (!result.ok()) {
        return result;
    }
    if (auto status = writeBytes(folder / (name + ".bin"), binary_); !status.ok()) {
        return status;
    }
    const std::string text = document(name).dump(2) + "\n";
    const auto* begin = reinterpret_cast<const std::uint8_t*>(text.data());
    return writeBytes(folder / (name + ".gltf"), {begin, text.size()});
}

}  // namespace gallery
