// The walk of a refracted ray from interface to interface.
#include "bsdf/sample.glsl"
#include "effects/ambient.glsl"
#include "effects/sample.glsl"
#include "hit/count.glsl"
#include "hit/images.glsl"
#include "hit/material.glsl"
#include "hit/primary.glsl"
#include "host/random.glsl"
#include "hit/trace.glsl"
#include "light/sized.glsl"
#include "materials/base/medium.glsl"
#if GLINT_LAYER_RAYS
#include "layers/ray_hits.glsl"
#endif

// The pairs of dimensions of the sequence: each interface has two.
const uint kPairInterface = 512u;

// The state of the ray.
struct Walker {
    vec3 origin;
    vec3 direction;
    vec3 weight;
    float coneWidth;
    uint channel;  // 0, 1 or 2 once dispersion has chosen a colour; 3 before
    Media media;
};

// The features of a surface that is met from either side.
Features walkFeatures(HostGeometry geometry) {
    return GLINT_FEATURES_OF_GLTF(
        GLINT_ALWAYS_LOBES & GLINT_INTERFACE_LOBES, GLINT_ALWAYS_INPUTS, GLINT_SOMETIMES_LOBES & GLINT_INTERFACE_LOBES,
        (GLINT_SOMETIMES_INPUTS | GLINT_ROLE_DOUBLE_SIDED) & ~GLINT_ALWAYS_INPUTS, geometry.featureLobes,
        geometry.featureInputs | GLINT_ROLE_DOUBLE_SIDED);
}

float channelOf(vec3 color, uint channel) {
    return channel == 0u ? color.x : channel == 2u ? color.z : color.y;
}

// The possible results of an interface.
const uint kPasses = 0u;
const uint kReflects = 1u;
const uint kStops = 2u;     // the surface is shaded like any other
const uint kAbsorbs = 3u;

// The share of a facet's reflection that no other facets block. With energy compensation, the blocked light leaves in
// the end, too. At a thin wall both lobes then grow in proportion and keep their shape (Turquin, "Practical multiple
// scattering compensation for microfacet models", 2019). The albedo of a lobe that bends is not known; there a facet's
// whole light leaves along its own direction, mirrored at the plane if it points below.
float shareBehindFacets(Base b, bool thin, vec3 view, vec3 l) {
    if (GLINT_ENERGY_COMPENSATION != 0 && !thin) {
        return 1.0;
    }
    float open = 2.0 * ggxVisibility(l, view, b.alpha) * l.z * (view.z + ggxProjection(view, b.alpha));
    return GLINT_ENERGY_COMPENSATION != 0 ? open / (1.0 - b.viewLoss) : open;
}

