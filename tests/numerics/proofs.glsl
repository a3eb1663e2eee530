// Claims about functions of the shaders, which glint_proofs proves for whole domains (proofs.h). A claim reads its inputs
// from i and writes what is claimed to o.
#include "numerics/proofs_hit.glsl"
#include "numerics/proofs_bsdf.glsl"
