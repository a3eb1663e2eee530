// An engine's scene whose content changes while frames are in flight, and RaySteps that replace their
// package.
#include "steps/engine_scene.h"

#include "base/files.h"
#include "context/commands.h"
#include "data/materials.h"
#include "gltf/material_set.h"
#include "materials/declarations.h"
#include "package/package.h"
#include "render/edited_scene.h"
#include "render/harness.h"
#include "render/replacement.h"
#include "render/scene_builder.h"
#include "scene/scene_store.h"
#include "support/must.h"
#include "support/temporary_folder.h"
#include "unit/gltf/block_files.h"

#include <glint/session/scene_view.h>
#include <glint/session/textures.h>
#include <glint/steps.h>

#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace glint;
using namespace glint::testing;

constexpr std::uint32_t kColumns = 24;
constexpr std::uint32_t kRows = 16;
constexpr std::uint32_t kRays = kColumns * kRows;
constexpr VkShaderStageFlags kStages = VK_SHADER_STAGE_ALL;

compiler::CompileSettings roomSteps() {
    compiler::CompileSettings settings = roomSettings(package::kStrategyUber | package::kStrategyHitShaders);
    settings.passes = package::Passes::Steps;
    settings.effects = {false, compiler::builtinEffects({"shadow"})};
    return settings;
}

// The room of replacement.h with two textured squares.
gltf::Scene texturedRoom() {
    gltf::Scene scene = roomScene();
    for (const float x : {-1.5F, 0.5F}) {
        materials::Material material = paint({0.9F, 0.9F, 0.9F});
        const bool isFirst = x < 0.0F;
        material.texture("baseColorTexture").texture =
            isFirst ? addTexture(scene, 2, 1, {255, 40, 40, 255, 40, 40, 255, 255})
                    : addTexture(scene, 1, 2, {40, 255, 40, 255, 200, 200, 40, 255});
        addQuad(scene, material, {x, -0.5F, -3.5F}, {1, 0, 0}, {0, 1, 0});
    }
    return scene;
}

// A scene that Glint has uploaded, and the same as an engine would have it.
struct Content {
    std::unique_ptr<GpuScene> gpu;
    std::vector<EngineScene::View::Geometry> geometries;
    std::vector<std::array<float, 12>> instances;
    std::vector<LightView> lights;
    std::vector<EngineScene::View::Texture> textures;
    std::vector<EngineScene::View::Sampler> samplers;

    EngineScene::View view() const {
        EngineScene::View view;
        view.geometries = geometries;
        view.instances = instances;
        view.lights = lights;
        view.textures = textures;
        view.samplers = samplers;
        return view;
    }
};

template <typename Change>
Content contentOf(const Package& package, const gltf::Scene& scene, const Change& change) {
    session::SceneViewData data = session::makeSceneView(scene);
    data.vertices = SceneView::VertexForm::Full;
    data.traversalOrder = SceneView::TraversalOrder::Input;  // an engine's triangles are in its own order
    change(data);
    const SceneView view = data.view();
    Content content;
    content.gpu = uploadScene(package, view);
    const GpuScene::State& state = content.gpu->state();
    for (std::uint32_t i = 0; i < state.store->geometries.count(); ++i) {
        const auto record = state.store->geometries.read<gpu::GeometryRecord>(i);
        const GeometryPlace place = *placeOf(state, i);
        content.geometries.push_back({place.mesh, place.primitive, record.instanceIndex, record.indices,
                                      record.positions, record.normals, record.tangents, record.texCoords0,
                                      record.texCoords1, record.colors, record.attributes});
    }
    for (const InstanceView& instance : view.instances) {
        content.instances.push_back(instance.objectToWorld);
    }
    content.lights = data.lights;
    const PackageScene known = package.scene(0);
    for (std::uint32_t i = 0; i < known.textures.size(); ++i) {
        const ImageView& image = view.images[known.textures[i].image];
        content.textures.push_back({i, image.width, image.height});
    }
    for (std::uint32_t i = 0; i < known.samplers.size(); ++i) {
        content.samplers.push_back({i, sharedContext().state().limits.samplerAnisotropy});
    }
    return content;
}

// An engine with two frames in flight, which asks for the light of the same rays in each.
class Engine {
public:
    explicit Engine(const GpuScene& like)
        : context_(sharedContext().state()), pool_(context_), frames_(sharedContext()) {
        const VkDescriptorSetLayout set = like.descriptorSetLayout();
        layout_ =
            must(createPipelineLayout(context_, std::span(&set, 1), {kStages, 0, RaySteps::kPushBytes}));
        rays_ = make(kRays * sizeof(RaySteps::Ray), MemoryUse::Upload);
        for (std::uint32_t i = 0; i < kRays; ++i) {
            const float x = (static_cast<float>(i % kColumns) + 0.5F) / kColumns - 0.5F;
            const float y = (static_cast<float>(i / kColumns) + 0.5F) / kRays * kColumns - 0.5F;
            const float length = std::sqrt(x * x + y * y + 1.0F);
            const RaySteps::Ray ray{{0, 0, 0}, i, {x / length, y / length, -1.0F / length}, 0.0F, 0.05F};
            std::memcpy(rays_.mapped + i * sizeof ray, &ray, sizeof ray);
        }
    }
    std::unique_ptr<RaySteps> makeSteps(const Package& package, EngineScene& scene,
                                        package::Strategy strategy) {
        RaySteps::Options options;
        options.strategy = strategy;
        options.tracer = strategy == package::kStrategyUber ? tracerOfDevice() : package::kTracerRayPipeline;
        options.maxRays = kRays;
        options.layout = layout_.get();
        options.pushStages = kStages;
        return must(RaySteps::create(sharedContext(), package, scene, options));
    }
    VkCommandBuffer begin() {
        return commands_ = frames_.begin();
    }
    std::uint64_t frame() const {
        return frames_.frame();
    }
    std::uint64_t completed() const {
        return frames_.completed();
    }
    // Records a batch over the structures and textures of a GpuScene. Its answers get the next number.
    Status ask(RaySteps& steps, const GpuScene& bound) {
        const VkDescriptorSet set = bound.descriptorSet();
        for (const VkPipelineBindPoint point :
             {VK_PIPELINE_BIND_POINT_COMPUTE, VK_PIPELINE_BIND_POINT_RAY_TRACING_KHR}) {
            context_.vk.CmdBindDescriptorSets(commands_, point, layout_.get(), 0, 1, &set, 0, nullptr);
        }
        answers_.push_back(make(kRays * sizeof(RaySteps::Radiance), MemoryUse::Readback));
        RaySteps::Batch batch;
        batch.rays = rays_.address;
        batch.rayCount = kRays;
        batch.answers = answers_.back().address;
        const Status status = steps.record(commands_, batch);
        recordDependency(context_, commands_,
                         {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT,
                          VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT});
        return status;
    }
    Buffer upload(std::span<const std::uint32_t> words) {
        Buffer buffer = make(words.size_bytes(), MemoryUse::Upload);
        std::memcpy(buffer.mapped, words.data(), words.size_bytes());
        return buffer;
    }
    void submit() {
        frames_.submit();
    }
    void drain() {
        frames_.drain();
    }
    std::vector<float> answers(std::size_t number) const {
        std::vector<float> values(kRays * sizeof(RaySteps::Radiance) / sizeof(float));
        std::memcpy(values.data(), answers_[number].mapped, values.size() * sizeof(float));
        return values;
    }
    // The answers by steps of their own over a scene that Glint has uploaded.
    std::vector<float> expected(const Package& package, GpuScene& scene, package::Strategy strategy) {
        auto shared = EngineScene::share(sharedContext(), scene);
        const auto steps = makeSteps(package, **shared, strategy);
        begin();
        EXPECT_TRUE(ask(*steps, scene));
        submit();
        drain();
        std::vector<float> found = answers(answers_.size() - 1);
        answers_.pop_back();
        return found;
    }

private:
    Buffer make(std::size_t bytes, MemoryUse use) {
        return must(createBuffer(context_, pool_, bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, use));
    }

