// Checks that the elements of tables.bin agree with each other.
#include "interop/frame.h"
#include "package/package.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <set>
#include <tuple>

namespace glint {

namespace {

constexpr std::uint32_t kLastAlphaMode = 2;
constexpr std::uint32_t kLastWrap = 2;

Diagnostic altered(const std::string& where, std::string message) {
    return makeError("package-altered", where, std::move(message),
                     "compile the package again with `glint compile`");
}

bool inStrings(const Package::State& state, package::StringRef ref) {
    return std::uint64_t{ref.offset} + ref.length <= state.strings.size();
}

std::string_view text(const Package::State& state, package::StringRef ref) {
    return {state.strings.data() + ref.offset, ref.length};
}

std::string describe(const package::ModuleKey& key) {
    const package::RoleInfo* const info = package::findRole(key.role);
    if (info == nullptr) {
        return "of the unknown role " + std::to_string(static_cast<std::uint32_t>(key.role));
    }
    std::string name(info->name);
    if (info->repeated != package::Repeated::Once) {
        name.append(" ").append(std::to_string(key.index));
    }
    if (key.tracer == package::kTracerRayPipeline) {
        name.append(" of the ray pipeline");
    }
    return name;
}

Status checkFiles(const Package::State& state, const std::string& where) {
    std::map<std::string_view, std::tuple<std::uint64_t, std::uint64_t>> files;
    for (const package::ModuleEntry& module : state.modules) {
        if (!inStrings(state, module.file)) {
            return altered(where, "the file name of module " +
                                      describe({module.role, module.index, module.tracer}) +
                                      " is out of range");
        }
        const std::tuple contents(module.bytes, module.hash);
        if (files.emplace(text(state, module.file), contents).first->second != contents) {
            return altered(where, "two modules disagree on the contents of the file that they share");
        }
    }
    return okStatus();
}

// The modules must match the header: none may be missing, and there may be no others.
Status checkModules(const Package::State& state, const std::string& where) {
    std::set<package::ModuleKey> present;
    for (const package::ModuleEntry& module : state.modules) {
        const package::ModuleKey key{module.role, module.index, module.tracer};
        if (!present.insert(key).second) {
            return altered(where, "module " + describe(key) + " is there twice");
        }
    }
    const std::vector<package::ModuleKey> required = package::requiredModules(shapeOf(state));
    for (const package::ModuleKey& key : required) {
        if (present.erase(key) == 0) {
            return altered(where, "the package lacks its module " + describe(key));
        }
    }
    if (!present.empty()) {
        return altered(where, "there is a module " + describe(*present.begin()) +
                                  ", which the package's settings do not call for");
    }
    return checkFiles(state, where);
}

Status checkHeader(const Package::State& state, const std::string& where) {
    const package::PackageHeader& header = state.header;
    const auto number = [](auto value) { return static_cast<std::uint32_t>(value); };
    const struct {
        const char* what;
        std::uint32_t value;
        std::uint32_t least;
        std::uint32_t most;
    } fields[] = {
        {"the set of strategies", header.strategies, 1, package::allStrategies()},
        {"the set of tracers", header.tracers, 1, package::kAllTracers},
        {"the alpha policy", number(header.alpha), 0, number(package::AlphaPolicy::Stochastic)},
        {"the placement of shadow rays", number(header.shadows), 0,
         number(package::ShadowPlacement::Deferred)},
        {"the number of shadow rays that wait", header.firstShadowRays, 0, gpu::kMostFirstShadowRays},
        {"what shadow rays pass", number(header.shadowThrough), 0, number(package::ShadowThrough::Glass)},
        {"the hit record", number(header.hitRecord), 0, number(package::HitRecordFormat::Packed)},
        {"the record of samples", number(header.sampleRecord), 0,
         number(package::SampleRecordFormat::Packed)},
        {"the source of positions", header.positionFetch, 0, 1},
        {"the precision of shading", number(header.precision), 0, number(package::ShadingPrecision::Half)},
        {"the set of passes", number(header.passes), 0, number(package::Passes::Steps)},
        {"the answer to a ray", number(header.answer), 0, number(package::HitAnswer::Surface)},
        {"the number of bounces", header.maxBounces, 1, package::kMaxBounces},
        {"the kind of fallback", header.fallback, 0, 1},
        {"the kind of notes about textures", header.textureLevels, 0, 1},
        {"the trust in textures", header.trustTextures, 0, 1},
        {"the kind of movement", header.deforms, 0, 1},
        {"the number of light samples", header.lightSamples, 0, package::kMaxLightSamples},
        {"the kind of the sky's light", header.skyLight, 0, 1},
        {"the kind of lights with a size", header.sizedLights, 0, 1},
        {"the kind of disks", header.diskLights, 0, 1},
        {"the kind of sky", header.environmentMap, 0, 1},
    };
    for (const auto& [what, value, least, most] : fields) {
        if (value < least || value > most) {
            return altered(where, phrase(what, " ", value, " is unknown"));
        }
    }
    return okStatus();
}

// Shaders read at these offsets and slots without a check. The runtime reads there only if they are right.
Status checkEmission(const Package::State& state, const std::string& where) {
    if (state.emission.empty()) {
        return okStatus();
    }
    const package::EmissionEntry& entry = state.emission.front();
    const auto fits = [&](std::uint32_t offset, std::size_t bytes) {
        return offset == package::EmissionEntry::kNone ||
               (offset % 4 == 0 && offset + bytes <= state.materials.textureOffset);
    };
    const bool known =
        entry.texture == package::EmissionEntry::kNone || entry.texture < state.materials.textureCount;
    if (state.emission.size() != 1 || !fits(entry.factor, 3 * sizeof(float)) ||
        !fits(entry.strength, sizeof(float)) || !known) {
        return altered(where, "the emission of materials is outside of their records");
    }
    return okStatus();
}

Status checkOpacity(const Package::State& state, const std::string& where) {
    if (state.opacity.empty()) {
        return okStatus();
    }
    const package::OpacityEntry& entry = state.opacity.front();
    const auto fits = [&](std::uint32_t offset) {
        return offset % 4 == 0 && std::uint64_t{offset} + sizeof(float) <= state.materials.textureOffset;
    };
    const bool known =
        entry.texture == package::OpacityEntry::kNone || entry.texture < state.materials.textureCount;
    if (state.opacity.size() != 1 || !fits(entry.factor) || !fits(entry.cutoff) || !known) {
        return altered(where, "the alpha of materials is outside of their records");
    }
    return okStatus();
}

Status checkCases(const Package::State& state, const std::string& where) {
    if (state.cases.size() != state.header.caseCount) {
        return altered(where, phrase("the header names ", state.header.caseCount, " cases, there are ",
                                     state.cases.size()));
    }
    for (const package::CaseEntry& entry : state.cases) {
        if (!inStrings(state, entry.name)) {
            return altered(where, "the name of a case is out of range");
        }
        const package::KeyWords& always = entry.always;
        const package::KeyWords& sometimes = entry.sometimes;
        if (((always.lobes & sometimes.lobes) | (always.inputs & sometimes.inputs)) != 0 ||
            !(always.own & sometimes.own).isEmpty() || always.model != sometimes.model) {
            return altered(where, "a case has a feature both always and sometimes");
        }
    }
    return okStatus();
}

Status checkPrimitive(const Package::State& state, const package::SceneEntry& scene,
                      const package::PrimitiveEntry& entry, const std::string& where) {
    const std::string name = phrase("primitive ", entry.primitive, " of mesh ", entry.mesh);
    if (entry.shaderId >= state.header.caseCount) {
        return altered(where,
                       phrase(name, " has shader ID ", entry.shaderId, " of ", state.header.caseCount));
    }
    if (entry.materialIndex >= scene.materialCount) {
        return altered(where,
                       phrase(name, " has material ", entry.materialIndex, " of ", scene.materialCount));
    }
    const package::CaseEntry& shadedBy = state.cases[entry.shaderId];
    if (shadedBy.keyCount == 0) {
        return altered(where, phrase(name, " has shader ID ", entry.shaderId, ", which is retired"));
    }
    // The key may have features that its case does not know: lobes that primary surfaces have and hits do not
    // keep.
    const package::KeyWords& always = shadedBy.always;
    const bool isOfModel = always.model == entry.key.model || always.model == gpu::kAnyModel;
    if (((always.lobes & ~entry.key.lobes) | (always.inputs & ~entry.key.inputs)) != 0 ||
        !(always.own & ~entry.key.own).isEmpty() || !isOfModel) {
        return altered(where, name + " lacks features that its case takes for granted");
    }
    if ((entry.geometryFlags & ~kEntryFlags) != 0 || entry.alphaMode > kLastAlphaMode) {
        return altered(where, name + " has unknown flags");
    }
    if ((entry.geometryFlags & gpu::kGeometryAlphaTested) != 0 &&
        state.header.alpha == package::AlphaPolicy::Opaque) {
        return altered(where, name + " is alpha tested, and the package is not");
    }
    if ((entry.geometryFlags & gpu::kGeometryEmitter) != 0 && state.emission.empty()) {
        return altered(where, name + " is a light, and the package has no emissive lights");
    }
    if ((entry.geometryFlags & gpu::kGeometryPassesLight) != 0 &&
        state.header.shadowThrough != package::ShadowThrough::Glass) {
        return altered(where, name + " passes light, and shadow rays of the package do not ask");
    }
    return okStatus();
}

Status checkPrimitives(const Package::State& state, const package::SceneEntry& scene,
                       const std::string& where) {
    const auto key = [](const package::PrimitiveEntry& entry) {
        return std::tuple(entry.mesh, entry.primitive);
    };
    const package::PrimitiveEntry* previous = nullptr;
    for (const package::PrimitiveEntry& entry :
         state.primitives.subspan(scene.firstPrimitive, scene.primitiveCount)) {
        if (previous != nullptr && key(*previous) >= key(entry)) {
            return altered(where, "the primitives are not in order");
        }
        previous = &entry;
        GLINT_TRY_DO(checkPrimitive(state, scene, entry, where));
    }
    return okStatus();
}

Status checkMaterials(const Package::State& state, const package::SceneEntry& scene,
                      const std::string& where) {
    // A slot that no key reads holds zero, even if there is no texture zero.
    const std::uint32_t textureEnd = std::max(scene.textureCount, 1U);
    const std::uint32_t samplerEnd = std::max(scene.samplerCount, 1U);
    const MaterialTable materials = state.materials.part(scene.firstMaterial, scene.materialCount);
    for (std::size_t i = 0; i < materials.size(); ++i) {
        for (std::uint32_t slot = 0; slot < materials.textureCount; ++slot) {
            const gpu::TextureRecord texture = textureAt(materials, i, slot);
            if (texture.textureIndex >= textureEnd || texture.samplerIndex >= samplerEnd ||
                texture.texCoord > 1) {
                return altered(where, phrase("material ", scene.firstMaterial + i,
                                             " refers to a texture, sampler or UV set that does not exist"));
            }
        }
    }
    return okStatus();
}

// A range of a section. It follows the range of the scene before.
struct SceneRange {
    std::uint32_t package::SceneEntry::*first;
    std::uint32_t package::SceneEntry::*count;
    std::size_t total;
};

Status checkScenes(const Package::State& state, const std::string& where) {
    using Entry = package::SceneEntry;
    if (state.scenes.empty()) {
        return altered(where, "there is no scene");
    }
    for (const SceneRange& range :
         {SceneRange{&Entry::firstMaterial, &Entry::materialCount, state.materials.size()},
          SceneRange{&Entry::firstPrimitive, &Entry::primitiveCount, state.primitives.size()},
          SceneRange{&Entry::firstTexture, &Entry::textureCount, state.textures.size()},
          SceneRange{&Entry::firstSampler, &Entry::samplerCount, state.samplers.size()}}) {
        std::uint64_t end = 0;
        for (const Entry& scene : state.scenes) {
            if (scene.*range.first != end) {
                return altered(where, "the scenes' parts of a section overlap or leave a gap");
            }
            end += scene.*range.count;
        }
        if (end != range.total) {
            return altered(where, "the scenes' parts of a section are not the whole of it");
        }
    }
    std::set<std::string_view> names;
    for (const Entry& scene : state.scenes) {
        if (!inStrings(state, scene.name) || !names.insert(text(state, scene.name)).second) {
            return altered(where, "the name of a scene is out of range, or there twice");
        }
        for (const auto check : {checkPrimitives, checkMaterials}) {
            GLINT_TRY_DO(check(state, scene, where));
        }
    }
    return okStatus();
}

Status checkSamplers(const Package::State& state, const std::string& where) {
    if (!std::ranges::all_of(state.textures, [](const package::TextureEntry& texture) {
            return texture.srgb <= 1 &&
                   static_cast<std::size_t>(texture.dimension) < std::size(package::kTextureDimensionNames);
        })) {
        return altered(where, "a texture has an unknown colour space or dimension");
    }
    const auto known = [](const package::SamplerEntry& sampler) {
        return sampler.wrapU <= kLastWrap && sampler.wrapV <= kLastWrap && sampler.magnification <= 1 &&
               sampler.minification <= 1 && sampler.mip <= 1 && sampler.mipmapped <= 1;
    };
    if (!std::ranges::all_of(state.samplers, known)) {
        return altered(where, "a sampler has an unknown mode");
    }
    return okStatus();
}

static_assert(package::KeyWords::kAnyModel == gpu::kAnyModel);

// A model alone is a feature, too.
bool isOneFeature(const package::KeyWords& features) {
    const int shared = std::popcount(features.lobes) + std::popcount(features.inputs);
    const int own = features.own.count();
    return features.model == 0 ? shared == 1 && own == 0 : shared == 0 && own <= 1;
}

Status checkAttributes(const Package::State& state, const std::string& where) {
    for (const package::AttributeEntry& entry : state.attributes) {
        const bool isBit = isOneFeature(entry.feature);
        const bool isFinite =
            std::ranges::all_of(entry.fallback, [](float value) { return std::isfinite(value); });
        if (!inStrings(state, entry.name) || entry.channels == 0 || entry.channels > 4 || !isBit ||
            !isFinite || entry.hasFallback > 1) {
            return altered(where, "an attribute of vertices is not well formed");
        }
    }
    return okStatus();
}

// Every role of features is that of one feature.
Status checkFeatures(const Package::State& state, const std::string& where) {
    constexpr auto kRoles = static_cast<std::size_t>(package::Role::Count);
    std::array<std::size_t, kRoles> features{};
    for (const package::FeatureEntry& entry : state.features) {
        const auto role = static_cast<std::size_t>(entry.role);
        if (!isOneFeature(entry.feature) || !inStrings(state, entry.name) || role >= kRoles) {
            return altered(where, "a feature is not well formed");
        }
        ++features[role];
    }
    for (std::size_t role = 1; role < kRoles; ++role) {
        const bool isOfFeatures = role >= static_cast<std::size_t>(package::kFirstFeatureRole);
        if (features[role] != (isOfFeatures ? 1U : 0U)) {
            return altered(where, "a role of features is not that of one feature");
        }
    }
    return okStatus();
}

Status checkFields(const Package::State& state, const std::string& where) {
    std::uint64_t end = 0;
    std::uint32_t model = 0;
    for (const package::FieldEntry& entry : state.fields) {
        const bool isInOrder =
            (entry.model != model || entry.offset >= end) && entry.offset % 4 == 0 && entry.bytes % 4 == 0;
        model = entry.model;
        end = std::uint64_t{entry.offset} + entry.bytes;
        if (!inStrings(state, entry.name) || !isInOrder || entry.bytes == 0 ||
            end > state.materials.recordBytes) {
            return altered(where, "a field of materials is not well formed");
        }
    }
    return okStatus();
}

Status checkEffects(const Package::State& state, const std::string& where) {
    package::Effect last = 0;
    for (const package::EffectEntry& entry : state.effectEntries) {
        const bool isNext = std::has_single_bit(entry.effect) && entry.effect > last;
        const bool isKnown = entry.kind <= package::EffectInfo::Kind::Rays &&
                             (entry.abilities & ~std::uint32_t{package::kAllEffectAbilities}) == 0;
        // Only effects with rays have abilities.
        const bool fits = entry.abilities == 0 || entry.kind == package::EffectInfo::Kind::Rays;
        if (!inStrings(state, entry.name) || entry.name.length == 0 || !isNext || !isKnown || !fits) {
            return altered(where, "an effect is not well formed");
        }
        last = entry.effect;
    }
    return okStatus();
}

// Requires state.effects.
Status checkLayers(const Package::State& state, const std::string& where) {
    std::uint32_t rays = 0;
    for (const package::EffectInfo& effect : state.effects) {
        rays |= effect.kind == package::EffectInfo::Kind::Rays ? effect.effect : 0U;
    }
    std::set<std::tuple<std::uint32_t, package::Effect, std::uint32_t>> seen;
    for (const package::LayerInfo::Entry& entry : state.layerEntries) {
        const package::LayerInfo* const info = package::findLayer(entry.layer);
        if (info == nullptr) {
            return altered(where, phrase("layer ", entry.layer, " is unknown"));
        }
        using Subject = package::LayerInfo::Subject;
        const bool ofBounce = info->subject == Subject::Bounce;
        const bool isOfEffect = std::has_single_bit(entry.effect) && (entry.effect & rays) != 0;
        const bool fits = entry.effect == 0 ? info->subject != Subject::Ray && !ofBounce
                                            : isOfEffect && package::hasSources(*info);
        const std::uint32_t mostBounces = std::min(state.header.maxBounces, package::kMostLayerBounces);
        const bool bounceFits =
            ofBounce ? entry.bounce >= 1 && entry.bounce <= mostBounces : entry.bounce == 0;
        if (!fits || !bounceFits || !seen.emplace(entry.layer, entry.effect, entry.bounce).second ||
            state.header.passes != package::Passes::Frame) {
            return altered(where, "the layer " + std::string(info->name) + " is not well formed");
        }
    }
    return okStatus();
}

// Requires entries that checkLayers() accepts.
std::vector<package::PackageLayer> layersOf(const Package::State& state) {
    std::vector<package::PackageLayer> layers;
    for (const package::LayerInfo::Entry& entry : state.layerEntries) {
        const package::LayerInfo& info = *package::findLayer(entry.layer);
        const auto effect = std::ranges::find(state.effects, entry.effect, &package::EffectInfo::effect);
        const std::string_view source = effect == state.effects.end() ? package::kDirectLight : effect->name;
        layers.push_back({&info, entry.effect, entry.bounce, package::layerName(info, source, entry.bounce)});
    }
    return layers;
}

}  // namespace

package::PackageShape shapeOf(const Package::State& state) {
    const package::PackageHeader& header = state.header;
    package::PackageShape shape{
        header.strategies, header.tracers, header.shadows, {}, header.alpha != package::AlphaPolicy::Opaque,
        header.caseCount};
    for (const package::EffectInfo& effect : state.effects) {
        shape.effects.add(effect);
    }
    for (std::uint32_t id = 0; id < state.cases.size(); ++id) {
        if (state.cases[id].keyCount == 0) {
            shape.retired.push_back(id);
        }
    }
    shape.deforms = header.deforms != 0;
    shape.passes = header.passes;
    shape.maxBounces = header.maxBounces;
    shape.fallback = header.fallback != 0;
    shape.shadowsApart = header.shadowThrough != package::ShadowThrough::Alpha;
    shape.firstShadowRays = header.firstShadowRays;
    return shape;
}

Status checkTables(Package::State& state, const std::string& where) {
    GLINT_TRY_DO(checkEffects(state, where));
    for (const package::EffectEntry& entry : state.effectEntries) {
        state.effects.push_back({entry.effect, entry.kind, entry.abilities, text(state, entry.name)});
    }
    for (const auto check : {checkHeader, checkCases, checkModules, checkScenes, checkEmission, checkOpacity,
                             checkSamplers, checkAttributes, checkFeatures, checkFields, checkLayers}) {
        GLINT_TRY_DO(check(state, where));
    }
    for (const package::FeatureEntry& entry : state.features) {
        if (entry.role != package::Role::None) {
            state.featureOfRole[static_cast<std::size_t>(entry.role)] = entry.feature;
        }
    }
    state.layers = layersOf(state);
    return okStatus();
}

}  // namespace glint
