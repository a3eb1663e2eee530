#include "emit/modules.h"

#include "emit/context.h"
#include "emit/material_code.h"
#include "emit/source_set.h"
#include "emit/warm_modules.h"
#include "gltf/scene_list.h"
#include "plan/plan.h"
#include "resolve/build.h"
#include "settings/settings.h"

#include <glint/result.h>

#include <fmt/format.h>
#include <kainjow/mustache.hpp>

#include <algorithm>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace glint::compiler {

namespace {

// --- The parts of shaders that choose among cases: the entry point with the switch, and each case by itself
// ---

constexpr std::string_view kSwitchFile = "generated/cases.glsl";
constexpr std::string_view kEmitterFile = "light/emitter.glsl";
constexpr std::string_view kSwitchTemplate = "cases.glsl.mustache";
constexpr std::string_view kPartTemplate = "case_part.comp.mustache";
// A case's part knows its own features only, as the case's shader of the strategy `visibility` does, and
// traces no ray. So it is the same for every strategy and tracer.
class SwitchParts {
public:
    // All of them must outlive this. `context` is that of makeContext(). `ofEmitters`: features that every
    // case evaluates.
    SwitchParts(const kainjow::mustache::data& context, const gltf::SceneList& scenes, const Plan& plan,
                const SourceSet& sources, const CompileSettings& settings, ModuleDrafts& drafts,
                MaterialCodeOfCases& codeOfCases, materials::FeatureMask ofEmitters)
        : context_(context),
          scenes_(scenes),
          plan_(plan),
          sources_(sources),
          settings_(settings),
          drafts_(drafts),
          codeOfCases_(codeOfCases),
          ofEmitters_(std::move(ofEmitters)) {}

    // Returns the switch with the code of its cases: all of them, or the fallback alone. Has the errors of
    // renderTemplate().
    Result<std::shared_ptr<const SourceSet>> wholeSwitch(bool fallbackAlone) {
        if (whole_[0] == nullptr) {
            GLINT_TRY_DO(makeSwitches());
        }
        return whole_[fallbackAlone ? 1 : 0];
    }
    // Adds the parts of a module whose text is `text`. Has the errors of renderTemplate().
    Status addTo(ModuleSource& module, const std::string& origin, const std::string& text,
                 bool fallbackAlone) {
        std::vector<Case> cases;
        if (!fallbackAlone) {
            for (const Case& shaderCase : plan_.cases) {
                if (!shaderCase.isRetired()) {
                    cases.push_back(shaderCase);
                }
            }
        }
        if (settings_.plan.fallback) {
            cases.push_back(fallbackCase(plan_));
        }
        if (cases.empty()) {
            return okStatus();
        }
        std::vector<std::shared_ptr<const ModuleSource>> parts;
        for (const Case& shaderCase : cases) {
            GLINT_TRY(auto part, partOf(shaderCase));
            module.functionsApart.push_back(part->link->exported.front());
            parts.push_back(std::move(part));
        }
        const std::shared_ptr<ModuleSource> head = makeHead(module, module.functionsApart);
        module.parts.push_back(head);
        std::ranges::move(parts, std::back_inserter(module.parts));
        drafts_.add(head, origin, text, head_[fallbackAlone ? 1 : 0]);
        return okStatus();
    }

private:
    Status makeSwitches() {
        kainjow::mustache::data context = context_;
        addCases(context, scenes_, plan_, settings_.plan);
        for (const bool fallbackAlone : {false, true}) {
            if (fallbackAlone) {
                context.set("cases", kainjow::mustache::data(kainjow::mustache::data::type::list));
            }
            for (const bool apart : {false, true}) {
                context.set("apart", apart);
                GLINT_TRY(auto text, renderTemplate(sources_, kSwitchTemplate, context));
                const auto to = std::make_shared<SourceSet>();
                to->add(std::string(kSwitchFile), std::move(text));
                if (apart && settings_.emissiveLights != EmissiveLights::On) {
                    // The emission of lights is the only code of materials that the switch would have, and an
                    // edit of that code would change the switch.
                    to->add(std::string(kEmitterFile), "");
                }
                (apart ? head_ : whole_)[fallbackAlone ? 1 : 0] = to;
            }
        }
        return okStatus();
    }

    Result<std::shared_ptr<const ModuleSource>> partOf(const Case& shaderCase) {
        const std::string function = "shade" + shaderCase.name;
        std::shared_ptr<const ModuleSource>& made = made_[function];
        if (made) {
            return made;
        }
        GLINT_TRY(auto code,
                  codeOfCases_.find(sources_, shaderCase.always | shaderCase.sometimes | ofEmitters_));
        kainjow::mustache::data context = context_;
        addCase(context, scenes_, *plan_.model, shaderCase);
        GLINT_TRY(auto text, renderTemplate(sources_, kPartTemplate, context));
        insertPartDefines(text, settings_.precision);
        const std::shared_ptr<ModuleSource> part = makePart(function + ".part", {function});
        if (settings_.emissiveLights == EmissiveLights::On) {
            // It shades a point on an emissive triangle, whatever the case. Inlined, it would be a quarter of
            // each case; apart, it is equal in all parts, and the joined shader has it once.
            part->functionsApart.emplace_back("sampleEmitter");
        }
        drafts_.add(part, part->name, std::move(text), std::move(code));
        made = part;
        return made;
    }