    Context::State& context_;
    MemoryPool pool_;
    UniquePipelineLayout layout_;
    Buffer rays_;
    std::vector<Buffer> answers_;
    TwoFrames frames_;
    VkCommandBuffer commands_ = VK_NULL_HANDLE;
};

// The strategies that the device can run with steps of both kinds of shader binding tables.
std::vector<package::Strategy> strategiesOfDevice() {
    const bool hasPipelines = (sharedContext().handles().tracers & package::kTracerRayPipeline) != 0;
    return hasPipelines ? std::vector{package::kStrategyUber, package::kStrategyHitShaders}
                        : std::vector{package::kStrategyUber};
}

void keepAll(session::SceneViewData& /*data*/) {}

void expectOthers(const std::vector<float>& first, const std::vector<float>& second) {
    EXPECT_NE(first, second) << "the contents look alike";
}

// Fewer and more instances, geometries and lights, other textures and transforms.
TEST(EngineSceneContent, FramesInFlightKeepTheirs) {
    const gltf::Scene room = texturedRoom();
    const std::shared_ptr<const Package> package = packageOf(room, roomSteps());
    const Content small =
        contentOf(*package, room, [](session::SceneViewData& data) { data.instances.resize(2); });
    const Content large = contentOf(*package, room, [](session::SceneViewData& data) {
        for (int i = 0; i < 3; ++i) {
            InstanceView copy = data.instances.back();
            copy.objectToWorld[3] += 0.2F * static_cast<float>(i) - 1.0F;
            copy.objectToWorld[7] += 0.8F;
            data.instances.push_back(copy);
            LightView light;
            light.type = LightView::Type::Point;
            light.position = {static_cast<float>(i) - 1.0F, 0.5F, -2.0F};
            light.intensity = {1.0F, 0.5F, 0.2F};
            data.lights.push_back(light);
        }
    });
    const Content repainted = contentOf(
        *package, room, [](session::SceneViewData& data) { std::swap(data.images[0], data.images[1]); });
    ASSERT_TRUE(small.gpu != nullptr && large.gpu != nullptr && repainted.gpu != nullptr);
    for (const package::Strategy strategy : strategiesOfDevice()) {
        Engine engine(*small.gpu);
        const std::array wanted{engine.expected(*package, *small.gpu, strategy),
                                engine.expected(*package, *large.gpu, strategy),
                                engine.expected(*package, *repainted.gpu, strategy)};
        expectOthers(wanted[0], wanted[1]);
        expectOthers(wanted[1], wanted[2]);
        VkCommandBuffer commands = engine.begin();
        auto scene =
            must(EngineScene::record(sharedContext(), *package, small.view(), commands, engine.frame()));
        const std::uint64_t bytes = scene->bytes();
        const auto steps = engine.makeSteps(*package, *scene, strategy);
        std::vector<std::size_t> order{0};
        FinishedRecordings finished;
        ASSERT_TRUE(engine.ask(*steps, *small.gpu));
        engine.submit();
        const std::array contents{&small, &large, &repainted};
        for (const std::size_t next : {1U, 0U, 2U, 1U, 1U}) {
            commands = engine.begin();
            scene->complete(engine.completed());
            finished.completed(*steps, engine.completed());
            const Content& content = *contents[next];
            const bool isSame = order.back() == next;
            must(isSame ? scene->update(commands, content.instances, content.lights, engine.frame())
                        : scene->update(commands, *package, content.view(), engine.frame()));
            ASSERT_TRUE(engine.ask(*steps, *content.gpu));
            finished.recorded(*steps, engine.frame());
            engine.submit();
            order.push_back(next);
        }
        engine.drain();
        for (std::size_t i = 0; i < order.size(); ++i) {
            EXPECT_EQ(engine.answers(i), wanted[order[i]]) << "frame " << i;
        }
        EXPECT_GT(scene->bytes(), bytes);
        scene->complete(engine.completed());
        const Status refused = scene->update(VK_NULL_HANDLE, small.instances, {}, engine.frame());
        ASSERT_FALSE(refused) << "the geometries name more instances";
        EXPECT_EQ(refused.error().id, "engine-scene");
        EXPECT_EQ(scene->update(VK_NULL_HANDLE, large.instances, {}, 0).error().id, "engine-scene")
            << "the frame's number has fallen";
    }
}

// The room with another material, whose records are longer, and merged cases.
std::pair<gltf::Scene, compiler::CompileSettings> otherCompilation() {
    gltf::Scene scene = texturedRoom();
    scene.materials[kGlossy].give("KHR_materials_specular");
    scene.materials[kGlossy]["specularFactor"] = 0.25F;
    scene.materials[kGlossy]["baseColorFactor"] = {0.2F, 0.7F, 0.9F, 1.0F};
    compiler::CompileSettings settings = roomSteps();
    settings.plan.merge = compiler::MergePolicy::All;
    return {std::move(scene), settings};
}

// The host's values of a material are those of another scene, whose light is known. They stay in the longer
// records of another package.
TEST(EngineSceneContent, MaterialsHaveTheHostsValues) {
    const auto repaint = [](gltf::Scene scene) {
        scene.materials[kGlossy]["baseColorFactor"] = {0.1F, 0.9F, 0.3F, 1.0F};
        return scene;
    };
    const gltf::Scene room = texturedRoom();
    const auto [changed, settings] = otherCompilation();
    const std::shared_ptr<const Package> original = packageOf(room, roomSteps());
    const std::shared_ptr<const Package> other = packageOf(changed, settings);
    const std::shared_ptr<const Package> repainted = packageOf(repaint(room), roomSteps());
    const std::shared_ptr<const Package> otherRepainted = packageOf(repaint(changed), settings);
    const Content content = contentOf(*original, room, keepAll);
    const Content wanted = contentOf(*repainted, repaint(room), keepAll);
    const Content otherWanted = contentOf(*otherRepainted, repaint(changed), keepAll);
    ASSERT_TRUE(content.gpu != nullptr && wanted.gpu != nullptr && otherWanted.gpu != nullptr);
    const std::span<const std::uint8_t> record = repainted->scene(0).materials.part(kGlossy, 1).bytes;
    using Material = EngineScene::View::Material;
    const Material values[] = {{0, repainted->scene(0).materials.part(0, 1).bytes}, {kGlossy, record}};
    std::vector<EngineScene::View::Geometry> geometries = content.geometries;
    std::size_t named = 0;
    for (EngineScene::View::Geometry& geometry : geometries) {
        if (original->scene(0).findPrimitive(geometry.mesh, geometry.primitive)->materialIndex == kGlossy) {
            geometry.material = 1;
            ++named;
        }
    }
    ASSERT_GT(named, 0U);
    EngineScene::View view = content.view();
    view.geometries = geometries;
    view.materials = values;

    constexpr package::Strategy kUber = package::kStrategyUber;
    Engine engine(*content.gpu);
    const std::array light{engine.expected(*repainted, *wanted.gpu, kUber),
                           engine.expected(*otherRepainted, *otherWanted.gpu, kUber),
                           engine.expected(*original, *content.gpu, kUber)};
    expectOthers(light[0], light[2]);
    auto scene = must(EngineScene::record(sharedContext(), *original, view, engine.begin(), engine.frame()));
    const auto steps = engine.makeSteps(*original, *scene, kUber);
    ASSERT_TRUE(engine.ask(*steps, *content.gpu));
    ASSERT_TRUE(steps->replacePackage(other));
    ASSERT_TRUE(engine.ask(*steps, *content.gpu));
    ASSERT_TRUE(steps->replacePackage(original));
    engine.submit();
    const VkCommandBuffer commands = engine.begin();
    ASSERT_TRUE(scene->update(commands, *original, content.view(), engine.frame()));
    ASSERT_TRUE(engine.ask(*steps, *content.gpu));
    engine.submit();
    engine.drain();
    for (std::size_t i = 0; i < light.size(); ++i) {
        EXPECT_EQ(engine.answers(i), light[i]) << "batch " << i;
    }
    const auto refusal = [&](std::span<const Material> materials) {
        view.materials = materials;
        return scene->update(VK_NULL_HANDLE, *original, view, engine.frame()).error().id;
    };
    const Material unknown[] = {values[1], values[1], {99, record}};
    EXPECT_EQ(refusal(unknown), "scene-material");
    const Material shorter[] = {values[1], {kGlossy, record.first(8)}};
    EXPECT_EQ(refusal(shorter), "scene-material");
    EXPECT_EQ(refusal(std::span(values).first(1)), "engine-scene") << "a geometry names the second";
    const Material otherMaterial[] = {values[0], values[0]};
    EXPECT_EQ(refusal(otherMaterial), "engine-scene");
    const Material unused[] = {values[0], {}};
    EXPECT_EQ(refusal(unused), "engine-scene") << "a geometry names a number that is not in use";
}

