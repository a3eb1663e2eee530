#include "renderer/background_pipelines.h"

#include <algorithm>
#include <iterator>
#include <tuple>
#include <utility>

namespace glint {
namespace {

// Returns the hits that wait for a pipeline. `hits` are by shader ID.
std::uint64_t waitingHits(const PlannedPipeline& planned, std::span<const std::uint32_t> hits) {
    std::uint64_t sum = 0;
    for (const std::uint32_t shaderId : casesOf(planned)) {
        sum += shaderId < hits.size() ? hits[shaderId] : 0;
    }
    return sum;
}

}  // namespace

std::vector<std::uint32_t> casesOf(const PlannedPipeline& planned) {
    std::vector<std::uint32_t> cases;
    for (const package::ModuleKey& key : planned.keys) {
        if (package::findRole(key.role)->over == package::Over::Buckets) {
            cases.push_back(key.index);
        }
    }
    return cases;
}

BackgroundPipelines::BackgroundPipelines(Jobs& jobs, std::vector<PlannedPipeline> planned,
                                         VkPipelineCreateFlags flags, std::uint32_t threads)
    : flags_(flags),
      waiting_(std::move(planned)),
      wanted_(static_cast<std::uint32_t>(waiting_.size())),
      threads_(std::max(threads, 1U)),
      group_(jobs) {
    const auto count = [&](PipelineTurn turn) {
        return static_cast<std::uint32_t>(std::ranges::count(waiting_, turn, &PlannedPipeline::turn));
    };
    missing_ = wanted_ - count(PipelineTurn::Spare);
    missingFixed_ = count(PipelineTurn::Fixed);
    done_.reserve(wanted_);
    giveOut();
}

void BackgroundPipelines::giveOut() noexcept {
    std::uint32_t wanted = 0;
    {
        const std::lock_guard lock(mutex_);
        const bool begins = best() != waiting_.end();
        const std::size_t most = begins ? std::min<std::size_t>(threads_, running_ + waiting_.size()) : 0;
        wanted = static_cast<std::uint32_t>(std::max<std::size_t>(most, given_) - given_);
        given_ += wanted;
    }
    for (; wanted > 0; --wanted) {
        try {
            group_.run([this] { work(); });
        } catch (...) {
            const std::lock_guard lock(mutex_);
            given_ -= wanted;
            if (given_ == 0) {
                waiting_.clear();
                error_ = caughtError();
            }
            return;  // if there are others, they make all pipelines
        }
    }
}

void BackgroundPipelines::work() noexcept {
    std::optional<PlannedPipeline> planned = next();
    if (planned) {
        std::optional<Diagnostic> error = make(std::move(*planned));
        if (error) {
            group_.jobs().report(*error);
        }
        const std::lock_guard lock(mutex_);
        --running_;
        if (error && !error_) {
            error_ = std::move(error);
        }
    }
    {
        const std::lock_guard lock(mutex_);
        --given_;
    }
    giveOut();
    changed_.notify_all();
}

std::optional<Diagnostic> BackgroundPipelines::make(PlannedPipeline planned) try {
    Result<MadePipeline> made = makePipeline(planned.job, flags_);
    const std::lock_guard lock(mutex_);
    missing_ -= planned.turn == PipelineTurn::Spare ? 0 : 1;
    if (!made) {
        return made.error();
    }
    missingFixed_ -= planned.turn == PipelineTurn::Fixed ? 1 : 0;
    done_.push_back({std::move(planned), std::move(*made)});
    return std::nullopt;
} catch (...) {
    return caughtError();
}

std::vector<PlannedPipeline>::iterator BackgroundPipelines::best() {
    // Among fixed passes, the largest must not begin last.
    const auto best = std::ranges::max_element(waiting_, {}, [&](const PlannedPipeline& planned) {
        return std::tuple(-static_cast<int>(planned.turn), waitingHits(planned, hits_),
                          planned.turn == PipelineTurn::Fixed ? planned.job.wordCount : 0);
    });
    return paused_ && best != waiting_.end() && best->turn != PipelineTurn::Fixed ? waiting_.end() : best;
}

std::optional<PlannedPipeline> BackgroundPipelines::next() {
    const std::lock_guard lock(mutex_);
    const auto most = best();
    if (most == waiting_.end()) {
        return std::nullopt;
    }
    ++running_;
    PlannedPipeline planned = std::move(*most);
    waiting_.erase(most);
    return planned;
}

void BackgroundPipelines::setHits(std::span<const std::uint32_t> bucketCounts) {
    const std::lock_guard lock(mutex_);
    hits_.assign(bucketCounts.begin() + std::min<std::ptrdiff_t>(1, std::ssize(bucketCounts)),
                 bucketCounts.end());
}

std::vector<BackgroundPipelines::Done> BackgroundPipelines::take(std::vector<Done>::iterator first,
                                                                 std::vector<Done>::iterator end) {
    std::vector<Done> taken(std::make_move_iterator(first), std::make_move_iterator(end));
    done_.erase(first, end);
    adopted_ += static_cast<std::uint32_t>(taken.size());
    return taken;
}

void BackgroundPipelines::putBack(std::vector<Done> done) {
    const std::lock_guard lock(mutex_);
    adopted_ -= static_cast<std::uint32_t>(done.size());
    std::ranges::move(done, std::back_inserter(done_));
}

std::vector<BackgroundPipelines::Done> BackgroundPipelines::take(std::size_t most) {
    const std::lock_guard lock(mutex_);
    return take(done_.begin(), done_.begin() + static_cast<std::ptrdiff_t>(std::min(most, done_.size())));
}

std::vector<BackgroundPipelines::Done> BackgroundPipelines::takeFixed() {
    const std::lock_guard lock(mutex_);
    if (missingFixed_ > 0) {
        return {};
    }
    const auto fixed = std::stable_partition(done_.begin(), done_.end(), [](const Done& done) {
        return done.planned.turn != PipelineTurn::Fixed;
    });
    return take(fixed, done_.end());
}

void BackgroundPipelines::wait() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return best() == waiting_.end() && running_ == 0; });
}

void BackgroundPipelines::setPaused(bool paused) {
    {
        const std::lock_guard lock(mutex_);
        paused_ = paused;
    }
    giveOut();
}

std::uint32_t BackgroundPipelines::missing() const {
    const std::lock_guard lock(mutex_);
    return missing_;
}

Renderer::PipelineProgress BackgroundPipelines::progress() const {
    const std::lock_guard lock(mutex_);
    return {wanted_, wanted_ - static_cast<std::uint32_t>(waiting_.size()) - running_, adopted_, error_};
}

}  // namespace glint
