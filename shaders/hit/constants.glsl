// A ray of this length leaves any scene, and its square is still finite in single precision.
const float kFarDistance = 1e18;
