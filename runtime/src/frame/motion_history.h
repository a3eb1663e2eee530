// The state of the previous frame, for motion: the camera, the transforms of instances, and the positions of
// vertices that follow joints or morph weights.
#pragma once

#include "context/resources.h"
#include "data/retired.h"
#include "interop/frame.h"
#include "scene/gpu_scene_state.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace glint {

// Belongs to one renderer. Its previous frame is the last picture that this renderer began. The scene must
// outlive it.
class MotionHistory {
public:
    // A scene that neither moves nor is edited needs no memory. Errors: those of buffers.
    static Result<std::unique_ptr<MotionHistory>> create(const GpuScene::State& scene);

    // Makes room for as many instances, and vertices that deform, as the scene has. After that the next frame
    // itself stands for the previous one. Errors: those of buffers; nothing has changed then.
    Status makeRoom();
    // Fills FrameConstants::previous*, whose camera is that of the frame to come. Without a previous frame,
    // the frame itself stands for it.
    void fill(gpu::FrameConstants& constants);
    // Records the copies that the next frame needs, after a frame's passes. The commands that follow must
    // wait for them.
    void record(VkCommandBuffer commands, std::uint64_t recording);
    // The device has completed all recordings up to a number: frees what only those used.
    void complete(std::uint64_t recording) {
        outgrown_.complete(recording);
    }

    void addMemory(std::vector<MemoryItem>& items) const;
    std::uint64_t allocatedBytes() const {
        return pool_.bytes();
    }

private:
    explicit MotionHistory(const GpuScene::State& scene)
        : scene_(&scene), pool_(scene.context, "frame before") {}

    Status makeVertices();
    void recordTable(VkCommandBuffer commands);

    // The positions of one deformed primitive.
    struct Copy {
        VkBuffer source = VK_NULL_HANDLE;
        VkBufferCopy region{};
    };
    struct View {
        gpu::vec4 rows[4];
    };

    const GpuScene::State* scene_;
    MemoryPool pool_;
    Buffer instances_;
    Retired outgrown_;  // frames in flight may read them
    Buffer vertices_;
    Buffer table_;                                 // gpu::PreviousVertices by geometry
    std::vector<gpu::PreviousVertices> newTable_;  // until they are recorded
    std::vector<Copy> copies_;
    std::optional<View> view_;   // of the last frame
    View next_{};                // of the frame that is recorded
    std::uint64_t shapes_ = 0;   // shapeVersion() of vertices_ and table_
    bool hasInstances_ = false;  // instances_ holds those of the last frame
    bool hasVertices_ = false;   // the same of vertices_
};

}  // namespace glint
