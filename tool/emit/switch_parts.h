// The parts of shaders that choose among cases: the entry point with the switch, and each case by itself.
#pragma once

#include "emit/material_code.h"
#include "emit/module_drafts.h"
#include "emit/module_source.h"
#include "gltf/scene_list.h"
#include "plan/plan.h"
#include "settings/compile_settings.h"

#include <glint/result.h>

#include <kainjow/mustache.hpp>

#include <map>
#include <memory>
#include <string>

namespace glint::compiler {

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
          ofEmitters_(ofEmitters) {}

    // Makes the texts of the switch. Has the errors of renderTemplate().
    Status makeSwitches();
    // Returns the switch with the code of its cases: all of them, or the fallback alone.
    const SourceSet& wholeSwitch(bool fallbackAlone) const {
        return whole_[fallbackAlone ? 1 : 0];
    }
    // Adds the parts of a module whose text is `text`. Has the errors of renderTemplate().
    Status addTo(ModuleSource& module, const std::string& origin, const std::string& text,
                 bool fallbackAlone);

private:
    Result<std::shared_ptr<const ModuleSource>> partOf(const Case& shaderCase);

    const kainjow::mustache::data context_;
    const gltf::SceneList& scenes_;
    const Plan& plan_;
    const SourceSet& sources_;
    const CompileSettings& settings_;
    ModuleDrafts& drafts_;
    MaterialCodeOfCases& codeOfCases_;
    materials::FeatureMask ofEmitters_;
    SourceSet whole_[2];
    SourceSet head_[2];                                                // switches whose cases have no code
    std::map<std::string, std::shared_ptr<const ModuleSource>> made_;  // by the function's name
};

}  // namespace glint::compiler
