// Tests compressed geometry: Draco and meshopt, round trips through the libraries' encoders, and damage.
#include "unit/gltf/only_primitive.h"
#include "unit/gltf/packed_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <meshoptimizer.h>
#include <set>
#include <string>
#include <vector>

namespace glint::test {
namespace {

constexpr const char* kDracoPointer = "/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression";

void expectError(const GltfBuilder& builder, std::string_view id, const std::string& pointer,
                 std::string_view part = "", const gltf::ImportOptions& options = {}) {
    const Result<gltf::Scene> scene = import(builder, options);
    ASSERT_FALSE(scene.ok()) << id;
    EXPECT_EQ(scene.error().id, id) << toString(scene.error());
    EXPECT_TRUE(scene.error().where.ends_with("scene.gltf#" + pointer)) << scene.error().where;
    EXPECT_NE(scene.error().message.find(part), std::string::npos) << scene.error().message;
    EXPECT_FALSE(scene.error().hint.empty());
}

Json& dracoOf(GltfBuilder& builder) {
    return builder.root["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"];
}

Json& meshoptOf(GltfBuilder& builder, std::size_t view) {
    return builder.root["bufferViews"][view]["extensions"]["EXT_meshopt_compression"];
}

// Returns triangles as corners by position, rotated so that the smallest comes first. The result does not
// depend on the order.
std::set<std::vector<gltf::Float3>> triangleSet(const gltf::Primitive& primitive) {
    std::set<std::vector<gltf::Float3>> triangles;
    for (std::size_t i = 0; i < primitive.indices.size(); i += 3) {
        std::vector<gltf::Float3> corners;
        for (std::size_t k = i; k < i + 3; ++k) {
            corners.push_back(primitive.positions[primitive.indices[k]]);
        }
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
        triangles.insert(corners);
    }
    return triangles;
}

void expectGrid(const gltf::Primitive& read) {
    const Grid grid = makeGrid();
    gltf::Primitive expected;
    expected.positions = grid.positions;
    expected.indices = grid.indices;
    EXPECT_EQ(triangleSet(read), triangleSet(expected));
    ASSERT_EQ(read.positions.size(), grid.positions.size());
    ASSERT_EQ(read.normals.size(), grid.positions.size());
    ASSERT_EQ(read.texCoords0.size(), grid.positions.size());
    for (std::size_t i = 0; i < read.positions.size(); ++i) {
        EXPECT_EQ(read.normals[i], (gltf::Float3{0, 0, 1}));
        EXPECT_NEAR(read.texCoords0[i][0], read.positions[i][0] / kGridCells, 1e-4F);
        EXPECT_NEAR(read.texCoords0[i][1], read.positions[i][1] / kGridCells, 1e-4F);
    }
}

TEST(GltfDraco, RoundTrips) {
    for (const DracoMethod method : {DracoMethod::Sequential, DracoMethod::Edgebreaker}) {
        const Result<gltf::Scene> scene = import(dracoScene(method));
        ASSERT_TRUE(scene.ok()) << toString(scene.error());
        EXPECT_TRUE(scene->warnings.empty()) << toString(scene->warnings[0]);
        expectGrid(onlyPrimitive(scene));
    }
}

TEST(GltfDraco, ReadsWhatIsNotCompressedFromItsAccessor) {
    GltfBuilder builder = dracoScene(DracoMethod::Sequential);
    std::vector<float> texCoords(std::size_t{2} * 25, 0.5F);
    builder.root["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_1"] =
        builder.addAccessor<float>(texCoords, 2);
    const Result<gltf::Scene> scene = import(builder);
    EXPECT_EQ(onlyPrimitive(scene).texCoords1.at(24), (gltf::Float2{0.5F, 0.5F}));
    // An accessor without data has zeros.
    builder.root["accessors"].back().erase("bufferView");
    const Result<gltf::Scene> bare = import(builder);
    EXPECT_EQ(onlyPrimitive(bare).texCoords1.at(24), (gltf::Float2{0.0F, 0.0F}));
    EXPECT_TRUE(bare->warnings.empty()) << toString(bare->warnings[0]);
    builder.root["accessors"].back()["count"] = 24;
    expectError(builder, "attribute-count", "/meshes/0/primitives/0/attributes/TEXCOORD_1", "25");
}

TEST(GltfDraco, LeavesOutWhatTheDataLack) {
    GltfBuilder builder = dracoScene(DracoMethod::Edgebreaker);
    Json& attributes = dracoOf(builder)["attributes"];
    attributes["NORMAL"] = 7;
    attributes["JOINTS_0"] = 8;
    Json& given = builder.root["meshes"][0]["primitives"][0]["attributes"];
    given["WEIGHTS_0"] = given["JOINTS_0"] = given["NORMAL"];
    const Result<gltf::Scene> scene = import(builder);
    EXPECT_TRUE(onlyPrimitive(scene).normals.empty());
    EXPECT_EQ(onlyPrimitive(scene).influences.count, 0U);
    EXPECT_EQ(onlyPrimitive(scene).texCoords0.size(), 25U);
    EXPECT_EQ(countWarnings(*scene, "draco-attribute"), 2U);
    attributes["POSITION"] = 9;
    expectError(builder, "draco-attribute", std::string(kDracoPointer) + "/attributes/POSITION", "9");
}

TEST(GltfDraco, ExplainsWrongAttributes) {
    GltfBuilder builder = dracoScene(DracoMethod::Sequential);
    Json& attributes = dracoOf(builder)["attributes"];
    const std::string pointer = std::string(kDracoPointer) + "/attributes";
    attributes["NORMAL"] = kDracoTexCoord;
    expectError(builder, "draco-attribute", pointer + "/NORMAL", "2 components");
    attributes["NORMAL"] = -1;
    expectError(builder, "json-range", pointer + "/NORMAL");
    attributes["NORMAL"] = kDracoNormal;
    // UVs of 16 bits do not fit into bytes.
    builder.root["accessors"][2]["componentType"] = 5121;
    expectError(builder, "draco-attribute", pointer + "/TEXCOORD_0", "component type");
    dracoOf(builder)["bufferView"] = 3;
    expectError(builder, "index-range", std::string(kDracoPointer) + "/bufferView");
    dracoOf(builder).erase("bufferView");
    expectError(builder, "json-missing", kDracoPointer);
}

TEST(GltfDraco, UsesTheCountsOfTheData) {
    GltfBuilder builder = dracoScene(DracoMethod::Edgebreaker);
    builder.root["accessors"][0]["count"] = 24;
    builder.root["accessors"][1]["count"] = 26;
    builder.root["accessors"][3]["count"] = 99;
    const Result<gltf::Scene> scene = import(builder);
    expectGrid(onlyPrimitive(scene));
    ASSERT_EQ(countWarnings(*scene, "draco-count"), 1U);
    EXPECT_TRUE(findWarning(*scene, "draco-count")
                    .message.ends_with(
                        "POSITION 24 instead of 25, NORMAL 26 instead of 25, indices 99 instead of 96"));
}

TEST(GltfDraco, ExplainsDamage) {
    GltfBuilder truncated = dracoScene(DracoMethod::Edgebreaker);
    truncated.root["bufferViews"][0]["byteLength"] = 60;
    expectError(truncated, "draco-decode", kDracoPointer, "/bufferViews/0");
    GltfBuilder foreign = dracoScene(DracoMethod::Edgebreaker);
    foreign.buffer[0] = 'X';
    expectError(foreign, "draco-decode", kDracoPointer, "no Draco mesh");
    GltfBuilder version = dracoScene(DracoMethod::Edgebreaker);
    version.buffer[6] = 9;
    expectError(version, "draco-decode", kDracoPointer, "2.2");
}

TEST(GltfDraco, RefusesHeadersThatClaimTooMuch) {
    // The header without metadata: "DRACO", version 2.2, a mesh, the method, no flags, then the counts as
    // varints (seven bits a byte, most significant first).
    const auto withCounts = [](bool sequential) {
        base::Bytes bytes{'D', 'R', 'A', 'C', 'O', 2, 2, 1, static_cast<std::uint8_t>(sequential ? 0 : 1),
                          0,   0};
        if (!sequential) {
            bytes.push_back(0);
        }
        for (int count = 0; count < 2; ++count) {
            bytes.insert(bytes.end(), {0xFF, 0xFF, 0xFF, 0xFF, 0x0F});
        }
        bytes.resize(200);
        return bytes;
    };
    for (const bool sequential : {false, true}) {
        GltfBuilder builder = dracoScene(DracoMethod::Sequential);
        const base::Bytes bytes = withCounts(sequential);
        dracoOf(builder)["bufferView"] = builder.addView(bytes.data(), bytes.size());
        expectError(builder, "draco-size", kDracoPointer, "200 bytes");
    }
    expectError(dracoScene(DracoMethod::Edgebreaker), "vertex-limit", kDracoPointer, "96 elements",
                {.maxVertices = 50});
    expectError(dracoScene(DracoMethod::Edgebreaker), "vertex-limit",
                "/meshes/0/primitives/0/attributes/NORMAL", "", {.maxVertices = 96 + 30});
}

TEST(GltfDraco, RefusesAttributesThatTakeTooMuch) {
    constexpr std::uint8_t kFloat64 = 10;
    const auto refuses = [](const base::Bytes& bytes) {
        GltfBuilder builder = dracoScene(DracoMethod::Sequential);
        dracoOf(builder)["bufferView"] = builder.addView(bytes.data(), bytes.size());
        expectError(builder, "draco-size", kDracoPointer, "bytes of attributes");
    };
    // 200 triangles and 600 points, as varints, with plain indices of 16 bits; then 200 attributes of 255
    // components each, which would take 245 MB.
    base::Bytes sequential{'D', 'R', 'A', 'C', 'O', 2, 2, 1, 0, 0, 0, 0xC8, 1, 0xD8, 4, 1};
    for (int corner = 0; corner < 600; ++corner) {
        sequential.push_back(static_cast<std::uint8_t>(corner));
        sequential.push_back(static_cast<std::uint8_t>(corner >> 8));
    }
    sequential.insert(sequential.end(), {1, 0xC8, 1});
    for (int attribute = 0; attribute < 200; ++attribute) {
        sequential.insert(sequential.end(), {4, kFloat64, 255, 0, 1});
    }
    sequential.resize(sequential.size() + 200);
    refuses(sequential);
    // Edgebreaker: 100 vertices, 16000 triangles, and 255 sets of attributes with seams of their own.
    base::Bytes edgebreaker{'D', 'R', 'A', 'C', 'O', 2, 2, 1, 1, 0, 0, 0, 100, 0x80, 0x7D, 255};
    edgebreaker.resize(200);
    refuses(edgebreaker);
}

TEST(GltfMeshopt, RoundTrips) {
    const GltfBuilder builder = meshoptScene();
    for (const std::string& text : {builder.text(), builder.glb()}) {
        const Result<gltf::Scene> scene = importText(text);
        ASSERT_TRUE(scene.ok()) << toString(scene.error());
        EXPECT_TRUE(scene->warnings.empty()) << toString(scene->warnings[0]);
        expectGrid(onlyPrimitive(scene));
    }
}

TEST(GltfMeshopt, ReadsVersion1OfAttributes) {
    const Result<gltf::Scene> scene = import(meshoptV1Scene());
    const gltf::Primitive& read = onlyPrimitive(scene);
    const std::vector<MeshoptVertex> vertices = meshoptVertices();
    ASSERT_EQ(read.positions.size(), vertices.size());
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        ASSERT_EQ(read.positions[i], vertices[i].position) << i;
        ASSERT_EQ(read.texCoords0[i], vertices[i].texCoord0) << i;
        ASSERT_EQ(read.texCoords1[i], vertices[i].texCoord1) << i;
    }
}

TEST(GltfMeshopt, ExplainsDamageOfVersion1) {
    const GltfBuilder whole = meshoptV1Scene();
    GltfBuilder longer = whole;
    const auto size = meshoptOf(longer, 0)["byteLength"].get<std::size_t>();
    const auto expectDamage = [&](std::size_t place, std::uint8_t byte, const char* part) {
        GltfBuilder builder = whole;
        builder.buffer[place] = byte;
        expectError(builder, "meshopt-decode", "/bufferViews/0", part);
    };
    expectDamage(0, 0xA2, "newer format");
    // The last byte is the mode of the last channel.
    expectDamage(size - 1, 3, "damaged");
    expectDamage(size - 1, 0x10, "damaged");
    // A byte of all elements takes less than it did, or more.
    expectDamage(1, 0xAA, "");
    expectDamage(1, 0xFF, "");
    longer.buffer.insert(longer.buffer.begin() + 8, 0);
    meshoptOf(longer, 0)["byteLength"] = size + 1;
    expectError(longer, "meshopt-decode", "/bufferViews/0");
}

// KHR_meshopt_compression, appendix B: Y, Co and Cg; alpha tells the number of bits.
TEST(GltfMeshopt, DecodesColors) {
    const auto colorsOf = [](const base::Bytes& filtered, int componentType) {
        const std::size_t stride = filtered.size() / 3;
        meshopt_encodeVertexVersion(0);
        GltfBuilder builder;
        Json& primitive = builder.addTriangle();
        addFallbackBuffer(builder, filtered.size());
        const int view = addPackedView(builder, packVertices(filtered.data(), 3, stride), 3, stride,
                                       "ATTRIBUTES", "COLOR");
        primitive["attributes"]["COLOR_0"] = builder.append("accessors", {{"bufferView", view},
                                                                          {"componentType", componentType},
                                                                          {"count", 3},
                                                                          {"type", "VEC4"},
                                                                          {"normalized", true}});
        std::vector<std::array<int, 4>> colors;
        const Result<gltf::Scene> scene = import(builder);
        for (const gltf::Float4& color : onlyPrimitive(scene).colors) {
            std::array<int, 4>& whole = colors.emplace_back();
            for (std::size_t i = 0; i < 4; ++i) {
                whole[i] =
                    static_cast<int>(std::lround(color[i] * (componentType == 5121 ? 255.0F : 65535.0F)));
            }
        }
        return colors;
    };
    using Colors = std::vector<std::array<int, 4>>;
    // White; a red whose alpha is half; 32 of 63, opaque.
    EXPECT_EQ(colorsOf({255, 0, 0, 255, 64, 127, 192, 192, 32, 0, 0, 63}, 5121),
              (Colors{{255, 255, 255, 255}, {255, 0, 1, 128}, {130, 130, 130, 255}}));
    const std::vector<std::uint16_t> wide{65535, 0, 0, 65535, 512, 0, 0, 1023, 300, 65436, 50, 512};
    base::Bytes bytes(wide.size() * sizeof wide[0]);
    std::memcpy(bytes.data(), wide.data(), bytes.size());
    // (300 - 100 - 50, 300 + 50, 300 + 100 - 50) of 1023
    EXPECT_EQ(colorsOf(bytes, 5123),
              (Colors{{65535, 65535, 65535, 65535}, {32800, 32800, 32800, 65535}, {9609, 22422, 22422, 0}}));
}

TEST(GltfMeshopt, ReadsTheNameOfTheKhronosExtension) {
    GltfBuilder builder = meshoptScene();
    builder.root["extensionsRequired"][0] = builder.root["extensionsUsed"][0] = "KHR_meshopt_compression";
    for (Json& view : builder.root["bufferViews"]) {
        Json extension = view["extensions"]["EXT_meshopt_compression"];
        view["extensions"] = {{"KHR_meshopt_compression", std::move(extension)}};
    }
    expectGrid(onlyPrimitive(import(builder)));
}

TEST(GltfMeshopt, ReadsIndexSequences) {
    meshopt_encodeIndexVersion(1);
    const std::vector<std::uint32_t> indices{2, 1, 0, 0, 1, 2};
    base::Bytes packed(meshopt_encodeIndexSequenceBound(indices.size(), 3));
    packed.resize(meshopt_encodeIndexSequence(packed.data(), packed.size(), indices.data(), indices.size()));
    for (const std::size_t stride : {2U, 4U}) {
        GltfBuilder builder;
        Json& primitive = builder.addTriangle();
        addFallbackBuffer(builder, 64);
        const int view = addPackedView(builder, packed, indices.size(), stride, "INDICES");
        primitive["indices"] = builder.append("accessors", {{"bufferView", view},
                                                            {"componentType", stride == 2 ? 5123 : 5125},
                                                            {"count", indices.size()},
                                                            {"type", "SCALAR"}});
        EXPECT_EQ(onlyPrimitive(import(builder)).indices, indices);
    }
}

TEST(GltfMeshopt, DecodesQuaternionsAsTangents) {
    // A tangent of four 16-bit components has the form that the filter takes.
    const std::vector<std::array<float, 4>> unit(3, {0.0F, 0.6F, 0.0F, 0.8F});
    base::Bytes filtered(unit.size() * 8);
    meshopt_encodeFilterQuat(filtered.data(), unit.size(), 8, 16, unit[0].data());
    meshopt_encodeVertexVersion(0);
    GltfBuilder builder;
    Json& primitive = builder.addTriangle();
    addFallbackBuffer(builder, 64);
    const int view =
        addPackedView(builder, packVertices(filtered.data(), 3, 8), 3, 8, "ATTRIBUTES", "QUATERNION");
    primitive["attributes"]["NORMAL"] = builder.addAccessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, 3);
    primitive["attributes"]["TANGENT"] = builder.append("accessors", {{"bufferView", view},
                                                                      {"componentType", 5122},
                                                                      {"count", 3},
                                                                      {"type", "VEC4"},
                                                                      {"normalized", true}});
    const Result<gltf::Scene> scene = import(builder);
    EXPECT_EQ(onlyPrimitive(scene).tangents.at(2), (gltf::Float4{0, 1, 0, 1}));
}

