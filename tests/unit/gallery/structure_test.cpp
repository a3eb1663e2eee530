// Checks the generated file against the rules of the glTF 2.0 specification.
#include "document.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace gallery::test {

namespace {

std::size_t sizeOf(const char* list) {
    return document().json[list].size();
}

void expectIndex(const Json& index, const char* list) {
    EXPECT_LT(index.get<std::size_t>(), sizeOf(list)) << list;
}

}  // namespace

TEST(GalleryStructure, ViewsLieWithinTheBuffer) {
    const Json& buffer = document().json["buffers"][0];
    EXPECT_EQ(buffer["byteLength"].get<std::size_t>(), document().binary.size());
    for (const Json& view : document().json["bufferViews"]) {
        const auto offset = view["byteOffset"].get<std::size_t>();
        EXPECT_EQ(offset % 4, 0U);
        EXPECT_GT(view["byteLength"].get<std::size_t>(), 0U);
        EXPECT_LE(offset + view["byteLength"].get<std::size_t>(), document().binary.size());
    }
}

TEST(GalleryStructure, AccessorsFillTheirViews) {
    for (const Json& accessor : document().json["accessors"]) {
        const Json& view = document().json["bufferViews"].at(accessor["bufferView"].get<std::size_t>());
        const std::size_t element = componentBytes(accessor) * componentCount(accessor);
        EXPECT_EQ(element * accessor["count"].get<std::size_t>(), view["byteLength"].get<std::size_t>());
        // Vertex attributes start at multiples of four bytes.
        if (view["target"] == 34962) {
            EXPECT_EQ(element % 4, 0U);
        }
    }
}

TEST(GalleryStructure, PositionBoundsAreExact) {
    std::set<std::size_t> seen;
    for (const Json& mesh : document().json["meshes"]) {
        for (const Json& primitive : mesh["primitives"]) {
            const Json& accessor = document().accessor(primitive["attributes"]["POSITION"]);
            if (!seen.insert(primitive["attributes"]["POSITION"].get<std::size_t>()).second) {
                continue;
            }
            const std::vector<float> values = document().values(accessor);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                float low = values[axis];
                float high = values[axis];
                for (std::size_t at = axis; at < values.size(); at += 3) {
                    low = std::min(low, values[at]);
                    high = std::max(high, values[at]);
                }
                EXPECT_EQ(accessor["min"][axis].get<float>(), low) << mesh["name"];
                EXPECT_EQ(accessor["max"][axis].get<float>(), high) << mesh["name"];
            }
        }
    }
    EXPECT_GT(seen.size(), 20U);
}

TEST(GalleryStructure, PrimitivesAreWhole) {
    for (const Json& mesh : document().json["meshes"]) {
        for (const Json& primitive : mesh["primitives"]) {
            expectIndex(primitive["material"], "materials");
            const std::size_t count =
                document().accessor(primitive["attributes"]["POSITION"])["count"].get<std::size_t>();
            for (const auto& [name, index] : primitive["attributes"].items()) {
                EXPECT_EQ(document().accessor(index)["count"].get<std::size_t>(), count)
                    << mesh["name"] << name;
            }
            const std::vector<std::uint32_t> indices =
                document().indices(document().accessor(primitive["indices"]));
            ASSERT_FALSE(indices.empty());
            EXPECT_EQ(indices.size() % 3, 0U);
            EXPECT_LT(*std::max_element(indices.begin(), indices.end()), count) << mesh["name"];
        }
    }
}

TEST(GalleryStructure, NormalsAndTangentsAreUnitAndOrthogonal) {
    for (const Json& mesh : document().json["meshes"]) {
        for (const Json& primitive : mesh["primitives"]) {
            const Json& attributes = primitive["attributes"];
            if (!attributes.contains("NORMAL")) {
                continue;
            }
            const std::vector<float> normals = document().values(document().accessor(attributes["NORMAL"]));
            for (std::size_t n = 0; n < normals.size(); n += 3) {
                ASSERT_NEAR(std::hypot(normals[n], normals[n + 1], normals[n + 2]), 1.0F, 1e-5F)
                    << mesh["name"];
            }
            if (!attributes.contains("TANGENT")) {
                continue;
            }
            const std::vector<float> tangents = document().values(document().accessor(attributes["TANGENT"]));
            for (std::size_t n = 0, t = 0; n < normals.size(); n += 3, t += 4) {
                ASSERT_NEAR(std::hypot(tangents[t], tangents[t + 1], tangents[t + 2]), 1.0F, 1e-5F);
                ASSERT_EQ(std::abs(tangents[t + 3]), 1.0F);
                const float dot = normals[n] * tangents[t] + normals[n + 1] * tangents[t + 1] +
                                  normals[n + 2] * tangents[t + 2];
                ASSERT_NEAR(dot, 0.0F, 1e-5F) << mesh["name"];
            }
        }
    }
}

