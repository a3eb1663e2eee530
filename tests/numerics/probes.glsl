// One probe for each function of the shaders that needs no device. A probe reads its arguments from i and
// writes results to o. It is written once; the device runs it as GLSL, and the host as C++ in single and in
// double precision.
#include "numerics/probes_hit.glsl"
#include "numerics/probes_bsdf.glsl"
