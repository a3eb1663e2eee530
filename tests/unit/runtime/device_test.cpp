// Tests contexts, uploads and what upload refuses.
#include "context/context.h"
#include "data/acceleration.h"
#include "device_fixture.h"
#include "host_device.h"
#include "interop/scene.h"
#include "scene/scene_store.h"
#include "support/must.h"

#include <functional>
#include <limits>

namespace glint {
namespace {

using test::TestScene;

class ContextTest : public test::DeviceTest {};

TEST_F(ContextTest, NamesItsDeviceAndDriver) {
    EXPECT_FALSE(context().deviceName().empty());
    EXPECT_FALSE(context().driverName().empty());
    EXPECT_NE(context().handles().device, VK_NULL_HANDLE);
    EXPECT_TRUE(missingRequirements(context().handles().physicalDevice).empty());
    EXPECT_FALSE(missingRequirements(VK_NULL_HANDLE).empty());
    EXPECT_EQ(deviceTracers(context().handles().physicalDevice), context().handles().tracers);
    EXPECT_EQ(deviceTracers(VK_NULL_HANDLE), 0U);
}

TEST_F(ContextTest, UnknownDeviceNamesListTheDevices) {
    HeadlessOptions options;
    options.deviceName = "no such device";
    const Diagnostic other = mustFail(Context::createHeadless(options));
    EXPECT_EQ(other.id, "device-missing");
    EXPECT_NE(other.hint.find(context().deviceName()), std::string::npos);
}

// A device may have one type of memory for everything.
TEST_F(ContextTest, MemoryThatTheHostReachesIsMapped) {
    Context::State& state = context().state();
    MemoryPool pool(state);
    const VkBufferUsageFlags usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    const auto device = must(createBuffer(state, pool, 256, usage));
    for (const MemoryUse use : {MemoryUse::Upload, MemoryUse::Readback}) {
        const auto buffer = must(createBuffer(state, pool, 256, usage, use));
        EXPECT_NE(buffer.mapped, nullptr);
    }
}

TEST_F(ContextTest, MemoryReturnsWithItsResourceAndOutlivesItsPool) {
    Context::State& state = context().state();
    const VkBufferUsageFlags usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    Buffer kept;
    {
        MemoryPool pool(state);
        kept = must(createBuffer(state, pool, 256, usage));
        const VkDeviceSize bytes = pool.bytes();
        VkDeviceSize offset = 0;
        {
            const Buffer near = must(createBuffer(state, pool, 256, usage));
            const Buffer large = must(createBuffer(state, pool, 2 * bytes, usage));
            offset = near.memory->offset;
            EXPECT_GT(pool.bytes(), bytes);
        }
        EXPECT_EQ(pool.bytes(), bytes) << "a block without a resource is freed";
        EXPECT_EQ(must(createBuffer(state, pool, 256, usage)).memory->offset, offset) << "its place is free";
    }
    EXPECT_GT(kept.memory->pool->bytes(), 0U);
}

TEST_F(ContextTest, MemoryOfEachFrameStaysUnlessItIsLarge) {
    Context::State& state = context().state();
    MemoryPool pool(state, "scene", MemoryPool::Use::EachFrame);
    const auto bytesAfter = [&](VkDeviceSize bytes) {
        must(createBuffer(state, pool, bytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, MemoryUse::Upload));
        return pool.bytes();
    };
    const VkDeviceSize small = bytesAfter(256);
    EXPECT_GT(small, 0U);
    EXPECT_EQ(bytesAfter(512), small) << "the same block";
    const VkDeviceSize larger = bytesAfter(2 * small);
    EXPECT_GE(larger, 2 * small);
    EXPECT_LT(larger, 3 * small) << "of two the larger one stays";
    EXPECT_EQ(bytesAfter(VkDeviceSize{5} << 20U), larger);
}

// Where all memory has one type, too.
TEST_F(ContextTest, ScratchAndStagingMemoryOfEachFrameStay) {
    Context::State& state = context().state();
    MemoryPool pool(state, "scene", MemoryPool::Use::EachFrame);
    must(createBuffer(state, pool, 256, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT));
    const VkDeviceSize scratch = pool.bytes();
    must(createBuffer(state, pool, 256, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, MemoryUse::Upload));
    EXPECT_GT(pool.bytes(), scratch);
}

// Each pipeline of a renderer is made with these functions in the place of the device's.
struct SeenPipelines {
    DeviceTable real;
    std::size_t pipelines = 0;
    std::size_t withoutPlaces = 0;  // for the feedback of each stage

