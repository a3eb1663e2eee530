// Small shaders, and what lint finds in them.
#pragma once

#include "spirv/compiler.h"
#include "spirv/lint.h"
#include "support/must.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace glint::testing {

using Words = std::vector<std::uint32_t>;
using Rules = std::vector<std::string>;

inline constexpr const char* kQueryHead = R"(#version 460
#extension GL_EXT_ray_query : require
#extension GL_EXT_ray_flags_primitive_culling : require
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) uniform accelerationStructureEXT tlas;
layout(set = 0, binding = 1) buffer Data { uint a; uint b; float t; uint flags; } data;
const uint kFast = gl_RayFlagsOpaqueEXT | gl_RayFlagsSkipAABBEXT;
const uint kAny = kFast | gl_RayFlagsTerminateOnFirstHitEXT;
#define START(q, flags) \
    rayQueryInitializeEXT(q, tlas, flags, 0xFFu, vec3(data.t), 0.0, vec3(0, 0, 1), 10.0)
#define HIT(q) rayQueryGetIntersectionTypeEXT(q, true)
#define DISTANCE(q) rayQueryGetIntersectionTEXT(q, true)
)";

inline Words compile(compiler::ShaderStage stage, const std::string& glsl,
                     std::vector<std::string> apart = {}) {
    compiler::ShaderSource source{"lint", stage, glsl};
    source.functionsApart = std::move(apart);
    return must(compileShader(source, {.debugInfo = true}));
}

inline Words compileQuery(const std::string& body, std::vector<std::string> apart = {}) {
    return compile(compiler::ShaderStage::Compute, kQueryHead + body, std::move(apart));
}

inline std::vector<compiler::LintFinding> findings(const Words& words) {
    const compiler::SpirvLint lint = must(compiler::lintSpirv(words));
    return lint.findings;
}

// Returns the findings as "error query-proceeds", sorted.
inline Rules rules(const Words& words) {
    constexpr const char* kNames[] = {"note", "warning", "error"};
    Rules list;
    for (const compiler::LintFinding& finding : findings(words)) {
        list.push_back(std::string(kNames[static_cast<int>(finding.severity)]) + " " + finding.rule);
    }
    std::ranges::sort(list);
    return list;
}

// Two functions that stay functions: one passes constants on, and the other has its own query.
inline constexpr const char* kFunctions = R"(
    bool isVisible(uint flags, float t) {
        if (t < 0.0) { return false; }
        rayQueryEXT q;
        START(q, flags);
        rayQueryProceedEXT(q);
        return HIT(q) == 0u;
    }
    void main() {
        rayQueryEXT p;
        START(p, kFast);
        rayQueryProceedEXT(p);
        float t = DISTANCE(p);
        bool visible = isVisible(kAny, t) && isVisible(kAny, 2.0 * t);
        data.t = visible ? READ : 0.0;
    })";

inline std::string functionsWith(const std::string& read) {
    return "#define READ " + read + kFunctions;
}

}  // namespace glint::testing
