#include "cli/table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace glint {
namespace {

TEST(Table, NumbersAlignRightAndTextLeft) {
    EXPECT_EQ(cli::formatTable({{"name", "count"}, {"a", "7"}, {"long name", "1234"}, {"b", "-"}}),
              "name       count\n"
              "a              7\n"
              "long name   1234\n"
              "b              -\n");
}

TEST(Table, FieldsAlignLeftAndCountCharactersNotBytes) {
    EXPECT_EQ(cli::formatFields({{"ä", "1"}, {"ab", "22"}, {"c"}}),
              "ä   1\n"
              "ab  22\n"
              "c\n");
}

std::size_t widestLine(const std::string& text) {
    std::size_t widest = 0;
    for (std::size_t begin = 0; begin < text.size(); begin = text.find('\n', begin) + 1) {
        widest = std::max(widest, text.find('\n', begin) - begin);
    }
    return widest;
}

TEST(Table, LongNamesAreCutUnlessAllIsAskedFor) {
    const std::string name = "N" + std::string(119, 'n');
    const std::vector<std::vector<std::string>> rows{{"shader", "ms", "file"},
                                                     {"12 " + name, "1.5", "a/" + name}};
    const std::string cut = cli::formatTable(rows);
    EXPECT_LE(widestLine(cut), cli::kTableWidth + 4) << cut;  // "…" has three bytes
    EXPECT_NE(cut.find("\n12 Nn"), std::string::npos) << cut;
    EXPECT_NE(cut.find("n…"), std::string::npos) << cut;
    EXPECT_NE(cut.find("…n"), std::string::npos) << "the end of a path stays\n" << cut;
    const std::string whole = formatTable(rows, cli::Detail::Whole);
    EXPECT_NE(whole.find("12 " + name + "  1.5  a/" + name + "\n"), std::string::npos) << whole;
}

TEST(Table, NumbersAreNeverCut) {
    const std::string digits(90, '1');
    const std::string text = cli::formatTable({{"a", "b"}, {digits, digits}});
    EXPECT_NE(text.find("\n" + digits + "  " + digits + "\n"), std::string::npos) << text;
}

TEST(Table, FieldsWrapBelowTheirValue) {
    std::string words;
    for (int i = 0; i < 30; ++i) {
        words += (i > 0 ? " word" : "word") + std::to_string(i);
    }
    const std::string text = cli::formatFields({{"label", words}});
    EXPECT_LE(widestLine(text), cli::kTableWidth) << text;
    EXPECT_NE(text.find("\n       word"), std::string::npos) << text;
    EXPECT_EQ(formatFields({{"label", words}}, cli::Detail::Whole), "label  " + words + "\n");
    EXPECT_LE(widestLine(cli::wrapped(words + "\n")), cli::kTableWidth);
    EXPECT_EQ(cli::wrapped("a\n\nb c\n"), "a\n\nb c\n");
}

// They begin with a digit, and are names all the same.
TEST(Table, ShadersAlignLeft) {
    EXPECT_EQ(cli::formatTable({{"shader", "ms"}, {"1 Pbr", "0.5 (0.4 to 0.6)"}, {"12 Unlit", "3"}}),
              "shader                  ms\n"
              "1 Pbr     0.5 (0.4 to 0.6)\n"
              "12 Unlit                 3\n");
}

TEST(Table, ShadersAreNamedByTheirIdAndFirstWords) {
    EXPECT_EQ(shaderTitle(3, "PbrFamily", cli::Detail::Short), "3 PbrFamily");
    const std::string name = "Clearcoat_BaseTex_MetalRoughTex_NormalTex_Uv0_Normals";
    EXPECT_EQ(shaderTitle(12, name, cli::Detail::Short), "12 Clearcoat_BaseTex…");
    EXPECT_EQ(shaderTitle(12, name, cli::Detail::Whole), "12 " + name);
    EXPECT_EQ(shaderTitle(0, std::string(40, 'x'), cli::Detail::Short), "0 " + std::string(28, 'x') + "…");
}

TEST(Table, BytesHaveUnits) {
    EXPECT_EQ(cli::formatBytes(0), "0 B");
    EXPECT_EQ(cli::formatBytes(1023), "1023 B");
    EXPECT_EQ(cli::formatBytes(1536), "1.5 KiB");
    EXPECT_EQ(cli::formatBytes(3U << 20U), "3.00 MiB");
}

TEST(Table, JoinOfNothingIsADash) {
    EXPECT_EQ(base::join({}), "-");
    EXPECT_EQ(base::join({"a", "b"}), "a, b");
}

}  // namespace
}  // namespace glint
