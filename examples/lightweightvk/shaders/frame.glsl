// Stands before each shader: the structures that the shaders share with main.cpp.
#extension GL_EXT_ray_query : require
layout(buffer_reference, std430) readonly buffer Floats { float data[]; };
layout(buffer_reference, std430) buffer Words { uint data[]; };
layout(buffer_reference, std430) buffer Pixels { vec4 data[]; };
struct Object {
    vec3 color;
    float gloss;
    vec3 mirror;
    float moved;
    Floats positions, normals;
    Words indices, pad;
};
layout(buffer_reference, std430) readonly buffer Objects { Object data[]; };
struct Ray {  // glint::RaySteps::Ray
    float origin[3];
    uint slot;
    float direction[3], coneWidth, coneSpread;
};
layout(buffer_reference, std430) writeonly buffer Rays { Ray data[]; };
layout(buffer_reference, std430) readonly buffer Frame {
    mat4 toClip;
    vec4 eye, sun;  // direction to it, and its irradiance
    Objects objects;
    Rays rays;
    Pixels weights, answers, sums;  // of rays, of rays, of pixels
    Words picture;
    uint width, height, number, tlas, places, normals;
};
layout(push_constant) uniform Push {
    Frame frame;
    uint drawn;
};
