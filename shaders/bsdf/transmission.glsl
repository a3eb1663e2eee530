// Refraction at rough interfaces: Walter et al., "Microfacet Models for Refraction through Rough Surfaces" (2007), for
// KHR_materials_transmission and KHR_materials_volume. eta = n_t / n_i: of the far side to that of the viewer. Vectors
// are unit, in the frame of the surface, and point away from it; the viewer is at z > 0.

// Indices this close bend light by less than the narrowest lobe is wide: it goes straight on, whatever the microfacets.
const float kMinIndexStep = 1e-4;

bool refracts(float eta) {
    return abs(eta - 1.0) >= kMinIndexStep;
}

// The direction of v's light beyond a facet h: Snell's law. False where all of it is reflected.
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

// The facet that sends v's light to l, by Snell's law.
struct RefractingFacet {
    vec3 h;         // unit
    float cosineV;  // v·h
    float cosineL;  // -l·h
    float spread;   // eta² / (v·h + eta l·h)²: turns densities of facets into densities of directions by |l·h|
};

// False where no facet does.
bool refractionHalfVector(vec3 v, vec3 l, float eta, out RefractingFacet facet) {
    // v + eta l is (v·h + eta l·h) h. Its x and y cancel near the direction of a smooth surface, and its products
    // with v and l where the facet is seen from the side.
    vec2 x = exactAddProduct(v.x, eta, l.x);
    vec2 y = exactAddProduct(v.y, eta, l.y);
    vec2 z = exactAddProduct(v.z, eta, l.z);
    vec3 sum = vec3(x.x, y.x, z.x);
    vec3 errors = vec3(x.y, y.y, z.y);
    float squared = dot(sum, sum);
    float scale = inversesqrt(squared) * (sum.z < 0.0 ? -1.0 : 1.0);
    facet.h = sum * scale;
    facet.cosineV = min((accurateDot(v, sum) + dot(v, errors)) * scale, 1.0);
    facet.cosineL = min(-(accurateDot(l, sum) + dot(l, errors)) * scale, 1.0);
    facet.spread = eta * eta / squared;
    return squared > 0.0 && facet.cosineV > 0.0 && facet.cosineL > 0.0;
}

// Transmitted by a thin wall: reflection, mirrored to the far side (KHR_materials_transmission). Times |n·l|, without
// Fresnel. cosine: of view and facet.
float thinTransmission(vec3 v, vec3 l, vec2 alpha, out float cosine) {
    vec3 mirrored = vec3(l.x, l.y, -l.z);
    // |v + l| is twice the cosine of v and h, and keeps its digits where facets are seen from the side.
    vec3 sum = v + mirrored;
    float size = sqrt(dot(sum, sum));
    vec3 h = sum / size;
    cosine = min(0.5 * size, 1.0);
    return ggxDistribution(h, alpha) * ggxVisibility(mirrored, v, alpha) * mirrored.z;
}

// Transmitted into a volume (Walter et al., equation 21), times |n·l|, without Fresnel; eta apart from 1. In flux:
// the compression of radiance by eta² is left out, as what comes in goes out again. cosine: to the facet, on the less
// dense side, which is that of Schlick's approximation.
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

// What a length of absorbing medium lets through (Beer and Lambert): KHR_materials_volume. absorption is per metre.
vec3 volumeTransmittance(vec3 absorption, float distance) {
    return exp(-absorption * distance);
}

// Indices of red, green and blue light: KHR_materials_dispersion. The spread is symmetric about that of green.
vec3 dispersedIor(float ior, float dispersion) {
    float halfSpread = (ior - 1.0) * 0.025 * dispersion;
    return vec3(ior - halfSpread, ior, ior + halfSpread);
}
