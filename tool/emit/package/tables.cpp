#include "emit/package/tables.h"

#include "emit/context.h"
#include "emit/material_code.h"
#include "resolve/build.h"
#include "scene/deformed.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <interop/scene.h>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>

namespace glint::compiler {

using namespace package;

namespace {

static_assert(std::endian::native == std::endian::little, "tables.bin is little endian");

// A table of distinct strings.
class StringTable {
public:
    StringRef add(const std::string& text) {
        const auto [place, isNew] = offsets_.try_emplace(text, static_cast<std::uint32_t>(bytes_.size()));
        if (isNew) {
            bytes_ += text;
        }
        return {place->second, static_cast<std::uint32_t>(text.size())};
    }
    const std::string& bytes() const {
        return bytes_;
    }

private:
    std::map<std::string, std::uint32_t> offsets_;
    std::string bytes_;
};

// Collects sections. The header is written last, because it holds the hash of the rest.
class TableWriter {
public:
    template <typename Elements>
    void add(SectionKind kind, const Elements& elements) {
        using Element = typename Elements::value_type;
        static_assert(std::is_trivially_copyable_v<Element>);
        add(kind, sizeof(Element),
            {reinterpret_cast<const std::uint8_t*>(elements.data()), elements.size() * sizeof(Element)});
    }
    // `bytes` holds whole elements.
    void add(SectionKind kind, std::size_t elementBytes, std::span<const std::uint8_t> bytes) {
        sections_.push_back(
            {kind, static_cast<std::uint32_t>(elementBytes), content_.size(), bytes.size() / elementBytes});
        content_.insert(content_.end(), bytes.begin(), bytes.end());
        constexpr std::size_t kAlignment = 8;
        content_.resize((content_.size() + kAlignment - 1) / kAlignment * kAlignment);
    }

