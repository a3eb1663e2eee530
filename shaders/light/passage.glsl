// The part of a light's rays that has remained so far on their straight way to a surface.

// It does not depend on the order in which surfaces are met.
struct LightPassage {
    vec3 share;  // the product over the surfaces so far; where emissive lights pass glass, negative once it has passed
                 // glass
    vec3 depth;  // the optical depth of volumes: their absorption times the metres at which they end, less those at
                 // which they begin
    vec3 open;   // absorption of the volumes that were entered, less that of those that were left
};

LightPassage wholePassage() {
    return LightPassage(vec3(1.0), vec3(0.0), vec3(0.0));
}

// TracePayload::geometry of a ray to a light, on its way.
const uint kLightRay = 1u;
