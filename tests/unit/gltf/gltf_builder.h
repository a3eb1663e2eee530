// Builds small glTF files for tests, and a folder for them.
#pragma once

#include "base/files.h"
#include "gltf/import.h"
#include "support/temporary_folder.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace glint::test {

using Json = nlohmann::json;

// Returns glTF's number of a component type.
template <typename T>
constexpr int componentTypeOf() {
    if constexpr (std::is_same_v<T, std::int8_t>) {
        return 5120;
    } else if constexpr (std::is_same_v<T, std::uint8_t>) {
        return 5121;
    } else if constexpr (std::is_same_v<T, std::int16_t>) {
        return 5122;
    } else if constexpr (std::is_same_v<T, std::uint16_t>) {
        return 5123;
    } else if constexpr (std::is_same_v<T, std::uint32_t>) {
        return 5125;
    } else {
        return 5126;
    }
}

// A glTF document under construction. `root` may be changed freely; accessors extend the buffer.
class GltfBuilder {
public:
    GltfBuilder();

    // Appends raw bytes as a buffer view. Returns its index.
    int addView(const void* bytes, std::size_t size, std::size_t stride = 0);

    // Appends an accessor with `components` values for each element (1 to 4, or more for matrices). Returns
    // its index.
    template <typename T>
    int addAccessor(const std::vector<T>& values, int components, bool normalized = false) {
        const int view = addView(values.data(), values.size() * sizeof(T));
        Json accessor{{"bufferView", view},
                      {"componentType", componentTypeOf<T>()},
                      {"count", values.size() / static_cast<std::size_t>(components)},
                      {"type", typeName(components)}};
        if (normalized) {
            accessor["normalized"] = true;
        }
        addBounds(values, components, accessor);
        return append("accessors", std::move(accessor));
    }

    // Appends to the array of that name. Returns the index.
    int append(const std::string& array, Json value);
    // Appends a mesh with one primitive, and a node that draws it. Returns the primitive.
    Json& addMesh(Json primitive);
    // Adds a triangle (0,0,0) (1,0,0) (0,1,0) that is drawn; it has POSITION only.
    Json& addTriangle();

    // Returns the document with its buffer as a data URI.
    std::string text() const;
    // Returns the document as a GLB.
    std::string glb() const;

    // Returns the buffers of the document. The first holds `buffer`, as a data URI or as the chunk of a GLB.
    Json buffers(bool embedded) const;

    Json root;
    base::Bytes buffer;
    std::vector<Json> otherBuffers;  // after the first

private:
    static const char* typeName(int components);

    // glTF demands bounds of positions and of the times of keyframes, and allows them everywhere.
    template <typename T>
    static void addBounds(const std::vector<T>& values, int components, Json& accessor) {
        const auto width = static_cast<std::size_t>(components);
        if (components > 4 || values.size() < width) {
            return;
        }
        std::vector<T> least(width);
        std::vector<T> greatest(width);
        for (std::size_t i = 0; i < values.size(); ++i) {
            if (std::isfinite(static_cast<double>(values[i]))) {
                const bool isFirst = i < width;
                T& low = least[i % width];
                T& high = greatest[i % width];
                low = isFirst ? values[i] : std::min(low, values[i]);
                high = isFirst ? values[i] : std::max(high, values[i]);
            }
        }
        accessor["min"] = least;
        accessor["max"] = greatest;
    }
    // Returns the root, in which extensionsUsed has all extensions of materials, nodes and so on, unless the
    // test gives that list.
    Json document() const;
};

// Returns a four-byte little-endian number, as in GLB headers.
std::string word(std::uint32_t value);
// Returns a GLB chunk, padded to four bytes.
std::string chunk(std::uint32_t type, std::string payload, char padding);

std::string base64(const base::Bytes& bytes);

// Writes `text` to a file in a new folder and imports it.
Result<gltf::Scene> importText(const std::string& text, const gltf::ImportOptions& options = {});
Result<gltf::Scene> import(const GltfBuilder& builder, const gltf::ImportOptions& options = {});
gltf::Scene mustImport(const GltfBuilder& builder, const gltf::ImportOptions& options = {});

// A material whose base colour is the image of those bytes.
GltfBuilder sceneWithImage(const base::Bytes& bytes, const std::string& mimeType = "image/png");

// Returns all but those of pictures that lack something. Files that only show how they are read draw nothing,
// or have no UVs.
std::vector<Diagnostic> readingWarnings(const gltf::Scene& scene);
// Warnings of that kind.
std::size_t countWarnings(const gltf::Scene& scene, std::string_view id);
// Returns the first warning of that kind; an empty one if there is none.
Diagnostic findWarning(const gltf::Scene& scene, std::string_view id);

// A PNG of 1 x 2 pixels of 8 bits, RGBA: (255, 0, 128, 64) above (1, 2, 3, 4).
inline constexpr const char* kPng8 =
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAACCAYAAACZgbYnAAAAEklEQVR4nGP4z9DgwMDIxMwCAA4VAcozrSjMAAAAAElFTkSuQmCC";
// A PNG that claims 16000 x 16000 pixels and contains none of them.
inline constexpr const char* kPngBomb =
    "iVBORw0KGgoAAAANSUhEUgAAPoAAAD6ACAYAAABBft/eAAAACUlEQVR4nGMAAAABAAFe/335AAAAAElFTkSuQmCC";

}  // namespace glint::test
