// A surface that chooses lights.
#include "bsdf/features.glsl"
#include "hit/hit.glsl"
#include "light/tree.glsl"

// The normal of LightReceiver in 32 bits. Surfaces that let light through take lights of both sides.
uint receiverNormal(Hit hit, Features features) {
    return transmits(features) ? kBothSides : packReceiver(hit.geometricNormal);
}

LightReceiver receiverOf(Hit hit, Features features) {
    return LightReceiver(hit.position, unpackReceiver(receiverNormal(hit, features)));
}