    base::Bytes finish(PackageHeader header) {
        const std::size_t start = sizeof(PackageHeader) + sections_.size() * sizeof(PackageSection);
        for (PackageSection& section : sections_) {
            section.offset += start;
        }
        base::Bytes file(start);
        std::memcpy(file.data() + sizeof header, sections_.data(), start - sizeof header);
        file.insert(file.end(), content_.begin(), content_.end());
        header.sectionCount = static_cast<std::uint32_t>(sections_.size());
        header.fileBytes = file.size();
        header.contentHash = 0;
        std::memcpy(file.data(), &header, sizeof header);
        const std::span whole(file);
        header.contentHash =
            base::hashBytes(whole.subspan(sizeof header), base::hashBytes(whole.first(sizeof header)));
        std::memcpy(file.data(), &header, sizeof header);
        return file;
    }

private:
    std::vector<PackageSection> sections_;
    base::Bytes content_;
};

std::vector<PrimitiveEntry> makePrimitives(const gltf::SceneList& scenes, gltf::SceneList::Range range,
                                           const Plan& plan, const CompileSettings& settings) {
    std::vector<PrimitiveEntry> entries;
    for (std::size_t i = range.first; i < range.first + range.count; ++i) {
        const materials::PrimitiveInputs& inputs = scenes.primitives()[i];
        const Key& key = plan.keys[plan.keyOfPrimitive[i]];
        const materials::Material& material = scenes.materials()[inputs.material];
        PrimitiveEntry entry{};
        entry.mesh = static_cast<std::uint32_t>(inputs.mesh);
        entry.primitive = static_cast<std::uint32_t>(inputs.primitive);
        entry.shaderId = static_cast<std::uint32_t>(key.shaderId);
        entry.materialIndex = static_cast<std::uint32_t>(scenes.place(inputs.material).index);
        entry.key = plan.model->words(plan.primaryMaskOfPrimitive[i]);
        const bool emits = settings.emissiveLights == EmissiveLights::On && isEmitter(material, inputs);
        entry.geometryFlags =
            geometryFlags(material, inputs, key.mask, settings.plan.keys.alpha, settings.shadowThrough) |
            (emits ? gpu::kGeometryEmitter : 0U);
        entry.alphaMode = static_cast<std::uint32_t>(material.alphaMode);
        entries.push_back(entry);
    }
    std::ranges::sort(entries, {},
                      [](const PrimitiveEntry& entry) { return std::pair(entry.mesh, entry.primitive); });
    return entries;
}

std::vector<AttributeEntry> makeAttributes(const Plan& plan, StringTable& strings) {
    const materials::FeatureMask used = usedFeatures(plan);
    std::vector<AttributeEntry> entries;
    for (const materials::VertexAttribute& attribute : plan.model->attributes) {
        const materials::Feature& feature = plan.model->features[static_cast<std::size_t>(attribute.feature)];
        if (!used.has(feature.bit)) {
            continue;
        }
        AttributeEntry entry{};
        entry.name = strings.add(attribute.gltf);
        entry.channels = static_cast<std::uint32_t>(attribute.type->channels);
        entry.hasFallback = attribute.fallback ? 1 : 0;
        std::ranges::copy(attribute.fallback.value_or(std::array<float, 4>{}), entry.fallback);
        entry.feature = plan.model->words(feature.mask());
        entries.push_back(entry);
    }
    return entries;
}

std::vector<FeatureEntry> makeFeatures(const materials::MaterialModel& model, StringTable& strings) {
    std::vector<FeatureEntry> entries;
    for (const materials::Feature& feature : model.features) {
        entries.push_back({model.words(feature.mask()), strings.add(feature.name), feature.role});
    }
    return entries;
}

// Tells types apart, and enums by their names.
std::uint32_t typeHash(const MaterialLayout& layout, const RecordField& field) {
    std::string text = fmt::format("{} {}", field.type->glsl, field.count);
    if (field.parameter >= 0) {
        text += fmt::format(
            " {}", fmt::join(layout.model->parameters[static_cast<std::size_t>(field.parameter)].names, " "));
    }
    return static_cast<std::uint32_t>(base::hashBytes(text));
}

std::vector<FieldEntry> makeFields(const MaterialLayout& layout, StringTable& strings) {
    std::vector<FieldEntry> entries;
    const auto add = [&](const std::string& name, std::uint32_t offset, std::uint32_t bytes,
                         std::uint32_t type, const std::vector<int>& models) {
        const package::StringRef text = strings.add(name);
        for (const int model : models) {
            entries.push_back({text, offset, bytes, model < 0 ? 0U : layout.model->modelWord(model), type});
        }
    };
    for (const RecordField& field : layout.fields) {
        add(field.name, field.offset, field.bytes(), typeHash(layout, field), field.models);
    }
    constexpr auto kBytes = static_cast<std::uint32_t>(sizeof(gpu::TextureRecord));
    for (const TextureSlot& row : layout.textures) {
        const materials::MaterialTexture& texture =
            layout.model->textures[static_cast<std::size_t>(row.texture)];
        add(texture.name, layout.textureOffset + static_cast<std::uint32_t>(row.slot) * kBytes, kBytes,
            static_cast<std::uint32_t>(texture.dimension), row.models);
    }
    std::ranges::stable_sort(entries, {}, [](const FieldEntry& entry) {
        return std::pair(entry.model & gpu::kModelNumber, entry.offset);
    });
    return entries;
}

// The bit in KeyWords::inputs of the feature with a role.
std::uint32_t inputOf(const materials::MaterialModel& model, Role role) {
    return model.words(model.mask(role)).inputs;
}

EmissionEntry emissionOf(const MaterialLayout& layout, const EmitterFeatures& features) {
    const materials::MaterialModel& model = *layout.model;
    const auto offsetOf = [&](Role role) {
        const RecordField* const field = layout.fieldOf(role);
        return field == nullptr ? EmissionEntry::kNone : field->offset;
    };
    const int slot = layout.slotOf(model.textureOf(Role::Emission));
    const auto [always, sometimes] = model.caseWords(features.always, features.sometimes);
    return {offsetOf(Role::Emission),
            offsetOf(Role::EmissionStrength),
            slot < 0 ? EmissionEntry::kNone : static_cast<std::uint32_t>(slot),
            model.words(model.textureMask(Role::Emission)).inputs,
            inputOf(model, Role::TexCoord0),
            inputOf(model, Role::TexCoord1),
            model.words(features.read),
            always,
            sometimes};
}

// Returns nothing if records lack what an alpha test reads: no material is tested.
std::optional<OpacityEntry> opacityOf(const MaterialLayout& layout) {
    const materials::MaterialModel& model = *layout.model;
    const RecordField* const color = layout.fieldOf(Role::BaseColor);
    const RecordField* const cutoff = layout.fieldOf(Role::AlphaCutoff);
    if (color == nullptr || cutoff == nullptr) {
        return std::nullopt;
    }
    const int slot = layout.slotOf(model.textureOf(Role::BaseColor));
    constexpr std::uint32_t kAlpha = 3 * sizeof(float);  // after red, green and blue
    return OpacityEntry{color->offset + kAlpha,
                        cutoff->offset,
                        slot < 0 ? OpacityEntry::kNone : static_cast<std::uint32_t>(slot),
                        model.words(model.textureMask(Role::BaseColor)).inputs,
                        inputOf(model, Role::TexCoord0),
                        inputOf(model, Role::TexCoord1),
                        inputOf(model, Role::TextureTransform),
                        inputOf(model, Role::VertexColor),
                        model.words(maskCodeFeatures(model).shared())};
}

std::vector<EffectEntry> makeEffects(const Plan& plan, StringTable& strings) {
    std::vector<EffectEntry> entries;
    package::forEachEffect(plan.effects.effects.all, [&](std::uint32_t number) {
        const package::EffectInfo info = infoOf(plan.model->effects[number], number);
        entries.push_back({strings.add(std::string(info.name)), info.effect, info.kind, info.abilities, 0});
    });
    return entries;
}

std::vector<SamplerEntry> makeSamplers(const gltf::Scene& scene) {
    std::vector<SamplerEntry> entries;
    for (const gltf::Sampler& sampler : scene.samplers) {
        entries.push_back(samplerEntry(sampler));
    }
    return entries;
}

// The sections that each scene has its own part of.
struct SceneTables {
    std::vector<std::uint8_t> materials;
    std::vector<PrimitiveEntry> primitives;
    std::vector<TextureEntry> textures;
    std::vector<SamplerEntry> samplers;
    std::vector<SceneEntry> scenes;
};

// Appends a scene's elements to those of all scenes, and stores where they are.
template <typename Element>
void append(std::vector<Element>& all, const std::vector<Element>& own, std::uint32_t& first,
            std::uint32_t& count) {
    first = static_cast<std::uint32_t>(all.size());
    count = static_cast<std::uint32_t>(own.size());
    all.insert(all.end(), own.begin(), own.end());
}

Diagnostic indexError(const gltf::Scene& scene, std::string what) {
    return makeError("scene-index", scene.path, std::move(what), "import the scene again");
}

bool within(int index, std::size_t count) {
    return index >= 0 && static_cast<std::size_t>(index) < count;
}

}  // namespace

SamplerEntry samplerEntry(const gltf::Sampler& sampler) {
    return {
        static_cast<std::uint32_t>(sampler.wrapU),         static_cast<std::uint32_t>(sampler.wrapV),
        static_cast<std::uint32_t>(sampler.magnification), static_cast<std::uint32_t>(sampler.minification),
        static_cast<std::uint32_t>(sampler.mip),           sampler.mipmapped ? 1U : 0U};
}

std::uint32_t geometryFlags(const materials::Material& material, const materials::PrimitiveInputs& inputs,
                            const materials::FeatureMask& hitKey, AlphaPolicy alpha, ShadowThrough through) {
    const bool tested =
        alpha != AlphaPolicy::Opaque && (hitKey & material.model().mask(Role::AlphaTest)) != 0;
    const bool blended = tested && material.alphaMode == materials::AlphaMode::Blend;
    const bool passes = through == ShadowThrough::Glass && (blended || passesLight(material, inputs));
    return (tested ? gpu::kGeometryAlphaTested : 0U) | (passes ? gpu::kGeometryPassesLight : 0U) |
           (material.doubleSided ? gpu::kGeometryDoubleSided : 0U) |
           (material.alphaMode == materials::AlphaMode::Mask || blended ? gpu::kGeometryMasked : 0U) |
           (blended ? gpu::kGeometryBlended : 0U);
}

Status checkScene(const gltf::Scene& scene) {
    for (std::size_t i = 0; i < scene.textures.size(); ++i) {
        const gltf::Texture& texture = scene.textures[i];
        if (!within(texture.image, scene.images.size()) || !within(texture.sampler, scene.samplers.size())) {
            return indexError(scene, fmt::format("texture {} has no image or no sampler", i));
        }
    }
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        for (const auto& [slot, info] : scene.materials[i].textures) {
            if (info.texture >= 0 && !within(info.texture, scene.textures.size())) {
                return indexError(scene, fmt::format("material {} has no texture {}", i, info.texture));
            }
        }
    }
    for (const gltf::Mesh& mesh : scene.meshes) {
        for (const gltf::Primitive& primitive : mesh.primitives) {
            if (!within(primitive.material, scene.materials.size())) {
                return indexError(
                    scene, fmt::format("{} has no material {}", primitive.pointer, primitive.material));
            }
        }
    }
    return okStatus();
}

