// The content of a scene: entries that handles name, the records that the device has copies of, and the work
// that the device still has to do. The upload, poses, edits and compaction write it by the same functions,
// and recordChanges() brings the device up to date.
//
// A scene that is not edited is sealed: a BLAS has all primitives of a mesh that are seen alike, alpha tests
// are decided where they can be, and records of materials are the package's. The meshes of other scenes have
// a BLAS for each primitive, and the TLAS holds the properties that follow from materials, so that a change
// of materials builds no BLAS. Instances that SceneEditor::seal() has sealed share BLASes of several
// primitives, until an edit makes these differ in such a property.
#pragma once

#include "context/commands.h"
#include "context/upload.h"
#include "data/acceleration.h"
#include "data/deformer.h"
#include "data/emitters.h"
#include "data/geometry.h"
#include "data/instance_math.h"
#include "data/motion_bounds.h"
#include "data/retired.h"
#include "data/scene_checks.h"
#include "scene/case_table.h"
#include "scene/draw_runs.h"
#include "scene/gpu_scene_state.h"
#include "scene/record_store.h"
#include "scene/scene_records.h"
#include "scene/scene_upload.h"
#include "scene/top_level.h"

#include <glint/package.h>
#include <glint/result.h>
#include <glint/scene.h>

#include <algorithm>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace glint {

// How often things use another one, by their index: primitives of a mesh or an instance a material, and
// materials a texture.
using Users = std::map<std::uint32_t, std::uint32_t>;

// Counts a use more or less.
inline void countUse(Users& users, std::uint32_t user, bool adds) {
    std::uint32_t& count = users[user];
    count = adds ? count + 1 : count - 1;
    if (count == 0) {
        users.erase(user);
    }
}

// A texture of a scene that is edited. Its image is GpuScene::State::textures at the handle's index.
struct StoredTexture {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    bool srgb = false;
    package::TextureEntry::Dimension dimension = package::TextureEntry::Dimension::Flat;
    std::shared_ptr<const EmissionTexels> texels{};  // of a colour
    Users materials{};
};

// A material of a scene that is edited. Its record is in SceneStore::materials at the handle's index.
struct StoredMaterial {
    std::vector<SceneEditor::MaterialKey> keys;
    std::vector<SceneEditor::TextureUse> textures;
    bool isOwn = false;         // an edit has added or replaced it; else keys and textures are the package's
    bool hasOwnValues = false;  // an edit or the host has given its values
    Users meshes{};
    Users instances{};  // that have it in the place of their mesh's own
};

// A part and its BLAS, which instances share that keep their shape and are not sealed.
struct StoredPart : MeshPart {
    AccelerationStructure blas{};      // without a handle unless StoredMesh::isOpen
    std::optional<BlasBuild> build{};  // of a mesh whose vertices edits change
    BlasHistory history{};
    bool isBuilt = false;  // the same
    Box box = Box::nothing();
    std::optional<MotionBounds> bounds{};  // of a mesh that may change its shape
};

// Successive parts of a mesh in one BLAS. All of them are seen alike.
struct SealedRun {
    std::uint32_t first = 0;  // of StoredMesh::parts
    std::uint32_t end = 0;
    AccelerationStructure blas{};
    Box box = Box::nothing();
};

// The BLASes of sealed instances of a mesh whose materials part it into the same runs.
struct SealedForm {
    std::uint32_t number = 0;  // that no other form of the scene has
    bool decides = false;      // its BLASes rely on StoredPrimitive::split
    std::vector<SealedRun> runs;
    std::uint32_t instances = 0;  // how many have the form
};

// The place of a BLAS: a part of a mesh, a run of one of its forms, or a part of an instance with its own
// shape.
struct PartPlace {
    MeshHandle mesh;
    InstanceHandle instance{};
    std::uint32_t form = 0;  // SealedForm::number; 0: none
    std::uint32_t part = 0;  // or run
};

// BLASes that one recording builds, whose compacted sizes it asks for.
struct Compaction {
    UniqueQueryPool sizes;
    std::vector<std::pair<PartPlace, VkAccelerationStructureKHR>> parts;
    std::uint64_t frame = 0;  // of the recording
};

struct StoredPrimitive {
    static constexpr std::uint32_t kNoEntry = 0xFFFFFFFF;

