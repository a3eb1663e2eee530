// Scenes on the device.
#pragma once

#include <glint/context.h>
#include <glint/memory_report.h>
#include <glint/package.h>
#include <glint/result.h>
#include <glint/scene_view.h>

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <memory>
#include <vector>

namespace glint {

class SceneEditor;
class TextureStream;

// The work of the last GpuScene::update(). Times are device times in milliseconds; without timestamps on the
// queue they are 0.
struct MotionStatistics {
    enum class TopLevel : std::uint32_t { Kept, Updated, Rebuilt };
    std::uint32_t deformed = 0;  // instances whose vertices were computed again
    std::uint32_t refits = 0;    // BLASes that were refitted
    std::uint32_t rebuilds = 0;  // BLASes that were built anew
    TopLevel topLevel = TopLevel::Kept;
    double deformMs = 0.0;
    double blasMs = 0.0;
    double tlasMs = 0.0;
};

// The geometry, acceleration structures, materials, textures and lights of a scene on the device. The Context
// must outlive it.
class GpuScene {
public:
    // Makes the scene and records its upload: copies from staging memory, mips, the builds of the BLASes (for
    // fast tracing), and that of the TLAS. Nothing waits for the device. `commands` is a command buffer of
    // the caller's, in the recording state and outside a render pass. Commands that use the scene may follow
    // in the same command buffer, or be submitted after it to the same queue; those of another queue need a
    // semaphore. `frame` is the caller's number of the frame that the commands belong to.
    //
    // The spans of `scene` are not kept (but see SceneView::streamsTextures). The call may run on any thread,
    // beside recordings of other scenes. Staging memory takes as many bytes as the scene's vertices and
    // textures, until complete() says that the frame is done. The scene may not be destroyed while the device
    // executes the commands; it may be if they were never submitted. A scene with SceneView::moves can be
    // updated when isUploaded() returns true.
    //
    // Errors: "scene-package" (the package has no such scene, or the attributes disagree with it),
    // "position-fetch" and "half-precision" (the device was created without what the package needs),
    // "scene-geometries" (more than 2^24 - 2 geometry records), other "scene-" errors for a scene that is not
    // well formed, "tlas-limit", and those of memory and Vulkan's calls. Nothing is recorded then.
    static Result<std::unique_ptr<GpuScene>> record(Context& context, const Package& package,
                                                    const SceneView& scene, VkCommandBuffer commands,
                                                    std::uint64_t frame);
    // Records the same into a command buffer of its own, submits it, waits for the device, and does the same
    // with the compaction. It has at most 64 MiB of staging memory: it submits and waits each time that they
    // are full. This is for tools, tests, and programs that may stand still while they load.
    static Result<std::unique_ptr<GpuScene>> upload(Context& context, const Package& package,
                                                    const SceneView& scene);
    // Says that the device has completed all commands of frames up to `frame`, and frees the resources that
    // only those used. It calls complete() of the editor and the texture stream, too.
    void complete(std::uint64_t frame);
    // Returns whether complete() was called for the frame of the upload.
    bool isUploaded() const;
    // Records the replacement of the BLASes by their compacted copies, and a build of the TLAS, if the upload
    // is complete and this was not done before; otherwise it records nothing. Returns whether it has.
    // Pictures stay the same. The requirements of `commands` and `frame` are those of record(), and
    // complete() frees the larger structures. In a scene that is edited it also records the edits that wait,
    // as SceneEditor::record() does. Errors: those of memory and Vulkan's calls; another call tries again.
    Result<bool> recordCompaction(VkCommandBuffer commands, std::uint64_t frame);
    ~GpuScene();
    GpuScene(const GpuScene&) = delete;
    GpuScene& operator=(const GpuScene&) = delete;

    struct Statistics {
        std::uint64_t triangles = 0;  // triangles of all instances
        std::uint32_t geometries = 0;
        std::uint32_t instances = 0;
        std::uint32_t blasCount = 0;
        std::uint64_t blasBytes = 0;  // of the present ones: compacted after recordCompaction()
        std::uint64_t blasUncompactedBytes = 0;
        // The number of 16-bit images that are stored with 8 bits, because this device can't filter or blit
        // R16G16B16A16_UNORM.
        std::uint32_t narrowedTextures = 0;
        // Triangles of meshes whose alpha rays would test, and those of them that are proved, so that no ray
        // tests them (SceneView::opacity).
        std::uint64_t maskedTriangles = 0;
        std::uint64_t provedOpaque = 0;
        std::uint64_t provedTransparent = 0;
        // Micromaps of the triangles that are still tested, on devices that have micromaps.
        std::uint32_t micromaps = 0;
        std::uint64_t micromapBytes = 0;
        double opacityMs = 0.0;    // wall clock of proving them
        double orderMs = 0.0;      // wall clock of SceneView::traversalOrder; 0: not ordered
        double blasBuildMs = 0.0;  // device time; 0 until complete() is called for the upload
        double tlasBuildMs = 0.0;
    };
    const Statistics& statistics() const;
    // The descriptor set with the scene's structures, textures and samplers, at the bindings that
    // package::Bindings has by default, and its layout. They are for hosts that record RaySteps.
    VkDescriptorSet descriptorSet() const;
    VkDescriptorSetLayout descriptorSetLayout() const;
    // Lists buffers and images by their contents. allocatedBytes() is the memory that was allocated for them.
    std::vector<MemoryItem> memory() const;
    std::uint64_t allocatedBytes() const;

    // Returns the editor of a scene with SceneView::editable (glint/scene_edit.h), or null for other scenes.
    // It lives as long as the scene.
    SceneEditor* editor();

    // Returns the stream of texture levels of a scene with SceneView::streamsTextures
    // (glint/texture_stream.h), or null for other scenes. It lives as long as the scene.
    TextureStream* textureStream();

    // Records the commands that bring a scene with SceneView::moves to another pose. `commands` is a command
    // buffer of the caller's, in the recording state and outside a render pass. The device then computes the
    // vertices that follow joints and morph weights, refits their BLASes, updates the TLAS and replaces the
    // records of instances, lights and materials. BLASes of meshes that keep their shape are not touched, and
    // neither is anything that has not changed since the last call. Renderer::record() may follow in the same
    // command buffer; its accumulation should start anew.
    //
    // A BLAS is built anew instead of refitted after 32 refits, or if the box around the mesh has more than
    // twice the surface that it had at the last build. The TLAS is built anew after 32 updates, or if an
    // instance has moved farther than its own box was long. docs/movement.md gives the reasons. A flattened
    // instance is hidden until its transform is invertible again.
    //
    // The spans are read in this call and not kept. Poses are written to host-visible memory in this call, so
    // only one update may be in flight at a time. The recorded commands must be submitted before the next
    // call, which builds upon them. With an error nothing is recorded. Errors: "scene-still" (the scene was
    // uploaded without `moves`), "scene-upload" (isUploaded() returns false), "scene-motion" (another number
    // of instances, lights, joints or weights than at upload, another mesh, or a number that is not finite),
    // "scene-light", "scene-material" (other materials than at upload).
    Status update(VkCommandBuffer commands, const MotionView& motion);

    // Records an update, submits it and waits for the device. This is for tools and tests.
    Status updateAndWait(const MotionView& motion);

    // Returns the work of the last update. The caller must have waited until the device completed it. Error
    // "frame-not-recorded" if there was no update, and those of reading device times.
    Result<MotionStatistics> motion() const;

    struct State;
    State& state();

private:
    explicit GpuScene(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace glint
