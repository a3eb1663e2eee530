#include "scene/case_table.h"

#include "interop/scene.h"
#include "package/package.h"

#include <glint/internal/package_modules.h>

#include <bit>
#include <optional>
#include <tuple>
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

// The features of a key, of which there may be too many.
package::KeyWords without(const package::KeyWords& features, const package::KeyWords& others) {
    return {features.lobes & ~others.lobes, features.inputs & ~others.inputs};
}

bool isEmpty(const package::KeyWords& features) {
    return features == package::KeyWords{};
}

int countOf(const package::KeyWords& features) {
    return std::popcount(features.lobes) + std::popcount(features.inputs) + features.own.count();
}

}  // namespace

bool CaseTable::Less::operator()(const package::KeyWords& a, const package::KeyWords& b) const {
    return std::tie(a.model, a.own, a.inputs, a.lobes) < std::tie(b.model, b.own, b.inputs, b.lobes);
}

CaseTable::CaseTable(std::shared_ptr<const Package> package)
    : package_(std::move(package)), fallback_(package_->shape().fallback) {
    for (std::uint32_t scene = 0; scene < package_->sceneCount(); ++scene) {
        for (const package::PrimitiveEntry& entry : package_->scene(scene).primitives) {
            shaderOfKey_.emplace(entry.key, entry.shaderId);
            known_.lobes |= entry.key.lobes;
            known_.inputs |= entry.key.inputs;
            KnownModel& model = knownModels_[entry.key.model];
            model.own = model.own | entry.key.own;
            model.flags |= entry.geometryFlags;
            always_.lobes &= entry.key.lobes;
            always_.inputs &= entry.key.inputs;
            flags_ |= entry.geometryFlags;
        }
    }
    // With a fallback no shader takes a feature for granted that a case does not.
    always_ = fallback_ || shaderOfKey_.empty() ? package::KeyWords{} : always_;
}

std::string CaseTable::namesOf(const package::KeyWords& features) const {
    std::string text;
    for (const std::string& name : package_->featureNames(features)) {
        text += (text.empty() ? "" : ", ") + name;
    }
    return text.empty() ? "no features" : text;
}

std::vector<std::uint32_t> CaseTable::shaderIds() const {
    std::vector<std::uint32_t> ids(package_->caseCount());
    for (std::uint32_t id = 0; id < ids.size(); ++id) {
        ids[id] = id;
    }
    if (fallback_) {
        ids.push_back(package_->caseCount());
    }
    return ids;
}

Status CaseTable::checkAttributes(const SceneEditor::MaterialKey& key, const std::string& where) const {
    constexpr struct {
        package::Role role;
        AttributeMask attribute;
    } kReads[] = {{package::Role::Normals, kAttributeNormals},
                  {package::Role::Tangents, kAttributeTangents},
                  {package::Role::TexCoord0, kAttributeTexCoords0},
                  {package::Role::TexCoord1, kAttributeTexCoords1},
                  {package::Role::VertexColor, kAttributeColors}};
    const Package::State& state = package_->state();
    package::KeyWords lacking;
    for (const auto& [role, attribute] : kReads) {
        if ((key.attributes & attribute) == 0 && state.hasFeature(key.features, role)) {
            lacking |= state.featureOfRole[static_cast<std::size_t>(role)];
        }
    }
    std::uint32_t bit = kDeclaredAttributesShift;
    for (const package::AttributeEntry& row : package_->attributes()) {
        const bool given = (key.attributes >> bit++ & 1U) != 0 || row.hasFallback != 0;
        if (!given && key.features.hasAny(row.feature)) {
            lacking |= row.feature;
        }
    }
    if (!isEmpty(lacking)) {
        return makeError(
            "scene-edit-key", where,
            "a key has features that read attributes which it says are not there: " + namesOf(lacking),
            "make the keys by the attributes of primitives");
    }
    return okStatus();
}

SceneEditor::MaterialKey CaseTable::asked(SceneEditor::MaterialKey key) const {
    const bool isBlended = (key.geometryFlags & gpu::kGeometryBlended) != 0;
    const bool ignoresBlended = isBlended && package_->alpha() != package::AlphaPolicy::Stochastic;
    const package::KeyWords& alphaTest =
        package_->state().featureOfRole[static_cast<std::size_t>(package::Role::AlphaTest)];
    if (package_->alpha() == package::AlphaPolicy::Opaque || ignoresBlended) {
        for (package::KeyWords* const features : {&key.features, &key.hitFeatures}) {
            features->lobes &= ~alphaTest.lobes;
            features->inputs &= ~alphaTest.inputs;
        }
        // The raster pass tests MASK all the same.
        key.geometryFlags &= ~(gpu::kGeometryAlphaTested | gpu::kGeometryBlended |
                               (ignoresBlended ? gpu::kGeometryMasked : 0U));
    }
    if (package_->shadowThrough() != package::ShadowThrough::Glass) {
        key.geometryFlags &= ~gpu::kGeometryPassesLight;
    } else if ((key.geometryFlags & gpu::kGeometryBlended) != 0) {
        key.geometryFlags |= gpu::kGeometryPassesLight;
    }
    if (package_->emission() == nullptr) {
        key.geometryFlags &= ~gpu::kGeometryEmitter;
    }
    return key;
}

