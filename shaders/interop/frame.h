// The data that the passes of a frame share: constants, ray list, hit records, buckets.
#ifndef GLINT_INTEROP_FRAME_H
#define GLINT_INTEROP_FRAME_H

#include "interop/scene.h"

GLINT_INTEROP_BEGIN

// Threads of a workgroup in one-dimensional passes over rays, and the side of the 8 x 8 tiles of passes over pixels.
GLINT_CONSTANT(kRayGroupSize, 64u);
GLINT_CONSTANT(kPixelGroupSize, 8u);
// The order of first hits: the threads of a workgroup, and the pixels of each.
GLINT_CONSTANT(kFirstGroupSize, 256u);
GLINT_CONSTANT(kFirstPixelsOfThread, 4u);
// The most workgroups of a dispatch over rays in x before it grows in y: half of the least limit that Vulkan allows.
GLINT_CONSTANT(kMaxRayGroupsX, 32768u);
// Threads of the single workgroup that scans the buckets.
GLINT_CONSTANT(kScanGroupSize, 256u);

// The most buckets that the orderings local-histogram and tile-sort hold in shared memory.
GLINT_CONSTANT(kMaxLocalBuckets, 1024u);
// The ordering tile-sort. The first constant is the number of hits for each thread in a tile, which a workgroup sorts
// at a time. The threads of that workgroup depend on the number of buckets: up to kSmallTileBuckets, up to
// kTileBuckets, and above, where a device can run that many. The last constant is for the workgroups that count. A
// vector of keys may be read up to the end of the last tile.
GLINT_CONSTANT(kTileHitsOfThread, 8u);
GLINT_CONSTANT(kSmallTileBuckets, 128u);
GLINT_CONSTANT(kTileBuckets, 512u);
GLINT_CONSTANT(kSmallTileThreads, 448u);
GLINT_CONSTANT(kTileThreads, 512u);
GLINT_CONSTANT(kLargeTileThreads, 1024u);
GLINT_CONSTANT(kCountGroupSize, 512u);
// The most shared memory that tile-sort takes in bytes (a word for each hit, bucket and subgroup), and the same with
// kLargeTileThreads.
GLINT_CONSTANT(kTileSharedBytes, 20992u);
GLINT_CONSTANT(kLargeTileSharedBytes, 37888u);

// HitRecord::geometry of a ray that hit nothing. No geometry can have this index, because custom indices have 24 bits.
GLINT_CONSTANT(kMissGeometry, 0xFFFFFFFFu);
// FrameConstants::orderedHits: a slot without a hit.
GLINT_CONSTANT(kNoHit, 0xFFFFFFFFu);
// G-buffer: the geometry index of a pixel without a surface.
GLINT_CONSTANT(kNoSurface, 0xFFFFFFFFu);

// The number of an effect's sample of a primary surface: slot * width * height + x + y * width, where slot is that of
// the effect among the package's effects that send rays. Samples, rays and random numbers go by this number. A frame
// may be lit in bands of rows, one after the other, which share memory. The records of a sample then lie at its place
// in its band (samplePlace() in hit/samples.glsl).

// A sample of an effect is a ray and the weight of the light that it finds. Three records hold it, so that each pass
// reads only the members that it needs. The second and the third are written only if the ray is sent or the march in
// screen space may read them.

// 16 bytes. In packages with paths of one bounce, light takes the place of the origin when the ray is shaded.
struct SampleStart {
    vec3 origin_orRadiance;
    uint state;  // kRaySent, or why there is no ray; in the bits from kPathShift on how the light was found, kPath*
};
GLINT_CONSTANT(kPathShift, 8u);
GLINT_CONSTANT(kOutcomeMask, 0xFFu);
// These are the same bits in the state of a packed record with light, which takes 24 bytes: a SampleStart, and a uvec2
// in the place of the other two (packed/sample.glsl).
GLINT_CONSTANT(kPackedPathShift, 4u);
GLINT_CONSTANT(kPackedPathMask, 0xFu);
GLINT_CONSTANT(kPackedOutcomeMask, 0xFu);

