// Traces, orders and shades the rays of a host, in the host's command buffer, with the host's bindings, over
// a scene that the host keeps on the device by itself: its vertex buffers, acceleration structures, textures
// and samplers stay where they are. docs/engine.md shows how to use it.
//
// Threads: an EngineScene and its RaySteps are used by one thread at a time; different ones may be used on
// different threads at once. Functions do not wait for the device and submit nothing, except
// EngineScene::create().
#pragma once

#include <glint/context.h>
#include <glint/package.h>
#include <glint/package_shape.h>
#include <glint/result.h>
#include <glint/scene_view.h>

#include <vulkan/vulkan_core.h>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace glint {

class Environment;
class GpuScene;
struct PackageProgress;     // glint/scene.h
struct PackageReplacement;  // as well

// --- The scene of a host ---

// The tables that Glint's shaders read of such a scene: a record for each geometry, instance, material and
// light. The Context must outlive it; the host keeps the objects that it points to alive.
class EngineScene {
public:
    // The content of the scene.
    struct View {
        // One geometry of one instance, which a ray can hit. Addresses are device addresses in the formats
        // that the package's shaders read; by default they are tightly packed: three uint32 a triangle, three
        // floats a position and a normal, four a tangent and a colour, two a UV. The address of an attribute
        // may be 0 only if the package's key of this primitive lacks the attribute.
        struct Geometry {
            std::uint32_t mesh = 0;       // mesh of the package's scene that gives material and key
            std::uint32_t primitive = 0;  // within the mesh
            std::uint32_t instance = 0;   // index into View::instances
            VkDeviceAddress indices = 0;
            VkDeviceAddress positions = 0;
            VkDeviceAddress normals = 0;
            VkDeviceAddress tangents = 0;
            VkDeviceAddress texCoords0 = 0;
            VkDeviceAddress texCoords1 = 0;
            VkDeviceAddress colors = 0;
            VkDeviceAddress attributes = 0;  // of packs: floats of Package::attributes(), vertex by vertex
            // Bits for a host's own functions (`glint compile --host`), such as the format of its vertices.
            // They are the upper half of GeometryRecord::flags.
            std::uint16_t hostFlags = 0;
            // The host's own number of the material: an index into View::materials, whose entry must
            // be of the primitive's material. kOfPackage: the values that the package has.
            std::uint32_t material = kOfPackage;
            static constexpr std::uint32_t kOfPackage = 0xFFFFFFFF;
            // If not 0, the address of such a number for each triangle, one uint32 each, aligned to 4 bytes;
            // `material` is then not used. Nothing checks the numbers: their entries must be of the
            // primitive's material, because the geometry's case shades all of its triangles. The host may
            // write others at any time between batches.
            VkDeviceAddress primitiveMaterials = 0;
            // In packages with emissive lights: the corners of all triangles, three points each, in the space
            // of `positions` and the order of `indices`. If the primitive's material emits light, its
            // triangles are then lights, as bright as the values of the material say; without corners only
            // rays that meet them find their light. The host needs the corners for the hierarchy of lights,
            // and shaders read `positions`. Those of a mesh that deforms are to be given again when they
            // move. Geometries with primitiveMaterials have none. Geometries with the same span share the
            // memory, 16 bytes a corner.
            std::span<const std::array<float, 3>> lightCorners{};
            // The mean luminance (linear, 0 to 1) of the emissive texture's texels on each triangle, or one
            // number for all. The hierarchy of lights then prefers triangles that show bright texels; samples
            // read the texture itself, so that the numbers change the noise alone. A triangle with 0 is no
            // light, which is right if all of its texels are black. If empty, the texture counts as white.
            std::span<const float> lightTexels{};
        };

        // A texture of the package's scene (PackageScene::textures) as the host has it. Its view has the type
        // that TextureEntry::dimension says, as those of a material's own textures have.
        struct Texture {
            std::uint32_t index = 0;  // in the host's array of images, Bindings::textures
            std::uint32_t width = 0;  // texels of mip 0, of one layer, face or slice
            std::uint32_t height = 0;
        };

        // A sampler of the package's scene (PackageScene::samplers) as the host has it.
        struct Sampler {
            std::uint32_t index = 0;     // in the host's array of samplers, Bindings::samplers
            float maxAnisotropy = 1.0F;  // of its filter; 1 without
        };

