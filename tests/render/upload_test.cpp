// Tests scenes and environments whose upload is recorded into a command buffer of the host's, and their
// compaction.
#include "context/context.h"
#include "interop/scene.h"
#include "render/edited_scene.h"
#include "render/moving_scenes.h"
#include "render/scene_builder.h"
#include "steps/engine_scene.h"
#include "support/must.h"

#include <glint/environment.h>
#include <glint/scene.h>
#include <glint/session/scene_view.h>

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <map>
#include <memory>
#include <string>
#include <utility>

namespace glint::testing {
namespace {

constexpr std::uint32_t kSide = 24;  // pixels of a picture

// Counts the calls by which the shared device is waited for, and its memory, while it is there.
class DeviceWatch {
public:
    DeviceWatch() : vk_(sharedContext().state().vk), real_(vk_) {
        watch = this;
        vk_.WaitForFences = [](VkDevice device, std::uint32_t count, const VkFence* fences, VkBool32 all,
                               std::uint64_t timeout) {
            ++watch->waits;
            return watch->real_.WaitForFences(device, count, fences, all, timeout);
        };
        vk_.DeviceWaitIdle = [](VkDevice device) {
            ++watch->waits;
            return watch->real_.DeviceWaitIdle(device);
        };
        vk_.QueueSubmit2 = [](VkQueue queue, std::uint32_t count, const VkSubmitInfo2* submits,
                              VkFence fence) {
            ++watch->submissions;
            return watch->real_.QueueSubmit2(queue, count, submits, fence);
        };
        vk_.AllocateMemory = [](VkDevice device, const VkMemoryAllocateInfo* info,
                                const VkAllocationCallbacks* callbacks, VkDeviceMemory* memory) {
            const VkResult result = watch->real_.AllocateMemory(device, info, callbacks, memory);
            if (result == VK_SUCCESS) {
                watch->sizes_[*memory] = info->allocationSize;
                watch->bytes += info->allocationSize;
            }
            return result;
        };
        vk_.FreeMemory = [](VkDevice device, VkDeviceMemory memory, const VkAllocationCallbacks* callbacks) {
            watch->bytes -= std::exchange(watch->sizes_[memory], 0);
            watch->real_.FreeMemory(device, memory, callbacks);
        };
    }
    ~DeviceWatch() {
        vk_ = real_;
        watch = nullptr;
    }
    DeviceWatch(const DeviceWatch&) = delete;
    DeviceWatch& operator=(const DeviceWatch&) = delete;

    int waits = 0;
    int submissions = 0;
    std::uint64_t bytes = 0;  // allocated since the construction

private:
    static DeviceWatch* watch;
    DeviceTable& vk_;
    DeviceTable real_;
    std::map<VkDeviceMemory, VkDeviceSize> sizes_;
};
DeviceWatch* DeviceWatch::watch = nullptr;

// A ramp with a texture of three levels and more, and a mirror below.
gltf::Scene texturedRoom() {
    gltf::Scene scene = rigidScene();
    std::vector<std::uint8_t> texels;
    for (std::uint32_t i = 0; i < 32 * 32; ++i) {
        const auto value = static_cast<std::uint8_t>(i * 2654435761U >> 24U);
        texels.insert(texels.end(), {value, static_cast<std::uint8_t>(255 - value), 128, 255});
    }
    materials::Material material;
    material["metallicFactor"] = 0.0F;
    material.texture("baseColorTexture").texture = addTexture(scene, 32, 32, texels);
    scene.samplers.back() = gltf::Sampler();
    addQuad(scene, material, {-1, -1, -4}, {2, 0, 0}, {0, 2, 0});
    return scene;
}

enum class Kind { Still, Streamed, Editable, Posed, Moving };
const char* nameOf(Kind kind) {
    constexpr const char* kNames[] = {"Still", "Streamed", "Editable", "Posed", "Moving"};
    return kNames[static_cast<std::size_t>(kind)];
}

// A scene with its package, which is compiled once for all kinds of uploads.
struct Source {
    explicit Source(gltf::Scene given, bool environmentMap = false) : scene(std::move(given)) {
        compiler::CompileSettings settings;
        settings.strategies = package::kStrategyUber;
        settings.environmentMap = environmentMap;
        settings.tracers = tracerOfDevice();
        loaded = std::make_unique<LoadedScene>(scene, settings);
        data = session::makeSceneView(scene);
        session::useLayoutOf(loaded->package(), scene, data);
    }
    SceneView view(Kind kind) const {
        SceneView view = data.view();
        view.moves = kind == Kind::Moving;
        view.editable = kind == Kind::Editable;
        view.streamsTextures = kind == Kind::Streamed;
        view.firstTexels = 8;
        view.vertices = SceneView::VertexForm::Quantized;  // builds have an input of their own
        return view;
    }

