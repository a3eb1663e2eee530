#include "emit/package/tables.h"

#include "emit/context.h"
#include "gltf/import.h"
#include "support/features.h"
#include "support/must.h"
#include "unit/emit/sample_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <interop/scene.h>
#include <limits>
#include <map>
#include <set>
#include <string_view>

namespace glint {
namespace {

using namespace glint::testing;
using package::SectionKind;

// Reads tables.bin by its own description.
class TableReader {
public:
    explicit TableReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {
        std::memcpy(&header, bytes.data(), sizeof header);
        for (std::uint32_t i = 0; i < header.sectionCount; ++i) {
            package::PackageSection section{};
            std::memcpy(&section, bytes.data() + sizeof header + i * sizeof section, sizeof section);
            EXPECT_EQ(section.offset % 8, 0U);
            EXPECT_LE(section.offset + section.count * section.elementBytes, bytes.size());
            EXPECT_TRUE(sections_.emplace(section.kind, section).second);
        }
    }
    template <typename Element>
    std::vector<Element> read(SectionKind kind) const {
        const package::PackageSection& section = sections_.at(kind);
        EXPECT_EQ(section.elementBytes, sizeof(Element));
        std::vector<Element> elements(section.count);
        std::memcpy(elements.data(), bytes_.data() + section.offset, section.count * sizeof(Element));
        return elements;
    }

    std::uint64_t count(SectionKind kind) const {
        return sections_.at(kind).count;
    }

    package::PackageHeader header{};

private:
    std::span<const std::uint8_t> bytes_;
    std::map<SectionKind, package::PackageSection> sections_;
};

// The layout of records of glTF's bases whose keys have those features.
compiler::MaterialLayout layoutWith(const materials::FeatureMask& used) {
    const compiler::RecordUse use{{-1}, used, true};
    return compiler::makeMaterialLayout(materials::builtinMaterialModel(), {&use, 1});
}

// A layout with every field and texture.
const compiler::MaterialLayout& wholeLayout() {
    static const compiler::MaterialLayout kLayout = layoutWith(~materials::FeatureMask{0});
    return kLayout;
}

// Reads records of that layout.
class Records {
public:
    explicit Records(std::vector<std::uint8_t> bytes) : bytes_(std::move(bytes)) {}

