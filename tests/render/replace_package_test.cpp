// A renderer that takes over another package of its scene while it draws.
#include "render/harness.h"
#include "render/pixel_test.h"
#include "renderer/renderer_state.h"
#include "support/shared_modules.h"

#include <glint/scene_view/package.h>
#include <glint/scene_view/scene_view.h>

#include <gtest/gtest.h>

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

compiler::CompileSettings settingsFor(std::uint32_t strategies, bool fallback = false) {
    compiler::CompileSettings settings;
    settings.strategies = strategies;
    settings.tracers = package::kAllTracers;
    settings.plan.merge = compiler::MergePolicy::None;
    settings.plan.fallback = fallback;
    settings.effects = {false, compiler::builtinEffects({"reflection"})};
    return settings;
}

constexpr std::size_t kGlossy = 1;  // the material that is edited

materials::Material glossyMaterial(gltf::Float3 color) {
    materials::Material material;
    material["baseColorFactor"] = {color[0], color[1], color[2], 1.0F};
    material["metallicFactor"] = 0.0F;
    material["roughnessFactor"] = 0.5F;
    return material;
}

void giveCoat(materials::Material& material) {
    material.give("KHR_materials_clearcoat");
    material["clearcoatFactor"] = 1.0F;
    material["clearcoatRoughnessFactor"] = 0.1F;
}

void giveSheen(materials::Material& material) {
    material.give("KHR_materials_sheen");
    material["sheenColorFactor"] = {0.9F, 0.4F, 0.1F};
    material["sheenRoughnessFactor"] = 0.5F;
}

// A mirror below walls with a material each.
gltf::Scene roomScene() {
    gltf::Scene scene = emptyScene();
    addCamera(scene);
    addInstance(scene, addMesh(scene, makeQuad(addMaterial(scene, mirrorMaterial()), {-4, -1, 0}, {8, 0, 0},
                                               {0, 0, -8})));
    materials::Material coated = glossyMaterial(kGreen);
    giveCoat(coated);
    materials::Material sheen = glossyMaterial(kBlue);
    giveSheen(sheen);
    gltf::Mesh walls;
    float x = -4.0F;
    for (const materials::Material& material : {glossyMaterial(kRed), coated, sheen, unlitMaterial(kGreen)}) {
        walls.primitives.push_back(
            makeQuad(addMaterial(scene, material), {x, -0.9F, -5.0F}, {2, 0, 0}, {0, 4, 0}));
        x += 2.0F;
    }
    scene.meshes.push_back(walls);
    addInstance(scene, static_cast<int>(scene.meshes.size()) - 1);
    addDirectionalLight(scene, {0.0F, -0.6F, -0.8F}, 2.0F);
    return scene;
}

// The room, with a combination of features that no material had: one case has another shader, and shader IDs
// move.
gltf::Scene editedRoom() {
    gltf::Scene scene = roomScene();
    giveCoat(scene.materials[kGlossy]);
    giveSheen(scene.materials[kGlossy]);
    return scene;
}

// The room, with a feature that no material had: records of materials are longer.
gltf::Scene extendedRoom() {
    gltf::Scene scene = roomScene();
    scene.materials[kGlossy].give("KHR_materials_specular");
    scene.materials[kGlossy]["specularFactor"] = 0.25F;
    return scene;
}

// The room, with another value of one of its materials.
gltf::Scene repaintedRoom() {
    gltf::Scene scene = roomScene();
    scene.materials[kGlossy]["baseColorFactor"] = {0.1F, 0.8F, 0.9F, 1.0F};
    return scene;
}

void expectEqualImage(const LinearImage& image, const LinearImage& reference, const std::string& what) {
    ASSERT_EQ(image.pixels.size(), reference.pixels.size()) << what;
    ASSERT_FALSE(image.pixels.empty()) << what;
    std::size_t others = 0;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        others += image.pixels[i] == reference.pixels[i] ? 0 : 1;
    }
    EXPECT_EQ(others, 0U) << what;
}

bool differ(const LinearImage& first, const LinearImage& second) {
    return first.pixels != second.pixels;
}

std::shared_ptr<const Package> packageOf(const gltf::Scene& scene,
                                         const compiler::CompileSettings& settings) {
    Result<Package> package = scene_view::compileAndLoad(scene, settings, &sharedModules());
    if (!package) {
        ADD_FAILURE() << toString(package.error());
        return nullptr;
    }
    return std::make_shared<const Package>(std::move(*package));
}

