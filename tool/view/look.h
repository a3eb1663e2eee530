// A view or a layer that the window shows in place of the picture. Both are pictures of tool/measure.
#pragma once

#include "image/exr.h"
#include "view/picture.h"

#include <glint/measure/views.h>

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

}  // namespace glint::view
