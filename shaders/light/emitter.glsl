// Emissive triangles as lights. A sample is a point of a triangle that is chosen by the hierarchy, or of each triangle
// with --lights all. Rays of effects and paths find the same triangles by chance. Both share the light by the balance
// heuristic (Veach and Guibas, "Optimally Combining Sampling Techniques for Monte Carlo Rendering", 1995).
#include "hit/alpha.glsl"
#include "hit/material.glsl"
#include "hit/samples.glsl"
#include "host/lights.glsl"
#include "host/random.glsl"
#include "light/shared_sample.glsl"

#if GLINT_EMISSIVE_LIGHTS

// The pairs of dimensions of the sequence: a point of the first light, and of each further one.
const uint kPairEmitter = 0x20000u;

// Triangles that fill less are sampled by area. There the density by solid angle hardly varies, unless the triangle is
// seen from the side, and the formulas for the sphere lose their digits.
const float kLeastSampledAngle = 0.01;

// The corners in the world.
struct EmitterTriangle {
    vec3 corners[3];
    HostGeometry geometry;
    uint primitive;
};

EmitterTriangle emitterTriangle(uint emitter) {
    EmitterRecord record = GLINT_FRAME.emitters.data[emitter];
    HostGeometry geometry = hostGeometry(record.geometry);
    InstanceRecord instance = hostInstance(geometry);
    EmitterTriangle triangle;
    triangle.geometry = geometry;
    triangle.primitive = record.primitive;
    vec3 corners[3];
    hostPositions(geometry, hostTriangle(geometry, record.primitive), corners);
    for (uint i = 0u; i < 3u; ++i) {
        triangle.corners[i] = transformPoint(instance.objectToWorld, corners[i]);
    }
    return triangle;
}

// A triangle as it is seen from a point.
struct SeenTriangle {
    vec3 a;       // unit vectors to the corners
    vec3 b;
    vec3 c;
    float angle;  // solid angle
};

// The solid angle: Van Oosterom and Strackee, "The Solid Angle of a Plane Triangle" (1983).
SeenTriangle seenFrom(vec3 position, EmitterTriangle triangle) {
    SeenTriangle seen;
    seen.a = directionOr(triangle.corners[0] - position, vec3(0.0));
    seen.b = directionOr(triangle.corners[1] - position, vec3(0.0));
    seen.c = directionOr(triangle.corners[2] - position, vec3(0.0));
    precise float volume = abs(dot(seen.a, cross(seen.b, seen.c)));
    precise float across = 1.0 + dot(seen.a, seen.b) + dot(seen.b, seen.c) + dot(seen.c, seen.a);
    precise float angle = 2.0 * atan(volume, across);
    seen.angle = angle;
    return seen;
}

// The density, by solid angle, of a sample of the triangle, at its point along a unit vector.
float emitterPointDensity(vec3 position, EmitterTriangle triangle, SeenTriangle seen, vec3 point) {
    if (seen.angle >= kLeastSampledAngle) {
        return 1.0 / seen.angle;
    }
    precise vec3 away = point - position;
    precise float squared = dot(away, away);
    // Twice the area, and |cosine| times it.
    precise vec3 normal = cross(triangle.corners[1] - triangle.corners[0], triangle.corners[2] - triangle.corners[0]);
    precise float projected = abs(dot(normal, away)) / sqrt(squared);
    return projected > 0.0 ? 2.0 * squared / projected : 0.0;
}

// The part of v across the unit vector u, as a unit vector.
vec3 acrossFrom(vec3 v, vec3 u) {
    precise vec3 across = v - dot(v, u) * u;
    return directionOr(across, vec3(0.0));
}

// Samples a direction uniformly within a triangle of the sphere: Arvo, "Stratified Sampling of Spherical Triangles"
// (1995). The differences of its formulas are written as products, which keep their digits for small angles.
vec3 sampleSeenTriangle(SeenTriangle seen, vec2 u) {
    // The angle between the arcs at a.
    precise vec3 ab = acrossFrom(seen.b, seen.a);
    precise vec3 ac = acrossFrom(seen.c, seen.a);
    precise float cosAlpha = clamp(dot(ab, ac), -1.0, 1.0);
    precise float alpha = acos(cosAlpha);
    precise float sinAlpha = sin(alpha);
    precise float half_ = 0.5 * u.x * seen.angle;
    precise float s = sin(2.0 * half_ - alpha);
    precise float t = cos(2.0 * half_ - alpha);
    precise float p = 2.0 * sin(alpha - half_) * sin(half_);
    precise vec3 chord = seen.b - seen.a;
    precise float q = 2.0 * sin(half_) * cos(half_ - alpha) - 0.5 * sinAlpha * dot(chord, chord);
    precise float below = (q * s + p * t) * sinAlpha;
    precise float cosine = below != 0.0 ? ((q * t - p * s) * cosAlpha - q) / below : 1.0;
    // The place on the arc from a to c.
    precise float held = clamp(cosine, -1.0, 1.0);
    precise vec3 place = held * seen.a + sqrt(max(1.0 - held * held, 0.0)) * ac;
    // This is the place on the arc from b to there. 1 - cosine of the whole arc is half of the squared chord.
    precise vec3 side = place - seen.b;
    precise float height = u.y * 0.5 * dot(side, side);
    precise vec3 direction = (1.0 - height) * seen.b +
                             sqrt(max(height * (2.0 - height), 0.0)) * acrossFrom(place, seen.b);
    return direction;
}

