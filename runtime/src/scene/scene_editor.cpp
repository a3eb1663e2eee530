#include "scene/scene_editor.h"

#include "data/instance_math.h"
#include "data/scene_checks.h"
#include "interop/scene.h"

#include <algorithm>
#include <bit>
#include <optional>
#include <utility>

namespace glint {
namespace {

constexpr const char* kCompileAgain = "compile the package from a scene that has such a material";

// A geometry flag that shaders know only if a material of the package has it.
struct NamedFlag {
    std::uint32_t flag;
    const char* what;
};
constexpr NamedFlag kNamedFlags[] = {{gpu::kGeometryAlphaTested, "alpha that rays test"},
                                     {gpu::kGeometryMasked, "masked alpha"},
                                     {gpu::kGeometryBlended, "blended alpha"},
                                     {gpu::kGeometryPassesLight, "light that passes the surface"},
                                     {gpu::kGeometryEmitter, "triangles that are lights"}};

std::uint64_t entryKey(const package::PrimitiveEntry& entry) {
    return std::uint64_t{entry.featureInputs} << 32U | entry.featureLobes;
}

}  // namespace

CaseTable::CaseTable(const Package& package) : package_(package), fallback_(package.shape().fallback) {
    for (std::uint32_t scene = 0; scene < package.sceneCount(); ++scene) {
        for (const package::PrimitiveEntry& entry : package.scene(scene).primitives) {
            shaderOfKey_.emplace(entryKey(entry), entry.shaderId);
            known_ |= entryKey(entry);
            always_ &= entryKey(entry);
            flags_ |= entry.geometryFlags;
        }
    }
    // With a fallback no shader takes a feature for granted that a case does not.
    always_ = fallback_ || shaderOfKey_.empty() ? 0 : always_;
}

std::string CaseTable::namesOf(std::uint64_t features) const {
    std::string text;
    for (const std::string& name : package_.featureNames(features)) {
        text += (text.empty() ? "" : ", ") + name;
    }
    return text.empty() ? "no features" : text;
}

std::vector<std::uint32_t> CaseTable::shaderIds() const {
    std::vector<std::uint32_t> ids(package_.caseCount());
    for (std::uint32_t id = 0; id < ids.size(); ++id) {
        ids[id] = id;
    }
    if (fallback_) {
        ids.push_back(package_.caseCount());
    }
    return ids;
}

Status CaseTable::checkAttributes(const MaterialKey& key, const std::string& where) const {
    constexpr struct {
        std::uint32_t input;
        AttributeMask attribute;
    } kReads[] = {{kInputNormals, kAttributeNormals},
                  {kInputTangents, kAttributeTangents},
                  {kInputTexCoord0, kAttributeTexCoords0},
                  {kInputTexCoord1, kAttributeTexCoords1},
                  {kInputVertexColor, kAttributeColors}};
    std::uint64_t lacking = 0;
    for (const auto& [input, attribute] : kReads) {
        const std::uint64_t feature = std::uint64_t{input} << 32U;
        lacking |= (key.attributes & attribute) == 0 ? key.features & feature : 0;
    }
    std::uint32_t bit = kDeclaredAttributesShift;
    for (const package::AttributeEntry& row : package_.attributes()) {
        const bool given = (key.attributes >> bit++ & 1U) != 0 || row.hasFallback != 0;
        lacking |= given ? 0 : key.features & row.feature;
    }
    if (lacking != 0) {
        return makeError(
            "scene-edit-key", where,
            "a key has features that read attributes which it says are not there: " + namesOf(lacking),
            "make the keys by the attributes of primitives");
    }
    return okStatus();
}

Status CaseTable::checkKnown(const MaterialKey& key, const std::string& where) const {
    if (const std::uint64_t unknown = (key.features | key.hitFeatures) & ~known_; unknown != 0) {
        return makeError("scene-edit-feature", where,
                         "no material of the package has these features: " + namesOf(unknown), kCompileAgain);
    }
    for (const NamedFlag& named : kNamedFlags) {
        if ((key.geometryFlags & ~flags_ & named.flag) != 0) {
            return makeError("scene-edit-feature", where,
                             std::string("no material of the package has ") + named.what, kCompileAgain);
        }
    }
    return okStatus();
}

Status CaseTable::checkEmitter(const MaterialKey& key, const std::string& where) const {
    const package::EmissionEntry* const emission = package_.emission();
    if (emission == nullptr || (key.geometryFlags & gpu::kGeometryEmitter) == 0) {
        return okStatus();
    }
    const auto inputs = [](std::uint32_t bits) { return std::uint64_t{bits} << 32U; };
    std::uint64_t read = emission->read;
    const bool layered = read == ~std::uint64_t{0};
    if (!layered && (key.features & inputs(emission->textureInput)) == 0) {
        // Shaders read nothing at these coordinates.
        read &= ~inputs(emission->texCoord0Input | emission->texCoord1Input) | emission->always;
    }
    const std::uint64_t unlike = (emission->always & ~key.features) |
                                 (key.features & read & ~(emission->always | emission->sometimes));
    if (unlike != 0) {
        return makeError(
            "scene-edit-case", where,
            "the package has no shader that samples lights that differ from its own in: " + namesOf(unlike),
            "compile the package with --fallback, or from a scene that has such a light");
    }
    return okStatus();
}

Result<Shading> CaseTable::find(const MaterialKey& key, const std::string& where) const {
    GLINT_TRY_DO(checkKnown(key, where));
    GLINT_TRY_DO(checkEmitter(key, where));
    Shading shading{key.features, key.geometryFlags, 0, false};
    if (const auto own = shaderOfKey_.find(key.features); own != shaderOfKey_.end()) {
        shading.shaderId = own->second;
        return shading;
    }
    std::optional<std::uint32_t> best;
    const std::span<const package::CaseEntry> cases = package_.cases();
    for (std::uint32_t id = 0; id < cases.size() && (key.features & always_) == always_; ++id) {
        const package::CaseEntry& entry = cases[id];
        const bool fits = entry.keyCount > 0 && (entry.always & ~key.hitFeatures) == 0 &&
                          (key.hitFeatures & ~(entry.always | entry.sometimes)) == 0;
        if (fits && (!best || std::popcount(entry.sometimes) < std::popcount(cases[*best].sometimes))) {
            best = id;
        }
    }
    if (!best && !fallback_) {
        return makeError("scene-edit-case", where,
                         "the package has no shader for this key: " + namesOf(key.features),
                         "compile the package with --fallback, or from a scene that has such a material");
    }
    shading.missing = !best;
    shading.shaderId = best.value_or(package_.caseCount());
    return shading;
}

namespace {

// Returns a handle of the upload if the thing that it names is still there.
template <typename Entries, typename Handle>
Handle stillThere(const Entries& entries, std::span<const Handle> handles, std::uint32_t number) {
    return number < handles.size() && entries.find(handles[number]) != nullptr ? handles[number] : Handle{};
}

}  // namespace

SceneEditor::State::State(GpuScene::State& owner, const Package& package, const SceneView& view)
    : scene(owner),
      cases(package),
      layout(package.scene(0).materials.part(0, 0)),
      capacity(orderedCapacity(blasCapacity(owner.context))),
      leafOrder(leafOrderFor(owner.context, view.traversalOrder)),
      vertices(view.vertices),
      dataAccess(package.positionFetch()),
      passesLight(package.shadowThrough() == package::ShadowThrough::Glass),
      buildsTree(package.lightSamples() > 0),
      trustsTextures(package.trustTextures()),
      emission(package.emission()),
      materials(layout.recordBytes),
      emittersDirty(package.emission() != nullptr),
      retired(owner.pool) {}

SceneEditor::SceneEditor(std::unique_ptr<State> state) : state_(std::move(state)) {}
SceneEditor::~SceneEditor() = default;

std::unique_ptr<SceneEditor> SceneEditor::create(std::unique_ptr<State> state) {
    return std::unique_ptr<SceneEditor>(new SceneEditor(std::move(state)));
}

SceneEditor::State& SceneEditor::state() {
    return *state_;
}

TextureHandle SceneEditor::texture(std::uint32_t number) const {
    return stillThere(state_->textures, std::span<const TextureHandle>(state_->firstTextures), number);
}

MaterialHandle SceneEditor::material(std::uint32_t number) const {
    return stillThere(state_->materialSlots, std::span<const MaterialHandle>(state_->firstMaterials), number);
}

MeshHandle SceneEditor::mesh(std::uint32_t number) const {
    const auto known = state_->firstMeshes.find(number);
    const bool there = known != state_->firstMeshes.end() && state_->meshes.find(known->second) != nullptr;
    return there ? known->second : MeshHandle{};
}

InstanceHandle SceneEditor::instance(std::uint32_t number) const {
    return stillThere(state_->instanceSlots, std::span<const InstanceHandle>(state_->firstInstances), number);
}

LightHandle SceneEditor::light(std::uint32_t number) const {
    return stillThere(state_->lightSlots, std::span<const LightHandle>(state_->firstLights), number);
}

Result<LightHandle> SceneEditor::addLight(const LightView& light) {
    GLINT_TRY_DO(checkLights(std::span(&light, 1)));
    const LightHandle handle = state_->lightSlots.add(light);
    state_->lightOrder.push_back(handle);
    state_->lightsDirty = true;
    return handle;
}

Status SceneEditor::setLight(LightHandle light, const LightView& view) {
    LightView* const entry = state_->lightSlots.find(light);
    if (entry == nullptr) {
        return unknownHandle("light");
    }
    GLINT_TRY_DO(checkLights(std::span(&view, 1)));
    *entry = view;
    state_->lightsDirty = true;
    return okStatus();
}

Status SceneEditor::removeLight(LightHandle light) {
    if (state_->lightSlots.find(light) == nullptr) {
        return unknownHandle("light");
    }
    state_->lightSlots.take(light);
    std::erase(state_->lightOrder, light);
    state_->lightsDirty = true;
    return okStatus();
}

Status SceneEditor::record(VkCommandBuffer commands, std::uint64_t frame) {
    if (frame < state_->lastFrame) {
        return makeError("scene-edit-frame", "",
                         "frame " + std::to_string(frame) + " is recorded after frame " +
                             std::to_string(state_->lastFrame),
                         "number frames in the order in which they are recorded");
    }
    return recordEdits(*state_, commands, frame);
}

void SceneEditor::complete(std::uint64_t frame) {
    state_->retired.complete(frame);
}

void SceneEditor::trim() {
    state_->trims = true;
}

std::uint64_t SceneEditor::retiredBytes() const {
    std::uint64_t bytes = state_->retired.bytes();
    for (const Buffer& staging : state_->uploader->staging()) {
        bytes += staging.bytes;
    }
    return bytes;
}

}  // namespace glint
