// Renders a room with LightweightVK. The engine has its own meshes, materials, acceleration structures and
// frame. Glint's steps answer its rays: those of mirrors, of indirect light, and into the sky.
#include "glint_side.h"

#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <glm/gtc/matrix_transform.hpp>
#include <stb_image_write.h>

#include <fstream>

namespace {

using Buffer = lvk::Holder<lvk::BufferHandle>;
using glm::mat4;
using glm::vec3;

const Material kMaterials[] = {
    {{0.75F, 0.72F, 0.68F}, 30, vec3(0.03F)}, {{0.8F, 0.1F, 0.06F}, 10, vec3(0.02F)},
    {vec3(0), 3000, {0.95F, 0.7F, 0.35F}},    {{0.05F, 0.15F, 0.65F}, 300, vec3(0.06F)},
    {{0.15F, 0.6F, 0.2F}, 60, vec3(0.04F)},   {{0.1F, 0.1F, 0.12F}, 1500, vec3(0.25F)}};

// A sphere, or with two sides a parallelogram about `place`.
struct Shape {
    std::uint32_t material;
    vec3 place;
    float radius = 0;
    vec3 sides[2]{};
};
const Shape kShapes[] = {{0, vec3(0), 0, {{0, 0, 6}, {6, 0, 0}}},
                         {0, {0, 0, -3.2F}, 0, {{6, 0, 0}, {0, 4, 0}}},
                         {1, {-3.2F, 0, 0}, 0, {{0, 4, 0}, {0, 0, 4}}},
                         {2, {-1.2F, 1.1F, -1.4F}, 1.1F},
                         {3, {1.3F, 0.8F, -1}, 0.8F},
                         {4, {-1.9F, 0.45F, 0.8F}, 0.45F},
                         {5, {0.3F, 0.4F, 0.5F}, 0.4F}};

// As in shaders/frame.glsl.
struct Object {
    vec3 moved;
    std::uint32_t material;
    std::uint64_t positions, normals, indices, pad;
};
struct Frame {
    mat4 toClip, fromClip;
    glm::vec4 eye, sun;
    std::uint64_t objects, materials, rays, weights, answers, sums;
    std::uint32_t width, height, number, tlas, places, normals;
};

struct Mesh {
    Buffer positions, normals, indices, transform;
    lvk::Holder<lvk::AccelStructHandle> structure;
};
constexpr std::uint32_t kCells = 48;
constexpr std::uint32_t kTriangles = 2 * kCells * kCells;

Buffer makeBuffer(lvk::IContext& engine, std::size_t bytes, const void* data = nullptr) {
    constexpr std::uint8_t kUsage =
        lvk::BufferUsageBits_Storage | lvk::BufferUsageBits_AccelStructBuildInputReadOnly;
    return engine.createBuffer({kUsage, lvk::StorageType_Device, bytes, data});
}

Mesh makeMesh(lvk::IContext& engine, const Shape& shape) {
    std::vector<vec3> positions, normals;
    std::vector<std::uint32_t> indices;
    for (std::uint32_t i = 0; i <= kCells; ++i) {
        for (std::uint32_t j = 0; j <= kCells; ++j) {
            const glm::vec2 part = glm::vec2(i, j) / static_cast<float>(kCells);
            const float polar = 3.14159265F * part.x, turn = 6.2831853F * part.y;
            const vec3 round(std::sin(polar) * std::cos(turn), std::cos(polar),
                             std::sin(polar) * std::sin(turn));
            const vec3 flat = shape.sides[0] * (2 * part.x - 1) + shape.sides[1] * (2 * part.y - 1);
            positions.push_back(shape.place + shape.radius * round + flat);
            normals.push_back(shape.radius > 0 ? round : normalize(cross(shape.sides[0], shape.sides[1])));
            for (const std::uint32_t corner : {0U, 1U, kCells + 1, 1U, kCells + 2, kCells + 1}) {
                if (i < kCells && j < kCells) {
                    indices.push_back(i * (kCells + 1) + j + corner);
                }
            }
        }
    }
    const glm::mat3x4 still(1.0F);
    Mesh mesh{makeBuffer(engine, positions.size() * sizeof(vec3), positions.data()),
              makeBuffer(engine, normals.size() * sizeof(vec3), normals.data()),
              makeBuffer(engine, indices.size() * sizeof indices[0], indices.data()),
              makeBuffer(engine, sizeof still, &still)};
    lvk::AccelStructDesc structure{lvk::AccelStructType_BLAS};
    structure.vertexFormat = lvk::VertexFormat_Float3;
    structure.vertexBuffer = mesh.positions;
    structure.numVertices = static_cast<std::uint32_t>(positions.size());
    structure.indexBuffer = mesh.indices;
    structure.transformBuffer = mesh.transform;
    structure.buildRange.primitiveCount = kTriangles;
    mesh.structure = engine.createAccelerationStructure(structure);
    return mesh;
}

// Reads GLSL with its includes.
std::string source(const std::string& name) {
    std::ifstream file(SOURCE_FOLDER "shaders/" + name);
    std::string text;
    for (std::string line; std::getline(file, line);) {
        text += line.starts_with("#include") ? source(line.substr(10, line.size() - 11)) : line + '\n';
    }
    return text;
}

void draw(lvk::VulkanContext& engine, const char* path, std::uint32_t width, std::uint32_t height,
          std::uint32_t frames) {
    std::vector<Mesh> meshes;
    std::vector<Object> objects;
    std::vector<lvk::AccelStructInstance> instances;
    std::vector<glint::EngineGeometryView> geometries;
    for (const Shape& shape : kShapes) {
        const auto number = static_cast<std::uint32_t>(meshes.size());
        const Mesh& mesh = meshes.emplace_back(makeMesh(engine, shape));
        const Object& object =
            objects.emplace_back(Object{vec3(0), shape.material, engine.gpuAddress(mesh.positions),
                                        engine.gpuAddress(mesh.normals), engine.gpuAddress(mesh.indices)});
        instances.push_back({.transform = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}},
                             .instanceCustomIndex = number,
                             .accelerationStructureReference = engine.gpuAddress(mesh.structure)});
        geometries.push_back({.instance = number,
                              .indices = object.indices,
                              .positions = object.positions,
                              .normals = object.normals,
                              .material = object.material});
    }
    const std::size_t pixels = std::size_t{width} * height;
    std::vector<glm::vec4> sums(pixels);
    const Buffer frameData = makeBuffer(engine, sizeof(Frame));
    const Buffer objectData = makeBuffer(engine, sizeof objects[0] * objects.size());
    const Buffer instanceData = makeBuffer(engine, sizeof instances[0] * instances.size(), instances.data());
    const Buffer materialData = makeBuffer(engine, sizeof kMaterials, kMaterials);
    const Buffer rays = makeBuffer(engine, 2 * pixels * sizeof(glint::EngineRay));
    const Buffer weights = makeBuffer(engine, 2 * pixels * sizeof sums[0]);
    const Buffer answers = makeBuffer(engine, 2 * pixels * sizeof(glint::EngineRadiance));
    const Buffer sumData = makeBuffer(engine, pixels * sizeof sums[0], sums.data());
    lvk::AccelStructDesc top{lvk::AccelStructType_TLAS, lvk::AccelStructGeomType_Instances};
    top.instancesBuffer = instanceData;
    top.buildRange.primitiveCount = static_cast<std::uint32_t>(instances.size());
    top.buildFlags |= lvk::AccelStructBuildFlagBits_AllowUpdate;
    const auto structure = engine.createAccelerationStructure(top, nullptr);
    const auto image = [&](lvk::Format format) {
        constexpr std::uint8_t kUsage = lvk::TextureUsageBits_Sampled | lvk::TextureUsageBits_Attachment;
        return engine.createTexture({.format = format, .dimensions = {width, height}, .usage = kUsage}, "",
                                    nullptr);
    };
    const auto seen = image(lvk::Format_RGBA_F32), normals = image(lvk::Format_RGBA_F32),
               depth = image(lvk::Format_Z_F32);

    const auto shader = [&](const char* name, lvk::ShaderStage stage) {
        return engine.createShaderModule({source(name).c_str(), stage, name}, nullptr);
    };
    const auto vertex = shader("gbuffer.vert", lvk::Stage_Vert),
               fragment = shader("gbuffer.frag", lvk::Stage_Frag);
    const auto lightCode = shader("light.comp", lvk::Stage_Comp),
               composeCode = shader("compose.comp", lvk::Stage_Comp);
    const auto gbuffer =
        engine.createRenderPipeline({.smVert = vertex,
                                     .smFrag = fragment,
                                     .color = {{lvk::Format_RGBA_F32}, {lvk::Format_RGBA_F32}},
                                     .depthFormat = lvk::Format_Z_F32},
                                    nullptr);
    const auto light = engine.createComputePipeline({.smComp = lightCode}, nullptr);
    const auto compose = engine.createComputePipeline({.smComp = composeCode}, nullptr);

    const vec3 eye(1.2F, 1.9F, 5.6F), toSun = glm::normalize(vec3(0.55F, 0.75F, 0.5F));
    const mat4 camera =
        glm::perspective(0.62F, static_cast<float>(width) / static_cast<float>(height), 0.1F, 50.0F) *
        glm::lookAt(eye, vec3(-0.2F, 0.75F, -0.6F), vec3(0, 1, 0));
    const glint::LightView sun{.intensity = {3, 3, 3}, .direction = {-toSun.x, -toSun.y, -toSun.z}};
    glint::RayBatch batch;
    batch.rays = engine.gpuAddress(rays);
    batch.rayCount = static_cast<std::uint32_t>(2 * pixels);
    batch.answers = engine.gpuAddress(answers);
    batch.tlas = engine.gpuAddress(structure);
    GlintSide glintSide(engine, geometries, kMaterials, sun, batch.rayCount);
    Frame frame{camera,
                camera,
                {eye, 0},
                {toSun, sun.intensity[0]},
                engine.gpuAddress(objectData),
                engine.gpuAddress(materialData),
                batch.rays,
                engine.gpuAddress(weights),
                batch.answers,
                engine.gpuAddress(sumData),
                width,
                height,
                0,
                structure.index(),
                seen.index(),
                normals.index()};
    struct {
        std::uint64_t frame;
        std::uint32_t drawn, pad;
    } push{engine.gpuAddress(frameData), 0, 0};
    const lvk::Dimensions groups{(batch.rayCount / 2 + 63) / 64};
    for (; frame.number < frames; batch.sampleIndex = ++frame.number) {
        // Samples are anywhere in their pixels. The last ball rolls while the picture is exposed.
        const glm::vec2 within = glm::fract(static_cast<float>(frame.number) * glm::vec2(0.754878F, 0.569840F)) - 0.5F;
        frame.toClip = glm::translate(mat4(1), vec3(2.0F * within / glm::vec2(width, height), 0)) * camera;
        frame.fromClip = glm::inverse(frame.toClip);
        objects.back().moved.x = 0.3F * static_cast<float>(frame.number) / static_cast<float>(frames);
        instances.back().transform.matrix[0][3] = objects.back().moved.x;
        lvk::ICommandBuffer& commands = engine.acquireCommandBuffer();
        commands.cmdUpdateBuffer(frameData, frame);
        commands.cmdUpdateBuffer(objectData, 0, sizeof objects[0] * objects.size(), objects.data());
        commands.cmdUpdateBuffer(instanceData, 0, sizeof instances[0] * instances.size(), instances.data());
        commands.cmdUpdateTLAS(structure, instanceData);
        commands.cmdBeginRendering(
            {.color = {{lvk::LoadOp_Clear}, {lvk::LoadOp_Clear}}, .depth = {lvk::LoadOp_Clear}},
            {.color = {{seen}, {normals}}, .depthStencil = {depth}}, {});
        commands.cmdBindRenderPipeline(gbuffer);
        commands.cmdBindDepthState({lvk::CompareOp_Less, true});
        for (push.drawn = 0; push.drawn < objects.size(); ++push.drawn) {
            commands.cmdPushConstants(push);
            commands.cmdDraw(3 * kTriangles);
        }
        commands.cmdEndRendering();
        glintSide.waitForStructure(commands);
        commands.cmdBindComputePipeline(light);
        commands.cmdPushConstants(push);
        commands.cmdDispatch(groups, {.sampledImages = {seen, normals}, .buffers = {frameData}});
        glintSide.record(commands, instances, batch);
        commands.cmdBindComputePipeline(compose);
        commands.cmdPushConstants(push);
        commands.cmdDispatch(groups, {});
        glintSide.submitted(engine.submit(commands, {}));
    }
    engine.wait({});
    engine.download(sumData, sums.data(), pixels * sizeof sums[0], 0);
    std::vector<std::uint8_t> bytes;
    for (const glm::vec4& sum : sums) {
        const vec3 shown =
            glm::pow(1.0F - glm::exp(-1.3F / static_cast<float>(frames) * vec3(sum)), vec3(1 / 2.2F));
        for (int channel = 0; channel < 3; ++channel) {
            bytes.push_back(static_cast<std::uint8_t>(255 * shown[channel] + 0.5F));
        }
    }
    stbi_write_png(path, static_cast<int>(width), static_cast<int>(height), 3, bytes.data(), 0);
}

}  // namespace

int main(int count, char** words) {
    if (count != 5) {
        std::cerr << "usage: lightweightvk PICTURE.png WIDTH HEIGHT FRAMES\n";
        return 2;
    }
    lvk::VulkanContext engine({.enableValidation = false}, nullptr);
    lvk::HWDeviceDesc device;
    if (engine.queryDevices(&device) == 0 || !engine.initContext(device).isOk()) {
        std::cerr << "LightweightVK finds no device\n";
        return 1;
    }
    draw(engine, words[1], std::stoul(words[2]), std::stoul(words[3]), std::stoul(words[4]));
}
