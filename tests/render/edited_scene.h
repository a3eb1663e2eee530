// A scene that is edited while frames are in flight, beside a description of its content, from which the same
// scene is uploaded afresh the ordinary way.
#pragma once

#include "render/harness.h"

#include <glint/scene.h>
#include <glint/session/material_source.h>
#include <glint/session/scene_view.h>

#include <vulkan/vulkan_core.h>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace glint::testing {

// The kinds of materials of the catalogue, and the shapes of its meshes: one, one and two primitives.
inline constexpr std::uint32_t kKinds = 6;
inline constexpr std::uint32_t kShapes = 3;
constexpr std::size_t primitivesOfShape(std::uint32_t shape) {
    return shape == 2 ? 2 : 1;
}
// Returns a scene with a mesh for each shape with each choice of materials, in front of a camera.
gltf::Scene catalogueScene();
// Makes the kinds 1 and 3 of the catalogue lights, the latter with a texture of its own.
void makeLamps(gltf::Scene& scene);
// Returns the number of a mesh of the catalogue. `kinds` has one kind for each primitive.
std::uint32_t meshOfCatalogue(std::uint32_t shape, std::span<const std::uint32_t> kinds);

// Submits frames of two command buffers in turn.
class TwoFrames {
public:
    explicit TwoFrames(Context& context);
    ~TwoFrames();
    TwoFrames(const TwoFrames&) = delete;
    TwoFrames& operator=(const TwoFrames&) = delete;

    // Waits until the frame before the last is done, which `completed()` then includes, and begins a frame.
    VkCommandBuffer begin();
    // The number of the frame that was begun. The first is 1.
    std::uint64_t frame() const {
        return frame_;
    }
    std::uint64_t completed() const {
        return completed_;
    }
    void submit();
    // Waits for all frames but the last.
    void waitForEarlier();
    void drain();

private:
    struct Slot {
        VkCommandPool pool = VK_NULL_HANDLE;
        VkCommandBuffer commands = VK_NULL_HANDLE;
        VkFence fence = VK_NULL_HANDLE;
        std::uint64_t frame = 0;  // 0: not in flight
    };
    void wait(Slot& slot);

    Context& context_;
    std::array<Slot, 2> slots_;
    std::uint64_t frame_ = 0;
    std::uint64_t completed_ = 0;
};

// Tells a Renderer or RaySteps which of its recordings are done.
class FinishedRecordings {
public:
    // Notes that the frame, which is to be submitted, has its last recording.
    template <typename Drawing>
    void recorded(const Drawing& renderer, std::uint64_t frame) {
        frames_[frame % 2] = {frame, renderer.recordings()};
    }
    template <typename Drawing>
    void completed(Drawing& renderer, std::uint64_t frame) const {
        for (const auto& [number, recording] : frames_) {
            if (number <= frame) {
                renderer.finished(recording);
            }
        }
    }

private:
    std::array<std::pair<std::uint64_t, std::uint64_t>, 2> frames_{};  // frame and recording
};

// Returns ray queries, or ray tracing pipelines on a device without them.
package::Tracer tracerOfDevice();

struct EditedSceneOptions {
    // Compiles and renders with a strategy, with a case for each key and alpha tests.
    explicit EditedSceneOptions(package::Strategy strategy = package::kStrategyUber,
                                package::Tracer tracer = tracerOfDevice());
    // With emissive lights, of which surfaces choose `samples` by the hierarchy; 0: they take all.
    static EditedSceneOptions withLamps(std::uint32_t samples);
    compiler::CompileSettings settings;
    RendererOptions renderer;
    bool trustsTextures = false;
    bool lamps = false;  // makeLamps(), and paths of two bounces with emissive lights
    SceneView::TraversalOrder traversalOrder = SceneView::TraversalOrder::Auto;
    std::uint32_t width = 32;
    std::uint32_t height = 18;
};

class EditedScene {
public:
    explicit EditedScene(EditedSceneOptions options);

    // The objects that are there. Each was added by the test or, if `first` is set, was uploaded.
    struct Material {
        MaterialHandle handle;
        std::uint32_t kind = 0;
        bool first = false;
    };
    struct Mesh {
        MeshHandle handle;
        std::uint32_t shape = 0;
        std::vector<std::size_t> materials;  // indices into materials
        bool first = false;
    };
    struct Instance {
        InstanceHandle handle;
        std::size_t mesh = 0;                               // index into meshes
        std::vector<std::optional<std::size_t>> materials;  // indices into materials
        std::array<float, 12> objectToWorld{};
        bool visible = true;
        bool first = false;
    };
    struct Light {
        LightHandle handle;
        LightView view;
        bool first = false;
    };
    struct Texture {  // by index into Scene::textures
        TextureHandle handle;
        std::uint32_t width = 0;
        std::uint32_t height = 0;
        std::vector<std::uint8_t> pixels;
        ImageView view() const {
            return {width, height, pixels};
        }
    };
    std::vector<Material> materials;
    std::vector<Mesh> meshes;
    std::vector<Instance> instances;
    std::vector<Light> lights;
    std::vector<Texture> textures;
    gltf::Scene scene;           // its materials have the present values of the kinds
    const gltf::Scene original;  // that was compiled

    SceneEditor& editor() {
        return *gpuScene_->editor();
    }
    GpuScene& gpuScene() {
        return *gpuScene_;
    }
    const Package& package() const {
        return *packages_[current_];
    }
    // Draws with another package from the next frame on, which this records, or with the first one again. The
    // other one has merged cases, more fields in the records of materials, and the scene at another index.
    void switchPackage();
    bool isSwitched() const {
        return current_ > 0;
    }
    PrimitiveView primitive(std::uint32_t shape, std::size_t index) const;
    // The source of a material of a kind with the kind's present values. A lamp that is dark keeps its keys.
    session::MaterialSourceData source(std::uint32_t kind) const;

    // Records the edits and a frame, and submits both.
    void frame();
    // Waits for all frames, and frees what they used.
    void drain();
    // Draws the edited scene, and the same content uploaded afresh, and compares the pictures' bits.
    void expectSameAsFresh(const std::string& what);
    LinearImage picture();

private:
    LinearImage fresh() const;

    EditedSceneOptions options_;
    std::vector<std::shared_ptr<const Package>> packages_;
    std::size_t current_ = 0;
    session::SceneViewData data_;
    compiler::MaterialLayout layout_;
    FrameOptions frameOptions_;
    std::unique_ptr<GpuScene> gpuScene_;
    std::unique_ptr<TwoFrames> frames_;
    std::unique_ptr<Renderer> renderer_;
    FinishedRecordings finished_;
};

}  // namespace glint::testing
