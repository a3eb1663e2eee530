#include "scene/case_table.h"

#include "data/scene_checks.h"
#include "interop/scene.h"

#include <glint/internal/package_modules.h>

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

CaseTable::CaseTable(std::shared_ptr<const Package> package)
    : package_(std::move(package)), fallback_(package_->shape().fallback) {
    for (std::uint32_t scene = 0; scene < package_->sceneCount(); ++scene) {
        for (const package::PrimitiveEntry& entry : package_->scene(scene).primitives) {
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
    for (const package::AttributeEntry& row : package_->attributes()) {
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
    const package::EmissionEntry* const emission = package_->emission();
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
    const std::span<const package::CaseEntry> cases = package_->cases();
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
    shading.shaderId = best.value_or(package_->caseCount());
    return shading;
}

}  // namespace glint
