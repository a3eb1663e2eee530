// SceneStore: meshes and their BLASes, instances and their shapes.
#include "data/scene_checks.h"
#include "data/traversal_order.h"
#include "scene/scene_store.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace glint {
namespace {

constexpr std::uint32_t kRowsOfJoint = 3;
constexpr std::uint32_t kWeightsOfRow = 4;

// The indices of a primitive, in the order of its triangles on the device.
std::span<const std::uint32_t> indicesOf(const MeshContent& content, std::size_t index) {
    const bool isOrdered = !content.ordered.empty() && !content.ordered[index].empty();
    return isOrdered ? std::span(content.ordered[index]) : content.primitives[index].indices;
}

Status makePrimitive(SceneStore& store, const Package& package, const MeshContent& content, std::size_t index,
                     StoredPrimitive& made) {
    GpuScene::State& scene = store.scene;
    const PrimitiveView& view = content.primitives[index];
    const std::span<const std::uint32_t> indices = indicesOf(content, index);
    if (!content.entries.empty()) {
        made.entry = *content.entries[index];
        made.micromap = content.micromaps[index];
    }
    std::vector<float> declared;
    if (!package.attributes().empty()) {
        declared =
            store.editable ? joinAllAttributes(package, view) : joinAttributes(package, made.entry, view);
    }
    MemoryPool& inputs = store.upload != nullptr ? store.upload->pool : scene.pool;
    GLINT_TRY(made.device, uploadPrimitive(scene.context, scene.pool, *store.uploader, view,
                                           {indices, declared, content.positions[index].words},
                                           {content.changes ? SceneView::VertexForm::Full : store.vertices,
                                            store.capacity.triangles, &inputs}));
    // A scene that has one pose needs them no longer when that is computed.
    MemoryPool& sources = store.keeps() ? scene.pool : inputs;
    GLINT_TRY(made.source, uploadDeformSource(scene.context, sources, *store.uploader, view));
    if (store.editable) {
        made.attributes = attributesOf(package, view);
        made.split = content.splits.empty() ? std::nullopt : content.splits[index];
    }
    if (store.editable || (made.entry.geometryFlags & gpu::kGeometryEmitter) != 0) {
        made.shape =
            std::make_shared<EmitterShape>(view, indices, store.editable || hasEmissionTexture(store));
    }
    return okStatus();
}

std::vector<MeshPart> partsOf(const SceneStore& store, const StoredMesh& mesh, const MeshContent& content) {
    std::vector<PartedPrimitive> parted;
    for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
        PartedPrimitive& primitive = parted.emplace_back();
        primitive.triangleCount = mesh.primitives[i].device.triangleCount;
        if (!store.editable) {
            primitive.doubleSided = (mesh.primitives[i].entry.geometryFlags & gpu::kGeometryDoubleSided) != 0;
            primitive.split = content.splits.empty() ? std::nullopt : content.splits[i];
        }
    }
    std::vector<MeshPart> parts = partitionMesh(parted, store.capacity);
    // Sealed instances have these beside the others, whose triangles are then fewer.
    for (std::uint32_t i = 0; i < mesh.primitives.size() && store.editable; ++i) {
        if (const auto& split = mesh.primitives[i].split; split && split->tested > 0 && split->opaque > 0) {
            parts.push_back({false, {{i, split->tested, split->opaque, 0, true}}});
        }
    }
    return parts;
}

// The box around the triangles of a part that the BLAS has.
Box boxOfPart(const MeshPart& part, const MeshContent& content) {
    Box box = Box::nothing();
    for (const TriangleRange& range : part.ranges) {
        const std::span<const std::uint32_t> indices = indicesOf(content, range.primitive);
        box.extend(boxOf(content.primitives[range.primitive],
                         indices.subspan(std::size_t{3} * range.first, std::size_t{3} * range.count)));
    }
    return box;
}

