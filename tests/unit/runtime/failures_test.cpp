// The device is lost, memory runs out: errors tell them apart, and leave everything usable or destroyable.
#include "device_fixture.h"
#include "host_device.h"
#include "support/must.h"
#include "vulkan_hooks.h"

#include <glint/environment.h>

#include <cstdlib>
#include <new>

namespace {

// The allocation of this thread outside of Vulkan that fails, counted down to 0. Drivers and layers use this
// operator, too, and can't do without memory.
thread_local std::int64_t strikeIn = 0;

void* allocate(std::size_t bytes) {
    if (strikeIn > 0 && glint::test::VulkanHooks::depth == 0 && --strikeIn == 0) {
        throw std::bad_alloc();
    }
    void* const memory = std::malloc(bytes > 0 ? bytes : 1);
    return memory != nullptr ? memory : throw std::bad_alloc();
}

}  // namespace

void* operator new(std::size_t bytes) {
    return allocate(bytes);
}
void* operator new[](std::size_t bytes) {
    return allocate(bytes);
}
void operator delete(void* memory) noexcept {
    std::free(memory);
}
void operator delete[](void* memory) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::size_t /*bytes*/) noexcept {
    std::free(memory);
}
void operator delete[](void* memory, std::size_t /*bytes*/) noexcept {
    std::free(memory);
}

namespace glint {
namespace {

using test::TestScene;
using test::VulkanHooks;

class Failures : public test::DeviceTest {
protected:
    void SetUp() override {
        DeviceTest::SetUp();
        package_ = std::make_shared<const Package>(load(spec(test::makeDeviceSpec())));
        other_ = std::make_shared<const Package>(load(spec(test::makeOtherSpec())));
    }
    static test::PackageSpec spec(test::PackageSpec one) {
        one.environmentMap = true;
        return one;
    }
    static FrameOptions frameWith(const Environment* environment) {
        FrameOptions frame;
        frame.camera = test::makeCamera(1.0F);
        frame.environment = environment;
        return frame;
    }
    static LinearImage sky() {
        return {4, 2, std::vector<std::array<float, 4>>(8, {1, 1, 1, 1})};
    }
    static RendererOptions options() {
        RendererOptions options{package::kStrategyVisibility, 8, 8};
        options.pipelineThreads = 1;
        return options;
    }

