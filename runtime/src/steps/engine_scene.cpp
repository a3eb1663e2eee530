#include "steps/engine_scene.h"

#include "context/commands.h"
#include "context/upload.h"
#include "data/instance_math.h"
#include "data/scene_checks.h"
#include "interop/frame.h"
#include "package/package.h"
#include "scene/gpu_scene_state.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

namespace glint {
namespace {

static_assert(static_cast<std::uint32_t>(EngineScene::View::RecordsBy::CustomIndexTable) ==
              gpu::kRecordsByCustomIndexTable);
static_assert(static_cast<std::uint32_t>(EngineScene::View::RecordsBy::InstanceTable) ==
              gpu::kRecordsByInstanceTable);

std::string geometryPlace(std::size_t index) {
    return "geometry " + std::to_string(index);
}

Diagnostic outOfRange(const std::string& where, const std::string& what, std::size_t value,
                      std::size_t count) {
    return makeError("engine-scene", where, phrase(what, " ", value, " is out of range, there are ", count),
                     "give indices below the number of what they name");
}

struct NamedAddress {
    const char* name;
    decltype(gpu::GeometryRecord::indices) gpu::GeometryRecord::*address;
    package::Role role;  // of the feature whose keys need it; None: all do
};
constexpr NamedAddress kAddresses[] = {
    {"indices", &gpu::GeometryRecord::indices, package::Role::None},
    {"positions", &gpu::GeometryRecord::positions, package::Role::None},
    {"normals", &gpu::GeometryRecord::normals, package::Role::Normals},
    {"tangents", &gpu::GeometryRecord::tangents, package::Role::Tangents},
    {"texCoords0", &gpu::GeometryRecord::texCoords0, package::Role::TexCoord0},
    {"texCoords1", &gpu::GeometryRecord::texCoords1, package::Role::TexCoord1},
    {"colors", &gpu::GeometryRecord::colors, package::Role::VertexColor}};

// Finds the entry of a geometry, and checks that its record has the addresses that the key reads.
Result<const package::PrimitiveEntry*> entryOf(const Package& package, const PackageScene& known,
                                               std::size_t index,
                                               const EngineScene::State::Primitive& primitive,
                                               const gpu::GeometryRecord& record) {
    const package::PrimitiveEntry* const entry = known.findPrimitive(primitive.mesh, primitive.primitive);
    if (entry == nullptr) {
        return makeError(
            "scene-package", geometryPlace(index),
            phrase("the package does not know primitive ", primitive.primitive, " of mesh ", primitive.mesh),
            "compile the package from the scene that is traced");
    }
    for (const NamedAddress& one : kAddresses) {
        const bool needed =
            one.role == package::Role::None || package.state().hasFeature(entry->key, one.role);
        if (needed && record.*one.address == 0) {
            return makeError("engine-scene", geometryPlace(index),
                             std::string("the package's key reads ") + one.name + ", whose address is 0",
                             "give its address");
        }
    }
    return entry;
}

// The corners of triangles that may be lights. Geometries that name the same corners share them.
class Shapes {
public:
    Result<std::shared_ptr<const EmitterShape>> find(const EngineScene::View::Geometry& view,
                                                     const std::string& where) {
        const std::span<const std::array<float, 3>> corners = view.lightCorners;
        if (corners.empty()) {
            return std::shared_ptr<const EmitterShape>();
        }
        if (view.primitiveMaterials != 0) {
            return makeError("engine-scene", where,
                             "it has lightCorners, and a list of materials on the device, which says how "
                             "bright its triangles are",
                             "leave out lightCorners, or give it one material");
        }
        std::shared_ptr<const EmitterShape>& known = known_[{corners.data(), corners.size()}];
        if (known == nullptr) {
            if (corners.size() % 3 != 0 ||
                !std::ranges::all_of(corners, [](const auto& corner) { return isFinite(corner); })) {
                return makeError("engine-scene", where,
                                 "its lightCorners are not three for each triangle, or not finite",
                                 "give the three corners of each triangle");
            }
            PrimitiveView triangles;
            triangles.positions = corners;
            std::vector<std::uint32_t> indices(corners.size());
            std::iota(indices.begin(), indices.end(), 0U);
            known = std::make_shared<const EmitterShape>(triangles, indices, false);
        }
        return known;
    }

private:
    std::map<std::pair<const void*, std::size_t>, std::shared_ptr<const EmitterShape>> known_;
};

// Returns null if the host has not given any.
Result<TexelMeans> texelMeans(std::span<const float> given, std::size_t triangles, const std::string& where) {
    if (given.empty()) {
        return TexelMeans();
    }
    const bool isRange =
        std::ranges::all_of(given, [](float mean) { return std::isfinite(mean) && mean >= 0.0F; });
    if ((given.size() != triangles && given.size() != 1) || !isRange) {
        return makeError("engine-scene", where,
                         "its lightTexels are not one for each triangle of lightCorners, or one for all, or "
                         "are negative or not finite",
                         "give the means of its texels, or leave them out");
    }
    std::vector<float> means(given.begin(), given.end());
    means.resize(triangles, means.front());
    return TexelMeans(std::make_shared<const std::vector<float>>(std::move(means)));
}

// The records of geometries, without what their entries say, and the lists that those name whose triangles
// have materials of their own.
struct Geometries {
    std::vector<gpu::GeometryRecord> records;
    std::vector<gpu::PrimitiveMaterials> primitiveMaterials;
    std::vector<EngineScene::State::Primitive> primitives;
};

Result<Geometries> makeGeometries(const EngineScene::View& scene) {
    Geometries made;
    Shapes shapes;
    for (std::size_t i = 0; i < scene.geometries.size(); ++i) {
        const EngineScene::View::Geometry& view = scene.geometries[i];
        if (view.instance >= scene.instances.size()) {
            return outOfRange(geometryPlace(i), "instance", view.instance, scene.instances.size());
        }
        GLINT_TRY(auto shape, shapes.find(view, geometryPlace(i)));
        GLINT_TRY(auto texels, texelMeans(view.lightTexels, view.lightCorners.size() / 3, geometryPlace(i)));
        made.primitives.push_back({view.mesh, view.primitive, view.material, view.primitiveMaterials != 0,
                                   std::move(shape), std::move(texels)});
        gpu::GeometryRecord& record = made.records.emplace_back(recordOf({}, view, view.instance));
        record.flags = std::uint32_t{view.hostFlags} << gpu::kGeometryHostFlagsShift;
        if (view.primitiveMaterials != 0) {
            made.primitiveMaterials.push_back({view.primitiveMaterials});
            record.primitiveMaterials = static_cast<std::uint32_t>(made.primitiveMaterials.size());
        }
    }
    return made;
}

Result<std::vector<gpu::InstanceRecord>> makeInstances(std::span<const Rows> instances) {
    std::vector<gpu::InstanceRecord> records;
    for (std::size_t i = 0; i < instances.size(); ++i) {
        if (!isFinite(instances[i])) {
            return makeError("engine-scene", "instance " + std::to_string(i), "its transform is not finite",
                             "give twelve finite numbers");
        }
        records.push_back(makeInstanceRecord(instances[i]));
    }
    return records;
}

// Returns transforms relative to an origin that has moved.
std::vector<Rows> movedBack(std::vector<Rows> instances, const std::array<double, 3>& originMoved) {
    for (Rows& rows : instances) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            rows[4 * axis + 3] = static_cast<float>(rows[4 * axis + 3] - originMoved[axis]);
        }
    }
    return instances;
}

