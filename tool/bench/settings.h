// What a bench may change: every setting of how exact a picture is, or of how it is made, with the values
// worth trying on a scene and a device.
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace glint::bench {

// Values by the name of their setting, which is that of the command line's option without its dashes. Of a
// point only what differs from the default.
using Configuration = std::map<std::string, std::string, std::less<>>;

// When a setting is decided.
enum class Stage { Compile, Render };

// What the values worth trying depend on.
struct Facts {
    bool masks = false;         // materials with an alpha mask
    bool furtherLobes = false;  // materials whose hits lose a lobe with --hit-lobes base
    bool textures = false;
    bool sizedLights = false;  // a light that casts soft shadows
    bool rayPipeline = false;  // of the device, as are the next two
    bool positionFetch = false;
    bool float16 = false;
    std::set<std::string, std::less<>> effects;  // of the default configuration, by name
    // Luminance that the picture's exposure brings to white, in the scene's units; 0: not known.
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
    bool approximates = false;        // else it changes time alone
    std::string base;                 // value of the default configuration
    std::vector<std::string> values;  // worth trying, `base` among them, in their natural order
    std::vector<SkippedValue> skipped;
};

// The names of all of them, in the order in which settingsFor() has them.
std::vector<std::string> settingNames();

Stage stageOf(std::string_view name);

// `base`: the default configuration; settings that it has no value for are left out. With `quick` fewer
// values.
std::vector<Setting> settingsFor(const Facts& facts, const Configuration& base, bool quick);

// What every approximation is in the reference: off. Others keep their value.
Configuration exactValues(const Facts& facts);

// `configuration` without what has no effect beside the rest of it, over `base`: an ordering where nothing is
// ordered, values that are those of `base`.
Configuration simplified(const Configuration& configuration, const Configuration& base);

// The value that a point has, its own or that of `base`.
const std::string& valueOf(std::string_view name, const Configuration& configuration,
                           const Configuration& base);

// "spp 4, ssr 16"; "default" for nothing.
std::string nameOf(const Configuration& configuration);

}  // namespace glint::bench
