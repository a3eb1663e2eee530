// Fresnel reflectance.
#include "generated/scene.glsl"
#include "bsdf/exact.glsl"

GLINT_RELAXED float largest(GLINT_RELAXED vec3 v) {
    return max(v.x, max(v.y, v.z));
}

GLINT_RELAXED float smallest(GLINT_RELAXED vec3 v) {
    return min(v.x, min(v.y, v.z));
}

// The luminance of linear Rec. 709.
float luminance(vec3 color) {
    return dot(color, vec3(0.2126, 0.7152, 0.0722));
}

// The reflectance at normal incidence of a dielectric in air: KHR_materials_ior. An index of 0 stands for an infinite
// one and gives 1.
float dielectricF0(float ior) {
    float r = (ior - 1.0) / (ior + 1.0);
    return r * r;
}

// (1 - cosine)⁵, the weight of f90 in Schlick's approximation. It is so steep that it is computed in 32 bits, whatever
// the precision of the result. The same holds for schlickRest().
GLINT_RELAXED float schlickWeight(float cosine) {
    float m = clamp(1.0 - cosine, 0.0, 1.0);
    float m2 = m * m;
    return m2 * m2 * m;
}

// 1 - schlickWeight() as a polynomial. Unlike the difference, its terms do not cancel near grazing.
GLINT_RELAXED float schlickRest(float cosine) {
    float c = clamp(cosine, 0.0, 1.0);
    return c * (5.0 + c * (-10.0 + c * (10.0 + c * (-5.0 + c))));
}

// Schlick's approximation: glTF 2.0, appendix B.3.4; f90 comes from KHR_materials_specular. cosine is that between view
// and half vector, in [0, 1].
GLINT_RELAXED vec3 fresnelSchlick(GLINT_RELAXED vec3 f0, GLINT_RELAXED float f90, float cosine) {
    return f0 + (vec3(f90) - f0) * schlickWeight(cosine);
}

// Fresnel for an interface of relative index eta = n_t / n_i, from the squared cosine and its error. If light leaves
// the denser side, Schlick's cosine is that of the transmitted angle (van der Burg 1999, "Schlick's approximation").
// Beyond the critical angle all light is reflected, whatever f90 is.
GLINT_RELAXED vec3 fresnelInterface(GLINT_RELAXED vec3 f0, GLINT_RELAXED float f90, vec2 cosine2, float eta) {
    if (eta >= 1.0) {
        return fresnelSchlick(f0, f90, sqrt(cosine2.x));
    }
    float refracted2 = refractedCosine2(cosine2, eta);
    return refracted2 > 0.0 ? fresnelSchlick(f0, f90, sqrt(refracted2)) : vec3(1.0);
}

// The share that a surface lets through in the channel that it reflects most: 1 - largest(fresnelSchlick()). It keeps
// its digits where little passes. f90 is at least f0.
GLINT_RELAXED float schlickPassed(GLINT_RELAXED vec3 f0, GLINT_RELAXED float f90, float cosine) {
    return (1.0 - largest(f0)) * schlickRest(cosine) + (1.0 - f90) * schlickWeight(cosine);
}

// The same share for an interface: 1 - largest(fresnelInterface()).
GLINT_RELAXED float interfacePassed(GLINT_RELAXED vec3 f0, GLINT_RELAXED float f90, vec2 cosine2, float eta) {
    if (eta >= 1.0) {
        return schlickPassed(f0, f90, sqrt(cosine2.x));
    }
    float refracted2 = refractedCosine2(cosine2, eta);
    return refracted2 > 0.0 ? schlickPassed(f0, f90, sqrt(refracted2)) : 0.0;
}

// Returns the f0 with which Schlick's approximation gives `reflectance` at `cosine`. Within 1e-4 of grazing the
// division gives no information about f0, so the weight is limited there.
vec3 schlickF0(vec3 reflectance, float f90, float cosine) {
    float rest = max(schlickRest(cosine), 1e-4);
    return clamp((reflectance - vec3(f90)) / rest + vec3(f90), vec3(0.0), vec3(1.0));
}
