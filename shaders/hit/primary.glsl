// The surface of a pixel, from the visibility in the G-buffer.
#include "hit/camera.glsl"
#include "hit/hit.glsl"

Hit primaryHit(HostGeometry geometry, uint primitive, CameraRay ray, uint pixel, Features features) {
    InstanceRecord instance = hostInstance(geometry);
    TriangleCorners triangle = vertexPositions(geometry, primitive);
    vec3 corners[3];
    for (uint i = 0u; i < 3u; ++i) {
        corners[i] = transformPoint(instance.objectToWorld, triangle.corners[i]);
    }
    vec2 barycentrics =
        rayTriangleBarycentrics(ray, corners[0], corners[1] - corners[0], corners[2] - corners[0]);
    vec3 position = corners[0] + barycentrics.x * (corners[1] - corners[0]) +
                    barycentrics.y * (corners[2] - corners[0]);
    float coneWidth = GLINT_FRAME.pixelWidth + GLINT_FRAME.pixelSpread * distance(position, ray.origin);
    return fetchHitAt(geometry, primitive, barycentrics, ray.direction, coneWidth, pixel, features, triangle);
}