    void look(const void* next, std::uint32_t stageCount) {
        ++pipelines;
        const auto* it = static_cast<const VkBaseInStructure*>(next);
        for (; it != nullptr; it = it->pNext) {
            if (it->sType == VK_STRUCTURE_TYPE_PIPELINE_CREATION_FEEDBACK_CREATE_INFO) {
                const auto* const feedback =
                    reinterpret_cast<const VkPipelineCreationFeedbackCreateInfo*>(it);
                withoutPlaces += feedback->pipelineStageCreationFeedbackCount != stageCount ||
                                         feedback->pPipelineStageCreationFeedbacks == nullptr
                                     ? 1
                                     : 0;
            }
        }
    }
};
SeenPipelines seen;

// Mesa's driver of Adreno writes to the first stage's place, whatever number is given.
TEST_F(ContextTest, PipelinesHaveAPlaceForTheFeedbackOfEachStage) {
    DeviceTable& vk = context().state().vk;
    seen = {};
    seen.real = vk;
    vk.CreateComputePipelines = [](VkDevice device, VkPipelineCache cache, std::uint32_t count,
                                   const VkComputePipelineCreateInfo* infos,
                                   const VkAllocationCallbacks* callbacks, VkPipeline* pipelines) {
        seen.look(infos->pNext, 1);
        return seen.real.CreateComputePipelines(device, cache, count, infos, callbacks, pipelines);
    };
    vk.CreateGraphicsPipelines = [](VkDevice device, VkPipelineCache cache, std::uint32_t count,
                                    const VkGraphicsPipelineCreateInfo* infos,
                                    const VkAllocationCallbacks* callbacks, VkPipeline* pipelines) {
        seen.look(infos->pNext, infos->stageCount);
        return seen.real.CreateGraphicsPipelines(device, cache, count, infos, callbacks, pipelines);
    };
    vk.CreateRayTracingPipelinesKHR = [](VkDevice device, VkDeferredOperationKHR operation,
                                         VkPipelineCache cache, std::uint32_t count,
                                         const VkRayTracingPipelineCreateInfoKHR* infos,
                                         const VkAllocationCallbacks* callbacks, VkPipeline* pipelines) {
        seen.look(infos->pNext, infos->stageCount);
        return seen.real.CreateRayTracingPipelinesKHR(device, operation, cache, count, infos, callbacks,
                                                      pipelines);
    };
    const Package package = load(test::makeDeviceSpec());
    TestScene scene = test::squareScene();
    const std::unique_ptr<GpuScene> uploaded = upload(package, scene);
    ASSERT_NE(uploaded, nullptr);
    RendererOptions options{package::kStrategyVisibility, 8, 8};
    options.pipelineThreads = 1;
    const auto renderer = Renderer::create(context(), package, *uploaded, options);
    vk = seen.real;
    ASSERT_TRUE(renderer) << toString(renderer.error());
    EXPECT_GT(seen.pipelines, 5U);
    EXPECT_EQ(seen.withoutPlaces, 0U);
}

TEST_F(ContextTest, RenderersNameTheModuleAndTheFeatureThatTheDeviceLacks) {
    const Package package = load(test::makeDeviceSpec());
    TestScene scene = test::squareScene();
    const std::unique_ptr<GpuScene> uploaded = upload(package, scene);
    ASSERT_NE(uploaded, nullptr);
    std::erase(context().state().features, "shaderStorageImageExtendedFormats");
    const Diagnostic renderer =
        mustFail(Renderer::create(context(), package, *uploaded, {package::kStrategyVisibility, 8, 8}));
    EXPECT_EQ(renderer.id, "module-features");
    EXPECT_NE(renderer.message.find(" needs shaderStorageImageExtendedFormats, which the device lacks"),
              std::string::npos)
        << renderer.message;
}

class AdoptedContextTest : public ContextTest, public ::testing::WithParamInterface<std::uint32_t> {};

// Devices with ray queries, and devices that also have pipelines.
INSTANTIATE_TEST_SUITE_P(Tracers, AdoptedContextTest,
                         ::testing::Values(package::kTracerRayQuery, package::kAllTracers));

TEST_P(AdoptedContextTest, RendersAndTheDeviceOutlivesIt) {
    test::HostDevice host;
    ASSERT_TRUE(host.create(GetParam()));
    const Package package = load(test::makeDeviceSpec());
    TestScene scene = test::squareScene();
    // Runs twice on one device, beside the headless context of the fixture; with labels and without.
    for (const bool debugUtils : {false, true}) {
        DeviceHandles handles = host.handles();
        handles.debugUtils = debugUtils && host.handles().debugUtils;
        auto adopted = must(Context::adopt(handles));
        EXPECT_EQ(adopted->handles().device, host.handles().device);
        EXPECT_TRUE(adopted->validationMessages().empty());
        auto uploaded = must(GpuScene::upload(*adopted, package, scene.view()));
        auto renderer =
            must(Renderer::create(*adopted, package, *uploaded, {package::kStrategyVisibility, 16, 16}));
        FrameOptions frame;
        frame.camera = test::makeCamera(1.0F);
        const auto image = must(renderer->render(frame));
        EXPECT_EQ(image.pixels[8 * 16 + 8][0], 1.0F);
    }
    EXPECT_NE(upload(package, scene), nullptr);
    // The layers also report objects of a context that still exist when the device is destroyed.
    host.destroy();
    for (const std::string& message : host.messages()) {
        ADD_FAILURE() << message;
    }
}

TEST_F(ContextTest, AdoptChecksItsHandles) {
    const DeviceHandles good = context().handles();
    const std::function<void(DeviceHandles&)> breaks[] = {
        [](DeviceHandles& h) { h.instance = VK_NULL_HANDLE; },
        [](DeviceHandles& h) { h.physicalDevice = VK_NULL_HANDLE; },
        [](DeviceHandles& h) { h.device = VK_NULL_HANDLE; },
        [](DeviceHandles& h) { h.queue = VK_NULL_HANDLE; },
        [](DeviceHandles& h) { h.tracers = 0; },
        [](DeviceHandles& h) { h.tracers = 4; },
    };
    for (const auto& change : breaks) {
        DeviceHandles handles = good;
        change(handles);
        EXPECT_EQ(mustFail(Context::adopt(handles)).id, "context-handles");
    }
    DeviceHandles handles = good;
    handles.queueFamily = 99;
    EXPECT_EQ(mustFail(Context::adopt(handles)).id, "context-queue");
}

class UploadTest : public test::DeviceTest {
protected:
    std::string refuse(const Package& package, const SceneView& scene) {
        const auto uploaded = GpuScene::upload(context(), package, scene);
        if (uploaded) {
            return "";
        }
        EXPECT_FALSE(uploaded.error().where.empty());
        return uploaded.error().id;
    }
};

TEST_F(UploadTest, PartsBySidednessAndRecordsByInstance) {
    test::PackageSpec spec = test::makeDeviceSpec();
    spec.primitives = {test::makePrimitive(0, 0, gpu::kGeometryDoubleSided), test::makePrimitive(0, 1),
                       test::makePrimitive(0, 2, gpu::kGeometryDoubleSided), test::makePrimitive(1, 0)};
    const Package package = load(spec);
    TestScene scene;
    scene.meshes = {test::makeSquare(0, 0), test::makeSquare(0, 1), test::makeSquare(0, 2),
                    test::makeSquare(1, 0)};
    scene.instances = {{0, test::kIdentity}, {1, test::kIdentity}, {0, test::kIdentity}};
    scene.traversalOrder = SceneView::TraversalOrder::Input;
    const std::unique_ptr<GpuScene> uploaded = upload(package, scene);
    ASSERT_NE(uploaded, nullptr);
    const GpuScene::Statistics& statistics = uploaded->statistics();
    EXPECT_EQ(statistics.blasCount, 3U);
    EXPECT_EQ(statistics.orderMs, 0.0);
    EXPECT_EQ(statistics.geometries, 7U);
    EXPECT_EQ(statistics.instances, 3U);
    EXPECT_EQ(statistics.triangles, 14U);
    EXPECT_GT(statistics.blasBytes, 0U);
    EXPECT_GE(statistics.blasUncompactedBytes, statistics.blasBytes);
    // No two instances of a mesh follow each other, so that each geometry is drawn by a call of its own.
    const std::vector<DrawBatch>& batches = uploaded->state().batches;
    ASSERT_EQ(batches.size(), 7U);
    EXPECT_FALSE(batches[0].doubleSided);
    EXPECT_TRUE(batches[1].doubleSided && batches[2].doubleSided);
}

TEST_F(UploadTest, NothingToBuildIsNoError) {
    const Package package = load(test::makeDeviceSpec());
    TestScene empty;
    const std::unique_ptr<GpuScene> nothing = upload(package, empty);
    ASSERT_NE(nothing, nullptr);
    EXPECT_EQ(nothing->statistics().blasCount, 0U);

    TestScene scene;
    scene.meshes = {{0, 0, {}, {}}};
    // There is a mesh without triangles, one that does not exist, and a flattened instance.
    scene.instances = {{0, test::kIdentity}, {7, test::kIdentity}};
    const std::unique_ptr<GpuScene> hollow = upload(package, scene);
    ASSERT_NE(hollow, nullptr);
    EXPECT_EQ(hollow->statistics().geometries, 0U);
    scene.meshes = {test::makeSquare(0, 0)};
    scene.instances = {{0, {1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0}}, {0, {}}, {0, test::kIdentity}};
    const std::unique_ptr<GpuScene> flat = upload(package, scene);
    ASSERT_NE(flat, nullptr);
    EXPECT_EQ(flat->statistics().geometries, 1U);
    EXPECT_EQ(flat->statistics().instances, 3U);
}

TEST_F(UploadTest, ManyMeshesInBatches) {
    constexpr std::uint32_t kMeshes = 300;
    test::PackageSpec spec = test::makeDeviceSpec();
    spec.primitives.clear();
    TestScene scene;
    for (std::uint32_t mesh = 0; mesh < kMeshes; ++mesh) {
        spec.primitives.push_back(test::makePrimitive(mesh, 0));
        scene.meshes.push_back(test::makeSquare(mesh, 0));
        scene.instances.push_back({mesh, test::kIdentity});
    }
    const Package package = load(spec);
    const std::unique_ptr<GpuScene> uploaded = upload(package, scene);
    ASSERT_NE(uploaded, nullptr);
    EXPECT_EQ(uploaded->statistics().blasCount, kMeshes);
}

// A mesh above the limit of a BLAS is split into several, and each triangle is in exactly one.
TEST_F(UploadTest, LargeMeshesAreSplit) {
    test::PackageSpec spec = test::makeDeviceSpec();
    spec.primitives = {test::makePrimitive(0, 0), test::makePrimitive(0, 1), test::makePrimitive(0, 2)};
    const Package package = load(spec);
    TestScene scene;
    scene.meshes = {test::makeSquare(0, 0), test::makeSquare(0, 1), test::makeSquare(0, 2)};
    scene.instances = {{0, test::kIdentity}};
    scene.traversalOrder = SceneView::TraversalOrder::Input;
    const auto count = [&](std::uint64_t triangles, std::uint64_t geometries) {
        DeviceLimits& limits = context().state().limits;
        limits.accelerationStructure.maxPrimitiveCount = triangles;
        limits.accelerationStructure.maxGeometryCount = geometries;
        const std::unique_ptr<GpuScene> uploaded = upload(package, scene);
        EXPECT_EQ(uploaded->statistics().triangles, 6U);
        std::uint32_t drawn = 0;
        for (const DrawBatch& batch : uploaded->state().batches) {
            drawn += batch.count;
        }
        EXPECT_EQ(drawn, uploaded->statistics().geometries);
        return std::pair(uploaded->statistics().blasCount, uploaded->statistics().geometries);
    };
    EXPECT_EQ(count(6, 3), std::pair(1U, 3U));
    EXPECT_EQ(count(4, 3), std::pair(2U, 3U));
    EXPECT_EQ(count(6, 1), std::pair(3U, 3U));
    EXPECT_EQ(count(3, 3), std::pair(3U, 3U)) << "a primitive that fits is not torn";
    EXPECT_EQ(count(1, 3), std::pair(6U, 6U)) << "one that does not fit is";
    scene.traversalOrder = SceneView::TraversalOrder::Halving;
    EXPECT_EQ(count(6, 3), std::pair(3U, 3U)) << "a driver that halves gets each geometry by itself";
    EXPECT_EQ(count(1, 3), std::pair(6U, 6U));
}

// A CPU's driver gets them in order where nothing else is asked for, other devices' as the scene has them.
TEST_F(UploadTest, OrdersForCpus) {
    const Package package = load(test::makeDeviceSpec());
    TestScene scene = test::squareScene();
    const auto orders = [&](VkPhysicalDeviceType type, SceneView::TraversalOrder order) {
        context().state().limits.deviceType = type;
        scene.traversalOrder = order;
        const std::unique_ptr<GpuScene> uploaded = upload(package, scene);
        return uploaded != nullptr && uploaded->state().store->leafOrder != nullptr &&
               uploaded->statistics().orderMs > 0.0;
    };
    constexpr VkPhysicalDeviceType kCpu = VK_PHYSICAL_DEVICE_TYPE_CPU;
    constexpr VkPhysicalDeviceType kGpu = VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU;
    EXPECT_TRUE(orders(kCpu, SceneView::TraversalOrder::Auto));
    EXPECT_FALSE(orders(kCpu, SceneView::TraversalOrder::Input));
    EXPECT_FALSE(orders(kGpu, SceneView::TraversalOrder::Auto));
    EXPECT_TRUE(orders(kGpu, SceneView::TraversalOrder::Halving));
}

TEST_F(UploadTest, BlasesKeepToTheStorageBufferRange) {
    const BlasCapacity all = blasCapacity(context().state());
    context().state().limits.core.maxStorageBufferRange = 1U << 16;
    const BlasCapacity few = blasCapacity(context().state());
    EXPECT_LT(few.triangles, all.triangles);
    EXPECT_GT(few.triangles, 16U);
    EXPECT_EQ(few.geometries, all.geometries);
}

// The textures are larger than the staging buffer, of odd sizes, and thin.
TEST_F(UploadTest, TexturesOfAllShapes) {
    test::PackageSpec spec = test::makeDeviceSpec();
    spec.textures = {{0, 1, {}}, {1, 0, {}}, {2, 1, {}}, {0, 0, {}}};
    spec.samplers = {{0, 1, 0, 1, 0, 0}, {2, 0, 1, 0, 1, 1}};
    const Package package = load(spec);
    TestScene scene;
    for (const auto& [width, height] : {std::pair(2100U, 2050U), std::pair(1U, 33U), std::pair(7U, 5U)}) {
        scene.images.push_back(
            {width, height, std::vector<std::uint8_t>(std::size_t{4} * width * height, 99), {}});
    }
    const std::unique_ptr<GpuScene> uploaded = upload(package, scene);
    ASSERT_NE(uploaded, nullptr);
    EXPECT_EQ(uploaded->state().textures.size(), 4U);
    EXPECT_EQ(uploaded->state().textures[0].mips, 12U);
    EXPECT_EQ(uploaded->state().textures[1].mips, 6U);
}

// 16-bit images keep their precision if the device can filter them, even as colour.
TEST_F(UploadTest, WideTexturesAreNarrowedOnlyWhereTheDeviceDemands) {
    test::PackageSpec spec = test::makeDeviceSpec();
    spec.textures = {{0, 1, {}}, {0, 0, {}}, {1, 1, {}}};
    const Package package = load(spec);
    TestScene scene;
    scene.images.push_back(
        {2100, 1030, std::vector<std::uint8_t>(std::size_t{8} * 2100 * 1030, 99), ImageView::Format::Rgba16});
    scene.images.push_back({3, 3, std::vector<std::uint8_t>(std::size_t{4} * 9, 99), {}});
    ASSERT_TRUE(context().state().limits.wideTextures);
    const std::unique_ptr<GpuScene> wide = upload(package, scene);
    ASSERT_NE(wide, nullptr);
    EXPECT_EQ(wide->state().textures[0].format, VK_FORMAT_R16G16B16A16_UNORM);
    EXPECT_EQ(wide->state().textures[1].format, VK_FORMAT_R16G16B16A16_UNORM);
    EXPECT_EQ(wide->state().textures[2].format, VK_FORMAT_R8G8B8A8_SRGB);
    EXPECT_EQ(wide->statistics().narrowedTextures, 0U);
    context().state().limits.wideTextures = false;
    const std::unique_ptr<GpuScene> narrow = upload(package, scene);
    ASSERT_NE(narrow, nullptr);
    EXPECT_EQ(narrow->state().textures[0].format, VK_FORMAT_R8G8B8A8_SRGB);
    EXPECT_EQ(narrow->state().textures[1].format, VK_FORMAT_R8G8B8A8_UNORM);
    EXPECT_EQ(narrow->statistics().narrowedTextures, 2U);
}

TEST_F(UploadTest, BrokenScenesAreErrors) {
    test::PackageSpec spec = test::makeDeviceSpec();
    spec.textures = {{0, 1, {}}};
    spec.primitives[0].key.inputs = test::inputOf(package::Role::Normals);
    spec.cases[0].always = std::uint64_t{spec.primitives[0].key.inputs} << 32U;
    const Package package = load(spec);
    const TestScene::Mesh square = test::makeSquare(0, 0);
    const std::vector<std::array<float, 3>> normals(4, {0, 0, 1});
    const std::vector<std::uint8_t> pixels(16, 0);
    const ImageView image{2, 2, pixels};
    const InstanceView instance;
    const auto withScene = [&](const std::function<void(PrimitiveView&, SceneView&, ImageView&)>& change) {
        PrimitiveView primitive;
        primitive.positions = square.positions;
        primitive.indices = square.indices;
        primitive.normals = normals;
        ImageView changedImage = image;
        SceneView scene{{&primitive, 1}, {&instance, 1}, {&changedImage, 1}, {}};
        change(primitive, scene, changedImage);
        return refuse(package, scene);
    };
    using P = PrimitiveView;
    using S = SceneView;
    using I = ImageView;
    EXPECT_EQ(withScene([](P&, S&, I&) {}), "");
    EXPECT_EQ(withScene([](P& p, S&, I&) { p.normals = {}; }), "scene-package");
    EXPECT_EQ(withScene([](P& p, S&, I&) { p.normals = p.normals.first(3); }), "scene-attribute");
    EXPECT_EQ(withScene([](P& p, S&, I&) { p.positions = p.positions.first(3); }), "scene-attribute");
    EXPECT_EQ(withScene([](P& p, S&, I&) {
                  p.positions = p.positions.first(3);
                  p.normals = p.normals.first(3);
              }),
              "scene-index");
    EXPECT_EQ(withScene([](P& p, S&, I&) { p.indices = p.indices.first(5); }), "scene-index");
    EXPECT_EQ(withScene([](P& p, S&, I&) { p.mesh = 1; }), "scene-package");
    EXPECT_EQ(withScene([](P&, S& s, I&) { s.primitives = {}; }), "scene-package");
    EXPECT_EQ(withScene([](P&, S& s, I&) { s.images = {}; }), "scene-package");
    EXPECT_EQ(withScene([](P&, S&, I& i) { i.width = 3; }), "scene-image");
    EXPECT_EQ(withScene([](P&, S&, I& i) { i.height = 0; }), "scene-image");
    EXPECT_EQ(withScene([](P&, S&, I& i) { i.format = I::Format::Rgba16; }), "scene-image");
    EXPECT_EQ(withScene([](P&, S&, I& i) { i.format = static_cast<I::Format>(255); }), "scene-image");
    EXPECT_EQ(withScene([](P&, S&, I& i) { i.width = 1U << 30; }), "scene-image");
    EXPECT_EQ(withScene([](P&, S&, I& i) { i.levels = 0; }), "scene-image");
    EXPECT_EQ(withScene([](P&, S&, I& i) { i.levels = 2; }), "scene-image");
    EXPECT_EQ(withScene([](P&, S&, I& i) { i.levels = 3; }), "scene-image");
    LightView light;
    light.range = std::numeric_limits<float>::infinity();
    EXPECT_EQ(withScene([&](P&, S& s, I&) { s.lights = {&light, 1}; }), "scene-light");
    light = {};
    light.type = LightView::Type::Disk;  // which the package does not know
    EXPECT_EQ(withScene([&](P&, S& s, I&) { s.lights = {&light, 1}; }), "scene-light");
    std::vector<PrimitiveView> twice(2);
    EXPECT_EQ(withScene([&](P& p, S& s, I&) {
                  twice = {p, p};
                  s.primitives = twice;
              }),
              "scene-order");
}

}  // namespace
}  // namespace glint
