// What the macros and constants of a text decide, and what of it then stays.
#include "emit/glsl/macros.h"
#include "emit/glsl/passes.h"
#include "unit/emit/tiny_module.h"

#include <gtest/gtest.h>

#include <optional>
#include <string>

namespace glint::compiler {
namespace {

std::string cutDecided(const std::string& text) {
    return compiler::cutDecided(testing::makeUnit(text, "a.glsl")).text();
}

// Queries of features as bsdf/features.glsl has them.
constexpr const char* kQueries =
    "#define ANY 0x6u\n"
    "#define ALWAYS 0x2u\n"
    "const uint kSheen = 0x4u;\n"
    "#define hasLobe(features, bit) \\\n"
    "    ((ALWAYS & (bit)) != 0u || ((ANY & (bit)) != 0u && lobeOfKey(features, bit)))\n";

std::string bodyOf(const std::string& body) {
    const std::string text = cutDecided(kQueries + ("void f() {\n" + body + "}\n"));
    const std::string start = "void f() {\n";
    const std::size_t begin = text.find(start) + start.size();
    return text.substr(begin, text.rfind("}\n") - begin);
}

TEST(DecidedGlsl, ExpressionsOfMacrosAndConstantsHaveValues) {
    Macros macros;
    macros.define("A 3");
    macros.define("PLUS(a, b) ((a) + (b))");
    macros.define("LOOP LOOP + 1");
    macros.setConstant("kMask", 0xFFFFFFFF);
    EXPECT_EQ(macros.evaluate("PLUS(A, PLUS(1, 2)) == 6 && !false"), 1U);
    EXPECT_EQ(macros.evaluate("(kMask & 0x10u) != 0u ? A : 7"), 3U);
    EXPECT_EQ(macros.evaluate("~0u == kMask"), 1U);
    EXPECT_EQ(macros.evaluate("1 + 2 * 3 << 1"), std::nullopt);
    EXPECT_EQ(macros.evaluate("2 < 10 && 10 >= 10"), 1U);
    // The sign of a number decides, and a macro doesn't name itself.
    EXPECT_EQ(macros.evaluate("kMask < 1"), std::nullopt);
    EXPECT_EQ(macros.evaluate("LOOP"), std::nullopt);
    // One side may decide; variables, calls, members and floats do not.
    EXPECT_EQ(macros.evaluate("A == 4 && f(x.y[2], g())"), 0U);
    EXPECT_EQ(macros.evaluate("f(x) || A == 3"), 1U);
    EXPECT_EQ(macros.evaluate("f(x) || A == 4"), std::nullopt);
    EXPECT_EQ(macros.evaluate("A > 0.5"), std::nullopt);
    EXPECT_EQ(macros.evaluate("A.x"), std::nullopt);
    EXPECT_EQ(macros.evaluate("A +"), std::nullopt);
    EXPECT_EQ(macros.evaluate(""), std::nullopt);
}

TEST(DecidedGlsl, FalseStatementsGo) {
    EXPECT_EQ(bodyOf("    if (hasLobe(features, 8u)) {\n        a();\n    }\n    b();\n"), "    b();\n");
    EXPECT_EQ(bodyOf("    if (hasLobe(features, 8u) && c()) a();\n    b();\n"), "    b();\n");
    EXPECT_EQ(bodyOf("    if (hasLobe(features, 8u)) {\n        a();\n    } else {\n        b();\n    }\n"),
              "    {\n        b();\n    }\n");
    EXPECT_EQ(bodyOf("    if (x) {\n        a();\n    } else if (hasLobe(features, 8u)) {\n        b();\n    "
                     "}\n    c();\n"),
              "    if (x) {\n        a();\n    } else {}\n    c();\n");
    EXPECT_EQ(bodyOf("    for (;;) if (hasLobe(features, 8u)) a();\n    b();\n"),
              "    for (;;) {}\n    b();\n");
}

TEST(DecidedGlsl, TrueStatementsStayAlone) {
    EXPECT_EQ(
        bodyOf(
            "    if (hasLobe(features, 2u)) {\n        a();\n    } else {\n        b();\n    }\n    c();\n"),
        "    {\n        a();\n    }\n    c();\n");
    EXPECT_EQ(bodyOf("    if (hasLobe(features, 2u)) {\n        return a();\n    }\n    b();\n    c();\n"),
              "    {\n        return a();\n    }\n");
    // A loop's body may not run.
    EXPECT_EQ(bodyOf("    for (;;) if (hasLobe(features, 2u)) return a();\n    b();\n"),
              "    for (;;) return a();\n    b();\n");
    EXPECT_EQ(
        bodyOf("    if (x) {\n        if (hasLobe(features, 2u)) return;\n        a();\n    }\n    b();\n"),
        "    if (x) {\n        return;\n    }\n    b();\n");
}

TEST(DecidedGlsl, ChoicesKeepOneSide) {
    EXPECT_EQ(bodyOf("    float x = hasLobe(features, 2u) ? a(1, 2) : b;\n"), "    float x = a(1, 2);\n");
    EXPECT_EQ(bodyOf("    x += hasLobe(features, 8u) ? a : b ? c : d;\n"), "    x += b ? c : d;\n");
    EXPECT_EQ(bodyOf("    f(u == v, hasLobe(features, 8u) && u <= v ? a : b, w);\n"),
              "    f(u == v, b, w);\n");
    EXPECT_EQ(bodyOf("    return u ? hasLobe(features, 2u) ? a : b : c;\n"), "    return u ? a : c;\n");
    EXPECT_EQ(bodyOf("    return (hasLobe(features, 2u) ? u : v) == w ? a : b;\n"),
              "    return (u) == w ? a : b;\n");
}

TEST(DecidedGlsl, WhatIsInDoubtStays) {
    for (const char* const body : {
             "    if (hasLobe(features, kSheen)) {\n        a();\n    }\n",
             "    if (hasLobe(features, 2u) && x) {\n        a();\n    }\n",
             // A directive that is not decided may change what belongs to the statement.
             "    if (hasLobe(features, 8u)) {\n#ifdef OTHER\n        a();\n    }\n#else\n    }\n#endif\n",
             "#define NAME if (hasLobe(features, 8u)) {\n    NAME }\n",
         }) {
        EXPECT_EQ(bodyOf(body), body);
    }
}

// A macro that is defined in two ways, or perhaps not at all, decides nothing.
TEST(DecidedGlsl, ChangedMacrosDecideNothing) {
    const std::string changed = "#define B 1\nvoid f() {\n    if (B == 1) a();\n}\n#undef B\n#define B 0\n";
    EXPECT_EQ(cutDecided(changed), changed);
    const std::string doubtful = "#ifdef OTHER\n#define B 1\n#endif\nvoid f() {\n    if (B == 1) a();\n}\n";
    EXPECT_EQ(cutDecided(doubtful), doubtful);
}

// A branch that is in doubt begins what stays of a conditional.
TEST(DecidedGlsl, ConditionalsKeepWhatIsInDoubt) {
    EXPECT_EQ(cutDecided(
                  "#define A 2\n#if A == 1\na\n#elif defined(OTHER)\nb\n#elif A == 2\nc\n#else\nd\n#endif\n"),
              "#define A 2\n#if defined(OTHER)\nb\n#elif A == 2\nc\n#else\nd\n#endif\n");
    EXPECT_EQ(cutDecided("#define A 2\n#if A == 1\na\n#elif A == 2\nb\n#elif defined(OTHER)\nc\n#endif\n"),
              "#define A 2\nb\n");
    const std::string doubtful = "#ifdef OTHER\n#define GLINT_B\n#endif\n#ifdef GLINT_B\nb\n#endif\n";
    EXPECT_EQ(cutDecided(doubtful), doubtful);
    EXPECT_EQ(cutDecided("#ifdef GLINT_B\na\n#else\nb\n#endif\n"), "b\n");
    EXPECT_EQ(cutDecided("#define A 0\n#if A\n#if OTHER\na\n#elif A\nb\n#endif\n#endif\nc\n"),
              "#define A 0\nc\n");
}

TEST(DecidedGlsl, LinesKeepTheirPlaces) {
    const GlslUnit unit = compiler::cutDecided(testing::makeUnit(
        "#define A 1\n#if A == 1\nvoid f() {\n    if (A != 1)\n        g();\n    h();\n}\n#endif\n",
        "a.glsl"));
    ASSERT_EQ(unit.size(), 4U);
    EXPECT_EQ(unit.line(2), "    h();");
    EXPECT_EQ(unit.number(2), 6);
}

TEST(DecidedGlsl, TextsThatEndEarlyStay) {
    for (const char* const text :
         {"a ? b =\n", "= a ? b : c\n", "if (true\n", "if (false) f( else\n", "? :\n"}) {
        EXPECT_EQ(cutDecided(text), text);
    }
}

}  // namespace
}  // namespace glint::compiler
