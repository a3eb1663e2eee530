// SceneStore: the upload of a scene.
#include "data/materials.h"
#include "data/opacity_split.h"
#include "data/traversal_order.h"
#include "package/package.h"
#include "scene/scene_store.h"
#include "scene/texture_stream.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace glint {

SceneStore::SceneStore(GpuScene::State& owner, const Package& package, const SceneView& view)
    : SceneRecords(package.scene(0).materials.recordBytes),
      scene(owner),
      moves(view.moves),
      editable(view.editable),
      capacity(blasCapacity(owner.context)),
      leafOrder(leafOrderFor(owner.context, view.traversalOrder)),
      vertices(view.vertices),
      dataAccess(package.positionFetch()),
      topLevel(view.moves, leafOrder),
      emittersDirty(package.emission() != nullptr),
      building(owner.context) {
    if (leafOrder != nullptr) {
        capacity = orderedCapacity(capacity);
    }
    sealedCapacity = capacity;
    if (editable) {
        // A BLAS holds one primitive, whose material may change.
        capacity.geometries = 1;
        // The caller keeps the package of the upload.
        cases.emplace(std::shared_ptr<const Package>(std::shared_ptr<void>(), &package));
    }
    if (package.emission() != nullptr) {
        emission = *package.emission();
    }
}

