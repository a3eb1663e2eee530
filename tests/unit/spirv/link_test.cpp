// Tests functions of shaders that come as SPIR-V.
#include "spirv/link.h"

#include "spirv/compiler.h"
#include "support/must.h"

#include <gtest/gtest.h>
#include <spirv-tools/libspirv.hpp>

#include <string>
#include <vector>

namespace glint {
namespace {

using Words = std::vector<std::uint32_t>;

Result<std::string> lineOf(const Words& words) {
    return compiler::libraryLine(
        "ramp.spv", {reinterpret_cast<const char*>(words.data()), words.size() * sizeof(std::uint32_t)});
}

Words assembled(const std::string& text, spv_target_env version = SPV_ENV_UNIVERSAL_1_3) {
    const spvtools::SpirvTools tools(version);
    Words words;
    EXPECT_TRUE(tools.Assemble(text, &words)) << text;
    return words;
}

constexpr const char* kExported =
    "OpCapability Shader\nOpCapability Linkage\nOpMemoryModel Logical GLSL450\n"
    "OpDecorate %ramp LinkageAttributes \"ramp\" Export\n";
// As glslang leaves a shader that does not call the function.
constexpr const char* kNamed =
    "OpCapability Shader\nOpMemoryModel Logical GLSL450\nOpEntryPoint GLCompute %main \"main\"\n"
    "OpExecutionMode %main LocalSize 1 1 1\nOpName %main \"main\"\nOpName %ramp "
    "\"ramp(struct-Ramp-f11;f1;\"\n";
constexpr const char* kValues =
    "%model = OpFunctionParameter %Ramp\n%x = OpFunctionParameter %float\n%start = OpLabel\n";
constexpr const char* kPointers =
    "%a = OpFunctionParameter %pRamp\n%b = OpFunctionParameter %pFloat\n%start = OpLabel\n"
    "%model = OpLoad %Ramp %a\n%x = OpLoad %float %b\n";

// A module with a function that returns 17 times the product of a structure's member and a number.
std::string rampOf(const std::string& head, bool byValue, const std::string& member = "%float") {
    return head +
           "%void = OpTypeVoid\n%float = OpTypeFloat 32\n%int = OpTypeInt 32 1\n%Ramp = OpTypeStruct " +
           member +
           "\n%pRamp = OpTypePointer Function %Ramp\n%pFloat = OpTypePointer Function %float\n"
           "%seventeen = OpConstant %float 17\n%procedure = OpTypeFunction %void\n%type = OpTypeFunction "
           "%float " +
           (byValue ? "%Ramp %float\n" : "%pRamp %pFloat\n") +
           "%main = OpFunction %void None %procedure\n%first = OpLabel\nOpReturn\nOpFunctionEnd\n"
           "%ramp = OpFunction %float None %type\n" +
           (byValue ? kValues : kPointers) + "%k = OpCompositeExtract " + member +
           " %model 0\n%y = OpFMul %float %x %seventeen\n" +
           (member == "%float" ? "%z = OpFMul %float %y %k\nOpReturnValue %z\n" : "OpReturnValue %y\n") +
           "OpFunctionEnd\n";
}

Result<Words> compiled(const Words& library) {
    const std::string glsl =
        "#version 460\nlayout(local_size_x = 1) in;\n"
        "layout(set = 0, binding = 0) buffer Data { float x[]; } data;\n"
        "struct Ramp { mediump float k; };\n" +
        must(lineOf(library)) + "\nfloat ramp(Ramp model, float x);\n" +
        "void main() { data.x[0] = ramp(Ramp(data.x[1]), data.x[2]); }\n";
    return compiler::compileShader({"ramp.comp", compiler::ShaderStage::Compute, glsl, {}}, {});
}

TEST(LinkFunctions, TakesThoseThatAModuleExportsOrNames) {
    std::string known;
    for (const auto& [head, byValue] :
         {std::pair{kExported, true}, {kExported, false}, {kNamed, true}, {kNamed, false}}) {
        const std::string text =
            must(compiler::disassemble(must(compiled(assembled(rampOf(head, byValue))))));
        EXPECT_NE(text.find("float_17"), std::string::npos) << text;
        EXPECT_EQ(text.find("OpFunctionCall"), std::string::npos) << text;
        EXPECT_EQ(text.find("Linkage"), std::string::npos) << text;
        EXPECT_TRUE(known.empty() || text == known) << text << known;
        known = text;
    }
}

TEST(LinkFunctions, RefusesOtherTypes) {
    const Result<Words> other = compiled(assembled(rampOf(kExported, true, "%int")));
    ASSERT_FALSE(other);
    EXPECT_EQ(other.error().id, "spirv-functions");
    EXPECT_EQ(other.error().where, "ramp.spv");
    EXPECT_NE(other.error().message.find("ramp takes or returns something else"), std::string::npos);
}

TEST(LinkFunctions, NeedsEachFunctionThatHasNoBody) {
    const Result<Words> missing =
        compiled(assembled("OpCapability Shader\nOpCapability Linkage\nOpMemoryModel Logical GLSL450\n"));
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.error().id, "glsl");
    EXPECT_EQ(missing.error().message, "ramp has no body");
}

TEST(LinkFunctions, RefusesWhatIsNoModule) {
    for (const Words& words :
         {Words{}, Words{1, 2, 3, 4, 5, 6}, assembled(rampOf(kExported, true), SPV_ENV_UNIVERSAL_1_6)}) {
        const Result<std::string> line = lineOf(words);
        ASSERT_FALSE(line);
        EXPECT_EQ(line.error().id, "spirv-functions");
        EXPECT_EQ(line.error().where, "ramp.spv");
    }
}

}  // namespace
}  // namespace glint
