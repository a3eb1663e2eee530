// The textbook forms of formulas, with the same arguments as the probes that they are named after.

PROBE(TextbookBuildBasis) {
    vec3 n = VEC3(0);
    vec3 up = abs(n.z) < 0.999 ? vec3(0.0, 0.0, 1.0) : vec3(1.0, 0.0, 0.0);
    vec3 tangent = normalize(cross(up, n));
    vec3 bitangent = cross(n, tangent);
    WRITE3(0, tangent);
    WRITE3(3, bitangent);
}

// Two angles.
PROBE(TextbookOctahedral) {
    vec3 n = VEC3(0);
    float theta = acos(clamp(n.z, -1.0, 1.0));
    float phi = n.x == 0.0 && n.y == 0.0 ? 0.0 : atan(n.y, n.x);
    vec3 v = vec3(sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta));
    WRITE3(0, v);
}

PROBE(TextbookAddProduct) {
    o[0] = i[0] + i[1] * i[2];
}

PROBE(TextbookDifferenceOfProducts) {
    o[0] = i[0] * i[1] - i[2] * i[3];
}

PROBE(TextbookAccurateDot) {
    o[0] = dot(VEC3(0), VEC3(3));
}

PROBE(TextbookInterfacePassed) {
    float cosine = i[4];
    if (i[5] < 1.0) {
        float sine = sqrt(1.0 - cosine * cosine) / i[5];
        cosine = sine < 1.0 ? sqrt(1.0 - sine * sine) : -1.0;
    }
    float f0 = max(i[0], max(i[1], i[2]));
    o[0] = cosine < 0.0 ? 0.0 : 1.0 - (f0 + (i[3] - f0) * pow(1.0 - cosine, 5.0));
    o[1] = cosine < 0.0 ? 0.0 : 1.0;
}

PROBE(TextbookRefractedCosine2) {
    float sine = sqrt(1.0 - i[0] * i[0]) / i[1];
    o[0] = sine < 1.0 ? sqrt(1.0 - sine * sine) : 0.0;
    o[1] = sine < 1.0 ? 1.0 : 0.0;
}

PROBE(TextbookFresnelSchlick) {
    vec3 f = VEC3(0) + (vec3(i[3]) - VEC3(0)) * pow(1.0 - i[4], 5.0);
    WRITE3(0, f);
}

PROBE(TextbookFresnelInterface) {
    float cosine = i[4];
    float eta = i[5];
    float reflected = 1.0;
    if (eta < 1.0) {
        float sine = sqrt(1.0 - cosine * cosine) / eta;
        cosine = sine < 1.0 ? sqrt(1.0 - sine * sine) : 0.0;
        reflected = sine < 1.0 ? 0.0 : 1.0;
    }
    vec3 f = VEC3(0) + (vec3(i[3]) - VEC3(0)) * pow(1.0 - cosine, 5.0);
    f = mix(f, vec3(1.0), reflected);
    WRITE3(0, f);
    o[3] = reflected;
}

// Walter et al. 2007, equation 33, through the cosine.
PROBE(TextbookGgxDistribution) {
    float nDotH = i[2];
    float a2 = i[3] * i[3];
    float d = nDotH * nDotH * (a2 - 1.0) + 1.0;
    o[0] = nDotH > 0.0 ? a2 / (kPi * d * d) : 0.0;
    o[1] = 0.0;
}

// Heitz 2014, equations 72 and 99: lambdas of tangents, over the cosines.
PROBE(TextbookGgxVisibility) {
    float nDotL = i[2];
    float nDotV = i[5];
    float a2 = i[6] * i[6];
    float tangentL2 = (1.0 - nDotL * nDotL) / (nDotL * nDotL);
    float tangentV2 = (1.0 - nDotV * nDotV) / (nDotV * nDotV);
    float lambdaL = 0.5 * (sqrt(1.0 + a2 * tangentL2) - 1.0);
    float lambdaV = 0.5 * (sqrt(1.0 + a2 * tangentV2) - 1.0);
    o[0] = 1.0 / ((1.0 + lambdaL + lambdaV) * (4.0 * nDotL * nDotV));
}

