#include "spirv/reader.h"
#include "unit/spirv/lint_shaders.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace glint::testing {
namespace {

constexpr std::uint32_t kOpSource = 3;
constexpr std::uint32_t kOpString = 7;
constexpr std::uint32_t kOpLine = 8;
constexpr std::uint32_t kOpRayQueryInitialize = 4473;

// Returns what lint finds in a main() with these statements.
Rules rulesOf(const std::string& statements) {
    return rules(compileQuery("void main() {" + statements + "}"));
}

TEST(LintQueries, TheFastShapeIsClean) {
    EXPECT_EQ(rulesOf(R"(
        rayQueryEXT q;
        START(q, kFast);
        rayQueryProceedEXT(q);
        if (HIT(q) != 0u) { data.t = DISTANCE(q); })"),
              Rules{});
}

TEST(LintQueries, ConditionAroundBothIsClean) {
    EXPECT_EQ(rulesOf(R"(
        if (data.b == 4u) { return; }
        for (uint i = 0u; i < data.a; ++i) {
            if (data.b == i) {
                rayQueryEXT q;
                START(q, kAny);
                rayQueryProceedEXT(q);
                data.b = HIT(q);
            }
        })"),
              Rules{});
}

TEST(LintQueries, TwoProceedsAreAnError) {
    EXPECT_EQ(rulesOf(R"(
        rayQueryEXT q;
        START(q, kAny);
        rayQueryProceedEXT(q);
        rayQueryProceedEXT(q);
        data.b = HIT(q);)"),
              Rules{"error query-proceeds"});
}

TEST(LintQueries, AProceedAfterEachInitializeIsClean) {
    EXPECT_EQ(rulesOf(R"(
        rayQueryEXT q;
        START(q, kAny);
        rayQueryProceedEXT(q);
        data.b = HIT(q);
        START(q, kFast);
        rayQueryProceedEXT(q);
        data.t = DISTANCE(q);)"),
              Rules{});
}

TEST(LintQueries, ConditionalProceedIsAnError) {
    const Rules expected{"error query-proceed-conditional"};
    EXPECT_EQ(rulesOf(R"(
        rayQueryEXT q;
        START(q, kAny);
        if (data.a == 3u) { rayQueryProceedEXT(q); }
        data.b = HIT(q);)"),
              expected);
    // The loop may run no round.
    EXPECT_EQ(rulesOf(R"(
        rayQueryEXT q;
        START(q, kAny);
        for (uint i = 0u; i < data.a; ++i) { rayQueryProceedEXT(q); }
        data.b = HIT(q);)"),
              expected);
    // There is a return between the two.
    EXPECT_EQ(rulesOf(R"(
        rayQueryEXT q;
        START(q, kAny);
        if (data.a == 3u) { return; }
        rayQueryProceedEXT(q);
        data.b = HIT(q);)"),
              expected);
    EXPECT_EQ(rulesOf(R"(
        rayQueryEXT q;
        START(q, kAny);
        switch (data.a) {
            case 1u: data.t = 1.0; break;
            case 7u: rayQueryProceedEXT(q); break;
            default: break;
        }
        data.b = HIT(q);)"),
              expected);
}

TEST(LintQueries, LoopOverCandidatesIsAWarning) {
    EXPECT_EQ(rulesOf(R"(
        rayQueryEXT q;
        START(q, gl_RayFlagsSkipAABBEXT);
        while (rayQueryProceedEXT(q)) {
            if (rayQueryGetIntersectionTEXT(q, false) > 1.0) { rayQueryConfirmIntersectionEXT(q); }
        }
        data.t = DISTANCE(q);)"),
              Rules{"warning query-proceed-loop"});
}

TEST(LintQueries, MissingProceedIsAWarning) {
    EXPECT_EQ(rulesOf(R"(
        rayQueryEXT q;
        START(q, kAny);
        data.b = HIT(q);)"),
              Rules{"warning query-proceed-missing"});
}

TEST(LintQueries, TwoLiveObjectsAreAnError) {
    EXPECT_EQ(rulesOf(R"(
        rayQueryEXT p;
        rayQueryEXT q;
        START(p, kFast);
        rayQueryProceedEXT(p);
        START(q, kFast);
        rayQueryProceedEXT(q);
        data.t = DISTANCE(p) + DISTANCE(q);)"),
              Rules{"error query-live-objects"});
    // The first query is read after a loop that uses the second.
    EXPECT_EQ(rulesOf(R"(
        rayQueryEXT p;
        START(p, kFast);
        rayQueryProceedEXT(p);
        for (uint i = 0u; i < data.a; ++i) {
            rayQueryEXT q;
            START(q, kAny);
            rayQueryProceedEXT(q);
            data.b = HIT(q);
        }
        data.t = DISTANCE(p);)"),
              Rules{"error query-live-objects"});
}

TEST(LintQueries, OneAfterTheOtherIsClean) {
    EXPECT_EQ(rulesOf(R"(
        for (uint i = 0u; i < data.a; ++i) {
            rayQueryEXT p;
            START(p, kFast);
            rayQueryProceedEXT(p);
            float t = DISTANCE(p);
            rayQueryEXT q;
            START(q, kAny);
            rayQueryProceedEXT(q);
            data.t = HIT(q) == 0u ? t : 0.0;
        })"),
              Rules{});
}

TEST(LintQueries, AnArrayChosenAtRunTimeIsAllLive) {
    EXPECT_EQ(rulesOf(R"(
        rayQueryEXT q[2];
        START(q[data.a], kAny);
        rayQueryProceedEXT(q[data.a]);
        data.b = HIT(q[data.a]);)"),
              Rules{"error query-live-objects"});
    EXPECT_EQ(rulesOf(R"(
        rayQueryEXT q[2];
        START(q[1], kAny);
        rayQueryProceedEXT(q[1]);
        data.b = HIT(q[1]);)"),
              Rules{});
}

TEST(LintQueries, FlagsMustBeConstantOpaqueAndWithoutAabbs) {
    const auto withFlags = [](const std::string& flags, const std::string& read) {
        return rulesOf("rayQueryEXT q; START(q, " + flags + "); rayQueryProceedEXT(q); " + read);
    };
    const std::string readsHit = "data.t = DISTANCE(q);";
    const std::string readsType = "data.b = HIT(q);";
    EXPECT_EQ(withFlags("kFast", readsHit), Rules{});
    EXPECT_EQ(withFlags("kAny", readsType), Rules{});
    EXPECT_EQ(withFlags("kFast", readsType), Rules{"note query-flags"});
    EXPECT_EQ(withFlags("gl_RayFlagsOpaqueEXT", readsHit), Rules{"warning query-flags"});
    EXPECT_EQ(withFlags("gl_RayFlagsSkipAABBEXT", readsHit), Rules{"warning query-flags"});
    EXPECT_EQ(withFlags("0u", readsHit), (Rules{"warning query-flags", "warning query-flags"}));
    EXPECT_EQ(withFlags("data.flags", readsHit), Rules{"warning query-flags"});
}

TEST(LintQueries, MicromapsOfTwoStatesSkipAlphaTests) {
    EXPECT_EQ(
        rulesOf("rayQueryEXT q; START(q, kFast | 0x400u); rayQueryProceedEXT(q); data.t = DISTANCE(q);"),
        Rules{"warning query-micromap-states"});
}

TEST(LintQueries, LooksThroughCalls) {
    EXPECT_EQ(rules(compileQuery(functionsWith("t"), {"isVisible"})), Rules{});
    const std::vector<compiler::LintFinding> found =
        findings(compileQuery(functionsWith("DISTANCE(p)"), {"isVisible"}));
    // There is one finding for the function, however often it is called.
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].rule, "query-live-objects");
    EXPECT_EQ(found[0].place.function, "isVisible");
}