    gltf::Scene scene;
    std::unique_ptr<LoadedScene> loaded;
    session::SceneViewData data;
};

Source& sourceOf(Kind kind) {
    static Source textured(texturedRoom());
    static Source skinned(skinnedScene(0.7));
    return kind == Kind::Posed || kind == Kind::Moving ? skinned : textured;
}

std::unique_ptr<Renderer> makeRenderer(const Source& source, GpuScene& scene) {
    RendererOptions options;
    options.strategy = package::kStrategyUber;
    options.tracer = tracerOfDevice();
    options.width = kSide;
    options.height = kSide;
    return testing::makeRenderer(source.loaded->package(), scene, options);
}

void expectSameBits(const Result<LinearImage>& image, const Result<LinearImage>& reference,
                    const std::string& what) {
    ASSERT_TRUE(image && reference) << what;
    ASSERT_EQ(image->pixels.size(), reference->pixels.size()) << what;
    const std::size_t bytes = image->pixels.size() * sizeof image->pixels[0];
    EXPECT_EQ(std::memcmp(image->pixels.data(), reference->pixels.data(), bytes), 0) << what;
}

class RecordedUpload : public ::testing::TestWithParam<Kind> {
protected:
    void SetUp() override {
        source_ = &sourceOf(GetParam());
        frame_ = defaultSetup(source_->scene, kSide, kSide).frame;
    }
    std::unique_ptr<GpuScene> record(VkCommandBuffer commands, std::uint64_t frame) const {
        return must(GpuScene::record(sharedContext(), source_->loaded->package(), source_->view(GetParam()),
                                     commands, frame));
    }

