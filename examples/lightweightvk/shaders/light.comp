// Lights what the camera sees by the sun, with a shadow ray of the engine's own, and lists two rays for Glint: one into
// the highlight, one by Lambert's law. A pixel without a surface gets its sky from the first.
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) uniform texture2D kTextures2D[];
layout(set = 0, binding = 4) uniform accelerationStructureEXT kTLAS[];
uint pixel = gl_GlobalInvocationID.x;
uint state = pixel * 9781u + frame.number * 6271u;

// PCG (Jarzynski and Olano, "Hash functions for GPU rendering", 2020).
float random() {
    state = state * 747796405u + 2891336453u;
    uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return float(((word >> 22u) ^ word) >> 8u) / 16777216.0;
}

// A direction whose angle to z has this cosine.
vec3 around(float cosine) {
    float turn = 6.2831853 * random();
    return vec3(sqrt(1.0 - cosine * cosine) * vec2(cos(turn), sin(turn)), cosine);
}

mat3 frameAbout(vec3 z) {
    vec3 x = normalize(cross(abs(z.y) < 0.9 ? vec3(0, 1, 0) : vec3(1, 0, 0), z));
    return mat3(x, cross(z, x), z);
}

void send(uint number, vec3 from, vec3 to, vec3 weight) {
    uint slot = 2u * pixel + number;
    frame.weights.data[slot] = vec4(weight, 0.0);
    frame.rays.data[slot] = Ray(float[3](from.x, from.y, from.z), slot, float[3](to.x, to.y, to.z), 0.0, 0.0);
}

void main() {
    if (pixel >= frame.width * frame.height) {
        return;
    }
    ivec2 at = ivec2(pixel % frame.width, pixel / frame.width);
    vec4 seen = texelFetch(kTextures2D[frame.places], at, 0);
    if (seen.w == 0.0) {
        vec2 clip = 2.0 * (vec2(at) + 0.5) / vec2(frame.width, frame.height) - 1.0;
        vec4 far = inverse(frame.toClip) * vec4(clip.x, -clip.y, 1.0, 1.0);
        send(0u, frame.eye.xyz, normalize(far.xyz / far.w - frame.eye.xyz), vec3(1.0));
        send(1u, frame.eye.xyz, vec3(0, 1, 0), vec3(0.0));
        return;
    }
    Object object = frame.objects.data[uint(seen.w - 0.5)];
    Satin satin = Satin(object.color, object.mirror, object.gloss);
    mat3 surface = frameAbout(texelFetch(kTextures2D[frame.normals], at, 0).xyz);
    vec3 origin = seen.xyz + 1e-3 * surface[2];
    vec3 view = normalize(frame.eye.xyz - seen.xyz) * surface;
    vec3 sun = frame.sun.xyz * surface;
    rayQueryEXT query;
    rayQueryInitializeEXT(query, kTLAS[frame.tlas], gl_RayFlagsNoneEXT, 0xFFu, origin, 0.0, frame.sun.xyz, 1e4);
    while (rayQueryProceedEXT(query)) {}
    if (sun.z > 0.0 && rayQueryGetIntersectionTypeEXT(query, true) == gl_RayQueryCommittedIntersectionNoneEXT) {
        frame.sums.data[pixel].rgb += satinEvaluate(satin, view, sun) * frame.sun.w;
    }
    vec3 mirrored = satinMirrored(satin, view.z);
    vec3 lobe = frameAbout(vec3(-view.xy, view.z)) * around(pow(random(), 1.0 / (satin.gloss + 1.0)));
    send(0u, origin, surface * lobe, lobe.z > 0.0 ? mirrored : vec3(0.0));
    send(1u, origin, surface * around(sqrt(random())), satinScattered(satin, mirrored));
}
