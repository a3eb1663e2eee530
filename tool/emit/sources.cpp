#include "base/files.h"
#include "emit/context.h"
#include "emit/material_code.h"
#include "emit/material_layout.h"
#include "emit/source_set.h"
#include "resolve/build.h"
#include "resolve/host.h"
#include "scene/deformed.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string_view>
#include <utility>

namespace glint::compiler {

std::uint64_t sourceNumber(std::string_view file, std::string_view item) {
    const std::uint64_t number = base::hashBytes(file);
    return item.empty() ? number : base::hashBytes(base::asBytes(item), number);
}

SourceSet::File& SourceSet::addFile(std::string name, std::string text) {
    File& file = files_[std::move(name)];
    file = {std::make_unique<const std::string>(std::move(text))};
    return file;
}

void SourceSet::add(std::string name, std::string text) {
    marks_[sourceNumber(name)] = base::hashBytes(text);
    addFile(std::move(name), std::move(text));
}

void SourceSet::addItems(std::string name, std::string text) {
    const std::uint64_t number = sourceNumber(name);
    File& file = addFile(name, std::move(text));
    Items& items = file.items.emplace();
    std::string rest;
    for (GlslItem& item : splitGlsl(*file.text)) {
        if (item.kind == GlslItemKind::Blank || item.kind == GlslItemKind::Comment) {
            continue;
        }
        const auto [known, isFirst] = items.try_emplace(item.name);
        known->second.insert(known->second.end(), item.words.begin(), item.words.end());
        rest += item.name.empty() ? item.text : item.name;
        rest += '\n';
        if (!item.name.empty()) {
            // Several items may have one name.
            std::uint64_t& mark = marks_[sourceNumber(name, item.name)];
            mark = base::hashBytes(base::asBytes(item.text), isFirst ? number : mark);
        }
    }
    marks_[number] = base::hashBytes(rest);
}

std::optional<std::string_view> SourceSet::find(std::string_view name) const {
    const auto place = files_.find(name);
    return place == files_.end() ? std::nullopt : std::optional<std::string_view>(*place->second.text);
}

const SourceSet::Items* SourceSet::itemsOf(std::string_view name) const {
    const auto place = files_.find(name);
    return place == files_.end() || !place->second.items ? nullptr : &*place->second.items;
}

std::optional<std::uint64_t> SourceSet::markOf(std::uint64_t source) const {
    const auto place = marks_.find(source);
    return place == marks_.end() ? std::nullopt : std::optional(place->second);
}

SourceLookup SourceSet::lookup() const {
    return [this](std::string_view name) { return find(name); };
}

namespace {

constexpr std::string_view kInteropFolder = "interop/";
// The files of generated/ that are made from templates.
constexpr std::string_view kGenerated[] = {"effects.glsl",     "skip_effects.glsl", "compose_effects.glsl",
                                           "hit_effects.glsl", "sky_layers.glsl",   "surface_layers.glsl",
                                           "tallies.glsl"};

void defineFeatures(std::string& text, std::string_view prefix, const materials::MaterialModel& model,
                    const materials::FeatureMask& always, const materials::FeatureMask& sometimes) {
    const auto [least, some] = model.caseWords(always, sometimes);
    text += fmt::format("#define {}_ALWAYS_LOBES {:#x}u\n", prefix, least.lobes);
    text += fmt::format("#define {}_ALWAYS_INPUTS {:#x}u\n", prefix, least.inputs);
    text += fmt::format("#define {}_SOMETIMES_LOBES {:#x}u\n", prefix, some.lobes);
    text += fmt::format("#define {}_SOMETIMES_INPUTS {:#x}u\n", prefix, some.inputs);
    text += fmt::format("#define {}_MODEL {:#x}u\n", prefix, least.model);
    // The members of Features that a case knows.
    text += fmt::format("#define {}_ALL {}\n", prefix, caseFeatures(least, some));
}

// The dimensions of textures that declarations have beside 2D.
std::string dimensionDefines(const materials::MaterialModel& model) {
    using package::TextureEntry;
    std::string text;
    for (const auto& [name, dimension] : {std::pair("ARRAY", TextureEntry::Dimension::Array),
                                          {"CUBE", TextureEntry::Dimension::Cube},
                                          {"VOLUME", TextureEntry::Dimension::Volume}}) {
        const bool has = std::ranges::find(model.textures, dimension,
                                           &materials::MaterialTexture::dimension) != model.textures.end();
        text += fmt::format("#define GLINT_{}_TEXTURES {}\n", name, has ? 1 : 0);
    }
    return text;
}

// The features that decide about the alpha of a hit.
materials::FeatureMask alphaFeatures(const materials::MaterialModel& model) {
    materials::FeatureMask mask = model.featuresFor(package::Role::BaseColor) |
                                  model.mask(package::Role::VertexColor) | maskCodeFeatures(model);
    for (const materials::Feature& feature : model.features) {
        const bool readForCode =
            feature.lobe >= 0 && mask.has(model.features[static_cast<std::size_t>(feature.lobe)].bit);
        mask |= readForCode ? feature.mask() : 0;
    }
    return mask;
}

std::string bindingDefines(const package::Bindings& bindings) {
    std::string text = "// Where the host binds its resources\n";
    for (const package::NamedBinding& one : package::kBindingNames) {
        std::string name(one.name);
        std::ranges::transform(name, name.begin(), [](char c) {
            return c == '-' ? '_' : c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
        });
        if (bindings.*one.member != package::Bindings::kByAddress) {
            text += fmt::format("#define GLINT_BINDING_{} {}\n", name, bindings.*one.member);
        }
    }
    text += fmt::format("#define GLINT_TLAS_BY_ADDRESS {}\n",
                        bindings.tlas == package::Bindings::kByAddress ? 1 : 0);
    return text;
}

// The features that decide what emissive lights emit.
std::string emitterDefines(const materials::MaterialModel& model, const EmitterFeatures& features) {
    std::string text = "// Emissive lights\n";
    defineFeatures(text, "GLINT_EMITTER", model, features.always, features.sometimes);
    text += fmt::format("#define GLINT_EMITTER_LAYERS {}\n", features.coveredByLayers ? 1 : 0);
    return text;
}

std::string sceneDefines(const gltf::SceneList& scenes, const Plan& plan, const CompileSettings& settings) {
    const auto has = [&](materials::AlphaMode mode) {
        return std::ranges::any_of(scenes.materials(), [mode](const materials::Material& material) {
            return material.alphaMode == mode;
        });
    };
    const package::AlphaPolicy alphaPolicy = settings.plan.keys.alpha;
    const bool hasBlended =
        alphaPolicy == package::AlphaPolicy::Stochastic && has(materials::AlphaMode::Blend);
    const bool hasMasked = has(materials::AlphaMode::Mask) || hasBlended;
    const auto flag = [](bool value) { return value ? 1 : 0; };
    const materials::FeatureMask used = usedFeatures(plan);
    std::string text = "// The scene as a whole: features of every primary surface, and of some.\n";
    defineFeatures(text, "GLINT", *plan.model, plan.primaryAlways, plan.primarySometimes);
    text += "// The same of hits, which may keep fewer lobes.\n";
    defineFeatures(text, "GLINT_HIT", *plan.model, plan.always, plan.sometimes);
    // These macros are separate, so that other features of a scene do not change modules that test alpha.
    text += "// What the alpha test of rays needs of the same.\n";
    const bool passesGlass = settings.shadowThrough == package::ShadowThrough::Glass;
    const materials::FeatureMask alpha =
        alphaPolicy != package::AlphaPolicy::Opaque ? alphaFeatures(*plan.model) : 0;
    // Shadow rays that pass glass read what glass is made of, whatever hits keep.
    defineFeatures(text, "GLINT_ALPHA", *plan.model, passesGlass ? plan.primaryAlways : plan.always & alpha,
                   passesGlass ? plan.primarySometimes : plan.sometimes & alpha);
    text += "// Some key is of a model that a pack declares. Features of such models take so many words.\n";
    text += fmt::format("#define GLINT_USES_MODELS {}\n", flag(used != used.shared()));
    text += fmt::format("#define GLINT_OWN_WORDS {}\n", plan.model->ownWordCount(used));
    text += "// Settings\n";
    text += fmt::format("#define GLINT_ALPHA_TESTED {}\n", flag(alphaPolicy != package::AlphaPolicy::Opaque));
    text += fmt::format("#define GLINT_BLENDED {}\n", flag(hasBlended));
    text += fmt::format("#define GLINT_SHADOW_GLASS {}\n", flag(passesGlass));
    text += fmt::format("#define GLINT_SHADOW_OPAQUE {}\n",
                        flag(settings.shadowThrough == package::ShadowThrough::Opaque));
    text += fmt::format("#define GLINT_ENERGY_COMPENSATION {}\n", flag(settings.energyCompensation));
    text +=
        fmt::format("#define GLINT_TEXTURE_LOD_CONES {}\n", flag(settings.textureLod == TextureLod::Cones));
    text += dimensionDefines(*plan.model);
    text += fmt::format("#define GLINT_PRECISION {}\n", package::bitsOf(settings.precision));
    // The precision of values that keep their meaning in 16 bits.
    text += fmt::format("#define GLINT_RELAXED{}\n",
                        settings.precision == package::ShadingPrecision::Half ? " mediump" : "");
    text += fmt::format("#define GLINT_SHADOWS_DEFERRED {}\n",
                        flag(settings.shadows == package::ShadowPlacement::Deferred));
    text +=
        "// The shadow rays of a first hit that wait for a pass of their own; 0: they are traced inline.\n";
    const package::PackageShape shape = shapeOf(scenes, plan, settings);
    text += fmt::format("#define GLINT_FIRST_SHADOW_RAYS {}\n",
                        shape.defersFirstShadows() ? shape.firstShadowRays : 0);
    text += fmt::format("#define GLINT_HIT_RECORD_PACKED {}\n",
                        flag(settings.hitRecord == package::HitRecordFormat::Packed));
    const bool packsSamples = settings.sampleRecord == package::SampleRecordFormat::Packed &&
                              settings.passes == package::Passes::Frame;
    text += fmt::format("#define GLINT_SAMPLE_RECORD_PACKED {}\n", flag(packsSamples));
    text += fmt::format("#define GLINT_ENVIRONMENT_MAP {}\n", flag(settings.environmentMap));
    text += fmt::format("#define GLINT_POSITION_FETCH {}\n", flag(settings.positionFetch));
    text += fmt::format("#define GLINT_LIGHT_SAMPLES {}\n", settings.lightSamples.value_or(0));
    const bool emissive = settings.emissiveLights == EmissiveLights::On;
    text += fmt::format("#define GLINT_EMISSIVE_LIGHTS {}\n", flag(emissive));
    const bool sky = settings.skyLight == SkyLight::On;
    text += fmt::format("#define GLINT_SKY_LIGHT {}\n", flag(sky));
    const bool sized = settings.sizedLights == SizedLights::On;
    text += fmt::format("#define GLINT_SIZED_LIGHTS {}\n", flag(sized));
    text += fmt::format("#define GLINT_DISK_LIGHTS {}\n", flag(settings.diskLights == DiskLights::On));
    text += "// Some lights are found by rays of lobes, too.\n";
    text += fmt::format("#define GLINT_SHARED_LIGHTS {}\n", flag(emissive || sky || sized));
    if (emissive) {
        text += emitterDefines(*plan.model, plan.emitters);
    }
    text += fmt::format("#define GLINT_STEPS {}\n", flag(settings.passes == package::Passes::Steps));
    text += fmt::format("#define GLINT_ANSWERS_SURFACE {}\n",
                        flag(settings.answer == package::HitAnswer::Surface));
    const bool paths = package::hasPaths(shape);
    text += fmt::format("#define GLINT_PATHS {}\n", flag(paths));
    text += "// The record of a sample holds what its ray hit, in the place of the ray's start.\n";
    text += fmt::format("#define GLINT_HITS_IN_SAMPLES {}\n", flag(packsSamples && !paths && !emissive));
    text += fmt::format("#define GLINT_FALLBACK {}\n", flag(settings.plan.fallback));
    text += fmt::format("#define GLINT_TEXTURE_LEVELS {}\n", flag(settings.textureLevels));
    text += fmt::format("#define GLINT_SKY_LIGHT_MEMBERS {}\n", flag(sky || !plan.layers.empty()));
    text += layerDefines(plan, std::ranges::any_of(scenes.scenes(), hasDeformedMesh), sized);
    text += bindingDefines(settings.bindings);
    text += effectDefines(*plan.model, plan.effects.effects);
    text += fmt::format("#define GLINT_MAY_MASK {}\n", flag(hasMasked));
    const bool hasMaskCode =
        (maskCodeFeatures(*plan.model) & (plan.primaryAlways | plan.primarySometimes)) != 0;
    text += fmt::format("#define GLINT_MASK_STAGES {}\n", flag(hasMasked && hasMaskCode));
    return text;
}

// Returns the number of buckets that shaders have room for: that of misses and one for each case, rounded up,
// so that modules stay as they are when there is one case more.
std::size_t mostBuckets(std::size_t cases) {
    constexpr std::size_t kStep = 8;
    return (1 + cases + kStep - 1) / kStep * kStep;
}

std::optional<std::string_view> findEmbedded(std::string_view name) {
    for (const base::BuiltinFile& file : builtinFiles()) {
        if (file.name == name) {
            return file.text;
        }
    }
    return std::nullopt;
}

// Puts the files of the host's folder into `sources`. Messages about them name their paths. Has the errors of
// hostFiles() and readFile().
Status addHost(SourceSet& sources, const std::string& folder) {
    constexpr std::uint64_t kMostBytes = 16ULL << 20;
    GLINT_TRY(const auto files, hostFiles(folder));
    for (const std::filesystem::path& file : files) {
        GLINT_TRY(const auto bytes, base::readFile(file, kMostBytes));
        const std::filesystem::path inner = file.lexically_relative(folder);
        const std::string name =
            (inner.has_parent_path() ? std::string() : std::string("host/")) + inner.generic_string();
        // The name that shaders include leads to the file under its own path, which messages then name. Such
        // a path must not be the name of another file of Glint's.
        const std::string path = file.generic_string();
        const std::string shown = path != name && sources.find(path) ? "./" + path : path;
        sources.add(name, fmt::format("#include \"{}\"\n", shown));
        sources.add(shown, std::string(base::asText(bytes)));
    }
    return okStatus();
}

}  // namespace

Result<SourceSet> makeSourceSet(const gltf::SceneList& scenes, const Plan& plan,
                                const CompileSettings& settings) {
    SourceSet sources;
    for (const base::BuiltinFile& file : builtinFiles()) {
        sources.add(std::string(file.name), std::string(file.text));
    }
    for (const materials::ModelSource& source : plan.model->sources) {
        sources.add(source.name, source.text);
    }
    GLINT_TRY_DO(addHost(sources, settings.host));
    const materials::FeatureMask used = usedFeatures(plan);
    // Modules of cases have their own forms of these files if packs have models, which may be many.
    const auto addOfModels = [&](const char* name, std::string text) {
        plan.model->models.empty() ? sources.addItems(name, std::move(text))
                                   : sources.add(name, std::move(text));
    };
    addOfModels("generated/features.glsl", plan.model->featureDefines(used));
    addOfModels("generated/material_record.glsl", recordDeclarations(materialLayoutOf(plan), used));
    const bool surface = settings.answer == package::HitAnswer::Surface;
    sources.add("generated/answer.glsl",
                fmt::format("#include \"hit/answer_{}.glsl\"\n", package::nameOf(settings.answer)));
    sources.add("generated/shade.glsl",
                fmt::format("#include \"hit/{}.glsl\"\n", surface ? "shade_surface" : "shade"));
    sources.addItems("generated/scene.glsl", sceneDefines(scenes, plan, settings));
    sources.add("generated/most_buckets.glsl",
                fmt::format("#define GLINT_MOST_BUCKETS {}\n", mostBuckets(plan.cases.size())));
    GLINT_TRY_DO(addMaterialCode(sources, *plan.model, used, sources));
    GLINT_TRY_DO(addMaskCode(sources, *plan.model, used, sources));
    sources.add("generated/attributes.glsl", vertexAttributeCode(*plan.model, used));
    kainjow::mustache::data context = makeContext(scenes, settings.plan);
    addEffects(context, plan);
    addLayers(context, plan);
    for (const std::string_view name : kGenerated) {
        GLINT_TRY(auto text, renderTemplate(sources, fmt::format("{}.mustache", name), context));
        sources.add(fmt::format("generated/{}", name), std::move(text));
    }
    return sources;
}

Result<std::string> interopDeclarations() {
    std::string root;
    for (const base::BuiltinFile& file : builtinFiles()) {
        if (file.name.starts_with(kInteropFolder)) {
            root += fmt::format("#include \"{}\"\n", file.name);
        }
    }
    const Result<GlslUnit> declarations = flatten("interop", root, findEmbedded, FlattenSide::Cpp);
    return declarations ? Result<std::string>(declarations->text()) : declarations.error();
}

std::uint64_t interopSourceHash() {
    std::string all;
    for (const base::BuiltinFile& file : builtinFiles()) {
        if (file.name.starts_with(kInteropFolder)) {
            all += file.name;
            all += '\n';
            all += file.text;
        }
    }
    return base::hashBytes(all);
}

}  // namespace glint::compiler
