// The GLSL files that modules are flattened from, embedded or made for a scene, and the values of templates.
#pragma once

#include "emit/source_set.h"
#include "gltf/scene_list.h"
#include "plan/plan.h"
#include "settings/settings.h"

#include <glint/result.h>

#include <kainjow/mustache.hpp>

#include <cstdint>
#include <string>
#include <string_view>

namespace glint::compiler {

// Returns the embedded files, and those of generated/ that all modules share. Has the errors of addHost() and
// renderTemplate().
Result<SourceSet> makeSourceSet(const gltf::SceneList& scenes, const Plan& plan,
                                const CompileSettings& settings);

// Returns the C++ declarations of every structure that host and device share, flattened from shaders/interop.
Result<std::string> interopDeclarations();

// Returns a hash of the names and texts of shaders/interop.
std::uint64_t interopSourceHash();

// --- The values of a compilation that templates can use ---

// Returns the tool's version, "0.1.0".
std::string_view toolVersion();

// Turns `text` into one line of printable ASCII that neither ends a comment nor continues its line. Long
// names are cut.
std::string commentText(std::string_view text);

// Makes the context: version, source, merge, alpha.
kainjow::mustache::data makeContext(const gltf::SceneList& scenes, const PlanOptions& options);

// Returns a value of the members of Features that hold own features of a model, as GLSL.
std::string ownLiteral(const package::KeyWords::Own& own);
// Returns the first members of Features (shaders/bsdf/features.glsl), as GLSL.
std::string caseFeatures(const package::KeyWords& always, const package::KeyWords& sometimes);

// Adds the fields of one case to the top level: id, name, alwaysLobes, alwaysInputs, sometimesLobes,
// sometimesInputs, model, caseFeatures, always, sometimes, materials.
void addCase(kainjow::mustache::data& context, const gltf::SceneList& scenes,
             const materials::MaterialModel& model, const Case& shaderCase);

// Adds `cases`, a list of what addCase() adds for each case that is not retired, and `fallback`, the same of
// the fallback, or false. Copies of the context copy all of them.
void addCases(kainjow::mustache::data& context, const gltf::SceneList& scenes, const Plan& plan,
              const PlanOptions& options);

// Renders the template `name` without HTML escapes. Error "template" if it is missing or malformed.
Result<std::string> renderTemplate(const SourceSet& sources, std::string_view name,
                                   const kainjow::mustache::data& context);

// --- The GLSL that calls the effects of a package and writes its layers ---

// Returns the layers' macros for generated/scene.glsl. `deforms`: some vertices follow joints or morph
// weights. `findsSizedLights`: rays find lights with a size, which walks may meet.
std::string layerDefines(const Plan& plan, bool deforms, bool findsSizedLights);

// Adds the fields for the templates of layers: sky_layers.glsl, surface_layers.glsl, compose_effects.glsl.
void addLayers(kainjow::mustache::data& context, const Plan& plan);
// Adds the fields of one effect's layers to its entry in compose_effects.glsl.mustache.
void addLayersOf(kainjow::mustache::data& entry, const Plan& plan, package::Effect effect);

// --- The GLSL that calls the effects of a package ---

// Returns the effects' macros and bits for generated/scene.glsl.
std::string effectDefines(const materials::MaterialModel& model, const package::EffectSet& effects);

// Adds the fields for the templates that call the effects of a package.
void addEffects(kainjow::mustache::data& context, const Plan& plan);
// Adds the fields for effect_rays.comp.mustache: the effect with that number, which sends rays.
void addEffect(kainjow::mustache::data& context, const materials::MaterialModel& model,
               const package::EffectSet& effects, std::size_t number);

}  // namespace glint::compiler
