// Vectors among the inputs of claims.
#define WRITE3(k, v) \
    o[k] = (v).x;    \
    o[(k) + 1] = (v).y; \
    o[(k) + 2] = (v).z

// A vector whose length is 1 but for an error, from its cosine to z and its azimuth.
vec3 directionAt(float cosine, float azimuth, float lengthError) {
    float sine = sqrt(max((1.0 - cosine) * (1.0 + cosine), 0.0));
    return vec3(sine * cos(azimuth), sine * sin(azimuth), cosine) * (1.0 + lengthError);
}

#define UNIT(k) directionAt(i[k], i[(k) + 1], i[(k) + 2])
