// Scenes on the device: their upload, their movement, their edits, and the textures that reach them later.
#pragma once

#include <glint/context.h>
#include <glint/package.h>
#include <glint/result.h>
#include <glint/scene_view.h>

#include <vulkan/vulkan_core.h>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace glint {

struct SceneStore;

// --- Edits of a scene that is on the device and drawn (docs/live.md, "Editing a scene") ---

// Names something in a scene. A handle stays valid until the thing that it names is removed. Its index may
// then be used again, with another generation, so an old handle names nothing. The initial value names
// nothing.
template <typename Kind>
struct SceneHandle {
    std::uint32_t index = 0;
    std::uint32_t generation = 0;  // 0: names nothing

    bool operator==(const SceneHandle&) const = default;
};
using TextureHandle = SceneHandle<struct TextureKind>;
using MaterialHandle = SceneHandle<struct MaterialKind>;
using MeshHandle = SceneHandle<struct MeshKind>;
using InstanceHandle = SceneHandle<struct InstanceKind>;
using LightHandle = SceneHandle<struct LightKind>;

// SceneView::packageScene of an editable scene that has nothing of the package's scenes: its materials and
// meshes are all added by edits.
inline constexpr std::uint32_t kNoPackageScene = 0xFFFFFFFF;

// The attributes of a primitive that decide about keys, as bits.
using AttributeMask = std::uint32_t;
inline constexpr AttributeMask kAttributeNormals = 1;
inline constexpr AttributeMask kAttributeTangents = 2;
inline constexpr AttributeMask kAttributeTexCoords0 = 4;
inline constexpr AttributeMask kAttributeTexCoords1 = 8;
inline constexpr AttributeMask kAttributeColors = 16;  // colours that are not all (1, 1, 1, 1)
// The bits from this one on stand for the attributes of Package::attributes(), in their order.
inline constexpr std::uint32_t kDeclaredAttributesShift = 8;

// Returns the attributes that the primitive has, as far as `package` knows them. Reads all colours.
AttributeMask attributesOf(const Package& package, const PrimitiveView& primitive);

// Edits the textures, materials, meshes, instances and lights of a GpuScene. The Package must outlive the
// scene.
//
// Each function checks its arguments and takes effect in host memory at once, or returns an error and changes
// nothing. Spans are read in the call and not kept. record() then records the work of the device for all
// edits since the last record(). Nothing waits for the device. The functions may not be called from several
// threads at the same time, nor during Renderer::record().
//
// Errors of all functions: "scene-edit-handle" (a handle names nothing), "scene-edit-used" (something else
// still uses the thing to be removed), "scene-edit-value" (a number is not finite, or an index out of range),
// and those of memory and Vulkan's calls. Errors of those that give a primitive a material: "scene-edit-key"
// (the material has no MaterialKey for the primitive's attributes), "scene-edit-feature" (the package has no
// code for a feature, which the fallback lacks as well) and "scene-edit-case" (no case of the package has the
// key, or no code samples lights with the key, and the package has no fallback); the message has the names of
// the features.
class SceneEditor {
public:
    ~SceneEditor() = default;
    SceneEditor(const SceneEditor&) = delete;
    SceneEditor& operator=(const SceneEditor&) = delete;

    // The features of a material on primitives with certain attributes, as with AlphaPolicy::Stochastic. They
    // and the flags also say what the package may ignore: alpha, light that passes the material, and light
    // that it emits. Glint::session makes these from a material of glTF (glint/session/material_source.h).
    struct MaterialKey {
        AttributeMask attributes = 0;
        package::KeyWords features;       // the key, with all lobes
        package::KeyWords hitFeatures;    // those that hits keep; the same unless the package has --hit-lobes
        std::uint32_t geometryFlags = 0;  // kGeometry* of shaders/interop/scene.h
    };

