// The loader accepts what a compiler writes, and nothing else.
#include "package/package.h"

#include "package_builder.h"
#include "support/must.h"

#include <glint/package.h>

#include <gtest/gtest.h>

#include <cstddef>
#include <cstring>
#include <fstream>
#include <functional>

namespace glint {
namespace {

using package::ModuleRole;
using test::PackageSpec;

class PackageTest : public testing::Test {
protected:
    void write(const PackageSpec& spec) {
        test::writePackage(spec, folder_.path());
    }
    // Returns the ID of the error, or "" for a package that loads.
    std::string load() {
        const Result<Package> loaded = Package::load(folder_.path());
        if (loaded) {
            return "";
        }
        EXPECT_FALSE(loaded.error().where.empty());
        EXPECT_FALSE(loaded.error().message.empty());
        EXPECT_FALSE(loaded.error().hint.empty());
        return loaded.error().id;
    }
    std::string loadTables(const std::vector<std::uint8_t>& bytes) {
        test::writeBytes(folder_.path() / package::kTablesFile, bytes);
        return load();
    }

    test::TemporaryFolder folder_;
};

PackageSpec makeRichSpec() {
    PackageSpec spec = test::makeSpec();
    spec.alpha = package::AlphaPolicy::Tested;
    spec.precision = package::ShadingPrecision::Half;
    spec.textures = {{0, 1, {}}, {0, 0, {}}};
    spec.samplers = {{0, 1, 1, 1, 1, 1}};
    spec.materials[0].textures[0].textureIndex = 1;
    spec.primitives = {test::makePrimitive(0, 0, gpu::kGeometryAlphaTested), test::makePrimitive(2, 1)};
    spec.fields = {{{}, 0, 4, 0, 0}, {{}, 4, sizeof(gpu::TextureRecord), 0, 0}};
    return spec;
}

void removeRole(PackageSpec& spec, ModuleRole role) {
    std::erase_if(spec.modules, [&](const test::ModuleSpec& module) { return module.key.role == role; });
}

TEST_F(PackageTest, LoadsAValidPackage) {
    PackageSpec spec = makeRichSpec();
    spec.caseCount = 2;
    spec.cases.push_back({0b01, 0b10, "Textured"});
    spec.modules.push_back({{package::roleNamed("ShadeCase"), 1, package::kTracerRayQuery},
                            "shade_case.comp.spv",
                            spec.modules[0].words});
    test::ModuleSpec first =
        *std::ranges::find(spec.modules, package::ModuleRole::FirstHit,
                           [](const test::ModuleSpec& module) { return module.key.role; });
    first.key.index = 1;
    spec.modules.push_back(first);
    spec.primitives[1].shaderId = 1;
    spec.primitives[1].key.lobes = 0b11;
    write(spec);
    const Package loaded = must(Package::load(folder_.path()));
    const Package& package = loaded;
    EXPECT_TRUE(package.supports(package::kStrategyUber));
    EXPECT_TRUE(package.supports(package::kStrategyVisibility));
    EXPECT_TRUE(package.alphaTested());
    ASSERT_EQ(package.fields().size(), 2U);
    EXPECT_EQ(package.string(package.fields()[1].name), "field 4");
    EXPECT_EQ(package.precision(), package::ShadingPrecision::Half);
    EXPECT_EQ(package.caseCount(), 2U);
    EXPECT_EQ(package.bucketCount(), 3U);
    EXPECT_EQ(package.string(package.cases()[1].name), "Textured");
    ASSERT_EQ(package.sceneCount(), 1U);
    const PackageScene scene = package.scene(0);
    EXPECT_EQ(test::materialAt(scene.materials, 0).textures[0].textureIndex, 1U);
    EXPECT_EQ(package.spirv({ModuleRole::Trace, 0, package::kTracerRayQuery}).size(), 5U);
    EXPECT_EQ(package.spirv({package::roleNamed("ShadeCase"), 0, package::kTracerRayQuery}).data(),
              package.spirv({package::roleNamed("ShadeCase"), 1, package::kTracerRayQuery}).data());
    EXPECT_TRUE(package.spirv({package::roleNamed("ShadeCase"), 2, package::kTracerRayQuery}).empty());
    ASSERT_NE(scene.findPrimitive(2, 1), nullptr);
    EXPECT_EQ(scene.findPrimitive(2, 1)->shaderId, 1U);
    EXPECT_EQ(scene.findPrimitive(2, 0), nullptr);
    EXPECT_EQ(scene.findPrimitive(3, 0), nullptr);
}

// Scenes share the cases. The primitives of each scene count materials from the scene's own first one.
TEST_F(PackageTest, ScenesHaveTheirOwnTables) {
    PackageSpec spec = test::makeSpec();
    spec.materials.resize(3);
    spec.materials[1].roughnessFactor = 0.25F;
    spec.primitives = {test::makePrimitive(0, 0), test::makePrimitive(0, 0), test::makePrimitive(0, 1)};
    spec.primitives[2].materialIndex = 1;
    spec.scenes = {{"one", 1, 1, 0, 0}, {"two", 2, 2, 0, 0}};
    write(spec);
    const Package package = must(Package::load(folder_.path()));
    ASSERT_EQ(package.sceneCount(), 2U);
    EXPECT_EQ(package.scene(0).name, "one");
    EXPECT_EQ(package.scene(0).findPrimitive(0, 1), nullptr);
    ASSERT_EQ(package.findScene("two"), 1U);
    EXPECT_FALSE(package.findScene("three"));
    const PackageScene two = package.scene(1);
    ASSERT_EQ(two.materials.size(), 2U);
    EXPECT_EQ(test::materialAt(two.materials, 0).roughnessFactor, 0.25F);
    ASSERT_NE(two.findPrimitive(0, 1), nullptr);
    EXPECT_EQ(two.findPrimitive(0, 1)->materialIndex, 1U);
}

TEST_F(PackageTest, RefusesScenesThatDoNotDivideTheTables) {
    const auto refused = [&](const std::vector<test::SceneSpec>& scenes) {
        PackageSpec spec = test::makeSpec();
        spec.materials.resize(2);
        spec.scenes = scenes;
        write(spec);
        const Result<Package> package = Package::load(folder_.path());
        return package ? std::string() : package.error().id;
    };
    EXPECT_EQ(refused({{"one", 1, 1, 0, 0}, {"two", 1, 0, 0, 0}}), "");
    EXPECT_EQ(refused({{"one", 1, 1, 0, 0}}), "package-altered");                       // one is left over
    EXPECT_EQ(refused({{"one", 1, 1, 0, 0}, {"two", 2, 0, 0, 0}}), "package-altered");  // too many
    EXPECT_EQ(refused({{"one", 1, 1, 0, 0}, {"one", 1, 0, 0, 0}}), "package-altered");  // one name
    EXPECT_EQ(refused({{"one", 0, 1, 0, 0}, {"two", 2, 0, 0, 0}}), "package-altered");  // material of another
    EXPECT_EQ(refused({{"one", 2, 1, 0, 0}, {"two", 0xFFFFFFFF, 0, 0, 0}, {"three", 1, 0, 0, 0}}),
              "package-altered");
}

TEST_F(PackageTest, SaysWhichEffectsItHas) {
    write(test::makeSpec());
    const Result<Package> package = Package::load(folder_.path());
    ASSERT_TRUE(package) << toString(package.error());
    ASSERT_EQ(package->effects().size(), 2U);
    EXPECT_EQ(package->effects()[0].name, "shadow");
    EXPECT_EQ(package->effect("reflection"), package::Effect{4});
    EXPECT_EQ(package->effect("glow"), package::Effect{0});
    EXPECT_EQ(package->shape().effects.all, 5U);
    EXPECT_EQ(package->shape().effects.screenStarts, 4U);
}

TEST_F(PackageTest, RefusesEffectsThatAreNotWellFormed) {
    const auto refused = [&](const auto& change) {
        PackageSpec spec = test::makeSpec();
        change(spec.effects);
        write(spec);
        return load();
    };
    using Effects = std::vector<package::EffectEntry>;
    EXPECT_EQ(refused([](Effects& effects) { effects[1].effect = 6; }), "package-altered");  // two bits
    EXPECT_EQ(refused([](Effects& effects) { effects[1].effect = 0; }), "package-altered");
    EXPECT_EQ(refused([](Effects& effects) { effects[1].effect = 1; }), "package-altered");  // twice
    EXPECT_EQ(refused([](Effects& effects) { effects[1].kind = package::EffectInfo::Kind{3}; }),
              "package-altered");
    EXPECT_EQ(refused([](Effects& effects) { effects[1].abilities = 4; }), "package-altered");
    EXPECT_EQ(refused([](Effects& effects) { effects[0].abilities = package::kEffectWalks; }),
              "package-altered");  // lights have no rays to follow
    // Its modules would be missing.
    EXPECT_EQ(refused([](Effects& effects) { effects[1].abilities |= package::kEffectWalks; }),
              "package-altered");
    EXPECT_EQ(refused([](Effects& effects) {
                  effects.push_back({{}, 8, package::EffectInfo::Kind::Rays, 0, 0});
              }),
              "package-altered");
}

// A lock file keeps this shader ID for keys that are gone.
TEST_F(PackageTest, RetiredCasesNeedNoModules) {
    PackageSpec spec = test::makeSpec();
    spec.caseCount = 2;
    spec.cases.push_back({0, 0, "Retired", 0});
    write(spec);
    const Package package = must(Package::load(folder_.path()));
    EXPECT_EQ(package.bucketCount(), 3U);
    EXPECT_EQ(package.shape().retired, std::vector<std::uint32_t>{1});

    spec.primitives[0].shaderId = 1;
    write(spec);
    EXPECT_EQ(mustFail(Package::load(folder_.path())).id, "package-altered");
}

// Runs the checks without files. Returns the ID of the error, or "".
std::string checkBytes(std::vector<std::uint8_t> bytes) {
    Package::State state;
    state.tables = std::move(bytes);
    Status status = readTables(state, "tables.bin");
    if (status) {
        status = checkTables(state, "tables.bin");
    }
    return status ? "" : status.error().id;
}

TEST_F(PackageTest, EveryTruncationIsAnError) {
    write(makeRichSpec());
    const std::vector<std::uint8_t> whole = test::serialize(makeRichSpec());
    ASSERT_EQ(loadTables(whole), "");
    for (std::size_t size = 0; size < whole.size(); ++size) {
        ASSERT_EQ(checkBytes({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)}),
                  "package-truncated")
            << size << " bytes";
    }
    for (const std::size_t size : {std::size_t{0}, std::size_t{7}, std::size_t{47}, whole.size() - 1}) {
        EXPECT_EQ(loadTables({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)}),
                  "package-truncated");
    }
    std::vector<std::uint8_t> longer = whole;
    longer.push_back(0);
    EXPECT_EQ(loadTables(longer), "package-altered");
}