    const kainjow::mustache::data context_;
    const gltf::SceneList& scenes_;
    const Plan& plan_;
    const SourceSet& sources_;
    const CompileSettings& settings_;
    ModuleDrafts& drafts_;
    MaterialCodeOfCases& codeOfCases_;
    materials::FeatureMask ofEmitters_;
    std::shared_ptr<const SourceSet> whole_[2];
    std::shared_ptr<const SourceSet> head_[2];                         // switches whose cases have no code
    std::map<std::string, std::shared_ptr<const ModuleSource>> made_;  // by the function's name
};
}  // namespace

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

// "passes/trace.comp" gives trace.comp, or trace.rgen if it is a ray generation shader. If a role
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
        for (const std::string_view ofCase : {"_case", "_hit"}) {
            name.resize(name.size() - (name.ends_with(ofCase) ? ofCase.size() : 0));
        }
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
    std::string defines = precisionDefines(precision);
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

// Returns the text of a shader or of a template, with the macros about the module itself.
Result<std::string> makeText(std::string_view source, const std::string& defines, const SourceSet& sources,
                             const kainjow::mustache::data& context) {
    std::string text;
    if (source.ends_with(kTemplateSuffix)) {
        Result<std::string> rendered = renderTemplate(sources, source, context);
        if (!rendered) {
            return rendered;
        }
        text = std::move(*rendered);
    } else if (const std::optional<std::string_view> found = sources.find(source)) {
        text = *found;
    } else {
        return makeError("source-include", std::string(source), "there is no such shader");
    }
    insertDefines(text, defines);
    return text;
}

// Every module that shades surfaces evaluates what emissive lights emit.
materials::FeatureMask emitterMask(const Plan& plan, const CompileSettings& settings) {
    return settings.emissiveLights == EmissiveLights::On ? plan.emitters.always | plan.emitters.sometimes : 0;
}

}  // namespace

Result<std::vector<ModuleSource>> makeModuleSources(const gltf::SceneList& scenes, const Plan& plan,
                                                    const std::shared_ptr<const SourceSet>& sources,
                                                    const CompileSettings& settings,
                                                    const KnownModules& known) {
    kainjow::mustache::data context = makeContext(scenes, settings.plan);
    WarmModules own;
    WarmModules& warm = known.warm != nullptr ? *known.warm : own;
    MaterialCodeOfCases& codeOfCases = warm.codeOfCases(plan);
    const materials::FeatureMask ofEmitters = emitterMask(plan, settings);
    const auto none = std::make_shared<const SourceSet>();
    const Case fallback = fallbackCase(plan);
    const Case draft = draftCase(plan);
    ModuleDrafts drafts(sources, warm, known.cache, known.makesAll);
    SwitchParts parts(context, scenes, plan, *sources, settings, drafts, codeOfCases, ofEmitters);
    std::vector<std::shared_ptr<ModuleSource>> modules;
    for (const package::ModuleKey& key : package::requiredModules(shapeOf(scenes, plan, settings))) {
        const package::RoleInfo& info = *package::findRole(key.role);
        const bool ofCase = info.repeated == package::Repeated::ByCase;
        const bool ofSwitch = info.hasSwitch();
        const bool ofFallback = info.purpose == package::Purpose::Fallback;
        std::shared_ptr<const SourceSet> ofModule = none;
        if (ofSwitch) {
            GLINT_TRY(ofModule, parts.wholeSwitch(ofFallback));
        }
        const bool ofDraft = info.purpose == package::Purpose::Draft;
        if (ofCase || ofDraft || (ofFallback && !ofSwitch)) {
            const Case& hitCase = ofCase ? plan.cases[key.index] : ofDraft ? draft : fallback;
            const Case shaderCase = info.shadesFirst() ? firstCase(plan, hitCase) : hitCase;
            addCase(context, scenes, *plan.model, shaderCase);
            context.set("skipsMisses", ofFallback);
            GLINT_TRY(ofModule,
                      codeOfCases.find(*sources, shaderCase.always | shaderCase.sometimes | ofEmitters));
        } else if (key.role == ModuleRole::EffectRays) {
            addEffect(context, *plan.model, plan.effects.effects, key.index);
        }
        const std::string_view source = sourceOf(info, key, *plan.model);
        GLINT_TRY(auto text,
                  makeText(source, moduleDefines(info, key, settings.precision), *sources, context));
        const std::string_view caseName = ofCase ? std::string_view(plan.cases[key.index].name) : "";
        auto module = std::make_shared<ModuleSource>();
        module->key = key;
        module->stage = stageOf(info, key.tracer);
        module->name = moduleName(source, info, key, caseName, *plan.model);
        const std::string origin = source.ends_with(kTemplateSuffix) ? module->name : std::string(source);
        // Joining is for optimised parts alone: it takes longer than to fold the whole.
        if (ofSwitch && settings.optimize) {
            GLINT_TRY_DO(parts.addTo(*module, origin, text, ofFallback));
        }
        drafts.add(module, origin, std::move(text), std::move(ofModule));
        modules.push_back(std::move(module));
    }
    GLINT_TRY_DO(drafts.finish(settings.jobs));
    std::vector<ModuleSource> made;
    made.reserve(modules.size());
    for (const std::shared_ptr<ModuleSource>& module : modules) {
        made.push_back(std::move(*module));
    }
    return made;
}

}  // namespace glint::compiler