// The barycentric coordinates at which a direction from a point meets a triangle's plane, held within the triangle.
vec2 barycentricsAlong(vec3 position, vec3 direction, EmitterTriangle triangle) {
    precise vec3 edge1 = triangle.corners[1] - triangle.corners[0];
    precise vec3 edge2 = triangle.corners[2] - triangle.corners[0];
    precise vec3 from = position - triangle.corners[0];
    precise vec3 across = cross(direction, edge2);
    precise float determinant = dot(edge1, across);
    precise float x = dot(from, across) / determinant;
    precise float y = dot(direction, cross(from, edge1)) / determinant;
    if (isnan(x) || isnan(y)) {
        return vec2(1.0 / 3.0);
    }
    precise float first = clamp(x, 0.0, 1.0);
    return vec2(first, clamp(y, 0.0, 1.0 - first));
}

// Samples a triangle uniformly: Heitz, "A Low-Distortion Map Between Triangle and Square" (2019).
vec2 sampleBarycentrics(vec2 u) {
    return u.x < u.y ? vec2(0.5 * u.x, u.y - 0.5 * u.x) : vec2(u.x - 0.5 * u.y, 0.5 * u.y);
}

// The light that the surface emits towards its viewer.
vec3 emissionOf(Hit hit, Features features) {
#if GLINT_EMITTER_LAYERS
    return evaluateSurface(hit, features).emission;
#else
    changeCoordinates(hit, features);
    return runEmissionStage(hit, features);
#endif
}

SharedSample sampleEmitter(uint emitter, vec3 position, vec2 u) {
    EmitterTriangle triangle = emitterTriangle(emitter);
    SeenTriangle seen = seenFrom(position, triangle);
    bool byAngle = seen.angle >= kLeastSampledAngle;
    vec2 barycentrics = byAngle ? barycentricsAlong(position, sampleSeenTriangle(seen, u), triangle)
                                : sampleBarycentrics(u);
    precise vec3 point = triangle.corners[0] + (barycentrics.x * (triangle.corners[1] - triangle.corners[0]) +
                                                barycentrics.y * (triangle.corners[2] - triangle.corners[0]));
    SharedSample result = SharedSample(directionOr(point - position, vec3(0.0)), vec3(0.0), 0.0, point);
    result.density = emitterPointDensity(position, triangle, seen, point);
    if (result.direction == vec3(0.0) || result.density <= 0.0) {
        result.density = 0.0;
        return result;
    }
    HostGeometry geometry = triangle.geometry;
    Features features = Features(GLINT_EMITTER_ALL, GLINT_KEY(geometry));
    // A cone without width reads the finest level of textures.
    Hit hit = fetchHitAt(geometry, triangle.primitive, barycentrics, result.direction, 0.0, 0u, features,
                         vertexPositions(geometry, triangle.primitive));
    if (!hit.frontFace && (geometry.flags & kGeometryDoubleSided) == 0u) {
        result.density = 0.0;
        return result;
    }
    result.radiance = emissionOf(hit, features);
#if GLINT_ALPHA_TESTED
    if ((geometry.flags & kGeometryAlphaTested) != 0u) {
        result.radiance *= coverageAt(geometry, triangle.primitive, barycentrics);
    }
#endif
    precise vec3 end = hit.position + hit.clearance * hit.geometricNormal;
    result.end = end;
    return result;
}

// The sample of a light that hostLight() has given. Its density is that of all samples of a surface together.
SharedSample emitterLight(Hit hit, HostLight light, uint pair) {
    if (light.chance <= 0.0) {
        return SharedSample(vec3(0.0), vec3(0.0), 0.0, vec3(0.0));
    }
    SharedSample drawn = sampleEmitter(light.emitter, hit.position, hostRandomPair(hit.target, pair));
    drawn.density *= light.chance;
    return drawn;
}

// The shadow ray of a sample, in place of its direction: from the start of rays that leave the surface to the end of
// the triangle's clearance.
LightSample emitterAim(Hit hit, SharedSample drawn) {
    precise vec3 away = drawn.end - rayOrigin(hit, drawn.direction);
    precise float squared = dot(away, away);
    precise float distance = sqrt(squared);
    vec3 direction = directionOr(away, vec3(0.0));
    bool sameSide = dot(direction, hit.geometricNormal) * dot(drawn.direction, hit.geometricNormal) > 0.0;
    return LightSample(direction, sameSide ? distance : 0.0, vec3(0.0), kRaySent);
}

// The density, by solid angle, of all samples of emissive lights that a surface takes, in the direction of a hit. It is
// 0 if the hit is on no such light.
float emitterDensity(LightReceiver receiver, Hit hit) {
    uint first = GLINT_FRAME.firstEmitters.data[hit.geometry];
    if (first == kNoEmitter) {
        return 0.0;
    }
    uint emitter = first + hit.primitive;
    float chance = emitterChance(receiver, emitter);
    EmitterTriangle triangle = emitterTriangle(emitter);
    if (chance <= 0.0 || (!hit.frontFace && (triangle.geometry.flags & kGeometryDoubleSided) == 0u)) {
        return 0.0;
    }
    SeenTriangle seen = seenFrom(receiver.position, triangle);
    return chance * emitterPointDensity(receiver.position, triangle, seen, hit.position);
}

// The share of the emission of a hit that its ray brings. The lights of the surface that sent it bring the rest.
float emissionOfRay(Hit hit) {
#if GLINT_STEPS
    if (GLINT_FRAME.bounce <= 1u) {
        return 1.0;  // A host's rays are of no lobe.
    }
#endif
    LobeRay ray = GLINT_FRAME.lobeRays.data[samplePlace(hit.target)];
#if GLINT_SHADOW_GLASS
    if (ray.density < 0.0) {
        return 0.0;
    }
#endif
    if (ray.density <= 0.0) {
        return 1.0;
    }
    float lights = emitterDensity(LightReceiver(hit.start, unpackReceiver(ray.normal)), hit);
    return ray.density / (ray.density + lights);
}

#endif
