// Reads the parameters of hair.
#include "hit/surface_values.glsl"
#include "materials/metallic_roughness/metallic_roughness.glsl"

void hairSurface(Hit hit, Features features, inout SurfaceValues values) {
    values.color = texturedBaseColor(hit, features);
}

void hairBsdf(Hit hit, Features features, inout SurfaceValues values, inout Surface surface) {
    vec3 tangent;
    vec3 bitangent;
    tangentFrame(hit, kNormalTexture, features, tangent, bitangent);
    vec2 along = toSurface(surface, tangent).xy;
    along = dot(along, along) > 0.0 ? normalize(along) : vec2(1.0, 0.0);
    float b = GLINT_MATERIAL_HAIR_ROUGHNESS_AROUND(hit);
    // The absorption with which a head of hair has the colour: Chiang et al., equation 9.
    float scale = 5.969 + b * (-0.215 + b * (2.532 + b * (-10.73 + b * (5.574 + 0.245 * b))));
    vec3 root = log(clamp(values.color.rgb, vec3(1e-4), vec3(0.9999))) / scale;
    Hair hair;
    hair.toStrand = transpose(mat3(along, 0.0, -along.y, along.x, 0.0, 0.0, 0.0, 1.0));
    hair.absorption = root * root;
    hair.roughness = GLINT_MATERIAL_HAIR_ROUGHNESS(hit);
    hair.width = 0.62666 * (0.265 * b + 1.194 * b * b + 5.372 * pow(b, 22.0));  // the square root of pi / 8
    hair.tilt = GLINT_MATERIAL_HAIR_TILT(hit);
    hair.ior = GLINT_MATERIAL_HAIR_IOR(hit);
    vec3 local = toSurface(surface, hit.view);
    hairPrepare(hair, normalize(vec3(local.xy, max(local.z, 1e-3))));
    surface.bsdf.layers.hair = hair;
    surface.bsdf.diffuse = hair.shares[0] + hair.shares[2] + hair.shares[3];
    surface.bsdf.diffuseTransmitted = hair.shares[1];
}
