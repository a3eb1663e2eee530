// The tab in which a view or a layer is chosen, with its legend.
#pragma once

#include "view/controls.h"
#include "view/look.h"

#include <optional>
#include <string>

namespace glint::view {

// Draws the list of looks and the legend of the one that is shown; `shown` is null until it is made. `note`
// is the reason why it is not shown. Returns the look that was clicked.
std::optional<Look> drawLooks(Controls& controls, const Build& build, const Look& chosen,
                              const measure::View* shown, const std::string& note);

}  // namespace glint::view
