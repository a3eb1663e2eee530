// Refraction at rough interfaces, for KHR_materials_transmission and KHR_materials_volume: Walter et al., "Microfacet
// Models for Refraction through Rough Surfaces" (2007). eta = n_t / n_i is the index of the far side over that of the
// viewer's side. Vectors are unit vectors in the frame of the surface and point away from it; the viewer is at z > 0.

// If indices are this close, light bends by less than the width of the narrowest lobe, so it goes straight on, whatever
// the microfacets are.
const float kMinIndexStep = 1e-4;

// The share of light that passes a length of absorbing medium (Beer and Lambert): KHR_materials_volume. absorption is
// per metre.
vec3 volumeTransmittance(vec3 absorption, float distance) {
    return exp(-absorption * distance);
}

// Red, green and blue have indices of their own (KHR_materials_dispersion). Values of each are computed in a loop, so
// that shaders that decide about dispersion at run time have its code once.
float channelOf(vec3 v, int channel) {
    return channel == 0 ? v.x : channel == 1 ? v.y : v.z;
}

vec3 withChannel(vec3 v, int channel, float value) {
    return vec3(channel == 0 ? value : v.x, channel == 1 ? value : v.y, channel == 2 ? value : v.z);
}

bool refracts(float eta) {
    return abs(eta - 1.0) >= kMinIndexStep;
}

// Returns the direction of v's light beyond a facet h, by Snell's law; false if all of it is reflected.
bool refractDirection(vec3 v, vec3 h, float eta, out vec3 l) {
    vec2 cosine = exactDot(v, h);
    float refracted2 = refractedCosine2(exactSquare(cosine), eta);
    if (refracted2 <= 0.0) {
        l = vec3(0.0);
        return false;
    }
    l = normalize(h * (cosine.x / eta - sqrt(refracted2)) - v / eta);
    return true;
}

// The facet that refracts v's light to l, by Snell's law.
struct RefractingFacet {
    vec3 h;         // unit
    float cosineV;  // v·h
    float cosineL;  // -l·h
    float spread;   // eta² / (v·h + eta l·h)²: times |l·h| it turns densities of facets into densities of directions
};

// Returns false if no facet refracts v to l.
bool refractionHalfVector(vec3 v, vec3 l, float eta, out RefractingFacet facet) {
    // v + eta l is (v·h + eta l·h) h. Its x and y cancel near the direction of a smooth surface; its products with v
    // and l cancel if the facet is seen from the side.
    vec2 x = exactAddProduct(v.x, eta, l.x);
    vec2 y = exactAddProduct(v.y, eta, l.y);
    vec2 z = exactAddProduct(v.z, eta, l.z);
    vec3 sum = vec3(x.x, y.x, z.x);
    vec3 errors = vec3(x.y, y.y, z.y);
    float squared = dot(sum, sum);
    float scale = inversesqrt(squared) * (sum.z < 0.0 ? -1.0 : 1.0);
    facet.h = sum * scale;
    facet.cosineL = min(-(accurateDot(l, sum) + dot(l, errors)) * scale, 1.0);
    facet.cosineV = min((accurateDot(v, sum) + dot(v, errors)) * scale, 1.0);
    facet.spread = eta * eta / squared;
    return squared > 0.0 && facet.cosineV > 0.0 && facet.cosineL > 0.0;
}

// Light that a thin wall transmits: reflection, mirrored to the far side (KHR_materials_transmission), times |n·l|,
// without Fresnel. `cosine` receives that between view and facet.
float thinTransmission(vec3 v, vec3 l, vec2 alpha, out float cosine) {
    vec3 mirrored = vec3(l.x, l.y, -l.z);
    // |v + l| is twice the cosine between v and h. It keeps its digits if a facet is seen from the side.
    vec3 sum = v + mirrored;
    float size = sqrt(dot(sum, sum));
    vec3 h = sum / size;
    cosine = min(0.5 * size, 1.0);
    return ggxDistribution(h, alpha) * ggxVisibility(mirrored, v, alpha) * mirrored.z;
}

// Light that is transmitted into a volume (Walter et al., equation 21), times |n·l|, without Fresnel; eta must differ
// from 1. It is in terms of flux: the compression of radiance by eta² is left out, because light that comes in also
// goes out. `cosine` receives that to the facet on the less dense side, which Schlick's approximation needs.
float refractedTransmission(vec3 v, vec3 l, vec2 alpha, float eta, out float cosine) {
    RefractingFacet facet;
    cosine = 1.0;
    if (!refractionHalfVector(v, l, eta, facet)) {
        return 0.0;
    }
    cosine = eta < 1.0 ? facet.cosineL : facet.cosineV;
    return 4.0 * ggxVisibility(l, v, alpha) * ggxDistribution(facet.h, alpha) * facet.cosineV * facet.cosineL *
           facet.spread * -l.z;
}