Status makeParts(SceneStore& store, const MeshContent& content, StoredMesh& mesh) {
    for (MeshPart& part : partsOf(store, mesh, content)) {
        StoredPart& made = mesh.parts.emplace_back();
        static_cast<MeshPart&>(made) = std::move(part);
        made.box = boxOfPart(made, content);
        const bool isDecided = made.ranges.front().drawn == 0;
        mesh.mainParts += isDecided ? 0 : 1;
        (isDecided ? mesh.decidedCount : mesh.geometryCount) +=
            static_cast<std::uint32_t>(made.ranges.size());
        if (mesh.mayDeform()) {
            const std::uint32_t first = made.ranges.front().primitive;
            made.bounds.emplace(content.primitives.subspan(first, made.ranges.back().primitive - first + 1));
        }
    }
    return content.isShared ? openMesh(store, store.meshes.next(), mesh) : okStatus();
}

Status fillMesh(SceneStore& store, const Package& package, const MeshContent& content, StoredMesh& mesh) {
    mesh.changes = content.changes;
    for (std::size_t i = 0; i < content.primitives.size(); ++i) {
        StoredPrimitive& primitive = mesh.primitives.emplace_back();
        GLINT_TRY_DO(makePrimitive(store, package, content, i, primitive));
        mesh.jointCount = std::max(mesh.jointCount, primitive.source.jointCount);
        mesh.weightCount = std::max(mesh.weightCount, primitive.source.targets);
    }
    if (mesh.mayDeform()) {
        mesh.bounds = std::make_shared<MotionBounds>(content.primitives);
    }
    return makeParts(store, content, mesh);
}

void retire(SceneStore& store, OwnShape& shape) {
    for (AccelerationStructure& blas : shape.blases) {
        store.retired.add(takeStructure(store, blas));
    }
    for (DeformedVertices& vertices : shape.vertices) {
        store.retired.add(std::move(vertices.buffer));
    }
}

}  // namespace

Result<MeshHandle> addMesh(SceneStore& store, const Package& package, const MeshContent& content) {
    StoredMesh mesh;
    const std::size_t copies = store.uploader->waiting();
    if (Status status = fillMesh(store, package, content, mesh); !status) {
        if (store.upload == nullptr) {
            store.uploader->forgetAfter(copies);
        }
        return status.error();
    }
    // Only the next recording reads the input of builds.
    for (StoredPrimitive& primitive : mesh.primitives) {
        if (store.upload != nullptr) {
            store.upload->keep(std::move(primitive.device.buildInput));
        } else {
            store.retired.add(std::move(primitive.device.buildInput));
        }
    }
    return store.meshes.add(std::move(mesh));
}

Status changeVertices(SceneStore& store, MeshHandle handle, std::size_t primitive,
                      const SceneEditor::VertexValues& vertices) {
    StoredMesh& mesh = store.meshes.at(handle.index);
    StoredPrimitive& changed = mesh.primitives[primitive];
    const Buffer& buffer = changed.device.buffer;
    const std::size_t copies = store.uploader->waiting();
    for (const auto& [bytes, address] : {std::pair(bytesOf(vertices.positions), changed.device.positions),
                                         std::pair(bytesOf(vertices.normals), changed.device.normals),
                                         std::pair(bytesOf(vertices.tangents), changed.device.tangents)}) {
        if (bytes.empty()) {
            continue;
        }
        if (Status status = store.uploader->copyToBuffer(bytes, buffer, address - buffer.address); !status) {
            store.uploader->forgetAfter(copies);
            return status;
        }
    }
    Box box = Box::nothing();
    for (const std::array<float, 3>& point : vertices.positions) {
        box.extend({{point[0], point[1], point[2]}, {point[0], point[1], point[2]}});
    }
    for (StoredPart& part : mesh.parts) {
        part.box = part.ranges.front().primitive == primitive ? box : part.box;
    }
    store.reshapedMeshes.insert(handle.index);
    if (changed.shape != nullptr) {
        EmitterShape shape = *changed.shape;
        shape.positions.assign(vertices.positions.begin(), vertices.positions.end());
        changed.shape = std::make_shared<EmitterShape>(std::move(shape));
    }
    for (const std::uint32_t index : mesh.instances) {
        // The triangles of a light are others.
        moveEmitters(store, store.instanceSlots.handleAt(index), true);
        store.emittersDirty = store.emittersDirty || store.emissiveInstances.contains(
                                                         store.instanceSlots.handleAt(index).generation);
        placeParts(store, store.instanceSlots.at(index));
    }
    return okStatus();
}

