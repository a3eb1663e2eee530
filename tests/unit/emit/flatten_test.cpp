#include "emit/glsl/passes.h"
#include "support/must.h"

#include <gtest/gtest.h>

#include <map>
#include <string>

namespace glint {
namespace {

using Files = std::map<std::string, std::string, std::less<>>;

Result<std::string> flattenRoot(const Files& files, const std::string& text,
                                compiler::FlattenSide side = compiler::FlattenSide::Glsl) {
    const compiler::SourceLookup lookup = [&](std::string_view name) -> std::optional<std::string_view> {
        const auto place = files.find(name);
        return place == files.end() ? std::nullopt : std::optional<std::string_view>(place->second);
    };
    const Result<compiler::GlslUnit> unit = flatten("root.comp", text, lookup, side);
    return unit ? Result<std::string>(unit->withPlaces()) : unit.error();
}

TEST(Flatten, InlinesEachFileOnceAndMarksLines) {
    const Files files{{"a.glsl", "int a;\n#include \"b.glsl\"\nint c;\n"}, {"b.glsl", "int b;\n"}};
    const auto text =
        must(flattenRoot(files, "#version 460\n#include \"a.glsl\"\n#include \"b.glsl\"\nvoid main() {}\n"));
    EXPECT_EQ(text,
              "#version 460\n"
              "#extension GL_GOOGLE_cpp_style_line_directive : require\n"
              "#line 1 \"a.glsl\"\n"
              "int a;\n"
              "#line 1 \"b.glsl\"\n"
              "int b;\n"
              "#line 3 \"a.glsl\"\n"
              "int c;\n"
              "#line 4 \"root.comp\"\n"
              "void main() {}\n");
}

constexpr const char* kShared =
    "#ifndef GUARD_H\n#define GUARD_H\n#include <cstdint>\n#ifdef __cplusplus\nint cpp;\n#if X\nint "
    "x;\n#endif\n"
    "#else\nint glsl;\n#ifdef Y\nint y;\n#else\nint z;\n#endif\n#endif\n#ifndef __cplusplus\nint "
    "only;\n#endif\n"
    "#endif\n";

TEST(Flatten, KeepsTheGlslSide) {
    const auto text = must(flattenRoot({{"s.h", kShared}}, "#version 460\n#include \"s.h\"\n"));
    EXPECT_EQ(text,
              "#version 460\n"
              "#extension GL_GOOGLE_cpp_style_line_directive : require\n"
              "#line 10 \"s.h\"\n"
              "int glsl;\n"
              "#ifdef Y\n"
              "int y;\n"
              "#else\n"
              "int z;\n"
              "#endif\n"
              "#line 18 \"s.h\"\n"
              "int only;\n");
}

TEST(Flatten, KeepsTheCppSideAndItsGuard) {
    const auto text = must(flattenRoot({{"s.h", kShared}}, "#include \"s.h\"\n", compiler::FlattenSide::Cpp));
    EXPECT_EQ(
        text,
        "#ifndef GUARD_H\n#define GUARD_H\n#include <cstdint>\nint cpp;\n#if X\nint x;\n#endif\n#endif\n");
}

TEST(Flatten, TakesTheNumbersThatALineGives) {
    const auto text = must(flattenRoot({}, "#version 460\n#define A 1\n#line 2\nint a;\n\n\nint b;\n"));
    EXPECT_EQ(text,
              "#version 460\n"
              "#extension GL_GOOGLE_cpp_style_line_directive : require\n"
              "#line 2 \"root.comp\"\n"
              "#define A 1\n"
              "#line 2 \"root.comp\"\n"
              "int a;\n"
              "\n"
              "#line 5 \"root.comp\"\n"
              "int b;\n");
    EXPECT_EQ(mustFail(flattenRoot({}, "#version 460\n#define A 1\n#line 2\n#endif\n")).where, "root.comp:2");
}

TEST(Flatten, TakesCarriageReturnsAndAMissingLastNewline) {
    const auto text =
        must(flattenRoot({{"a.glsl", "int a;"}}, "#version 460\r\n#include \"a.glsl\"\r\nint b;"));
    EXPECT_EQ(text.find('\r'), std::string::npos);
    EXPECT_TRUE(text.ends_with("int a;\n#line 3 \"root.comp\"\nint b;\n")) << text;
}

TEST(Flatten, FindsFilesBesideTheOneThatIncludesThem) {
    const Files files{{"pack/a.glsl", "#include \"b.glsl\"\n#include \"c.glsl\"\n"},
                      {"pack/b.glsl", "int b;\n"},
                      {"pack/c.glsl", "int other;\n"},
                      {"c.glsl", "int c;\n"}};
    const auto text = must(flattenRoot(files, "#version 460\n#include \"pack/a.glsl\"\n"));
    EXPECT_NE(text.find("#line 1 \"pack/b.glsl\"\nint b;"), std::string::npos) << text;
    EXPECT_NE(text.find("int c;"), std::string::npos) << "Glint's files come first: " << text;
}

struct BadSource {
    const char* text;
    const char* id;
    const char* where;
};

class FlattenErrors : public ::testing::TestWithParam<BadSource> {};

TEST_P(FlattenErrors, NameTheirPlace) {
    const Files files{{"cycle.glsl", "\n#include \"other.glsl\"\n"},
                      {"other.glsl", "#include \"cycle.glsl\"\n"},
                      {"missing.glsl", "int a;\n  # include \"nowhere.glsl\" // why\n"},
                      {"open.glsl", "int a;\n#ifdef X\n"}};
    const auto text = flattenRoot(files, GetParam().text);
    ASSERT_FALSE(text) << *text;
    EXPECT_EQ(text.error().id, GetParam().id);
    EXPECT_EQ(text.error().where, GetParam().where);
    EXPECT_FALSE(text.error().hint.empty());
}

INSTANTIATE_TEST_SUITE_P(
    All, FlattenErrors,
    ::testing::Values(
        BadSource{"#version 460\n#include \"missing.glsl\"\n", "source-include", "missing.glsl:2"},
        BadSource{"#version 460\n#include \"cycle.glsl\"\n", "source-include", "other.glsl:1"},
        BadSource{"#version 460\n#include \"root.comp\"\n", "source-include", "root.comp:2"},
        BadSource{"#version 460\n#include nothing\n", "source-include", "root.comp:2"},
        BadSource{"#version 460\n#include \"\n", "source-include", "root.comp:2"},
        BadSource{"#version 460\n#include \"open.glsl\"\n", "source-conditional", "open.glsl:2"},
        BadSource{"#version 460\n#endif\n", "source-conditional", "root.comp:2"},
        BadSource{"#version 460\n#if defined(__cplusplus)\n#endif\n", "source-conditional", "root.comp:2"},
        BadSource{"#version 460\n#ifdef __cplusplus\n#elif 1\n#endif\n", "source-conditional", "root.comp:3"},
        BadSource{"void main() {}\n", "source-version", "root.comp:1"}));

}  // namespace
}  // namespace glint
