// The messages of the Vulkan validation layers.
#pragma once

#include "cli/console.h"

#include <glint/context.h>
#include <glint/result.h>

namespace glint {

// Returns the error "validation" with the number of messages, each of which is reported as a warning. Without
// --validate there are none.
Status checkValidation(const Console& console, const Context& context);

}  // namespace glint
