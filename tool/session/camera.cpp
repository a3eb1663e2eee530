#include "base/text.h"
#include "base/vectors.h"
#include "scene/deformed.h"
#include "session/pose.h"

#include <glint/session/camera.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <vector>

namespace glint::session {

namespace {

// Returns nothing if the length is 0 or not finite.
std::optional<glm::dvec3> normalized(const glm::dvec3& a) {
    const double metres = glm::length(a);
    if (!(metres > 0.0) || !std::isfinite(metres)) {
        return std::nullopt;
    }
    return a * (1.0 / metres);
}

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr Bounds kNothing{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};

void extend(Bounds& bounds, const glm::dvec3& point) {
    bounds.min = base::toArray(glm::min(base::toVector(bounds.min), point));
    bounds.max = base::toArray(glm::max(base::toVector(bounds.max), point));
}

glm::dvec3 corner(const Bounds& bounds, unsigned number) {
    return glm::mix(base::toVector(bounds.min), base::toVector(bounds.max),
                    glm::bvec3((number & 1U) != 0, (number & 2U) != 0, (number & 4U) != 0));
}

glm::dvec3 centreOf(const Bounds& bounds) {
    return 0.5 * (base::toVector(bounds.min) + base::toVector(bounds.max));
}

// Returns the bounds of each mesh in its own space, by mesh number.
std::vector<Bounds> meshBounds(const SceneViewData& scene) {
    std::vector<Bounds> bounds;
    for (const PrimitiveView& primitive : scene.primitives) {
        bounds.resize(std::max<std::size_t>(bounds.size(), primitive.mesh + std::size_t{1}), kNothing);
        for (const gltf::Float3& position : primitive.positions) {
            extend(bounds[primitive.mesh], base::toVector(position));
        }
    }
    return bounds;
}

Bounds transformedBox(const Bounds& box, const std::array<float, 12>& rows) {
    Bounds bounds = kNothing;
    for (unsigned number = 0; number < 8; ++number) {
        extend(bounds, base::transformed(rows, corner(box, number)));
    }
    return bounds;
}

bool isFiniteBox(const Bounds& bounds) {
    return base::isFinite(bounds.min) && base::isFinite(bounds.max);
}

// Returns a box that has some extent, whatever the scene contains.
Bounds withExtent(const Bounds& bounds) {
    const Bounds box = bounds.empty() ? Bounds{} : bounds;
    if (box.min != box.max) {
        return box;
    }
    const glm::dvec3 point = base::toVector(box.min);
    return {base::toArray(point - 0.5), base::toArray(point + 0.5)};
}

// Returns the direction to the viewer of a box with this extent: in front, on +Z (glTF 2.0, section 3.4), a
// little above and to the right. A flat object, such as a board or a floor, shows its face. An object is flat
// if it is thinner than kFlat times its next larger extent.
glm::dvec3 directionToViewer(const glm::dvec3& extent) {
    constexpr double kFlat = 0.25;
    const auto thin = [&](glm::length_t axis) {
        return extent[axis] < kFlat * std::min(extent[(axis + 1) % 3], extent[(axis + 2) % 3]);
    };
    if (thin(0)) {
        return *normalized({1.0, 0.1, 0.1});
    }
    if (thin(1)) {
        return *normalized({0.1, 1.0, 0.5});
    }
    if (thin(2)) {
        return *normalized({0.06, 0.1, 1.0});
    }
    return *normalized({0.4, 0.35, 1.0});
}

// The place of a camera that looks against `backward`, from which two planes through the camera enclose the
// box. The planes open by `slope` along `axis`, and both touch the box.
struct Fit {
    double offset;    // along axis from the box's centre
    double distance;  // along backward
};

Fit fit(const Bounds& box, const glm::dvec3& axis, const glm::dvec3& backward, double slope) {
    const glm::dvec3 centre = centreOf(box);
    double low = -kInfinity;
    double high = -kInfinity;
    for (unsigned number = 0; number < 8; ++number) {
        const glm::dvec3 point = corner(box, number) - centre;
        // A point is inside if |point·axis - offset| <= slope (distance - point·backward).
        low = std::max(low, slope * glm::dot(point, backward) - glm::dot(point, axis));
        high = std::max(high, slope * glm::dot(point, backward) + glm::dot(point, axis));
    }
    return {0.5 * (high - low), 0.5 * (high + low) / slope};
}

std::string cameraName(const gltf::Scene& scene, std::size_t index) {
    const std::string& name = scene.cameras[index].name;
    return name.empty() ? std::to_string(index) : name;
}

std::optional<std::size_t> findCamera(const gltf::Scene& scene, const std::string& wanted) {
    std::size_t number = 0;
    const char* end = wanted.data() + wanted.size();
    const auto parsed = std::from_chars(wanted.data(), end, number);
    if (parsed.ec == std::errc() && parsed.ptr == end && number < scene.cameras.size()) {
        return number;
    }
    const auto found = std::find_if(scene.cameras.begin(), scene.cameras.end(),
                                    [&](const gltf::Camera& camera) { return camera.name == wanted; });
    if (found == scene.cameras.end()) {
        return std::nullopt;
    }
    return static_cast<std::size_t>(found - scene.cameras.begin());
}

Diagnostic unknownCamera(const gltf::Scene& scene, const std::string& wanted) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
        names.push_back(cameraName(scene, i));
    }
    const std::string known = names.empty() ? " (it has none)" : base::enumeration(names);
    names.emplace_back("auto");
    return makeError("camera-unknown", scene.path,
                     "has no camera \"" + wanted + "\"" + known + base::suggestion(wanted, names),
                     "use --camera auto, a name, a number from 0, or a place such as 1,2,3/0,0,0/30");
}

