// A ray answered with the surface that it hits, for a host that lights it.
#include "hit/bindings.glsl"

struct ShadeResult {
    SurfaceRecord surface;
};

void storeSurface(uint target, SurfaceRecord surface) {
    GLINT_FRAME.surfaces.data[target] = surface;
}

SurfaceRecord noSurface(uint shaderId) {
    SurfaceRecord surface;
    surface.position = vec3(0.0);
    surface.shaderId = shaderId;
    surface.normal = vec3(0.0);
    surface.roughness = 0.0;
    surface.geometricNormal = vec3(0.0);
    surface.clearance = 0.0;
    surface.albedo = vec3(0.0);
    surface.occlusion = 0.0;
    surface.f0 = vec3(0.0);
    surface.f90 = 0.0;
    surface.emission = vec3(0.0);
    surface.transmission = 0.0;
    surface.motion = vec3(0.0);
    surface.material = 0u;
    return surface;
}

// The surface of a hit with an unknown shader ID. It occurs only if scene and package disagree.
ShadeResult shadeUnknown() {
    ShadeResult result = ShadeResult(noSurface(kSurfaceUnknown));
    result.surface.emission = vec3(1.0, 0.0, 1.0);
    return result;
}

void resolveMiss(uint target, vec3 direction) {
    SurfaceRecord miss = noSurface(kSurfaceMiss);
    miss.position = direction;
    storeSurface(target, miss);
}

void resolveUnknown(uint target) {
    storeSurface(target, shadeUnknown().surface);
}
