#include "base/lists.h"
#include "base/vectors.h"
#include "image/image_file.h"
#include "image/tone.h"
#include "session/pose.h"

#include <glint/session/sky.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

namespace glint::session {

namespace {

using Corners = std::array<glm::dvec3, 3>;

// Returns whether the transform mirrors, which swaps the sides of a triangle.
bool mirrors(const std::array<float, 12>& rows) {
    const glm::dvec3 x{rows[0], rows[1], rows[2]};
    const glm::dvec3 y{rows[4], rows[5], rows[6]};
    const glm::dvec3 z{rows[8], rows[9], rows[10]};
    return glm::dot(glm::cross(x, y), z) < 0.0;
}

// Returns a vector along the normal of the triangle's front; its length is twice the area.
glm::dvec3 areaVector(const Corners& corners) {
    return glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
}

// Calls `visit` for each triangle of all visible instances that has an area, in a fixed order. The corners
// are counter-clockwise as seen from the front.
void visitTriangles(const gltf::Scene& scene, const SceneViewData& view,
                    const std::function<void(const Corners&, double area)>& visit) {
    for (std::size_t i = 0; i < view.instances.size(); ++i) {
        const InstanceView& instance = view.instances[i];
        if (!instance.visible) {
            continue;
        }
        const bool mirrored = mirrors(instance.objectToWorld);
        for (const gltf::Primitive& primitive : scene.meshes[instance.mesh].primitives) {
            const std::vector<glm::dvec3> positions = placedPositions(scene, view, i, primitive);
            for (std::size_t first = 0; first + 2 < primitive.indices.size(); first += 3) {
                Corners corners{positions[primitive.indices[first]], positions[primitive.indices[first + 1]],
                                positions[primitive.indices[first + 2]]};
                if (mirrored) {
                    std::swap(corners[1], corners[2]);
                }
                const glm::dvec3 twice = areaVector(corners);
                const double area = 0.5 * glm::length(twice);
                if (std::isfinite(area) && area > 0.0) {
                    visit(corners, area);
                }
            }
        }
    }
}

// Returns the middle of a triangle.
SurfacePoint centreOf(const Corners& corners) {
    SurfacePoint point;
    point.position = base::toArray((corners[0] + corners[1] + corners[2]) / 3.0);
    point.normal = base::toArray(glm::normalize(areaVector(corners)));
    return point;
}

// Returns whether a light is so near that its illuminance varies over the triangle.
bool varies(const Corners& corners, const glm::dvec3& centre, std::span<const LightView> lights) {
    double radius = 0.0;
    for (const glm::dvec3& corner : corners) {
        radius = std::max(radius, glm::distance(corner, centre));
    }
    return std::ranges::any_of(lights, [&](const LightView& light) {
        return light.type != LightView::Type::Directional &&
               glm::distance(base::toVector(light.position), centre) < 4.0 * radius;
    });
}

// Divides a triangle of this area into patches.
void addPatches(const Corners& corners, double area, std::span<const LightView> lights, int divisions,
                std::vector<LitPatch>& patches) {
    const SurfacePoint centre = centreOf(corners);
    // This bounds the evaluations of lights if there are many lights.
    constexpr std::size_t kMostEvaluations = 1U << 20U;
    if (divisions > 0 && patches.size() * lights.size() < kMostEvaluations &&
        varies(corners, base::toVector(centre.position), lights)) {
        const glm::dvec3 ab = 0.5 * (corners[0] + corners[1]);
        const glm::dvec3 bc = 0.5 * (corners[1] + corners[2]);
        const glm::dvec3 ca = 0.5 * (corners[2] + corners[0]);
        for (const Corners& quarter : {Corners{corners[0], ab, ca}, Corners{ab, corners[1], bc},
                                       Corners{ca, bc, corners[2]}, Corners{ab, bc, ca}}) {
            addPatches(quarter, 0.25 * area, lights, divisions - 1, patches);
        }
        return;
    }
    LitPatch patch{0.0, area};
    for (const LightView& light : lights) {
        patch.illuminance += illuminanceAt(light, centre);
    }
    patches.push_back(patch);
}

double luminanceOf(const std::array<float, 3>& color) {
    return image::luminance({color[0], color[1], color[2]});
}

}  // namespace

std::vector<LitPatch> litPatches(const gltf::Scene& scene, const SceneViewData& view,
                                 std::span<const LightView> lights) {
    constexpr double kParts = 8192.0;
    constexpr int kDivisions = 20;  // enough to divide a plane of a hundred kilometres into tenths of a metre
    double whole = 0.0;
    visitTriangles(scene, view, [&](const Corners&, double area) { whole += area; });
    std::vector<LitPatch> patches;
    if (!std::isfinite(whole) || whole <= 0.0) {
        return patches;
    }
    const double part = whole / kParts;
    double small = 0.0;  // area of small triangles for which no patch stands yet
    visitTriangles(scene, view, [&](const Corners& corners, double area) {
        if (area >= part) {
            addPatches(corners, area, lights, kDivisions, patches);
            return;
        }
        // This is systematic sampling: one triangle is chosen for each part of the small triangles' total
        // area.
        small += area;
        if (small > 0.5 * part) {
            addPatches(corners, part, lights, 0, patches);
            small -= part;
        }
    });
    return patches;
}

double illuminanceAt(const LightView& light, const SurfacePoint& point) {
    const double intensity = luminanceOf(light.intensity);
    const glm::dvec3 way = base::toVector(light.direction);
    const glm::dvec3 normal = base::toVector(point.normal);
    if (light.type == LightView::Type::Directional) {
        return intensity * std::max(-glm::dot(way, normal), 0.0);
    }
    constexpr double kLeastSquaredDistance = 1e-20;  // as in shaders/light/punctual.glsl
    const glm::dvec3 toLight = base::toVector(light.position) - base::toVector(point.position);
    const double squared = glm::dot(toLight, toLight);
    if (!(squared > 0.0)) {
        return 0.0;
    }
    const double distance = std::sqrt(squared);
    const glm::dvec3 direction = toLight * (1.0 / distance);
    double share = std::max(glm::dot(direction, normal), 0.0) / std::max(squared, kLeastSquaredDistance);
    if (light.range > 0.0F) {
        const double ratio = distance / light.range;
        share *= std::clamp(1.0 - ratio * ratio * ratio * ratio, 0.0, 1.0);
    }
    if (light.type == LightView::Type::Spot) {
        const double outer = std::cos(light.outerConeAngle);
        const double width = std::max(0.001, std::cos(light.innerConeAngle) - outer);
        const double cone = std::clamp((-glm::dot(way, direction) - outer) / width, 0.0, 1.0);
        share *= cone * cone;
    } else if (light.type == LightView::Type::Disk) {
        share *= std::max(-glm::dot(way, direction), 0.0);
    }
    return intensity * share;
}

std::optional<double> typicalIlluminance(std::vector<LitPatch> patches) {
    constexpr double kShare = 0.75;
    std::erase_if(patches, [](const LitPatch& patch) {
        return !std::isfinite(patch.illuminance) || patch.illuminance <= 0.0;
    });
    std::ranges::sort(patches, std::greater(), &LitPatch::illuminance);
    const auto flux =
        base::sumOf<double>(patches, [](const LitPatch& patch) { return patch.illuminance * patch.area; });
    double received = 0.0;
    double area = 0.0;
    double sum = 0.0;
    for (const LitPatch& patch : patches) {
        if (received >= kShare * flux) {
            break;
        }
        received += patch.illuminance * patch.area;
        area += patch.area;
        sum += patch.area * std::log(patch.illuminance);
    }
    return area > 0.0 ? std::optional(std::exp(sum / area)) : std::nullopt;
}

double meanIlluminance(const SkyView& sky) {
    // The gradient is linear in the height, and the area of the sphere is uniform over the height.
    return std::numbers::pi * 0.25 *
           (2.0 * luminanceOf(sky.horizon) + luminanceOf(sky.zenith) + luminanceOf(sky.ground));
}

SkyView SkyChoice::sky() const {
    SkyView result;
    for (std::array<float, 3>* const radiance : {&result.zenith, &result.horizon, &result.ground}) {
        for (float& channel : *radiance) {
            channel = static_cast<float>(channel * scale);
        }
    }
    return result;
}

SkyChoice skyForLights(std::vector<LitPatch> patches) {
    constexpr double kMost = 1e18;  // the same limit as for an environment map
    SkyChoice choice;
    choice.automatic = true;
    choice.lights = typicalIlluminance(std::move(patches));
    if (choice.lights) {
        choice.scale = std::clamp(*choice.lights / meanIlluminance(SkyView{}), 1.0 / kMost, kMost);
    }
    return choice;
}

// --- Environment maps ---
namespace {

// Returns warnings about the file, and notes about how it is used.
std::vector<Diagnostic> describe(const std::string& file, const LinearImage& image,
                                 const Environment::Statistics& statistics) {
    std::vector<Diagnostic> notes;
    if (image.width != 2 * image.height) {
        notes.push_back(makeWarning("environment-aspect", file,
                                    fmt::format("is {} x {}: an equirectangular map is twice as wide as high",
                                                image.width, image.height),
                                    "check that it shows the whole sphere"));
    }
    if (statistics.negativePixels > 0) {
        notes.push_back(makeWarning(
            "environment-negative", file,
            fmt::format("{} pixels have negative radiance, which is taken as 0", statistics.negativePixels),
            "check the program that made it"));
    }
    if (statistics.width != image.width || statistics.height != image.height) {
        notes.push_back({Severity::Note, "environment-resampled", file,
                         fmt::format("is {} x {}, and resampled to {} x {}", image.width, image.height,
                                     statistics.width, statistics.height),
                         ""});
    }
    return notes;
}

}  // namespace

Result<std::unique_ptr<Environment>> loadEnvironment(Context& context, const std::string& file,
                                                     const Environment::Options& options,
                                                     std::vector<Diagnostic>& notes) {
    GLINT_TRY(const auto image, image::readRadiance(file));
    Result<std::unique_ptr<Environment>> environment = Environment::create(context, image, options);
    if (!environment) {
        Diagnostic error = environment.error();
        error.where = file;
        return error;
    }
    const std::vector<Diagnostic> more = describe(file, image, (*environment)->statistics());
    notes.insert(notes.end(), more.begin(), more.end());
    return environment;
}

}  // namespace glint::session
