// OpenPBR 1.1 (Academy Software Foundation): metal, glossy-diffuse, subsurface and translucent base under a thin film,
// a coat and fuzz. Layers are mixed by the albedo-scaling of the specification: what lies below gets the share that the
// layer does not reflect of the view's light. So the model is not reciprocal, and its energy is exact.
//
// The formulas are those of the specification, but for these approximations:
//   - Albedos of microfacets are Glint's fits (bsdf/albedo.glsl), with the Fresnel reflectance at the cosine at which
//     Schlick's weight has its mean. Light of several bounces between facets is added as by Kulla and Conty (2017) to
//     the opaque base. Refraction has the first bounce alone.
//   - A thin film on metal is Glint's (Belcour and Barla 2017, with Schlick's approximation). That on a dielectric has
//     the reflectance of dielectrics, of both polarisations together.
//   - Subsurface light leaves where it enters, by the law of the diffuse lobe with subsurface_color: the limit of
//     subsurface_radius 0. The light that a large surface sends back is right, its blur is missing.
//   - A medium that scatters lets the unscattered light through, exp(-mu_t d) over the way d through the object. The
//     share that scatters and is not absorbed, (1 - exp(-mu_s d)) exp(-mu_a d), leaves at the end of the straight way
//     in a cosine lobe: (1 + g) / 2 of it outwards, the rest back.
//   - specular_weight above 1 acts on the dielectric alone.
//   - Emission is not tinted by coat and fuzz. Coat and base have one normal and one tangent.
//
// A ray within an object is one that meets the back of a surface, so objects of glass are closed and double-sided.
#include "bsdf/albedo.glsl"
#include "bsdf/ggx.glsl"
#include "bsdf/model.glsl"
#include "bsdf/transmission.glsl"
#include "materials/iridescence/iridescence.glsl"

struct OpenPbr {
    vec2 along;             // the tangent in the frame of the surface: a unit vector
    vec2 alpha;             // of the base, along the tangent and across it
    vec3 eta;               // index beyond the base's facets over that on the viewer's side: red, green, blue
    float metalness;
    vec3 metalF0;           // F82-tint: reflectance at normal incidence, and what its dip takes
    vec3 metalDip;
    float metalWeight;
    vec3 specularColor;
    vec3 diffuse;           // colours times weights
    vec3 subsurface;
    float sidedness;        // the share of the subsurface light in front
    float diffuseRoughness;
    float transmission;
    vec3 tint;              // of light that passes the interface
    bool isThin;
    bool isInside;          // the viewer is within the object
    vec3 clear;             // within: the share that reaches the viewer without scattering
    vec3 scattered;         // and the share that scatters on the way
    float forward;          // of that, outwards
    float filmWeight;
    float filmIor;          // over that outside
    float filmThickness;    // nanometres times the index outside
    float coat;             // its weight
    vec2 coatAlpha;
    float coatEta;
    vec3 coatDepth;         // half of -ln(coat_color)
    vec3 coatDarkening;
    float fuzz;             // its weight
    vec3 fuzzColor;
    float fuzzRoughness;
    // openPbrPrepare() sets the others:
    vec3 view;              // along the tangent, across it, along the normal
    float loss;             // of white microfacets, at the view and in the mean
    float meanLoss;
    vec3 dielectricPassed;  // 1 - the interface's albedo, with all bounces
    vec3 metalAgain;        // light of later bounces over the loss
    vec3 dielectricAgain;
    float coatPassed;       // 1 - the coat's albedo
    float fuzzAlbedo;
    vec3 fuzzShape;         // the transform of its lobe, a and b; the sine of the view's angle
    // Chances of the lobes: fuzz, coat, reflection by the base, cosine lobe in front; refraction, cosine lobe behind.
    vec4 chances;
    vec2 chancesBehind;
    vec3 front;             // shares of a white sky
    vec3 behind;
};

// Schlick's weight has its mean over the hemisphere, 1/21, at this cosine.
const float kMeanCosine = 0.456;
const float kEonSingle = 0.5 - 2.0 / (3.0 * kPi);  // the loss of Fujii's lobe at a roughness of 1
const float kEonMean = 2.0 / 3.0 - 28.0 / (15.0 * kPi);
const float kMinFuzzRoughness = 0.07;              // the fits of fuzz hold from here

