#include "settings/descriptor.h"

#include <glint/measure/settings.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace glint::measure {
namespace {

compiler::Configuration usual() {
    return {{"spp", "4"},
            {"shadow-spp", "1"},
            {"ao-spp", "4"},
            {"effects", "auto"},
            {"max-roughness", "0.3"},
            {"mirror-roughness", "0.05"},
            {"skip-below", "0"},
            {"clamp", "0"},
            {"ssr", "off"},
            {"max-interfaces", "8"},
            {"bounces", "1"},
            {"hit-lobes", "all"},
            {"lights", "auto"},
            {"energy-compensation", "on"},
            {"texture-lod", "cones"},
            {"alpha", "opaque"},
            {"shadow-through", "alpha"},
            {"emissive-lights", "off"},
            {"sky-light", "off"},
            {"sized-lights", "off"},
            {"precision", "32"},
            {"hit-record", "full"},
            {"sample-record", "full"},
            {"strategy", "visibility"},
            {"merge", "family"},
            {"shadows", "inline"},
            {"position-fetch", "off"},
            {"optimize", "on"},
            {"ordering", "auto"},
            {"binning", "none"},
            {"batch-effects", "off"},
            {"bands", "0"},
            {"vertices", "compact"},
            {"compress-textures", "off"}};
}

compiler::BenchFacts rich() {
    compiler::BenchFacts facts;
    facts.masks = facts.furtherLobes = facts.textures = facts.manyLights = facts.sizedLights = true;
    facts.passesLight = facts.emits = facts.lightsMayEmit = facts.skyMayLight = facts.sizedMayShow = true;
    facts.rayPipeline = facts.positionFetch = facts.float16 = facts.packsTextures = true;
    facts.effects = {"shadow", "reflection", "refraction", "ambient-occlusion"};
    facts.effectsOfAnyRoughness = facts.effects;
    facts.sendsRays = true;
    facts.punctualLights = true;
    facts.lights = 1000;
    facts.rayEffects = "auto,indirect-diffuse";
    facts.fullTransport = true;
    facts.white = 2.0;
    return facts;
}

const measure::Setting& named(const std::vector<measure::Setting>& settings, std::string_view name) {
    return *std::ranges::find(settings, name, &measure::Setting::name);
}

TEST(BenchSettings, AreAllThereAndHaveTheirDefault) {
    for (const bool quick : {false, true}) {
        const std::vector<measure::Setting> settings = settingsFor(rich(), usual(), quick);
        EXPECT_EQ(settings.size(), compiler::settingNames().size());
        for (const measure::Setting& setting : settings) {
            EXPECT_EQ(std::ranges::count(setting.values, setting.base), 1) << setting.name;
            EXPECT_GT(setting.values.size(), 1U) << setting.name;
            EXPECT_TRUE(setting.skipped.empty()) << setting.name;
            EXPECT_FALSE(setting.what.empty()) << setting.name;
        }
    }
}

TEST(BenchSettings, TryEveryOrdering) {
    const std::vector<measure::Setting> settings = settingsFor(rich(), usual(), false);
    std::vector<std::string> names{"auto"};
    for (const Named<package::Ordering>& ordering : package::kOrderingNames) {
        names.emplace_back(ordering.name);
    }
    EXPECT_EQ(named(settings, "ordering").values, names);
}

TEST(BenchSettings, KeepADefaultOfTheirOwnInItsPlace) {
    compiler::Configuration base = usual();
    base["spp"] = "6";
    base["ssr"] = "12";
    const std::vector<measure::Setting> settings = settingsFor(rich(), base, false);
    EXPECT_EQ(named(settings, "spp").values,
              (std::vector<std::string>{"1", "2", "4", "6", "8", "16", "32", "64"}));
    EXPECT_EQ(named(settings, "ssr").values, (std::vector<std::string>{"off", "8", "12", "16", "32", "64"}));
    // A word may be the largest value.
    base["bounces"] = "3";
    base["lights"] = "3";
    const std::vector<measure::Setting> words = settingsFor(rich(), base, false);
    EXPECT_EQ(named(words, "bounces").values,
              (std::vector<std::string>{"1", "2", "3", "4", "8", "unlimited"}));
    EXPECT_EQ(named(words, "lights").values,
              (std::vector<std::string>{"auto", "all", "1", "2", "3", "4", "8", "16", "32", "64"}));
}

TEST(BenchSettings, LeaveOutWhatASceneOrDeviceLacksAndSayWhy) {
    compiler::BenchFacts facts;
    facts.effects = {"shadow"};
    const std::vector<measure::Setting> settings = settingsFor(facts, usual(), false);
    for (const char* const name : {"shadow-spp", "lights", "ao-spp", "max-roughness", "ssr", "max-interfaces",
                                   "hit-lobes", "texture-lod", "alpha", "precision", "strategy", "ordering",
                                   "binning", "position-fetch", "clamp", "bounces"}) {
        const measure::Setting& setting = named(settings, name);
        EXPECT_EQ(setting.values, std::vector<std::string>{setting.base}) << name;
        EXPECT_TRUE(std::ranges::none_of(setting.skipped, [](const measure::SkippedValue& value) {
            return value.reason.empty();
        })) << name;
    }
    EXPECT_GT(named(settings, "spp").values.size(), 1U);
}

TEST(BenchSettings, TryEffectsWithoutEachOfThem) {
    compiler::BenchFacts facts = rich();
    facts.effects = {"reflection", "shadow"};
    facts.fullTransport = false;
    EXPECT_EQ(named(settingsFor(facts, usual(), true), "effects").values,
              (std::vector<std::string>{"auto", "shadow", "reflection"}));
    facts.effects = {"shadow"};
    EXPECT_EQ(named(settingsFor(facts, usual(), true), "effects").values,
              (std::vector<std::string>{"auto", "none"}));
    // The reference has further ones.
    facts.fullTransport = true;
    const measure::Setting effects = named(settingsFor(facts, usual(), true), "effects");
    EXPECT_EQ(effects.values, (std::vector<std::string>{"auto", "auto,indirect-diffuse", "none"}));
    EXPECT_EQ(effects.exact, "auto,indirect-diffuse");
}

// A hierarchy over as many lights as it chooses, or with none but directional ones, changes nothing.
TEST(BenchSettings, TryFewerLightsThanThereAre) {
    compiler::BenchFacts facts = rich();
    facts.manyLights = false;
    facts.lights = 5;
    EXPECT_EQ(named(settingsFor(facts, usual(), false), "lights").values,
              (std::vector<std::string>{"auto", "1", "2", "4"}));
    facts.lights = 1;
    const measure::Setting none = named(settingsFor(facts, usual(), false), "lights");
    EXPECT_EQ(none.values, std::vector<std::string>{"auto"});
    EXPECT_FALSE(hasExactValue(none));
}

// The exact value is tried even if the quick values lack it.
TEST(BenchSettings, TryTheValuesOfTheReference) {
    for (const bool quick : {false, true}) {
        const std::vector<measure::Setting> settings = settingsFor(rich(), usual(), quick);
        for (const char* const name : {"bounces", "max-interfaces", "mirror-roughness", "max-roughness"}) {
            EXPECT_TRUE(hasExactValue(named(settings, name))) << name;
        }
        EXPECT_EQ(named(settings, "max-interfaces").values.back(), "64");
        EXPECT_EQ(named(settings, "mirror-roughness").values.front(), "0");
        EXPECT_FALSE(hasExactValue(named(settings, "spp")));
        EXPECT_FALSE(hasExactValue(named(settings, "strategy")));
    }
    // Rough surfaces that send no ray by default may send one with a higher limit.
    compiler::BenchFacts rough = rich();
    rough.effects = {"shadow"};
    EXPECT_TRUE(hasExactValue(named(settingsFor(rough, usual(), true), "max-roughness")));
    rough.effectsOfAnyRoughness = rough.effects;
    EXPECT_FALSE(hasExactValue(named(settingsFor(rough, usual(), true), "max-roughness")));
}

TEST(BenchSettings, ScaleTheClampByWhite) {
    EXPECT_EQ(named(settingsFor(rich(), usual(), false), "clamp").values,
              (std::vector<std::string>{"0", "32", "8", "2"}));
}

TEST(BenchSettings, OfTheReferenceApproximateNothing) {
    const compiler::Configuration exact = exactValues(rich());
    EXPECT_EQ(exact.at("texture-lod"), "mip0");
    EXPECT_EQ(exact.at("hit-lobes"), "all");
    EXPECT_EQ(exact.at("alpha"), "stochastic");
    EXPECT_EQ(exact.at("max-roughness"), "1");
    EXPECT_EQ(exact.at("ssr"), "off");
    EXPECT_EQ(exact.at("bounces"), "unlimited");
    EXPECT_EQ(exact.at("lights"), "auto");
    EXPECT_EQ(exact.at("effects"), "auto,indirect-diffuse");
    EXPECT_FALSE(exact.contains("strategy"));
    EXPECT_FALSE(exact.contains("spp"));
    compiler::BenchFacts still = rich();
    still.effects = {"shadow"};
    EXPECT_EQ(exactValues(still).at("max-roughness"), "1");
    // A reference with the default's transport keeps what decides how light travels, and calls for no effect.
    still.fullTransport = false;
    const compiler::Configuration same = exactValues(still);
    EXPECT_FALSE(same.contains("bounces"));
    EXPECT_FALSE(same.contains("effects"));
    EXPECT_FALSE(same.contains("max-roughness"));
    EXPECT_EQ(same.at("texture-lod"), "mip0");
}

// Light of lights that paths can't find passes glass on straight lines. Paths find all other light
// themselves.
TEST(BenchSettings, OfTheReferencePassGlassStraightForPunctualLightsAlone) {
    compiler::BenchFacts facts = rich();
    EXPECT_EQ(exactValues(facts).at("shadow-through"), "glass");
    facts.punctualLights = false;
    EXPECT_EQ(exactValues(facts).at("shadow-through"), "alpha");
    facts.fullTransport = false;
    EXPECT_EQ(exactValues(facts).at("shadow-through"), "glass");
}

TEST(BenchSettings, DropWhatHasNoEffectBesideOthers) {
    const compiler::Configuration base = usual();
    EXPECT_EQ(simplified({{"spp", "4"}, {"ssr", "16"}}, base), (compiler::Configuration{{"ssr", "16"}}));
    EXPECT_EQ(simplified({{"strategy", "uber"}, {"ordering", "wave-loop"}, {"hit-record", "packed"}}, base),
              (compiler::Configuration{{"strategy", "uber"}}));
    EXPECT_EQ(simplified({{"position-fetch", "on"}}, base), compiler::Configuration{});
    EXPECT_EQ(nameOf({{"ssr", "16"}, {"spp", "8"}}), "spp 8, ssr 16");
    EXPECT_EQ(nameOf(compiler::Configuration{}), "default");
}

}  // namespace
}  // namespace glint::measure
