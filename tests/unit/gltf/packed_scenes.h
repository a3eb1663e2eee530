// Makes compressed scenes with the encoders of the libraries that the importer uses to decode.
#pragma once

#include "unit/gltf/gltf_builder.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace glint::test {

// A square of kGridCells x kGridCells cells in the plane z = 0: position (x, y, 0) for whole x and y, normal
// +Z, UV (x, y) / kGridCells.
inline constexpr std::uint32_t kGridCells = 4;
struct Grid {
    std::vector<std::array<float, 3>> positions;
    std::vector<std::array<float, 3>> normals;
    std::vector<std::array<std::uint16_t, 2>> texCoords;  // normalised
    std::vector<std::uint32_t> indices;
};
Grid makeGrid();

enum class DracoMethod : std::uint8_t { Sequential, Edgebreaker };

// The unique identifiers of the attributes in encodeDraco()'s data.
inline constexpr std::uint32_t kDracoPosition = 0;
inline constexpr std::uint32_t kDracoNormal = 1;
inline constexpr std::uint32_t kDracoTexCoord = 2;

// Encodes without loss, and with metadata. The sequential method keeps the order of points.
base::Bytes encodeDraco(const Grid& grid, DracoMethod method);

// Returns the grid with KHR_draco_mesh_compression. Its accessors have no buffer views.
GltfBuilder dracoScene(DracoMethod method);

// Adds the buffer that packed views refer to: it has that many bytes, but no data.
void addFallbackBuffer(GltfBuilder& builder, std::size_t bytes);

// Appends a buffer view packed by EXT_meshopt_compression into the fallback buffer. Returns its index.
int addPackedView(GltfBuilder& builder, const base::Bytes& packed, std::size_t count, std::size_t stride,
                  const std::string& mode, const std::string& filter = "NONE");

base::Bytes packVertices(const void* vertices, std::size_t count, std::size_t stride);
// Packs by version 1 of the codec, which the library of Debian 12 does not write: with every mode of
// channels, control and groups, where the data allow it.
base::Bytes packVerticesV1(const void* vertices, std::size_t count, std::size_t stride);

// Returns the grid with EXT_meshopt_compression: plain positions, octahedral normals in 8 bits, exponential
// UVs, indices as triangles.
GltfBuilder meshoptScene();

// Returns triangles with KHR_meshopt_compression's version 1: the vertices of meshoptVertices(), in two
// blocks.
struct MeshoptVertex {
    gltf::Float3 position;
    gltf::Float2 texCoord0;
    gltf::Float2 texCoord1;
};
std::vector<MeshoptVertex> meshoptVertices();
GltfBuilder meshoptV1Scene();

// Encodes without loss; the input has four bytes for each pixel.
base::Bytes encodeWebp(const base::Bytes& rgba8, int width, int height);

// Returns a material whose base colour is a WebP image in a buffer view, 2 x 1 pixels: kWebpPixels.
GltfBuilder webpScene();
inline constexpr std::array<std::uint8_t, 8> kWebpPixels{250, 10, 20, 255, 1, 2, 3, 128};

}  // namespace glint::test
