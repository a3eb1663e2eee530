// Rough diffuse reflection that keeps its energy: Portsmouth, Kutz and Hill, "EON: A Practical Energy-Preserving Rough
// Diffuse BRDF" (JCGT 2025), as OpenPBR has it.
#include "bsdf/layer.glsl"

struct DiffuseRoughness {
    float roughness;
};

const float kEonSingle = 0.5 - 2.0 / (3.0 * kPi);    // the loss of Fujii's lobe at a roughness of 1
const float kEonMean = 2.0 / 3.0 - 28.0 / (15.0 * kPi);

// The share of a white sky that Fujii's lobe reflects at the first bounce, by the paper's fit, whose error is 1e-3.
float eonSingleAlbedo(float cosine, float roughness) {
    float t = 1.0 - cosine;
    float fit = t * (0.0571085289 + t * (0.491881867 + t * (-0.332181442 + t * 0.0714429953)));
    return (1.0 + roughness * fit) / (1.0 + kEonSingle * roughness);
}

vec3 diffuseRoughnessDiffuse(DiffuseRoughness lobe, vec3 albedo, vec3 view, vec3 l) {
    float r = lobe.roughness;
    float single = 1.0 / (1.0 + kEonSingle * r);
    float s = dot(view, l) - view.z * l.z;
    float lobeOfFujii = single * (1.0 + r * (s > 0.0 ? s / max(view.z, l.z) : s));
    float mean = single * (1.0 + kEonMean * r);
    float lossView = max(1.0 - eonSingleAlbedo(view.z, r), 0.0);
    float lossLight = max(1.0 - eonSingleAlbedo(l.z, r), 0.0);
    vec3 again = albedo * albedo * mean / (vec3(1.0) - albedo * (1.0 - mean));
    return albedo * lobeOfFujii + again * (lossView * lossLight / max(1.0 - mean, 1e-7));
}
