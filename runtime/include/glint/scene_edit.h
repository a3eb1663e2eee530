// Edits of a scene that is on the device and drawn. docs/live.md, "Editing a scene", shows how to use it.
#pragma once

#include <glint/package.h>
#include <glint/result.h>
#include <glint/scene_view.h>

#include <vulkan/vulkan_core.h>

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace glint {

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

// The features of a material on primitives with certain attributes. Glint::scene_view makes these from a
// material of glTF (glint/scene_view/material_source.h).
struct MaterialKey {
    AttributeMask attributes = 0;
    std::uint64_t features = 0;       // the key, with all lobes
    std::uint64_t hitFeatures = 0;    // those that hits keep; the same unless the package has --hit-lobes
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
    // A record in the package's layout (MaterialRecord of its C++ header). Texture transforms are taken from
    // it; `textures` says which textures it has.
    std::span<const std::uint8_t> record;
    // One for each set of attributes that a primitive with this material has or will have.
    std::span<const MaterialKey> keys;
    std::span<const TextureUse> textures;
};

// A material on a primitive for which the package has no shader.
struct MissingCase {
    MaterialHandle material;
    std::uint64_t features = 0;      // its key
    std::vector<std::string> names;  // the names of these features
};

// The report of an edit.
struct EditReport {
    // Materials that the fallback shades from now on. Each key is listed once in an edit.
    std::vector<MissingCase> missing;
};

struct EditedPrimitive {
    PrimitiveView geometry;  // its numbers of mesh and primitive are not read
    MaterialHandle material;
};

struct AddedMesh {
    MeshHandle mesh;
    EditReport report;
};

struct AddedInstance {
    InstanceHandle instance;
    EditReport report;
};

// An instance that is added.
struct PlacedMesh {
    MeshHandle mesh;
    std::array<float, 12> objectToWorld{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};  // three rows of four
    bool visible = true;
    // Empty, or one for each primitive of the mesh. A handle that names nothing stands for the mesh's own
    // material.
    std::span<const MaterialHandle> materials{};
};

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
    ~SceneEditor();
    SceneEditor(const SceneEditor&) = delete;
    SceneEditor& operator=(const SceneEditor&) = delete;

    // These return the handle of an uploaded thing by its number in the package's scene (textures, materials,
    // meshes) or in SceneView (instances, lights). A number that was not uploaded, or was removed, gives a
    // handle that names nothing.
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
    Result<EditReport> setMaterial(MaterialHandle material, const MaterialSource& source);
    // Replaces the values of a material, whose keys and textures stay. The caller makes sure that the values
    // agree with the keys. Texture transforms are values. In packages with emissive lights, a material is a
    // light if its key has kGeometryEmitter and its values emit light.
    Status setMaterialValues(MaterialHandle material, std::span<const std::uint8_t> record);
    Status removeMaterial(MaterialHandle material);

    // Adds a mesh of at least one primitive with a triangle. Skins and morph targets are not supported. Its
    // BLASes are built by the commands of record() and are not compacted. Errors: "scene-attribute",
    // "scene-index".
    Result<AddedMesh> addMesh(std::span<const EditedPrimitive> primitives);
    // Gives a primitive of the mesh another material. Instances that have none of their own follow.
    Result<EditReport> setMeshMaterial(MeshHandle mesh, std::uint32_t primitive, MaterialHandle material);
    Status removeMesh(MeshHandle mesh);

    // An instance that is not visible, or whose transform is flattened, is neither drawn nor hit. Error
    // "scene-geometries".
    Result<AddedInstance> addInstance(const PlacedMesh& placed);
    Status moveInstance(InstanceHandle instance, const std::array<float, 12>& objectToWorld);
    Status showInstance(InstanceHandle instance, bool visible);
    // Gives the instance another mesh and materials, as addInstance() does. Its place stays.
    Result<EditReport> setInstanceMesh(InstanceHandle instance, MeshHandle mesh,
                                       std::span<const MaterialHandle> materials = {});
    // Gives a primitive of the instance a material of its own, as a variant of KHR_materials_variants does. A
    // handle that names nothing takes it away again.
    Result<EditReport> setInstanceMaterial(InstanceHandle instance, std::uint32_t primitive,
                                           MaterialHandle material);
    Status removeInstance(InstanceHandle instance);

    // Lights keep their order when one is removed. In packages with a light hierarchy, record() builds it
    // anew if a light or an emissive triangle that is one has changed. Error "scene-light".
    Result<LightHandle> addLight(const LightView& light);
    Status setLight(LightHandle light, const LightView& view);
    Status removeLight(LightHandle light);

    // Records the edits since the last call into a command buffer of the caller's, in the recording state and
    // outside a render pass: copies, builds of added meshes and the build of the TLAS. Renderer::record() may
    // follow in the same command buffer; its accumulation should start anew. The commands must be submitted
    // before other commands that use the scene, to the Context's queue or ordered after its work. `frame` is
    // the number of the frame that the commands belong to, by the caller's count; it may not be below that of
    // the last call. Memory that is no longer needed is freed by complete(). On an error nothing is recorded,
    // and the edits wait for the next call. Errors: "scene-edit-frame", "tlas-limit".
    Status record(VkCommandBuffer commands, std::uint64_t frame);
    // Says that the device has completed all commands of frames up to `frame`, and frees the resources that
    // they alone used. Command buffers of these frames may not be submitted again.
    void complete(std::uint64_t frame);
    // Lets the next record() shrink the buffers of records and the TLAS to their contents, but not below
    // their size at the upload. Without it they only grow.
    void trim();

    // Returns how many bytes wait for complete(): staging, scratch, and everything that was removed or
    // replaced.
    std::uint64_t retiredBytes() const;

    struct State;  // for the runtime's own sources and their tests
    State& state();
    static std::unique_ptr<SceneEditor> create(std::unique_ptr<State> state);

private:
    explicit SceneEditor(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace glint