// 16 bytes.
struct SampleAim {
    vec3 direction;   // unit vector
    float coneWidth;  // width of the ray cone at the origin, metres
};

// 16 bytes.
struct SampleWeight {
    vec3 weight;       // factor of the radiance that the ray finds
    float coneSpread;  // growth of the cone's width in a metre
};

// A ray as a host lists it. 36 bytes. The lists of a frame have the number of each ray's sample instead.
struct RayRecord {
    vec3 origin;
    uint target;  // number of the sample
    vec3 direction;  // unit vector
    float coneWidth;   // width of the ray cone at the origin, metres
    float coneSpread;  // growth of the width in a metre
};

// The state of a sample's path after a bounce. There is one for each sample, in packages with paths of several bounces.
// The next ray takes the place of the last one in the sample's records. 20 bytes.
struct PathState {
    vec3 throughput;  // factor of the radiance that the ray finds, since the primary surface
    uint media[2];    // volumes that the ray is in (materials/base/media.glsl)
};

// A ray of a host's own that only asks whether something is in its way. 32 bytes.
struct VisibilityRay {
    vec3 origin;
    uint target;     // number of the answer
    vec3 direction;  // unit vector
    float distance;  // metres; what is beyond does not count
};

// The hit of a ray. Its index is that of the ray in the list. 20 bytes.
struct HitRecord {
    uint geometry;   // GeometryRecord index, or kMissGeometry
    uint primitive;  // triangle within the geometry
    float barycentricU;
    float barycentricV;
    float coneWidth;  // width of the ray cone at the hit, metres
};

// The same hit in 12 bytes. A miss has 0xFFFFFFFF in its first word, which no hit can have.
struct PackedHitRecord {
    uint geometry24_coneLog8;  // top 8 bits: 8 log2 of the cone's width in metres over 2^-20, at most 254; 0 for no
                               // width
    uint primitive;
    uint barycentrics2x16;  // unorm
};

// A shadow ray that waits, with the light that arrives if nothing is in the way. 48 bytes.
struct ShadowRecord {
    vec3 origin;
    uint target;  // number of the sample that gets the light
    vec3 direction;  // unit vector
    float distance;  // metres
    vec3 light;
    uint sees;       // kShadow*
};
// The surfaces that stop a shadow ray.
GLINT_CONSTANT(kShadowOfLight, 0u);     // either side of every surface
GLINT_CONSTANT(kShadowOfShared, 1u);   // what stops a ray of a lobe that finds the light by chance
GLINT_CONSTANT(kShadowOfSharedWithin, 2u);  // the same within a volume
// The light is as for kShadowOfLight. If the light has passed glass, it is multiplied by the float in the other bits.
GLINT_CONSTANT(kShadowPastGlass, 3u);
GLINT_CONSTANT(kShadowKind, 3u);  // the bits of these numbers

// The most shadow rays of a pixel that wait in memory at once: a package has room for those that its scenes need, up to
// this number. Pixels with more are shaded once more for each further round of as many.
GLINT_CONSTANT(kMostFirstShadowRays, 4u);

// A hit as a surface, for a host that lights it. 112 bytes. Vectors are in the world.
struct SurfaceRecord {
    vec3 position;         // of a miss: the direction of the ray
    uint shaderId;         // of the case, or kSurface*
    vec3 normal;           // unit, of shading; on the viewer's side
    float roughness;       // square root of the larger alpha
    vec3 geometricNormal;  // unit, on the viewer's side
    float clearance;       // metres along geometricNormal at which a ray that leaves the surface starts
    vec3 albedo;           // of the diffuse reflection
    float occlusion;       // of ambient light
    vec3 f0;               // reflectance at normal incidence, of metal and dielectric together
    float f90;             // and at grazing angles
    vec3 emission;         // radiance; of an unlit material, its colour
    float transmission;    // share of the light that passes, specularly or diffusely
    vec3 motion;           // since the frame before, metres
    uint material;         // index of the material
};
// SurfaceRecord::shaderId of a ray that hit nothing, and of a hit that no case can shade.
GLINT_CONSTANT(kSurfaceMiss, 0xFFFFFFFFu);
GLINT_CONSTANT(kSurfaceUnknown, 0xFFFFFFFEu);

