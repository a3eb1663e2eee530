// Makes one self-contained text of a source and everything that it includes.
#pragma once

#include <glint/result.h>

#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace glint {

// Shared headers hold a C++ side and a GLSL side, told apart by __cplusplus.
enum class FlattenSide { Glsl, Cpp };

// The text of an include by the name between the quotes; nothing where there is no such file. The text must
// outlive the call of flatten().
using SourceLookup = std::function<std::optional<std::string_view>(std::string_view name)>;

// Inlines each `#include "name"` once, and drops the other side's parts. For GLSL, also drops include guards
// and `#include <…>`, and emits `#line` directives with file names (GL_GOOGLE_cpp_style_line_directive), so
// that the compiler's messages name the real place; `text` must then begin with #version, comments apart.
// Errors, each with file and line: "source-include" (missing or cyclic), "source-conditional" (unbalanced, or
// a form of __cplusplus other than #ifdef, #ifndef and #else), "source-version".
Result<std::string> flatten(std::string_view name, std::string_view text, const SourceLookup& lookup,
                            FlattenSide side);

}  // namespace glint