// The package's materials, with the host's numbers of textures and samplers.
Result<std::vector<std::uint8_t>> makeMaterials(const Context::State& context, const PackageScene& known,
                                                std::span<const EngineScene::View::Texture> textures,
                                                std::span<const EngineScene::View::Sampler> samplers) {
    if (textures.size() != known.textures.size() || samplers.size() != known.samplers.size()) {
        return makeError("engine-scene", "",
                         phrase("there are ", textures.size(), " textures and ", samplers.size(),
                                " samplers, the package's scene has ", known.textures.size(), " and ",
                                known.samplers.size()),
                         "give one for each of PackageScene::textures and PackageScene::samplers");
    }
    std::vector<ImageView> images;
    for (std::size_t i = 0; i < known.textures.size(); ++i) {
        const EngineScene::View::Texture& texture = textures[i];
        if (texture.width == 0 || texture.height == 0) {
            return makeError("engine-scene", "texture " + std::to_string(i), "it has no texels",
                             "give the size of its finest level");
        }
        images.resize(std::max<std::size_t>(images.size(), known.textures[i].image + std::size_t{1}));
        images[known.textures[i].image].width = texture.width;
        images[known.textures[i].image].height = texture.height;
    }
    std::vector<std::uint8_t> bytes = materialsWithSizes(context, known, images);
    for (std::size_t i = 0; i < known.materials.size(); ++i) {
        for (std::uint32_t slot = 0; slot < known.materials.textureCount; ++slot) {
            gpu::TextureRecord record = textureAt(tableWith(known.materials, bytes), i, slot);
            if (record.textureIndex < textures.size()) {
                record.textureIndex = textures[record.textureIndex].index;
            }
            if (record.samplerIndex < samplers.size()) {
                record.anisotropy = samplers[record.samplerIndex].maxAnisotropy;
                record.samplerIndex = samplers[record.samplerIndex].index;
            }
            std::memcpy(&bytes[placeOfTexture(known.materials, i, slot)], &record, sizeof record);
        }
    }
    return bytes;
}