// The positions of a geometry in the previous frame, in the form of GeometryRecord::flags.
struct PreviousVertices {
    GLINT_ADDRESS(Vec3Array) positions;
};

// The hit of the first ray of a sample, for layers. 32 bytes.
struct RayHit {
    uint geometry;   // as in HitRecord; kScreenGeometry if the end was found in screen space
    uint primitive;  // kScreenGeometry: the number of the pixel whose surface it is
    vec2 barycentrics;
    vec3 direction;  // of the ray that found it, unit vector
    float distance;  // from the primary surface along the way, metres
};

// The light of one bounce of a sample's path, for layers. 16 bytes.
struct BounceLight {
    vec3 light;      // as the radiance of the sample, of which it is a part
    float distance;  // of the bounce's ray, metres; 0: none
};
GLINT_CONSTANT(kScreenGeometry, 0xFFFFFFFEu);
// Values of layers (glint/layers.h).
GLINT_CONSTANT(kLayerNoRay, 0xFFFFFFFFu);
GLINT_CONSTANT(kLayerLeftScene, 0xFFFFFFFEu);
GLINT_CONSTANT(kLayerOnScreen, 0xFFFFFFFDu);
GLINT_CONSTANT(kInfiniteSample, 0x10000u);
// RayHit::distance of a ray that left the scene: the largest 16-bit float.
GLINT_CONSTANT(kDistanceOfMiss, 65504u);

// FrameConstants::recordsBy: how instances of a host lead to GeometryRecords.
GLINT_CONSTANT(kRecordsByCustomIndex, 0u);       // the custom index is the number of the first record
GLINT_CONSTANT(kRecordsByCustomIndexTable, 1u);  // firstRecords[custom index] is
GLINT_CONSTANT(kRecordsByInstanceTable, 2u);     // firstRecords[place of the instance in the TLAS] is

// VkDispatchIndirectCommand and VkTraceRaysIndirectCommandKHR for the same list. 32 bytes.
struct DispatchArguments {
    uint x;  // workgroups
    uint y;
    uint z;
    uint elementCount;  // threads that have work
    uint traceWidth;  // = elementCount
    uint traceHeight;
    uint traceDepth;
    uint pad;
};

GLINT_INTEROP_END