    GpuPrimitive device;
    AttributeMask attributes = 0;
    MaterialHandle material{};                    // of a scene that is edited
    package::PrimitiveEntry entry{};              // of a sealed scene
    std::uint32_t entryIndex = kNoEntry;          // in PackageScene::primitives, if it was uploaded
    std::shared_ptr<const EmitterShape> shape{};  // of a light, or in a scene that is edited
    const DeviceMicromap* micromap = nullptr;     // of a sealed scene
    // Decided alpha tests of a scene that is edited, with the material of the upload.
    std::optional<OpacitySplit> split{};
    MaterialHandle splitMaterial{};
    DeformSource source{};
};

struct StoredMesh {
    std::vector<StoredPrimitive> primitives;
    std::vector<StoredPart> parts;
    std::uint32_t geometryCount = 0;  // records of an instance, without those of decided parts
    std::uint32_t decidedCount = 0;   // records of the parts of triangles whose alpha test was decided
    std::size_t mainParts = 0;        // the parts before those
    std::uint32_t jointCount = 0;     // joints that a pose must have
    std::uint32_t weightCount = 0;    // the most morph targets of a primitive
    std::shared_ptr<const MotionBounds> bounds{};  // if the mesh may change its shape
    std::vector<std::uint32_t> instances{};        // their indices, in no order
    bool changes = false;                          // edits may give it other vertices
    bool isOpen = false;                           // its parts have BLASes
    std::vector<std::unique_ptr<SealedForm>> forms{};

    bool mayDeform() const {
        return jointCount > 0 || weightCount > 0;
    }
    // Returns whether the pose moves vertices.
    bool deformsIn(const InstanceView& pose) const {
        return std::ranges::any_of(primitives, [&](const StoredPrimitive& primitive) {
            return primitive.source.moves(!pose.joints.empty(), !pose.morphWeights.empty());
        });
    }
};

// The vertices and BLASes of an instance that changes its shape.
struct OwnShape {
    std::vector<DeformedVertices> vertices;     // by primitive
    std::vector<AccelerationStructure> blases;  // by part
    std::vector<BlasBuild> builds;              // the same
    std::vector<BlasHistory> histories;         // the same
    IndexRange pose;                            // in SceneStore::poses: rows of joints, then weights
    std::uint32_t joints = 0;
    std::uint32_t weights = 0;
    IndexRange records;  // in SceneStore::deforms, one for each primitive that moves
    bool isBuilt = false;
};

struct StoredInstance {
    MeshHandle mesh;
    Rows objectToWorld{};
    bool visible = true;
    std::vector<MaterialHandle> materials;  // one for each primitive of the mesh; some may name nothing
    std::uint32_t firstGeometry = 0;
    std::uint32_t geometryCount = 0;  // 0 if a sealed scene that stays still leaves the instance out
    // The records of decided parts follow those of all instances, so that a decision changes the number of no
    // other record, on which the noise of blended alpha depends.
    std::optional<std::uint32_t> firstDecided{};
    std::uint32_t placeInMesh = 0;  // in StoredMesh::instances
    std::unique_ptr<OwnShape> shape{};
    SealedForm* form = nullptr;  // of the mesh; null unless the instance is sealed

    bool isShown() const {
        return visible && isInvertible(objectToWorld);
    }
};

struct EmissiveInstance {
    InstanceHandle handle;
    std::uint32_t number = 0;  // EmitterPart::instance, of those that were lights at the last recording
};

struct QueuedBuild {
    BlasBuild build;
    PartPlace place;
};

struct SceneStore : SceneRecords {
    SceneStore(GpuScene::State& owner, const Package& package, const SceneView& view);

    GpuScene::State& scene;
    // Settings of the upload.
    bool moves = false;     // GpuScene::update() gives poses
    bool editable = false;  // the scene has an editor; otherwise it is sealed
    BlasCapacity capacity;
    BlasCapacity sealedCapacity;    // of a BLAS of a sealed instance
    LeafOrder leafOrder = nullptr;  // null: structures get their input as it is
    SceneView::VertexForm vertices = SceneView::VertexForm::Compact;
    bool dataAccess = false;                         // BLASes let shaders read positions
    std::optional<package::EmissionEntry> emission;  // none without emissive lights
    std::vector<package::SamplerEntry> samplers;     // of GpuScene::State::samplers
    DeviceImage white;                               // for places without a texture

    // Scenes that are edited.
    std::optional<CaseTable> cases;
    bool otherTexels = false;  // an edit has replaced the image of a texture
    Slots<StoredTexture, TextureHandle> textures;
    Slots<StoredMaterial, MaterialHandle> materialSlots;

