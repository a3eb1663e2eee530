// Views of values that are given: statistics, colours, legends.
#include "base/fields.h"
#include "image/text.h"

#include <glint/measure/views.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <vector>

namespace glint::measure {
namespace {

// A picture of 8 by 4 pixels whose rays are 0, 2, 4, … over two samples.
View raysView() {
    ViewInput input;
    input.width = 8;
    input.height = 4;
    input.samples = 2;
    LayerValues rays{8, 4, 1, {}, {}};
    for (std::uint32_t i = 0; i < 32; ++i) {
        rays.integers.push_back(2 * i);
    }
    input.layers.emplace("rays", rays);
    return colorView(*parseView("rays"), input);
}

TEST(ViewTable, RowsNameLayersThatExist) {
    std::set<std::string_view> names;
    for (const ViewInfo& view : viewTable()) {
        EXPECT_TRUE(names.insert(view.name).second) << view.name;
        EXPECT_EQ(view.layers.empty(), view.readsReference) << view.name;
        for (const std::string_view layer : view.layers) {
            EXPECT_NE(package::findLayer(layer), nullptr) << layer;
        }
    }
}

TEST(ViewTable, TheDocumentShowsEachView) {
    const std::filesystem::path folder = std::filesystem::path(GLINT_SOURCE_DIR) / "docs";
    std::ifstream file(folder / "views.md");
    const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
    std::uintmax_t bytes = 0;
    for (const ViewInfo& view : viewTable()) {
        std::string picture = "images/views_" + std::string(view.name) + ".png";
        std::ranges::replace(picture, '-', '_');
        EXPECT_NE(text.find("![](" + picture + ")"), std::string::npos) << picture;
        EXPECT_NE(text.find("`" + std::string(view.name) + "`"), std::string::npos) << view.name;
        ASSERT_TRUE(std::filesystem::exists(folder / picture)) << "scripts/views.py makes " << picture;
        bytes += std::filesystem::file_size(folder / picture);
    }
    EXPECT_LT(bytes, 600'000U) << "keep the pictures small";
}

TEST(ViewTable, NamesAreReadWithTheirEffect) {
    EXPECT_TRUE(parseView("rays"));
    EXPECT_FALSE(parseView("ray"));
    EXPECT_FALSE(parseView("reflection.rays")) << "rays are not those of one effect";
    EXPECT_FALSE(parseView(".hit-distance"));
    const auto view = parseView("refraction.hit-distance");
    ASSERT_TRUE(view);
    EXPECT_EQ(view->name(), "refraction.hit-distance");
    EXPECT_EQ(layersFor(*view), std::vector<std::string>{"refraction.distance"});
    EXPECT_EQ(layersFor(*parseView("hit-distance")), std::vector<std::string>{"distance"});
}

TEST(ViewStatisticsOf, NumbersAreThoseOfOneSample) {
    const ViewStatistics statistics = raysView().statistics;
    EXPECT_EQ(statistics.numbers, 32U);
    EXPECT_EQ(statistics.least, 0.0);
    EXPECT_EQ(statistics.greatest, 31.0);
    EXPECT_EQ(statistics.mean, 15.5);
    EXPECT_EQ(statistics.median, 16.0);
    ASSERT_EQ(statistics.histogram.size(), 16U);
    for (const std::uint64_t pixels : statistics.histogram) {
        EXPECT_EQ(pixels, 2U);
    }
    const auto json = base::jsonOf(raysView());
    EXPECT_EQ(json["name"], "rays");
    EXPECT_EQ(json["greatest"], 31.0);
    EXPECT_EQ(json["histogram"]["pixels"].size(), 16U);
}

TEST(ViewStatisticsOf, PixelsWithoutANumberAreCategories) {
    ViewInput input;
    input.width = 4;
    input.height = 1;
    input.layers.emplace("distance", LayerValues{4, 1, 1, {0.0F, 2.0F, 65504.0F, 0.0F}, {}});
    const View view = colorView(*parseView("hit-distance"), input);
    EXPECT_EQ(view.statistics.numbers, 1U);
    ASSERT_EQ(view.statistics.categories.size(), 2U);
    EXPECT_EQ(view.statistics.categories[0].category.name, "no ray");
    EXPECT_EQ(view.statistics.categories[0].pixels, 2U);
    EXPECT_EQ(view.statistics.categories[1].category.name, "left the scene");
    EXPECT_EQ(view.picture.pixels[0], view.picture.pixels[3]);
}

TEST(ViewDifference, IsTheLargestRelativeErrorOfAPixel) {
    LinearImage picture{2, 1, {{1.0F, 1.0F, 1.0F, 1.0F}, {4.0F, 1.0F, 1.0F, 1.0F}}};
    LinearImage reference{2, 1, {{1.0F, 1.0F, 1.0F, 1.0F}, {2.0F, 1.0F, 1.25F, 1.0F}}};
    ViewInput input;
    input.width = 2;
    input.height = 1;
    input.picture = &picture;
    input.reference = &reference;
    const View view = colorView(*parseView("difference"), input);
    EXPECT_EQ(view.statistics.numbers, 1U);
    EXPECT_EQ(view.statistics.greatest, 1.0);
    EXPECT_EQ(view.statistics.categories[0].category.name, "up to 0.0001");
}

// 1000 pixels of 1 m, one of which is 1 km.
View footprintView() {
    ViewInput input;
    input.width = 1000;
    input.height = 1;
    LayerValues widths{1000, 1, 1, std::vector<float>(1000, 1.0F), {}};
    for (std::size_t i = 0; i < 500; ++i) {
        widths.reals[i] = 2.0F;
    }
    widths.reals[999] = 1000.0F;
    input.layers.emplace("footprint", widths);
    return colorView(*parseView("footprint"), input);
}

TEST(ViewScales, AFewPixelsFarAwayLeaveTheOthersTheirColours) {
    const View view = footprintView();
    EXPECT_EQ(view.statistics.scale, (std::array<double, 2>{1.0, 2.0}));
    EXPECT_EQ(view.statistics.greatest, 1000.0);
    EXPECT_EQ(view.statistics.histogram.front(), 499U);
    EXPECT_EQ(view.statistics.histogram.back(), 501U) << "what is beyond the scale is in the last step";
    EXPECT_EQ(view.picture.pixels[999], view.picture.pixels[0]);
}

TEST(ViewScales, NoDivergenceHasTheColourOfTheBest) {
    ViewInput input;
    input.width = 2;
    input.height = 1;
    input.layers.emplace("cases-run", LayerValues{2, 1, 1, {}, {1, 1}});
    input.layers.emplace("hit-shader", LayerValues{2, 1, 1, {}, {0, 0}});
    const View view = colorView(*parseView("divergence"), input);
    EXPECT_EQ(view.picture.pixels[0], image::quantityColor(0.0));
}

TEST(ViewLegend, IsBelowThePictureAndLegibleAtEverySize) {
    View view = raysView();
    for (const std::uint32_t width : {64U, 320U, 1280U, 3840U}) {
        const image::DisplayImage legend = makeLegend(view, width);
        EXPECT_EQ(legend.width, width);
        EXPECT_EQ(legend.pixels.size(), std::size_t{width} * legend.height);
        std::set<image::Color8> colors(legend.pixels.begin(), legend.pixels.end());
        const std::uint32_t columns = width / std::max(1U, (width + 320) / 640);
        EXPECT_TRUE(colors.contains(image::quantityColor(0.5 / (columns - 8.0))));
        EXPECT_TRUE(colors.contains(image::Color8{235, 235, 235})) << "text";
    }
    const image::DisplayImage both = withLegend(view);
    EXPECT_GT(both.height, view.picture.height);
    EXPECT_TRUE(std::equal(view.picture.pixels.begin(), view.picture.pixels.end(), both.pixels.begin()));
    EXPECT_GT(makeLegend(view, 1280).height, makeLegend(view, 320).height) << "text grows with the picture";
}

TEST(ViewLegend, OnesOfManyAreCounted) {
    View view = raysView();
    view.choice = *parseView("bucket");
    view.statistics = {};
    view.statistics.categories.push_back({{"no ray", {}}, 1});
    const std::uint32_t height = makeLegend(view, 320).height;
    for (int i = 0; i < 100; ++i) {
        view.statistics.categories.push_back({{"group " + std::to_string(i), {}, true}, 1});
    }
    EXPECT_EQ(makeLegend(view, 320).height, height) << "both in one row";
}

TEST(ViewLegend, ManyCategoriesAreSummedUp) {
    View view = raysView();
    view.choice = *parseView("material");
    view.statistics = {};
    for (int i = 0; i < 100; ++i) {
        view.statistics.categories.push_back({{"material with a long name " + std::to_string(i), {}}, 1});
    }
    EXPECT_LT(makeLegend(view, 320).height, 120U);
}

TEST(Palettes, ColorsDiffer) {
    std::set<image::Color8> colors;
    for (std::uint32_t i = 0; i < image::kCategoryColors; ++i) {
        EXPECT_TRUE(colors.insert(image::categoryColor(i)).second) << i;
    }
    const auto lightness = [](image::Color8 color) {
        return 0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2];
    };
    for (int i = 0; i < 32; ++i) {
        EXPECT_LT(lightness(image::quantityColor(i / 32.0)), lightness(image::quantityColor((i + 1) / 32.0)));
    }
}

}  // namespace
}  // namespace glint::measure
