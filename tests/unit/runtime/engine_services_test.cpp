// A program's allocators, lock, cache, threads and names serve everything that Glint does.
#include "device_fixture.h"
#include "host_device.h"
#include "renderer/background_pipelines.h"
#include "renderer/renderer.h"
#include "support/must.h"
#include "vulkan_hooks.h"

#include <condition_variable>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <future>

namespace glint {
namespace {

using test::TestScene;
using test::VulkanHooks;

// VkAllocationCallbacks whose memory is counted. A block begins with its size.
struct HostMemory {
    std::atomic<std::int64_t> blocks{0};
    std::atomic<std::uint64_t> calls{0};
    VkAllocationCallbacks callbacks{.pUserData = this,
                                    .pfnAllocation = allocate,
                                    .pfnReallocation = reallocate,
                                    .pfnFree = release,
                                    .pfnInternalAllocation = nullptr,
                                    .pfnInternalFree = nullptr};

    static constexpr std::size_t kHead = 64;  // no alignment is larger

    static VKAPI_ATTR void* VKAPI_CALL allocate(void* user, std::size_t bytes, std::size_t /*alignment*/,
                                                VkSystemAllocationScope /*scope*/) {
        auto* const block =
            static_cast<std::uint8_t*>(std::aligned_alloc(kHead, (bytes + 2 * kHead) / kHead * kHead));
        std::memcpy(block, &bytes, sizeof bytes);
        ++static_cast<HostMemory*>(user)->blocks;
        ++static_cast<HostMemory*>(user)->calls;
        return block + kHead;
    }
    static VKAPI_ATTR void VKAPI_CALL release(void* user, void* memory) {
        if (memory != nullptr) {
            --static_cast<HostMemory*>(user)->blocks;
            std::free(static_cast<std::uint8_t*>(memory) - kHead);
        }
    }
    static VKAPI_ATTR void* VKAPI_CALL reallocate(void* user, void* memory, std::size_t bytes,
                                                  std::size_t alignment, VkSystemAllocationScope scope) {
        void* const moved = bytes > 0 ? allocate(user, bytes, alignment, scope) : nullptr;
        if (memory != nullptr && moved != nullptr) {
            std::size_t before = 0;
            std::memcpy(&before, static_cast<std::uint8_t*>(memory) - kHead, sizeof before);
            std::memcpy(moved, memory, std::min(before, bytes));
        }
        release(user, memory);
        return moved;
    }
};

// An allocator that gives each resource the second half of an allocation of its own.
struct EngineMemory {
    DeviceTable vk;
    DeviceHandles handles;
    std::set<std::uint64_t> live;
    std::set<std::string> names;
    std::mutex mutex;
    bool full = false;