// Cases that send no shadow ray trace nothing.
std::span<const std::uint32_t> caseWords(const Package& package, std::uint32_t shaderId) {
    return package.spirv({package::roleNamed("ShadeCase"), shaderId, 0});
}

class ReplacePackage : public ::testing::Test {
protected:
    static void SetUpTestSuite() {
        before_ = new gltf::Scene(roomScene());
        after_ = new gltf::Scene(editedRoom());
        const compiler::CompileSettings settings = settingsFor(package::allStrategies(), true);
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
        ASSERT_NE(*original_, nullptr);
        ASSERT_NE(*edited_, nullptr);
        setup_ = defaultSetup(*before_, 24, 24);
    }

    RendererOptions optionsOf(package::Strategy strategy, package::Tracer tracer) const {
        RendererOptions options;
        options.width = setup_.width;
        options.height = setup_.height;
        options.strategy = strategy;
        options.tracer = tracer;
        return options;
    }
    // Every strategy, and visibility with every tracer that the device has.
    template <typename Test>
    static void forEachWay(const Test& test) {
        for (const package::Strategy strategy : package::strategies()) {
            bool tested = false;
            for (const package::Tracer tracer : package::kTracers) {
                const bool again = tested && strategy != package::kStrategyVisibility;
                if (!again && (sharedContext().handles().tracers & tracer &
                               package::tracersOf(strategy, package::kAllTracers)) != 0) {
                    tested = true;
                    test(strategy, tracer,
                         std::string(package::nameOf(strategy)) + " with " +
                             std::string(package::nameOf(tracer)));
                }
            }
        }
    }
    // Uploads `scene` for the package.
    static std::unique_ptr<GpuScene> upload(const gltf::Scene& scene, const Package& package) {
        scene_view::SceneViewData data = scene_view::makeSceneView(scene);
        scene_view::useLayoutOf(package, scene, data);
        Result<std::unique_ptr<GpuScene>> uploaded = GpuScene::upload(sharedContext(), package, data.view());
        if (!uploaded) {
            ADD_FAILURE() << toString(uploaded.error());
            return nullptr;
        }
        return std::move(*uploaded);
    }
    static std::unique_ptr<Renderer> make(const Package& package, GpuScene& scene,
                                          const RendererOptions& options) {
        auto renderer = Renderer::create(sharedContext(), package, scene, options);
        if (!renderer) {
            ADD_FAILURE() << toString(renderer.error());
            return nullptr;
        }
        return std::move(*renderer);
    }
    LinearImage draw(Renderer& renderer) const {
        const Result<LinearImage> image = renderer.render(setup_.frame, setup_.samples);
        EXPECT_TRUE(image) << toString(image.error());
        return image ? *image : LinearImage{};
    }
    // Returns the picture of a scene and a renderer of its own.
    LinearImage fresh(const gltf::Scene& scene, const Package& package,
                      const RendererOptions& options) const {
        const std::unique_ptr<GpuScene> uploaded = upload(scene, package);
        const std::unique_ptr<Renderer> renderer = uploaded ? make(package, *uploaded, options) : nullptr;
        return renderer ? draw(*renderer) : LinearImage{};
    }

    static inline gltf::Scene* before_ = nullptr;
    static inline gltf::Scene* after_ = nullptr;
    static inline std::shared_ptr<const Package>* original_ = nullptr;
    static inline std::shared_ptr<const Package>* edited_ = nullptr;
    RenderSetup setup_;
};

