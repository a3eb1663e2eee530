// Draws the legend of a view.

#include <glint/measure/views.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace glint::measure {

namespace {

constexpr image::Color8 kPaper = {16, 16, 16};
constexpr image::Color8 kInk = {235, 235, 235};
constexpr image::Color8 kOutline = {110, 110, 110};  // of what may be as dark as the paper
constexpr std::uint32_t kMargin = 4;                 // the lengths are pixels of text of scale 1
constexpr std::uint32_t kEntryWidth = 150;           // of a category, at least
constexpr std::uint32_t kSwatch = 8;
constexpr std::size_t kMostRows = 8;

std::uint32_t textScale(std::uint32_t width) {
    return std::max(1U, (width + 320) / 640);
}

// "2345", "12.3 k", "4.56 M"
std::string shortNumber(double value) {
    struct Unit {
        double least;
        double size;
        std::string_view name;
    };
    for (const Unit& unit : {Unit{1e9, 1e9, " G"}, Unit{1e6, 1e6, " M"}, Unit{1e4, 1e3, " k"}}) {
        if (value >= unit.least) {
            return fmt::format("{:.4g}{}", value / unit.size, unit.name);
        }
    }
    return fmt::format("{:.4g}", value);
}

std::string percentage(std::uint64_t pixels, std::uint64_t all) {
    return fmt::format("{:.3g} %", 100.0 * static_cast<double>(pixels) / static_cast<double>(all));
}

// Returns the lines of a text that is at most `width` pixels wide at scale 1.
std::vector<std::string> wrapped(std::string_view text, std::uint32_t width) {
    std::vector<std::string> lines;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find(' '), text.size());
        const std::string word(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
        if (!lines.empty() && image::textWidth(lines.back() + " " + word) <= width) {
            lines.back() += " " + word;
        } else {
            lines.push_back(word);
        }
    }
    return lines;
}

// A line of the legend: a category, or several.
struct LegendEntry {
    std::string name;
    std::optional<image::Color8> color;
    std::uint64_t pixels = 0;
};

// All categories with isOneOfMany become one entry.
std::vector<LegendEntry> entriesOf(const View& view) {
    std::vector<LegendEntry> entries;
    LegendEntry many;
    std::uint64_t count = 0;
    for (const ViewStatistics::Category& one : view.statistics.categories) {
        if (one.category.isOneOfMany) {
            many.pixels += one.pixels;
            ++count;
        } else {
            entries.push_back({one.category.name, one.category.color, one.pixels});
        }
    }
    if (count > 0) {
        many.name = fmt::format("{} {}{}", count, view.choice.info->unit, count > 1 ? "s" : "");
        entries.insert(entries.begin(), many);
    }
    return entries;
}

// Draws in units of the text's scale.
class LegendPainter {
public:
    LegendPainter(const View& view, std::uint32_t width)
        : view_(view),
          entries_(entriesOf(view)),
          scale_(textScale(width)),
          units_(std::max(width / scale_, 1U)),
          pixels_(width) {}

