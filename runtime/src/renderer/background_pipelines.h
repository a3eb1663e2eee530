// Pipelines that threads make while frames are drawn with a fallback.
#pragma once

#include "context/parallel.h"
#include "renderer/pipeline_jobs.h"

#include <glint/internal/package_modules.h>
#include <glint/renderer_options.h>

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace glint {

// The time at which a pipeline is made, in this order.
enum class PipelineTurn : std::uint8_t {
    First,  // frames can't begin without it
    Fixed,  // frames are drafts without it
    Case,   // the fallback is in its place
    Spare,  // nothing that is drawn needs it
};

// A pipeline to make, and the passes that it serves.
struct PlannedPipeline {
    PipelineJob job;
    std::vector<package::ModuleKey> keys;                // of the passes
    std::shared_ptr<const RayPipelineSource> rays = {};  // of a ray tracing pipeline
    PipelineTurn turn = PipelineTurn::First;
};

// Returns the shader IDs of the cases that have a dispatch of their own with the pipeline.
std::vector<std::uint32_t> casesOf(const PlannedPipeline& planned);

class BackgroundPipelines {
public:
    struct Done {
        PlannedPipeline planned;
        MadePipeline made;
    };

    // Makes at most `threads` pipelines at once, at least one. Modules and layouts that they need must
    // outlive this. If there is no thread, progress() has the error.
    BackgroundPipelines(Jobs& jobs, std::vector<PlannedPipeline> planned, VkPipelineCreateFlags flags,
                        std::uint32_t threads);
    // Waits for the pipelines that are being made, and makes no more.
    ~BackgroundPipelines() = default;
    BackgroundPipelines(const BackgroundPipelines&) = delete;
    BackgroundPipelines& operator=(const BackgroundPipelines&) = delete;

    // Sets the order of the cases that remain: the one with the most hits is made next. `bucketCounts` has
    // the misses first, then the hits by shader ID.
    void setHits(std::span<const std::uint32_t> bucketCounts);
    // Takes back what take() or takeFixed() returned last and the caller could not use.
    void putBack(std::vector<Done> done);
    // Returns pipelines that were made since the last call, at most `most`.
    std::vector<Done> take(std::size_t most);
    // Returns all fixed passes if all are made and none has failed, and otherwise nothing.
    std::vector<Done> takeFixed();
    // Returns when every pipeline that may be begun was made or has failed.
    void wait();
    // While paused, no further pipeline is begun but for fixed passes, which end a draft.
    void setPaused(bool paused);
    // Returns the number of pipelines, other than spare ones, that are not made yet.
    std::uint32_t missing() const;

    Renderer::PipelineProgress progress() const;

private:
    // Gives out as many jobs as there are pipelines to begin and threads left.
    void giveOut() noexcept;
    // Is a job: makes one pipeline.
    void work() noexcept;
    std::optional<Diagnostic> make(PlannedPipeline planned);
    std::optional<PlannedPipeline> next();
    // Returns the pipeline that is made next; the end if nothing may be begun. Requires the lock.
    std::vector<PlannedPipeline>::iterator best();
    std::vector<Done> take(std::vector<Done>::iterator first, std::vector<Done>::iterator end);

    VkPipelineCreateFlags flags_;
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::vector<PlannedPipeline> waiting_;
    std::vector<Done> done_;
    std::vector<std::uint32_t> hits_;  // by shader ID
    std::uint32_t wanted_ = 0;
    std::uint32_t running_ = 0;
    std::uint32_t missing_ = 0;
    std::uint32_t missingFixed_ = 0;
    std::uint32_t adopted_ = 0;
    std::optional<Diagnostic> error_;
    std::uint32_t threads_;
    std::uint32_t given_ = 0;  // jobs that have not ended
    bool paused_ = false;
    JobGroup group_;
};

}  // namespace glint
