#include "replacement/pipeline_identity.h"

#include "renderer/ray_pipelines.h"

#include <xxhash.h>

namespace glint {

PipelineIdentity identify(VkPipelineBindPoint point, std::uint64_t number,
                          const std::vector<std::span<const std::uint32_t>>& stages) {
    std::vector<std::uint64_t> parts{static_cast<std::uint64_t>(point), number};
    for (const std::span<const std::uint32_t> words : stages) {
        const XXH128_hash_t hash = XXH3_128bits(words.data(), words.size_bytes());
        parts.insert(parts.end(), {hash.low64, hash.high64});
    }
    const XXH128_hash_t all = XXH3_128bits(parts.data(), parts.size() * sizeof(parts[0]));
    return {all.low64, all.high64};
}

PipelineIdentity identify(const RayPipelineSource& source) {
    std::vector<SpirvWords> stages{source.rayGeneration, source.anyHit};
    stages.insert(stages.end(), source.miss.begin(), source.miss.end());
    stages.insert(stages.end(), source.closestHit.begin(), source.closestHit.end());
    // With the number of stages, the number of miss shaders says which stage is what.
    return identify(VK_PIPELINE_BIND_POINT_RAY_TRACING_KHR, source.miss.size(), stages);
}

}  // namespace glint