// Adds a line at the first initialise.
Words withLine(const Words& words, std::uint32_t line) {
    Words result(words.begin(), words.begin() + 5);
    const std::uint32_t file = result[3]++;
    bool named = false;
    EXPECT_TRUE(compiler::visitSpirv(words, [&](const compiler::SpirvInstruction& it) {
        const auto opcode = it.opcode;
        if (!named && opcode >= kOpSource && opcode < kOpLine) {
            result.insert(result.end(), {4U << 16U | kOpString, file, 0x65732E61U, 0U});  // "a.se"
            named = true;
        }
        if (named && opcode == kOpRayQueryInitialize) {
            result.insert(result.end(), {4U << 16U | kOpLine, file, line, 1U});
        }
        result.push_back(static_cast<std::uint32_t>(it.operands.size() + 1) << 16U | opcode);
        result.insert(result.end(), it.operands.begin(), it.operands.end());
    }));
    EXPECT_TRUE(named);
    return result;
}

TEST(LintQueries, NamesThePlace) {
    const std::string twice = R"(
        void main() {
            rayQueryEXT q;
            START(q, kAny);
            rayQueryProceedEXT(q);
            rayQueryProceedEXT(q);
            data.b = HIT(q);
        })";
    const Words words = compileQuery(twice);
    const std::vector<compiler::LintFinding> found = findings(words);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].place.function, "main");
    EXPECT_EQ(found[0].place.source, "");
    ASSERT_LT(found[0].place.offset, words.size());
    EXPECT_EQ(words[found[0].place.offset] & 0xFFFFU, kOpRayQueryInitialize);
    EXPECT_FALSE(found[0].hint.empty());

    const std::vector<compiler::LintFinding> lined = findings(withLine(words, 34));
    ASSERT_EQ(lined.size(), 1U);
    EXPECT_EQ(lined[0].place.source, "a.se:34");
    EXPECT_NE(toString(lined[0].place).find("in main (a.se:34, word "), std::string::npos);
}

