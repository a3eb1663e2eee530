#include "render/edited_scene.h"

#include "context/context.h"
#include "render/scene_builder.h"
#include "resolve/resolve.h"
#include "support/must.h"
#include "support/shared_modules.h"

#include <glint/session/session.h>

#include <algorithm>
#include <cstring>
#include <iterator>
#include <limits>
#include <utility>

namespace glint::testing {
namespace {

std::vector<std::uint8_t> chequers(int size, std::uint8_t dark) {
    std::vector<std::uint8_t> texels;
    for (int i = 0; i < size * size; ++i) {
        const std::uint8_t value = (i / size + i) % 2 == 0 ? std::uint8_t{255} : dark;
        texels.insert(texels.end(), {255, value, 200, value});
    }
    return texels;
}

void addKinds(gltf::Scene& scene) {
    addMaterial(scene, mirrorMaterial());
    addMaterial(scene, paint({0.8F, 0.2F, 0.1F}, 0.4F));
    materials::Material coated = paint({0.1F, 0.3F, 0.8F}, 0.6F);
    coated.give("KHR_materials_clearcoat");
    coated["clearcoatFactor"] = 0.9F;
    coated["clearcoatRoughnessFactor"] = 0.1F;
    addMaterial(scene, coated);
    materials::Material textured = paint({0.9F, 0.9F, 0.9F}, 0.3F);
    textured.texture("baseColorTexture").texture = addTexture(scene, 4, 4, chequers(4, 40));
    // With mips, and linear.
    scene.samplers.back() = gltf::Sampler{};
    addMaterial(scene, textured);
    addMaterial(scene, unlitMaterial({0.2F, 0.7F, 0.3F}));
    materials::Material fence = paint({0.9F, 0.8F, 0.3F}, 0.5F);
    fence.alphaMode = materials::AlphaMode::Mask;
    fence.doubleSided = true;
    fence.texture("baseColorTexture").texture = addTexture(scene, 8, 8, chequers(8, 0));
    addMaterial(scene, fence);
}

gltf::Mesh shapeWith(std::uint32_t shape, std::span<const std::uint32_t> kinds) {
    const auto kind = [&](std::size_t i) { return static_cast<int>(kinds[i]); };
    gltf::Mesh mesh;
    if (shape == 1) {
        // A tent of two slopes.
        gltf::Primitive tent = makeQuad(kind(0), {-0.6F, -0.5F, 0.2F}, {1.2F, 0, 0}, {0, 0.5F, -0.4F});
        const gltf::Primitive back = makeQuad(kind(0), {0.6F, -0.5F, -0.6F}, {-1.2F, 0, 0}, {0, 0.5F, 0.4F});
        const auto first = static_cast<std::uint32_t>(tent.positions.size());
        tent.positions.insert(tent.positions.end(), back.positions.begin(), back.positions.end());
        tent.normals.insert(tent.normals.end(), back.normals.begin(), back.normals.end());
        tent.texCoords0.insert(tent.texCoords0.end(), back.texCoords0.begin(), back.texCoords0.end());
        for (const std::uint32_t index : back.indices) {
            tent.indices.push_back(first + index);
        }
        mesh.primitives = {tent};
        return mesh;
    }
    mesh.primitives = {makeQuad(kind(0), {-0.5F, -0.5F, 0}, {1, 0, 0}, {0, 1, 0})};
    if (shape == 2) {
        mesh.primitives.push_back(makeQuad(kind(1), {-0.3F, -0.4F, 0.3F}, {0.9F, 0, 0.2F}, {0, 0.7F, 0.1F}));
    }
    return mesh;
}

gltf::Scene sceneFor(const EditedSceneOptions& options) {
    gltf::Scene scene = catalogueScene();
    scene.trustsTextures = options.trustsTextures;
    if (options.lamps) {
        makeLamps(scene);
    }
    return scene;
}

// Returns null if the scenes can't be compiled, and the test fails.
std::shared_ptr<const Package> packageFor(std::span<const gltf::Scene> scenes,
                                          const compiler::CompileSettings& settings) {
    return must(session::compileAndLoad(*compiler::resolve(scenes, settings), &sharedModules()));
}

// A scene of materials that no other scene here has.
gltf::Scene furtherScene() {
    gltf::Scene scene = emptyScene();
    scene.path = "further.gltf";
    addCamera(scene);
    materials::Material cloth = paint({0.5F, 0.5F, 0.5F}, 0.5F);
    cloth.give("KHR_materials_sheen");
    cloth["sheenColorFactor"] = {0.5F, 0.4F, 0.3F};
    cloth["sheenRoughnessFactor"] = 0.5F;
    addQuad(scene, cloth, {-1, -1, -3}, {2, 0, 0}, {0, 2, 0});
    return scene;
}

template <typename Function, typename... Arguments>
void call(const Function& function, const Arguments&... arguments) {
    EXPECT_EQ(function(arguments...), VK_SUCCESS);
}

}  // namespace

std::uint32_t meshOfCatalogue(std::uint32_t shape, std::span<const std::uint32_t> kinds) {
    const std::uint32_t first = shape * kKinds;
    return shape == 2 ? first + kinds[0] * kKinds + kinds[1] : first + kinds[0];
}

gltf::Scene catalogueScene() {
    gltf::Scene scene = sceneWithCamera();
    addKinds(scene);
    for (std::uint32_t shape = 0; shape < kShapes; ++shape) {
        for (std::uint32_t first = 0; first < kKinds; ++first) {
            for (std::uint32_t second = 0; second < (shape == 2 ? kKinds : 1); ++second) {
                scene.meshes.push_back(shapeWith(shape, std::array{first, second}));
                addInstance(scene, static_cast<int>(scene.meshes.size()) - 1);
            }
        }
    }
    addDirectionalLight(scene, {0.0F, -0.6F, -0.8F}, 2.0F);
    return scene;
}

void makeLamps(gltf::Scene& scene) {
    scene.materials[1]["emissiveFactor"] = {4.0F, 3.0F, 2.0F};
    materials::Material& textured = scene.materials[3];
    textured["emissiveFactor"] = {3.0F, 3.0F, 3.0F};
    std::vector<std::uint8_t> texels = chequers(8, 10);
    std::fill_n(texels.begin(), texels.size() / 2, std::uint8_t{0});
    textured.texture("emissiveTexture").texture = addTexture(scene, 8, 8, texels);
}

TwoFrames::TwoFrames(Context& context) : context_(context) {
    const Context::State& state = context.state();
    const VkDevice device = state.handles.device;
    for (Slot& slot : slots_) {
        VkCommandPoolCreateInfo poolInfo{};
        poolInfo.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
        poolInfo.queueFamilyIndex = state.handles.queueFamily;
        call(state.vk.CreateCommandPool, device, &poolInfo, nullptr, &slot.pool);
        VkCommandBufferAllocateInfo bufferInfo{};
        bufferInfo.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
        bufferInfo.commandPool = slot.pool;
        bufferInfo.commandBufferCount = 1;
        call(state.vk.AllocateCommandBuffers, device, &bufferInfo, &slot.commands);
        VkFenceCreateInfo fenceInfo{};
        fenceInfo.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO;
        call(state.vk.CreateFence, device, &fenceInfo, nullptr, &slot.fence);
    }
}

TwoFrames::~TwoFrames() {
    drain();
    const Context::State& state = context_.state();
    for (const Slot& slot : slots_) {
        state.vk.DestroyFence(state.handles.device, slot.fence, nullptr);
        state.vk.DestroyCommandPool(state.handles.device, slot.pool, nullptr);
    }
}

void TwoFrames::wait(Slot& slot) {
    if (slot.frame == 0) {
        return;
    }
    const Context::State& state = context_.state();
    const VkDevice device = state.handles.device;
    call(state.vk.WaitForFences, device, 1U, &slot.fence, VkBool32{VK_TRUE},
         std::numeric_limits<std::uint64_t>::max());
    call(state.vk.ResetFences, device, 1U, &slot.fence);
    completed_ = std::max(completed_, slot.frame);
    slot.frame = 0;
}

VkCommandBuffer TwoFrames::begin() {
    Slot& slot = slots_[++frame_ % 2];
    wait(slot);
    const Context::State& state = context_.state();
    call(state.vk.ResetCommandPool, state.handles.device, slot.pool, VkCommandPoolResetFlags{0});
    VkCommandBufferBeginInfo info{};
    info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    call(state.vk.BeginCommandBuffer, slot.commands, &info);
    return slot.commands;
}

void TwoFrames::submit() {
    Slot& slot = slots_[frame_ % 2];
    const Context::State& state = context_.state();
    call(state.vk.EndCommandBuffer, slot.commands);
    VkCommandBufferSubmitInfo commands{};
    commands.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO;
    commands.commandBuffer = slot.commands;
    VkSubmitInfo2 submit{};
    submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2;
    submit.commandBufferInfoCount = 1;
    submit.pCommandBufferInfos = &commands;
    call(state.vk.QueueSubmit2, state.handles.queue, 1U, &submit, slot.fence);
    slot.frame = frame_;
}

void TwoFrames::waitForEarlier() {
    wait(slots_[(frame_ + 1) % 2]);
}

void TwoFrames::drain() {
    for (Slot& slot : slots_) {
        wait(slot);
    }
}

package::Tracer tracerOfDevice() {
    const bool queries = (sharedContext().handles().tracers & package::kTracerRayQuery) != 0;
    return queries ? package::kTracerRayQuery : package::kTracerRayPipeline;
}

EditedSceneOptions::EditedSceneOptions(package::Strategy strategy, package::Tracer tracer) {
    settings.strategies = strategy;
    settings.tracers = tracer;
    settings.plan.merge = compiler::MergePolicy::None;
    settings.plan.keys.alpha = package::AlphaPolicy::Tested;
    renderer.strategy = strategy;
    renderer.tracer = tracer;
}

EditedSceneOptions EditedSceneOptions::withLamps(std::uint32_t samples) {
    EditedSceneOptions options;
    options.lamps = true;
    options.settings.emissiveLights = compiler::EmissiveLights::On;
    options.settings.lightSamples = samples;
    options.settings.maxBounces = 2;
    options.renderer.bounces = 2;
    return options;
}

EditedScene::EditedScene(EditedSceneOptions options)
    : scene(sceneFor(options)), original(scene), options_(std::move(options)) {
    packages_ = {packageFor(std::span(&scene, 1), options_.settings)};
    if (packages_.front() == nullptr) {
        return;
    }
    data_ = session::makeSceneView(scene);
    layout_ = session::recordLayoutOf(package(), scene.materials.front().model());
    frameOptions_ = defaultSetup(scene, options_.width, options_.height).frame;
    // A floor that mirrors, and something above it.
    const std::array<std::uint32_t, 2> placed{meshOfCatalogue(0, std::array{0U, 0U}),
                                              meshOfCatalogue(1, std::array{3U, 0U})};
    std::vector<PrimitiveView> primitives{data_.primitives[placed[0]], data_.primitives[placed[1]]};
    std::vector<InstanceView> views(2);
    views[0] = {placed[0], {8, 0, 0, 0, 0, 0, 8, -1, 0, -8, 0, -4}};
    views[1] = {placed[1], {1, 0, 0, 0.2F, 0, 1, 0, -0.2F, 0, 0, 1, -2.5F}};
    SceneView view = data_.view();
    view.primitives = primitives;
    view.instances = views;
    view.editable = true;
    view.traversalOrder = options_.traversalOrder;
    view.vertices = SceneView::VertexForm::Quantized;  // meshes get a buffer for their builds alone, too
    gpuScene_ = uploadScene(package(), view);
    for (std::uint32_t kind = 0; kind < kKinds; ++kind) {
        materials.push_back({editor().material(kind), kind, true});
    }
    meshes.push_back({editor().mesh(placed[0]), 0, {0}, true});
    meshes.push_back({editor().mesh(placed[1]), 1, {3}, true});
    for (std::uint32_t i = 0; i < views.size(); ++i) {
        instances.push_back({editor().instance(i), i, {}, views[i].objectToWorld, true, true});
    }
    lights.push_back({editor().light(0), data_.lights[0], true});
    const std::vector<session::EditedTextures> known =
        session::uploadedTextures(editor(), package().scene(0), scene);
    for (std::size_t i = 0; i < scene.textures.size(); ++i) {
        const gltf::Image& image = scene.images[i];
        textures.push_back({known[i].color, static_cast<std::uint32_t>(image.width),
                            static_cast<std::uint32_t>(image.height), image.pixels});
    }
    // Those that no uploaded primitive has, have no keys yet.
    for (const Material& material : materials) {
        const session::MaterialSourceData made = source(material.kind);
        const Result<SceneEditor::Report> set = editor().setMaterial(material.handle, made.view());
        EXPECT_TRUE(set) << (set ? "" : toString(set.error()));
    }
    RendererOptions& renderer = options_.renderer;
    renderer.width = options_.width;
    renderer.height = options_.height;
    frames_ = std::make_unique<TwoFrames>(sharedContext());
    renderer_ = makeRenderer(package(), *gpuScene_, renderer);
}

void EditedScene::switchPackage() {
    if (packages_.size() == 1) {
        compiler::CompileSettings settings = options_.settings;
        settings.plan.merge = compiler::MergePolicy::All;
        packages_.push_back(packageFor(std::array{furtherScene(), original}, settings));
        ASSERT_NE(packages_.back()->scene(0).materials.recordBytes, package().scene(0).materials.recordBytes);
    }
    current_ = 1 - current_;
    const Renderer::Replacement replaced = must(renderer_->replacePackage(packages_[current_]));
    EXPECT_TRUE(replaced.missing.empty());
    const std::uint64_t before = renderer_->replacementProgress().inUse;
    frame();
    EXPECT_EQ(renderer_->replacementProgress().inUse, before + 1);
    layout_ = session::recordLayoutOf(package(), scene.materials.front().model());
}

PrimitiveView EditedScene::primitive(std::uint32_t shape, std::size_t index) const {
    const std::uint32_t mesh = meshOfCatalogue(shape, std::array{0U, 0U});
    const auto found = std::ranges::find_if(data_.primitives, [&](const PrimitiveView& view) {
        return view.mesh == mesh && view.primitive == index;
    });
    return *found;
}

session::MaterialSourceData EditedScene::source(std::uint32_t kind) const {
    std::vector<session::EditedTextures> handles;
    for (const Texture& texture : textures) {
        handles.push_back({texture.handle, {}});
    }
    materials::Material material = scene.materials[kind];
    session::MaterialSourceData data =
        session::makeMaterialSource(package(), layout_, scene, material, handles);
    if (options_.lamps && (kind == 1 || kind == 3)) {
        material["emissiveFactor"] = {1.0F, 1.0F, 1.0F};
        std::vector<std::uint8_t> record = std::move(data.record);
        data = session::makeMaterialSource(package(), layout_, scene, material, handles);
        data.record = std::move(record);
    }
    return data;
}

void EditedScene::frame() {
    const VkCommandBuffer commands = frames_->begin();
    editor().complete(frames_->completed());
    finished_.completed(*renderer_, frames_->completed());
    const Status edited = editor().record(commands, frames_->frame());
    EXPECT_TRUE(edited) << (edited ? "" : toString(edited.error()));
    const Status recorded = renderer_->record(commands, frameOptions_);
    EXPECT_TRUE(recorded) << (recorded ? "" : toString(recorded.error()));
    finished_.recorded(*renderer_, frames_->frame());
    frames_->submit();
}

void EditedScene::drain() {
    frames_->drain();
    editor().complete(frames_->completed());
    finished_.completed(*renderer_, frames_->completed());
}

LinearImage EditedScene::picture() {
    frame();
    drain();
    return drawn(*renderer_, frameOptions_);
}

LinearImage EditedScene::fresh() const {
    std::vector<InstanceView> views;
    std::vector<std::uint32_t> used;
    for (const Instance& instance : instances) {
        const Mesh& mesh = meshes[instance.mesh];
        std::vector<std::uint32_t> kinds;
        for (std::size_t i = 0; i < mesh.materials.size(); ++i) {
            const bool own = !instance.materials.empty() && instance.materials[i].has_value();
            kinds.push_back(materials[own ? *instance.materials[i] : mesh.materials[i]].kind);
        }
        InstanceView& view = views.emplace_back();
        view.mesh = meshOfCatalogue(mesh.shape, kinds);
        view.objectToWorld = instance.objectToWorld;
        view.visible = instance.visible;
        used.push_back(view.mesh);
    }
    std::vector<PrimitiveView> primitives;
    std::ranges::copy_if(data_.primitives, std::back_inserter(primitives), [&](const PrimitiveView& view) {
        return std::ranges::find(used, view.mesh) != used.end();
    });
    std::vector<ImageView> images;
    for (const Texture& texture : textures) {
        images.push_back(texture.view());
    }
    std::vector<std::vector<std::uint8_t>> records;
    std::vector<MaterialView> values;
    for (std::uint32_t kind = 0; kind < kKinds; ++kind) {
        records.push_back(compiler::makeMaterialRecord(scene.materials[kind], layout_));
    }
    for (std::uint32_t kind = 0; kind < kKinds; ++kind) {
        values.push_back({kind, records[kind]});
    }
    std::vector<LightView> lightViews;
    for (const Light& light : lights) {
        lightViews.push_back(light.view);
    }
    SceneView view;
    view.packageScene = *package().findScene(packages_.front()->scene(0).name);
    view.primitives = primitives;
    view.instances = views;
    view.images = images;
    view.lights = lightViews;
    view.materials = values;
    view.traversalOrder = options_.traversalOrder;
    view.vertices = SceneView::VertexForm::Quantized;
    const auto uploaded = uploadScene(package(), view);
    const auto renderer = uploaded ? makeRenderer(package(), *uploaded, options_.renderer) : nullptr;
    return renderer ? drawn(*renderer, frameOptions_) : LinearImage{};
}

void EditedScene::expectSameAsFresh(const std::string& what) {
    if (package().lightSamples() > 0 || package().emission() != nullptr) {
        editor().trim();  // else it has another hierarchy of lights, and dark ones, and so other noise
    }
    const LinearImage edited = picture();
    const LinearImage reference = fresh();
    ASSERT_EQ(edited.pixels.size(), reference.pixels.size()) << what;
    std::size_t off = 0;
    for (std::size_t i = 0; i < edited.pixels.size(); ++i) {
        off += std::memcmp(&edited.pixels[i], &reference.pixels[i], sizeof edited.pixels[i]) == 0 ? 0 : 1;
    }
    EXPECT_EQ(off, 0U) << what << ": pixels differ";
}

}  // namespace glint::testing
