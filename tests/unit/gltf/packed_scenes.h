// Compressed scenes, made by the encoders of the libraries that the importer decodes with.
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

// Unique identifiers of the attributes in encodeDraco()'s data.
inline constexpr std::uint32_t kDracoPosition = 0;
inline constexpr std::uint32_t kDracoNormal = 1;
inline constexpr std::uint32_t kDracoTexCoord = 2;

// Lossless, and with metadata. The sequential method keeps the order of points.
Bytes encodeDraco(const Grid& grid, DracoMethod method);

// The grid with KHR_draco_mesh_compression; accessors have no buffer views.
GltfBuilder dracoScene(DracoMethod method);

// Where packed views pretend to be: a buffer of that many bytes with no data.
void addFallbackBuffer(GltfBuilder& builder, std::size_t bytes);

// Appends a buffer view packed by EXT_meshopt_compression, into the fallback buffer; returns its index.
int addPackedView(GltfBuilder& builder, const Bytes& packed, std::size_t count, std::size_t stride,
                  const std::string& mode, const std::string& filter = "NONE");

Bytes packVertices(const void* vertices, std::size_t count, std::size_t stride);

// The grid with EXT_meshopt_compression: positions plain, normals octahedral in 8 bits, UVs exponential,
// indices as triangles.
GltfBuilder meshoptScene();

// Lossless; four bytes a pixel.
Bytes encodeWebp(const Bytes& rgba8, int width, int height);

// A material whose base colour is a WebP image in a buffer view, 2 x 1 pixels: kWebpPixels.
GltfBuilder webpScene();
inline constexpr std::array<std::uint8_t, 8> kWebpPixels{250, 10, 20, 255, 1, 2, 3, 128};

}  // namespace glint::test
