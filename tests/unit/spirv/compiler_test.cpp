#include "spirv/compiler.h"

#include "spirv/optimize.h"
#include "spirv/reader.h"
#include "spirv/statistics.h"
#include "support/must.h"

#include <glint/internal/package_modules.h>

#include <glslang/SPIRV/spirv.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <thread>
#include <vector>

namespace glint {
namespace {

// The shape of the generated shaders: one shade() for all cases, with features decided by literals and a
// mask. Case 0 reads textures 0 and 1, and case 1 reads texture 2. In case 2 the mask decides on texture 3.
constexpr const char* kThreeCases = R"(#version 460
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) uniform sampler2D images[5];
layout(set = 0, binding = 1) buffer Data { uint shaderId; uint mask; vec4 result; } data;

struct Features { uint always; uint sometimes; uint mask; };
bool has(Features f, uint bits) {
    return (f.always & bits) != 0u || ((f.sometimes & bits) != 0u && (f.mask & bits) != 0u);
}
vec4 shade(Features f) {
    vec4 sum = vec4(0.0);
    if (has(f, 1u)) { sum += textureLod(images[0], vec2(0.1), 0.0); }
    if (has(f, 2u)) { sum *= textureLod(images[1], sum.xy, 0.0); }
    if (has(f, 4u)) { sum += textureLod(images[2], sum.yz, 0.0); }
    if (has(f, 8u)) { sum -= textureLod(images[3], sum.zw, 0.0); }
    if (has(f, 16u)) { sum /= textureLod(images[4], sum.xw, 0.0); }
    return sum;
}
void main() {
    switch (data.shaderId) {
        case 0u: data.result = shade(Features(3u, 0u, data.mask)); break;
        case 1u: data.result = shade(Features(4u, 0u, data.mask)); break;
        case 2u: data.result = shade(Features(0u, 8u, data.mask)); break;
    }
}
)";

std::string computeShader(const std::string& body) {
    return "#version 460\n#extension GL_GOOGLE_cpp_style_line_directive : require\n"
           "#line 2 \"passes/test.comp\"\nlayout(local_size_x = 1) in;\nvoid main() {\n" +
           body + "}\n";
}

TEST(CompileShader, FoldsDecidedFeaturesAway) {
    const auto words =
        must(compiler::compileShader({"three.comp", compiler::ShaderStage::Compute, kThreeCases}, {}));
    const auto statistics = compiler::measureSpirv(words);
    ASSERT_TRUE(statistics);
    EXPECT_EQ(statistics->textureFetches, 4U);
    // There is one branch on the mask, for the feature that some keys have.
    EXPECT_EQ(statistics->branches, 2U);
}

TEST(CompileShader, LeavesInliningToDriversOnRequest) {
    const compiler::ShaderSource source{"three.comp", compiler::ShaderStage::Compute, kThreeCases};
    const auto words = must(compiler::compileShader(source, {.optimize = false}));
    const auto statistics = compiler::measureSpirv(words);
    ASSERT_TRUE(statistics);
    // The one function that all cases call.
    EXPECT_EQ(statistics->textureFetches, 5U);
    EXPECT_FALSE(compiler::findFunctions(words).empty());
    // Only the optimiser makes 16 bits of mediump.
    compiler::ShaderSource relaxed = source;
    relaxed.glsl.replace(relaxed.glsl.find("vec4 sum"), 4, "mediump vec4");
    EXPECT_EQ(must(compiler::compileShader(relaxed, {.optimize = false})),
              must(compiler::compileShader(relaxed, {})));
}

