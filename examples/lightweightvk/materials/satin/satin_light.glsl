// Phong, "Illumination for computer generated pictures" (1975), with a lobe that has no cosine and reflects its share
// in all, under Schlick's approximation of Fresnel's equations (1994). Directions are in the frame of the surface.
struct Satin {
    vec3 color;
    vec3 mirror;  // reflectance seen straight on
    float gloss;  // exponent of the lobe
};

vec3 satinMirrored(Satin model, float viewCosine) {
    return model.mirror + (1.0 - model.mirror) * pow(1.0 - clamp(viewCosine, 0.0, 1.0), 5.0);
}

// The light that Lambert's law gets is what the lobe leaves.
vec3 satinScattered(Satin model, vec3 mirrored) {
    return model.color * (1.0 - max(mirrored.x, max(mirrored.y, mirrored.z)));
}

// The BSDF times the cosine of l.
vec3 satinLight(Satin model, vec3 view, vec3 l) {
    vec3 mirrored = satinMirrored(model, view.z);
    float about = max(dot(vec3(-view.xy, view.z), l), 0.0);
    float lobe = 0.5 * (model.gloss + 1.0) * pow(about, model.gloss);
    return (satinScattered(model, mirrored) * l.z + mirrored * lobe) * 0.318309886;
}