// Returns a box that is relative to the scene's origin as one in the world.
Bounds inWorld(const Bounds& box, const SceneViewData& scene) {
    return box.empty() ? box
                       : Bounds{base::toArray(base::toVector(box.min) + base::toVector(scene.origin)),
                                base::toArray(base::toVector(box.max) + base::toVector(scene.origin))};
}

}  // namespace

bool Bounds::empty() const {
    return min[0] > max[0] || min[1] > max[1] || min[2] > max[2];
}

Bounds worldBounds(const SceneViewData& scene) {
    const std::vector<Bounds> meshes = meshBounds(scene);
    Bounds bounds = kNothing;
    for (const InstanceView& instance : scene.instances) {
        const Bounds& mesh = meshes[instance.mesh];
        if (mesh.empty()) {
            continue;
        }
        const Bounds placed = transformedBox(mesh, instance.objectToWorld);
        if (isFiniteBox(placed)) {
            extend(bounds, base::toVector(placed.min));
            extend(bounds, base::toVector(placed.max));
        }
    }
    return inWorld(bounds, scene);
}

Bounds united(const Bounds& a, const Bounds& b) {
    Bounds both = kNothing;
    for (const Bounds& bounds : {a, b}) {
        if (!bounds.empty()) {
            extend(both, base::toVector(bounds.min));
            extend(both, base::toVector(bounds.max));
        }
    }
    return both;
}

Bounds posedBounds(const gltf::Scene& scene, const SceneViewData& view) {
    SceneViewData rigid;
    rigid.primitives = view.primitives;
    rigid.origin = view.origin;
    Bounds bounds = kNothing;
    for (std::size_t i = 0; i < view.instances.size(); ++i) {
        const InstanceView& instance = view.instances[i];
        const gltf::Node& node = scene.nodes[view.sources[i].node];
        if (!instance.visible) {
            continue;
        }
        if (!compiler::isDeformed(scene, node)) {
            rigid.instances.push_back(instance);
            continue;
        }
        const std::vector<gltf::Matrix4> joints =
            instance.joints.empty() ? std::vector<gltf::Matrix4>()
                                    : jointMatrices(scene, scene.skins[static_cast<std::size_t>(node.skin)]);
        // Skinned vertices are already in world space. Others are relative to their mesh's origin.
        const glm::dvec3 from =
            joints.empty() ? base::toVector(view.meshOrigins[instance.mesh]) : glm::dvec3(0.0);
        Bounds own = kNothing;
        for (const gltf::Primitive& primitive : scene.meshes[instance.mesh].primitives) {
            for (const std::array<double, 3>& point : deformedPositions(primitive, node.weights, joints)) {
                extend(own, base::toVector(point) - from);
            }
        }
        const Bounds placed =
            own.empty() || !joints.empty() ? own : inWorld(transformedBox(own, instance.objectToWorld), view);
        bounds = isFiniteBox(placed) ? united(bounds, placed) : bounds;
    }
    return united(bounds, worldBounds(rigid));
}

