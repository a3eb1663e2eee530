// Finds the reasons why a camera sees nothing.
#include "base/vectors.h"
#include "scene/deformed.h"

#include <glint/scene_view/camera.h>
#include <glint/scene_view/pose.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace glint::scene_view {

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

class Looker {
public:
    Looker(const gltf::Scene& scene, const SceneViewData& view, const CameraView& camera)
        : scene_(scene), view_(view), frustum_(camera), boxes_(scene.meshes.size()) {}

    Unseen instance(std::size_t index) {
        const InstanceView& placed = view_.instances[index];
        if (!placed.visible) {
            return Unseen::Hidden;
        }
        const gltf::Node& node = scene_.nodes[view_.sources[index].node];
        const gltf::Mesh& mesh = scene_.meshes[placed.mesh];
        if (compiler::isDeformed(scene_, node)) {
            return deformed(node, mesh, placed);
        }
        const Unseen box = frustum_.side(cornersOf(placed));
        if (box != Unseen::None) {
            return box;
        }
        const glm::dmat3x4 rows(glm::make_mat3x4(placed.objectToWorld.data()));
        const double mirror = glm::determinant(glm::dmat3(rows)) < 0.0 ? -1.0 : 1.0;
        Unseen nearest = Unseen::Hidden;
        for (const gltf::Primitive& primitive : mesh.primitives) {
            std::vector<glm::dvec3> positions;
            positions.reserve(primitive.positions.size());
            for (const gltf::Float3& position : primitive.positions) {
                positions.push_back(glm::dvec4(base::toVector(position), 1.0) * rows);
            }
            nearest = std::max(nearest, lookAt(frustum_, positions, primitive.indices,
                                               isDoubleSided(primitive) ? 0.0 : mirror));
            if (nearest == Unseen::None) {
                break;
            }
        }
        return nearest;
    }

private:
    bool isDoubleSided(const gltf::Primitive& primitive) const {
        return scene_.materials[static_cast<std::size_t>(primitive.material)].doubleSided;
    }

    // Counts the triangles' sides as unknown.
    Unseen deformed(const gltf::Node& node, const gltf::Mesh& mesh, const InstanceView& placed) const {
        const std::vector<gltf::Matrix4> joints =
            placed.joints.empty() ? std::vector<gltf::Matrix4>()
                                  : jointMatrices(scene_, scene_.skins[static_cast<std::size_t>(node.skin)]);
        Unseen nearest = Unseen::Hidden;
        for (const gltf::Primitive& primitive : mesh.primitives) {
            std::vector<glm::dvec3> positions;
            for (const std::array<double, 3>& position : deformedPositions(primitive, node.weights, joints)) {
                const glm::dvec3 point = base::toVector(position);
                positions.push_back(joints.empty() ? base::transformed(placed.objectToWorld, point) : point);
            }
            nearest = std::max(nearest, lookAt(frustum_, positions, primitive.indices, 0.0));
        }
        return nearest;
    }

    // Returns the corners of the mesh's box in the world.
    std::array<glm::dvec3, 8> cornersOf(const InstanceView& placed) {
        std::optional<Bounds>& box = boxes_[placed.mesh];
        if (!box) {
            box = Bounds{{1.0, 1.0, 1.0}, {-1.0, -1.0, -1.0}};
            for (const gltf::Primitive& primitive : scene_.meshes[placed.mesh].primitives) {
                for (const gltf::Float3& position : primitive.positions) {
                    const std::array<double, 3> point{position[0], position[1], position[2]};
                    box = united(*box, {point, point});
                }
            }
        }
        std::array<glm::dvec3, 8> corners;
        for (std::size_t i = 0; i < corners.size(); ++i) {
            corners[i] = base::transformed(placed.objectToWorld, {((i & 1U) != 0 ? box->max : box->min)[0],
                                                                  ((i & 2U) != 0 ? box->max : box->min)[1],
                                                                  ((i & 4U) != 0 ? box->max : box->min)[2]});
        }
        return corners;
    }

    const gltf::Scene& scene_;
    const SceneViewData& view_;
    Frustum frustum_;
    std::vector<std::optional<Bounds>> boxes_;
};

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
    Looker looker(scene, view, placed);
    for (std::size_t i = 0; i < view.instances.size(); ++i) {
        const Unseen reason = looker.instance(i);
        if (reason == Unseen::None && !isCertain) {
            return std::nullopt;
        }
        Group& group = groups[reason];
        if (++group.count <= kShown) {
            group.shown.push_back(fmt::format("/nodes/{}", scene.nodes[view.sources[i].node].source));
        }
    }
    std::vector<std::string> reasons;
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

}  // namespace glint::scene_view