TEST_F(PackageTest, EveryFlippedBitIsAnError) {
    const std::vector<std::uint8_t> whole = test::serialize(makeRichSpec());
    ASSERT_EQ(checkBytes(whole), "");
    for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
        std::vector<std::uint8_t> flipped = whole;
        flipped[bit / 8] = static_cast<std::uint8_t>(flipped[bit / 8] ^ (1U << bit % 8));
        ASSERT_NE(checkBytes(flipped), "") << "byte " << bit / 8 << ", bit " << bit % 8;
    }
}

// Whoever alters a section can also correct the hash, so nothing behind the hash may be trusted either.
TEST_F(PackageTest, ResealedGarbageIsNoCrash) {
    const std::vector<std::uint8_t> whole = test::serialize(makeRichSpec());
    int refused = 0;
    for (std::size_t byte = sizeof(package::PackageHeader); byte < whole.size(); ++byte) {
        for (int value = 0; value < 256; ++value) {
            std::vector<std::uint8_t> altered = whole;
            altered[byte] = static_cast<std::uint8_t>(value);
            test::reseal(altered);
            refused += checkBytes(altered).empty() ? 0 : 1;
        }
    }
    EXPECT_GT(refused, 50000);
}

TEST_F(PackageTest, FoldersThatAreNoPackage) {
    EXPECT_EQ(load(), "package-missing");
    EXPECT_EQ(mustFail(Package::load(folder_.path() / "nowhere")).id, "package-missing");
    EXPECT_EQ(loadTables({'P', 'N', 'G', ' ', 'f', 'i', 'l', 'e', '!'}), "package-foreign");
    EXPECT_EQ(loadTables(std::vector<std::uint8_t>(4096, 0)), "package-foreign");
    std::filesystem::remove(folder_.path() / package::kTablesFile);
    std::filesystem::create_directory(folder_.path() / package::kTablesFile);
    EXPECT_EQ(load(), "package-missing");
}

