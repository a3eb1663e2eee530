// Clearcoat (KHR_materials_clearcoat): an isotropic GGX lobe of index 1.5 about its own normal. Vectors are in the
// frame of the base, where the coat's normal need not be z. Products that nearly cancel therefore keep their rounding
// errors.

// Reflectance of the layer, which depends on the angle of the view alone, as in the extension's text.
GLINT_RELAXED float clearcoatFresnel(GLINT_RELAXED float factor, float nDotV) {
    return factor * (0.04 + 0.96 * schlickWeight(nDotV));
}

// The share that the layer lets through: 1 - clearcoatFresnel(). It keeps its digits where little passes.
GLINT_RELAXED float clearcoatPassed(GLINT_RELAXED float factor, float nDotV) {
    return (1.0 - factor) + factor * 0.96 * schlickRest(nDotV);
}

// The NDF about n, for the facet between v and l.
float clearcoatDistribution(vec3 n, vec3 v, vec3 l, float alpha) {
    // Sine and cosine between n and the unnormalised half vector s, times |s|.
    vec3 s = v + l;
    vec3 sine = accurateCrossOfSum(n, v, l);
    float cosine = dot(n, s);
    float a2 = alpha * alpha;
    float t = (dot(sine, sine) / a2 + cosine * cosine) / dot(s, s);
    return cosine > 0.0 ? 1.0 / (kPi * a2 * t * t) : 0.0;
}

// ggxProjection(), as a function of the cosine to n.
float clearcoatProjection(float cosine, float alpha) {
    float a2 = alpha * alpha;
    return sqrt(cosine * cosine * (1.0 - a2) + a2);
}

// The lobe without Fresnel: D V. n is a unit vector; nDotL and nDotV are cosines to it, above 0.
float clearcoatLobe(vec3 n, float nDotL, float nDotV, vec3 v, vec3 l, float alpha) {
    return clearcoatDistribution(n, v, l, alpha) * 0.5 /
           (nDotL * clearcoatProjection(nDotV, alpha) + nDotV * clearcoatProjection(nDotL, alpha));
}
