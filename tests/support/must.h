// Values and errors that a test can't do without.
#pragma once

#include <glint/result.h>

#include <stdexcept>
#include <utility>

namespace glint {

// Returns the value of work that has to succeed. Otherwise it throws the diagnostic, and GoogleTest then ends
// the case as a failure with this text.
template <typename Value>
Value must(Result<Value> made) {
    if (!made) {
        throw std::runtime_error(toString(made.error()));
    }
    return *std::move(made);
}

// Returns the error of work that has to fail, and otherwise throws in the same way.
template <typename Value>
Diagnostic mustFail(const Result<Value>& made) {
    if (made) {
        throw std::runtime_error("what should fail has succeeded");
    }
    return made.error();
}

}  // namespace glint
