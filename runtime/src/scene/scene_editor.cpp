// SceneEditor: handles of the upload, meshes, instances, lights, and the recording of edits.
#include "context/parallel.h"
#include "data/geometry.h"
#include "data/instance_math.h"
#include "data/scene_checks.h"
#include "data/traversal_order.h"
#include "scene/scene_store.h"

#include <algorithm>

namespace glint {
namespace {

Diagnostic notFinite(const std::string& where) {
    return makeError("scene-edit-value", where, "the transform has a number that is not finite",
                     "give finite numbers");
}

Status checkPrimitive(const SceneStore& store, const SceneEditor::EditedPrimitive& primitive,
                      const std::string& where) {
    const PrimitiveView& view = primitive.geometry;
    GLINT_TRY_DO(checkGeometry(view, where));
    if (view.indices.empty()) {
        return makeError("scene-edit-value", where, "the primitive has no triangle",
                         "leave such primitives out");
    }
    for (const package::AttributeEntry& row : store.cases->package().attributes()) {
        const std::string name(store.cases->package().string(row.name));
        const auto given = std::ranges::find(view.attributes, name, &PrimitiveView::Attribute::name);
        if (given != view.attributes.end() &&
            (given->channels != row.channels ||
             given->values.size() != view.positions.size() * row.channels)) {
            return makeError("scene-attribute", where,
                             name + " has another number of channels than the package reads, or of values",
                             "give as many values as the positions have, times the package's channels");
        }
    }
    return okStatus();
}

// Checks the materials of an instance of a mesh and reports those without a case. Materials of the mesh are
// reported by the edits of the mesh.
Result<SceneEditor::Report> checkMaterials(const SceneStore& store, const StoredMesh& mesh,
                                           std::span<const MaterialHandle> materials,
                                           const std::string& where) {
    if (!materials.empty() && materials.size() != mesh.primitives.size()) {
        return makeError(
            "scene-edit-value", where,
            phrase("there are ", materials.size(), " materials for ", mesh.primitives.size(), " primitives"),
            "give one for each primitive, or none");
    }
    SceneEditor::Report report;
    for (std::size_t i = 0; i < materials.size(); ++i) {
        if (materials[i].generation == 0) {
            continue;
        }
        GLINT_TRY(auto shading, shadingOf(store, materials[i], mesh.primitives[i].attributes));
        addTo(report, *store.cases, materials[i], shading);
    }
    return report;
}

}  // namespace

AttributeMask attributesOf(const Package& package, const PrimitiveView& primitive) {
    AttributeMask mask = 0;
    mask |= primitive.normals.empty() ? 0 : kAttributeNormals;
    mask |= primitive.tangents.empty() ? 0 : kAttributeTangents;
    mask |= primitive.texCoords0.empty() ? 0 : kAttributeTexCoords0;
    mask |= primitive.texCoords1.empty() ? 0 : kAttributeTexCoords1;
    constexpr std::array<float, 4> kWhite{1, 1, 1, 1};
    const bool white =
        std::ranges::all_of(primitive.colors, [&](const auto& color) { return color == kWhite; });
    mask |= white ? 0 : kAttributeColors;
    std::uint32_t bit = kDeclaredAttributesShift;
    for (const package::AttributeEntry& row : package.attributes()) {
        const bool given = std::ranges::find(primitive.attributes, package.string(row.name),
                                             &PrimitiveView::Attribute::name) != primitive.attributes.end();
        mask |= AttributeMask{given} << bit++;
    }
    return mask;
}

Result<SceneEditor::AddedMesh> SceneEditor::addMesh(std::span<const EditedPrimitive> primitives,
                                                    MeshUse use) try {
    if (primitives.empty()) {
        return makeError("scene-edit-value", "", "the mesh has no primitive", "give at least one");
    }
    AddedMesh added;
    std::vector<PrimitiveView> views;
    for (const EditedPrimitive& primitive : primitives) {
        const std::string where = placeOf("mesh", store_->meshes.next().index) + ", " +
                                  placeOf("primitive", static_cast<std::uint32_t>(views.size()));
        GLINT_TRY_DO(checkPrimitive(*store_, primitive, where));
        const AttributeMask attributes = attributesOf(store_->cases->package(), primitive.geometry);
        GLINT_TRY(auto shading, shadingOf(*store_, primitive.material, attributes));
        addTo(added.report, *store_->cases, primitive.material, shading);
        views.push_back(primitive.geometry);
    }
    SceneView shapes;
    shapes.primitives = views;
    GLINT_TRY_DO(checkDeformation(shapes));
    const bool changes = use == MeshUse::Changing;
    const std::vector<GridPositions> positions =
        packPositions(views, changes ? SceneView::VertexForm::Full : store_->vertices);
    const std::vector<PrimitiveView> placed = withPositions(views, positions);
    MeshContent content{placed, positions};
    content.changes = changes;
    std::vector<std::vector<std::uint32_t>> ordered;
    if (store_->leafOrder != nullptr) {
        ordered = orderedTriangles(placed, store_->capacity, store_->leafOrder);
        content.ordered = ordered;
    }
    GLINT_TRY(added.mesh, glint::addMesh(*store_, store_->cases->package(), content));
    StoredMesh& mesh = *store_->meshes.find(added.mesh);
    for (std::size_t i = 0; i < primitives.size(); ++i) {
        mesh.primitives[i].material = primitives[i].material;
        countUse(store_->materialSlots, primitives[i].material, &StoredMaterial::meshes, added.mesh.index,
                 true);
    }
    return added;
}
GLINT_CATCH

Status SceneEditor::setVertices(MeshHandle mesh, std::uint32_t primitive, const VertexValues& vertices) try {
    GLINT_TRY(const StoredMesh* const entry, findNamed(store_->meshes, mesh, "mesh"));
    const std::string where = placeOf("mesh", mesh.index);
    if (!entry->changes || entry->mayDeform() || primitive >= entry->primitives.size()) {
        return makeError(
            "scene-edit-value", where,
            "the mesh has no such primitive, or was not added with MeshUse::Changing, or follows "
            "joints or morph targets",
            "add the mesh with MeshUse::Changing, without joints and targets");
    }
    const GpuPrimitive& device = entry->primitives[primitive].device;
    const auto fits = [&](const auto& values, VkDeviceAddress address) {
        return values.empty() || (values.size() == device.vertexCount && address != 0);
    };
    if (vertices.positions.size() != device.vertexCount || !fits(vertices.normals, device.normals) ||
        !fits(vertices.tangents, device.tangents)) {
        return makeError("scene-edit-value", where,
                         "the vertices are not as many as the primitive's, or it has no such attribute",
                         "give as many, or exchange the mesh by setInstanceMesh()");
    }
    for (const std::array<float, 3>& point : vertices.positions) {
        if (!isFinite(point)) {
            return makeError("scene-edit-value", where, "a position is not finite", "give finite numbers");
        }
    }
    return changeVertices(*store_, mesh, primitive, vertices);
}
GLINT_CATCH

Result<SceneEditor::Report> SceneEditor::setMeshMaterial(MeshHandle mesh, std::uint32_t primitive,
                                                         MaterialHandle material) try {
    GLINT_TRY(StoredMesh* const entry, findNamed(store_->meshes, mesh, "mesh"));
    if (primitive >= entry->primitives.size()) {
        return makeError("scene-edit-value", placeOf("mesh", mesh.index),
                         "the mesh has no primitive " + std::to_string(primitive), "count from 0");
    }
    StoredPrimitive& place = entry->primitives[primitive];
    GLINT_TRY(auto shading, shadingOf(*store_, material, place.attributes));
    SceneEditor::Report report;
    addTo(report, *store_->cases, material, shading);
    countUse(store_->materialSlots, place.material, &StoredMaterial::meshes, mesh.index, false);
    countUse(store_->materialSlots, material, &StoredMaterial::meshes, mesh.index, true);
    place.material = material;
    for (const std::uint32_t index : entry->instances) {
        writeGeometries(*store_, store_->instanceSlots.handleAt(index), store_->instanceSlots.at(index));
    }
    return report;
}
GLINT_CATCH

Status SceneEditor::removeMesh(MeshHandle mesh) try {
    GLINT_TRY(const StoredMesh* const entry, findNamed(store_->meshes, mesh, "mesh"));
    if (!entry->instances.empty()) {
        return makeError("scene-edit-used", placeOf("mesh", mesh.index),
                         std::to_string(entry->instances.size()) + " instances use the mesh",
                         "remove them first, or give them another mesh");
    }
    for (const StoredPrimitive& primitive : entry->primitives) {
        countUse(store_->materialSlots, primitive.material, &StoredMaterial::meshes, mesh.index, false);
    }
    retireMesh(*store_, mesh);
    return okStatus();
}
GLINT_CATCH

namespace {

Status checkRoom(const SceneStore& store, const StoredMesh& mesh, const std::string& where) {
    if (store.geometryRuns.end() > kMostGeometries - mesh.geometryCount) {
        return tooManyGeometries(where);
    }
    return okStatus();
}

}  // namespace

Result<SceneEditor::AddedInstance> SceneEditor::addInstance(const PlacedMesh& placed) try {
    const std::string where = placeOf("instance", store_->instanceSlots.next().index);
    GLINT_TRY(const StoredMesh* const mesh, findNamed(store_->meshes, placed.mesh, "mesh"));
    if (!isFinite(placed.objectToWorld)) {
        return notFinite(where);
    }
    InstanceView pose;
    pose.joints = placed.joints;
    pose.morphWeights = placed.morphWeights;
    GLINT_TRY_DO(checkPose(pose, mesh->jointCount, mesh->weightCount, where));
    GLINT_TRY(auto report, checkMaterials(*store_, *mesh, placed.materials, where));
    GLINT_TRY_DO(checkRoom(*store_, *mesh, where));
    StoredInstance instance;
    instance.mesh = placed.mesh;
    instance.objectToWorld = placed.objectToWorld;
    instance.visible = placed.visible;
    instance.materials.assign(placed.materials.begin(), placed.materials.end());
    GLINT_TRY(const auto handle,
              placeInstance(*store_, &store_->cases->package(), std::move(instance), pose));
    return AddedInstance{handle, std::move(report)};
}
GLINT_CATCH

Status SceneEditor::moveInstance(InstanceHandle instance, const std::array<float, 12>& objectToWorld) try {
    GLINT_TRY(const StoredInstance* const entry, findNamed(store_->instanceSlots, instance, "instance"));
    if (!isFinite(objectToWorld)) {
        return notFinite(placeOf("instance", instance.index));
    }
    glint::moveInstance(*store_, instance, objectToWorld, entry->visible);
    return okStatus();
}
GLINT_CATCH

Status SceneEditor::poseInstance(InstanceHandle instance, std::span<const std::array<float, 12>> joints,
                                 std::span<const float> morphWeights) try {
    GLINT_TRY(const StoredInstance* const entry, findNamed(store_->instanceSlots, instance, "instance"));
    InstanceView pose;
    pose.joints = joints;
    pose.morphWeights = morphWeights;
    const StoredMesh& mesh = *store_->meshes.find(entry->mesh);
    GLINT_TRY_DO(checkPose(pose, mesh.jointCount, mesh.weightCount, placeOf("instance", instance.index)));
    return glint::poseInstance(*store_, &store_->cases->package(), instance, pose);
}
GLINT_CATCH

Status SceneEditor::showInstance(InstanceHandle instance, bool visible) try {
    GLINT_TRY(const StoredInstance* const entry, findNamed(store_->instanceSlots, instance, "instance"));
    if (entry->visible != visible) {
        const Rows rows = entry->objectToWorld;
        glint::moveInstance(*store_, instance, rows, visible);
    }
    return okStatus();
}
GLINT_CATCH

Result<SceneEditor::Report> SceneEditor::setInstanceMesh(InstanceHandle instance, MeshHandle mesh,
                                                         std::span<const MaterialHandle> materials) try {
    const StoredMesh* const wanted = store_->meshes.find(mesh);
    const bool known = store_->instanceSlots.find(instance) != nullptr;
    if (!known || wanted == nullptr) {
        return unknownHandle(known ? "mesh" : "instance");
    }
    const std::string where = placeOf("instance", instance.index);
    GLINT_TRY(auto report, checkMaterials(*store_, *wanted, materials, where));
    GLINT_TRY_DO(checkRoom(*store_, *wanted, where));
    exchangeMesh(*store_, instance, mesh, materials);
    return report;
}
GLINT_CATCH

Result<SceneEditor::Report> SceneEditor::setInstanceMaterial(InstanceHandle instance, std::uint32_t primitive,
                                                             MaterialHandle material) try {
    GLINT_TRY(StoredInstance* const entry, findNamed(store_->instanceSlots, instance, "instance"));
    const StoredMesh& mesh = *store_->meshes.find(entry->mesh);
    if (primitive >= mesh.primitives.size()) {
        return makeError("scene-edit-value", placeOf("instance", instance.index),
                         "its mesh has no primitive " + std::to_string(primitive), "count from 0");
    }
    SceneEditor::Report report;
    if (material.generation != 0) {
        GLINT_TRY(auto shading, shadingOf(*store_, material, mesh.primitives[primitive].attributes));
        addTo(report, *store_->cases, material, shading);
    }
    setOwnMaterial(*store_, instance, primitive, material);
    return report;
}
GLINT_CATCH

Status SceneEditor::removeInstance(InstanceHandle instance) try {
    if (store_->instanceSlots.find(instance) == nullptr) {
        return unknownHandle("instance");
    }
    glint::removeInstance(*store_, instance);
    return okStatus();
}
GLINT_CATCH

Status SceneEditor::seal(std::span<const InstanceHandle> instances) try {
    for (const InstanceHandle instance : instances) {
        if (store_->instanceSlots.find(instance) == nullptr) {
            return unknownHandle("instance");
        }
    }
    for (const InstanceHandle instance : instances) {
        sealInstance(*store_, instance);
    }
    return okStatus();
}
GLINT_CATCH

// --- Handles of the upload, lights, recordings ---

namespace {

// Returns a handle of the upload if the thing that it names is still there.
template <typename Entries, typename Handle>
Handle stillThere(const Entries& entries, std::span<const Handle> handles, std::uint32_t number) {
    return number < handles.size() && entries.find(handles[number]) != nullptr ? handles[number] : Handle{};
}

}  // namespace

TextureHandle SceneEditor::texture(std::uint32_t number) const {
    return stillThere(store_->textures, std::span<const TextureHandle>(store_->firstTextures), number);
}

MaterialHandle SceneEditor::material(std::uint32_t number) const {
    return stillThere(store_->materialSlots, std::span<const MaterialHandle>(store_->firstMaterials), number);
}

MeshHandle SceneEditor::mesh(std::uint32_t number) const {
    const auto known = store_->firstMeshes.find(number);
    const bool there = known != store_->firstMeshes.end() && store_->meshes.find(known->second) != nullptr;
    return there ? known->second : MeshHandle{};
}

InstanceHandle SceneEditor::instance(std::uint32_t number) const {
    return stillThere(store_->instanceSlots, std::span<const InstanceHandle>(store_->firstInstances), number);
}

LightHandle SceneEditor::light(std::uint32_t number) const {
    return stillThere(store_->lightSlots, std::span<const LightHandle>(store_->firstLights), number);
}

Result<LightHandle> SceneEditor::addLight(const LightView& light) try {
    GLINT_TRY_DO(checkLights(store_->cases->package(), std::span(&light, 1)));
    return glint::addLight(*store_, light);
}
GLINT_CATCH

Status SceneEditor::setLight(LightHandle light, const LightView& view) try {
    if (store_->lightSlots.find(light) == nullptr) {
        return unknownHandle("light");
    }
    GLINT_TRY_DO(checkLights(store_->cases->package(), std::span(&view, 1)));
    glint::setLight(*store_, light, view);
    return okStatus();
}
GLINT_CATCH

Status SceneEditor::removeLight(LightHandle light) try {
    if (store_->lightSlots.find(light) == nullptr) {
        return unknownHandle("light");
    }
    glint::removeLight(*store_, light);
    return okStatus();
}
GLINT_CATCH

Status SceneEditor::record(VkCommandBuffer commands, std::uint64_t frame) try {
    GLINT_TRY_DO(checkFrame(*store_, frame));
    return recordChanges(*store_, commands, frame);
}
GLINT_CATCH

void SceneEditor::complete(std::uint64_t frame) {
    completeFrames(*store_, frame);
}

void SceneEditor::trim() {
    store_->trims = true;
}

std::uint64_t SceneEditor::retiredBytes() const {
    std::uint64_t bytes = store_->retired.bytes();
    for (const Buffer& staging : store_->uploader->staging()) {
        bytes += staging.bytes;
    }
    return bytes;
}

}  // namespace glint