        // A material of the host's own: values, and with ownTextures also textures, for a material of the
        // package.
        struct Material {
            // Number of the package's material (PrimitiveEntry::materialIndex), whose case shades it.
            std::uint32_t material = 0;
            // The bytes of a record in the package's layout (MaterialRecord of its C++ header).
            std::span<const std::uint8_t> record{};
            // If true, the TextureRecords of `record` count as they are: textureIndex and samplerIndex are
            // indices into the host's arrays, texels is the size of mip 0, anisotropy that of the sampler (1
            // without), and texCoord the UV set. Shaders read those for which the package's material has a
            // texture; the others may be 0. If false, the textures are those of the package's material. UV
            // transforms always count, if the package's material has one.
            bool ownTextures = false;
        };

        // The rule by which the shaders find the geometry of a hit. A geometry's index in
        // View::geometries is the number of the instance's first geometry plus the index of the
        // geometry in its BLAS.
        enum class RecordsBy : std::uint32_t {
            CustomIndex = 0,       // instanceCustomIndex is the number of the instance's first geometry
            CustomIndexTable = 1,  // firstRecords[instanceCustomIndex] is that number
            InstanceTable = 2,     // firstRecords[place of the instance in the TLAS] is that number
        };

        std::uint32_t packageScene = 0;  // index of the scene in the package
        std::span<const Geometry> geometries;
        std::span<const std::array<float, 12>> instances;  // objectToWorld, three rows of four
        std::span<const Texture> textures;                 // one for each of PackageScene::textures
        std::span<const Sampler> samplers;                 // one for each of PackageScene::samplers
        std::span<const LightView> lights;
        RecordsBy recordsBy = RecordsBy::CustomIndex;
        std::span<const std::uint32_t> firstRecords{};
        // For strategies with a pipeline of their own: for each hit record of the shader binding table, the
        // number of the geometry that it is for. A hit's record is instanceShaderBindingTableRecordOffset
        // plus the index of the geometry in its BLAS. If empty, record i is for geometry i.
        std::span<const std::uint32_t> hitRecords{};
        // The host's own materials by its own numbers. Geometries name them, and any number of them may be of
        // one material of the package. A number that is not in use may have an entry with an empty record.
        std::span<const Material> materials{};
    };

    // Makes the records, and records their upload. Nothing waits for the device. The requirements of
    // `commands` and `frame`, and when the scene may be used and destroyed, are as in GpuScene::record(). The
    // spans are not kept. Errors: "position-fetch" and "half-precision" (the device was created without what
    // the package needs), "scene-package" (the package has no such scene or primitive), "engine-scene" (a
    // number is out of range, an attribute that a key needs is missing, or a transform is not finite),
    // "scene-light" (a value is not finite, or the package knows no disks), "scene-material" (the package has
    // no such material, or records of another size, or a texture of a material has no texels),
    // "texture-trusted" (a material has own textures, and Package::trustTextures() is true), and those of
    // memory and Vulkan's calls.
    static Result<std::unique_ptr<EngineScene>> record(Context& context, const Package& package,
                                                       const View& scene, VkCommandBuffer commands,
                                                       std::uint64_t frame);
    // Says that the device has completed all commands of frames up to `frame`, and frees the staging memory
    // and the buffers that only they used.
    void complete(std::uint64_t frame);
    // Records the same into a command buffer of its own, submits it to DeviceHandles::queue under
    // HostServices::lockQueue, and waits for the device.
    static Result<std::unique_ptr<EngineScene>> create(Context& context, const Package& package,
                                                       const View& scene);
    // The records of a scene that Glint has uploaded, for a host that brings rays of its own and no scene
    // yet. The GpuScene must outlive it. It is updated and edited by its own functions; steps that are
    // recorded afterwards read it as it is then. Renderers and RaySteps of the scene replace its package
    // together, when all have one of the same compilation. Rays are relative to its SceneView::origin. The
    // host binds GpuScene::descriptorSet().
    static Result<std::unique_ptr<EngineScene>> share(Context& context, GpuScene& scene);
    ~EngineScene();
    EngineScene(const EngineScene&) = delete;
    EngineScene& operator=(const EngineScene&) = delete;