TEST_F(PackageTest, OtherVersionsAreNamed) {
    PackageSpec spec = test::makeSpec();
    spec.version = package::kVersion + 1;
    write(spec);
    const Diagnostic newer = mustFail(Package::load(folder_.path()));
    EXPECT_EQ(newer.id, "package-version");
    EXPECT_NE(newer.message.find(std::to_string(package::kVersion + 1)), std::string::npos);
    spec = test::makeSpec();
    spec.interopHash ^= 1;
    write(spec);
    EXPECT_EQ(load(), "package-version");
}

TEST_F(PackageTest, ModulesAreChecked) {
    const PackageSpec spec = test::makeSpec();
    write(spec);
    const std::filesystem::path module = folder_.path() / spec.modules[3].file;
    std::filesystem::remove(module);
    EXPECT_EQ(load(), "package-module-missing");
    write(spec);
    std::filesystem::resize_file(module, 16);
    EXPECT_EQ(load(), "package-module-altered");
    write(spec);
    std::filesystem::resize_file(module, 24);
    EXPECT_EQ(load(), "package-module-altered");
    write(spec);
    test::writeBytes(module, std::vector<std::uint8_t>(20, 7));
    EXPECT_EQ(load(), "package-module-altered");
}

TEST_F(PackageTest, ModulesMustBeSpirv) {
    PackageSpec spec = test::makeSpec();
    spec.modules[3].words[0] = 1;
    write(spec);
    EXPECT_EQ(load(), "package-module-altered");
    spec.modules[3].words.clear();
    write(spec);
    EXPECT_EQ(load(), "package-module-altered");
}

