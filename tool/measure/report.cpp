#include "base/fields.h"
#include "base/files.h"
#include "base/lists.h"
#include "base/text.h"
#include "image/compare.h"
#include "image/image_file.h"
#include "measure/page.h"
#include "settings/descriptor.h"

#include <glint/measure/report.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <system_error>

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
    std::ranges::move(compiler::wordsOf(given), std::back_inserter(words));
    if (!point.package.empty()) {
        words.insert(words.end(), {"--package", point.package});
    }
    return base::shellWords(words);
}

// --- Strategies ---

namespace {

StrategyRow rowOf(const BenchPoint& point, std::size_t index, const std::string& strategy) {
    StrategyRow row;
    row.strategy = strategy;
    row.point = index;
    row.ratio = timeRatio(point);
    row.hits = measure::intervalOf(point.hitMs);
    row.hitRatio = measure::intervalOf(point.hitRatios);
    row.traceMs = measure::intervalOf(base::mapped<double>(point.hits, &HitTimes::trace)).median;
    row.orderMs = measure::intervalOf(base::mapped<double>(point.hits, &HitTimes::order)).median;
    // Shading gets the rest, because its passes overlap if they are not measured one by one.
    row.shadeMs = std::max(row.hits.median - row.traceMs - row.orderMs, 0.0);
    row.commonMs = std::max(measure::intervalOf(point.times).median - row.hits.median, 0.0);
    row.rays = point.counters.rays;
    return row;
}

// Returns the average number of cases among `wave` hits in random order.
double casesIn(std::span<const std::uint32_t> hits, double wave) {
    const double all = std::accumulate(hits.begin(), hits.end(), 0.0);
    return base::sumOf<double>(
        hits, [&](std::uint32_t count) { return all > 0.0 ? 1.0 - std::pow(1.0 - count / all, wave) : 0.0; });
}

void countHits(std::span<const std::uint32_t> buckets, StrategyReport& report) {
    constexpr double kWave = 32.0;
    if (buckets.size() < 2) {
        return;
    }
    const std::span<const std::uint32_t> hits = buckets.subspan(1);  // the first is of misses
    report.cases = static_cast<std::uint32_t>(hits.size());
    report.filledCases =
        static_cast<std::uint32_t>(std::ranges::count_if(hits, [](std::uint32_t n) { return n > 0; }));
    const double all = std::accumulate(hits.begin(), hits.end(), 0.0);
    report.largestShare = all > 0.0 ? *std::ranges::max_element(hits) / all : 0.0;
    report.casesInWave = casesIn(hits, kWave);
}

// Returns the share of the row's time, in whole per cent.
double percent(double part, const StrategyRow& row) {
    return 100.0 * part / std::max(row.commonMs + row.traceMs + row.orderMs + row.shadeMs, 1e-12);
}

void explain(StrategyReport& report) {
    const auto least =
        std::ranges::min_element(report.rows, {}, [](const StrategyRow& row) { return row.ratio.median; });
    for (const StrategyRow& row : report.rows) {
        if (overlap(row.ratio, least->ratio)) {
            report.fastest.push_back(row.strategy);
        }
    }
    if (report.fastest.size() > 1) {
        report.why.push_back(
            fmt::format("{} take equally long: their intervals overlap.", fmt::join(report.fastest, ", ")));
    } else {
        report.why.push_back(fmt::format("{} is fastest.", least->strategy));
    }
    for (const StrategyRow& row : report.rows) {
        if (&row != &*least) {
            report.why.push_back(fmt::format("{} takes {:.2f} times as long as {} (the medians).",
                                             row.strategy, row.ratio.median / least->ratio.median,
                                             least->strategy));
        }
    }
    report.why.push_back(
        fmt::format("In a picture with {}, {:.0f} % of the time is work that all strategies share: primary "
                    "surfaces, rays, the composition. Strategies differ only in the rest.",
                    least->strategy, percent(least->commonMs, *least)));
    for (const StrategyRow& row : report.rows) {
        if (row.orderMs > 0.0) {
            report.why.push_back(
                fmt::format("{} spends {:.1f} % on tracing into hit records, {:.1f} % on sorting them and "
                            "{:.1f} % on shading them.",
                            row.strategy, percent(row.traceMs, row), percent(row.orderMs, row),
                            percent(row.shadeMs, row)));
        } else {
            report.why.push_back(
                fmt::format("{} sorts nothing: it spends {:.1f} % on tracing and shading hits at once.",
                            row.strategy, percent(row.shadeMs, row)));
        }
    }
    const std::uint32_t rays = report.rows.front().rays;
    report.why.push_back(fmt::format("A sample sends {} rays whose hits are shaded.", rays));
    if (report.cases > 0) {
        report.why.push_back(fmt::format(
            "Hits have {} of {} shaders, and {:.0f} % of them have the same one. 32 hits in random order "
            "have {:.1f} shaders: a subgroup of an uber shader runs at most that many one after another.",
            report.filledCases, report.cases, 100.0 * report.largestShare, report.casesInWave));
    }
}

}  // namespace

