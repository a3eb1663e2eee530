// A scene on a device that follows the edits of a Scene (glint/session/edits.h) while its animations play.
// Each frame:
//
//     applyEdit(edit, files, scene);           // any number of them
//     moveTo(moment, scene);
//     live.follow(scene);                      // instances, materials and lights as the scene has them
//     gpu.update(commands, live.motion(), frame);  // records all of it
#pragma once

#include "gltf/scene.h"
#include "materials/material.h"

#include <glint/package.h>
#include <glint/result.h>
#include <glint/scene.h>
#include <glint/session/material_source.h>
#include <glint/session/scene_view.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

namespace glint::session {

// Makes the upload of `data` one that edits can change while it moves.
void makeEditable(const Package& package, SceneViewData& data);

// Functions may not be called at the same time as each other or other functions of the GpuScene. None of
// them waits for the device.
class LiveScene {
public:
    // `data` was made of `scene`, changed by makeEditable() and uploaded as `gpu`. `package`, `gpu` and
    // `data` must outlive the object. `keptLobes` are those that hits keep (--hit-lobes).
    LiveScene(const Package& package, GpuScene& gpu, SceneViewData& data, const gltf::Scene& scene,
              materials::FeatureMask keptLobes);

    // Brings the device's scene to the content and pose of `scene`, which is the one of the constructor after
    // edits. The images of scenes that edits have added must have been given to addTextures() (glint/session/
    // textures.h) before, in the same order. The work of the device waits for GpuScene::update() with
    // motion(). An instance, mesh or light for which there is an error is left out, or stays as it was,
    // and later calls pass it over; everything else follows. Returns the first error; they are those of
    // SceneEditor.
    Status follow(const gltf::Scene& scene);
    // The pose of what was uploaded.
    MotionView motion() const;
    // Returns the notes "edit-fallback" since the last call, one for each material and key.
    std::vector<Diagnostic> takeNotes();
    // Returns the instance in SceneViewData that has the handle (Renderer::SurfacePlace::handle), if any.
    std::optional<std::size_t> instanceOf(InstanceHandle handle) const;

private:
    struct LiveMaterial {
        MaterialHandle handle;
        std::vector<AttributeMask> attributes;  // that it has keys for
        std::vector<std::uint8_t> record;       // as it was given last; of animated materials of edits
    };
    struct LiveMesh {
        MeshHandle handle;                      // names nothing until the mesh is on the device
        std::vector<AttributeMask> attributes;  // of each primitive
        std::vector<int> materials;             // of each primitive
        std::size_t first = 0;                  // of its primitives, in SceneViewData
    };
    struct LiveInstance {
        InstanceHandle handle;       // names nothing after its removal, and if it can't be drawn
        bool isNew = true;           // not tried yet
        std::vector<int> materials;  // of its own; empty: those of the mesh
        // As they were given last, for instances that edits have added.
        InstanceView view;
        std::vector<std::array<float, 12>> joints;
        std::vector<float> weights;
    };
    struct LiveLight {
        LightHandle handle;
        bool isNew = true;
        LightView view;
    };

    LiveMesh& meshOf(std::uint32_t mesh);
    Result<MaterialHandle> materialFor(const gltf::Scene& scene, int material, AttributeMask attributes);
    Result<MaterialSourceData> sourceOf(const gltf::Scene& scene, int material,
                                        const std::vector<AttributeMask>& attributes);
    Result<TextureHandle> textureFor(const gltf::Scene& scene, int texture, bool srgb);
    Status addMesh(const gltf::Scene& scene, std::uint32_t mesh);
    Status followMesh(const gltf::Scene& scene, std::uint32_t number, LiveMesh& mesh);
    Status addInstance(const gltf::Scene& scene, std::size_t index);
    Status followInstance(const gltf::Scene& scene, std::size_t index);
    Status followLight(std::size_t index, bool isPlaced);
    Status followMaterials(const gltf::Scene& scene);
    void note(const gltf::Scene& scene, const SceneEditor::Report& report);

    const Package& package_;
    GpuScene& gpu_;
    SceneViewData& data_;
    materials::FeatureMask keptLobes_;
    std::size_t uploadedInstances_ = 0;
    std::size_t uploadedLights_ = 0;
    std::size_t uploadedAnimated_ = 0;
    std::map<int, LiveMaterial> materials_;
    std::map<std::uint32_t, LiveMesh> meshes_;
    std::vector<LiveInstance> instances_;
    std::vector<LiveLight> lights_;
    std::map<std::pair<int, bool>, TextureHandle> textures_;  // by image, and whether it is colour
    std::vector<Diagnostic> notes_;
};

}  // namespace glint::session
