// The images that surfaces show by the rays of effects: their distance and their motion.
#include "hit/camera.glsl"
#include "hit/geometry.glsl"
#include "hit/images.glsl"
#include "hit/samples.glsl"
#include "host/geometry.glsl"
#if GLINT_LAYER_HISTORY
#include "layers/motion.glsl"
#endif

// The distance that a ray travelled, or 0 if the sample has none. `path` is one of kPath*.
vec4 rayDistance(uint target, uint path) {
    float travelled = path == kPathNone ? 0.0 : GLINT_FRAME.rayHits.data[samplePlace(target)].distance;
    return vec4(travelled, 0.0, 0.0, 0.0);
}

// Returns the shader ID of a ray's hit.
uvec4 rayShader(uint target, uint path) {
    if (path == kPathNone) {
        return uvec4(kLayerNoRay);
    }
    uint geometry = GLINT_FRAME.rayHits.data[samplePlace(target)].geometry;
    return uvec4(geometry == kMissGeometry     ? kLayerLeftScene
                 : geometry == kScreenGeometry ? kLayerOnScreen
                                               : hostShaderId(geometry));
}

#if GLINT_LAYER_HISTORY

// A point of a triangle, now and in the previous frame, and the frame of the triangle at both times: its first edge, a
// normal, and the vector that completes the frame.
struct MovedPoint {
    vec3 now;
    vec3 before;
    vec3 axesNow[3];
    vec3 axesBefore[3];
};

vec3[3] axesOf(vec3 corners[3]) {
    vec3 axes[3];
    axes[0] = directionOr(corners[1] - corners[0], vec3(1.0, 0.0, 0.0));
    axes[1] = directionOr(cross(corners[1] - corners[0], corners[2] - corners[0]), vec3(0.0, 0.0, 1.0));
    axes[2] = cross(axes[0], axes[1]);
    return axes;
}

MovedPoint movedPoint(uint number, uint primitive, vec2 barycentrics) {
    HostGeometry geometry = hostGeometry(number);
    vec3 now[3] = currentCorners(geometry, primitive);
    vec3 before[3] = previousCorners(geometry, number, primitive);
    return MovedPoint(cornerMean(now, barycentrics), cornerMean(before, barycentrics), axesOf(now), axesOf(before));
}

// The point that a pixel sees; it must see one.
MovedPoint movedPointOf(ivec2 place) {
    uvec2 seen = imageLoad(surfaceImage, place).xy;
    CameraRay ray = cameraRay(uvec2(place));
    vec3 corners[3] = currentCorners(hostGeometry(seen.x), seen.y);
    return movedPoint(seen.x, seen.y, rayTriangleBarycentrics(ray, corners[0], corners[1] - corners[0],
                                                              corners[2] - corners[0]));
}

// Turns a direction back by the triangle's rotation since the previous frame.
vec3 turnedBack(MovedPoint point, vec3 v) {
    return dot(v, point.axesNow[0]) * point.axesBefore[0] + dot(v, point.axesNow[1]) * point.axesBefore[1] +
           dot(v, point.axesNow[2]) * point.axesBefore[2];
}

vec3 mirroredAt(vec3 v, vec3 normal) {
    return v - 2.0 * dot(v, normal) * normal;
}

// The point that a ray found, with its place in the previous frame.
MovedPoint foundPoint(RayHit found) {
    if (found.geometry == kScreenGeometry) {
        return movedPointOf(ivec2(found.primitive % GLINT_FRAME.width, found.primitive / GLINT_FRAME.width));
    }
    return movedPoint(found.geometry, found.primitive, found.barycentrics);
}

// The motion of the image of a ray's hit, behind a mirror at the primary surface. The mirror is the plane that sends
// the view to the ray: of a flat mirror it is the surface itself, and the result is exact. It moves and turns as the
// triangle does. Curved mirrors are taken for their tangent planes.
vec4 mirroredMotion(ivec2 place, RayHit found) {
    MovedPoint mirror = movedPointOf(place);
    vec3 seen = cameraRay(uvec2(place)).direction;
    vec3 normal = directionOr(found.direction - seen, mirror.axesNow[1]);
    vec3 normalBefore = turnedBack(mirror, normal);
    if (found.geometry == kMissGeometry) {
        return skyMotion(seen, mirroredAt(found.direction, normalBefore));
    }
    MovedPoint point = foundPoint(found);
    vec3 imageNow = mirror.now + mirroredAt(point.now - mirror.now, normal);
    vec3 imageBefore = mirror.before + mirroredAt(point.before - mirror.before, normalBefore);
    return motionOf(vec4(imageNow, 1.0), vec4(imageBefore, 1.0));
}

// The motion of the image that is seen through the primary surface. The view continues straight to the place where the
// point appears, and the point's own motion moves this image. A ray that passes straight on, as through a thin wall,
// meets the point itself, and the result is exact. The different bending of other rays by a moving or curved surface is
// ignored.
vec4 refractedMotion(ivec2 place, RayHit found) {
    CameraRay ray = cameraRay(uvec2(place));
    if (found.geometry == kMissGeometry) {
        return skyMotion(ray.direction, ray.direction);
    }
    MovedPoint window = movedPointOf(place);
    MovedPoint point = foundPoint(found);
    vec3 image = window.now + found.distance * ray.direction;
    return motionOf(vec4(image, 1.0), vec4(point.before + (image - point.now), 1.0));
}

#endif