void retireMesh(SceneStore& store, MeshHandle handle) {
    store.reshapedMeshes.erase(handle.index);
    StoredMesh mesh = store.meshes.take(handle);
    for (StoredPart& part : mesh.parts) {
        store.retired.add(takeStructure(store, part.blas));
    }
    for (const std::unique_ptr<SealedForm>& form : mesh.forms) {
        retireForm(store, *form);
    }
    for (StoredPrimitive& primitive : mesh.primitives) {
        store.retired.add(std::move(primitive.device.buffer));
        store.retired.add(std::move(primitive.source.buffer));
    }
}

void countUse(Slots<StoredMaterial, MaterialHandle>& materials, MaterialHandle material,
              Users StoredMaterial::*users, std::uint32_t user, bool adds) {
    if (StoredMaterial* const entry = materials.find(material); entry != nullptr) {
        countUse(entry->*users, user, adds);
    }
}

Diagnostic tooManyGeometries(const std::string& where) {
    return makeError("scene-geometries", where,
                     "the scene's instances have more than 2^24 - 2 primitives altogether",
                     "join primitives of a material, or use fewer instances");
}

namespace {

// Counts the records and the triangles of an instance, once more or once less.
void countRecords(SceneStore& store, const StoredInstance& instance, bool adds) {
    GpuScene::Statistics& statistics = store.scene.statistics;
    forEachGeometry(*store.meshes.find(instance.mesh), instance,
                    [&](const TriangleRange& range, const StoredPrimitive&, std::uint32_t) {
                        if (adds) {
                            ++statistics.geometries;
                            statistics.triangles += range.drawn;
                        } else {
                            --statistics.geometries;
                            statistics.triangles -= range.drawn;
                        }
                    });
}

// Notes that the mesh has one instance more or less, which may decide about its BLASes.
void noteUse(SceneStore& store, const StoredInstance& instance) {
    const StoredMesh& mesh = *store.meshes.find(instance.mesh);
    if (store.editable && (!mesh.isOpen || !mesh.forms.empty())) {
        store.reformed.insert(instance.mesh.index);
    }
}

// Links the instance to its mesh and its materials, and gives it geometry records.
void link(SceneStore& store, std::uint32_t index, StoredInstance& instance) {
    StoredMesh& mesh = *store.meshes.find(instance.mesh);
    const bool isLeftOut = !store.keeps() && !instance.isShown();
    instance.geometryCount = isLeftOut ? 0 : mesh.geometryCount;
    instance.firstGeometry = store.geometryRuns.allocate(instance.geometryCount);
    instance.placeInMesh = static_cast<std::uint32_t>(mesh.instances.size());
    mesh.instances.push_back(index);
    for (const MaterialHandle material : instance.materials) {
        countUse(store.materialSlots, material, &StoredMaterial::instances, index, true);
    }
    countRecords(store, instance, true);
    noteUse(store, instance);
}

void releaseShape(SceneStore& store, std::uint32_t index, StoredInstance& instance) {
    if (instance.shape == nullptr) {
        return;
    }
    OwnShape& shape = *instance.shape;
    retire(store, shape);
    store.poseRuns.release(shape.pose.first, shape.pose.end - shape.pose.first);
    store.deformRuns.release(shape.records.first, shape.records.end - shape.records.first);
    store.shaped.erase(index);
    store.reshaped.erase(index);
    instance.shape.reset();
    ++store.shapeVersion;
}

// Takes the instance out of the TLAS and gives back its records and uses.
void unlink(SceneStore& store, std::uint32_t index, StoredInstance& instance) {
    StoredMesh& mesh = *store.meshes.find(instance.mesh);
    forEachPart(mesh, instance,
                [&](std::size_t /*part*/, std::uint32_t geometry) { store.topLevel.remove(geometry); });
    leaveForm(store, instance);
    countRecords(store, instance, false);
    store.sealing.erase(index);
    noteUse(store, instance);
    store.draws.set(index, {});
    store.drawsDirty = true;
    store.geometryRuns.release(instance.firstGeometry, instance.geometryCount);
    const std::uint32_t last = mesh.instances.back();
    mesh.instances[instance.placeInMesh] = last;
    mesh.instances.pop_back();
    if (last != index) {
        store.instanceSlots.at(last).placeInMesh = instance.placeInMesh;
    }
    for (const MaterialHandle material : instance.materials) {
        countUse(store.materialSlots, material, &StoredMaterial::instances, index, false);
    }
    releaseShape(store, index, instance);
}

void shrinkRecords(SceneStore& store) {
    shrinkGeometries(store);
    store.instances.shrink(store.instanceSlots.end());
}

std::uint32_t rowsOfWeights(std::uint32_t weights) {
    return (weights + kWeightsOfRow - 1) / kWeightsOfRow;
}

Status fillShape(SceneStore& store, const StoredMesh& mesh, OwnShape& shape) {
    GpuScene::State& scene = store.scene;
    for (const StoredPrimitive& primitive : mesh.primitives) {
        DeformedVertices& vertices = shape.vertices.emplace_back();
        if (primitive.source.moves(shape.joints > 0, shape.weights > 0)) {
            GLINT_TRY(vertices, createDeformedVertices(scene.context, scene.pool, primitive.device));
        }
    }
    const std::size_t parts = store.editable ? mesh.mainParts : mesh.parts.size();
    for (std::size_t part = 0; part < parts; ++part) {
        BlasBuild& build = shape.builds.emplace_back(describeBuild(
            scene.context, inputOf(store, mesh, std::span(mesh.parts).subspan(part, 1), &shape)));
        GLINT_TRY_DO(makeStructure(store, build, !store.keeps(), shape.blases.emplace_back()));
    }
    shape.histories.resize(parts);
    return okStatus();
}

// Makes the vertices and BLASes of an instance that `pose` gives a shape of its own.
Result<std::unique_ptr<OwnShape>> makeShape(SceneStore& store, const Package* package, const StoredMesh& mesh,
                                            const InstanceView& pose) {
    if (!store.deformPass) {
        GLINT_TRY(auto pass, DeformPass::create(store.scene.context, *package));
        store.deformPass.emplace(std::move(pass));
    }
    auto shape = std::make_unique<OwnShape>();
    shape->joints = static_cast<std::uint32_t>(pose.joints.size());
    shape->weights = static_cast<std::uint32_t>(pose.morphWeights.size());
    if (Status status = fillShape(store, mesh, *shape); !status) {
        for (AccelerationStructure& blas : shape->blases) {
            takeStructure(store, blas);
        }
        return status.error();
    }
    const auto run = [](RunAllocator& runs, std::uint32_t count) {
        const std::uint32_t first = runs.allocate(count);
        return IndexRange{first, first + count};
    };
    shape->pose = run(store.poseRuns, kRowsOfJoint * shape->joints + rowsOfWeights(mesh.weightCount));
    shape->records =
        run(store.deformRuns,
            static_cast<std::uint32_t>(std::ranges::count_if(
                shape->vertices, [](const DeformedVertices& vertices) { return vertices.positions != 0; })));
    return shape;
}

// Writes the joints and weights. Returns whether they are others than before.
bool writePose(SceneStore& store, const OwnShape& shape, const InstanceView& pose) {
    std::vector<gpu::vec4> rows(shape.pose.end - shape.pose.first);
    if (!pose.joints.empty()) {
        std::memcpy(rows.data(), pose.joints.data(), pose.joints.size_bytes());
    }
    if (!pose.morphWeights.empty()) {
        std::memcpy(rows.data() + std::size_t{kRowsOfJoint} * shape.joints, pose.morphWeights.data(),
                    pose.morphWeights.size_bytes());
    }
    bool changes = false;
    for (std::uint32_t i = 0; i < rows.size(); ++i) {
        const std::uint32_t row = shape.pose.first + i;
        const auto* const bytes = reinterpret_cast<const std::uint8_t*>(&rows[i]);
        const bool isSame = row < store.poses.count() &&
                            std::ranges::equal(store.poses.at(row), std::span(bytes, sizeof rows[i]));
        if (!isSame) {
            store.poses.write(row, rows[i]);
            changes = true;
        }
    }
    return changes;
}

// Gives the instance its shape, whose records of deforming are then written.
void takeShape(SceneStore& store, std::uint32_t index, StoredInstance& instance,
               std::unique_ptr<OwnShape> shape, const InstanceView& pose) {
    writePose(store, *shape, pose);
    instance.shape = std::move(shape);
    store.shaped.insert(index);
    store.reshaped.insert(index);
    writeDeforms(store, index, store.poses.device.address);
}

gpu::GeometryRecord recordAt(const SceneStore& store, const StoredInstance& instance, std::uint32_t index,
                             const TriangleRange& range, const StoredPrimitive& primitive) {
    gpu::GeometryRecord record =
        makeGeometryRecord(entryOf(store, instance, range.primitive), primitive.device, range.first, index);
    if (instance.shape != nullptr && instance.shape->vertices[range.primitive].positions != 0) {
        const DeformedVertices& own = instance.shape->vertices[range.primitive];
        record.positions = own.positions;
        record.normals = own.normals;
        record.tangents = own.tangents;
        record.flags &=
            ~(gpu::kGeometryPackedPositions | gpu::kGeometryPackedNormals | gpu::kGeometryPackedTangents);
    }
    return record;
}

// A BLAS of a scene that is edited is seen from both sides if the material of its geometry says so.
VkAccelerationStructureInstanceKHR placedAt(const SceneStore& store, const StoredInstance& instance,
                                            std::size_t part, VkDeviceAddress blas, std::uint32_t geometry) {
    if (!store.editable) {
        const bool doubleSided = store.meshes.find(instance.mesh)->parts[part].doubleSided;
        return makePlaced(doubleSided, geometry, instance.objectToWorld, blas);
    }
    const auto record = store.geometries.read<gpu::GeometryRecord>(geometry);
    VkAccelerationStructureInstanceKHR placed =
        makePlaced((record.flags & gpu::kGeometryDoubleSided) != 0, geometry, instance.objectToWorld, blas);
    const std::uint32_t flags =
        placed.flags | static_cast<std::uint32_t>(isOpaque(store, instance, part)
                                                      ? VK_GEOMETRY_INSTANCE_FORCE_OPAQUE_BIT_KHR
                                                      : VK_GEOMETRY_INSTANCE_FORCE_NO_OPAQUE_BIT_KHR);
    placed.flags = flags & 0xFFU;
    // The shader binding table has a record for each shader ID.
    placed.instanceShaderBindingTableRecordOffset = record.shaderId & 0xFFFFFFU;
    return placed;
}

}  // namespace

