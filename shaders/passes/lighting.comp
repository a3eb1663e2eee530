#version 460
// Lighting of the primary surfaces: materials, every punctual light with its shadow ray, the sky; and what the effects
// need of each pixel.
#define GLINT_MODULE_ALWAYS_LOBES GLINT_ALWAYS_LOBES
#define GLINT_MODULE_ALWAYS_INPUTS GLINT_ALWAYS_INPUTS
#define GLINT_MODULE_ANY_LOBES (GLINT_ALWAYS_LOBES | GLINT_SOMETIMES_LOBES)
#define GLINT_MODULE_ANY_INPUTS (GLINT_ALWAYS_INPUTS | GLINT_SOMETIMES_INPUTS)
#include "effects/reflection.glsl"
#include "hit/camera.glsl"
#include "hit/images.glsl"
#include "hit/shade.glsl"
#include "hit/trace.glsl"

GLINT_PIXEL_WORKGROUP

Hit primaryHit(GeometryRecord geometry, uint primitive, CameraRay ray, uint pixel, Features features) {
    InstanceRecord instance = GLINT_FRAME.instances.data[geometry.instanceIndex];
    vec3 corners[3];
    for (uint i = 0u; i < 3u; ++i) {
        uint index = geometry.indices.data[3u * primitive + i];
        corners[i] = transformPoint(instance.objectToWorld, geometry.positions.data[index]);
    }
    vec2 barycentrics =
        rayTriangleBarycentrics(ray, corners[0], corners[1] - corners[0], corners[2] - corners[0]);
    vec3 position = corners[0] + barycentrics.x * (corners[1] - corners[0]) +
                    barycentrics.y * (corners[2] - corners[0]);
    float coneWidth = GLINT_FRAME.pixelWidth + GLINT_FRAME.pixelSpread * distance(position, ray.origin);
    return fetchHit(geometry, primitive, barycentrics, ray.direction, coneWidth, pixel, features);
}

vec3 directLight(Hit hit, Surface surface, Features features) {
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < GLINT_FRAME.lightCount; ++i) {
        LightSample light = sampleLight(GLINT_FRAME.lights.data[i], hit.position);
        vec3 contribution = unshadowedLight(hit, surface, features, light);
        if (luminance(contribution) > 0.0 &&
            isVisible(rayOrigin(hit, light.direction), light.direction, light.distance)) {
            sum += contribution;
        }
    }
    return sum;
}

void main() {
    uvec2 pixel = GLINT_PIXEL_OF_THREAD;
    if (pixel.x >= GLINT_FRAME.width || pixel.y >= GLINT_FRAME.height) {
        return;
    }
    ivec2 place = ivec2(pixel);
    uvec2 surfaceId = imageLoad(surfaceImage, place).xy;
    CameraRay ray = cameraRay(pixel);
    vec4 radianceDepth = vec4(skyRadiance(ray.direction), 0.0);
    vec4 position = vec4(0.0);
    ReflectionSample reflection = ReflectionSample(vec3(0.0), vec3(0.0), kRayNoSurface);

    if (surfaceId.x != kNoSurface) {
        GeometryRecord geometry = GLINT_FRAME.geometries.data[surfaceId.x];
        Features features = GLINT_PRIMARY_FEATURES(geometry);
        Hit hit = primaryHit(geometry, surfaceId.y, ray, pixel.x + pixel.y * GLINT_FRAME.width, features);
        vec3 origin = rayOrigin(hit, hit.geometricNormal);
        position = vec4(origin, uintBitsToFloat(packSnorm2x16(octahedralEncode(hit.geometricNormal))));
        radianceDepth.w = dot(hit.position - GLINT_FRAME.cameraPosition, GLINT_FRAME.cameraForward);
        if (hasLobe(features, GLINT_UNLIT)) {
            radianceDepth.rgb = baseColor(hit, features).rgb;
            reflection.outcome = kRayUnlit;
        } else {
            Surface surface = evaluateSurface(hit, features);
            TracedLobes traced = tracedLobes(surface, features);
            radianceDepth.rgb = surface.emission + directLight(hit, surface, features) +
                                ambientLight(surface, features, hit.view, 1.0 - traced.base, 1.0 - traced.coat);
            reflection = sampleReflection(hit, surface, features, traced);
        }
    }
    imageStore(radianceImage, place, radianceDepth);
    imageStore(reflectionRayImage, place, vec4(reflection.direction, uintBitsToFloat(reflection.outcome)));
    imageStore(positionImage, place, position);
    imageStore(reflectanceImage, place, vec4(reflection.weight, 0.0));
    imageStore(reflectionImage, place, vec4(0.0));
}