// Chooses at random whether a ray passes, reflects or stops at a surface. `first` marks the primary surface, whose
// other light is already shaded, so that the ray always passes.
uint scatter(Hit hit, Surface surface, Features features, bool first, uint depth, inout Walker walker) {
    Base b = surface.bsdf.base;
    vec3 view = surface.bsdf.view;
    vec2 u = hostRandomPair(hit.target, kPairInterface + 2u * depth);
    vec2 choice = hostRandomPair(hit.target, kPairInterface + 2u * depth + 1u);
    // The part of a surface that is not clear is shaded where it is met, in proportion.
    float clear = luminance(b.transmitted);
    float rest = luminance(surface.bsdf.diffuse) + luminance(surface.bsdf.diffuseTransmitted);
    bool pure = rest <= 0.0;
    if (!first && !pure) {
        float chance = clear / (clear + rest);
        if (choice.x >= chance) {
            walker.weight /= 1.0 - chance;
            return kStops;
        }
        walker.weight /= chance;
    }
    bool dispersed = dispersesLight(features) && b.eta.x != b.eta.z;
    if (dispersed && walker.channel == 3u) {
        walker.channel = min(uint(3.0 * choice.y), 2u);
        vec3 only = vec3(walker.channel == 0u ? 1.0 : 0.0, walker.channel == 1u ? 1.0 : 0.0,
                         walker.channel == 2u ? 1.0 : 0.0);
        walker.weight *= 3.0 * only;
    }
    float eta = channelOf(b.eta, walker.channel);
    b.eta = vec3(eta);
    vec3 h = sampleVisibleNormal(view, b.alpha, u);
    vec2 deciding = decidingCosine2(features, view, exactSquare(exactDot(view, h)), eta);
    float apparent = boundsMedium(features) && refracts(eta) ? eta : 1.0;
    bool thin = !boundsMedium(features);
    bool straight = thin || passesStraight(features, eta);
    if (!first && pure) {
        float reflected = facetChances(b, features, deciding, eta).x;
        float random = walker.channel == 3u || !dispersed ? choice.y : fract(3.0 * choice.y);
        if (random < reflected) {
            vec3 l = reflectAbout(view, h);
            if ((GLINT_ENERGY_COMPENSATION == 0 || thin) && l.z <= 0.0) {
                return kAbsorbs;
            }
            l.z = abs(l.z);
            vec3 fresnel = withMetal(b, features, fresnelInterface(b.f0, b.f90, deciding, apparent),
                                     fresnelSchlick(b.metalF0, 1.0, sqrt(deciding.x)));
            walker.weight *= fresnel * (shareBehindFacets(b, thin, view, l) / reflected);
            walker.direction = onSide(toWorld(surface, l), hit.geometricNormal);
            return kReflects;
        }
        walker.weight /= 1.0 - reflected;
    }
    vec3 l;
    float passed;
    if (straight) {
        vec2 alpha = passesStraight(features, eta) ? vec2(kMinAlpha) : b.alpha;
        l = reflectAbout(view, sampleVisibleNormal(view, alpha, u));
        l.z = -l.z;
        passed = l.z < 0.0 ? specularTransmission(b, features, view, l, eta) /
                                 mirroredPdf(view, normalize(view + vec3(l.xy, -l.z)), alpha)
                           : 0.0;
    } else {
        if (!refractDirection(view, h, eta, l)) {
            return kAbsorbs;
        }
        RefractingFacet facet;
        passed = l.z < 0.0 && refractionHalfVector(view, l, eta, facet)
                     ? specularTransmission(b, features, view, l, eta) /
                           (visibleNormalPdf(view, facet.h, b.alpha) * facet.spread * facet.cosineL)
                     : 0.0;
    }
    if (GLINT_ENERGY_COMPENSATION != 0 && thin) {
        // At the first interface, the effect reflection and the sky have added all reflected light. Where nothing
        // passes, both are 0; the bound keeps their quotient finite.
        passed *= first ? diffusePassed(b) / max(passedOnce(b), 1e-6) : 1.0 / (1.0 - b.viewLoss);
    } else if (GLINT_ENERGY_COMPENSATION != 0) {
        l.z = -abs(l.z);
        passed = first ? diffusePassed(b) : interfacePassed(b.f0, b.f90, deciding, apparent);
    }
    walker.weight *= b.transmitted * passed;
    walker.direction = onSide(toWorld(surface, l), -hit.geometricNormal);
    return kPasses;
}

#if GLINT_SIZED_LIGHTS
// The light of area lights that the ray meets before the distance at which it ends, as the viewer sees it. No samples
// of lights bring light to the surfaces of a walk.
vec3 lightsOnWay(Walker walker, float end) {
    vec3 sum = vec3(0.0);
    LightSearch lights = lightsOnRay(walker.origin, walker.direction, end, true);
    GLINT_EACH_LIGHT(i, lights) {
        HostLight light = lightToFind(i);
        LightSample point = lightAlong(light, hostSampleLight(light, walker.origin), walker.direction);
        if (lobesFind(light) && point.irradiance != vec3(0.0) && point.distance < end) {
            vec3 arriving = walker.weight * point.irradiance;
            if (isWithin(walker.media)) {
                arriving *= mediumTransmittance(walker.media, point.distance);
            }
            sum += arriving;
        }
    }
    return sum;
}
#endif

#if GLINT_LAYER_WALKS
// The sum of this light over a walk. It is in the picture, and the layers of its effect have it, too.
vec3 foundOnWalk = vec3(0.0);
#endif

