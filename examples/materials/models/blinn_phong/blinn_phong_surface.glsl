// Reads the parameters of blinnPhong.
#include "hit/surface_values.glsl"
#include "materials/metallic_roughness/metallic_roughness.glsl"

void blinnPhongSurface(Hit hit, Features features, inout SurfaceValues values) {
    values.color = texturedBaseColor(hit, features);
}

void blinnPhongBsdf(Hit hit, Features features, inout SurfaceValues values, inout Surface surface) {
    GLINT_RELAXED vec3 specular = GLINT_MATERIAL_BLINN_PHONG_SPECULAR(hit);
    if (GLINT_HAS_BLINN_PHONG_SPECULAR_TEXTURE(features)) {
        specular *= sampleSlot(hit, kBlinnPhongSpecularTexture, features).rgb;
    }
    GLINT_RELAXED vec3 diffuse = values.color.rgb * (1.0 - largest(specular));
    float shininess = GLINT_MATERIAL_BLINN_PHONG_SHININESS(hit);
    surface.bsdf.layers.blinnPhong = BlinnPhong(diffuse, specular, shininess, 0.0);
    float cosine = clamp(dot(surface.normal, hit.view), 0.0, 1.0);
    surface.bsdf.diffuse = diffuse + specular * blinnPhongAlbedo(shininess, cosine);
}