// --- Fresnel

// The squared cosine beyond an interface of this relative index. It is at most 0 beyond the critical angle.
vec3 beyondCosine2(vec3 cosine, vec3 eta) {
    return 1.0 - (1.0 - cosine) * (1.0 + cosine) / (eta * eta);
}

// Unpolarised reflectance of a dielectric: Walter et al. (2007), equation 22. Light from the denser side has that of
// the angle beyond.
vec3 dielectricFresnel(vec3 cosine, vec3 eta) {
    bvec3 fromDenser = lessThan(eta, vec3(1.0));
    vec3 beyond2 = beyondCosine2(cosine, eta);
    vec3 rarer = sqrt(max(mix(cosine * cosine, beyond2, fromDenser), vec3(0.0)));
    eta = max(eta, 1.0 / eta);
    vec3 excess = (eta - 1.0) * (eta + 1.0);
    vec3 g = sqrt(excess + rarer * rarer);
    vec3 sum = g + rarer;
    vec3 a = excess / max(sum * sum, vec3(1e-12));
    vec3 b = (rarer * sum - 1.0) / (rarer * (g - rarer) + 1.0);
    vec3 fresnel = min(0.5 * a * a * (1.0 + b * b), vec3(1.0));
    return mix(fresnel, vec3(1.0), lessThanEqual(beyond2, vec3(0.0)));
}

// A film of an index and a thickness (nanometres) on a dielectric, all relative to the index outside, from there:
// Belcour and Barla (2017), with two orders of interference and the reflectances of both polarisations together.
vec3 filmFresnel(float cosine, float ior, float thickness, vec3 eta) {
    float inFilm2 = beyondCosine2(vec3(cosine), vec3(ior)).x;
    if (inFilm2 <= 0.0) {
        return vec3(1.0);
    }
    float inFilm = sqrt(inFilm2);
    float r12 = dielectricFresnel(vec3(cosine), vec3(ior)).x;
    vec3 r23 = dielectricFresnel(vec3(inFilm), eta / ior);
    // A reflection off the denser side turns the phase by half a cycle.
    vec3 turns = vec3(ior < 1.0 ? 0.0 : 0.5) + mix(vec3(0.0), vec3(0.5), lessThan(eta, vec3(ior)));
    vec3 both = clamp(r12 * r23, vec3(1e-10), vec3(0.9999));
    vec3 series = (1.0 - r12) * (1.0 - r12) * r23 / (1.0 - both);
    vec3 order = (series - vec3(1.0 - r12)) * sqrt(both);
    float path = 2.0 * ior * thickness * inFilm;
    vec3 reflected = vec3(r12) + series + 2.0 * order * filmSensitivity(path, turns) +
                     2.0 * order * sqrt(both) * filmSensitivity(2.0 * path, 2.0 * turns);
    return clamp(reflected, vec3(0.0), vec3(1.0));
}

// The interface of the base at a facet that is seen under this cosine.
vec3 openPbrInterface(OpenPbr model, float cosine) {
    vec3 fresnel = dielectricFresnel(vec3(cosine), model.eta);
    if (model.filmWeight > 0.0) {
        vec3 outside2 = model.isInside ? beyondCosine2(vec3(cosine), model.eta) : vec3(cosine * cosine);
        vec3 film = filmFresnel(sqrt(max(outside2.y, 0.0)), model.filmIor, model.filmThickness,
                                model.isInside ? 1.0 / model.eta : model.eta);
        fresnel = mix(fresnel, mix(film, vec3(1.0), lessThanEqual(outside2, vec3(0.0))), model.filmWeight);
    }
    return fresnel;
}

// A sheet of the translucent base: all light that its two sides reflect and, in `passed`, let through.
vec3 openPbrSheet(OpenPbr model, vec3 fresnel, out vec3 passed) {
    vec3 again = fresnel * model.tint;
    vec3 open = (1.0 - fresnel) * (1.0 - fresnel) / max(1.0 - again * again, vec3(1e-6));
    passed = open * model.tint;
    return fresnel + open * again * model.tint;
}