Status CaseTable::checkKnown(const SceneEditor::MaterialKey& key, const std::string& where) const {
    package::KeyWords all = key.features;
    all |= key.hitFeatures;
    const auto found = knownModels_.find(all.model);
    const bool isKnown = found != knownModels_.end();
    if (all.model == 0 && !isKnown && !knownModels_.empty()) {
        return makeError("scene-edit-feature", where, "no material of the package has a base of glTF",
                         kCompileAgain);
    }
    package::KeyWords unknown = without(all, known_);
    const KnownModel known = isKnown ? found->second : KnownModel{};
    if (!isKnown || !(all.own & ~known.own).isEmpty()) {
        unknown.model = all.model;
        unknown.own = all.own & ~known.own;
    }
    if (!isEmpty(unknown)) {
        return makeError("scene-edit-feature", where,
                         "no material of the package has these features: " + namesOf(unknown), kCompileAgain);
    }
    // The records of a model have a cutoff if some of its materials need one.
    const std::uint32_t flags =
        fallback_ ? flags_ : (flags_ & ~gpu::kGeometryMasked) | (known.flags & gpu::kGeometryMasked);
    for (const NamedFlag& named : kNamedFlags) {
        if ((key.geometryFlags & ~flags & named.flag) != 0) {
            return makeError("scene-edit-feature", where,
                             std::string("no material of the package has ") + named.what, kCompileAgain);
        }
    }
    return okStatus();
}

Status CaseTable::checkEmitter(const SceneEditor::MaterialKey& key, const std::string& where) const {
    const package::EmissionEntry* const emission = package_->emission();
    if (emission == nullptr || (key.geometryFlags & gpu::kGeometryEmitter) == 0) {
        return okStatus();
    }
    package::KeyWords read = emission->read;
    const bool layered = read.lobes == ~0U && read.inputs == ~0U;
    if (!layered && (key.features.inputs & emission->textureInput) == 0) {
        // Shaders read nothing at these coordinates.
        read.inputs &= ~(emission->texCoord0Input | emission->texCoord1Input) | emission->always.inputs;
    }
    const package::KeyWords& always = emission->always;
    const package::KeyWords& sometimes = emission->sometimes;
    const auto unlike = [](const auto& has, const auto& reads, const auto& least, const auto& some) {
        return (least & ~has) | (has & reads & ~(least | some));
    };
    package::KeyWords differing{unlike(key.features.lobes, read.lobes, always.lobes, sometimes.lobes),
                                unlike(key.features.inputs, read.inputs, always.inputs, sometimes.inputs)};
    if (read.model != 0 && always.model != gpu::kAnyModel) {
        const bool isOther = always.model != key.features.model;
        const package::KeyWords::Own own = unlike(key.features.own, read.own, always.own, sometimes.own);
        differing.model = isOther || !own.isEmpty() ? key.features.model : 0;
        differing.own = isOther ? package::KeyWords::Own{} : own;
    }
    if (!isEmpty(differing)) {
        return makeError("scene-edit-case", where,
                         "the package has no shader that samples lights that differ from its own in: " +
                             namesOf(differing),
                         "compile the package with --fallback, or from a scene that has such a light");
    }
    return okStatus();
}

Result<Shading> CaseTable::find(const SceneEditor::MaterialKey& whole, const std::string& where) const {
    const SceneEditor::MaterialKey key = asked(whole);
    GLINT_TRY_DO(checkKnown(key, where));
    GLINT_TRY_DO(checkEmitter(key, where));
    Shading shading{key.features, key.geometryFlags, 0, false};
    if (const auto own = shaderOfKey_.find(key.features); own != shaderOfKey_.end()) {
        shading.shaderId = own->second;
        return shading;
    }
    std::optional<std::uint32_t> best;
    const std::span<const package::CaseEntry> cases = package_->cases();
    const bool hasUsual = isEmpty(without(always_, key.features));
    for (std::uint32_t id = 0; id < cases.size() && hasUsual; ++id) {
        const package::CaseEntry& entry = cases[id];
        if (entry.keyCount > 0 && entry.fits(key.hitFeatures) &&
            (!best || countOf(entry.sometimes) < countOf(cases[*best].sometimes))) {
            best = id;
        }
    }
    if (!best && !fallback_) {
        return makeError("scene-edit-case", where,
                         "the package has no shader for this key: " + namesOf(key.features),
                         "compile the package with --fallback, or from a scene that has such a material");
    }
    shading.missing = !best;
    shading.shaderId = best.value_or(package_->caseCount());
    return shading;
}

}  // namespace glint