package::PrimitiveEntry entryOf(const SceneStore& store, const StoredInstance& instance,
                                std::size_t primitive) {
    const StoredPrimitive& stored = store.meshes.find(instance.mesh)->primitives[primitive];
    if (!store.editable) {
        return stored.entry;
    }
    const MaterialHandle material = materialOf(store, instance, primitive);
    const Shading shading = *shadingOf(store, material, stored.attributes);
    package::PrimitiveEntry entry{};
    entry.shaderId = shading.shaderId;
    entry.materialIndex = material.index;
    entry.key = shading.features;
    entry.geometryFlags = shading.geometryFlags;
    return entry;
}

void shrinkGeometries(SceneStore& store) {
    store.geometries.shrink(store.geometryRuns.end());
    store.firstEmitters.shrink(store.geometryRuns.end());
}

void writeGeometries(SceneStore& store, InstanceHandle handle, const StoredInstance& instance) {
    const StoredMesh& mesh = *store.meshes.find(instance.mesh);
    bool turns = false;
    forEachGeometry(
        mesh, instance,
        [&](const TriangleRange& range, const StoredPrimitive& primitive, std::uint32_t index) {
            const gpu::GeometryRecord record = recordAt(store, instance, handle.index, range, primitive);
            const std::uint32_t before = index < store.geometries.count()
                                             ? store.geometries.read<gpu::GeometryRecord>(index).flags
                                             : record.flags;
            turns = turns || ((before ^ record.flags) & gpu::kGeometryDoubleSided) != 0;
            store.geometries.write(index, record);
        });
    if (turns) {
        placeDraws(store, handle, instance);
    }
    noteEmitters(store, handle, instance);
    checkSeal(store, store.instanceSlots.at(handle.index));
    placeParts(store, instance);
    ++store.shapeVersion;
}

