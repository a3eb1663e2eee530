// How much of the sky's light on a surface its effects leave: what an effect traces, the sky no longer brings.
struct SkyShares {
    float mirrored;     // of what the base reflects at the first bounce
    float coated;       // of what the coat reflects
    float transmitted;  // of what passes the microfacets
    float diffuse;      // of what diffuse lobes scatter, on either side
    float open;         // of all that comes from outside: what nothing occludes
};

SkyShares wholeSky() {
    return SkyShares(1.0, 1.0, 1.0, 1.0, 1.0);
}
