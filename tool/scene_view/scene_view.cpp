#include "base/vectors.h"
#include "gltf/motion/transform.h"

#include <glint/scene_view/pose.h>
#include <glint/scene_view/scene_view.h>

#include <algorithm>
#include <cmath>

namespace glint::scene_view {

namespace {

LightView toView(const gltf::Light& light) {
    LightView view;
    switch (light.type) {
        case gltf::LightType::Directional:
            view.type = LightView::Type::Directional;
            break;
        case gltf::LightType::Point:
            view.type = LightView::Type::Point;
            break;
        case gltf::LightType::Spot:
            view.type = LightView::Type::Spot;
            break;
    }
    for (std::size_t i = 0; i < 3; ++i) {
        view.intensity[i] = light.shown ? light.color[i] * light.intensity : 0.0F;
    }
    view.position = light.position;
    view.direction = light.direction;
    view.range = light.range;
    view.innerConeAngle = light.innerConeAngle;
    view.outerConeAngle = light.outerConeAngle;
    return view;
}

std::vector<MorphTargetView> toViews(const std::vector<gltf::MorphTarget>& targets) {
    std::vector<MorphTargetView> views;
    views.reserve(targets.size());
    for (const gltf::MorphTarget& target : targets) {
        views.push_back({target.positions, target.normals, target.tangents});
    }
    return views;
}

std::vector<AttributeView> toViews(const std::vector<gltf::VertexValues>& attributes) {
    std::vector<AttributeView> views;
    views.reserve(attributes.size());
    for (const gltf::VertexValues& attribute : attributes) {
        views.push_back({attribute.name, attribute.channels, attribute.values});
    }
    return views;
}

PrimitiveView toView(const gltf::Primitive& primitive, std::size_t mesh, std::size_t index) {
    PrimitiveView view;
    view.mesh = static_cast<std::uint32_t>(mesh);
    view.primitive = static_cast<std::uint32_t>(index);
    view.positions = primitive.positions;
    view.normals = primitive.normals;
    view.tangents = primitive.tangents;
    view.texCoords0 = primitive.texCoords0;
    view.texCoords1 = primitive.texCoords1;
    view.colors = primitive.colors;
    view.indices = primitive.indices;
    view.joints = primitive.influences.joints;
    view.jointWeights = primitive.influences.weights;
    return view;
}

bool hasTriangles(const gltf::Primitive& primitive) {
    return primitive.indices.size() >= 3;
}

// For each mesh, whether a node that is shown at some time places it.
std::vector<bool> placedMeshes(const gltf::Scene& scene) {
    std::vector<bool> placed(scene.meshes.size(), false);
    for (const gltf::Node& node : scene.nodes) {
        if (node.mesh >= 0 && node.canShow) {
            placed[static_cast<std::size_t>(node.mesh)] = true;
        }
    }
    return placed;
}

// Returns the determinant of the linear part.
double determinantOf(const gltf::Matrix4& m) {
    return glm::determinant(glm::dmat3(base::toMatrix(m)));
}

// Returns whether the node's mesh follows its skin. The node's own transform then has no effect (glTF 2.0,
// section 3.7.3.2).
bool isSkinned(const gltf::Scene& scene, const gltf::Node& node) {
    const std::vector<gltf::Primitive>& primitives =
        scene.meshes[static_cast<std::size_t>(node.mesh)].primitives;
    return node.skin >= 0 && std::ranges::any_of(primitives, [](const gltf::Primitive& primitive) {
               return primitive.influences.count > 0;
           });
}

// How often the node draws its mesh.
std::size_t placementsOf(const gltf::Scene& scene, const gltf::Node& node) {
    return node.instancing < 0 ? 1 : scene.instancings[static_cast<std::size_t>(node.instancing)].count;
}

gltf::Matrix4 worldOf(const gltf::Scene& scene, const gltf::Node& node, std::size_t placement) {
    if (node.instancing < 0) {
        return node.world;
    }
    const gltf::Instancing& instancing = scene.instancings[static_cast<std::size_t>(node.instancing)];
    return gltf::multiply(node.world, gltf::instanceTransform(instancing, placement));
}

void poseMaterials(const gltf::Scene& scene, SceneViewData& data) {
    if (data.materialLayout.fields.empty()) {
        return;
    }
    for (std::size_t i = 0; i < data.materials.size(); ++i) {
        data.materialRecords[i] =
            makeMaterialRecord(scene.materials[data.materials[i].material], data.materialLayout);
        data.materials[i].record = data.materialRecords[i];
    }
}

}  // namespace

compiler::MaterialLayout recordLayoutOf(const Package& package, const materials::MaterialModel& model) {
    materials::FeatureMask used = 0;
    for (std::uint32_t i = 0; i < package.sceneCount(); ++i) {
        for (const package::PrimitiveEntry& entry : package.scene(i).primitives) {
            used |= materials::FeatureMask{entry.featureLobes} | materials::FeatureMask{entry.featureInputs}
                                                                     << 32U;
        }
    }
    return compiler::makeMaterialLayout(model, used);
}

void useLayoutOf(const Package& package, const gltf::Scene& scene, SceneViewData& data) {
    const materials::MaterialModel& model =
        scene.materials.empty() ? materials::builtinMaterialModel() : scene.materials.front().model();
    data.materialLayout = recordLayoutOf(package, model);
    poseMaterials(scene, data);
}

SceneView SceneViewData::view() const {
    return {primitives, instances, images,         lights,   packageScene,
            moves,      materials, traversalOrder, vertices, opacity};
}

MotionView SceneViewData::motion() const {
    return {instances, lights, MotionView::Builds::ByRule, materials};
}

std::array<float, 12> toRows(const gltf::Matrix4& matrix) {
    const glm::mat4x4 transposed(glm::transpose(base::toMatrix(matrix)));
    std::array<float, 12> rows{};
    std::copy_n(glm::value_ptr(transposed), rows.size(), rows.begin());
    return rows;
}

SceneViewData makeSceneView(const gltf::Scene& scene) {
    SceneViewData data;
    const std::vector<bool> placed = placedMeshes(scene);
    std::vector<bool> visible(scene.meshes.size(), false);
    for (std::size_t mesh = 0; mesh < scene.meshes.size(); ++mesh) {
        const std::vector<gltf::Primitive>& primitives = scene.meshes[mesh].primitives;
        for (std::size_t index = 0; placed[mesh] && index < primitives.size(); ++index) {
            if (hasTriangles(primitives[index])) {
                data.primitives.push_back(toView(primitives[index], mesh, index));
                data.primitives.back().targets =
                    data.targets.emplace_back(toViews(primitives[index].targets));
                data.primitives.back().attributes =
                    data.attributes.emplace_back(toViews(primitives[index].attributes));
                visible[mesh] = true;
            }
        }
    }
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        const gltf::Node& node = scene.nodes[i];
        if (node.mesh < 0 || !node.canShow || !visible[static_cast<std::size_t>(node.mesh)]) {
            continue;
        }
        const std::size_t count = placementsOf(scene, node);
        for (std::size_t placement = 0; placement < count; ++placement) {
            data.instances.emplace_back().mesh = static_cast<std::uint32_t>(node.mesh);
            data.sources.push_back({i, placement});
        }
    }
    data.joints.resize(data.instances.size());
    data.weights.resize(data.instances.size());
    for (const gltf::AnimatedMaterial& animated : scene.animatedMaterials) {
        data.materials.push_back({static_cast<std::uint32_t>(animated.material), {}});
    }
    std::ranges::sort(data.materials, {}, &MaterialView::material);
    data.materialRecords.resize(data.materials.size());
    for (const gltf::Image& image : scene.images) {
        data.images.push_back(
            {static_cast<std::uint32_t>(image.width), static_cast<std::uint32_t>(image.height), image.pixels,
             image.format == gltf::PixelFormat::Rgba16 ? ImageView::Format::Rgba16 : ImageView::Format::Rgba8,
             static_cast<std::uint32_t>(image.levels)});
    }
    data.lights.resize(scene.lights.size());
    poseSceneView(scene, data);
    return data;
}