using Host = EngineScene::State::Host;
using OwnMaterial = EngineScene::State::OwnMaterial;

std::string materialPlace(std::size_t number) {
    return "material " + std::to_string(number);
}

// Gives a record the host's own textures, where the record of the package's material has any. Such a record
// holds zero in the place of others.
Status takeTextures(const MaterialTable& given, const MaterialTable& ofPackage, std::size_t number,
                    std::span<std::uint8_t> record) {
    for (std::uint32_t slot = 0; slot < given.textureCount; ++slot) {
        const gpu::TextureRecord known = textureAt(ofPackage, 0, slot);
        const auto isZero = [](const gpu::vec3& row) {
            return row.x == 0.0F && row.y == 0.0F && row.z == 0.0F;
        };
        if (isZero(known.rowU) && isZero(known.rowV)) {
            continue;
        }
        gpu::TextureRecord texture = textureAt(given, 0, slot);
        if (!(texture.texels.x >= 1.0F && texture.texels.y >= 1.0F)) {
            return makeError("scene-material", materialPlace(number),
                             phrase("texture ", slot, " of the record has no texels"),
                             "give the size of its finest level in TextureRecord::texels");
        }
        texture.anisotropy = std::max(texture.anisotropy, 1.0F);
        std::memcpy(&record[placeOfTexture(given, 0, slot)], &texture, sizeof texture);
    }
    return okStatus();
}

// Returns the record of a material of the host's own. `ofPackage` has those of the package's materials, with
// the host's numbers of textures and samplers.
Result<std::vector<std::uint8_t>> makeOwnRecord(const Host& host, std::span<const std::uint8_t> ofPackage,
                                                std::size_t number, const OwnMaterial& own) {
    const std::size_t size = host.layout.recordBytes;
    std::vector<std::uint8_t> record(size);
    if (own.record.empty()) {
        return record;
    }
    if (own.material >= host.ofPackage || own.record.size() != size) {
        return makeError("scene-material", materialPlace(number),
                         own.record.size() != size
                             ? "the record has another size than the package's"
                             : "the package has no material " + std::to_string(own.material),
                         "give records of the package's materials, in its layout");
    }
    const std::span<const std::uint8_t> known = ofPackage.subspan(own.material * size, size);
    std::ranges::copy(known, record.begin());
    takeValues(own.record, host.layout, record);
    if (own.ownTextures) {
        if (host.trustsTextures) {
            return makeError(
                "texture-trusted", materialPlace(number),
                "it has textures of its own, and the package's shaders rely on those of the scene",
                "compile it with --no-trust-textures");
        }
        GLINT_TRY_DO(
            takeTextures(tableWith(host.layout, own.record), tableWith(host.layout, known), number, record));
    }
    return record;
}

// Appends the records of the host's own materials.
Status appendOwn(const Host& host, std::vector<std::uint8_t>& bytes) {
    const std::size_t ofPackage = bytes.size();
    bytes.reserve(ofPackage + host.materials.size() * host.layout.recordBytes);
    for (std::size_t i = 0; i < host.materials.size(); ++i) {
        GLINT_TRY(const auto record,
                  makeOwnRecord(host, std::span(bytes).first(ofPackage), i, host.materials[i]));
        bytes.insert(bytes.end(), record.begin(), record.end());
    }
    return okStatus();
}

