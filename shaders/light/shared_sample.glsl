// A sample of a light that rays of lobes find, too.

struct SharedSample {
    vec3 direction;  // unit vector, towards the point
    vec3 radiance;   // that arrives along it if nothing is in the way
    float density;   // of the direction, by solid angle, for one sample of this light; 0 if no light arrives
    vec3 end;        // of the shadow ray, off an emissive triangle; the sky has none
};
