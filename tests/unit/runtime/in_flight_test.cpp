// What frames in flight use stays, and an error of a recording leaves no command behind.
#include "device_fixture.h"
#include "frame/motion_history.h"
#include "renderer/renderer.h"
#include "scene/scene_store.h"
#include "support/must.h"
#include "vulkan_hooks.h"

#include <glint/environment.h>

#include <algorithm>
#include <limits>

namespace glint {
namespace {

using test::TestScene;
using test::VulkanHooks;

FrameOptions frameWith(const Environment* environment) {
    FrameOptions frame;
    frame.camera = test::makeCamera(1.0F);
    frame.environment = environment;
    return frame;
}

class InFlight : public test::DeviceTest {
protected:
    struct Recording {
        CommandRunner runner;
        VkCommandBuffer commands;
    };
    Recording begin() {
        CommandRunner runner = std::move(*CommandRunner::create(context().state()));
        VkCommandBuffer const commands = *runner.begin();
        return {std::move(runner), commands};
    }
    std::unique_ptr<Environment> makeEnvironment(float radiance) {
        const LinearImage image{4, 2,
                                std::vector<std::array<float, 4>>(8, {radiance, radiance, radiance, 1})};
        return std::move(*Environment::create(context(), image, {}));
    }
    std::shared_ptr<const Package> share(const test::PackageSpec& spec) {
        return std::make_shared<const Package>(load(spec));
    }
    bool sees(Renderer& renderer) {
        const Result<LinearImage> image = renderer.render(frameWith(nullptr));
        EXPECT_TRUE(image) << toString(image.error());
        return image && image->pixels[4 * 8 + 4][0] == 1.0F;
    }
};

// The layers report commands whose set was written, or whose objects were destroyed, before they run.
TEST_F(InFlight, EnvironmentsChange) {
    test::PackageSpec spec = test::makeDeviceSpec();
    spec.environmentMap = true;
    const Package package = load(spec);
    TestScene scene = test::squareScene();
    const auto uploaded = upload(package, scene);
    const auto renderer = makeRenderer(package, *uploaded, package::kStrategyUber, 8, 8);
    ASSERT_NE(renderer, nullptr);
    std::unique_ptr<Environment> first = makeEnvironment(1.0F);
    const std::unique_ptr<Environment> second = makeEnvironment(2.0F);
    Recording one = begin();
    ASSERT_TRUE(renderer->record(one.commands, frameWith(first.get())));
    Recording two = begin();
    ASSERT_TRUE(renderer->record(two.commands, frameWith(second.get())));
    first.reset();
    ASSERT_TRUE(one.runner.submitAndWait());
    ASSERT_TRUE(two.runner.submitAndWait());
    EXPECT_EQ(renderer->state().leftovers.size(), 2U);  // the set without an environment, and the first one
    renderer->finished(1);
    EXPECT_TRUE(renderer->state().leftovers.empty());
}

TEST_F(InFlight, OutgrownHistoryIsFreed) {
    const Package package = load(test::makeDeviceSpec());
    TestScene scene = test::squareScene();
    SceneView view = scene.view();
    view.moves = true;
    const auto uploaded = must(GpuScene::upload(context(), package, view));
    GpuScene::State& state = uploaded->state();
    Buffer& instances = state.store->instances.device;
    const auto history = MotionHistory::create(state);
    ASSERT_TRUE(history);
    Buffer few;
    for (std::uint64_t recording = 1; recording <= 3; ++recording) {
        if (recording == 1) {
            auto more = createBuffer(context().state(), state.pool, instances.bytes << 14U,
                                     VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT);
            ASSERT_TRUE(more);
            few = std::exchange(instances, std::move(*more));
        }
        Recording commands = begin();
        ASSERT_TRUE((*history)->makeRoom());
        context().state().vk.CmdFillBuffer(commands.commands, instances.handle.get(), 0, VK_WHOLE_SIZE, 0);
        (*history)->record(commands.commands, recording);
        ASSERT_TRUE(commands.runner.submitAndWait());
        std::vector<MemoryItem> items;
        (*history)->addMemory(items);
        ASSERT_EQ(items.size(), 1U);
        EXPECT_EQ(items[0].count, recording == 1 ? 2U : 1U);
        (*history)->complete(recording);
        items.clear();
        (*history)->addMemory(items);
        EXPECT_EQ(items[0].bytes, instances.bytes);
    }
    instances = std::move(few);
}

TEST_F(InFlight, PipelineCachesThatThreadsMayUseStay) {
    const Package package = load(test::makeDeviceSpec());
    TestScene scene = test::squareScene();
    const auto uploaded = upload(package, scene);
    ASSERT_NE(makeRenderer(package, *uploaded, package::kStrategyUber, 8, 8), nullptr);
    const auto data = context().pipelineCacheData();
    ASSERT_TRUE(data);
    const VkPipelineCache before = context().state().pipelineCache;
    {
        VulkanHooks hooks(context());
        EXPECT_TRUE(context().addPipelineCache(*data));
        EXPECT_EQ(hooks.callsOf["vkDestroyPipelineCache"], 0U);
    }
    EXPECT_NE(context().state().pipelineCache, before);
    // A thread that has begun with the earlier cache adds to it, and this is not lost.
    const VkPipelineCache after = context().state().pipelineCache.exchange(before);
    ASSERT_NE(makeRenderer(package, *uploaded, package::kStrategyVisibility, 8, 8), nullptr);
    context().state().pipelineCache = after;
    const auto both = context().pipelineCacheData();
    ASSERT_TRUE(both);
    EXPECT_GE(both->size(), data->size());
}

// Each call of Vulkan in a recording that switches package and environment fails once.
TEST_F(InFlight, ARecordingThatFailsRecordsNothing) {
    test::PackageSpec spec = test::makeDeviceSpec();
    test::PackageSpec other = test::makeOtherSpec();
    spec.environmentMap = other.environmentMap = true;
    const auto package = share(spec);
    const auto next = share(other);
    TestScene scene = test::squareScene();
    const std::unique_ptr<Environment> sky = makeEnvironment(1.0F);
    std::uint64_t failed = 0;
    for (std::uint64_t at = 1;; ++at) {
        const auto uploaded = upload(*package, scene);
        const auto renderer = makeRenderer(*package, *uploaded, package::kStrategyVisibility, 8, 8);
        ASSERT_TRUE(renderer->replacePackage(next));
        Recording recording = begin();
        bool struck = false;
        {
            VulkanHooks hooks(context());
            hooks.failAt = at;
            hooks.failure = VK_ERROR_OUT_OF_HOST_MEMORY;
            const Status status = renderer->record(recording.commands, frameWith(sky.get()));
            struck = hooks.struck > 0;
            if (!status) {
                ++failed;
                EXPECT_EQ(status.error().kind, ErrorKind::OutOfHostMemory);
                for (const auto& [function, count] : hooks.callsOf) {
                    EXPECT_FALSE(function.starts_with("vkCmd")) << function;
                }
                // The next recording switches. A switch that fails is given up instead, and is no error.
                EXPECT_TRUE(renderer->record(recording.commands, frameWith(sky.get())));
                EXPECT_EQ(renderer->replacementProgress().inUse, 1U);
            }
        }
        EXPECT_TRUE(recording.runner.submitAndWait());
        if (!struck) {
            break;
        }
    }
    EXPECT_GT(failed, 1U);
}

TEST_F(InFlight, RenderersOfASceneSwitchTogether) {
    const auto package = share(test::makeDeviceSpec());
    const auto other = share(test::makeOtherSpec());
    TestScene scene = test::squareScene();
    const auto uploaded = upload(*package, scene);
    const auto first = makeRenderer(*package, *uploaded, package::kStrategyVisibility, 8, 8);
    const auto second = makeRenderer(*package, *uploaded, package::kStrategyUber, 8, 8);
    ASSERT_TRUE(sees(*second));
    ASSERT_TRUE(first->replacePackage(other));
    const auto late = makeRenderer(*package, *uploaded, package::kStrategyVisibility, 8, 8);
    ASSERT_NE(late, nullptr);
    for (Renderer* const renderer : {first.get(), second.get(), late.get()}) {
        EXPECT_TRUE(sees(*renderer));
        EXPECT_EQ(renderer->replacementProgress().inUse, 1U);
        EXPECT_EQ(renderer->state().size.bucketCount, other->bucketCount());
    }
    EXPECT_EQ(mustFail(Renderer::create(context(), *package, *uploaded, {package::kStrategyUber, 8, 8})).id,
              "scene-package");
    EXPECT_NE(makeRenderer(*other, *uploaded, package::kStrategyUber, 8, 8), nullptr);
}

}  // namespace
}  // namespace glint
