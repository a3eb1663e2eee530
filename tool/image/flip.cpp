#include "image/flip.h"

#include "image/flip_color.h"
#include "image/flip_filters.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace glint::image {

namespace {

using flip::Color;
using flip::Kernel;
using Row = std::vector<double>;

struct Filters {
    flip::SensitivityFilters sensitivity;
    flip::FeatureFilters feature;
    std::size_t radius;  // the largest radius of the filters
};

Filters makeFilters(double pixelsPerDegree) {
    Filters filters{flip::sensitivityFilters(pixelsPerDegree), flip::featureFilters(pixelsPerDegree), 0};
    filters.radius =
        std::max(flip::radiusOf(filters.sensitivity.achromatic), flip::radiusOf(filters.feature.smooth));
    return filters;
}

// Computes out[x] = sum of kernel weights times the values around x. `padded` starts `margin` values left of
// the row.
void filterAlong(const Row& padded, std::size_t margin, const Kernel& kernel, Row& out) {
    std::fill(out.begin(), out.end(), 0.0);
    const std::size_t first = margin - flip::radiusOf(kernel);
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

// Reads one picture row by row from the top. It keeps the filtered rows that the filters need for one row of
// the map.
class FilteredPicture {
public:
    FilteredPicture(const LinearImage& image, const Filters& filters);

    // Returns the colours of row y after contrast sensitivity, as from toHuntLab(), and the strength of edges
    // and points. y must not decrease.
    void readRow(std::uint32_t y, std::vector<Color>& colors, Row& edges, Row& points);

private:
    using Plane = Row FilteredRow::*;

    void filterRow(std::uint32_t y);
    void filterDown(std::uint32_t y, Plane plane, const Kernel& kernel, Row& out) const;

    const LinearImage& image_;
    const Filters& filters_;
    std::vector<FilteredRow> ring_;  // row y is at index y modulo the ring's size
    std::uint32_t filtered_ = 0;     // number of rows filtered so far
    std::array<Row, 4> padded_;      // Y, Cx, Cz, and Y in [0, 1]
    std::array<Row, 4> down_;
};

FilteredPicture::FilteredPicture(const LinearImage& image, const Filters& filters)
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

// NaN has no order, so it is handled separately.
double clampToDisplay(float value) {
    return std::isnan(value) ? 0.0 : std::clamp(static_cast<double>(value), 0.0, 1.0);
}

void FilteredPicture::filterRow(std::uint32_t y) {
    const std::size_t margin = filters_.radius;
    const std::array<float, 4>* pixels = image_.pixels.data() + static_cast<std::size_t>(y) * image_.width;
    for (std::size_t x = 0; x < image_.width; ++x) {
        const std::array<float, 4>& pixel = pixels[x];
        const Color opponent =
            flip::toOpponent({clampToDisplay(pixel[0]), clampToDisplay(pixel[1]), clampToDisplay(pixel[2])});
        for (std::size_t i = 0; i < 3; ++i) {
            padded_[i][margin + x] = opponent[i];
        }
        padded_[3][margin + x] = (opponent[0] + 16.0) / 116.0;
    }
    for (Row& row : padded_) {
        std::fill_n(row.begin(), margin, row[margin]);
        std::fill_n(row.end() - static_cast<std::ptrdiff_t>(margin), margin, row[row.size() - margin - 1]);
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

void FilteredPicture::filterDown(std::uint32_t y, Plane plane, const Kernel& kernel, Row& out) const {
    std::fill(out.begin(), out.end(), 0.0);
    const auto radius = static_cast<std::int64_t>(flip::radiusOf(kernel));
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

void FilteredPicture::readRow(std::uint32_t y, std::vector<Color>& colors, Row& edges, Row& points) {
    const std::size_t last = std::min<std::size_t>(y + filters_.radius, image_.height - 1);
    for (; filtered_ <= last; ++filtered_) {
        filterRow(filtered_);
    }
    const flip::SensitivityFilters& eye = filters_.sensitivity;
    filterDown(y, &FilteredRow::achromatic, eye.achromatic, down_[0]);
    filterDown(y, &FilteredRow::redGreen, eye.redGreen, down_[1]);
    filterDown(y, &FilteredRow::wide, eye.blueYellowWide, down_[2]);
    filterDown(y, &FilteredRow::narrow, eye.blueYellowNarrow, down_[3]);
    for (std::size_t x = 0; x < colors.size(); ++x) {
        Color rgb = flip::fromOpponent(
            {down_[0][x], down_[1][x], eye.wideShare * down_[2][x] + eye.narrowShare * down_[3][x]});
        for (double& channel : rgb) {
            channel = std::clamp(channel, 0.0, 1.0);
        }
        colors[x] = flip::toHuntLab(rgb);
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
    return std::pow(flip::colorDifference(a.colors[x], b.colors[x]), 1.0 - featureDifference);
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
