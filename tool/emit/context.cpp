#include "emit/context.h"

#include "settings/settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <functional>
#include <map>
#include <vector>

namespace glint::compiler {

namespace mustache = kainjow::mustache;

namespace {

constexpr std::size_t kMaxNameLength = 64;
constexpr std::size_t kMaxNamesListed = 8;

std::string featureList(const materials::MaterialModel& model, const materials::FeatureMask& mask) {
    const std::vector<std::string> names = model.names(mask);
    return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
}

std::string materialNames(const gltf::SceneList& scenes, const std::vector<int>& materials) {
    if (materials.empty()) {
        return "any";
    }
    std::vector<std::string> names;
    for (std::size_t i = 0; i < materials.size() && i < kMaxNamesListed; ++i) {
        const std::string& name = scenes.materials()[materials[i]].name;
        names.push_back(name.empty() ? fmt::format("material {}", scenes.place(materials[i]).index)
                                     : commentText(name));
    }
    std::string list = fmt::format("{}", fmt::join(names, ", "));
    if (materials.size() > kMaxNamesListed) {
        list += fmt::format(" and {} more", materials.size() - kMaxNamesListed);
    }
    return list;
}

std::string literal(std::uint32_t word) {
    return fmt::format("{:#x}u", word);
}

}  // namespace

std::string_view toolVersion() {
    return GLINT_VERSION;
}

std::string commentText(std::string_view text) {
    std::string line;
    for (const char character : text.substr(0, kMaxNameLength)) {
        const bool printable = character >= ' ' && character <= '~';
        // A backslash could continue the comment's line, and a star or slash could end or open a comment.
        const bool special = character == '\\' || character == '*' || character == '/';
        line += !printable ? '?' : special ? '_' : character;
    }
    return text.size() > kMaxNameLength ? line + "..." : line;
}

std::string ownLiteral(const package::KeyWords::Own& own) {
    return fmt::format("GLINT_OWN({:#x}u)", fmt::join(own.words, "u, "));
}

std::string caseFeatures(const package::KeyWords& always, const package::KeyWords& sometimes) {
    return fmt::format("{:#x}u, {:#x}u, {:#x}u, {:#x}u, {:#x}u, {}, {}", always.lobes, always.inputs,
                       sometimes.lobes, sometimes.inputs, always.model, ownLiteral(always.own),
                       ownLiteral(sometimes.own));
}

void addCase(mustache::data& context, const gltf::SceneList& scenes, const materials::MaterialModel& model,
             const Case& shaderCase) {
    context.set("id", shaderCase.shaderId < 0 ? "of any material" : fmt::format("{}", shaderCase.shaderId));
    context.set("name", shaderCase.name);
    const auto [always, sometimes] = model.caseWords(shaderCase.always, shaderCase.sometimes);
    context.set("alwaysLobes", literal(always.lobes));
    context.set("alwaysInputs", literal(always.inputs));
    context.set("sometimesLobes", literal(sometimes.lobes));
    context.set("sometimesInputs", literal(sometimes.inputs));
    context.set("model", literal(always.model));
    context.set("caseFeatures", caseFeatures(always, sometimes));
    context.set("always", featureList(model, shaderCase.always));
    context.set("sometimes", featureList(model, shaderCase.sometimes));
    context.set("materials", materialNames(scenes, shaderCase.materials));
}

mustache::data makeContext(const gltf::SceneList& scenes, const PlanOptions& options) {
    mustache::data context;
    context.set("version", std::string(toolVersion()));
    context.set("source", commentText(scenes.fileNames()));
    context.set("merge", std::string(nameOf(options.merge)));
    context.set("alpha", std::string(nameOf(options.keys.alpha)));
    return context;
}

void addCases(mustache::data& context, const gltf::SceneList& scenes, const Plan& plan,
              const PlanOptions& options) {
    mustache::data cases(mustache::data::type::list);
    for (const Case& shaderCase : plan.cases) {
        if (!shaderCase.isRetired()) {
            mustache::data entry;
            addCase(entry, scenes, *plan.model, shaderCase);
            cases.push_back(entry);
        }
    }
    context.set("cases", cases);
    mustache::data fallback;
    addCase(fallback, scenes, *plan.model, fallbackCase(plan));
    context.set("fallback", options.fallback ? fallback : mustache::data(false));
}

Result<std::string> renderTemplate(const SourceSet& sources, std::string_view name,
                                   const mustache::data& context) {
    const std::optional<std::string_view> text = sources.find(name);
    if (!text) {
        return makeError("template", std::string(name), "there is no such template");
    }
    // Templates are Glint's own, so they are few, and packages render some of them for each case.
    thread_local std::map<std::string, mustache::mustache, std::less<>> known;
    auto parsed = known.find(*text);
    if (parsed == known.end()) {
        parsed = known.emplace(*text, mustache::mustache{std::string(*text)}).first;
        parsed->second.set_custom_escape([](const std::string& value) { return value; });
    }
    if (!parsed->second.is_valid()) {
        return makeError("template", std::string(name), parsed->second.error_message());
    }
    return parsed->second.render(context);
}

}  // namespace glint::compiler
