// Decides everything that follows from scenes, settings and the place where shaders will run. It alone knows
// the meaning of `auto`.
#pragma once

#include "gltf/import_options.h"
#include "gltf/scene_list.h"
#include "resolve/build.h"
#include "settings/settings.h"

#include <glint/result.h>

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace glint::compiler {

// Returns how the scenes of a package are read. `texels` keeps what was found in images; null: nothing is
// kept. Errors "effect-unknown" and those of loadMaterialModel().
Result<gltf::ImportOptions> importOptions(const Settings& settings, base::Memo* texels);

// The scenes of `scenes` must outlive the result. Errors: those of reading a profile and a lock;
// "lock-outdated"; "hit-lobe-unknown"; "calibration-strategies" if there are constants for no strategy that
// can run; those of planLight() and resolveLayers(); and settings that contradict each other ("strategy",
// "tracer", "passes", "bounces", "bindings", "position-fetch").
Result<Build> resolve(std::shared_ptr<const gltf::SceneList> scenes, const Settings& settings,
                      const Target& target = {});
Result<Build> resolve(std::span<const gltf::Scene> scenes, const Settings& settings,
                      const Target& target = {});
// Decides about a package whose keys are to be made with `settings.plan` as it is.
Result<Build> resolve(std::span<const gltf::Scene> scenes, const CompileSettings& settings);

// Returns whether planning relies on what textures hold. Packages with a fallback or a host do not, because
// textures may hold anything at run time. Scenes have to be read accordingly. `package` may be null.
bool trustsTextures(const Settings& settings, const DecidedPackage* package = nullptr);

// Returns the names of the strategies, or tracers, in a set of bits.
std::vector<std::string> strategyNames(std::uint32_t strategies);
std::vector<std::string> tracerNames(std::uint32_t tracers);

// The things that a change of settings makes anew, as bits of a set. A set that is less than kChangesUpload
// needs neither another upload nor another package.
enum Change : std::uint32_t {
    kChangesFrame = 1,     // the picture starts anew
    kChangesRenderer = 2,  // another renderer
    kChangesUpload = 4,    // another upload of the scene
    kChangesPackage = 8,   // another package
};
// Returns the set. It follows from the table of settings.
std::uint32_t changeBetween(const Settings& before, const Settings& after);
// Returns the settings of a build with those of `wanted` that need no other upload or package.
Settings withoutRebuilding(Settings built, const Settings& wanted);

}  // namespace glint::compiler
