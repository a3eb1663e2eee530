#include "image/compare.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

namespace glint::image {

namespace {

using Color = std::array<double, 3>;
using Matrix = std::array<Color, 3>;

// Matrices from linear RGB to CIE XYZ and back, derived from the chromaticities of ITU-R BT.709's primaries
// and of D65 (0.3127, 0.3290).
constexpr Matrix kToXyz{{{506752.0 / 1228815.0, 87881.0 / 245763.0, 12673.0 / 70218.0},
                         {87098.0 / 409605.0, 175762.0 / 245763.0, 12673.0 / 175545.0},
                         {7918.0 / 409605.0, 87881.0 / 737289.0, 1001167.0 / 1053270.0}}};
constexpr Matrix kFromXyz{{{12831.0 / 3959.0, -329.0 / 214.0, -1974.0 / 3959.0},
                           {-851781.0 / 878810.0, 1648619.0 / 878810.0, 36519.0 / 878810.0},
                           {705.0 / 12673.0, -2585.0 / 12673.0, 705.0 / 667.0}}};

// White in XYZ, which is the reference illuminant.
constexpr Color kWhite{kToXyz[0][0] + kToXyz[0][1] + kToXyz[0][2], kToXyz[1][0] + kToXyz[1][1] + kToXyz[1][2],
                       kToXyz[2][0] + kToXyz[2][1] + kToXyz[2][2]};

// q_c, p_c and p_t of the paper: the exponent of the difference, and the bend of its range. Differences up to
// kBend of the largest one take kBendTo of the output.
constexpr double kExponent = 0.7;
constexpr double kBend = 0.4;
constexpr double kBendTo = 0.95;

constexpr Color multiply(const Matrix& m, const Color& v) {
    return {m[0][0] * v[0] + m[0][1] * v[1] + m[0][2] * v[2],
            m[1][0] * v[0] + m[1][1] * v[1] + m[1][2] * v[2],
            m[2][0] * v[0] + m[2][1] * v[1] + m[2][2] * v[2]};
}

// The function f of CIE 1976 L*a*b* (CIE 15:2004).
double labCurve(double t) {
    constexpr double kDelta = 6.0 / 29.0;
    return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3.0 * kDelta * kDelta) + 4.0 / 29.0;
}

// The HyAB distance: Abasi, Amani Tehran and Fairchild 2019, "Distance metrics for very large color
// differences".
double hyab(const Color& a, const Color& b) {
    return std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]);
}

// Convert linear Rec. 709 in [0, 1] to YCxCz and back. This is the linear opponent space in which the eye's
// contrast sensitivity was measured: Y in [-16, 100], Cx from green to red, Cz from blue to yellow.
// Source: Flohr, Kolpatzik, Balasubramanian, Carrara, Bouman and Allebach 1993, "Model-based color image
// quantization".
Color toOpponent(const Color& rgb) {
    const Color xyz = multiply(kToXyz, rgb);
    const double x = xyz[0] / kWhite[0];
    const double y = xyz[1] / kWhite[1];
    const double z = xyz[2] / kWhite[2];
    return {116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)};
}

Color fromOpponent(const Color& opponent) {
    const double y = (opponent[0] + 16.0) / 116.0;
    const double x = y + opponent[1] / 500.0;
    const double z = y - opponent[2] / 200.0;
    return multiply(kFromXyz, {x * kWhite[0], y * kWhite[1], z * kWhite[2]});
}

// Returns CIE L*a*b* of linear Rec. 709, with a* and b* times L*/100 (Hunt: colours look paler in the dark).
// Sources: CIE 1976 L*a*b* (CIE 15:2004), and Hunt 1952, "Light and Dark Adaptation and the Perception of
// Color", in the form of the paper.
Color toHuntLab(const Color& rgb) {
    const Color xyz = multiply(kToXyz, rgb);
    const double x = labCurve(xyz[0] / kWhite[0]);
    const double y = labCurve(xyz[1] / kWhite[1]);
    const double z = labCurve(xyz[2] / kWhite[2]);
    const double lightness = 116.0 * y - 16.0;
    return {lightness, 0.01 * lightness * 500.0 * (x - y), 0.01 * lightness * 200.0 * (y - z)};
}

// Returns the perceived difference of two colours of toHuntLab(), from 0 to 1.
double colorDifference(const Color& a, const Color& b) {
    // The largest difference within Rec. 709 is that between green and blue.
    static const double kLargest =
        std::pow(hyab(toHuntLab({0.0, 1.0, 0.0}), toHuntLab({0.0, 0.0, 1.0})), kExponent);
    const double difference = std::pow(hyab(a, b), kExponent);
    const double bend = kBend * kLargest;
    if (difference < bend) {
        return kBendTo / bend * difference;
    }
    return std::min(1.0, kBendTo + (difference - bend) / (kLargest - bend) * (1.0 - kBendTo));
}

