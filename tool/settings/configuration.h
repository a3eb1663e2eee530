// Settings by name, as command lines, files and a bench's points have them.
#pragma once

#include "settings/settings.h"

#include <map>
#include <set>
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

// Returns the names of the settings that a bench sweeps, in the order of the table.
std::vector<std::string> settingNames();
// Returns the value of every setting of settingNames().
Configuration configurationOf(const Settings& settings);
// Returns `settings` with the values of `configuration`, which must be valid.
Settings withSettings(Settings settings, const Configuration& configuration);
// Returns the words of a command line: {"--spp", "4"}.
std::vector<std::string> wordsOf(const Configuration& configuration);

}  // namespace glint::compiler
