// The table of settings agrees with itself: each value that it names is one, and is kept.
#include "settings/descriptor.h"

#include <gtest/gtest.h>

#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace glint {
namespace {

std::vector<std::string> valuesIn(std::string_view text) {
    std::istringstream words{std::string(text)};
    std::vector<std::string> values;
    for (std::string value; words >> value;) {
        values.push_back(value);
    }
    return values;
}

// Returns the text of a setting after it was given.
std::string kept(const compiler::Descriptor& row, std::string_view text) {
    compiler::Settings settings;
    row.values.set(settings, text);
    return row.values.text(settings);
}

TEST(SettingsTable, HasARowForEachOptionOfACommand) {
    std::set<std::pair<std::uint32_t, std::string_view>> options;
    for (const compiler::Descriptor& row : compiler::settingsTable()) {
        EXPECT_NE(row.commands, 0U) << row.name;
        EXPECT_FALSE(row.group.empty()) << row.name;
        EXPECT_FALSE(row.what.empty() || row.what.ends_with('.')) << row.name;
        for (const std::uint32_t command :
             {compiler::kOfCompile, compiler::kOfExplain, compiler::kOfRender}) {
            if ((row.commands & command) != 0) {
                EXPECT_TRUE(options.emplace(command, row.name).second) << row.name;
            }
        }
        const bool isSwept = row.bench.use == compiler::BenchUse::Swept;
        EXPECT_EQ(isSwept ? compiler::sweptSetting(row.name) : nullptr, isSwept ? &row : nullptr) << row.name;
    }
}

TEST(SettingsTable, KeepsEachValueThatItNames) {
    for (const compiler::Descriptor& row : compiler::settingsTable()) {
        SCOPED_TRACE(row.name);
        const std::string usual = row.values.text(compiler::Settings());
        EXPECT_EQ(kept(row, usual), usual);
        std::vector<std::string> values = valuesIn(row.bench.tried);
        for (const std::string& value : valuesIn(row.bench.quick)) {
            values.push_back(value);
        }
        if (row.bench.exact && !row.bench.exact->empty()) {
            values.emplace_back(*row.bench.exact);
        }
        for (const compiler::SettingWord& word : wordsOf(row)) {
            values.push_back(word.name);
        }
        for (const std::string& value : values) {
            // The words of a list are checked one by one.
            std::istringstream words(value);
            for (std::string word; std::getline(words, word, ',');) {
                EXPECT_EQ(complaintAbout(row, word), "") << value;
            }
            // "all" and "base" may be written as what they stand for.
            const bool isList = row.values.form == compiler::ValueForm::List;
            EXPECT_EQ(isList ? kept(row, kept(row, value)) : kept(row, value),
                      isList ? kept(row, value) : value);
        }
    }
}

TEST(SettingsTable, KeepsDifferentWordsApart) {
    for (const compiler::Descriptor& row : compiler::settingsTable()) {
        std::set<std::string> texts;
        const bool isWord = row.values.form == compiler::ValueForm::Word;
        for (const compiler::SettingWord& word : wordsOf(row)) {
            EXPECT_TRUE(texts.insert(kept(row, word.name)).second || !isWord) << row.name << " " << word.name;
        }
    }
}

TEST(SettingsTable, RefusesNumbersOutsideOfTheRangeAndOtherText) {
    for (const compiler::Descriptor& row : compiler::settingsTable()) {
        if (row.values.form == compiler::ValueForm::Whole || row.values.form == compiler::ValueForm::Real) {
            EXPECT_EQ(complaintAbout(row, compiler::boundText(row.values.min)), "") << row.name;
            EXPECT_EQ(complaintAbout(row, compiler::boundText(row.values.max)), "") << row.name;
            EXPECT_NE(complaintAbout(row, std::to_string(row.values.min - 1.0)), "") << row.name;
            EXPECT_NE(complaintAbout(row, std::to_string(row.values.max * 2.0 + 1.0)), "") << row.name;
            EXPECT_NE(complaintAbout(row, "nan"), "") << row.name;
        }
        EXPECT_NE(complaintAbout(row, "no value"), "") << row.name;
        EXPECT_NE(complaintAbout(row, ""), "") << row.name;
    }
}

TEST(SettingsTable, WritesBoundsShortly) {
    EXPECT_EQ(compiler::boundText(0.0), "0");
    EXPECT_EQ(compiler::boundText(0.5), "0.5");
    EXPECT_EQ(compiler::boundText(-360.0), "-360");
    EXPECT_EQ(compiler::boundText(1000000.0), "1000000");
    EXPECT_EQ(compiler::boundText(4294967295.0), "4294967295");
    EXPECT_EQ(compiler::boundText(1e9), "1e9");
}

TEST(Configurations, AreTheSettingsThatABenchSweeps) {
    const compiler::Configuration usual = configurationOf(compiler::Settings());
    EXPECT_EQ(usual.size(), compiler::settingNames().size());
    EXPECT_EQ(usual.at("spp"), "1");
    EXPECT_EQ(usual.at("clamp"), "0");
    EXPECT_EQ(usual.at("hit-lobes"), "all");
    const compiler::Settings changed = compiler::withSettings(
        {}, {{"spp", "4"}, {"clamp", "2.5"}, {"effects", "none"}, {"ordering", "tile-sort"}});
    EXPECT_EQ(changed.samples, 4U);
    EXPECT_EQ(changed.frame.maxSampleRadiance, 2.5F);
    EXPECT_EQ(changed.compile.effects.named, 0U);
    EXPECT_FALSE(changed.compile.effects.automatic);
    EXPECT_EQ(changed.renderer.ordering, package::Ordering::TileSort);
    EXPECT_EQ(compiler::wordsOf(
                  compiler::Configuration{{"position-fetch", "on"}, {"batch-effects", "off"}, {"ssr", "8"}}),
              (std::vector<std::string>{"--ssr", "8", "--position-fetch", "--no-batch-effects"}));
}

}  // namespace
}  // namespace glint