namespace {

PackageHeader makeTablesHeader(const gltf::SceneList& scenes, const Plan& plan,
                               const CompileSettings& settings, const MaterialLayout& layout) {
    PackageHeader header{};
    std::memcpy(header.magic, kMagic, sizeof header.magic);
    header.version = kVersion;
    header.strategies = settings.strategies;
    header.tracers = settings.tracers;
    header.shadows = settings.shadows;
    header.firstShadowRays = shapeOf(scenes, plan, settings).firstShadowRays;
    header.hitRecord = settings.hitRecord;
    const bool hasSamples = settings.passes == package::Passes::Frame;
    header.sampleRecord = hasSamples ? settings.sampleRecord : package::SampleRecordFormat::Full;
    header.environmentMap = settings.environmentMap ? 1 : 0;
    header.positionFetch = settings.positionFetch ? 1 : 0;
    header.lightSamples = settings.lightSamples.value_or(0);
    header.skyLight = settings.skyLight == SkyLight::On ? 1 : 0;
    header.sizedLights = settings.sizedLights == SizedLights::On ? 1 : 0;
    header.diskLights = settings.diskLights == DiskLights::On ? 1 : 0;
    header.precision = settings.precision;
    header.passes = settings.passes;
    header.answer = settings.answer;
    header.bindings = settings.bindings;
    header.maxBounces = settings.maxBounces;
    header.fallback = settings.plan.fallback ? 1 : 0;
    header.textureLevels = settings.textureLevels ? 1 : 0;
    header.trustTextures = std::ranges::any_of(scenes.scenes(), &gltf::Scene::trustsTextures) ? 1 : 0;
    header.deforms = std::ranges::any_of(scenes.scenes(), hasDeformedMesh) ? 1 : 0;
    header.alpha = settings.plan.keys.alpha;
    header.shadowThrough = settings.shadowThrough;
    header.materialTextureOffset = layout.textureOffset;
    header.materialTextureCount = layout.textureCount;
    header.caseCount = static_cast<std::uint32_t>(plan.cases.size());
    header.interopHash = static_cast<std::uint32_t>(interopSourceHash());
    return header;
}

}  // namespace

