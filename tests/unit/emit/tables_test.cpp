#include "emit/tables.h"

#include "emit/sources.h"
#include "unit/emit/sample_scene.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cstring>
#include <map>

namespace glint {
namespace {

using namespace glint::testing;
using package::SectionKind;

// tables.bin, read by its own description.
class TableReader {
public:
    explicit TableReader(const Bytes& bytes) : bytes_(bytes) {
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

    package::PackageHeader header{};

private:
    const Bytes& bytes_;
    std::map<SectionKind, package::PackageSection> sections_;
};

TEST(MaterialTables, ListEachImageOncePerColourSpace) {
    const MaterialTables tables = makeMaterialTables(makeSampleScene());
    ASSERT_EQ(tables.textures.size(), 3U);
    EXPECT_EQ(tables.textures[0].image, 0U);
    EXPECT_EQ(tables.textures[0].srgb, 1U);
    EXPECT_EQ(tables.textures[1].image, 1U);
    EXPECT_EQ(tables.textures[1].srgb, 1U);
    EXPECT_EQ(tables.textures[2].image, 1U);
    EXPECT_EQ(tables.textures[2].srgb, 0U);
    const auto slots = [&](int material) { return tables.materials[material].textures; };
    EXPECT_EQ(slots(1)[gpu::kTextureBaseColor].textureIndex, 0U);
    EXPECT_EQ(slots(2)[gpu::kTextureBaseColor].textureIndex, 1U);
    EXPECT_EQ(slots(2)[gpu::kTextureBaseColor].samplerIndex, 1U);
    EXPECT_EQ(slots(2)[gpu::kTextureOcclusion].textureIndex, 2U);
    EXPECT_EQ(slots(3)[gpu::kTextureBaseColor].textureIndex, 0U);
}

TEST(MaterialTables, LeaveEmptySlotsZero) {
    const MaterialTables tables = makeMaterialTables(makeSampleScene());
    using Words = std::array<std::uint32_t, sizeof(gpu::TextureRecord) / sizeof(std::uint32_t)>;
    for (const gpu::TextureRecord& record : tables.materials[0].textures) {
        EXPECT_EQ(std::bit_cast<Words>(record), Words{});
    }
}

// A quarter turn counter-clockwise on the image, whose v points down, takes (1, 0) to (0, -1).
TEST(MaterialTables, TransformScalesThenTurnsThenMoves) {
    const MaterialTables tables = makeMaterialTables(makeSampleScene());
    const gpu::TextureRecord& record = tables.materials[2].textures[gpu::kTextureOcclusion];
    const auto apply = [&](float u, float v) {
        return std::pair(record.rowU.x * u + record.rowU.y * v + record.rowU.z,
                         record.rowV.x * u + record.rowV.y * v + record.rowV.z);
    };
    // Scale (2, 3), then the turn, then (0.25, 0.5).
    const auto [u1, v1] = apply(1, 0);
    EXPECT_NEAR(u1, 0.25, 1e-6);
    EXPECT_NEAR(v1, -2 + 0.5, 1e-6);
    const auto [u2, v2] = apply(0, 1);
    EXPECT_NEAR(u2, 3 + 0.25, 1e-6);
    EXPECT_NEAR(v2, 0.5, 1e-6);
    const gpu::TextureRecord& identity = tables.materials[2].textures[gpu::kTextureBaseColor];
    EXPECT_EQ(identity.rowU.x, 1.0F);
    EXPECT_EQ(identity.rowU.y, 0.0F);
    EXPECT_EQ(identity.rowV.x, 0.0F);
    EXPECT_EQ(identity.rowV.y, 1.0F);
}

TEST(Tables, HoldWhatTheHeaderSays) {
    CompileSettings settings;
    settings.plan.keys.alpha = AlphaPolicy::Tested;
    settings.plan.merge = MergePolicy::None;
    const CompiledPackage compiled = compileSample(settings);
    const PackageFile* const file = findFile(compiled, package::kTablesFile);
    ASSERT_NE(file, nullptr);
    const TableReader reader(file->bytes);
    EXPECT_EQ(std::memcmp(reader.header.magic, "GLINTPKG", 8), 0);
    EXPECT_EQ(reader.header.version, package::kVersion);
    EXPECT_EQ(reader.header.fileBytes, file->bytes.size());
    EXPECT_EQ(reader.header.contentHash,
              hashBytes(std::span(file->bytes).subspan(sizeof(package::PackageHeader))));
    EXPECT_EQ(reader.header.strategies, settings.strategies);
    EXPECT_EQ(reader.header.alphaTested, 1U);
    EXPECT_EQ(reader.header.caseCount, compiled.plan.cases.size());
    EXPECT_EQ(reader.header.interopHash, static_cast<std::uint32_t>(interopHash()));

    const auto strings = reader.read<char>(SectionKind::Strings);
    const auto text = [&](package::StringRef ref) {
        EXPECT_LE(ref.offset + ref.length, strings.size());
        return std::string(strings.data() + ref.offset, ref.length);
    };
    const auto modules = reader.read<package::ModuleEntry>(SectionKind::Modules);
    ASSERT_EQ(modules.size(), compiled.modules.size());
    for (std::size_t i = 0; i < modules.size(); ++i) {
        const PackageFile* const spirv = findFile(compiled, text(modules[i].file));
        ASSERT_NE(spirv, nullptr) << text(modules[i].file);
        EXPECT_EQ(spirv->bytes.size(), modules[i].bytes);
        EXPECT_EQ(hashBytes(spirv->bytes), modules[i].hash);
    }
    const auto cases = reader.read<package::CaseEntry>(SectionKind::Cases);
    ASSERT_EQ(cases.size(), compiled.plan.cases.size());
    EXPECT_EQ(text(cases[1].name), compiled.plan.cases[1].name);
    EXPECT_EQ(reader.read<gpu::MaterialRecord>(SectionKind::Materials).size(), 4U);

    const auto samplers = reader.read<package::SamplerEntry>(SectionKind::Samplers);
    ASSERT_EQ(samplers.size(), 2U);
    EXPECT_EQ(samplers[1].wrapU, 2U);
    EXPECT_EQ(samplers[1].mipmapped, 0U);
}

TEST(Tables, GivePrimitivesTheFlagsOfTheirMaterial) {
    for (const AlphaPolicy alpha : {AlphaPolicy::Opaque, AlphaPolicy::Tested}) {
        CompileSettings settings;
        settings.strategies = package::kStrategyUber;
        settings.plan.keys.alpha = alpha;
        const CompiledPackage compiled = compileSample(settings);
        const PackageFile* const file = findFile(compiled, package::kTablesFile);
        ASSERT_NE(file, nullptr);
        const auto primitives =
            TableReader(file->bytes).read<package::PrimitiveEntry>(SectionKind::Primitives);
        ASSERT_EQ(primitives.size(), 4U);
        EXPECT_EQ(primitives[0].geometryFlags, 0U);
        EXPECT_EQ(primitives[1].geometryFlags, gpu::kGeometryDoubleSided);
        const std::uint32_t tested = alpha == AlphaPolicy::Tested ? gpu::kGeometryAlphaTested : 0U;
        EXPECT_EQ(primitives[3].geometryFlags, gpu::kGeometryMasked | tested);
        EXPECT_EQ(primitives[3].alphaMode, 1U);
        for (std::uint32_t i = 0; i < 4; ++i) {
            EXPECT_EQ(primitives[i].primitive, i);
            EXPECT_EQ(primitives[i].materialIndex, i);
            const Key& key = compiled.plan.keys[compiled.plan.keyOfPrimitive[i]];
            EXPECT_EQ(primitives[i].featureLobes | FeatureMask{primitives[i].featureInputs} << 32U, key.mask);
            EXPECT_EQ(primitives[i].shaderId, static_cast<std::uint32_t>(key.shaderId));
        }
    }
}

TEST(CheckScene, RefusesIndicesThatLeadNowhere) {
    const auto idAfter = [](auto change) {
        Scene scene = makeSampleScene();
        change(scene);
        const Result<CompiledPackage> compiled = compilePackage(scene, {});
        return compiled ? std::string("none") : compiled.error().id;
    };
    EXPECT_EQ(idAfter([](Scene& scene) { scene.textures[0].image = 2; }), "scene-index");
    EXPECT_EQ(idAfter([](Scene& scene) { scene.textures[1].sampler = -1; }), "scene-index");
    EXPECT_EQ(idAfter([](Scene& scene) { scene.materials[1].textures[0].texture = 9; }), "scene-index");
    EXPECT_EQ(idAfter([](Scene& scene) { scene.meshes[0].primitives[0].material = 4; }), "scene-index");
}

}  // namespace
}  // namespace glint