    Slots<StoredMesh, MeshHandle> meshes;
    Slots<StoredInstance, InstanceHandle> instanceSlots;
    Slots<LightView, LightHandle> lightSlots;
    std::vector<LightHandle> lightOrder;  // the place of a light is the index of its record

    std::vector<TextureHandle> uploadedTextures;  // by ScenePackage::textures
    // Handles by their numbers at the upload; textures and materials by those of the package.
    std::vector<TextureHandle> firstTextures;
    std::vector<MaterialHandle> firstMaterials;
    std::map<std::uint32_t, MeshHandle> firstMeshes;
    std::vector<InstanceHandle> firstInstances;
    std::vector<LightHandle> firstLights;
    // The attributes of the primitives of the upload, by their places in PackageScene::primitives.
    std::vector<std::pair<std::uint32_t, AttributeMask>> firstAttributes;

    RecordArray poses{sizeof(gpu::vec4)};
    RecordArray deforms{sizeof(gpu::DeformRecord)};
    RunAllocator geometryRuns;
    RunAllocator poseRuns;
    RunAllocator deformRuns;
    TopLevel topLevel;
    DrawRuns draws;

    // Instances that change their shape, and those of them with another pose since the last recording.
    std::optional<DeformPass> deformPass;
    std::set<std::uint32_t> shaped;          // by index
    std::set<std::uint32_t> reshaped;        // by index
    std::set<std::uint32_t> reshapedMeshes;  // by index: those with other vertices
    std::uint64_t shapeVersion = 0;  // changes when geometry records do, if some instance has its own shape

    // Instances with a material that is a light, by generation: in the order in which they were added.
    std::map<std::uint32_t, EmissiveInstance> emissiveInstances;
    std::vector<InstanceHandle> numberedEmitters;  // by EmissiveInstance::number
    bool keepsDark = false;  // the hierarchy of lights has leaves for triangles that are hidden or dark
    std::set<std::uint32_t> emissiveMaterials;  // of those that were shown at the last recording
    EmitterMeans emitterMeans;
    // Returns the texels of a texture of a sealed scene by its number. It exists during the upload.
    std::function<std::shared_ptr<const EmissionTexels>(std::uint32_t)> texelsOf;

    // The work of the next recording.
    std::unique_ptr<Uploader> ownUploader;  // null in the upload, which has one of its own
    Uploader* uploader = nullptr;
    // Builds of BLASes that instances share, by their destinations.
    std::map<VkAccelerationStructureKHR, QueuedBuild> builds;
    std::set<std::uint32_t> sealing;   // instances, by index, that are to be sealed
    std::set<std::uint32_t> reformed;  // meshes, by index, whose instances may have or lack BLASes
    std::uint32_t lastForm = 0;        // SealedForm::number
    // Materials, by index, whose alpha is still that by which tests were decided.
    std::set<std::uint32_t> decidedMaterials;
    bool drawsDirty = false;
    bool lightsDirty = true;     // other lights
    LightMoves lightMoves;       // the same lights and emissive triangles with other values
    bool emittersDirty = false;  // other emissive triangles
    bool setDirty = true;
    bool trims = false;

    AlignedBuffer tlasScratch;
    VkDeviceSize tlasScratchBytes = 0;
    std::uint32_t tlasCapacity = 0;  // instances
    std::uint32_t firstTlasCapacity = 0;
    Retired retired;
    std::uint64_t lastFrame = 0;
    std::optional<std::uint64_t> completed;  // the last frame that the device is known to have completed
    MemoryPool building;                     // of BLASes until they are compacted
    std::deque<Compaction> compactions;      // by ascending frame
    bool compacts = false;                   // the next recording makes compacted copies
    // Null after the upload, in which BLASes are built together.
    SceneUpload* upload = nullptr;

    MotionShape posedShape;  // of the upload, which every pose must have
    // The values of the last pose, or of the upload. A pose writes what differs from them, so edits of other
    // things stay.
    std::vector<Rows> lastRows;
    std::vector<bool> lastVisible;
    std::vector<gpu::LightRecord> lastLights;
    std::optional<Timer> timer;  // deform, BLASes, TLAS
    GpuScene::MotionStatistics statistics;
    bool posed = false;

    bool keeps() const {
        return moves || editable;
    }
};

// --- Meshes and instances (store_meshes.cpp) ---

