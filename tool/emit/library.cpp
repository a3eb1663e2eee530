#include "cache/module_cache.h"
#include "emit/compile.h"
#include "emit/context.h"
#include "emit/glsl/passes.h"
#include "emit/material_code.h"
#include "resolve/host.h"
#include "spirv/compiler.h"

#include <fmt/format.h>

#include <iterator>
#include <optional>
#include <regex>
#include <string>
#include <utility>

namespace glint::compiler {

namespace {

namespace mustache = kainjow::mustache;

constexpr std::string_view kTemplate = "library.glsl.mustache";
constexpr std::string_view kHostFile = "library/host.glsl";
constexpr std::string_view kAdapters = "library/host/";

// Puts the library's forms in the place of the files that read resources.
Result<SourceSet> librarySources(const gltf::SceneList& scenes, Plan plan, CompileSettings settings) {
    plan.effects.effects = {};
    plan.layers.clear();
    settings.host.clear();
    settings.precision = package::ShadingPrecision::Single;
    settings.answer = package::HitAnswer::Radiance;
    settings.maxBounces = 1;
    settings.emissiveLights = EmissiveLights::Off;
    settings.skyLight = SkyLight::Off;
    settings.sizedLights = SizedLights::Off;
    Result<SourceSet> sources = makeSourceSet(scenes, plan, settings);
    if (!sources) {
        return sources;
    }
    for (const base::BuiltinFile& file : builtinFiles()) {
        if (file.name.starts_with(kAdapters)) {
            sources->add("host/" + std::string(file.name.substr(kAdapters.size())), std::string(file.text));
        }
    }
    // Nothing of the library asks for samples in memory.
    sources->add("hit/samples.glsl", "");
    // The host has the lights.
    sources->add("light/emitter.glsl", "");
    sources->add("light/shared.glsl", "");
    sources->add("light/receiver.glsl", "");
    return sources;
}

std::string hostText(const SourceSet& sources) {
    return std::string(sources.find(kHostFile).value_or(""));
}

// Returns the text without a macro that stands for nothing.
std::string withoutMacro(std::string text, const std::string& name) {
    const auto drop = [&](const std::string& words) {
        for (std::size_t place = text.find(words); place != std::string::npos;
             place = text.find(words, place)) {
            text.erase(place, words.size());
        }
    };
    drop("#define " + name + "\n");
    drop(name + " ");
    return text;
}

// Joins the library's own text and the declarations of the host, which shaders may have included before.
std::string withHost(std::string text, const std::string& host) {
    constexpr std::string_view kVersion = "#version 460\n";
    text.erase(0, kVersion.size());
    // Shading in 16 bits needs statements that a file that is included can't make.
    text = withoutMacro(std::move(text), "GLINT_RELAXED");
    const std::size_t place = text.find("\n// --- ");
    const std::string code = prefixNames(std::string_view(text).substr(place));
    return text.substr(0, place) +
           "\n#ifdef GLINT_LIBRARY\n#error a shader includes one file of a library of Glint's\n#endif\n"
           "#define GLINT_LIBRARY\n\n" +
           host + code;
}

void setModule(mustache::data& context, const std::string& alwaysLobes, const std::string& alwaysInputs,
               const std::string& anyLobes, const std::string& anyInputs, const std::string& model) {
    context.set("moduleModel", model);
    context.set("moduleAlwaysLobes", alwaysLobes);
    context.set("moduleAlwaysInputs", alwaysInputs);
    context.set("moduleAnyLobes", anyLobes);
    context.set("moduleAnyInputs", anyInputs);
}

// Files of `own` stand in for those of `sources`.
Result<std::string> makeFile(const SourceSet& sources, const SourceSet& own, const mustache::data& context,
                             const std::string& name) {
    GLINT_TRY(const auto rendered, renderTemplate(sources, kTemplate, context));
    const auto lookup = [&](std::string_view file) -> std::optional<std::string_view> {
        if (file == kHostFile) {
            return "";
        }
        const std::optional<std::string_view> found = own.find(file);
        return found ? found : sources.find(file);
    };
    GLINT_TRY(const auto flattened, flatten(name, rendered, lookup, FlattenSide::Glsl));
    return withHost(makeReadable(dropUnused(flattened), ""), hostText(sources));
}

constexpr const char* kExported[] = {"glintSurface",  "glintEvaluate", "glintSample",   "glintDensity",
                                     "glintRadiance", "glintMirror",   "glintRayOrigin"};
// The functions that each case has.
constexpr const char* kOfCase[] = {"surface",  "evaluate", "sample",  "density",
                                   "radiance", "mirror",   "shadeAll"};

// Calls every function, so that none is dropped.
constexpr std::string_view kMain = R"(
layout(local_size_x = 1) in;

void main() {
    vec3 v;
    GlintSurface surface = glintSurface(GlintHit(0u, 0u, vec2(0.0), v, 0.0, 0u));
    v += glintEvaluate(surface, v, v);
    v += glintSample(surface, v, v).weight;
    v += glintDensity(surface, v, v);
    v += glintRadiance(surface).radiance;
    v += glintMirror(surface).weight;
    v += glintShadeAll(surface, v, v, v);
    v += glintRayOrigin(surface, v);
}
)";

// A function of the host, as glint_host.glsl declares it.
struct HostFunction {
    std::string name;
    std::string declaration;  // without the semicolon
    std::string type;
};

std::vector<HostFunction> hostFunctions(const std::string& host) {
    static const std::regex kPrototype(R"((?:^|\n)((\w+) (glintHost\w+)\([^;]*\));)");
    std::vector<HostFunction> functions;
    for (std::sregex_iterator place(host.begin(), host.end(), kPrototype), end; place != end; ++place) {
        functions.push_back({(*place)[3], (*place)[1], (*place)[2]});
    }
    return functions;
}

// Returns the library of all cases as a shader whose main() calls it, and the names for linkers.
std::pair<ShaderSource, LinkNames> linkableSource(const std::string& library, const std::string& host,
                                                  const Plan& plan) {
    ShaderSource source{"glint_library.spv", ShaderStage::Compute, "#version 460\n" + library, {}};
    LinkNames names{{std::begin(kExported), std::end(kExported)}, {}};
    for (const HostFunction& function : hostFunctions(host)) {
        source.glsl +=
            fmt::format("\n{} {{\n    {} none;\n    return none;\n}}\n", function.declaration, function.type);
        names.imported.push_back(function.name);
    }
    source.glsl += kMain;
    for (const Case& shaderCase : plan.cases) {
        if (shaderCase.isRetired()) {
            continue;
        }
        for (const char* const function : kOfCase) {
            source.functionsApart.push_back(fmt::format("glint_{}OfCase{}", function, shaderCase.shaderId));
        }
    }
    return {std::move(source), std::move(names)};
}

// Compiles that, or takes it from the cache, which may be null.
Result<PackageFile> makeLinkableFile(const std::string& library, const std::string& host, const Plan& plan,
                                     bool debugInfo, const ModuleCache* cache) {
    const auto [source, names] = linkableSource(library, host, plan);
    const std::string text = fmt::format("// glint linkable 1\n// names {}\n{}", debugInfo,
                                         debugInfo ? source.glsl : essentialText(source.glsl));
    const TextHash hash = hashOfText(text);
    std::optional<CachedModule> module = cache != nullptr ? cache->find(hash) : std::nullopt;
    if (!module) {
        GLINT_TRY(auto words, compileLinkable(source, names, {debugInfo}));
        module = CachedModule{std::move(words), {}};
        if (cache != nullptr) {
            cache->put(hash, *module);
        }
    }
    const std::span<const std::uint8_t> bytes = module->bytes();
    return PackageFile(std::string(kLibraryFolder) + source.name, base::Bytes(bytes.begin(), bytes.end()));
}

PackageFile fileOf(const std::string& name, std::string_view text) {
    return {std::string(kLibraryFolder) + name, base::Bytes(text.begin(), text.end())};
}

}  // namespace