void placeParts(SceneStore& store, const StoredInstance& instance) {
    const StoredMesh& mesh = *store.meshes.find(instance.mesh);
    const bool isPlaced = instance.isShown();
    const auto place = [&](std::size_t part, std::uint32_t geometry, VkDeviceAddress blas, const Box& box) {
        if (isPlaced) {
            store.topLevel.set(placedAt(store, instance, part, blas, geometry), box);
        } else {
            store.topLevel.remove(geometry);
        }
    };
    if (instance.form != nullptr) {
        for (const SealedRun& run : instance.form->runs) {
            place(run.first, geometryOf(mesh, instance, run.first), run.blas.address,
                  transformed(run.box, instance.objectToWorld));
        }
        return;
    }
    const OwnShape* const shape = instance.shape.get();
    const InstanceView pose = poseOf(store, instance);
    forEachPart(mesh, instance, [&](std::size_t i, std::uint32_t geometry) {
        const StoredPart& part = mesh.parts[i];
        place(i, geometry, shape != nullptr ? shape->blases[i].address : part.blas.address,
              shape != nullptr ? part.bounds->at(pose) : transformed(part.box, instance.objectToWorld));
    });
}

InstanceView poseOf(const SceneStore& store, const StoredInstance& instance) {
    InstanceView view;
    view.objectToWorld = instance.objectToWorld;
    view.visible = instance.visible;
    if (instance.shape != nullptr) {
        const OwnShape& shape = *instance.shape;
        const std::span<const std::uint8_t> bytes = store.poses.at(shape.pose);
        view.joints = {reinterpret_cast<const Rows*>(bytes.data()), shape.joints};
        view.morphWeights = {
            reinterpret_cast<const float*>(bytes.data() + std::size_t{shape.joints} * sizeof(Rows)),
            shape.weights};
    }
    return view;
}