// Returns the IDs of the structures that ray queries are initialised with. Each must be the result of the
// instruction directly before.
std::vector<std::uint32_t> queriedStructures(const std::string& glsl) {
    constexpr std::uint32_t kOpRayQueryInitialize = 4473;
    std::vector<std::uint32_t> structures;
    const auto words = compiler::compileShader({"query.comp", compiler::ShaderStage::Compute, glsl}, {});
    EXPECT_TRUE(words) << toString(words.error());
    std::uint32_t before = 0;
    EXPECT_TRUE(words && compiler::visitSpirv(*words, [&](const compiler::SpirvInstruction& it) {
                    if (it.opcode == kOpRayQueryInitialize) {
                        structures.push_back(it.operands[1]);
                        EXPECT_EQ(before, structures.back());
                    }
                    before = it.operands.size() > 1 ? it.operands[1] : 0;
                }));
    return structures;
}

// SPIRV-Tools finds that the loads are equal, in a block and across blocks.
TEST(CompileShader, EachRayQueryLoadsItsStructureDirectlyBefore) {
    const auto shader = [](const std::string& structure) {
        return R"(#version 460
#extension GL_EXT_ray_query : require
#extension GL_EXT_nonuniform_qualifier : require
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) uniform accelerationStructureEXT one;
layout(set = 0, binding = 1) uniform accelerationStructureEXT several[];
layout(set = 0, binding = 2) buffer Data { uint n; float t; } data;
layout(push_constant) uniform Pushed { uint index; uvec2 address; } pushed;
#define STRUCTURE )" +
               structure + R"(
float trace(float t) {
    rayQueryEXT query;
    rayQueryInitializeEXT(query, STRUCTURE, gl_RayFlagsOpaqueEXT, 0xFFu, vec3(t), 0.0, vec3(0, 0, 1), 1e9);
    rayQueryProceedEXT(query);
    return rayQueryGetIntersectionTEXT(query, true);
}
void main() {
    float t = trace(trace(0.5));
    for (uint i = 0u; i < data.n; ++i) {
        t += trace(t);
    }
    data.t = t > 0.0 ? trace(t) : 0.0;
}
)";
    };
    for (const char* const structure :
         {"one", "several[pushed.index]", "accelerationStructureEXT(pushed.address)"}) {
        std::vector<std::uint32_t> structures = queriedStructures(shader(structure));
        EXPECT_EQ(structures.size(), 4U) << structure;
        std::ranges::sort(structures);
        EXPECT_EQ(std::ranges::adjacent_find(structures), structures.end()) << structure;
    }
}

std::string disassembled(const compiler::ShaderSource& source) {
    const auto words = compileShader(source, {});
    return must(words ? compiler::disassemble(*words) : Result<std::string>(words.error()));
}

// glslang declares what the source declares, and code that is folded away needs no feature of a device.
TEST(CompileShader, DeclaresNoCapabilityThatNothingNeeds) {
    const auto shader = [](const char* condition) {
        return std::string(R"(#version 460
#extension GL_EXT_ray_query : require
#extension GL_EXT_nonuniform_qualifier : require
#extension GL_EXT_shader_8bit_storage : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_arithmetic : require
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) uniform accelerationStructureEXT structures[];
layout(set = 0, binding = 1) buffer Data { uint n; float t; uint8_t bytes[]; } data;
layout(set = 0, binding = 2) uniform sampler2D images[];
layout(set = 0, binding = 3, rg32ui) uniform uimage2D pairs;
void main() {
    if ()") + condition +
               R"() {
        rayQueryEXT query;
        rayQueryInitializeEXT(query, structures[0], gl_RayFlagsOpaqueEXT, 0xFFu, vec3(0), 0.0, vec3(0, 0, 1), 1e9);
        rayQueryProceedEXT(query);
        data.t = rayQueryGetIntersectionTEXT(query, true) + textureLod(images[nonuniformEXT(data.n)], vec2(0), 0.0).x;
        data.bytes[data.n] = uint8_t(subgroupBallotBitCount(subgroupBallot(data.n > 3u)));
        data.n = uint((uint64_t(data.n) * data.n) >> 32u) + subgroupAdd(data.n) + imageLoad(pairs, ivec2(0)).x;
    }
}
)";
    };
    const auto featuresOf = [](const std::string& glsl) {
        const auto words =
            must(compiler::compileShader({"wide.comp", compiler::ShaderStage::Compute, glsl}, {}));
        return package::featuresOf(words);
    };
    EXPECT_EQ(featuresOf(shader("false")), std::vector<std::string>{});
    EXPECT_EQ(featuresOf(shader("true")),
              (std::vector<std::string>{
                  "VK_SUBGROUP_FEATURE_ARITHMETIC_BIT", "VK_SUBGROUP_FEATURE_BALLOT_BIT", "rayQuery",
                  "runtimeDescriptorArray", "shaderInt64", "shaderSampledImageArrayNonUniformIndexing",
                  "shaderStorageImageExtendedFormats", "storageBuffer8BitAccess"}));
}

