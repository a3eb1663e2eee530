#include "base/text.h"
#include "settings/descriptor.h"

#include <glint/measure/report.h>

#include <fmt/format.h>

#include <algorithm>

namespace glint::measure {

namespace {

Interval times(const Interval& interval, double factor) {
    return {interval.median * factor, interval.low * factor, interval.high * factor, interval.q1 * factor,
            interval.q3 * factor};
}

}  // namespace

std::string describeReference(const BenchReport& report) {
    compiler::Configuration given;
    for (const auto& [name, value] : report.base) {
        const compiler::Descriptor& row = *compiler::sweptSetting(name);
        if (row.bench.isTransport) {
            given[name] = valueOf(name, report.reference.configuration, report.base);
        }
    }
    return fmt::format("{} ({}), with every light and {} approximation off",
                       report.reference.isFull ? "all of light transport" : "the default's transport",
                       base::shellWords(compiler::wordsOf(given)),
                       report.reference.isFull ? "every" : "every other");
}

Interval timeOf(const BenchReport& report, std::size_t point) {
    const double base = measure::intervalOf(report.points.front().times).median;
    return point == 0 ? measure::intervalOf(report.points.front().times)
                      : times(timeRatio(report.points[point]), base);
}

std::string imageName(std::size_t point) {
    return fmt::format("images/{:03}.png", point);
}

std::string errorImageName(std::size_t point) {
    return fmt::format("images/{:03}_error.png", point);
}

std::uint32_t pictureScale(const BenchReport& report) {
    constexpr std::uint32_t kWidest = 320;
    const std::uint32_t extent = std::min(report.scene.width, 2 * report.scene.height);
    return std::max(1U, (extent + kWidest - 1) / kWidest);
}

std::string renderCommand(const BenchReport& report, const BenchPoint& point) {
    const bool isFiltered = point.kind == PointKind::Filtered;
    std::vector<std::string> words{"glint", "render", report.scene.file, "-o", "picture.png"};
    if (isFiltered) {
        words = {"denoise", report.scene.file, "picture.png", "--frames",
                 fmt::format("{}", point.filteredFrames)};
    }
    words.insert(words.end(), report.viewWords.begin(), report.viewWords.end());
    // With these options the command renders the picture of the first round exactly.
    words.insert(words.end(), {"--seed", fmt::format("{}", report.seed), "--exposure",
                               fmt::format("{:.9g}", report.reference.exposure)});
    compiler::Configuration given;
    const compiler::Configuration defaults = configurationOf(compiler::Settings());
    for (const auto& [name, value] : defaults) {
        const std::string& own = valueOf(name, point.configuration, report.base);
        const bool isPackaged =
            !point.package.empty() && compiler::sweptSetting(name)->stage == compiler::SettingStage::Package;
        if (own != value && !isPackaged) {
            given[name] = own;
        }
    }
    if (isFiltered) {
        words.insert(words.end(), {"--samples", given.contains("spp") ? given["spp"] : "1"});
        given.erase("spp");
    }
    for (const std::string& word : compiler::wordsOf(given)) {
        words.push_back(word);
    }
    if (!point.package.empty()) {
        words.insert(words.end(), {"--package", point.package});
    }
    return base::shellWords(words);
}

}  // namespace glint::measure
