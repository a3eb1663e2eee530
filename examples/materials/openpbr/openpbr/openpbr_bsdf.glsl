// Reads the parameters of OpenPBR.
#include "hit/surface_values.glsl"
#include "materials/metallic_roughness/metallic_roughness.glsl"

// Quotients by lengths and logarithms of colours stay finite.
const float kLeastDepth = 1e-9;
const float kDarkest = 1e-8;

void openPbrSurface(Hit hit, Features features, inout SurfaceValues values) {
    metallicRoughnessSurface(hit, features, values);
}

// Lobes have some width across the tangent.
const float kMostAnisotropy = 0.99;

// The alphas of a roughness and an anisotropy, along the tangent and across it.
vec2 openPbrAlphas(float roughness, float anisotropy) {
    float across = 1.0 - min(anisotropy, kMostAnisotropy);
    float along = roughness * roughness * sqrt(2.0 / (1.0 + across * across));
    return clamp(vec2(along, across * along), kMinAlpha, 1.0);
}

// The mean reflectance of a dielectric over the hemisphere: d'Eon (2021), eta in [1, 3].
float openPbrMeanFresnel(float eta) {
    eta = clamp(eta, 1.0, 3.0);
    return log((10893.0 * eta - 1438.2) / (-774.4 * eta * eta + 10212.0 * eta + 1.0));
}

// The indices for red, green and blue by Cauchy's formula, from that at 587.6 nm.
vec3 openPbrDispersed(float eta, float abbeNumber) {
    const vec3 kInverseSquares = 1.0 / (vec3(620.0, 540.0, 450.0) * vec3(620.0, 540.0, 450.0));
    const float kSpan = 1.0 / (486.1 * 486.1) - 1.0 / (656.3 * 656.3);
    float greater = max(eta, 1.0 / eta);
    float slope = (greater - 1.0) / (abbeNumber * kSpan);
    vec3 dispersed = max(greater + slope * (kInverseSquares - 1.0 / (587.6 * 587.6)), vec3(1.0));
    return eta < 1.0 ? 1.0 / dispersed : dispersed;
}

// The index of the base over that outside, with the reflectance that specular_weight asks for.
float openPbrIndex(float ior, float coat, float coatIor, float weight) {
    float eta = mix(ior, max(ior / coatIor, coatIor / ior), coat);
    float root = (eta - 1.0) / (eta + 1.0);
    // An index of 1e4 reflects all but 4e-4.
    float modulated = sign(root) * min(sqrt(weight) * abs(root), 0.9998);
    return (1.0 + modulated) / (1.0 - modulated);
}

// The reflectance that the tint at 82 degrees takes from Schlick's, as a factor of cosine (1 - cosine)^6.
vec3 openPbrDip(vec3 f0, vec3 tint) {
    const float kEdge = 1.0 / 7.0;
    return (f0 + (1.0 - f0) * schlickWeight(kEdge)) * (1.0 - tint) / (kEdge * pow(1.0 - kEdge, 6.0));
}

// Reads the coat, and finds how it darkens the base.
void openPbrCoat(Hit hit, vec3 baseAlbedo, float baseRoughness, float cosine, inout OpenPbr model) {
    vec3 color = max(GLINT_MATERIAL_OPEN_PBR_COAT_COLOR(hit), vec3(kDarkest));
    model.coatEta = GLINT_MATERIAL_OPEN_PBR_COAT_IOR(hit);
    model.coatAlpha = openPbrAlphas(GLINT_MATERIAL_OPEN_PBR_COAT_ROUGHNESS(hit),
                                    GLINT_MATERIAL_OPEN_PBR_COAT_ROUGHNESS_ANISOTROPY(hit));
    model.coatDepth = -0.5 * log(color);
    // The share of diffuse light that the coat's inner side turns back, and of light that a smooth base mirrors.
    float rough = 1.0 - (1.0 - openPbrMeanFresnel(model.coatEta)) / (model.coatEta * model.coatEta);
    float inner = mix(openPbrCoatFresnel(model.coatEta, cosine), rough, baseRoughness);
    vec3 darkening = (1.0 - inner) / max(1.0 - baseAlbedo * inner, vec3(1e-6));
    model.coatDarkening = mix(vec3(1.0), darkening, GLINT_MATERIAL_OPEN_PBR_COAT_DARKENING(hit));
}

