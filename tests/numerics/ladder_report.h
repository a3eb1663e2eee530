// The precision ladder as text and as JSON.
#pragma once

#include "ladder.h"

#include <string>

namespace glint::numerics {

// A row for each function and rung, for a terminal.
std::string toText(const Ladder& ladder);
std::string toMarkdown(const Ladder& ladder);
std::string toJson(const Ladder& ladder);
// What toJson() made, perhaps on another machine. Error "ladder-format".
Result<Ladder> ladderFromJson(const std::string& text);

}  // namespace glint::numerics
