#include "resolve/build.h"

#include "scene/deformed.h"

#include <algorithm>

namespace glint::compiler {

namespace {

std::vector<std::uint32_t> retiredIds(const Plan& plan) {
    std::vector<std::uint32_t> ids;
    for (const Case& shaderCase : plan.cases) {
        if (shaderCase.isRetired()) {
            ids.push_back(static_cast<std::uint32_t>(shaderCase.shaderId));
        }
    }
    return ids;
}

}  // namespace

package::PackageShape shapeOf(const gltf::SceneList& scenes, const Plan& plan,
                              const CompileSettings& settings) {
    return {settings.strategies,
            settings.tracers,
            settings.shadows,
            plan.effects.effects,
            settings.plan.keys.alpha != package::AlphaPolicy::Opaque,
            static_cast<std::uint32_t>(plan.cases.size()),
            retiredIds(plan),
            std::ranges::any_of(scenes.scenes(), hasDeformedMesh),
            settings.passes,
            settings.maxBounces,
            settings.plan.fallback,
            settings.shadowThrough != package::ShadowThrough::Alpha};
}

}  // namespace glint::compiler
