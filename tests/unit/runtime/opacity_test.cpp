// The states of triangles and micro-triangles against a device's arithmetic, and the layout of micromaps.
#include "alpha_check.h"
#include "support/nightly.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <mutex>
#include <set>
#include <thread>

namespace glint::test {
namespace {

using opacity::AlphaLookup;
using opacity::AlphaMaterial;
using opacity::AlphaTexels;
using opacity::AlphaTriangle;
using opacity::ErrorModel;
using opacity::MicromapArray;
using opacity::MicroTriangle;
using opacity::State;
using opacity::TriangleStates;

MicromapArray arrayOf(const AlphaCase& given, std::uint32_t maxLevel, const ErrorModel& model = {}) {
    AlphaMaterial material = given.material;
    if (material.lookup) {
        material.lookup->texels = &given.texels;
    }
    std::vector<TriangleStates> states;
    for (const AlphaTriangle& triangle : given.triangles) {
        states.push_back(opacity::statesOf(material, triangle, maxLevel, 2.0, model));
    }
    return opacity::packMicromaps(states);
}

// A nearest lookup of one texel everywhere.
AlphaCase constantCase(std::uint8_t texel, bool linear, float cutoff) {
    AlphaCase made;
    made.texels = {1, 1, {texel}};
    made.material.cutoff = cutoff;
    made.material.lookup = AlphaLookup{};
    made.material.lookup->linear = linear;
    made.triangles.push_back({{{{0.1F, 0.1F}, {0.4F, 0.1F}, {0.1F, 0.4F}}}, {}});
    return made;
}

std::size_t wrongIn(const AlphaCase& given, const MicromapArray& array) {
    CheckedStates checked;
    checkStates(given, array, {}, checked);
    return checked.wrong.size();
}

TEST(OpacityMicromap, TheCurveIsThatOfTheReference) {
    for (std::uint32_t level = 0; level <= opacity::kMaxLevel; ++level) {
        const std::uint32_t steps = 1U << level;
        std::set<std::uint32_t> places;
        for (std::uint32_t v = 0; v < steps; ++v) {
            for (std::uint32_t u = 0; u + v < steps; ++u) {
                for (const bool inverted : {false, true}) {
                    if (inverted && u + v + 1 >= steps) {
                        continue;
                    }
                    const MicroTriangle micro{u, v, inverted};
                    const std::uint32_t place = opacity::curveIndex(micro, level);
                    places.insert(place);
                    const float third = inverted ? 2.0F / 3.0F : 1.0F / 3.0F;
                    EXPECT_EQ(
                        microTriangleAt((static_cast<float>(u) + third) / static_cast<float>(steps),
                                        (static_cast<float>(v) + third) / static_cast<float>(steps), level),
                        micro);
                    if (level > 0) {
                        // The four parts of a micro-triangle follow each other.
                        const MicroTriangle parent = microTriangleAt(
                            (static_cast<float>(u) + third) / static_cast<float>(steps),
                            (static_cast<float>(v) + third) / static_cast<float>(steps), level - 1);
                        EXPECT_EQ(place / 4, opacity::curveIndex(parent, level - 1));
                    }
                }
            }
        }
        EXPECT_EQ(places.size(), opacity::microTriangles(level));
        EXPECT_EQ(*places.rbegin(), opacity::microTriangles(level) - 1);
    }
    // The curve begins at corner 0, goes to corner 2 through the middle and ends at corner 1.
    EXPECT_EQ(opacity::curveIndex({0, 0, false}, 1), 0U);
    EXPECT_EQ(opacity::curveIndex({0, 0, true}, 1), 1U);
    EXPECT_EQ(opacity::curveIndex({1, 0, false}, 1), 2U);
    EXPECT_EQ(opacity::curveIndex({0, 1, false}, 1), 3U);
}

TEST(OpacityMicromap, PacksStatesAndSharesRecords) {
    const State o = State::Opaque;
    const State t = State::Transparent;
    const State x = State::UnknownOpaque;
    const std::vector<TriangleStates> triangles{{1, {o, t, t, o}}, {0, {o}},          {1, {o, t, x, o}},
                                                {1, {o, t, t, o}}, {1, {t, t, t, t}}, {0, {x}}};
    const MicromapArray array = opacity::packMicromaps(triangles);
    EXPECT_EQ(array.indices, (std::vector<std::int32_t>{0, -2, 1, 0, -1, -4}));
    ASSERT_EQ(array.records.size(), 2U);
    EXPECT_EQ(array.records[0], (opacity::MicromapRecord{0, 1, opacity::kTwoStates}));
    EXPECT_EQ(array.records[1], (opacity::MicromapRecord{1, 1, opacity::kFourStates}));
    EXPECT_EQ(array.data, (std::vector<std::uint8_t>{0b1001, 0b01110001}));
    EXPECT_EQ(array.usages, (std::vector<opacity::MicromapUsage>{{1, 1, 1}, {1, 1, 2}}));
    EXPECT_EQ(opacity::usagesOf(array), (std::vector<opacity::MicromapUsage>{{2, 1, 1}, {1, 1, 2}}));
    EXPECT_EQ(faultIn(array, 6), std::nullopt);
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        for (std::uint32_t place = 0; place < triangles[i].states.size(); ++place) {
            EXPECT_EQ(stateAt(array, i, place, triangles[i].level), triangles[i].states[place]);
        }
    }
}

TEST(OpacityMicromap, FindsFaultsOfArrays) {
    const MicromapArray good = opacity::packMicromaps(
        std::vector<TriangleStates>{{1, {State::Opaque, State::Transparent, State::Opaque, State::Opaque}},
                                    {1, {State::Transparent, State::Opaque, State::Opaque, State::Opaque}}});
    ASSERT_EQ(faultIn(good, 6), std::nullopt);
    EXPECT_NE(faultIn(good, 0), std::nullopt);
    const auto faulty = [&](auto&& damage) {
        MicromapArray array = good;
        damage(array);
        return faultIn(array, 6).has_value();
    };
    EXPECT_TRUE(faulty([](MicromapArray& array) { array.records[0].format = 3; }));
    EXPECT_TRUE(faulty([](MicromapArray& array) { array.records[1].dataOffset = 0; }));
    EXPECT_TRUE(faulty([](MicromapArray& array) { array.records[1].dataOffset = 0xFFFFFFFF; }));
    EXPECT_TRUE(faulty([](MicromapArray& array) { array.indices[0] = 2; }));
    EXPECT_TRUE(faulty([](MicromapArray& array) { array.indices[0] = -5; }));
    EXPECT_TRUE(faulty([](MicromapArray& array) { array.usages[0].count = 1; }));
}

// Ten million micro-triangles in the nightly run, in which no state may contradict the device.
TEST(AlphaStates, AreRightForEveryMicroTriangle) {
    const std::uint64_t wanted = nightly() ? 10'000'000 : 30'000;
    std::atomic<std::uint64_t> next{0};
    std::atomic<std::uint64_t> done{0};
    std::mutex mutex;
    CheckedStates all;
    const auto work = [&] {
        while (done < wanted) {
            const AlphaCase given = makeAlphaCase(next++);
            const MicromapArray array = arrayOf(given, opacity::kMaxLevel);
            EXPECT_EQ(faultIn(array, opacity::kMaxLevel), std::nullopt);
            CheckedStates checked;
            checkStates(given, array, {}, checked);
            EXPECT_TRUE(checked.wrong.empty())
                << given.name << ", triangle " << checked.wrong[0].triangle << ", micro-triangle "
                << checked.wrong[0].place << " of level " << checked.wrong[0].level << ", alpha "
                << checked.wrong[0].alpha << ", cutoff " << given.material.cutoff;
            done += checked.microTriangles;
            const std::scoped_lock lock(mutex);
            all.microTriangles += checked.microTriangles;
            all.known += checked.known;
            all.opaque += checked.opaque;
            all.needless += checked.needless;
        }
    };
    std::thread helper(work);
    work();
    helper.join();
    // Numbers for docs/alpha.md.
    RecordProperty("microTriangles", std::to_string(all.microTriangles));
    std::printf("%llu micro-triangles, %llu known, %llu opaque; %llu unknown ones look uniform\n",
                static_cast<unsigned long long>(all.microTriangles),
                static_cast<unsigned long long>(all.known), static_cast<unsigned long long>(all.opaque),
                static_cast<unsigned long long>(all.needless));
    EXPECT_GE(all.microTriangles, wanted);
    // The states say something: many are known, of both kinds.
    EXPECT_GT(all.known, all.microTriangles / 3);
    EXPECT_GT(all.opaque, all.known / 10);
    EXPECT_LT(all.opaque, all.known * 9 / 10);
}

TEST(AlphaStates, AreKnownWhereTheAnswerIsPlain) {
    EXPECT_EQ(opacity::stateOf({1.0F, 0.5F, {}}, {}), State::Opaque);
    EXPECT_EQ(opacity::stateOf({0.4F, 0.5F, {}}, {}), State::Transparent);
    for (const bool linear : {false, true}) {
        AlphaCase given = constantCase(200, linear, 0.5F);
        EXPECT_EQ(arrayOf(given, 6).indices[0], opacity::specialIndex(State::Opaque));
        given.texels.alpha = {0};
        EXPECT_EQ(arrayOf(given, 6).indices[0], opacity::specialIndex(State::Transparent));
        // Nothing is below a cutoff of 0.
        given.material.cutoff = 0.0F;
        EXPECT_EQ(arrayOf(given, 6).indices[0], opacity::specialIndex(State::Opaque));
    }
}

// A triangle in the lower half of a texture whose upper half is transparent. Its box reaches the other half,
// its footprint does not.
TEST(AlphaStates, FollowTheTriangleAndNotItsBox) {
    AlphaCase given;
    given.texels = {64, 64, std::vector<std::uint8_t>(64 * 64)};
    for (std::uint32_t y = 0; y < 64; ++y) {
        for (std::uint32_t x = 0; x < 64; ++x) {
            given.texels.alpha[64 * y + x] = x + y < 60 ? 255 : 0;
        }
    }
    given.material.lookup = AlphaLookup{};
    given.triangles = {{{{{0.1F, 0.1F}, {0.8F, 0.1F}, {0.1F, 0.8F}}}, {}},
                       {{{{0.95F, 0.1F}, {0.95F, 0.95F}, {0.1F, 0.95F}}}, {}}};
    const MicromapArray array = arrayOf(given, 6);
    EXPECT_EQ(array.indices, (std::vector<std::int32_t>{-2, -1}));
}

TEST(AlphaStates, APlantedSwapOfAStateIsFound) {
    for (std::uint64_t number = 0, planted = 0; planted < 20; ++number) {
        ASSERT_LT(number, 2000U);
        const AlphaCase given = makeAlphaCase(number);
        MicromapArray array = arrayOf(given, 4);
        // Any known state of a record, inverted.
        for (std::size_t i = 0; i < array.records.size(); ++i) {
            const opacity::MicromapRecord& record = array.records[i];
            const std::uint32_t place =
                static_cast<std::uint32_t>(number) % opacity::microTriangles(record.subdivisionLevel);
            const std::size_t bit = std::size_t{place} * record.format;
            std::uint8_t& byte = array.data[record.dataOffset + bit / 8];
            if (record.format == opacity::kFourStates && ((byte >> (bit % 8)) & 2) != 0) {
                continue;
            }
            byte = static_cast<std::uint8_t>(byte ^ (1U << (bit % 8)));
            EXPECT_GT(wrongIn(given, array), 0U) << given.name;
            ++planted;
            break;
        }
    }
}

// A texel whose conversion may come out one unit lower than its number, at a cutoff of that number.
TEST(AlphaStates, ABoundThatIsTooNarrowByOneUnitIsFound) {
    const auto number = static_cast<float>(100 / 255.0);
    const AlphaCase nearest = constantCase(100, false, number);
    EXPECT_EQ(wrongIn(nearest, arrayOf(nearest, 0)), 0U);
    ErrorModel narrow;
    narrow.conversionUlps = 0;
    EXPECT_GT(wrongIn(nearest, arrayOf(nearest, 0, narrow)), 0U);

    AlphaCase scaled = constantCase(255, false, 0.3F);
    scaled.material.factor = 0.3F;
    scaled.triangles[0].vertexAlpha = {0.75F, 0.75F, 0.75F};
    narrow = {};
    narrow.vertexAlpha = 0.0;
    narrow.outside = 0.0;
    const opacity::AlphaBounds exact = opacity::boundsOf(scaled.material, 255, 255, {0.75F, 0.75F}, narrow);
    scaled.material.cutoff = std::nextafter(exact.least, 1.0F);
    EXPECT_EQ(wrongIn(scaled, arrayOf(scaled, 0)), 0U);
    narrow.productUlps = 0;
    EXPECT_GT(wrongIn(scaled, arrayOf(scaled, 0, narrow)), 0U);

    // The cutoff is one unit above the least value that a filter may give.
    AlphaCase linear = constantCase(100, true, 0.0F);
    const opacity::AlphaBounds bounds = opacity::boundsOf(linear.material, 100, 100, {1.0F, 1.0F}, {});
    linear.material.cutoff = bounds.least;
    EXPECT_EQ(arrayOf(linear, 0).indices[0], opacity::specialIndex(State::Opaque));
    EXPECT_EQ(wrongIn(linear, arrayOf(linear, 0)), 0U);
    linear.material.cutoff = std::nextafter(std::nextafter(bounds.least, 1.0F), 1.0F);
    EXPECT_FALSE(arrayOf(linear, 0).indices[0] == opacity::specialIndex(State::Opaque));
    narrow = {};
    narrow.filter -= 2.0 * (std::nextafter(bounds.least, 1.0F) - bounds.least);
    EXPECT_EQ(arrayOf(linear, 0, narrow).indices[0], opacity::specialIndex(State::Opaque));
    EXPECT_GT(wrongIn(linear, arrayOf(linear, 0, narrow)), 0U);
}

// A triangle one texel short of a border, by less than a lookup may be off.
TEST(AlphaStates, AReachThatIsTooShortIsFound) {
    AlphaCase given;
    given.texels = {2, 1, {255, 0}};
    given.material.lookup = AlphaLookup{};
    given.material.lookup->linear = false;
    given.material.lookup->wrapU = opacity::Wrap::Clamp;
    const float border = 0.5F - 0.9F / 32.0F;  // 0.9 / 16 of a texel
    given.triangles = {{{{{0.1F, 0.1F}, {border, 0.5F}, {0.1F, 0.9F}}}, {}}};
    EXPECT_EQ(wrongIn(given, arrayOf(given, 0)), 0U);
    ErrorModel narrow;
    narrow.texelPosition = 0.5 / 16.0;
    EXPECT_GT(wrongIn(given, arrayOf(given, 0, narrow)), 0U);
}

}  // namespace
}  // namespace glint::test