#ifndef __cplusplus
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer SampleStartArray { SampleStart data[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer SampleAimArray { SampleAim data[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer SampleWeightArray { SampleWeight data[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer TargetArray { uint data[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer RadianceArray { vec4 data[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer RayArray { RayRecord data[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer VisibilityRayArray { VisibilityRay data[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer VisibilityArray { float data[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer PathArray { PathState data[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer LobeRayArray { LobeRay data[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer SkyShareArray { float data[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer HitArray { HitRecord data[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer PackedHitArray { PackedHitRecord data[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer ShadowArray { ShadowRecord data[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer DispatchArray { DispatchArguments data[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer KeyArray { uvec4 data[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer CounterArray { uint data[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer SurfaceArray { SurfaceRecord data[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer OrderedArray { uint data[]; };
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer PreviousVerticesArray {
    PreviousVertices data[];
};
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer RayHitArray { RayHit data[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer BounceLightArray { BounceLight data[]; };
#endif

GLINT_INTEROP_BEGIN

// The outcome of a surface for an effect: a ray, or the reason why it sends none. These are also the first counts of an
// effect.
GLINT_CONSTANT(kRaySent, 0u);
GLINT_CONSTANT(kRayNoSurface, 1u);  // the pixel shows the sky
GLINT_CONSTANT(kRayUnlit, 2u);
GLINT_CONSTANT(kRayRough, 3u);      // above the roughness limit
GLINT_CONSTANT(kRayBlack, 4u);      // the sample would bring no light, or points into the surface
GLINT_CONSTANT(kRayAbsent, 5u);     // the material has no such lobe
GLINT_CONSTANT(kRayFaint, 6u);      // below FrameConstants::faintWeight
GLINT_CONSTANT(kRayFacing, 7u);     // the surface faces away from the light
GLINT_CONSTANT(kRayRange, 8u);      // beyond the light's range
GLINT_CONSTANT(kRayCone, 9u);       // outside the light's cone
GLINT_CONSTANT(kRayOff, 10u);       // FrameConstants::effects lacks the effect
GLINT_CONSTANT(kRayEnded, 11u);     // the ray's end was found without the list
// The further counts of an effect.
GLINT_CONSTANT(kCountScreenHits, 12u);  // found in screen space
GLINT_CONSTANT(kCountHits, 13u);        // rays that hit
GLINT_CONSTANT(kCountMisses, 14u);      // rays that left the scene, or hit nothing on their way
GLINT_CONSTANT(kCountSegments, 15u);    // rays traced before the one that joins the list
GLINT_CONSTANT(kCountWaited, 16u);      // shadow rays of first hits that waited in memory
GLINT_CONSTANT(kCountsOfEffect, 17u);

// FrameConstants::counters, one uint each.
GLINT_CONSTANT(kCounterRays, 0u);           // rays appended to the list
GLINT_CONSTANT(kCounterShadowRays, 1u);     // deferred shadow rays in the list
GLINT_CONSTANT(kCounterUnknownShader, 2u);  // hits whose shader ID no case has
GLINT_CONSTANT(kCounterOrderErrors, 3u);    // lost, doubled or misplaced hits, found by the check of the order
GLINT_CONSTANT(kCounterNonFinite, 4u);      // pixels whose sample was not a number and was taken as black
GLINT_CONSTANT(kCounterDeepest, 5u);        // the deepest bounce that many rays reach, in packages with paths
GLINT_CONSTANT(kCounterAlphaTests, 6u);     // candidates whose alpha was tested, if kCountsLight
// The counters from here on exist kCounterCopies times and are to be added up: kCountsOfEffect for each effect, in the
// order of their bits up to the package's last one.
GLINT_CONSTANT(kCounterEffects, 7u);
GLINT_CONSTANT(kCounterCopies, 64u);
// In packages with --texture-levels one more counter for each texture follows these: kFinestTextureLevel minus the
// finest level that was read; 0 if the texture was not read.
GLINT_CONSTANT(kFinestTextureLevel, 32u);

// FrameConstants::binning: the criterion by which rays of a workgroup are sorted before they are appended to the list.
GLINT_CONSTANT(kBinningNone, 0u);
GLINT_CONSTANT(kBinningSign, 1u);        // signs of the direction: 8 bins
GLINT_CONSTANT(kBinningOctahedral, 2u);  // cells of the octahedral map of the direction: 8 x 8 bins
GLINT_CONSTANT(kMaxDirectionBins, 64u);

// FrameConstants::accumulates, bits.
GLINT_CONSTANT(kPictureHasResidual, 1u);  // the residual of the mean has an image
GLINT_CONSTANT(kPictureIsHalf, 2u);       // the images of light have 16-bit floats: values above kMostHalf become that
GLINT_CONSTANT(kMostHalf, 65504u);

// Shaders have the last members only in packages that need them, so that others do not change. Those that follow a
// group of members need this group, too.
#ifdef __cplusplus
#define GLINT_SKY_LIGHT_MEMBERS 1
#define GLINT_LAYER_MEMBERS 1
#define GLINT_LAYER_WALKS 1
#endif

// The constants of one frame of one sample.
struct FrameConstants {
    vec4 worldToClip[4];  // rows; Vulkan clip space, y down, reversed depth (1 near, 0 far), jittered
    // The members that lead to the place of a sample stand together, so that one load reads them.
    uint width;  // pixels
    uint height;
    // The band of rows that the passes over pixels are at:
    uint bandFirst;     // the number of its first pixel
    uint outsideBands;  // pixels of the frame that samples of a band have no memory for
    uint firstRow;
    uint endRow;        // the row after its last one
    vec3 cameraPosition;
    vec3 cameraForward;  // unit vector
    vec3 cameraRight;  // from the image centre to its right edge, on the plane at distance 1 (perspective) or in world
                       // units (orthographic)
    uint orthographic;  // 1: rays are parallel
    vec3 cameraUp;      // from the image centre to its top edge, likewise
    float pixelSpread;  // growth of the cone of one of a pixel's samples by metre (perspective); 0 if orthographic
    vec2 jitter;        // offset of the sample from the pixel centre, pixels in [-0.5, 0.5)
    float pixelWidth;   // width of that cone at the camera, metres; 0 for perspective
    float sampleLodBias;  // of levels that derivatives of the screen choose: log2 of that cone's share of the pixel
    float lengthUnit;   // metres: a power of two, in which lengths count that are kept in few bits
    float perLengthUnit;  // 1 / lengthUnit
    uint sampleIndex;   // 0 for the first sample of a pixel
    uint seed;
    uint averaged;  // samples in the mean that this one joins; 0: the picture starts with it
    float time;  // seconds: what materials of packs may follow
    uint effects;  // bits of the package's effects that are on
    uint lightCount;
    uint shadowSamples;     // rays for each light and sample on primary surfaces, for lights that have a size
    uint occlusionSamples;  // rays for each sample
    float occlusionRadius;  // metres; kFarDistance for no limit
    uint occlusionFalloff;  // 1: an occluder counts less with distance, linearly; 0: all count alike
    uint maxInterfaces;     // the most interfaces that a refracted ray passes
    uint bucketCount;  // 1 + cases
    uint bucketAlignment;  // buckets begin at multiples of it in the ordered list
    float mirrorRoughness;  // surfaces smoother than this reflect as mirrors
    float maxReflectionRoughness;  // surfaces rougher than this send no ray
    float faintWeight;  // samples whose weight has a smaller luminance are not sent; 0 sends all
    float maxSampleRadiance;  // the most luminance that a ray of an effect brings; infinite for no limit
    uint binning;  // kBinning*
    uint screenSteps;  // steps of the march in screen space; 0 for none
    float screenThickness;  // assumed thickness of a pixel's surface, as a share of its depth
    vec3 skyZenith;    // radiance, cd/m² in the units of the lights
    vec3 skyHorizon;
    vec3 skyGround;
    vec3 skyHarmonics[9];  // environment: irradiance over π, factors of 1, x, y, z, 3y² - 1, xy, yz, xz, x² - z²
    float environmentLevels;  // mip levels of the environment map: roughness 0 to 1
    float environmentTurn;    // added to its u: a rotation over 2π
    float environmentScale;   // radiance of a texel with the value 1
    GLINT_ADDRESS(GeometryArray) geometries;
    GLINT_ADDRESS(InstanceArray) instances;
    GLINT_ADDRESS(MaterialArray) materials;
    GLINT_ADDRESS(LightArray) lights;
    GLINT_ADDRESS(LightNodeArray) lightNodes;  // in packages with --lights K: the tree, then the lights apart from it
    GLINT_ADDRESS(SampleStartArray) sampleStarts;  // samples of every pixel of a band, effect by effect
    GLINT_ADDRESS(SampleAimArray) sampleAims;
    GLINT_ADDRESS(SampleWeightArray) sampleWeights;
    GLINT_ADDRESS(RadianceArray) radiance;  // the radiance that rays bring, with paths of several bounces in the order of
                                       // samples, and by slot if the rays are a host's; kPath* as a float
    GLINT_ADDRESS(RayArray) rays;           // the list, if it is a host's
    GLINT_ADDRESS(TargetArray) listed;      // the list otherwise, and of further bounces: the numbers of the samples that
                                       // send the rays
    GLINT_ADDRESS(HitArray) hits;
    GLINT_ADDRESS(PackedHitArray) packedHits;  // the same memory as hits
    GLINT_ADDRESS(OrderedArray) orderedHits;  // hit indices, bucket by bucket; kNoHit in the gaps of alignment
    // The bucket of a hit is 0 for a miss, 1 + shaderId otherwise. Keys are the buckets of all hits, in 1, 2 or 4
    // bytes of a word, depending on the number of buckets. The next three lists hold for each bucket: its number of hits, its
    // first slot in the ordered list, and how many of its slots have been taken while hits are copied.
    GLINT_ADDRESS(KeyArray) bucketKeys;
    GLINT_ADDRESS(CounterArray) bucketCounts;   // bucketCount
    GLINT_ADDRESS(CounterArray) bucketBegins;   // bucketCount
    GLINT_ADDRESS(CounterArray) bucketCursors;  // bucketCount
    GLINT_ADDRESS(CounterArray) visitedHits;  // one bit for each hit, for the check of the order
    GLINT_ADDRESS(DispatchArray) rayDispatch;     // 1: over the ray list
    GLINT_ADDRESS(DispatchArray) bucketDispatch;  // bucketCount, then one over the ordered list, gaps included
    GLINT_ADDRESS(ShadowArray) shadows;           // kCounterShadowRays
    GLINT_ADDRESS(DispatchArray) shadowDispatch;  // 1: over the shadow rays
    GLINT_ADDRESS(CounterArray) firstShadowCounts;  // of every pixel of a band: the shadow rays that its surface sends
    GLINT_ADDRESS(CounterArray) counters;         // kCounterCount
    // The members for rays of a host's own:
    GLINT_ADDRESS(SurfaceArray) surfaces;           // the answers, if they are surfaces
    GLINT_ADDRESS(InstanceArray) previousInstances;  // transforms of the frame before
    GLINT_ADDRESS(UintArray) firstRecords;           // see kRecordsBy*
    uint recordsBy;
    uint rayMask;  // instances that share no bit with it are not hit
    uvec2 tlasAddress;  // of the acceleration structure, in packages that have it by address
    GLINT_ADDRESS(CounterArray) rayCount;   // the length of the list
    GLINT_ADDRESS(HitArray) givenHits;      // the hits of the rays, if givesHits
    GLINT_ADDRESS(VisibilityRayArray) visibilityRays;  // the list, if its rays only ask for visibility
    GLINT_ADDRESS(VisibilityArray) visibilities;       // their answers: a float each, or three where shadow rays pass glass
    GLINT_ADDRESS(PrimitiveMaterialsArray) primitiveMaterials;  // see GeometryRecord::primitiveMaterials
    uint givesHits;  // 1: no ray is traced for the first hits
    uint lightTreeNodes;   // nodes of the tree
    uint lightsApart;  // leaves after them
    // The members for packages with paths of several bounces:
    GLINT_ADDRESS(TargetArray) nextListed;  // the list of the next bounce
    GLINT_ADDRESS(PathArray) paths;         // of every sample, in the order of the samples
    uint bounce;      // of the hits that are being shaded, from 1; 0 on primary surfaces
    float bounceWeight;  // factor of what the rays bring that hits of this bounce send
    uint lastBounce;  // hits of this bounce send no further ray
    // The members for packages with emissive lights:
    GLINT_ADDRESS(EmitterArray) emitters;
    GLINT_ADDRESS(UintArray) firstEmitters;  // of every geometry: the emitter of its first triangle, or kNoEmitter
    GLINT_ADDRESS(LobeRayArray) lobeRays;    // of every sample, in the order of the samples
    uint emitterCount;
    uint accumulates;  // kPicture*
#if GLINT_SKY_LIGHT_MEMBERS
    // The members for packages whose sky is a light:
    GLINT_ADDRESS(SkyShareArray) skyShares;  // of every sample, in the order of the samples: the share of the sky's light
                                        // that its ray brings if it leaves the scene
    GLINT_ADDRESS(UintArray) skyCounts;      // the distribution of the environment map (runtime/src/sky/sky_counts.h)
    uint skyColumns;
    uint skyRows;
#endif
#if GLINT_LAYER_MEMBERS
    // The members for packages with layers (glint/layers.h). `previousInstances` are those of the previous frame here,
    // too.
    vec4 previousView[4];  // the camera of the frame before, rows: clip x and y without jitter, the distance along its
                           // axis, clip w
    GLINT_ADDRESS(PreviousVerticesArray) previousVertices;  // of every geometry, if hasPreviousVertices
    uint hasPreviousVertices;  // 1: some vertices follow joints or morph weights
    GLINT_ADDRESS(RayHitArray) rayHits;  // of every sample, in the order of the samples
    GLINT_ADDRESS(BounceLightArray) bounceLight;  // of every sample and bounce that has layers
#if GLINT_LAYER_WALKS
    // The members for packages that also find area lights:
    GLINT_ADDRESS(BounceLightArray) walkedLight;  // of every sample, in the order of the samples: what its walk has found,
                                             // as the viewer sees it
#endif
#endif
};

GLINT_INTEROP_END

#ifndef __cplusplus
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer FrameArray { FrameConstants data; };
#endif

GLINT_INTEROP_BEGIN

struct PushConstants {
    GLINT_ADDRESS(FrameArray) frame;
    uint bucket;    // shading passes: which bucket this dispatch shades
    uint geometry;  // G-buffer pass: GeometryRecord index of this draw's first instance
    uint geometryStride;  // and from one instance's GeometryRecord to the next one's
    uint shadowRound;  // passes over first hits: the round of shadow rays that are stored and traced
};

// Descriptor set 0: the scene.
GLINT_CONSTANT(kSetScene, 0u);
GLINT_CONSTANT(kBindingTlas, 0u);      // accelerationStructureEXT
GLINT_CONSTANT(kBindingTextures, 1u);  // texture2D[]
GLINT_CONSTANT(kBindingSamplers, 2u);  // sampler[]
// Descriptor set 1: the images of a frame, all storage images. Half pictures have rgba16f for rgba32f.
GLINT_CONSTANT(kSetFrame, 1u);
GLINT_CONSTANT(kBindingSurface, 0u);      // rg32ui: geometry, primitive; also a colour attachment
GLINT_CONSTANT(kBindingRadiance, 1u);     // rgba32f: light that leaves the primary surface, without effects that have
                                          // rays; distance along the camera's axis in units of lengthUnit, 0 for none
GLINT_CONSTANT(kBindingAccumulated, 2u);  // rgba32f: mean over the samples so far, linear. The same image as before if
                                          // frames do not accumulate
GLINT_CONSTANT(kBindingResidual, 3u);     // rgba32f: what rounding leaves out of that mean, if frames accumulate
GLINT_CONSTANT(kBindingPosition, 4u);     // rgba32f: ray origin off the surface; geometric normal, octahedral, bits
                                          // 2x16snorm. If frames may march in screen space
GLINT_CONSTANT(kFrameImageCount, 5u);
// The set also holds:
GLINT_CONSTANT(kBindingEnvironment, 5u);  // sampler2D: the environment map
GLINT_CONSTANT(kBindingLayers, 6u);       // the first of the package's layers, one image each

// The way in which the radiance of a sample was found.
GLINT_CONSTANT(kPathNone, 0u);    // no ray
GLINT_CONSTANT(kPathScreen, 1u);  // found in screen space
GLINT_CONSTANT(kPathHit, 2u);     // a ray that hit
GLINT_CONSTANT(kPathMiss, 3u);    // a ray that left the scene

GLINT_INTEROP_END
#endif