    // Records another content: other geometries, instances, lights, materials, textures and samplers, as many
    // as there are now. An instance keeps its number, by which its motion is measured from its previous
    // transform; new ones are still. All places are relative to an origin of the engine's choice, which may
    // follow its camera: `originMoved` says in metres how far it has moved since the previous transforms,
    // which then count from the new one. `package` is the present one, or one that RaySteps::replacePackage()
    // gets; then RaySteps::begin() fails until it has it. It need not outlive the call.
    //
    // The call compares all records on the host, and records copies of those that differ. The spans are not
    // kept. Any number of frames may be in flight: buffers that are too small give way to larger ones, so
    // materials() may change. `frame` is the caller's number of the frame that the commands belong to; it may
    // not fall, and complete() frees what only its frames used. The commands must be submitted, in the order
    // of their recording. With an error nothing is recorded; after one of memory the next call brings the
    // content. Errors: those of record(), "engine-scene" also for a shared scene or a number that has fallen.
    Status update(VkCommandBuffer commands, const Package& package, const View& scene, std::uint64_t frame,
                  const std::array<double, 3>& originMoved = {});
    // The same for transforms and lights alone. There are any number of them, but not fewer transforms than
    // the geometries name. Errors: "engine-scene", "scene-light", and those of memory.
    Status update(VkCommandBuffer commands, std::span<const std::array<float, 12>> instances,
                  std::span<const LightView> lights, std::uint64_t frame,
                  const std::array<double, 3>& originMoved = {});

    // Sets the host's own material of a number, and records the copy of its record alone. A number beyond
    // those of the present content adds it, and all numbers between have no material. An empty record removes
    // the material. Takes constant time, unless the number gets another material of the package or none: then
    // no geometry may name it. The next update() with a View replaces all materials. Errors:
    // "scene-material", "texture-trusted", "engine-scene" (a geometry names the number, the scene is shared,
    // or `frame` has fallen), and those of memory.
    Status updateMaterial(VkCommandBuffer commands, std::uint32_t number, const View::Material& material,
                          std::uint64_t frame);

    // The address of the material records, with the host's numbers of textures and samplers:
    // glintHostMaterials() of the library. Commands that were recorded before an update use the old one.
    VkDeviceAddress materials() const;
    std::uint64_t bytes() const;  // on the device

