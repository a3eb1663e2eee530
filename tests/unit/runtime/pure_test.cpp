// Tests what the runtime computes without a device: cameras, transforms, lights, requirements, names of bits.
#include "context/context.h"
#include "context/vulkan_table.h"
#include "data/instance_math.h"
#include "data/materials.h"
#include "data/scene_checks.h"
#include "frame/frame_constants.h"
#include "materials/material_model.h"
#include "scene/draw_runs.h"
#include "support/features.h"
#include "support/must.h"
#include "unit/runtime/package_builder.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <set>

namespace glint {
namespace {

Draw makeDraw(std::uint32_t geometry, std::uint32_t primitive) {
    Draw draw;
    draw.geometry = geometry;
    draw.primitive = primitive;
    draw.vertexCount = 3 * (primitive + 1);
    return draw;
}

// Instances of the same primitives are one call each primitive, whose records are as far apart as an instance
// has draws.
TEST(DrawRunsTest, InstancesThatFollowEachOtherAreJoined) {
    DrawRuns runs;
    EXPECT_TRUE(runs.batches().empty());
    const auto show = [&](std::uint32_t instance, bool mirrored = false) {
        std::vector<Draw> draws{makeDraw(2 * instance, 0), makeDraw(2 * instance + 1, 1)};
        draws[0].mirrored = draws[1].mirrored = mirrored;
        runs.set(instance, draws);
    };
    // Whatever the order is in which they come.
    for (const std::uint32_t instance : {3U, 0U, 4U, 1U, 2U}) {
        show(instance);
    }
    runs.set(5, {makeDraw(10, 0)});
    const std::vector<DrawBatch> joined = runs.batches();
    ASSERT_EQ(joined.size(), 3U);
    EXPECT_EQ(joined[0].geometry, 0U);
    EXPECT_EQ(joined[1].geometry, 1U);
    EXPECT_EQ(joined[1].stride, 2U);
    EXPECT_EQ(joined[1].count, 5U);
    EXPECT_EQ(joined[1].vertexCount, 6U);
    EXPECT_EQ(joined[2].geometry, 10U);
    EXPECT_EQ(joined[2].count, 1U);
    // A mirrored instance, or one that is not drawn, ends a run.
    runs.set(2, {});
    show(4, true);
    const std::vector<DrawBatch> cut = runs.batches();
    ASSERT_EQ(cut.size(), 7U);
    std::uint32_t drawn = 0;
    for (const DrawBatch& batch : cut) {
        drawn += batch.count;
        EXPECT_NE(batch.geometry, 4U);
    }
    EXPECT_EQ(drawn, 9U);
    EXPECT_EQ(cut[2].geometry, 6U);
    EXPECT_TRUE(cut[4].mirrored);
    show(2);
    show(4);
    EXPECT_EQ(runs.batches().size(), 3U);
}

// Textures and samplers are the package's, whatever the host's record says.
TEST(SceneMaterialTest, TakesValuesAndKeepsTextures) {
    std::vector<test::TestMaterial> records(3);
    records[2].textures[1].textureIndex = 7;
    records[2].textures[1].texels = {64.0F, 32.0F};
    const std::span<std::uint8_t> all(reinterpret_cast<std::uint8_t*>(records.data()),
                                      records.size() * sizeof(test::TestMaterial));
    const MaterialTable table{all, sizeof(test::TestMaterial), offsetof(test::TestMaterial, textures), 2};
    test::TestMaterial given{};
    given.roughnessFactor = 0.25F;
    given.textures[1].textureIndex = 99;
    given.textures[1].rowU = {1.0F, 2.0F, 3.0F};
    const std::span<const std::uint8_t> bytes(reinterpret_cast<const std::uint8_t*>(&given), sizeof(given));
    const std::array views{MaterialView{2, bytes}};
    std::vector<ChangingMaterial> changing = must(replaceMaterials(views, table, all));
    EXPECT_EQ(records[2].roughnessFactor, 0.25F);
    EXPECT_EQ(records[2].textures[1].textureIndex, 7U);
    EXPECT_EQ(records[2].textures[1].texels.x, 64.0F);
    EXPECT_EQ(records[2].textures[1].rowU.z, 3.0F);
    given.roughnessFactor = 0.5F;
    ASSERT_TRUE(takeMaterials(views, table, changing).ok());
    const MaterialTable taken{changing[0].record, sizeof(test::TestMaterial), table.textureOffset, 2};
    EXPECT_EQ(test::materialAt(taken, 0).roughnessFactor, 0.5F);
    for (const std::vector<MaterialView>& wrong :
         {std::vector<MaterialView>{{3, bytes}}, {{2, bytes.first(8)}}, {{1, bytes}, {1, bytes}}}) {
        EXPECT_EQ(replaceMaterials(wrong, table, all).error().id, "scene-material");
        EXPECT_EQ(takeMaterials(wrong, table, changing).error().id, "scene-material");
    }
}

double dot(const gpu::vec4& row, const std::array<double, 3>& p) {
    return row.x * p[0] + row.y * p[1] + row.z * p[2] + row.w;
}

// A point on the ray of a pixel, at a distance along the view, projects to that pixel's centre.
TEST(CameraTest, RasterAndRaysAgree) {
    constexpr std::uint32_t kWidth = 31;
    constexpr std::uint32_t kHeight = 17;
    for (const bool orthographic : {false, true}) {
        CameraView camera;
        camera.position = {1.0F, -2.0F, 3.0F};
        camera.forward = {0.6F, 0.0F, 0.8F};
        camera.up = {0.0F, 1.0F, 0.0F};
        camera.halfWidth = 0.9F;
        camera.halfHeight = 0.5F;
        camera.near = 0.1F;
        camera.far = orthographic ? 50.0F : 0.0F;
        camera.orthographic = orthographic;
        for (const std::uint32_t sample : {0U, 1U, 7U}) {
            gpu::FrameConstants c{};
            fillCamera(camera, {}, kWidth, kHeight, sampleJitter(sample), c);
            const double x = 5;
            const double y = 11;
            const double px = (x + 0.5 + c.jitter.x) / kWidth * 2 - 1;
            const double py = 1 - (y + 0.5 + c.jitter.y) / kHeight * 2;
            for (const double d : {0.1, 2.0, 40.0}) {
                const double side = orthographic ? 1.0 : d;
                const std::array<double, 3> p{c.cameraPosition.x + d * c.cameraForward.x +
                                                  side * (px * c.cameraRight.x + py * c.cameraUp.x),
                                              c.cameraPosition.y + d * c.cameraForward.y +
                                                  side * (px * c.cameraRight.y + py * c.cameraUp.y),
                                              c.cameraPosition.z + d * c.cameraForward.z +
                                                  side * (px * c.cameraRight.z + py * c.cameraUp.z)};
                const double w = dot(c.worldToClip[3], p);
                EXPECT_NEAR((dot(c.worldToClip[0], p) / w + 1) / 2 * kWidth, x + 0.5, 1e-4);
                EXPECT_NEAR((dot(c.worldToClip[1], p) / w + 1) / 2 * kHeight, y + 0.5, 1e-4);
                const double depth = orthographic ? (50.0 - d) / 49.9 : 0.1 / d;
                EXPECT_NEAR(dot(c.worldToClip[2], p) / w, depth, 1e-5);
            }
        }
    }
}

// Only the place relative to the scene's origin matters, and the difference is taken in double precision.
TEST(CameraTest, IsRelativeToTheOrigin) {
    CameraView camera;
    camera.position = {1e9 + 0.125, -2.0, 3e9};
    gpu::FrameConstants c{};
    fillCamera(camera, {1e9, 0.0, 3e9 - 1.5}, 8, 8, {0, 0}, c);
    EXPECT_EQ(c.cameraPosition.x, 0.125F);
    EXPECT_EQ(c.cameraPosition.y, -2.0F);
    EXPECT_EQ(c.cameraPosition.z, 1.5F);
    EXPECT_TRUE(checkOrigin({1e9, 0.0, 0.0}).ok());
    EXPECT_EQ(checkOrigin({0.0, std::nan(""), 0.0}).error().id, "scene-origin");
}

// Codes of lengths count in metres, except in scenes that are far smaller or larger.
TEST(CameraTest, UnitOfLengthsFollowsTheNearPlane) {
    const auto unitOf = [](float near) {
        CameraView camera;
        camera.near = near;
        gpu::FrameConstants c{};
        fillCamera(camera, {}, 8, 8, {0, 0}, c);
        EXPECT_EQ(c.lengthUnit * c.perLengthUnit, 1.0F);
        return c.lengthUnit;
    };
    for (const float near : {0x1p-10F, 0.01F, 1.0F, 64.0F}) {
        EXPECT_EQ(unitOf(near), 1.0F) << near;
    }
    EXPECT_EQ(unitOf(0x1p-20F), 0x1p-10F);
    EXPECT_EQ(unitOf(0x1p16F), 0x1p10F);
    EXPECT_EQ(unitOf(1e-38F), 0x1p-80F);
    EXPECT_EQ(unitOf(1e38F), 0x1p80F);
}

TEST(CameraTest, FiniteFarPlaneIsDepthZero) {
    CameraView camera;
    camera.near = 0.5F;
    camera.far = 20.0F;
    gpu::FrameConstants c{};
    fillCamera(camera, {}, 8, 8, {0, 0}, c);
    const auto depth = [&](double d) {
        return dot(c.worldToClip[2], {0, 0, -d}) / dot(c.worldToClip[3], {0, 0, -d});
    };
    EXPECT_NEAR(depth(0.5), 1.0, 1e-6);
    EXPECT_NEAR(depth(20.0), 0.0, 1e-6);
    EXPECT_GT(depth(5.0), depth(6.0));
}

TEST(CameraTest, JitterStartsAtTheCentreAndFillsThePixel) {
    EXPECT_EQ(sampleConeScale(0), 1.0F);
    EXPECT_EQ(sampleConeScale(1), 1.0F);
    EXPECT_EQ(sampleConeScale(4), 0.5F);
    EXPECT_EQ(sampleConeScale(64), 0.125F);
    EXPECT_EQ(sampleJitter(0).x, 0.0F);
    EXPECT_EQ(sampleJitter(0).y, 0.0F);
    std::set<int> cells;
    double sum = 0.0;
    for (std::uint32_t i = 0; i < 256; ++i) {
        const gpu::vec2 jitter = sampleJitter(i);
        ASSERT_TRUE(jitter.x >= -0.5F && jitter.x < 0.5F && jitter.y >= -0.5F && jitter.y < 0.5F) << i;
        cells.insert(static_cast<int>((jitter.x + 0.5F) * 8) * 8 + static_cast<int>((jitter.y + 0.5F) * 8));
        sum += jitter.x + jitter.y;
    }
    EXPECT_EQ(cells.size(), 64U);
    EXPECT_NEAR(sum / 512, 0.0, 5e-3);
    // Another seed is another start of the same sequence.
    const gpu::vec2 start = sampleJitter(0, 7);
    EXPECT_NE(start.x, 0.0F);
    EXPECT_NE(start.y, start.x);
    double mean = 0.0;
    for (std::uint32_t i = 0; i < 1000; ++i) {
        const gpu::vec2 jitter = sampleJitter(i, 7);
        EXPECT_GE(jitter.x, -0.5F);
        EXPECT_LT(jitter.x, 0.5F);
        const double turned = double{sampleJitter(i).x} + double{start.x} - double{jitter.x};
        EXPECT_NEAR(turned, std::round(turned), 1e-6);
        mean += double{jitter.x} / 1000.0;
    }
    EXPECT_NEAR(mean, 0.0, 1e-3);
    const gpu::vec2 last = sampleJitter(std::numeric_limits<std::uint32_t>::max());
    EXPECT_TRUE(last.x >= -0.5F && last.x < 0.5F);
}

TEST(CameraTest, UnusableCamerasAreErrors) {
    EXPECT_TRUE(checkCamera({}));
    const auto refused = [](auto change) {
        CameraView camera;
        change(camera);
        return !checkCamera(camera);
    };
    EXPECT_TRUE(refused([](CameraView& c) { c.position[0] = std::nanf(""); }));
    EXPECT_TRUE(refused([](CameraView& c) { c.forward = {0, 0, 0}; }));
    EXPECT_TRUE(refused([](CameraView& c) { c.up = {0, 0, 1}; }));
    EXPECT_TRUE(refused([](CameraView& c) { c.halfWidth = 0; }));
    EXPECT_TRUE(refused([](CameraView& c) { c.halfHeight = -1; }));
    EXPECT_TRUE(refused([](CameraView& c) { c.near = 0; }));
    EXPECT_TRUE(refused([](CameraView& c) { c.far = c.near; }));
    EXPECT_TRUE(refused([](CameraView& c) { c.orthographic = true; }));
}

TEST(InstanceTest, NormalsOfMirroredAndStretchedInstances) {
    // The scale (-2, 3, 4) has cofactors (12, -8, -6), times the sign of the determinant, over 8.
    const gpu::InstanceRecord record = makeInstanceRecord({-2, 0, 0, 5, 0, 3, 0, 6, 0, 0, 4, 7});
    EXPECT_EQ(record.flags, gpu::kInstanceMirrored);
    EXPECT_EQ(record.normalToWorld[0].x, -1.5F);
    EXPECT_EQ(record.normalToWorld[1].y, 1.0F);
    EXPECT_EQ(record.normalToWorld[2].z, 0.75F);
    EXPECT_EQ(record.objectToWorld[1].w, 6.0F);
    EXPECT_EQ(makeInstanceRecord({2, 0, 0, 0, 0, 3, 0, 0, 0, 0, 4, 0}).flags, 0U);
}

TEST(InstanceTest, ExtremeScalesStayFinite) {
    for (const float scale : {1e-18F, 1e-6F, 1e6F, 1e18F}) {
        const Rows rows{scale, 0, 0, 0, 0, scale, 0, 0, 0, 0, -scale, 0};
        EXPECT_TRUE(isInvertible(rows)) << scale;
        const gpu::InstanceRecord record = makeInstanceRecord(rows);
        EXPECT_TRUE(std::isfinite(record.normalToWorld[0].x)) << scale;
        EXPECT_NE(record.normalToWorld[0].x, 0.0F) << scale;
        EXPECT_EQ(record.normalToWorld[0].x, -record.normalToWorld[2].z) << scale;
        EXPECT_EQ(record.flags, gpu::kInstanceMirrored) << scale;
    }
}

TEST(InstanceTest, FlattenedInstancesHaveNoInverse) {
    EXPECT_FALSE(isInvertible({0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}));
    EXPECT_FALSE(isInvertible({1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0}));
    EXPECT_FALSE(isInvertible({1, 1, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0}));
    EXPECT_FALSE(isInvertible({std::nanf(""), 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}));
    EXPECT_TRUE(isInvertible({1, 0, 0, 0, 0, 1e-5F, 0, 0, 0, 0, 1, 0}));
    // The transform is flat along y, and the normal keeps a direction.
    EXPECT_EQ(makeInstanceRecord({1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0}).normalToWorld[1].y, 1.0F);
}

TEST(LightTest, SpotFalloffIsThatOfTheExtension) {
    LightView light;
    light.type = LightView::Type::Spot;
    light.innerConeAngle = 0.3F;
    light.outerConeAngle = 0.6F;
    const gpu::LightRecord record = makeLightRecord(light);
    EXPECT_EQ(record.type, gpu::kLightSpot);
    EXPECT_NEAR(std::cos(0.3F) * record.spotScale + record.spotOffset, 1.0F, 1e-5F);
    EXPECT_NEAR(std::cos(0.6F) * record.spotScale + record.spotOffset, 0.0F, 1e-5F);
    light.innerConeAngle = light.outerConeAngle;
    EXPECT_NEAR(makeLightRecord(light).spotScale, 1000.0F, 1e-2F);
}

// Describes a device that has everything.
void fillReport(DeviceReport& report) {
    report.apiVersion = VK_API_VERSION_1_3;
    for (const char* extension : report.features.extensions) {
        report.extensions.emplace_back(extension);
    }
    report.subgroupStages = VK_SHADER_STAGE_COMPUTE_BIT;
    report.subgroupOperations = VK_SUBGROUP_FEATURE_BALLOT_BIT | VK_SUBGROUP_FEATURE_ARITHMETIC_BIT;
    report.maxPushConstantBytes = 128;
    report.maxWorkgroupThreads = 1024;
    report.hasQueue = true;
}

TEST(RequirementsTest, EachMissingFeatureIsNamed) {
    DeviceReport complete;
    fillReport(complete);
    EXPECT_TRUE(missingFrom(complete).empty());
    const auto missing = [](auto change) {
        DeviceReport report;
        fillReport(report);
        change(report);
        return joinNames(missingFrom(report));
    };
    EXPECT_EQ(missing([](DeviceReport& r) { r.apiVersion = VK_API_VERSION_1_2; }),
              "Vulkan 1.3 (the device has 1.2)");
    // Either tracer is enough.
    EXPECT_EQ(missing([](DeviceReport& r) { r.features.rayQuery.rayQuery = VK_FALSE; }), "");
    EXPECT_EQ(missing([](DeviceReport& r) {
                  std::erase(r.extensions, std::string("VK_KHR_ray_tracing_pipeline"));
              }),
              "");
    EXPECT_EQ(missing([](DeviceReport& r) {
                  r.features.rayQuery.rayQuery = VK_FALSE;
                  r.features.rayPipeline.rayTracingPipelineTraceRaysIndirect = VK_FALSE;
              }),
              "VK_KHR_ray_query (rayQuery) or VK_KHR_ray_tracing_pipeline (rayTracingPipeline and "
              "rayTracingPipelineTraceRaysIndirect)");
    EXPECT_EQ(missing([](DeviceReport& r) {
                  r.features.vulkan12.bufferDeviceAddress = VK_FALSE;
                  r.features.vulkan13.synchronization2 = VK_FALSE;
                  r.features.accelerationStructure.accelerationStructure = VK_FALSE;
              }),
              "bufferDeviceAddress, synchronization2 and accelerationStructure");
    EXPECT_EQ(missing([](DeviceReport& r) { r.extensions.erase(r.extensions.begin() + 1); }),
              "VK_KHR_deferred_host_operations");
    // These are for the modules that need them.
    EXPECT_EQ(missing([](DeviceReport& r) {
                  r.subgroupOperations = 0;
                  r.features.features.features.shaderStorageImageExtendedFormats = VK_FALSE;
                  r.features.vulkan12.runtimeDescriptorArray = VK_FALSE;
              }),
              "");
    EXPECT_EQ(missing([](DeviceReport& r) { r.subgroupStages = 0; }),
              "subgroup operations in compute shaders");
    EXPECT_EQ(missing([](DeviceReport& r) { r.maxWorkgroupThreads = 128; }), "workgroups of 256 threads");
    EXPECT_EQ(missing([](DeviceReport& r) { r.maxPushConstantBytes = 16; }), "24 bytes of push constants");
    EXPECT_EQ(missing([](DeviceReport& r) { r.hasQueue = false; }),
              "a queue family with graphics and compute");
}

// A device that has no bytes in storage buffers runs every package, as Adreno 740 has to.
TEST(RequirementsTest, NoDeviceNeedsWhatOnlySomeModulesNeed) {
    DeviceReport report;
    fillReport(report);
    EXPECT_EQ(report.features.vulkan12.storageBuffer8BitAccess, VK_FALSE);
    EXPECT_EQ(report.features.vulkan11.storageBuffer16BitAccess, VK_FALSE);
    report.features.features.features.shaderStorageImageExtendedFormats = VK_FALSE;
    report.subgroupOperations = VK_SUBGROUP_FEATURE_BALLOT_BIT;
    DeviceRequirements requirements;
    leaveOutLacking(report, requirements);
    EXPECT_EQ(requirements.features.features.shaderStorageImageExtendedFormats, VK_FALSE);
    EXPECT_EQ(requirements.vulkan12.runtimeDescriptorArray, VK_TRUE);
    EXPECT_EQ(requirements.vulkan12.bufferDeviceAddress, VK_TRUE);
    const std::vector<std::string> features = moduleFeatures(report, DeviceHandles{});
    const auto has = [&](const char* name) { return std::ranges::find(features, name) != features.end(); };
    EXPECT_TRUE(has("bufferDeviceAddress") && has("rayQuery") && has("VK_SUBGROUP_FEATURE_BALLOT_BIT"));
    EXPECT_FALSE(has("shaderStorageImageExtendedFormats") || has("rayTracingPipeline") ||
                 has("VK_SUBGROUP_FEATURE_ARITHMETIC_BIT") || has("shaderFloat16"));
}

TEST(RequirementsTest, TracersAreThoseWithEveryFeature) {
    DeviceReport report;
    fillReport(report);
    EXPECT_EQ(tracersOf(report), package::kAllTracers);
    report.features.rayQuery.rayQuery = VK_FALSE;
    EXPECT_EQ(tracersOf(report), package::kTracerRayPipeline);
    report.features.rayPipeline.rayTracingPipeline = VK_FALSE;
    EXPECT_EQ(tracersOf(report), 0U);
}

TEST(RequirementsTest, HalfPrecisionIsEnabledWhereItIsAskedFor) {
    EXPECT_EQ(DeviceRequirements().vulkan12.shaderFloat16, VK_FALSE);
    EXPECT_EQ(DeviceRequirements(package::kAllTracers, false, true).vulkan12.shaderFloat16, VK_TRUE);
}

// Device creation requests nothing for a tracer that was not asked for.
TEST(RequirementsTest, OnlyTheTracersAskedForAreEnabled) {
    const auto enabled = [](std::uint32_t tracers) {
        const DeviceRequirements requirements(tracers);
        std::uint32_t found = 0;
        for (const char* extension : requirements.extensions) {
            found |=
                std::string(extension) == VK_KHR_RAY_QUERY_EXTENSION_NAME ? package::kTracerRayQuery : 0U;
            found |= std::string(extension) == VK_KHR_RAY_TRACING_PIPELINE_EXTENSION_NAME
                         ? package::kTracerRayPipeline
                         : 0U;
        }
        std::uint32_t chained = 0;
        for (const auto* next = static_cast<const VkBaseInStructure*>(requirements.features.pNext);
             next != nullptr; next = next->pNext) {
            chained |= next->sType == requirements.rayQuery.sType ? package::kTracerRayQuery : 0U;
            chained |= next->sType == requirements.rayPipeline.sType ? package::kTracerRayPipeline : 0U;
        }
        EXPECT_EQ(chained, found);
        return found;
    };
    for (const std::uint32_t tracers :
         {std::uint32_t{package::kTracerRayQuery}, std::uint32_t{package::kTracerRayPipeline},
          std::uint32_t{package::kAllTracers}}) {
        EXPECT_EQ(enabled(tracers), tracers);
    }
}

TEST(ErrorTest, CallsAndResultsAreNamed) {
    const Diagnostic error = vulkanError("vkQueueSubmit2", VK_ERROR_DEVICE_LOST);
    EXPECT_EQ(error.id, "vulkan-call");
    EXPECT_EQ(error.message, "vkQueueSubmit2 failed with VK_ERROR_DEVICE_LOST");
    EXPECT_EQ(vulkanResultName(static_cast<VkResult>(-12345)), "VkResult -12345");
}

}  // namespace
}  // namespace glint
