// glint render --profile: counts the hits of every key while rendering.
#pragma once

#include "cli/options.h"
#include "gltf/scene_list.h"

#include <glint/result.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace glint {

// Hits are counted by case, so every key needs its own case, in a strategy that orders hits. Chooses --merge
// none. Throws a CLI::ParseError if the command line asks for something else. Does nothing if `file` is
// empty.
void settleProfileOutput(const std::string& file, const std::string& package, const std::string& strategy,
                         bool mergeGiven, PlanArguments& plan);

// `hits` is indexed by shader ID of a plan with `options`, in which every key has its own case. Adds to
// `warnings` if there are no hits. Has the errors of writeFile().
Status writeProfile(const std::string& file, const SceneList& scenes, const PlanOptions& options,
                    std::span<const std::uint64_t> hits, std::vector<Diagnostic>& warnings);

}  // namespace glint