// Records of a package's materials, in which a host sets textures of its own.
struct TexturedMaterials {
    TexturedMaterials(const Package& package, const Content& content) : known(package.scene(0)) {
        for (std::uint32_t i = 0; i < known.materials.size(); ++i) {
            const auto bytes = known.materials.part(i, 1).bytes;
            records.emplace_back(bytes.begin(), bytes.end());
            for (std::uint32_t slot = 0; slot < known.materials.textureCount; ++slot) {
                set(i, slot, content.textures, textureAt(known.materials, i, slot).textureIndex);
            }
        }
    }
    void set(std::uint32_t material, std::uint32_t slot, std::span<const EngineScene::View::Texture> textures,
             std::uint32_t texture) {
        gpu::TextureRecord record = textureAt(known.materials, material, slot);
        record.textureIndex = textures[texture].index;
        record.texels = {static_cast<float>(textures[texture].width),
                         static_cast<float>(textures[texture].height)};
        record.anisotropy = sharedContext().state().limits.samplerAnisotropy;
        std::memcpy(&records[material][placeOfTexture(known.materials, 0, slot)], &record, sizeof record);
    }
    EngineScene::View::Material of(std::uint32_t material) const {
        return {material, records[material], true};
    }

    PackageScene known;
    std::vector<std::vector<std::uint8_t>> records;
};

// Materials have the host's own textures, which change by one record at a time, and materials come and go by
// their numbers. Another package has the same textures, until its turn is over.
TEST(EngineSceneContent, MaterialsHaveTheHostsTextures) {
    const gltf::Scene room = texturedRoom();
    const auto [changed, settings] = otherCompilation();
    const std::shared_ptr<const Package> package = packageOf(room, roomSteps());
    const std::shared_ptr<const Package> other = packageOf(changed, settings);
    const Content content = contentOf(*package, room, keepAll);
    const auto swap = [](session::SceneViewData& data) { std::swap(data.images[0], data.images[1]); };
    const Content swapped = contentOf(*package, room, swap);
    const Content otherSwapped = contentOf(*other, changed, swap);
    ASSERT_EQ(content.textures.size(), 2U);
    // The last two materials are textured. Each gets the other's texture.
    const auto last = static_cast<std::uint32_t>(room.materials.size()) - 1;
    TexturedMaterials own(*package, content);
    const std::uint32_t slot = 0;
    ASSERT_EQ(package->scene(0).materials.textureCount, 1U);
    constexpr package::Strategy kUber = package::kStrategyUber;
    Engine engine(*content.gpu);
    const std::vector<float> before = engine.expected(*package, *content.gpu, kUber);
    const std::vector<float> after = engine.expected(*package, *swapped.gpu, kUber);
    const std::vector<float> otherAfter = engine.expected(*other, *otherSwapped.gpu, kUber);
    expectOthers(before, after);

    EngineScene::View view = content.view();
    std::vector<EngineScene::View::Geometry> geometries = content.geometries;
    for (EngineScene::View::Geometry& geometry : geometries) {
        const std::uint32_t material =
            package->scene(0).findPrimitive(geometry.mesh, geometry.primitive)->materialIndex;
        geometry.material = material + 1 >= last ? 7 + last - material : geometry.material;
    }
    view.geometries = geometries;
    std::vector<EngineScene::View::Material> materials(9);
    materials[7] = own.of(last);
    materials[8] = own.of(last - 1);
    view.materials = materials;
    VkCommandBuffer commands = engine.begin();
    auto scene = must(EngineScene::record(sharedContext(), *package, view, commands, engine.frame()));
    const auto steps = engine.makeSteps(*package, *scene, kUber);
    ASSERT_TRUE(engine.ask(*steps, *content.gpu));
    engine.submit();
    commands = engine.begin();
    own.set(last, slot, content.textures, textureAt(own.known.materials, last - 1, slot).textureIndex);
    own.set(last - 1, slot, content.textures, textureAt(own.known.materials, last, slot).textureIndex);
    must(scene->updateMaterial(commands, 7, own.of(last), engine.frame()));
    EXPECT_TRUE(scene->state().materials.dirty().empty());
    must(scene->updateMaterial(commands, 8, own.of(last - 1), engine.frame()));
    ASSERT_TRUE(engine.ask(*steps, *content.gpu));
    ASSERT_TRUE(steps->replacePackage(other));
    ASSERT_TRUE(engine.ask(*steps, *content.gpu));
    ASSERT_TRUE(steps->replacePackage(package));
    ASSERT_TRUE(engine.ask(*steps, *content.gpu));
    // Materials that no geometry names come and go.
    must(scene->updateMaterial(commands, 20, own.of(0), engine.frame()));
    must(scene->updateMaterial(commands, 20, own.of(1), engine.frame()));
    EXPECT_EQ(scene->state().materials.count(), last + 1 + 21);
    must(scene->updateMaterial(commands, 20, {}, engine.frame()));
    EXPECT_EQ(scene->state().materials.count(), last + 1 + 9);
    ASSERT_TRUE(engine.ask(*steps, *content.gpu));
    engine.submit();
    engine.drain();
    EXPECT_EQ(engine.answers(0), before);
    EXPECT_EQ(engine.answers(1), after);
    EXPECT_EQ(engine.answers(2), otherAfter);
    EXPECT_EQ(engine.answers(3), after);
    EXPECT_EQ(engine.answers(4), after);

    const auto refusal = [&](std::uint32_t number, const EngineScene::View::Material& material) {
        return mustFail(scene->updateMaterial(VK_NULL_HANDLE, number, material, engine.frame())).id;
    };
    EXPECT_EQ(refusal(7, {}), "engine-scene") << "a geometry names it";
    EXPECT_EQ(refusal(7, own.of(0)), "engine-scene") << "its geometry has another case";
    EXPECT_EQ(refusal(3, {99, own.records[0], true}), "scene-material");
    const EngineScene::View::Texture empty[] = {{0, 0, 0}};
    own.set(last, slot, empty, 0);
    EXPECT_EQ(refusal(7, own.of(last)), "scene-material") << "a texture without texels";
    gltf::Scene trusted = room;
    trusted.trustsTextures = true;
    const std::shared_ptr<const Package> trusting = packageOf(trusted, roomSteps());
    ASSERT_TRUE(trusting->trustTextures());
    EXPECT_EQ(mustFail(EngineScene::record(sharedContext(), *trusting, view, VK_NULL_HANDLE, 0)).id,
              "texture-trusted");
}

