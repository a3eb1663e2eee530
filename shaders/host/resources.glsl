// The resources that the other files of the host read. Here they are those of Glint's renderer.
#include "hit/bindings.glsl"
