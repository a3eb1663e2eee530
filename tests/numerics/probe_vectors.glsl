// Vectors among the arguments and results of probes.
#define VEC2(k) vec2(i[k], i[(k) + 1])
#define VEC3(k) vec3(i[k], i[(k) + 1], i[(k) + 2])
#define VEC4(k) vec4(i[k], i[(k) + 1], i[(k) + 2], i[(k) + 3])
#define WRITE3(k, v) \
    o[k] = (v).x;    \
    o[(k) + 1] = (v).y; \
    o[(k) + 2] = (v).z
