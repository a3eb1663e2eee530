#include "base/lists.h"
#include "base/vectors.h"
#include "gltf/motion/transform.h"

#include <glint/session/scene_view.h>

#include <algorithm>
#include <cmath>
#include <interop/models.h>
#include <interop/scene.h>
#include <limits>

namespace glint::session {

namespace {

using Place = std::array<double, 3>;

LightView toView(const gltf::Light& light, const SceneViewData& data) {
    LightView view;
    view.size = light.type == gltf::LightType::Directional ? data.directionalSize : data.placedSize;
    view.type = light.type == gltf::LightType::Directional ? LightView::Type::Directional
                : light.type == gltf::LightType::Point     ? LightView::Type::Point
                                                           : LightView::Type::Spot;
    for (std::size_t i = 0; i < 3; ++i) {
        view.intensity[i] = light.shown ? light.color[i] * light.intensity : 0.0F;
    }
    view.position = base::toFloat3(base::toVector(light.position) - base::toVector(data.origin));
    view.direction = light.direction;
    view.range = light.range;
    view.innerConeAngle = light.innerConeAngle;
    view.outerConeAngle = light.outerConeAngle;
    return view;
}

std::vector<PrimitiveView::MorphTarget> toViews(const std::vector<gltf::MorphTarget>& targets) {
    return base::mapped<PrimitiveView::MorphTarget>(targets, [](const gltf::MorphTarget& target) {
        return PrimitiveView::MorphTarget{target.positions, target.normals, target.tangents};
    });
}

std::vector<PrimitiveView::Attribute> toViews(const std::vector<gltf::VertexValues>& attributes) {
    return base::mapped<PrimitiveView::Attribute>(attributes, [](const gltf::VertexValues& attribute) {
        return PrimitiveView::Attribute{attribute.name, attribute.channels, attribute.values};
    });
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

// Returns the mesh that has the vertices of a node's mesh.
std::size_t verticesOf(const gltf::Scene& scene, const gltf::Node& node) {
    const int copyOf = scene.meshes[static_cast<std::size_t>(node.mesh)].copyOf;
    return static_cast<std::size_t>(copyOf < 0 ? node.mesh : copyOf);
}

// Returns for each mesh whether a node that is shown at some time places its vertices.
std::vector<bool> placedMeshes(const gltf::Scene& scene) {
    std::vector<bool> placed(scene.meshes.size(), false);
    for (const gltf::Node& node : scene.nodes) {
        if (node.mesh >= 0 && node.canShow) {
            placed[verticesOf(scene, node)] = true;
        }
    }
    return placed;
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

// Returns how often the node draws its mesh.
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

// Places are rebased if they are this many times as far from 0 as they are apart. Nearer places lose at most
// 2^-17 of the scene's size to single precision, and keep the numbers that the file gives them.
constexpr double kFar = 128.0;

double largest(const glm::dvec3& v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

glm::dvec3 middleOf(const Bounds& box) {
    return 0.5 * (base::toVector(box.min) + base::toVector(box.max));
}

glm::dvec3 halfOf(const Bounds& box) {
    return 0.5 * (base::toVector(box.max) - base::toVector(box.min));
}

// Returns the box of a mesh in its own space, as the file gives it.
Bounds boxOf(const gltf::Mesh& mesh) {
    constexpr double kEndless = std::numeric_limits<double>::infinity();
    glm::dvec3 lower(kEndless);
    glm::dvec3 upper(-kEndless);
    for (const gltf::Primitive& primitive : mesh.primitives) {
        for (const gltf::Float3& position : primitive.positions) {
            lower = glm::min(lower, base::toVector(position));
            upper = glm::max(upper, base::toVector(position));
        }
    }
    return {base::toArray(lower), base::toArray(upper)};
}

// Returns the origin that positions of a mesh get. The coordinates of an axis differ by less than a factor of
// two from that of the origin, or it is 0, so the differences are exact (Sterbenz 1974).
Place originOf(const Bounds& box) {
    Place origin{};
    const glm::dvec3 centre = middleOf(box);
    const glm::dvec3 half = halfOf(box);
    if (!std::isfinite(largest(half)) || !(largest(centre) > kFar * largest(half))) {
        return origin;
    }
    for (glm::length_t axis = 0; axis < 3; ++axis) {
        if (std::abs(centre[axis]) > 3.0 * half[axis]) {
            origin[static_cast<std::size_t>(axis)] = static_cast<float>(centre[axis]);
        }
    }
    return origin;
}

// Adds the positions of a mesh's primitives from its origin on, if it has one.
void rebase(const gltf::Primitive& primitive, const Place& origin, SceneViewData& data, PrimitiveView& view) {
    if (origin == Place{}) {
        return;
    }
    view.positions = data.positions.emplace_back(
        base::mapped<gltf::Float3>(primitive.positions, [&](const gltf::Float3& position) {
            return base::toFloat3(base::toVector(position) - base::toVector(origin));
        }));
}

gltf::Matrix4 translation(const glm::dvec3& by) {
    gltf::Matrix4 matrix = gltf::identity();
    std::copy_n(glm::value_ptr(by), 3, matrix.begin() + 12);
    return matrix;
}

// Returns a transform into the world as one from a mesh with an origin into a scene with an origin.
gltf::Matrix4 rebased(const gltf::Matrix4& world, const Place& mesh, const Place& scene) {
    gltf::Matrix4 result = mesh == Place{} ? world : gltf::multiply(world, translation(base::toVector(mesh)));
    for (std::size_t axis = 0; axis < 3; ++axis) {
        result[12 + axis] -= scene[axis];
    }
    return result;
}

// Something that is placed in the world: the middle of its box, and half of the box's longest side.
struct Placed {
    glm::dvec3 centre{};
    double radius = 0.0;
};

Placed placedBox(const gltf::Matrix4& world, const Bounds& box) {
    const glm::dmat3 linear(base::toMatrix(world));
    const glm::dvec3 half = halfOf(box);
    const glm::dvec3 extent =
        glm::abs(linear[0]) * half.x + glm::abs(linear[1]) * half.y + glm::abs(linear[2]) * half.z;
    return {base::transformed(world, middleOf(box)), largest(extent)};
}

// Returns the things that the origin of a scene follows: the drawn meshes, and the cameras of the file, which
// decide in scenes of few things. Of many instances, some thousand are enough.
std::vector<Placed> placedThings(const gltf::Scene& scene, const SceneViewData& data) {
    constexpr std::size_t kMostInstances = 4096;
    std::vector<Placed> things;
    const std::size_t step = data.instances.size() / kMostInstances + 1;
    for (std::size_t i = 0; i < data.instances.size(); i += step) {
        const gltf::Node& node = scene.nodes[data.sources[i].node];
        const Bounds& box = data.meshBoxes[data.instances[i].mesh];
        Placed thing = placedBox(worldOf(scene, node, data.sources[i].placement), box);
        if (isSkinned(scene, node)) {
            // Joints place the vertices. Their mean is close enough.
            const gltf::Skin& skin = scene.skins[static_cast<std::size_t>(node.skin)];
            thing = {};
            for (const gltf::Matrix4& joint : jointMatrices(scene, skin)) {
                const Placed part = placedBox(joint, box);
                thing.centre += part.centre / static_cast<double>(skin.joints.size());
                thing.radius = std::max(thing.radius, part.radius);
            }
        }
        things.push_back(thing);
    }
    for (const gltf::Camera& camera : scene.cameras) {
        things.push_back({{camera.world[12], camera.world[13], camera.world[14]}, 0.0});
    }
    std::erase_if(things, [](const Placed& thing) {
        return !std::isfinite(thing.radius) || !base::isFinite(base::toArray(thing.centre));
    });
    return things;
}

// Returns the origin of a scene: 0, or a place among most of the scene's things if they are far from 0. A
// thing that lies elsewhere, such as a lamp left at 0, does not count. The place is rounded to a grid, so
// that it stays the same while a scene moves a little.
Place originOf(std::vector<Placed> things) {
    if (things.empty()) {
        return {};
    }
    const auto medianOf = [&](std::size_t number, const auto& value) {
        const auto at = things.begin() + static_cast<std::ptrdiff_t>(number);
        std::ranges::nth_element(things, at, {}, value);
        return value(*at);
    };
    glm::dvec3 middle{};
    for (glm::length_t axis = 0; axis < 3; ++axis) {
        middle[axis] =
            medianOf(things.size() / 2, [axis](const Placed& thing) { return thing.centre[axis]; });
    }
    const std::size_t lower = (things.size() - 1) / 2;
    double size =
        medianOf(lower, [&](const Placed& thing) { return largest(thing.centre - middle) + thing.radius; });
    // Cameras that are close to each other make no small scene.
    std::erase_if(things, [](const Placed& thing) { return thing.radius == 0.0; });
    if (!things.empty()) {
        size = std::max(size,
                        medianOf((things.size() - 1) / 2, [](const Placed& thing) { return thing.radius; }));
    }
    if (!(size > 0.0) || !(largest(middle) > kFar * size)) {
        return {};
    }
    const double grid = std::exp2(std::floor(std::log2(2.0 * size)));
    return base::toArray(glm::round(middle / grid) * grid);
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
    const MaterialTable table = package.scene(0).materials;
    compiler::MaterialLayout layout;
    layout.model = &model;
    layout.bytes = table.recordBytes;
    layout.textureOffset = table.textureOffset;
    layout.textureCount = table.textureCount;
    const auto indexIn = [](const auto& rows, std::string_view name) {
        const auto found = std::ranges::find_if(rows, [&](const auto& row) { return row.name == name; });
        return found == rows.end() ? -1 : static_cast<int>(found - rows.begin());
    };
    // A field has an entry for each model whose records have it.
    const auto addOwner = [](auto& rows, const auto& value, auto member, int owner) {
        const auto known = std::ranges::find(rows, value, member);
        if (known != rows.end()) {
            known->models.push_back(owner);
        }
        return known != rows.end();
    };
    for (const package::FieldEntry& entry : package.fields()) {
        const int owner = static_cast<int>(entry.model & gpu::kModelNumber) - 1;
        const std::string_view name = package.string(entry.name);
        if (entry.offset >= table.textureOffset) {
            const auto slot = (entry.offset - table.textureOffset) / sizeof(gpu::TextureRecord);
            const int texture = model.findTexture(name);
            if (!addOwner(layout.textures, texture, &compiler::TextureSlot::texture, owner)) {
                layout.textures.push_back({texture, static_cast<int>(slot), {owner}});
            }
            continue;
        }
        if (addOwner(layout.fields, std::string(name), &compiler::RecordField::name, owner)) {
            continue;
        }
        compiler::RecordField field;
        field.name = name;
        field.offset = entry.offset;
        field.parameter = model.findParameter(name);
        field.derived = indexIn(model.derived, name);
        if (field.parameter >= 0) {
            const materials::Parameter& parameter =
                model.parameters[static_cast<std::size_t>(field.parameter)];
            field.type = parameter.type;
            field.count = parameter.count;
        } else if (field.derived >= 0) {
            field.type = model.derived[static_cast<std::size_t>(field.derived)].type;
        }
        // A field of another declaration keeps what the record has.
        if ((field.parameter < 0 && field.derived < 0) || field.bytes() != entry.bytes) {
            continue;
        }
        field.models = {owner};
        layout.fields.push_back(std::move(field));
    }
    layout.makeIndex();
    for (std::uint32_t i = 0; i < package.sceneCount(); ++i) {
        for (const package::PrimitiveEntry& entry : package.scene(i).primitives) {
            layout.turnsFrames = layout.turnsFrames ||
                                 (model.maskOf(entry.key) & model.mask(package::Role::TurnedFrames)) != 0;
        }
    }
    return layout;
}

void useLayoutOf(const Package& package, const gltf::Scene& scene, SceneViewData& data) {
    const materials::MaterialModel& model =
        scene.materials.empty() ? materials::builtinMaterialModel() : scene.materials.front().model();
    data.materialLayout = recordLayoutOf(package, model);
    poseMaterials(scene, data);
}

SceneView SceneViewData::view() const {
    SceneView view{primitives, instances, images,         lights,   packageScene,
                   moves,      materials, traversalOrder, vertices, opacity};
    view.origin = origin;
    view.editable = editable;
    view.sealed = sealed;
    view.textureRoom = textureRoom;
    return view;
}

MotionView SceneViewData::motion() const {
    return {instances, lights, MotionView::Builds::ByRule, materials, origin};
}

std::array<float, 12> toRows(const gltf::Matrix4& matrix) {
    const glm::mat4x4 transposed(glm::transpose(base::toMatrix(matrix)));
    std::array<float, 12> rows{};
    std::copy_n(glm::value_ptr(transposed), rows.size(), rows.begin());
    return rows;
}

namespace {

void listPrimitives(const gltf::Scene& scene, std::size_t mesh, SceneViewData& data) {
    data.meshBoxes[mesh] = boxOf(scene.meshes[mesh]);
    data.meshOrigins[mesh] = originOf(data.meshBoxes[mesh]);
    const std::vector<gltf::Primitive>& primitives = scene.meshes[mesh].primitives;
    for (std::size_t index = 0; index < primitives.size(); ++index) {
        if (primitives[index].indices.size() >= 3) {
            PrimitiveView& view = data.primitives.emplace_back(toView(primitives[index], mesh, index));
            rebase(primitives[index], data.meshOrigins[mesh], data, view);
            view.targets = data.targets.emplace_back(toViews(primitives[index].targets));
            view.attributes = data.attributes.emplace_back(toViews(primitives[index].attributes));
            data.listed[mesh] = true;
        }
    }
}

// Adds the meshes, instances and lights that `data` lacks.
void addContent(const gltf::Scene& scene, SceneViewData& data) {
    const std::vector<bool> placed = placedMeshes(scene);
    data.listed.resize(scene.meshes.size(), false);
    data.meshBoxes.resize(scene.meshes.size());
    data.meshOrigins.resize(scene.meshes.size());
    for (std::size_t mesh = 0; mesh < scene.meshes.size(); ++mesh) {
        if (placed[mesh] && !data.listed[mesh]) {
            listPrimitives(scene, mesh, data);
        }
    }
    std::vector<bool> isDrawn(scene.nodes.size(), false);
    for (const SceneViewData::Source& source : data.sources) {
        isDrawn[source.node] = true;
    }
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        const gltf::Node& node = scene.nodes[i];
        if (node.mesh < 0 || !node.canShow || isDrawn[i] || !data.listed[verticesOf(scene, node)]) {
            continue;
        }
        const std::size_t count = placementsOf(scene, node);
        for (std::size_t placement = 0; placement < count; ++placement) {
            data.instances.emplace_back().mesh = static_cast<std::uint32_t>(verticesOf(scene, node));
            data.sources.push_back({i, placement});
        }
    }
    data.joints.resize(data.instances.size());
    data.weights.resize(data.instances.size());
    const auto known = std::ranges::count_if(data.lightSources, [](int source) { return source >= 0; });
    data.lightSources.resize(data.lights.size(), -1);
    for (std::size_t i = static_cast<std::size_t>(known); i < scene.lights.size(); ++i) {
        data.lights.emplace_back();
        data.lightSources.push_back(static_cast<int>(i));
    }
}

}  // namespace

SceneViewData makeSceneView(const gltf::Scene& scene) {
    SceneViewData data;
    addContent(scene, data);
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
        data.images.back().dimension = image.dimension;
        data.images.back().layers = static_cast<std::uint32_t>(image.layers);
    }
    poseSceneView(scene, data);
    return data;
}

void extendSceneView(const gltf::Scene& scene, SceneViewData& data) {
    data.keepsOrigin = true;
    addContent(scene, data);
}

void poseSceneView(const gltf::Scene& scene, SceneViewData& data) {
    if (!data.keepsOrigin) {
        data.origin = originOf(placedThings(scene, data));
    }
    for (std::size_t i = 0; i < data.instances.size(); ++i) {
        const gltf::Node& node = scene.nodes[data.sources[i].node];
        InstanceView& instance = data.instances[i];
        if (node.mesh < 0) {
            instance.visible = false;  // an edit has removed the node
            continue;
        }
        instance.visible = node.shown;
        const bool skinned = isSkinned(scene, node);
        // Only the sign of its transform's determinant counts, because it decides which side of a triangle is
        // the front (section 3.7.4). If it is negative, the instance mirrors X, and so do its joints before
        // that.
        const Place& mesh = data.meshOrigins[instance.mesh];
        const float mirror =
            skinned && glm::determinant(glm::dmat3(base::toMatrix(node.world))) < 0.0 ? -1.0F : 1.0F;
        instance.objectToWorld =
            skinned ? InstanceView{}.objectToWorld
                    : toRows(rebased(worldOf(scene, node, data.sources[i].placement), mesh, data.origin));
        data.joints[i].clear();
        if (skinned) {
            instance.objectToWorld[0] = mirror;
            for (const gltf::Matrix4& joint :
                 jointMatrices(scene, scene.skins[static_cast<std::size_t>(node.skin)])) {
                std::array<float, 12>& rows =
                    data.joints[i].emplace_back(toRows(rebased(joint, mesh, data.origin)));
                std::transform(rows.begin(), rows.begin() + 4, rows.begin(),
                               [&](float element) { return mirror * element; });
            }
        }
        data.weights[i].assign(node.weights.begin(), node.weights.end());
        instance.joints = data.joints[i];
        instance.morphWeights = data.weights[i];
    }
    poseMaterials(scene, data);
    for (std::size_t i = 0; i < data.lightSources.size(); ++i) {
        if (data.lightSources[i] >= 0) {
            data.lights[i] = toView(scene.lights[static_cast<std::size_t>(data.lightSources[i])], data);
        }
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

}  // namespace glint::session