TEST(CompileShader, LeavesMembersThatAreReadAtTheirOffsets) {
    const std::string text = disassembled(
        {"members.comp", compiler::ShaderStage::Compute,
         "#version 460\n#extension GL_EXT_buffer_reference : require\n"
         "layout(buffer_reference) buffer Data { vec4 unused[2]; float read; float other; float written; };\n"
         "layout(push_constant) uniform Push { Data data; };\n"
         "void main() { data.written = data.read; }\n"});
    EXPECT_NE(text.find("Offset 32"), std::string::npos) << text;
    EXPECT_NE(text.find("Offset 40"), std::string::npos) << text;
    EXPECT_EQ(text.find("ArrayStride"), std::string::npos) << text;
    EXPECT_EQ(text.find("Offset 36"), std::string::npos) << text;
}

// Payloads have no offsets: another stage of the pipeline finds a member by its number.
TEST(CompileShader, LeavesPayloadsWhole) {
    const std::string text = disassembled({"payload.rchit", compiler::ShaderStage::ClosestHit,
                                           "#version 460\n#extension GL_EXT_ray_tracing : require\n"
                                           "struct Payload { uint id; float distance; vec2 uv; };\n"
                                           "layout(location = 0) rayPayloadInEXT Payload payload;\n"
                                           "void main() { payload.distance = gl_HitTEXT; }\n"});
    EXPECT_NE(text.find("OpTypeStruct %uint %float %v2float"), std::string::npos) << text;
}

TEST(CompileShader, MakesSpirv15) {
    const auto words =
        must(compiler::compileShader({"a.comp", compiler::ShaderStage::Compute, computeShader("")}, {}));
    EXPECT_EQ(words.at(1), 0x00010500U);
}

TEST(CompileShader, NamesFileAndLineOfAnError) {
    const Diagnostic words = mustFail(compiler::compileShader(
        {"a.comp", compiler::ShaderStage::Compute, computeShader("    float x = missing;\n")}, {}));
    EXPECT_EQ(words.id, "glsl");
    EXPECT_EQ(words.where, "passes/test.comp:4");
    EXPECT_NE(words.message.find("missing"), std::string::npos) << words.message;
    EXPECT_NE(words.message.find("a.comp"), std::string::npos);
}

TEST(CompileShader, ReportsLinkErrors) {
    const Diagnostic words =
        mustFail(compiler::compileShader({"a.comp", compiler::ShaderStage::Compute,
                                          "#version 460\nvoid undefined();\nvoid main() { undefined(); }\n"},
                                         {}));
    EXPECT_EQ(words.id, "glsl");
    EXPECT_FALSE(words.message.empty());
}

TEST(CompileShader, KeepsNamesForDebugInfoOnly) {
    for (const bool debugInfo : {false, true}) {
        const auto words = must(compiler::compileShader(
            {"three.comp", compiler::ShaderStage::Compute, kThreeCases}, {.debugInfo = debugInfo}));
        const auto text = compiler::disassemble(words);
        ASSERT_TRUE(text);
        EXPECT_EQ(text->find("OpMemberName") != std::string::npos, debugInfo);
    }
}