// Walter et al. 2007, equations 16 and 20, from the cosines.
PROBE(TextbookRefractedTransmission) {
    vec3 v = VEC3(0);
    vec3 l = VEC3(3);
    float eta = i[8];
    vec3 h = -normalize(v + eta * l);
    h = h.z < 0.0 ? -h : h;
    float hDotV = dot(h, v);
    float hDotL = dot(h, l);
    o[0] = 0.0;
    o[1] = 0.0;
    o[2] = 0.0;
    if (refracts(eta) && hDotV > 0.0 && hDotL < 0.0) {
        vec2 a2 = vec2(i[6] * i[6], i[7] * i[7]);
        float d = h.x * h.x / a2.x + h.y * h.y / a2.y + h.z * h.z;
        float distribution = 1.0 / (kPi * i[6] * i[7] * d * d);
        float spread = eta * hDotL + hDotV;
        float lambdaV = 0.5 * (sqrt(1.0 + (a2.x * v.x * v.x + a2.y * v.y * v.y) / (v.z * v.z)) - 1.0);
        float lambdaL = 0.5 * (sqrt(1.0 + (a2.x * l.x * l.x + a2.y * l.y * l.y) / (l.z * l.z)) - 1.0);
        float masking = 1.0 / (1.0 + lambdaV + lambdaL);
        o[0] = abs(hDotV * hDotL / (v.z * l.z)) * eta * eta * masking * distribution / (spread * spread) * abs(l.z);
        o[2] = 1.0;
    }
}

// The half vector normalised, the NDF through its cosine.
PROBE(TextbookClearcoatLobe) {
    vec3 n = VEC3(0);
    vec3 h = normalize(VEC3(3) + VEC3(6));
    float nDotV = dot(n, VEC3(3));
    float nDotL = dot(n, VEC3(6));
    float nDotH = dot(n, h);
    float a2 = i[9] * i[9];
    bool lit = nDotV >= kMinViewCosine && nDotL >= kMinViewCosine;
    float d = nDotH * nDotH * (a2 - 1.0) + 1.0;
    float roots = nDotL * sqrt(nDotV * nDotV * (1.0 - a2) + a2) + nDotV * sqrt(nDotL * nDotL * (1.0 - a2) + a2);
    o[0] = lit ? a2 / (kPi * d * d) * 0.5 / roots : 0.0;
    o[1] = lit ? 1.0 : 0.0;
}

// Akenine-Möller et al. 2021, on anisotropic lookups: both axes by projection, divided by their part that is
// perpendicular to the ray.
PROBE(TextbookConeAxes) {
    vec3 direction = VEC3(0);
    vec3 n = VEC3(3);
    vec3 along = direction - dot(n, direction) * n;
    along = along / length(along - dot(direction, along) * direction) * max(abs(dot(n, direction)), 0.01);
    vec3 across = cross(n, along);
    across = across / length(across - dot(direction, across) * direction);
    WRITE3(0, across);
    WRITE3(3, along);
    o[6] = 0.0;
}

// Uses squares of the area, without scaling.
PROBE(TextbookInEdges) {
    vec3 normal = cross(VEC3(3), VEC3(6));
    o[0] = dot(cross(VEC3(0), VEC3(6)), normal) / dot(normal, normal);
    o[1] = dot(cross(VEC3(3), VEC3(0)), normal) / dot(normal, normal);
    o[2] = 0.0;
}

// The sum, divided once.
PROBE(TextbookRunningMean) {
    float sum = 0.0;
    uint count = uint(i[2]);
    for (uint k = 0u; k < count; ++k) {
        sum += givenSample(i[0], i[1], i[3], k);
    }
    o[0] = sum / float(count);
}
