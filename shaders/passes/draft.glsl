// A draft of a primary surface: the base of its material, every light without its shadow, and the sky. It has little
// code, so a driver makes its shader soon. It sends no rays.
#include "hit/primary.glsl"
#include "hit/shade.glsl"

// The reflection of a base. Its BSDF loses the light that its microfacets scatter more than once.
struct Draft {
    vec3 normal;
    vec3 diffuse;
    vec3 f0;
    float alpha;
};

// The light of one light, without its shadow: GGX with the visibility of Kelemen and Szirmay-Kalos, "A Microfacet Based
// Coupled Specular-Matte BRDF Model" (2001).
vec3 draftLight(Draft draft, vec3 view, LightSample light) {
    float cosine = dot(draft.normal, light.direction);
    if (!(cosine > 0.0)) {
        return vec3(0.0);
    }
    vec3 h = normalize(view + light.direction);
    vec3 sine = cross(draft.normal, h);
    float height = dot(draft.normal, h);
    float alpha2 = draft.alpha * draft.alpha;
    float spread = alpha2 * height * height + dot(sine, sine);
    float facing = dot(view, h);
    float away = 1.0 - facing;
    vec3 fresnel = draft.f0 + (1.0 - draft.f0) * (away * away * away * away * away);
    // The lower bound of v·h keeps rays along the surface from dividing by 0.
    vec3 specular = fresnel * (alpha2 / (4.0 * kPi * spread * spread * max(facing * facing, 1e-4)));
    return (draft.diffuse * kInversePi + specular) * light.irradiance * cosine;
}

// The sky's light, with the Fresnel of a rough surface: Lagarde, "Memo on Fresnel equations" (2011).
vec3 draftSky(Draft draft, vec3 view, float roughness) {
    float away = 1.0 - clamp(dot(draft.normal, view), 0.0, 1.0);
    vec3 grazing = max(vec3(1.0 - roughness), draft.f0);
    vec3 fresnel = draft.f0 + (grazing - draft.f0) * (away * away * away * away * away);
    return draft.diffuse * hostSkyIrradianceOverPi(draft.normal) +
           fresnel * hostSkyAround(reflect(-view, draft.normal), roughness);
}

vec3 draftRadiance(Hit hit, Features features) {
    changeCoordinates(hit, features);
    SurfaceValues values = valuesAt(hit, features);
    if (hasLobe(features, GLINT_UNLIT)) {
        return values.color.rgb;
    }
    Draft draft;
    draft.normal = values.normal * facing(hit, features);
    draft.diffuse = values.color.rgb * (1.0 - values.metallic);
    draft.f0 = mix(values.f0, values.color.rgb, values.metallic);
    draft.alpha = max(values.roughness * values.roughness, kMinAlpha);
    vec3 sum = runEmissionStage(hit, features) + draftSky(draft, hit.view, values.roughness);
    uint lights = hostLightCount(hit.position);
    for (uint i = 0u; i < lights; ++i) {
        HostLight light = lightOfHost(hit, features, i);
#if GLINT_SHARED_LIGHTS
        if (isShared(light)) {
            continue;
        }
#endif
        sum += draftLight(draft, hit.view, hostSampleLight(light, hit.position));
    }
    return sum;
}