TEST(CompileShader, GivesTheSameWordsOnEveryThread) {
    const compiler::ShaderSource source{"three.comp", compiler::ShaderStage::Compute, kThreeCases};
    const auto expected = compileShader(source, {});
    ASSERT_TRUE(expected);
    std::vector<std::vector<std::uint32_t>> results(4);
    {
        std::vector<std::jthread> threads;
        threads.reserve(results.size());
        for (auto& result : results) {
            threads.emplace_back([&] {
                if (const auto words = compileShader(source, {})) {
                    result = *words;
                }
            });
        }
    }
    for (const auto& result : results) {
        EXPECT_EQ(result, *expected);
    }
}

// Records behind an address, as the shaders of packages read them.
constexpr const char* kRecords = R"(#version 460
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
layout(local_size_x = 64) in;
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Words { uint data[]; };
struct Record { uint kind; vec3 place; Words words; float size; uint flags; };
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer Records { Record data[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Results { float data[]; };
layout(push_constant, scalar) uniform Push { Records records; Results results; Words words; } pushed;
void main() {
    uint i = gl_GlobalInvocationID.x;
)";

// The result's components of the loads behind addresses, in the order of the module.
std::vector<std::uint32_t> loadedComponents(const std::string& body) {
    const auto words = compiler::compileShader(
        {"records.comp", compiler::ShaderStage::Compute, kRecords + body + "}\n"}, {});
    EXPECT_TRUE(words) << toString(words.error());
    std::map<std::uint32_t, std::uint32_t> components;
    std::vector<std::uint32_t> loaded;
    EXPECT_TRUE(compiler::visitSpirv(*words, [&](const compiler::SpirvInstruction& it) {
        if (it.opcode == spv::OpTypeInt || it.opcode == spv::OpTypeFloat) {
            components[it.operands[0]] = 1;
        } else if (it.opcode == spv::OpTypeVector) {
            components[it.operands[0]] = it.operands[2];
        } else if (it.opcode == spv::OpLoad && it.operands.size() == 5) {  // with its alignment
            loaded.push_back(components[it.operands[0]]);
        }
    }));
    return loaded;
}

TEST(WideLoads, ReadNeighboursTogether) {
    // The members of a structure, in their order: 1 + 3 words, then an address, a float and a uint.
    EXPECT_EQ(loadedComponents(R"(
        Record r = pushed.records.data[i];
        pushed.results.data[i] = r.place.x + r.place.y * r.place.z + r.size + float(r.kind + r.flags + r.words.data[0]);
    )"),
              (std::vector<std::uint32_t>{4, 4, 1}));
    // Elements of an array at an index that is not known, with the constant on either side.
    EXPECT_EQ(loadedComponents(R"(
        pushed.results.data[i] = float(pushed.words.data[3u * i + 1u] + pushed.words.data[3u * i] +
                                       pushed.words.data[2u + 3u * i]);
    )"),
              (std::vector<std::uint32_t>{3}));
}

TEST(WideLoads, LeaveWhatIsApartOrMayHaveChanged) {
    EXPECT_EQ(loadedComponents(R"(
        pushed.results.data[i] = float(pushed.words.data[i] + pushed.words.data[i + 3u]);
    )"),
              (std::vector<std::uint32_t>{1, 1}));
    EXPECT_EQ(loadedComponents(R"(
        uint first = pushed.words.data[i];
        pushed.results.data[i] = 1.0;
        pushed.results.data[i + 9u] = float(first + pushed.words.data[i + 1u]);
    )"),
              (std::vector<std::uint32_t>{1, 1}));
}

// glslang takes the alignment of the words that the address points to.
TEST(CompileShader, LoadsAddressesWithTheirAlignment) {
    const auto words = must(compiler::compileShader(
        {"records.comp", compiler::ShaderStage::Compute,
         kRecords + std::string("pushed.results.data[i] = pushed.records.data[i].words.data[0]; }\n")},
        {}));
    std::set<std::uint32_t> pointers;
    std::vector<std::uint32_t> alignments;
    ASSERT_TRUE(compiler::visitSpirv(words, [&](const compiler::SpirvInstruction& it) {
        if (it.opcode == spv::OpTypePointer) {
            pointers.insert(it.operands[0]);
        } else if (it.opcode == spv::OpLoad && it.operands.size() == 5 && pointers.contains(it.operands[0])) {
            alignments.push_back(it.operands[4]);
        }
    }));
    EXPECT_EQ(alignments, std::vector<std::uint32_t>{8});
}

TEST(WideLoads, LeaveOtherTypes) {
    const std::string glsl = R"(#version 460
        #extension GL_EXT_buffer_reference : require
        #extension GL_EXT_shader_16bit_storage : require
        #extension GL_EXT_shader_explicit_arithmetic_types_float16 : require
        layout(local_size_x = 64) in;
        layout(buffer_reference, std430, buffer_reference_align = 8) buffer Halves { f16vec4 data[]; };
        layout(push_constant) uniform Push { Halves from; Halves to; } pushed;
        void main() {
            uint i = gl_GlobalInvocationID.x;
            pushed.to.data[i] = pushed.from.data[i] + pushed.from.data[i + 1u];
        })";
    const auto words = compiler::compileShader({"halves.comp", compiler::ShaderStage::Compute, glsl}, {});
    EXPECT_TRUE(words) << toString(words.error());
}

// Nothing behind the loads writes to memory behind an address, and no block follows.
TEST(WideLoads, JoinInTheLastBlock) {
    const std::string glsl = R"(#version 460
        #extension GL_EXT_buffer_reference : require
        layout(local_size_x = 64) in;
        struct Record { vec3 place; float size; };
        layout(buffer_reference, std430, buffer_reference_align = 16) buffer Records { Record data[]; };
        layout(push_constant) uniform Push { Records from; } pushed;
        layout(set = 0, binding = 0) buffer Results { float sums[]; } results;
        void main() {
            Record r = pushed.from.data[gl_GlobalInvocationID.x];
            results.sums[gl_GlobalInvocationID.x] = r.place.x + r.size;
        })";
    const auto words = must(compiler::compileShader({"last.comp", compiler::ShaderStage::Compute, glsl}, {}));
    const Status valid = compiler::validateSpirv(words, "last.comp");
    EXPECT_TRUE(valid) << toString(valid.error());
}

