#include "spirv/compiler.h"
#include "spirv/optimize.h"
#include "spirv/reader.h"
#include "spirv/statistics.h"
#include "support/must.h"

#include <glslang/SPIRV/spirv.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

namespace glint {
namespace {

// Two cases, each a function of its own, above a chain of calls that literals cut short.
constexpr const char* kTwoCases = R"(#version 460
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) uniform sampler2D images[3];
layout(set = 0, binding = 1) buffer Data { uint shaderId; uint mask; vec4 result; } data;

struct Features { uint always; uint sometimes; uint mask; };
bool has(Features f, uint bits) {
    return (f.always & bits) != 0u || ((f.sometimes & bits) != 0u && (f.mask & bits) != 0u);
}
vec4 fetch(uint slot, vec2 uv) { return textureLod(images[slot], uv, 0.0); }
vec4 coat(Features f, vec4 base) {
    if (!has(f, 4u)) { return base; }
    return base + fetch(2u, base.xy);
}
vec4 shade(Features f) {
    vec4 sum = vec4(0.25);
    if (has(f, 1u)) { sum += fetch(0u, sum.xy); }
    if (has(f, 2u)) { sum *= fetch(1u, sum.yz); }
    return coat(f, sum);
}
vec4 shadeFirst() { return shade(Features(1u, 0u, data.mask)); }
vec4 shadeSecond() { return shade(Features(6u, 0u, data.mask)); }
void main() {
    if (data.shaderId == 0u) { data.result = shadeFirst(); } else { data.result = shadeSecond(); }
}
)";

compiler::ShaderSource source(std::vector<std::string> apart) {
    compiler::ShaderSource result{"two.comp", compiler::ShaderStage::Compute, kTwoCases};
    result.functionsApart = std::move(apart);
    return result;
}

const compiler::SpirvFunction* find(const std::vector<compiler::SpirvFunction>& functions,
                                    const std::string& name) {
    const auto place = std::ranges::find(functions, name, &compiler::SpirvFunction::name);
    return place == functions.end() ? nullptr : &*place;
}

TEST(CallGraph, LosesWhatNothingCalls) {
    auto words = must(compileShader(source({"shadeFirst", "shadeSecond"}), {.debugInfo = true}));
    EXPECT_EQ(compiler::withoutUncalled(words), words);
    // main() calls shadeFirst() twice.
    const std::vector<compiler::SpirvFunction> functions = compiler::findFunctions(words);
    const std::uint32_t first = find(functions, "shadeFirst")->id;
    const std::uint32_t second = find(functions, "shadeSecond")->id;
    for (const compiler::SpirvInstruction& it : compiler::SpirvInstructions(words)) {
        if (it.opcode == spv::OpFunctionCall && it.operands[2] == second) {
            words[it.at + 3] = first;
        }
    }
    const auto left = compiler::withoutUncalled(words);
    EXPECT_TRUE(compiler::validateSpirv(left, "two.comp"));
    EXPECT_EQ(compiler::findFunctions(left).size(), 2U);
    EXPECT_LT(left.size(), words.size());
    for (const compiler::SpirvInstruction& it : compiler::SpirvInstructions(left)) {
        EXPECT_FALSE(it.opcode == spv::OpName && it.operands[0] == second);
    }
}

TEST(CallGraph, NamesFunctionsAndWhatTheyCall) {
    const auto words = must(compileShader(source({"shadeFirst", "shadeSecond"}), {.debugInfo = true}));
    const std::vector<compiler::SpirvFunction> functions = compiler::findFunctions(words);
    ASSERT_EQ(functions.size(), 3U);
    const compiler::SpirvFunction* const main = find(functions, "main");
    const compiler::SpirvFunction* const first = find(functions, "shadeFirst");
    const compiler::SpirvFunction* const second = find(functions, "shadeSecond");
    ASSERT_TRUE(main != nullptr && first != nullptr && second != nullptr);
    std::vector<std::uint32_t> calls = main->calls;
    std::ranges::sort(calls);
    std::vector<std::uint32_t> expected{first->id, second->id};
    std::ranges::sort(expected);
    EXPECT_EQ(calls, expected);
    EXPECT_TRUE(first->calls.empty());
    EXPECT_TRUE(second->calls.empty());
}

TEST(CallGraph, AFunctionApartHoldsWhatItsLiteralsLeave) {
    const auto apart = compileShader(source({"shadeFirst", "shadeSecond"}), {});
    const auto inlined = compileShader(source({}), {});
    ASSERT_TRUE(apart && inlined);
    EXPECT_EQ(compiler::findFunctions(*apart).size(), 3U);
    EXPECT_EQ(compiler::findFunctions(*inlined).size(), 1U);
    for (const auto& words : {*apart, *inlined}) {
        const auto statistics = compiler::measureSpirv(words);
        ASSERT_TRUE(statistics);
        // There is one texture in the first case, and two in the second.
        EXPECT_EQ(statistics->textureFetches, 3U);
    }
}

TEST(CallGraph, LeavesInliningToTheDriver) {
    const auto words = compileShader(source({"shadeFirst", "shadeSecond"}), {});
    ASSERT_TRUE(words);
    for (const compiler::SpirvFunction& function : compiler::findFunctions(*words)) {
        EXPECT_EQ(words->at(function.controlWord), 0U);
    }
}

TEST(CallGraph, ForbidsInliningOfThoseApart) {
    auto words = compileShader(source({"shadeFirst", "shadeSecond"}), {.debugInfo = true});
    ASSERT_TRUE(words);
    const std::vector<compiler::SpirvFunction> functions = compiler::findFunctions(*words);
    const compiler::SpirvFunction* const first = find(functions, "shadeFirst");
    ASSERT_NE(first, nullptr);
    keepApart(*words, functions, {first->id});
    constexpr std::uint32_t kDontInline = 2;
    for (const compiler::SpirvFunction& function : functions) {
        EXPECT_EQ(words->at(function.controlWord), function.id == first->id ? kDontInline : 0U);
    }
}

}  // namespace
}  // namespace glint
