#include "base/fields.h"
#include "base/lists.h"
#include "base/text.h"
#include "emit/package/manifest.h"
#include "settings/descriptor.h"

#include <glint/measure/device_file.h>
#include <glint/measure/report.h>

#include <algorithm>
#include <string_view>
#include <utility>

namespace glint::measure {

using base::constant;
using base::field;
using base::Fields;
using base::group;
using base::output;

namespace {

// Values in the order of the table of settings.
using SettingValues = std::vector<std::pair<std::string, std::string>>;

SettingValues inOrder(const compiler::Configuration& configuration) {
    SettingValues values;
    for (const std::string& name : compiler::settingNames()) {
        const auto value = configuration.find(name);
        if (value != configuration.end()) {
            values.emplace_back(name, value->second);
        }
    }
    return values;
}

// An interval, and the values that it is of.
struct MeasuredTimes {
    Interval interval;
    std::vector<double> values;
};

struct SkippedStrategy {
    std::string strategy;
    std::string reason;
};
using StrategyOutcome = std::variant<SkippedStrategy, StrategyMeasure>;

struct PassTimes {
    std::string name;
    Interval time;
};

// A part of a report that needs the whole.
struct PointOf {
    const BenchReport* report = nullptr;
    std::size_t index = 0;

    const BenchPoint& point() const {
        return report->points[index];
    }
};
struct RowOf {
    const BenchReport* report = nullptr;
    const StrategyRow* row = nullptr;
};
struct AdviceOf {
    const BenchReport* report = nullptr;
    const BenchAdvice* advice = nullptr;