    image::DisplayImage paint() {
        const bool hasNumbers = view_.choice.info->scale != ViewScale::Categories;
        const std::vector<std::string> title =
            wrapped(fmt::format("{}: {}", view_.choice.name(), view_.choice.info->what), lineWidth());
        const std::vector<std::string> summary =
            hasNumbers ? wrapped(summaryText(), lineWidth()) : std::vector<std::string>();
        const std::size_t columns = columnsOfCategories();
        const std::size_t all = entries_.size();
        const std::size_t room = columns * kMostRows;
        const std::size_t shown = all <= room ? all : room - 1;
        const std::size_t entries = shown + (shown < all ? 1 : 0);
        const std::size_t rows = (entries + columns - 1) / columns;
        const std::size_t scaleRows = hasNumbers && view_.statistics.numbers > 0 ? 2 : 0;
        const std::size_t allRows = title.size() + scaleRows + summary.size() + rows;
        const auto lines = static_cast<std::uint32_t>(allRows);
        image_ = {pixels_, (2 * kMargin + lines * image::kLineHeight) * scale_, {}};
        image_.pixels.assign(std::size_t{image_.width} * image_.height, kPaper);
        std::uint32_t row = 0;
        for (const std::string& text : title) {
            line(kMargin, row++, text, lineWidth());
        }
        if (scaleRows > 0) {
            paintScale(row);
            row += static_cast<std::uint32_t>(scaleRows);
        }
        for (const std::string& text : summary) {
            line(kMargin, row++, text, lineWidth());
        }
        paintCategories(row, columns, shown);
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

    std::uint32_t lineWidth() const {
        return units_ - std::min(units_, 2 * kMargin);
    }

    std::string summaryText() const {
        const ViewStatistics& statistics = view_.statistics;
        if (statistics.numbers == 0) {
            return "no pixel has a number";
        }
        return fmt::format("mean {}, median {}, 99 % up to {}, least {}, greatest {}",
                           shortNumber(statistics.mean), shortNumber(statistics.median),
                           shortNumber(statistics.percentile99), shortNumber(statistics.least),
                           shortNumber(statistics.greatest));
    }

    // Returns as many columns as have room for the longest of the shown names, at least one.
    std::size_t columnsOfCategories() const {
        std::uint32_t widest = kEntryWidth;
        for (std::size_t i = 0; i < std::min(entries_.size(), kMostRows); ++i) {
            const std::string text = entries_[i].name + " " + percentage(entries_[i].pixels, count());
            widest = std::max(widest, kSwatch + 3 * kMargin + image::textWidth(text));
        }
        return std::max<std::size_t>(1, (units_ - std::min(units_, kMargin)) / widest);
    }

    // The first categories, and a line for the rest.
    void paintCategories(std::uint32_t first, std::size_t columns, std::size_t shown) {
        const std::uint32_t columnWidth =
            (units_ - std::min(units_, kMargin)) / static_cast<std::uint32_t>(columns);
        const auto placeOf = [&](std::size_t i) {
            return std::pair(kMargin + static_cast<std::uint32_t>(i % columns) * columnWidth,
                             first + static_cast<std::uint32_t>(i / columns));
        };
        std::uint64_t rest = 0;
        for (std::size_t i = 0; i < entries_.size(); ++i) {
            const LegendEntry& one = entries_[i];
            if (i >= shown) {
                rest += one.pixels;
                continue;
            }
            const auto [x, y] = placeOf(i);
            if (one.color) {
                area(x, y * image::kLineHeight + kMargin, kSwatch, kSwatch, kOutline);
                area(x + 1, y * image::kLineHeight + kMargin + 1, kSwatch - 2, kSwatch - 2, *one.color);
            }
            entry(x, y, one.name, one.pixels, columnWidth);
        }
        if (shown < entries_.size()) {
            const auto [x, y] = placeOf(shown);
            const bool repeats = entries_.size() > image::kCategoryColors;
            entry(x, y, fmt::format("{} more{}", entries_.size() - shown, repeats ? ", colours repeat" : ""),
                  rest, columnWidth);
        }
    }

    // The colours of the scale, with numbers at its ends and in its middle, in two rows.
    void paintScale(std::uint32_t row) {
        const ViewStatistics& statistics = view_.statistics;
        const std::uint32_t width = lineWidth();
        for (std::uint32_t x = 0; x < width; ++x) {
            area(kMargin + x, row * image::kLineHeight + kMargin, 1, kSwatch,
                 image::quantityColor((x + 0.5) / static_cast<double>(width)));
        }
        const double first = statistics.scale[0];
        const double last = statistics.scale[1];
        const bool isLogarithmic = view_.choice.info->scale == ViewScale::Logarithmic;
        const std::string least =
            fmt::format("{}{}", statistics.least < first ? "up to " : "", shortNumber(first));
        const std::string middle =
            shortNumber(isLogarithmic ? std::sqrt(first * last) : (first + last) / 2.0);
        const std::string greatest = fmt::format("{}{} {}", statistics.greatest > last ? "from " : "",
                                                 shortNumber(last), view_.choice.info->unit);
        line(kMargin, row + 1, least, width);
        const std::uint32_t ofEnds = std::max(image::textWidth(least), image::textWidth(greatest));
        if (2 * (ofEnds + kMargin) + image::textWidth(middle) < width) {
            line(kMargin + (width - image::textWidth(middle)) / 2, row + 1, middle, width);
        }
        line(kMargin + width - std::min(width, image::textWidth(greatest)), row + 1, greatest, width);
    }

    const View& view_;
    std::vector<LegendEntry> entries_;
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
