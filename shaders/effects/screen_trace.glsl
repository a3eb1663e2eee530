// Marches a reflection ray over the screen, against the depth of the primary surfaces.
#include "effects/screen_ray.glsl"
#include "host/sky.glsl"
#include "bsdf/constants.glsl"
#include "hit/geometry.glsl"
#include "hit/images.glsl"
#include "hit/samples.glsl"

struct ScreenMarch {
    bool found;
    ivec2 place;     // if the ray hits: the pixel whose surface it meets
    float distance;  // otherwise: the distance in which the ray certainly meets nothing, metres
};

// A point of the ray, over a pixel.
struct ScreenPoint {
    ivec2 place;
    vec3 position;
    float distance;  // along the ray, metres
    float depth;     // along the camera's axis, metres
};

vec4 toClip(vec4 v) {
    return vec4(dot(GLINT_FRAME.worldToClip[0], v), dot(GLINT_FRAME.worldToClip[1], v),
                dot(GLINT_FRAME.worldToClip[2], v), dot(GLINT_FRAME.worldToClip[3], v));
}

ivec2 insideImage(vec2 pixel) {
    return clamp(ivec2(floor(pixel)), ivec2(0), ivec2(GLINT_FRAME.width, GLINT_FRAME.height) - 1);
}

ScreenPoint screenPoint(ScreenRay ray, vec3 origin, vec3 direction, float share) {
    ScreenPoint point;
    point.place = insideImage(screenPixel(ray, share));
    point.distance = screenDistance(ray, share);
    point.position = origin + point.distance * direction;
    point.depth = dot(point.position - GLINT_FRAME.cameraPosition, GLINT_FRAME.cameraForward);
    return point;
}

// The depth of a pixel's surface along the camera's axis, metres; 0 if there is none.
float seenDepth(ivec2 place) {
    return imageLoad(radianceImage, place).w * GLINT_FRAME.lengthUnit;
}

vec3 normalOf(vec4 position) {
    return octahedralDecode(unpackSnorm2x16(floatBitsToUint(position.w)));
}

// Returns whether the surface of a pixel hides the point: the surface is nearer, and the point is also behind its
// plane. The depth is that of the pixel's centre, while the point may be anywhere in the pixel. By depth alone a ray
// would hit the floor that it leaves.
bool isHidden(ScreenPoint point, ivec2 place) {
    float seen = seenDepth(place);
    if (seen == 0.0 || point.depth < seen) {
        return false;
    }
    vec4 surface = imageLoad(positionImage, place);
    return dot(point.position - surface.xyz, normalOf(surface)) <= 0.0;
}

// Returns whether no surface of the surrounding pixels hides the point either. Then nothing as large as a pixel lies
// between it and its neighbours on the line, even where a silhouette passes between their centres.
bool isClear(ScreenPoint point) {
    bool clear = true;
    for (int i = 0; clear && i < 9; ++i) {
        ivec2 place = point.place + ivec2(i % 3, i / 3) - 1;
        clear = i == 4 ||
                !isHidden(point, clamp(place, ivec2(0), ivec2(GLINT_FRAME.width, GLINT_FRAME.height) - 1));
    }
    return clear;
}

// Bisects the part of the line from `free`, where nothing hides the ray, to `hidden`, until it is shorter than 1/64
// pixel, because depths may change much within one pixel. The surface there is a hit if three conditions hold: the ray
// is at most the surface's thickness behind it; a pixel earlier the ray was in front of its plane, so that it meets the
// side that the camera sees; and it is not the surface that the ray leaves. `pixel` is the share of the line that one
// pixel takes.
ScreenMarch hitBetween(ScreenRay ray, vec3 origin, vec3 direction, float free, float hidden, float pixel) {
    while (hidden - free > 0.015625 * pixel) {
        float middle = 0.5 * (free + hidden);
        ScreenPoint point = screenPoint(ray, origin, direction, middle);
        if (isHidden(point, point.place)) {
            hidden = middle;
        } else {
            free = middle;
        }
    }
    ScreenPoint point = screenPoint(ray, origin, direction, hidden);
    float seen = seenDepth(point.place);
    bool thick = point.depth - seen <= GLINT_FRAME.screenThickness * seen;
    vec3 before = screenPoint(ray, origin, direction, max(free - pixel, 0.0)).position;
    vec4 surface = imageLoad(positionImage, point.place);
    bool crossed = dot(before - surface.xyz, normalOf(surface)) > 0.0;
    return ScreenMarch(thick && crossed && point.place != insideImage(ray.begin), point.place, 0.0);
}

// Ends at the first surface that hides the ray, even if it is no hit, because anything may be behind it. If the steps
// look at every pixel of the line, the returned distance is that of the last clear point but one, which is a pixel
// before anything that the line may meet next. Otherwise it is 0.
ScreenMarch marchScreen(vec3 origin, vec3 direction) {
    ScreenRay ray = screenRay(toClip(vec4(origin, 1.0)), toClip(vec4(direction, 0.0)),
                              vec2(GLINT_FRAME.width, GLINT_FRAME.height), kFarDistance);
    vec2 span = ray.end - ray.begin;
    bool steep = abs(span.y) > abs(span.x);
    float pixels = steep ? abs(span.y) : abs(span.x);
    float stride = max(pixels / float(GLINT_FRAME.screenSteps), 1.0);
    // Steps of one pixel go from pixel centre to pixel centre.
    bool clear = stride == 1.0;
    float along = steep ? fract(ray.begin.y) - 0.5 : fract(ray.begin.x) - 0.5;
    bool forwards = steep ? span.y >= 0.0 : span.x >= 0.0;
    float first = clear ? (forwards ? -along : along) : 0.0;

    ScreenMarch result = ScreenMarch(false, ivec2(0), 0.0);
    float free = 0.0;
    float lastClear = 0.0;
    for (uint i = 1u; i <= GLINT_FRAME.screenSteps; ++i) {
        float share = (first + float(i) * stride) / pixels;
        if (!(share < 1.0)) {
            break;
        }
        ScreenPoint point = screenPoint(ray, origin, direction, share);
        if (isHidden(point, point.place)) {
            ScreenMarch hit = hitBetween(ray, origin, direction, free, share, 1.0 / pixels);
            result.found = hit.found;
            result.place = hit.place;
            break;
        }
        clear = clear && isClear(point);
        result.distance = clear ? lastClear : result.distance;
        lastClear = point.distance;
        free = share;
    }
    return result;
}

// The light that the surface of a pixel sends to the ray: its light as the camera sees it, with the sky in its
// reflection, as in hits of rays.
vec3 screenRadiance(ivec2 place, vec3 direction) {
    vec3 normal = normalOf(imageLoad(positionImage, place));
    uint target = sampleTarget(GLINT_SLOT_REFLECTION, uint(place.x) + uint(place.y) * GLINT_FRAME.width);
    return imageLoad(radianceImage, place).rgb +
           sampleWeight(target) * hostSky(reflect(direction, normal));
}
