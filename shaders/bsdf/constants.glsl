const float kPi = 3.14159265358979;
const float kInversePi = 0.318309886183791;
// Limits the NDF's peak, 1 / (π alpha²), to 3.2e7, so that products stay far within the range of single precision.
const float kMinAlpha = 1e-4;
// The smallest cosine between normal and view. If an interpolated normal turns away from the viewer, the view is lifted
// to it. It bounds the visibility terms; below it a single-precision unit vector has no digits left.
const float kMinViewCosine = 1e-7;
// A ray of this length leaves any scene, and its square is still finite in single precision.
const float kFarDistance = 1e18;
