// Tests shaders that are compiled in parts and joined.
#include "spirv/join.h"

#include "spirv/compiler.h"
#include "spirv/optimize.h"
#include "spirv/reader.h"
#include "spirv/statistics.h"
#include "support/must.h"

#include <glslang/SPIRV/spirv.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace glint {
namespace {

using Words = std::vector<std::uint32_t>;

// What all parts declare: a buffer, a structure that leads back to itself by address, and one to pass on.
constexpr const char* kShared =
    "#version 460\n"
    "#extension GL_EXT_buffer_reference : require\n"
    "#extension GL_EXT_scalar_block_layout : require\n"
    "layout(local_size_x = 1) in;\n"
    "layout(buffer_reference) buffer Node;\n"
    "layout(buffer_reference, scalar) buffer Node { float value; float unread; Node next; };\n"
    "layout(push_constant, scalar) uniform Push { Node first; uint number; } pushed;\n"
    "layout(set = 0, binding = 1, scalar) buffer Data { float x[]; } data;\n"
    "struct Hit { vec3 place; uint number; };\n";

Words compilePart(const std::string& glsl, const compiler::LinkNames& names,
                  const compiler::ShaderCompileOptions& options = {}) {
    return must(
        compiler::compilePart({"part", compiler::ShaderStage::Compute, kShared + glsl, {}}, names, options));
}

// A part with a function that returns `value`, a float.
Words partOf(const std::string& name, const std::string& value, const std::string& before = "",
             const compiler::ShaderCompileOptions& options = {}) {
    return compilePart(before + "float " + name + "(Hit hit) { return " + value + "; }\n" +
                           "void main() { Hit hit; " + name + "(hit); }\n",
                       {{name}, {}, false}, options);
}

// Calls first(), and second() unless it is left out.
Words headOf(bool callsSecond = true, const compiler::ShaderCompileOptions& options = {}) {
    return compilePart(
        std::string("float first(Hit hit) { return 0.0; }\nfloat second(Hit hit) { return 0.0; }\n") +
            "void main() {\n  Hit hit = Hit(vec3(data.x[0]), pushed.number);\n" +
            "  float sum = pushed.first.next.value;\n  if (pushed.number == 1u) { sum += first(hit); }\n" +
            (callsSecond ? "  else { sum += second(hit); }\n" : "") + "  data.x[1] = sum;\n}\n",
        {{}, {"first", "second"}, true}, options);
}

Result<Words> join(const std::vector<Words>& parts, const compiler::ShaderCompileOptions& options = {}) {
    std::vector<std::span<const std::uint32_t>> spans(parts.begin(), parts.end());
    return compiler::joinParts(spans, "joined", options);
}

// How often a module has each opcode.
std::map<std::uint32_t, int> opcodesOf(const Words& words) {
    std::map<std::uint32_t, int> opcodes;
    const Status status = compiler::visitSpirv(
        words, [&](const compiler::SpirvInstruction& instruction) { ++opcodes[instruction.opcode]; });
    EXPECT_TRUE(status);
    return opcodes;
}

// Types, constants and variables, which a module that was compiled as a whole has once.
int countGlobals(const Words& words) {
    int count = 0;
    for (const auto& [opcode, number] : opcodesOf(words)) {
        count += (opcode >= spv::OpTypeVoid && opcode <= spv::OpTypeForwardPointer) ||
                         (opcode >= spv::OpConstantTrue && opcode <= spv::OpConstantNull)
                     ? number
                     : 0;
    }
    return count;
}

TEST(Join, HasWhatAWholeShaderHas) {
    const std::string bodies =
        "float first(Hit hit) { return hit.place.x * pushed.first.value; }\n"
        "float second(Hit hit) { return data.x[hit.number] + sqrt(hit.place.y); }\n";
    const auto joined = must(join({headOf(), partOf("first", "hit.place.x * pushed.first.value"),
                                   partOf("second", "data.x[hit.number] + sqrt(hit.place.y)")}));
    const auto whole = must(compiler::compileShader(
        {"whole",
         compiler::ShaderStage::Compute,
         kShared + bodies +
             "void main() {\n  Hit hit = Hit(vec3(data.x[0]), pushed.number);\n"
             "  float sum = pushed.first.next.value;\n  if (pushed.number == 1u) { sum += first(hit); }\n"
             "  else { sum += second(hit); }\n  data.x[1] = sum;\n}\n",
         {"first", "second"}},
        {}));
    EXPECT_LE(countGlobals(joined), countGlobals(whole));
    for (const std::uint32_t opcode :
         {spv::OpFunction, spv::OpFunctionCall, spv::OpVariable, spv::OpTypeStruct, spv::OpTypePointer,
          spv::OpLoad, spv::OpStore, spv::OpFAdd}) {
        EXPECT_EQ(opcodesOf(joined)[opcode], opcodesOf(whole)[opcode]) << opcode;
    }
    EXPECT_LE(joined.size(), whole.size());
    const std::string text = must(compiler::disassemble(joined));
    EXPECT_EQ(text.find("Linkage"), std::string::npos);
    EXPECT_EQ(opcodesOf(joined)[spv::OpName], 0);
    EXPECT_EQ(opcodesOf(joined)[spv::OpTypeForwardPointer], 1);
}

TEST(Join, EqualFunctionsBecomeOne) {
    const Words first = partOf("first", "hit.place.x * 3.0");
    const auto same = join({headOf(), first, partOf("second", "hit.place.x * 3.0")});
    const auto other = join({headOf(), first, partOf("second", "hit.place.x * 2.0")});
    ASSERT_TRUE(same) << toString(same.error());
    ASSERT_TRUE(other) << toString(other.error());
    EXPECT_EQ(opcodesOf(*same)[spv::OpFunction], 2);
    EXPECT_EQ(opcodesOf(*other)[spv::OpFunction], 3);
    EXPECT_EQ(opcodesOf(*same)[spv::OpFunctionCall], 2);
}

// The instructions are the same; only how exactly they are computed differs.
TEST(Join, FunctionsWithOtherDecorationsStayApart) {
    const std::string sum =
        "float NAME(Hit hit) { QUALIFIER float sum = hit.place.x * hit.place.y + 1.0; return sum; }\n"
        "void main() { Hit hit; NAME(hit); }\n";
    const auto part = [&](const std::string& name, const std::string& qualifier) {
        std::string glsl = sum;
        for (const auto& [key, value] :
             std::map<std::string, std::string>{{"NAME", name}, {"QUALIFIER", qualifier}}) {
            for (std::size_t at = glsl.find(key); at != std::string::npos; at = glsl.find(key)) {
                glsl.replace(at, key.size(), value);
            }
        }
        return compilePart(glsl, {{name}, {}, false});
    };
    const auto joined = must(join({headOf(), part("first", "precise"), part("second", "")}));
    EXPECT_EQ(opcodesOf(joined)[spv::OpFunction], 3);
    const std::string text = must(compiler::disassemble(joined));
    EXPECT_NE(text.find("NoContraction"), std::string::npos);
    const auto alike = must(join({headOf(), part("first", "precise"), part("second", "precise")}));
    EXPECT_EQ(opcodesOf(alike)[spv::OpFunction], 2);
}

TEST(Join, KeepsNamesForDebuggers) {
    const compiler::ShaderCompileOptions options{.debugInfo = true};
    const auto joined = must(join({headOf(true, options), partOf("first", "hit.place.x", "", options),
                                   partOf("second", "hit.place.x", "", options)},
                                  options));
    const std::string text = must(compiler::disassemble(joined));
    for (const char* const name : {"%Hit = ", "%main = ", "%first", "%second", "%Node = "}) {
        EXPECT_NE(text.find(name), std::string::npos) << name << "\n" << text;
    }
    // Functions that compute the same keep their own names.
    EXPECT_EQ(opcodesOf(joined)[spv::OpFunction], 3);
    std::set<std::pair<std::uint32_t, std::string>> names;
    int count = 0;
    EXPECT_TRUE(compiler::visitSpirv(joined, [&](const compiler::SpirvInstruction& instruction) {
        if (instruction.opcode == spv::OpName) {
            ++count;
            names.emplace(instruction.operands[0], compiler::spirvString(instruction.operands.subspan(1)));
        }
    }));
    EXPECT_EQ(static_cast<std::size_t>(count), names.size());
}

TEST(Join, GivesTheSameWordsForTheSameParts) {
    const std::vector<Words> parts{headOf(), partOf("first", "hit.place.x"),
                                   partOf("second", "data.x[hit.number]")};
    const auto once = join(parts);
    const auto again =
        join({headOf(), partOf("first", "hit.place.x"), partOf("second", "data.x[hit.number]")});
    ASSERT_TRUE(once);
    ASSERT_TRUE(again);
    EXPECT_EQ(*once, *again);
}

// Two functions of a shader whose structures have members that nothing reads, at the places that count.
std::vector<Words> partsWithUnreadMembers() {
    const std::string shared =
        "#version 460\n#extension GL_EXT_scalar_block_layout : require\nlayout(local_size_x = 1) in;\n"
        "struct Inner { float unread; vec2 read; };\n"
        "layout(push_constant, scalar) uniform Push { uint unread; uint number; Inner inner[2]; vec4 last; "
        "};\n"
        "layout(set = 0, binding = 0, scalar) buffer Data { float x[]; } data;\n"
        "layout(set = 0, binding = 1, scalar) uniform Unread { float y; } unreadBlock;\n";
    std::vector<Words> parts;
    for (const auto& [glsl, names] : std::vector<std::pair<std::string, compiler::LinkNames>>{
             {"float first(float x) { return 0.0; }\nfloat second(float x) { return 0.0; }\n"
              "void main() { data.x[1] = number == 1u ? first(data.x[0]) : second(data.x[0]) + 7.0; }\n",
              {{}, {"first", "second"}, true}},
             {"float first(float x) { return x * inner[number].read.y + last.z; }\n"
              "void main() { first(1.0); }\n",
              {{"first"}, {}, false}},
             {"float second(float x) { return inner[1].read.x - x; }\nvoid main() { second(1.0); }\n",
              {{"second"}, {}, false}}}) {
        auto words =
            compiler::compilePart({"part", compiler::ShaderStage::Compute, shared + glsl, {}}, names, {});
        EXPECT_TRUE(words) << toString(words.error());
        parts.push_back(words ? *words : Words());
    }
    return parts;
}

TEST(Join, ClearsLikeTheOptimiser) {
    const std::vector<Words> parts = partsWithUnreadMembers();
    const std::vector<std::span<const std::uint32_t>> spans(parts.begin(), parts.end());
    const Words joined = must(compiler::joinModules(spans, "joined", false));
    const auto parsed = must(compiler::parseModule(joined, "joined"));
    for (const bool keepMembers : {false, true}) {
        const std::optional<Words> cleared = compiler::clearGlobals(parsed, keepMembers);
        ASSERT_TRUE(cleared);
        Words expected = joined;
        ASSERT_TRUE(compiler::clearJoined(expected, "joined", keepMembers));
        EXPECT_LT(cleared->size(), joined.size());
        EXPECT_EQ(*cleared, expected) << keepMembers;
    }
}

// A shader of three functions that have many instructions.
Words largeShader() {
    constexpr int kLines = 1500;
    std::vector<Words> parts{headOf()};
    for (const std::string name : {"first", "second"}) {
        std::string before = "float long_" + name + "(float x) {\n";
        for (int i = 0; i < kLines; ++i) {
            before += "x = sin(x) * data.x[" + std::to_string(i) + (name == "first" ? "];\n" : "] + 2.0;\n");
        }
        parts.push_back(partOf(name, "long_" + name + "(hit.place.x)", before + "return x;\n}\n"));
    }
    return must(join(parts));
}

TEST(Join, ValidatesGroupsOfFunctions) {
    Words shader = largeShader();
    const std::vector<Words> copies = compiler::validationCopies(shader, 2);
    ASSERT_EQ(copies.size(), 2U);
    for (const Words& copy : copies) {
        EXPECT_LT(copy.size(), shader.size() * 3 / 4);
        const Status valid = compiler::validateSpirv(copy, "copy");
        EXPECT_TRUE(valid) << toString(valid.error());
    }
    // The last product gets a function as a factor.
    std::size_t product = 0;
    std::uint32_t function = 0;
    for (std::size_t at = compiler::kSpirvHeaderWords; at < shader.size(); at += shader[at] >> 16U) {
        product = (shader[at] & 0xFFFFU) == spv::OpFMul ? at : product;
        function = (shader[at] & 0xFFFFU) == spv::OpFunction ? shader[at + 2] : function;
    }
    ASSERT_NE(product, 0U);
    shader[product + 3] = function;
    int invalid = 0;
    for (const Words& copy : compiler::validationCopies(shader, 2)) {
        invalid += compiler::validateSpirv(copy, "copy") ? 0 : 1;
    }
    EXPECT_EQ(invalid, 1);
    EXPECT_EQ(mustFail(compiler::validateJoined(shader, "shader", 2)).message,
              compiler::validateSpirv(shader, "shader").error().message);
}

TEST(Join, RefusesWhatDoesNotFit) {
    const Words first = partOf("first", "hit.place.x");
    const Words second = partOf("second", "hit.place.y");
    const Diagnostic missing = mustFail(join({headOf(), first}));
    EXPECT_EQ(missing.id, "spirv-join");
    EXPECT_NE(missing.message.find("second"), std::string::npos);

    const Diagnostic twice = mustFail(join({headOf(), first, second, first}));
    EXPECT_NE(twice.message.find("two parts have a function first"), std::string::npos);

    const Words other = compilePart("float second(float hit) { return hit; }\nvoid main() { second(1.0); }\n",
                                    {{"second"}, {}, false});
    const Diagnostic type = mustFail(join({headOf(), first, other}));
    EXPECT_NE(type.message.find("second"), std::string::npos);

    const auto entry = join({headOf(false), first, headOf(false)});
    ASSERT_FALSE(entry);

    Words torn = second;
    torn[compiler::kSpirvHeaderWords] += 1U << 20U;  // an instruction that is longer than it can be
    EXPECT_EQ(mustFail(join({headOf(), first, torn})).id, "spirv-join");
}

// Two parts that disagree about a resource were not made of the same sources.
TEST(Join, RefusesResourcesThatAreDeclaredDifferently) {
    std::string glsl = kShared;
    const std::string declared = "buffer Data { float x[]; }";
    for (const auto& [from, to] :
         std::map<std::string, std::string>{{declared, "buffer Data { vec2 x[]; }"},
                                            {"buffer Data {", "readonly buffer Data {"},
                                            {"uint number; } pushed", "int number; } pushed"}}) {
        std::string changed = glsl;
        changed.replace(changed.find(from), from.size(), to);
        const auto part = must(compiler::compilePart(
            {"part",
             compiler::ShaderStage::Compute,
             changed + "float first(Hit hit) { return float(data.x[pushed.number].x); }\n"
                       "void main() { Hit hit; first(hit); }\n",
             {}},
            {{"first"}, {}, false}, {}));
        const auto joined = join({headOf(false), part});
        ASSERT_FALSE(joined) << to;
        EXPECT_EQ(joined.error().id, "spirv-join");
        EXPECT_NE(joined.error().message.find("declare"), std::string::npos) << joined.error().message;
    }
}

// What one part writes to such a variable, another may read.
TEST(Join, PartsWithGlobalVariablesAreNotJoinable) {
    const Words shared = partOf("first", "state", "float state;\n");
    EXPECT_FALSE(compiler::isJoinable(shared));
    EXPECT_TRUE(compiler::isJoinable(partOf("first", "hit.place.x", "float state;\n")));
    EXPECT_TRUE(compiler::isJoinable(headOf()));
    EXPECT_TRUE(compiler::measureSpirv(shared));
}

// Unless the entry points use them, too: then all parts have one variable, which keeps its stores and loads.
TEST(Join, VariablesThatEntryPointsUseAreShared) {
    const std::string state = "float state[2];\n";
    const Words part = compilePart(state +
                                       "float first(Hit hit) { return state[hit.number]; }\n"
                                       "void main() { Hit hit; state[0] = 0.0; first(hit); }\n",
                                   {{"first"}, {}, false});
    const Words head = compilePart(state +
                                       "float first(Hit hit) { return state[0]; }\n"
                                       "void main() {\n  Hit hit = Hit(vec3(0.0), pushed.number);\n"
                                       "  state[pushed.number] = data.x[2];\n  data.x[1] = first(hit);\n}\n",
                                   {{}, {"first"}, true});
    ASSERT_TRUE(compiler::isJoinable(part));
    const auto joined = must(join({head, part}));
    std::set<std::uint32_t> variables;
    std::map<std::uint32_t, std::uint32_t> places;  // pointers into them
    int stores = 0;
    int loads = 0;
    ASSERT_TRUE(compiler::visitSpirv(joined, [&](const compiler::SpirvInstruction& instruction) {
        const auto& words = instruction.operands;
        if (instruction.opcode == spv::OpVariable && words[2] == spv::StorageClassPrivate) {
            variables.insert(words[1]);
        } else if (instruction.opcode == spv::OpAccessChain && variables.contains(words[2])) {
            places[words[1]] = words[2];
        } else if (instruction.opcode == spv::OpStore) {
            stores += places.contains(words[0]) ? 1 : 0;
        } else if (instruction.opcode == spv::OpLoad) {
            loads += places.contains(words[2]) ? 1 : 0;
        }
    }));
    EXPECT_EQ(variables.size(), 1U);
    EXPECT_EQ(stores, 1);
    EXPECT_EQ(loads, 1);
}

}  // namespace
}  // namespace glint
