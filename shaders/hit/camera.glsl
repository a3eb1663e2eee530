// The camera's rays, consistent with FrameConstants::worldToClip.
#include "hit/bindings.glsl"

struct CameraRay {
    vec3 origin;
    vec3 direction;  // unit vector
};

CameraRay cameraRay(uvec2 pixel) {
    vec2 unit = (vec2(pixel) + 0.5 + GLINT_FRAME.jitter) / vec2(GLINT_FRAME.width, GLINT_FRAME.height);
    vec2 p = vec2(2.0 * unit.x - 1.0, 1.0 - 2.0 * unit.y);
    vec3 across = p.x * GLINT_FRAME.cameraRight + p.y * GLINT_FRAME.cameraUp;
    if (GLINT_FRAME.orthographic != 0u) {
        return CameraRay(GLINT_FRAME.cameraPosition + across, GLINT_FRAME.cameraForward);
    }
    return CameraRay(GLINT_FRAME.cameraPosition, normalize(GLINT_FRAME.cameraForward + across));
}

// The barycentrics of the point where a ray meets a triangle's plane, clamped to the triangle: the rasteriser decides
// that the pixel is covered, and rounds differently. Möller and Trumbore (1997).
vec2 rayTriangleBarycentrics(CameraRay ray, vec3 p0, vec3 edge1, vec3 edge2) {
    vec3 p = cross(ray.direction, edge2);
    float determinant = dot(edge1, p);
    if (determinant == 0.0) {
        return vec2(0.0);
    }
    vec3 t = ray.origin - p0;
    float u = clamp(dot(t, p) / determinant, 0.0, 1.0);
    float v = clamp(dot(ray.direction, cross(t, edge1)) / determinant, 0.0, 1.0 - u);
    return vec2(u, v);
}
