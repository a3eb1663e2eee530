#include <glint/measure/sweep.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace glint::measure {
namespace {

Setting setting(const std::string& name, std::vector<std::string> values, bool approximates) {
    Setting made;
    made.name = name;
    made.base = values.front();
    made.values = std::move(values);
    made.approximates = approximates;
    return made;
}

const std::vector<Setting> kSettings{
    setting("spp", {"1", "2", "4", "8"}, true), setting("ssr", {"off", "16"}, true),
    setting("texture-lod", {"cones", "mip0"}, true), setting("strategy", {"visibility", "uber"}, false)};
const Configuration kBase{{"spp", "1"}, {"ssr", "off"}, {"texture-lod", "cones"}, {"strategy", "visibility"}};

// A model world in which times multiply and errors add, within the noise of samples.
Rated measured(const Configuration& configuration) {
    const auto value = [&](const char* name) { return valueOf(name, configuration, kBase); };
    const double samples = std::stod(value("spp"));
    Rated point;
    point.configuration = configuration;
    point.time = samples * (value("ssr") == "16" ? 0.7 : 1.0) * (value("texture-lod") == "mip0" ? 1.2 : 1.0) *
                 (value("strategy") == "uber" ? 0.9 : 1.0);
    point.error =
        0.1 / samples + (value("ssr") == "16" ? 0.003 : 0.0) + (value("texture-lod") == "mip0" ? 0.0 : 0.02);
    return point;
}

std::vector<Rated> measuredSingles() {
    std::vector<Rated> points{measured({})};
    for (const Configuration& configuration : singles(kSettings, kBase)) {
        points.push_back(measured(configuration));
    }
    return points;
}

TEST(Sweep, SinglesAreEachValueAlone) {
    const std::vector<Configuration> all = singles(kSettings, kBase);
    EXPECT_EQ(all.size(), 6U);
    for (const Configuration& one : all) {
        EXPECT_EQ(one.size(), 1U);
    }
}

TEST(Sweep, PairsAreOfTwoAndDistinct) {
    const std::vector<Configuration> all = pairs(kSettings, kBase, false);
    EXPECT_FALSE(all.empty());
    EXPECT_EQ(std::set<Configuration>(all.begin(), all.end()).size(), all.size());
    for (const Configuration& one : all) {
        EXPECT_EQ(one.size(), 2U);
    }
    EXPECT_LT(pairs(kSettings, kBase, true).size(), all.size());
}

TEST(ParetoFront, LeavesOutWhatIsBeaten) {
    const std::vector<Rated> points{{{}, 3, 3}, {{}, 1, 5}, {{}, 2, 5}, {{}, 4, 1},
                                    {{}, 4, 1}, {{}, 5, 2}, {{}, 1, 6}};
    EXPECT_EQ(paretoFront(points), (std::vector<std::size_t>{1, 0, 3}));
    EXPECT_TRUE(paretoFront({}).empty());
}

// The dominating points of all combinations must be found.
TEST(Proposals, FindTheFrontOfASeparableWorld) {
    std::vector<Rated> known = measuredSingles();
    for (int round = 0; round < 3; ++round) {
        for (const Configuration& configuration : proposals(kSettings, kBase, known, 8)) {
            known.push_back(measured(configuration));
        }
    }
    std::vector<Rated> all;
    for (const char* spp : {"1", "2", "4", "8"}) {
        for (const char* ssr : {"off", "16"}) {
            for (const char* lod : {"cones", "mip0"}) {
                for (const char* strategy : {"visibility", "uber"}) {
                    all.push_back(measured(simplified(
                        {{"spp", spp}, {"ssr", ssr}, {"texture-lod", lod}, {"strategy", strategy}}, kBase)));
                }
            }
        }
    }
    const auto front = [](const std::vector<Rated>& points) {
        std::set<Configuration> configurations;
        for (const std::size_t i : paretoFront(points)) {
            configurations.insert(points[i].configuration);
        }
        return configurations;
    };
    EXPECT_EQ(front(known), front(all));
    EXPECT_LT(known.size(), all.size());
}

TEST(Proposals, AreNewAndFew) {
    const std::vector<Rated> known = measuredSingles();
    const std::vector<Configuration> proposed = proposals(kSettings, kBase, known, 3);
    EXPECT_LE(proposed.size(), 3U);
    EXPECT_FALSE(proposed.empty());
    for (const Configuration& configuration : proposed) {
        EXPECT_TRUE(std::ranges::none_of(
            known, [&](const Rated& point) { return point.configuration == configuration; }));
    }
}

// A value that differs only by noise, below the default in both, must not count as better.
TEST(Proposals, DoNotFollowTies) {
    std::vector<Rated> known{measured({})};
    Rated noise = measured({});
    noise.configuration = {{"ssr", "16"}};
    noise.time *= 0.9;
    noise.error *= 0.9;
    noise.timeTie = noise.errorTie = true;
    known.push_back(noise);
    Rated more = measured({{"spp", "2"}});
    known.push_back(more);
    for (const Configuration& configuration : proposals(kSettings, kBase, known, 8)) {
        EXPECT_FALSE(configuration.contains("ssr")) << nameOf(configuration);
    }
}

}  // namespace
}  // namespace glint::measure