TEST(GltfMeshopt, ExplainsContradictions) {
    const auto check = [](std::size_t view, const char* member, Json value, std::string_view id,
                          std::string_view part) {
        GltfBuilder builder = meshoptScene();
        meshoptOf(builder, view)[member] = std::move(value);
        const std::string pointer = "/bufferViews/" + std::to_string(view);
        const bool isJson = id.starts_with("json") || id.starts_with("index");
        expectError(builder, id, isJson ? pointer + "/extensions/EXT_meshopt_compression/" + member : pointer,
                    part);
    };
    check(0, "mode", "LINES", "meshopt-layout", "LINES");
    check(0, "filter", "COLOR", "meshopt-layout", "COLOR");
    check(0, "filter", "HUE", "meshopt-layout", "HUE");
    check(0, "byteStride", 6, "meshopt-layout", "multiple of 4");
    check(0, "filter", "OCTAHEDRAL", "meshopt-layout", "OCTAHEDRAL");
    check(1, "filter", "QUATERNION", "meshopt-layout", "QUATERNION");
    check(3, "filter", "EXPONENTIAL", "meshopt-layout", "ATTRIBUTES");
    check(3, "byteStride", 1, "meshopt-layout", "2 or 4");
    check(3, "count", 95, "meshopt-layout", "multiple of 3");
    check(0, "count", 24, "meshopt-layout", "300 bytes");
    check(0, "byteStride", 260, "json-range", "");
    check(0, "count", -1, "json-range", "");
    check(0, "buffer", 2, "index-range", "");
    check(0, "byteOffset", 1000000, "buffer-view-range", "");
    check(0, "mode", "TRIANGLES", "meshopt-layout", "2 or 4");
}

