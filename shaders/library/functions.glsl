// The functions of Glint's library for the features of one case.
#include "bsdf/sample.glsl"
#include "hit/shade.glsl"

// The hit of a ray.
struct GlintHit {
    uint geometry;      // a number of the host's; only the host's functions read it
    uint primitive;     // triangle within the geometry
    vec2 barycentrics;  // of the second and third corner
    vec3 direction;     // of the ray
    float coneWidth;    // width of the ray's cone at the hit, which chooses levels of textures; 0 for the finest
    uint number;        // for glintHostRandom(), such as that of the pixel
};

// A surface as a ray sees it.
struct GlintSurface {
    vec3 position;
    vec3 view;             // towards the start of the ray
    vec3 geometricNormal;  // of the triangle, on the side of the view
    vec3 normal;           // for shading, on the side of the view unless the normal texture turns it away
    vec3 albedo;           // share of light that the diffuse lobe scatters; black for metals
    vec3 f0;               // reflectance at normal incidence, of dielectric and metal together
    float roughness;       // square root of the larger alpha; 0 to 1
    vec3 emission;         // radiance; all that an unlit surface sends
    float occlusion;       // share of ambient light, from the occlusion texture
    uint shaderId;         // the case; GlintGeometry has it, too
    // These members are the library's own.
    uint featureLobes;
    uint featureInputs;
    uint featureModel;
    uvec4 featureOwn;
    uint number;
    float clearance;
    Surface inner;
};

// A sampled direction.
struct GlintSample {
    vec3 direction;
    vec3 weight;    // glintEvaluate() over the density; black where there is no direction
    float density;  // by solid angle; 0 where there is no direction
};

// The light of a hit. The caller traces the shadow ray.
struct GlintRadiance {
    vec3 radiance;         // what is certain: emission, and the sky
    vec3 direct;           // to be added unless something is in the way of the shadow ray
    vec3 shadowOrigin;
    vec3 shadowDirection;
    float shadowDistance;  // 0 for no shadow ray
};

// The reflection of the base as a mirror shows it. The caller traces the ray.
struct GlintMirror {
    vec3 direction;  // of the ray
    vec3 weight;     // of what the ray finds; black if nothing is reflected
    vec3 sky;        // what glintRadiance() has of the sky in the place of that
};

GlintSurface librarySurface(GlintHit given, HostGeometry geometry, Features features) {
    Hit hit = fetchHit(geometry, given.primitive, given.barycentrics, given.direction, given.coneWidth, given.number,
                       features);
    GlintSurface result;
    result.position = hit.position;
    result.view = hit.view;
    result.geometricNormal = hit.geometricNormal;
    result.shaderId = geometry.shaderId;
    result.featureLobes = geometry.featureLobes;
    result.featureInputs = geometry.featureInputs;
    result.featureModel = geometry.featureModel;
    result.featureOwn = geometry.featureOwn;
    result.number = given.number;
    result.clearance = hit.clearance;
    if (!isLit(features)) {
        result.normal = hit.normal * facing(hit, features);
        result.albedo = vec3(0.0);
        result.f0 = vec3(0.0);
        result.roughness = 1.0;
        result.occlusion = 1.0;
        result.emission = surfaceValues(hit, features).color.rgb;
        return result;
    }
    result.inner = evaluateSurface(hit, features);
    Bsdf bsdf = result.inner.bsdf;
    result.normal = result.inner.normal;
    result.albedo = bsdf.diffuse;
    result.f0 = withMetal(bsdf.base, features, bsdf.base.f0, bsdf.base.metalF0);
    result.roughness = result.inner.roughness;
    result.emission = result.inner.emission;
    result.occlusion = result.inner.occlusion;
    return result;
}

// The surface for light that goes to another view than that of the ray.
Surface surfaceSeenFrom(GlintSurface given, Features features, vec3 wo) {
    Surface surface = given.inner;
    if (wo != given.view) {
        prepareBsdf(surface.bsdf, features, toSurface(surface, wo));
    }
    return surface;
}

vec3 libraryEvaluate(GlintSurface given, Features features, vec3 wo, vec3 wi) {
    if (!isLit(features)) {
        return vec3(0.0);
    }
    return scatteredLight(surfaceSeenFrom(given, features, wo), features, given.geometricNormal, wi);
}

GlintSample librarySample(GlintSurface given, Features features, vec3 wo, vec3 random) {
    GlintSample result = GlintSample(vec3(0.0), vec3(0.0), 0.0);
    if (!isLit(features)) {
        return result;
    }
    Surface surface = surfaceSeenFrom(given, features, wo);
    BsdfSample drawn = sampleBsdf(surface.bsdf, features, random);
    if (drawn.pdf > 0.0) {
        result.direction = toWorld(surface, drawn.direction);
        result.weight = scatteredLight(surface, features, given.geometricNormal, result.direction) / drawn.pdf;
        result.density = drawn.pdf;
    }
    return result;
}

