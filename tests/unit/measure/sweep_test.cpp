#include <glint/measure/sweep.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace glint::measure {
namespace {

measure::Setting setting(const std::string& name, std::vector<std::string> values, bool approximates) {
    measure::Setting made;
    made.name = name;
    made.base = values.front();
    made.values = std::move(values);
    made.approximates = approximates;
    return made;
}

const std::vector<measure::Setting> kSettings{
    setting("spp", {"1", "2", "4", "8"}, true), setting("ssr", {"off", "16"}, true),
    setting("texture-lod", {"cones", "mip0"}, true), setting("strategy", {"visibility", "uber"}, false)};
const compiler::Configuration kBase{
    {"spp", "1"}, {"ssr", "off"}, {"texture-lod", "cones"}, {"strategy", "visibility"}};

// A model world in which times multiply and errors add, within the noise of samples.
measure::Rated measured(const compiler::Configuration& configuration) {
    const auto value = [&](const char* name) { return valueOf(name, configuration, kBase); };
    const double samples = std::stod(value("spp"));
    measure::Rated point;
    point.configuration = configuration;
    point.time = samples * (value("ssr") == "16" ? 0.7 : 1.0) * (value("texture-lod") == "mip0" ? 1.2 : 1.0) *
                 (value("strategy") == "uber" ? 0.9 : 1.0);
    point.error =
        0.1 / samples + (value("ssr") == "16" ? 0.003 : 0.0) + (value("texture-lod") == "mip0" ? 0.0 : 0.02);
    return point;
}

std::vector<measure::Rated> measuredSingles() {
    std::vector<measure::Rated> points{measured({})};
    for (const compiler::Configuration& configuration : singles(kSettings, kBase)) {
        points.push_back(measured(configuration));
    }
    return points;
}

TEST(Sweep, SinglesAreEachValueAlone) {
    const std::vector<compiler::Configuration> all = singles(kSettings, kBase);
    EXPECT_EQ(all.size(), 6U);
    for (const compiler::Configuration& one : all) {
        EXPECT_EQ(one.size(), 1U);
    }
}

TEST(Sweep, PairsAreOfTwoAndDistinct) {
    const std::vector<compiler::Configuration> all = pairs(kSettings, kBase, false);
    EXPECT_FALSE(all.empty());
    EXPECT_EQ(std::set<compiler::Configuration>(all.begin(), all.end()).size(), all.size());
    for (const compiler::Configuration& one : all) {
        EXPECT_EQ(one.size(), 2U);
    }
    EXPECT_LT(pairs(kSettings, kBase, true).size(), all.size());
}

TEST(ParetoFront, LeavesOutWhatIsBeaten) {
    const std::vector<measure::Rated> points{{{}, 3, 3}, {{}, 1, 5}, {{}, 2, 5}, {{}, 4, 1},
                                             {{}, 4, 1}, {{}, 5, 2}, {{}, 1, 6}};
    EXPECT_EQ(paretoFront(points), (std::vector<std::size_t>{1, 0, 3}));
    EXPECT_TRUE(paretoFront({}).empty());
}

// The dominating points of all combinations must be found.
TEST(Proposals, FindTheFrontOfASeparableWorld) {
    std::vector<measure::Rated> known = measuredSingles();
    for (int round = 0; round < 3; ++round) {
        for (const compiler::Configuration& configuration : proposals(kSettings, kBase, known, 8)) {
            known.push_back(measured(configuration));
        }
    }
    std::vector<measure::Rated> all;
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
    const auto front = [](const std::vector<measure::Rated>& points) {
        std::set<compiler::Configuration> configurations;
        for (const std::size_t i : paretoFront(points)) {
            configurations.insert(points[i].configuration);
        }
        return configurations;
    };
    EXPECT_EQ(front(known), front(all));
    EXPECT_LT(known.size(), all.size());
}

TEST(Proposals, AreNewAndFew) {
    const std::vector<measure::Rated> known = measuredSingles();
    const std::vector<compiler::Configuration> proposed = proposals(kSettings, kBase, known, 3);
    EXPECT_LE(proposed.size(), 3U);
    EXPECT_FALSE(proposed.empty());
    for (const compiler::Configuration& configuration : proposed) {
        EXPECT_TRUE(std::ranges::none_of(
            known, [&](const measure::Rated& point) { return point.configuration == configuration; }));
    }
}

// A value that differs only by noise, below the default in both, must not count as better.
TEST(Proposals, DoNotFollowTies) {
    std::vector<measure::Rated> known{measured({})};
    measure::Rated noise = measured({});
    noise.configuration = {{"ssr", "16"}};
    noise.time *= 0.9;
    noise.error *= 0.9;
    noise.timeTie = noise.errorTie = true;
    known.push_back(noise);
    measure::Rated more = measured({{"spp", "2"}});
    known.push_back(more);
    for (const compiler::Configuration& configuration : proposals(kSettings, kBase, known, 8)) {
        EXPECT_FALSE(configuration.contains("ssr")) << nameOf(configuration);
    }
}

}  // namespace
}  // namespace glint::measure
