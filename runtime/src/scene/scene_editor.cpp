// SceneEditor: handles of the upload, lights, and the recording of edits.
#include "context/parallel.h"
#include "data/scene_checks.h"
#include "scene/scene_store.h"

namespace glint {
namespace {

// Returns a handle of the upload if the thing that it names is still there.
template <typename Entries, typename Handle>
Handle stillThere(const Entries& entries, std::span<const Handle> handles, std::uint32_t number) {
    return number < handles.size() && entries.find(handles[number]) != nullptr ? handles[number] : Handle{};
}

}  // namespace

TextureHandle SceneEditor::texture(std::uint32_t number) const {
    return stillThere(store_->textures, std::span<const TextureHandle>(store_->firstTextures), number);
}

MaterialHandle SceneEditor::material(std::uint32_t number) const {
    return stillThere(store_->materialSlots, std::span<const MaterialHandle>(store_->firstMaterials), number);
}

MeshHandle SceneEditor::mesh(std::uint32_t number) const {
    const auto known = store_->firstMeshes.find(number);
    const bool there = known != store_->firstMeshes.end() && store_->meshes.find(known->second) != nullptr;
    return there ? known->second : MeshHandle{};
}

InstanceHandle SceneEditor::instance(std::uint32_t number) const {
    return stillThere(store_->instanceSlots, std::span<const InstanceHandle>(store_->firstInstances), number);
}

LightHandle SceneEditor::light(std::uint32_t number) const {
    return stillThere(store_->lightSlots, std::span<const LightHandle>(store_->firstLights), number);
}

Result<LightHandle> SceneEditor::addLight(const LightView& light) try {
    GLINT_TRY_DO(checkLights(std::span(&light, 1)));
    return glint::addLight(*store_, light);
}
GLINT_CATCH

Status SceneEditor::setLight(LightHandle light, const LightView& view) try {
    if (store_->lightSlots.find(light) == nullptr) {
        return unknownHandle("light");
    }
    GLINT_TRY_DO(checkLights(std::span(&view, 1)));
    glint::setLight(*store_, light, view);
    return okStatus();
}
GLINT_CATCH

Status SceneEditor::removeLight(LightHandle light) try {
    if (store_->lightSlots.find(light) == nullptr) {
        return unknownHandle("light");
    }
    glint::removeLight(*store_, light);
    return okStatus();
}
GLINT_CATCH

Status SceneEditor::record(VkCommandBuffer commands, std::uint64_t frame) try {
    GLINT_TRY_DO(checkFrame(*store_, frame));
    return recordChanges(*store_, commands, frame);
}
GLINT_CATCH

void SceneEditor::complete(std::uint64_t frame) {
    store_->retired.complete(frame);
}

void SceneEditor::trim() {
    store_->trims = true;
}

std::uint64_t SceneEditor::retiredBytes() const {
    std::uint64_t bytes = store_->retired.bytes();
    for (const Buffer& staging : store_->uploader->staging()) {
        bytes += staging.bytes;
    }
    return bytes;
}

}  // namespace glint
