// SceneStore: the BLASes that instances share: of the parts of a mesh, and of sealed instances.
#include "package/package.h"
#include "scene/scene_store.h"

#include <glint/internal/package_modules.h>

#include <algorithm>
#include <utility>

namespace glint {
namespace {

// How many triangles of a range are in a BLAS that relies on decided alpha tests. Those that are opaque have
// a range of their own, unless all of the others let every ray through.
std::uint32_t undecided(const StoredPrimitive& primitive, const TriangleRange& range) {
    if (!primitive.split || range.drawn == 0) {
        return range.count;
    }
    return primitive.split->tested > 0 ? primitive.split->tested : primitive.split->opaque;
}

}  // namespace

BlasInput inputOf(const SceneStore& store, const StoredMesh& mesh, std::span<const StoredPart> parts,
                  const OwnShape* shape, bool decides) {
    BlasInput input;
    input.dataAccess = store.dataAccess;
    input.updatable = (shape != nullptr && store.keeps()) || mesh.changes;
    const auto add = [&](const TriangleRange& range) {
        const StoredPrimitive& primitive = mesh.primitives[range.primitive];
        BlasGeometry& geometry = input.geometries.emplace_back(
            blasGeometry(primitive.device, range.first, decides ? undecided(primitive, range) : range.count));
        if (shape != nullptr && shape->vertices[range.primitive].positions != 0) {
            geometry.positions = shape->vertices[range.primitive].positions;
        }
        if (store.editable) {
            // The TLAS says whether the material is opaque. Light may pass any material of another package.
            geometry.once = true;
            return;
        }
        const std::uint32_t flags = primitive.entry.geometryFlags;
        geometry.opaque =
            range.opaque || (flags & (gpu::kGeometryAlphaTested | gpu::kGeometryPassesLight)) == 0;
        geometry.once = (flags & gpu::kGeometryPassesLight) != 0;
        geometry.micromap = geometry.opaque ? nullptr : primitive.micromap;
    };
    for (const StoredPart& part : parts) {
        std::ranges::for_each(part.ranges, add);
    }
    return input;
}

Status makeStructure(SceneStore& store, BlasBuild& build, bool isCompacted, AccelerationStructure& made) {
    GpuScene::State& scene = store.scene;
    GLINT_TRY(made, createStructure(scene.context, isCompacted ? store.building : scene.pool,
                                    build.structureBytes, VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR));
    build.info.dstAccelerationStructure = made.handle.get();
    ++scene.statistics.blasCount;
    scene.statistics.blasBytes += made.buffer.bytes;
    if (store.upload != nullptr) {
        scene.statistics.blasUncompactedBytes += made.buffer.bytes;
    }
    return okStatus();
}

AccelerationStructure takeStructure(SceneStore& store, AccelerationStructure& place) {
    if (place.handle.get() != VK_NULL_HANDLE) {
        store.builds.erase(place.handle.get());
        --store.scene.statistics.blasCount;
        store.scene.statistics.blasBytes -= place.buffer.bytes;
    }
    return std::exchange(place, {});
}

AccelerationStructure* structureAt(SceneStore& store, const PartPlace& place) {
    if (StoredMesh* const mesh = store.meshes.find(place.mesh); mesh != nullptr) {
        if (place.form == 0) {
            return &mesh->parts[place.part].blas;
        }
        const auto form = std::ranges::find(mesh->forms, place.form, &SealedForm::number);
        return form == mesh->forms.end() ? nullptr : &(*form)->runs[place.part].blas;
    }
    StoredInstance* const instance = store.instanceSlots.find(place.instance);
    return instance == nullptr || instance->shape == nullptr ? nullptr : &instance->shape->blases[place.part];
}

namespace {

void queueBuild(SceneStore& store, BlasBuild build, const PartPlace& place) {
    const VkAccelerationStructureKHR structure = build.info.dstAccelerationStructure;
    store.builds.emplace(structure, QueuedBuild{std::move(build), place});
}

void closeMesh(SceneStore& store, StoredMesh& mesh) {
    for (StoredPart& part : mesh.parts) {
        store.retired.add(takeStructure(store, part.blas));
    }
    mesh.isOpen = false;
}

Status openParts(SceneStore& store, MeshHandle handle, StoredMesh& mesh) {
    const std::size_t parts = store.editable ? mesh.mainParts : mesh.parts.size();
    for (std::uint32_t i = 0; i < parts; ++i) {
        StoredPart& part = mesh.parts[i];
        BlasBuild build = describeBuild(store.scene.context,
                                        inputOf(store, mesh, std::span(mesh.parts).subspan(i, 1), nullptr));
        GLINT_TRY_DO(makeStructure(store, build, !mesh.changes, part.blas));
        if (mesh.changes) {
            part.build = std::move(build);
        } else {
            queueBuild(store, std::move(build), {.mesh = handle, .part = i});
        }
    }
    return okStatus();
}

}  // namespace

Status openMesh(SceneStore& store, MeshHandle handle, StoredMesh& mesh) {
    if (Status status = openParts(store, handle, mesh); !status) {
        for (StoredPart& part : mesh.parts) {
            takeStructure(store, part.blas);
        }
        return status;
    }
    if (mesh.changes) {
        store.reshapedMeshes.insert(handle.index);
    }
    mesh.isOpen = true;
    return okStatus();
}

namespace {

// Returns whether a BLAS may have several primitives. Strategies with a pipeline of their own find the shader
// of a hit by the instance of the TLAS.
bool mayJoin(const SceneStore& store) {
    DrawnScene::Users& users = *store.scene.users;
    const std::lock_guard lock(users.mutex);
    return !users.readTables &&
           (store.cases->package().shape().strategies & package::pipelineStrategies()) == 0;
}

// Returns whether the instance has the materials with which alpha tests of its mesh were decided.
bool isDecided(const SceneStore& store, const StoredInstance& instance) {
    const std::vector<StoredPrimitive>& primitives = store.meshes.find(instance.mesh)->primitives;
    bool decided = false;
    for (std::size_t i = 0; i < primitives.size(); ++i) {
        if (primitives[i].split) {
            decided = true;
            if (!store.decidedMaterials.contains(primitives[i].splitMaterial.index) ||
                materialOf(store, instance, i) != primitives[i].splitMaterial) {
                return false;
            }
        }
    }
    return decided;
}

// The properties of a part that the TLAS has for its BLAS.
struct Look {
    bool doubleSided = false;
    bool opaque = false;

