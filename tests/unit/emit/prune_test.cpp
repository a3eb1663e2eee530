#include "emit/compile.h"
#include "emit/glsl/passes.h"
#include "emit/module_files.h"
#include "support/must.h"
#include "unit/emit/sample_scene.h"
#include "unit/emit/tiny_module.h"

#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

namespace glint {
namespace {

const std::string kStart = "#version 460\n";

std::string dropUnused(const std::string& text) {
    return glint::compiler::dropUnused(testing::makeUnit(text, "a.glsl")).text();
}

bool has(const std::string& text, std::string_view part) {
    return text.find(part) != std::string::npos;
}

TEST(DropUnused, DropsWhatNothingReaches) {
    const std::string text = dropUnused(kStart +
                                        "#define USED 1\n"
                                        "#define UNUSED 2\n"
                                        "#define VIA UNUSED\n"
                                        "const uint kUsed = 3u;\n"
                                        "const uint kUnused = kUsed;\n"
                                        "const float kTable[2] = float[2](1.0, 2.0);\n"
                                        "// Says twice.\n"
                                        "float twice(float x) {\n"
                                        "    return x + x;\n"
                                        "}\n"
                                        "\n"
                                        "float again(float x) { return twice(x); }\n"
                                        "float kept(float x) {\n"
                                        "    return x * USED;\n"
                                        "}\n"
                                        "void main() { kept(float(kUsed)); }\n");
    EXPECT_EQ(text, kStart +
                        "#define USED 1\n"
                        "const uint kUsed = 3u;\n"
                        "\n"
                        "float kept(float x) {\n"
                        "    return x * USED;\n"
                        "}\n"
                        "void main() { kept(float(kUsed)); }\n");
}

TEST(DropUnused, DropsTypesAndResourcesThatNothingReads) {
    const std::string text =
        dropUnused(kStart +
                   "struct Inner { float x; };\n"
                   "struct Used {\n    Inner inner;\n};\n"
                   "struct Unused { Used used; };\n"
                   "GLINT_CONSTANT(kUsed, 1u);\n"
                   "GLINT_CONSTANT(kUnused, 2u);\n"
                   "layout(buffer_reference, scalar) readonly buffer A { Used data[]; };\n"
                   "layout(buffer_reference, scalar) buffer B { Unused data[]; };\n"
                   "layout(set = 0, binding = 0) uniform texture2D images[];\n"
                   "layout(set = 0, binding = 1) uniform sampler filters[kUnused];\n"
                   "layout(push_constant) uniform Push { A a; } push;\n"
                   "void main() { images[kUsed]; }\n");
    EXPECT_EQ(text, kStart +
                        "struct Inner { float x; };\n"
                        "struct Used {\n    Inner inner;\n};\n"
                        "GLINT_CONSTANT(kUsed, 1u);\n"
                        "layout(buffer_reference, scalar) readonly buffer A { Used data[]; };\n"
                        "layout(set = 0, binding = 0) uniform texture2D images[];\n"
                        "layout(push_constant) uniform Push { A a; } push;\n"
                        "void main() { images[kUsed]; }\n");
}

TEST(DropUnused, KeepsThePlacesOfLines) {
    compiler::GlslUnit unit;
    unit.add("#version 460", "main.comp", 1);
    unit.add("int unused() { return 1; }", "a.glsl", 7);
    unit.add("int used() {", "a.glsl", 8);
    unit.add("    return 2; }", "a.glsl", 9);
    unit.add("", "a.glsl", 10);
    unit.add("", "a.glsl", 11);
    unit.add("int last = used();", "a.glsl", 12);
    unit.add("void main() {}", "main.comp", 3);
    EXPECT_EQ(glint::compiler::dropUnused(unit).withPlaces(),
              "#version 460\n"
              "#extension GL_GOOGLE_cpp_style_line_directive : require\n"
              "#line 8 \"a.glsl\"\n"
              "int used() {\n"
              "    return 2; }\n"
              "\n"
              "#line 12 \"a.glsl\"\n"
              "int last = used();\n"
              "#line 3 \"main.comp\"\n"
              "void main() {}\n");
}

// A precision is not part of a declaration's type or name.
TEST(DropUnused, SeesThroughPrecision) {
    const std::string used = "GLINT_RELAXED vec3 used(GLINT_RELAXED vec3 x) { return x; }\n";
    const std::string text = dropUnused(kStart + used +
                                        "GLINT_RELAXED float a(GLINT_RELAXED float x) { return x; }\n"
                                        "mediump vec3 b() { return vec3(0.0); }\n"
                                        "const highp float kC = 1.0;\n"
                                        "void main() { used(vec3(1.0)); }\n");
    EXPECT_TRUE(has(text, used)) << text;
    EXPECT_FALSE(has(text, "float a(")) << text;
    EXPECT_FALSE(has(text, "vec3 b(")) << text;
    EXPECT_FALSE(has(text, "kC")) << text;
}

TEST(DropUnused, KeepsWhatItCantTell) {
    for (const char* const text :
         {"float a(float x);\nvoid main() {}\n", "int a, b;\nvoid main() {}\n",
          "struct A { float x; } a;\nvoid main() {}\n",
          "layout(set = 0, binding = 0) buffer A { uint x; } a;\nvoid main() {}\n",
          "MACRO void a() {}\nvoid main() {}\n", "void a() {} void b() {}\nvoid main() {}\n",
          "void a() {\n#define INNER 1\n}\nvoid main() {}\n",
          "#if A\nvoid a(int x) {\n#else\nvoid a() {\n#endif\n}\nvoid main() {}\n",
          "#define JOIN(T) T##Array\nvoid uintArray() {}\nvoid main() { JOIN(uint)(); }\n",
          "#define JOIN(a, b) a##b\nvoid join() {}\nvoid main() { JOIN(jo, in)(); }\n",
          "#ifndef X\n#define X 1\n#endif\nvoid main() {}\n", "void never() {\n",
          "void main() {}\n/* never ends\n"}) {
        EXPECT_EQ(dropUnused(text), text);
    }
}

TEST(DropUnused, DropsWhatOnlyAnUnusedMacroPastes) {
    EXPECT_EQ(dropUnused("#define JOIN(T) T##Array\nvoid uintArray() {}\nvoid main() {}\n"),
              "void main() {}\n");
}

TEST(DropUnused, TakesCommentsWithTheirListOfMacros) {
    EXPECT_EQ(dropUnused("// These.\n#define A 1\n#define B 2\nvoid main() { B; }\n"),
              "// These.\n#define B 2\nvoid main() { B; }\n");
    EXPECT_EQ(dropUnused("// These.\n#define A 1\n#define B 2\nvoid main() {}\n"), "void main() {}\n");
    EXPECT_EQ(dropUnused("// File.\n\n// One.\nvoid one() {}\nvoid main() {}\n"),
              "// File.\n\nvoid main() {}\n");
}

TEST(DropUnused, EndsAMacroAloneOnItsLine) {
    EXPECT_EQ(dropUnused("#define END\nEND\n#define A 1\nvoid a() {}\nvoid main() {}\n"),
              "#define END\nEND\nvoid main() {}\n");
}

TEST(DropUnused, ReadsContinuedMacrosAndCommentsAsWhatTheyAre) {
    const std::string text =
        "#define F(x) \\\n    g(x)\nvoid g(int x) {}\n// h() is gone: F\nvoid h() {}\n"
        "/* } h( */ void main() { F(1); }\n";
    EXPECT_EQ(dropUnused(text),
              "#define F(x) \\\n    g(x)\nvoid g(int x) {}\n/* } h( */ void main() { F(1); }\n");
}

TEST(DropUnused, ChangesNothingTheSecondTime) {
    compiler::CompileSettings settings;
    settings.emitGlsl = true;
    settings.strategies = package::allStrategies();
    const compiler::CompiledPackage package = testing::compileSample(settings);
    ASSERT_FALSE(package.modules.empty());
    for (const compiler::CompiledModule& module : package.modules) {
        const compiler::GlslUnit& unit = module.glsl->made();
        EXPECT_EQ(glint::compiler::dropUnused(unit).withPlaces(), unit.withPlaces()) << module.name;
    }
}

TEST(EssentialText, IsWithoutCommentsPlacesAndBlanks) {
    EXPECT_EQ(
        compiler::essentialText("#version 460\n// why\n\n  int a; // b\n\tint /* c\nd */ e = 1 / 2;\r\n"),
        "#version 460\nint a;\nint e = 1 / 2;\n");
}

TEST(GlslTokens, PairsOfBracketsNest) {
    const std::vector<compiler::GlslToken> tokens = compiler::splitTokens("{ ( } [ )");
    ASSERT_EQ(tokens.size(), 5U);
    for (const compiler::GlslToken& token : tokens) {
        EXPECT_EQ(token.match, compiler::GlslToken::kNone) << token.text;
    }
    const std::vector<compiler::GlslToken> nested = compiler::splitTokens("{ ( } ) }");
    EXPECT_EQ(nested[1].match, 3U);
    EXPECT_EQ(nested[0].match, 4U);
    EXPECT_EQ(nested[2].match, compiler::GlslToken::kNone);
}

TEST(ConstParameters, AreThoseThatTheirFunctionsDoNotWrite) {
    const auto of = [](const std::string& parameters, const std::string& body) {
        const std::string rest = ") { " + body + " }\n";
        const std::string before = "void out1(out float x) {}\nfloat read(const float x) { return x; }\n";
        const std::string text = compiler::withConstParameters(before + "void f(" + parameters + rest, {});
        return text.substr(before.size() + 7, text.size() - before.size() - 7 - rest.size());
    };
    EXPECT_EQ(of("vec3 a, in float b", "a.x + b; read(a.y);"), "const vec3 a, const in float b");
    EXPECT_EQ(of("highp float a, out float b", "b = a;"), "const highp float a, out float b");
    EXPECT_EQ(of("float a, float b", "if (a == b || a <= b || a != b || a >= b) { b.a = 1.0; }"),
              "const float a, float b");
    for (const char* const body :
         {"a = b;", "a.x[0].y += b;", "a <<= b;", "++a;", "a--;", "out1(a.x);", "out1(read(a));",
          "atomicAdd(a, 1u) + b;", "b + a[i];", "b + a.x[i + 1];"}) {
        EXPECT_EQ(of("uvec4 a, uint b", body), "uvec4 a, const uint b") << body;
    }
    EXPECT_EQ(of("float a[2], uint b", "a[1] + b;"), "float a[2], const uint b");
    EXPECT_EQ(of("", ""), "");
}

TEST(ConstParameters, LeaveFunctionsWhoseTypesOthersKnow) {
    const std::string text =
        "float a(float x);\nfloat a(float x) { return x; }\nfloat b(float x) { return x; }\n";
    EXPECT_EQ(compiler::withConstParameters(text, std::vector<std::string>{"b"}), text);
    for (const char* const broken :
         {"void a(int x", "void a(int x) { x[", "void a(int x) { x.", "void a(int x,\n#if A\nint x) {}",
          "}}) {", "void a(int x) { ) x; }", "void a(int x) { b(x; }", ""}) {
        EXPECT_GE(compiler::withConstParameters(broken, {}).size(), std::string_view(broken).size());
    }
}

TEST(ConstParameters, AMacroMayWriteOne) {
    const std::string text =
        "#version 460\n#define DOUBLE(value) value *= 2u\nlayout(local_size_x = 1) in;\n"
        "layout(set = 0, binding = 0) buffer Data { uint x; } data;\n"
        "uint doubled(uint x) { DOUBLE(x); return x; }\nvoid main() { data.x = doubled(data.x); }\n";
    EXPECT_NE(compiler::withConstParameters(text, {}), text);
    EXPECT_TRUE(compiler::compileMeasured({"double.comp", compiler::ShaderStage::Compute, text, {}}, {}));
}

// One case more changes only those modules that contain the number of cases, or all cases.
TEST(ModuleTexts, DependOnNothingThatTheModuleDoesNotUse) {
    compiler::CompileSettings settings;
    settings.plan.merge = compiler::MergePolicy::None;
    settings.strategies = package::kStrategyVisibility;
    const compiler::CompiledPackage package = testing::compileSample(settings);
    for (const compiler::CompiledModule& module : package.modules) {
        // A text whose hash the cache knows is made when it is asked for.
        const std::string text = must(module.glsl->unit())->text();
        const bool isCase = module.key.role == package::roleNamed("ShadeCase");
        EXPECT_FALSE(isCase && has(text, "GLINT_MOST_BUCKETS")) << module.name;
        EXPECT_FALSE(isCase && has(text, "GLINT_HIT_ALWAYS_LOBES")) << module.name;
        EXPECT_FALSE(isCase && has(text, "GLINT_ALWAYS_LOBES")) << module.name;
    }
}

}  // namespace
}  // namespace glint
