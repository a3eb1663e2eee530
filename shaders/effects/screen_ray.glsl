// A ray as a line of pixels. Over the screen, 1/w and distance/w are linear, where w is the fourth coordinate of clip
// space: McGuire and Mara, "Efficient GPU Screen-Space Ray Tracing" (JCGT 2014). Orthographic views have w = 1.

struct ScreenRay {
    vec2 begin;  // pixels
    vec2 end;    // where the ray leaves the view, pixels
    float inverseBegin;     // 1/w
    float inverseEnd;
    float distanceOverEnd;  // distance along the ray / w
};

// Returns where a ray leaves the half space in which a coordinate is positive, but at most `far`.
float leavesAt(float value, float slope, float far) {
    return slope < 0.0 ? min(max(value, 0.0) / -slope, far) : far;
}

vec2 pixelOf(vec4 clip, vec2 size) {
    return (clip.xy / clip.w * 0.5 + 0.5) * size;
}

// The visible part of a ray: from its origin, which must be in view, to the first of the six planes of clip space
// (reversed depth). A ray that meets none of them before `far` ends next to its vanishing point. `size` is that of the
// image in pixels.
ScreenRay screenRay(vec4 origin, vec4 direction, vec2 size, float far) {
    float distance = far;
    distance = leavesAt(origin.w - origin.z, direction.w - direction.z, distance);
    distance = leavesAt(origin.z, direction.z, distance);
    distance = leavesAt(origin.w - origin.x, direction.w - direction.x, distance);
    distance = leavesAt(origin.w + origin.x, direction.w + direction.x, distance);
    distance = leavesAt(origin.w - origin.y, direction.w - direction.y, distance);
    distance = leavesAt(origin.w + origin.y, direction.w + direction.y, distance);
    vec4 end = origin + distance * direction;
    end.w = max(end.w, end.z);  // The near plane bounds w: far away the sum may cancel to less.
    return ScreenRay(pixelOf(origin, size), pixelOf(end, size), 1.0 / origin.w, 1.0 / end.w, distance / end.w);
}

// For a share of the line, 0 to 1: the pixel coordinates, and the distance along the ray.
vec2 screenPixel(ScreenRay ray, float share) {
    return mix(ray.begin, ray.end, share);
}

float screenDistance(ScreenRay ray, float share) {
    return share * ray.distanceOverEnd / mix(ray.inverseBegin, ray.inverseEnd, share);
}