// Gives a geometry the materials that the host has named for it.
Status takeMaterial(const Host& host, std::size_t index, gpu::GeometryRecord& geometry) {
    const EngineScene::State::Primitive& primitive = host.primitives[index];
    if (primitive.ownMaterials) {
        geometry.materialIndex = host.ofPackage;
        return okStatus();
    }
    if (primitive.material == EngineScene::View::Geometry::kOfPackage) {
        return okStatus();
    }
    if (primitive.material >= host.materials.size() || host.materials[primitive.material].record.empty()) {
        return outOfRange(geometryPlace(index), "material", primitive.material, host.materials.size());
    }
    const std::uint32_t material = host.materials[primitive.material].material;
    if (material != geometry.materialIndex) {
        return makeError("engine-scene", geometryPlace(index),
                         phrase("its values are of material ", material, ", and the primitive has material ",
                                geometry.materialIndex),
                         "name values of the primitive's material");
    }
    geometry.materialIndex = host.ofPackage + primitive.material;
    return okStatus();
}

Result<std::vector<std::uint32_t>> findShaderIds(std::span<const gpu::GeometryRecord> geometries,
                                                 std::span<const std::uint32_t> hitRecords) {
    std::vector<std::uint32_t> shaderIds;
    for (std::size_t i = 0; hitRecords.empty() && i < geometries.size(); ++i) {
        shaderIds.push_back(geometries[i].shaderId);
    }
    for (std::size_t i = 0; i < hitRecords.size(); ++i) {
        if (hitRecords[i] >= geometries.size()) {
            return outOfRange("hit record " + std::to_string(i), "geometry", hitRecords[i],
                              geometries.size());
        }
        shaderIds.push_back(geometries[hitRecords[i]].shaderId);
    }
    return shaderIds;
}

// The content of a scene by a package.
struct PackageContent {
    Host host;
    std::vector<gpu::GeometryRecord> geometries;
    std::vector<std::uint8_t> materials;
    std::vector<std::uint32_t> shaderIds;
    std::uint64_t records = 0;  // recordsHash()
};

// Gives geometries what a package says of their primitives, and makes the other records.
Result<PackageContent> makeContent(const Context::State& context, const Package& package, std::uint32_t index,
                                   std::vector<gpu::GeometryRecord> geometries, Host host) {
    GLINT_TRY_DO(checkDevice(package, context.handles));
    const PackageScene known = package.scene(index);
    for (std::size_t i = 0; i < geometries.size(); ++i) {
        GLINT_TRY(const auto entry, entryOf(package, known, i, host.primitives[i], geometries[i]));
        takeEntry(*entry, geometries[i]);
        GLINT_TRY_DO(takeMaterial(host, i, geometries[i]));
    }
    PackageContent content;
    GLINT_TRY(content.materials, makeMaterials(context, known, host.textures, host.samplers));
    GLINT_TRY_DO(appendOwn(host, content.materials));
    GLINT_TRY(content.shaderIds, findShaderIds(geometries, host.hitRecords));
    content.host = std::move(host);
    content.geometries = std::move(geometries);
    content.records = recordsHash(package, known);
    return content;
}

// Notes the layout of a package's records.
void takeLayout(const Package& package, const PackageScene& known, Host& host) {
    host.fields = recordFields(package, known);
    host.layout = tableWith(known.materials, {});
    host.trustsTextures = package.trustTextures();
    host.ofPackage = static_cast<std::uint32_t>(known.materials.size());
    host.emission = package.emission() != nullptr ? std::optional(*package.emission()) : std::nullopt;
    host.knowsDisks = package.diskLights();
}

// Carries the host's values into records of a package. What these have beside is that of `records`, the
// package's records with the host's numbers of textures and samplers.
Status carryValues(const Package& package, const PackageScene& known, std::span<const std::uint8_t> records,
                   Host& host) {
    const RecordFields before = std::move(host.fields);
    takeLayout(package, known, host);
    for (OwnMaterial& one : host.materials) {
        if (one.record.empty()) {
            continue;
        }
        if (one.material >= host.ofPackage) {
            return makeError("scene-package", materialPlace(one.material),
                             "the host has given values of this material, which the package lacks",
                             "compile the package with the same materials");
        }
        const std::span<const std::uint8_t> own = tableWith(host.layout, records).part(one.material, 1).bytes;
        const std::vector<std::uint8_t> given = std::exchange(one.record, {own.begin(), own.end()});
        carryFields(before, before.modelOf(one.material), given, host.fields,
                    host.fields.modelOf(one.material), one.record);
    }
    return okStatus();
}

