// The passes over the GLSL of a module: one self-contained text of a source file and everything that it
// includes, without what the module does not use, or as if it had been written by hand for this module alone.
#pragma once

#include "emit/glsl/text.h"

#include <glint/result.h>

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace glint::compiler {

// The side of shared headers to keep. They hold a C++ side and a GLSL side, told apart by __cplusplus.
enum class FlattenSide { Glsl, Cpp };

// Finds the text of an include by the name between the quotes. Returns nothing if there is no such file. The
// text must outlive the call of flatten().
using SourceLookup = std::function<std::optional<std::string_view>(std::string_view name)>;

// Inlines each `#include "name"` once, and drops the parts for the other side. For GLSL it also drops include
// guards and `#include <…>`; apart from comments, `text` must then begin with #version. `#line N` gives the
// number of the next line. Errors, each with file and line: "source-include" (missing or cyclic),
// "source-conditional" (unbalanced, or a form of __cplusplus other than #ifdef, #ifndef and #else),
// "source-version".
Result<GlslUnit> flatten(std::string_view name, std::string_view text, const SourceLookup& lookup,
                         FlattenSide side);

// --- What a module does not use goes ---

// Returns the unit without what its own macros and constants decide against: branches of #if and the
// directives of decided ones, statements below an `if` whose condition is false, and what follows a return.
// Where a condition is true, its statement stays alone. A condition is decided if it is an expression of
// macros, constants and literals, or if && or || make the rest of it irrelevant. What is in doubt stays.
GlslUnit cutDecided(const GlslUnit& unit);

// Returns the unit without the functions, constants and macros that the rest does not reach. Comments right
// above them are dropped too. In doubt an item stays: the text keeps its meaning, and a second call changes
// nothing.
GlslUnit dropUnused(const GlslUnit& unit);

// Returns a unit's text without comments, blank lines and indentation. This alone decides about its SPIR-V if
// that has no debug information.
std::string essentialText(std::string_view glsl);

// Returns a text in which parameters that their functions do not write are const. glslang passes those as
// values, and makes a variable of each of the others for every call, which the optimiser has to remove. A
// parameter stays if it is an argument of a function that may write it, an array, or indexed by a variable,
// and so do those of functions named in `fixed` and of functions with a prototype. Macros are not followed:
// if one writes a parameter, the result does not compile.
std::string withConstParameters(std::string_view glsl, std::span<const std::string> fixed);

// --- Names that a text shares with whatever includes it ---

// Puts "glint_" before the names that a text without #include and #line declares at its top level: functions,
// macros, constants, structs and blocks. A macro GLINT_A becomes GLINT_LIBRARY_A. Names that begin with glint
// or Glint stay, and so do members.
std::string prefixNames(std::string_view glsl);

// --- Text for people ---

// Returns a text that has no branches that its own #defines decide against, no parts that are unused or only
// for C++, and one place for its extensions. It begins with the lines of `header`, each a comment, unless the
// unit already has a header that says what made it. It compiles to the same SPIR-V as long as that holds no
// debug information.
std::string makeReadable(const GlslUnit& unit, std::string_view header);

}  // namespace glint::compiler
