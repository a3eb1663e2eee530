// What the Vulkan validation layers said.
#pragma once

#include "cli/console.h"

#include <glint/context.h>
#include <glint/result.h>

namespace glint {

// Error "validation" with the number of messages, each of which is reported as a warning; none without
// --validate.
Status checkValidation(const Console& console, const Context& context);

}  // namespace glint
