// A path tracer in double precision: any number of bounces, one sampling decision over the lobes of each
// surface, light chosen and found with multiple importance sampling (Veach and Guibas 1995, power heuristic),
// alpha, glass and media. It shares the BSDF's text with the shaders, and nothing of their transport.
#pragma once

#include "oracle/light.h"
#include "oracle/scene/geometry.h"
#include "oracle/transport/media.h"
#include "oracle/transport/path_lights.h"
#include "oracle/transport/path_surface.h"

#include <cstdint>
#include <limits>
#include <vector>

namespace glint::oracle {

// What rays to lights pass. Whatever does not pass on a straight line may still arrive along a path.
enum class ShadowThrough : std::uint8_t {
    Opaque,  // nothing but masked holes
    Alpha,   // BLEND, in proportion to 1 - alpha
    Glass    // that, and KHR_materials_transmission: tint, 1 - Fresnel and absorption on the straight line.
           // Light that a path finds through glass behind another surface is then left out, as it is already
           // counted.
};

inline constexpr std::uint32_t kUnlimited = std::numeric_limits<std::uint32_t>::max();

struct PathSettings {
    // Light is scattered by at most this many surfaces and one more. What happens between the surfaces of
    // clear glass, passing and total reflection included, is not counted.
    std::uint32_t bounces = kUnlimited;
    ShadowThrough shadowThrough = ShadowThrough::Alpha;
    // From this number of scatterings on, a path goes on with the probability of its largest throughput, at
    // least 0.05 and at most 0.95; kUnlimited never ends a path so, and follows it down to a throughput of
    // 1e-9.
    std::uint32_t rouletteFrom = 4;
    // Directions below a surface are reflected once more: PathSurface::sample().
    bool reflectsBelow = false;
    LightSizes sizes{};
    SrgbTable srgb = exactSrgb();
};

// What the path of a camera's ray met, for explanations.
struct PathNotes {
    int material = -1;  // of the first surface
    bool glass = false;
    bool blended = false;
};

class PathTracer {
public:
    // The scene must outlive the object.
    PathTracer(const gltf::Scene& scene, PathSky sky, const PathSettings& settings);

    // Returns one sample of the light along a ray. Several threads may call this.
    Vec3 radiance(const Ray& ray, Random& random, PathNotes* notes = nullptr) const;
    const gltf::Scene& scene() const {
        return textures_.scene();
    }

private:
    struct Walk;
    struct Vertex;
    std::optional<SurfacePoint> next(Walk& walk, Random& random, PathNotes* notes) const;
    Vec3 emitted(const Walk& walk, const SurfacePoint& point, const PathSurface& surface) const;
    Vec3 skyAlong(const Walk& walk) const;
    // The light of all lights at a vertex, chosen.
    Vec3 chosenLight(const Vertex& vertex, Random& random) const;
    Vec3 lampLight(const Vertex& vertex, const gltf::Light& light, Random& random) const;
    Vec3 triangleLight(const Vertex& vertex, Random& random) const;
    Vec3 skyLight(const Vertex& vertex, Random& random) const;
    // The light of lamps that have a size, in a direction that the surface has chosen.
    Vec3 lampsFound(const Vertex& vertex, const PathSample& sample) const;
    // What arrives over a distance, on a straight line from a vertex.
    struct Arrival {
        Vec3 share{0.0};
        bool throughGlass = false;
    };
    Arrival arriving(const Vertex& vertex, const Vec3& direction, double distance, Backs backs) const;
    double alphaAt(const SurfacePoint& point) const;
    LightCap capOf(const gltf::Light& light, const Vec3& position) const;

    Textures textures_;
    PathSky sky_;
    PathSettings settings_;
    SceneGeometry geometry_;
    EmissiveTriangles emissive_;
    std::vector<Medium> media_;              // by material
    std::vector<const gltf::Light*> lamps_;  // those that shine
};

}  // namespace glint::oracle
