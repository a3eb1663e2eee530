const float kPi = 3.14159265358979;
const float kInversePi = 0.318309886183791;
// Bounds the NDF's peak, 1 / (π alpha²), to 3.2e7, far within the range of single precision products.
const float kMinAlpha = 1e-4;
// The least cosine between normal and view: where an interpolated normal turns from the viewer, the view is lifted
// to it. Bounds the visibility terms; below it a single-precision unit vector has no digits left.
const float kMinViewCosine = 1e-7;
