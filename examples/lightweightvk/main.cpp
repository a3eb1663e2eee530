// Renders a room with LightweightVK. The engine has its own meshes, materials, acceleration structures and
// frame. Glint's steps answer its rays: those of mirrors, of indirect light, and into the sky.
#include "glint_side.h"

#include <glm/gtc/matrix_transform.hpp>
#include <stb_image_write.h>

#include <fstream>

namespace {

using Buffer = lvk::Holder<lvk::BufferHandle>;
using glm::vec3;

// A sphere, or with two sides a parallelogram about `place`.
struct Shape {
    Object object;
    vec3 place;
    float radius = 0;
    vec3 side{}, otherSide{};
};
const Shape kShapes[] = {{{vec3(0.6F), 30, vec3(0.03F)}, vec3(0), 0, {0, 0, 6}, {6, 0, 0}},
                         {{vec3(0.6F), 30, vec3(0.03F)}, {0, 0, -3.2F}, 0, {6, 0, 0}, {0, 2.6F, 0}},
                         {{{0.75F, 0.1F, 0.06F}, 10, vec3(0.02F)}, {-3.2F, 0, 0}, 0, {0, 2.6F, 0}, {0, 0, 4}},
                         {{vec3(0), 3000, {0.95F, 0.66F, 0.3F}}, {-1.2F, 1.1F, -1.4F}, 1.1F},
                         {{{0.05F, 0.15F, 0.65F}, 300, vec3(0.06F)}, {1.3F, 0.8F, -1}, 0.8F},
                         {{{0.15F, 0.6F, 0.2F}, 60, vec3(0.04F)}, {-1.9F, 0.45F, 0.8F}, 0.45F},
                         {{{0.1F, 0.1F, 0.12F}, 1500, vec3(0.25F)}, {0.3F, 0.4F, 0.5F}, 0.4F}};

// As in shaders/frame.glsl.
struct Frame {
    glm::mat4 toClip;
    glm::vec4 eye, sun;
    std::array<std::uint64_t, 6> addresses;  // of objects, rays, weights, answers, sums, picture
    std::array<std::uint32_t, 6> numbers;    // width, height, number, tlas, places, normals
};
constexpr std::uint32_t kCells = 48, kCorners = 6 * kCells * kCells;

template <typename T>
Buffer makeBuffer(lvk::IContext& engine, const std::vector<T>& data) {
    constexpr std::uint8_t kUsage =
        lvk::BufferUsageBits_Storage | lvk::BufferUsageBits_AccelStructBuildInputReadOnly;
    return engine.createBuffer({kUsage, lvk::StorageType_Device, sizeof(T) * data.size(), data.data()});
}

// Makes the mesh of an object, and returns its structure.
lvk::Holder<lvk::AccelStructHandle> makeMesh(lvk::IContext& engine, const Shape& shape, Object& object,
                                             std::vector<Buffer>& buffers) {
    std::vector<vec3> positions, normals;
    std::vector<std::uint32_t> indices;
    for (std::uint32_t i = 0; i < (kCells + 1) * (kCells + 1); ++i) {
        const glm::vec2 part = glm::vec2(i / (kCells + 1), i % (kCells + 1)) / static_cast<float>(kCells);
        const glm::vec2 sine = glm::sin(part * glm::vec2(3.14159265F, 6.2831853F));
        const glm::vec2 cosine = glm::cos(part * glm::vec2(3.14159265F, 6.2831853F));
        const vec3 round(sine.x * cosine.y, cosine.x, sine.x * sine.y);
        const vec3 flat = shape.side * (2 * part.x - 1) + shape.otherSide * (2 * part.y - 1);
        positions.push_back(shape.place + shape.radius * round + flat);
        normals.push_back(shape.radius > 0 ? round : normalize(cross(shape.side, shape.otherSide)));
        if (part.x < 1 && part.y < 1) {
            indices.insert(indices.end(), {i, i + 1, i + kCells + 1, i + 1, i + kCells + 2, i + kCells + 1});
        }
    }
    lvk::AccelStructDesc mesh{lvk::AccelStructType_BLAS};
    mesh.vertexFormat = lvk::VertexFormat_Float3;
    mesh.vertexBuffer = buffers.emplace_back(makeBuffer(engine, positions));
    mesh.numVertices = static_cast<std::uint32_t>(positions.size());
    mesh.indexBuffer = buffers.emplace_back(makeBuffer(engine, indices));
    mesh.transformBuffer = buffers.emplace_back(makeBuffer(engine, std::vector{glm::mat3x4(1.0F)}));
    mesh.buildRange.primitiveCount = kCorners / 3;
    object.positions = engine.gpuAddress(mesh.vertexBuffer);
    object.indices = engine.gpuAddress(mesh.indexBuffer);
    object.normals = engine.gpuAddress(buffers.emplace_back(makeBuffer(engine, normals)));
    return engine.createAccelerationStructure(mesh);
}

void draw(lvk::VulkanContext& engine, const char* path, std::uint32_t width, std::uint32_t height,
          std::uint32_t frames) {
    std::vector<Object> objects;
    std::vector<Buffer> buffers;
    std::vector<lvk::Holder<lvk::AccelStructHandle>> meshes;
    std::vector<lvk::AccelStructInstance> instances(std::size(kShapes));
    std::vector<Place> places(std::size(kShapes), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0});
    for (std::uint32_t i = 0; i < std::size(kShapes); ++i) {
        meshes.push_back(makeMesh(engine, kShapes[i], objects.emplace_back(kShapes[i].object), buffers));
        std::memcpy(&instances[i].transform, &places[i], sizeof places[i]);
        instances[i].instanceCustomIndex = i;
        instances[i].accelerationStructureReference = engine.gpuAddress(meshes.back());
    }
    const std::uint32_t pixels = width * height, rayCount = 2 * pixels;
    const Buffer frameData = makeBuffer(engine, std::vector<Frame>(1));
    const Buffer objectData = makeBuffer(engine, objects), instanceData = makeBuffer(engine, instances);
    const Buffer rays = makeBuffer(engine, std::vector<glint::RaySteps::Ray>(rayCount));
    const Buffer weights = makeBuffer(engine, std::vector<glm::vec4>(rayCount));
    const Buffer answers = makeBuffer(engine, std::vector<glint::RaySteps::Radiance>(rayCount));
    const Buffer sums = makeBuffer(engine, std::vector<glm::vec4>(pixels));
    const Buffer picture = makeBuffer(engine, std::vector<std::uint32_t>(pixels));
    lvk::AccelStructDesc top{lvk::AccelStructType_TLAS, lvk::AccelStructGeomType_Instances};
    top.instancesBuffer = instanceData;
    top.buildRange.primitiveCount = static_cast<std::uint32_t>(instances.size());
    top.buildFlags |= lvk::AccelStructBuildFlagBits_AllowUpdate;
    const auto structure = engine.createAccelerationStructure(top, nullptr);
    constexpr std::uint8_t kUsage = lvk::TextureUsageBits_Sampled | lvk::TextureUsageBits_Attachment;
    lvk::TextureDesc image{lvk::TextureType_2D, lvk::Format_RGBA_F32, {width, height}, 1, 1, kUsage};
    auto seen = engine.createTexture(image, "", nullptr), normals = engine.createTexture(image, "", nullptr);
    image.format = lvk::Format_Z_F32;
    const auto depth = engine.createTexture(image, "", nullptr);
    const auto shader = [&](const char* name, lvk::ShaderStage stage) {
        std::string text;
        for (const std::string file : {"shaders/frame.glsl", "materials/satin/satin.glsl", name}) {
            std::ifstream stream(FOLDER + file);
            text.append(std::istreambuf_iterator<char>(stream), {});
        }
        return engine.createShaderModule({text.c_str(), stage, name}, nullptr);
    };
    const auto vert = shader("shaders/gbuffer.vert", lvk::Stage_Vert);
    const auto frag = shader("shaders/gbuffer.frag", lvk::Stage_Frag);
    const auto lit = shader("shaders/light.comp", lvk::Stage_Comp);
    const auto sum = shader("shaders/compose.comp", lvk::Stage_Comp);
    lvk::RenderPipelineDesc drawing{.smVert = vert, .smFrag = frag, .depthFormat = image.format};
    drawing.color[0].format = drawing.color[1].format = lvk::Format_RGBA_F32;
    const auto gbuffer = engine.createRenderPipeline(drawing, nullptr);
    const auto light = engine.createComputePipeline({lit}, nullptr);
    const auto compose = engine.createComputePipeline({sum}, nullptr);
    const vec3 eye(1.2F, 1.9F, 5.6F), toSun = glm::normalize(vec3(0.55F, 0.75F, 0.5F));
    const glm::mat4 camera = glm::perspectiveFov(0.66F, 1.0F * width, 1.0F * height, 0.1F, 50.0F) *
                             glm::lookAt(eye, vec3(-0.2F, 0.95F, -0.6F), vec3(0, 1, 0));
    const glint::LightView sun{.intensity = {3, 3, 3}, .direction = {-toSun.x, -toSun.y, -toSun.z}};
    glint::RaySteps::Batch batch;
    batch.rays = engine.gpuAddress(rays);
    batch.rayCount = rayCount;
    batch.answers = engine.gpuAddress(answers);
    batch.tlas = engine.gpuAddress(structure);
    GlintSide glintSide(engine, objects, places, sun, rayCount);
    const std::uint64_t frameAddress = engine.gpuAddress(frameData);
    Frame frame{camera, {eye, 0}, {toSun, sun.intensity[0]}};
    frame.addresses = {engine.gpuAddress(objectData), batch.rays,
                       engine.gpuAddress(weights),    batch.answers,
                       engine.gpuAddress(sums),       engine.gpuAddress(picture)};
    frame.numbers = {width, height, 0, structure.index(), seen.index(), normals.index()};
    const lvk::Dimensions groups{(pixels + 63) / 64};
    for (; frame.numbers[2] < frames; batch.sampleIndex = ++frame.numbers[2]) {
        // Samples are anywhere in their pixels. The last ball rolls while the picture is exposed.
        const glm::vec2 at = glm::fract(1.0F * batch.sampleIndex * glm::vec2(0.754878F, 0.56984F)) - 0.5F;
        frame.toClip = glm::translate(glm::mat4(1), vec3(2.0F * at / glm::vec2(width, height), 0)) * camera;
        objects.back().moved = places.back()[3] = 0.3F * batch.sampleIndex / frames;
        std::memcpy(&instances.back().transform, &places.back(), sizeof places.back());
        lvk::ICommandBuffer& commands = engine.acquireCommandBuffer();
        commands.cmdUpdateBuffer(frameData, frame);
        commands.cmdUpdateBuffer(objectData, 0, sizeof(Object) * objects.size(), objects.data());
        commands.cmdUpdateBuffer(instanceData, 0, sizeof instances[0] * instances.size(), instances.data());
        commands.cmdUpdateTLAS(structure, instanceData);
        // The engine's barrier after the build is for ray tracing pipelines alone. Glint has its own.
        constexpr VkMemoryBarrier kBuilt{VK_STRUCTURE_TYPE_MEMORY_BARRIER, nullptr,
                                         VK_ACCESS_MEMORY_WRITE_BIT, VK_ACCESS_MEMORY_READ_BIT};
        vkCmdPipelineBarrier(lvk::getVkCommandBuffer(commands), VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                             VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 1, &kBuilt, 0, nullptr, 0, nullptr);
        commands.cmdBeginRendering(
            {.color = {{lvk::LoadOp_Clear}, {lvk::LoadOp_Clear}}, .depth = {lvk::LoadOp_Clear}},
            {.color = {{seen}, {normals}}, .depthStencil = {depth}}, {});
        commands.cmdBindRenderPipeline(gbuffer);
        commands.cmdBindDepthState({lvk::CompareOp_Less, true});
        for (std::uint64_t i = 0; i < objects.size(); ++i) {
            commands.cmdPushConstants(std::array{frameAddress, i});
            commands.cmdDraw(kCorners);
        }
        commands.cmdEndRendering();
        commands.cmdBindComputePipeline(light);
        commands.cmdPushConstants(frameAddress);
        commands.cmdDispatch(groups, {.sampledImages = {seen, normals}});
        glintSide.record(commands, places, batch);
        commands.cmdBindComputePipeline(compose);
        commands.cmdPushConstants(frameAddress);
        commands.cmdDispatch(groups, {});
        glintSide.submitted(engine.submit(commands, {}));
    }
    engine.wait({});
    std::vector<std::uint32_t> shown(pixels);
    engine.download(picture, shown.data(), sizeof shown[0] * pixels, 0);
    stbi_write_png(path, static_cast<int>(width), static_cast<int>(height), 4, shown.data(), 0);
}

}  // namespace

int main(int count, char** words) {
    lvk::VulkanContext engine({.enableValidation = false}, nullptr);
    lvk::HWDeviceDesc device;
    if (count != 5 || engine.queryDevices(&device) == 0 || !engine.initContext(device).isOk()) {
        std::cerr << "usage: lightweightvk PICTURE.png WIDTH HEIGHT FRAMES, on a Vulkan device\n";
        return 1;
    }
    draw(engine, words[1], std::stoul(words[2]), std::stoul(words[3]), std::stoul(words[4]));
}
