// Documents and schemas name the settings and the values that the program has. GLINT_UPDATE_DOCUMENTS=1 in
// the environment writes the table into docs/cli.md instead of comparing it.
#include "base/text.h"
#include "settings/descriptor.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace glint {
namespace {

using Json = nlohmann::json;

const std::string kDocument = GLINT_SOURCE_DIR "/docs/cli.md";
constexpr std::string_view kBegin = "<!-- settings: begin -->\n";
constexpr std::string_view kEnd = "<!-- settings: end -->\n";

std::string readText(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

std::string commandsOf(const compiler::Descriptor& row) {
    std::vector<std::string_view> names;
    if ((row.commands & compiler::kOfCompile) != 0) {
        names.emplace_back("`compile`");
    }
    if ((row.commands & compiler::kOfExplain) != 0) {
        names.emplace_back("`explain`");
    }
    if ((row.commands & compiler::kOfRender) != 0) {
        names.emplace_back("`render`");
        names.emplace_back("`view`");
        names.emplace_back("`bench`");
    }
    return fmt::format("{}", fmt::join(names, ", "));
}

std::string valuesOf(const compiler::Descriptor& row) {
    const compiler::SettingValues& values = row.values;
    std::vector<std::string> parts;
    const bool isPlain = values.form == compiler::ValueForm::Switch;
    for (const compiler::SettingWord& word :
         isPlain ? std::vector<compiler::SettingWord>{{"on", ""}, {"off", ""}} : wordsOf(row)) {
        parts.push_back("`" + (isSwitch(row) ? optionWords(row, word.name).front() : word.name) + "`");
    }
    if (values.form == compiler::ValueForm::Whole || values.form == compiler::ValueForm::Real) {
        parts.push_back(
            fmt::format("{} to {}", compiler::boundText(values.min), compiler::boundText(values.max)));
    } else if (values.form == compiler::ValueForm::Text) {
        parts.push_back("`" + std::string(values.type) + "`");
    } else if (!values.further.empty()) {
        parts.emplace_back(values.further);
    }
    return (values.form == compiler::ValueForm::List ? "list of " : "") +
           fmt::format("{}", fmt::join(parts, ", "));
}

std::string stageOf(const compiler::Descriptor& row) {
    switch (row.stage) {
        case compiler::SettingStage::Package:
            return "package";
        case compiler::SettingStage::Choice:
            return "package, then renderer";
        case compiler::SettingStage::Scene:
            return "scene";
        case compiler::SettingStage::Renderer:
            return "renderer";
        case compiler::SettingStage::Frame:
            break;
    }
    return "frame";
}

std::string referenceOf(const compiler::SettingBench& bench) {
    if (bench.use != compiler::BenchUse::Swept) {
        return "";
    }
    return !bench.exact ? "changes time alone"
           : bench.exact->empty()
               ? "as given"
               : fmt::format("`{}`{}", *bench.exact,
                             bench.isTransport ? "; as given with `--reference same`" : "");
}

std::string triedOf(const compiler::SettingBench& bench) {
    if (bench.use != compiler::BenchUse::Swept) {
        return "";
    }
    if (bench.triedFor != nullptr) {
        return "depends on the scene";
    }
    const std::string all = bench.tried.empty() ? "all" : std::string(bench.tried);
    return bench.quick.empty() ? all : fmt::format("{} (quick: {})", all, bench.quick);
}

std::string sentencesOf(const compiler::Descriptor& row) {
    std::string text(row.what);
    text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
    text += ".";
    for (const compiler::SettingWord& word : wordsOf(row)) {
        if (!word.what.empty()) {
            text += fmt::format(" `{}`: {}.", isSwitch(row) ? optionWords(row, word.name).front() : word.name,
                                word.what);
        }
    }
    if (!row.document.empty()) {
        const bool isOwn = row.document.starts_with("cli.md#");
        text += isOwn ? fmt::format(" More is [below]({}).", row.document.substr(6))
                      : fmt::format(" More is in [{}]({}).", row.document.substr(0, row.document.find('#')),
                                    row.document);
    }
    return text;
}

std::string tableOfSettings() {
    std::string text =
        "| option | of | values | default | decided for | in the reference | the bench tries | |\n"
        "|---|---|---|---|---|---|---|---|\n";
    for (const compiler::Descriptor& row : compiler::settingsTable()) {
        text += fmt::format("| `--{}` | {} | {} | `{}` | {} | {} | {} | {} |\n", row.name, commandsOf(row),
                            valuesOf(row), row.values.text(compiler::Settings()), stageOf(row),
                            referenceOf(row.bench), triedOf(row.bench), sentencesOf(row));
    }
    return text;
}

TEST(DocumentedSettings, AreThoseOfTheTable) {
    const std::string document = readText(kDocument);
    const std::size_t begin = document.find(kBegin);
    const std::size_t end = document.find(kEnd);
    ASSERT_TRUE(begin < end && end != std::string::npos) << "the table's place is missing";
    const std::size_t first = begin + kBegin.size();
    const std::string table = tableOfSettings();
    if (std::getenv("GLINT_UPDATE_DOCUMENTS") != nullptr) {
        std::ofstream(kDocument, std::ios::binary)
            << document.substr(0, first) << table << document.substr(end);
        return;
    }
    EXPECT_EQ(document.substr(first, end - first), table)
        << "write it anew: GLINT_UPDATE_DOCUMENTS=1 ctest -R DocumentedSettings";
}

TEST(DocumentedSettings, LeadToHeadingsThatExist) {
    for (const compiler::Descriptor& row : compiler::settingsTable()) {
        const std::string_view file = row.document.substr(0, row.document.find('#'));
        if (file.empty()) {
            continue;
        }
        const std::string text = readText(GLINT_SOURCE_DIR "/docs/" + std::string(file));
        EXPECT_FALSE(text.empty()) << row.document;
        if (file.size() == row.document.size()) {
            continue;
        }
        std::set<std::string> anchors;
        std::istringstream lines(text);
        for (std::string line; std::getline(lines, line);) {
            if (!line.starts_with('#')) {
                continue;
            }
            std::string anchor;
            for (const char c : line.substr(line.find(' ') + 1)) {
                const auto byte = static_cast<unsigned char>(c);
                anchor += c == ' ' ? "-"
                          : std::isalnum(byte) != 0 || c == '-'
                              ? std::string(1, static_cast<char>(std::tolower(byte)))
                              : "";
            }
            anchors.insert(anchor);
        }
        EXPECT_TRUE(anchors.contains(std::string(row.document.substr(file.size() + 1)))) << row.document;
    }
}

template <typename Value>
std::set<std::string> namesOfAll() {
    std::set<std::string> names;
    for (const Named<Value>& one : namesOf(Value{})) {
        names.emplace(one.name);
    }
    return names;
}

// The enumerations of schemas, by the member whose values they list.
const std::map<std::string, std::set<std::string>, std::less<>>& enumerations() {
    static const std::map<std::string, std::set<std::string>, std::less<>> kEnumerations{
        {"strategy", namesOfAll<package::Strategy>()},
        {"strategies", namesOfAll<package::Strategy>()},
        {"fastest", namesOfAll<package::Strategy>()},
        {"tracer", namesOfAll<package::Tracer>()},
        {"tracers", namesOfAll<package::Tracer>()},
        {"ordering", namesOfAll<package::Ordering>()},
        {"shadows", namesOfAll<package::ShadowPlacement>()},
        {"shadowThrough", namesOfAll<package::ShadowThrough>()},
        {"hitRecord", namesOfAll<package::HitRecordFormat>()},
        {"sampleRecord", namesOfAll<package::SampleRecordFormat>()},
        {"textureLod", namesOfAll<compiler::TextureLod>()},
        {"merge", namesOfAll<compiler::MergePolicy>()},
        {"alpha", namesOfAll<package::AlphaPolicy>()}};
    return kEnumerations;
}

// Compares the enumerations below `schema`, which describes the member `name`, and counts them in `found`.
void compareEnumerations(const Json& schema, const std::string& name, const std::string& file,
                         std::map<std::string, int>& found) {
    if (schema.is_array()) {
        for (const Json& element : schema) {
            compareEnumerations(element, name, file, found);
        }
    }
    if (!schema.is_object()) {
        return;
    }
    const auto expected = enumerations().find(name);
    if (schema.contains("enum") && schema["enum"].is_array() && expected != enumerations().end()) {
        std::set<std::string> values;
        for (const Json& value : schema["enum"]) {
            if (value.is_string()) {
                values.insert(value.get<std::string>());
            }
        }
        EXPECT_EQ(values, expected->second) << file << ": " << name;
        ++found[name];
    }
    for (const auto& [key, value] : schema.items()) {
        const bool hasMembers = key == "properties" || key == "definitions";
        if (!hasMembers) {
            compareEnumerations(value, name, file, found);
            continue;
        }
        for (const auto& [member, description] : value.items()) {
            compareEnumerations(description, member, file, found);
        }
    }
}

TEST(Schemas, EnumerateTheValuesOfSettings) {
    std::map<std::string, int> found;
    for (const auto& entry : std::filesystem::directory_iterator(GLINT_SOURCE_DIR "/docs/schemas")) {
        compareEnumerations(Json::parse(readText(entry.path().string())), "",
                            entry.path().filename().string(), found);
    }
    for (const char* const name :
         {"strategy", "strategies", "fastest", "tracer", "tracers", "shadows", "shadowThrough", "hitRecord",
          "sampleRecord", "textureLod", "merge", "alpha"}) {
        EXPECT_GE(found[name], 1) << name;
    }
}

// The manifest has no other settings than those that its schema describes.
TEST(Schemas, DescribeTheSettingsOfAManifest) {
    const Json schema = Json::parse(readText(GLINT_SOURCE_DIR "/docs/schemas/common.json"));
    std::set<std::string> described;
    for (const auto& [name, description] : schema.at("definitions").at("settings").at("properties").items()) {
        described.insert(name);
    }
    std::size_t recorded = 2;  // hitLobes and sky
    for (const compiler::Descriptor& row : compiler::settingsTable()) {
        recorded += row.recorded ? 1 : 0;
        std::string name;
        for (const char c : row.name) {
            name += !name.empty() && name.back() == '-' ? static_cast<char>(std::toupper(c)) : c;
            if (name.size() > 1 && name[name.size() - 2] == '-') {
                name.erase(name.size() - 2, 1);
            }
        }
        EXPECT_TRUE(!row.recorded || described.contains(name)) << name;
    }
    EXPECT_EQ(described.size(), recorded);
}

}  // namespace
}  // namespace glint
