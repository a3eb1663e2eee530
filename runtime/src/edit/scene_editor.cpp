// SceneEditor: lights, handles of the upload, frames.
#include "edit/editor_state.h"
#include "scene/instance_math.h"
#include "scene/scene_checks.h"

#include <algorithm>
#include <utility>

namespace glint {
namespace {

// Returns a handle of the upload if the thing that it names is still there.
template <typename Entries, typename Handle>
Handle stillThere(const Entries& entries, std::span<const Handle> handles, std::uint32_t number) {
    return number < handles.size() && entries.find(handles[number]) != nullptr ? handles[number] : Handle{};
}

}  // namespace

SceneEditor::State::State(GpuScene::State& owner, const Package& package, const SceneView& view)
    : scene(owner),
      cases(package),
      layout(package.scene(0).materials.part(0, 0)),
      capacity(orderedCapacity(blasCapacity(owner.context))),
      leafOrder(leafOrderFor(owner.context, view.traversalOrder)),
      vertices(view.vertices),
      dataAccess(package.positionFetch()),
      passesLight(package.shadowThrough() == package::ShadowThrough::Glass),
      buildsTree(package.lightSamples() > 0),
      trustsTextures(package.trustTextures()),
      emission(package.emission()),
      materials(layout.recordBytes),
      emittersDirty(package.emission() != nullptr),
      retired(owner.pool) {}

SceneEditor::SceneEditor(std::unique_ptr<State> state) : state_(std::move(state)) {}
SceneEditor::~SceneEditor() = default;

std::unique_ptr<SceneEditor> SceneEditor::create(std::unique_ptr<State> state) {
    return std::unique_ptr<SceneEditor>(new SceneEditor(std::move(state)));
}

SceneEditor::State& SceneEditor::state() {
    return *state_;
}

TextureHandle SceneEditor::texture(std::uint32_t number) const {
    return stillThere(state_->textures, std::span<const TextureHandle>(state_->firstTextures), number);
}

MaterialHandle SceneEditor::material(std::uint32_t number) const {
    return stillThere(state_->materialSlots, std::span<const MaterialHandle>(state_->firstMaterials), number);
}

MeshHandle SceneEditor::mesh(std::uint32_t number) const {
    const auto known = state_->firstMeshes.find(number);
    const bool there = known != state_->firstMeshes.end() && state_->meshes.find(known->second) != nullptr;
    return there ? known->second : MeshHandle{};
}

InstanceHandle SceneEditor::instance(std::uint32_t number) const {
    return stillThere(state_->instanceSlots, std::span<const InstanceHandle>(state_->firstInstances), number);
}

LightHandle SceneEditor::light(std::uint32_t number) const {
    return stillThere(state_->lightSlots, std::span<const LightHandle>(state_->firstLights), number);
}

Result<LightHandle> SceneEditor::addLight(const LightView& light) {
    GLINT_TRY_DO(checkLights(std::span(&light, 1)));
    const LightHandle handle = state_->lightSlots.add(light);
    state_->lightOrder.push_back(handle);
    state_->lightsDirty = true;
    return handle;
}

Status SceneEditor::setLight(LightHandle light, const LightView& view) {
    LightView* const entry = state_->lightSlots.find(light);
    if (entry == nullptr) {
        return unknownHandle("light");
    }
    GLINT_TRY_DO(checkLights(std::span(&view, 1)));
    *entry = view;
    state_->lightsDirty = true;
    return okStatus();
}

Status SceneEditor::removeLight(LightHandle light) {
    if (state_->lightSlots.find(light) == nullptr) {
        return unknownHandle("light");
    }
    state_->lightSlots.take(light);
    std::erase(state_->lightOrder, light);
    state_->lightsDirty = true;
    return okStatus();
}

Status SceneEditor::record(VkCommandBuffer commands, std::uint64_t frame) {
    if (frame < state_->lastFrame) {
        return makeError("scene-edit-frame", "",
                         "frame " + std::to_string(frame) + " is recorded after frame " +
                             std::to_string(state_->lastFrame),
                         "number frames in the order in which they are recorded");
    }
    return recordEdits(*state_, commands, frame);
}

void SceneEditor::complete(std::uint64_t frame) {
    state_->retired.complete(frame);
}

void SceneEditor::trim() {
    state_->trims = true;
}

std::uint64_t SceneEditor::retiredBytes() const {
    std::uint64_t bytes = state_->retired.bytes();
    for (const Buffer& staging : state_->uploader->staging()) {
        bytes += staging.bytes;
    }
    return bytes;
}

}  // namespace glint