TEST_F(PackageTest, ModuleNamesStayInTheFolder) {
    const std::filesystem::path inside = folder_.path() / "package";
    std::filesystem::create_directory(inside);
    for (const std::string name :
         {"../gbuffer.vert.spv", "/etc/hostname", "a/../../b.spv", "", ".", "..", "a\\b", "./a.spv"}) {
        PackageSpec spec = test::makeSpec();
        spec.modules[0].file = name;
        test::writeModules(test::makeSpec(), inside);
        test::writeModules(test::makeSpec(), folder_.path());
        test::writeBytes(inside / package::kTablesFile, test::serialize(spec));
        const Result<Package> loaded = Package::load(inside);
        ASSERT_FALSE(loaded) << name;
        EXPECT_EQ(loaded.error().id, "package-file-name") << name;
    }
}

TEST_F(PackageTest, LinksThatLeaveTheFolderAreRefused) {
    const std::filesystem::path inside = folder_.path() / "package";
    std::filesystem::create_directory(inside);
    const PackageSpec spec = test::makeSpec();
    test::writePackage(spec, inside);
    test::writeModules(spec, folder_.path());
    std::filesystem::remove(inside / spec.modules[0].file);
    std::filesystem::create_symlink(folder_.path() / spec.modules[0].file, inside / spec.modules[0].file);
    EXPECT_EQ(mustFail(Package::load(inside)).id, "package-file-name");
}

