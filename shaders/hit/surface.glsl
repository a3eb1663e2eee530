// The properties of a surface that shading needs, once its textures are read.
#include "bsdf/bsdf.glsl"

struct Surface {
    Bsdf bsdf;       // prepared for the view
    vec3 tangent;    // x, y and z of the BSDF's frame in the world
    vec3 bitangent;
    vec3 normal;     // on the viewer's side
    float roughness; // sqrt of the larger alpha
    vec3 emission;
    GLINT_RELAXED float occlusion; // of ambient light only
#if GLINT_SHADOW_GLASS
    GLINT_RELAXED vec3 unabsorbed; // share of light from behind that passes the volume's thickness, for light that is
                                   // not followed: rays measure the distance
#endif
};

// Returns the surface for light number `light`. A compiler does not see that the frame is the same for all lights, so
// it computes the frame from the normal instead of keeping it: the highest bit of the number is 0.
Surface surfaceAgain(Surface surface, Features features, uint light) {
    if (!isAnisotropic(features)) {
        vec3 normal = vec3(surface.normal.xy, uintBitsToFloat(floatBitsToUint(surface.normal.z) | light >> 31));
        buildBasis(normal, surface.tangent, surface.bitangent);
    }
    return surface;
}

vec3 toSurface(Surface surface, vec3 direction) {
    return vec3(dot(surface.tangent, direction), dot(surface.bitangent, direction), dot(surface.normal, direction));
}

vec3 toWorld(Surface surface, vec3 direction) {
    return direction.x * surface.tangent + direction.y * surface.bitangent + direction.z * surface.normal;
}

// Returns the BSDF times |n·l|, reflected or transmitted, for light from a direction of the world. geometricNormal is
// on the viewer's side. If it and a lobe's normal disagree on which side the light is, the lobe brings nothing, because
// light would leak through the surface.
vec3 scatteredLight(Surface surface, Features features, vec3 geometricNormal, vec3 toLight) {
    vec3 l = toSurface(surface, toLight);
    float height = dot(geometricNormal, toLight);
    vec3 base = l.z * height > 0.0 ? evaluateBase(surface.bsdf, features, l) : vec3(0.0);
    return addLayersAbove(surface.bsdf.layers, features, surface.bsdf.view, l, height, base);
}

// The share of the base's reflected or transmitted light that the layers above it let out again.
GLINT_RELAXED float baseShare(Surface surface, Features features) {
    return passedByLayers(surface.bsdf.layers, features, surface.bsdf.view);
}
