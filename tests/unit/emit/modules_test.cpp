#include "emit/modules.h"

#include "emit/context.h"
#include "support/must.h"
#include "unit/emit/sample_scene.h"
#include "unit/emit/tiny_module.h"

#include <gtest/gtest.h>

#include <string>

namespace glint {
namespace {

TEST(CompileModules, SharesTheFileOfEqualSpirv) {
    const auto modules = must(compiler::compileModules(
        {testing::makeTinyModule(0, "data.x = 1u + 1u;"), testing::makeTinyModule(1, "data.x = 3u;"),
         testing::makeTinyModule(2, "data.x = 2u;  // the same in the end")},
        2, {}));
    EXPECT_EQ(modules.at(0).file, "shade_0.spv");
    EXPECT_EQ(modules.at(1).file, "shade_1.spv");
    EXPECT_EQ(modules.at(2).file, "shade_0.spv");
    EXPECT_EQ(modules.at(2).hash, modules.at(0).hash);
    EXPECT_NE(modules.at(1).hash, modules.at(0).hash);
}

TEST(CompileModules, ReportsTheFirstErrorWhateverTheJobs) {
    for (const int jobs : {1, 2, 8}) {
        std::vector<compiler::ModuleSource> sources;
        sources.reserve(12);
        for (int i = 0; i < 12; ++i) {
            sources.push_back(
                testing::makeTinyModule(i, i >= 5 ? "data.x = wrong" + std::to_string(i) + ";" : ""));
        }
        const Diagnostic modules = mustFail(compileModules(std::move(sources), jobs, {}));
        EXPECT_EQ(modules.id, "glsl");
        EXPECT_EQ(modules.where, "case.glsl:13");
        EXPECT_NE(modules.message.find("wrong5"), std::string::npos) << modules.message;
    }
}

TEST(CompileModules, TakesNoModules) {
    const auto modules = compiler::compileModules({}, 4, {});
    ASSERT_TRUE(modules);
    EXPECT_TRUE(modules->empty());
}

TEST(RenderTemplate, ReportsMissingAndMalformedTemplates) {
    compiler::SourceSet sources;
    sources.add("open.mustache", "{{#cases}} never closed");
    for (const char* const name : {"none.mustache", "open.mustache"}) {
        const Diagnostic text = mustFail(renderTemplate(sources, name, {}));
        EXPECT_EQ(text.id, "template");
        EXPECT_EQ(text.where, name);
    }
}

TEST(RenderTemplate, EscapesNothing) {
    compiler::SourceSet sources;
    sources.add("a.mustache", "{{name}}");
    const auto text = renderTemplate(sources, "a.mustache", {"name", std::string("a<b> & \"c\"")});
    ASSERT_TRUE(text);
    EXPECT_EQ(*text, "a<b> & \"c\"");
}

TEST(CommentText, CannotLeaveItsComment) {
    EXPECT_EQ(compiler::commentText("plain"), "plain");
    EXPECT_EQ(compiler::commentText("a\nb*/c\\"), "a?b__c_");
    EXPECT_EQ(compiler::commentText(std::string(100, 'x')), std::string(64, 'x') + "...");
}

}  // namespace
}  // namespace glint
