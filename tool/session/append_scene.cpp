#include "session/append_scene.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace glint::session {

namespace {

using gltf::Scene;

// The lengths of a scene's lists, which are added to the numbers of another one that comes behind it.
struct Offsets {
    int nodes = 0;
    int materials = 0;
    int meshes = 0;
    int lights = 0;
    int skins = 0;
    int instancings = 0;
    int animated = 0;
    int textures = 0;
    int samplers = 0;
    int images = 0;

    explicit Offsets(const Scene& scene)
        : nodes(static_cast<int>(scene.nodes.size())),
          materials(static_cast<int>(scene.materials.size())),
          meshes(static_cast<int>(scene.meshes.size())),
          lights(static_cast<int>(scene.lights.size())),
          skins(static_cast<int>(scene.skins.size())),
          instancings(static_cast<int>(scene.instancings.size())),
          animated(static_cast<int>(scene.animatedMaterials.size())),
          textures(static_cast<int>(scene.textures.size())),
          samplers(static_cast<int>(scene.samplers.size())),
          images(static_cast<int>(scene.images.size())) {}
};

int shifted(int index, int offset) {
    return index < 0 ? -1 : index + offset;
}

materials::Material shifted(materials::Material material, const Offsets& by) {
    for (auto& [slot, info] : material.textures) {
        info.texture = shifted(info.texture, by.textures);
    }
    return material;
}

// Makes the primitive's list of variants one of `all`, which contains those of `own`.
void alignVariants(const std::vector<std::string>& own, const std::vector<std::string>& all,
                   gltf::Primitive& primitive) {
    if (primitive.variantMaterials.empty()) {
        return;
    }
    std::vector<int> aligned(all.size() + 1, primitive.variantMaterials.back());
    for (std::size_t i = 0; i < own.size(); ++i) {
        aligned[static_cast<std::size_t>(std::ranges::find(all, own[i]) - all.begin())] =
            primitive.variantMaterials[i];
    }
    primitive.variantMaterials = std::move(aligned);
}

void appendMaterials(const Scene& from, const Offsets& by, Scene& to) {
    for (const materials::Material& material : from.materials) {
        to.materials.push_back(shifted(material, by));
    }
    for (const gltf::AnimatedMaterial& animated : from.animatedMaterials) {
        to.animatedMaterials.push_back({animated.material + by.materials, shifted(animated.rest, by),
                                        shifted(animated.planned, by), animated.changes, animated.edited});
    }
    for (const gltf::Texture& texture : from.textures) {
        to.textures.push_back({texture.image + by.images, texture.sampler + by.samplers});
    }
    to.samplers.insert(to.samplers.end(), from.samplers.begin(), from.samplers.end());
    for (const gltf::Image& image : from.images) {
        // The texels are for whoever uploads them, and come from the other scene.
        gltf::Image& added = to.images.emplace_back(image);
        added.file.clear();
        added.pixels.clear();
        added.sameAs = shifted(image.sameAs, by.images);
    }
}

void appendMeshes(const Scene& from, const Offsets& by, Scene& to) {
    const std::vector<std::string> before = to.variants;
    for (const std::string& variant : from.variants) {
        if (std::ranges::find(to.variants, variant) == to.variants.end()) {
            to.variants.push_back(variant);
        }
    }
    for (gltf::Mesh& mesh : to.meshes) {
        for (gltf::Primitive& primitive : mesh.primitives) {
            alignVariants(before, to.variants, primitive);
        }
    }
    for (const gltf::Mesh& mesh : from.meshes) {
        gltf::Mesh& added = to.meshes.emplace_back(mesh);
        added.copyOf = shifted(mesh.copyOf, by.meshes);
        for (gltf::Primitive& primitive : added.primitives) {
            primitive.material += by.materials;
            for (int& material : primitive.variantMaterials) {
                material += by.materials;
            }
            alignVariants(from.variants, to.variants, primitive);
        }
    }
}

void appendAnimations(const Scene& from, const Offsets& by, Scene& to) {
    for (const gltf::Animation& animation : from.animations) {
        gltf::Animation& added = to.animations.emplace_back(animation);
        std::erase_if(added.channels, [](const gltf::AnimationChannel& channel) {
            return channel.path == gltf::AnimationPath::Camera;
        });
        for (gltf::AnimationChannel& channel : added.channels) {
            channel.target += gltf::drivesNode(channel.path)               ? by.nodes
                              : channel.path == gltf::AnimationPath::Light ? by.lights
                                                                           : by.animated;
        }
    }
}

}  // namespace

int nextNumber(const gltf::Scene& scene) {
    int last = -1;
    for (const gltf::Node& node : scene.nodes) {
        last = std::max(last, node.source);
    }
    return last + 1;
}

void appendScene(const gltf::Scene& from, int parent, gltf::Scene& to) {
    const Offsets by(to);
    appendMaterials(from, by, to);
    appendMeshes(from, by, to);
    if (!to.restLights.empty() || !from.restLights.empty()) {
        to.restLights = to.restLights.empty() ? to.lights : std::move(to.restLights);
        const std::vector<gltf::Light>& rest = from.restLights.empty() ? from.lights : from.restLights;
        to.restLights.insert(to.restLights.end(), rest.begin(), rest.end());
    }
    to.lights.insert(to.lights.end(), from.lights.begin(), from.lights.end());
    to.instancings.insert(to.instancings.end(), from.instancings.begin(), from.instancings.end());
    for (const gltf::Skin& skin : from.skins) {
        for (int& joint : to.skins.emplace_back(skin).joints) {
            joint += by.nodes;
        }
    }
    int number = nextNumber(to);
    for (const gltf::Node& node : from.nodes) {
        gltf::Node& added = to.nodes.emplace_back(node);
        added.parent = node.parent < 0 ? parent : node.parent + by.nodes;
        added.mesh = shifted(node.mesh, by.meshes);
        added.light = shifted(node.light, by.lights);
        added.skin = shifted(node.skin, by.skins);
        added.instancing = shifted(node.instancing, by.instancings);
        added.camera = -1;
        added.source = number++;
    }
    appendAnimations(from, by, to);
}

}  // namespace glint::session
