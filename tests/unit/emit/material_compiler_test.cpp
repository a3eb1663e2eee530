// Sets of materials that a program compiles in memory.
#include "emit/material_compiler.h"

#include "support/must.h"
#include "support/temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <thread>

namespace {

using namespace glint;

gltf::MaterialSet smallSet() {
    gltf::MaterialSet set;
    set.path = "game";
    set.materials.push_back({.name = "paint", .values = {{"clearcoatFactor", {1}}}});
    set.materials.push_back({.name = "cloth", .values = {{"sheenColorFactor", {1, 1, 1}}}});
    return set;
}

// Few modules, which compile in less than a second.
compiler::Settings smallSettings() {
    compiler::Settings settings;
    settings.compile.passes = package::Passes::Steps;
    settings.compile.strategies = package::kStrategyUber;
    settings.compile.plan.merge = compiler::MergePolicy::None;
    settings.compile.effects = {false, 0};
    return settings;
}

// Returns the modules and parts that a call compiled.
std::ptrdiff_t countCompiled(const compiler::CompiledMaterials& compiled) {
    std::ptrdiff_t count = 0;
    for (const compiler::CompiledModule& module : compiled.package.modules) {
        count += (module.compiled ? 1 : 0) + module.partsCompiled;
    }
    return count;
}

std::map<std::string, base::Bytes> filesOf(const compiler::CompiledMaterials& compiled) {
    std::map<std::string, base::Bytes> files;
    for (const compiler::PackageFile& file : compiled.package.files) {
        files[file.name].assign(file.bytes.begin(), file.bytes.end());
    }
    return files;
}

TEST(MaterialCompiler, CompilesOnlyWhatIsNew) {
    const test::TemporaryFolder folder;
    gltf::MaterialSet set = smallSet();
    std::map<std::string, base::Bytes> last;
    {
        Result<compiler::MaterialCompiler> compiler =
            compiler::MaterialCompiler::create(smallSettings(), folder.path());
        ASSERT_TRUE(compiler) << toString(compiler.error());
        const compiler::CompiledMaterials first = must(compiler->compile(set));
        EXPECT_EQ(first.package.plan.cases.size(), 2U);
        EXPECT_EQ(first.scene.materials[0].name, "paint");
        EXPECT_GT(countCompiled(first), 0);

        // An error changes nothing.
        set.materials.push_back({.name = "coat", .values = {{"clearcoatFacto", {1}}}});
        EXPECT_EQ(mustFail(compiler->compile(set)).where, "game#/materials/2/values/clearcoatFacto");
        set.materials.pop_back();
        const compiler::CompiledMaterials again = must(compiler->compile(set));
        EXPECT_EQ(countCompiled(again), 0);
        EXPECT_TRUE(filesOf(again) == filesOf(first));

        // A value is in the tables alone. Numbers outside of the range are clamped, with a warning.
        set.materials[0].values["roughnessFactor"] = {-1.0};
        const compiler::CompiledMaterials value = must(compiler->compile(set));
        EXPECT_EQ(countCompiled(value), 0);
        EXPECT_TRUE(filesOf(value) != filesOf(first));
        EXPECT_TRUE(std::ranges::any_of(value.messages, [](const Diagnostic& message) {
            return message.where == "game#/materials/0/values/roughnessFactor";
        }));

        set.materials.push_back(
            {.name = "coat", .values = {{"clearcoatFactor", {1}}, {"sheenColorFactor", {1, 1, 1}}}});
        const compiler::CompiledMaterials added = must(compiler->compile(set));
        EXPECT_EQ(added.package.plan.cases.size(), 3U);
        EXPECT_GT(countCompiled(added), 0);
        // The shader of the new case is one of the parts that are joined; those of the others are kept.
        EXPECT_TRUE(std::ranges::any_of(added.package.modules, [](const compiler::CompiledModule& module) {
            return module.partsCached > 0;
        }));
        last = filesOf(added);
    }
    // The folder has all of it for the next program, or for several threads of one.
    std::array<std::thread, 2> threads;
    for (std::thread& thread : threads) {
        thread = std::thread([&] {
            Result<compiler::MaterialCompiler> compiler =
                compiler::MaterialCompiler::create(smallSettings(), folder.path());
            ASSERT_TRUE(compiler) << toString(compiler.error());
            const compiler::CompiledMaterials next = must(compiler->compile(set));
            EXPECT_EQ(countCompiled(next), 0);
            EXPECT_TRUE(filesOf(next) == last);
        });
    }
    for (std::thread& thread : threads) {
        thread.join();
    }
}

TEST(MaterialCompiler, FoldsNewShadersUntilTheyAreOptimized) {
    compiler::Settings settings = smallSettings();
    settings.compile.strategies = package::kStrategyVisibility;
    compiler::MaterialCompiler compiler = must(compiler::MaterialCompiler::create(settings));
    const auto compile = [&](const gltf::MaterialSet& set, compiler::NewShaders newShaders) {
        return must(compiler.compile(set, newShaders));
    };
    gltf::MaterialSet set = smallSet();
    const compiler::CompiledMaterials before = compile(set, compiler::NewShaders::Optimized);
    EXPECT_EQ(before.folded, 0U);

    set.materials.push_back(
        {.name = "coat", .values = {{"clearcoatFactor", {1}}, {"sheenColorFactor", {1, 1, 1}}}});
    const compiler::CompiledMaterials soon = compile(set, compiler::NewShaders::Folded);
    EXPECT_EQ(countCompiled(soon), 1);
    EXPECT_EQ(soon.folded, 1U);
    // The same again comes from memory, and is still not optimised.
    const compiler::CompiledMaterials same = compile(set, compiler::NewShaders::Folded);
    EXPECT_EQ(countCompiled(same), 0);
    EXPECT_EQ(same.folded, 1U);

    const compiler::CompiledMaterials whole = compile(set, compiler::NewShaders::Optimized);
    EXPECT_EQ(countCompiled(whole), 1);
    EXPECT_EQ(whole.folded, 0U);
    EXPECT_LT(whole.package.spirvBytes, soon.package.spirvBytes);
    compiler::MaterialCompiler other = must(compiler::MaterialCompiler::create(settings));
    EXPECT_TRUE(filesOf(whole) == filesOf(must(other.compile(set))));
    // What was optimised once is taken.
    EXPECT_TRUE(filesOf(compile(set, compiler::NewShaders::Folded)) == filesOf(whole));
}

TEST(MaterialCompiler, RefusesPacksThatAreNotThere) {
    compiler::Settings settings = smallSettings();
    settings.materials = {"no such folder"};
    EXPECT_EQ(mustFail(compiler::MaterialCompiler::create(settings)).id, "materials-folder");
}

}  // namespace