    // Returns the values of the base and the point that `glint compile` decides, or the others; nothing
    // without a point.
    std::optional<SettingValues> decided(bool compiled) const {
        if (!advice->point) {
            return std::nullopt;
        }
        compiler::Configuration values;
        for (const auto& [name, value] : report->base) {
            if (compiler::isCompiled(*compiler::sweptSetting(name)) == compiled) {
                values[name] = valueOf(name, report->points[*advice->point].configuration, report->base);
            }
        }
        return inOrder(values);
    }
};

template <double image::ImageErrors::*Member>
Interval errorInterval(const BenchPoint& point) {
    return measure::intervalOf(base::mapped<double>(point.errors, Member));
}

std::vector<PassTimes> passesOf(const PointOf& it) {
    return base::mapped<PassTimes>(it.point().passes, [](const auto& pass) {
        return PassTimes{pass.first, measure::intervalOf(pass.second)};
    });
}

}  // namespace

// The fields of a type stand above those of the types that have it.
Fields fieldsOf(const Interval*) {
    using T = Interval;
    return {
        field<&T::median>("median", "Median over the rounds.", {.orNull = true}),
        output<&T::low>("low", "Lower end of the 95 % confidence interval of the median.", {.orNull = true}),
        output<&T::high>("high", "Upper end of that interval.", {.orNull = true}),
        output<&T::q1>("q1", "Lower quartile.", {.orNull = true}),
        output<&T::q3>("q3", "Upper quartile.", {.orNull = true})};
}

Fields fieldsOf(const BenchMachine*) {
    using T = BenchMachine;
    return {
        field<&T::device>("device", "Name of the device."),
        field<&T::driver>("driver", "Name and version of the driver."),
        field<&T::deviceType>("deviceType", "Kind of the device.", {.names = {"cpu", "gpu"}}),
        field<&T::subgroupSize>("subgroupSize", "Lanes of a subgroup; left out where glint wrote the file.",
                                {.least = 1, .most = 1024, .optional = true}),
        field<&T::tracers>("tracers", "Tracers that the device has.",
                           {.names = base::wordsFor<package::Tracer>()}),
        output<&T::processor>("cpu", "Processor of the host; empty where it is not known."),
        output<&T::cores>("cores", "Number of cores of the host."),
        output<&T::system>("os", "Operating system of the host.")};
}

namespace {

Fields fieldsOf(const MeasuredTimes*) {
    using T = MeasuredTimes;
    return {field<&T::interval>("", ""),
            output<&T::values>("values", "One time for each round; for a bench's default, of all batches.")};
}

Fields fieldsOf(const SkippedStrategy*) {
    using T = SkippedStrategy;
    return {output<&T::strategy>("strategy", "Name of the strategy.", {.names = compiler::strategyWords()}),
            output<&T::reason>("skipped", "Why it was left out.")};
}

}  // namespace

static Fields fieldsOf(const HitTimes*) {
    using T = HitTimes;
    return {output<&T::dispatch>("dispatch", "Time of making the indirect arguments of the list."),
            output<&T::trace>("trace", "Time of tracing rays to hit records, if a separate pass does that."),
            output<&T::order>("order", "Time of sorting the records by bucket."),
            output<&T::shade>("shade", "Time of shading; with tracing where a strategy has no pass for it."),
            output<&T::shadow>("shadow", "Time of deferred shadow rays, including their dispatch.")};
}

static Fields fieldsOf(const PictureDifference*) {
    using T = PictureDifference;
    return {
        output<&T::largest>("largest", "Largest |a - b| / max(1, |b|) over all channels."),
        field<&T::differing>("differing", "Number of pixels that differ by more than 0.001 by that measure."),
        field<&T::pixels>("pixels", "Number of all pixels."),
        output<&T::isWrong>("wrong", "Whether over 1 in 1000 pixels differ; its times don't count then.")};
}

static Fields fieldsOf(const StrategyMeasure*) {
    using T = StrategyMeasure;
    // A file has the median of the ratios, which is enough for a fit.
    return {
        field<&T::strategy>("strategy", "Name of the strategy.", {.names = compiler::strategyWords()}),
        output<&T::tracer>("tracer", "The tracer.", {.names = base::wordsFor<package::Tracer>()}),
        output<&T::ordering>("ordering", "How hits are ordered; null where they are not.", {.orNull = true}),
        field(
            "time", "Milliseconds of device time, a sample, of the passes that strategies differ in.",
            [](const T& it) {
                return MeasuredTimes{measure::intervalOf(it.times), it.times};
            },
            [](T& it, const MeasuredTimes& time) { it.times = {time.interval.median}; }),
        field(
            "ratio", "Interval of the ratio to uber in the same round.",
            [](const T& it) { return measure::intervalOf(it.ratios); },
            [](T& it, const Interval& ratio) { it.ratios = {ratio.median}; }),
        output<&T::split>("split", "Means over all rounds, milliseconds a sample."),
        output<&T::pipelineMs>("pipelineMs", "Wall-clock time of making the pipelines."),
        output<&T::firstMs>("firstMs", "Wall-clock time of the first sample; drivers may compile in it."),
        output<&T::bytes>("bytes", "Size of the renderer's buffers and images."),
        field<&T::difference>("difference", "Difference of the picture from that of uber.")};
}

static Fields fieldsOf(const CaseWork*) {
    using T = CaseWork;
    return {field<&T::share>("share", "Share of the hits.", {.least = 0, .most = 1}),
            field<&T::instructions>("instructions",
                                    "SPIR-V instructions of the shader with which visibility shades it.",
                                    {.least = 0}),
            field<&T::fetches>("fetches", "Texture fetches of the same shader.", {.least = 0})};
}

namespace {

std::vector<StrategyOutcome> outcomesOf(const CalibrationEntry& entry) {
    std::vector<StrategyOutcome> outcomes;
    for (const StrategyMeasure& measure : entry.strategies) {
        if (measure.times.empty()) {
            outcomes.emplace_back(SkippedStrategy{measure.strategy, measure.skipped});
        } else {
            outcomes.emplace_back(measure);
        }
    }
    return outcomes;
}

base::Field strategiesField() {
    base::Field field =
        output<outcomesOf>("strategies", "The strategies that the device can run, uber first.");
    field.read = [](void* object, base::JsonReader& reader, const base::Json& json, const std::string& place,
                    const base::FieldTraits&) {
        reader.each(json, place, [&](const base::Json& outcome, const std::string& there) {
            if (!outcome.is_object() || !outcome.contains("skipped")) {
                static_cast<CalibrationEntry*>(object)->strategies.push_back(
                    base::readAs<StrategyMeasure>(reader, outcome, there));
            }
        });
    };
    return field;
}

}  // namespace

Fields fieldsOf(const CalibrationEntry*) {
    using T = CalibrationEntry;
    using Point = CalibrationPoint;
    constexpr double kMaxCases = 1U << 20U;
    return {field<&T::point, &Point::cases>(
                "cases", "Number of shaders of the scene's hits, one for each key.", {.most = kMaxCases}),
            field<&T::point, &Point::cost>("cost", "What shading a hit costs: cheap or expensive."),
            field<&T::point, &Point::coherence>(
                "coherence", "Rays of a mirror (coherent), or of a white floor (incoherent)."),
            output<&T::shares>("shares", "How the ceiling is divided among the cases: uniform or zipf."),
            output<&T::lights>("lights", "Number of point lights that shade each hit."),
            output<&T::shadows>("shadows", "Whether hits send shadow rays to them."),
            output<&T::width>("width", "Width of the picture in pixels."),
            output<&T::height>("height", "Height of the picture in pixels."),
            field(
                "rays", "Rays of the list in one sample: those that may bring light.",
                [](const T& it) { return static_cast<std::uint64_t>(it.point.rays); },
                [](T& it, std::uint64_t rays) { it.point.rays = static_cast<double>(rays); }),
            output<&T::hits>("hits", "Number of rays of the list that hit something."),
            field<&T::point, &Point::hitShare>("hitShare", "Share of the rays that hit something.",
                                               {.least = 0, .most = 1}),
            field<&T::point, &Point::coherentShare>(
                "coherentShare",
                "(a - r) / (1 - r): a is the chance that two hits of 32 neighbouring rays are of one case, r "
                "that of any two. 0: as in random order; 1: all alike. Computed from the geometry.",
                {.least = -1, .most = 1}),
            output<&T::filledCases>("filledCases", "Number of cases that have a hit."),
            output("instructions", "Mean of the SPIR-V instructions over all hits.",
                   [](const T& it) { return meanOf(it.point.work, &CaseWork::instructions); }),
            output("fetches", "Texture fetches of the same shader.",
                   [](const T& it) { return meanOf(it.point.work, &CaseWork::fetches); }),
            field<&T::point, &Point::work>("work", "The cost of each shader, by shader ID."),
            output<&T::samples>("samples", "Number of samples of which each time is the mean."),
            strategiesField(),
            output<&T::fastest>("fastest", "The strategies with the least ratio; several are a tie.",
                                {.names = compiler::strategyWords()})};
}

namespace {

// Returns the members at the head of a report, and `further` behind them.
template <typename T>
Fields withHead(const char* format, Fields further) {
    Fields fields{
        constant("format", "Format of the file.", format),
        constant("version", "Version of the format.", 1),
        output("tool", "Version of glint.", [](const T&) { return std::string_view(GLINT_VERSION); }),
        output("commit", "Commit of glint's sources; \"unknown\" without a repository.",
               [](const T&) { return sourceCommit(); }),
        output<&T::date>("date", "Date and time in UTC, in the format of ISO 8601."),
        field<&T::command>("command", "The command that repeats the run.")};
    std::ranges::move(further, std::back_inserter(fields));
    return fields;
}

template <typename T>
base::Field confidenceField() {
    return output("confidence", "Confidence of every interval.", [](const T&) { return kConfidence; });
}

}  // namespace

Fields fieldsOf(const CalibrationReport*) {
    using T = CalibrationReport;
    return withHead<T>(
        "glint-calibration",
        {field<&T::machine>("machine", "Where the calibration ran."),
         group(
             "method", "How the calibration measured.",
             {output<&T::rounds>("rounds", "Rounds; in each, every strategy is timed once, in random order."),
              output<&T::seed>("seed", "Seed of the order; round r renders with seed + r."),
              confidenceField<T>(), output<&T::quick>("quick", "Whether --quick was given."),
              output<&T::compileSeconds>("compileSeconds", "Wall-clock time of compiling all packages."),
              output<&T::seconds>("seconds", "Wall-clock time in seconds of everything so far.")}),
         output<&T::complete>("complete", "False if the run was cut short before the last point."),
         field<&T::entries>("points", "The points, in the order in which they were measured.")});
}

static Fields fieldsOf(const MeanInterval*) {
    using T = MeanInterval;
    return {output<&T::mean>("mean", "Mean over the rounds."),
            output<&T::low>("low", "Lower end of the 95 % confidence interval of the mean."),
            output<&T::high>("high", "Upper end of the 95 % confidence interval of the mean.")};
}

static Fields fieldsOf(const RemovedError*) {
    using T = RemovedError;
    return {output<&T::point>("point", "Id of the configuration."),
            output<&T::all>("removed", "Share of the default's error that goes; below 0 it grows."),
            output<&T::bias>("bias", "The part of it that no number of samples takes away."),
            output<&T::noise>("noise", "The part of it that samples take away, too.")};
}

static Fields fieldsOf(const ErrorPart*) {
    using T = ErrorPart;
    return {output<&T::setting>("setting", "Name of the setting."),
            output<&T::from>("from", "Value in the default."),
            output<&T::to>("to", "Value in the reference."), output<&T::removed>("", "")};
}

static Fields fieldsOf(const ErrorParts*) {
    using T = ErrorParts;
    return {output<&T::parts>("parts", "The approximations, the most bias first."),
            output<&T::exact>("exact", "All exact values together; null where that was not measured."),
            output<&T::noise>("noise", "Share that any number of samples would take away; 0 with one round."),
            output<&T::rest>("rest", "Share of bias that is in no part; below 0 the parts overlap.")};
}

static Fields fieldsOf(const SkippedValue*) {
    return {output<&SkippedValue::value>("value", "The value in the form of the command line."),
            output<&SkippedValue::reason>("reason", "Why the value was not tried.")};
}

static Fields fieldsOf(const Setting*) {
    using T = Setting;
    return {
        output<&T::name>("name", "Name of the option, without dashes."),
        output("option", "Option of glint render.", [](const T& setting) { return "--" + setting.name; }),
        output("stage", "When it is decided: `compile` means that another value needs another package.",
               [](const T& setting) { return setting.isCompiled ? "compile" : "render"; },
               {.names = {"compile", "render"}}),
        output<&T::approximates>("approximates", "Whether it changes the picture; others change time alone."),
        output("exact", "Value in the reference; null where that is the default's, or not worth trying.",
               [](const T& setting) {
                   return hasExactValue(setting) ? std::optional(setting.exact) : std::nullopt;
               }),
        output<&T::what>("what", "What the setting does, for people."),
        output<&T::base>("default", "Value of the default."),
        output<&T::values>("values", "The values that were tried, with the default."),
        output<&T::skipped>("skipped", "The values that were not tried.")};
}

static Fields fieldsOf(const BenchScene*) {
    using T = BenchScene;
    return {output<&T::file>("file", "Path as given on the command line."),
            output("name", "Name of the file.",
                   [](const T& scene) { return std::filesystem::path(scene.file).stem().string(); }),
            output("sceneInFile", "The scene that was read (--scene); null if there are none.",
                   [](const T& scene) { return compiler::orNone(scene.inFile); }),
            output<&T::triangles>("triangles", "Number of triangles of all instances."),
            output<&T::materials>("materials", "Number of materials."),
            output<&T::instances>("instances", "Number of instances."),
            output<&T::lights>("lights", "Number of lights, including the sun that is added."),
            output<&T::camera>("camera", "Name of the camera."),
            output<&T::width>("width", "Width in pixels."),
            output<&T::height>("height", "Height in pixels."),
            output<&T::environment>("environment", "File of the environment map.", {.orNull = true})};
}

static Fields fieldsOf(const Reference*) {
    using T = Reference;
    using Noise = image::ImageErrors;
    return {output<&T::samples>("samples", "Samples of each pixel."),
            output<&T::relativeError>("relativeError", "Root of noise.trimmed."),
            output<&T::target>("target", "The relative error that was asked for."),
            output<&T::reached>("reached", "Whether that error was reached."),
            group("noise", "Errors that a picture without any would show: of the reference's standard error.",
                  {output<&T::noise, &Noise::relMse>("relMse", "The error, measured as for points."),
                   output<&T::noise, &Noise::trimmed>("trimmed", "The error, measured as for points."),
                   output<&T::noise, &Noise::rmse>("rmse", "The error, measured as for points.")}),
            output<&T::cached>("cached", "Whether some samples come from an earlier run."),
            output<&T::seconds>("seconds", "Wall-clock time in seconds."),
            output("settings", "Settings that differ from the default, as on the command line.",
                   [](const T& it) { return inOrder(it.configuration); }),
            output<&T::exposure>("exposure", "Exposure of every picture and error, in stops.")};
}

static Fields fieldsOf(const BenchPoint*) {
    using T = BenchPoint;
    using Errors = image::ImageErrors;
    return {
        output<errorInterval<&Errors::relMse>>("relMse",
                                               "Mean of d² / (r² + 0.01), exposed, in linear light."),
        output<errorInterval<&Errors::rmse>>("rmse", "Root of the mean of d²."),
        output<errorInterval<&Errors::psnr>>("psnr", "In decibels, relative to white; null if infinite."),
        output<errorInterval<&Errors::p999>>("p999", "99.9th percentile of the relative error of a pixel."),
        output<errorInterval<&Errors::trimmed>>("trimmed", "relMse without the worst 0.1 % of the pixels."),
        output<errorInterval<&Errors::flip>>("flip", "Mean LDR-FLIP of the displayed pictures."),
        output("bias", "Mean of d over mean of r: light that is added or lost.",
               [](const T& point) { return meanOf(base::mapped<double>(point.errors, &Errors::bias)); })};
}

namespace {

Fields fieldsOf(const PassTimes*) {
    using T = PassTimes;
    return {output<&T::name>("name", "Name of the pass as in `glint render`; passes of cases are added up."),
            output<&T::time, &Interval::median>("median", "Median in milliseconds."),
            output<&T::time, &Interval::q1>("q1", "Lower quartile."),
            output<&T::time, &Interval::q3>("q3", "Upper quartile.")};
}

Fields fieldsOf(const PointOf*) {
    using T = PointOf;
    using Point = BenchPoint;
    return {
        output<&T::index>("id", "Index in `points`."),
        output<&T::point, &Point::name>("name", "The settings that differ from the default."),
        output("kind", "The reason for measuring it.", [](const T& it) { return nameOf(it.point().kind); },
               {.names = base::wordsFor<PointKind>()}),
        output("settings", "The settings that differ from the default, as on the command line.",
               [](const T& it) { return inOrder(it.point().configuration); }),
        output<&T::point, &Point::package>("package", "Folder that --candidate named; null for others.",
                                           {.orNull = true}),
        output<&T::point, &Point::filteredFrames>(
            "filteredFrames", "Frames that the filter of --only denoise has seen; 0 without it."),
        output("command", "The command that renders it.",
               [](const T& it) { return renderCommand(*it.report, it.point()); }),
        output("time",
               "Milliseconds of device time of a picture: the ratio to the default, in units of its median.",
               [](const T& it) {
                   return MeasuredTimes{timeOf(*it.report, it.index), it.point().times};
               }),
        output("ratio", "Ratio of its time to that of the default in the same round.",
               [](const T& it) { return timeRatio(it.point()); }),
        output("timeTie", "Whether the interval of the ratio contains 1.",
               [](const T& it) { return isTimeTie(it.point()); }),
        output<passesOf>("passes", "Times of the passes in all samples of a picture."),
        output<&T::point>("error", "Errors against the reference, each with an interval over the rounds."),
        output("errorTie",
               "Whether the interval of the error's ratio to that of the default, seed by seed, contains 1.",
               [](const T& it) { return isErrorTie(it.point()); }),
        output<&T::point, &Point::sameImage>("sameImage",
                                             "Whether every picture is bit-exact with the default's."),
        output("front", "Whether it is on the Pareto front.",
               [](const T& it) { return std::ranges::count(it.report->front, it.index) > 0; }),
        output<&T::point, &Point::tracer>("tracer", "Tracer that ran."),
        output<&T::point, &Point::ordering>("ordering", "The ordering; null without one.", {.orNull = true}),
        output<&T::point, &Point::counters, &Renderer::Counters::rays>("rays",
                                                                       "Rays of effects in the last sample."),
        output<&T::point, &Point::cases>("cases", "Number of shaders of hits."),
        output<&T::point, &Point::footprint, &Renderer::Footprint::pipelines>("pipelines", "Its pipelines."),
        output<&T::point, &Point::footprint, &Renderer::Footprint::bytes>("bytes", "Its images and buffers."),
        output("image", "File of the picture of the first round, relative to the folder.",
               [](const T& it) { return imageName(it.index); }),
        output("errorImage", "File of the map that shows how far the picture is from the reference.",
               [](const T& it) { return errorImageName(it.index); })};
}

Fields fieldsOf(const RowOf*) {
    using T = RowOf;
    using Row = StrategyRow;
    return {
        output<&T::row, &Row::strategy>("strategy", "Name of the strategy."),
        output<&T::row, &Row::point>("point", "Id of the configuration."),
        output("time", "Time of a picture.", [](const T& it) { return timeOf(*it.report, it.row->point); }),
        output<&T::row, &Row::ratio>("ratio", "Ratio of this time to that of the default."),
        output<&T::row, &Row::hits>("hits", "Milliseconds of the passes that strategies differ in."),
        output<&T::row, &Row::hitRatio>("hitRatio", "Their ratio to the default's in the same round."),
        output<&T::row, &Row::traceMs>("traceMs", "Time of tracing, if a separate pass traces hits."),
        output<&T::row, &Row::orderMs>("orderMs", "Time of sorting hits: the passes count, offset and copy."),
        output<&T::row, &Row::shadeMs>("shadeMs", "Time of shading; with tracing where no pass does that."),
        output<&T::row, &Row::commonMs>("commonMs", "Time of the work that every strategy does alike."),
        output<&T::row, &Row::rays>("rays", "Number of rays of the last sample.")};
}

Fields fieldsOf(const AdviceOf*) {
    using T = AdviceOf;
    using Advice = BenchAdvice;
    return {
        output<&T::advice, &Advice::budgetMs>("budgetMs", "The limit of --budget-ms."),
        output<&T::advice, &Advice::maxError>("maxError", "The limit of --max-error."),
        output("metric", "Metric of the error.", [](const T& it) { return nameOf(it.report->metric); }),
        output<&T::advice, &Advice::point>("point",
                                           "Id of the configuration; null if none is within the limits."),
        output("file", "File with its settings, for `--settings`.",
               [](const T& it) { return it.advice->point ? std::optional(it.advice->file) : std::nullopt; }),
        output("compile", "Options with which its package is compiled; absent without a configuration.",
               [](const T& it) { return it.decided(true); }, {.optional = true}),
        output("render", "Options with which it is rendered; absent without a configuration.",
               [](const T& it) { return it.decided(false); }, {.optional = true}),
        output<&T::advice, &Advice::why>("why", "An explanation for people.")};
}

std::vector<PointOf> pointsOf(const BenchReport& report) {
    std::vector<PointOf> points;
    for (std::size_t i = 0; i < report.points.size(); ++i) {
        points.push_back({&report, i});
    }
    return points;
}

std::vector<RowOf> rowsOf(const BenchReport& report) {
    return base::mapped<RowOf>(report.strategies.rows, [&](const StrategyRow& row) {
        return RowOf{&report, &row};
    });
}

std::optional<AdviceOf> adviceOf(const BenchReport& report) {
    return report.advice ? std::optional(AdviceOf{&report, &*report.advice}) : std::nullopt;
}

}  // namespace

Fields fieldsOf(const BenchReport*) {
    using T = BenchReport;
    using Strategies = StrategyReport;
    return withHead<T>(
        "glint-bench",
        {output<&T::scene>("scene", "The scene and the view that were rendered."),
         output<&T::machine>("machine", "Where the bench ran."),
         group(
             "method", "How the bench measured.",
             {output<&T::rounds>("rounds", "Pictures of each configuration, each with other random numbers."),
              output<&T::seed>("seed", "Seed of the first round and of the order."), confidenceField<T>(),
              output<&T::quick>("quick", "Whether --quick was given."),
              output<&T::batch>("batch", "Configurations at a time, besides the default."),
              output<pictureScale>("pictureScale", "How much smaller the page's pictures are."),
              output<&T::seconds>("seconds", "Wall-clock time in seconds."),
              output("metric", "The error that configurations are ordered by.",
                     [](const T& report) { return nameOf(report.metric); })}),
         group("reference", "The picture that errors are measured against.",
               {output("image", "File of the picture, relative to the folder.",
                       [](const T&) { return kReferenceImage; }),
                output("transport",
                       "Whether the reference has all of light transport, or that of the default "
                       "(--reference).",
                       [](const T& report) { return report.reference.isFull ? "full" : "same"; },
                       {.names = {"full", "same"}}),
                output<describeReference>("what", "What the reference is, in words."),
                output<&T::reference>("", "")}),
         output<&T::settings>("settings", "All settings, or those of --only."),
         output<pointsOf>("points", "The configurations that were measured; the default comes first.",
                          {.leastElements = 1}),
         output<&T::front>("front", "Ids on the Pareto front of error against time, the fastest first."),
         output<adviceOf>("advice", "Advice for --budget-ms and --max-error; null if none was asked for."),
         output<&T::errorParts>("errorParts", "Which share of the default's error is which approximation."),
         group(
             "strategies", "Which strategy is fastest, and why. Milliseconds are medians.",
             {output<&T::strategies, &Strategies::fastest>("fastest", "The fastest; several are a tie.",
                                                           {.names = compiler::strategyWords()}),
              output<rowsOf>("rows", "The strategies that were measured, with the default's other settings."),
              output<&T::strategies, &Strategies::cases>("cases", "Shaders of hits; 0 if none was counted."),
              output<&T::strategies, &Strategies::filledCases>("filledCases", "Those that have a hit."),
              output<&T::strategies, &Strategies::largestShare>("largestShare", "The most that one has."),
              output<&T::strategies, &Strategies::casesInWave>("casesInWave",
                                                               "Different ones among 32 hits."),
              output<&T::strategies, &Strategies::why>("why", "Sentences that explain the choice.")})});
}

}  // namespace glint::measure