TEST(GltfMeshopt, ExplainsDamage) {
    GltfBuilder header = meshoptScene();
    header.buffer[0] = 0;
    expectError(header, "meshopt-decode", "/bufferViews/0", "code -1");
    GltfBuilder cut = meshoptScene();
    meshoptOf(cut, 0)["byteLength"] = 40;
    expectError(cut, "meshopt-decode", "/bufferViews/0", "ends early");
    GltfBuilder plain = meshoptScene();
    plain.root["bufferViews"][0].erase("extensions");
    expectError(plain, "buffer-data", "/buffers/1", "fallback");
}

TEST(GltfMeshopt, BoundsWhatItUnpacks) {
    GltfBuilder builder = meshoptScene();
    const std::uint64_t count = 1ULL << 40;
    meshoptOf(builder, 0)["count"] = count;
    builder.root["bufferViews"][0]["byteLength"] = count * 12;
    expectError(builder, "meshopt-size", "/bufferViews/0", "no data can");
    // Zeros are packed very small, so the limit must apply to the unpacked size.
    constexpr std::size_t kCount = 10000;
    const std::vector<std::array<float, 3>> zeros(kCount);
    GltfBuilder large;
    addFallbackBuffer(large, kCount * 12);
    const int view = addPackedView(large, packVertices(zeros.data(), kCount, 12), kCount, 12, "ATTRIBUTES");
    large.addMesh({{"attributes",
                    {{"POSITION", large.append("accessors", {{"bufferView", view},
                                                             {"componentType", 5126},
                                                             {"count", kCount},
                                                             {"type", "VEC3"}})}}}});
    EXPECT_TRUE(import(large).ok());
    ASSERT_LT(large.text().size(), 50000U);
    expectError(large, "meshopt-size", "/bufferViews/0", "too much", {.maxFileBytes = 50000});
}

}  // namespace
}  // namespace glint::test