// Each triangle of a geometry names a material of the host's own.
TEST(EngineSceneContent, TrianglesHaveMaterialsOfTheirOwn) {
    const gltf::Scene room = roomScene();
    gltf::Scene painted = room;
    painted.materials[kGlossy]["baseColorFactor"] = {0.1F, 0.9F, 0.3F, 1.0F};
    const std::shared_ptr<const Package> package = packageOf(room, roomSteps());
    const std::shared_ptr<const Package> repainted = packageOf(painted, roomSteps());
    const Content content = contentOf(*package, room, keepAll);
    const Content wanted = contentOf(*repainted, painted, keepAll);
    const EngineScene::View::Material materials[] = {
        {kGlossy, package->scene(0).materials.part(kGlossy, 1).bytes},
        {kGlossy, repainted->scene(0).materials.part(kGlossy, 1).bytes}};
    for (const package::Strategy strategy : strategiesOfDevice()) {
        Engine engine(*content.gpu);
        const std::vector<float> first = engine.expected(*package, *content.gpu, strategy);
        const std::vector<float> second = engine.expected(*repainted, *wanted.gpu, strategy);
        // A list for each geometry and batch, in one buffer.
        constexpr std::uint32_t kBatches[][2] = {{0, 0}, {1, 1}, {0, 1}};
        std::vector<std::uint32_t> numbers;
        for (const auto& batch : kBatches) {
            numbers.insert(numbers.end(), std::begin(batch), std::end(batch));
        }
        const Buffer lists = engine.upload(numbers);
        std::unique_ptr<EngineScene> scene;
        std::unique_ptr<RaySteps> steps;
        for (std::uint32_t batch = 0; batch < std::size(kBatches); ++batch) {
            std::vector<EngineScene::View::Geometry> geometries = content.geometries;
            for (EngineScene::View::Geometry& geometry : geometries) {
                const auto* const entry = package->scene(0).findPrimitive(geometry.mesh, geometry.primitive);
                if (entry->materialIndex == kGlossy) {
                    geometry.primitiveMaterials = lists.address + batch * sizeof kBatches[0];
                }
            }
            EngineScene::View view = content.view();
            view.geometries = geometries;
            view.materials = materials;
            const VkCommandBuffer commands = engine.begin();
            if (batch == 0) {
                scene = must(EngineScene::record(sharedContext(), *package, view, commands, engine.frame()));
                steps = engine.makeSteps(*package, *scene, strategy);
            } else {
                must(scene->update(commands, *package, view, engine.frame()));
            }
            ASSERT_TRUE(engine.ask(*steps, *content.gpu));
            engine.submit();
        }
        engine.drain();
        EXPECT_EQ(engine.answers(0), first);
        EXPECT_EQ(engine.answers(1), second);
        const std::vector<float> mixed = engine.answers(2);
        std::array<std::size_t, 2> kept{};
        for (std::size_t i = 0; i < mixed.size(); ++i) {
            EXPECT_TRUE(mixed[i] == first[i] || mixed[i] == second[i]) << i;
            kept[0] += mixed[i] != second[i] ? 1 : 0;
            kept[1] += mixed[i] != first[i] ? 1 : 0;
        }
        EXPECT_GT(kept[0], 0U);
        EXPECT_GT(kept[1], 0U);
    }
}

// A model that emits what it reads of textures of each dimension and of a buffer.
constexpr const char* kProbe = R"json({
    "name": "probe", "extension": "EXT_probe", "stage": "base",
    "glsl": {"bsdf": "probe_surface.glsl", "model": "probe.glsl", "emission": "probe_surface.glsl",
             "after": ["emission"]},
    "replaces": {"object": "pbrMetallicRoughness"},
    "parameters": [{"name": "table", "type": "address"},
                   {"name": "color", "is": "baseColorFactor", "default": [1, 1, 1, 1]}],
    "textures": [{"name": "flat"}, {"name": "fog", "dimension": "3d"}, {"name": "pages", "dimension": "2d-array"},
                 {"name": "scene", "dimension": "cube"}],
    "effects": [{"does": "emits", "when": "doubleSided or not doubleSided"}]
})json";
constexpr const char* kProbeModel = R"(#include "bsdf/model.glsl"
struct Probe {
    float none;
};
void probePrepare(inout Probe model, vec3 view) {}
vec3 probeEvaluate(Probe model, vec3 view, vec3 l) {
    return vec3(0.0);
}
)";
constexpr const char* kProbeSurface = R"(#include "hit/surface_values.glsl"
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer ProbeTable { float values[]; };
void probeBsdf(Hit hit, Features features, inout SurfaceValues values, inout Surface surface) {
    surface.bsdf.layers.probe = Probe(0.0);
    surface.bsdf.diffuse = vec3(0.0);
}
void probeEmission(Hit hit, Features features, inout vec3 emitted) {
    emitted = vec3(0.0);
    if (GLINT_HAS_PROBE_SCENE(features)) {
        emitted.r = sampleCubeAt(hit, kProbeScene, hit.position, hit.edges).r;
    }
    if (GLINT_HAS_PROBE_FLAT(features) && GLINT_HAS_PROBE_PAGES(features)) {
        emitted.g = 0.5 + sampleArray(hit, kProbePages, features, 1.0).r - sampleSlot(hit, kProbeFlat, features).r;
        emitted.g += sampleArrayLevel(hit, kProbePages, vec2(0.5), 0.0, 1.0).r;
    }
    if (GLINT_HAS_PROBE_FOG(features)) {
        emitted.b = sampleVolumeLevel(hit, kProbeFog, vec3(0.5, 0.5, 0.75), 1.0).r;
    }
    uvec2 table = GLINT_MATERIAL_PROBE_TABLE(hit);
    if (table != uvec2(0u)) {
        emitted.b += ProbeTable(table).values[2];
    }
}
)";

// Levels of an image in which all texels of a level and a layer are equal: `valueOf` gives their red.
std::vector<std::uint8_t> levelsOf(const ImageView& image,
                                   const std::function<int(std::uint32_t, std::uint32_t)>& valueOf) {
    std::vector<std::uint8_t> pixels;
    for (std::uint32_t level = 0; level < image.levels; ++level) {
        for (std::uint32_t layer = 0; layer < image.layersAt(level); ++layer) {
            const auto value = static_cast<std::uint8_t>(valueOf(level, layer));
            // Both ends of a block of BC4 are the value.
            std::vector<std::uint8_t> block(infoOf(image.format).blockBytes, value);
            std::fill(block.begin() + 2, block.end(), std::uint8_t{0});
            for (std::uint64_t i = 0; i < bytesOfLevel(image.format, image.width, image.height, level);
                 i += block.size()) {
                pixels.insert(pixels.end(), block.begin(), block.end());
            }
        }
    }
    return pixels;
}

// Who gives the texels of the textures that materials name.
enum class TexelSource : std::uint8_t { Program, Texels, Blocks };

class TexturesOfAllDimensions : public ::testing::TestWithParam<TexelSource> {};