    VkResult allocate(const HostServices::MemoryRequest& request, HostServices::MemoryRange& range) {
        const std::lock_guard lock(mutex);
        if (full) {
            return VK_ERROR_OUT_OF_DEVICE_MEMORY;
        }
        names.insert(request.name);
        const VkMemoryAllocateFlagsInfo flags{.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO,
                                              .pNext = nullptr,
                                              .flags = request.flags,
                                              .deviceMask = 0};
        range.offset = (request.requirements.size + request.requirements.alignment - 1) /
                       request.requirements.alignment * request.requirements.alignment;
        range.type = 0;  // lavapipe has one type, and host.create() takes no other device in these tests
        while ((request.requirements.memoryTypeBits >> range.type & 1U) == 0) {
            ++range.type;
        }
        const VkMemoryAllocateInfo info{.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                        .pNext = &flags,
                                        .allocationSize = range.offset + request.requirements.size,
                                        .memoryTypeIndex = range.type};
        const VkResult result = vk.AllocateMemory(handles.device, &info, nullptr, &range.memory);
        live.insert(reinterpret_cast<std::uint64_t>(range.memory));
        range.allocation = range.memory;
        return result;
    }
    void release(const HostServices::MemoryRange& range) {
        const std::lock_guard lock(mutex);
        EXPECT_EQ(range.allocation, range.memory);
        EXPECT_EQ(live.erase(reinterpret_cast<std::uint64_t>(range.memory)), 1U);
        vk.FreeMemory(handles.device, range.memory, nullptr);
    }
    VkResult map(const HostServices::MemoryRange& range, void*& mapped) const {
        return vk.MapMemory(handles.device, range.memory, range.offset, VK_WHOLE_SIZE, 0, &mapped);
    }
};

// One thread that runs jobs.
class EnginePool {
public:
    ~EnginePool() {
        run(nullptr);
        thread_.join();
    }
    void run(std::function<void()> job) {
        const std::lock_guard lock(mutex_);
        jobs_.push_back(std::move(job));
        changed_.notify_one();
    }
    // Returns when all jobs before have ended.
    void drain() {
        const auto reached = std::make_shared<std::promise<void>>();
        run([reached] { reached->set_value(); });
        reached->get_future().wait();
    }
    std::thread::id id() const {
        return thread_.get_id();
    }
    std::atomic<int> done{0};

private:
    void work() {
        while (true) {
            std::unique_lock lock(mutex_);
            changed_.wait(lock, [this] { return !jobs_.empty(); });
            const std::function<void()> job = std::move(jobs_.front());
            jobs_.pop_front();
            lock.unlock();
            if (!job) {
                return;
            }
            job();
            ++done;
        }
    }
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<std::function<void()>> jobs_;
    std::thread thread_{[this] { work(); }};
};

class EngineServices : public test::DeviceTest {
protected:
    void SetUp() override {
        DeviceTest::SetUp();
        if (context_ == nullptr || !host_.create()) {
            GTEST_SKIP() << "no device to test on";
        }
        const Result<std::shared_ptr<VulkanLibrary>> library = VulkanLibrary::open();
        memory_.handles = host_.handles();
        memory_.vk = *loadDeviceTable(
            *loadInstanceTable((*library)->getInstanceProcAddr(), host_.handles().instance), host_.handles());
        services_.allocateMemory = [this](const auto& request, auto& range) {
            return memory_.allocate(request, range);
        };
        services_.freeMemory = [this](const auto& range) { memory_.release(range); };
        services_.mapMemory = [this](const auto& range, void*& mapped) { return memory_.map(range, mapped); };
        services_.allocation = &hostMemory_.callbacks;
        services_.lockQueue = [this] {
            queue_.lock();
            locked_ = true;
            ++locks_;
        };
        services_.unlockQueue = [this] {
            locked_ = false;
            queue_.unlock();
        };
        services_.runJob = [this](std::function<void()> job) { pool_.run(std::move(job)); };
        services_.namePrefix = "engine/";
        services_.message = [this](const Diagnostic& message) { messages_.push_back(message); };
        const VkPipelineCacheCreateInfo info{.sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO,
                                             .pNext = nullptr,
                                             .flags = 0,
                                             .initialDataSize = 0,
                                             .pInitialData = nullptr};
        memory_.vk.CreatePipelineCache(host_.handles().device, &info, nullptr, &services_.pipelineCache);
    }
    void TearDown() override {
        if (services_.pipelineCache != VK_NULL_HANDLE) {
            memory_.vk.DestroyPipelineCache(host_.handles().device, services_.pipelineCache, nullptr);
        }
        host_.destroy();
        for (const std::string& message : host_.messages()) {
            ADD_FAILURE() << message;
        }
        DeviceTest::TearDown();
    }