constexpr double kPi = std::numbers::pi;

// A term a sqrt(π / b) exp(-π² d² / b) over the distance d in degrees. These are the paper's spatial filters,
// with the parameters of its table 1.
struct Term {
    double a;
    double b;
};
constexpr Term kAchromatic{1.0, 0.0047};
constexpr Term kRedGreen{1.0, 0.0053};
constexpr Term kBlueYellowWide{34.1, 0.04};
constexpr Term kBlueYellowNarrow{13.5, 0.025};

// The number of standard deviations that a filter reaches from its middle, as in the paper.
constexpr double kReach = 3.0;
// The distance from the highest to the lowest weight of the edge filter, in degrees: w of the paper's feature
// detection.
constexpr double kEdgeWidth = 0.082;

// The weights from -radius to radius.
using Kernel = std::vector<double>;

std::size_t radiusOf(const Kernel& kernel) {
    return kernel.size() / 2;
}

template <typename Function>
Kernel sample(std::size_t radius, Function function) {
    Kernel kernel(2 * radius + 1);
    for (std::size_t i = 0; i < kernel.size(); ++i) {
        kernel[i] = function(static_cast<double>(i) - static_cast<double>(radius));
    }
    return kernel;
}

// Scales the weights above 0 so that they sum to 1, and those below to -1. Returns the sum of those above
// before scaling.
double normalizeLobes(Kernel& kernel) {
    double above = 0.0;
    double below = 0.0;
    for (const double weight : kernel) {
        (weight > 0.0 ? above : below) += weight;
    }
    for (double& weight : kernel) {
        if (weight != 0.0) {
            weight /= weight > 0.0 ? above : -below;
        }
    }
    return above;
}

// The standard deviation of exp(-π² d² / b) is sqrt(b / (2 π²)).
std::size_t sensitivityRadius(double pixelsPerDegree) {
    const double deviation = std::sqrt(kBlueYellowWide.b / (2.0 * kPi * kPi));
    return static_cast<std::size_t>(std::ceil(kReach * deviation * pixelsPerDegree));
}

Kernel gaussian(const Term& term, double pixelsPerDegree) {
    return sample(sensitivityRadius(pixelsPerDegree), [&](double x) {
        const double degrees = x / pixelsPerDegree;
        return std::exp(-kPi * kPi * degrees * degrees / term.b);
    });
}

// The contrast sensitivity of the eye: a sum of Gaussians for each channel of YCxCz. The blue-yellow channel
// has two terms, with these shares of the sum.
struct SensitivityFilters {
    Kernel achromatic;
    Kernel redGreen;
    Kernel blueYellowWide;
    Kernel blueYellowNarrow;
    double wideShare = 1.0;
    double narrowShare = 0.0;
};

// Returns filters that have one radius and sum to 1 each.
SensitivityFilters sensitivityFilters(double pixelsPerDegree) {
    SensitivityFilters filters{gaussian(kAchromatic, pixelsPerDegree), gaussian(kRedGreen, pixelsPerDegree),
                               gaussian(kBlueYellowWide, pixelsPerDegree),
                               gaussian(kBlueYellowNarrow, pixelsPerDegree)};
    normalizeLobes(filters.achromatic);
    normalizeLobes(filters.redGreen);
    // The paper normalises the sum of both terms over x and y, so each term keeps its share of that sum.
    const auto weight = [](const Term& term, Kernel& kernel) {
        const double sum = normalizeLobes(kernel);
        return term.a * std::sqrt(kPi / term.b) * sum * sum;
    };
    const double wide = weight(kBlueYellowWide, filters.blueYellowWide);
    const double narrow = weight(kBlueYellowNarrow, filters.blueYellowNarrow);
    filters.wideShare = wide / (wide + narrow);
    filters.narrowShare = narrow / (wide + narrow);
    return filters;
}

// The filters of edges and points: derivatives of a Gaussian in one direction, and the Gaussian in the other.
struct FeatureFilters {
    Kernel smooth;  // sums to 1
    Kernel edge;    // first derivative: weights above 0 sum to 1, those below to -1
    Kernel point;   // second derivative, normalised like the edge filter
};