// The content by a package of what the host has given before.
Result<PackageContent> contentBy(const EngineScene::State& state, const Package& package,
                                 std::uint32_t index) {
    GLINT_TRY_DO(checkDisks(package.diskLights(), state.lightViews));
    const RecordStore& geometries = state.geometries;
    std::vector<gpu::GeometryRecord> records;
    for (std::uint32_t i = 0; i < geometries.count(); ++i) {
        records.push_back(geometries.read<gpu::GeometryRecord>(i));
    }
    Host host = state.host;
    const PackageScene known = package.scene(index);
    GLINT_TRY(const auto rows, makeMaterials(state.context, known, host.textures, host.samplers));
    GLINT_TRY_DO(carryValues(package, known, rows, host));
    return makeContent(state.context, package, index, std::move(records), std::move(host));
}

void take(EngineScene::State& state, const PackageContent& content) {
    RecordStore& materials = state.materials;
    if (content.host.layout.recordBytes != materials.stride()) {
        materials.reset(content.host.layout.recordBytes);
    }
    materials.replaceBytes(content.materials);
    state.geometries.replace(content.geometries);
    state.host = content.host;
    state.records = content.records;
    state.shaderIds = content.shaderIds;
}

// Lists the triangles that are lights: those whose corners the host has given, if their material emits light.
void gatherEmitters(EngineScene::State& state) {
    const RecordStore& geometries = state.geometries;
    std::vector<EmitterPart> parts;
    std::vector<std::uint32_t> firsts;
    state.emitters = {};
    if (state.host.emission) {
        for (std::uint32_t i = 0; i < geometries.count(); ++i) {
            const auto record = geometries.read<gpu::GeometryRecord>(i);
            const auto& shape = state.host.primitives[i].shape;
            if (shape == nullptr || (record.flags & gpu::kGeometryEmitter) == 0) {
                continue;
            }
            EmitterPart& part = parts.emplace_back();
            part.geometry = part.primitive = i;
            part.instance = record.instanceIndex;
            part.material = record.materialIndex;
            part.count = static_cast<std::uint32_t>(shape->indices.size() / 3);
            part.twoSided = (record.flags & gpu::kGeometryDoubleSided) != 0;
            part.luminance = emittedLuminance(state.materials.at(record.materialIndex), *state.host.emission);
            part.shape = shape;
            part.texels = state.host.primitives[i].texels;
        }
        state.emitters = Emitters(*state.host.emission, std::move(parts));
        firsts = state.emitters.firstsOf(geometries.count());
    }
    state.firstEmitters.replace(firsts);
}

InstancePoses posesOf(const EngineScene::State& state) {
    return [&state](std::uint32_t instance) {
        InstanceView pose;
        pose.objectToWorld = state.placed[instance];
        return pose;
    };
}

// Brings triangles and lights to another content.
void rebuildLights(EngineScene::State& state) {
    gatherEmitters(state);
    state.buildLights(posesOf(state), true);
}

// The instances and lights that differ from those that were placed. Both have as many lights.
LightMoves movesTo(const EngineScene::State& state, std::span<const Rows> instances,
                   std::span<const LightView> lights) {
    LightMoves moves;
    const std::size_t count =
        state.emitters.records.empty() ? 0 : std::min(instances.size(), state.placed.size());
    for (std::uint32_t i = 0; i < count; ++i) {
        if (instances[i] != state.placed[i]) {
            moves.instances.push_back(i);
        }
    }
    for (std::uint32_t i = 0; i < lights.size(); ++i) {
        const gpu::LightRecord record = makeLightRecord(lights[i]);
        if (!std::ranges::equal(std::as_bytes(std::span(&record, 1)), std::as_bytes(state.lights.at(i)))) {
            moves.lights.push_back(i);
        }
    }
    return moves;
}

