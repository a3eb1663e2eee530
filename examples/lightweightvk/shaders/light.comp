// Lights what the camera sees by the sun, with a shadow ray of the engine's own, and lists two rays for Glint: one into
// the highlight, one by Lambert's law. A pixel without a surface gets its sky from the first.
#extension GL_EXT_ray_query : require
#include "frame.glsl"
#include "../materials/satin/satin_light.glsl"
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) uniform texture2D kTextures2D[];
layout(set = 0, binding = 4) uniform accelerationStructureEXT kTLAS[];

const float kTurn = 6.2831853;
uint state;

// Jarzynski and Olano, "Hash functions for GPU rendering" (2020): pcg.
float random() {
    state = state * 747796405u + 2891336453u;
    uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return float(((word >> 22u) ^ word) >> 8u) / 16777216.0;
}

// A frame about z.
mat3 frameAbout(vec3 z) {
    vec3 x = normalize(cross(abs(z.y) < 0.9 ? vec3(0, 1, 0) : vec3(1, 0, 0), z));
    return mat3(x, cross(z, x), z);
}

void send(uint slot, vec3 from, vec3 to, vec3 weight) {
    frame.weights.data[slot] = vec4(weight, 0.0);
    frame.rays.data[slot] = Ray(float[3](from.x, from.y, from.z), slot, float[3](to.x, to.y, to.z), 0.0, 0.0);
}

bool isSunlit(vec3 origin) {
    rayQueryEXT query;
    rayQueryInitializeEXT(query, kTLAS[frame.tlas], gl_RayFlagsTerminateOnFirstHitEXT, 0xFFu, origin, 0.0,
                          frame.sun.xyz, 1e4);
    while (rayQueryProceedEXT(query)) {}
    return rayQueryGetIntersectionTypeEXT(query, true) == gl_RayQueryCommittedIntersectionNoneEXT;
}

void main() {
    uint pixel = gl_GlobalInvocationID.x;
    if (pixel >= frame.width * frame.height) {
        return;
    }
    state = pixel * 9781u + frame.number * 6271u;
    ivec2 at = ivec2(pixel % frame.width, pixel / frame.width);
    vec4 seen = texelFetch(kTextures2D[frame.places], at, 0);
    if (seen.w == 0.0) {
        vec2 part = (vec2(at) + 0.5) / vec2(frame.width, frame.height);
        vec4 far = frame.fromClip * vec4(2.0 * part.x - 1.0, 1.0 - 2.0 * part.y, 1.0, 1.0);
        vec3 away = normalize(far.xyz / far.w - frame.eye.xyz);
        send(2u * pixel, frame.eye.xyz, away, vec3(1.0));
        send(2u * pixel + 1u, frame.eye.xyz, away, vec3(0.0));
        return;
    }
    Material material = frame.materials.data[uint(seen.w - 0.5)];
    Satin satin = Satin(material.color, material.mirror, material.gloss);
    mat3 surface = frameAbout(texelFetch(kTextures2D[frame.normals], at, 0).xyz);
    vec3 origin = seen.xyz + 1e-3 * surface[2];
    vec3 view = normalize(frame.eye.xyz - seen.xyz) * surface;
    vec3 sun = frame.sun.xyz * surface;
    if (sun.z > 0.0 && isSunlit(origin)) {
        frame.sums.data[pixel].rgb += satinLight(satin, view, sun) * frame.sun.w;
    }
    vec3 mirrored = satinMirrored(satin, view.z);
    float cosine = pow(random(), 1.0 / (satin.gloss + 1.0));
    float turn = kTurn * random();
    vec3 about = vec3(sqrt(1.0 - cosine * cosine) * vec2(cos(turn), sin(turn)), cosine);
    vec3 lobe = frameAbout(vec3(-view.xy, view.z)) * about;
    send(2u * pixel, origin, surface * lobe, lobe.z > 0.0 ? mirrored : vec3(0.0));
    float square = random();
    turn = kTurn * random();
    vec3 around = vec3(sqrt(square) * vec2(cos(turn), sin(turn)), sqrt(1.0 - square));
    send(2u * pixel + 1u, origin, surface * around, satinScattered(satin, mirrored));
}
