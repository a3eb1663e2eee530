// Tests what renderer and scene report about their memory.
#include "device_fixture.h"
#include "scene/gpu_scene_state.h"
#include "support/must.h"

#include <algorithm>
#include <numeric>
#include <set>
#include <utility>

namespace glint::test {
namespace {

using MemoryReports = DeviceTest;

std::uint64_t sum(const std::vector<MemoryItem>& items) {
    return std::accumulate(items.begin(), items.end(), std::uint64_t{0},
                           [](std::uint64_t bytes, const MemoryItem& item) { return bytes + item.bytes; });
}

const MemoryItem* find(const std::vector<MemoryItem>& items, const std::string& name) {
    const auto found = std::ranges::find(items, name, &MemoryItem::name);
    return found == items.end() ? nullptr : &*found;
}

TEST_F(MemoryReports, HaveEveryBufferAndImageOnce) {
    const Package package = load(makeDeviceSpec());
    TestScene scene;
    scene.meshes = {makeSquare(0, 0)};
    scene.instances = {{0, kIdentity}, {0, kIdentity}};
    const auto gpuScene = upload(package, scene);
    ASSERT_NE(gpuScene, nullptr);
    for (const package::Strategy strategy : {package::kStrategyUber, package::kStrategyVisibility}) {
        const auto renderer = makeRenderer(package, *gpuScene, strategy, 33, 17);
        ASSERT_NE(renderer, nullptr);
        const std::vector<MemoryItem> items = renderer->memory();
        const Renderer::Footprint footprint = renderer->footprint();
        EXPECT_EQ(sum(items), footprint.bytes);
        EXPECT_GE(footprint.allocatedBytes, footprint.bytes);
        std::uint32_t images = 0;
        std::uint32_t buffers = 0;
        std::set<std::pair<bool, std::string>> names;
        for (const MemoryItem& item : items) {
            EXPECT_GT(item.bytes, 0U) << item.name;
            EXPECT_TRUE(names.emplace(item.isImage, item.name).second) << item.name;
            (item.isImage ? images : buffers) += item.count;
        }
        EXPECT_EQ(images, footprint.images);
        EXPECT_EQ(buffers, footprint.buffers);
        ASSERT_NE(find(items, "constants"), nullptr);
        EXPECT_EQ(find(items, "constants")->use, MemoryUse::Device);
        EXPECT_EQ(find(items, "read-back")->use, MemoryUse::Readback);
        EXPECT_EQ(find(items, "rays")->use, MemoryUse::Device);
        EXPECT_EQ(find(items, "hits") != nullptr, strategy == package::kStrategyVisibility);
        EXPECT_GE(find(items, "accumulated")->bytes, 33U * 17U * 16U);
    }
}

TEST_F(MemoryReports, OfASceneGrowWithIt) {
    const Package package = load(makeDeviceSpec());
    TestScene scene = squareScene();
    const auto one = upload(package, scene);
    ASSERT_NE(one, nullptr);
    scene.instances.resize(100, {0, kIdentity});
    const auto many = upload(package, scene);
    ASSERT_NE(many, nullptr);
    const std::vector<MemoryItem> few = one->memory();
    const std::vector<MemoryItem> more = many->memory();
    const GpuScene::Statistics& statistics = one->statistics();
    EXPECT_EQ(find(few, "bottom levels")->bytes, statistics.blasBytes);
    EXPECT_EQ(find(few, "bottom levels")->count, statistics.blasCount);
    EXPECT_EQ(find(few, "bottom levels")->bytes, find(more, "bottom levels")->bytes);
    EXPECT_EQ(find(few, "vertices and indices")->bytes, find(more, "vertices and indices")->bytes);
    EXPECT_EQ(find(few, "instance records")->bytes * 100, find(more, "instance records")->bytes);
    EXPECT_GT(find(more, "top level")->bytes, find(few, "top level")->bytes);
    EXPECT_TRUE(find(few, "textures")->isImage);
    EXPECT_GE(one->allocatedBytes(), sum(few));
    EXPECT_GE(many->allocatedBytes(), sum(more));
}

// The device of the tests builds no micromaps, so their buffers are planted.
TEST_F(MemoryReports, ListMicromaps) {
    const Package package = load(makeDeviceSpec());
    TestScene scene = squareScene();
    const auto gpuScene = upload(package, scene);
    ASSERT_NE(gpuScene, nullptr);
    const std::vector<MemoryItem> before = gpuScene->memory();
    EXPECT_EQ(find(before, "opacity micromaps"), nullptr);
    GpuScene::State& state = gpuScene->state();
    const auto make = [&](VkDeviceSize bytes) {
        return must(createBuffer(state.context, state.pool, bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                 MemoryUse::Device));
    };
    state.micromaps[0].buffer = make(512);
    state.micromaps[0].indices = make(64);
    state.micromaps[1].indices = make(32);  // its triangles need no record
    const std::vector<MemoryItem> items = gpuScene->memory();
    ASSERT_NE(find(items, "opacity micromaps"), nullptr);
    EXPECT_EQ(find(items, "opacity micromaps")->count, 3U);
    EXPECT_GE(find(items, "opacity micromaps")->bytes, 512U + 64U + 32U);
    EXPECT_EQ(sum(items), sum(before) + find(items, "opacity micromaps")->bytes);
    EXPECT_GE(gpuScene->allocatedBytes(), sum(items));
}

}  // namespace
}  // namespace glint::test
