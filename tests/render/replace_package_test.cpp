// A renderer that takes over another package of its scene while it draws.
#include "render/edited_scene.h"
#include "render/replacement.h"
#include "render/ways.h"
#include "renderer/renderer.h"
#include "support/must.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace glint;
using namespace glint::testing;

// The room, with a combination of features that no material had: one case has another shader, and shader IDs
// move.
gltf::Scene editedRoom() {
    gltf::Scene scene = roomScene();
    giveCoat(scene.materials[kGlossy]);
    giveSheen(scene.materials[kGlossy]);
    return scene;
}

// Cases that send no shadow ray trace nothing.
std::span<const std::uint32_t> caseWords(const Package& package, std::uint32_t shaderId) {
    return package.spirv({package::roleNamed("ShadeCase"), shaderId, 0});
}

class ReplacePackage : public ReplacementTest {
protected:
    static void SetUpTestSuite() {
        before_ = new gltf::Scene(roomScene());
        after_ = new gltf::Scene(editedRoom());
        const compiler::CompileSettings settings = roomSettings(package::allStrategies(), true);
        edited_ = new std::shared_ptr<const Package>(packageOf(*after_, settings));
        original_ = new std::shared_ptr<const Package>(packageOf(*before_, settings));
    }
    static void TearDownTestSuite() {
        delete original_;
        delete edited_;
        delete after_;
        delete before_;
    }
    void SetUp() override {
        setup_ = defaultSetup(*before_, 24, 24);
    }

    // Every strategy, and visibility with every tracer that the device has.
    template <typename Test>
    static void forEachWay(const Test& test) {
        std::uint32_t tested = 0;  // strategies
        for (const Way& way : waysOf(package::allStrategies(), package::kAllTracers)) {
            if ((tested & way.strategy) == 0 || way.strategy == package::kStrategyVisibility) {
                test(way.strategy, way.tracer, nameOf(way));
            }
            tested |= way.strategy;
        }
    }

    static inline gltf::Scene* before_ = nullptr;
    static inline gltf::Scene* after_ = nullptr;
    static inline std::shared_ptr<const Package>* original_ = nullptr;
    static inline std::shared_ptr<const Package>* edited_ = nullptr;
};

TEST_F(ReplacePackage, ThePictureIsThatOfTheOldPackageAndThenOfTheNewOne) {
    forEachWay([&](package::Strategy strategy, package::Tracer tracer, const std::string& name) {
        RendererOptions options = optionsOf(strategy, tracer);
        const LinearImage old = fresh(*before_, **original_, options);
        const LinearImage wanted = fresh(*after_, **edited_, options);
        ASSERT_TRUE(differ(old, wanted)) << name;
        options.backgroundPipelines = true;
        const std::unique_ptr<GpuScene> scene = uploadScene(**original_, *before_);
        const std::unique_ptr<Renderer> renderer = makeRenderer(**original_, *scene, options);
        renderer->waitForPipelines();
        expectEqualImage(draw(*renderer), old, name + ", before");

        renderer->state().pipelines.adoptedAtOnce = 0;
        const Result<Renderer::Replacement> replaced = renderer->replacePackage(*edited_);
        ASSERT_TRUE(replaced) << name << ": " << toString(replaced.error());
        EXPECT_GT(replaced->pipelinesKept, 0U) << name;
        EXPECT_GT(replaced->pipelinesMade, 0U) << name;
        renderer->waitForPipelines();
        EXPECT_TRUE(renderer->replacementProgress().pending) << name;
        EXPECT_EQ(renderer->replacementProgress().missing, 0U) << name;
        expectEqualImage(draw(*renderer), old, name + ", while pipelines are made");
        renderer->state().pipelines.adoptedAtOnce = std::numeric_limits<std::size_t>::max();
        EXPECT_TRUE(renderer->replacementProgress().ready) << name;
        expectEqualImage(draw(*renderer), wanted, name + ", after");
        EXPECT_FALSE(renderer->replacementProgress().pending) << name;
        EXPECT_EQ(renderer->replacementProgress().inUse, 1U) << name;
        const Renderer::Counters counters = must(renderer->counters());
        EXPECT_EQ(counters.unknownShader, 0U) << name;
    });
}