    Source* source_ = nullptr;
    FrameOptions frame_;
};

TEST_P(RecordedUpload, FramesShowWhatABlockingUploadShows) {
    const auto whole = uploadScene(source_->loaded->package(), source_->view(GetParam()));
    EXPECT_TRUE(whole->isUploaded());
    const std::unique_ptr<Renderer> reference = makeRenderer(*source_, *whole);
    const Result<LinearImage> expected = reference->render(frame_);

    DeviceWatch watch;
    TwoFrames frames(sharedContext());
    VkCommandBuffer commands = frames.begin();
    const std::unique_ptr<GpuScene> scene = record(commands, frames.frame());
    EXPECT_EQ(watch.waits, 0);
    EXPECT_EQ(watch.submissions, 0);
    EXPECT_FALSE(scene->isUploaded());
    EXPECT_GT(scene->statistics().blasCount, 0U);
    EXPECT_EQ(scene->statistics().blasBytes, scene->statistics().blasUncompactedBytes);
    const std::unique_ptr<Renderer> renderer = makeRenderer(*source_, *scene);
    EXPECT_TRUE(renderer->record(commands, frame_));
    EXPECT_EQ(watch.waits + watch.submissions, 0) << "of the renderer";
    frames.submit();
    // Another frame while the first one may be on its way. The sizes of compacted copies are not known yet.
    commands = frames.begin();
    scene->complete(frames.completed());
    if (GetParam() == Kind::Moving) {
        EXPECT_TRUE(scene->update(commands, source_->data.motion(), frames.frame()));
    }
    const bool early = must(scene->recordCompaction(commands, frames.frame()));
    EXPECT_FALSE(early);
    EXPECT_TRUE(renderer->record(commands, frame_));
    frames.submit();
    frames.drain();
    expectSameBits(renderer->readOutput(), expected, "first frames");

    int compactions = 0;
    const int waits = watch.waits;
    for (int i = 0; i < 4; ++i) {
        commands = frames.begin();
        scene->complete(frames.completed());
        const int before = watch.waits;
        const Result<bool> compacted = scene->recordCompaction(commands, frames.frame());
        EXPECT_EQ(watch.waits, before);
        ASSERT_TRUE(compacted.ok());
        compactions += *compacted ? 1 : 0;
        EXPECT_TRUE(renderer->record(commands, frame_));
        frames.submit();
    }
    EXPECT_EQ(compactions, 1);
    EXPECT_EQ(watch.waits, waits + 2);  // for the two frames before the last two
    frames.drain();
    scene->complete(frames.completed());
    EXPECT_TRUE(scene->isUploaded());
    expectSameBits(renderer->readOutput(), expected, "after the compaction");
    const GpuScene::Statistics& statistics = scene->statistics();
    EXPECT_EQ(statistics.blasBytes, whole->statistics().blasBytes);
    EXPECT_EQ(statistics.blasUncompactedBytes, whole->statistics().blasUncompactedBytes);
    const auto total = [](const GpuScene& one) {
        std::uint64_t bytes = 0;
        for (const MemoryItem& item : one.memory()) {
            bytes += item.bytes;
        }
        return bytes;
    };
    EXPECT_EQ(total(*scene), total(*whole));

    if (GetParam() == Kind::Moving) {
        // The top level of later poses has the compacted structures, too.
        Source other(skinnedScene(-0.4));
        for (GpuScene* const one : {scene.get(), whole.get()}) {
            EXPECT_TRUE(one->updateAndWait(other.data.motion()));
        }
        expectSameBits(renderer->render(frame_), reference->render(frame_), "another pose");
    }
}

TEST_P(RecordedUpload, MemoryReturnsWheneverTheSceneGoes) {
    DeviceWatch watch;
    TwoFrames frames(sharedContext());
    {
        // Its commands are never submitted.
        const std::unique_ptr<GpuScene> scene = record(frames.begin(), frames.frame());
        EXPECT_GT(watch.bytes, 0U);
    }
    EXPECT_EQ(watch.bytes, 0U);
    {
        // The device is done with it, but the scene was not told.
        const std::unique_ptr<GpuScene> scene = record(frames.begin(), frames.frame());
        frames.submit();
        frames.drain();
        EXPECT_FALSE(scene->isUploaded());
    }
    EXPECT_EQ(watch.bytes, 0U);
    {
        const std::unique_ptr<GpuScene> scene = record(frames.begin(), frames.frame());
        const std::uint64_t most = scene->allocatedBytes();
        frames.submit();
        frames.drain();
        scene->complete(frames.completed());
        EXPECT_TRUE(scene->isUploaded());
        EXPECT_LT(scene->allocatedBytes(), most);
        // The compaction is on its way.
        const Result<bool> compacted = scene->recordCompaction(frames.begin(), frames.frame());
        EXPECT_TRUE(compacted.ok() && *compacted);
        frames.submit();
        frames.drain();
    }
    EXPECT_EQ(watch.bytes, 0U);
}

INSTANTIATE_TEST_SUITE_P(Kinds, RecordedUpload,
                         ::testing::Values(Kind::Still, Kind::Streamed, Kind::Editable, Kind::Posed,
                                           Kind::Moving),
                         [](const auto& kind) { return std::string(nameOf(kind.param)); });

// A mesh is removed before the compaction, which then leaves it out.
TEST(RecordedUploadEdits, RemovedMeshesAreNotCompacted) {
    Source& source = sourceOf(Kind::Editable);
    DeviceWatch watch;
    {
        TwoFrames frames(sharedContext());
        auto scene = GpuScene::record(sharedContext(), source.loaded->package(), source.view(Kind::Editable),
                                      frames.begin(), frames.frame());
        frames.submit();
        frames.drain();
        (*scene)->complete(frames.completed());
        SceneEditor& editor = *(*scene)->editor();
        EXPECT_TRUE(editor.removeInstance(editor.instance(3)));
        EXPECT_TRUE(editor.removeMesh(editor.mesh(source.data.instances[3].mesh)));
        for (int i = 0; i < 3; ++i) {
            const VkCommandBuffer commands = frames.begin();
            (*scene)->complete(frames.completed());
            EXPECT_TRUE((*scene)->recordCompaction(commands, frames.frame()));
            frames.submit();
        }
        frames.drain();
        (*scene)->complete(frames.completed());
        EXPECT_EQ(editor.retiredBytes(), 0U);
        for (const MemoryItem& item : (*scene)->memory()) {
            EXPECT_NE(item.name, "bottom levels before compaction");
        }
    }
    EXPECT_EQ(watch.bytes, 0U);
}

TEST(RecordedEngineScene, NothingWaitsAndStagingMemoryIsUsedAgain) {
    Source& source = sourceOf(Kind::Moving);
    DeviceWatch watch;
    TwoFrames frames(sharedContext());
    {
        const std::array<std::array<float, 12>, 1> instances{{{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}}};
        EngineScene::View view;
        view.instances = instances;
        auto scene = must(EngineScene::record(sharedContext(), source.loaded->package(), view, frames.begin(),
                                              frames.frame()));
        EXPECT_EQ(watch.waits + watch.submissions, 0);
        frames.submit();
        const std::uint64_t most = watch.bytes;
        for (int i = 0; i < 3; ++i) {
            frames.drain();
            scene->complete(frames.completed());
            const std::array<std::array<float, 12>, 1> moved{
                {{1, 0, 0, 0.1F * static_cast<float>(i), 0, 1, 0, 0, 0, 0, 1, 0}}};
            EXPECT_TRUE(scene->update(frames.begin(), moved, {}, frames.frame()));
            frames.submit();
            EXPECT_EQ(watch.bytes, most) << "another frame takes the same memory";
        }
        frames.drain();
    }
    EXPECT_EQ(watch.bytes, 0U);
}

// Where an engine moves its origin, the previous transforms count from the new one.
TEST(RecordedEngineScene, PreviousTransformsFollowTheOrigin) {
    Source& source = sourceOf(Kind::Moving);
    TwoFrames frames(sharedContext());
    const std::array<std::array<float, 12>, 1> here{{{1, 0, 0, 3, 0, 1, 0, 0, 0, 0, 1, 0}}};
    const std::array<std::array<float, 12>, 1> there{{{1, 0, 0, 4, 0, 1, 0, 0, 0, 0, 1, 0}}};
    EngineScene::View view;
    view.instances = here;
    auto scene = must(
        EngineScene::record(sharedContext(), source.loaded->package(), view, frames.begin(), frames.frame()));
    frames.submit();
    const auto previous = [&] { return scene->state().previousInstances.read<gpu::InstanceRecord>(0); };
    EXPECT_TRUE(scene->update(frames.begin(), there, {}, frames.frame()));
    frames.submit();
    EXPECT_EQ(previous().objectToWorld[0].w, 3.0F);
    EXPECT_TRUE(scene->update(frames.begin(), here, {}, frames.frame(), {1e6, 0.0, -4.0}));
    frames.submit();
    frames.drain();
    EXPECT_EQ(previous().objectToWorld[0].w, 4.0F - 1e6F);
    EXPECT_EQ(previous().objectToWorld[2].w, 4.0F);
}

TEST(RecordedEnvironment, FramesShowWhatABlockingOneShows) {
    const Source source(rigidScene(), true);
    LinearImage map{32, 16, {}};
    for (std::uint32_t i = 0; i < 32 * 16; ++i) {
        map.pixels.push_back({0.1F * static_cast<float>(i % 7), 0.5F, 0.05F * static_cast<float>(i / 32), 1});
    }
    const std::unique_ptr<Renderer> renderer = makeRenderer(source, source.loaded->gpuScene());
    FrameOptions frame = defaultSetup(source.scene, kSide, kSide).frame;
    auto blocking = Environment::create(sharedContext(), map, {});
    ASSERT_TRUE(blocking.ok());
    frame.environment = blocking->get();
    const Result<LinearImage> expected = renderer->render(frame);

    DeviceWatch watch;
    {
        TwoFrames frames(sharedContext());
        const VkCommandBuffer commands = frames.begin();
        auto environment = Environment::record(sharedContext(), map, {}, commands, frames.frame());
        ASSERT_TRUE(environment.ok());
        EXPECT_EQ(watch.waits + watch.submissions, 0);
        frame.environment = environment->get();
        EXPECT_TRUE(renderer->record(commands, frame));
        frames.submit();
        const std::uint64_t most = watch.bytes;
        frames.drain();
        (*environment)->complete(frames.completed());
        EXPECT_LT(watch.bytes, most);
        expectSameBits(renderer->readOutput(), expected, "environment");
        frame.environment = blocking->get();
        expectSameBits(renderer->render(frame), expected, "the blocking one again");
    }
}

}  // namespace
}  // namespace glint::testing
