// The settings that a bench may change: all that decide how exact a picture is or how it is made, with the
// values worth trying on a scene and a device.
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace glint::measure {

// Values by the name of their setting, which is the name of the command-line option without its dashes. The
// configuration of a point holds only what differs from the default.
using Configuration = std::map<std::string, std::string, std::less<>>;

// The stage at which a setting is decided.
enum class Stage { Compile, Render };

// The facts about scene and device on which the values worth trying depend.
struct Facts {
    bool masks = false;         // some materials have an alpha mask
    bool furtherLobes = false;  // hits of some materials lose a lobe with --hit-lobes base
    bool textures = false;
    bool sizedLights = false;  // some light casts soft shadows
    bool rayPipeline = false;  // this and the next two are features of the device
    bool positionFetch = false;
    bool float16 = false;
    std::set<std::string, std::less<>> effects;  // effects of the default configuration, by name
    // The luminance that the picture's exposure maps to white, in the scene's units; 0 if unknown.
    double white = 0.0;
};

struct SkippedValue {
    std::string value;
    std::string reason;
};

struct Setting {
    std::string name;
    std::string_view what;
    Stage stage = Stage::Render;
    bool approximates = false;        // false if it changes time alone
    std::string base;                 // the value in the default configuration
    std::vector<std::string> values;  // the values worth trying, including `base`, in their natural order
    std::vector<SkippedValue> skipped;
};

// Returns the names of all settings, in the order of settingsFor().
std::vector<std::string> settingNames();

Stage stageOf(std::string_view name);

// Returns the settings for which `base`, the default configuration, has a value. With `quick` they have fewer
// values.
std::vector<Setting> settingsFor(const Facts& facts, const Configuration& base, bool quick);

// Returns the configuration of the reference: every approximation is off, and other settings keep their
// value.
Configuration exactValues(const Facts& facts);

// Returns `configuration`, to be applied over `base`, without values that have no effect: an ordering if
// nothing is ordered, and values that equal those of `base`.
Configuration simplified(const Configuration& configuration, const Configuration& base);

// Returns the value of a setting at a point: its own, or that of `base`.
const std::string& valueOf(std::string_view name, const Configuration& configuration,
                           const Configuration& base);

// Returns "spp 4, ssr 16", or "default" for an empty configuration.
std::string nameOf(const Configuration& configuration);

}  // namespace glint::measure
