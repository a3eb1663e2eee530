// Declares the fields of a type (base/fields.h) without JSON.
#pragma once

#include <vector>

namespace glint::base {

struct Field;
using Fields = std::vector<Field>;

}  // namespace glint::base
