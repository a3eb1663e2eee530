// The settings of a bench as the arguments of glint render, and back.
#pragma once

#include "bench/settings.h"
#include "cli/render_arguments.h"
#include "gltf/scene.h"

#include <glint/result.h>

#include <string>
#include <string_view>
#include <vector>

namespace glint {

// Those of glint render where nothing is given.
RenderArguments usualArguments();

// The value of every setting of bench::settingNames().
bench::Configuration configurationOf(const RenderArguments& arguments);

// `arguments` with the values of `configuration`, which are those of bench::Setting::values or of
// configurationOf().
RenderArguments withSettings(RenderArguments arguments, const bench::Configuration& configuration);

// What of the scene and of what is asked decides which values are worth trying; what the device has is left
// out.
bench::Facts factsOf(const RenderArguments& arguments, const Scene& scene, const PlanOptions& plan);

// As words of a command line: {"--spp", "4"}; a switch that is off is left out.
std::vector<std::string> wordsOf(const bench::Configuration& configuration);

// Whether a setting is given by a bare word, such as --position-fetch.
bool isSwitch(std::string_view setting);

}  // namespace glint