    struct State;  // for the runtime's own sources
    State& state();

private:
    explicit EngineScene(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

// --- The steps ---

// The pipelines and buffers that shade a host's rays. Context, EngineScene and the layout must outlive it. It
// has no image, no camera and no descriptor set.
//
// The host records, in this order: its own descriptor sets for the bind points that the passes use (compute,
// and ray tracing with that tracer), then either record() or begin(), trace(), order() and shade(), with
// commands of its own between them if it likes. Afterwards the command buffer has another pipeline bound at
// these bind points and other push constants in the package's bytes; nothing else of its state has changed.
// Each step is a debug label, in which its passes are labels.
class RaySteps {
public:
    // A ray of the host's list.
    struct Ray {
        std::array<float, 3> origin{};
        // Where its answer goes. It must be below Options::maxRays in packages with several bounces.
        std::uint32_t slot = 0;
        std::array<float, 3> direction{};  // unit
        float coneWidth = 0.0F;   // footprint at the origin, metres; 0 reads the finest level of textures
        float coneSpread = 0.0F;  // growth of the footprint in a metre
    };
    static_assert(sizeof(Ray) == 36);

    // The first hit of a ray, if the host has found it itself: by rasterising, or by rays of its own.
    struct Hit {
        std::uint32_t geometry = kMiss;       // index into View::geometries
        std::uint32_t primitive = 0;          // triangle within the geometry
        std::array<float, 2> barycentrics{};  // weights of the second and the third corner
        float coneWidth = 0.0F;  // footprint at the hit, metres; 0 reads the finest level of textures

        static constexpr std::uint32_t kMiss = 0xFFFFFFFF;  // the ray leaves the scene
    };
    static_assert(sizeof(Hit) == 20);

    // A ray of a batch with Batch::visibility.
    struct VisibilityRay {
        std::array<float, 3> origin{};
        std::uint32_t slot = 0;            // where its answer goes
        std::array<float, 3> direction{};  // unit
        float distance = 0.0F;             // metres; what is beyond does not count
    };
    static_assert(sizeof(VisibilityRay) == 32);

    // The answer of a package with HitAnswer::Radiance: radiance, and how it was found.
    struct Radiance {
        std::array<float, 3> radiance{};
        float path = 0.0F;  // 2: the ray hit, 3: it left the scene
    };
    static_assert(sizeof(Radiance) == 16);

    // The answer of a package with HitAnswer::Surface. Vectors are in the world.
    struct Surface {
        std::array<float, 3> position{};         // of a miss: the direction of the ray
        std::uint32_t shaderId = 0;              // of the case, or one of the numbers below
        std::array<float, 3> normal{};           // unit, of shading, on the viewer's side
        float roughness = 0.0F;                  // square root of the larger alpha
        std::array<float, 3> geometricNormal{};  // unit, on the viewer's side
        float clearance = 0.0F;  // metres along geometricNormal at which a ray that leaves the surface starts
        std::array<float, 3> albedo{};    // of the diffuse reflection
        float occlusion = 0.0F;           // of ambient light
        std::array<float, 3> f0{};        // reflectance at normal incidence, of metal and dielectric together
        float f90 = 0.0F;                 // and at grazing angles
        std::array<float, 3> emission{};  // radiance; of an unlit material, its colour
        float transmission = 0.0F;        // share of the light that passes, specularly or diffusely
        std::array<float, 3> motion{};    // since the transforms before EngineScene::update(), metres;
                                          // docs/host.md says how it follows vertices that move
        std::uint32_t material = 0;       // index of the material in its file; of values of the host's, their
                                          // index after the package's materials

        static constexpr std::uint32_t kMiss = 0xFFFFFFFF;
        static constexpr std::uint32_t kUnknown = 0xFFFFFFFE;  // no case has the shader ID of what it hit
    };
    static_assert(sizeof(Surface) == 112);

    struct Options {
        package::Strategy strategy = package::kDefaultStrategy;
        // The same option as in RendererOptions.
        std::optional<package::Tracer> tracer{};
        std::optional<package::Ordering> ordering{};
        bool checkOrder = false;
        std::uint32_t pipelineThreads = 0;
        bool backgroundPipelines = false;  // as in RendererOptions; begin() uses what was made by then
        std::uint32_t maxRays = 0;         // in a batch, at least 1
        // The layout of the host's pipelines. Its sets have the bindings of Package::bindings(), visible to
        // compute shaders, or to the stages of ray tracing pipelines if they trace. Its range of push
        // constants has RaySteps::kPushBytes bytes at Bindings::pushOffset for `pushStages`. It must outlive
        // the RaySteps.
        VkPipelineLayout layout = VK_NULL_HANDLE;
        VkShaderStageFlags pushStages =
            VK_SHADER_STAGE_COMPUTE_BIT;  // of the range that overlaps those bytes
    };

    // The rays of one call.
    struct Batch {
        VkDeviceAddress rays = 0;    // Ray[], or with `visibility` VisibilityRay[]; aligned to 4 bytes
        std::uint32_t rayCount = 0;  // at most Options::maxRays
        // If not 0, the device knows the number of rays: a uint32 at this address, aligned to 4 bytes.
        // rayCount is then not used, and rays beyond maxRays are left out.
        VkDeviceAddress countAddress = 0;
        // If not 0, Hit[], aligned to 4 bytes: entry i is the first hit of ray i, which is then not traced.
        // Shading reads the slot and the direction of the ray, and with several bounces origin and
        // coneSpread. The host decides which surfaces there are: neither `mask` nor alpha changes a hit that
        // is given. Strategies with a pipeline of their own, which shade where they trace, take no hits.
        VkDeviceAddress hits = 0;
        // True: the rays only ask whether light arrives along them, up to VisibilityRay::distance. What
        // stops them is what stops shadow rays: both sides of every surface, with its alpha. The answer is a
        // float by slot, 1 or 0. If Package::shadowThrough() is Glass, it is three floats, the share of red,
        // green and blue that arrives through glass and alpha.
        bool visibility = false;
        VkDeviceAddress answers = 0;    // Radiance[] (16-byte aligned) or Surface[], by slot
        std::uint32_t bounces = 0;      // of paths, at most PackageShape::maxBounces; 0: as many as that
        std::uint32_t sampleIndex = 0;  // random numbers differ by slot, sample and seed
        std::uint32_t seed = 0;
        std::uint8_t mask = 0xFF;  // instances that share no bit with it are not hit
        VkDeviceAddress tlas = 0;  // the acceleration structure, if Bindings::tlas is kByAddress
        // The light for rays that leave the scene, with HitAnswer::Radiance.
        SkyView sky{};
        // With a package that reads an environment map. The host binds Environment::image() at
        // Bindings::environment, and keeps it until the device has completed the batch.
        const Environment* environment = nullptr;
        float environmentRotation = 0.0F;  // radians, as in FrameOptions
        float environmentIntensity = 1.0F;
        float time = 0.0F;  // seconds that materials of packs may follow
        Timing timing = Timing::Frame;
    };

    static constexpr std::uint32_t kPushBytes = 24;

    // Makes all pipelines and buffers, which takes as long as the driver needs. Errors: "package-passes" (the
    // package draws frames), "scene-package" (the scene was made with another package), "module-features"
    // (the device was created without what a module needs), "renderer-options", "package-strategy",
    // "package-tracer", "device-tracer", "device-ordering", "ray-steps" (no rays, no layout, or more rays
    // than the device can dispatch), and those of memory and Vulkan's calls.
    static Result<std::unique_ptr<RaySteps>> create(Context& context, const Package& package,
                                                    EngineScene& scene, const Options& options);
    ~RaySteps();
    RaySteps(const RaySteps&) = delete;
    RaySteps& operator=(const RaySteps&) = delete;

    // Starts a batch: waits for all earlier commands that write memory, and sets the constants. The values
    // are stored in the command buffer. Batches share buffers, so on several queues the host orders them
    // itself. With an error nothing is recorded. Errors: "ray-steps", "sky", "environment-missing",
    // "environment-unread", "environment-unsampled", "package-bounces" (more than the package has),
    // "package-replaced" (EngineScene::update() has given the scene the content of another package), and
    // those of memory and Vulkan's calls. If the scene has other geometries, strategies with a pipeline of
    // their own get another shader binding table, and may need another pipeline, which the call then makes.
    Status begin(VkCommandBuffer commands, const Batch& batch);
    // Traces the rays, or takes the hits that the host gives. Strategies that order no hits trace and shade
    // in one pass, in shade(), so with them this and order() do nothing.
    void trace(VkCommandBuffer commands);
    // Orders the hits by shader.
    void order(VkCommandBuffer commands);
    // Shades the hits and writes the answers, which later commands may read at any stage. With several
    // bounces it also traces, orders and shades the further rays of the paths, bounce by bounce.
    void shade(VkCommandBuffer commands);
    // Records all of these steps.
    Status record(VkCommandBuffer commands, const Batch& batch);

    // Switches to another package of the same scene with steps, as Renderer::replacePackage() does: begin()
    // uses it as soon as all of its pipelines are there, and then records the copies that bring the scene's
    // records to it, unless EngineScene::update() has done so before. RaySteps that share a scene switch
    // together. `package` must not be null; it is kept as long as it is needed. With an error nothing
    // changes. Errors: those of create(); "scene-package" and "engine-scene" (the package does not suit what
    // the host has given; EngineScene::update() can give what it needs), "ray-steps" (it has other bindings
    // or answers), and those of Renderer::replacePackage() for a scene that Glint has uploaded.
    Result<PackageReplacement> replacePackage(const std::shared_ptr<const Package>& package);
    PackageProgress replacementProgress() const;
    // Gives up a package that waits, for all RaySteps of the scene. Recordings continue with the old package.
    // Without such a package nothing changes.
    void withdrawPackage();
    // Makes all pipelines anew for another layout, such as one for a larger array of images; see
    // Options::layout and pushStages. Batches that begin afterwards use it, and need the host's sets
    // bound by it. The layout before must live until the device has completed the batches before. With an
    // error nothing changes. Errors: those of create().
    Status setLayout(VkPipelineLayout layout, VkShaderStageFlags pushStages);
    // The number of batches that were begun, which is that of the last one. finished() says that the device
    // has completed all batches up to a number, and frees what only those used. It never waits.
    std::uint64_t recordings() const;
    void finished(std::uint64_t recording);

    // The counters of a batch, of all its bounces except where a member says otherwise.
    struct Counters {
        std::uint32_t rays = 0;           // of the host's list
        std::uint32_t furtherRays = 0;    // of further bounces
        std::uint32_t shadowRays = 0;     // deferred ones
        std::uint32_t unknownShader = 0;  // hits whose shader ID no case has, without a fallback
        std::uint32_t orderErrors = 0;    // with Options::checkOrder
        std::vector<std::uint32_t>
            bucketCounts;  // misses, then hits by shader ID; filled if hits are ordered
    };

    // The results of the last batch, which the device must have completed. Error "frame-not-recorded".
    Result<Counters> counters();
    Result<std::vector<PassTiming>> timings();

    package::Tracer tracer() const;
    package::Ordering ordering() const;
    std::uint64_t bytes() const;  // of its buffers

    struct State;  // for the runtime's own sources

private:
    explicit RaySteps(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace glint
