// Punctual lights. They are separate from the rest of a scene because they need no device addresses.
#ifndef GLINT_INTEROP_LIGHTS_H
#define GLINT_INTEROP_LIGHTS_H

#include "interop/types.h"

GLINT_INTEROP_BEGIN

// LightRecord::type, in the order of the text of KHR_lights_punctual; glTF has no disk
GLINT_CONSTANT(kLightDirectional, 0u);
GLINT_CONSTANT(kLightPoint, 1u);
GLINT_CONSTANT(kLightSpot, 2u);
GLINT_CONSTANT(kLightDisk, 3u);  // shines on one side, by Lambert's law

// Beside emissive triangles, up to as many point and spot lights are apart from the hierarchy: every surface takes them
// all, because samples that a few lights share with many triangles would only add noise.
GLINT_CONSTANT(kMostLightsApart, 16u);

// A punctual light in world space (KHR_lights_punctual).
struct LightRecord {
    vec3 position;   // of all but directional ones
    uint type;       // kLight*
    vec3 direction;  // unit vector along which the light travels; directional and spot; of a disk, its normal
    float range;     // metres; 0 means unlimited
    vec3 intensity;  // colour times intensity: lux (directional) or candela; of a disk, along its normal
    float spotScale;   // 1 / max(0.001, cos(inner) - cos(outer))
    float spotOffset;  // -cos(outer) * spotScale
    float size;  // radius, metres; directional: sine of half its angular diameter; 0 for hard shadows
};

// LightNode::next of a leaf: the number of its light is in the other bits.
GLINT_CONSTANT(kLightLeaf, 0x80000000u);

// With this bit, the number of a leaf's light is that of an emissive triangle, in packages with emissive lights.
GLINT_CONSTANT(kLightEmitter, 0x40000000u);
// No emissive triangle.
GLINT_CONSTANT(kNoEmitter, 0xFFFFFFFFu);
// The sky, in place of an emissive triangle.
GLINT_CONSTANT(kSkyEmitter, 0xFFFFFFFEu);

// The counts of the distribution of an environment map add up to this number, because random numbers have so many values.
GLINT_CONSTANT(kSkyCounts, 16777216u);

// A triangle that emits light. The triangles of a geometry follow each other. 12 bytes.
struct EmitterRecord {
    uint geometry;   // GeometryRecord index
    uint primitive;  // triangle within the geometry
    uint leaf;       // its node of the hierarchy; kNoEmitter if the triangle is dark
};

// The choice of a ray by an effect or a path, for the light of emissive triangles that it finds. 8 bytes.
struct LobeRay {
    float density;  // by solid angle; 0 if no sample of a light could have taken its place; negative if samples bring
                    // all of the light, behind glass that shadow rays pass
    uint normal;    // of the surface that sent it: LightReceiver::packed
};

// The most nodes on the way from the root of the hierarchy to a leaf, the root apart.
GLINT_CONSTANT(kLightTreeDepth, 32u);

// The largest value of a share in a node.
GLINT_CONSTANT(kLightShares, 1023u);

// A node of the hierarchy of lights: bounds of the lights below it, and the place within them from which the light
// comes. 64 bytes.
struct LightNode {
    vec3 lower;         // box of the positions
    float intensity;    // sum of the luminance, candela
    vec3 upper;
    float reach;        // the largest range, metres; infinite if a light has none; negative if some light shines on
                        // both sides
    vec3 axis;          // unit vector; the axes of all lights are within an angle of it
    float cosAxes;      // cosine of that angle
    float cosEmission;  // cosine of the most angle between the axis of a light and a direction in which it shines
    uint next;          // index of the second child, after which all its descendants come; the first child is the next
                        // node. Or kLightLeaf and a light
    // The mean of the positions and their standard deviation, weighted by intensity: shares of the box and of half of it,
    // 10 bits for each axis from the lowest on (kLightShares).
    uint mean3x10;
    uint deviation3x10;
};

GLINT_INTEROP_END
#endif