// Returns filters that have one radius.
FeatureFilters featureFilters(double pixelsPerDegree) {
    // The extremes of a Gaussian's first derivative are one standard deviation from its middle.
    const double deviation = 0.5 * kEdgeWidth * pixelsPerDegree;
    const auto radius = static_cast<std::size_t>(std::ceil(kReach * deviation));
    const auto bell = [deviation](double x) { return std::exp(-x * x / (2.0 * deviation * deviation)); };
    FeatureFilters filters{
        sample(radius, bell), sample(radius, [&](double x) { return -x * bell(x); }),
        sample(radius, [&](double x) { return (x * x / (deviation * deviation) - 1.0) * bell(x); })};
    normalizeLobes(filters.smooth);
    normalizeLobes(filters.edge);
    normalizeLobes(filters.point);
    return filters;
}

using Row = std::vector<double>;

struct Filters {
    SensitivityFilters sensitivity;
    FeatureFilters feature;
    std::size_t radius;  // the largest radius of the filters
};

Filters makeFilters(double pixelsPerDegree) {
    Filters filters{sensitivityFilters(pixelsPerDegree), featureFilters(pixelsPerDegree), 0};
    filters.radius = std::max(radiusOf(filters.sensitivity.achromatic), radiusOf(filters.feature.smooth));
    return filters;
}

// Computes out[x] = sum of kernel weights times the values around x. `padded` starts `margin` values left of
// the row.
void filterAlong(const Row& padded, std::size_t margin, const Kernel& kernel, Row& out) {
    std::fill(out.begin(), out.end(), 0.0);
    const std::size_t first = margin - radiusOf(kernel);
    for (std::size_t k = 0; k < kernel.size(); ++k) {
        const double weight = kernel[k];
        const double* values = padded.data() + first + k;
        for (std::size_t x = 0; x < out.size(); ++x) {
            out[x] += weight * values[x];
        }
    }
}

// A row after filtering along it, before it is filtered down the columns.
struct FilteredRow {
    Row achromatic, redGreen, wide, narrow;  // YCxCz after the filters of contrast sensitivity
    Row smooth, edge, point;                 // Y in [0, 1] after the filters of features
};

// NaN has no order, so it is handled separately.
double clampToDisplay(float value) {
    return std::isnan(value) ? 0.0 : std::clamp(static_cast<double>(value), 0.0, 1.0);
}

// Reads one picture row by row from the top. It keeps the filtered rows that the filters need for one row of
// the map.
class FilteredPicture {
public:
    FilteredPicture(const LinearImage& image, const Filters& filters)
        : image_(image), filters_(filters), ring_(2 * filters.radius + 1) {
        for (FilteredRow& row : ring_) {
            for (const Plane plane :
                 {&FilteredRow::achromatic, &FilteredRow::redGreen, &FilteredRow::wide, &FilteredRow::narrow,
                  &FilteredRow::smooth, &FilteredRow::edge, &FilteredRow::point}) {
                (row.*plane).resize(image.width);
            }
        }
        for (Row& row : padded_) {
            row.resize(image.width + 2 * filters.radius);
        }
        for (Row& row : down_) {
            row.resize(image.width);
        }
    }

    // Returns the colours of row y after contrast sensitivity, as from toHuntLab(), and the strength of edges
    // and points. y must not decrease.
    void readRow(std::uint32_t y, std::vector<Color>& colors, Row& edges, Row& points) {
        const std::size_t last = std::min<std::size_t>(y + filters_.radius, image_.height - 1);
        for (; filtered_ <= last; ++filtered_) {
            filterRow(filtered_);
        }
        const SensitivityFilters& eye = filters_.sensitivity;
        filterDown(y, &FilteredRow::achromatic, eye.achromatic, down_[0]);
        filterDown(y, &FilteredRow::redGreen, eye.redGreen, down_[1]);
        filterDown(y, &FilteredRow::wide, eye.blueYellowWide, down_[2]);
        filterDown(y, &FilteredRow::narrow, eye.blueYellowNarrow, down_[3]);
        for (std::size_t x = 0; x < colors.size(); ++x) {
            Color rgb = fromOpponent(
                {down_[0][x], down_[1][x], eye.wideShare * down_[2][x] + eye.narrowShare * down_[3][x]});
            for (double& channel : rgb) {
                channel = std::clamp(channel, 0.0, 1.0);
            }
            colors[x] = toHuntLab(rgb);
        }

        const auto strength = [&](Plane derivative, const Kernel& kernel, Row& out) {
            filterDown(y, derivative, filters_.feature.smooth, down_[0]);
            filterDown(y, &FilteredRow::smooth, kernel, down_[1]);
            for (std::size_t x = 0; x < out.size(); ++x) {
                out[x] = std::sqrt(down_[0][x] * down_[0][x] + down_[1][x] * down_[1][x]);
            }
        };
        strength(&FilteredRow::edge, filters_.feature.edge, edges);
        strength(&FilteredRow::point, filters_.feature.point, points);
    }

private:
    using Plane = Row FilteredRow::*;

