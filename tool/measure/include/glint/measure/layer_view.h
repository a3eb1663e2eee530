// Pictures of a layer's values as they are, for people. Views (glint/measure/views.h) instead show the
// meaning of layers.
#pragma once

#include <glint/measure/views.h>

#include <string_view>

namespace glint::measure {

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