CameraView framingCamera(const Bounds& bounds, double aspect) {
    constexpr double kHalfHeight = 0.26794919243112270;  // tan(30° / 2)
    constexpr double kMargin = 1.05;
    const Bounds box = withExtent(bounds);
    const glm::dvec3 centre = centreOf(box);
    const glm::dvec3 extent = base::toVector(box.max) - base::toVector(box.min);
    const glm::dvec3 backward = directionToViewer(extent);
    const glm::dvec3 right = *normalized(glm::cross(glm::dvec3{0.0, 1.0, 0.0}, backward));
    const glm::dvec3 up = glm::cross(backward, right);

    const Fit across = fit(box, right, backward, kHalfHeight * aspect / kMargin);
    const Fit upright = fit(box, up, backward, kHalfHeight / kMargin);
    double nearest = -kInfinity;
    for (unsigned number = 0; number < 8; ++number) {
        nearest = std::max(nearest, glm::dot(corner(box, number) - centre, backward));
    }
    // Seen from the viewer, a box may be no more than a line. It is then viewed from a hundredth of its size.
    const double clearance = 0.01 * glm::length(extent);
    const double distance = std::max({across.distance, upright.distance, nearest + clearance});

    CameraView view;
    view.position =
        base::toArray(centre + backward * distance + (right * across.offset + up * upright.offset));
    view.forward = base::toFloat3(-backward);
    view.up = base::toFloat3(up);
    view.halfHeight = static_cast<float>(kHalfHeight);
    view.halfWidth = static_cast<float>(kHalfHeight * aspect);
    // Nothing is nearer than the box. The plane keeps a distance from the box's face, which may be seen
    // head-on.
    view.near = static_cast<float>(0.99 * (distance - nearest));
    return view;
}

Result<CameraView> sceneCamera(const gltf::Scene& scene, std::size_t index, double aspect) {
    const gltf::Camera& camera = scene.cameras[index];
    const gltf::Matrix4& m = camera.world;
    const std::optional<glm::dvec3> forward = normalized({-m[8], -m[9], -m[10]});
    const glm::dvec3 upward{m[4], m[5], m[6]};
    const std::optional<glm::dvec3> up =
        forward ? normalized(upward - *forward * glm::dot(upward, *forward)) : std::nullopt;
    if (!up) {
        return makeError("camera-matrix", scene.path,
                         "the node of camera " + cameraName(scene, index) + " has a scale of 0",
                         "give it another scale, or use --camera auto");
    }
    CameraView view;
    view.position = {m[12], m[13], m[14]};
    view.forward = base::toFloat3(*forward);
    view.up = base::toFloat3(*up);
    view.orthographic = camera.orthographic;
    const double halfHeight = camera.orthographic ? camera.ymag : std::tan(0.5 * camera.yfov);
    view.halfHeight = static_cast<float>(halfHeight);
    view.halfWidth = static_cast<float>(halfHeight * aspect);
    view.near = static_cast<float>(camera.znear);
    view.far = static_cast<float>(camera.zfar);
    return view;
}

std::optional<PlacedCamera> parsePlacedCamera(std::string_view text) {
    constexpr double kMostCoordinate = 1e15;  // where a double still tells decimetres apart
    std::vector<double> numbers;
    std::string separators;
    for (const char *at = text.data(), *const end = at + text.size(); at <= end;) {
        double number = 0.0;
        const auto parsed = std::from_chars(at, end, number);
        if (parsed.ec != std::errc() || !(std::abs(number) < kMostCoordinate)) {
            return std::nullopt;
        }
        numbers.push_back(number);
        if (parsed.ptr == end) {
            break;
        }
        separators += *parsed.ptr;
        at = parsed.ptr + 1;
    }
    if (separators != ",,/,,/" && separators != ",,/,,") {
        return std::nullopt;
    }
    PlacedCamera camera{{numbers[0], numbers[1], numbers[2]}, {numbers[3], numbers[4], numbers[5]}};
    camera.degrees = numbers.size() == 7 ? numbers[6] : camera.degrees;
    const bool looksAside = camera.position[0] != camera.target[0] || camera.position[2] != camera.target[2];
    const bool opens = camera.degrees > 0.0 && camera.degrees < 180.0;
    return looksAside && opens ? std::optional(camera) : std::nullopt;
}

std::string toText(const PlacedCamera& camera) {
    return fmt::format("{}/{}/{}", fmt::join(camera.position, ","), fmt::join(camera.target, ","),
                       camera.degrees);
}

CameraView viewOf(const PlacedCamera& camera, double aspect) {
    constexpr double kNearShare = 1e-3;
    const glm::dvec3 position = base::toVector(camera.position);
    const glm::dvec3 toTarget = base::toVector(camera.target) - position;
    const glm::dvec3 forward = glm::normalize(toTarget);
    const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3{0.0, 1.0, 0.0}));
    const double halfHeight = std::tan(camera.degrees * std::numbers::pi / 360.0);
    CameraView view;
    view.position = camera.position;
    view.forward = base::toFloat3(forward);
    view.up = base::toFloat3(glm::cross(right, forward));
    view.halfHeight = static_cast<float>(halfHeight);
    view.halfWidth = static_cast<float>(halfHeight * aspect);
    view.near = static_cast<float>(kNearShare * glm::length(toTarget));
    return view;
}

