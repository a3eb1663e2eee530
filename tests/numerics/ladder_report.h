// The precision ladder as text.
#pragma once

#include "ladder.h"

#include <string>

namespace glint::numerics {

// A row for each function and rung, for a terminal.
std::string toText(const Ladder& ladder);
std::string toMarkdown(const Ladder& ladder);
std::string toJson(const Ladder& ladder);

}  // namespace glint::numerics