// Places the instances and lights. Motion is measured from the transforms before; new instances are still.
Status place(EngineScene::State& state, std::span<const Rows> instances, std::span<const LightView> lights,
             bool knowsDisks, const std::array<double, 3>& originMoved) {
    GLINT_TRY(auto records, makeInstances(instances));
    GLINT_TRY_DO(checkLights(lights));
    GLINT_TRY_DO(checkDisks(knowsDisks, lights));
    std::vector<Rows> before = movedBack(state.placed, originMoved);
    before.resize(std::min(before.size(), instances.size()));
    before.insert(before.end(), instances.begin() + static_cast<std::ptrdiff_t>(before.size()),
                  instances.end());
    GLINT_TRY(auto previous, makeInstances(before));
    state.instances.replace(records);
    state.previousInstances.replace(previous);
    state.lights.replace(makeLightRecords(lights));
    state.placed.assign(instances.begin(), instances.end());
    state.lightViews.assign(lights.begin(), lights.end());
    return okStatus();
}

Status checkOwn(const EngineScene::State& state, std::uint64_t frame) {
    if (state.shared != nullptr) {
        return makeError("engine-scene", "", "the scene is that of a GpuScene", "use GpuScene::update()");
    }
    if (frame < state.lastFrame) {
        return makeError("engine-scene", "",
                         phrase("frame ", frame, " is recorded after frame ", state.lastFrame),
                         "number frames in the order in which they are recorded");
    }
    return okStatus();
}

OwnMaterial keptMaterial(const EngineScene::View::Material& view) {
    return {view.material, {view.record.begin(), view.record.end()}, view.ownTextures};
}

Status recordContent(EngineScene::State& state, VkCommandBuffer commands, const Package& package,
                     const EngineScene::View& scene, std::uint64_t frame,
                     const std::array<double, 3>& originMoved) {
    if (scene.packageScene >= package.sceneCount()) {
        return makeError("scene-package", "",
                         "the package has no scene " + std::to_string(scene.packageScene),
                         "give an index below Package::sceneCount()");
    }
    Host host;
    host.textures.assign(scene.textures.begin(), scene.textures.end());
    host.samplers.assign(scene.samplers.begin(), scene.samplers.end());
    host.hitRecords.assign(scene.hitRecords.begin(), scene.hitRecords.end());
    takeLayout(package, package.scene(scene.packageScene), host);
    std::uint32_t leastInstances = 0;
    for (const EngineScene::View::Geometry& view : scene.geometries) {
        leastInstances = std::max(leastInstances, view.instance + 1);
    }
    for (const EngineScene::View::Material& view : scene.materials) {
        host.materials.push_back(keptMaterial(view));
    }
    GLINT_TRY(auto geometries, makeGeometries(scene));
    host.primitives = std::move(geometries.primitives);
    GLINT_TRY(const auto content, makeContent(state.context, package, scene.packageScene,
                                              std::move(geometries.records), std::move(host)));
    for (std::size_t i = 0; i < scene.firstRecords.size(); ++i) {
        if (scene.firstRecords[i] >= std::max<std::size_t>(content.geometries.size(), 1)) {
            return outOfRange(phrase("entry ", i, " of firstRecords"), "geometry", scene.firstRecords[i],
                              content.geometries.size());
        }
    }
    GLINT_TRY_DO(place(state, scene.instances, scene.lights, content.host.knowsDisks, originMoved));
    state.shaderIdsVersion += state.shaderIds != content.shaderIds ? 1 : 0;
    take(state, content);
    state.firstRecords.replace(scene.firstRecords);
    state.primitiveMaterials.replace(geometries.primitiveMaterials);
    state.name = package.scene(scene.packageScene).name;
    state.leastInstances = leastInstances;
    state.recordsBy = scene.recordsBy;
    rebuildLights(state);
    return state.recordChanges(commands, frame);
}

// Brings lights to the brightness of a material whose record has changed.
void brightenLights(EngineScene::State& state, std::uint32_t index) {
    const RecordStore& materials = state.materials;
    if (index >= materials.count()) {
        return;
    }
    const std::span<const std::uint8_t> record = materials.at(index);
    LightMoves moves;
    moves.instances = state.emitters.takeMaterial({index, {record.begin(), record.end()}});
    if (!moves.isEmpty()) {
        state.refitLights(moves, posesOf(state));
    }
}