// The share that a facet of the dielectric reflects of the light from the viewer's side.
vec3 openPbrDielectric(OpenPbr model, float cosine) {
    vec3 fresnel = openPbrInterface(model, cosine);
    if (model.isThin && model.transmission > 0.0) {
        vec3 passed;
        fresnel = mix(fresnel, openPbrSheet(model, fresnel, passed), model.transmission);
    }
    return fresnel;
}

// F82-tint: Kutz, Hašan and Edmondson (2021).
vec3 openPbrMetal(OpenPbr model, float cosine) {
    float m = clamp(1.0 - cosine, 0.0, 1.0);
    float m2 = m * m;
    vec3 fresnel = model.metalF0 + (1.0 - model.metalF0) * (m2 * m2 * m) - model.metalDip * (cosine * m2 * m2 * m2);
    if (model.filmWeight > 0.0) {
        fresnel = mix(fresnel, iridescentFresnel(cosine, model.metalF0, model.filmIor, model.filmThickness),
                      model.filmWeight);
    }
    return clamp(fresnel, vec3(0.0), vec3(1.0)) * model.metalWeight;
}

// --- Diffuse: Portsmouth, Kutz and Hill, "EON: A Practical Energy-Preserving Rough Diffuse BRDF" (2025)

float eonSingle(float cosine, float roughness) {
    float t = 1.0 - cosine;
    float fit = t * (0.0571085289 + t * (0.491881867 + t * (-0.332181442 + t * 0.0714429953)));
    return (1.0 + roughness * fit) / (1.0 + kEonSingle * roughness);
}

float eonMean(float roughness) {
    return (1.0 + kEonMean * roughness) / (1.0 + kEonSingle * roughness);
}

vec3 eonAgain(vec3 color, float mean) {
    return color * color * mean / (1.0 - color * (1.0 - mean));
}

// π times the BRDF.
vec3 openPbrDiffuse(vec3 color, float roughness, vec3 v, vec3 l) {
    float s = dot(v, l) - v.z * l.z;
    float single = (1.0 + roughness * (s > 0.0 ? s / max(v.z, l.z) : s)) / (1.0 + kEonSingle * roughness);
    float mean = eonMean(roughness);
    float losses = max(1.0 - eonSingle(v.z, roughness), 0.0) * max(1.0 - eonSingle(l.z, roughness), 0.0);
    return color * single + eonAgain(color, mean) * (losses / max(1.0 - mean, 1e-7));
}

vec3 openPbrDiffuseAlbedo(vec3 color, float roughness, float cosine) {
    float single = eonSingle(cosine, roughness);
    return color * single + eonAgain(color, eonMean(roughness)) * max(1.0 - single, 0.0);
}

// --- Fuzz: Zeltner, Burley and Chiang, "Practical Multiple-Scattering Sheen Using Linearly Transformed Cosines"
// (2022), with the rational fits that MaterialX has for the coefficients

void openPbrPrepareFuzz(inout OpenPbr model) {
    float x = model.view.z;
    float y = model.fuzzRoughness;
    float spread = y * (0.0206607 + 1.58491 * y) / (0.0379424 + y * (1.32227 + y));
    float centre = y * (-0.193854 + y * (-1.14885 + y * (1.7932 - 0.95943 * y * y))) / (0.046391 + y);
    float offset = y * (0.000654023 + (-0.0207818 + 0.119681 * y) * y) / (1.26264 + y * (-1.92021 + y));
    float distance = (x - centre) / spread;
    model.fuzzAlbedo = clamp(exp(-0.5 * distance * distance) / (spread * sqrt(2.0 * kPi)) + offset, 0.0, 1.0);
    model.fuzzShape = vec3((2.58126 * x + 0.813703 * y) * y / (1.0 + 0.310327 * x * x + 2.60994 * x * y),
                           sqrt(1.0 - x) * (y - 1.0) * y * y * y /
                               (0.0000254053 + 1.71228 * x - 1.71506 * x * y + 1.34174 * y * y),
                           length(model.view.xy));
}

