// The spelling of the words in CompileSettings::layers.
#pragma once

namespace glint::compiler {

// Ends a word whose layer a package may lack, because it has no effect with such a layer: "hit-shader?".
inline constexpr char kOptionalLayer = '?';

}  // namespace glint::compiler