namespace {

using Clock = std::chrono::steady_clock;

double millisecondsSince(Clock::time_point begin) {
    return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

// The steps of an upload.
class SceneUploader {
public:
    SceneUploader(SceneStore& store, const Package& package, const PackageScene& known,
                  const SceneView& given)
        : store_(store),
          scene_(store.scene),
          package_(package),
          known_(known),
          positions_(packPositions(given.primitives, given.vertices)),
          primitives_(withPositions(given.primitives, positions_)),
          view_(given) {
        // Everything that is made from positions uses those that the device reads.
        view_.primitives = primitives_;
    }

    Status upload(VkCommandBuffer commands) {
        for (const auto& step :
             {&SceneUploader::addSamplers, &SceneUploader::addTextures, &SceneUploader::addMaterials,
              &SceneUploader::settleTriangles, &SceneUploader::addMeshes, &SceneUploader::addInstances}) {
            GLINT_TRY_DO((this->*step)());
        }
        for (const LightView& light : view_.lights) {
            store_.firstLights.push_back(addLight(store_, light));
            store_.posedShape.lights.push_back(light.type);
            store_.lastLights.push_back(makeLightRecord(light));
        }
        scene_.statistics.narrowedTextures = countNarrowed(scene_.context, known_.textures, view_.images);
        scene_.package = describePackage(package_, known_, view_);
        scene_.records = recordsHash(package_, known_);
        if (store_.editable) {
            scene_.shaderIds = store_.cases->shaderIds();
        } else {
            seal();
        }
        GLINT_TRY_DO(createSetLayout(scene_));
        GLINT_TRY_DO(recordChanges(store_, commands, store_.upload->frame));
        finish();
        return okStatus();
    }

private:
    // Samplers keep the package's numbers, which its records have.
    Status addSamplers() {
        GLINT_TRY(scene_.samplers, createSamplers(scene_.context, known_.samplers));
        store_.samplers.assign(known_.samplers.begin(), known_.samplers.end());
        if (store_.samplers.empty()) {
            store_.samplers.push_back({0, 0, 1, 1, 1, 1});
        }
        if (store_.editable) {
            scene_.samplerRoom =
                std::max(view_.samplerRoom, static_cast<std::uint32_t>(known_.samplers.size()));
            scene_.samplerRoom = std::max(scene_.samplerRoom, 1U);
        }
        return okStatus();
    }

    // A sealed scene has at least one texture, and others a white one for places without, so that the array
    // is never empty.
    Status addTextures() {
        const auto count = static_cast<std::uint32_t>(known_.textures.size());
        if (store_.editable) {
            scene_.textureRoom = std::max({view_.textureRoom, count, 1U});
        }
        GLINT_TRY_DO(checkTextureCount(scene_.context, std::max(scene_.textureRoom, count)));
        for (const package::TextureEntry& entry : known_.textures) {
            const ImageView& image = view_.images[entry.image];
            const bool srgb = entry.srgb != 0;
            const auto number = static_cast<std::uint32_t>(scene_.textures.size());
            GLINT_TRY(auto made, uploadSceneTexture(scene_, *store_.uploader, number, image, srgb));
            scene_.textures.push_back(std::move(made));
            if (store_.editable) {
                store_.firstTextures.push_back(store_.textures.add(
                    {image.width, image.height, srgb, image.dimension, emissionTexels(image, srgb)}));
            }
        }
        store_.uploadedTextures = store_.firstTextures;
        if (store_.editable || scene_.textures.empty()) {
            GLINT_TRY(auto white, uploadTexture(scene_.context, scene_.pool, *store_.uploader,
                                                {1, 1, kWhiteTexel}, false));
            if (store_.editable) {
                store_.white = std::move(white);
            } else {
                scene_.textures.push_back(std::move(white));
            }
        }
        return okStatus();
    }

    Status addMaterials() {
        records_ = materialsWithSizes(scene_.context, known_, view_.images);
        GLINT_TRY(scene_.changing, replaceMaterials(view_.materials, known_.materials, records_));
        scene_.materialLayout = package_.scene(0).materials.part(0, 0);
        const std::size_t bytes = scene_.materialLayout.recordBytes;
        for (std::uint32_t i = 0; i < known_.materials.size(); ++i) {
            store_.materials.writeBytes(i, std::span(records_).subspan(i * bytes, bytes));
            if (store_.editable) {
                StoredMaterial material;
                material.textures = usesOf(known_, store_.firstTextures, i);
                material.hasOwnValues = std::ranges::find(scene_.changing, i, &ChangingMaterial::material) !=
                                        scene_.changing.end();
                for (const SceneEditor::TextureUse& use : material.textures) {
                    countUse(store_.textures.find(use.texture)->materials, i, true);
                }
                store_.firstMaterials.push_back(store_.materialSlots.add(std::move(material)));
            }
        }
        return okStatus();
    }

    // Decides alpha tests of what is sealed, and the order of triangles.
    Status settleTriangles() {
        if (!store_.editable || view_.sealed) {
            const Clock::time_point begin = Clock::now();
            // The indices of micromaps are in the order of the triangles, which an order of leaves would
            // change.
            const bool hasMicromaps = store_.leafOrder == nullptr && !store_.editable;
            const std::uint32_t level = hasMicromaps ? micromapLevel(scene_.context) : 0;
            decided_ =
                decideTriangles(package_, known_, view_, records_, blasCapacity(scene_.context), level);
            scene_.statistics.opacityMs = millisecondsSince(begin);
            scene_.statistics.maskedTriangles = decided_.tested;
            scene_.statistics.provedOpaque = decided_.opaque;
            scene_.statistics.provedTransparent = decided_.transparent;
            GLINT_TRY_DO(addMicromapsOf());
        }
        ordered_ = std::move(decided_.sorted);
        if (store_.leafOrder != nullptr) {
            const Clock::time_point begin = Clock::now();
            ordered_ =
                orderedTriangles(primitives_, store_.capacity, store_.leafOrder, ordered_, decided_.splits);
            scene_.statistics.orderMs = millisecondsSince(begin);
        }
        return okStatus();
    }

    Status addMicromapsOf() {
        if (decided_.micromaps.empty()) {
            return okStatus();
        }
        std::vector<opacity::MicromapArray> arrays;
        for (const auto& [primitive, array] : decided_.micromaps) {
            arrays.push_back(array);
        }
        GLINT_TRY(auto made, addMicromaps(*store_.upload, scene_.pool, arrays));
        std::size_t next = 0;
        for (const auto& [primitive, array] : decided_.micromaps) {
            scene_.statistics.micromapBytes += made[next].bytes;
            scene_.micromaps.emplace(primitive, std::move(made[next++]));
        }
        scene_.statistics.micromaps = static_cast<std::uint32_t>(scene_.micromaps.size());
        return okStatus();
    }

    // Returns whether an instance has the mesh's own shape, or none has the mesh. The instances of a scene
    // that begins sealed get other BLASes.
    bool isShared(std::uint32_t mesh, std::span<const PrimitiveView> own) const {
        if (store_.editable) {
            return !view_.sealed;
        }
        const bool hasJoints =
            std::ranges::any_of(own, [](const auto& view) { return !view.joints.empty(); });
        const bool hasTargets =
            std::ranges::any_of(own, [](const auto& view) { return !view.targets.empty(); });
        bool isUsed = false;
        for (const InstanceView& instance : view_.instances) {
            if (instance.mesh == mesh) {
                isUsed = true;
                const bool deforms =
                    (hasJoints && !instance.joints.empty()) || (hasTargets && !instance.morphWeights.empty());
                if (!deforms) {
                    return true;
                }
            }
        }
        return !isUsed;
    }

    MeshContent contentOf(std::uint32_t first, std::uint32_t end) const {
        MeshContent content;
        const std::size_t count = end - first;
        content.primitives = view_.primitives.subspan(first, count);
        content.positions = std::span(positions_).subspan(first, count);
        if (!ordered_.empty()) {
            content.ordered = std::span(ordered_).subspan(first, count);
        }
        content.isShared = isShared(content.primitives.front().mesh, content.primitives);
        for (std::uint32_t i = first; i < end; ++i) {
            const auto split = decided_.splits.find(i);
            content.splits.push_back(split == decided_.splits.end() ? std::nullopt
                                                                    : std::optional(split->second));
            if (store_.editable) {
                continue;
            }
            const PrimitiveView& view = view_.primitives[i];
            content.entries.push_back(known_.findPrimitive(view.mesh, view.primitive));
            const auto micromap = scene_.micromaps.find(i);
            content.micromaps.push_back(micromap == scene_.micromaps.end() ? nullptr : &micromap->second);
        }
        return content;
    }

    // The key of a primitive of the package becomes a key of its material.
    void addMaterialTo(MeshHandle mesh, StoredPrimitive& primitive, const package::PrimitiveEntry& entry) {
        primitive.material = store_.firstMaterials[entry.materialIndex];
        StoredMaterial& material = *store_.materialSlots.find(primitive.material);
        ++material.meshes[mesh.index];
        addKey(material, entry, primitive.attributes);
        if (primitive.split) {
            primitive.splitMaterial = primitive.material;
            store_.decidedMaterials.insert(primitive.material.index);
        }
    }

    Status addMeshes() {
        for (std::uint32_t first = 0; first < view_.primitives.size();) {
            const std::uint32_t number = view_.primitives[first].mesh;
            const std::uint32_t end = primitivesOf(view_.primitives, number).end;
            GLINT_TRY(const auto handle, addMesh(store_, package_, contentOf(first, end)));
            store_.firstMeshes[number] = handle;
            StoredMesh& mesh = *store_.meshes.find(handle);
            for (std::uint32_t i = first; i < end; ++i) {
                const package::PrimitiveEntry* const entry =
                    known_.findPrimitive(number, view_.primitives[i].primitive);
                StoredPrimitive& primitive = mesh.primitives[i - first];
                primitive.entryIndex = static_cast<std::uint32_t>(entry - known_.primitives.data());
                if (store_.editable) {
                    store_.firstAttributes.emplace_back(primitive.entryIndex, primitive.attributes);
                    addMaterialTo(handle, primitive, *entry);
                }
            }
            first = end;
        }
        return okStatus();
    }

    // A mesh without primitives is empty.
    Result<MeshHandle> meshOf(std::uint32_t number) {
        auto known = store_.firstMeshes.find(number);
        if (known == store_.firstMeshes.end()) {
            known = store_.firstMeshes.emplace(number, store_.meshes.add({})).first;
        }
        return known->second;
    }

    Status addInstances() {
        for (const InstanceView& view : view_.instances) {
            StoredInstance instance;
            GLINT_TRY(instance.mesh, meshOf(view.mesh));
            instance.objectToWorld = view.objectToWorld;
            instance.visible = view.visible;
            GLINT_TRY(const auto handle, placeInstance(store_, &package_, std::move(instance), view));
            store_.firstInstances.push_back(handle);
            if (view_.sealed) {
                sealInstance(store_, handle);
            }
            store_.posedShape.instances.push_back({view.mesh, view.joints.size(), view.morphWeights.size()});
            store_.lastRows.push_back(view.objectToWorld);
            store_.lastVisible.push_back(view.visible);
            if (store_.geometryRuns.end() > kMostGeometries) {
                return tooManyGeometries(placeOf("instance", handle.index));
            }
        }
        addDecided();
        return store_.geometryRuns.end() > kMostGeometries ? Status(tooManyGeometries("")) : okStatus();
    }

    // Places the parts of decided triangles, after all others. Those of a scene that is edited come with
    // seals.
    void addDecided() {
        if (store_.editable) {
            return;
        }
        for (const InstanceHandle handle : store_.firstInstances) {
            StoredInstance& instance = store_.instanceSlots.at(handle.index);
            const std::uint32_t count = store_.meshes.find(instance.mesh)->decidedCount;
            if (count > 0 && instance.geometryCount > 0) {
                instance.firstDecided = store_.geometryRuns.allocate(count);
                scene_.statistics.geometries += count;
                writeGeometries(store_, handle, instance);
            }
        }
    }

    // Takes what a sealed scene keeps of its package.
    void seal() {
        for (std::uint32_t i = 0; i < store_.geometries.count(); ++i) {
            scene_.shaderIds.push_back(store_.geometries.read<gpu::GeometryRecord>(i).shaderId);
        }
        for (const auto& [primitive, split] : decided_.splits) {
            const PrimitiveView& view = view_.primitives[primitive];
            const package::PrimitiveEntry* const entry = known_.findPrimitive(view.mesh, view.primitive);
            scene_.package.decided.push_back(
                {static_cast<std::uint32_t>(entry - known_.primitives.data()),
                 alphaInputs(*package_.opacity(), tableWith(known_.materials, records_), *entry)});
        }
        store_.texelsOf = [this](std::uint32_t texture) {
            std::shared_ptr<const EmissionTexels>& texels = texels_[texture];
            if (texels == nullptr) {
                const package::TextureEntry& entry = known_.textures[texture];
                texels = std::make_shared<EmissionTexels>(view_.images[entry.image], entry.srgb != 0);
            }
            return texels;
        };
    }

    void finish() {
        for (RecordArray* const records :
             {&store_.geometries, &store_.instances, &store_.materials, &store_.lights, &store_.lightNodes,
              &store_.emitterRecords, &store_.firstEmitters, &store_.poses, &store_.deforms,
              &store_.topLevel.records()}) {
            records->firstCapacity = records->capacity;
        }
        store_.firstTlasCapacity = store_.tlasCapacity;
        store_.texelsOf = nullptr;
        if (!store_.keeps()) {
            store_.emitters = {};
            store_.lightTree.nodes = {};
            store_.emitterMeans = {};
            store_.meshes.forEach([&](MeshHandle /*handle*/, StoredMesh& mesh) {
                for (StoredPrimitive& primitive : mesh.primitives) {
                    store_.upload->keep(std::move(primitive.source.buffer));
                    primitive.shape.reset();
                }
            });
        }
        store_.ownUploader = std::make_unique<Uploader>(scene_.context, scene_.brief);
        store_.uploader = store_.ownUploader.get();
        store_.upload = nullptr;
    }

    SceneStore& store_;
    GpuScene::State& scene_;
    const Package& package_;
    const PackageScene& known_;
    std::vector<GridPositions> positions_;
    std::vector<PrimitiveView> primitives_;
    SceneView view_;
    std::vector<std::uint8_t> records_;  // of materials
    DecidedTriangles decided_;
    std::vector<std::vector<std::uint32_t>> ordered_;
    std::map<std::uint32_t, std::shared_ptr<const EmissionTexels>> texels_;  // by texture
};

}  // namespace

Status uploadScene(GpuScene::State& state, const Package& package, const PackageScene& known,
                   const SceneView& view, SceneUpload& upload, VkCommandBuffer commands) {
    state.store = std::make_unique<SceneStore>(state, package, view);
    state.store->upload = &upload;
    state.store->uploader = upload.uploader.get();
    return SceneUploader(*state.store, package, known, view).upload(commands);
}

}  // namespace glint