TEST(WideLoads, ReadTheSameOnce) {
    EXPECT_EQ(loadedComponents(R"(
        float size = pushed.records.data[i].size;
        pushed.results.data[i] = size * pushed.records.data[i].size;
    )"),
              (std::vector<std::uint32_t>{1}));
}

TEST(ValidateSpirv, RefusesWhatIsNotValid) {
    auto words = compiler::compileShader({"three.comp", compiler::ShaderStage::Compute, kThreeCases}, {});
    ASSERT_TRUE(words);
    EXPECT_TRUE(compiler::validateSpirv(*words, "three.comp"));
    // The bound on IDs is below the IDs in use.
    words->at(3) = 2;
    const Diagnostic status = mustFail(compiler::validateSpirv(*words, "three.comp"));
    EXPECT_EQ(status.id, "spirv-validate");
    EXPECT_EQ(status.where, "three.comp");
}

TEST(ValidateSpirv, AllowsScalarLayout) {
    const auto words = compiler::compileShader({"scalar.comp", compiler::ShaderStage::Compute, R"(#version 460
#extension GL_EXT_scalar_block_layout : require
layout(local_size_x = 1) in;
layout(set = 0, binding = 0, scalar) buffer Data { float a; vec3 b; float c[3]; } data;
void main() { data.b = vec3(data.a, data.c[0], data.c[2]); }
)"},
                                               {});
    EXPECT_TRUE(words) << toString(words.error());
}

TEST(Disassemble, RefusesGarbage) {
    EXPECT_EQ(mustFail(compiler::disassemble({1, 2, 3})).id, "spirv-format");
}

}  // namespace
}  // namespace glint
