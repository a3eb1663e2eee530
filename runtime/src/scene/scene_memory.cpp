#include "context/memory_items.h"
#include "edit/editor_state.h"
#include "motion/deformer.h"
#include "motion/scene_motion.h"
#include "scene/gpu_scene_state.h"

namespace glint {

namespace {

void addMotion(std::vector<MemoryItem>& items, const SceneMotion& motion) {
    if (motion.deformer != nullptr) {
        motion.deformer->addMemory(items);
    }
    if (motion.blases != nullptr) {
        motion.blases->addMemory(items);
    }
    addTo(items, "instances of the top level", motion.placedBuffer);
    addTo(items, "scratch of structures", motion.tlasScratch.buffer);
    addTo(items, "poses on their way", motion.staging);
}

void addEditor(std::vector<MemoryItem>& items, const SceneEditor::State& editor) {
    editor.meshes.forEach([&](MeshHandle /*handle*/, const EditedMesh& mesh) {
        for (const EditedMeshPrimitive& primitive : mesh.primitives) {
            addTo(items, "vertices and indices", primitive.device.buffer);
            for (const EditedPart& part : primitive.parts) {
                addTo(items, "bottom levels", part.blas.buffer);
            }
        }
    });
    addTo(items, "textures", editor.white);
    addTo(items, "scratch of structures", editor.tlasScratch.buffer);
    for (const Buffer& staging : editor.uploader->staging()) {
        addTo(items, "edits on their way", staging);
    }
    if (editor.retired.count() > 0) {
        addTo(items,
              {"retired by edits", MemoryUse::Device, false, editor.retired.count(), editor.retired.bytes()});
    }
}

}  // namespace

std::vector<MemoryItem> GpuScene::memory() const {
    std::vector<MemoryItem> items;
    for (const GpuPrimitive& primitive : state_->primitives) {
        addTo(items, "vertices and indices", primitive.buffer);
    }
    for (const Buffer& buffer : state_->deformed.buffers) {
        addTo(items, "deformed vertices", buffer);
    }
    for (const DeviceImage& texture : state_->textures) {
        addTo(items, "textures", texture);
    }
    if (state_->stream != nullptr) {
        addTo(items, {"levels on their way", MemoryUse::Upload, false, 1, state_->stream->retiredBytes()});
    }
    for (const AccelerationStructure& blas : state_->blases) {
        addTo(items, "bottom levels", blas.buffer);
    }
    for (const auto& [primitive, micromap] : state_->micromaps) {
        addTo(items, "opacity micromaps", micromap.buffer);
        addTo(items, "opacity micromaps", micromap.indices);
    }
    addTo(items, "top level", state_->tlas.buffer);
    addTo(items, "geometry records", state_->geometries);
    addTo(items, "instance records", state_->instances);
    addTo(items, "material records", state_->materials);
    addTo(items, "light records", state_->lights);
    if (state_->lightNodes.address != 0) {
        addTo(items, "light nodes", state_->lightNodes);
    }
    if (state_->emitterRecords.address != 0) {
        addTo(items, "emissive triangles", state_->emitterRecords);
        addTo(items, "emissive triangles", state_->firstEmitters);
    }
    if (state_->motion != nullptr) {
        addMotion(items, *state_->motion);
    }
    if (state_->upload != nullptr) {
        for (const Buffer& buffer : state_->upload->kept) {
            addTo(items, "upload on its way", buffer);
        }
    }
    if (state_->compaction != nullptr) {
        for (const AccelerationStructure& blas : state_->compaction->replaced) {
            addTo(items, "bottom levels before compaction", blas.buffer);
        }
    }
    if (state_->editor != nullptr) {
        addEditor(items, state_->editor->state());
    }
    return items;
}

std::uint64_t GpuScene::allocatedBytes() const {
    const SceneMotion* const motion = state_->motion.get();
    std::uint64_t bytes = state_->pool.bytes();
    bytes += state_->package.pool != nullptr ? state_->package.pool->bytes() : 0;
    bytes += state_->upload != nullptr ? state_->upload->pool.bytes() : 0;
    bytes += state_->compaction != nullptr ? state_->compaction->pool.bytes() : 0;
    if (motion != nullptr) {
        bytes +=
            motion->pool.bytes() + (motion->deformer != nullptr ? motion->deformer->allocatedBytes() : 0);
    }
    return bytes;
}

}  // namespace glint
