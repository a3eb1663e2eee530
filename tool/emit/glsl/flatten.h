// Makes one self-contained text of a source file and everything that it includes.
#pragma once

#include "emit/glsl/unit.h"

#include <glint/result.h>

#include <functional>
#include <optional>
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

}  // namespace glint::compiler
