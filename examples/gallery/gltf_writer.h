// Builds a glTF 2.0 scene: one .gltf, one .bin, PNG textures.
#pragma once

#include "image.h"
#include "mesh.h"

#include <glint/result.h>

#include <glm/gtc/quaternion.hpp>
#include <nlohmann/json.hpp>

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace gallery {

inline constexpr double kQuarterTurn = 1.5707963267948966;

using Json = nlohmann::ordered_json;

// KHR_texture_transform. It is written whenever it is present, even if it is the identity.
struct TextureTransform {
    std::array<double, 2> offset{0.0, 0.0};
    double rotation = 0.0;  // radians, counter-clockwise
    std::array<double, 2> scale{1.0, 1.0};
};

struct TextureUse {
    int texture = -1;  // from GltfWriter::addTexture(); -1 for none
    int texCoord = 0;
    std::optional<TextureTransform> transform = std::nullopt;
    double amount = 1.0;  // scale of a normal texture, strength of an occlusion texture
};

// A material extension, with the names that it has in the file.
struct ExtensionSpec {
    std::string name;
    std::vector<std::pair<std::string, Json>> values = {};
    std::vector<std::pair<std::string, TextureUse>> textures = {};
};

// Values that differ from glTF's defaults are written. Optional members are written whenever they have a
// value.
struct MaterialSpec {
    std::string name = {};
    std::array<double, 4> baseColor{1.0, 1.0, 1.0, 1.0};  // linear
    double metallic = 1.0;
    double roughness = 1.0;
    std::array<double, 3> emissive{0.0, 0.0, 0.0};
    std::optional<double> emissiveStrength = std::nullopt;
    TextureUse baseColorTexture = {};
    TextureUse metallicRoughnessTexture = {};
    TextureUse normalTexture = {};
    TextureUse occlusionTexture = {};
    TextureUse emissiveTexture = {};
    std::string alphaMode = "OPAQUE";
    bool doubleSided = false;
    bool unlit = false;
    std::vector<ExtensionSpec> extensions = {};
};

// The attributes of a MeshData that are written besides positions.
enum Attribute : unsigned {
    kNormals = 1,
    kTangents = 2,
    kTexCoord0 = 4,
    kTexCoord1 = 8,      // 16-bit, normalised
    kColorsByte4 = 16,   // RGBA, 8-bit, normalised
    kColorsFloat3 = 32,  // RGB, float
};

struct Placement {
    glm::vec3 translation{0.0F};
    glm::quat rotation{1.0F, 0.0F, 0.0F, 0.0F};
    glm::vec3 scale{1.0F};
};

struct LightSpec {
    std::string name;
    std::string type;  // "directional", "point", "spot"
    std::array<double, 3> color{1.0, 1.0, 1.0};
    double intensity = 1.0;                                          // lux or candela
    std::optional<std::array<double, 2>> coneAngles = std::nullopt;  // inner, outer; radians
};

// Errors: "gallery-write".
glint::Status writeBytes(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);

// Every add function returns the index that later calls refer to.
class GltfWriter {
public:
    int addTexture(const std::string& name, Image image);
    int addMaterial(const MaterialSpec& material);
    // Writes the geometry once, so that meshes can share it.
    int addGeometry(const MeshData& mesh, unsigned attributes);

    // Names a variant of the scene (KHR_materials_variants).
    int addVariant(const std::string& name);

    struct VariantMaterial {
        int variant;
        int material;
    };
    struct Part {
        int geometry;
        int material;
        std::vector<VariantMaterial> variants = {};
    };
    int addMesh(const std::string& name, const std::vector<Part>& parts);

    void addMeshNode(const std::string& name, int mesh, const Placement& placement);
    void addLightNode(const LightSpec& light, const Placement& placement);
    void addCameraNode(const std::string& name, double yfov, const Placement& placement);

    // Writes NAME.gltf, NAME.bin and the images into `folder`, which is created. Errors: "gallery-write".
    glint::Status write(const std::filesystem::path& folder, const std::string& name) const;

private:
    int addAccessor(const void* data, std::size_t bytes, int target, Json accessor);
    int addFloats(const std::vector<float>& values, int components, bool bounds);
    int addIndices(const std::vector<std::uint32_t>& indices, std::size_t vertexCount);
    void addNode(const std::string& name, const Placement& placement, const Json& node);
    Json document(const std::string& name) const;

    struct NamedImage {
        std::string uri;
        Image image;
    };
    std::vector<NamedImage> images_;
    std::vector<std::uint8_t> binary_;
    Json materials_ = Json::array();
    Json accessors_ = Json::array();
    Json bufferViews_ = Json::array();
    Json geometries_ = Json::array();  // primitives without their material
    Json meshes_ = Json::array();
    Json nodes_ = Json::array();
    Json lights_ = Json::array();
    Json cameras_ = Json::array();
    Json variants_ = Json::array();
};

// The JSON of a material.
Json toJson(const MaterialSpec& material);

}  // namespace gallery