void poseSceneView(const gltf::Scene& scene, SceneViewData& data) {
    for (std::size_t i = 0; i < data.instances.size(); ++i) {
        const gltf::Node& node = scene.nodes[data.sources[i].node];
        InstanceView& instance = data.instances[i];
        instance.visible = node.shown;
        const bool skinned = isSkinned(scene, node);
        // Only the sign of its transform's determinant counts, because it decides which side of a triangle is
        // the front (section 3.7.4). If it is negative, the instance mirrors X, and so do its joints before
        // that.
        const float mirror = skinned && determinantOf(node.world) < 0.0 ? -1.0F : 1.0F;
        instance.objectToWorld =
            skinned ? InstanceView{}.objectToWorld : toRows(worldOf(scene, node, data.sources[i].placement));
        data.joints[i].clear();
        if (skinned) {
            instance.objectToWorld[0] = mirror;
            for (const gltf::Matrix4& joint :
                 jointMatrices(scene, scene.skins[static_cast<std::size_t>(node.skin)])) {
                std::array<float, 12>& rows = data.joints[i].emplace_back(toRows(joint));
                std::transform(rows.begin(), rows.begin() + 4, rows.begin(),
                               [&](float element) { return mirror * element; });
            }
        }
        data.weights[i].assign(node.weights.begin(), node.weights.end());
        instance.joints = data.joints[i];
        instance.morphWeights = data.weights[i];
    }
    poseMaterials(scene, data);
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        data.lights[i] = toView(scene.lights[i]);
    }
}

LightView sunLight() {
    LightView sun;
    sun.type = LightView::Type::Directional;
    sun.intensity = {3.0F, 2.85F, 2.6F};
    const std::array<float, 3> way{0.5F, -1.0F, -0.6F};
    const float metres = std::sqrt(way[0] * way[0] + way[1] * way[1] + way[2] * way[2]);
    sun.direction = {way[0] / metres, way[1] / metres, way[2] / metres};
    return sun;
}

}  // namespace glint::scene_view