    test::HostDevice host_;
    HostMemory hostMemory_;
    EngineMemory memory_;
    EnginePool pool_;
    std::mutex queue_;
    bool locked_ = false;
    int locks_ = 0;
    std::vector<Diagnostic> messages_;
    HostServices services_;
};

TEST_F(EngineServices, NothingBypassesThem) {
    const auto package = std::make_shared<const Package>(load(test::makeDeviceSpec()));
    const auto other = std::make_shared<const Package>(load(test::makeOtherSpec()));
    TestScene scene = test::squareScene();
    {
        auto adopted = must(Context::adopt(host_.handles(), services_));
        VulkanHooks hooks(*adopted);
        hooks.allocation = services_.allocation;
        hooks.pipelineCache = services_.pipelineCache;
        hooks.namePrefix = services_.namePrefix;
        hooks.isLocked = [this] { return locked_; };
        hooks.pipelineThreads = {std::this_thread::get_id(), pool_.id()};
        auto uploaded = must(GpuScene::upload(*adopted, *package, scene.view()));
        RendererOptions options{package::kStrategyVisibility, 16, 16};
        options.pipelineThreads = 1;
        auto renderer = must(Renderer::create(*adopted, *package, *uploaded, options));
        FrameOptions frame;
        frame.camera = test::makeCamera(1.0F);
        for (int pictures = 0; pictures < 2; ++pictures) {
            const auto image = must(renderer->render(frame));
            EXPECT_EQ(image.pixels[8 * 16 + 8][0], 1.0F);
            ASSERT_TRUE(renderer->replacePackage(other));
        }
        pool_.drain();  // it destroys the replaced pipelines
        EXPECT_GT(pool_.done, 0);
        for (const std::string& function : hooks.bypasses) {
            ADD_FAILURE() << function << " bypasses a service";
        }
        for (const char* function :
             {"vkAllocateMemory", "vkFreeMemory", "vkMapMemory", "vkCreatePipelineCache"}) {
            EXPECT_EQ(hooks.callsOf[function], 0U) << function;
        }
        EXPECT_EQ(static_cast<std::uint64_t>(locks_), hooks.callsOf["vkQueueSubmit2"]);
        EXPECT_GT(locks_, 2);
        EXPECT_GT(hooks.made.size(), 50U);
        for (const auto& [handle, function] : hooks.made) {
            EXPECT_TRUE(hooks.named.contains(handle)) << "an object of " << function << " has no name";
        }
        for (const std::string& name : memory_.names) {
            EXPECT_TRUE(name.starts_with("engine/")) << name;
        }
        EXPECT_GT(hostMemory_.calls, 0U);
        EXPECT_FALSE(adopted->addPipelineCache(*adopted->pipelineCacheData()));
        // The caller's allocator is full: an error, and everything stays.
        memory_.full = true;
        EXPECT_EQ(mustFail(Renderer::create(*adopted, *other, *uploaded, options)).kind,
                  ErrorKind::OutOfDeviceMemory);
        memory_.full = false;
        EXPECT_TRUE(renderer->render(frame));
        renderer.reset();
        uploaded.reset();
        adopted->state().vk = hooks.real();
    }
    EXPECT_TRUE(memory_.live.empty());
    EXPECT_EQ(hostMemory_.blocks, 0);
    EXPECT_TRUE(messages_.empty());
}

// Pipelines of the background are made on the caller's threads, and failures are told.
TEST_F(EngineServices, BackgroundPipelines) {
    Jobs jobs(services_);
    std::vector<PlannedPipeline> planned(5);
    std::mutex mutex;
    std::set<std::thread::id> threads;
    for (PlannedPipeline& one : planned) {
        one.job.make = [&, fails = &one == &planned[2]](PipelineCreation&) -> Result<UniquePipeline> {
            const std::lock_guard lock(mutex);
            threads.insert(std::this_thread::get_id());
            return fails ? Result<UniquePipeline>(makeError("job", "", "failed")) : UniquePipeline();
        };
    }
    {
        BackgroundPipelines background(jobs, std::move(planned), 0, 3);
        background.wait();
        EXPECT_EQ(background.take(9).size(), 4U);
        EXPECT_EQ(background.missing(), 0U);
    }
    EXPECT_EQ(threads, std::set{pool_.id()});
    ASSERT_EQ(messages_.size(), 1U);
    EXPECT_EQ(messages_[0].message, "failed");
    // What has not begun when the object is destroyed is not begun.
    std::atomic<int> made{0};
    std::mutex busy;
    busy.lock();
    pool_.run([&] { const std::lock_guard lock(busy); });
    std::vector<PlannedPipeline> late(3);
    for (PlannedPipeline& one : late) {
        one.job.make = [&](PipelineCreation&) -> Result<UniquePipeline> {
            ++made;
            return UniquePipeline();
        };
    }
    std::make_unique<BackgroundPipelines>(jobs, std::move(late), 0, 3).reset();
    busy.unlock();
    pool_.drain();  // its jobs use the variables of this function
    EXPECT_EQ(made, 0);
}

TEST_F(EngineServices, PartsAreRefused) {
    for (const auto& change : std::initializer_list<std::function<void(HostServices&)>>{
             [](HostServices& services) { services.freeMemory = nullptr; },
             [](HostServices& services) { services.lockQueue = nullptr; }}) {
        HostServices services = services_;
        change(services);
        EXPECT_EQ(mustFail(Context::adopt(host_.handles(), services)).id, "context-services");
    }
}

// Handles may not claim features that the device lacks. It has them all here, so the claims are of a device
// without.
TEST_F(EngineServices, ClaimsAreComparedWithTheDevice) {
    DeviceReport report;
    ASSERT_TRUE(queryDevice(context().state().instance, context().handles().physicalDevice, report));
    std::uint32_t refused = 0;
    for (bool DeviceHandles::*claim :
         {&DeviceHandles::positionFetch, &DeviceHandles::shaderFloat16, &DeviceHandles::shaderClock,
          &DeviceHandles::opacityMicromaps, &DeviceHandles::pipelineStatistics,
          &DeviceHandles::samplerAnisotropy}) {
        DeviceHandles handles = context().handles();
        handles.*claim = true;
        EXPECT_EQ(checkClaims(handles, report).ok(), Context::adopt(handles).ok());
        DeviceReport without;
        ASSERT_TRUE(queryDevice(context().state().instance, handles.physicalDevice, without));
        std::erase_if(without.extensions, [](const std::string& name) {
            return name != VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME &&
                   name != VK_KHR_RAY_QUERY_EXTENSION_NAME &&
                   name != VK_KHR_RAY_TRACING_PIPELINE_EXTENSION_NAME &&
                   name != VK_KHR_DEFERRED_HOST_OPERATIONS_EXTENSION_NAME;
        });
        without.features.vulkan12.shaderFloat16 = VK_FALSE;
        without.features.features.features.samplerAnisotropy = VK_FALSE;
        DeviceHandles one = host_.handles();
        EXPECT_TRUE(checkClaims(one, without));
        one.*claim = true;
        EXPECT_EQ(mustFail(checkClaims(one, without)).id, "device-features");
        ++refused;
    }
    EXPECT_EQ(refused, 6U);
}

}  // namespace
}  // namespace glint
