// The places of points of the world in the previous frame, in the world and in its picture.
#include "host/geometry.glsl"
#include "hit/bindings.glsl"
#include "hit/hit.glsl"

// Returns the geometry with its vertices of the previous frame.
HostGeometry previousGeometry(HostGeometry geometry, uint number) {
#if GLINT_LAYER_DEFORMS
    if (GLINT_FRAME.hasPreviousVertices != 0u) {
        geometry.positions = GLINT_FRAME.previousVertices.data[number].positions;
    }
#endif
    return geometry;
}

vec3[3] cornersIn(HostGeometry geometry, uint primitive, vec4 objectToWorld[3]) {
    TriangleCorners triangle = vertexPositions(geometry, primitive);
    vec3 corners[3];
    for (uint i = 0u; i < 3u; ++i) {
        corners[i] = transformPoint(objectToWorld, triangle.corners[i]);
    }
    return corners;
}

// The corners of a triangle in the world.
vec3[3] currentCorners(HostGeometry geometry, uint primitive) {
    return cornersIn(geometry, primitive, hostInstance(geometry).objectToWorld);
}

// Returns the same in the previous frame. `number` is that of the geometry.
vec3[3] previousCorners(HostGeometry geometry, uint number, uint primitive) {
    return cornersIn(previousGeometry(geometry, number), primitive,
                     GLINT_FRAME.previousInstances.data[geometry.instanceIndex].objectToWorld);
}

vec3 cornerMean(vec3 corners[3], vec2 barycentrics) {
    return corners[0] + barycentrics.x * (corners[1] - corners[0]) + barycentrics.y * (corners[2] - corners[0]);
}

// The place of a point of the world in the picture, without jitter, in pixels; w of its clip coordinates is above 0.
vec2 pixelNow(vec4 point) {
    vec3 clip = vec3(dot(GLINT_FRAME.worldToClip[0], point), dot(GLINT_FRAME.worldToClip[1], point),
                     dot(GLINT_FRAME.worldToClip[3], point));
    return (clip.xy / clip.z * 0.5 + 0.5) * vec2(GLINT_FRAME.width, GLINT_FRAME.height) + GLINT_FRAME.jitter;
}

float depthNow(vec3 point) {
    return dot(point - GLINT_FRAME.cameraPosition, GLINT_FRAME.cameraForward);
}

// The motion of a point of the world, or of a direction with w = 0, to its place in the previous frame: in pixels to
// the right and down, and in the third component the change of its depth. A point that the camera before had behind it
// gets a motion that leads out of the picture.
vec4 motionOf(vec4 now, vec4 before) {
    vec4 view = vec4(dot(GLINT_FRAME.previousView[0], before), dot(GLINT_FRAME.previousView[1], before),
                     dot(GLINT_FRAME.previousView[2], before), dot(GLINT_FRAME.previousView[3], before));
    vec2 size = vec2(GLINT_FRAME.width, GLINT_FRAME.height);
    if (view.w <= 0.0) {
        return vec4(-2.0 * size, 0.0, 0.0);
    }
    vec2 last = (view.xy / view.w * 0.5 + 0.5) * size;
    return vec4(last - pixelNow(now), now.w > 0.0 ? view.z - depthNow(now.xyz) : 0.0, 0.0);
}

// Returns the same for the sky, in a direction that the camera sees. Parallel rays always see the same part of it.
vec4 skyMotion(vec3 now, vec3 before) {
    return GLINT_FRAME.orthographic != 0u ? vec4(0.0) : motionOf(vec4(now, 0.0), vec4(before, 0.0));
}