// The direction of the view in the plane of the surface.
vec2 openPbrAcross(OpenPbr model) {
    return model.fuzzShape.z > 0.0 ? model.view.xy / model.fuzzShape.z : vec2(1.0, 0.0);
}

float openPbrFuzzDensity(OpenPbr model, vec3 l) {
    vec2 across = openPbrAcross(model);
    vec2 local = vec2(dot(across, l.xy), across.x * l.y - across.y * l.x);
    vec3 cosineLobe = vec3(model.fuzzShape.x * local.x + model.fuzzShape.y * l.z, model.fuzzShape.x * local.y, l.z);
    float ratio = model.fuzzShape.x / dot(cosineLobe, cosineLobe);
    return l.z * kInversePi * ratio * ratio;
}

// --- The parts together

// Turns a direction of the surface's frame to the tangent.
vec3 openPbrTurned(OpenPbr model, vec3 d) {
    return vec3(dot(model.along, d.xy), model.along.x * d.y - model.along.y * d.x, d.z);
}

float openPbrCoatFresnel(float eta, float cosine) {
    return dielectricFresnel(vec3(cosine), vec3(eta)).x;
}

// The cosine of a direction within the coat.
float openPbrCoatCosine(OpenPbr model, float cosine) {
    return sqrt(max(1.0 - (1.0 - cosine * cosine) / (model.coatEta * model.coatEta), 1e-4));
}

// The share of the base's light that coat and fuzz let out. `ways` is the sum of the lengths in the coat, over its
// thickness.
vec3 openPbrLayered(OpenPbr model, float ways) {
    vec3 coated = model.coatPassed * model.coatDarkening * exp(-model.coatDepth * ways);
    return mix(vec3(1.0), coated, model.coat) * (1.0 - model.fuzz * model.fuzzAlbedo);
}

// The cosine at which Schlick's weight has the lobe's mean.
float meanCosine(vec2 lossBias) {
    return 1.0 - pow(clamp(lossBias.y / max(1.0 - lossBias.x, 1e-6), 0.0, 1.0), 0.2);
}

vec3 laterBounces(vec3 fresnel, float meanLoss) {
    return GLINT_ENERGY_COMPENSATION != 0 ? fresnel * fresnel * (1.0 - meanLoss) / (1.0 - fresnel * meanLoss)
                                          : vec3(0.0);
}

// Bends the view at a facet. An interface whose indices are alike lets it go straight on.
bool isStraight(OpenPbr model) {
    return model.isThin || !refracts(model.eta.y);
}

vec2 straightAlpha(OpenPbr model) {
    return model.isThin ? model.alpha : vec2(kMinAlpha);
}