// Frames follow each other while threads work. Each is that of one package or of the other, and once it is
// the other one's, it stays so.
TEST_F(ReplacePackage, NoFrameMixesTwoPackages) {
    RendererOptions options = optionsOf(package::kStrategyVisibility, package::kTracerRayPipeline);
    if ((sharedContext().handles().tracers & package::kTracerRayPipeline) == 0) {
        GTEST_SKIP() << "the device has no ray tracing pipelines";
    }
    const LinearImage old = fresh(*before_, **original_, options);
    const LinearImage wanted = fresh(*after_, **edited_, options);
    options.backgroundPipelines = true;
    options.draft = false;
    options.pipelineThreads = 2;
    const std::unique_ptr<GpuScene> scene = uploadScene(**original_, *before_);
    const std::unique_ptr<Renderer> renderer = makeRenderer(**original_, *scene, options);
    // Not all pipelines of the first package are made yet.
    ASSERT_TRUE(renderer->replacePackage(*edited_));
    bool switched = false;
    for (int frame = 0; frame < 1000 && !switched; ++frame) {
        const bool ready = renderer->replacementProgress().ready;
        const LinearImage image = draw(*renderer);
        switched = renderer->replacementProgress().inUse == 1;
        EXPECT_TRUE(switched || !ready);
        if (switched) {
            expectEqualImage(image, wanted, "frame " + std::to_string(frame));
        } else {
            // The fallback may still stand in for a case, and rounds in another way.
            expectSameImage(image, old, "frame " + std::to_string(frame));
        }
    }
    EXPECT_TRUE(switched);
    renderer->waitForPipelines();
    expectEqualImage(draw(*renderer), wanted, "at the end");
}

// A draft ends while another package waits, because the fixed passes are still made.
TEST_F(ReplacePackage, ADraftEndsWhileAPackageWaits) {
    RendererOptions options = optionsOf(package::kStrategyVisibility, tracerOfDevice());
    const LinearImage wanted = fresh(*after_, **edited_, options);
    options.backgroundPipelines = true;
    const std::unique_ptr<GpuScene> scene = uploadScene(**original_, *before_);
    const std::unique_ptr<Renderer> renderer = makeRenderer(**original_, *scene, options);
    renderer->state().pipelines.adoptedAtOnce = 0;
    draw(*renderer);
    EXPECT_TRUE(renderer->pipelineProgress().draft);
    ASSERT_TRUE(renderer->replacePackage(*edited_));
    // A thread may have made the pipelines of the new package by now. Then the picture switches to it.
    const auto pauseNext = [&](bool paused) {
        if (renderer->state().next && renderer->state().next->pipelines.background) {
            renderer->state().next->pipelines.background->setPaused(paused);
        }
    };
    pauseNext(true);
    renderer->state().pipelines.background->wait();
    // One more pipeline than the fixed ones would be a case.
    renderer->state().pipelines.adoptedAtOnce = 1;
    draw(*renderer);
    EXPECT_FALSE(renderer->pipelineProgress().draft);
    pauseNext(false);
    renderer->waitForPipelines();
    expectEqualImage(draw(*renderer), wanted, "the other package");
    EXPECT_FALSE(renderer->pipelineProgress().draft);
}

TEST_F(ReplacePackage, FramesInFlightKeepWhatTheyUse) {
    const RendererOptions options = optionsOf(package::kStrategyVisibility, tracerOfDevice());
    const LinearImage old = fresh(*before_, **original_, options);
    const LinearImage wanted = fresh(*after_, **edited_, options);
    const std::unique_ptr<GpuScene> scene = uploadScene(**original_, *before_);
    const std::unique_ptr<Renderer> renderer = makeRenderer(**original_, *scene, options);
    TwoFrames frames(sharedContext());
    // Returns the number of the recording.
    const auto submit = [&] {
        const Status recorded = renderer->record(frames.begin(), setup_.frame);
        EXPECT_TRUE(recorded) << toString(recorded.error());
        frames.submit();
        return renderer->recordings();
    };
    std::uint64_t last = submit();
    const VkImage output = renderer->output();
    std::vector<std::uint64_t> bytes;
    for (int swap = 0; swap < 10; ++swap) {
        const bool forth = swap % 2 == 0;
        ASSERT_TRUE(renderer->replacePackage(forth ? *edited_ : *original_));
        const std::uint64_t earlier = std::exchange(last, submit());  // the earlier frame is in flight
        EXPECT_EQ(renderer->replacementProgress().inUse, static_cast<std::uint64_t>(swap) + 1);
        EXPECT_FALSE(renderer->state().leftovers.empty());
        frames.waitForEarlier();
        renderer->finished(earlier);
        EXPECT_FALSE(renderer->state().leftovers.empty()) << "the frame of the switch is in flight";
        if (swap == 4 || swap == 5) {
            frames.drain();
            renderer->finished(last);
            EXPECT_TRUE(renderer->state().leftovers.empty());
            expectEqualImage(draw(*renderer), forth ? wanted : old, "swap " + std::to_string(swap));
            last = submit();
        }
        if (!forth) {
            bytes.push_back(renderer->footprint().allocatedBytes + scene->allocatedBytes());
        }
    }
    frames.drain();
    renderer->finished(last);
    EXPECT_TRUE(renderer->state().leftovers.empty());
    for (const std::uint64_t allocated : bytes) {
        EXPECT_LE(allocated, bytes.front()) << "memory grows";
    }
    EXPECT_EQ(renderer->output(), output) << "the picture's image stays";
}

