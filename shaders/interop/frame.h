// What the passes of a frame share: constants, ray list, hit records, buckets.
#ifndef GLINT_INTEROP_FRAME_H
#define GLINT_INTEROP_FRAME_H

#include "interop/scene.h"

GLINT_INTEROP_BEGIN

// Threads of a workgroup: one-dimensional passes over rays, and 8 x 8 tiles of passes over pixels.
GLINT_CONSTANT(kRayGroupSize, 64u);
GLINT_CONSTANT(kPixelGroupSize, 8u);
// Workgroups of a dispatch over rays in x before it grows in y: half of the least limit that Vulkan allows.
GLINT_CONSTANT(kMaxRayGroupsX, 32768u);
// Threads of the single workgroup that scans the buckets.
GLINT_CONSTANT(kScanGroupSize, 256u);

// HitRecord::geometry of a ray that hit nothing: no geometry can have it, as custom indices have 24 bits.
GLINT_CONSTANT(kMissGeometry, 0xFFFFFFFFu);
// GBuffer: geometry index of a pixel without a surface.
GLINT_CONSTANT(kNoSurface, 0xFFFFFFFFu);

// A ray that waits in the list. 36 bytes.
struct RayRecord {
    vec3 origin;
    uint pixel;  // x + y * width
    vec3 direction;  // unit
    float coneWidth;   // width of the ray cone at the origin, metres
    float coneSpread;  // growth of the width by metre
};

// What a ray found. 32 bytes.
struct HitRecord {
    uint pixel;      // x + y * width
    uint geometry;   // GeometryRecord index, or kMissGeometry
    uint primitive;  // triangle within the geometry
    float barycentricU_orDirectionX;
    float barycentricV_orDirectionY;
    float distance_orDirectionZ;
    float coneWidth;  // width of the ray cone at the hit, metres
    uint ray;         // RayRecord index
};

// VkDispatchIndirectCommand, padded to 16 bytes.
struct DispatchArguments {
    uint x;
    uint y;
    uint z;
    uint elementCount;  // threads that have work
};

// Bucket of a hit: 0 a miss, 1 + shaderId otherwise.
struct BucketRecord {
    uint count;   // hits in the bucket
    uint begin;   // first slot in the ordered list
    uint cursor;  // next free slot while copying
    uint pad;
};

GLINT_INTEROP_END

#ifndef __cplusplus
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer RayArray { RayRecord data[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer HitArray { HitRecord data[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer DispatchArray { DispatchArguments data[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer BucketArray { BucketRecord data[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer CounterArray { uint data[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer OrderedArray { uint data[]; };
#endif

GLINT_INTEROP_BEGIN

// FrameConstants::counters, one uint each.
GLINT_CONSTANT(kCounterRays, 0u);          // rays appended to the list
GLINT_CONSTANT(kCounterSkippedSky, 1u);    // pixels without a surface
GLINT_CONSTANT(kCounterSkippedRough, 2u);  // surfaces above the roughness limit
GLINT_CONSTANT(kCounterSkippedUnlit, 3u);  // unlit surfaces
GLINT_CONSTANT(kCounterUnknownShader, 4u); // hits whose shader ID no case has
GLINT_CONSTANT(kCounterNonFinite, 5u);     // pixels whose sample was no number: taken as black
GLINT_CONSTANT(kCounterCount, 6u);

// One frame of one sample.
struct FrameConstants {
    vec4 worldToClip[4];  // rows; Vulkan clip space, y down, reversed depth (1 near, 0 far), jittered
    vec3 cameraPosition;
    uint width;  // pixels
    vec3 cameraForward;  // unit
    uint height;
    vec3 cameraRight;  // from the image centre to its right edge, on the plane at distance 1 (perspective) or as is
    uint orthographic;  // 1: rays are parallel
    vec3 cameraUp;      // from the image centre to its top edge, likewise
    float pixelSpread;  // growth of a pixel's cone by metre (perspective); 0 if orthographic
    vec2 jitter;        // offset of the sample from the pixel centre, pixels in [-0.5, 0.5)
    float pixelWidth;   // width of a pixel's cone at the camera, metres; 0 for perspective
    uint sampleIndex;   // 0 for the first sample of a pixel
    uint seed;
    uint lightCount;
    uint bucketCount;  // 1 + cases
    float maxReflectionRoughness;  // surfaces rougher than this send no ray
    vec3 skyZenith;    // radiance, cd/m² in the units of the lights
    vec3 skyHorizon;
    vec3 skyGround;
    GLINT_ADDRESS(Geometry) geometries;
    GLINT_ADDRESS(Instance) instances;
    GLINT_ADDRESS(Material) materials;
    GLINT_ADDRESS(Light) lights;
    GLINT_ADDRESS(Ray) rays;
    GLINT_ADDRESS(Hit) hits;
    GLINT_ADDRESS(Ordered) orderedHits;  // hit indices, bucket by bucket
    GLINT_ADDRESS(Bucket) buckets;       // bucketCount
    GLINT_ADDRESS(Dispatch) rayDispatch;     // 1: over the ray list
    GLINT_ADDRESS(Dispatch) bucketDispatch;  // bucketCount
    GLINT_ADDRESS(Counter) counters;         // kCounterCount
};

GLINT_INTEROP_END

#ifndef __cplusplus
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer FrameArray { FrameConstants data; };
#endif

GLINT_INTEROP_BEGIN

struct PushConstants {
    GLINT_ADDRESS(Frame) frame;
    uint tlasIndex;  // into the array of acceleration structures; uniform in a dispatch
    uint bucket;     // shading passes: which bucket this dispatch shades
    uint geometry;   // G-buffer pass: GeometryRecord index of this draw
    uint pad;
};

// Descriptor set 0: the scene.
GLINT_CONSTANT(kSetScene, 0u);
GLINT_CONSTANT(kBindingTlas, 0u);      // accelerationStructureEXT[]
GLINT_CONSTANT(kBindingTextures, 1u);  // texture2D[]
GLINT_CONSTANT(kBindingSamplers, 2u);  // sampler[]
// Descriptor set 1: the images of a frame, all storage images.
GLINT_CONSTANT(kSetFrame, 1u);
GLINT_CONSTANT(kBindingSurface, 0u);          // rg32ui: geometry, primitive; also a colour attachment
GLINT_CONSTANT(kBindingRadiance, 1u);         // rgba32f: light that leaves the primary surface, reflection apart
GLINT_CONSTANT(kBindingNormalRoughness, 2u);  // rgba32f: shading normal, roughness (negative: no reflection)
GLINT_CONSTANT(kBindingPosition, 3u);         // rgba32f: ray origin off the surface; geometric normal, octahedral, bits 2x16snorm
GLINT_CONSTANT(kBindingReflectance, 4u);      // rgba32f: weight of the traced reflection
GLINT_CONSTANT(kBindingReflection, 5u);       // rgba32f: radiance that the traced ray brings
GLINT_CONSTANT(kBindingAccumulated, 6u);      // rgba32f: mean over samples so far, linear
GLINT_CONSTANT(kBindingResidual, 7u);         // rgba32f: what rounding keeps out of that mean
GLINT_CONSTANT(kFrameImageCount, 8u);

GLINT_INTEROP_END
#endif
