#include "renderer/pipeline_jobs.h"

#include "package/package_state.h"
#include "renderer/ray_pipelines.h"

#include <xxhash.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <numeric>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

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

std::uint32_t pipelineThreads(std::uint32_t wanted, std::size_t jobCount) {
    const std::uint32_t most = wanted > 0 ? wanted : std::max(std::thread::hardware_concurrency(), 1U);
    return static_cast<std::uint32_t>(std::clamp<std::size_t>(jobCount, 1, most));
}

std::vector<Result<MadePipeline>> tryPipelines(std::span<const PipelineJob> jobs, VkPipelineCreateFlags flags,
                                               std::uint32_t threads) {
    // The longest job must not begin last, as the others would then wait for it.
    std::vector<std::size_t> order(jobs.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, std::greater(), [&](std::size_t job) { return jobs[job].wordCount; });

    std::vector<std::optional<Result<UniquePipeline>>> results(jobs.size());
    std::vector<PipelineCreation> creations(jobs.size(), PipelineCreation{flags, {}});
    std::atomic<std::size_t> next{0};
    const auto work = [&] {
        for (std::size_t taken = next++; taken < order.size(); taken = next++) {
            const std::size_t job = order[taken];
            results[job].emplace(jobs[job].make(creations[job]));
        }
    };
    std::vector<std::thread> helpers;
    for (std::uint32_t i = 1; i < threads; ++i) {
        try {
            helpers.emplace_back(work);
        } catch (const std::system_error&) {
            break;  // no more threads: the existing ones do all the work
        }
    }
    work();
    for (std::thread& helper : helpers) {
        helper.join();
    }

    std::vector<Result<MadePipeline>> made;
    made.reserve(jobs.size());
    for (std::size_t job = 0; job < jobs.size(); ++job) {
        Result<UniquePipeline>& result = *results[job];
        if (!result) {
            made.emplace_back(result.error());
            continue;
        }
        made.emplace_back(MadePipeline{jobs[job].name,
                                       std::make_shared<const UniquePipeline>(std::move(*result)),
                                       creations[job].feedback, jobs[job].identity});
    }
    return made;
}

Result<std::vector<MadePipeline>> makePipelines(std::span<const PipelineJob> jobs,
                                                VkPipelineCreateFlags flags, std::uint32_t threads) {
    std::vector<MadePipeline> made;
    made.reserve(jobs.size());
    for (Result<MadePipeline>& result : tryPipelines(jobs, flags, threads)) {
        if (!result) {
            return result.error();
        }
        made.push_back(std::move(*result));
    }
    return made;
}

}  // namespace glint
