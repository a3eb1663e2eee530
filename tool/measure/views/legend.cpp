// Draws the legend of a view.
#include "image/palette.h"
#include "image/text.h"

#include <glint/measure/views.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace glint::measure {

namespace {

constexpr image::Color8 kPaper = {16, 16, 16};
constexpr image::Color8 kInk = {235, 235, 235};
constexpr std::uint32_t kMargin = 4;        // the lengths are pixels of text of scale 1
constexpr std::uint32_t kEntryWidth = 150;  // of a category, at least
constexpr std::uint32_t kSwatch = 8;
constexpr std::size_t kMostRows = 6;

std::uint32_t textScale(std::uint32_t width) {
    return std::max(1U, (width + 320) / 640);
}

std::string shortNumber(double value) {
    return fmt::format("{:.4g}", value);
}

std::string percentage(std::uint64_t pixels, std::uint64_t all) {
    return fmt::format("{:.3g} %", 100.0 * static_cast<double>(pixels) / static_cast<double>(all));
}

// Draws in units of the text's scale.
class LegendPainter {
public:
    LegendPainter(const View& view, std::uint32_t width)
        : view_(view), scale_(textScale(width)), units_(std::max(width / scale_, 1U)), pixels_(width) {}

    image::DisplayImage paint() {
        const ViewStatistics& statistics = view_.statistics;
        const std::size_t columns = std::max<std::size_t>(1, (units_ - kMargin) / kEntryWidth);
        const std::size_t room = columns * kMostRows;
        const std::size_t all = statistics.categories.size();
        const std::size_t shown = all <= room ? all : room - 1;
        const std::size_t entries = shown + (shown < all ? 1 : 0);
        const std::size_t rows = (entries + columns - 1) / columns;
        const bool hasNumbers = view_.choice.info->scale != ViewScale::Categories;
        const std::uint32_t lines = 1 + (hasNumbers ? 3 : 0) + static_cast<std::uint32_t>(rows);
        image_ = {pixels_, (2 * kMargin + lines * image::kLineHeight) * scale_, {}};
        image_.pixels.assign(std::size_t{image_.width} * image_.height, kPaper);
        line(kMargin, 0, fmt::format("{}: {}", view_.choice.name(), view_.choice.info->what),
             units_ - 2 * kMargin);
        if (hasNumbers) {
            paintScale();
        }
        const auto first = static_cast<std::uint32_t>(hasNumbers ? 4 : 1);
        const std::uint32_t columnWidth = (units_ - kMargin) / static_cast<std::uint32_t>(columns);
        std::uint64_t rest = 0;
        for (std::size_t i = 0; i < all; ++i) {
            if (i >= shown) {
                rest += statistics.categories[i].pixels;
                continue;
            }
            const auto x = kMargin + static_cast<std::uint32_t>(i % columns) * columnWidth;
            const auto y = first + static_cast<std::uint32_t>(i / columns);
            area(x, y * image::kLineHeight + kMargin, kSwatch, kSwatch,
                 statistics.categories[i].category.color);
            entry(x, y, statistics.categories[i].category.name, statistics.categories[i].pixels, columnWidth);
        }
        if (shown < all) {
            const auto x = kMargin + static_cast<std::uint32_t>(shown % columns) * columnWidth;
            entry(x, first + static_cast<std::uint32_t>(shown / columns), fmt::format("{} more", all - shown),
                  rest, columnWidth);
        }
        return std::move(image_);
    }

private:
    std::uint64_t count() const {
        return std::uint64_t{view_.picture.width} * view_.picture.height;
    }

    void area(std::uint32_t x, std::uint32_t y, std::uint32_t width, std::uint32_t height,
              image::Color8 color) {
        image::fillArea(image_, x * scale_, y * scale_, width * scale_, height * scale_, color);
    }

    void line(std::uint32_t x, std::uint32_t row, std::string_view text, std::uint32_t width) {
        image::drawText(image_, x * scale_, (kMargin + row * image::kLineHeight) * scale_,
                        image::fittedText(text, width), kInk, scale_);
    }

    void entry(std::uint32_t x, std::uint32_t row, std::string_view name, std::uint64_t pixels,
               std::uint32_t columnWidth) {
        const std::string share = " " + percentage(pixels, count());
        const std::uint32_t left = columnWidth - kSwatch - 2 * kMargin;
        const std::uint32_t ofShare = image::textWidth(share);
        line(x + kSwatch + kMargin, row, image::fittedText(name, left - std::min(left, ofShare)) + share,
             left);
    }

    // The colours from least to greatest with numbers at their ends and middle, and how the numbers are
    // spread.
    void paintScale() {
        const ViewStatistics& statistics = view_.statistics;
        if (statistics.numbers == 0) {
            line(kMargin, 1, "no pixel has a number", units_ - 2 * kMargin);
            return;
        }
        const std::uint32_t width = units_ - 2 * kMargin;
        for (std::uint32_t x = 0; x < width; ++x) {
            area(kMargin + x, image::kLineHeight + kMargin, 1, kSwatch,
                 image::quantityColor((x + 0.5) / static_cast<double>(width)));
        }
        const double first = statistics.scale[0];
        const double last = statistics.scale[1];
        const bool isLogarithmic = view_.choice.info->scale == ViewScale::Logarithmic;
        const std::string least = shortNumber(first);
        const std::string middle =
            shortNumber(isLogarithmic ? std::sqrt(first * last) : (first + last) / 2.0);
        const std::string greatest = fmt::format("{} {}", shortNumber(last), view_.choice.info->unit);
        line(kMargin, 2, least, width);
        line(kMargin + (width - image::textWidth(middle)) / 2, 2, middle, width);
        line(kMargin + width - std::min(width, image::textWidth(greatest)), 2, greatest, width);
        line(kMargin, 3,
             fmt::format("mean {}, median {}, 99 % up to {}, greatest {}", shortNumber(statistics.mean),
                         shortNumber(statistics.median), shortNumber(statistics.percentile99),
                         shortNumber(statistics.greatest)),
             width);
    }

    const View& view_;
    std::uint32_t scale_;
    std::uint32_t units_;   // the width in units
    std::uint32_t pixels_;  // the width in pixels
    image::DisplayImage image_;
};

}  // namespace

image::DisplayImage makeLegend(const View& view, std::uint32_t width) {
    return LegendPainter(view, width).paint();
}

image::DisplayImage withLegend(const View& view) {
    image::DisplayImage image = view.picture;
    const image::DisplayImage legend = makeLegend(view, image.width);
    image.height += legend.height;
    image.pixels.insert(image.pixels.end(), legend.pixels.begin(), legend.pixels.end());
    return image;
}

}  // namespace glint::measure
