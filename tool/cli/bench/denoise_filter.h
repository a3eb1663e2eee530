// The filter of examples/denoise as a bench measures it.
#pragma once

#include <glint/measure/picture_filter.h>

namespace glint::cli {

// Null in a build without the examples.
const measure::FilterMaker* exampleFilter();

}  // namespace glint::cli
