#include "emit/modules.h"

#include "emit/context.h"
#include "emit/effects.h"
#include "emit/glsl/prune.h"
#include "emit/lights.h"
#include "emit/material_code.h"
#include "scene/deformed.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>

namespace glint::compiler {

using package::ModuleRole;

namespace {

// File systems allow names of 255 bytes. The shader ID alone already makes a name unique.
constexpr std::size_t kMaxCaseNameLength = 100;

// Sources for an ordering that has passes of its own.
constexpr std::pair<ModuleRole, std::string_view> kTileSortSources[] = {
    {ModuleRole::BucketCount, "passes/bucket_count_tile_sort.comp"},
    {ModuleRole::BucketCopy, "passes/bucket_copy_tile_sort.comp"},
};

std::string_view sourceOf(const package::RoleInfo& info, const package::ModuleKey& key,
                          const materials::MaterialModel& model) {
    if (key.role == ModuleRole::EffectWalk) {
        return model.effects[key.index].walk;
    }
    const bool sortsTiles = info.repeated == package::Repeated::ByOrdering &&
                            key.index == static_cast<std::uint32_t>(package::Ordering::TileSort);
    return sortsTiles ? std::ranges::find(kTileSortSources, key.role,
                                          &std::pair<ModuleRole, std::string_view>::first)
                            ->second
                      : info.source;
}

ShaderStage stageOf(const package::RoleInfo& info, std::uint32_t tracer) {
    switch (info.kind) {
        case package::ShaderKind::Vertex:
            return ShaderStage::Vertex;
        case package::ShaderKind::Fragment:
            return ShaderStage::Fragment;
        case package::ShaderKind::Compute:
            return ShaderStage::Compute;
        case package::ShaderKind::Tracing:
        case package::ShaderKind::Shading:
            return tracer == package::kTracerRayPipeline ? ShaderStage::RayGeneration : ShaderStage::Compute;
        case package::ShaderKind::RayGeneration:
            return ShaderStage::RayGeneration;
        case package::ShaderKind::ClosestHit:
            return ShaderStage::ClosestHit;
        case package::ShaderKind::AnyHit:
            return ShaderStage::AnyHit;
        case package::ShaderKind::Miss:
            return ShaderStage::Miss;
    }
    return ShaderStage::Compute;
}

constexpr std::string_view kTemplateSuffix = ".mustache";
constexpr std::string_view kComputeExtension = ".comp";

// "passes/lighting.comp" gives lighting.comp, or lighting.rgen if it is a ray generation shader. If a role
// has several modules, the name says which one it is.
std::string moduleName(std::string_view source, const package::RoleInfo& info, const package::ModuleKey& key,
                       std::string_view caseName, const materials::MaterialModel& model) {
    std::string name(source.substr(source.rfind('/') + 1));
    if (name.ends_with(kTemplateSuffix)) {
        name.resize(name.size() - kTemplateSuffix.size());
    }
    const std::size_t dot = name.rfind('.');
    std::string extension = name.substr(dot);
    name.resize(dot);
    if (info.repeated == package::Repeated::ByCase) {
        // "shade_case" gives shade_2_BaseTex.
        name.resize(name.rfind('_') + 1);
        name += fmt::format("{}_{}", key.index, caseName.substr(0, kMaxCaseNameLength));
    } else if (info.repeated == package::Repeated::ByOrdering) {
        std::string ordering = fmt::format("_{}", package::nameOf(static_cast<package::Ordering>(key.index)));
        std::ranges::replace(ordering, '-', '_');
        if (!name.ends_with(ordering)) {
            name += ordering;
        }
    } else if (info.repeated == package::Repeated::ByEffect) {
        // "effect_rays" gives reflection_rays.
        name.replace(0, name.find('_'), model.effects[key.index].file());
    } else if (info.repeated == package::Repeated::ByWalk) {
        name = model.effects[key.index].file() + "_walk";
    } else if (info.purpose == package::Purpose::Fallback) {
        // "shade_case" gives shade_fallback, "sky" would give sky_fallback.
        constexpr std::string_view kCase = "_case";
        name.resize(name.size() - (name.ends_with(kCase) ? kCase.size() : 0));
        name += "_fallback";
    }
    if (extension == kComputeExtension && stageOf(info, key.tracer) == ShaderStage::RayGeneration) {
        extension = ".rgen";
    }
    return name + extension;
}

// Returns the macros about the module itself, which precede the rest of its text.
std::string moduleDefines(const package::RoleInfo& info, const package::ModuleKey& key,
                          package::ShadingPrecision precision) {
    std::string defines;
    if (precision == package::ShadingPrecision::Half) {
        // Without these, values without a precision take that of their neighbours, even mediump.
        defines += "precision highp float;\nprecision highp int;\n";
    }
    const ShaderStage stage = stageOf(info, key.tracer);
    if (stage != ShaderStage::Vertex && stage != ShaderStage::Fragment) {
        defines += fmt::format("#define GLINT_TRACER {}\n#define GLINT_RAY_GENERATION {}\n", key.tracer,
                               stage == ShaderStage::RayGeneration ? 1 : 0);
    }
    if (info.repeated == package::Repeated::ByOrdering) {
        defines += fmt::format("#define GLINT_ORDERING {}\n", key.index);
    }
    return defines;
}

// Inserts the macros after the line of #version, which must come first.
void insertDefines(std::string& text, const std::string& defines) {
    if (!defines.empty()) {
        text.insert(text.find('\n') + 1, defines + "#line 2\n");
    }
}

// Files of `own` stand in for those of `sources` that have their names.
Result<ModuleSource> makeModule(std::string_view source, const package::ModuleKey& key,
                                std::string_view caseName, const SourceSet& sources, const SourceSet& own,
                                const kainjow::mustache::data& context, const materials::MaterialModel& model,
                                package::ShadingPrecision precision, WarmModules* warm) {
    const package::RoleInfo& info = *package::findRole(key.role);
    ModuleSource module{
        key, stageOf(info, key.tracer), moduleName(source, info, key, caseName, model), {}, {}, {}};
    std::string text;
    std::string origin(source);
    if (source.ends_with(kTemplateSuffix)) {
        Result<std::string> rendered = renderTemplate(sources, source, context);
        if (!rendered) {
            return rendered.error();
        }
        text = std::move(*rendered);
        origin = module.name;
    } else if (const std::optional<std::string_view> found = sources.find(source)) {
        text = *found;
    } else {
        return makeError("source-include", origin, "there is no such shader");
    }
    insertDefines(text, moduleDefines(info, key, precision));
    const auto lookup = [&](std::string_view name) {
        const std::optional<std::string_view> found = own.find(name);
        return found ? found : sources.find(name);
    };
    if (warm == nullptr) {
        const Result<GlslUnit> flattened = flatten(origin, text, lookup, FlattenSide::Glsl);
        if (!flattened) {
            return flattened.error();
        }
        module.glsl = dropUnused(*flattened);
        return module;
    }
    module.warm = warm->findGlsl(origin, text, lookup);
    if (!module.warm) {
        const SourceLookup plain = lookup;
        WarmModules::Reader reader(plain);
        const Result<GlslUnit> flattened = flatten(origin, text, reader.recording(), FlattenSide::Glsl);
        if (!flattened) {
            return flattened.error();
        }
        GlslUnit unit = dropUnused(*flattened);
        std::string essential = essentialText(unit.text());
        module.warm =
            std::make_shared<const PreparedGlsl>(PreparedGlsl{std::move(unit), std::move(essential)});
        warm->putGlsl(origin, text, reader, module.warm);
    }
    module.glsl = module.warm->unit;
    return module;
}

// Returns the switch of shaders that have the fallback alone.
Result<std::string> fallbackCases(const SourceSet& sources, kainjow::mustache::data context) {
    context.set("cases", kainjow::mustache::data(kainjow::mustache::data::type::list));
    return renderTemplate(sources, "cases.glsl.mustache", context);
}

std::vector<std::uint32_t> retiredIds(const Plan& plan) {
    std::vector<std::uint32_t> ids;
    for (const Case& shaderCase : plan.cases) {
        if (shaderCase.isRetired()) {
            ids.push_back(static_cast<std::uint32_t>(shaderCase.shaderId));
        }
    }
    return ids;
}

}  // namespace

package::PackageShape shapeOf(const gltf::SceneList& scenes, const Plan& plan,
                              const CompileSettings& settings) {
    return {settings.strategies,
            settings.tracers,
            settings.shadows,
            plan.effects.effects,
            settings.plan.keys.alpha != package::AlphaPolicy::Opaque,
            static_cast<std::uint32_t>(plan.cases.size()),
            retiredIds(plan),
            std::ranges::any_of(scenes.scenes(), hasDeformedMesh),
            settings.passes,
            settings.maxBounces,
            settings.plan.fallback,
            settings.shadowThrough != package::ShadowThrough::Alpha};
}

Result<std::vector<ModuleSource>> makeModuleSources(const gltf::SceneList& scenes, const Plan& plan,
                                                    const SourceSet& sources, const CompileSettings& settings,
                                                    WarmModules* warm) {
    kainjow::mustache::data context = makeContext(scenes, plan, settings.plan);
    MaterialCodeOfCases codeOfCases(sources, *plan.model);
    // Every case evaluates what emissive lights emit.
    materials::FeatureMask ofEmitters = 0;
    if (settings.emissiveLights == EmissiveLights::On) {
        const EmitterFeatures features = emitterFeatures(scenes, plan);
        ofEmitters = features.always | features.sometimes;
    }
    const SourceSet none;
    const Case fallback = fallbackCase(plan);
    SourceSet fallbackSwitch;  // the switch of shaders that have the fallback alone
    if (settings.plan.fallback) {
        Result<std::string> text = fallbackCases(sources, context);
        if (!text) {
            return text.error();
        }
        fallbackSwitch.add("generated/cases.glsl", std::move(*text));
    }
    std::vector<ModuleSource> modules;
    for (const package::ModuleKey& key : package::requiredModules(shapeOf(scenes, plan, settings))) {
        const package::RoleInfo& info = *package::findRole(key.role);
        const bool ofCase = info.repeated == package::Repeated::ByCase;
        const bool ofSwitch = info.hasSwitch();
        const bool ofFallback = info.purpose == package::Purpose::Fallback;
        const SourceSet* own = ofFallback && ofSwitch ? &fallbackSwitch : &none;
        if (ofCase || (ofFallback && !ofSwitch)) {
            const Case& shaderCase = ofCase ? plan.cases[key.index] : fallback;
            addCase(context, scenes, *plan.model, shaderCase);
            context.set("skipsMisses", ofFallback);
            Result<const SourceSet*> code =
                codeOfCases.find(shaderCase.always | shaderCase.sometimes | ofEmitters);
            if (!code) {
                return code.error();
            }
            own = *code;
        } else if (key.role == ModuleRole::EffectRays) {
            addEffect(context, *plan.model, plan.effects.effects, key.index);
        }
        Result<ModuleSource> module = makeModule(
            sourceOf(info, key, *plan.model), key, ofCase ? std::string_view(plan.cases[key.index].name) : "",
            sources, *own, context, *plan.model, settings.precision, warm);
        if (!module) {
            return module.error();
        }
        if (ofSwitch) {
            for (const Case& shaderCase : plan.cases) {
                if (!ofFallback && !shaderCase.isRetired()) {
                    module->functionsApart.push_back("shade" + shaderCase.name);
                }
            }
            if (settings.plan.fallback) {
                module->functionsApart.push_back("shade" + fallback.name);
            }
        }
        modules.push_back(std::move(*module));
    }
    return modules;
}

}  // namespace glint::compiler