base::Bytes makeTables(const gltf::SceneList& scenes, const Plan& plan,
                       std::span<const CompiledModule> modules, const CompileSettings& settings) {
    StringTable strings;
    std::vector<ModuleEntry> moduleEntries;
    for (const CompiledModule& module : modules) {
        moduleEntries.push_back({module.key.role, module.key.index, module.key.tracer, 0,
                                 strings.add(module.file), module.statistics.bytes, module.hash});
    }
    std::vector<CaseEntry> cases;
    for (const Case& shaderCase : plan.cases) {
        const auto [always, sometimes] = plan.model->caseWords(shaderCase.always, shaderCase.sometimes);
        cases.push_back({always, sometimes, strings.add(shaderCase.name),
                         static_cast<std::uint32_t>(shaderCase.keys.size())});
    }
    const MaterialLayout layout = materialLayoutOf(plan);
    SceneTables tables;
    for (std::size_t i = 0; i < scenes.scenes().size(); ++i) {
        const gltf::Scene& scene = scenes.scenes()[i];
        const MaterialTables materials = makeMaterialTables(scene, layout);
        SceneEntry entry{};
        entry.name = strings.add(scenes.name(i));
        entry.firstMaterial = static_cast<std::uint32_t>(tables.materials.size() / layout.bytes);
        entry.materialCount = static_cast<std::uint32_t>(scene.materials.size());
        tables.materials.insert(tables.materials.end(), materials.materials.begin(),
                                materials.materials.end());
        append(tables.primitives, makePrimitives(scenes, scenes.primitivesOf(i), plan, settings),
               entry.firstPrimitive, entry.primitiveCount);
        append(tables.textures, materials.textures, entry.firstTexture, entry.textureCount);
        append(tables.samplers, makeSamplers(scene), entry.firstSampler, entry.samplerCount);
        tables.scenes.push_back(entry);
    }

    const std::vector<AttributeEntry> attributes = makeAttributes(plan, strings);
    const std::vector<EffectEntry> effects = makeEffects(plan, strings);
    const std::vector<FeatureEntry> features = makeFeatures(*plan.model, strings);
    const std::vector<FieldEntry> fields = makeFields(layout, strings);
    TableWriter writer;
    writer.add(SectionKind::Modules, moduleEntries);
    writer.add(SectionKind::Materials, layout.bytes, tables.materials);
    writer.add(SectionKind::Primitives, tables.primitives);
    writer.add(SectionKind::Textures, tables.textures);
    writer.add(SectionKind::Samplers, tables.samplers);
    writer.add(SectionKind::Scenes, tables.scenes);
    writer.add(SectionKind::Strings, strings.bytes());
    writer.add(SectionKind::Cases, cases);
    writer.add(SectionKind::Attributes, attributes);
    writer.add(SectionKind::Effects, effects);
    writer.add(SectionKind::Features, features);
    writer.add(SectionKind::Fields, fields);
    if (settings.emissiveLights == EmissiveLights::On) {
        writer.add(SectionKind::Emission, std::vector{emissionOf(layout, plan.emitters)});
    }
    if (!plan.layers.empty()) {
        writer.add(SectionKind::Layers, plan.layers);
    }
    const std::optional<OpacityEntry> opacity = opacityOf(layout);
    if (opacity && settings.plan.keys.alpha != AlphaPolicy::Opaque && settings.host.empty()) {
        writer.add(SectionKind::Opacity, std::vector{*opacity});
    }

    return writer.finish(makeTablesHeader(scenes, plan, settings, layout));
}

