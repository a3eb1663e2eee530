// What scripts/nightly.sh tests beyond scripts/test.sh.
#pragma once

#include <cstdlib>

namespace glint::test {

// Returns whether a sweep is to be whole. Elsewhere it takes the values that stand for the others.
inline bool nightly() {
    return std::getenv("GLINT_NIGHTLY") != nullptr;
}

}  // namespace glint::test