// The content of a mesh. `positions` and `ordered` are as many as the primitives, whose positions are those
// that the device reads; `ordered` may be empty, as may the indices of a primitive in it.
struct MeshContent {
    std::span<const PrimitiveView> primitives;
    std::span<const GridPositions> positions;
    std::span<const std::vector<std::uint32_t>> ordered{};
    // Sealed meshes have the next three, by primitive.
    std::vector<const package::PrimitiveEntry*> entries{};
    std::vector<std::optional<OpacitySplit>> splits{};
    std::vector<const DeviceMicromap*> micromaps{};
    bool isShared = true;  // some instance keeps the mesh's shape
    bool changes = false;  // edits may give it other vertices
};
// Uploads a mesh, whose BLASes the next recording builds. The caller sets the materials, or the entries. With
// an error nothing changes, unless this is the upload.
Result<MeshHandle> addMesh(SceneStore& store, const Package& package, const MeshContent& content);
// Gives a primitive of a mesh that may change other vertices, which have been checked.
Status changeVertices(SceneStore& store, MeshHandle mesh, std::size_t primitive,
                      const SceneEditor::VertexValues& vertices);
// Retires a mesh that no instance has.
void retireMesh(SceneStore& store, MeshHandle mesh);

// Adds an instance whose mesh and materials have been checked. A pose with joints or weights gives it a shape
// of its own, for which the scene's first such instance needs `package`. Errors: those of memory, and
// "scene-package" (the package has no pass that deforms).
Result<InstanceHandle> placeInstance(SceneStore& store, const Package* package, StoredInstance instance,
                                     const InstanceView& pose);
void removeInstance(SceneStore& store, InstanceHandle handle);
void moveInstance(SceneStore& store, InstanceHandle handle, const Rows& objectToWorld, bool visible);
// Gives the instance another mesh and materials, in its rest pose. Both have been checked.
void exchangeMesh(SceneStore& store, InstanceHandle handle, MeshHandle mesh,
                  std::span<const MaterialHandle> materials);
// Gives a primitive of the instance a material of its own, which has been checked, or takes it away.
void setOwnMaterial(SceneStore& store, InstanceHandle handle, std::size_t primitive, MaterialHandle material);
// Gives the instance the joints and weights of `pose`, or takes its own shape away if it has neither. The
// errors are those of placeInstance().
Status poseInstance(SceneStore& store, const Package* package, InstanceHandle handle,
                    const InstanceView& pose);
// The joints and weights of an instance. The spans hold until the store changes.
InstanceView poseOf(const SceneStore& store, const StoredInstance& instance);

// Counts a use of the material, if it names one, more or less.
void countUse(Slots<StoredMaterial, MaterialHandle>& materials, MaterialHandle material,
              Users StoredMaterial::*users, std::uint32_t user, bool adds);
// Error "scene-geometries".
Diagnostic tooManyGeometries(const std::string& where);

// Forgets the records after the last geometry.
void shrinkGeometries(SceneStore& store);
// Writes the geometry records of an instance, whose materials have been checked.
void writeGeometries(SceneStore& store, InstanceHandle handle, const StoredInstance& instance);
// The entry of a primitive of an instance: its key, its shader and its material.
package::PrimitiveEntry entryOf(const SceneStore& store, const StoredInstance& instance,
                                std::size_t primitive);
// Puts the instance's parts into the TLAS, at their places, or takes them out if it is not shown.
void placeParts(SceneStore& store, const StoredInstance& instance);
// Writes where deformed vertices and poses are, after one of the arrays has moved to these addresses.
void writeDeforms(SceneStore& store, std::uint32_t instance, VkDeviceAddress poses);
// Notes what the raster pass draws of an instance, if it is shown.
void placeDraws(SceneStore& store, InstanceHandle handle, const StoredInstance& instance);

// Calls visit(index, geometry) for the parts of an instance, with their first geometry records.
template <typename Visit>
void forEachPart(const StoredMesh& mesh, const StoredInstance& instance, const Visit& visit) {
    std::uint32_t geometry = instance.firstGeometry;
    const std::size_t end = instance.geometryCount == 0 ? 0
                            : instance.firstDecided     ? mesh.parts.size()
                                                        : mesh.mainParts;
    for (std::size_t part = 0; part < end; ++part) {
        if (part == mesh.mainParts) {
            geometry = *instance.firstDecided;
        }
        visit(part, geometry);
        geometry += static_cast<std::uint32_t>(mesh.parts[part].ranges.size());
    }
}

// The geometry record of a part of an instance, in a scene that is edited, where a part has one.
inline std::uint32_t geometryOf(const StoredMesh& mesh, const StoredInstance& instance, std::size_t part) {
    return static_cast<std::uint32_t>(part < mesh.mainParts ? instance.firstGeometry + part
                                                            : *instance.firstDecided + part - mesh.mainParts);
}

