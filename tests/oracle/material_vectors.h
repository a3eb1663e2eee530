// Parameters of materials as vectors.
#pragma once

#include "materials/material.h"
#include "oracle/vectors.h"

namespace glint::oracle {

// The first three numbers of a parameter.
inline Vec3 toVec(const materials::ConstParameterValue& v) {
    return {v[0], v[1], v[2]};
}

}  // namespace glint::oracle
