#include "oracle/traversal/rays.h"

#include "base/vectors.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <random>
#include <thread>

namespace glint::traversal {
namespace {

Float3 transformed(const std::array<float, 12>& rows, const Float3& point) {
    Float3 result{};
    for (std::size_t row = 0; row < 3; ++row) {
        result[row] = rows[4 * row] * point[0] + rows[4 * row + 1] * point[1] + rows[4 * row + 2] * point[2] +
                      rows[4 * row + 3];
    }
    return result;
}

Float3 plus(const Float3& a, float factor, const Float3& b) {
    return {a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]};
}

Float3 cross(const Float3& a, const Float3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

float dot(const Float3& a, const Float3& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Float3 unit(const Float3& v) {
    const float length = std::sqrt(dot(v, v));
    return {v[0] / length, v[1] / length, v[2] / length};
}

RTCRayHit rayHitOf(const Ray& ray) {
    RTCRayHit query{};
    query.ray.org_x = ray.origin[0];
    query.ray.org_y = ray.origin[1];
    query.ray.org_z = ray.origin[2];
    query.ray.dir_x = ray.direction[0];
    query.ray.dir_y = ray.direction[1];
    query.ray.dir_z = ray.direction[2];
    query.ray.tfar = std::numeric_limits<float>::infinity();
    query.ray.mask = 0xFFFFFFFFU;
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    return query;
}

void intersect(RTCScene scene, RTCRayHit& query) {
#if RTC_VERSION_MAJOR >= 4
    rtcIntersect1(scene, &query);
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene, &context, &query);
#endif
}

}  // namespace

std::vector<Triangle> worldTriangles(const SceneView& scene) {
    std::vector<Triangle> triangles;
    for (const InstanceView& instance : scene.instances) {
        const auto own = std::ranges::equal_range(scene.primitives, instance.mesh, {}, &PrimitiveView::mesh);
        for (const PrimitiveView& primitive : own) {
            for (std::size_t i = 0; i + 2 < primitive.indices.size(); i += 3) {
                Triangle& triangle = triangles.emplace_back();
                for (std::size_t corner = 0; corner < 3; ++corner) {
                    triangle.corners[corner] = transformed(
                        instance.objectToWorld, primitive.positions[primitive.indices[i + corner]]);
                }
            }
        }
    }
    return triangles;
}

std::vector<Ray> cameraRays(const CameraView& camera, std::uint32_t width, std::uint32_t height) {
    const Float3 right = cross(camera.forward, camera.up);
    std::vector<std::array<std::uint32_t, 2>> tiles;
    for (std::uint32_t y = 0; y + 8 <= height; y += 8) {
        for (std::uint32_t x = 0; x + 8 <= width; x += 8) {
            tiles.push_back({x, y});
        }
    }
    std::ranges::shuffle(tiles, std::mt19937_64(1));
    const Float3 position = base::toFloat3(base::toVector(camera.position));
    std::vector<Ray> rays;
    for (const auto& [left, top] : tiles) {
        for (std::uint32_t i = 0; i < kTile; ++i) {
            const float x =
                (2.0F * static_cast<float>(left + i % 8) + 1.0F) / static_cast<float>(width) - 1.0F;
            const float y =
                1.0F - (2.0F * static_cast<float>(top + i / 8) + 1.0F) / static_cast<float>(height);
            const Float3 across =
                plus(plus({}, x * camera.halfWidth, right), y * camera.halfHeight, camera.up);
            if (camera.orthographic) {
                rays.push_back({plus(position, 1.0F, across), camera.forward});
            } else {
                rays.push_back({position, unit(plus(camera.forward, 1.0F, across))});
            }
        }
    }
    return rays;
}

struct EmbreeScene::Embree {
    RTCDevice device = rtcNewDevice(nullptr);
    RTCScene scene = rtcNewScene(device);

    Embree() = default;
    ~Embree() {
        rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }
    Embree(const Embree&) = delete;
    Embree& operator=(const Embree&) = delete;
};

EmbreeScene::EmbreeScene(const std::vector<Triangle>& triangles) : embree_(std::make_unique<Embree>()) {
    RTCGeometry geometry = rtcNewGeometry(embree_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), 3 * triangles.size()));
    auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), triangles.size()));
    std::uint32_t next = 0;
    for (const Triangle& triangle : triangles) {
        for (const Float3& corner : triangle.corners) {
            vertices = std::ranges::copy(corner, vertices).out;
            *indices++ = next++;
        }
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(embree_->scene, geometry);
    rtcReleaseGeometry(geometry);
    // This makes Embree watertight, as the driver's intersection is, and selects its best tree.
    rtcSetSceneFlags(embree_->scene, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(embree_->scene, RTC_BUILD_QUALITY_HIGH);
    rtcCommitScene(embree_->scene);
    if (const RTCError error = rtcGetDeviceError(embree_->device); error != RTC_ERROR_NONE) {
        std::fprintf(stderr, "Embree failed: error %d\n", static_cast<int>(error));
        std::abort();
    }
}

EmbreeScene::~EmbreeScene() = default;

double EmbreeScene::trace(std::span<const Ray> rays, std::span<float> distances) const {
    std::atomic<std::size_t> next{0};
    const auto work = [&] {
        for (std::size_t first = next.fetch_add(kTile); first < rays.size(); first = next.fetch_add(kTile)) {
            for (std::size_t i = first; i < std::min(first + kTile, rays.size()); ++i) {
                RTCRayHit query = rayHitOf(rays[i]);
                intersect(embree_->scene, query);
                distances[i] = query.hit.geomID == RTC_INVALID_GEOMETRY_ID ? -1.0F : query.ray.tfar;
            }
        }
    };
    const auto begin = std::chrono::steady_clock::now();
    std::vector<std::thread> helpers;
    for (unsigned i = 1; i < std::thread::hardware_concurrency(); ++i) {
        helpers.emplace_back(work);
    }
    work();
    for (std::thread& helper : helpers) {
        helper.join();
    }
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

std::vector<Ray> EmbreeScene::bounces(std::span<const Ray> rays) const {
    std::mt19937_64 random(2);
    std::uniform_real_distribution<float> share(0.0F, 1.0F);
    std::vector<Ray> found;
    for (const Ray& ray : rays) {
        RTCRayHit query = rayHitOf(ray);
        intersect(embree_->scene, query);
        const Float3 along{query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z};
        if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID || !(dot(along, along) > 0.0F)) {
            continue;
        }
        Float3 normal = unit(along);
        if (dot(normal, ray.direction) > 0.0F) {
            normal = plus({}, -1.0F, normal);
        }
        const float angle = 2.0F * std::numbers::pi_v<float> * share(random);
        const float height = 2.0F * share(random) - 1.0F;
        const float radius = std::sqrt(std::max(1.0F - height * height, 0.0F));
        // The direction leads to a uniform point on the unit sphere about the tip of the normal, so its
        // density is proportional to the cosine.
        const Float3 sphere{radius * std::cos(angle), radius * std::sin(angle), height};
        const Float3 direction = plus(normal, 0.999F, sphere);
        const Float3 position = plus(ray.origin, query.ray.tfar, ray.direction);
        found.push_back({plus(position, 1e-3F * query.ray.tfar, normal), unit(direction)});
    }
    return found;
}

}  // namespace glint::traversal
