// The second half of a preprocessor: it resolves what the text itself decides.
#pragma once

#include "emit/glsl/unit.h"

#include <string_view>

namespace glint::compiler {

// Drops the branches of conditionals that earlier #defines decide against, and the directives of decided
// conditionals. Undecided ones stay. It decides these conditions: NAME, NAME == number, NAME != number, and
// whether a name is defined, for names that begin with "GLINT_".
GlslUnit resolveConditionals(const GlslUnit& unit);

// Replaces the macros that `file` defines, each on one line, by their bodies. Lines that become empty are
// dropped.
GlslUnit expandMacros(const GlslUnit& unit, std::string_view file);

}  // namespace glint::compiler
