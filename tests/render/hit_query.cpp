#include "render/hit_query.h"

#include "render/hit_kernel.h"
#include "support/must.h"

#include <cstring>

namespace glint::testing {

namespace {

constexpr std::size_t kWords = sizeof(Values) / sizeof(std::uint32_t);

}  // namespace

std::vector<Values> ask(const gltf::Scene& scene, const std::vector<Query>& queries) {
    compiler::CompileSettings settings;
    settings.strategies = package::kStrategyUber;  // the less to compile: the kernel reads the scene only
    // Queries name triangles by the numbers that they have in the scene.
    const LoadedScene loaded(scene, settings, [](session::SceneViewData& data) {
        data.traversalOrder = SceneView::TraversalOrder::Input;
    });
    const std::unique_ptr<HitKernel> kernel = must(HitKernel::create(scene, loaded, "hit_values.comp"));
    std::vector<gpu::RayRecord> rays;
    for (const Query& query : queries) {
        gpu::RayRecord ray{};
        ray.origin = {query.barycentrics[0], query.barycentrics[1], query.anisotropy};
        ray.target = query.geometry;
        ray.direction = {query.direction[0], query.direction[1], query.direction[2]};
        ray.coneWidth = query.coneWidth;
        ray.coneSpread = static_cast<float>(query.triangle);
        rays.push_back(ray);
    }
    const auto count = static_cast<std::uint32_t>(rays.size());
    const std::vector<std::uint32_t> words = must(kernel->run({}, rays, count, count * kWords));
    std::vector<Values> values(queries.size());
    std::memcpy(values.data(), words.data(), words.size() * sizeof(std::uint32_t));
    return values;
}

}  // namespace glint::testing