// Calls visit(range, primitive, geometry) for all geometry records of an instance.
template <typename Visit>
void forEachGeometry(const StoredMesh& mesh, const StoredInstance& instance, const Visit& visit) {
    forEachPart(mesh, instance, [&](std::size_t part, std::uint32_t geometry) {
        for (const TriangleRange& range : mesh.parts[part].ranges) {
            visit(range, mesh.primitives[range.primitive], geometry++);
        }
    });
}

// The structure at a place, or null if edits have removed it.
AccelerationStructure* structureAt(SceneStore& store, const PartPlace& place);

// --- BLASes that instances share (store_blases.cpp) ---

// The input of the build of successive parts. `shape` is that of an instance with one of its own, or null.
// `decides`: without the triangles whose alpha tests were decided, in a scene that is edited.
BlasInput inputOf(const SceneStore& store, const StoredMesh& mesh, std::span<const StoredPart> parts,
                  const OwnShape* shape, bool decides = false);
// Makes the structure of a BLAS, and gives the build its destination.
Status makeStructure(SceneStore& store, BlasBuild& build, bool isCompacted, AccelerationStructure& made);
// Takes a structure out of its place. One that waits to be built is not built.
AccelerationStructure takeStructure(SceneStore& store, AccelerationStructure& place);
// Makes the BLASes of a mesh's parts. With an error the mesh has none.
Status openMesh(SceneStore& store, MeshHandle handle, StoredMesh& mesh);
// Lets the next recording seal an instance, if it can be.
void sealInstance(SceneStore& store, InstanceHandle handle);
// Returns whether rays stop at a part of an instance, where the TLAS has to say so.
bool isOpaque(const SceneStore& store, const StoredInstance& instance, std::size_t part);
// Unseals instances that rely on the alpha of a material.
void forgetDecisions(SceneStore& store, std::uint32_t material);
// Unseals the instance if its parts are no longer seen alike where they share a BLAS, or alpha tests are open
// again.
void checkSeal(SceneStore& store, StoredInstance& instance);
// Takes the instance's form away, if it has one.
void leaveForm(SceneStore& store, StoredInstance& instance);
// Retires the BLASes of a form that no instance has.
void retireForm(SceneStore& store, SealedForm& form);
// Unseals instances whose BLASes have several primitives, and seals them again as they can be.
void partBlases(SceneStore& store);
// Gives instances that are to be sealed their forms, makes the BLASes that others lack, and retires those
// that no instance has. Errors: those of memory; another call goes on from there.
Status settleBlases(SceneStore& store);

// --- Compaction (compaction.cpp) ---

// Notes that the device has completed the frame.
void completeFrames(SceneStore& store, std::uint64_t frame);
// Queues compacted copies of the BLASes whose builds the device has completed, in the place of the larger
// ones. Errors: those of memory and Vulkan's calls; another call tries again.
Status compactBuilt(SceneStore& store);

// --- Materials of scenes that are edited (edit_materials.cpp) ---

// Finds the shading of a material on a primitive. Has the errors that SceneEditor lists.
Result<Shading> shadingOf(const SceneStore& store, MaterialHandle material, AttributeMask attributes);
// The same for a material with these keys. `where` is for messages.
Result<Shading> shadingBy(const CaseTable& cases, std::span<const SceneEditor::MaterialKey> keys,
                          AttributeMask attributes, const std::string& where);
// Lists the key in the report if the fallback shades it.
void addTo(SceneEditor::Report& report, const CaseTable& cases, MaterialHandle material,
           const Shading& shading);
// The textures of a material of the package, whose textures have these handles by their numbers. They may
// name what edits have removed.
std::vector<SceneEditor::TextureUse> usesOf(const PackageScene& known,
                                            std::span<const TextureHandle> textures, std::size_t material);
// Returns how many samplers are there if this one is not.
std::size_t findSampler(const SceneStore& store, const package::SamplerEntry& entry);
// Makes the sampler, unless it is there. Error "scene-edit-room".
Status ensureSampler(SceneStore& store, const package::SamplerEntry& entry);
Diagnostic noRoomForSampler(const SceneStore& store);
// Writes into a record of this layout which textures it has. They and their samplers must be there.
void settleTextures(const SceneStore& store, const MaterialTable& layout,
                    std::span<const SceneEditor::TextureUse> uses, std::span<std::uint8_t> record);