// Error "engine-scene": a geometry names the material.
Status checkUnnamed(const Host& host, std::uint32_t number) {
    for (std::size_t i = 0; i < host.primitives.size(); ++i) {
        if (!host.primitives[i].ownMaterials && host.primitives[i].material == number) {
            return makeError("engine-scene", materialPlace(number),
                             geometryPlace(i) +
                                 " names it, and it would be of another material of the package, "
                                 "or of none",
                             "give the geometry another material first");
        }
    }
    return okStatus();
}

// Writes the material of a number, and gives numbers between an empty record.
Status setMaterial(EngineScene::State& state, std::uint32_t number, OwnMaterial own) {
    Host& host = state.host;
    RecordStore& rows = state.materials;
    const bool isKnown = number < host.materials.size() && !host.materials[number].record.empty();
    if (isKnown && (own.record.empty() || own.material != host.materials[number].material)) {
        GLINT_TRY_DO(checkUnnamed(host, number));
    }
    GLINT_TRY(const auto record,
              makeOwnRecord(
                  host, host.ofPackage > 0 ? rows.at({0, host.ofPackage}) : std::span<const std::uint8_t>(),
                  number, own));
    if (own.record.empty() && number >= host.materials.size()) {
        return okStatus();
    }
    for (auto next = static_cast<std::uint32_t>(host.materials.size()); next < number; ++next) {
        rows.writeBytes(host.ofPackage + next, std::vector<std::uint8_t>(record.size()));
    }
    host.materials.resize(std::max<std::size_t>(host.materials.size(), number + std::size_t{1}));
    host.materials[number] = std::move(own);
    rows.writeBytes(host.ofPackage + number, record);
    while (!host.materials.empty() && host.materials.back().record.empty()) {
        host.materials.pop_back();
    }
    rows.shrink(host.ofPackage + static_cast<std::uint32_t>(host.materials.size()));
    return okStatus();
}

}  // namespace

EngineScene::State::State(Context::State& contextState)
    : DrawnScene(contextState),
      SceneRecords(sizeof(std::uint32_t)),
      pool(contextState, "engine scene"),
      brief(contextState, "engine scene", MemoryPool::Use::EachFrame) {}

Status EngineScene::State::recordChanges(VkCommandBuffer commands, std::uint64_t frame,
                                         RetiredLot* leftovers) {
    std::vector<ArrayTarget> now;
    for (RecordArray* const array : arrays) {
        now.push_back({*array, grownCapacity(array->count(), array->capacity), &pool});
    }
    ArrayUpdate update(context, brief);
    GLINT_TRY_DO(update.prepareBuffers(now));
    GLINT_TRY_DO(update.prepareStaging(now));
    if (update.hasWork()) {
        recordDependency(context, commands, kAllToAll);
        update.recordResizes(commands, now, retired);
        retired.add(update.recordCopies(commands, now));
        recordDependency(context, commands, kAllToAll);
    }
    if (leftovers != nullptr) {
        *leftovers = retired.take();
    } else {
        retired.close(frame);
    }
    countLights();
    lastFrame = frame;
    return okStatus();
}

Result<PackageFit> EngineScene::State::fit(const std::shared_ptr<const Package>& package) const {
    const std::optional<std::uint32_t> index = package->findScene(name);
    if (!index) {
        return makeError("scene-package", name, "the package has no scene of this name",
                         "compile the package from the scene that is traced");
    }
    GLINT_TRY(auto content, contentBy(*this, *package, *index));
    return PackageFit{*index, content.records, std::move(content.shaderIds)};
}

Result<RetiredLot> EngineScene::State::recordReplacement(const std::shared_ptr<const Package>& package,
                                                         std::uint32_t index, VkCommandBuffer commands) {
    GLINT_TRY(const auto content, contentBy(*this, *package, index));
    const RecordStore materialsBefore = materials;
    const RecordStore geometriesBefore = geometries;
    const Host hostBefore = host;
    const std::uint64_t recordsBefore = records;
    const std::vector<std::uint32_t> idsBefore = shaderIds;
    take(*this, content);
    rebuildLights(*this);
    RetiredLot leftovers;
    if (Status status = recordChanges(commands, lastFrame, &leftovers); !status) {
        static_cast<RecordStore&>(materials) = materialsBefore;
        static_cast<RecordStore&>(geometries) = geometriesBefore;
        host = hostBefore;
        records = recordsBefore;
        shaderIds = idsBefore;
        rebuildLights(*this);
        return status.error();
    }
    return leftovers;
}