    std::shared_ptr<const Package> package_;
    std::shared_ptr<const Package> other_;
    TestScene scene_ = test::squareScene();
};

// Does what programs do, from an upload to the data of pipelines. A map of the sky would take most of the
// time.
Status useAll(Context& context, const std::shared_ptr<const Package>& package,
              const std::shared_ptr<const Package>& other, TestScene& scene, const RendererOptions& options,
              const FrameOptions& frame) {
    GLINT_TRY(auto uploaded, GpuScene::upload(context, *package, scene.view()));
    GLINT_TRY(auto renderer, Renderer::create(context, *package, *uploaded, options));
    GLINT_TRY_DO(renderer->renderSamples(frame, 1));
    GLINT_TRY(auto replacement, renderer->replacePackage(other));
    GLINT_TRY(auto image, renderer->render(frame));
    GLINT_TRY(auto counters, renderer->counters());
    GLINT_TRY(auto data, context.pipelineCacheData());
    return okStatus();
}

TEST_F(Failures, LostDevicesAreAKindOfTheirOwnAtEachCall) {
    test::HostDevice host;
    ASSERT_TRUE(host.create());
    const auto package = std::make_shared<const Package>(load(test::makeDeviceSpec()));
    const auto other = std::make_shared<const Package>(load(test::makeOtherSpec()));
    // The pipelines of earlier rounds make the later ones fast.
    HostServices services;
    {
        const auto first = Context::adopt(host.handles());
        ASSERT_TRUE(first);
        services.pipelineCache = *createPipelineCache((*first)->state(), {});
    }
    // Each function in turn, at its first and its last call.
    std::vector<std::pair<std::string, std::uint64_t>> strikes{{"", 0}};
    for (std::size_t round = 0; round < strikes.size(); ++round) {
        const auto [function, at] = strikes[round];
        auto context = must(Context::adopt(host.handles(), services));
        VulkanHooks hooks(*context);
        hooks.failing = function;
        hooks.failAt = at;
        hooks.failsOn = true;
        const Status status = useAll(*context, package, other, scene_, options(), frameWith(nullptr));
        ASSERT_EQ(status.ok(), at == 0) << "call " << at << " of " << function;
        if (at == 0) {
            for (const std::string& name : hooks.canFail) {
                strikes.emplace_back(name, 1);
                strikes.emplace_back(name, hooks.callsOf[name]);
            }
        } else {
            EXPECT_EQ(status.error().kind, ErrorKind::DeviceLost) << toString(status.error());
            EXPECT_EQ(status.error().code, VK_ERROR_DEVICE_LOST);
        }
        context->state().vk = hooks.real();
    }
    EXPECT_GT(strikes.size(), 40U);
    const auto last = Context::adopt(host.handles());
    (*last)->state().vk.DestroyPipelineCache(host.handles().device, services.pipelineCache, nullptr);
}

TEST_F(Failures, WithoutDeviceMemoryNothingChanges) {
    const auto uploaded = upload(*package_, scene_);
    const auto environment = std::move(*Environment::create(context(), sky(), {}));
    const auto renderer = must(Renderer::create(context(), *package_, *uploaded, options()));
    const FrameOptions frame = frameWith(environment.get());
    const auto picture = renderer->render(frame);
    ASSERT_TRUE(picture);
    const std::function<Status()> attempts[] = {
        [&]() -> Status {
            GLINT_TRY(auto made, GpuScene::upload(context(), *package_, scene_.view()));
            return okStatus();
        },
        [&]() -> Status {
            GLINT_TRY(auto made, Renderer::create(context(), *package_, *uploaded, options()));
            return okStatus();
        },
        [&]() -> Status {
            GLINT_TRY(auto made, Environment::create(context(), sky(), {}));
            return okStatus();
        },
        [&]() -> Status {
            GLINT_TRY(auto made, renderer->render(frame));
            return okStatus();
        },
        [&]() -> Status {
            // The switch itself is given up, and the renderer says so.
            GLINT_TRY(auto begun, renderer->replacePackage(other_));
            GLINT_TRY_DO(renderer->renderSamples(frame, 1));
            const std::optional<Diagnostic> error = renderer->replacementProgress().error;
            return error ? Status(*error) : okStatus();
        },
    };
    for (const std::function<Status()>& attempt : attempts) {
        for (const bool failsOn : {true, false}) {
            for (std::uint64_t at = 1;; ++at) {
                bool struck = false;
                Status status = okStatus();
                {
                    VulkanHooks hooks(context());
                    hooks.failing = "vkAllocateMemory";
                    hooks.failure = VK_ERROR_OUT_OF_DEVICE_MEMORY;
                    hooks.failAt = at;
                    hooks.failsOn = failsOn;
                    status = attempt();
                    struck = hooks.struck > 0;
                }
                if (!struck) {
                    EXPECT_TRUE(status);
                    break;
                }
                if (failsOn) {
                    ASSERT_FALSE(status) << &attempt - attempts << ", allocation " << at;
                }
                if (!status) {
                    EXPECT_EQ(status.error().kind, ErrorKind::OutOfDeviceMemory) << toString(status.error());
                    EXPECT_EQ(status.error().code, VK_ERROR_OUT_OF_DEVICE_MEMORY);
                }
                const auto again = must(renderer->render(frame));
                EXPECT_EQ(again.pixels, picture->pixels) << &attempt - attempts << ", allocation " << at;
            }
        }
    }
}

// The device seems to have a second heap, whose memory is that of the only one.
DeviceTable oneHeap;
int inSecondHeap = 0;

TEST_F(Failures, AnotherHeapThatFitsIsTaken) {
    Context::State& state = context().state();
    oneHeap = state.vk;
    inSecondHeap = 0;
    VkPhysicalDeviceMemoryProperties& memory = state.limits.memory;
    if (memory.memoryTypeCount != 1) {
        GTEST_SKIP() << "the device has several types of memory";
    }
    memory.memoryHeapCount = memory.memoryTypeCount = 2;
    memory.memoryHeaps[1] = memory.memoryHeaps[0];
    memory.memoryTypes[1] = {memory.memoryTypes[0].propertyFlags & ~VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, 1};
    // A type of memory that needs a feature is not taken.
    memory.memoryTypeCount = 3;
    memory.memoryTypes[2] = {memory.memoryTypes[0].propertyFlags | VK_MEMORY_PROPERTY_PROTECTED_BIT, 0};
    state.vk.GetBufferMemoryRequirements = [](VkDevice device, VkBuffer buffer,
                                              VkMemoryRequirements* requirements) {
        oneHeap.GetBufferMemoryRequirements(device, buffer, requirements);
        requirements->memoryTypeBits = 7;
    };
    state.vk.GetImageMemoryRequirements = [](VkDevice device, VkImage image,
                                             VkMemoryRequirements* requirements) {
        oneHeap.GetImageMemoryRequirements(device, image, requirements);
        requirements->memoryTypeBits = 7;
    };
    state.vk.AllocateMemory = [](VkDevice device, const VkMemoryAllocateInfo* info,
                                 const VkAllocationCallbacks* callbacks, VkDeviceMemory* made) {
        EXPECT_LT(info->memoryTypeIndex, 2U);
        if (info->memoryTypeIndex == 0) {
            return VK_ERROR_OUT_OF_DEVICE_MEMORY;
        }
        ++inSecondHeap;
        VkMemoryAllocateInfo first = *info;
        first.memoryTypeIndex = 0;
        return oneHeap.AllocateMemory(device, &first, callbacks, made);
    };
    const auto uploaded = upload(*package_, scene_);
    ASSERT_NE(uploaded, nullptr);
    const auto renderer = must(Renderer::create(context(), *package_, *uploaded, options()));
    EXPECT_GT(inSecondHeap, 3);
    state.vk = oneHeap;
}

// Each allocation of the host in turn, or as many as there are in this time, at distances that grow.
TEST_F(Failures, NoExceptionLeaves) {
    const auto uploaded = upload(*package_, scene_);
    const auto environment = std::move(*Environment::create(context(), sky(), {}));
    const auto renderer = must(Renderer::create(context(), *package_, *uploaded, options()));
    const FrameOptions frame = frameWith(environment.get());
    const auto picture = renderer->render(frame);
    const LinearImage map = sky();
    const DeviceHandles handles = context().handles();
    const std::function<Status()> attempts[] = {
        [&]() -> Status {
            GLINT_TRY(auto made, Package::load(folder_.path()));
            return okStatus();
        },
        [&]() -> Status {
            GLINT_TRY(auto made, Context::adopt(handles));
            return okStatus();
        },
        [&]() -> Status {
            GLINT_TRY(auto made, Renderer::create(context(), *package_, *uploaded, options()));
            return okStatus();
        },
        [&]() -> Status {
            GLINT_TRY(auto made, Environment::create(context(), map, {}));
            return okStatus();
        },
        [&]() -> Status {
            GLINT_TRY(auto made, renderer->render(frame));
            return okStatus();
        },
        [&]() -> Status {
            GLINT_TRY(auto begun, renderer->replacePackage(other_));
            return renderer->renderSamples(frame, 1);
        },
    };
    std::uint64_t errors = 0;
    for (const std::function<Status()>& attempt : attempts) {
        bool ended = false;
        for (std::int64_t at = 1; !ended; at += 1 + at / 8) {
            VulkanHooks hooks(context());
            strikeIn = at;
            const Status status = attempt();
            ended = strikeIn > 0;
            strikeIn = 0;
            errors += status ? 0 : 1;
            if (!status) {
                EXPECT_EQ(status.error().kind, ErrorKind::OutOfHostMemory) << toString(status.error());
            }
        }
        const auto again = renderer->render(frame);
        ASSERT_TRUE(again) << &attempt - attempts << ": " << toString(again.error());
        EXPECT_EQ(again->pixels, picture->pixels);
    }
    EXPECT_GT(errors, 50U);
}

TEST(ErrorKinds, FollowFromVulkansCode) {
    const std::pair<VkResult, ErrorKind> kinds[] = {
        {VK_ERROR_DEVICE_LOST, ErrorKind::DeviceLost},
        {VK_ERROR_OUT_OF_HOST_MEMORY, ErrorKind::OutOfHostMemory},
        {VK_ERROR_OUT_OF_DEVICE_MEMORY, ErrorKind::OutOfDeviceMemory},
        {VK_ERROR_SURFACE_LOST_KHR, ErrorKind::SurfaceLost},
        {VK_ERROR_TOO_MANY_OBJECTS, ErrorKind::Other}};
    for (const auto& [code, kind] : kinds) {
        const Diagnostic error = vulkanError("vkCall", code);
        EXPECT_EQ(error.kind, kind);
        EXPECT_EQ(error.code, code);
        EXPECT_EQ(error.id, "vulkan-call");
    }
    EXPECT_EQ(makeError("id", "", "message").kind, ErrorKind::Other);
}

}  // namespace
}  // namespace glint