TEST(GalleryStructure, ReferencesResolve) {
    const Json& json = document().json;
    for (const Json& root : json["scenes"][0]["nodes"]) {
        expectIndex(root, "nodes");
    }
    for (const Json& node : json["nodes"]) {
        if (node.contains("mesh")) {
            expectIndex(node["mesh"], "meshes");
        }
        if (node.contains("camera")) {
            expectIndex(node["camera"], "cameras");
        }
    }
    for (const Json& texture : json["textures"]) {
        expectIndex(texture["source"], "images");
        expectIndex(texture["sampler"], "samplers");
    }
    for (const Json& image : json["images"]) {
        EXPECT_TRUE(std::filesystem::exists(document().folder / image["uri"].get<std::string>())) << image;
    }
}

// A material's textures only work if the mesh has the coordinates that they name.
TEST(GalleryStructure, TexturedPrimitivesHaveTheCoordinates) {
    for (const Json& mesh : document().json["meshes"]) {
        for (const Json& primitive : mesh["primitives"]) {
            for (const std::size_t material : materialsOf(primitive)) {
                for (const auto& [name, use] : textureUses(document().json["materials"].at(material))) {
                    expectIndex(use["index"], "textures");
                    const std::string set = "TEXCOORD_" + std::to_string(use.value("texCoord", 0));
                    EXPECT_TRUE(primitive["attributes"].contains(set)) << mesh["name"] << name;
                }
            }
        }
    }
}

TEST(GalleryStructure, EveryMaterialMeshAndTextureIsUsed) {
    const Json& json = document().json;
    std::set<std::size_t> materials;
    for (const Json& mesh : json["meshes"]) {
        for (const Json& primitive : mesh["primitives"]) {
            const std::vector<std::size_t> worn = materialsOf(primitive);
            materials.insert(worn.begin(), worn.end());
        }
    }
    EXPECT_EQ(materials.size(), json["materials"].size());
    std::set<std::size_t> meshes;
    for (const Json& node : json["nodes"]) {
        if (node.contains("mesh")) {
            meshes.insert(node["mesh"].get<std::size_t>());
        }
    }
    EXPECT_EQ(meshes.size(), json["meshes"].size());
    std::set<std::size_t> textures;
    for (const Json& material : json["materials"]) {
        for (const auto& [name, use] : textureUses(material)) {
            textures.insert(use["index"].get<std::size_t>());
        }
    }
    EXPECT_EQ(textures.size(), json["textures"].size());
}

TEST(GalleryStructure, VariantsAreNamedAndUsed) {
    const Json& json = document().json;
    const Json& variants = json["extensions"]["KHR_materials_variants"]["variants"];
    ASSERT_EQ(variants.size(), 2U);
    std::set<std::size_t> used;
    for (const Json& mesh : json["meshes"]) {
        for (const Json& primitive : mesh["primitives"]) {
            if (primitive.contains("extensions")) {
                std::set<std::size_t> here;
                for (const Json& mapping : primitive["extensions"]["KHR_materials_variants"]["mappings"]) {
                    expectIndex(mapping["material"], "materials");
                    for (const Json& variant : mapping["variants"]) {
                        // A variant must have only one material in a primitive.
                        EXPECT_TRUE(here.insert(variant.get<std::size_t>()).second) << mesh["name"];
                    }
                }
                used.insert(here.begin(), here.end());
            }
        }
    }
    EXPECT_EQ(used, (std::set<std::size_t>{0, 1}));
}

TEST(GalleryStructure, ExtensionsUsedAreThoseThatOccur) {
    const std::vector<std::string> expected{"KHR_lights_punctual",
                                            "KHR_materials_anisotropy",
                                            "KHR_materials_clearcoat",
                                            "KHR_materials_diffuse_transmission",
                                            "KHR_materials_dispersion",
                                            "KHR_materials_emissive_strength",
                                            "KHR_materials_ior",
                                            "KHR_materials_iridescence",
                                            "KHR_materials_pbrSpecularGlossiness",
                                            "KHR_materials_sheen",
                                            "KHR_materials_specular",
                                            "KHR_materials_transmission",
                                            "KHR_materials_unlit",
                                            "KHR_materials_variants",
                                            "KHR_materials_volume",
                                            "KHR_texture_transform"};
    EXPECT_EQ(document().json["extensionsUsed"].get<std::vector<std::string>>(), expected);
}

}  // namespace gallery::test
