// The any-hit shader of rays: the alpha test of a candidate, or the random choice of one that is blended. A ray to a
// light may keep a share of its light. The file that includes this one says first which ray goes to a light,
// goesToLight(), and whether its light ends at a candidate, lightEndsHere().
void main() {
    uint candidate = geometryOfHit(gl_InstanceID, gl_InstanceCustomIndexEXT, gl_GeometryIndexEXT);
#if GLINT_SHADOW_GLASS || GLINT_SHADOW_OPAQUE
    bool stops = goesToLight() ? lightEndsHere(candidate)
                               : passesAlphaTest(gl_WorldRayOriginEXT, gl_WorldRayDirectionEXT, candidate,
                                                 uint(gl_PrimitiveID), hitBarycentrics);
#else
    bool stops = passesAlphaTest(gl_WorldRayOriginEXT, gl_WorldRayDirectionEXT, candidate, uint(gl_PrimitiveID),
                                 hitBarycentrics);
#endif
    if (!stops) {
        ignoreIntersectionEXT;
    }
}
