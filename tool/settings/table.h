// The table of settings. The options of the command line with their help, their checks and their completion,
// files of settings, the sweeps of a bench, the settings in a manifest and the table in docs/cli.md follow
// from it.
#pragma once

#include "settings/configuration.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glint::compiler {

// The stage at which a setting is decided.
enum class SettingStage : std::uint8_t {
    Package,   // when shaders are compiled: another value needs another package
    Choice,    // a package may have several values, from which a renderer chooses one
    Scene,     // when a scene is uploaded
    Renderer,  // when a renderer is made
    Frame,     // for each frame
};

// The commands that have a setting as an option, as bits of a set.
enum SettingCommand : std::uint32_t {
    kOfCompile = 1,
    kOfExplain = 2,
    kOfRender = 4,  // also view and bench, which make pictures in the same way
};

enum class ValueForm : std::uint8_t {
    Switch,  // on or off
    Word,    // one of the words
    List,    // words, separated by commas
    Whole,   // a number within the range, or one of the words
    Real,
    Text,  // text that `further` accepts
};

struct SettingWord {
    std::string name;
    std::string what;  // may be empty
};

// The values of a setting, and where they are kept.
struct SettingValues {
    ValueForm form = ValueForm::Switch;
    std::string (*text)(const Settings& settings) = nullptr;
    // `text` is a value for which complaintAbout() has no complaint.
    void (*set)(Settings& settings, std::string_view text) = nullptr;
    std::vector<SettingWord> (*words)() = nullptr;  // null: none
    double min = 0.0;                               // the range of numbers
    double max = 0.0;
    std::string_view automatic{};  // the meaning of the word "auto"
    std::string_view type{};       // of the value, for help; empty: the words, N or X
    // Text values besides words and numbers, and their description: "size such as 960x540".
    bool (*accepts)(std::string_view text) = nullptr;
    std::string_view further{};
};

enum class BenchUse : std::uint8_t {
    Swept,  // other values are tried
    View,   // the same in all points, and part of their commands
    None,   // decides about no picture
};

struct SettingBench {
    BenchUse use = BenchUse::View;
    // The value in the reference. It is empty for the default's value, because the user asks for that value
    // or all values converge to the same picture. It is absent if the setting changes time alone.
    std::optional<std::string_view> exact{};
    // True if the value changes how much light is transported, not only how exactly. A reference that shares
    // the default's transport (BenchFacts::fullTransport) has the default's value.
    bool isTransport = false;
    std::string_view tried{};  // values, separated by blanks; empty: all words
    std::string_view quick{};  // fewer values; empty: `tried`
    // Returns why a value is not worth trying, or the whole setting if `value` is empty. Returns an empty
    // text if it is worth trying. Null: always worth it.
    std::string (*against)(std::string_view value, const BenchFacts& facts,
                           const Configuration& base) = nullptr;
    // Returns the values if they depend on the scene; null if not.
    std::vector<std::string> (*triedFor)(const BenchFacts& facts, const std::string& base,
                                         bool quick) = nullptr;
    // Returns the exact value if it depends on the scene; null if not.
    std::string (*exactFor)(const BenchFacts& facts) = nullptr;
};

struct Descriptor {
    std::string_view name;  // of the option, without its dashes
    std::uint32_t commands = 0;
    SettingStage stage = SettingStage::Frame;
    std::string_view group;  // of options in the help
    std::string_view what;   // a sentence without a full stop
    SettingValues values;
    SettingBench bench{};
    std::string_view document{};  // says more: "reflections.md#ray-binning"
    bool recorded = false;        // a member of the manifest's `settings`
    // Returns why the setting changes nothing in pictures of the configuration `base`, or an empty text.
    // Null: the reasons are the absence of all effects that have it, and those of bench.against for all
    // values.
    std::string (*idle)(const BenchFacts& facts, const Configuration& base) = nullptr;
};

// Rows of the same name have no command in common.
std::span<const Descriptor> settingsTable();
// Returns the row that a bench sweeps; null for other names.
const Descriptor* sweptSetting(std::string_view name);
// Returns whether `glint compile` has the setting.
constexpr bool isCompiled(const Descriptor& row) {
    return row.stage == SettingStage::Package || row.stage == SettingStage::Choice;
}

std::vector<SettingWord> wordsOf(const Descriptor& row);
// Returns whether the values are on, off and perhaps auto. On the command line these are --x, --no-x and
// --x=auto.
bool isSwitch(const Descriptor& row);
// Returns the words that give the setting a value on a command line.
std::vector<std::string> optionWords(const Descriptor& row, const std::string& value);
// Returns why the setting of a row changes nothing: the default configuration lacks all effects that have it.
// Returns an empty text if it may change something.
std::string withoutEffect(const Descriptor& row, const BenchFacts& facts);
// Returns why the setting of a row changes nothing in pictures of the configuration `base`, whatever its
// value. Returns an empty text if it may change something.
std::string idleReason(const Descriptor& row, const BenchFacts& facts, const Configuration& base);
// Returns "\"fast\" is none of on, off", or an empty text for a value. A list is checked word by word.
std::string complaintAbout(const Descriptor& row, std::string_view text);
// Returns a bound of a range: "0.5", "1e9".
std::string boundText(double bound);

}  // namespace glint::compiler
