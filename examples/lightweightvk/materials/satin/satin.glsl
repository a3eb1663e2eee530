// The engine's material, for its own shaders and for Glint: Lambert's law below Phong's lobe ("Illumination for
// computer generated pictures", 1975), which reflects what Schlick's approximation of Fresnel's equations says.
struct Satin {
    vec3 color;
    vec3 mirror;  // reflectance seen straight on
    float gloss;  // exponent of the lobe
};

vec3 satinMirrored(Satin model, float viewCosine) {
    return model.mirror + (1.0 - model.mirror) * pow(1.0 - clamp(viewCosine, 0.0, 1.0), 5.0);
}

vec3 satinScattered(Satin model, vec3 mirrored) {
    return model.color * (1.0 - max(mirrored.x, max(mirrored.y, mirrored.z)));
}

void satinPrepare(inout Satin model, vec3 view) {}

vec3 satinEvaluate(Satin model, vec3 view, vec3 l) {
    vec3 mirrored = satinMirrored(model, view.z);
    float lobe = 0.5 * (model.gloss + 1.0) * pow(max(dot(vec3(-view.xy, view.z), l), 0.0), model.gloss);
    return (satinScattered(model, mirrored) * l.z + mirrored * lobe) * 0.318309886;
}
