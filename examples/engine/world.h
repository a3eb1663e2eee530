// The engine's own scene: quantised, interleaved vertices, its instances, textures and lights.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace engine {

// How vertices are stored. shaders/engine.glsl has the same two.
enum class Format : std::uint32_t {
    Full,     // floats, 72 bytes a vertex; indices of 32 bits
    Compact,  // 28 bytes a vertex: positions of 16 bits, octahedral normals, half UVs; indices of 16 bits
};

// Full vertices, as files bring them.
struct Vertex {
    std::array<float, 3> position{};
    std::array<float, 3> normal{};
    std::array<float, 4> tangent{};
    std::array<float, 2> uv0{};
    std::array<float, 2> uv1{};
    std::array<float, 4> color{1, 1, 1, 1};
};
static_assert(sizeof(Vertex) == 72);

struct Geometry {
    std::uint32_t mesh = 0;  // the numbers by which a package knows it
    std::uint32_t primitive = 0;
    std::vector<std::uint8_t> vertices;
    std::vector<std::uint8_t> indices;
    std::uint32_t vertexCount = 0;
    std::uint32_t indexCount = 0;
};

struct Mesh {
    std::vector<Geometry> geometries;
    // The map of stored positions into the mesh's space: a scale, then an offset.
    float scale = 1.0F;
    std::array<float, 3> offset{};
};

struct Instance {
    std::uint32_t mesh = 0;
    std::array<float, 12> objectToWorld{};  // of the mesh's space
};

struct Texture {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<std::uint8_t> rgba8;
};

struct Sun {
    std::array<float, 3> direction{};  // along which the light travels
    std::array<float, 3> lux{};
};

struct Camera {
    std::array<float, 3> position{};
    std::array<float, 3> forward{};
    std::array<float, 3> up{};
    float halfWidth = 0.0F;  // of the image plane at distance 1
    float halfHeight = 0.0F;
    float near = 0.01F;
};

struct World {
    Format format = Format::Full;
    std::vector<Mesh> meshes;
    std::vector<Instance> instances;
    std::vector<Texture> textures;
    std::vector<Sun> suns;
    Camera camera;
};

constexpr std::uint32_t vertexBytes(Format format) {
    return format == Format::Full ? 72 : 28;
}

// Stores vertices in a format. Adds to the mesh, whose scale and offset must hold all its positions.
void addGeometry(World& world, Mesh& mesh, std::uint32_t meshNumber, std::uint32_t primitive,
                 std::span<const Vertex> vertices, std::span<const std::uint32_t> indices);

// Returns the transform of an instance from stored positions.
std::array<float, 12> storedToWorld(const World& world, const Instance& instance);

// Reads a glTF file. Errors end the program.
World readGltf(const std::string& file, Format format, float aspect);

}  // namespace engine
