// How bright the sky is where no environment map lights the scene: it follows the lights.
#pragma once

#include "cli/scene_view.h"
#include "gltf/scene.h"

#include <glint/renderer.h>
#include <glint/scene_view.h>

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace glint {

// A point of a surface in world space, with the unit normal of its triangle's front.
struct SurfacePoint {
    std::array<double, 3> position{};
    std::array<double, 3> normal{};
};

// Illuminance that a light brings to a surface if nothing shadows it, in lux: the luminance (Rec. 709) of its
// colour times the formulas of KHR_lights_punctual (inverse square law, window of the range, cone) times the
// cosine. Light within 1 mm counts as 1 mm away, as in shaders/hit/punctual.glsl.
double illuminanceAt(const LightView& light, const SurfacePoint& point);

// A piece of a surface on which illuminance hardly varies, but for the edges of cones.
struct LitPatch {
    double illuminance = 0.0;  // lux, of all lights together
    double area = 0.0;         // square metres
};

// The surfaces of all instances at the pose of `scene`, from which `view` was made, in at most some ten
// thousand patches: triangles, divided where a point or spot light is near, and of many small ones some that
// stand for all. Deterministic. Triangles that are not finite are left out.
std::vector<LitPatch> litPatches(const Scene& scene, const SceneViewData& view,
                                 std::span<const LightView> lights);

// What the lights bring to a surface that they light: the log-average by area (Reinhard et al. 2002,
// "Photographic Tone Reproduction for Digital Images", equation 1) over the brightest patches that together
// receive three quarters of all light. So neither a ground without end counts, which a lamp hardly reaches,
// nor a small shade around the lamp itself. Nothing where no light arrives.
std::optional<double> typicalIlluminance(std::vector<LitPatch> patches);

// Illuminance that a sky brings to a surface without shadows, the mean over all directions that the surface
// may face, in lux: π times the mean of the sky's luminance over the sphere.
double meanIlluminance(const SkyView& sky);

// The sky of a picture, and why it is so bright.
struct SkyChoice {
    double scale = 1.0;      // times the radiance of SkyView{}
    bool automatic = false;  // by the lights; otherwise as asked for
    // Lux, of the lights that the scale follows; nothing where there are none.
    std::optional<double> lights;

    SkyView sky() const;
};

// The sky that brings as much light as the scene's lights do: meanIlluminance() of the sky is their
// typicalIlluminance(). Scale 1 where there is none. The radiance stays between 1e-18 and 1e18 of the
// default.
SkyChoice skyForLights(std::vector<LitPatch> patches);

// One line for people.
std::string toText(const SkyChoice& choice);

}  // namespace glint
