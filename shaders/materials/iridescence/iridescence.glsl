// Thin-film iridescence (KHR_materials_iridescence): Belcour and Barla, "A Practical Extension to Microfacet Theory for
// the Modeling of Varying Iridescence" (2017).

// cos(2π cycles). The argument is reduced first, because hardware cosines are specified for one turn only.
float cosineOfCycles(float cycles) {
    return cos(2.0 * kPi * (cycles - floor(cycles + 0.5)));
}

// The colour, in linear Rec. 709, of a spectrum that oscillates with the optical path difference (nanometres): the
// Fourier transform of the XYZ sensitivities, fitted by Gaussians. `turns` is the phase shift of each channel, in
// cycles.
vec3 filmSensitivity(float pathDifference, vec3 turns) {
    float path = pathDifference * 1e-9;
    float phase = 2.0 * kPi * path;
    float p2 = phase * phase;
    // Each factor is value √(2π variance) of a Gaussian, divided by the common norm 1.0685e-7.
    float x = 0.846590 * cosineOfCycles(1.6810e6 * path + turns.x) * exp(-4.3278e9 * p2) +
              0.153868 * cosineOfCycles(2.2399e6 * path + turns.x) * exp(-4.5282e9 * p2);
    float y = 1.000222 * cosineOfCycles(1.7953e6 * path + turns.y) * exp(-9.3046e9 * p2);
    float z = 1.001122 * cosineOfCycles(2.2084e6 * path + turns.z) * exp(-6.6121e9 * p2);
    return vec3(3.2404542 * x - 1.5371385 * y - 0.4985314 * z, -0.9692660 * x + 1.8760108 * y + 0.0415560 * z,
                0.0556434 * x - 0.2040259 * y + 1.0572252 * z);
}

// The reflectance of a film of `thickness` nanometres over a base whose reflectance at normal incidence is `baseF0`, in
// [0, 1]. Below 0.03 nm the film's index fades to that of air, so that a film of no thickness has no effect. The loop
// of the extension's text is unrolled: two orders of interference.
vec3 iridescentFresnel(float cosine, vec3 baseF0, float filmIor, float thickness) {
    // The index minus 1. It has the digits that the index itself loses if it is near 1.
    float excess = (filmIor - 1.0) * smoothstep(0.0, 0.03, thickness);
    float ior = 1.0 + excess;
    // Snell's law gives (cosine² + ior² - 1) / ior².
    vec2 square = exactAddProduct(2.0 * excess, excess, excess);
    vec2 sum = exactAddProduct(square.x, cosine, cosine);
    if (sum.x <= 0.0) {
        return vec3(1.0);
    }
    float cosineInFilm = sqrt(max(sum.x + (sum.y + square.y), 0.0)) / ior;

    // This is the interface from air to film. A reflection off the denser side turns the phase by half a cycle.
    float root12 = excess / (2.0 + excess);
    float r12 = mix(root12 * root12, 1.0, schlickWeight(cosine));
    float t121 = 1.0 - r12;
    float turn21 = excess < 0.0 ? 0.0 : 0.5;

    // This is the interface from film to base. An F0 of 1 has no finite index; 0.9999 corresponds to one of 4e4.
    vec3 root = sqrt(clamp(baseF0, vec3(0.0), vec3(0.9999)));
    vec3 baseExcess = 2.0 * root / (vec3(1.0) - root);
    vec3 ratio = (baseExcess - vec3(excess)) / (baseExcess + vec3(2.0 + excess));
    vec3 r23 = mix(ratio * ratio, vec3(1.0), vec3(schlickWeight(cosineInFilm)));
    vec3 turns = vec3(turn21) + vec3(baseExcess.x < excess ? 0.5 : 0.0, baseExcess.y < excess ? 0.5 : 0.0,
                                     baseExcess.z < excess ? 0.5 : 0.0);

    // The series of internal reflections. The upper limit keeps its sum finite.
    vec3 r123 = clamp(r12 * r23, vec3(1e-5), vec3(0.9999));
    vec3 amplitude = sqrt(r123);
    vec3 series = t121 * t121 * r23 / (vec3(1.0) - r123);
    float pathDifference = 2.0 * ior * thickness * cosineInFilm;
    vec3 order1 = (series - vec3(t121)) * amplitude;
    vec3 order2 = order1 * amplitude;
    vec3 reflectance = vec3(r12) + series + 2.0 * order1 * filmSensitivity(pathDifference, turns) +
                       2.0 * order2 * filmSensitivity(2.0 * pathDifference, 2.0 * turns);
    return clamp(reflectance, vec3(0.0), vec3(1.0));
}
