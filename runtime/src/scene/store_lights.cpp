// SceneRecords, and of SceneStore the lights, and emissive triangles as lights.
#include "data/instance_math.h"
#include "data/materials.h"
#include "data/opacity_split.h"
#include "package/package.h"
#include "scene/scene_store.h"

#include <algorithm>
#include <utility>

namespace glint {

namespace {

std::vector<gpu::LightRecord> lightsOf(const RecordStore& lights) {
    std::vector<gpu::LightRecord> records;
    for (std::uint32_t i = 0; i < lights.count(); ++i) {
        records.push_back(lights.read<gpu::LightRecord>(i));
    }
    return records;
}

// Brings the records to the hierarchy.
void takeTree(SceneRecords& records, std::span<const EmitterBounds> bounds) {
    records.emitters.setLeaves(records.lightTree, bounds);
    records.lightNodes.replace(records.lightTree.nodes);
    records.emitterRecords.replace(records.emitters.records);
}

}  // namespace

void SceneRecords::buildLights(const InstancePoses& poses, bool keepsDark) {
    const std::vector<EmitterBounds> bounds = emitters.boundsAt(poses);
    lightTree = buildLightTree(lightsOf(lights), bounds, keepsDark);
    takeTree(*this, bounds);
}

void SceneRecords::refitLights(const LightMoves& moves, const InstancePoses& poses) {
    std::vector<std::pair<std::uint32_t, EmitterBounds>> triangles;
    if (lightTree.refits) {
        triangles = emitters.boundsOf(moves.instances, poses);
    }
    // A refit of all nodes does less for each of them.
    const bool isFew = 8 * (triangles.size() + moves.lights.size()) < lightTree.nodes.size();
    if (!lightTree.refits || !isFew) {
        const std::vector<EmitterBounds> bounds = emitters.boundsAt(poses);
        refitLightTree(lightTree, lightsOf(lights), bounds);
        takeTree(*this, bounds);
        return;
    }
    std::vector<std::pair<std::uint32_t, gpu::LightRecord>> moved;
    for (const std::uint32_t light : moves.lights) {
        moved.emplace_back(light, lights.read<gpu::LightRecord>(light));
    }
    for (const std::uint32_t node : refitLightTree(lightTree, moved, triangles)) {
        lightNodes.write(node, lightTree.nodes[node]);
    }
    for (const auto& [triangle, bounds] : triangles) {
        gpu::EmitterRecord& record = emitters.records[triangle];
        const std::uint32_t leaf =
            bounds.intensity > 0.0 ? lightTree.refits->emitterLeaves[triangle] : gpu::kNoEmitter;
        if (std::exchange(record.leaf, leaf) != leaf) {
            emitterRecords.write(triangle, record);
        }
    }
}

void SceneRecords::countLights() {
    counts = {lights.count(), emitterRecords.count(), lightTree.treeNodes, lightTree.apart};
}

void SceneRecords::fill(gpu::FrameConstants& constants) const {
    constants.geometries = geometries.device.address;
    constants.instances = instances.device.address;
    constants.materials = materials.device.address;
    constants.lights = lights.device.address;
    constants.lightCount = counts.lights;
    constants.lightNodes = lightNodes.device.address;
    constants.lightTreeNodes = counts.treeNodes;
    constants.lightsApart = counts.apart;
    constants.emitters = emitterRecords.device.address;
    constants.firstEmitters = firstEmitters.device.address;
    constants.emitterCount = counts.emitters;
}

namespace {

bool isEmitterRecord(const SceneStore& store, std::uint32_t geometry) {
    return (store.geometries.read<gpu::GeometryRecord>(geometry).flags & gpu::kGeometryEmitter) != 0;
}

bool emitsLight(const SceneStore& store, const StoredInstance& instance) {
    const std::uint32_t end = instance.firstGeometry + instance.geometryCount;
    for (std::uint32_t i = instance.firstGeometry; i < end; ++i) {
        if (isEmitterRecord(store, i)) {
            return true;
        }
    }
    return false;
}

// The material's texture in the emission's slot. Requires that records have one.
gpu::TextureRecord emissionRecord(const SceneStore& store, std::span<const std::uint8_t> record) {
    return textureAt(tableWith(store.scene.materialLayout, record), 0, store.emission->texture);
}

// Returns null if the material has no texture there, or its texels are not known.
std::shared_ptr<const EmissionTexels> texelsOf(const SceneStore& store, const StoredInstance& instance,
                                               std::size_t primitive, const gpu::TextureRecord& record) {
    if (!store.editable) {
        return store.texelsOf(record.textureIndex);
    }
    const StoredMaterial& material = *store.materialSlots.find(materialOf(store, instance, primitive));
    const auto use =
        std::ranges::find(material.textures, store.emission->texture, &SceneEditor::TextureUse::slot);
    return use == material.textures.end() ? nullptr : store.textures.find(use->texture)->texels;
}

// An update of a sealed scene may move the textures of some materials.
bool mayChange(const SceneStore& store, std::uint32_t material) {
    return !store.editable && store.moves &&
           std::ranges::find(store.scene.changing, material, &ChangingMaterial::material) !=
               store.scene.changing.end();
}

// Appends the parts of an instance.
void addParts(SceneStore& store, const StoredInstance& instance, std::uint32_t number,
              std::vector<EmitterPart>& parts) {
    const StoredMesh& mesh = *store.meshes.find(instance.mesh);
    forEachGeometry(
        mesh, instance,
        [&](const TriangleRange& range, const StoredPrimitive& primitive, std::uint32_t geometry) {
            const auto record = store.geometries.read<gpu::GeometryRecord>(geometry);
            if ((record.flags & gpu::kGeometryEmitter) == 0) {
                return;
            }
            const std::span<const std::uint8_t> values = store.materials.at(record.materialIndex);
            EmitterPart& part = parts.emplace_back();
            part.geometry = geometry;
            part.instance = number;
            part.primitive = range.primitive;
            part.material = record.materialIndex;
            part.first = range.first;
            part.count = range.count;
            part.twoSided = (record.flags & gpu::kGeometryDoubleSided) != 0;
            part.luminance = emittedLuminance(values, *store.emission);
            part.shape = primitive.shape;
            if (instance.shape != nullptr && instance.shape->vertices[range.primitive].positions != 0) {
                part.motion = mesh.bounds;
            }
            if (hasEmissionTexture(store)) {
                const gpu::TextureRecord texture = emissionRecord(store, values);
                const bool isRead = (record.featureInputs & store.emission->textureInput) != 0;
                std::optional<EmitterTexture> emission =
                    emitterTexture(*store.emission, record.featureInputs, texture, store.samplers,
                                   isRead ? texelsOf(store, instance, range.primitive, texture) : nullptr);
                if (emission) {
                    emission->animated = mayChange(store, record.materialIndex);
                }
                part.texels = store.emitterMeans.find(part.shape, record.materialIndex, emission);
            }
            store.emissiveMaterials.insert(record.materialIndex);
        });
}

// Calls visit(instance, entry) for the instances that are lights. Those that are hidden are left out, unless
// they may be shown without other changes.
template <typename Visit>
void forEachEmissive(SceneStore& store, const Visit& visit) {
    for (auto& [generation, emissive] : store.emissiveInstances) {
        const StoredInstance& instance = *store.instanceSlots.find(emissive.handle);
        if (store.keepsDark || instance.isShown()) {
            visit(instance, emissive);
        }
    }
}

void gatherEmitters(SceneStore& store) {
    std::vector<EmitterPart> parts;
    store.emissiveMaterials.clear();
    store.numberedEmitters.clear();
    forEachEmissive(store, [&](const StoredInstance& instance, EmissiveInstance& emissive) {
        emissive.number = static_cast<std::uint32_t>(store.numberedEmitters.size());
        store.numberedEmitters.push_back(emissive.handle);
        addParts(store, instance, emissive.number, parts);
    });
    store.emitterMeans.forgetUnused();
    store.emitters = Emitters(*store.emission, std::move(parts));
    store.firstEmitters.replace(store.emitters.firstsOf(store.geometries.count()));
}

}  // namespace

bool hasEmissionTexture(const SceneStore& store) {
    return store.emission->texture != package::EmissionEntry::kNone;
}

std::shared_ptr<const EmissionTexels> emissionTexels(const ImageView& image, bool srgb) {
    const std::uint64_t wanted = bytesOfLevel(TexelFormat::Rgba8, image.width, image.height, 0);
    const bool readable = !isBlockFormat(image.format) || image.decoded.size() == wanted;
    return srgb && readable ? std::make_shared<EmissionTexels>(image, srgb) : nullptr;
}

namespace {

std::uint32_t placeOfLight(const SceneStore& store, LightHandle handle) {
    const auto place = std::ranges::find(store.lightOrder, handle);
    return static_cast<std::uint32_t>(place - store.lightOrder.begin());
}

}  // namespace

LightHandle addLight(SceneStore& store, const LightView& light) {
    const LightHandle handle = store.lightSlots.add(light);
    store.lights.write(static_cast<std::uint32_t>(store.lightOrder.size()), makeLightRecord(light));
    store.lightOrder.push_back(handle);
    store.lightsDirty = true;
    return handle;
}

void setLight(SceneStore& store, LightHandle handle, const LightView& light) {
    LightView& entry = store.lightSlots.at(handle.index);
    const std::uint32_t place = placeOfLight(store, handle);
    store.lightsDirty = store.lightsDirty || entry.type != light.type;
    store.lightMoves.lights.push_back(place);
    entry = light;
    store.lights.write(place, makeLightRecord(light));
}

void removeLight(SceneStore& store, LightHandle handle) {
    store.lightSlots.take(handle);
    std::erase(store.lightOrder, handle);
    std::vector<gpu::LightRecord> records;
    for (const LightHandle other : store.lightOrder) {
        records.push_back(makeLightRecord(*store.lightSlots.find(other)));
    }
    store.lights.replace(records);
    store.lightsDirty = true;
}

void noteEmitters(SceneStore& store, InstanceHandle handle, const StoredInstance& instance) {
    if (!store.emission) {
        return;
    }
    const bool was = store.emissiveInstances.contains(handle.generation);
    const bool is = emitsLight(store, instance);
    if (is) {
        store.emissiveInstances[handle.generation].handle = handle;
    } else if (was) {
        store.emissiveInstances.erase(handle.generation);
    }
    store.emittersDirty = store.emittersDirty || was || is;
    // These places may have held records of another instance. gatherEmitters() numbers those that are lights.
    const std::uint32_t end = instance.firstGeometry + instance.geometryCount;
    for (std::uint32_t i = instance.firstGeometry; i < end; ++i) {
        store.firstEmitters.write(i, gpu::kNoEmitter);
    }
}

void moveEmitters(SceneStore& store, InstanceHandle handle, bool changes, bool removed) {
    const auto found = store.emissiveInstances.find(handle.generation);
    if (found == store.emissiveInstances.end()) {
        return;
    }
    // Hidden triangles stay lights, which are dark.
    store.lightMoves.instances.push_back(found->second.number);
    store.emittersDirty = store.emittersDirty || removed || (changes && !store.keepsDark);
    if (removed) {
        store.emissiveInstances.erase(found);
    }
}

void replaceEmission(SceneStore& store, const StoredTexture& texture) {
    if (!store.emission || !hasEmissionTexture(store)) {
        return;
    }
    for (const auto& [material, uses] : texture.materials) {
        const std::vector<SceneEditor::TextureUse>& slots = store.materialSlots.at(material).textures;
        const auto use = std::ranges::find(slots, store.emission->texture, &SceneEditor::TextureUse::slot);
        store.emittersDirty =
            store.emittersDirty || (use != slots.end() && store.textures.find(use->texture) == &texture &&
                                    store.emissiveMaterials.contains(material));
    }
}

void forgetEmitters(SceneStore& store) {
    store.emissiveInstances.clear();
    store.emissiveMaterials.clear();
    store.numberedEmitters.clear();
    store.emitterMeans = {};
    store.emitters = {};
    store.emitterRecords.shrink(0);
    store.firstEmitters.shrink(0);
    store.emittersDirty = false;
    store.lightMoves.instances.clear();
    store.lightsDirty = true;
}

namespace {

// The part of a material's record that alpha tests read, whatever its key is.
std::vector<std::uint8_t> alphaOf(const SceneStore& store, std::span<const std::uint8_t> record) {
    package::PrimitiveEntry any{};
    any.key.inputs = ~0U;
    return alphaInputs(*store.cases->package().opacity(), tableWith(store.scene.materialLayout, record), any);
}

bool sameRecord(const gpu::TextureRecord& a, const gpu::TextureRecord& b) {
    return std::ranges::equal(std::as_bytes(std::span(&a, 1)), std::as_bytes(std::span(&b, 1)));
}

}  // namespace

void writeMaterial(SceneStore& store, std::uint32_t material, std::span<const std::uint8_t> record) {
    if (store.emissiveMaterials.contains(material)) {
        const std::span<const std::uint8_t> old = store.materials.at(material);
        const double before = emittedLuminance(old, *store.emission);
        const double after = emittedLuminance(record, *store.emission);
        const bool showsOther = store.editable && hasEmissionTexture(store) &&
                                !sameRecord(emissionRecord(store, old), emissionRecord(store, record));
        if (showsOther || (before != after && !store.keepsDark && std::min(before, after) <= 0.0)) {
            store.emittersDirty = true;
        } else if (before != after) {
            const std::vector<std::uint32_t> changed =
                store.emitters.takeMaterial({material, {record.begin(), record.end()}});
            store.lightMoves.instances.insert(store.lightMoves.instances.end(), changed.begin(),
                                              changed.end());
        }
    }
    const bool forgets = store.decidedMaterials.contains(material) &&
                         alphaOf(store, store.materials.at(material)) != alphaOf(store, record);
    store.materials.writeBytes(material, record);
    if (forgets) {
        forgetDecisions(store, material);
    }
}

void settleLights(SceneStore& store) {
    const bool rebuilds = store.lightsDirty || store.emittersDirty || store.trims;
    if (!rebuilds && store.lightMoves.isEmpty()) {
        return;
    }
    if (rebuilds) {
        const bool keepsDark = store.moves || (store.editable && !store.trims);
        const bool keptDark = std::exchange(store.keepsDark, keepsDark);
        if (store.emission && (store.emittersDirty || keptDark != keepsDark)) {
            gatherEmitters(store);
        }
    }
    const InstancePoses poses = [&](std::uint32_t number) {
        return poseOf(store, *store.instanceSlots.find(store.numberedEmitters[number]));
    };
    if (rebuilds) {
        store.buildLights(poses, store.keepsDark);
    } else {
        store.refitLights(store.lightMoves, poses);
    }
}

}  // namespace glint
