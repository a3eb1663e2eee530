// Translates flattened GLSL to C++, for functions that need no device.
#pragma once

#include <glint/result.h>

#include <string>
#include <string_view>

namespace glint::numerics {

// Keeps every expression as it is, and changes what C++ spells differently:
//
//   float, 1.5              Real, Real(1.5)
//   out vec3 n              vec3& n
//   v.xyz                   v.xyz(), a copy
//   Foo(a, b)               Foo{a, b}, where Foo is a structure
//   float[3](a, b, c)       {a, b, c}
//   #version, #extension, precision qualifiers   dropped
//
// #line directives stay, so that a compiler's message names the shader file.
// Errors: "glsl-swizzle" (a swizzle is assigned to: C++ would lose the value, because it is a copy),
// "glsl-bracket".
Result<std::string> translateToCpp(std::string_view glsl);

}  // namespace glint::numerics
