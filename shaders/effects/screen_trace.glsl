// The march of a reflection ray over the screen, against the depth of the primary surfaces.
#include "effects/screen_ray.glsl"
#include "effects/sky.glsl"
#include "hit/constants.glsl"
#include "hit/geometry.glsl"
#include "hit/images.glsl"
#include "hit/samples.glsl"

struct ScreenMarch {
    bool found;
    ivec2 place;     // the pixel whose surface the ray meets
    float distance;  // otherwise: how far the ray is known to meet nothing, metres
};

// A point of the ray over a pixel.
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

vec3 normalOf(vec4 position) {
    return octahedralDecode(unpackSnorm2x16(floatBitsToUint(position.w)));
}

// Whether the surface of a pixel hides the point: it is nearer, and the point is behind its plane, too. The depth is of
// the pixel's centre, the point anywhere in it: by depth alone a ray would meet the floor that it leaves.
bool isHidden(ScreenPoint point, ivec2 place) {
    float seen = imageLoad(radianceImage, place).w;
    if (seen == 0.0 || point.depth < seen) {
        return false;
    }
    vec4 surface = imageLoad(positionImage, place);
    return dot(point.position - surface.xyz, normalOf(surface)) <= 0.0;
}

// Whether no surface of the pixels around hides the point, either: then what is as large as a pixel is not between it
// and its neighbours on the line, even where a silhouette passes between their centres.
bool isClear(ScreenPoint point) {
    bool clear = true;
    for (int i = 0; clear && i < 9; ++i) {
        ivec2 place = point.place + ivec2(i % 3, i / 3) - 1;
        clear = i == 4 ||
                !isHidden(point, clamp(place, ivec2(0), ivec2(GLINT_FRAME.width, GLINT_FRAME.height) - 1));
    }
    return clear;
}

// Halves the part of the line from `free`, where nothing hides the ray, to `hidden` until it is below 1/64 pixel, as
// depths may change much within one, and takes the surface there for a hit if the ray is at most its thickness behind
// it, was in front of its plane a pixel earlier, so that it meets the side that the camera sees, and if it is not the
// one that the ray leaves. `pixel`: share of the line.
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
    float seen = imageLoad(radianceImage, point.place).w;
    bool thick = point.depth - seen <= GLINT_FRAME.screenThickness * seen;
    vec3 before = screenPoint(ray, origin, direction, max(free - pixel, 0.0)).position;
    vec4 surface = imageLoad(positionImage, point.place);
    bool crossed = dot(before - surface.xyz, normalOf(surface)) > 0.0;
    return ScreenMarch(thick && crossed && point.place != insideImage(ray.begin), point.place, 0.0);
}

// Ends at the first surface that hides the ray, whether that is a hit or not: behind it anything may be. Where the
// steps look at every pixel of the line the distance is that of the last point but one that is clear, a pixel from
// whatever the line may meet next; otherwise 0.
ScreenMarch marchScreen(vec3 origin, vec3 direction) {
    ScreenRay ray = screenRay(toClip(vec4(origin, 1.0)), toClip(vec4(direction, 0.0)),
                              vec2(GLINT_FRAME.width, GLINT_FRAME.height), kFarDistance);
    vec2 span = ray.end - ray.begin;
    bool steep = abs(span.y) > abs(span.x);
    float pixels = steep ? abs(span.y) : abs(span.x);
    float stride = max(pixels / float(GLINT_FRAME.screenSteps), 1.0);
    // Steps of one pixel go from centre to centre.
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

// What the surface of a pixel sends to the ray: its light as the camera sees it, with the sky for what it reflects, as
// hits of rays have it.
vec3 screenRadiance(ivec2 place, vec3 direction) {
    vec3 normal = normalOf(imageLoad(positionImage, place));
    uint target = sampleTarget(GLINT_SLOT_REFLECTION, uint(place.x) + uint(place.y) * GLINT_FRAME.width);
    return imageLoad(radianceImage, place).rgb +
           GLINT_FRAME.samples.data[target].weight * skyRadiance(reflect(direction, normal));
}
