// Skies: environment maps from files, and the brightness of the sky in a scene without one, which follows the
// lights.
#pragma once

#include "gltf/scene.h"

#include <glint/context.h>
#include <glint/environment.h>
#include <glint/renderer.h>
#include <glint/result.h>
#include <glint/scene_view.h>
#include <glint/session/scene_view.h>

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace glint::session {

// A point of a surface in world space, with the unit normal of its triangle's front.
struct SurfacePoint {
    std::array<double, 3> position{};
    std::array<double, 3> normal{};
};

// Returns the illuminance that a light gives a surface without shadows, in lux. It is the luminance (Rec.
// 709) of the light's colour, times the formulas of KHR_lights_punctual (inverse square law, window of the
// range, cone), times the cosine. A light that is nearer than 1 mm counts as 1 mm away, as in
// shaders/light/punctual.glsl.
double illuminanceAt(const LightView& light, const SurfacePoint& point);

// A piece of a surface on which the illuminance hardly varies, except at the edges of cones.
struct LitPatch {
    double illuminance = 0.0;  // lux, from all lights together
    double area = 0.0;         // square metres
};

// Returns the surfaces of all instances as at most some ten thousand patches, at the pose of `scene` from
// which `view` was made. A patch is a triangle, or a part of one if a point or spot light is near. If there
// are many small triangles, some of them stand for all. The result is deterministic. Triangles that are not
// finite are left out.
std::vector<LitPatch> litPatches(const gltf::Scene& scene, const SceneViewData& view,
                                 std::span<const LightView> lights);

// Returns the illuminance of a typical lit surface. It is the log-average by area (Reinhard et al. 2002,
// "Photographic Tone Reproduction for Digital Images", equation 1) over the brightest patches that together
// receive three quarters of all light. So an endless ground that a lamp hardly reaches does not count, nor
// does a small shade around the lamp itself. Returns nothing if no light arrives.
std::optional<double> typicalIlluminance(std::vector<LitPatch> patches);

// Returns the illuminance that a sky gives a surface without shadows, in lux, as the mean over all directions
// that the surface may face. It is π times the mean of the sky's luminance over the sphere.
double meanIlluminance(const SkyView& sky);

// The sky of a picture, and the reason for its brightness.
struct SkyChoice {
    double scale = 1.0;      // factor for the radiance of SkyView{}
    bool automatic = false;  // chosen by the lights; otherwise by the user
    // The illuminance in lux that the scale follows. It is empty if there are no lights.
    std::optional<double> lights;

    SkyView sky() const;
};

// Returns the sky that gives as much light as the scene's lights: its meanIlluminance() equals their
// typicalIlluminance(). The scale is 1 if no light arrives. The radiance stays between 1e-18 and 1e18 times
// the default.
SkyChoice skyForLights(std::vector<LitPatch> patches);

// Reads an equirectangular .hdr or .exr file (radiance, linear Rec. 709) and makes the map, which the caller
// owns and which must not outlive `context`. Appends warnings about the file and notes about how it is used.
// Errors: of the file
// ("file-open", "image-format", …) and of Environment::create(), with the file as their place.
Result<std::unique_ptr<Environment>> loadEnvironment(Context& context, const std::string& file,
                                                     const Environment::Options& options,
                                                     std::vector<Diagnostic>& notes);

}  // namespace glint::session
