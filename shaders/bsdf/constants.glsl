const float kPi = 3.14159265358979;
const float kInversePi = 0.318309886183791;