    // A texture of a material.
    struct TextureUse {
        std::uint32_t slot = 0;  // of the record: below MaterialTable::textureCount
        TextureHandle texture;
        package::SamplerEntry sampler{0, 0, 1, 1, 1, 1};
        std::uint32_t texCoord = 0;  // UV set: 0 or 1
    };

    // A material that the package does not have, or has with other values.
    struct MaterialSource {
        // A record in the package's layout (MaterialRecord of its C++ header). Texture transforms are taken
        // from it; `textures` says which textures it has.
        std::span<const std::uint8_t> record;
        // One for each set of attributes that a primitive with this material has or will have.
        std::span<const MaterialKey> keys;
        std::span<const TextureUse> textures;
    };

    // The report of an edit.
    struct Report {
        // A material on a primitive for which the package has no shader.
        struct MissingCase {
            MaterialHandle material;
            package::KeyWords features;      // its key
            std::vector<std::string> names;  // the names of these features
        };
        // Materials that the fallback shades from now on. Each key is listed once in an edit.
        std::vector<MissingCase> missing;
    };

    struct EditedPrimitive {
        PrimitiveView geometry;  // its numbers of mesh and primitive are not read
        MaterialHandle material;
    };

    // New vertices of a primitive: as many as it has. Empty spans leave the normals or tangents as they are.
    struct VertexValues {
        std::span<const std::array<float, 3>> positions;
        std::span<const std::array<float, 3>> normals{};
        std::span<const std::array<float, 4>> tangents{};
    };

    // Whether edits give a mesh other vertices.
    enum class MeshUse : std::uint32_t {
        Fixed,
        Changing,  // vertices are stored in full, and BLASes are built fast and can be refitted
    };

    struct AddedMesh {
        MeshHandle mesh;
        Report report;
    };

    struct AddedInstance {
        InstanceHandle instance;
        Report report;
    };

    // An instance that is added.
    struct PlacedMesh {
        MeshHandle mesh;
        std::array<float, 12> objectToWorld{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};  // three rows of four
        bool visible = true;
        // Empty, or one for each primitive of the mesh. A handle that names nothing stands for the mesh's own
        // material.
        std::span<const MaterialHandle> materials{};
        // As in InstanceView: the pose of a mesh that follows joints or has morph targets.
        std::span<const std::array<float, 12>> joints{};
        std::span<const float> morphWeights{};
    };

    // These return the handle of an uploaded thing by its number in the present package's scene (textures,
    // materials, meshes) or in SceneView (instances, lights). A number that was not uploaded, or was removed,
    // gives a handle that names nothing.
    TextureHandle texture(std::uint32_t number) const;
    MaterialHandle material(std::uint32_t number) const;
    MeshHandle mesh(std::uint32_t number) const;
    InstanceHandle instance(std::uint32_t number) const;
    LightHandle light(std::uint32_t number) const;

    // Textures get a full pyramid of mips. With `srgb` the values are colours. Errors: "scene-image",
    // "scene-edit-room" (SceneView::textureRoom textures are there).
    Result<TextureHandle> addTexture(const ImageView& image, bool srgb);
    // Replaces the image of a texture by another one of any size and format, for all materials that use it.
    // Errors: "scene-image", "texture-trusted" (Package::trustTextures()).
    Status replaceTexture(TextureHandle texture, const ImageView& image);
    Status removeTexture(TextureHandle texture);

    // Error "scene-edit-room": there are SceneView::samplerRoom kinds of samplers.
    Result<MaterialHandle> addMaterial(const MaterialSource& source);
    // Replaces a material by another, which may have other keys and textures. Takes time in proportion to the
    // scene's instances if the keys of its primitives change.
    Result<Report> setMaterial(MaterialHandle material, const MaterialSource& source);
    // Replaces the values of a material, whose keys and textures stay. The caller makes sure that the values
    // agree with the keys. Texture transforms are values. In packages with emissive lights, a material is a
    // light if its key has kGeometryEmitter and its values emit light.
    Status setMaterialValues(MaterialHandle material, std::span<const std::uint8_t> record);
    Status removeMaterial(MaterialHandle material);

