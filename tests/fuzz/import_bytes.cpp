#include "fuzz/import_bytes.h"

#include "fuzz/fuzz_target.h"
#include "fuzz/scratch_file.h"
#include "gltf/import.h"
#include "gltf/scene_list.h"
#include "plan/plan.h"
#include "scene/deformed.h"
#include "support/temporary_folder.h"

#include <glint/session/scene_view.h>

#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace glint::fuzz {

namespace {

void checkError(const Diagnostic& error, const std::filesystem::path& path) {
    require(error.where.starts_with(path.string()), "an error of the import names the file");
    require(!error.id.empty() && !error.message.empty(), "an error of the import has an id and a message");
}

void checkPrimitive(const gltf::Scene& scene, const gltf::Primitive& primitive) {
    const std::size_t vertices = primitive.positions.size();
    require(static_cast<std::size_t>(primitive.material) < scene.materials.size(),
            "every primitive has a material");
    require(primitive.indices.size() % 3 == 0, "triangles have three corners");
    for (const std::uint32_t index : primitive.indices) {
        require(index < vertices, "every index is that of a vertex");
    }
    for (const std::size_t count :
         {primitive.normals.size(), primitive.tangents.size(), primitive.texCoords0.size(),
          primitive.texCoords1.size(), primitive.colors.size()}) {
        require(count == 0 || count == vertices, "an attribute is there for all vertices or for none");
    }
    for (const gltf::MorphTarget& target : primitive.targets) {
        for (const std::size_t count :
             {target.positions.size(), target.normals.size(), target.tangents.size()}) {
            require(count == 0 || count == vertices, "a target has differences for all vertices or for none");
        }
    }
    require(primitive.influences.joints.size() == primitive.influences.count * vertices &&
                primitive.influences.weights.size() == primitive.influences.joints.size(),
            "every vertex follows as many joints");
}

// Returns how many targets the channels of that path can have.
std::size_t targetsOf(const gltf::Scene& scene, gltf::AnimationPath path) {
    switch (path) {
        case gltf::AnimationPath::Material:
            return scene.animatedMaterials.size();
        case gltf::AnimationPath::Light:
            return scene.restLights.size();
        case gltf::AnimationPath::Camera:
            return scene.restCameras.size();
        default:
            return scene.nodes.size();
    }
}

void checkAnimation(const gltf::Scene& scene, const gltf::Animation& animation) {
    for (const gltf::AnimationSampler& sampler : animation.samplers) {
        const std::size_t parts = sampler.interpolation == gltf::Interpolation::CubicSpline ? 3 : 1;
        require(!sampler.times.empty(), "a sampler has a keyframe");
        require(sampler.values.size() == parts * sampler.width * sampler.times.size(),
                "a sampler has the values of its keyframes");
    }
    for (const gltf::AnimationChannel& channel : animation.channels) {
        require(static_cast<std::size_t>(channel.target) < targetsOf(scene, channel.path),
                "a channel's target exists");
        require(static_cast<std::size_t>(channel.sampler) < animation.samplers.size(),
                "a channel's sampler exists");
    }
}

// Whatever the file contains, its animations can be played.
void checkMotion(gltf::Scene scene) {
    std::vector<std::size_t> all;
    for (const gltf::Animation& animation : scene.animations) {
        checkAnimation(scene, animation);
        all.push_back(all.size());
    }
    for (const double time : {0.0, 0.4, 1e6}) {
        session::applyPose(session::poseAt(scene, all, time), scene);
        for (const gltf::Node& node : scene.nodes) {
            if (!compiler::isDeformed(scene, node)) {
                continue;
            }
            const std::vector<gltf::Matrix4> joints =
                node.skin < 0
                    ? std::vector<gltf::Matrix4>()
                    : session::jointMatrices(scene, scene.skins[static_cast<std::size_t>(node.skin)]);
            for (const gltf::Primitive& primitive :
                 scene.meshes[static_cast<std::size_t>(node.mesh)].primitives) {
                require(session::deformedPositions(primitive, node.weights, joints).size() ==
                            primitive.positions.size(),
                        "every vertex has a place");
            }
        }
    }
}

void checkScene(const gltf::Scene& scene) {
    for (const gltf::Mesh& mesh : scene.meshes) {
        for (const gltf::Primitive& primitive : mesh.primitives) {
            checkPrimitive(scene, primitive);
        }
    }
    for (const gltf::Node& node : scene.nodes) {
        require(node.mesh < static_cast<int>(scene.meshes.size()), "a node's mesh exists");
        require(node.camera < static_cast<int>(scene.cameras.size()), "a node's camera exists");
        require(node.light < static_cast<int>(scene.lights.size()), "a node's light exists");
    }
    for (const gltf::Image& image : scene.images) {
        require(image.pixels.size() == byteCount(image), "an image has the pixels that it says");
    }
}

void checkPlan(const gltf::SceneList& scenes, compiler::MergePolicy merge) {
    compiler::PlanOptions options;
    options.merge = merge;
    const compiler::Plan plan = makePlan(scenes.materials(), scenes.primitives(), options);
    require(plan.keyOfPrimitive.size() == scenes.primitives().size(), "every primitive has a key");
    for (const compiler::Key& key : plan.keys) {
        require(static_cast<std::size_t>(key.shaderId) < plan.cases.size(), "every key has a case");
        const compiler::Case& shader = plan.cases[static_cast<std::size_t>(key.shaderId)];
        require((shader.always & ~key.mask) == 0, "a case takes nothing for granted that a key lacks");
        require((key.mask & ~(shader.always | shader.sometimes)) == 0, "a case knows what its keys have");
    }
}

}  // namespace

void importBytes(std::span<const std::uint8_t> bytes, std::string_view name) {
    static const test::TemporaryFolder folder;
    static ScratchFile file(folder.path() / name);
    const std::filesystem::path& path = file.hold(bytes);
    // Large images are slow to decode and show nothing that smaller ones do not.
    const gltf::ImportOptions options{.decodeImages = true, .maxImageSize = 1024};
    Result<gltf::Scene> scene = importScene(path, options);
    if (!scene) {
        checkError(scene.error(), path);
        return;
    }
    checkScene(*scene);
    {
        const gltf::SceneList scenes(std::span(&*scene, 1));
        for (const compiler::MergePolicy merge :
             {compiler::MergePolicy::None, compiler::MergePolicy::Family, compiler::MergePolicy::Auto}) {
            checkPlan(scenes, merge);
        }
    }
    checkMotion(std::move(*scene));
}

}  // namespace glint::fuzz
