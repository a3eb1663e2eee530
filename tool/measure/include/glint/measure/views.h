// Views: debug pictures of a frame, with a legend and with their numbers. docs/views.md shows each of them.
//
// viewTable() is their only declaration: the words of --view, the layers that a package needs, the colours,
// the legend, and the JSON of --stats follow from its rows. A view reads layers of the renderer
// (glint/layers.h) on the host and colours them. It has no pass, so its cost in a frame is that of its
// layers.
#pragma once

#include "base/fields_fwd.h"
#include "image/text.h"
#include "materials/material_model.h"

#include <glint/package.h>
#include <glint/renderer.h>
#include <glint/result.h>

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glint::measure {

enum class ViewScale : std::uint8_t {
    Categories,   // each pixel is of a kind
    Linear,       // from the least to the greatest number
    FromZero,     // from 0 to the greatest
    FromOne,      // from 1 to the greatest, for counts of which 1 is the best
    Logarithmic,  // from the least to the greatest number above 0
};

struct ViewInput;
struct ViewValues;

// A row of the table.
struct ViewInfo {
    std::string_view name;
    std::string_view what;  // a sentence without a full stop
    ViewScale scale{};
    std::string_view unit;  // of the numbers, or what a category is: "metres", "case"
    // The layers that it reads. The value of "distance" is that of the source of light which the view is
    // about.
    std::vector<std::string_view> layers;
    void (*evaluate)(const ViewInput& input, ViewValues& values) = nullptr;
    bool readsReference = false;  // it compares with another picture
    // A further layer that it reads of every source of light that has it; empty if there is none.
    std::string_view everySource{};
};

// All rows, in the order in which --help lists them.
std::span<const ViewInfo> viewTable();
// Returns null if there is no such view.
const ViewInfo* findView(std::string_view name);
// Returns whether it is about the rays of one effect, so that "reflection.hit-distance" names it, too.
bool isOfRays(const ViewInfo& info);

// A view, and the effect that it is about.
struct ViewChoice {
    const ViewInfo* info = nullptr;
    std::string source;  // empty: the first effect of the package with rays

    // "reflection.hit-distance"
    std::string name() const;
};
// Returns no value if the text names no view.
std::optional<ViewChoice> parseView(std::string_view text);
// Returns the words that CompileSettings::layers needs for the view. A package without effects may lack those
// that end with a question mark.
std::vector<std::string> layersFor(const ViewChoice& view);

// The inputs of a view. The objects that they point to must outlive it.
struct ViewInput {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::uint32_t samples = 1;     // of the picture
    bool dispatchesCases = false;  // StrategyInfo::dispatchesCases of the strategy
    const Package* package = nullptr;
    std::uint32_t scene = 0;                                                     // of the package
    std::vector<std::string> materialNames;                                      // by number; may be empty
    const materials::MaterialModel* model = &materials::builtinMaterialModel();  // of the scene's materials
    const LinearImage* picture = nullptr;
    const LinearImage* reference = nullptr;  // if the view compares, of equal size
    // The layers of ViewInfo::layers by name, and those of ViewInfo::everySource by their whole names, such
    // as "reflection.hit-shader".
    std::map<std::string, LayerValues> layers;
};

// A kind of pixels.
struct ViewCategory {
    std::string name;
    image::Color8 color{};
    bool isOneOfMany = false;  // The legend counts those, and names none of them.
};

// The values of the pixels of a view, row by row from the top.
struct ViewValues {
    static constexpr std::uint32_t kNumber = 0xFFFFFFFF;
    std::vector<double> numbers;                       // of pixels whose mark is kNumber
    std::vector<std::uint32_t> marks;                  // kNumber, or a key of `categories`
    std::map<std::uint32_t, ViewCategory> categories;  // those that may occur
};

// The numbers of a view.
struct ViewStatistics {
    struct Category {
        ViewCategory category;
        std::uint64_t pixels = 0;
    };
    std::vector<Category> categories;  // those that occur, the most frequent first
    std::uint64_t numbers = 0;         // pixels that have a number; the rest is 0 if none has
    double least = 0.0;
    double greatest = 0.0;
    double mean = 0.0;
    double median = 0.0;
    double percentile99 = 0.0;
    double percentileHalf = 0.0;    // at 0.5 %
    double percentile99Half = 0.0;  // at 99.5 %
    // Pixels in equal steps from scale[0] to scale[1]; of a logarithmic view the steps are equal in the
    // logarithm. The first and the last step include the pixels beyond the scale: it leaves out the outermost
    // half percent of the numbers where these are far from the others.
    std::array<double, 2> scale{};
    std::vector<std::uint64_t> histogram;
};

// A finished view.
struct View {
    ViewChoice choice;
    image::DisplayImage picture;  // of the size of the frame; nothing is drawn over it
    ViewStatistics statistics;
};
base::Fields fieldsOf(const View*);

// Reads the layers of the renderer's last recording into `input`, waits for the device, and colours the
// pixels. Sizes and layers of `input` are filled in. `range` fixes the scale, which otherwise is that of the
// numbers. Errors: "view-source" (the package has no such effect), "view-layer" (the package lacks a layer),
// "view-reference" (the sizes differ, or there is none), and those of Renderer::readLayer().
Result<View> makeView(const ViewChoice& choice, Renderer& renderer, ViewInput input,
                      std::optional<std::array<double, 2>> range = {});

// Makes the same view from layers that are in `input` already.
View colorView(const ViewChoice& choice, const ViewInput& input,
               std::optional<std::array<double, 2>> range = {});

// Returns the legend of a view for a picture of that width: its title, its colours, and its numbers. Its text
// is larger in wide pictures.
image::DisplayImage makeLegend(const View& view, std::uint32_t width);
// Returns the picture with the legend below it.
image::DisplayImage withLegend(const View& view);

// Reads a layer of the renderer's last recording, waits for the device, and shows it:
// - one number a pixel by the colours of quantities, from the least to the greatest; values that stand for
//   none are grey
// - numbers of things, such as shader IDs, by the colours of categories
// - light as the picture is shown at `exposure`, in stops, and albedo without exposure
// - vectors as red, green and blue, from the least to the greatest value of all channels; where some are
//   below 0, grey is 0
// The statistics are those of all channels. `name` is PackageLayer::name; View::choice has the layer's name
// and source, and describes the layer. Errors: those of Renderer::readLayer().
Result<View> makeLayerView(std::string_view name, Renderer& renderer, double exposure);

}  // namespace glint::measure
