#include "emit/package/interop_layouts.h"

#include <cstddef>
#include <interop/deform.h>
#include <interop/frame.h>
#include <interop/scene.h>

// A row of a table of members. If a member is missing here, the test against SPIR-V finds it.
#define GLINT_MEMBER(type, name) \
    { #name, static_cast < std::uint32_t>(offsetof(gpu::type, name)) }
#define GLINT_STRUCT(type) \
    { #type, static_cast < std::uint32_t>(sizeof(gpu::type)), k##type }

namespace glint::compiler {

namespace {

constexpr MemberLayout kGeometryRecord[] = {
    GLINT_MEMBER(GeometryRecord, shaderId),      GLINT_MEMBER(GeometryRecord, materialIndex),
    GLINT_MEMBER(GeometryRecord, featureLobes),  GLINT_MEMBER(GeometryRecord, featureInputs),
    GLINT_MEMBER(GeometryRecord, instanceIndex), GLINT_MEMBER(GeometryRecord, flags),
    GLINT_MEMBER(GeometryRecord, indices),       GLINT_MEMBER(GeometryRecord, positions),
    GLINT_MEMBER(GeometryRecord, normals),       GLINT_MEMBER(GeometryRecord, tangents),
    GLINT_MEMBER(GeometryRecord, texCoords0),    GLINT_MEMBER(GeometryRecord, texCoords1),
    GLINT_MEMBER(GeometryRecord, colors),        GLINT_MEMBER(GeometryRecord, attributes),
};

constexpr MemberLayout kInstanceRecord[] = {
    GLINT_MEMBER(InstanceRecord, objectToWorld),
    GLINT_MEMBER(InstanceRecord, normalToWorld),
    GLINT_MEMBER(InstanceRecord, flags),
};

constexpr MemberLayout kTextureRecord[] = {
    GLINT_MEMBER(TextureRecord, textureIndex), GLINT_MEMBER(TextureRecord, samplerIndex),
    GLINT_MEMBER(TextureRecord, texCoord),     GLINT_MEMBER(TextureRecord, rowU),
    GLINT_MEMBER(TextureRecord, rowV),         GLINT_MEMBER(TextureRecord, texels),
    GLINT_MEMBER(TextureRecord, anisotropy),
};

constexpr MemberLayout kLightRecord[] = {
    GLINT_MEMBER(LightRecord, position),   GLINT_MEMBER(LightRecord, type),
    GLINT_MEMBER(LightRecord, direction),  GLINT_MEMBER(LightRecord, range),
    GLINT_MEMBER(LightRecord, intensity),  GLINT_MEMBER(LightRecord, spotScale),
    GLINT_MEMBER(LightRecord, spotOffset), GLINT_MEMBER(LightRecord, size),
};

constexpr MemberLayout kEffectSample[] = {
    GLINT_MEMBER(EffectSample, origin),    GLINT_MEMBER(EffectSample, outcome),
    GLINT_MEMBER(EffectSample, direction), GLINT_MEMBER(EffectSample, coneWidth),
    GLINT_MEMBER(EffectSample, weight),    GLINT_MEMBER(EffectSample, coneSpread),
};

constexpr MemberLayout kRayRecord[] = {
    GLINT_MEMBER(RayRecord, origin),     GLINT_MEMBER(RayRecord, target),
    GLINT_MEMBER(RayRecord, direction),  GLINT_MEMBER(RayRecord, coneWidth),
    GLINT_MEMBER(RayRecord, coneSpread),
};

constexpr MemberLayout kPathState[] = {
    GLINT_MEMBER(PathState, origin),     GLINT_MEMBER(PathState, medium),
    GLINT_MEMBER(PathState, direction),  GLINT_MEMBER(PathState, density),
    GLINT_MEMBER(PathState, throughput), GLINT_MEMBER(PathState, coneWidth),
    GLINT_MEMBER(PathState, coneSpread), GLINT_MEMBER(PathState, goesOn),
};

constexpr MemberLayout kHitRecord[] = {
    GLINT_MEMBER(HitRecord, target),
    GLINT_MEMBER(HitRecord, geometry),
    GLINT_MEMBER(HitRecord, primitive),
    GLINT_MEMBER(HitRecord, barycentricU_orDirectionX),
    GLINT_MEMBER(HitRecord, barycentricV_orDirectionY),
    GLINT_MEMBER(HitRecord, distance_orDirectionZ),
    GLINT_MEMBER(HitRecord, coneWidth),
    GLINT_MEMBER(HitRecord, ray),
};

constexpr MemberLayout kPackedHitRecord[] = {
    GLINT_MEMBER(PackedHitRecord, target),
    GLINT_MEMBER(PackedHitRecord, geometry24_coneLog8),
    GLINT_MEMBER(PackedHitRecord, primitive_orDirectionOctX),
    GLINT_MEMBER(PackedHitRecord, barycentrics2x16_orDirectionOctY),
};

constexpr MemberLayout kShadowRecord[] = {
    GLINT_MEMBER(ShadowRecord, origin),    GLINT_MEMBER(ShadowRecord, target),
    GLINT_MEMBER(ShadowRecord, direction), GLINT_MEMBER(ShadowRecord, distance),
    GLINT_MEMBER(ShadowRecord, light),     GLINT_MEMBER(ShadowRecord, sees),
};

constexpr MemberLayout kDispatchArguments[] = {
    GLINT_MEMBER(DispatchArguments, x),          GLINT_MEMBER(DispatchArguments, y),
    GLINT_MEMBER(DispatchArguments, z),          GLINT_MEMBER(DispatchArguments, elementCount),
    GLINT_MEMBER(DispatchArguments, traceWidth), GLINT_MEMBER(DispatchArguments, traceHeight),
    GLINT_MEMBER(DispatchArguments, traceDepth), GLINT_MEMBER(DispatchArguments, pad),
};

constexpr MemberLayout kFrameConstants[] = {
    GLINT_MEMBER(FrameConstants, worldToClip),
    GLINT_MEMBER(FrameConstants, cameraPosition),
    GLINT_MEMBER(FrameConstants, width),
    GLINT_MEMBER(FrameConstants, cameraForward),
    GLINT_MEMBER(FrameConstants, height),
    GLINT_MEMBER(FrameConstants, cameraRight),
    GLINT_MEMBER(FrameConstants, orthographic),
    GLINT_MEMBER(FrameConstants, cameraUp),
    GLINT_MEMBER(FrameConstants, pixelSpread),
    GLINT_MEMBER(FrameConstants, jitter),
    GLINT_MEMBER(FrameConstants, pixelWidth),
    GLINT_MEMBER(FrameConstants, sampleLodBias),
    GLINT_MEMBER(FrameConstants, sampleIndex),
    GLINT_MEMBER(FrameConstants, seed),
    GLINT_MEMBER(FrameConstants, time),
    GLINT_MEMBER(FrameConstants, effects),
    GLINT_MEMBER(FrameConstants, countsLight),
    GLINT_MEMBER(FrameConstants, lightCount),
    GLINT_MEMBER(FrameConstants, shadowSamples),
    GLINT_MEMBER(FrameConstants, occlusionSamples),
    GLINT_MEMBER(FrameConstants, occlusionRadius),
    GLINT_MEMBER(FrameConstants, occlusionFalloff),
    GLINT_MEMBER(FrameConstants, maxInterfaces),
    GLINT_MEMBER(FrameConstants, bucketCount),
    GLINT_MEMBER(FrameConstants, bucketAlignment),
    GLINT_MEMBER(FrameConstants, mirrorRoughness),
    GLINT_MEMBER(FrameConstants, maxReflectionRoughness),
    GLINT_MEMBER(FrameConstants, faintWeight),
    GLINT_MEMBER(FrameConstants, maxSampleRadiance),
    GLINT_MEMBER(FrameConstants, binning),
    GLINT_MEMBER(FrameConstants, screenSteps),
    GLINT_MEMBER(FrameConstants, screenThickness),
    GLINT_MEMBER(FrameConstants, skyZenith),
    GLINT_MEMBER(FrameConstants, skyHorizon),
    GLINT_MEMBER(FrameConstants, skyGround),
    GLINT_MEMBER(FrameConstants, skyHarmonics),
    GLINT_MEMBER(FrameConstants, environmentLevels),
    GLINT_MEMBER(FrameConstants, environmentTurn),
    GLINT_MEMBER(FrameConstants, environmentScale),
    GLINT_MEMBER(FrameConstants, geometries),
    GLINT_MEMBER(FrameConstants, instances),
    GLINT_MEMBER(FrameConstants, materials),
    GLINT_MEMBER(FrameConstants, lights),
    GLINT_MEMBER(FrameConstants, lightNodes),
    GLINT_MEMBER(FrameConstants, samples),
    GLINT_MEMBER(FrameConstants, radiance),
    GLINT_MEMBER(FrameConstants, rays),
    GLINT_MEMBER(FrameConstants, hits),
    GLINT_MEMBER(FrameConstants, packedHits),
    GLINT_MEMBER(FrameConstants, orderedHits),
    GLINT_MEMBER(FrameConstants, bucketKeys),
    GLINT_MEMBER(FrameConstants, bucketCounts),
    GLINT_MEMBER(FrameConstants, bucketBegins),
    GLINT_MEMBER(FrameConstants, bucketCursors),
    GLINT_MEMBER(FrameConstants, visitedHits),
    GLINT_MEMBER(FrameConstants, rayDispatch),
    GLINT_MEMBER(FrameConstants, bucketDispatch),
    GLINT_MEMBER(FrameConstants, shadows),
    GLINT_MEMBER(FrameConstants, shadowDispatch),
    GLINT_MEMBER(FrameConstants, counters),
    GLINT_MEMBER(FrameConstants, surfaces),
    GLINT_MEMBER(FrameConstants, previousInstances),
    GLINT_MEMBER(FrameConstants, firstRecords),
    GLINT_MEMBER(FrameConstants, recordsBy),
    GLINT_MEMBER(FrameConstants, rayMask),
    GLINT_MEMBER(FrameConstants, tlasAddress),
    GLINT_MEMBER(FrameConstants, lightTreeNodes),
    GLINT_MEMBER(FrameConstants, unboundedLights),
    GLINT_MEMBER(FrameConstants, nextRays),
    GLINT_MEMBER(FrameConstants, paths),
    GLINT_MEMBER(FrameConstants, bounce),
    GLINT_MEMBER(FrameConstants, bounceWeight),
    GLINT_MEMBER(FrameConstants, lastBounce),
    GLINT_MEMBER(FrameConstants, emitters),
    GLINT_MEMBER(FrameConstants, firstEmitters),
    GLINT_MEMBER(FrameConstants, lobeRays),
    GLINT_MEMBER(FrameConstants, emitterCount),
};

constexpr MemberLayout kLightNode[] = {
    GLINT_MEMBER(LightNode, lower),       GLINT_MEMBER(LightNode, intensity),
    GLINT_MEMBER(LightNode, upper),       GLINT_MEMBER(LightNode, reach),
    GLINT_MEMBER(LightNode, axis),        GLINT_MEMBER(LightNode, cosAxes),
    GLINT_MEMBER(LightNode, cosEmission), GLINT_MEMBER(LightNode, next),
};

constexpr MemberLayout kEmitterRecord[] = {
    GLINT_MEMBER(EmitterRecord, geometry),
    GLINT_MEMBER(EmitterRecord, primitive),
    GLINT_MEMBER(EmitterRecord, leaf),
};

constexpr MemberLayout kLobeRay[] = {
    GLINT_MEMBER(LobeRay, density),
    GLINT_MEMBER(LobeRay, normal),
};

constexpr MemberLayout kPushConstants[] = {
    GLINT_MEMBER(PushConstants, frame),          GLINT_MEMBER(PushConstants, tlasIndex),
    GLINT_MEMBER(PushConstants, bucket),         GLINT_MEMBER(PushConstants, geometry),
    GLINT_MEMBER(PushConstants, geometryStride),
};

constexpr StructLayout kStructs[] = {
    GLINT_STRUCT(GeometryRecord),  GLINT_STRUCT(InstanceRecord), GLINT_STRUCT(TextureRecord),
    GLINT_STRUCT(LightNode),       GLINT_STRUCT(LightRecord),    GLINT_STRUCT(EffectSample),
    GLINT_STRUCT(RayRecord),       GLINT_STRUCT(PathState),      GLINT_STRUCT(HitRecord),
    GLINT_STRUCT(PackedHitRecord), GLINT_STRUCT(ShadowRecord),   GLINT_STRUCT(DispatchArguments),
    GLINT_STRUCT(FrameConstants),  GLINT_STRUCT(PushConstants),  GLINT_STRUCT(EmitterRecord),
    GLINT_STRUCT(LobeRay),
};

constexpr MemberLayout kDeformRecord[] = {
    GLINT_MEMBER(DeformRecord, vertexCount),       GLINT_MEMBER(DeformRecord, targetCount),
    GLINT_MEMBER(DeformRecord, influenceCount),    GLINT_MEMBER(DeformRecord, flags),
    GLINT_MEMBER(DeformRecord, positions),         GLINT_MEMBER(DeformRecord, normals),
    GLINT_MEMBER(DeformRecord, tangents),          GLINT_MEMBER(DeformRecord, targetPositions),
    GLINT_MEMBER(DeformRecord, targetNormals),     GLINT_MEMBER(DeformRecord, targetTangents),
    GLINT_MEMBER(DeformRecord, targetWeights),     GLINT_MEMBER(DeformRecord, joints),
    GLINT_MEMBER(DeformRecord, jointWeights),      GLINT_MEMBER(DeformRecord, jointRows),
    GLINT_MEMBER(DeformRecord, deformedPositions), GLINT_MEMBER(DeformRecord, deformedNormals),
    GLINT_MEMBER(DeformRecord, deformedTangents),
};

constexpr MemberLayout kDeformConstants[] = {
    GLINT_MEMBER(DeformConstants, records),
    GLINT_MEMBER(DeformConstants, record),
    GLINT_MEMBER(DeformConstants, pad),
};

constexpr StructLayout kDeformStructs[] = {
    GLINT_STRUCT(DeformRecord),
    GLINT_STRUCT(DeformConstants),
};

}  // namespace

std::span<const StructLayout> interopLayouts() {
    return kStructs;
}

std::span<const StructLayout> deformLayouts() {
    return kDeformStructs;
}

}  // namespace glint::compiler
