#include "oracle/scene/texels.h"

#include "base/files.h"
#include "image/image_file.h"

#include <cstring>

namespace glint::oracle {
namespace {

constexpr std::uint32_t kSide = 16;

// Two triangles of corners (position, UV). The camera looks along -Z, and texels are not filtered.
constexpr std::string_view kScene = R"({
  "asset": {"version": "2.0"},
  "extensionsUsed": ["KHR_materials_unlit"],
  "scene": 0,
  "scenes": [{"nodes": [0, 1]}],
  "nodes": [{"mesh": 0}, {"camera": 0, "translation": [0, 0, 1]}],
  "cameras": [{"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 1, "znear": 0.1, "zfar": 2}}],
  "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "material": 0}]}],
  "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}},
                 "extensions": {"KHR_materials_unlit": {}}}],
  "textures": [{"source": 0, "sampler": 0}],
  "samplers": [{"magFilter": 9728, "minFilter": 9728}],
  "images": [{"uri": "texels.png"}],
  "accessors": [
    {"bufferView": 0, "componentType": 5126, "count": 6, "type": "VEC3", "min": [-1, -1, 0], "max": [1, 1, 0]},
    {"bufferView": 0, "byteOffset": 12, "componentType": 5126, "count": 6, "type": "VEC2"}],
  "bufferViews": [{"buffer": 0, "byteLength": 120, "byteStride": 20}],
  "buffers": [{"uri": "texels.bin", "byteLength": 120}]
}
)";

constexpr float kCorners[6][5] = {{-1, -1, 0, 0, 1}, {1, -1, 0, 1, 1}, {1, 1, 0, 1, 0},
                                  {-1, -1, 0, 0, 1}, {1, 1, 0, 1, 0},  {-1, 1, 0, 0, 0}};

}  // namespace

Status writeTexelScene(const std::filesystem::path& folder) {
    image::DisplayImage image{kSide, kSide, {}};
    for (std::uint32_t i = 0; i < kSide * kSide; ++i) {
        const auto grey = static_cast<std::uint8_t>(i);
        image.pixels.push_back({grey, grey, grey});
    }
    GLINT_TRY_DO(image::writeImage(folder / "texels.png", image));
    // glTF is little-endian, and so are all machines that Glint runs on.
    std::string corners(sizeof kCorners, '\0');
    std::memcpy(corners.data(), kCorners, sizeof kCorners);
    GLINT_TRY_DO(base::writeFile(folder / "texels.bin", corners));
    return base::writeFile(folder / "texels.gltf", std::string(kScene));
}

Result<SrgbTable> texelsOf(const LinearImage& picture, const std::string& where) {
    SrgbTable table{};
    bool rises = picture.width == kSide && picture.height == kSide;
    for (std::size_t i = 0; rises && i < table.size(); ++i) {
        table[i] = picture.pixels[i][0];
        rises = i == 0 || table[i] > table[i - 1];
    }
    if (!rises) {
        return makeError("oracle-texels", where, "is no picture of the scene of --write-texels",
                         "render texels.gltf at 16x16 pixels with one sample");
    }
    return table;
}

}  // namespace glint::oracle
