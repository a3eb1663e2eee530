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

#if RTC_VERSION_MAJOR >= 4
using QueryContext = RTCRayQueryContext;
#else
using QueryContext = RTCIntersectContext;
#endif

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
};

namespace {

// Returns where the ray meets the triangle's plane: Möller and Trumbore (1997), without their tests.
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

// The data that Embree passes to the filter. The context comes first, so that a pointer to it is also a
// pointer to this.
struct Query {
    QueryContext context;
    const Triangles& triangles;
    const Vec3& origin;
    const Vec3& direction;
    double nearest;
    double farthest;
    const Accepts& accepts;
};

TriangleHit hitOf(const Query& query, std::uint32_t index) {
    TriangleHit hit = planeHit(query.triangles.at(index), query.origin, query.direction);
    hit.triangle = index;
    return hit;
}

// Leaves out the start of the ray, hits that are too far, and surfaces that do not exist there. Embree
// continues behind a rejected hit, first with others in the same place.
void filter(const RTCFilterFunctionNArguments* arguments) {
    const Query& query = *reinterpret_cast<const Query*>(arguments->context);
    const TriangleHit hit = hitOf(query, RTCHitN_primID(arguments->hit, arguments->N, 0));
    if (!(hit.distance > query.nearest && hit.distance < query.farthest && query.accepts(hit))) {
        arguments->valid[0] = 0;
    }
}

RTCRay rayOf(const Query& query) {
    RTCRay ray{};
    ray.org_x = static_cast<float>(query.origin.x);
    ray.org_y = static_cast<float>(query.origin.y);
    ray.org_z = static_cast<float>(query.origin.z);
    ray.dir_x = static_cast<float>(query.direction.x);
    ray.dir_y = static_cast<float>(query.direction.y);
    ray.dir_z = static_cast<float>(query.direction.z);
    ray.tfar = std::numeric_limits<float>::infinity();
    ray.mask = 0xFFFFFFFFU;
    return ray;
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
        rtcSetGeometryIntersectFilterFunction(geometry, filter);
        rtcSetGeometryOccludedFilterFunction(geometry, filter);
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

bool Triangles::showsBack(std::uint32_t index, const Vec3& direction) const {
    const Triangle& triangle = triangles_[index];
    const Vec3 front = glm::cross(triangle.positions[1] - triangle.positions[0],
                                  triangle.positions[2] - triangle.positions[0]);
    return glm::dot(front, direction) > 0.0;
}

bool Triangles::closest(const Vec3& origin, const Vec3& direction, double nearest, double farthest,
                        bool culled, TriangleHit& hit) const {
    return closest(
        origin, direction, nearest, farthest,
        [&](const TriangleHit& found) {
            return !culled || at(found.triangle).doubleSided || !showsBack(found.triangle, direction);
        },
        hit);
}

bool Triangles::closest(const Vec3& origin, const Vec3& direction, double nearest, double farthest,
                        const Accepts& accepts, TriangleHit& hit) const {
    Query query{{}, *this, origin, direction, nearest, farthest, accepts};
    RTCRayHit found{};
    found.ray = rayOf(query);
    found.hit.geomID = RTC_INVALID_GEOMETRY_ID;
#if RTC_VERSION_MAJOR >= 4
    rtcInitRayQueryContext(&query.context);
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.context = &query.context;
    rtcIntersect1(embree_->scene, &found, &arguments);
#else
    rtcInitIntersectContext(&query.context);
    rtcIntersect1(embree_->scene, &query.context, &found);
#endif
    if (found.hit.geomID == RTC_INVALID_GEOMETRY_ID) {
        return false;
    }
    hit = hitOf(query, found.hit.primID);
    return true;
}

bool Triangles::blocked(const Vec3& origin, const Vec3& direction, double nearest, double farthest,
                        const Accepts& accepts) const {
    Query query{{}, *this, origin, direction, nearest, farthest, accepts};
    RTCRay ray = rayOf(query);
#if RTC_VERSION_MAJOR >= 4
    rtcInitRayQueryContext(&query.context);
    RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    arguments.context = &query.context;
    rtcOccluded1(embree_->scene, &ray, &arguments);
#else
    rtcInitIntersectContext(&query.context);
    rtcOccluded1(embree_->scene, &query.context, &ray);
#endif
    // Embree marks a blocked ray in this way.
    return ray.tfar < 0.0F;
}

}  // namespace glint::oracle