    float value(std::size_t material, std::string_view field, std::uint32_t channel = 0) const {
        const auto& fields = wholeLayout().fields;
        const auto found = std::ranges::find(fields, field, &compiler::RecordField::name);
        EXPECT_NE(found, fields.end()) << field;
        float number = 0.0F;
        std::memcpy(&number, &bytes_.at(material * wholeLayout().bytes + found->offset + 4 * channel),
                    sizeof number);
        return number;
    }
    gpu::TextureRecord texture(std::size_t material, std::string_view name) const {
        const int slot = wholeLayout().slotOf(materials::builtinMaterialModel().findTexture(name));
        EXPECT_GE(slot, 0) << name;
        gpu::TextureRecord record{};
        std::memcpy(&record,
                    &bytes_.at(material * wholeLayout().bytes + wholeLayout().textureOffset +
                               static_cast<std::size_t>(slot) * sizeof record),
                    sizeof record);
        return record;
    }

private:
    std::vector<std::uint8_t> bytes_;
};

TEST(MaterialLayout, HasTheFieldsOfTheFeaturesThatAreUsed) {
    const materials::MaterialModel& model = materials::builtinMaterialModel();
    const auto has = [](const compiler::MaterialLayout& layout, std::string_view field) {
        return std::ranges::find(layout.fields, field, &compiler::RecordField::name) != layout.fields.end();
    };
    const compiler::MaterialLayout plain = layoutWith(0);
    EXPECT_TRUE(has(plain, "baseColorFactor"));
    EXPECT_FALSE(has(plain, "clearcoatFactor"));
    EXPECT_TRUE(plain.textures.empty());
    EXPECT_EQ(plain.bytes, plain.textureOffset);
    const compiler::MaterialLayout coated = layoutWith(model.mask("clearcoat") | model.mask("normalTexture"));
    EXPECT_TRUE(has(coated, "clearcoatFactor"));
    EXPECT_TRUE(has(coated, "normalScale"));
    EXPECT_FALSE(has(coated, "clearcoatNormalScale"));
    ASSERT_EQ(coated.textures.size(), 1U);
    EXPECT_EQ(coated.textures[0].texture, model.findTexture("normalTexture"));
    EXPECT_EQ(coated.bytes, coated.textureOffset + sizeof(gpu::TextureRecord));
    EXPECT_LT(plain.bytes, 64U);
}

// A frame may be that of the normal texture's coordinates though no key reads the texture. A material without
// one has the coordinates as they are.
TEST(MaterialLayout, HasTheTransformsOfFrames) {
    const materials::MaterialModel& model = materials::builtinMaterialModel();
    const int normal = model.findTexture("normalTexture");
    const materials::FeatureMask grooves = model.mask("anisotropy") | model.mask("texCoord0");
    EXPECT_EQ(layoutWith(grooves).slotOf(normal), -1);
    EXPECT_EQ(layoutWith(grooves | model.mask("texCoord1")).slotOf(normal), 0);
    EXPECT_EQ(layoutWith(model.mask("turnedFrames")).slotOf(normal), -1);
    const compiler::MaterialLayout layout = layoutWith(grooves | model.mask("turnedFrames"));
    ASSERT_EQ(layout.slotOf(normal), 0);
    const std::vector<std::uint8_t> record = makeMaterialRecord(materials::Material(), layout);
    gpu::TextureRecord texture{};
    std::memcpy(&texture, &record[layout.textureOffset], sizeof texture);
    EXPECT_EQ(texture.rowU.x, 1.0F);
    EXPECT_EQ(texture.rowU.y, 0.0F);
    EXPECT_EQ(texture.rowV.x, 0.0F);
    EXPECT_EQ(texture.rowV.y, 1.0F);
}

TEST(MaterialTables, ListEachImageOncePerColourSpace) {
    const compiler::MaterialTables tables = makeMaterialTables(makeSampleScene(), wholeLayout());
    ASSERT_EQ(tables.textures.size(), 3U);
    EXPECT_EQ(tables.textures[0].image, 0U);
    EXPECT_EQ(tables.textures[0].srgb, 1U);
    EXPECT_EQ(tables.textures[1].image, 1U);
    EXPECT_EQ(tables.textures[1].srgb, 1U);
    EXPECT_EQ(tables.textures[2].image, 1U);
    EXPECT_EQ(tables.textures[2].srgb, 0U);
    const Records records(tables.materials);
    EXPECT_EQ(records.texture(1, "baseColorTexture").textureIndex, 0U);
    EXPECT_EQ(records.texture(2, "baseColorTexture").textureIndex, 1U);
    EXPECT_EQ(records.texture(2, "baseColorTexture").samplerIndex, 1U);
    EXPECT_EQ(records.texture(2, "occlusionTexture").textureIndex, 2U);
    EXPECT_EQ(records.texture(3, "baseColorTexture").textureIndex, 0U);
}

TEST(MaterialTables, LeaveEmptySlotsZero) {
    compiler::MaterialLayout layout = wholeLayout();
    layout.turnsFrames = false;
    const compiler::MaterialTables tables = makeMaterialTables(makeSampleScene(), layout);
    using Words = std::array<std::uint32_t, sizeof(gpu::TextureRecord) / sizeof(std::uint32_t)>;
    for (const materials::MaterialTexture& texture : materials::builtinMaterialModel().textures) {
        EXPECT_EQ(std::bit_cast<Words>(Records(tables.materials).texture(0, texture.name)), Words{});
    }
}

// A quarter turn counter-clockwise on the image, whose v points down, takes (1, 0) to (0, -1).
TEST(MaterialTables, TransformScalesThenTurnsThenMoves) {
    const compiler::MaterialTables tables = makeMaterialTables(makeSampleScene(), wholeLayout());
    const gpu::TextureRecord record = Records(tables.materials).texture(2, "occlusionTexture");
    const auto apply = [&](float u, float v) {
        return std::pair(record.rowU.x * u + record.rowU.y * v + record.rowU.z,
                         record.rowV.x * u + record.rowV.y * v + record.rowV.z);
    };
    // First the scale (2, 3), then the turn, then the offset (0.25, 0.5).
    const auto [u1, v1] = apply(1, 0);
    EXPECT_NEAR(u1, 0.25, 1e-6);
    EXPECT_NEAR(v1, -2 + 0.5, 1e-6);
    const auto [u2, v2] = apply(0, 1);
    EXPECT_NEAR(u2, 3 + 0.25, 1e-6);
    EXPECT_NEAR(v2, 0.5, 1e-6);
    const gpu::TextureRecord identity = Records(tables.materials).texture(2, "baseColorTexture");
    EXPECT_EQ(identity.rowU.x, 1.0F);
    EXPECT_EQ(identity.rowU.y, 0.0F);
    EXPECT_EQ(identity.rowV.x, 0.0F);
    EXPECT_EQ(identity.rowV.y, 1.0F);
}

// One image is in every slot; this tests which of its views each slot gets.
TEST(MaterialTables, TexturesOfColorsAreSrgb) {
    const auto srgbSlots = [](bool specularGlossiness) {
        gltf::Scene scene = makeSampleScene();
        scene.materials.resize(1);
        if (specularGlossiness) {
            scene.materials[0].give("KHR_materials_pbrSpecularGlossiness");
        }
        for (std::size_t slot = 0; slot < materials::builtinMaterialModel().textures.size(); ++slot) {
            scene.materials[0].textures[slot].texture = 0;
        }
        const compiler::MaterialTables tables = makeMaterialTables(scene, wholeLayout());
        EXPECT_EQ(tables.textures.size(), 2U);
        std::set<std::string> slots;
        for (const materials::MaterialTexture& texture : materials::builtinMaterialModel().textures) {
            if (tables.textures[Records(tables.materials).texture(0, texture.name).textureIndex].srgb == 1U) {
                slots.insert(texture.name);
            }
        }
        return slots;
    };
    std::set<std::string> expected{"baseColorTexture", "emissiveTexture", "sheenColorTexture",
                                   "specularColorTexture", "diffuseTransmissionColorTexture"};
    EXPECT_EQ(srgbSlots(false), expected);
    expected.insert("metallicRoughnessTexture");
    EXPECT_EQ(srgbSlots(true), expected);
}

Records recordOf(const materials::Material& material) {
    return Records(makeMaterialRecord(material, wholeLayout()));
}

TEST(MaterialTables, HoldEveryFactorOfTheExtensions) {
    materials::Material material;
    material["ior"] = 1.25F;
    material.give("KHR_materials_specular");
    material["specularFactor"] = 0.5F;
    material["specularColorFactor"] = {0.25F, 0.5F, 2.0F};
    material.give("KHR_materials_clearcoat");
    material["clearcoatFactor"] = 0.75F;
    material["clearcoatRoughnessFactor"] = 0.125F;
    material["clearcoatNormalScale"] = -1.5F;
    material.give("KHR_materials_sheen");
    material["sheenColorFactor"] = {0.1F, 0.2F, 0.3F};
    material["sheenRoughnessFactor"] = 0.4F;
    material.give("KHR_materials_anisotropy");
    material["anisotropyStrength"] = 0.625F;
    material["anisotropyRotation"] = 2.5F;
    material.give("KHR_materials_iridescence");
    material["iridescenceFactor"] = 0.7F;
    material["iridescenceIor"] = 1.8F;
    material["iridescenceThicknessMinimum"] = 150.0F;
    material["iridescenceThicknessMaximum"] = 650.0F;
    material.give("KHR_materials_transmission");
    material["transmissionFactor"] = 0.9F;
    material.give("KHR_materials_diffuse_transmission");
    material["diffuseTransmissionFactor"] = 0.35F;
    material["diffuseTransmissionColorFactor"] = {0.6F, 0.5F, 0.4F};
    material["thicknessFactor"] = 0.05F;
    material.give("KHR_materials_dispersion");
    material["dispersion"] = 0.45F;
    const Records record = recordOf(material);
    EXPECT_EQ(record.value(0, "ior"), 1.25F);
    EXPECT_EQ(record.value(0, "specularFactor"), 0.5F);
    EXPECT_EQ(record.value(0, "specularColorFactor", 2), 2.0F);
    EXPECT_EQ(record.value(0, "clearcoatFactor"), 0.75F);
    EXPECT_EQ(record.value(0, "clearcoatRoughnessFactor"), 0.125F);
    EXPECT_EQ(record.value(0, "clearcoatNormalScale"), -1.5F);
    EXPECT_EQ(record.value(0, "sheenColorFactor", 1), 0.2F);
    EXPECT_EQ(record.value(0, "sheenRoughnessFactor"), 0.4F);
    EXPECT_EQ(record.value(0, "anisotropyStrength"), 0.625F);
    EXPECT_FLOAT_EQ(record.value(0, "anisotropyDirection", 0), std::cos(2.5F));
    EXPECT_FLOAT_EQ(record.value(0, "anisotropyDirection", 1), std::sin(2.5F));
    EXPECT_EQ(record.value(0, "iridescenceFactor"), 0.7F);
    EXPECT_EQ(record.value(0, "iridescenceIor"), 1.8F);
    EXPECT_EQ(record.value(0, "iridescenceThicknessMinimum"), 150.0F);
    EXPECT_EQ(record.value(0, "iridescenceThicknessMaximum"), 650.0F);
    EXPECT_EQ(record.value(0, "transmissionFactor"), 0.9F);
    EXPECT_EQ(record.value(0, "diffuseTransmissionFactor"), 0.35F);
    EXPECT_EQ(record.value(0, "diffuseTransmissionColorFactor", 2), 0.4F);
    EXPECT_EQ(record.value(0, "thicknessFactor"), 0.05F);
    EXPECT_EQ(record.value(0, "dispersion"), 0.45F);
    material.give("KHR_materials_pbrSpecularGlossiness");
    material["glossySpecularFactor"] = {0.3F, 0.2F, 0.1F};
    material["glossinessFactor"] = 0.85F;
    EXPECT_EQ(recordOf(material).value(0, "glossinessFactor"), 0.85F);
    EXPECT_EQ(recordOf(material).value(0, "glossySpecularFactor"), 0.3F);
}

// After the attenuation distance, white light has become the attenuation colour.
TEST(MaterialTables, AbsorptionLeavesTheColorAtTheDistance) {
    materials::Material material;
    material.give("KHR_materials_volume");
    material["thicknessFactor"] = 1.0F;
    material["attenuationDistance"] = 0.25F;
    material["attenuationColor"] = {0.5F, 1.0F, 0.0F};
    const Records record = recordOf(material);
    const gpu::vec3 absorption{record.value(0, "absorption", 0), record.value(0, "absorption", 1),
                               record.value(0, "absorption", 2)};
    EXPECT_NEAR(std::exp(-static_cast<double>(absorption.x) * 0.25), 0.5, 1e-7);
    EXPECT_EQ(absorption.y, 0.0F);
    EXPECT_FALSE(std::signbit(absorption.y));
    // Black lets nothing pass, and the product with a kilometre is finite.
    EXPECT_GE(absorption.z, 1e17F);
    EXPECT_TRUE(std::isfinite(absorption.z * 1000.0F));
    material["attenuationDistance"] = 1e-30F;
    EXPECT_LE(recordOf(material).value(0, "absorption", 0), 1.0001e18F);
    material["attenuationDistance"] = std::numeric_limits<float>::infinity();
    EXPECT_EQ(recordOf(material).value(0, "absorption", 2), 0.0F);
}

TEST(Tables, HoldWhatTheHeaderSays) {
    compiler::CompileSettings settings;
    settings.plan.keys.alpha = package::AlphaPolicy::Tested;
    settings.plan.merge = compiler::MergePolicy::None;
    const compiler::CompiledPackage compiled = compileSample(settings);
    const compiler::PackageFile* const file = findFile(compiled, package::kTablesFile);
    ASSERT_NE(file, nullptr);
    const TableReader reader(file->bytes);
    EXPECT_EQ(std::memcmp(reader.header.magic, "GLINTPKG", 8), 0);
    EXPECT_EQ(reader.header.version, package::kVersion);
    EXPECT_EQ(reader.header.fileBytes, file->bytes.size());
    package::PackageHeader unhashed = reader.header;
    unhashed.contentHash = 0;
    const std::uint64_t seed =
        base::hashBytes({reinterpret_cast<const std::uint8_t*>(&unhashed), sizeof(package::PackageHeader)});
    EXPECT_EQ(reader.header.contentHash,
              base::hashBytes(std::span(file->bytes).subspan(sizeof(package::PackageHeader)), seed));
    EXPECT_EQ(reader.header.strategies, settings.strategies);
    EXPECT_EQ(reader.header.alpha, package::AlphaPolicy::Tested);
    EXPECT_EQ(reader.header.caseCount, compiled.plan.cases.size());
    EXPECT_EQ(reader.header.interopHash, static_cast<std::uint32_t>(compiler::interopSourceHash()));

    const auto strings = reader.read<char>(SectionKind::Strings);
    const auto text = [&](package::StringRef ref) {
        EXPECT_LE(ref.offset + ref.length, strings.size());
        return std::string(strings.data() + ref.offset, ref.length);
    };
    const auto modules = reader.read<package::ModuleEntry>(SectionKind::Modules);
    ASSERT_EQ(modules.size(), compiled.modules.size());
    for (std::size_t i = 0; i < modules.size(); ++i) {
        const compiler::PackageFile* const spirv = findFile(compiled, text(modules[i].file));
        ASSERT_NE(spirv, nullptr) << text(modules[i].file);
        EXPECT_EQ(spirv->bytes.size(), modules[i].bytes);
        EXPECT_EQ(base::hashBytes(spirv->bytes), modules[i].hash);
    }
    const auto cases = reader.read<package::CaseEntry>(SectionKind::Cases);
    ASSERT_EQ(cases.size(), compiled.plan.cases.size());
    EXPECT_EQ(text(cases[1].name), compiled.plan.cases[1].name);
    EXPECT_EQ(reader.count(SectionKind::Materials), 4U);
    const auto fields = reader.read<package::FieldEntry>(SectionKind::Fields);
    const compiler::MaterialLayout layout = compiler::materialLayoutOf(compiled.plan);
    ASSERT_EQ(fields.size(), layout.fields.size() + layout.textures.size());
    EXPECT_EQ(text(fields[0].name), layout.fields[0].name);
    EXPECT_EQ(fields.back().offset + fields.back().bytes, layout.bytes);

    const auto samplers = reader.read<package::SamplerEntry>(SectionKind::Samplers);
    ASSERT_EQ(samplers.size(), 2U);
    EXPECT_EQ(samplers[1].wrapU, 2U);
    EXPECT_EQ(samplers[1].mipmapped, 0U);
}

TEST(Tables, GivePrimitivesTheFlagsOfTheirMaterial) {
    for (const package::AlphaPolicy alpha : {package::AlphaPolicy::Opaque, package::AlphaPolicy::Tested}) {
        compiler::CompileSettings settings;
        settings.strategies = package::kStrategyUber;
        settings.plan.keys.alpha = alpha;
        const compiler::CompiledPackage compiled = compileSample(settings);
        const compiler::PackageFile* const file = findFile(compiled, package::kTablesFile);
        ASSERT_NE(file, nullptr);
        const auto primitives =
            TableReader(file->bytes).read<package::PrimitiveEntry>(SectionKind::Primitives);
        ASSERT_EQ(primitives.size(), 4U);
        EXPECT_EQ(primitives[0].geometryFlags, 0U);
        EXPECT_EQ(primitives[1].geometryFlags, gpu::kGeometryDoubleSided);
        const std::uint32_t tested = alpha == package::AlphaPolicy::Tested ? gpu::kGeometryAlphaTested : 0U;
        EXPECT_EQ(primitives[3].geometryFlags, gpu::kGeometryMasked | tested);
        EXPECT_EQ(primitives[3].alphaMode, 1U);
        for (std::uint32_t i = 0; i < 4; ++i) {
            EXPECT_EQ(primitives[i].primitive, i);
            EXPECT_EQ(primitives[i].materialIndex, i);
            const compiler::Key& key = compiled.plan.keys[compiled.plan.keyOfPrimitive[i]];
            EXPECT_EQ(compiled.plan.model->maskOf(primitives[i].key), key.mask);
            EXPECT_EQ(primitives[i].shaderId, static_cast<std::uint32_t>(key.shaderId));
        }
    }
}

// Scenes share cases but have their own tables: materials and textures of each count from 0.
TEST(Tables, GoSceneByScene) {
    std::vector<gltf::Scene> scenes{makeSampleScene(), makeSampleScene()};
    scenes[1].materials[0]["clearcoatFactor"] = 1.0F;
    compiler::CompileSettings settings;
    settings.strategies = package::kStrategyUber;
    settings.plan.merge = compiler::MergePolicy::None;
    const compiler::CompiledPackage compiled = must(compilePackage(scenes, settings, &sharedModules()));
    const TableReader reader(findFile(compiled, package::kTablesFile)->bytes);
    const auto entries = reader.read<package::SceneEntry>(SectionKind::Scenes);
    ASSERT_EQ(entries.size(), 2U);
    EXPECT_EQ(entries[1].firstMaterial, 4U);
    EXPECT_EQ(entries[1].materialCount, 4U);
    EXPECT_EQ(entries[1].firstPrimitive, 4U);
    const auto primitives = reader.read<package::PrimitiveEntry>(SectionKind::Primitives);
    ASSERT_EQ(primitives.size(), 8U);
    ASSERT_EQ(reader.count(SectionKind::Materials), 8U);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(primitives[4 + i].materialIndex, i);
        EXPECT_EQ(primitives[4 + i].shaderId == primitives[i].shaderId, i != 0);
    }
    const std::size_t keysOfOne = compileSample(settings).plan.keys.size();
    EXPECT_EQ(compiled.plan.keys.size(), keysOfOne + 1);
}

// Hits may keep fewer lobes, but the mask on the device is that of primary surfaces.
TEST(Tables, GivePrimitivesTheirPrimaryMask) {
    gltf::Scene scene = makeSampleScene();
    scene.materials[0]["clearcoatFactor"] = 1.0F;
    compiler::CompileSettings settings;
    settings.plan.keys.keptLobes = 0;
    const gltf::SceneList scenes({&scene, 1});
    const compiler::Plan plan = makePlan(scenes.materials(), scenes.primitives(), settings.plan);
    const base::Bytes bytes = makeTables(scenes, plan, {}, settings);
    const auto primitives = TableReader(bytes).read<package::PrimitiveEntry>(SectionKind::Primitives);
    ASSERT_EQ(primitives.size(), 4U);
    EXPECT_EQ(primitives[0].key.lobes, bit("clearcoat").shared());
    EXPECT_EQ((plan.always | plan.sometimes) & bit("clearcoat"), 0U);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(plan.model->maskOf(primitives[i].key), plan.primaryMaskOfPrimitive[i]);
    }
}

TEST(CheckScene, RefusesIndicesThatLeadNowhere) {
    const auto idAfter = [](auto change) {
        gltf::Scene scene = makeSampleScene();
        change(scene);
        const Result<compiler::CompiledPackage> compiled =
            compiler::compilePackage(scene, {}, &sharedModules());
        return compiled ? std::string("none") : compiled.error().id;
    };
    EXPECT_EQ(idAfter([](gltf::Scene& scene) { scene.textures[0].image = 2; }), "scene-index");
    EXPECT_EQ(idAfter([](gltf::Scene& scene) { scene.textures[1].sampler = -1; }), "scene-index");
    EXPECT_EQ(idAfter([](gltf::Scene& scene) { scene.materials[1].textures[0].texture = 9; }), "scene-index");
    EXPECT_EQ(idAfter([](gltf::Scene& scene) { scene.meshes[0].primitives[0].material = 4; }), "scene-index");
}

}  // namespace
}  // namespace glint