void openPbrPrepare(inout OpenPbr model, vec3 view) {
    model.view = openPbrTurned(model, view);
    vec2 lossBias = anisotropicGgxAlbedo(model.view, model.alpha);
    float cosine = meanCosine(lossBias);
    model.loss = lossBias.x;
    model.meanLoss = anisotropicGgxMeanAlbedo(model.alpha).x;
    float once = 1.0 - model.loss;
    vec3 atView = openPbrInterface(model, cosine);
    vec3 dielectric = openPbrDielectric(model, cosine) * once;
    vec3 metal = openPbrMetal(model, cosine) * once;
    model.metalAgain = laterBounces(openPbrMetal(model, kMeanCosine), model.meanLoss);
    model.dielectricAgain = laterBounces(openPbrDielectric(model, kMeanCosine), model.meanLoss);
    if (model.isInside) {
        model.dielectricAgain = vec3(0.0);
    }
    model.dielectricPassed = max(1.0 - dielectric - model.dielectricAgain * model.loss, vec3(0.0));
    model.coatPassed = 1.0;
    if (model.coat > 0.0) {
        vec2 coatLossBias = anisotropicGgxAlbedo(model.view, model.coatAlpha);
        model.coatPassed = 1.0 - openPbrCoatFresnel(model.coatEta, meanCosine(coatLossBias)) * (1.0 - coatLossBias.x);
    }
    model.fuzzAlbedo = 0.0;
    if (model.fuzz > 0.0) {
        openPbrPrepareFuzz(model);
    }

    // The shares of a white sky.
    float dielectricShare = 1.0 - model.metalness;
    vec3 reflected = model.metalness * metal + dielectricShare * model.specularColor * dielectric;
    vec3 again = model.loss * (model.metalness * model.metalAgain +
                               dielectricShare * model.specularColor * model.dielectricAgain);
    vec3 opaque = dielectricShare * (1.0 - model.transmission) * model.dielectricPassed;
    vec3 scatter = openPbrDiffuseAlbedo(model.diffuse, model.diffuseRoughness, model.view.z);
    vec3 below = openPbrDiffuseAlbedo(model.subsurface, model.diffuseRoughness, model.view.z);
    vec3 diffuse = again + opaque * (scatter + below * model.sidedness);
    vec3 behind = opaque * below * (1.0 - model.sidedness);
    vec3 refracted = vec3(0.0);
    if (model.transmission > 0.0) {
        vec3 passed = (1.0 - atView) * model.tint;
        if (model.isThin) {
            openPbrSheet(model, atView, passed);
        }
        refracted = dielectricShare * model.transmission * passed * (model.isThin || !isStraight(model) ? once : 1.0);
    }
    vec3 reflectedByCoat = vec3(0.0);
    vec3 reflectedByFuzz = vec3(0.0);
    if (model.isInside) {
        reflected = dielectricShare * dielectric * model.clear;
        refracted *= model.clear;
        diffuse = dielectricShare * model.scattered * (1.0 - model.forward);
        behind = dielectricShare * model.scattered * model.forward;
    } else {
        float way = 1.0 / openPbrCoatCosine(model, model.view.z);
        vec3 layered = openPbrLayered(model, way + 1.1);
        vec3 layeredOnce = openPbrLayered(model, way);
        reflected *= layered;
        diffuse *= layered;
        behind *= layeredOnce;
        refracted *= layeredOnce;
        reflectedByFuzz = model.fuzzColor * (model.fuzz * model.fuzzAlbedo);
        reflectedByCoat = vec3((1.0 - model.fuzz * model.fuzzAlbedo) * model.coat * (1.0 - model.coatPassed));
    }
    model.front = reflected + diffuse + reflectedByCoat + reflectedByFuzz;
    model.behind = behind + refracted;
    // Rough facets refract where the view alone would be reflected in whole.
    float bent = luminance(refracted) + (model.transmission > 0.0 ? 0.1 * luminance(reflected) * model.alpha.x : 0.0);
    model.chances = vec4(luminance(reflectedByFuzz), luminance(reflectedByCoat), luminance(reflected),
                         luminance(diffuse));
    model.chancesBehind = vec2(bent, luminance(behind));
    float sum = dot(model.chances, vec4(1.0)) + model.chancesBehind.x + model.chancesBehind.y;
    if (sum < 1e-30) {
        model.chances = vec4(0.0, 0.0, 0.0, 1.0);
        model.chancesBehind = vec2(0.0);
    } else {
        model.chances /= sum;
        model.chancesBehind /= sum;
    }
}

// A lobe of microfacets times n·l.
float openPbrLobe(vec3 v, vec3 l, vec2 alpha, out float cosine) {
    vec3 sum = v + l;
    float size = sqrt(dot(sum, sum));
    cosine = min(0.5 * size, 1.0);
    return ggxDistribution(sum / size, alpha) * ggxVisibility(l, v, alpha) * l.z;
}

