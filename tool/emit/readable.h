// The text of a module for people: as somebody would have written it for this module alone.
#pragma once

#include <string>
#include <string_view>

namespace glint {

// `flattened`, as flatten() makes it, without #line directives, without branches that its own #defines decide
// against, without what is only there for C++ or is used by nothing, and with one place for its extensions.
// `header` are the lines that it begins with, each a comment, unless it has a header that says what made it.
// It compiles to the same SPIR-V, as long as that holds no debug information.
std::string makeReadable(std::string_view flattened, std::string_view header);

}  // namespace glint
