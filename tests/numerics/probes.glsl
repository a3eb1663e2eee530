// One probe for each function of the shaders that needs no device: reads its arguments from i, writes results to o.
// Written once; the device runs it as GLSL, the host as C++ in single and in double precision.
#include "numerics/probes_hit.glsl"
#include "numerics/probes_bsdf.glsl"