// The light that passes the facets, times |n·l|; l.z < 0.
vec3 openPbrRefracted(OpenPbr model, vec3 l) {
    vec3 lobe = vec3(0.0);
    float cosine;
    if (isStraight(model)) {
        lobe = vec3(thinTransmission(model.view, l, straightAlpha(model), cosine));
        vec3 fresnel = openPbrInterface(model, cosine);
        vec3 passed = (1.0 - fresnel) * model.tint;
        if (model.isThin) {
            openPbrSheet(model, fresnel, passed);
        }
        return lobe * passed;
    }
    bool spreads = model.eta.x != model.eta.z;
    for (int channel = spreads ? 0 : 1; channel < (spreads ? 3 : 2); ++channel) {
        RefractingFacet facet;
        float eta = channelOf(model.eta, channel);
        if (refractionHalfVector(model.view, l, eta, facet)) {
            float one = 4.0 * ggxVisibility(l, model.view, model.alpha) * ggxDistribution(facet.h, model.alpha) *
                        facet.cosineV * facet.cosineL * facet.spread * -l.z;
            vec3 passed = 1.0 - openPbrInterface(model, facet.cosineV);
            lobe = spreads ? withChannel(lobe, channel, one * channelOf(passed, channel)) : one * passed;
        }
    }
    return lobe * model.tint;
}

vec3 openPbrBehind(OpenPbr model, vec3 l) {
    float dielectricShare = 1.0 - model.metalness;
    vec3 light = vec3(0.0);
    if (model.transmission > 0.0) {
        light = dielectricShare * model.transmission * openPbrRefracted(model, l);
    }
    if (model.isInside) {
        // Without the light that the coat turns back.
        vec3 way = exp(-model.coatDepth / openPbrCoatCosine(model, -l.z));
        light *= model.clear * mix(vec3(1.0), way, model.coat);
        return light + dielectricShare * model.scattered * (model.forward * kInversePi * -l.z);
    }
    vec3 sheet = openPbrDiffuse(model.subsurface, model.diffuseRoughness, model.view, vec3(l.xy, -l.z));
    light += dielectricShare * (1.0 - model.transmission) * (1.0 - model.sidedness) * model.dielectricPassed * sheet *
             (kInversePi * -l.z);
    return light * openPbrLayered(model, 1.0 / openPbrCoatCosine(model, model.view.z));
}

vec3 openPbrEvaluate(OpenPbr model, vec3 view, vec3 direction) {
    vec3 l = openPbrTurned(model, direction);
    if (l.z <= 0.0) {
        return openPbrBehind(model, l);
    }
    float dielectricShare = 1.0 - model.metalness;
    float cosine;
    float lobe = openPbrLobe(model.view, l, model.alpha, cosine);
    if (model.isInside) {
        return dielectricShare * (openPbrInterface(model, cosine) * model.clear * lobe +
                                  model.scattered * ((1.0 - model.forward) * kInversePi * l.z));
    }
    float again = model.loss * anisotropicGgxAlbedo(l, model.alpha).x * l.z * kInversePi / max(model.meanLoss, 1e-12);
    vec3 metal = openPbrMetal(model, cosine) * lobe + model.metalAgain * again;
    vec3 dielectric = openPbrDielectric(model, cosine) * lobe + model.dielectricAgain * again;
    vec3 opaque = openPbrDiffuse(model.diffuse, model.diffuseRoughness, model.view, l) +
                  model.sidedness * openPbrDiffuse(model.subsurface, model.diffuseRoughness, model.view, l);
    vec3 base = model.metalness * metal +
                dielectricShare * (model.specularColor * dielectric +
                                   (1.0 - model.transmission) * model.dielectricPassed * opaque * (kInversePi * l.z));
    float ways = 1.0 / openPbrCoatCosine(model, model.view.z) + 1.0 / openPbrCoatCosine(model, l.z);
    vec3 light = base * openPbrLayered(model, ways);
    if (model.coat > 0.0) {
        float coated = openPbrLobe(model.view, l, model.coatAlpha, cosine);
        light += (1.0 - model.fuzz * model.fuzzAlbedo) * model.coat * coated *
                 openPbrCoatFresnel(model.coatEta, cosine);
    }
    if (model.fuzz > 0.0) {
        light += model.fuzzColor * (model.fuzz * model.fuzzAlbedo * openPbrFuzzDensity(model, l));
    }
    return light;
}

