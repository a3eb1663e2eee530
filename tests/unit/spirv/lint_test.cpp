#include "spirv/lint.h"

#include "support/must.h"
#include "unit/spirv/lint_shaders.h"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

namespace glint::testing {
namespace {

constexpr const char* kTraceHead = R"(#version 460
#extension GL_EXT_ray_tracing : require
layout(set = 0, binding = 0) uniform accelerationStructureEXT tlas;
#define TRACE(payloadIndex) \
    traceRayEXT(tlas, 0u, 0xFFu, 0u, 0u, 0u, vec3(0), 0.0, vec3(0, 0, 1), 10.0, payloadIndex)
)";

TEST(LintPipelines, OnlyHitShadersMayNotTrace) {
    const std::string generates =
        std::string(kTraceHead) +
        "layout(location = 0) rayPayloadEXT vec4 payload; void main() { payload = vec4(0); TRACE(0); }";
    EXPECT_EQ(rules(compile(compiler::ShaderStage::RayGeneration, generates)), Rules{"note payload-bytes"});
    const std::string recurses = std::string(kTraceHead) +
                                 "layout(location = 0) rayPayloadInEXT vec4 payload;\n"
                                 "layout(location = 1) rayPayloadEXT float next;\n"
                                 "void go() { TRACE(1); }\nvoid main() { go(); payload.x = next; }";
    EXPECT_EQ(rules(compile(compiler::ShaderStage::ClosestHit, recurses)),
              (Rules{"note payload-bytes", "warning trace-from-hit"}));
    EXPECT_EQ(rules(compile(compiler::ShaderStage::Miss, recurses, {"go"})),
              (Rules{"note payload-bytes", "warning trace-from-hit"}));
    const std::string ends =
        std::string(kTraceHead) +
        "layout(location = 0) rayPayloadInEXT vec4 payload; void main() { payload.x = 1.0; }";
    EXPECT_EQ(rules(compile(compiler::ShaderStage::ClosestHit, ends)), Rules{});
}

TEST(LintPipelines, MeasuresPayloads) {
    const auto lint = [](const std::string& type) {
        return findings(compile(compiler::ShaderStage::RayGeneration,
                                std::string(kTraceHead) +
                                    "struct Inner { vec3 a; uint b[2]; };\n"
                                    "struct Payload { Inner inner; mat3x4 m; bool c; };\n"
                                    "layout(location = 0) rayPayloadEXT " +
                                    type + " payload;\nvoid main() { TRACE(0); }"));
    };
    const std::vector<compiler::LintFinding> large = lint("Payload");
    ASSERT_EQ(large.size(), 1U);
    EXPECT_EQ(large[0].severity, Severity::Warning);
    // 12 + 8, 48, 4
    EXPECT_EQ(large[0].message, "the ray payload has 72 bytes");
    const std::vector<compiler::LintFinding> exact = lint("mat4");
    ASSERT_EQ(exact.size(), 1U);
    EXPECT_EQ(exact[0].severity, Severity::Note);
    EXPECT_EQ(exact[0].message, "the ray payload has 64 bytes");
}

TEST(Lint, CountsAndNamesStages) {
    const compiler::SpirvLint lint =
        must(compiler::lintSpirv(compileQuery(functionsWith("t"), {"isVisible"})));
    EXPECT_EQ(lint.stages, std::vector<std::string>{"GLCompute"});
    EXPECT_EQ(lint.statistics.functions, 2U);
    EXPECT_EQ(lint.statistics.rayQueries, 2U);
    EXPECT_EQ(lint.statistics.traces, 0U);
    const compiler::SpirvLint traces = must(compiler::lintSpirv(compile(
        compiler::ShaderStage::RayGeneration, std::string(kTraceHead) +
                                                  "layout(location = 0) rayPayloadEXT vec4 payload;\n"
                                                  "void main() { payload = vec4(0); TRACE(0); TRACE(0); }")));
    EXPECT_EQ(traces.stages, std::vector<std::string>{"RayGenerationKHR"});
    EXPECT_EQ(traces.statistics.traces, 2U);
}

TEST(Lint, ReportsWhatIsNotValid) {
    const Words good = compileQuery("void main() { data.a = 1u; }");
    Words bound = good;
    bound.at(3) = 2;
    Words operand = good;
    operand.back() = 2U << 16U | 253U;  // the end of the function, as a return of two words
    for (const Words& words : {bound, Words(good.begin(), good.end() - 1)}) {
        const Diagnostic lint = mustFail(compiler::lintSpirv(words));
        EXPECT_EQ(lint.id, "spirv-invalid");
        EXPECT_FALSE(lint.hint.empty());
    }
    for (const Words& words : {Words(), Words(5, 7U), operand}) {
        EXPECT_EQ(mustFail(compiler::lintSpirv(words)).id, "spirv-format");
    }
}

// Words are changed at random. The result must be an error or findings, never a crash.
TEST(Lint, SurvivesAlteredModules) {
    const Words good = compileQuery(functionsWith("DISTANCE(p)"), {"isVisible"});
    ASSERT_FALSE(good.empty());
    std::mt19937 engine(11);
    const auto random = [&] { return static_cast<std::uint32_t>(engine()); };
    int refused = 0;
    constexpr int kRounds = 300;
    for (int round = 0; round < kRounds; ++round) {
        Words words = good;
        for (std::uint32_t changes = 1 + random() % 3; changes > 0; --changes) {
            std::uint32_t& word = words[5 + random() % (words.size() - 5)];
            word = random() % 2 == 0 ? random() % words[3] : word ^ 1U << random() % 32;
        }
        const Result<compiler::SpirvLint> lint = compiler::lintSpirv(words);
        refused += lint ? 0 : 1;
        if (lint) {
            EXPECT_EQ(lint->stages.size(), 1U);
        }
    }
    EXPECT_GT(refused, kRounds / 2);
}

}  // namespace
}  // namespace glint::testing
