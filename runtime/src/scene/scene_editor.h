// The state of a SceneEditor: the content of the scene by handles, the shaders of its keys, and the data that
// the device still has to get.
#pragma once

#include "context/upload.h"
#include "data/acceleration.h"
#include "data/geometry.h"
#include "data/instance_math.h"
#include "data/motion_bounds.h"
#include "data/retired.h"
#include "scene/gpu_scene_state.h"
#include "scene/record_store.h"
#include "scene/scene_upload.h"

#include <glint/package.h>
#include <glint/result.h>
#include <glint/scene.h>

#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

namespace glint {

// The fields of a geometry record that follow from its material's key.
struct Shading {
    std::uint64_t features = 0;
    std::uint32_t geometryFlags = 0;
    std::uint32_t shaderId = 0;
    bool missing = false;  // no case has the key: the fallback shades it

    bool operator==(const Shading&) const = default;
};

// The keys that a package has shaders for. The package must outlive it.
class CaseTable {
public:
    explicit CaseTable(const Package& package);

    // Finds the shader of a key. `where` is the material, for messages. A key of the package's own scenes has
    // the shader that they have. For others it is the case that has all of the key's features and takes the
    // fewest others into account. Errors: "scene-edit-feature", "scene-edit-case".
    Result<Shading> find(const MaterialKey& key, const std::string& where) const;
    // Checks that the attributes include those that shaders of the key's features read. Error
    // "scene-edit-key".
    Status checkAttributes(const MaterialKey& key, const std::string& where) const;

    // The shader IDs of the shader binding table of a strategy: those of the cases, then one for all others.
    std::vector<std::uint32_t> shaderIds() const;
    std::string namesOf(std::uint64_t features) const;
    const Package& package() const {
        return package_;
    }

private:
    Status checkKnown(const MaterialKey& key, const std::string& where) const;
    // Checks that shaders compute the emission of a light with this key.
    Status checkEmitter(const MaterialKey& key, const std::string& where) const;

    const Package& package_;
    bool fallback_;
    std::unordered_map<std::uint64_t, std::uint32_t> shaderOfKey_;  // of the package's primitives
    std::uint64_t known_ = 0;                                       // features of some primitive
    std::uint64_t always_ = ~0ULL;  // features of every primitive, which no shader asks for
    std::uint32_t flags_ = 0;       // geometry flags of some primitive
};

// A texture. Its image is GpuScene::State::textures at the handle's index.
struct EditedTexture {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    bool srgb = false;
    std::uint32_t uses = 0;                          // by materials
    std::shared_ptr<const EmissionTexels> texels{};  // of a colour, if emission may have textures
};

// A material. Its record is in State::materials at the handle's index.
struct EditedMaterial {
    std::vector<MaterialKey> keys;
    std::vector<TextureUse> textures;
    std::uint32_t uses = 0;  // by primitives of meshes and by instances
};

// A BLAS with one geometry: a primitive, or a part of a large one. The TLAS holds the properties that follow
// from its material, so that a change of materials builds no BLAS.
struct EditedPart {
    TriangleRange triangles;
    AccelerationStructure blas;
    Box box = Box::nothing();
};

struct EditedMeshPrimitive {
    GpuPrimitive device;
    AttributeMask attributes = 0;
    MaterialHandle material;
    std::vector<EditedPart> parts;
    std::shared_ptr<const EmitterShape> shape;  // in packages with emissive lights
};

struct EditedMesh {
    std::vector<EditedMeshPrimitive> primitives;
    std::uint32_t partCount = 0;
    std::uint32_t uses = 0;  // by instances
};

struct EditedInstance {
    MeshHandle mesh;
    Rows objectToWorld{};
    bool visible = true;
    std::vector<MaterialHandle> materials;  // one for each primitive of the mesh; some may name nothing
    std::uint32_t firstGeometry = 0;        // a geometry record for each part of the mesh
    std::uint32_t geometryCount = 0;

    bool isShown() const;
};

struct SceneEditor::State {
    State(GpuScene::State& owner, const Package& package, const SceneView& view);

    GpuScene::State& scene;
    CaseTable cases;
    MaterialTable layout;  // of material records, without records
    BlasCapacity capacity;
    LeafOrder leafOrder = nullptr;  // null: structures get their input as it is
    VertexForm vertices = VertexForm::Compact;
    bool dataAccess = false;                           // BLASes let shaders read positions
    bool passesLight = false;                          // a ray meets each triangle at most once
    bool buildsTree = false;                           // the package chooses lights by a hierarchy
    bool trustsTextures = false;                       // Package::trustTextures()
    const package::EmissionEntry* emission = nullptr;  // null without emissive lights

    Slots<EditedTexture, TextureHandle> textures;
    Slots<EditedMaterial, MaterialHandle> materialSlots;
    Slots<EditedMesh, MeshHandle> meshes;
    Slots<EditedInstance, InstanceHandle> instanceSlots;
    Slots<LightView, LightHandle> lightSlots;
    std::vector<LightHandle> lightOrder;
    std::vector<package::SamplerEntry> samplers;  // of GpuScene::State::samplers
    DeviceImage white;                            // for places without a texture

