// The ways to make a picture: each strategy with each tracer. Tests expect one picture of all of them.
#pragma once

#include "render/harness.h"

#include <glint/internal/package_modules.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace glint::testing {

struct Way {
    package::Strategy strategy;
    package::Tracer tracer;
};

std::string nameOf(const Way& way);

// Options of a renderer that goes this way, with the check of orders.
RendererOptions optionsOf(const Way& way);

// Returns the ways of these strategies and tracers (bits) that the shared device has.
std::vector<Way> waysOf(std::uint32_t strategies, std::uint32_t tracers);

// Calls `visit` for ways of all strategies, each with a package for `settings` that has what it needs. At
// night these are all ways. By day each strategy has one tracer, in turn, because compiling takes longest.
// `change`: as in LoadedScene.
void forEachWay(const gltf::Scene& scene, compiler::CompileSettings settings,
                const std::function<void(const LoadedScene&, const Way&)>& visit,
                const std::function<void(session::SceneViewData&)>& change = {});

}  // namespace glint::testing