StrategyReport compareStrategies(std::span<const BenchPoint> points, const std::string& base) {
    StrategyReport report;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const compiler::Configuration& configuration = points[i].configuration;
        const auto own = configuration.find("strategy");
        const bool isAlone =
            configuration.empty() || (own != configuration.end() && configuration.size() == 1);
        if (!isAlone || points[i].times.empty() || !isOfSettings(points[i].kind)) {
            continue;
        }
        report.rows.push_back(rowOf(points[i], i, own == configuration.end() ? base : own->second));
        if (report.cases == 0) {
            countHits(points[i].counters.bucketCounts, report);
        }
    }
    if (report.rows.size() > 1 && report.rows.front().rays > 0) {
        explain(report);
    }
    return report;
}

// --- The default's error, divided among its approximations ---

namespace {

// The two causes of an error, in a measure that adds up.
struct Causes {
    double bias = 0.0;
    double noise = 0.0;  // the part that more samples remove
};

// Over N rounds of independent noise the error of the mean picture has 1 / N of the noise that the error of
// one picture has, and all of the bias. FLIP is no square: there the noise is a lower bound. A single round
// gives no estimate of noise.
Causes causesOf(const BenchPoint& point, ErrorMetric metric) {
    const auto rounds = static_cast<double>(point.errors.size());
    Causes causes;
    for (const image::ImageErrors& errors : point.errors) {
        causes.bias += additive(metric, valueOf(metric, errors)) / rounds;
    }
    if (point.errors.size() > 1 && point.errorOfMean) {
        const double lost = causes.bias - additive(metric, valueOf(metric, *point.errorOfMean));
        causes.noise = lost * (metric == ErrorMetric::Flip ? 1.0 : rounds / (rounds - 1.0));
        causes.bias -= causes.noise;
    }
    return causes;
}

const BenchPoint* find(std::span<const BenchPoint> points, const compiler::Configuration& configuration) {
    const auto found = std::ranges::find_if(points, [&](const BenchPoint& point) {
        return isOfSettings(point.kind) && point.configuration == configuration;
    });
    return found == points.end() ? nullptr : &*found;
}

}  // namespace

ErrorParts partsOfError(std::span<const BenchPoint> points, std::span<const Setting> settings,
                        ErrorMetric metric) {
    const Causes base = causesOf(points.front(), metric);
    const double whole = std::max(base.bias + base.noise, 1e-300);
    const auto removedBy = [&](const BenchPoint& point) {
        std::vector<double> removed;  // by rounds with the same seed
        for (const double ratio : point.errorRatios) {
            removed.push_back(1.0 - additive(metric, ratio));
        }
        const Causes causes = causesOf(point, metric);
        return RemovedError{static_cast<std::size_t>(&point - points.data()), intervalOf(removed),
                            (base.bias - causes.bias) / whole, (base.noise - causes.noise) / whole};
    };
    ErrorParts parts;
    parts.noise = base.noise / whole;
    parts.rest = base.bias / whole;
    compiler::Configuration exact;
    for (const Setting& setting : settings) {
        if (!hasExactValue(setting)) {
            continue;
        }
        exact.emplace(setting.name, setting.exact);
        if (const BenchPoint* const point = find(points, {{setting.name, setting.exact}})) {
            parts.parts.push_back({setting.name, setting.base, setting.exact, removedBy(*point)});
            parts.rest -= parts.parts.back().removed.bias;
        }
    }
    std::ranges::stable_sort(parts.parts, std::ranges::greater(),
                             [](const ErrorPart& part) { return part.removed.bias; });
    if (const BenchPoint* const point = exact.empty() ? nullptr : find(points, exact)) {
        parts.exact = removedBy(*point);
    }
    return parts;
}

// --- Files ---