void writeDeforms(SceneStore& store, std::uint32_t instance, VkDeviceAddress poses) {
    const StoredInstance& placed = store.instanceSlots.at(instance);
    const StoredMesh& mesh = *store.meshes.find(placed.mesh);
    const OwnShape& shape = *placed.shape;
    const VkDeviceAddress joints = poses + shape.pose.first * sizeof(gpu::vec4);
    const VkDeviceAddress weights = joints + shape.joints * sizeof(Rows);
    std::uint32_t record = shape.records.first;
    for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
        if (shape.vertices[i].positions != 0) {
            const StoredPrimitive& primitive = mesh.primitives[i];
            store.deforms.write(record++,
                                makeDeformRecord(primitive.device, primitive.source, shape.vertices[i],
                                                 shape.joints > 0 ? joints : 0, weights));
        }
    }
}

Result<InstanceHandle> placeInstance(SceneStore& store, const Package* package, StoredInstance instance,
                                     const InstanceView& pose) {
    std::unique_ptr<OwnShape> shape;
    const StoredMesh& mesh = *store.meshes.find(instance.mesh);
    if (mesh.deformsIn(pose)) {
        GLINT_TRY(shape, makeShape(store, package, mesh, pose));
    }
    const InstanceHandle handle = store.instanceSlots.add(std::move(instance));
    StoredInstance& placed = store.instanceSlots.at(handle.index);
    link(store, handle.index, placed);
    if (shape != nullptr) {
        takeShape(store, handle.index, placed, std::move(shape), pose);
    }
    store.instances.write(handle.index, makeInstanceRecord(placed.objectToWorld));
    writeGeometries(store, handle, placed);
    placeDraws(store, handle, placed);
    return handle;
}