// Each change breaks one promise of an otherwise valid package.
TEST_F(PackageTest, BrokenPromisesAreErrors) {
    const std::pair<const char*, std::function<void(PackageSpec&)>> breaks[] = {
        {"shader ID", [](PackageSpec& s) { s.primitives[0].shaderId = 1; }},
        {"material", [](PackageSpec& s) { s.primitives[0].materialIndex = 1; }},
        {"texture", [](PackageSpec& s) { s.materials[0].textures[1].textureIndex = 2; }},
        {"sampler", [](PackageSpec& s) { s.materials[0].textures[1].samplerIndex = 1; }},
        {"UV set", [](PackageSpec& s) { s.materials[0].textures[1].texCoord = 2; }},
        {"colour space", [](PackageSpec& s) { s.textures[0].srgb = 2; }},
        {"dimension", [](PackageSpec& s) { s.textures[0].dimension = package::TextureEntry::Dimension{4}; }},
        {"wrap", [](PackageSpec& s) { s.samplers[0].wrapV = 3; }},
        {"filter", [](PackageSpec& s) { s.samplers[0].mip = 2; }},
        {"order", [](PackageSpec& s) { std::swap(s.primitives[0], s.primitives[1]); }},
        {"twice", [](PackageSpec& s) { s.primitives[1] = s.primitives[0]; }},
        {"alpha policy", [](PackageSpec& s) { s.alpha = package::AlphaPolicy::Opaque; }},
        {"alpha policy value", [](PackageSpec& s) { s.alpha = package::AlphaPolicy{3}; }},
        {"precision", [](PackageSpec& s) { s.precision = package::ShadingPrecision{2}; }},
        {"geometry flags", [](PackageSpec& s) { s.primitives[0].geometryFlags |= 1U << 31; }},
        {"alpha mode", [](PackageSpec& s) { s.primitives[0].alphaMode = 3; }},
        {"key short of its case",
         [](PackageSpec& s) {
             s.cases[0].always |= std::uint64_t{1} << 40;
             s.cases[0].sometimes &= ~(std::uint64_t{1} << 40);
         }},
        {"field beyond the record", [](PackageSpec& s) { s.fields[1].offset = sizeof(test::TestMaterial); }},
        {"fields in each other", [](PackageSpec& s) { s.fields[1].offset = 0; }},
        {"empty field", [](PackageSpec& s) { s.fields[0].bytes = 0; }},
        {"feature without a bit", [](PackageSpec& s) { s.features[0].feature = {}; }},
        {"role that no feature has", [](PackageSpec& s) { s.features.pop_back(); }},
        {"role of two features", [](PackageSpec& s) { s.features[0].role = s.features[1].role; }},
        {"role of parameters",
         [](PackageSpec& s) {
             s.features.push_back({{1}, {}, package::Role::Emission});
         }},
        {"unknown role of a feature", [](PackageSpec& s) { s.features[0].role = package::Role{99}; }},
        {"case count", [](PackageSpec& s) { s.caseCount = 0; }},
        {"case features",
         [](PackageSpec& s) {
             s.cases[0] = {1, 1, "Both"};
         }},
        {"no strategy", [](PackageSpec& s) { s.strategies = 0; }},
        {"unknown strategy", [](PackageSpec& s) { s.strategies |= 16; }},
        {"no tracer", [](PackageSpec& s) { s.tracers = 0; }},
        {"unknown tracer", [](PackageSpec& s) { s.tracers |= 4; }},
        {"tracer without modules", [](PackageSpec& s) { s.tracers = package::kAllTracers; }},
        {"strategy without modules", [](PackageSpec& s) { removeRole(s, package::roleNamed("UberShade")); }},
        {"modules without strategy", [](PackageSpec& s) { s.strategies = package::kStrategyUber; }},
        {"case without module", [](PackageSpec& s) { removeRole(s, package::roleNamed("ShadeCase")); }},
        {"pass without module", [](PackageSpec& s) { removeRole(s, ModuleRole::FirstMiss); }},
        {"module twice", [](PackageSpec& s) { s.modules.push_back(s.modules[0]); }},
        {"unknown role", [](PackageSpec& s) { s.modules[12].key.role = ModuleRole{99}; }},
        {"module's shader ID", [](PackageSpec& s) { s.modules.back().key.index = 1; }},
    };
    write(makeRichSpec());
    ASSERT_EQ(load(), "");
    for (const auto& [name, change] : breaks) {
        PackageSpec spec = makeRichSpec();
        change(spec);
        write(spec);
        EXPECT_EQ(load(), "package-altered") << name;
    }
}

TEST_F(PackageTest, SectionsAreBounded) {
    write(makeRichSpec());
    const std::vector<std::uint8_t> whole = test::serialize(makeRichSpec());
    const auto withSection = [&](const std::function<void(package::PackageSection&)>& change) {
        std::vector<std::uint8_t> bytes = whole;
        package::PackageSection section{};
        std::memcpy(&section, bytes.data() + sizeof(package::PackageHeader), sizeof(section));
        change(section);
        std::memcpy(bytes.data() + sizeof(package::PackageHeader), &section, sizeof(section));
        test::reseal(bytes);
        return loadTables(bytes);
    };
    EXPECT_EQ(withSection([](auto& section) { section.offset = ~0ULL - 7; }), "package-altered");
    EXPECT_EQ(withSection([](auto& section) { section.offset += 4; }), "package-altered");
    EXPECT_EQ(withSection([](auto& section) { section.count = ~0ULL; }), "package-altered");
    // Times 32 bytes, this overflows to 0.
    EXPECT_EQ(withSection([](auto& section) { section.count = 1ULL << 59; }), "package-altered");
    EXPECT_EQ(withSection([](auto& section) { section.elementBytes = 1; }), "package-altered");
    EXPECT_EQ(withSection([](auto& section) { section.kind = package::SectionKind::Cases; }),
              "package-altered");
    EXPECT_EQ(withSection([](auto& section) { section.kind = package::SectionKind{99}; }), "package-altered");
}

TEST_F(PackageTest, OneStrategyIsEnough) {
    PackageSpec spec = test::makeSpec();
    spec.strategies = package::kStrategyUber;
    for (const package::RoleInfo& info : package::roles()) {
        if ((info.strategies & package::kStrategyUber) == 0) {
            removeRole(spec, info.role);
        }
    }
    write(spec);
    const Package loaded = must(Package::load(folder_.path()));
    EXPECT_FALSE(loaded.supports(package::kStrategyVisibility));
    EXPECT_TRUE(loaded.spirv({ModuleRole::Trace, 0, package::kTracerRayQuery}).empty());
}

}  // namespace
}  // namespace glint