// Reads the glass or the scattering sheet beyond the interface.
void openPbrGlass(Hit hit, Features features, inout OpenPbr model) {
    model.transmission = GLINT_MATERIAL_OPEN_PBR_TRANSMISSION_WEIGHT(hit);
    model.isInside = !model.isThin && model.transmission > 0.0 && showsBack(features) && !hit.frontFace;
    float depth = GLINT_MATERIAL_OPEN_PBR_TRANSMISSION_DEPTH(hit);
    vec3 color = GLINT_MATERIAL_OPEN_PBR_TRANSMISSION_COLOR(hit);
    model.tint = model.isThin || depth == 0.0 ? color : vec3(1.0);
    float scale = GLINT_MATERIAL_OPEN_PBR_TRANSMISSION_DISPERSION_SCALE(hit);
    if (scale > 0.0) {
        model.eta =
            openPbrDispersed(model.eta.y, GLINT_MATERIAL_OPEN_PBR_TRANSMISSION_DISPERSION_ABBE_NUMBER(hit) / scale);
    }
    if (model.isInside) {
        model.eta = 1.0 / model.eta;
#if GLINT_PATHS
        float way = distance(hit.position, hit.arrival.start);
#else
        float way = 0.0;
#endif
        if (depth > 0.0) {
            vec3 scattering = GLINT_MATERIAL_OPEN_PBR_TRANSMISSION_SCATTER(hit) / max(depth, kLeastDepth);
            vec3 absorption = -log(max(color, vec3(kDarkest))) / max(depth, kLeastDepth) - scattering;
            absorption -= min(smallest(absorption), 0.0);
            vec3 kept = volumeTransmittance(absorption, way);
            model.clear = kept * volumeTransmittance(scattering, way);
            model.scattered = model.transmission * (kept - model.clear);
            model.forward = 0.5 + 0.5 * GLINT_MATERIAL_OPEN_PBR_TRANSMISSION_SCATTER_ANISOTROPY(hit);
        }
    }
}

