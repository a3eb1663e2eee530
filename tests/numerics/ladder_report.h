// The precision ladder as text and as JSON.
#pragma once

#include "ladder.h"

#include <string>

namespace glint::numerics {

// Returns a row for each function and rung, for a terminal.
std::string toText(const Ladder& ladder);
std::string toMarkdown(const Ladder& ladder);
std::string toJson(const Ladder& ladder);
// Reads the output of toJson(), perhaps from another machine. Error "ladder-format".
Result<Ladder> ladderFromJson(const std::string& text);

}  // namespace glint::numerics