// The instances that show the material, by index.
std::set<std::uint32_t> instancesWith(const SceneStore& store, const StoredMaterial& material);
// The material of a primitive of an instance.
MaterialHandle materialOf(const SceneStore& store, const StoredInstance& instance, std::size_t primitive);
// Writes a material's record. Lights follow if its emission has changed.
void writeMaterial(SceneStore& store, std::uint32_t material, std::span<const std::uint8_t> record);

// --- Another package of a scene that is edited (edit_package.cpp) ---

// The content that follows from a package.
struct EditedTables {
    CaseTable cases;
    Slots<StoredMaterial, MaterialHandle> materialSlots;
    std::vector<TextureHandle> firstTextures;
    std::vector<MaterialHandle> firstMaterials;
    RecordStore materials;
    std::map<std::uint32_t, std::vector<MaterialHandle>> meshMaterials;  // of meshes that were uploaded
    std::vector<Users> textureUsers;                                     // by index
    SceneEditor::Report report;                                          // materials without a case
};
// Gives a material of the package the key of one of its primitives.
void addKey(StoredMaterial& material, const package::PrimitiveEntry& entry, AttributeMask attributes);
// Makes the content for a package that agrees with the uploaded data. `known` may be a scene without tables.
// Errors: "scene-package", "texture-trusted", and those that SceneEditor lists for materials.
Result<EditedTables> editedTables(const SceneStore& store, const std::shared_ptr<const Package>& package,
                                  const PackageScene& known);
// Exchanges the store's content and this one.
void exchangeTables(SceneStore& store, EditedTables& tables);

// --- Lights and emissive triangles (store_lights.cpp) ---

// Returns whether the emission of a material may have a texture. Requires emissive lights.
bool hasEmissionTexture(const SceneStore& store);
// Returns the texels of a texture that may be an emission, by this or by another package, or null.
std::shared_ptr<const EmissionTexels> emissionTexels(const ImageView& image, bool srgb);
LightHandle addLight(SceneStore& store, const LightView& light);
void setLight(SceneStore& store, LightHandle handle, const LightView& light);
void removeLight(SceneStore& store, LightHandle handle);
// Notes that an instance, whose geometry records have been written, is or was a light.
void noteEmitters(SceneStore& store, InstanceHandle handle, const StoredInstance& instance);
// Notes that an instance has moved, or was shown or hidden (`changes`), or `removed`.
void moveEmitters(SceneStore& store, InstanceHandle handle, bool changes, bool removed = false);
// Notes that a texture has another image.
void replaceEmission(SceneStore& store, const StoredTexture& texture);
// Forgets which triangles are lights, for a package without emissive lights.
void forgetEmitters(SceneStore& store);
// Brings records of emissive triangles and the hierarchy of lights up to date.
void settleLights(SceneStore& store);

// --- The device (store_record.cpp) ---

// Error "scene-edit-frame": the frame is before the last one.
Status checkFrame(const SceneStore& store, std::uint64_t frame);
// Records everything that has changed, for a frame that is at or after the last one. `builds` overrules the
// rules for refits. `leftovers`, if given, gets the resources that are no longer needed when the recording is
// complete; else complete() for the frame frees them. With an error nothing is recorded, and the changes wait
// for the next call.
Status recordChanges(SceneStore& store, VkCommandBuffer commands, std::uint64_t frame,
                     MotionView::Builds builds = MotionView::Builds::ByRule, RetiredLot* leftovers = nullptr);
// Reads the device times of the last recording into milliseconds of deforming, BLASes and the TLAS.
Result<std::vector<double>> readTimes(const SceneStore& store);

// --- The upload (store_upload.cpp) ---

// Makes the content of a scene and records its upload. `known` may be a scene without tables.
Status uploadScene(GpuScene::State& state, const Package& package, const PackageScene& known,
                   const SceneView& view, SceneUpload& upload, VkCommandBuffer commands);

std::string placeOf(const char* what, std::uint32_t index);
// Error "scene-edit-handle".
Diagnostic unknownHandle(const char* what);
// Finds what a handle names. Error "scene-edit-handle", with the name of the kind of thing.
template <typename Entries, typename Handle>
auto findNamed(Entries& entries, Handle handle, const char* what) -> Result<decltype(entries.find(handle))> {
    auto* const entry = entries.find(handle);
    return entry != nullptr ? Result<decltype(entries.find(handle))>(entry) : unknownHandle(what);
}

}  // namespace glint
