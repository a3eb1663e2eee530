// The interface of a model: the base of materials that name its extension, in place of Glint's own. A declaration with
// "model" has a struct of its own name, here Toon, and these functions, which take the prepared view and directions in
// the frame of the surface:
//
//   void toonPrepare(inout Toon model, vec3 view)         what depends on the view alone
//   vec3 toonEvaluate(Toon model, vec3 view, vec3 l)      the BSDF times |n·l|
//   vec3 toonSample(Toon model, vec3 view, vec2 u)        with "sampled": a unit vector, or 0; u is uniform in [0, 1)²
//   float toonDensity(Toon model, vec3 view, vec3 l)      with "sampled": the density of toonSample() by solid angle
//   vec3 toonShadeAll(Toon model, vec3 view, vec3 light)  with "shadesAll": the light that the viewer sees where all
//                                                         lights would bring `light` if nothing cast a shadow
//
// toonBsdf() sets the struct, surface.bsdf.layers.toon, and the shares of a uniform white sky that the surface reflects
// and lets through, surface.bsdf.diffuse and surface.bsdf.diffuseTransmitted. Rays that stand for all of the
// surroundings, ambient light and denoisers take those. If it leaves them, they are the colour of the surface, and 0.
// Without "sampled", directions are cosine-weighted on either side, in proportion to these shares. With "light":
// "front", no l is below the surface.
#include "bsdf/layer.glsl"