    // Adds a mesh of at least one primitive with a triangle. Its BLASes are built by the commands of
    // record(). Errors: "scene-attribute", "scene-index".
    Result<AddedMesh> addMesh(std::span<const EditedPrimitive> primitives, MeshUse use = MeshUse::Fixed);
    // Gives a primitive of a mesh with MeshUse::Changing other vertices, for all instances, as a program that
    // simulates cloth does. record() copies them and refits the BLASes, or builds them anew by the rules of
    // GpuScene::update(). Motion counts such vertices as still. Errors: "scene-edit-value" (the mesh is
    // fixed, or has joints or morph targets; another number of vertices, or one that is not finite), and
    // those of memory.
    Status setVertices(MeshHandle mesh, std::uint32_t primitive, const VertexValues& vertices);
    // Gives a primitive of the mesh another material. Instances that have none of their own follow.
    Result<Report> setMeshMaterial(MeshHandle mesh, std::uint32_t primitive, MaterialHandle material);
    Status removeMesh(MeshHandle mesh);

    // An instance that is not visible, or whose transform is flattened, is neither drawn nor hit. Errors:
    // "scene-geometries", and those of poseInstance().
    Result<AddedInstance> addInstance(const PlacedMesh& placed);
    Status moveInstance(InstanceHandle instance, const std::array<float, 12>& objectToWorld);
    // Gives the instance another pose: a transform for each joint of its mesh and a weight for each morph
    // target, as in InstanceView. An instance with a pose has vertices and BLASes of its own, which record()
    // computes and refits; without joints and weights it shares those of the mesh. Errors: "scene-index" (the
    // mesh follows more joints), "scene-motion" (there are more weights than targets, or a number is not
    // finite), "scene-package" (the package has no pass that moves vertices).
    Status poseInstance(InstanceHandle instance, std::span<const std::array<float, 12>> joints,
                        std::span<const float> morphWeights);
    Status showInstance(InstanceHandle instance, bool visible);
    // Gives the instance another mesh and materials, as addInstance() does. Its place stays.
    Result<Report> setInstanceMesh(InstanceHandle instance, MeshHandle mesh,
                                   std::span<const MaterialHandle> materials = {});
    // Gives a primitive of the instance a material of its own, as a variant of KHR_materials_variants does. A
    // handle that names nothing takes it away again.
    Result<Report> setInstanceMaterial(InstanceHandle instance, std::uint32_t primitive,
                                       MaterialHandle material);
    Status removeInstance(InstanceHandle instance);

    // Seals instances whose meshes and materials will stay as they are, for faster rays: the next record()
    // builds BLASes for the successive primitives of a mesh whose materials are alike in opacity and sides.
    // The TLAS has one instance for each of these BLASes, and the BLASes of single primitives are freed if no
    // other instance has them. Sealed instances can be edited like others. They stay sealed when they are
    // moved, shown or hidden, and when their materials change in other ways. Another mesh, a pose, and
    // materials that differ in opacity or sides unseal the instance alone; record() then builds the BLASes
    // that it lacks. An instance that gains nothing stays as it is. Nothing is merged if triangles are sorted
    // (TraversalOrder) or a strategy of the package has a ray tracing pipeline of its own. Alpha tests are
    // decided only for instances of an upload with SceneView::sealed.
    Status seal(std::span<const InstanceHandle> instances);

    // Lights keep their order when one is removed. If lights or emissive triangles come or go, record()
    // builds the hierarchy of lights anew. If they move or get brighter, it gives them other bounds in the
    // one that is there, of which trim() makes a new one. Error "scene-light".
    Result<LightHandle> addLight(const LightView& light);
    Status setLight(LightHandle light, const LightView& view);
    Status removeLight(LightHandle light);

