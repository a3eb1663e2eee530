// glTF to the engine's scene. Nothing else of the engine knows where its scene came from.
#include "gltf/import.h"
#include "gpu.h"
#include "world.h"

#include <glint/session/camera.h>
#include <glint/session/scene_view.h>

#include <algorithm>
#include <map>

namespace engine {
namespace {

Vertex vertexOf(const glint::PrimitiveView& view, std::size_t i) {
    Vertex vertex;
    vertex.position = view.positions[i];
    const auto take = [i](auto& target, const auto& source) {
        if (!source.empty()) {
            target = source[i];
        }
    };
    take(vertex.normal, view.normals);
    take(vertex.tangent, view.tangents);
    take(vertex.uv0, view.texCoords0);
    take(vertex.uv1, view.texCoords1);
    take(vertex.color, view.colors);
    return vertex;
}

// The cube around all primitives of a mesh.
void measure(std::span<const glint::PrimitiveView> primitives, std::uint32_t number, Mesh& mesh) {
    std::array<float, 3> least{};
    std::array<float, 3> most{};
    bool first = true;
    for (const glint::PrimitiveView& view : primitives) {
        for (const std::array<float, 3>& p :
             view.mesh == number ? view.positions : std::span<const std::array<float, 3>>()) {
            for (std::size_t i = 0; i < 3; ++i) {
                least[i] = first ? p[i] : std::min(least[i], p[i]);
                most[i] = first ? p[i] : std::max(most[i], p[i]);
            }
            first = false;
        }
    }
    for (std::size_t i = 0; i < 3; ++i) {
        mesh.offset[i] = 0.5F * (least[i] + most[i]);
        mesh.scale = i == 0 ? 0.0F : mesh.scale;
        mesh.scale = std::max(mesh.scale, 0.5F * (most[i] - least[i]));
    }
}

}  // namespace

World readGltf(const std::string& file, Format format, float aspect) {
    glint::gltf::ImportOptions options;
    options.decodeImages = true;
    const glint::Result<glint::gltf::Scene> scene = glint::gltf::importScene(file, options);
    if (!scene) {
        fail(toString(scene.error()));
    }
    const glint::session::SceneViewData data = glint::session::makeSceneView(*scene);
    World world;
    world.format = format;
    std::map<std::uint32_t, std::uint32_t> meshes;
    for (const glint::PrimitiveView& view : data.primitives) {
        const auto [place, isNew] =
            meshes.emplace(view.mesh, static_cast<std::uint32_t>(world.meshes.size()));
        if (isNew) {
            world.meshes.emplace_back();
            if (format == Format::Compact) {
                measure(data.primitives, view.mesh, world.meshes.back());
            }
        }
        std::vector<Vertex> vertices;
        for (std::size_t i = 0; i < view.positions.size(); ++i) {
            vertices.push_back(vertexOf(view, i));
        }
        if (format == Format::Compact && vertices.size() > 65536) {
            fail("compact indices have 16 bits");
        }
        addGeometry(world, world.meshes[place->second], view.mesh, view.primitive, vertices, view.indices);
    }
    for (const glint::InstanceView& instance : data.instances) {
        world.instances.push_back({meshes.at(instance.mesh), instance.objectToWorld});
    }
    for (const glint::ImageView& image : data.images) {
        if (image.format != glint::ImageView::Format::Rgba8 || image.levels != 1) {
            fail("this example reads 8-bit images without mips");
        }
        world.textures.push_back({image.width, image.height, {image.pixels.begin(), image.pixels.end()}});
    }
    for (const glint::LightView& light : data.lights) {
        if (light.type != glint::LightView::Type::Directional) {
            fail("this example has directional lights alone");
        }
        world.suns.push_back({light.direction, light.intensity});
    }
    const glint::Result<glint::session::CameraChoice> camera =
        glint::session::chooseCamera(*scene, data, "", aspect);
    if (!camera) {
        fail(toString(camera.error()));
    }
    const glint::CameraView& view = camera->view;
    // All that the engine has is relative to the origin that the scene got.
    std::array<float, 3> place{};
    for (std::size_t i = 0; i < 3; ++i) {
        place[i] = static_cast<float>(view.position[i] - data.origin[i]);
    }
    world.camera = {place, view.forward, view.up, view.halfWidth, view.halfHeight, view.near};
    return world;
}

}  // namespace engine