bool framesEverything(const gltf::Scene& scene, const std::string& wanted) {
    return wanted == "auto" || (wanted.empty() && scene.cameras.empty());
}

Result<CameraChoice> chooseCamera(const gltf::Scene& scene, const SceneViewData& view,
                                  const std::string& wanted, double aspect) {
    const bool everything = framesEverything(scene, wanted);
    return chooseCameraAround(scene, everything ? posedBounds(scene, view) : Bounds{}, wanted, aspect);
}

Result<CameraChoice> chooseCameraAround(const gltf::Scene& scene, const Bounds& framed,
                                        const std::string& wanted, double aspect) {
    if (framesEverything(scene, wanted)) {
        return CameraChoice{framingCamera(framed, aspect), "auto"};
    }
    const std::optional<std::size_t> index =
        wanted.empty() ? std::optional<std::size_t>(0) : findCamera(scene, wanted);
    const std::optional<PlacedCamera> placed = index ? std::nullopt : parsePlacedCamera(wanted);
    if (placed) {
        return CameraChoice{viewOf(*placed, aspect), toText(*placed)};
    }
    if (!index) {
        return unknownCamera(scene, wanted);
    }
    GLINT_TRY(const auto camera, sceneCamera(scene, *index, aspect));
    return CameraChoice{camera, cameraName(scene, *index)};
}

// --- Why a camera sees nothing ---

namespace {

// The reasons why a triangle is not in a picture. The later ones are nearer to being seen, and an instance
// has that of its nearest triangle.
enum class Unseen : std::uint8_t { Hidden, Flat, Behind, Near, Far, Outside, Turned, None };

class Frustum {
public:
    explicit Frustum(const CameraView& view)
        : view_(view),
          position_(base::toVector(view.position)),
          forward_(base::toVector(view.forward)),
          up_(base::toVector(view.up)),
          right_(glm::cross(forward_, up_)) {}

    // Returns the reason if all points are on the far side of one plane of the frustum.
    template <std::size_t Count>
    Unseen side(const std::array<glm::dvec3, Count>& points) const {
        std::array<glm::dvec3, Count> seen;  // in the camera's space: right, up, forward
        std::ranges::transform(points, seen.begin(), [&](const glm::dvec3& point) {
            const glm::dvec3 offset = point - position_;
            return glm::dvec3(glm::dot(offset, right_), glm::dot(offset, up_), glm::dot(offset, forward_));
        });
        const auto all = [&](auto isOutside) { return std::ranges::all_of(seen, isOutside); };
        if (all([](const glm::dvec3& p) { return p.z < 0.0; })) {
            return Unseen::Behind;
        }
        if (all([&](const glm::dvec3& p) { return p.z < view_.near; })) {
            return Unseen::Near;
        }
        if (view_.far > 0.0F && all([&](const glm::dvec3& p) { return p.z > view_.far; })) {
            return Unseen::Far;
        }
        const auto reach = [&](double slope, const glm::dvec3& p) {
            return view_.orthographic ? slope : slope * p.z;
        };
        for (const double sign : {-1.0, 1.0}) {
            if (all([&](const glm::dvec3& p) { return sign * p.x > reach(view_.halfWidth, p); }) ||
                all([&](const glm::dvec3& p) { return sign * p.y > reach(view_.halfHeight, p); })) {
                return Unseen::Outside;
            }
        }
        return Unseen::None;
    }

