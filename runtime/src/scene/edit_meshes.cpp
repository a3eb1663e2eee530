// SceneEditor: meshes and their BLASes, and instances.
#include "data/geometry.h"
#include "data/instance_math.h"
#include "data/scene_checks.h"
#include "data/traversal_order.h"
#include "scene/scene_editor.h"

#include <algorithm>
#include <cmath>

namespace glint {
namespace {

bool isFinite(const Rows& rows) {
    return std::ranges::all_of(rows, [](float value) { return std::isfinite(value); });
}

Diagnostic notFinite(const std::string& where) {
    return makeError("scene-edit-value", where, "the transform has a number that is not finite",
                     "give finite numbers");
}

Status checkPrimitive(const SceneEditor::State& state, const EditedPrimitive& primitive,
                      const std::string& where) {
    const PrimitiveView& view = primitive.geometry;
    GLINT_TRY_DO(checkGeometry(view, where));
    if (view.indices.empty()) {
        return makeError("scene-edit-value", where, "the primitive has no triangle",
                         "leave such primitives out");
    }
    if (!view.joints.empty() || !view.targets.empty()) {
        return makeError("scene-edit-moves", where, "the primitive follows a skin or has morph targets",
                         "add the mesh in one pose, or upload a scene that moves");
    }
    for (const package::AttributeEntry& row : state.cases.package().attributes()) {
        const std::string name(state.cases.package().string(row.name));
        const auto given = std::ranges::find(view.attributes, name, &AttributeView::name);
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

Box boxOf(const PrimitiveView& view, std::span<const std::uint32_t> indices) {
    Box box = Box::nothing();
    for (const std::uint32_t index : indices) {
        const std::array<float, 3>& at = view.positions[index];
        box.extend({{at[0], at[1], at[2]}, {at[0], at[1], at[2]}});
    }
    return box;
}

BlasInput inputOf(const SceneEditor::State& state, const GpuPrimitive& primitive,
                  const TriangleRange& triangles) {
    BlasInput input;
    input.dataAccess = state.dataAccess;
    input.geometries.push_back(blasGeometry(primitive, triangles.first, triangles.count));
    input.geometries.back().once = state.passesLight;
    return input;
}

// Gives back everything that an unfinished mesh has so far.
void discardMesh(SceneEditor::State& state, EditedMesh& mesh) {
    for (EditedMeshPrimitive& primitive : mesh.primitives) {
        for (EditedPart& part : primitive.parts) {
            discard(state.scene.pool, std::move(part.blas));
        }
        discard(state.scene.pool, std::move(primitive.device.buffer));
        discard(state.scene.pool, std::move(primitive.device.buildInput));
    }
}

Status makePrimitive(SceneEditor::State& state, const PrimitiveView& view, const GridPositions& positions,
                     std::vector<BlasInput>* inputs, EditedMeshPrimitive& made) {
    GpuScene::State& scene = state.scene;
    std::vector<std::vector<std::uint32_t>> ordered;
    if (state.leafOrder != nullptr) {
        ordered = orderedTriangles(std::span(&view, 1), state.capacity, state.leafOrder);
    }
    const std::span<const std::uint32_t> indices = ordered.empty() ? view.indices : std::span(ordered[0]);
    const Package& package = state.cases.package();
    std::vector<float> declared;
    if (!package.attributes().empty()) {
        declared = joinAllAttributes(package, view);
    }
    GLINT_TRY(made.device, uploadPrimitive(scene.context, scene.pool, *state.uploader, view,
                                           {indices, declared, positions.words},
                                           {state.vertices, state.capacity.triangles, &scene.pool}));
    made.attributes = attributesOf(package, view);
    if (state.emission != nullptr) {
        made.shape = std::make_shared<EmitterShape>(*state.emission, view, indices);
    }
    for (std::uint32_t first = 0; first < made.device.triangleCount;) {
        const auto count = static_cast<std::uint32_t>(
            std::min<std::uint64_t>(made.device.triangleCount - first, state.capacity.triangles));
        EditedPart& part = made.parts.emplace_back();
        part.triangles = {0, first, count};
        part.box = boxOf(view, indices.subspan(std::size_t{3} * first, std::size_t{3} * count));
        const BlasInput input = inputOf(state, made.device, part.triangles);
        if (inputs != nullptr) {
            inputs->push_back(input);
        } else {
            BlasBuild build = describeBuild(scene.context, input);
            GLINT_TRY(part.blas, createStructure(scene.context, scene.pool, build.structureBytes,
                                                 VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR));
            build.info.dstAccelerationStructure = part.blas.handle.get();
            state.builds.push_back({std::move(build), {}});
        }
        first += count;
    }
    if (inputs == nullptr) {
        state.builds.back().input = std::move(made.device.buildInput);
    }
    return okStatus();
}

void retireMesh(SceneEditor::State& state, EditedMesh&& mesh) {
    for (EditedMeshPrimitive& primitive : mesh.primitives) {
        for (EditedPart& part : primitive.parts) {
            state.retired.add(std::move(part.blas));
        }
        state.retired.add(std::move(primitive.device.buffer));
    }
}

void countUse(SceneEditor::State& state, MaterialHandle material, bool adds) {
    if (EditedMaterial* const entry = state.materialSlots.find(material); entry != nullptr) {
        entry->uses = adds ? entry->uses + 1 : entry->uses - 1;
    }
}

// Checks the materials of an instance of a mesh and reports those without a case. Materials of the mesh are
// reported by the edits of the mesh.
Result<EditReport> checkMaterials(const SceneEditor::State& state, const EditedMesh& mesh,
                                  std::span<const MaterialHandle> materials, const std::string& where) {
    if (!materials.empty() && materials.size() != mesh.primitives.size()) {
        return makeError("scene-edit-value", where,
                         "there are " + std::to_string(materials.size()) + " materials for " +
                             std::to_string(mesh.primitives.size()) + " primitives",
                         "give one for each primitive, or none");
    }
    EditReport report;
    for (std::size_t i = 0; i < materials.size(); ++i) {
        if (materials[i].generation == 0) {
            continue;
        }
        GLINT_TRY(auto shading, shadingOf(state, materials[i], mesh.primitives[i].attributes));
        addTo(report, state, materials[i], shading);
    }
    return report;
}

// Gives back the records and the uses of an instance.
void unplace(SceneEditor::State& state, const EditedInstance& instance) {
    state.geometryRuns.release(instance.firstGeometry, instance.geometryCount);
    --state.meshes.find(instance.mesh)->uses;
    for (const MaterialHandle material : instance.materials) {
        countUse(state, material, false);
    }
    state.tlasDirty = true;
    state.drawsDirty = true;
}

void place(SceneEditor::State& state, EditedInstance& instance) {
    EditedMesh& mesh = *state.meshes.find(instance.mesh);
    instance.geometryCount = mesh.partCount;
    instance.firstGeometry = state.geometryRuns.allocate(instance.geometryCount);
    ++mesh.uses;
    for (const MaterialHandle material : instance.materials) {
        countUse(state, material, true);
    }
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
                                             &AttributeView::name) != primitive.attributes.end();
        mask |= AttributeMask{given} << bit++;
    }
    return mask;
}

bool EditedInstance::isShown() const {
    return visible && isInvertible(objectToWorld);
}

MaterialHandle materialOf(const SceneEditor::State& state, const EditedInstance& instance,
                          std::size_t primitive) {
    const bool own = !instance.materials.empty() && instance.materials[primitive].generation != 0;
    return own ? instance.materials[primitive]
               : state.meshes.find(instance.mesh)->primitives[primitive].material;
}

void writeGeometries(SceneEditor::State& state, InstanceHandle handle, const EditedInstance& instance) {
    const EditedMesh& mesh = *state.meshes.find(instance.mesh);
    std::uint32_t index = instance.firstGeometry;
    for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
        const EditedMeshPrimitive& primitive = mesh.primitives[i];
        const MaterialHandle material = materialOf(state, instance, i);
        const Shading shading = *shadingOf(state, material, primitive.attributes);
        package::PrimitiveEntry entry{};
        entry.shaderId = shading.shaderId;
        entry.materialIndex = material.index;
        entry.featureLobes = static_cast<std::uint32_t>(shading.features);
        entry.featureInputs = static_cast<std::uint32_t>(shading.features >> 32U);
        entry.geometryFlags = shading.geometryFlags;
        for (const EditedPart& part : primitive.parts) {
            state.geometries.write(
                index++, makeGeometryRecord(entry, primitive.device, part.triangles.first, handle.index));
        }
    }
    noteEmitters(state, handle, instance);
    state.tlasDirty = true;
    state.drawsDirty = true;
}

Result<EditedMesh> makeMesh(SceneEditor::State& state, std::span<const PrimitiveView> primitives,
                            std::vector<BlasInput>* inputs) {
    EditedMesh mesh;
    const std::size_t copies = state.uploader->waiting();
    const std::size_t builds = state.builds.size();
    const std::vector<GridPositions> positions = packPositions(primitives, state.vertices);
    const std::vector<PrimitiveView> placed = withPositions(primitives, positions);
    for (std::size_t i = 0; i < placed.size(); ++i) {
        EditedMeshPrimitive& made = mesh.primitives.emplace_back();
        if (Status status = makePrimitive(state, placed[i], positions[i], inputs, made); !status) {
            if (state.upload == nullptr) {
                state.uploader->forgetAfter(copies);
            }
            for (; state.builds.size() > builds; state.builds.pop_back()) {
                discard(state.scene.pool, std::move(state.builds.back().input));
            }
            discardMesh(state, mesh);
            return status.error();
        }
        mesh.partCount += static_cast<std::uint32_t>(made.parts.size());
    }
    return mesh;
}

InstanceHandle placeInstance(SceneEditor::State& state, EditedInstance instance) {
    place(state, instance);
    const InstanceHandle handle = state.instanceSlots.add(std::move(instance));
    const EditedInstance& placed = *state.instanceSlots.find(handle);
    state.instances.write(handle.index, makeInstanceRecord(placed.objectToWorld));
    writeGeometries(state, handle, placed);
    return handle;
}

Result<AddedMesh> SceneEditor::addMesh(std::span<const EditedPrimitive> primitives) {
    if (primitives.empty()) {
        return makeError("scene-edit-value", "", "the mesh has no primitive", "give at least one");
    }
    AddedMesh added;
    std::vector<PrimitiveView> views;
    for (const EditedPrimitive& primitive : primitives) {
        const std::string where = placeOf("mesh", state_->meshes.next().index) + ", " +
                                  placeOf("primitive", static_cast<std::uint32_t>(views.size()));
        GLINT_TRY_DO(checkPrimitive(*state_, primitive, where));
        const AttributeMask attributes = attributesOf(state_->cases.package(), primitive.geometry);
        GLINT_TRY(auto shading, shadingOf(*state_, primitive.material, attributes));
        addTo(added.report, *state_, primitive.material, shading);
        views.push_back(primitive.geometry);
    }
    GLINT_TRY(auto mesh, makeMesh(*state_, views, nullptr));
    for (std::size_t i = 0; i < primitives.size(); ++i) {
        mesh.primitives[i].material = primitives[i].material;
        countUse(*state_, primitives[i].material, true);
    }
    added.mesh = state_->meshes.add(std::move(mesh));
    return added;
}

Result<EditReport> SceneEditor::setMeshMaterial(MeshHandle mesh, std::uint32_t primitive,
                                                MaterialHandle material) {
    EditedMesh* const entry = state_->meshes.find(mesh);
    if (entry == nullptr) {
        return unknownHandle("mesh");
    }
    if (primitive >= entry->primitives.size()) {
        return makeError("scene-edit-value", placeOf("mesh", mesh.index),
                         "the mesh has no primitive " + std::to_string(primitive), "count from 0");
    }
    EditedMeshPrimitive& place = entry->primitives[primitive];
    GLINT_TRY(auto shading, shadingOf(*state_, material, place.attributes));
    EditReport report;
    addTo(report, *state_, material, shading);
    countUse(*state_, place.material, false);
    countUse(*state_, material, true);
    place.material = material;
    state_->instanceSlots.forEach([&](InstanceHandle handle, const EditedInstance& instance) {
        if (instance.mesh == mesh) {
            writeGeometries(*state_, handle, instance);
        }
    });
    return report;
}

Status SceneEditor::removeMesh(MeshHandle mesh) {
    const EditedMesh* const entry = state_->meshes.find(mesh);
    if (entry == nullptr) {
        return unknownHandle("mesh");
    }
    if (entry->uses > 0) {
        return makeError("scene-edit-used", placeOf("mesh", mesh.index),
                         std::to_string(entry->uses) + " instances use the mesh",
                         "remove them first, or give them another mesh");
    }
    for (const EditedMeshPrimitive& primitive : entry->primitives) {
        countUse(*state_, primitive.material, false);
    }
    retireMesh(*state_, state_->meshes.take(mesh));
    return okStatus();
}

Result<AddedInstance> SceneEditor::addInstance(const PlacedMesh& placed) {
    const std::string where = placeOf("instance", state_->instanceSlots.next().index);
    const EditedMesh* const mesh = state_->meshes.find(placed.mesh);
    if (mesh == nullptr) {
        return unknownHandle("mesh");
    }
    if (!isFinite(placed.objectToWorld)) {
        return notFinite(where);
    }
    GLINT_TRY(auto report, checkMaterials(*state_, *mesh, placed.materials, where));
    if (state_->geometryRuns.end() > kMostGeometries - mesh->partCount) {
        return makeError("scene-geometries", where,
                         "the scene's instances have more than 2^24 - 2 primitives altogether",
                         "join primitives of a material, or use fewer instances");
    }
    EditedInstance instance;
    instance.mesh = placed.mesh;
    instance.objectToWorld = placed.objectToWorld;
    instance.visible = placed.visible;
    instance.materials.assign(placed.materials.begin(), placed.materials.end());
    return AddedInstance{placeInstance(*state_, std::move(instance)), std::move(report)};
}

Status SceneEditor::moveInstance(InstanceHandle instance, const std::array<float, 12>& objectToWorld) {
    EditedInstance* const entry = state_->instanceSlots.find(instance);
    if (entry == nullptr) {
        return unknownHandle("instance");
    }
    if (!isFinite(objectToWorld)) {
        return notFinite(placeOf("instance", instance.index));
    }
    const bool wasShown = entry->isShown();
    const gpu::InstanceRecord record = makeInstanceRecord(objectToWorld);
    const bool turned = state_->instances.read<gpu::InstanceRecord>(instance.index).flags != record.flags;
    entry->objectToWorld = objectToWorld;
    state_->instances.write(instance.index, record);
    moveEmitters(*state_, instance);
    state_->tlasDirty = true;
    state_->drawsDirty = state_->drawsDirty || turned || wasShown != entry->isShown();
    return okStatus();
}

Status SceneEditor::showInstance(InstanceHandle instance, bool visible) {
    EditedInstance* const entry = state_->instanceSlots.find(instance);
    if (entry == nullptr) {
        return unknownHandle("instance");
    }
    if (entry->visible != visible) {
        entry->visible = visible;
        moveEmitters(*state_, instance);
        state_->tlasDirty = true;
        state_->drawsDirty = true;
    }
    return okStatus();
}

Result<EditReport> SceneEditor::setInstanceMesh(InstanceHandle instance, MeshHandle mesh,
                                                std::span<const MaterialHandle> materials) {
    EditedInstance* const entry = state_->instanceSlots.find(instance);
    const EditedMesh* const wanted = state_->meshes.find(mesh);
    if (entry == nullptr || wanted == nullptr) {
        return unknownHandle(entry == nullptr ? "instance" : "mesh");
    }
    const std::string where = placeOf("instance", instance.index);
    Result<EditReport> report = checkMaterials(*state_, *wanted, materials, where);
    if (!report) {
        return report.error();
    }
    if (state_->geometryRuns.end() > kMostGeometries - wanted->partCount) {
        return makeError("scene-geometries", where,
                         "the scene's instances have more than 2^24 - 2 primitives altogether",
                         "join primitives of a material, or use fewer instances");
    }
    unplace(*state_, *entry);
    entry->mesh = mesh;
    entry->materials.assign(materials.begin(), materials.end());
    place(*state_, *entry);
    writeGeometries(*state_, instance, *entry);
    state_->geometries.shrink(state_->geometryRuns.end());
    state_->firstEmitters.shrink(state_->geometryRuns.end());
    return report;
}

Result<EditReport> SceneEditor::setInstanceMaterial(InstanceHandle instance, std::uint32_t primitive,
                                                    MaterialHandle material) {
    EditedInstance* const entry = state_->instanceSlots.find(instance);
    if (entry == nullptr) {
        return unknownHandle("instance");
    }
    const EditedMesh& mesh = *state_->meshes.find(entry->mesh);
    if (primitive >= mesh.primitives.size()) {
        return makeError("scene-edit-value", placeOf("instance", instance.index),
                         "its mesh has no primitive " + std::to_string(primitive), "count from 0");
    }
    EditReport report;
    if (material.generation != 0) {
        GLINT_TRY(auto shading, shadingOf(*state_, material, mesh.primitives[primitive].attributes));
        addTo(report, *state_, material, shading);
    }
    entry->materials.resize(mesh.primitives.size());
    countUse(*state_, entry->materials[primitive], false);
    countUse(*state_, material, true);
    entry->materials[primitive] = material;
    writeGeometries(*state_, instance, *entry);
    return report;
}

Status SceneEditor::removeInstance(InstanceHandle instance) {
    if (state_->instanceSlots.find(instance) == nullptr) {
        return unknownHandle("instance");
    }
    const EditedInstance gone = state_->instanceSlots.take(instance);
    moveEmitters(*state_, instance, true);
    unplace(*state_, gone);
    state_->geometries.shrink(state_->geometryRuns.end());
    state_->firstEmitters.shrink(state_->geometryRuns.end());
    state_->instances.shrink(state_->instanceSlots.end());
    return okStatus();
}

}  // namespace glint
