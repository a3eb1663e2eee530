// All settings of a package and of its pictures, as the values of compiler and runtime. Each setting has a
// row in the table of settings/descriptor.h, which gives its name, its text and its help.
#pragma once

#include "settings/compile_settings.h"

#include <glint/renderer_options.h>
#include <glint/scene_view.h>

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glint::compiler {

// The choice whether a picture gets a light that the scene lacks.
enum class Sun : std::uint8_t { Auto, On, Off };
inline constexpr Named<Sun> kSunNames[] = {
    {Sun::Auto, "auto", "only if the scene has no light and there is no --environment"},
    {Sun::On, "on"},
    {Sun::Off, "off"},
};
constexpr std::span<const Named<Sun>> namesOf(Sun /*type*/) {
    return kSunNames;
}

// A request to keep shader IDs from build to build.
struct LockRequest {
    std::string file{};      // empty: they aren't
    bool frozen = false;     // error rather than change the file
    bool prune = false;      // keys that no scene has go
    bool isWritten = false;  // by the command; else the file must be there
};

// The settings that a user asks for. resolve() (resolve/resolve.h) decides those that depend on the scene or
// the device.
struct Settings {
    Settings();  // the settings of `glint render` without options

    CompileSettings compile;
    RendererOptions renderer;
    FrameOptions frame;

    // The strategy of a picture. No value takes the one that should be fastest.
    std::optional<package::Strategy> strategy = package::kDefaultStrategy;
    // A package also gets the strategy that should be fastest, besides compile.strategies.
    bool advisesStrategy = false;
    // The table of `gpu` decides about the member of `compile`, which has the usual value until then.
    bool choosesShadows = false;
    bool choosesPrecision = false;
    double precisionError = 0.0;  // relMSE that the choice of a precision may cost
    // A package that is compiled for pictures has these strategies, too, so that a renderer of one of them
    // can switch to it.
    std::uint32_t furtherStrategies = 0;
    // Layers that a package that is compiled for pictures has besides compile.layers, as a view or a denoiser
    // reads them.
    std::vector<std::string> readLayers{};
    // Hits are counted for a profile, so every key has a case of its own.
    bool countsHits = false;
    std::optional<package::AlphaPolicy> alpha{};  // none: as the scene needs
    Sun sun = Sun::Auto;
    std::optional<double> sky{};       // factor of the default sky's radiance; none: as bright as the lights
    std::uint32_t samples = 1;         // for each pixel
    double lightRadius = 0.0;          // of point and spot lights, metres
    double sunAngle = 0.0;             // angular diameter of directional lights, degrees
    double environmentRotation = 0.0;  // degrees
    TraversalOrder traversalOrder = TraversalOrder::Auto;
    OpacityUse opacity = OpacityUse::Proved;
    VertexForm vertices = VertexForm::Compact;
    bool compressTextures = false;

    // Names and files. They are options of their own, without rows in the table.
    std::string environment;  // a map; empty: a gradient
    std::string camera;       // see session::chooseCamera()
    std::string device;
    std::string package;  // a folder; empty: one is compiled
    std::string profile;  // hit counts, for the merge policies profile and auto
    LockRequest lock{};
    std::string calibration;  // a device file; empty: constants that are built in
    std::string sceneInFile;  // ImportOptions::scene; empty: the file's default
    std::string gpu;          // name or file of a table of a GPU's code, or kThisDevice; empty: none
    std::string variant;      // of KHR_materials_variants; empty: none
    bool strictPaths = false;
    std::vector<std::string> materials;  // folders of packs: material features of a user's own
    std::vector<std::string> packLobes;  // lobes of these that hits keep besides those of compile.plan.keys
    bool validate = false;

    // The names of the settings that have another value than usual because the user gave it.
    std::vector<std::string> given;
};

// The value of Settings::gpu that stands for the device that renders.
inline constexpr std::string_view kThisDevice = "device";

// Returns the lobes that hits keep with "base": the base models, and lobes that are declared as part of the
// base.
materials::FeatureMask baseLobes();

// Parses the whole of `text` as a number within [min, max]. NaN is outside of every range.
bool parseReal(std::string_view text, double min, double max, double& value);
bool parseWhole(std::string_view text, std::int64_t min, std::int64_t max, std::int64_t& value);
// Parses "960x540". Returns false unless it is the size of a picture that can be made.
bool parseSize(std::string_view text, std::uint32_t& width, std::uint32_t& height);
// The value of --merge: a policy, and the file of `POLICY:FILE`, which policies that use hits may name.
struct MergeChoice {
    MergePolicy policy{};
    std::string_view file;
};
std::optional<MergeChoice> parseMerge(std::string_view text);
constexpr bool takesHits(MergePolicy policy) {
    return policy == MergePolicy::Auto || policy == MergePolicy::Profile;
}

// Found by their arguments from other namespaces.
using glint::nameOf;

}  // namespace glint::compiler
