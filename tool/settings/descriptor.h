// The table of settings: the description of each, and values by name.
#pragma once

#include "settings/settings.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glint::compiler {

// Values by the name of their setting, which is the name of the command-line option without its dashes. The
// configuration of a point of a bench holds only the values that differ from the default.
using Configuration = std::map<std::string, std::string, std::less<>>;

// The facts about scene and device on which the values worth trying depend.
struct BenchFacts {
    bool masks = false;          // some materials have the alpha mode MASK or BLEND
    bool passesLight = false;    // some materials are glass, or have the alpha mode BLEND
    bool emits = false;          // some triangles emit light
    bool lightsMayEmit = false;  // and packages with the default's effects can have them as lights
    bool skyMayLight = false;    // packages with the default's effects can have the sky as a light
    bool sizedMayShow = false;   // rays of packages with the default's effects can find area lights
    bool bouncesLight = false;   // something is a light in packages for several bounces alone
    bool furtherLobes = false;   // hits of some materials lose a lobe with --hit-lobes base
    bool textures = false;
    bool placedLights = false;       // the picture has point or spot lights
    bool directionalLights = false;  // the picture has directional lights, or a sun
    bool packsTextures = true;       // the device reads BC formats, and this program packs them
    bool punctualLights = false;  // the picture has punctual lights or a sun, which no path finds by itself
    std::size_t lights = 0;       // with a position, of which the default's hierarchy chooses
    bool manyLights = false;      // more than --lights auto takes whole
    bool sizedLights = false;     // some light casts soft shadows
    bool rayPipeline = false;     // this and the next two are features of the device
    bool positionFetch = false;
    bool float16 = false;
    std::set<std::string, std::less<>> effects;  // effects of the default configuration, by name
    bool sendsRays = false;                      // one of them has rays whose hits are shaded
    // True if the reference has all of light transport, even if the default leaves parts out.
    bool fullTransport = false;
    // The value of --effects with which surfaces send rays in all directions that light comes from.
    std::string rayEffects;
    // The effects that the default configuration would have with --max-roughness 1.
    std::set<std::string, std::less<>> effectsOfAnyRoughness;
    // The luminance that the picture's exposure maps to white, in the scene's units; 0 if unknown.
    double white = 0.0;
};

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
// Returns why the setting of that name changes nothing: the default configuration lacks all effects that have
// it. Returns an empty text if it may change something.
std::string withoutEffect(std::string_view setting, const BenchFacts& facts);
// Returns why the setting of a row changes nothing in pictures of the configuration `base`, whatever its
// value. Returns an empty text if it may change something.
std::string idleReason(const Descriptor& row, const BenchFacts& facts, const Configuration& base);
// Returns "\"fast\" is none of on, off", or an empty text for a value. A list is checked word by word.
std::string complaintAbout(const Descriptor& row, std::string_view text);
// Returns a bound of a range: "0.5", "1e9".
std::string boundText(double bound);

// The table of settings. The options of the command line with their help, their checks and their completion,
// files of settings, the sweeps of a bench, the settings in a manifest and the table in docs/cli.md follow
// from it.

// Rows of the same name have no command in common.
std::span<const Descriptor> settingsTable();
// Returns the row that a bench sweeps; null for other names.
const Descriptor* sweptSetting(std::string_view name);

// --- Settings by name, as command lines, files and a bench's points have them ---

// Returns the names of the settings that a bench sweeps, in the order of the table.
std::vector<std::string> settingNames();
// Returns the value of every setting of settingNames().
Configuration configurationOf(const Settings& settings);
// Returns `settings` with the values of `configuration`, which must be valid.
Settings withSettings(Settings settings, const Configuration& configuration);
// Returns the words of a command line: {"--spp", "4"}.
std::vector<std::string> wordsOf(const Configuration& configuration);

}  // namespace glint::compiler