TEST_F(ReplacePackage, ThePictureIsThatOfTheOldPackageAndThenOfTheNewOne) {
    forEachWay([&](package::Strategy strategy, package::Tracer tracer, const std::string& name) {
        RendererOptions options = optionsOf(strategy, tracer);
        const LinearImage old = fresh(*before_, **original_, options);
        const LinearImage wanted = fresh(*after_, **edited_, options);
        ASSERT_TRUE(differ(old, wanted)) << name;
        options.backgroundPipelines = true;
        const std::unique_ptr<GpuScene> scene = upload(*before_, **original_);
        ASSERT_NE(scene, nullptr);
        const std::unique_ptr<Renderer> renderer = make(**original_, *scene, options);
        ASSERT_NE(renderer, nullptr);
        renderer->waitForPipelines();
        expectEqualImage(draw(*renderer), old, name + ", before");

        renderer->state().pipelines.adoptedAtOnce = 0;
        const Result<PackageReplacement> replaced = renderer->replacePackage(*edited_);
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
        const Result<FrameCounters> counters = renderer->counters();
        ASSERT_TRUE(counters);
        EXPECT_EQ(counters->unknownShader, 0U) << name;
        expectNoValidationMessages();
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
    const std::unique_ptr<GpuScene> scene = upload(*before_, **original_);
    const std::unique_ptr<Renderer> renderer = make(**original_, *scene, options);
    ASSERT_NE(renderer, nullptr);
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
    expectNoValidationMessages();
}

// A draft ends while another package waits, because the fixed passes are still made.
TEST_F(ReplacePackage, ADraftEndsWhileAPackageWaits) {
    const bool queries = (sharedContext().handles().tracers & package::kTracerRayQuery) != 0;
    RendererOptions options = optionsOf(package::kStrategyVisibility,
                                        queries ? package::kTracerRayQuery : package::kTracerRayPipeline);
    const LinearImage old = fresh(*before_, **original_, options);
    const LinearImage wanted = fresh(*after_, **edited_, options);
    options.backgroundPipelines = true;
    const std::unique_ptr<GpuScene> scene = upload(*before_, **original_);
    const std::unique_ptr<Renderer> renderer = make(**original_, *scene, options);
    ASSERT_NE(renderer, nullptr);
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
    expectNoValidationMessages();
}

// A command buffer of a frame in flight.
struct Flight {
    explicit Flight(Context::State& state) : context(state) {
        const DeviceTable& vk = context.vk;
        VkCommandPoolCreateInfo poolInfo{};
        poolInfo.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
        poolInfo.queueFamilyIndex = context.handles.queueFamily;
        VkCommandPool made = VK_NULL_HANDLE;
        EXPECT_EQ(vk.CreateCommandPool(context.handles.device, &poolInfo, nullptr, &made), VK_SUCCESS);
        pool = UniqueCommandPool(context, made);
        VkCommandBufferAllocateInfo bufferInfo{};
        bufferInfo.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
        bufferInfo.commandPool = made;
        bufferInfo.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
        bufferInfo.commandBufferCount = 1;
        EXPECT_EQ(vk.AllocateCommandBuffers(context.handles.device, &bufferInfo, &commands), VK_SUCCESS);
        VkFenceCreateInfo fenceInfo{};
        fenceInfo.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO;
        VkFence signal = VK_NULL_HANDLE;
        EXPECT_EQ(vk.CreateFence(context.handles.device, &fenceInfo, nullptr, &signal), VK_SUCCESS);
        fence = UniqueFence(context, signal);
    }
    // Submits a sample of the renderer without waiting.
    void submit(Renderer& renderer, const FrameOptions& frame) {
        const DeviceTable& vk = context.vk;
        VkCommandBufferBeginInfo begin{};
        begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
        EXPECT_EQ(vk.ResetCommandPool(context.handles.device, pool.get(), 0), VK_SUCCESS);
        EXPECT_EQ(vk.BeginCommandBuffer(commands, &begin), VK_SUCCESS);
        const Status recorded = renderer.record(commands, frame);
        EXPECT_TRUE(recorded) << toString(recorded.error());
        EXPECT_EQ(vk.EndCommandBuffer(commands), VK_SUCCESS);
        VkCommandBufferSubmitInfo buffer{};
        buffer.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO;
        buffer.commandBuffer = commands;
        VkSubmitInfo2 submission{};
        submission.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2;
        submission.commandBufferInfoCount = 1;
        submission.pCommandBufferInfos = &buffer;
        const VkFence signal = fence.get();
        EXPECT_EQ(vk.QueueSubmit2(context.handles.queue, 1, &submission, signal), VK_SUCCESS);
        recording = renderer.recordings();
    }
    void wait() {
        const VkFence signal = fence.get();
        EXPECT_EQ(context.vk.WaitForFences(context.handles.device, 1, &signal, VK_TRUE,
                                           std::numeric_limits<std::uint64_t>::max()),
                  VK_SUCCESS);
        EXPECT_EQ(context.vk.ResetFences(context.handles.device, 1, &signal), VK_SUCCESS);
    }

    Context::State& context;
    UniqueCommandPool pool;
    UniqueFence fence;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    std::uint64_t recording = 0;
};

TEST_F(ReplacePackage, FramesInFlightKeepWhatTheyUse) {
    const package::Strategy strategy = package::kStrategyVisibility;
    const package::Tracer tracer = (sharedContext().handles().tracers & package::kTracerRayQuery) != 0
                                       ? package::kTracerRayQuery
                                       : package::kTracerRayPipeline;
    const RendererOptions options = optionsOf(strategy, tracer);
    const LinearImage old = fresh(*before_, **original_, options);
    const LinearImage wanted = fresh(*after_, **edited_, options);
    const std::unique_ptr<GpuScene> scene = upload(*before_, **original_);
    const std::unique_ptr<Renderer> renderer = make(**original_, *scene, options);
    ASSERT_NE(renderer, nullptr);
    Flight one(sharedContext().state());
    Flight two(sharedContext().state());
    Flight* first = &one;
    Flight* second = &two;
    first->submit(*renderer, setup_.frame);
    const VkImage output = renderer->output();
    std::vector<std::uint64_t> bytes;
    for (int swap = 0; swap < 10; ++swap) {
        const bool forth = swap % 2 == 0;
        ASSERT_TRUE(renderer->replacePackage(forth ? *edited_ : *original_));
        second->submit(*renderer, setup_.frame);  // the earlier frame is in flight
        EXPECT_EQ(renderer->replacementProgress().inUse, static_cast<std::uint64_t>(swap) + 1);
        EXPECT_FALSE(renderer->state().leftovers.empty());
        first->wait();
        renderer->finished(first->recording);
        EXPECT_FALSE(renderer->state().leftovers.empty()) << "the frame of the switch is in flight";
        std::swap(first, second);
        if (swap == 4 || swap == 5) {
            first->wait();
            renderer->finished(first->recording);
            EXPECT_TRUE(renderer->state().leftovers.empty());
            expectEqualImage(draw(*renderer), forth ? wanted : old, "swap " + std::to_string(swap));
            first->submit(*renderer, setup_.frame);
        }
        if (!forth) {
            bytes.push_back(renderer->footprint().allocatedBytes + scene->allocatedBytes());
        }
    }
    first->wait();
    renderer->finished(first->recording);
    EXPECT_TRUE(renderer->state().leftovers.empty());
    for (const std::uint64_t allocated : bytes) {
        EXPECT_EQ(allocated, bytes.front()) << "memory grows";
    }
    EXPECT_EQ(renderer->output(), output) << "the picture's image stays";
    expectNoValidationMessages();
}

TEST_F(ReplacePackage, OnlyPipelinesThatChangedAreMade) {
    const package::Strategy strategy = package::kStrategyVisibility;
    const compiler::CompileSettings settings = settingsFor(strategy);
    const std::shared_ptr<const Package> original = packageOf(*before_, settings);
    const std::shared_ptr<const Package> repainted = packageOf(repaintedRoom(), settings);
    const std::shared_ptr<const Package> edited = packageOf(*after_, settings);
    const std::unique_ptr<GpuScene> scene = upload(*before_, *original);
    RendererOptions options;
    options.strategy = strategy;
    options.width = setup_.width;
    options.height = setup_.height;
    const std::unique_ptr<Renderer> renderer = make(*original, *scene, options);
    ASSERT_NE(renderer, nullptr);
    const std::uint32_t pipelines = renderer->footprint().pipelines;

    const Result<PackageReplacement> values = renderer->replacePackage(repainted);
    ASSERT_TRUE(values) << toString(values.error());
    EXPECT_EQ(values->pipelinesMade, 0U) << "values of materials are in no shader";
    EXPECT_EQ(values->pipelinesKept, pipelines);
    EXPECT_TRUE(values->casesMade.empty());
    EXPECT_EQ(values->buffersMade, 0U);
    expectEqualImage(draw(*renderer), fresh(repaintedRoom(), *repainted, options), "another colour");

    const Result<PackageReplacement> key = renderer->replacePackage(edited);
    ASSERT_TRUE(key) << toString(key.error());
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
    EXPECT_EQ(key->casesMade, fresh);
    EXPECT_EQ(key->casesMade.size(), 1U);
    EXPECT_GT(key->pipelinesKept, 0U);
    draw(*renderer);
    EXPECT_EQ(renderer->footprint().pipelines, key->pipelinesKept + key->pipelinesMade);
    expectNoValidationMessages();
}

// The package that comes last wins, and what an earlier one has made already is not made again.
TEST_F(ReplacePackage, ALaterPackageTakesThePlaceOfOneThatWaits) {
    RendererOptions options = optionsOf(package::kStrategyVisibility, package::kTracerRayPipeline);
    if ((sharedContext().handles().tracers & package::kTracerRayPipeline) == 0) {
        GTEST_SKIP() << "the device has no ray tracing pipelines";
    }
    options.backgroundPipelines = true;
    const std::unique_ptr<GpuScene> scene = upload(*before_, **original_);
    const std::unique_ptr<Renderer> renderer = make(**original_, *scene, options);
    ASSERT_NE(renderer, nullptr);
    renderer->waitForPipelines();
    const LinearImage old = draw(*renderer);
    const Result<PackageReplacement> first = renderer->replacePackage(*edited_);
    ASSERT_TRUE(first);
    renderer->waitForPipelines();
    const Result<PackageReplacement> again = renderer->replacePackage(*edited_);
    ASSERT_TRUE(again);
    EXPECT_EQ(again->pipelinesMade, 0U);
    EXPECT_EQ(again->pipelinesKept, first->pipelinesKept + first->pipelinesMade);
    ASSERT_TRUE(renderer->replacePackage(*original_));
    renderer->waitForPipelines();
    expectEqualImage(draw(*renderer), old, "the first package again");
    EXPECT_EQ(renderer->replacementProgress().inUse, 1U);
    EXPECT_TRUE(renderer->state().leftovers.empty());
    expectNoValidationMessages();
}

// finished() leaves pipelines that are still being made to a thread, and so never waits for them.
TEST_F(ReplacePackage, APackageThatIsGivenUpIsLeftToAThread) {
    RendererOptions options = optionsOf(package::kStrategyVisibility, package::kTracerRayPipeline);
    if ((sharedContext().handles().tracers & package::kTracerRayPipeline) == 0) {
        GTEST_SKIP() << "the device has no ray tracing pipelines";
    }
    options.backgroundPipelines = true;
    const std::unique_ptr<GpuScene> scene = upload(*before_, **original_);
    const std::unique_ptr<Renderer> renderer = make(**original_, *scene, options);
    ASSERT_NE(renderer, nullptr);
    ASSERT_TRUE(renderer->replacePackage(*edited_));
    ASSERT_TRUE(renderer->replacePackage(*original_));
    EXPECT_EQ(renderer->state().leftovers.size(), 1U);
    renderer->finished(renderer->recordings());
    EXPECT_TRUE(renderer->state().leftovers.empty());
    expectNoValidationMessages();
}

TEST_F(ReplacePackage, ErrorsKeepThePackageBefore) {
    const compiler::CompileSettings uber = settingsFor(package::kStrategyUber);
    const std::shared_ptr<const Package> original = packageOf(*before_, uber);
    const std::unique_ptr<GpuScene> scene = upload(*before_, *original);
    RendererOptions options;
    options.strategy = package::kStrategyUber;
    options.width = setup_.width;
    options.height = setup_.height;
    const std::unique_ptr<Renderer> renderer = make(*original, *scene, options);
    ASSERT_NE(renderer, nullptr);
    const LinearImage old = draw(*renderer);
    const auto expectError = [&](const std::shared_ptr<const Package>& package, const char* id) {
        const Result<PackageReplacement> replaced = renderer->replacePackage(package);
        ASSERT_FALSE(replaced) << id;
        EXPECT_EQ(replaced.error().id, id) << toString(replaced.error());
        EXPECT_FALSE(renderer->replacementProgress().pending) << id;
    };
    expectError(packageOf(*before_, settingsFor(package::kStrategyVisibility)), "package-strategy");
    gltf::Scene fewer = roomScene();
    fewer.meshes[1].primitives.pop_back();
    expectError(packageOf(fewer, uber), "scene-package");
    gltf::Scene seen = roomScene();
    seen.materials[kGlossy].doubleSided = true;
    expectError(packageOf(seen, uber), "scene-package");
    gltf::Scene textured = roomScene();
    textured.materials[kGlossy].texture("baseColorTexture").texture =
        addTexture(textured, 1, 1, {255, 255, 255, 255});
    expectError(packageOf(textured, uber), "scene-package");
    compiler::CompileSettings map = uber;
    map.environmentMap = true;
    expectError(packageOf(*before_, map), "package-frame");
    expectEqualImage(draw(*renderer), old, "after errors");
    EXPECT_EQ(renderer->replacementProgress().inUse, 0U);
    expectNoValidationMessages();
}

// A masked leaf whose left half is opaque, above a mirror: without rays nothing is tested. UVs keep clear of
// the border, so that the states of all triangles are known.
gltf::Scene maskedRoom() {
    gltf::Scene scene = emptyScene();
    addCamera(scene);
    addDirectionalLight(scene, {0.0F, -0.6F, -0.8F}, 2.0F);
    materials::Material leaf = glossyMaterial(kGreen);
    leaf.alphaMode = materials::AlphaMode::Mask;
    leaf.texture("baseColorTexture").texture =
        addTexture(scene, 2, 1, {255, 255, 255, 255, 255, 255, 255, 100});
    const int mask = addMaterial(scene, leaf);
    for (const float left : {0.1F, 0.6F}) {
        gltf::Primitive quad = makeQuad(mask, {left - 0.8F, -0.5F, -2}, {0.4F, 0, 0}, {0, 1, 0});
        for (gltf::Float2& uv : quad.texCoords0) {
            uv[0] = left + 0.3F * uv[0];
        }
        addInstance(scene, addMesh(scene, quad));
    }
    addInstance(scene, addMesh(scene, makeQuad(addMaterial(scene, mirrorMaterial()), {-4, -1, 0}, {8, 0, 0},
                                               {0, 0, -8})));
    return scene;
}

// What the upload has proved about triangles holds for a package with the same alpha only.
TEST_F(ReplacePackage, TheAlphaOfDecidedTrianglesStays) {
    compiler::CompileSettings uber = settingsFor(package::kStrategyUber);
    uber.plan.keys.alpha = package::AlphaPolicy::Stochastic;
    const std::shared_ptr<const Package> original = packageOf(maskedRoom(), uber);
    ASSERT_NE(original, nullptr);
    RendererOptions options;
    options.strategy = package::kStrategyUber;
    options.width = setup_.width;
    options.height = setup_.height;
    struct Edit {
        const char* what;
        bool isRefused;
        void (*change)(materials::Material& leaf);
    };
    const Edit edits[] = {
        {"nothing", false, [](materials::Material&) {}},
        {"the colour", false, [](materials::Material& leaf) { leaf["baseColorFactor"][0] = 0.7F; }},
        {"the cutoff", true, [](materials::Material& leaf) { leaf["alphaCutoff"] = 0.3F; }},
        {"the factor", true, [](materials::Material& leaf) { leaf["baseColorFactor"][3] = 0.9F; }},
        {"the transform", true,
         [](materials::Material& leaf) {
             leaf.texture("baseColorTexture").transform.offset = {0.5F, 0.0F};
         }},
    };
    const gltf::Scene still = maskedRoom();
    for (const OpacityUse use : {OpacityUse::Proved, OpacityUse::Tested}) {
        scene_view::SceneViewData data = scene_view::makeSceneView(still);
        data.opacity = use;
        scene_view::useLayoutOf(*original, still, data);
        const Result<std::unique_ptr<GpuScene>> scene =
            GpuScene::upload(sharedContext(), *original, data.view());
        ASSERT_TRUE(scene) << toString(scene.error());
        const bool isDecided = use == OpacityUse::Proved;
        EXPECT_EQ((*scene)->statistics().provedOpaque, isDecided ? 2U : 0U);
        EXPECT_EQ((*scene)->statistics().provedTransparent, isDecided ? 2U : 0U);
        for (const Edit& edit : edits) {
            gltf::Scene edited = maskedRoom();
            edit.change(edited.materials[0]);
            const std::shared_ptr<const Package> package = packageOf(edited, uber);
            const std::unique_ptr<Renderer> renderer = make(*original, **scene, options);
            ASSERT_TRUE(package != nullptr && renderer != nullptr);
            const Result<PackageReplacement> replaced = renderer->replacePackage(package);
            if (!isDecided || !edit.isRefused) {
                EXPECT_TRUE(replaced) << edit.what << ": " << toString(replaced.error());
                continue;
            }
            ASSERT_FALSE(replaced) << edit.what;
            EXPECT_EQ(replaced.error().id, "scene-package") << edit.what;
            EXPECT_NE(replaced.error().message.find("proved"), std::string::npos)
                << edit.what << ": " << toString(replaced.error());
        }
    }
    expectNoValidationMessages();
}

TEST_F(ReplacePackage, AnEditableSceneKeepsItsPackage) {
    const std::shared_ptr<const Package> original = packageOf(*before_, settingsFor(package::kStrategyUber));
    scene_view::SceneViewData data = scene_view::makeSceneView(*before_);
    scene_view::useLayoutOf(*original, *before_, data);
    SceneView view = data.view();
    view.editable = true;
    const Result<std::unique_ptr<GpuScene>> scene = GpuScene::upload(sharedContext(), *original, view);
    ASSERT_TRUE(scene) << toString(scene.error());
    RendererOptions options;
    options.strategy = package::kStrategyUber;
    options.width = setup_.width;
    options.height = setup_.height;
    const std::unique_ptr<Renderer> renderer = make(*original, **scene, options);
    ASSERT_NE(renderer, nullptr);
    const LinearImage old = draw(*renderer);
    const Result<PackageReplacement> replaced = renderer->replacePackage(original);
    ASSERT_FALSE(replaced);
    EXPECT_EQ(replaced.error().id, "scene-package");
    expectEqualImage(draw(*renderer), old, "after the error");
    expectNoValidationMessages();
}

TEST_F(ReplacePackage, AnotherRendererOfTheSceneSaysThatItIsStale) {
    const compiler::CompileSettings uber = settingsFor(package::kStrategyUber);
    const std::shared_ptr<const Package> original = packageOf(*before_, uber);
    // Its records of materials have another size, so that they move to another buffer.
    const std::shared_ptr<const Package> extended = packageOf(extendedRoom(), uber);
    ASSERT_GT(extended->scene(0).materials.recordBytes, original->scene(0).materials.recordBytes);
    const std::unique_ptr<GpuScene> scene = upload(*before_, *original);
    RendererOptions options;
    options.strategy = package::kStrategyUber;
    options.width = setup_.width;
    options.height = setup_.height;
    const std::unique_ptr<Renderer> renderer = make(*original, *scene, options);
    const std::unique_ptr<Renderer> other = make(*original, *scene, options);
    ASSERT_TRUE(renderer->replacePackage(extended));
    draw(*other);
    const LinearImage image = draw(*renderer);
    expectEqualImage(image, fresh(extendedRoom(), *extended, options), "longer records");
    const Result<LinearImage> stale = other->render(setup_.frame);
    ASSERT_FALSE(stale);
    EXPECT_EQ(stale.error().id, "package-replaced");
    const std::unique_ptr<Renderer> anew = make(*extended, *scene, options);
    ASSERT_NE(anew, nullptr);
    expectEqualImage(draw(*anew), image, "made anew");
    expectNoValidationMessages();
}

// Values that the host has given stay, and the material's other values are the new package's.
TEST_F(ReplacePackage, ValuesOfTheHostStay) {
    const compiler::CompileSettings uber = settingsFor(package::kStrategyUber);
    const std::shared_ptr<const Package> original = packageOf(*before_, uber);
    gltf::Scene both = repaintedRoom();
    both.materials[2]["baseColorFactor"] = {0.2F, 0.9F, 0.2F, 1.0F};
    const std::shared_ptr<const Package> repainted = packageOf(both, uber);
    const MaterialTable table = original->scene(0).materials;
    const std::vector<std::uint8_t> kept(table.part(2, 1).bytes.begin(), table.part(2, 1).bytes.end());
    const MaterialView views[] = {{2, kept}};
    scene_view::SceneViewData data = scene_view::makeSceneView(*before_);
    scene_view::useLayoutOf(*original, *before_, data);
    SceneView view = data.view();
    view.materials = views;
    Result<std::unique_ptr<GpuScene>> scene = GpuScene::upload(sharedContext(), *original, view);
    ASSERT_TRUE(scene) << toString(scene.error());
    RendererOptions options;
    options.strategy = package::kStrategyUber;
    options.width = setup_.width;
    options.height = setup_.height;
    const std::unique_ptr<Renderer> renderer = make(*original, **scene, options);
    ASSERT_TRUE(renderer->replacePackage(repainted));
    const std::shared_ptr<const Package> wanted = packageOf(repaintedRoom(), uber);
    expectEqualImage(draw(*renderer), fresh(repaintedRoom(), *wanted, options), "the host's colour");
    expectNoValidationMessages();
}

}  // namespace