float openPbrDensity(OpenPbr model, vec3 view, vec3 direction) {
    vec3 l = openPbrTurned(model, direction);
    if (l.z <= 0.0) {
        float density = model.chancesBehind.y * -l.z * kInversePi;
        if (model.chancesBehind.x > 0.0 && l.z < 0.0) {
            float bent = 0.0;
            if (isStraight(model)) {
                bent = mirroredPdf(model.view, normalize(model.view + vec3(l.xy, -l.z)), straightAlpha(model));
            } else {
                bool spreads = model.eta.x != model.eta.z;
                for (int channel = spreads ? 0 : 1; channel < (spreads ? 3 : 2); ++channel) {
                    RefractingFacet facet;
                    if (refractionHalfVector(model.view, l, channelOf(model.eta, channel), facet)) {
                        bent += visibleNormalPdf(model.view, facet.h, model.alpha) * facet.spread * facet.cosineL *
                                (spreads ? 1.0 / 3.0 : 1.0);
                    }
                }
            }
            density += model.chancesBehind.x * bent;
        }
        return density;
    }
    float density = model.chances.w * l.z * kInversePi;
    vec3 sum = model.view + l;
    vec3 h = sum / max(sqrt(dot(sum, sum)), 1e-12);
    density += model.chances.z * mirroredPdf(model.view, h, model.alpha);
    if (model.coat > 0.0) {
        density += model.chances.y * mirroredPdf(model.view, h, model.coatAlpha);
    }
    if (model.fuzz > 0.0) {
        density += model.chances.x * openPbrFuzzDensity(model, l);
    }
    return density;
}

vec3 openPbrSampleFuzz(OpenPbr model, vec2 u) {
    vec3 cosineLobe = sampleCosine(u);
    vec2 local = vec2(cosineLobe.x - model.fuzzShape.y * cosineLobe.z, cosineLobe.y) / model.fuzzShape.x;
    vec2 across = openPbrAcross(model);
    return normalize(vec3(local.x * across + local.y * vec2(-across.y, across.x), cosineLobe.z));
}

vec3 openPbrSampleRefracted(OpenPbr model, vec2 u) {
    if (isStraight(model)) {
        vec3 l = reflectAbout(model.view, sampleVisibleNormal(model.view, straightAlpha(model), u));
        return l.z > 0.0 ? vec3(l.xy, -l.z) : vec3(0.0);
    }
    float eta = model.eta.y;
    if (model.eta.x != model.eta.z) {
        int channel = min(int(3.0 * u.x), 2);
        eta = channelOf(model.eta, channel);
        u.x = min(3.0 * u.x - float(channel), 0.99999994);
    }
    vec3 l;
    bool passes = refractDirection(model.view, sampleVisibleNormal(model.view, model.alpha, u), eta, l);
    return passes && l.z < 0.0 ? l : vec3(0.0);
}

// Returns whether `u` falls on a lobe of this chance, and takes what is left of it.
bool falls(inout float u, float chance) {
    if (u < chance) {
        u = min(u / chance, 0.99999994);
        return true;
    }
    u -= chance;
    return false;
}

vec3 openPbrSample(OpenPbr model, vec3 view, vec2 u) {
    vec3 l;
    if (falls(u.x, model.chances.x)) {
        l = openPbrSampleFuzz(model, u);
    } else if (falls(u.x, model.chances.y)) {
        l = reflectAbout(model.view, sampleVisibleNormal(model.view, model.coatAlpha, u));
        l = l.z > 0.0 ? l : vec3(0.0);
    } else if (falls(u.x, model.chances.z)) {
        l = reflectAbout(model.view, sampleVisibleNormal(model.view, model.alpha, u));
        l = l.z > 0.0 ? l : vec3(0.0);
    } else if (falls(u.x, model.chancesBehind.x)) {
        l = openPbrSampleRefracted(model, u);
    } else if (falls(u.x, model.chancesBehind.y)) {
        l = sampleCosine(u) * vec3(1.0, 1.0, -1.0);
    } else {
        u.x = min(u.x / max(model.chances.w, 1e-12), 0.99999994);
        l = model.chances.w > 0.0 ? sampleCosine(u) : vec3(0.0);
    }
    return vec3(model.along * l.x + vec2(-model.along.y, model.along.x) * l.y, l.z);
}