using package::TextureEntry;

MaterialTables makeMaterialTables(const gltf::Scene& scene, const MaterialLayout& layout) {
    MaterialTables tables;
    std::map<std::tuple<std::uint32_t, std::uint16_t, TextureEntry::Dimension>, std::uint32_t> indexOf;
    for (const materials::Material& material : scene.materials) {
        std::vector<std::uint8_t> record = makeMaterialRecord(material, layout);
        for (const auto& [i, info] : material.textures) {
            if (info.texture < 0) {
                continue;
            }
            // A texture that no key reads is in the tables all the same, so that images keep their numbers.
            const gltf::Texture& texture = scene.textures[static_cast<std::size_t>(info.texture)];
            const bool isColor = material.isColor(static_cast<int>(i));
            const TextureEntry entry{static_cast<std::uint32_t>(texture.image),
                                     static_cast<std::uint16_t>(isColor ? 1 : 0),
                                     layout.model->textures[i].dimension};
            const auto [place, isNew] =
                indexOf.try_emplace({entry.image, entry.srgb, entry.dimension},
                                    static_cast<std::uint32_t>(tables.textures.size()));
            if (isNew) {
                tables.textures.push_back(entry);
            }
            const int slot = layout.slotOf(static_cast<int>(i), modelOf(material));
            if (slot < 0) {
                continue;
            }
            std::uint8_t* const target =
                &record[layout.textureOffset + static_cast<std::size_t>(slot) * sizeof(gpu::TextureRecord)];
            gpu::TextureRecord settled{};
            std::memcpy(&settled, target, sizeof settled);
            settled.textureIndex = place->second;
            settled.samplerIndex = static_cast<std::uint32_t>(texture.sampler);
            settled.texCoord = static_cast<std::uint32_t>(info.texCoord);
            std::memcpy(target, &settled, sizeof settled);
        }
        tables.materials.insert(tables.materials.end(), record.begin(), record.end());
    }
    return tables;
}

}  // namespace glint::compiler