// An engine gives a cube, an array, a 3D texture and a buffer by its material alone. The textures are the
// engine's own, or those of KTX2 files that a list of materials names.
TEST_P(TexturesOfAllDimensions, MaterialsReadThemAndBuffers) {
    const test::TemporaryFolder folder;
    for (const auto& [file, text] : {std::pair{"probe.json", kProbe},
                                     {"probe.glsl", kProbeModel},
                                     {"probe_surface.glsl", kProbeSurface}}) {
        ASSERT_TRUE(base::writeFile(folder.path() / file, std::string(text)));
    }
    gltf::ImportOptions options;
    options.materialModel = must(materials::loadMaterialModel(std::vector{folder.path().string()}));
    const bool isOfFiles = GetParam() != TexelSource::Program;
    const TexelFormat format = GetParam() == TexelSource::Blocks ? TexelFormat::Bc4 : TexelFormat::Rgba8;
    using Dimension = ImageView::Dimension;
    std::vector<ImageView> images{{.width = 32, .height = 32, .pixels = {}, .format = format, .levels = 6},
                                  {.width = 4,
                                   .height = 4,
                                   .pixels = {},
                                   .format = format,
                                   .levels = 2,
                                   .dimension = Dimension::Volume,
                                   .layers = 4},
                                  {.width = 32,
                                   .height = 32,
                                   .pixels = {},
                                   .format = format,
                                   .levels = 6,
                                   .dimension = Dimension::Array,
                                   .layers = 2},
                                  {.width = 64,
                                   .height = 64,
                                   .pixels = {},
                                   .format = format,
                                   .levels = 7,
                                   .dimension = Dimension::Cube,
                                   .layers = 6}};
    const std::function<int(std::uint32_t, std::uint32_t)> values[] = {
        [](std::uint32_t level, std::uint32_t) { return 250 - 40 * static_cast<int>(level); },
        [](std::uint32_t level, std::uint32_t slice) { return static_cast<int>(100 * level + 51 * slice); },
        // The first layer has 1 / 5 at level 1, the second is the flat texture.
        [](std::uint32_t level, std::uint32_t layer) {
            return layer == 0 ? static_cast<int>(51 * level) : 250 - 40 * static_cast<int>(level);
        },
        // The face -Z has a value that grows with the level.
        [](std::uint32_t level, std::uint32_t face) {
            return face == 5 ? 40 * static_cast<int>(level) : 255;
        }};
    gltf::MaterialDescription listed{.name = "probe", .model = "probe"};
    std::vector<std::vector<std::uint8_t>> pixels;
    for (std::size_t i = 0; i < images.size(); ++i) {
        constexpr const char* kNames[] = {"flat", "fog", "pages", "scene"};
        constexpr test::Ktx2Layers kLayers[] = {{}, {.depth = 4}, {.layers = 2}, {.faces = 6}};
        pixels.push_back(levelsOf(images[i], values[i]));
        images[i].pixels = pixels.back();
        gltf::TextureDescription& texture = listed.textures[kNames[i]];
        if (isOfFiles) {
            texture.file = std::string(kNames[i]) + ".ktx2";
            const std::uint32_t vkFormat = format == TexelFormat::Bc4 ? 139 : 37;
            ASSERT_TRUE(base::writeFile(folder.path() / texture.file,
                                        test::makeKtx2(vkFormat, format, images[i].width, images[i].height,
                                                       images[i].levels, pixels.back(), kLayers[i])));
        }
    }
    options.decodeImages = !isOfFiles;
    options.keepImageFiles = isOfFiles;
    const gltf::Scene list =
        must(gltf::importMaterials({(folder.path() / "list").string(), {listed}}, options));
    gltf::Scene scene = sceneWithCamera();
    scene.images = list.images;
    scene.textures = list.textures;
    scene.samplers = list.samplers;
    addQuad(scene, list.materials[0], {-4, -4, -4}, {8, 0, 0}, {0, 8, 0});
    compiler::CompileSettings settings = roomSteps();
    settings.effects = {false, {}};
    const std::shared_ptr<const Package> package = packageOf(scene, settings);

    const auto textures = must(
        session::loadTextures(scene, {.fit = {.formats = sharedContext().texelFormats()}, .threads = 1}));
    for (std::size_t i = 0; isOfFiles && i < images.size(); ++i) {
        EXPECT_EQ(textures->images[i].texels, pixels[i]);
        EXPECT_EQ(textures->images[i].format, format);
    }
    const Content content = contentOf(*package, scene, [&](session::SceneViewData& data) {
        data.images = images;
        if (isOfFiles) {
            session::useTextures(textures, data);
        }
    });

    // The material of the engine's own has the bytes of a record with its textures and the address.
    TexturedMaterials own(*package, content);
    Engine engine(*content.gpu);
    const float numbers[] = {1.0F, 2.0F, 8.0F};
    std::vector<std::uint32_t> words(std::size(numbers));
    std::memcpy(words.data(), numbers, sizeof numbers);
    const Buffer table = engine.upload(words);
    const RecordFields fields = recordFields(*package, own.known);
    const RecordField* const field = fields.find("probeTable", fields.modelOf(0));
    ASSERT_TRUE(field != nullptr && field->bytes == sizeof table.address);
    EngineScene::View::Geometry geometry = content.geometries.at(0);
    geometry.material = 0;
    EngineScene::View::Material material = own.of(0);
    EngineScene::View view = content.view();
    view.geometries = {&geometry, 1};
    view.materials = {&material, 1};
    VkCommandBuffer commands = engine.begin();
    const auto engineScene =
        must(EngineScene::record(sharedContext(), *package, view, commands, engine.frame()));
    const auto steps = engine.makeSteps(*package, *engineScene, package::kStrategyUber);
    ASSERT_TRUE(engine.ask(*steps, *content.gpu));
    std::memcpy(&own.records[0][field->offset], &table.address, sizeof table.address);
    must(engineScene->updateMaterial(commands, 0, own.of(0), engine.frame()));
    ASSERT_TRUE(engine.ask(*steps, *content.gpu));
    engine.submit();
    engine.drain();
    for (const std::size_t batch : {0U, 1U}) {
        const std::vector<float> answers = engine.answers(batch);
        for (std::uint32_t i = 0; i < kRays; ++i) {
            const float x = 4.0F * ((static_cast<float>(i % kColumns) + 0.5F) / kColumns - 0.5F);
            const float y = 4.0F * ((static_cast<float>(i / kColumns) + 0.5F) / kRays * kColumns - 0.5F);
            const float distance = std::sqrt(x * x + y * y + 16.0F);
            // The footprint's axes are the cone's width, and that over the cosine. In the direction of the
            // plane, at distance 4, a metre has 8 of the face's 64 texels.
            const float width = 0.05F * distance;
            const float texels = width * width * (distance / 4.0F) * (8.0F * 8.0F);
            const float level = std::max(0.5F * std::log2(texels), 0.0F);
            SCOPED_TRACE(i);
            ASSERT_NEAR(answers[4 * i], 40.0F * level / 255.0F, 2e-3F);
            ASSERT_NEAR(answers[4 * i + 1], 0.5F + 0.2F, 1e-5F);
            ASSERT_NEAR(answers[4 * i + 2], (100.0F + 51.0F) / 255.0F + (batch == 1 ? 8.0F : 0.0F), 1e-5F);
        }
    }

    // An image that is declared as a cube must be one.
    session::SceneViewData data = session::makeSceneView(scene);
    data.images = images;
    data.images[3] = {1, 1, kWhiteTexel};
    const Diagnostic refused = mustFail(GpuScene::upload(sharedContext(), *package, data.view()));
    EXPECT_EQ(refused.id, "texture-dimension");
    EXPECT_EQ(refused.message, "the texture is 2D, and the package's shaders read a cube");
    // Neither can an edit make it anything else.
    const auto edited = uploadScene(*package, scene, [&](SceneView& edits) {
        edits.images = images;
        edits.editable = true;
    });
    SceneEditor& editor = *edited->editor();
    const PackageScene known = package->scene(0);
    const std::uint32_t slot = (fields.find("probeScene", fields.modelOf(0))->offset -
                                static_cast<std::uint32_t>(placeOfTexture(known.materials, 0, 0))) /
                               static_cast<std::uint32_t>(sizeof(gpu::TextureRecord));
    const TextureHandle cube = editor.texture(textureAt(known.materials, 0, slot).textureIndex);
    EXPECT_EQ(mustFail(editor.replaceTexture(cube, {1, 1, kWhiteTexel})).id, "texture-dimension");
    const TextureHandle white = must(editor.addTexture({1, 1, kWhiteTexel}, false));
    const SceneEditor::MaterialKey key{kAttributeNormals | kAttributeTexCoords0, known.primitives[0].key,
                                       known.primitives[0].key};
    for (const TextureHandle texture : {cube, white}) {
        const SceneEditor::TextureUse use{slot, texture};
        const auto added = editor.addMaterial({known.materials.part(0, 1).bytes, {&key, 1}, {&use, 1}});
        EXPECT_EQ(added ? "" : added.error().id, texture == cube ? "" : "texture-dimension");
    }
}

