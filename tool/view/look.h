// A view or a layer that the window shows in place of the picture, and the text about a pixel.
#pragma once

#include "image/exr.h"
#include "view/controls.h"
#include "view/picture.h"

#include <glint/measure/views.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace glint::view {

// A view or a layer, or neither: the picture itself.
struct Look {
    std::string view;   // as --view names it
    std::string layer;  // PackageLayer::name

    bool isPicture() const {
        return view.empty() && layer.empty();
    }
    const std::string& name() const {
        return view.empty() ? layer : view;
    }
    friend bool operator==(const Look&, const Look&) = default;
};

// Returns the looks that packages of a build may have, in the order of their tables. Views that compare with
// a file are left out.
std::vector<Look> looksOf(const Build& build);
// Returns a sentence about it, without a full stop.
std::string describe(const Look& look);

// Adds the layers that a look reads to the setting `layers`. Returns false if the package of the build has
// them already.
bool askFor(const Look& look, const Build& build, compiler::Settings& settings);

// Shows the picture's last sample, which must be complete. `exposure` in stops is for layers of light.
// Errors: those of measure::makeView() and measure::makeLayerView().
Result<measure::View> makeLook(const Look& look, Picture& picture, double exposure);

// Returns the layer in a form that files hold. Errors: those of Renderer::readLayer().
Result<image::ExrLayer> layerForFile(const Look& look, Picture& picture);
// Returns the word of the setting `layers` for a layer. The layers of all bounces have one word.
std::string layerWord(const std::string& layer);

// Draws the list of looks and the legend of the one that is shown; `shown` is null until it is made. `note`
// is the reason why it is not shown. Returns the look that was clicked.
std::optional<Look> drawLooks(Controls& controls, const Build& build, const Look& chosen,
                              const measure::View* shown, const std::string& note);

// --- A pixel ---

struct Pick {
    std::uint32_t x = 0;  // pixels of the picture
    std::uint32_t y = 0;
    std::vector<Field> fields;
    int material = -1;  // index into Scene::materials; -1: the sky
    int node = -1;      // index into Scene::nodes
};

// Describes the surface that the pixel sees in the last sample: material, key, case and the reasons for them,
// bucket, rays, cost. Waits for the device. Errors are those of Renderer::readPlace() and
// Renderer::readOutput().
Result<Pick> pickPixel(const Request& request, Picture& picture, std::uint32_t x, std::uint32_t y,
                       double exposure);

}  // namespace glint::view