    void filterRow(std::uint32_t y) {
        const std::size_t margin = filters_.radius;
        const std::array<float, 4>* pixels =
            image_.pixels.data() + static_cast<std::size_t>(y) * image_.width;
        for (std::size_t x = 0; x < image_.width; ++x) {
            const std::array<float, 4>& pixel = pixels[x];
            const Color opponent =
                toOpponent({clampToDisplay(pixel[0]), clampToDisplay(pixel[1]), clampToDisplay(pixel[2])});
            for (std::size_t i = 0; i < 3; ++i) {
                padded_[i][margin + x] = opponent[i];
            }
            padded_[3][margin + x] = (opponent[0] + 16.0) / 116.0;
        }
        for (Row& row : padded_) {
            std::fill_n(row.begin(), margin, row[margin]);
            std::fill_n(row.end() - static_cast<std::ptrdiff_t>(margin), margin,
                        row[row.size() - margin - 1]);
        }
        FilteredRow& row = ring_[y % ring_.size()];
        filterAlong(padded_[0], margin, filters_.sensitivity.achromatic, row.achromatic);
        filterAlong(padded_[1], margin, filters_.sensitivity.redGreen, row.redGreen);
        filterAlong(padded_[2], margin, filters_.sensitivity.blueYellowWide, row.wide);
        filterAlong(padded_[2], margin, filters_.sensitivity.blueYellowNarrow, row.narrow);
        filterAlong(padded_[3], margin, filters_.feature.smooth, row.smooth);
        filterAlong(padded_[3], margin, filters_.feature.edge, row.edge);
        filterAlong(padded_[3], margin, filters_.feature.point, row.point);
    }

    void filterDown(std::uint32_t y, Plane plane, const Kernel& kernel, Row& out) const {
        std::fill(out.begin(), out.end(), 0.0);
        const auto radius = static_cast<std::int64_t>(radiusOf(kernel));
        for (std::int64_t k = -radius; k <= radius; ++k) {
            const std::int64_t from = std::clamp<std::int64_t>(static_cast<std::int64_t>(y) + k, 0,
                                                               static_cast<std::int64_t>(image_.height) - 1);
            const Row& values = ring_[static_cast<std::size_t>(from) % ring_.size()].*plane;
            const double weight = kernel[static_cast<std::size_t>(k + radius)];
            for (std::size_t x = 0; x < out.size(); ++x) {
                out[x] += weight * values[x];
            }
        }
    }

    const LinearImage& image_;
    const Filters& filters_;
    std::vector<FilteredRow> ring_;  // row y is at index y modulo the ring's size
    std::uint32_t filtered_ = 0;     // number of rows filtered so far
    std::array<Row, 4> padded_;      // Y, Cx, Cz, and Y in [0, 1]
    std::array<Row, 4> down_;
};

// The colours and features of one row of a picture.
struct Seen {
    explicit Seen(std::size_t width) : colors(width), edges(width), points(width) {}
    std::vector<Color> colors;
    Row edges;
    Row points;
};

// The paper's final difference: a difference of features makes a difference of colours larger. The exponent
// of features is 1/2.
double pixelDifference(const Seen& a, const Seen& b, std::size_t x) {
    const double feature = std::max(std::abs(a.edges[x] - b.edges[x]), std::abs(a.points[x] - b.points[x]));
    const double featureDifference = std::min(1.0, std::sqrt(feature / std::numbers::sqrt2));
    return std::pow(colorDifference(a.colors[x], b.colors[x]), 1.0 - featureDifference);
}

}  // namespace

std::vector<float> flipMap(const LinearImage& image, const LinearImage& reference, double pixelsPerDegree) {
    if (image.pixels.empty()) {
        return {};
    }
    const Filters filters = makeFilters(pixelsPerDegree);
    FilteredPicture pictureA(image, filters);
    FilteredPicture pictureB(reference, filters);
    Seen a(image.width);
    Seen b(image.width);
    std::vector<float> map;
    map.reserve(image.pixels.size());
    for (std::uint32_t y = 0; y < image.height; ++y) {
        pictureA.readRow(y, a.colors, a.edges, a.points);
        pictureB.readRow(y, b.colors, b.edges, b.points);
        for (std::size_t x = 0; x < image.width; ++x) {
            map.push_back(static_cast<float>(pixelDifference(a, b, x)));
        }
    }
    return map;
}

double flipMean(std::span<const float> map) {
    double sum = 0.0;
    for (const float value : map) {
        sum += value;
    }
    return map.empty() ? 0.0 : sum / static_cast<double>(map.size());
}

}  // namespace glint::image
