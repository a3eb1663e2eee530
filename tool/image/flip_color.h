// The colours of FLIP: converts linear Rec. 709 to opponent channels and to perceived differences.
#pragma once

#include <array>

namespace glint::image::flip {

using Color = std::array<double, 3>;

// Converts linear Rec. 709 in [0, 1] to YCxCz and back. This is the linear opponent space in which the eye's
// contrast sensitivity was measured: Y in [-16, 100], Cx from green to red, Cz from blue to yellow.
Color toOpponent(const Color& rgb);
Color fromOpponent(const Color& opponent);

// Returns CIE L*a*b* of linear Rec. 709, with a* and b* times L*/100 (Hunt: colours look paler in the dark).
Color toHuntLab(const Color& rgb);

// Returns the perceived difference of two colours of toHuntLab(), from 0 to 1.
double colorDifference(const Color& a, const Color& b);

}  // namespace glint::image::flip
