// The GGX microfacet lobe in well-conditioned forms. alpha = roughness².

// Trowbridge-Reitz NDF: glTF 2.0, appendix B.3.2, with 1 - (n·h)² written as |n×h|². The difference loses every digit
// where h nears n, which is where a smooth lobe has its energy. n and h are unit; alpha > 0.
float ggxDistribution(vec3 n, vec3 h, float alpha) {
    vec3 c = cross(n, h);
    float nDotH = dot(n, h);
    float a2 = alpha * alpha;
    float t = dot(c, c) + a2 * nDotH * nDotH;
    return nDotH > 0.0 ? a2 / (kPi * t * t) : 0.0;
}

// Height-correlated Smith visibility, G / (4 (n·l) (n·v)): Heitz 2014; glTF 2.0, appendix B.3.3. Both cosines in
// (0, 1], alpha > 0: the sum of roots is then above 0.
float ggxVisibility(float nDotL, float nDotV, float alpha) {
    float a2 = alpha * alpha;
    float lambdaV = nDotL * sqrt(nDotV * nDotV * (1.0 - a2) + a2);
    float lambdaL = nDotV * sqrt(nDotL * nDotL * (1.0 - a2) + a2);
    return 0.5 / (lambdaV + lambdaL);
}