    bool operator==(const Look&) const = default;
};

Look lookOf(const SceneStore& store, const StoredInstance& instance, std::size_t part, bool decides) {
    const StoredMesh& mesh = *store.meshes.find(instance.mesh);
    const bool isApart = part >= mesh.mainParts;
    const std::uint32_t number = mesh.parts[part].ranges.front().primitive;
    if (isApart) {
        // The other triangles of the primitive have the same material, and a record before the instance is
        // sealed.
        part = 0;
        while (mesh.parts[part].ranges.front().primitive != number) {
            ++part;
        }
    }
    const std::uint32_t flags =
        store.geometries.read<gpu::GeometryRecord>(geometryOf(mesh, instance, part)).flags;
    const std::optional<OpacitySplit>& split = mesh.primitives[number].split;
    const bool isDecided = decides && split && (isApart || split->tested == 0);
    return {(flags & gpu::kGeometryDoubleSided) != 0,
            isDecided || (flags & (gpu::kGeometryAlphaTested | gpu::kGeometryPassesLight)) == 0};
}

// Successive parts of an instance that are seen alike, as the ends of runs of them.
std::vector<std::uint32_t> runsOf(const SceneStore& store, const StoredInstance& instance, bool decides) {
    const StoredMesh& mesh = *store.meshes.find(instance.mesh);
    const bool joinsAny = mayJoin(store);
    const std::size_t parts = decides ? mesh.parts.size() : mesh.mainParts;
    std::vector<std::uint32_t> ends;
    std::optional<Look> last;
    std::uint64_t triangles = 0;
    for (std::uint32_t i = 0; i < parts; ++i) {
        const std::uint64_t added = mesh.parts[i].ranges.front().count;
        const std::uint32_t first = ends.size() < 2 ? 0 : ends[ends.size() - 2];
        const Look look = lookOf(store, instance, i, decides);
        // The records of decided triangles do not follow the others.
        const bool joins = joinsAny && last == look && i != mesh.mainParts &&
                           i - first < store.sealedCapacity.geometries &&
                           triangles + added <= store.sealedCapacity.triangles;
        if (!joins) {
            ends.push_back(i);
            triangles = 0;
        }
        ends.back() = i + 1;
        triangles += added;
        last = look;
    }
    return ends;
}

bool isOfRuns(const SealedForm& form, std::span<const std::uint32_t> ends, bool decides) {
    return form.decides == decides && std::ranges::equal(form.runs, ends, {}, &SealedRun::end);
}

// How many BLASes of the form have several primitives.
std::uint32_t joinedIn(const SealedForm& form) {
    return static_cast<std::uint32_t>(
        std::ranges::count_if(form.runs, [](const SealedRun& run) { return run.end - run.first > 1; }));
}

// Brings the inputs of a mesh's builds to the device again. Those of an upload are still there.
Status uploadInputs(SceneStore& store, StoredMesh& mesh) {
    if (store.upload != nullptr) {
        return okStatus();
    }
    const std::size_t copies = store.uploader->waiting();
    for (StoredPrimitive& primitive : mesh.primitives) {
        if ((primitive.device.forms & gpu::kGeometryPackedPositions) == 0) {
            continue;
        }
        if (Status status = uploadBuildInput(store.scene.context, store.scene.pool, *store.uploader,
                                             primitive.shape->positions, primitive.device);
            !status) {
            store.uploader->forgetAfter(copies);
            return status;
        }
        store.retired.add(std::move(primitive.device.buildInput));
    }
    return okStatus();
}

Status fillForm(SceneStore& store, MeshHandle handle, StoredMesh& mesh, std::span<const std::uint32_t> ends,
                SealedForm& form) {
    for (const std::uint32_t end : ends) {
        const std::uint32_t first = form.runs.empty() ? 0 : form.runs.back().end;
        SealedRun& run = form.runs.emplace_back();
        run.first = first;
        run.end = end;
        const std::span<const StoredPart> parts = std::span(mesh.parts).subspan(first, end - first);
        for (const StoredPart& part : parts) {
            run.box.extend(part.box);
        }
        BlasBuild build =
            describeBuild(store.scene.context, inputOf(store, mesh, parts, nullptr, form.decides));
        GLINT_TRY_DO(makeStructure(store, build, true, run.blas));
        queueBuild(
            store, std::move(build),
            {.mesh = handle, .form = form.number, .part = static_cast<std::uint32_t>(form.runs.size()) - 1});
    }
    return okStatus();
}

Status makeForm(SceneStore& store, MeshHandle handle, std::span<const std::uint32_t> ends, bool decides) {
    StoredMesh& mesh = *store.meshes.find(handle);
    GLINT_TRY_DO(uploadInputs(store, mesh));
    auto form = std::make_unique<SealedForm>();
    form->number = ++store.lastForm;
    form->decides = decides;
    if (Status status = fillForm(store, handle, mesh, ends, *form); !status) {
        for (SealedRun& run : form->runs) {
            takeStructure(store, run.blas);
        }
        return status;
    }
    store.scene.joinedBlases += joinedIn(*form);
    mesh.forms.push_back(std::move(form));
    return okStatus();
}

// Takes the instance out of the TLAS, where it has other places with another form.
void unplace(SceneStore& store, const StoredInstance& instance) {
    forEachPart(*store.meshes.find(instance.mesh), instance,
                [&](std::size_t /*part*/, std::uint32_t geometry) { store.topLevel.remove(geometry); });
}

Status takeForm(SceneStore& store, InstanceHandle handle) {
    StoredInstance& instance = store.instanceSlots.at(handle.index);
    StoredMesh& mesh = *store.meshes.find(instance.mesh);
    if (instance.form != nullptr || instance.shape != nullptr || mesh.changes) {
        return okStatus();
    }
    const bool decides =
        isDecided(store, instance) && store.geometryRuns.end() <= kMostGeometries - mesh.decidedCount;
    const std::vector<std::uint32_t> ends = runsOf(store, instance, decides);
    if (ends.size() == mesh.mainParts && !decides) {
        return okStatus();
    }
    const auto find = [&] {
        return std::ranges::find_if(mesh.forms,
                                    [&](const auto& form) { return isOfRuns(*form, ends, decides); });
    };
    if (find() == mesh.forms.end()) {
        GLINT_TRY_DO(makeForm(store, instance.mesh, ends, decides));
    }
    unplace(store, instance);
    instance.form = find()->get();
    ++instance.form->instances;
    store.reformed.insert(instance.mesh.index);
    if (decides && mesh.decidedCount > 0) {
        instance.firstDecided = store.geometryRuns.allocate(mesh.decidedCount);
        store.scene.statistics.geometries += mesh.decidedCount;
        writeGeometries(store, handle, instance);
    }
    placeParts(store, instance);
    return okStatus();
}

// Makes the BLASes that instances of the mesh lack, and retires those that none has.
Status settleMesh(SceneStore& store, MeshHandle handle) {
    StoredMesh& mesh = *store.meshes.find(handle);
    std::size_t sealed = 0;
    for (const std::unique_ptr<SealedForm>& form : mesh.forms) {
        sealed += form->instances;
    }
    const bool needsParts = sealed < mesh.instances.size();
    if (needsParts && !mesh.isOpen) {
        GLINT_TRY_DO(uploadInputs(store, mesh));
        GLINT_TRY_DO(openMesh(store, handle, mesh));
        for (const std::uint32_t instance : mesh.instances) {
            placeParts(store, store.instanceSlots.at(instance));
        }
    } else if (!needsParts && sealed > 0 && mesh.isOpen) {
        closeMesh(store, mesh);
    }
    std::erase_if(mesh.forms, [&](const std::unique_ptr<SealedForm>& form) {
        if (form->instances == 0) {
            retireForm(store, *form);
        }
        return form->instances == 0;
    });
    return okStatus();
}

}  // namespace

void sealInstance(SceneStore& store, InstanceHandle handle) {
    if (store.editable && store.instanceSlots.find(handle)->form == nullptr) {
        store.sealing.insert(handle.index);
    }
}

void retireForm(SceneStore& store, SealedForm& form) {
    for (SealedRun& run : form.runs) {
        store.retired.add(takeStructure(store, run.blas));
    }
    store.scene.joinedBlases -= joinedIn(form);
}

void leaveForm(SceneStore& store, StoredInstance& instance) {
    if (instance.form == nullptr) {
        return;
    }
    --instance.form->instances;
    instance.form = nullptr;
    store.reformed.insert(instance.mesh.index);
    if (instance.firstDecided) {
        const std::uint32_t count = store.meshes.find(instance.mesh)->decidedCount;
        store.geometryRuns.release(*instance.firstDecided, count);
        store.scene.statistics.geometries -= count;
        instance.firstDecided.reset();
        shrinkGeometries(store);
    }
}

bool isOpaque(const SceneStore& store, const StoredInstance& instance, std::size_t part) {
    return lookOf(store, instance, part, instance.form != nullptr && instance.form->decides).opaque;
}

void checkSeal(SceneStore& store, StoredInstance& instance) {
    if (instance.form == nullptr) {
        return;
    }
    const SealedForm& form = *instance.form;
    bool fits = instance.shape == nullptr && (joinedIn(form) == 0 || mayJoin(store)) &&
                (!form.decides || isDecided(store, instance));
    for (const SealedRun& run : form.runs) {
        for (std::uint32_t i = run.first + 1; i < run.end && fits; ++i) {
            fits = lookOf(store, instance, i - 1, form.decides) == lookOf(store, instance, i, form.decides);
        }
    }
    if (!fits) {
        unplace(store, instance);
        leaveForm(store, instance);
    }
}

void forgetDecisions(SceneStore& store, std::uint32_t material) {
    if (store.decidedMaterials.erase(material) == 0) {
        return;
    }
    for (const std::uint32_t index : instancesWith(store, store.materialSlots.at(material))) {
        StoredInstance& instance = store.instanceSlots.at(index);
        checkSeal(store, instance);
        placeParts(store, instance);
    }
}

void partBlases(SceneStore& store) {
    store.instanceSlots.forEach([&](InstanceHandle handle, StoredInstance& instance) {
        if (instance.form != nullptr && joinedIn(*instance.form) > 0) {
            unplace(store, instance);
            leaveForm(store, instance);
            store.sealing.insert(handle.index);
        }
    });
}

Status settleBlases(SceneStore& store) {
    for (; !store.sealing.empty(); store.sealing.erase(store.sealing.begin())) {
        GLINT_TRY_DO(takeForm(store, store.instanceSlots.handleAt(*store.sealing.begin())));
    }
    for (; !store.reformed.empty(); store.reformed.erase(store.reformed.begin())) {
        if (const std::uint32_t mesh = *store.reformed.begin(); store.meshes.has(mesh)) {
            GLINT_TRY_DO(settleMesh(store, store.meshes.handleAt(mesh)));
        }
    }
    return okStatus();
}

}  // namespace glint
