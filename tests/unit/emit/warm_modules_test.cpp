// The texts of modules that are known from runs before.
#include "emit/warm_modules.h"

#include "support/must.h"
#include "support/temporary_folder.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace glint {
namespace {

constexpr const char* kItems =
    "#define UNUSED 1\n#define USED THROUGH\n#define THROUGH 2\n// A comment.\nstruct Pair { int a; int b; "
    "};\n";
constexpr const char* kFile = "int one() { return 1; }\n";

compiler::ModuleTemplate makeTemplate(const std::string& items = kItems, const std::string& file = kFile) {
    const auto sources = std::make_shared<compiler::SourceSet>();
    sources->addItems("items.glsl", items);
    sources->add("file.glsl", file);
    return {"main.comp",
            "#version 460\n#include \"items.glsl\"\n#include \"file.glsl\"\n"
            "void main() { Pair pair = Pair(USED, one()); }\n",
            {std::make_shared<const compiler::SourceSet>(), sources}};
}

std::string with(const std::string& text, const std::string& old, const std::string& other) {
    std::string changed = text;
    changed.replace(changed.find(old), old.size(), other);
    return changed;
}

class KnownTexts : public ::testing::Test {
protected:
    // Returns the hash that it puts.
    compiler::TextHash put(compiler::WarmModules& warm, const compiler::ModuleCache* cache = nullptr) {
        std::vector<std::uint64_t> sources;
        const compiler::ModuleGlsl glsl(must(makeTemplate().make(&sources)));
        warm.putText(makeTemplate(), sources, glsl.hash(), cache);
        return glsl.hash();
    }

    compiler::WarmModules warm_;
};

TEST_F(KnownTexts, DependOnTheItemsThatTheyUse) {
    const std::optional<compiler::TextHash> hash = put(warm_);
    const auto find = [&](const std::string& items) { return warm_.findText(makeTemplate(items), nullptr); };
    EXPECT_EQ(find(kItems), hash);
    EXPECT_EQ(find(with(kItems, "UNUSED 1", "UNUSED 3")), hash);
    EXPECT_EQ(find(with(kItems, "A comment", "Another")), hash);
    EXPECT_EQ(find(with(kItems, "THROUGH 2", "THROUGH 3")), std::nullopt);
    EXPECT_EQ(find(with(kItems, "USED THROUGH", "USED UNUSED")), std::nullopt);
    EXPECT_EQ(find(with(kItems, "int b;", "int b; int c;")), std::nullopt);
    // The module may use the name of another item.
    EXPECT_EQ(find(std::string(kItems) + "#define one() 4\n"), std::nullopt);
}

TEST_F(KnownTexts, DependOnFilesAndTheTextThatTheyStartWith) {
    const std::optional<compiler::TextHash> hash = put(warm_);
    EXPECT_EQ(warm_.findText(makeTemplate(kItems, "int one() { return 2; }\n"), nullptr), std::nullopt);
    compiler::ModuleTemplate other = makeTemplate();
    other.text += "int more;\n";
    EXPECT_EQ(warm_.findText(other, nullptr), std::nullopt);
    other = makeTemplate();
    other.origin = "other/module.comp";
    EXPECT_EQ(warm_.findText(other, nullptr), std::nullopt);
    // What a text is called and says to people changes when there is one case more.
    other = makeTemplate();
    other.origin = "other.comp";
    other.text += "// Shader 7.\n";
    EXPECT_EQ(warm_.findText(other, nullptr), hash);
    EXPECT_EQ(warm_.findText(makeTemplate(), nullptr), hash);
}

TEST_F(KnownTexts, StayInTheCache) {
    const test::TemporaryFolder folder;
    compiler::CacheStore store({folder.path(), 1ULL << 20, {}});
    const compiler::ModuleCache cache(store, "compiler");
    const std::optional<compiler::TextHash> hash = put(warm_, &cache);
    compiler::WarmModules other;
    EXPECT_EQ(other.findText(makeTemplate(), &cache), hash);
    EXPECT_EQ(other.findText(makeTemplate(with(kItems, "THROUGH 2", "THROUGH 3")), &cache), std::nullopt);
    compiler::WarmModules without;
    EXPECT_EQ(without.findText(makeTemplate(), nullptr), std::nullopt);
}

TEST_F(KnownTexts, GoWhenTheyWereNotUsedForLong) {
    put(warm_);
    for (std::uint64_t run = 0; run < compiler::WarmModules::kRuns + 2; ++run) {
        warm_.endRun();
    }
    EXPECT_EQ(warm_.findText(makeTemplate(), nullptr), std::nullopt);
}

}  // namespace
}  // namespace glint