INSTANTIATE_TEST_SUITE_P(Texels, TexturesOfAllDimensions,
                         ::testing::Values(TexelSource::Program, TexelSource::Texels, TexelSource::Blocks),
                         [](const auto& one) {
                             return one.param == TexelSource::Program  ? "OfTheProgram"
                                    : one.param == TexelSource::Texels ? "OfFiles"
                                                                       : "OfFilesInBlocks";
                         });

// The room with two lamps of two triangles, which are instances of one mesh, and lights with a size.
gltf::Scene roomWithLamps() {
    gltf::Scene scene = roomScene();
    materials::Material lamp = paint({0, 0, 0});
    lamp["emissiveFactor"] = {1.0F, 0.75F, 0.5F};
    lamp["emissiveStrength"] = 4.0F;
    addQuad(scene, lamp, {-1, 2, -4}, {1, 0, 0}, {0, 0, 1});
    const int mesh = static_cast<int>(scene.meshes.size()) - 1;
    gltf::Matrix4 aside = scaling(1, 1, 1);
    aside[12] = 2.0;
    addInstance(scene, mesh, aside);
    return scene;
}

compiler::CompileSettings lampSteps(std::uint32_t lights) {
    compiler::CompileSettings settings = roomSteps();
    settings.strategies = package::kStrategyUber;
    settings.plan.merge = compiler::MergePolicy::All;
    settings.maxBounces = 2;
    settings.lightSamples = lights;
    settings.emissiveLights = compiler::EmissiveLights::On;
    settings.sizedLights = compiler::SizedLights::On;
    return settings;
}

void addSizedLights(session::SceneViewData& data) {
    for (const LightView::Type type : {LightView::Type::Point, LightView::Type::Disk}) {
        LightView light;
        light.type = type;
        light.position = {type == LightView::Type::Point ? -2.0F : 2.0F, 1.0F, -3.0F};
        light.direction = {0, -1, 0};
        light.intensity = {1.0F, 2.0F, 3.0F};
        light.size = 0.3F;
        data.lights.push_back(light);
    }
}

// Gives the corners of the lamps' triangles, as makeQuad() has them.
void giveCorners(Content& content, const Package& package, const gltf::Scene& scene,
                 std::vector<std::array<float, 3>>& corners) {
    const auto isLamp = [&](const EngineScene::View::Geometry& geometry) {
        const auto* const entry = package.scene(0).findPrimitive(geometry.mesh, geometry.primitive);
        return (entry->geometryFlags & gpu::kGeometryEmitter) != 0;
    };
    for (EngineScene::View::Geometry& geometry : content.geometries) {
        if (!isLamp(geometry)) {
            continue;
        }
        const gltf::Primitive& quad = scene.meshes[geometry.mesh].primitives[geometry.primitive];
        if (corners.empty()) {
            for (const std::uint32_t index : quad.indices) {
                corners.push_back(quad.positions[index]);
            }
        }
        geometry.lightCorners = corners;
    }
}

double meanOfAnswers(const std::vector<float>& answers) {
    double sum = 0.0;
    for (const float value : answers) {
        sum += static_cast<double>(value);
    }
    return sum / static_cast<double>(answers.size());
}

// The list of triangles and the hierarchy are those of the same scene that Glint has uploaded. They
// follow transforms, values of materials and another package.
TEST(EngineSceneLights, AreThoseOfGlintsOwnScene) {
    const gltf::Scene room = roomWithLamps();
    gltf::Scene bright = room;
    const std::size_t lamp = room.materials.size() - 1;
    bright.materials[lamp]["emissiveStrength"] = 12.0F;
    const auto move = [](session::SceneViewData& data) {
        addSizedLights(data);
        data.instances.back().objectToWorld[3] += 0.5F;
        data.instances.back().objectToWorld[7] -= 0.5F;
    };
    for (const std::uint32_t lights : {0U, 2U}) {
        SCOPED_TRACE(lights);
        const std::shared_ptr<const Package> package = packageOf(room, lampSteps(lights));
        const std::shared_ptr<const Package> brighter = packageOf(bright, lampSteps(lights));
        ASSERT_TRUE(package != nullptr && package->emission() != nullptr);
        Content content = contentOf(*package, room, addSizedLights);
        const Content moved = contentOf(*package, room, move);
        const Content brightened = contentOf(*brighter, bright, move);
        Engine engine(*content.gpu);
        constexpr package::Strategy kUber = package::kStrategyUber;
        const std::vector<float> first = engine.expected(*package, *content.gpu, kUber);
        const std::vector<float> second = engine.expected(*package, *moved.gpu, kUber);
        const std::vector<float> third = engine.expected(*brighter, *brightened.gpu, kUber);
        expectOthers(first, second);
        expectOthers(second, third);

        std::vector<std::array<float, 3>> corners;
        EngineScene::View view = content.view();
        VkCommandBuffer commands = engine.begin();
        auto scene = must(EngineScene::record(sharedContext(), *package, view, commands, engine.frame()));
        const auto steps = engine.makeSteps(*package, *scene, kUber);
        ASSERT_TRUE(engine.ask(*steps, *content.gpu));  // 0: without corners
        giveCorners(content, *package, room, corners);
        const EngineScene::View::Material own{static_cast<std::uint32_t>(lamp),
                                              package->scene(0).materials.part(lamp, 1).bytes};
        for (EngineScene::View::Geometry& geometry : content.geometries) {
            geometry.material = geometry.lightCorners.empty() ? geometry.material : 0;
        }
        view = content.view();
        view.materials = std::span(&own, 1);
        must(scene->update(commands, *package, view, engine.frame()));
        ASSERT_TRUE(engine.ask(*steps, *content.gpu));  // 1
        engine.submit();
        engine.drain();
        commands = engine.begin();
        must(scene->update(commands, moved.instances, moved.lights, engine.frame()));
        ASSERT_TRUE(engine.ask(*steps, *moved.gpu));  // 2
        must(scene->updateMaterial(
            commands, 0, {own.material, brighter->scene(0).materials.part(lamp, 1).bytes}, engine.frame()));
        ASSERT_TRUE(engine.ask(*steps, *moved.gpu));  // 3
        engine.submit();
        engine.drain();
        commands = engine.begin();
        view.instances = moved.instances;
        must(scene->update(commands, *package, view, engine.frame()));
        ASSERT_TRUE(engine.ask(*steps, *moved.gpu));  // 4: built anew
        ASSERT_TRUE(steps->replacePackage(brighter));
        ASSERT_TRUE(engine.ask(*steps, *moved.gpu));  // 5: the host's values stay
        engine.submit();
        engine.drain();
        // Without corners, paths find the same light by chance.
        expectOthers(engine.answers(0), first);
        EXPECT_NEAR(meanOfAnswers(engine.answers(0)) / meanOfAnswers(first), 1.0, 0.05);
        EXPECT_EQ(engine.answers(1), first);
        EXPECT_EQ(engine.answers(4), second);
        EXPECT_EQ(engine.answers(5), second);
        if (lights == 0) {
            EXPECT_EQ(engine.answers(2), second);
            EXPECT_EQ(engine.answers(3), third);
        } else {  // the hierarchy keeps its order
            EXPECT_NEAR(meanOfAnswers(engine.answers(2)) / meanOfAnswers(second), 1.0, 0.1);
            EXPECT_NEAR(meanOfAnswers(engine.answers(3)) / meanOfAnswers(third), 1.0, 0.1);
        }
        corners.pop_back();
        for (EngineScene::View::Geometry& geometry : content.geometries) {
            geometry.lightCorners = geometry.lightCorners.empty() ? geometry.lightCorners : corners;
        }
        view.geometries = content.geometries;
        EXPECT_EQ(mustFail(scene->update(VK_NULL_HANDLE, *package, view, engine.frame())).id, "engine-scene");
    }
}

