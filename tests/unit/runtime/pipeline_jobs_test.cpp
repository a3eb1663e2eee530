// Tests jobs on several threads: results and errors must not depend on which job was first.
#include "renderer/pipeline_jobs.h"

#include "renderer/background_pipelines.h"
#include "support/must.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <future>
#include <string>
#include <thread>

namespace glint {
namespace {

// There is no device: the handles stay null, and jobs are identified by what they report.
PipelineJob job(std::uint64_t number, std::size_t wordCount, bool fails = false) {
    return {"job " + std::to_string(number), wordCount,
            [number, fails](PipelineCreation& creation) -> Result<UniquePipeline> {
                creation.feedback.duration = number;
                if (fails) {
                    return makeError("job", "", std::to_string(number));
                }
                return UniquePipeline();
            }};
}

TEST(PipelineJobs, ComeInTheirOrderWhateverTheirSizesAndThreads) {
    std::vector<PipelineJob> jobs;
    for (std::uint64_t i = 0; i < 40; ++i) {
        jobs.push_back(job(i, (i * 7) % 11));
    }
    for (const std::uint32_t threads : {1U, 2U, 16U, 64U}) {
        const auto made = makePipelines(jobs, 0, threads);
        ASSERT_TRUE(made);
        ASSERT_EQ(made->size(), jobs.size());
        for (std::uint64_t i = 0; i < jobs.size(); ++i) {
            EXPECT_EQ((*made)[i].name, jobs[i].name);
            EXPECT_EQ((*made)[i].feedback.duration, i);
        }
    }
}

TEST(PipelineJobs, FirstErrorInOrderIsToldWhicheverCameFirst) {
    const std::vector<PipelineJob> jobs{job(0, 1), job(1, 2, true), job(2, 9, true), job(3, 3, true)};
    for (const std::uint32_t threads : {1U, 4U}) {
        EXPECT_EQ(mustFail(makePipelines(jobs, 0, threads)).message, "1");
    }
}

PlannedPipeline caseOf(std::uint32_t shaderId, std::function<Result<UniquePipeline>()> make) {
    PlannedPipeline planned;
    planned.job = {"case " + std::to_string(shaderId), 1,
                   [make = std::move(make)](PipelineCreation&) { return make(); }};
    planned.keys = {{package::roleNamed("ShadeCase"), shaderId, 0}};
    planned.turn = PipelineTurn::Case;
    return planned;
}

TEST(BackgroundPipelines, CasesWithMostHitsComeFirst) {
    std::promise<void> begun;
    std::promise<void> counted;
    std::vector<PlannedPipeline> planned;
    for (std::uint32_t id = 0; id < 4; ++id) {
        planned.push_back(caseOf(id, [&begun, &counted, id]() -> Result<UniquePipeline> {
            if (id == 0) {
                begun.set_value();
                counted.get_future().wait();  // the other cases wait until their hits are known
            }
            return UniquePipeline();
        }));
    }
    Jobs jobs;
    BackgroundPipelines background(jobs, std::move(planned), 0, 1);
    begun.get_future().wait();
    const std::vector<std::uint32_t> missesAndHits{1000, 0, 5, 0, 9};
    background.setHits(missesAndHits);
    counted.set_value();
    background.wait();
    std::vector<std::string> names;
    for (const BackgroundPipelines::Done& done : background.take(3)) {
        names.push_back(done.made.name);
    }
    EXPECT_EQ(names, (std::vector<std::string>{"case 0", "case 3", "case 1"}));
    EXPECT_EQ(background.take(9).size(), 1U);
    const Renderer::PipelineProgress progress = background.progress();
    EXPECT_EQ(progress.wanted, 4U);
    EXPECT_EQ(progress.made, 4U);
    EXPECT_EQ(progress.adopted, 4U);
    EXPECT_FALSE(progress.error);
}

// Fixed passes come before cases, the largest first, also while cases are paused, and are taken together.
TEST(BackgroundPipelines, FixedPassesComeFirstAndTogether) {
    std::vector<PlannedPipeline> planned;
    planned.push_back(caseOf(0, [] { return UniquePipeline(); }));
    std::promise<void> go;
    std::shared_future<void> gone = go.get_future().share();
    for (const std::uint32_t words : {3U, 9U}) {
        PlannedPipeline& fixed = planned.emplace_back();
        fixed.job = {"fixed " + std::to_string(words), words,
                     [gone](PipelineCreation&) -> Result<UniquePipeline> {
                         gone.wait();
                         return UniquePipeline();
                     }};
        fixed.turn = PipelineTurn::Fixed;
    }
    Jobs jobs;
    BackgroundPipelines background(jobs, std::move(planned), 0, 1);
    background.setPaused(true);
    EXPECT_TRUE(background.takeFixed().empty());
    go.set_value();
    background.wait();
    const std::vector<BackgroundPipelines::Done> fixed = background.takeFixed();
    ASSERT_EQ(fixed.size(), 2U);
    EXPECT_EQ(fixed[0].made.name, "fixed 9");
    EXPECT_EQ(fixed[1].made.name, "fixed 3");
    EXPECT_TRUE(background.take(9).empty());
    background.setPaused(false);
    background.wait();
    EXPECT_EQ(background.take(9).size(), 1U);
    EXPECT_EQ(background.progress().adopted, 3U);
}

TEST(BackgroundPipelines, AFixedPassThatFailsKeepsTheOthersBack) {
    std::vector<PlannedPipeline> planned;
    for (const bool fails : {false, true}) {
        PlannedPipeline& fixed = planned.emplace_back();
        fixed.job = job(0, 1, fails);
        fixed.turn = PipelineTurn::Fixed;
    }
    Jobs jobs;
    BackgroundPipelines background(jobs, std::move(planned), 0, 1);
    background.wait();
    EXPECT_TRUE(background.takeFixed().empty());
    EXPECT_TRUE(background.progress().error);
}

TEST(BackgroundPipelines, ErrorsAreToldAndTheRestIsMade) {
    std::vector<PlannedPipeline> planned;
    for (std::uint32_t id = 0; id < 3; ++id) {
        planned.push_back(caseOf(id, [id]() -> Result<UniquePipeline> {
            return id == 1 ? Result<UniquePipeline>(makeError("job", "", "failed")) : UniquePipeline();
        }));
    }
    Jobs jobs;
    BackgroundPipelines background(jobs, std::move(planned), 0, 2);
    background.wait();
    EXPECT_EQ(background.take(9).size(), 2U);
    const Renderer::PipelineProgress progress = background.progress();
    EXPECT_EQ(progress.made, 3U);
    EXPECT_EQ(progress.adopted, 2U);
    ASSERT_TRUE(progress.error);
    EXPECT_EQ(progress.error->message, "failed");
}

TEST(PipelineJobs, LargestBeginsFirst) {
    std::vector<int> begun;
    std::vector<PipelineJob> jobs;
    for (const int words : {3, 50, 7, 50}) {
        jobs.push_back({"", static_cast<std::size_t>(words),
                        [&begun, number = static_cast<int>(jobs.size())](PipelineCreation&) {
                            begun.push_back(number);
                            return Result<UniquePipeline>(UniquePipeline());
                        }});
    }
    ASSERT_TRUE(makePipelines(jobs, 0, 1));
    EXPECT_EQ(begun, (std::vector<int>{1, 3, 2, 0}));
}

// Each of two jobs waits until the other has begun.
TEST(PipelineJobs, RunAtTheSameTime) {
    std::atomic<int> begun{0};
    const PipelineJob waits{"", 1, [&begun](PipelineCreation&) -> Result<UniquePipeline> {
                                ++begun;
                                const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
                                while (begun < 2 && std::chrono::steady_clock::now() < end) {
                                    std::this_thread::yield();
                                }
                                if (begun < 2) {
                                    return makeError("job", "", "the other never came");
                                }
                                return UniquePipeline();
                            }};
    EXPECT_TRUE(makePipelines(std::array{waits, waits}, 0, 2));
}

TEST(PipelineJobs, FlagsReachEveryJob) {
    const PipelineJob flagged{"", 1, [](PipelineCreation& creation) -> Result<UniquePipeline> {
                                  creation.feedback.duration = creation.flags;
                                  return UniquePipeline();
                              }};
    const auto made =
        makePipelines(std::array{flagged, flagged}, VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR, 2);
    ASSERT_TRUE(made);
    for (const MadePipeline& pipeline : *made) {
        EXPECT_EQ(pipeline.feedback.duration, VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR);
    }
}

TEST(PipelineJobs, ThreadsAreNoMoreThanJobsNorThanAreAskedFor) {
    EXPECT_EQ(pipelineThreads(1, 100), 1U);
    EXPECT_EQ(pipelineThreads(8, 100), 8U);
    EXPECT_EQ(pipelineThreads(8, 3), 3U);
    EXPECT_EQ(pipelineThreads(0, 1), 1U);
    EXPECT_GE(pipelineThreads(0, 100), 1U);
    EXPECT_EQ(pipelineThreads(4, 0), 1U);
    const auto none = makePipelines({}, 0, 1);
    ASSERT_TRUE(none);
    EXPECT_TRUE(none->empty());
}

}  // namespace
}  // namespace glint
