#include "oracle/triangles.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <cstdio>
#include <cstdlib>
#include <limits>

namespace glint::oracle {

struct Triangles::Embree {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;

    Embree() : device(rtcNewDevice("threads=1")), scene(rtcNewScene(device)) {}
    ~Embree() {
        rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }
    Embree(const Embree&) = delete;
    Embree& operator=(const Embree&) = delete;

    RTCRayHit nearestFrom(const Vec3& origin, const Vec3& direction, float nearest) const {
        RTCRayHit query{};
        query.ray.org_x = static_cast<float>(origin.x);
        query.ray.org_y = static_cast<float>(origin.y);
        query.ray.org_z = static_cast<float>(origin.z);
        query.ray.dir_x = static_cast<float>(direction.x);
        query.ray.dir_y = static_cast<float>(direction.y);
        query.ray.dir_z = static_cast<float>(direction.z);
        query.ray.tnear = nearest;
        query.ray.tfar = std::numeric_limits<float>::infinity();
        query.ray.mask = 0xFFFFFFFFU;
        query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
#if RTC_VERSION_MAJOR >= 4
        rtcIntersect1(scene, &query);
#else
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        rtcIntersect1(scene, &context, &query);
#endif
        return query;
    }
};

namespace {

// Where the ray meets the triangle's plane: Möller and Trumbore (1997), without their tests.
TriangleHit planeHit(const Triangle& triangle, const Vec3& origin, const Vec3& direction) {
    const Vec3 edge1 = triangle.positions[1] - triangle.positions[0];
    const Vec3 edge2 = triangle.positions[2] - triangle.positions[0];
    const Vec3 p = glm::cross(direction, edge2);
    const double determinant = glm::dot(edge1, p);
    const Vec3 t = origin - triangle.positions[0];
    const Vec3 q = glm::cross(t, edge1);
    TriangleHit hit;
    hit.distance = glm::dot(edge2, q) / determinant;
    hit.u = glm::dot(t, p) / determinant;
    hit.v = glm::dot(direction, q) / determinant;
    return hit;
}

bool showsBack(const Triangle& triangle, const Vec3& direction) {
    const Vec3 front = glm::cross(triangle.positions[1] - triangle.positions[0],
                                  triangle.positions[2] - triangle.positions[0]);
    return glm::dot(front, direction) > 0.0;
}

}  // namespace

Triangles::Triangles(std::vector<Triangle> triangles)
    : triangles_(std::move(triangles)), embree_(std::make_unique<Embree>()) {
    if (!triangles_.empty()) {
        RTCGeometry geometry = rtcNewGeometry(embree_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                                     RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                                                     3 * triangles_.size()));
        auto* indices = static_cast<std::uint32_t*>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                    3 * sizeof(std::uint32_t), triangles_.size()));
        std::uint32_t corner = 0;
        for (const Triangle& triangle : triangles_) {
            for (const Vec3& position : triangle.positions) {
                for (int axis = 0; axis < 3; ++axis) {
                    *vertices++ = static_cast<float>(position[axis]);
                }
                *indices++ = corner++;
            }
        }
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(embree_->scene, geometry);
        rtcReleaseGeometry(geometry);
    }
    rtcSetSceneFlags(embree_->scene, RTC_SCENE_FLAG_ROBUST);
    rtcCommitScene(embree_->scene);
    if (const RTCError error = rtcGetDeviceError(embree_->device); error != RTC_ERROR_NONE) {
        std::fprintf(stderr, "Embree failed: error %d\n", static_cast<int>(error));
        std::abort();
    }
}

Triangles::~Triangles() = default;

bool Triangles::closest(const Vec3& origin, const Vec3& direction, double nearest, double farthest,
                        bool culled, TriangleHit& hit) const {
    float start = 0.0F;
    while (true) {
        const RTCRayHit found = embree_->nearestFrom(origin, direction, start);
        if (found.hit.geomID == RTC_INVALID_GEOMETRY_ID) {
            return false;
        }
        const Triangle& triangle = triangles_[found.hit.primID];
        hit = planeHit(triangle, origin, direction);
        hit.triangle = found.hit.primID;
        if (hit.distance >= farthest) {
            return false;
        }
        const bool there = !culled || triangle.doubleSided || !showsBack(triangle, direction);
        if (hit.distance > nearest && there) {
            return true;
        }
        // The surface that the ray starts on, or one that it does not see: on from behind it.
        start = std::nextafter(found.ray.tfar, std::numeric_limits<float>::infinity());
    }
}

}  // namespace glint::oracle