void openPbrBsdf(Hit hit, Features features, inout SurfaceValues values, inout Surface surface) {
    OpenPbr model;
    vec3 local = toSurface(surface, hit.view);
    local.z = max(local.z, 1e-3);
    model.along = vec2(1.0, 0.0);
    float anisotropy = 0.0;
    if (GLINT_HAS_OPEN_PBR_GROOVES(features)) {
        vec3 tangent;
        vec3 bitangent;
        tangentFrame(hit, kNormalTexture, features, tangent, bitangent);
        vec2 along = toSurface(surface, tangent).xy;
        model.along = dot(along, along) > 0.0 ? normalize(along) : model.along;
        anisotropy = GLINT_MATERIAL_OPEN_PBR_SPECULAR_ROUGHNESS_ANISOTROPY(hit);
    }
    model.coat = GLINT_HAS_OPEN_PBR_COAT(features) ? GLINT_MATERIAL_OPEN_PBR_COAT_WEIGHT(hit) : 0.0;
    float roughness = values.roughness;
    if (model.coat > 0.0) {
        // The lobes of slopes, of which the coat's counts twice.
        float coatRoughness = GLINT_MATERIAL_OPEN_PBR_COAT_ROUGHNESS(hit);
        float both = pow(roughness, 4.0) + 2.0 * pow(coatRoughness, 4.0);
        roughness = mix(roughness, pow(min(both, 1.0), 0.25), model.coat);
    }
    model.alpha = openPbrAlphas(roughness, anisotropy);
    float coatIor = GLINT_HAS_OPEN_PBR_COAT(features) ? GLINT_MATERIAL_OPEN_PBR_COAT_IOR(hit) : 1.0;
    float weight = GLINT_MATERIAL_OPEN_PBR_SPECULAR_WEIGHT(hit);
    float eta = openPbrIndex(GLINT_MATERIAL_OPEN_PBR_SPECULAR_IOR(hit), model.coat, coatIor, weight);
    model.eta = vec3(eta);

    vec3 color = values.color.rgb * GLINT_MATERIAL_OPEN_PBR_BASE_WEIGHT(hit);
    float share = GLINT_MATERIAL_OPEN_PBR_SUBSURFACE_WEIGHT(hit);
    vec3 subsurface = GLINT_MATERIAL_OPEN_PBR_SUBSURFACE_COLOR(hit);
    model.specularColor = GLINT_MATERIAL_OPEN_PBR_SPECULAR_COLOR(hit);
    model.metalness = values.metallic;
    model.metalF0 = color;
    model.metalDip = openPbrDip(color, model.specularColor);
    model.metalWeight = min(weight, 1.0);
    model.diffuse = color * (1.0 - share);
    model.subsurface = subsurface * share;
    model.diffuseRoughness = GLINT_MATERIAL_OPEN_PBR_BASE_DIFFUSE_ROUGHNESS(hit);

    model.isThin = GLINT_HAS_OPEN_PBR_GLASS(features) && GLINT_MATERIAL_OPEN_PBR_GEOMETRY_THIN_WALLED(hit) >= 0.5;
    model.sidedness = 1.0;
    model.transmission = 0.0;
    model.tint = vec3(1.0);
    model.isInside = false;
    model.clear = vec3(1.0);
    model.scattered = vec3(0.0);
    model.forward = 0.5;
    if (GLINT_HAS_OPEN_PBR_GLASS(features)) {
        openPbrGlass(hit, features, model);
        model.sidedness = model.isThin ? 0.5 - 0.5 * GLINT_MATERIAL_OPEN_PBR_SUBSURFACE_SCATTER_ANISOTROPY(hit) : 1.0;
    }

    float outside = mix(1.0, coatIor, model.coat);
    model.filmWeight = 0.0;
    model.filmIor = 1.0;
    model.filmThickness = 0.0;
    if (GLINT_HAS_OPEN_PBR_FILM(features)) {
        model.filmWeight = GLINT_MATERIAL_OPEN_PBR_THIN_FILM_WEIGHT(hit);
        model.filmIor = GLINT_MATERIAL_OPEN_PBR_THIN_FILM_IOR(hit) / outside;
        model.filmThickness = 1000.0 * outside * GLINT_MATERIAL_OPEN_PBR_THIN_FILM_THICKNESS(hit);
    }

    model.coatAlpha = vec2(kMinAlpha);
    model.coatEta = 1.0;
    model.coatDepth = vec3(0.0);
    model.coatDarkening = vec3(1.0);
    if (GLINT_HAS_OPEN_PBR_COAT(features)) {
        float f0 = dielectricF0(eta);
        vec3 opaque = mix(color, subsurface, share);
        vec3 albedo = mix(mix(opaque, vec3(1.0 - f0), model.transmission), color * model.metalWeight,
                          model.metalness);
        float rough = mix(mix(1.0, values.roughness, f0), values.roughness, model.metalness);
        openPbrCoat(hit, albedo, rough, local.z, model);
    }
    model.fuzz = 0.0;
    model.fuzzColor = vec3(0.0);
    model.fuzzRoughness = 1.0;
    if (GLINT_HAS_OPEN_PBR_FUZZ(features)) {
        model.fuzz = GLINT_MATERIAL_OPEN_PBR_FUZZ_WEIGHT(hit);
        model.fuzzColor = GLINT_MATERIAL_OPEN_PBR_FUZZ_COLOR(hit);
        model.fuzzRoughness = max(GLINT_MATERIAL_OPEN_PBR_FUZZ_ROUGHNESS(hit), kMinFuzzRoughness);
    }

    openPbrPrepare(model, normalize(local));
    surface.bsdf.diffuse = model.front;
    surface.bsdf.diffuseTransmitted = model.behind;
    surface.bsdf.layers.openPbr = model;
}
