// Tests which shaders of two packages belong together, without packages.
#include "inspect/diff.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace glint::inspect {
namespace {

using Key = std::vector<std::string>;
using Kind = inspect::ShaderChangeKind;

const package::ModuleKey kShade{package::roleNamed("ShadeCase"), 0, package::kTracerRayQuery};

inspect::DiffCase makeCase(const std::string& name, const std::set<Key>& keys, std::uint64_t code) {
    inspect::DiffCase shader{name, keys};
    shader.modules[kShade] = {name + ".spv", code, {}};
    return shader;
}

inspect::DiffPackage makePackage(std::map<int, inspect::DiffCase> cases) {
    inspect::DiffPackage package;
    package.scenes = {"room"};
    package.cases = std::move(cases);
    return package;
}

inspect::ShaderChange only(const inspect::PackageDiff& diff) {
    EXPECT_EQ(diff.shaders.size(), 1U);
    return diff.shaders.empty() ? inspect::ShaderChange{} : diff.shaders.front();
}

TEST(DiffCompare, OneCaseWithOneOther) {
    const inspect::DiffPackage before = makePackage({{0, makeCase("A", {{"a"}, {"b"}}, 1)}});
    EXPECT_TRUE(comparePackages(before, before).isEmpty());

    const inspect::DiffPackage moved = makePackage({{2, makeCase("B", {{"a"}, {"b"}}, 1)}});
    EXPECT_EQ(only(comparePackages(before, moved)).kind, Kind::Moved);
    EXPECT_EQ(comparePackages(before, moved).sameModules, 1U);

    const inspect::DiffPackage renamed = makePackage({{0, makeCase("B", {{"a"}, {"b"}}, 1)}});
    EXPECT_EQ(only(comparePackages(before, renamed)).kind, Kind::Renamed);

    const inspect::DiffPackage grown = makePackage({{0, makeCase("A", {{"b"}, {"c"}}, 2)}});
    const inspect::PackageDiff diff = comparePackages(before, grown);
    EXPECT_EQ(only(diff).kind, Kind::Keys);
    EXPECT_EQ(only(diff).keysAdded, std::vector<Key>{{"c"}});
    EXPECT_EQ(only(diff).keysRemoved, std::vector<Key>{{"a"}});
    ASSERT_EQ(diff.modules.size(), 1U);
    EXPECT_EQ(diff.modules[0].before->hash, 1U);
    EXPECT_EQ(diff.modules[0].after->hash, 2U);

    const inspect::DiffPackage code = makePackage({{0, makeCase("A", {{"a"}, {"b"}}, 9)}});
    EXPECT_TRUE(comparePackages(before, code).shaders.empty());
    EXPECT_EQ(comparePackages(before, code).modules.size(), 1U);
}

TEST(DiffCompare, SeveralCasesWithSeveral) {
    const inspect::DiffPackage two =
        makePackage({{0, makeCase("A", {{"a"}, {"b"}}, 1)}, {1, makeCase("C", {{"c"}, {"d"}}, 2)}});
    const inspect::DiffPackage one = makePackage({{0, makeCase("All", {{"a"}, {"b"}, {"c"}, {"d"}}, 3)}});
    EXPECT_EQ(only(comparePackages(two, one)).kind, Kind::Merged);
    EXPECT_EQ(only(comparePackages(one, two)).kind, Kind::Split);
    const inspect::DiffPackage crossed =
        makePackage({{1, makeCase("A", {{"a"}, {"c"}}, 1)}, {4, makeCase("C", {{"b"}, {"d"}}, 2)}});
    const inspect::PackageDiff diff = comparePackages(two, crossed);
    EXPECT_EQ(only(diff).kind, Kind::Regrouped);
    EXPECT_EQ(only(diff).before, (std::vector<int>{0, 1}));
    EXPECT_EQ(only(diff).after, (std::vector<int>{1, 4}));
    // Those with ID 1 are compared; 0 is gone and 4 is new. They are sorted by ID.
    ASSERT_EQ(diff.modules.size(), 3U);
    EXPECT_EQ(diff.modules[0].after, nullptr);
    EXPECT_EQ(diff.modules[1].idBefore, diff.modules[1].idAfter);
    EXPECT_EQ(diff.modules[2].before, nullptr);
}

// A chain of common keys is one group. Cases without common keys are added or removed.
TEST(DiffCompare, GroupsAreWhatKeysConnect) {
    const inspect::DiffPackage before = makePackage({{0, makeCase("A", {{"a"}}, 1)},
                                                     {1, makeCase("B", {{"b"}, {"c"}}, 2)},
                                                     {2, makeCase("X", {{"x"}}, 3)}});
    const inspect::DiffPackage after = makePackage(
        {{0, makeCase("A", {{"a"}, {"b"}}, 1)}, {1, makeCase("B", {{"c"}}, 2)}, {7, makeCase("Y", {{}}, 4)}});
    const inspect::PackageDiff diff = comparePackages(before, after);
    ASSERT_EQ(diff.shaders.size(), 3U);
    EXPECT_EQ(diff.shaders[0].kind, Kind::Added);
    EXPECT_EQ(diff.shaders[0].after, std::vector<int>{7});
    EXPECT_EQ(diff.shaders[1].kind, Kind::Removed);
    EXPECT_EQ(diff.shaders[2].kind, Kind::Regrouped);
    EXPECT_EQ(diff.sameShaders, 0U);
}

TEST(DiffCompare, MaterialsAreKnownByNameAndSceneWhereThereAreSeveral) {
    inspect::DiffPackage before = makePackage({});
    before.materials = {{{"room", "Stone", 0}, {0}}, {{"room", "Stone", 1}, {1}}};
    inspect::DiffPackage after = before;
    after.scenes = {"hall"};
    after.materials = {{{"hall", "Stone", 0}, {0}}, {{"hall", "Stone", 1}, {0, 1}}};
    const inspect::PackageDiff diff = comparePackages(before, after);
    EXPECT_EQ(diff.sameMaterials, 1U);
    ASSERT_EQ(diff.materials.size(), 1U);
    EXPECT_EQ(diff.materials[0].material.sameNamed, 1);
    after.scenes = {"hall", "room"};
    EXPECT_EQ(comparePackages(before, after).materials.size(), 4U);
}

}  // namespace
}  // namespace glint::inspect