    // Handles by their numbers at the upload.
    std::vector<TextureHandle> firstTextures;
    std::vector<MaterialHandle> firstMaterials;
    std::map<std::uint32_t, MeshHandle> firstMeshes;
    std::vector<InstanceHandle> firstInstances;
    std::vector<LightHandle> firstLights;

    RecordStore geometries{sizeof(gpu::GeometryRecord)};
    RecordStore instances{sizeof(gpu::InstanceRecord)};
    RecordStore materials;
    RecordStore lights{sizeof(gpu::LightRecord)};
    RecordStore lightNodes{sizeof(gpu::LightNode)};
    RecordStore emitters{sizeof(gpu::EmitterRecord)};
    RecordStore firstEmitters{sizeof(std::uint32_t)};  // of each geometry record
    RunAllocator geometryRuns;

    // Instances with a material that is a light, by generation: in the order in which they were added.
    std::map<std::uint32_t, InstanceHandle> emissiveInstances;
    std::set<std::uint32_t> emissiveMaterials;  // of those that were shown at the last recording
    EmitterMeans emitterMeans;

    // The work of the next record().
    std::unique_ptr<Uploader> ownUploader;  // null in the upload, which has one of its own
    Uploader* uploader = nullptr;
    struct PendingBuild {
        BlasBuild build;  // with its destination
        Buffer input;     // input of this and earlier builds of the same primitive; may be none
    };
    std::vector<PendingBuild> builds;
    bool tlasDirty = true;
    bool drawsDirty = true;
    bool lightsDirty = true;
    bool emittersDirty = false;
    bool setDirty = false;
    bool trims = false;

    std::uint32_t tlasCapacity = 0;  // instances
    std::uint32_t firstTlasCapacity = 0;
    Scratch tlasScratch;
    Retired retired;
    std::uint64_t lastFrame = 0;
    // Null after the upload, in which BLASes are built together.
    SceneUpload* upload = nullptr;
};

// The upload of an editable scene; `known` may be a scene without tables. Records everything that is queued
// in `upload` or added by the editor.
Status uploadEditable(GpuScene::State& state, const Package& package, const PackageScene& known,
                      const SceneView& view, SceneUpload& upload, VkCommandBuffer commands);

// --- Parts of an edit that several functions share ---

// Finds the shading of a material on a primitive. Has the errors that SceneEditor lists.
Result<Shading> shadingOf(const SceneEditor::State& state, MaterialHandle material, AttributeMask attributes);
// Lists the key in the report if the fallback shades it.
void addTo(EditReport& report, const SceneEditor::State& state, MaterialHandle material,
           const Shading& shading);
// The material of a primitive of an instance.
MaterialHandle materialOf(const SceneEditor::State& state, const EditedInstance& instance,
                          std::size_t primitive);
// Writes the geometry records of an instance, whose materials have been checked.
void writeGeometries(SceneEditor::State& state, InstanceHandle handle, const EditedInstance& instance);
// Uploads the primitives of a mesh. With `inputs`, the caller builds their BLASes from these, part by part;
// otherwise record() does. The caller sets the materials.
Result<EditedMesh> makeMesh(SceneEditor::State& state, std::span<const PrimitiveView> primitives,
                            std::vector<BlasInput>* inputs);
// Adds an instance whose mesh and materials have been checked.
InstanceHandle placeInstance(SceneEditor::State& state, EditedInstance instance);
// Finds the sampler, or makes it. Error "scene-edit-room".
Result<std::uint32_t> samplerIndex(SceneEditor::State& state, const package::SamplerEntry& entry);
// Writes a material's record. Lights follow if its emission has changed.
void writeMaterial(SceneEditor::State& state, std::uint32_t material, std::span<const std::uint8_t> record);

// --- Emissive triangles (edit_emitters.cpp) ---

// Returns the texels of a texture that may be an emission, or null.
std::shared_ptr<const EmissionTexels> emissionTexels(const SceneEditor::State& state, const ImageView& image,
                                                     bool srgb);
// Notes that an instance, whose geometry records have been written, is or was a light.
void noteEmitters(SceneEditor::State& state, InstanceHandle handle, const EditedInstance& instance);
// Notes that an instance has moved, or was shown, hidden or (`removed`) removed.
void moveEmitters(SceneEditor::State& state, InstanceHandle handle, bool removed = false);
// Notes that a texture has another image.
void replaceEmission(SceneEditor::State& state, TextureHandle texture);
// Returns the emissive triangles of all instances that are shown, and these instances.
Emitters gatherEmitters(SceneEditor::State& state);
std::vector<InstanceView> emissiveViews(const SceneEditor::State& state);

// Records the pending edits, for a frame that is at or after the last one.
Status recordEdits(SceneEditor::State& state, VkCommandBuffer commands, std::uint64_t frame);

std::string placeOf(const char* what, std::uint32_t index);
// Error "scene-edit-handle".
Diagnostic unknownHandle(const char* what);

}  // namespace glint