namespace {

namespace fs = std::filesystem;

constexpr const char* kImages = "images";

// The files, and their content for the page.
struct Pictures {
    std::vector<PageImage> files;
    std::vector<PageImage> ofPage;
};

// Returns means over `factor` x `factor` pixels. The remainder at the right and the bottom is cut off.
image::DisplayImage shrunk(const image::DisplayImage& image, std::uint32_t factor) {
    const std::uint32_t area = std::max(1U, factor * factor);
    image::DisplayImage small{image.width / factor, image.height / factor, {}};
    for (std::uint32_t y = 0; y < small.height; ++y) {
        for (std::uint32_t x = 0; x < small.width; ++x) {
            std::array<std::uint32_t, 3> sum{};
            for (std::uint32_t i = 0; i < area; ++i) {
                const std::size_t row = std::size_t{y} * factor + i / factor;
                const auto& pixel = image.pixels[row * image.width + std::size_t{x} * factor + i % factor];
                for (std::size_t c = 0; c < 3; ++c) {
                    sum[c] += pixel[c];
                }
            }
            std::array<std::uint8_t, 3> mean{};
            for (std::size_t c = 0; c < 3; ++c) {
                mean[c] = static_cast<std::uint8_t>((sum[c] + area / 2) / area);
            }
            small.pixels.push_back(mean);
        }
    }
    return small;
}

Status add(Pictures& pictures, std::uint32_t factor, const std::string& name,
           const image::DisplayImage& image) {
    GLINT_TRY(auto png, encodePng(image, name));
    GLINT_TRY(auto small, factor == 1 ? png : encodePng(shrunk(image, factor), name));
    pictures.files.push_back({name, std::move(png)});
    pictures.ofPage.push_back({name, std::move(small)});
    return okStatus();
}

Result<Pictures> picturesOf(const BenchReport& report) {
    const double exposure = report.reference.exposure;
    const std::uint32_t factor = pictureScale(report);
    Pictures pictures;
    const LinearImage reference = image::exposed(report.reference.image, exposure);
    Status added =
        add(pictures, factor, kReferenceImage, image::toDisplayImage(report.reference.image, exposure));
    for (std::size_t i = 0; added && i < report.points.size(); ++i) {
        const LinearImage& image = report.points[i].image;
        added = add(pictures, factor, imageName(i), image::toDisplayImage(image, exposure));
        if (added) {
            added = add(pictures, factor, errorImageName(i),
                        image::differenceMap(image::exposed(image, exposure), reference));
        }
    }
    return added ? Result(std::move(pictures)) : Result<Pictures>(added.error());
}

// Removes pictures of an earlier bench that had more configurations.
void removeOthers(const fs::path& folder, const std::vector<PageImage>& pictures) {
    std::set<std::string> names;
    for (const PageImage& picture : pictures) {
        names.insert(fs::path(picture.name).filename().string());
    }
    std::error_code ignored;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder / kImages, ignored)) {
        if (entry.path().extension() == ".png" && !names.contains(entry.path().filename().string())) {
            fs::remove(entry.path(), ignored);
        }
    }
}

}  // namespace

Status checkBenchFolder(const fs::path& folder, const char* mark) {
    std::error_code error;
    const fs::file_status status = fs::status(folder, error);
    if (fs::exists(status) && !fs::is_directory(status)) {
        return makeError("bench-folder", folder.string(), "is a file, not a folder", "give another -o");
    }
    if (fs::exists(status) && !fs::is_empty(folder, error) && !fs::exists(folder / mark, error)) {
        return makeError("bench-folder", folder.string(), "holds something other than a bench",
                         "give an empty folder, a new one, or that of an earlier bench");
    }
    const Status possible = base::checkOutputFolder(folder);
    return possible ? possible
                    : Status(makeError("bench-folder", folder.string(), possible.error().message,
                                       "give another -o, or check the folder and its permissions"));
}

Status makeBenchFolder(const fs::path& folder, const std::string& hint) {
    std::error_code error;
    fs::create_directories(folder, error);
    return error
               ? Status(makeError("bench-folder", folder.string(), "can't be made: " + error.message(), hint))
               : okStatus();
}

Status writeBench(const BenchReport& report, const fs::path& folder) {
    GLINT_TRY(const auto pictures, picturesOf(report));
    std::error_code error;
    fs::create_directories(folder / kImages, error);
    if (error) {
        return makeError("bench-folder", folder.string(), "can't be made: " + error.message(),
                         "give another -o");
    }
    for (const PageImage& picture : pictures.files) {
        GLINT_TRY_DO(base::writeFile(folder / picture.name, picture.png));
    }
    if (report.advice && report.advice->point) {
        compiler::Configuration settings = report.base;
        for (const auto& [name, value] : report.points[*report.advice->point].configuration) {
            settings[name] = value;
        }
        GLINT_TRY_DO(base::writeFile(folder / kSettingsFile, settingsText(settings, report.command)));
    }
    const base::Json json = base::jsonOf(report);
    GLINT_TRY_DO(base::writeFile(folder / kReportFile, base::toText(json)));
    GLINT_TRY_DO(base::writeFile(folder / kPageFile, makePage(json, pictures.ofPage)));
    removeOthers(folder, pictures.files);
    return okStatus();
}

}  // namespace glint::measure
