// Puts one scene into another one.
#pragma once

#include "gltf/scene.h"

namespace glint::session {

// Returns the number (Node::source) that the next node gets: one above those that are there.
int nextNumber(const gltf::Scene& scene);

// Adds everything of `from` but its cameras to `to`, with its nodes below the node `parent`. Images have
// their sizes and no texels. Variants of the same name become one.
void appendScene(const gltf::Scene& from, int parent, gltf::Scene& to);

}  // namespace glint::session