// Two lamps that show the bright and the dark half of a texture: with the means of their texels the hierarchy
// is that of Glint's own scene, and without them the light is the same but for noise.
TEST(EngineSceneLights, TexelsGuideTheHierarchy) {
    gltf::Scene room = roomScene();
    materials::Material lamp = paint({0, 0, 0});
    lamp["emissiveFactor"] = {1.0F, 1.0F, 1.0F};
    lamp["emissiveStrength"] = 4.0F;
    std::vector<std::uint8_t> texels;
    for (int x = 0; x < 16; ++x) {
        texels.insert(texels.end(), 4, x < 8 ? 255 : 60);
    }
    lamp.texture("emissiveTexture").texture = addTexture(room, 16, 1, texels);
    constexpr std::array<float, 2> kLeft{0.125F, 0.625F};
    for (const float left : kLeft) {
        addQuad(room, lamp, {4.0F * left - 1.5F, 2, -4}, {1, 0, 0}, {0, 0, 1});
        for (gltf::Float2& place : room.meshes.back().primitives[0].texCoords0) {
            place[0] = left + 0.25F * place[0];
        }
    }
    const std::shared_ptr<const Package> package = packageOf(room, lampSteps(2));
    ASSERT_TRUE(package != nullptr && package->emission() != nullptr);
    Content content = contentOf(*package, room, addSizedLights);
    Engine engine(*content.gpu);
    const std::vector<float> expected = engine.expected(*package, *content.gpu, package::kStrategyUber);
    ImageView image;
    image.width = 16;
    image.height = 1;
    image.pixels = texels;
    const EmissionTexels known(image, true);
    std::vector<std::array<float, 3>> corners[2];
    float means[2] = {};
    for (std::size_t i = 0; i < 2; ++i) {
        const TexelBox box{{kLeft[i], 0.0}, {kLeft[i] + 0.25, 1.0}};
        means[i] = static_cast<float>(known.mean(box, 0, 0));
        const gltf::Primitive& quad = room.meshes[room.meshes.size() - 2 + i].primitives[0];
        for (const std::uint32_t index : quad.indices) {
            corners[i].push_back(quad.positions[index]);
        }
        for (EngineScene::View::Geometry& geometry : content.geometries) {
            if (geometry.mesh == room.meshes.size() - 2 + i) {
                geometry.lightCorners = corners[i];
                geometry.lightTexels = std::span(&means[i], 1);
            }
        }
    }
    EXPECT_GT(means[0], 10.0F * means[1]);
    const auto scene = must(EngineScene::create(sharedContext(), *package, content.view()));
    const auto steps = engine.makeSteps(*package, *scene, package::kStrategyUber);
    VkCommandBuffer commands = engine.begin();
    ASSERT_TRUE(engine.ask(*steps, *content.gpu));  // 0
    engine.submit();
    engine.drain();
    commands = engine.begin();
    for (EngineScene::View::Geometry& geometry : content.geometries) {
        geometry.lightTexels = {};
    }
    must(scene->update(commands, *package, content.view(), engine.frame()));
    ASSERT_TRUE(engine.ask(*steps, *content.gpu));  // 1
    engine.submit();
    engine.drain();
    EXPECT_EQ(engine.answers(0), expected);
    expectOthers(engine.answers(1), expected);
    EXPECT_NEAR(meanOfAnswers(engine.answers(1)) / meanOfAnswers(expected), 1.0, 0.1);
    for (EngineScene::View::Geometry& geometry : content.geometries) {
        geometry.lightTexels = geometry.lightCorners.empty() ? geometry.lightTexels : std::span(means, 2);
    }
    means[1] = -1.0F;
    EXPECT_EQ(mustFail(scene->update(VK_NULL_HANDLE, *package, content.view(), engine.frame())).id,
              "engine-scene");
}

// A package that knows no disks gets none, by whatever call, and a call that is refused changes nothing.
TEST(EngineSceneLights, DisksNeedAPackageThatKnowsThem) {
    compiler::CompileSettings settings = roomSteps();
    settings.strategies = package::kStrategyUber;
    const gltf::Scene room = roomScene();
    const std::shared_ptr<const Package> knowing = packageOf(room, settings);
    settings.diskLights = compiler::DiskLights::Off;
    const std::shared_ptr<const Package> package = packageOf(room, settings);
    const Content content = contentOf(*package, room, keepAll);
    std::vector<LightView> disks = content.lights;
    disks.emplace_back().type = LightView::Type::Disk;
    EngineScene::View view = content.view();
    Engine engine(*content.gpu);
    const std::vector<float> wanted = engine.expected(*package, *content.gpu, package::kStrategyUber);
    VkCommandBuffer commands = engine.begin();
    auto scene = must(EngineScene::record(sharedContext(), *package, view, commands, engine.frame()));
    const auto steps = engine.makeSteps(*package, *scene, package::kStrategyUber);
    view.lights = disks;
    EXPECT_EQ(mustFail(EngineScene::create(sharedContext(), *package, view)).id, "scene-light");
    EXPECT_EQ(mustFail(scene->update(commands, *package, view, engine.frame())).id, "scene-light");
    EXPECT_EQ(mustFail(scene->update(commands, content.instances, disks, engine.frame())).id, "scene-light");
    ASSERT_TRUE(engine.ask(*steps, *content.gpu));
    engine.submit();
    engine.drain();
    EXPECT_EQ(engine.answers(0), wanted);
    // Disks that are there keep such a package out.
    must(scene->update(engine.begin(), *knowing, view, engine.frame()));
    must(steps->replacePackage(knowing));
    ASSERT_TRUE(engine.ask(*steps, *content.gpu));
    engine.submit();
    engine.drain();
    EXPECT_EQ(mustFail(steps->replacePackage(package)).id, "scene-light");
}

