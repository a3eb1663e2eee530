#include "cache/module_cache.h"

#include "emit/modules.h"
#include "spirv/compiler.h"
#include "support/temporary_folder.h"
#include "unit/emit/tiny_module.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace glint {
namespace {

class Modules : public ::testing::Test {
protected:
    // Returns the number of modules that were compiled; -1 after an error.
    int compile(std::vector<compiler::ModuleSource> sources, compiler::ModuleCache* cache,
                bool debugInfo = false) {
        Result<std::vector<compiler::CompiledModule>> compiled =
            compileModules(std::move(sources), 2, {.debugInfo = debugInfo}, cache);
        EXPECT_TRUE(compiled) << toString(compiled.error());
        if (!compiled) {
            return -1;
        }
        modules_ = std::move(*compiled);
        return static_cast<int>(std::ranges::count_if(modules_, &compiler::CompiledModule::compiled));
    }
    compiler::CacheStore& store() {
        return store_;
    }

    std::vector<compiler::CompiledModule> modules_;

private:
    test::TemporaryFolder folder_;
    compiler::CacheStore store_{compiler::StoreOptions{folder_.path(), 1ULL << 24, {}}};
};

TEST_F(Modules, ComeFromTheCacheAsTheyWereCompiled) {
    compiler::ModuleCache cache(store(), "compiler");
    const auto sources = [] {
        return std::vector{testing::makeTinyModule(0, "data.x = 1u;"),
                           testing::makeTinyModule(1, "data.x = 2u;")};
    };
    EXPECT_EQ(compile(sources(), &cache), 2);
    const std::vector<compiler::CompiledModule> first = modules_;
    EXPECT_EQ(compile(sources(), &cache), 0);
    for (std::size_t i = 0; i < first.size(); ++i) {
        EXPECT_EQ(modules_[i].spirv, first[i].spirv);
        EXPECT_EQ(modules_[i].hash, first[i].hash);
        EXPECT_EQ(modules_[i].file, first[i].file);
        EXPECT_EQ(modules_[i].statistics.bytes, first[i].statistics.bytes);
        EXPECT_EQ(modules_[i].statistics.instructions, first[i].statistics.instructions);
        EXPECT_EQ(modules_[i].statistics.functions, first[i].statistics.functions);
    }
}

TEST_F(Modules, CommentsPlacesAndNamesDoNotCountWithoutDebugInfo) {
    compiler::ModuleCache cache(store(), "compiler");
    EXPECT_EQ(compile({testing::makeTinyModule(0, "data.x = 1u;")}, &cache), 1);
    const base::SharedArray<std::uint32_t> words = modules_[0].spirv;
    EXPECT_EQ(
        compile({testing::makeTinyModule(5, "// Brass\n\n    data.x = /* one */ 1u;  // Gold")}, &cache), 0);
    EXPECT_EQ(modules_[0].spirv, words);
    EXPECT_EQ(
        compile({testing::makeTinyModule(5, "// Brass\n\n    data.x = /* one */ 1u;  // Gold")}, nullptr), 1);
    EXPECT_EQ(modules_[0].spirv, words);
    EXPECT_EQ(compile({testing::makeTinyModule(0, "data.x = 1u;")}, &cache, true), 1);
    EXPECT_EQ(compile({testing::makeTinyModule(0, "data.x = 1u;  // Gold")}, &cache, true), 1);
    EXPECT_EQ(compile({testing::makeTinyModule(0, "data.x = 1u;")}, &cache, true), 0);
}

TEST_F(Modules, WhatDecidesAboutTheWordsCounts) {
    compiler::ModuleCache cache(store(), "compiler");
    compiler::ModuleCache other(store(), "another compiler");
    EXPECT_EQ(compile({testing::makeTinyModule(0, "data.x = 1u;")}, &cache), 1);
    EXPECT_EQ(compile({testing::makeTinyModule(0, "data.x = 1u;")}, &other), 1);
    compiler::ModuleSource apart = testing::makeTinyModule(0, "data.x = 1u;");
    apart.functionsApart = {"other"};
    EXPECT_EQ(compile({apart}, &cache), 1);
}

TEST_F(Modules, EqualTextsAreCompiledOnce) {
    EXPECT_EQ(compile({testing::makeTinyModule(0, "data.x = 1u;"), testing::makeTinyModule(1, "data.x = 2u;"),
                       testing::makeTinyModule(2, "data.x = 1u;  // again")},
                      nullptr),
              2);
    EXPECT_EQ(modules_[2].file, "shade_0.spv");
    EXPECT_FALSE(modules_[2].compiled);
}

TEST_F(Modules, CollisionsAreCompiled) {
    test::TemporaryFolder folder;
    compiler::CacheStore colliding(
        {folder.path(), 1ULL << 24, [](std::string_view) { return std::uint64_t{1}; }});
    compiler::ModuleCache cache(colliding, "compiler");
    EXPECT_EQ(compile({testing::makeTinyModule(0, "data.x = 1u;")}, &cache), 1);
    const base::SharedArray<std::uint32_t> words = modules_[0].spirv;
    EXPECT_EQ(compile({testing::makeTinyModule(0, "data.x = 2u;")}, &cache), 1);
    EXPECT_NE(modules_[0].spirv, words);
}

TEST(CompilerIdentity, NamesItsParts) {
    const std::string identity = compiler::compilerIdentity();
    EXPECT_NE(identity.find("glslang"), std::string::npos) << identity;
    EXPECT_NE(identity.find("SPIRV-Tools"), std::string::npos) << identity;
    EXPECT_EQ(identity, compiler::compilerIdentity());
}

}  // namespace
}  // namespace glint