// The head declares one structure; this shader has an array beside it.
Rules rulesOfIndex(const std::string& index) {
    return rules(compile(compiler::ShaderStage::Compute,
                         std::string(kQueryHead) + R"(
        layout(constant_id = 3) const uint kChosen = 1u;
        layout(set = 0, binding = 2) uniform accelerationStructureEXT several[4];
        void main() {
            rayQueryEXT q;
            rayQueryInitializeEXT(q, several[)" +
                             index + R"(], kAny, 0xFFu, vec3(data.t), 0.0, vec3(0, 0, 1), 10.0);
            rayQueryProceedEXT(q);
            data.b = HIT(q);
        })"));
}

TEST(LintQueries, StructuresChosenAtRunTimeAreAWarning) {
    EXPECT_EQ(rulesOfIndex("data.a"), Rules{"warning query-structure-index"});
    EXPECT_EQ(rulesOfIndex("gl_WorkGroupID.x"), Rules{"warning query-structure-index"});
    EXPECT_EQ(rulesOfIndex("2"), Rules{});
    EXPECT_EQ(rulesOfIndex("kChosen"), Rules{});
    EXPECT_EQ(rulesOfIndex("kChosen + 1u"), Rules{});
}

// Optimisers make such modules.
TEST(LintQueries, StructuresThatAreNotLoadedBesideTheQueryAreAWarning) {
    const Words words = compileQuery(R"(
        void main() {
            rayQueryEXT q;
            START(q, kAny);
            rayQueryProceedEXT(q);
            if (HIT(q) == 0u) {
                START(q, kFast);
                rayQueryProceedEXT(q);
                data.t = DISTANCE(q);
            }
        })");
    EXPECT_EQ(rules(words), Rules{});
    Words shared = words;
    std::uint32_t first = 0;
    EXPECT_TRUE(compiler::visitSpirv(words, [&](const compiler::SpirvInstruction& it) {
        if (it.opcode == kOpRayQueryInitialize) {
            first = first == 0 ? it.operands[1] : first;
            shared[static_cast<std::size_t>(&it.operands[1] - words.data())] = first;
        }
    }));
    EXPECT_EQ(rules(shared), Rules{"warning query-structure-load"});
    EXPECT_NE(findings(shared).at(0).message.find("share"), std::string::npos);
}

}  // namespace
}  // namespace glint::testing
