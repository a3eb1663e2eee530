// Values that a test can't do without.
#pragma once

#include <glint/result.h>

#include <stdexcept>
#include <utility>

namespace glint {

// Returns the value of work that has to succeed. Otherwise it throws the diagnostic, and GoogleTest then ends the case
// as a failure with this text.
template <typename Value>
Value must(Result<Value> made) {
    if (!made) {
        throw std::runtime_error(toString(made.error()));
    }
    return *std::move(made);
}

}  // namespace glint