TEST(RayStepsReplacement, BatchesUseTheNewPackageAtOnce) {
    const gltf::Scene room = texturedRoom();
    const auto [changed, settings] = otherCompilation();
    const std::shared_ptr<const Package> original = packageOf(room, roomSteps());
    const std::shared_ptr<const Package> other = packageOf(changed, settings);
    ASSERT_TRUE(original != nullptr && other != nullptr);
    ASSERT_NE(original->scene(0).materials.recordBytes, other->scene(0).materials.recordBytes);
    const Content content = contentOf(*original, room, keepAll);
    const Content after = contentOf(*other, changed, keepAll);
    ASSERT_TRUE(content.gpu != nullptr && after.gpu != nullptr);
    for (const package::Strategy strategy : strategiesOfDevice()) {
        Engine engine(*content.gpu);
        const std::array wanted{engine.expected(*original, *content.gpu, strategy),
                                engine.expected(*other, *after.gpu, strategy)};
        expectOthers(wanted[0], wanted[1]);
        const VkCommandBuffer commands = engine.begin();
        auto scene =
            must(EngineScene::record(sharedContext(), *original, content.view(), commands, engine.frame()));
        const auto steps = engine.makeSteps(*original, *scene, strategy);
        const auto second = engine.makeSteps(*original, *scene, strategy);
        ASSERT_TRUE(steps != nullptr && second != nullptr);
        std::vector<std::size_t> order;
        FinishedRecordings finished;
        for (const std::size_t number : {0U, 0U, 1U, 1U, 0U, 1U}) {
            if (!order.empty()) {
                engine.begin();
                scene->complete(engine.completed());
                finished.completed(*steps, engine.completed());
            }
            const bool switches = !order.empty() && order.back() != number;
            if (switches) {
                const auto replaced = must(steps->replacePackage(number == 0 ? original : other));
                EXPECT_TRUE(steps->replacementProgress().ready);
            }
            // The second one switches with the first.
            ASSERT_TRUE(engine.ask(*steps, *content.gpu));
            ASSERT_TRUE(engine.ask(*second, *content.gpu));
            order.push_back(number);
            finished.recorded(*steps, engine.frame());
            order.push_back(number);
            engine.submit();
        }
        EXPECT_EQ(steps->replacementProgress().inUse, 3U);
        engine.drain();
        for (std::size_t i = 0; i < order.size(); ++i) {
            EXPECT_EQ(engine.answers(i), wanted[order[i]]) << "batch " << i;
        }
        // Answers of another kind do not fit the engine's buffer.
        compiler::CompileSettings unlike = settings;
        unlike.answer = package::HitAnswer::Surface;
        EXPECT_EQ(mustFail(steps->replacePackage(packageOf(changed, unlike))).id, "ray-steps");
    }
}

// A scene that Glint has uploaded is shared by RaySteps and a Renderer. Whichever gets its package first,
// both go on with the packages before, while a frame is in flight, until the other has one of the same
// compilation.
TEST(RayStepsReplacement, ARendererOfTheSceneSwitchesTogetherWithThem) {
    const gltf::Scene room = texturedRoom();
    const auto [changed, settings] = otherCompilation();
    compiler::CompileSettings frames = roomSteps();
    frames.passes = package::Passes::Frame;
    compiler::CompileSettings otherFrames = frames;
    otherFrames.plan.merge = settings.plan.merge;
    const std::array ofSteps{packageOf(room, roomSteps()), packageOf(changed, settings)};
    const std::array ofFrames{packageOf(room, frames), packageOf(changed, otherFrames)};
    gltf::Scene painted = room;
    painted.materials[kGlossy]["baseColorFactor"] = {0.1F, 0.8F, 0.9F, 1.0F};
    const std::shared_ptr<const Package> repainted = packageOf(painted, roomSteps());
    const Content after = contentOf(*ofSteps[1], changed, keepAll);
    for (const bool editable : {false, true}) {
        const auto scene = uploadScene(*ofSteps[0], room, [&](SceneView& view) { view.editable = editable; });
        ASSERT_TRUE(scene != nullptr && after.gpu != nullptr);
        Engine engine(*scene);
        const std::array wanted{engine.expected(*ofSteps[0], *scene, package::kStrategyUber),
                                Engine(*after.gpu).expected(*ofSteps[1], *after.gpu, package::kStrategyUber)};
        auto shared = EngineScene::share(sharedContext(), *scene);
        auto steps = engine.makeSteps(*ofSteps[0], **shared, package::kStrategyUber);
        RendererOptions options;
        options.width = options.height = 16;
        options.strategy = package::kStrategyUber;
        const auto renderer = makeRenderer(*ofFrames[0], *scene, options);
        ASSERT_TRUE(steps != nullptr && renderer != nullptr);
        const FrameOptions frame = defaultSetup(room, 16, 16).frame;
        const LinearImage before = drawn(*renderer, frame);
        std::vector<std::size_t> order;
        FinishedRecordings finishedSteps;
        FinishedRecordings finishedFrames;
        // Records a batch and a frame behind the one that is in flight.
        const auto go = [&](std::size_t package) {
            const VkCommandBuffer commands = engine.begin();
            finishedSteps.completed(*steps, engine.completed());
            finishedFrames.completed(*renderer, engine.completed());
            const Status asked = engine.ask(*steps, *scene);
            EXPECT_TRUE(asked) << (asked ? "" : toString(asked.error()));
            const Status recorded = renderer->record(commands, frame);
            EXPECT_TRUE(recorded) << (recorded ? "" : toString(recorded.error()));
            finishedSteps.recorded(*steps, engine.frame());
            finishedFrames.recorded(*renderer, engine.frame());
            engine.submit();
            order.push_back(package);
        };
        go(0);
        ASSERT_TRUE(renderer->replacePackage(ofFrames[1]));
        EXPECT_TRUE(renderer->replacementProgress().pending && !renderer->replacementProgress().ready);
        go(0);
        ASSERT_TRUE(steps->replacePackage(ofSteps[1]));
        EXPECT_TRUE(renderer->replacementProgress().ready && steps->replacementProgress().ready);
        go(1);
        go(1);
        const LinearImage image = drawn(*renderer, frame);
        EXPECT_TRUE(differ(image, before));
        // And back, by the steps first.
        ASSERT_TRUE(steps->replacePackage(ofSteps[0]));
        EXPECT_FALSE(steps->replacementProgress().ready);
        go(1);
        EXPECT_FALSE(differ(drawn(*renderer, frame), image));
        ASSERT_TRUE(renderer->replacePackage(ofFrames[0]));
        EXPECT_FALSE(differ(drawn(*renderer, frame), before));
        go(0);
        EXPECT_EQ(renderer->replacementProgress().inUse, 2U);
        EXPECT_EQ(steps->replacementProgress().inUse, 2U);
        // A package that is withdrawn changes nothing, and one waits no longer for steps that are gone.
        ASSERT_TRUE(renderer->replacePackage(ofFrames[1]));
        const std::vector<std::string> reasons = renderer->replacementProgress().waitsFor;
        ASSERT_EQ(reasons.size(), 1U);
        EXPECT_TRUE(reasons[0].starts_with("RaySteps 1 of the scene needs a package")) << reasons[0];
        renderer->withdrawPackage();
        EXPECT_FALSE(renderer->replacementProgress().pending);
        EXPECT_FALSE(differ(drawn(*renderer, frame), before));
        // Other values of materials alone are those of both at once.
        ASSERT_TRUE(steps->replacePackage(repainted));
        EXPECT_TRUE(steps->replacementProgress().ready);
        engine.begin();
        ASSERT_TRUE(engine.ask(*steps, *scene));
        engine.submit();
        engine.drain();
        EXPECT_TRUE(differ(drawn(*renderer, frame), before));
        EXPECT_NE(engine.answers(order.size()), wanted[0]);
        for (std::size_t i = 0; i < order.size(); ++i) {
            EXPECT_EQ(engine.answers(i), wanted[order[i]]) << "batch " << i;
        }
        ASSERT_TRUE(renderer->replacePackage(ofFrames[1]));
        EXPECT_FALSE(renderer->replacementProgress().ready);
        steps.reset();
        EXPECT_TRUE(renderer->replacementProgress().ready);
        EXPECT_FALSE(differ(drawn(*renderer, frame), image));
        EXPECT_EQ(renderer->replacementProgress().inUse, 3U);
    }
}

}  // namespace
