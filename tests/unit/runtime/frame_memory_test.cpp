// The memory of a frame, and the bytes that its passes move, stay within bounds. docs/memory.md states them.
#include "frame/frame_resources.h"
#include "renderer/pipelines.h"

#include <glint/internal/frame_traffic.h>
#include <glint/internal/package_modules.h>
#include <glint/renderer.h>

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace {

using namespace glint;

constexpr std::uint32_t kBuckets = 35;

// A frame as a program draws it that shows each as it comes, with the smallest records. `effects` send rays.
FrameSize realTimeFrame(package::Strategy strategy, std::uint32_t effects, std::uint32_t bands) {
    FrameSize size;
    size.width = 1920;
    size.height = 1080;
    size.bucketCount = kBuckets;
    size.sampleCount = effects;
    size.batchCount = 1;
    size.effects.rays = (1U << effects) - 1U;
    size.effects.screenStarts = 1;
    size.ordered = package::infoOf(strategy).ordersHits;
    size.bucketAlignment = package::infoOf(strategy).fillsWorkgroups ? gpu::kRayGroupSize : 1;
    size.keyBytes = keyBytesOf(kBuckets);
    size.accumulates = false;
    size.halfPicture = true;
    size.packedSamples = true;
    size.hitBytes = 0;
    size.bandRows = chooseBandRows(size, bands);
    return size;
}

double bytesOfPixel(const FrameSize& size) {
    return static_cast<double>(frameBytes(size)) / (static_cast<double>(size.width) * size.height);
}

// The same with records and a picture in full.
FrameSize fullFrame(package::Strategy strategy, std::uint32_t effects, std::uint32_t bands) {
    FrameSize size = realTimeFrame(strategy, effects, bands);
    size.halfPicture = false;
    size.packedSamples = false;
    size.hitBytes = sizeof(gpu::HitRecord);
    return size;
}

// The same with the bands of a device that shares its memory; `shadowRays` of each first hit wait.
FrameSize defaultFrame(package::Strategy strategy, std::uint32_t effects, std::uint32_t shadowRays) {
    FrameSize size = fullFrame(strategy, effects, 1);
    size.firstShadowRays = shadowRays;
    size.firstShadowBytes = shadowRays > 0 ? 28 : 0;
    size.bandRows = chooseBandRows(size, 0);
    return size;
}

TEST(FrameMemory, OfASmallFrameIsThatOfItsRecords) {
    for (const package::Strategy strategy : package::strategies()) {
        EXPECT_LE(bytesOfPixel(realTimeFrame(strategy, 1, 1)), 50.0) << package::infoOf(strategy).name;
        EXPECT_LE(bytesOfPixel(realTimeFrame(strategy, 3, 1)), 97.5) << package::infoOf(strategy).name;
    }
}

TEST(FrameMemory, IsAtMost64BytesAPixelAnd16ForEachFurtherEffect) {
    for (const package::Strategy strategy : package::strategies()) {
        for (std::uint32_t shadowRays = 0; shadowRays <= gpu::kMostFirstShadowRays; ++shadowRays) {
            EXPECT_LE(bytesOfPixel(defaultFrame(strategy, 1, shadowRays)), 64.0)
                << package::infoOf(strategy).name << ", " << shadowRays;
        }
        EXPECT_LE(bytesOfPixel(defaultFrame(strategy, 3, 0)), 96.0) << package::infoOf(strategy).name;
    }
}

// Buffers that nothing needs while shadow rays of first hits wait take no memory beside these rays.
TEST(FrameMemory, OfWaitingShadowRaysIsThatOfTheListAndItsHits) {
    FrameSize size = fullFrame(package::kStrategyVisibility, 1, 1);
    size.firstShadowRays = 2;
    size.firstShadowBytes = 28;
    // The surface, the picture, the depth, whose memory has the pixels' order, the sample, two shadow rays
    // and their number.
    EXPECT_NEAR(bytesOfPixel(size), 8.0 + 16.0 + 4.0 + 48.0 + 2 * 28.0 + 4.0, 0.2);
    size.deferredShadows = true;  // of hits, which need the memory beside the list and the hits
    EXPECT_NEAR(bytesOfPixel(size), 8.0 + 16.0 + 48.0 + 2 * 28.0 + 4.0 + 4.0 + 20.0 + 4.0 + 1.0, 0.2);
}

TEST(FrameMemory, OfTheDepthIsThatOfBuffers) {
    const FrameSize size = realTimeFrame(package::kStrategyUber, 1, 1);
    // The surface and the picture, a sample, its place in the list, which lies where the depth was, and the
    // order of the pixels with their keys.
    EXPECT_NEAR(bytesOfPixel(size), 8.0 + 8.0 + 24.0 + 4.0 + 4.0 + 1.0, 0.1);
}

TEST(FrameBands, CoverTheFrameInWholeTiles) {
    FrameSize size = realTimeFrame(package::kStrategyUber, 1, 7);
    EXPECT_EQ(size.rowsOfBand() % gpu::kPixelGroupSize, 0U);
    EXPECT_GE(size.bandCount() * size.rowsOfBand(), size.height);
    EXPECT_LT((size.bandCount() - 1) * size.rowsOfBand(), size.height);
    EXPECT_EQ(size.roundCount(), size.bandCount());
    // As many as asked for would leave bands without rows.
    size.height = 9;
    size.bandRows = chooseBandRows(size, 7);
    EXPECT_EQ(size.bandCount(), 2U);
    EXPECT_EQ(chooseBandRows(size, 0), 0U);
}

TEST(FrameBands, AreNoSmallerThanAGpuNeeds) {
    FrameSize size = fullFrame(package::kStrategyVisibility, 3, 1);
    EXPECT_EQ(chooseBandRows(size, 0), 272U);
    size.width = 640;
    size.height = 360;
    EXPECT_EQ(chooseBandRows(size, 0), 0U);
}

TEST(FrameBands, AreFewWhereEachHasADispatchForEveryCase) {
    FrameSize size = realTimeFrame(package::kStrategyVisibility, 1, 1);
    size.bucketCount = 257;
    EXPECT_EQ(chooseBandRows(size, 0), 0U);
    size.bucketCount = 33;
    EXPECT_NE(chooseBandRows(size, 0), 0U);
    size.marchesScreen = true;
    EXPECT_EQ(chooseBandRows(size, 4), 0U) << "the march reads every pixel";
}

// Every pixel sends a ray, and every ray hits.
double bytesMoved(TrafficShape shape) {
    shape.bucketCount = kBuckets;
    TrafficCounts counts;
    for (double& count : counts.of) {
        count = shape.effects;
    }
    counts.of[static_cast<std::size_t>(TrafficUnit::Pixel)] = 1.0;
    for (const TrafficUnit none :
         {TrafficUnit::Miss, TrafficUnit::FurtherRay, TrafficUnit::ShadowRay, TrafficUnit::ShadowRound}) {
        counts.of[static_cast<std::size_t>(none)] = 0.0;
    }
    const TrafficSum sum = sumTraffic(trafficRows(shape), counts);
    return sum.read + sum.written;
}

TEST(FrameTraffic, IsWithinItsBounds) {
    TrafficShape shape;
    shape.effects = 1;
    EXPECT_LE(bytesMoved(shape), 285.0);
    shape.strategy = package::kStrategyUber;
    EXPECT_LE(bytesMoved(shape), 218.0);
    shape.strategy = package::kStrategyVisibility;
    shape.hitRecord = package::HitRecordFormat::Packed;
    EXPECT_LE(bytesMoved(shape), 269.0);
    shape.hitRecord = package::HitRecordFormat::Full;
    shape.sampleRecord = package::SampleRecordFormat::Packed;
    EXPECT_LE(bytesMoved(shape), 249.0);
    shape.hitsInSamples = true;
    shape.halfPicture = true;
    EXPECT_LE(bytesMoved(shape), 220.0);
    shape.halfPicture = false;
    shape.effects = 0;
    EXPECT_EQ(bytesMoved(shape), 12.0 + 5.0 + 5.0 + 28.0 + 32.0)
        << "visibility and depth, the order of the pixels, light, and the picture";
}

TEST(FrameTraffic, HasTheShadowRaysOfFirstHits) {
    TrafficShape shape;
    shape.effects = 1;
    const double before = bytesMoved(shape);
    shape.firstShadowBytes = 28;
    // Each ray is written and read. Each pixel's count is, too, and its surface and light are read again.
    EXPECT_EQ(bytesMoved(shape), before + 2 * 28.0 + 2 * 4.0 + 8.0 + 2 * 16.0);

    Renderer::Counters counters;
    counters.pixelCounts = {3, 7};
    counters.shadowRounds = 3;
    Renderer::EffectCounters shadow;
    shadow.kind = package::EffectInfo::Kind::Light;
    shadow.rays = 20;  // of hits, too
    shadow.waited = 12;
    counters.effects = {shadow};
    const TrafficCounts counts = trafficCounts(counters, shape, 10.0);
    EXPECT_EQ(counts[TrafficUnit::Surface], 7.0);
    EXPECT_EQ(counts[TrafficUnit::FirstShadowRay], 12.0);
    EXPECT_EQ(counts[TrafficUnit::ShadowRound], 20.0);
}

TEST(FrameTraffic, GrowsWithWhatAFrameDoes) {
    TrafficShape plain;
    plain.effects = 1;
    for (bool TrafficShape::*const member :
         {&TrafficShape::paths, &TrafficShape::emissiveLights, &TrafficShape::skyLight,
          &TrafficShape::accumulates, &TrafficShape::marchesScreen, &TrafficShape::binsRays}) {
        TrafficShape more = plain;
        more.*member = true;
        EXPECT_GT(bytesMoved(more), bytesMoved(plain));
    }
}

}  // namespace