DrawnScene& EngineScene::State::drawn() {
    return shared != nullptr ? static_cast<DrawnScene&>(*shared) : *this;
}

Result<std::unique_ptr<EngineScene>> EngineScene::record(Context& context, const Package& package,
                                                         const EngineScene::View& scene,
                                                         VkCommandBuffer commands, std::uint64_t frame) try {
    auto state = std::make_unique<State>(context.state());
    GLINT_TRY_DO(recordContent(*state, commands, package, scene, frame, {}));
    return std::unique_ptr<EngineScene>(new EngineScene(std::move(state)));
}
GLINT_CATCH

Result<std::unique_ptr<EngineScene>> EngineScene::create(Context& context, const Package& package,
                                                         const EngineScene::View& scene) try {
    return makeOnce(context.state(),
                    [&](VkCommandBuffer commands) { return record(context, package, scene, commands, 0); });
}
GLINT_CATCH

void EngineScene::complete(std::uint64_t frame) {
    state_->retired.complete(frame);
}

Result<std::unique_ptr<EngineScene>> EngineScene::share(Context& context, GpuScene& scene) try {
    auto state = std::make_unique<State>(context.state());
    state->shared = &scene.state();
    return std::unique_ptr<EngineScene>(new EngineScene(std::move(state)));
}
GLINT_CATCH

void EngineScene::State::fill(gpu::FrameConstants& constants) const {
    if (shared != nullptr) {
        fillScene(*shared, constants);
        constants.previousInstances = constants.instances;
        return;
    }
    SceneRecords::fill(constants);
    constants.previousInstances = previousInstances.device.address;
    constants.firstRecords = firstRecords.device.address;
    constants.primitiveMaterials = primitiveMaterials.device.address;
    constants.recordsBy = static_cast<std::uint32_t>(recordsBy);
}

EngineScene::EngineScene(std::unique_ptr<State> state) : state_(std::move(state)) {}
EngineScene::~EngineScene() = default;

Status EngineScene::update(VkCommandBuffer commands, const Package& package, const EngineScene::View& scene,
                           std::uint64_t frame, const std::array<double, 3>& originMoved) try {
    GLINT_TRY_DO(checkOwn(*state_, frame));
    return recordContent(*state_, commands, package, scene, frame, originMoved);
}
GLINT_CATCH

Status EngineScene::update(VkCommandBuffer commands, std::span<const std::array<float, 12>> instances,
                           std::span<const LightView> lights, std::uint64_t frame,
                           const std::array<double, 3>& originMoved) try {
    GLINT_TRY_DO(checkOwn(*state_, frame));
    if (instances.size() < state_->leastInstances) {
        return outOfRange("", "instance", state_->leastInstances - 1, instances.size());
    }
    const bool refits =
        std::ranges::equal(state_->lightViews, lights, {}, &LightView::type, &LightView::type);
    const LightMoves moves = refits ? movesTo(*state_, instances, lights) : LightMoves{};
    GLINT_TRY_DO(place(*state_, instances, lights, state_->host.knowsDisks, originMoved));
    if (!refits) {
        state_->buildLights(posesOf(*state_), true);
    } else if (!moves.isEmpty()) {
        state_->refitLights(moves, posesOf(*state_));
    }
    return state_->recordChanges(commands, frame);
}
GLINT_CATCH

Status EngineScene::updateMaterial(VkCommandBuffer commands, std::uint32_t number,
                                   const EngineScene::View::Material& material, std::uint64_t frame) try {
    GLINT_TRY_DO(checkOwn(*state_, frame));
    GLINT_TRY_DO(setMaterial(*state_, number, keptMaterial(material)));
    brightenLights(*state_, state_->host.ofPackage + number);
    return state_->recordChanges(commands, frame);
}
GLINT_CATCH

VkDeviceAddress EngineScene::materials() const {
    gpu::FrameConstants constants{};
    state_->fill(constants);
    return constants.materials;
}

std::uint64_t EngineScene::bytes() const {
    std::uint64_t sum = 0;
    for (const RecordArray* const array : state_->arrays) {
        sum += array->device.bytes;
    }
    return sum;
}

EngineScene::State& EngineScene::state() {
    return *state_;
}

}  // namespace glint
