// Converts the settings of a bench to the arguments of glint render, and back.
#pragma once

#include "bench/settings.h"
#include "cli/render_arguments.h"
#include "gltf/scene.h"

#include <glint/result.h>

#include <string>
#include <string_view>
#include <vector>

namespace glint {

// Returns the arguments of glint render if no option is given.
RenderArguments usualArguments();

// Returns the value of every setting of bench::settingNames().
bench::Configuration configurationOf(const RenderArguments& arguments);

// Returns `arguments` with the values of `configuration`, which come from bench::Setting::values or
// configurationOf().
RenderArguments withSettings(RenderArguments arguments, const bench::Configuration& configuration);

// Returns the facts of the scene and the request on which the values worth trying depend. Facts of the device
// are left out.
bench::Facts factsOf(const RenderArguments& arguments, const Scene& scene, const PlanOptions& plan);

// Returns the words of a command line: {"--spp", "4"}. A switch that is off is left out.
std::vector<std::string> wordsOf(const bench::Configuration& configuration);

// Returns whether a setting is given by a single word, such as --position-fetch.
bool isSwitch(std::string_view setting);

}  // namespace glint
