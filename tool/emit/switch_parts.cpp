#include "emit/switch_parts.h"

#include "emit/context.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace glint::compiler {

namespace {

constexpr std::string_view kSwitchFile = "generated/cases.glsl";
constexpr std::string_view kEmitterFile = "light/emitter.glsl";
constexpr std::string_view kSwitchTemplate = "cases.glsl.mustache";
constexpr std::string_view kPartTemplate = "case_part.comp.mustache";

}  // namespace

Status SwitchParts::makeSwitches() {
    kainjow::mustache::data context = context_;
    for (const bool fallbackAlone : {false, true}) {
        if (fallbackAlone) {
            context.set("cases", kainjow::mustache::data(kainjow::mustache::data::type::list));
        }
        for (const bool apart : {false, true}) {
            context.set("apart", apart);
            GLINT_TRY(auto text, renderTemplate(sources_, kSwitchTemplate, context));
            SourceSet& to = (apart ? head_ : whole_)[fallbackAlone ? 1 : 0];
            to.add(std::string(kSwitchFile), std::move(text));
            if (apart && settings_.emissiveLights != EmissiveLights::On) {
                // The emission of lights is the only code of materials that the switch would have, and an
                // edit of that code would change the switch.
                to.add(std::string(kEmitterFile), "");
            }
        }
    }
    return okStatus();
}

Result<std::shared_ptr<const ModuleSource>> SwitchParts::partOf(const Case& shaderCase) {
    const std::string function = "shade" + shaderCase.name;
    std::shared_ptr<const ModuleSource>& made = made_[function];
    if (made) {
        return made;
    }
    GLINT_TRY(auto code, codeOfCases_.find(shaderCase.always | shaderCase.sometimes | ofEmitters_));
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
    drafts_.add(part, part->name, std::move(text), *code);
    made = part;
    return made;
}

Status SwitchParts::addTo(ModuleSource& module, const std::string& origin, const std::string& text,
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

}  // namespace glint::compiler
