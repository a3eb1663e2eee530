// The layers of a frame: images beside the picture, such as depth, motion, albedo and the light of each
// effect, for denoisers, compositing and debug views. docs/layers.md describes each of them.
//
// layerTable() is their only declaration. The words of --layers, the code of a package, the images of a
// renderer, the bytes of --stats and the channels of OpenEXR files follow from its rows.
#pragma once

#include <glint/package_shape.h>

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glint::package {

// Bounces beyond this number share the layers of the last one.
inline constexpr std::uint32_t kMostLayerBounces = 4;

// A row of the table.
struct LayerInfo {
    // The storage format of a layer's values.
    enum class Format : std::uint32_t {
        Float1,   // one 32-bit float
        Float4,   // four
        Half4,    // four 16-bit floats
        Snorm4,   // four 16-bit numbers from -1 to 1
        Integer,  // one 32-bit number without a sign
    };

    struct FormatInfo {
        Format format{};
        std::uint32_t bytes = 0;     // of a pixel
        std::string_view qualifier;  // of the image in GLSL: "rgba32f"
        std::uint32_t components = 0;
    };

    // The subject of a layer, which decides how many images of it a package may have.
    enum class Subject : std::uint32_t {
        Surface,  // the primary surface: one image
        Light,    // light that leaves the primary surface: an image for the direct light and for each effect
                  // with rays
        Ray,      // the end of an effect's ray: an image for each effect with rays
        Bounce,   // light of a bounce of its paths: an image for each such effect and bounce, where there are
                  // several
        Work,     // the work of all passes for the pixel: one image
    };

    // The pass that writes a layer.
    enum class Pass : std::uint32_t {
        FirstHits,
        Compose,
        Several,  // first hits begin it, and the passes whose work it counts add to it
    };

    // The combination of a picture's samples into one value.
    enum class Mean : std::uint32_t {
        First,  // the layer is that of the picture's first sample
        Mean,   // it is the mean over the samples, as the picture is
        Sum,    // it is the sum over the samples
    };

    // The needs of a layer beside its image, as bits of a set.
    enum Demand : std::uint32_t {
        kHistory = 1,  // camera, transforms and deformed vertices of the previous frame
        kRays = 2,     // the hits of effects' rays
        kClock = 4,    // shaders read a clock: DeviceHandles::shaderClock
        kQueries = 8,  // rays are traced by ray queries alone
    };

    // A layer of a package, in tables.bin.
    struct Entry {
        std::uint32_t layer = 0;   // number
        Effect effect = 0;         // of layers of an effect; 0 for surfaces and the direct light
        std::uint32_t bounce = 0;  // of layers of a bounce, from 1; 0 for others

        friend bool operator==(const Entry&, const Entry&) = default;
    };

    std::uint32_t number = 0;   // in packages; stable
    std::uint32_t demands = 0;  // Demand bits
    std::string_view name;      // in --layers and OpenEXR files
    std::string_view what;      // a sentence without a full stop
    Subject subject{};
    Format format{};
    std::string_view channels;  // of OpenEXR, one letter each: "XYZ". Further components of the format are 0
    Mean mean{};
    // The layer's value is computed from its own last value, too, where a picture is a mean.
    bool continues = false;
    // The layer is a place: relative to SceneView::origin in the image, and in the world where the host reads
    // it (Renderer::readLayer()).
    bool isPlace = false;
    // The layer is for people who look for a problem. Words for several layers at once leave it out.
    bool isDiagnostic = false;
    // Another layer of the same subject that it is computed from; empty if there is none.
    std::string_view from{};
    // The expressions that the GLSL uses: a function of shaders/layers/, and the value of a pixel without a
    // surface.
    std::string_view function{};
    std::string_view absent{};
    // With Pass::Several: the macro by which passes add to it (subject Work), or store the value of a
    // sample (subject Ray). `absent` is the value that it begins with.
    std::string_view tally{};
};
static_assert(sizeof(LayerInfo::Entry) == 12);
const LayerInfo::FormatInfo& infoOf(LayerInfo::Format format);

// Values of the layer "hit-shader" that are no shader IDs.
inline constexpr std::uint32_t kNoRay = 0xFFFFFFFF;
inline constexpr std::uint32_t kRayLeftScene = 0xFFFFFFFE;
inline constexpr std::uint32_t kRayEndedOnScreen = 0xFFFFFFFD;
// The layer "non-finite" counts infinite samples in this unit, and those that are not a number in ones.
inline constexpr std::uint32_t kInfiniteSample = 0x10000;

// Returns whether the layer exists for each source of light, rather than once for the pixel.
bool hasSources(const LayerInfo& info);

// All rows, in the order in which --help lists them.
std::span<const LayerInfo> layerTable();
// These return null if there is no such layer.
const LayerInfo* findLayer(std::string_view name);
const LayerInfo* findLayer(std::uint32_t number);

// The source of the layers of the direct light, as effects are those of the others: "direct.radiance".
inline constexpr std::string_view kDirectLight = "direct";

// A layer of a package.
struct PackageLayer {
    const LayerInfo* info = nullptr;
    Effect effect = 0;  // as in LayerInfo::Entry, as the next
    std::uint32_t bounce = 0;
    std::string
        name;  // "depth", "direct.radiance", "reflection.virtual-motion", "reflection.bounce-radiance.2"
};

// Returns the name of a layer, whose source of light has the name `source`.
std::string layerName(const LayerInfo& info, std::string_view source, std::uint32_t bounce);

// Returns the pass that writes the layer. First hits write surfaces and their direct light, several passes
// write a layer with a tally, and compose writes the rest.
LayerInfo::Pass passOf(const LayerInfo::Entry& entry);
// Returns the LayerInfo::Demand bits of all of them.
std::uint32_t demandsOf(std::span<const PackageLayer> layers);
// Returns the number of bounces that have layers of their own; 0 if none has.
std::uint32_t layerBounces(std::span<const PackageLayer> layers);
// Returns whether some layer holds light that the walk of an effect may find. `walks` are the effects that
// have one.
bool showWalkedLight(std::span<const PackageLayer> layers, std::uint32_t walks);
bool showsWalkedLight(const LayerInfo::Entry& entry, std::uint32_t walks);
// Returns the size of a pixel of all images, in bytes.
std::uint32_t bytesOf(std::span<const PackageLayer> layers);

}  // namespace glint::package