Result<std::vector<PackageFile>> makeLibrary(const gltf::SceneList& scenes, const Plan& plan,
                                             const CompileSettings& settings, const ModuleCache* cache) {
    GLINT_TRY(const auto sources, librarySources(scenes, plan, settings));
    MaterialCodeOfCases codeOfCases(plan);
    std::vector<PackageFile> files{fileOf("glint_host.glsl", hostText(sources))};
    const auto add = [&](const mustache::data& context, const materials::FeatureMask& features,
                         const std::string& name) -> Status {
        GLINT_TRY(const auto code, codeOfCases.find(sources, features));
        GLINT_TRY(const auto text, makeFile(sources, *code, context, name));
        files.push_back(fileOf(name, text));
        return okStatus();
    };

    mustache::data all = makeContext(scenes, settings.plan);
    addCases(all, scenes, plan, settings.plan);
    all.set("title",
            "// Glint's library: the shading of every case. The shader ID of a hit chooses the case.");
    all.set("isSwitch", mustache::data(true));
    setModule(all, "GLINT_HIT_ALWAYS_LOBES", "GLINT_HIT_ALWAYS_INPUTS",
              "(GLINT_HIT_ALWAYS_LOBES | GLINT_HIT_SOMETIMES_LOBES)",
              "(GLINT_HIT_ALWAYS_INPUTS | GLINT_HIT_SOMETIMES_INPUTS)", "GLINT_HIT_MODEL");
    GLINT_TRY_DO(add(all, plan.always | plan.sometimes, "glint_library.glsl"));
    if (settings.emitLinkable) {
        const std::string text(files.back().bytes.begin(), files.back().bytes.end());
        GLINT_TRY(auto linkable, makeLinkableFile(text, hostText(sources), plan, settings.debugInfo, cache));
        files.push_back(std::move(linkable));
    }
    for (const Case& shaderCase : plan.cases) {
        if (shaderCase.isRetired() || !settings.emitLibrary) {
            continue;
        }
        mustache::data one = makeContext(scenes, settings.plan);
        mustache::data entry;
        addCase(entry, scenes, *plan.model, shaderCase);
        mustache::data list(mustache::data::type::list);
        list.push_back(entry);
        one.set("cases", list);
        addCase(one, scenes, *plan.model, shaderCase);
        one.set("title", fmt::format("// Glint's library: the shading of hits with the shader ID {}.",
                                     shaderCase.shaderId));
        one.set("isSwitch", mustache::data(false));
        const auto word = [](std::uint32_t bits) { return fmt::format("{:#x}u", bits); };
        const materials::FeatureMask any = shaderCase.always | shaderCase.sometimes;
        const auto [always, sometimes] = plan.model->caseWords(shaderCase.always, shaderCase.sometimes);
        setModule(one, word(always.lobes), word(always.inputs), word(always.lobes | sometimes.lobes),
                  word(always.inputs | sometimes.inputs), word(always.model));
        const std::string name =
            fmt::format("glint_case_{}_{}.glsl", shaderCase.shaderId, shaderCase.name.substr(0, 100));
        GLINT_TRY_DO(add(one, any, name));
    }
    return files;
}

}  // namespace glint::compiler
