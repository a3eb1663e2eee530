#include "replacement/pipeline_identity.h"

#include "package/package_state.h"
#include "renderer/ray_pipelines.h"

#include <xxhash.h>

#include <array>

namespace glint {

PipelineIdentity identify(const Package& package, VkPipelineBindPoint point, std::uint64_t number,
                          const std::vector<std::span<const std::uint32_t>>& stages) {
    std::vector<std::uint64_t> parts{static_cast<std::uint64_t>(point), number};
    const auto& hashes = package.state().hashes;
    for (const std::span<const std::uint32_t> words : stages) {
        // A stage that the pipeline lacks has no words.
        const auto hash = hashes.find(words.data());
        const std::array<std::uint64_t, 2> ofStage =
            hash == hashes.end() ? std::array<std::uint64_t, 2>{} : hash->second;
        parts.insert(parts.end(), ofStage.begin(), ofStage.end());
    }
    const XXH128_hash_t all = XXH3_128bits(parts.data(), parts.size() * sizeof(parts[0]));
    return {all.low64, all.high64};
}

PipelineIdentity identify(const Package& package, const RayPipelineSource& source) {
    std::vector<SpirvWords> stages{source.rayGeneration, source.anyHit};
    stages.insert(stages.end(), source.miss.begin(), source.miss.end());
    stages.insert(stages.end(), source.closestHit.begin(), source.closestHit.end());
    // The number of miss shaders, together with the number of stages, tells the kind of each stage.
    return identify(package, VK_PIPELINE_BIND_POINT_RAY_TRACING_KHR, source.miss.size(), stages);
}

}  // namespace glint