TEST_F(ReplacePackage, OnlyPipelinesThatChangedAreMade) {
    const package::Strategy strategy = package::kStrategyVisibility;
    const compiler::CompileSettings settings = roomSettings(strategy);
    const std::shared_ptr<const Package> original = packageOf(*before_, settings);
    const std::shared_ptr<const Package> repainted = packageOf(repaintedRoom(), settings);
    const std::shared_ptr<const Package> edited = packageOf(*after_, settings);
    const std::unique_ptr<GpuScene> scene = uploadScene(*original, *before_);
    const RendererOptions options = optionsOf(strategy);
    const std::unique_ptr<Renderer> renderer = makeRenderer(*original, *scene, options);
    const std::uint32_t pipelines = renderer->footprint().pipelines;

    const Renderer::Replacement values = must(renderer->replacePackage(repainted));
    EXPECT_EQ(values.pipelinesMade, 0U) << "values of materials are in no shader";
    EXPECT_EQ(values.pipelinesKept, pipelines);
    EXPECT_TRUE(values.casesMade.empty());
    EXPECT_EQ(values.buffersMade, 0U);
    expectEqualImage(draw(*renderer), fresh(repaintedRoom(), *repainted, options), "another colour");

    const Renderer::Replacement key = must(renderer->replacePackage(edited));
    // The case of the material with sheen is the only one whose SPIR-V is new.
    std::vector<std::uint32_t> fresh;
    for (std::uint32_t id = 0; id < edited->caseCount(); ++id) {
        bool known = false;
        for (std::uint32_t other = 0; other < original->caseCount(); ++other) {
            known = known || std::ranges::equal(caseWords(*edited, id), caseWords(*original, other));
        }
        if (!known) {
            fresh.push_back(id);
        }
    }
    ASSERT_FALSE(caseWords(*edited, 0).empty());
    EXPECT_EQ(key.casesMade, fresh);
    EXPECT_EQ(key.casesMade.size(), 1U);
    EXPECT_GT(key.pipelinesKept, 0U);
    draw(*renderer);
    EXPECT_EQ(renderer->footprint().pipelines, key.pipelinesKept + key.pipelinesMade);
}

// The package that comes last wins, and what an earlier one has made already is not made again.
TEST_F(ReplacePackage, ALaterPackageTakesThePlaceOfOneThatWaits) {
    RendererOptions options = optionsOf(package::kStrategyVisibility, package::kTracerRayPipeline);
    if ((sharedContext().handles().tracers & package::kTracerRayPipeline) == 0) {
        GTEST_SKIP() << "the device has no ray tracing pipelines";
    }
    options.backgroundPipelines = true;
    const std::unique_ptr<GpuScene> scene = uploadScene(**original_, *before_);
    const std::unique_ptr<Renderer> renderer = makeRenderer(**original_, *scene, options);
    renderer->waitForPipelines();
    const LinearImage old = draw(*renderer);
    const Renderer::Replacement first = must(renderer->replacePackage(*edited_));
    renderer->waitForPipelines();
    const Renderer::Replacement again = must(renderer->replacePackage(*edited_));
    EXPECT_EQ(again.pipelinesMade, 0U);
    EXPECT_EQ(again.pipelinesKept, first.pipelinesKept + first.pipelinesMade);
    ASSERT_TRUE(renderer->replacePackage(*original_));
    renderer->waitForPipelines();
    expectEqualImage(draw(*renderer), old, "the first package again");
    EXPECT_EQ(renderer->replacementProgress().inUse, 1U);
    EXPECT_TRUE(renderer->state().leftovers.empty());
}

// finished() leaves pipelines that are still being made to a thread, and so never waits for them.
TEST_F(ReplacePackage, APackageThatIsGivenUpIsLeftToAThread) {
    RendererOptions options = optionsOf(package::kStrategyVisibility, package::kTracerRayPipeline);
    if ((sharedContext().handles().tracers & package::kTracerRayPipeline) == 0) {
        GTEST_SKIP() << "the device has no ray tracing pipelines";
    }
    options.backgroundPipelines = true;
    const std::unique_ptr<GpuScene> scene = uploadScene(**original_, *before_);
    const std::unique_ptr<Renderer> renderer = makeRenderer(**original_, *scene, options);
    ASSERT_TRUE(renderer->replacePackage(*edited_));
    ASSERT_TRUE(renderer->replacePackage(*original_));
    EXPECT_EQ(renderer->state().leftovers.size(), 1U);
    renderer->finished(renderer->recordings());
    EXPECT_TRUE(renderer->state().leftovers.empty());
}

}  // namespace
