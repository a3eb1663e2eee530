// EXT_mesh_opacity_micromap: what is written is read again, and what the draft forbids is refused.
#include "gltf/micromaps.h"

#include <gtest/gtest.h>

#include <functional>

namespace glint::gltf {
namespace {

using opacity::State;

// A document with a mesh of two primitives: 3 triangles each, one of them without indices.
Json document() {
    return Json::parse(R"({
        "asset": {"version": "2.0"},
        "accessors": [{"componentType": 5126, "type": "VEC3", "count": 9},
                      {"componentType": 5123, "type": "SCALAR", "count": 9}],
        "bufferViews": [], "buffers": [{"byteLength": 4}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}, {"attributes": {"POSITION": 0}}]}]
    })");
}

std::vector<PrimitiveMicromap> micromaps() {
    const State o = State::Opaque;
    const State t = State::Transparent;
    const State x = State::UnknownTransparent;
    return {
        {0, 0,
         opacity::packMicromaps(std::vector<opacity::TriangleStates>{
             {1, {o, t, t, o}},
             {0, {x}},
             {2, std::vector<State>{o, t, t, t, t, t, t, t, t, t, t, t, t, t, x, t}}})},
        {0, 1, opacity::packMicromaps(std::vector<opacity::TriangleStates>{{0, {o}}, {0, {t}}, {0, {o}}})}};
}

struct Written {
    Json json = document();
    std::vector<std::uint8_t> bytes;

    Written() {
        writeMicromaps(micromaps(), "micromaps.bin", json, bytes);
    }
    Result<std::vector<PrimitiveMicromap>> read() const {
        return readMicromaps(json, [&](std::size_t view) -> Result<std::span<const std::uint8_t>> {
            const Json& it = json["bufferViews"][view];
            return std::span(bytes).subspan(it["byteOffset"].get<std::size_t>(),
                                            it["byteLength"].get<std::size_t>());
        });
    }
    Json& root() {
        return json["extensions"][kMicromapExtension]["micromaps"][0];
    }
    Json& primitive() {
        return json["meshes"][0]["primitives"][0]["extensions"][kMicromapExtension];
    }
};

TEST(Micromaps, AreReadAsTheyWereWritten) {
    const Written written;
    EXPECT_EQ(written.json["extensionsUsed"], Json({kMicromapExtension}));
    EXPECT_EQ(written.json["buffers"][1]["byteLength"], written.bytes.size());
    const auto read = written.read();
    ASSERT_TRUE(read.ok()) << toString(read.error());
    const std::vector<PrimitiveMicromap> given = micromaps();
    ASSERT_EQ(read->size(), 2U);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ((*read)[i].primitive, i);
        EXPECT_EQ((*read)[i].array.indices, given[i].array.indices);
    }
    EXPECT_EQ((*read)[0].array.records, given[0].array.records);
    EXPECT_EQ((*read)[0].array.data, given[0].array.data);
    EXPECT_EQ((*read)[0].array.usages, given[0].array.usages);
}

TEST(Micromaps, IndicesMayHaveAnyTypeAndABase) {
    Written written;
    // Three numbers of 8 bits: record 0 after the base, transparent, unknown opaque.
    const std::vector<std::uint8_t> indices{0, 255, 252};
    const std::size_t offset = written.bytes.size();
    written.bytes.insert(written.bytes.end(), indices.begin(), indices.end());
    written.json["bufferViews"].push_back({{"buffer", 1}, {"byteOffset", offset}, {"byteLength", 3}});
    written.json["accessors"].push_back({{"bufferView", written.json["bufferViews"].size() - 1},
                                         {"componentType", 5121},
                                         {"count", 3},
                                         {"type", "SCALAR"}});
    written.primitive()["micromapIndices"] = written.json["accessors"].size() - 1;
    written.primitive()["micromapBaseTriangle"] = 1;
    auto read = written.read();
    ASSERT_TRUE(read.ok()) << toString(read.error());
    EXPECT_EQ((*read)[0].array.indices, (std::vector<std::int32_t>{1, -1, -4}));
    // Without an accessor triangle t has record t; there are two records for three triangles.
    written.primitive() = {{"micromap", 0}};
    EXPECT_FALSE(written.read().ok());
}

TEST(Micromaps, FaultsAreRefused) {
    const std::pair<const char*, std::function<void(Written&)>> faults[] = {
        {"no view", [](Written& it) { it.root()["data"] = 99; }},
        {"no triangles", [](Written& it) { it.root().erase("triangles"); }},
        {"usage lengths", [](Written& it) { it.root()["usageLevels"].push_back(1); }},
        {"usage counts", [](Written& it) { it.root()["usageCounts"][0] = 7; }},
        {"usage of none", [](Written& it) { it.root()["usageCounts"][0] = 0; }},
        {"stride",
         [](Written& it) {
             it.json["bufferViews"][it.root()["triangles"].get<std::size_t>()]["byteStride"] = 6;
         }},
        {"no micromap", [](Written& it) { it.primitive()["micromap"] = 2; }},
        {"a strip", [](Written& it) { it.json["meshes"][0]["primitives"][0]["mode"] = 5; }},
        {"indices of other triangles", [](Written& it) { it.json["accessors"][1]["count"] = 12; }},
        {"floats",
         [](Written& it) {
             it.json["accessors"][it.primitive()["micromapIndices"].get<std::size_t>()]["componentType"] =
                 5126;
         }},
    };
    for (const auto& [name, damage] : faults) {
        Written written;
        damage(written);
        const auto read = written.read();
        ASSERT_FALSE(read.ok()) << name;
        EXPECT_EQ(read.error().id, "micromap") << name;
    }
}

}  // namespace
}  // namespace glint::gltf
