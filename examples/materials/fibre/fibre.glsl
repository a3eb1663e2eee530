// Fibres: a lobe with a density of its own. A fibre along t sends light on the cone l·t = -v·t (Marschner et al.,
// "Light Scattering from Human Hair Fibers", 2003, has this for smooth fibres). Here l·t has a Cauchy distribution
// about that cosine, cut to [-1, 1], and all azimuths above the surface are alike. The lobe is its own density times
// the colour, so it reflects exactly that share of a uniform sky. It is not reciprocal.
#include "bsdf/layer.glsl"

struct Fibre {
    GLINT_RELAXED vec3 color;
    GLINT_RELAXED float factor;
    float width;
    vec2 along;  // the fibres' direction, in the plane of the surface
};

void fibrePrepare(inout Fibre layer, vec3 view) {}

LayerAlbedo fibreShares(Fibre layer, vec3 view) {
    return LayerAlbedo(layer.color * layer.factor, 1.0 - layer.factor);
}

// The angles whose tangents are the ends of [-1, 1] about the centre of the distribution.
vec2 fibreEnds(Fibre layer, float centre) {
    return atan(vec2(-1.0 - centre, 1.0 - centre) / layer.width);
}

float fibreDensity(Fibre layer, vec3 view, vec3 l) {
    if (l.z <= 0.0) {
        return 0.0;
    }
    float centre = -dot(view.xy, layer.along);
    vec2 ends = fibreEnds(layer, centre);
    float distance = (dot(l.xy, layer.along) - centre) / layer.width;
    // The half circle of azimuths has the length π. An area on the sphere is that on the cylinder about t.
    return kInversePi / (layer.width * (1.0 + distance * distance) * (ends.y - ends.x));
}

LayerLight fibreEvaluate(Fibre layer, vec3 view, vec3 l) {
    return LayerLight(layer.color * (layer.factor * fibreDensity(layer, view, l)), 1.0 - layer.factor, l.z);
}

vec3 fibreSample(Fibre layer, vec3 view, vec2 u) {
    float centre = -dot(view.xy, layer.along);
    vec2 ends = fibreEnds(layer, centre);
    float t = clamp(centre + layer.width * tan(mix(ends.x, ends.y, u.x)), -1.0, 1.0);
    float around = sqrt(1.0 - t * t);
    float azimuth = kPi * u.y;
    float across = around * cos(azimuth);
    return vec3(t * layer.along + across * vec2(-layer.along.y, layer.along.x), around * sin(azimuth));
}
