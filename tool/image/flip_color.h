// The colours of FLIP: from linear Rec. 709 to opponent channels and to perceived differences.
#pragma once

#include <array>

namespace glint::flip {

using Color = std::array<double, 3>;

// Linear Rec. 709 in [0, 1] into YCxCz, the linear opponent space in which the eye's contrast sensitivity was
// measured: Y in [-16, 100], Cx from green to red, Cz from blue to yellow. And back.
Color toOpponent(const Color& rgb);
Color fromOpponent(const Color& opponent);

// CIE L*a*b* of linear Rec. 709, a* and b* times L*/100 (Hunt: colours look paler in the dark).
Color toHuntLab(const Color& rgb);

// How different two colours of toHuntLab() are, from 0 to 1.
double colorDifference(const Color& a, const Color& b);

}  // namespace glint::flip