    // Records the edits since the last call into a command buffer of the caller's, in the recording state and
    // outside a render pass: copies, builds of added meshes and the build of the TLAS. Renderer::record() may
    // follow in the same command buffer; its accumulation should start anew. The commands must be submitted
    // before other commands that use the scene, to the Context's queue or ordered after its work. `frame` is
    // the number of the frame that the commands belong to, by the caller's count; it may not be below that of
    // the last call. BLASes that a completed frame has built are replaced by their compacted copies. Memory
    // that is no longer needed is freed by complete(). On an error nothing is recorded, and the edits wait
    // for the next call. Errors: "scene-edit-frame", "tlas-limit".
    Status record(VkCommandBuffer commands, std::uint64_t frame);
    // Says that the device has completed all commands of frames up to `frame`, and frees the resources that
    // they alone used. Command buffers of these frames may not be submitted again.
    void complete(std::uint64_t frame);
    // Lets the next record() shrink the buffers of records and the TLAS to their contents, but not below
    // their size at the upload, and build a hierarchy of lights anew that lights have moved in. Without it
    // buffers only grow.
    void trim();

    // Returns how many bytes wait for complete(): staging, scratch, and everything that was removed or
    // replaced.
    std::uint64_t retiredBytes() const;

    explicit SceneEditor(SceneStore& store) : store_(&store) {}

private:
    SceneStore* store_;
};

// The report of replacePackage(), of Renderer and of RaySteps: the pipelines and buffers that it keeps, and
// those that it makes.
struct PackageReplacement {
    // Pipelines that the new package has in common with the earlier one: their SPIR-V is the same.
    std::uint32_t pipelinesKept = 0;
    // Pipelines that are made, in the call or in the background.
    std::uint32_t pipelinesMade = 0;
    // The shader IDs, in the new package, of the cases with a pipeline of their own that is made. Only
    // strategies with a dispatch for each case have such pipelines.
    std::vector<std::uint32_t> casesMade{};
    // Buffers of the frame that have the size that the new package needs, and those that are made.
    std::uint32_t buffersKept = 0;
    std::uint32_t buffersMade = 0;
    // In a scene that is edited: the materials that the fallback of the new package shades.
    std::vector<SceneEditor::Report::MissingCase> missing{};
};

// The progress of the last replacement.
struct PackageProgress {
    std::uint64_t inUse = 0;    // replacements that recordings have begun to use
    bool pending = false;       // a package waits; recordings use the old one
    bool ready = false;         // the next recording uses the package that waits
    std::uint32_t missing = 0;  // pipelines that it still waits for
    // Why a pending package is not ready: a sentence for each Renderer and RaySteps of the scene that all
    // wait for. They are numbered by kind, in the order in which they were made.
    std::vector<std::string> waitsFor{};
    // Why the last replacement was given up; recordings continue with the old package. The next
    // replacePackage() clears it.
    std::optional<Diagnostic> error{};
};

// Textures whose finer levels reach the device while frames are drawn. docs/textures.md, "Streaming".

// Brings the levels of a scene's textures that the upload has left out (SceneView::streamsTextures), the
// coarsest first. Frames read the levels that were there when they were recorded. Nothing waits for the
// device. Textures have the numbers of PackageScene::textures, or TextureHandle::index in a scene that is
// edited.
//
// The functions may not be called at the same time as each other, SceneEditor's or Renderer::record().
class TextureStream {
public:
    ~TextureStream();
    TextureStream(const TextureStream&) = delete;
    TextureStream& operator=(const TextureStream&) = delete;