void removeInstance(SceneStore& store, InstanceHandle handle) {
    moveEmitters(store, handle, true, true);
    unlink(store, handle.index, store.instanceSlots.at(handle.index));
    store.instanceSlots.take(handle);
    shrinkRecords(store);
}

void moveInstance(SceneStore& store, InstanceHandle handle, const Rows& objectToWorld, bool visible) {
    StoredInstance& instance = store.instanceSlots.at(handle.index);
    const bool wasShown = instance.isShown();
    const gpu::InstanceRecord record = makeInstanceRecord(objectToWorld);
    const bool turned = store.instances.read<gpu::InstanceRecord>(handle.index).flags != record.flags;
    if (instance.objectToWorld != objectToWorld) {
        instance.objectToWorld = objectToWorld;
        store.instances.write(handle.index, record);
    }
    instance.visible = visible;
    const bool shows = wasShown != instance.isShown();
    moveEmitters(store, handle, shows);
    placeParts(store, instance);
    if (turned || shows) {
        placeDraws(store, handle, instance);
    }
}

void exchangeMesh(SceneStore& store, InstanceHandle handle, MeshHandle mesh,
                  std::span<const MaterialHandle> materials) {
    StoredInstance& instance = store.instanceSlots.at(handle.index);
    unlink(store, handle.index, instance);
    instance.mesh = mesh;
    instance.materials.assign(materials.begin(), materials.end());
    link(store, handle.index, instance);
    writeGeometries(store, handle, instance);
    placeDraws(store, handle, instance);
    shrinkRecords(store);
}

void setOwnMaterial(SceneStore& store, InstanceHandle handle, std::size_t primitive,
                    MaterialHandle material) {
    StoredInstance& instance = store.instanceSlots.at(handle.index);
    instance.materials.resize(store.meshes.find(instance.mesh)->primitives.size());
    countUse(store.materialSlots, instance.materials[primitive], &StoredMaterial::instances, handle.index,
             false);
    countUse(store.materialSlots, material, &StoredMaterial::instances, handle.index, true);
    instance.materials[primitive] = material;
    writeGeometries(store, handle, instance);
}

Status poseInstance(SceneStore& store, const Package* package, InstanceHandle handle,
                    const InstanceView& pose) {
    StoredInstance& instance = store.instanceSlots.at(handle.index);
    OwnShape* const shape = instance.shape.get();
    const bool isSameKind =
        shape != nullptr && shape->joints == pose.joints.size() && shape->weights == pose.morphWeights.size();
    if (isSameKind) {
        if (writePose(store, *shape, pose)) {
            store.reshaped.insert(handle.index);
            moveEmitters(store, handle, false);
            placeParts(store, instance);
        }
        return okStatus();
    }
    std::unique_ptr<OwnShape> made;
    const StoredMesh& mesh = *store.meshes.find(instance.mesh);
    if (mesh.deformsIn(pose)) {
        GLINT_TRY(made, makeShape(store, package, mesh, pose));
    }
    if (made == nullptr && shape == nullptr) {
        return okStatus();
    }
    releaseShape(store, handle.index, instance);
    if (made != nullptr) {
        takeShape(store, handle.index, instance, std::move(made), pose);
    }
    writeGeometries(store, handle, instance);
    return okStatus();
}

void placeDraws(SceneStore& store, InstanceHandle handle, const StoredInstance& instance) {
    std::vector<Draw> draws;
    if (instance.isShown()) {
        const std::uint32_t flags = store.instances.read<gpu::InstanceRecord>(handle.index).flags;
        forEachGeometry(*store.meshes.find(instance.mesh), instance,
                        [&](const TriangleRange& range, const StoredPrimitive&, std::uint32_t geometry) {
                            const auto record = store.geometries.read<gpu::GeometryRecord>(geometry);
                            if (range.drawn > 0) {
                                draws.push_back({geometry, 3 * range.drawn,
                                                 (record.flags & gpu::kGeometryDoubleSided) != 0,
                                                 (flags & gpu::kInstanceMirrored) != 0, range.primitive,
                                                 instance.mesh.index});
                            }
                        });
    }
    store.draws.set(handle.index, std::move(draws));
    store.drawsDirty = true;
}

}  // namespace glint
