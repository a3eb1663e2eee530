#include "spirv/lint.h"

#include "spirv/lint_prepare.h"
#include "spirv/lint_rules.h"

#include <fmt/format.h>
#include <glslang/SPIRV/spirv.hpp>

#include <algorithm>

namespace glint::compiler {

namespace {

std::string nameModel(std::uint32_t model) {
    switch (model) {
        case spv::ExecutionModelVertex:
            return "Vertex";
        case spv::ExecutionModelFragment:
            return "Fragment";
        case spv::ExecutionModelGLCompute:
            return "GLCompute";
        case spv::ExecutionModelRayGenerationKHR:
            return "RayGenerationKHR";
        case spv::ExecutionModelIntersectionKHR:
            return "IntersectionKHR";
        case spv::ExecutionModelAnyHitKHR:
            return "AnyHitKHR";
        case spv::ExecutionModelClosestHitKHR:
            return "ClosestHitKHR";
        case spv::ExecutionModelMissKHR:
            return "MissKHR";
        case spv::ExecutionModelCallableKHR:
            return "CallableKHR";
        default:
            return fmt::format("model {}", model);
    }
}

}  // namespace

Result<SpirvLint> lintSpirv(std::span<const std::uint32_t> words) {
    GLINT_TRY(const auto statistics, measureSpirv(words));
    GLINT_TRY_DO(checkSpirv(words));
    SpirvLint lint;
    lint.statistics = statistics;
    for (const SpirvEntryPoint& entry : findEntryPoints(words)) {
        const std::string stage = nameModel(entry.model);
        if (std::ranges::find(lint.stages, stage) == lint.stages.end()) {
            lint.stages.push_back(stage);
        }
    }
    const std::map<std::size_t, SpirvPlace> places = findPlaces(words);
    if (statistics.rayQueries > 0) {
        lintQueries(words, places, lint.findings);
    }
    lintPipelines(words, places, lint.findings);
    std::ranges::stable_sort(lint.findings, {},
                             [](const LintFinding& finding) { return finding.place.offset; });
    return lint;
}

}  // namespace glint::compiler