float libraryDensity(GlintSurface given, Features features, vec3 wo, vec3 wi) {
    if (!isLit(features)) {
        return 0.0;
    }
    Surface surface = surfaceSeenFrom(given, features, wo);
    return bsdfPdf(surface.bsdf, features, toSurface(surface, wi));
}

// Returns a Hit with the members that are needed to leave the surface and to light it.
Hit hitOf(GlintSurface given) {
    Hit hit;
    hit.position = given.position;
    hit.geometricNormal = given.geometricNormal;
    hit.clearance = given.clearance;
    hit.view = given.view;
    hit.target = given.number;
    return hit;
}

GlintRadiance libraryRadiance(GlintSurface given, Features features) {
    if (!isLit(features)) {
        return GlintRadiance(given.emission, vec3(0.0), vec3(0.0), vec3(0.0), 0.0);
    }
    Hit hit = hitOf(given);
    ShadeResult shaded = shadeSurface(hit, given.inner, features);
    return GlintRadiance(shaded.radiance, shaded.direct, rayOrigin(hit, shaded.shadowDirection),
                         shaded.shadowDirection, shaded.shadowDistance);
}

GlintMirror libraryMirror(GlintSurface given, Features features) {
    GlintMirror result = GlintMirror(reflect(-given.view, given.normal), vec3(0.0), vec3(0.0));
    if (!isLit(features)) {
        return result;
    }
    Surface surface = given.inner;
    result.direction = onSide(reflect(-given.view, surface.normal), given.geometricNormal);
    result.weight = singleScatterAlbedo(surface.bsdf.base, features) * baseShare(surface, features);
    SkyShares with = wholeSky();
    SkyShares without = wholeSky();
    without.mirrored = 0.0;
    result.sky = ambientLight(surface, features, given.view, with) -
                 ambientLight(surface, features, given.view, without);
    return result;
}

vec3 libraryShadeAll(GlintSurface given, Features features, vec3 wo, vec3 whole, vec3 seen) {
#if GLINT_SHADES_ALL
    float sum = luminance(whole);
    if (isLit(features) && shadesAll(features) && sum > 0.0) {
        Surface surface = surfaceSeenFrom(given, features, wo);
        return shadeAll(surface.bsdf.layers, features, surface.bsdf.view, whole) * (luminance(seen) / sum);
    }
#endif
    return seen;
}

// Returns the surface of a shader ID that the library does not have. Only its emission is seen.
GlintSurface unknownSurface(GlintHit given, HostGeometry geometry) {
    GlintSurface result;
    result.position = vec3(0.0);
    result.view = -given.direction;
    result.geometricNormal = -given.direction;
    result.normal = -given.direction;
    result.albedo = vec3(0.0);
    result.f0 = vec3(0.0);
    result.roughness = 1.0;
    result.emission = vec3(1.0, 0.0, 1.0);
    result.occlusion = 1.0;
    result.shaderId = geometry.shaderId;
    result.featureLobes = 0u;
    result.featureInputs = 0u;
    result.featureModel = 0u;
    result.featureOwn = uvec4(0u);
    result.number = given.number;
    result.clearance = 0.0;
    return result;
}

// Reads the surface that a ray has hit: the attributes of the triangle, the material and its textures.
GlintSurface glintSurface(const GlintHit hit);

// Returns the BSDF times |cos| of the angle between `wi` and the normal, for light that comes from `wi` and goes to
// `wo`, reflected or transmitted. `wo` is on the side of the normal. It costs less where it is surface.view.
vec3 glintEvaluate(const GlintSurface surface, const vec3 wo, const vec3 wi);

// Samples a direction from which light comes, for light that goes to `wo`. `random` is uniform in [0, 1)³.
GlintSample glintSample(const GlintSurface surface, const vec3 wo, const vec3 random);

// Returns the density, by solid angle, with which glintSample() gives `wi`.
float glintDensity(const GlintSurface surface, const vec3 wo, const vec3 wi);

// Returns the light that the surface sends to its view, as Glint's renderer shades hits: emission, the sky's light
// (which no ray brings), and the light of one light, chosen in proportion to its contribution.
GlintRadiance glintRadiance(const GlintSurface surface);

// Returns the mirror's ray of a surface, with which a host brings reflections of the scene instead of the sky's:
// glintRadiance() - sky + weight times the light that the ray finds. It stands for a rough lobe, too, if only roughly;
// glintSample() is exact. Coats and sheen keep their sky.
GlintMirror glintMirror(const GlintSurface surface);

// Returns the light of all lights that goes to `wo`. `whole` is what they would bring if nothing cast a shadow: the sum
// of glintEvaluate() times the irradiance of each; `seen` is the sum of those that are not in shadow. Most materials
// return `seen`. A model that shades all lights at once (cel shading) makes a tone of `whole`, of which it returns the
// part that `seen` has of the luminance.
vec3 glintShadeAll(const GlintSurface surface, const vec3 wo, const vec3 whole, const vec3 seen);

// Returns where a ray in a direction must start, so that it does not meet the surface that it leaves.
vec3 glintRayOrigin(const GlintSurface surface, const vec3 direction);
