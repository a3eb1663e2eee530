// mediump becomes 16-bit arithmetic, and nothing else does.
#include "spirv/compiler.h"
#include "support/must.h"

#include <gtest/gtest.h>

#include <regex>
#include <string>

namespace glint {
namespace {

// A light from a buffer, whose position and intensity are far outside of 16 bits, and a colour that fits.
std::string lightShader(const std::string& relaxed) {
    return "#version 460\n#extension GL_EXT_buffer_reference : require\n"
           "#extension GL_EXT_scalar_block_layout : require\n"
           "precision highp float;\nprecision highp int;\n"
           "#define RELAXED " +
           relaxed + R"(
struct Light { vec3 position; vec3 intensity; float weights[2]; };
layout(buffer_reference, scalar) buffer Data { Light light; vec3 colour; vec3 result; };
layout(push_constant) uniform Push { Data data; };
RELAXED vec3 tinted(RELAXED vec3 a, RELAXED vec3 b) { return a * b + vec3(0.25); }
void main() {
    Light light = data.light;
    RELAXED vec3 colour = tinted(data.colour, data.colour.zyx) * light.weights[0];
    float squared = dot(light.position, light.position);
    data.result = colour * (light.intensity / squared);
}
)";
}

std::string disassembled(const std::string& glsl, const compiler::ShaderCompileOptions& options = {}) {
    const auto words = compileShader({"half.comp", compiler::ShaderStage::Compute, glsl}, options);
    return must(words ? compiler::disassemble(*words) : Result<std::string>(words.error()));
}

int count(const std::string& text, const std::string& pattern) {
    const std::regex expression(pattern);
    return static_cast<int>(std::distance(std::sregex_iterator(text.begin(), text.end(), expression), {}));
}

TEST(HalfPrecision, IsThatOfMediump) {
    const std::string text = disassembled(lightShader("mediump"));
    EXPECT_EQ(count(text, "OpCapability Float16"), 1) << text;
    EXPECT_EQ(count(text, "OpTypeFloat 16"), 1) << text;
    // This is a * b + 0.25, which may be fused.
    EXPECT_EQ(count(text, R"(OpFMul %v3half|Fma %\w+ %\w+)"), 1) << text;
    EXPECT_EQ(count(text, "= Op(Dot|FDiv) %(v3)?half"), 0) << text;
    EXPECT_EQ(count(text, "RelaxedPrecision"), 0) << text;
}

// SPIRV-Tools' pass treats values that come out of a structure or an array as relaxed.
TEST(HalfPrecision, LeavesWhatIsTakenOutOfStructures) {
    const std::string text = disassembled(lightShader("mediump"));
    EXPECT_EQ(count(text, "OpCompositeExtract %(v3)?half"), 0) << text;
    EXPECT_EQ(count(text, "OpDot %float"), 1) << text;
    EXPECT_EQ(count(text, "OpArrayLength"), 0) << text;
}

TEST(HalfPrecision, IsNowhereWithoutMediump) {
    const std::string text = disassembled(lightShader(""));
    EXPECT_EQ(count(text, "Float16|half|OpTypeFloat 16"), 0) << text;
}

TEST(HalfPrecision, CanBeThatOfEverything) {
    compiler::ShaderCompileOptions options;
    options.halvesAll = true;
    const std::string text = disassembled(lightShader(""), options);
    EXPECT_EQ(count(text, "= OpDot %half"), 1) << text;
    EXPECT_EQ(count(text, "= Op(Dot|FDiv|FMul|FAdd) %(v3)?float"), 0) << text;
}

// Functions that stay functions pass structures and colours to each other.
TEST(HalfPrecision, HoldsAcrossFunctionsThatStay) {
    compiler::ShaderSource source{
        "half.comp", compiler::ShaderStage::Compute, lightShader("mediump"), {"tinted"}};
    const auto words = must(compileShader(source, {}));
    const auto text = compiler::disassemble(words);
    ASSERT_TRUE(text);
    EXPECT_EQ(count(*text, "= OpFunction "), 2) << *text;
    EXPECT_GE(count(*text, "%v3half"), 1) << *text;
}

}  // namespace
}  // namespace glint