    // `normal` is that of the front.
    bool seesFront(const glm::dvec3& point, const glm::dvec3& normal) const {
        return glm::dot(normal, view_.orthographic ? -forward_ : position_ - point) > 0.0;
    }

private:
    const CameraView& view_;
    glm::dvec3 position_;
    glm::dvec3 forward_;
    glm::dvec3 up_;
    glm::dvec3 right_;
};

// `sides` is 1 or -1 if only the front of a triangle is seen; a mirrored instance turns it over. 0: both
// sides are seen.
Unseen lookAt(const Frustum& frustum, const std::vector<glm::dvec3>& positions,
              const std::vector<std::uint32_t>& indices, double sides) {
    Unseen nearest = Unseen::Hidden;
    for (std::size_t i = 0; i + 2 < indices.size() && nearest != Unseen::None; i += 3) {
        const std::array corners{positions[indices[i]], positions[indices[i + 1]], positions[indices[i + 2]]};
        const glm::dvec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
        Unseen reason = frustum.side(corners);
        if (glm::length(normal) == 0.0) {
            reason = Unseen::Flat;
        } else if (reason == Unseen::None && sides != 0.0 && !frustum.seesFront(corners[0], sides * normal)) {
            reason = Unseen::Turned;
        }
        nearest = std::max(nearest, reason);
    }
    return nearest;
}

Unseen lookAt(const Frustum& frustum, const gltf::Scene& scene, const SceneViewData& view,
              std::size_t index) {
    const InstanceView& placed = view.instances[index];
    if (!placed.visible) {
        return Unseen::Hidden;
    }
    const bool isDeformed = compiler::isDeformed(scene, scene.nodes[view.sources[index].node]);
    if (!isDeformed) {
        std::array<glm::dvec3, 8> corners;
        for (unsigned number = 0; number < corners.size(); ++number) {
            corners[number] =
                base::transformed(placed.objectToWorld, corner(view.meshBoxes[placed.mesh], number) -
                                                            base::toVector(view.meshOrigins[placed.mesh]));
        }
        if (const Unseen box = frustum.side(corners); box != Unseen::None) {
            return box;
        }
    }
    const glm::dmat3x4 rows(glm::make_mat3x4(placed.objectToWorld.data()));
    const double mirror = glm::determinant(glm::dmat3(rows)) < 0.0 ? -1.0 : 1.0;
    Unseen nearest = Unseen::Hidden;
    for (const gltf::Primitive& primitive : scene.meshes[placed.mesh].primitives) {
        const bool isDoubleSided = scene.materials[static_cast<std::size_t>(primitive.material)].doubleSided;
        // Deformed triangles count as seen from both sides.
        nearest = std::max(nearest, lookAt(frustum, placedPositions(scene, view, index, primitive),
                                           primitive.indices, isDeformed || isDoubleSided ? 0.0 : mirror));
        if (nearest == Unseen::None) {
            break;
        }
    }
    return nearest;
}

std::string textOf(Unseen reason, const CameraView& view) {
    switch (reason) {
        case Unseen::Hidden:
            return "hidden";
        case Unseen::Flat:
            return "without an area";
        case Unseen::Behind:
            return "behind the camera";
        case Unseen::Near:
            return fmt::format("nearer than its near plane at {} m", view.near);
        case Unseen::Far:
            return fmt::format("beyond its far plane at {} m", view.far);
        case Unseen::Outside:
            return "outside of its view";
        case Unseen::Turned:
            return "one-sided and seen from behind";
        case Unseen::None:
            break;
    }
    return "smaller than a pixel, or cut out by alpha";
}

}  // namespace

std::optional<Diagnostic> nothingSeen(const gltf::Scene& scene, const SceneViewData& view,
                                      const CameraChoice& camera, bool isCertain) {
    if (view.instances.empty()) {
        return std::nullopt;  // importScene() has said so
    }
    constexpr std::size_t kShown = 3;
    struct Group {
        std::size_t count = 0;
        std::vector<std::string> shown;
    };
    std::map<Unseen, Group> groups;
    CameraView placed = camera.view;  // counted from the origin, as the instances are
    for (std::size_t i = 0; i < view.origin.size(); ++i) {
        placed.position[i] -= view.origin[i];
    }
    const Frustum frustum(placed);
    for (std::size_t i = 0; i < view.instances.size(); ++i) {
        const Unseen reason = lookAt(frustum, scene, view, i);
        if (reason == Unseen::None && !isCertain) {
            return std::nullopt;
        }
        Group& group = groups[reason];
        if (++group.count <= kShown) {
            group.shown.push_back(fmt::format("/nodes/{}", scene.nodes[view.sources[i].node].source));
        }
    }
    std::vector<std::string> reasons;
    reasons.reserve(groups.size());
    for (const auto& [reason, group] : groups) {
        reasons.push_back(fmt::format("{} {} {} ({}{})", group.count,
                                      group.count == 1 ? "instance is" : "instances are",
                                      textOf(reason, camera.view), fmt::join(group.shown, ", "),
                                      group.count > group.shown.size() ? ", …" : ""));
    }
    std::string hint = camera.name == "auto"
                           ? "place a camera: --camera X,Y,Z/X,Y,Z"
                           : "use --camera auto, which frames everything, or place a camera";
    if (scene.scenesInFile.size() > 1) {
        hint += "; --scene chooses another of the file's scenes";
    }
    return makeWarning(
        "nothing-seen", scene.path,
        fmt::format("the camera {} sees no surface: {}", camera.name, fmt::join(reasons, "; ")), hint);
}

}  // namespace glint::session