    // Records copies of about `mostBytes` bytes, and at least one row of blocks if something waits.
    // `commands` is a command buffer of the caller's, in the recording state and outside a render pass.
    // Recordings from then on read the levels that are complete. GpuScene::descriptorSet() is then another
    // one, and accumulated pictures should start anew if the result is above 0. In a scene that is edited the
    // next SceneEditor::record() takes them over. `frame` is the caller's number of the frame that the
    // commands belong to; it may not fall. The commands must be submitted, in the order of their recording.
    // Returns how many levels were completed. Has the errors of memory and Vulkan's calls, and "stream-frame"
    // (the number has fallen); nothing is then recorded.
    Result<std::uint32_t> record(VkCommandBuffer commands, std::uint64_t frame,
                                 std::uint64_t mostBytes = std::uint64_t{8} << 20);
    // Says that the device has completed all commands of frames up to `frame`, and frees the resources that
    // they alone used.
    void complete(std::uint64_t frame);

    // Leaves out levels finer than `level` of a texture, until another call asks for them. Levels that are on
    // the device stay. A number that names no texture changes nothing.
    void setFinest(std::uint32_t texture, std::uint32_t level);
    // Returns the finest level that new frames read: 0 for a texture that does not stream.
    std::uint32_t finest(std::uint32_t texture) const;

    struct Progress {
        std::uint32_t textures = 0;  // with levels that setFinest() allows and that are not there
        std::uint64_t bytes = 0;     // of these levels
    };
    Progress progress() const;
    // Returns how many bytes wait for complete().
    std::uint64_t retiredBytes() const;

    struct State;  // for the runtime's own sources
    State& state();
    explicit TextureStream(std::unique_ptr<State> state);

private:
    std::unique_ptr<State> state_;
};

// --- Scenes on the device ---

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
    // executes the commands; it may be if they were never submitted.
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
    // complete() frees the larger structures. In a scene that is edited it also records the edits that wait.
    // SceneEditor::record() and update() do the same by themselves. Errors: those of memory and Vulkan's
    // calls; another call tries again.
    Result<bool> recordCompaction(VkCommandBuffer commands, std::uint64_t frame);
    ~GpuScene();
    GpuScene(const GpuScene&) = delete;
    GpuScene& operator=(const GpuScene&) = delete;

    struct Statistics {
        std::uint64_t triangles = 0;  // triangles of all instances
        std::uint32_t geometries = 0;
        std::uint32_t instances = 0;
        std::uint32_t blasCount = 0;             // of the present ones, as the next
        std::uint64_t blasBytes = 0;             // compacted after recordCompaction()
        std::uint64_t blasUncompactedBytes = 0;  // of the upload
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

    // Returns the editor of a scene with SceneView::editable, or null for other scenes.
    // It lives as long as the scene.
    SceneEditor* editor();

    // Returns the stream of texture levels of a scene with SceneView::streamsTextures, or null for other
    // scenes. It lives as long as the scene.
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
    // In a scene that is edited, too, the pose is that of the uploaded instances, lights and materials. It
    // changes what differs from the pose before, so edits of anything that stays still in it last. Those that
    // edits have removed are passed over, and an instance with another mesh moves as a whole. The call
    // records the edits that wait.
    //
    // The spans are read in this call and not kept. Several updates may be in flight. `frame` is the caller's
    // number of the frame that the commands belong to; it may not fall, and complete() frees what only its
    // frames used. The recorded commands must be submitted before those of the next call, which builds upon
    // them. With an error nothing is recorded, but parts of the pose may be part of the next recording.
    // Errors: "scene-still" (the scene was uploaded as one that neither moves nor is edited),
    // "scene-edit-frame" (the number has fallen), "scene-motion" (another number of instances, lights, joints
    // or weights than at upload, another mesh, or a number that is not finite), "scene-light",
    // "scene-material" (other materials than at upload).
    Status update(VkCommandBuffer commands, const MotionView& motion, std::uint64_t frame);

    // Records an update for the frame of the last recording, submits it, waits for the device and calls
    // complete(). This is for tools and tests.
    Status updateAndWait(const MotionView& motion);

    // The work of the last update(). Times are device times in milliseconds; without timestamps on the
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