// Returns the number of rays traced.
uint walk(uvec2 pixel, uint target) {
    uvec2 surfaceId = imageLoad(surfaceImage, ivec2(pixel)).xy;
    CameraRay camera = cameraRay(pixel);
    HostGeometry geometry = hostGeometry(surfaceId.x);
    Features features = walkFeatures(geometry);
    Hit hit = primaryHit(geometry, surfaceId.y, camera, target, features);
    Walker walker;
    walker.origin = camera.origin;
    walker.direction = camera.direction;
    walker.coneWidth = GLINT_FRAME.pixelWidth;
    walker.channel = 3u;
    walker.media = uvec2(0u);
    // See the comment in refraction.glsl.
#if GLINT_SAMPLE_RECORD_PACKED
    walker.weight = storedSample(target).origin;
#else
    walker.weight = vec3(storedSample(target).coneSpread);
#endif
    float travelled = distance(hit.position, camera.origin);
    uint segments = 0u;
#if GLINT_LAYER_RAYS
    float way = 0.0;  // of the rays so far
#endif
    bool meets = true;  // the ray meets a surface that affects it
    for (uint depth = 0u;; ++depth) {
        if (meets) {
            Surface surface = evaluateSurface(hit, features);
            bool volume = boundsMedium(features);
            if (volume) {
                nestMedia(hit, features, walker.media, surface.bsdf.base);
            }
            vec3 before = walker.direction;
            uint outcome = scatter(hit, surface, features, depth == 0u, depth, walker);
            if (outcome == kStops) {
                walker.direction = before;
                break;
            }
            if (outcome == kAbsorbs || luminance(walker.weight) <= 0.0) {
#if GLINT_LAYER_RAYS
                storeRayMiss(target, walker.direction);
#endif
                endSample(target, vec3(0.0), vec3(0.0));
                return segments;
            }
            if (outcome == kPasses && volume) {
                walker.media = mediaBeyond(hit, walker.media);
            }
        }
        walker.origin = rayOrigin(hit, walker.direction);
        walker.coneWidth += GLINT_FRAME.pixelSpread * travelled;
        if (depth + 1u >= GLINT_FRAME.maxInterfaces) {
            // The sky stands in for further interfaces.
#if GLINT_LAYER_RAYS
            storeRayMiss(target, walker.direction);
#endif
            endSample(target, walker.weight, hostSky(walker.direction));
            return segments;
        }
        // Continues to the next surface. Within a medium, its back is seen too.
        RayRecord ray = RayRecord(walker.origin, target, walker.direction, walker.coneWidth, GLINT_FRAME.pixelSpread);
        bool within = isWithin(walker.media);
        TracedHit record = traceRay(ray, within ? 0u : gl_RayFlagsCullBackFacingTrianglesEXT);
        segments += 1u;
#if GLINT_SIZED_LIGHTS
        vec3 met = lightsOnWay(walker, record.geometry == kMissGeometry ? 2.0 * kFarDistance : record.distance);
        if (met != vec3(0.0)) {
            vec4 seen = imageLoad(radianceImage, ivec2(pixel));
            imageStore(radianceImage, ivec2(pixel), storable(vec4(seen.rgb + met, seen.a)));
#if GLINT_LAYER_WALKS
            foundOnWalk += met;
#endif
        }
#endif
        if (record.geometry == kMissGeometry) {
#if GLINT_LAYER_RAYS
            storeRayMiss(target, walker.direction);
#endif
            endSample(target, walker.weight, hostSky(walker.direction));
            return segments;
        }
        geometry = hostGeometry(record.geometry);
        features = walkFeatures(geometry);
        hit = fetchHit(geometry, record.primitive, record.barycentrics, walker.direction, record.coneWidth, target,
                       features);
        travelled = record.distance;
#if GLINT_LAYER_RAYS
        way += travelled;
#endif
        if (within) {
            walker.weight *= mediumTransmittance(walker.media, travelled);
        }
        // The back of a single-sided surface is ignored, unless it is the end of a volume.
        bool back = !hit.frontFace && (geometry.flags & kGeometryDoubleSided) == 0u;
        bool clear = passesFacets(features);
        meets = !back || (clear && boundsMedium(features));
        if (meets && !clear) {
            break;
        }
    }
    EffectSample drawn;
    drawn.outcome = luminance(walker.weight) > 0.0 ? kRaySent : kRayBlack;
    drawn.origin = walker.origin;
    drawn.direction = walker.direction;
    drawn.weight = walker.weight;
    drawn.coneWidth = walker.coneWidth;
    drawn.coneSpread = GLINT_FRAME.pixelSpread;
    storeSample(target, drawn);
#if GLINT_LAYER_RAYS
    GLINT_FRAME.rayHits.data[samplePlace(target)].distance = max(way - travelled, 0.0);
#endif
#if GLINT_PATHS
    // The next surface of the ray is in these volumes, and sends its next ray there.
    GLINT_FRAME.paths.data[samplePlace(target)].media = uint[2](walker.media.x, walker.media.y);
#endif
    return segments;
}
