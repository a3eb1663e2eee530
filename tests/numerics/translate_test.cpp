#include "translate.h"

#include <gtest/gtest.h>

#include <string>

namespace glint::numerics {
namespace {

std::string translated(const char* glsl) {
    const Result<std::string> cpp = translateToCpp(glsl);
    return cpp ? *cpp : toString(cpp.error());
}

TEST(Translate, NumbersKeepTheirPrecision) {
    EXPECT_EQ(translated("float x = 1.5e-3 + .5 * 2. - 1e4;"),
              "Real x = Real(1.5e-3) + Real(.5) * Real(2.) - Real(1e4);");
    EXPECT_EQ(translated("uint x = 0x1Eu + 3u; int i = 7;"), "uint x = 0x1Eu + 3u; int i = 7;");
}

TEST(Translate, OutputsAreReferences) {
    EXPECT_EQ(translated("void f(vec3 a, out float b, inout vec3 c) {}"),
              "void f(vec3 a,  Real& b,  vec3& c) {}");
}

TEST(Translate, SwizzlesAreCalls) {
    EXPECT_EQ(translated("vec2 a = v.yx * w.xyz.zx - b.x;"), "vec2 a = v.yx() * w.xyz().zx() - b.x;");
    EXPECT_EQ(translated("bool same = v.xy == w.xy;"), "bool same = v.xy() == w.xy();");
}

TEST(Translate, RefusesToLoseAnAssignment) {
    EXPECT_NE(translated("v.xy = w;").find("glsl-swizzle"), std::string::npos);
    const std::string message = translated("#line 7 \"hit/a.glsl\"\nv.xy += w;");
    EXPECT_NE(message.find("glsl-swizzle"), std::string::npos);
    EXPECT_NE(message.find("hit/a.glsl"), std::string::npos) << message;
}

TEST(Translate, ConstructorsOfStructuresAndArraysAreBraces) {
    EXPECT_EQ(translated("struct S { float a; }; S s = S(f(1.0));"),
              "struct S { Real a; }; S s = S{f(Real(1.0))};");
    EXPECT_EQ(translated("float t[2] = float[2](1.0, (2.0));"), "Real t[2] = {Real(1.0), (Real(2.0))};");
    EXPECT_NE(translated("struct S { float a; }; S s = S(1.0;").find("glsl-bracket"), std::string::npos);
}

TEST(Translate, CommentsStayAndDirectivesOfGlslGo) {
    EXPECT_EQ(translated("#version 460\n// 1.5 in v.xy\n#define A 2.0\n#line 3 \"x.glsl\"\n"),
              "\n// 1.5 in v.xy\n#define A Real(2.0)\n#line 3 \"x.glsl\"\n");
}

}  // namespace
}  // namespace glint::numerics
