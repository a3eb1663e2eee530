#include "ladder.h"

#include "evaluate.h"
#include "spirv/statistics.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <random>
#include <utility>

namespace glint::numerics {
namespace {

// Elements whose evaluations are timed; they stay in a cache of any device.
constexpr std::uint32_t kElements = 4096;
// Enough to fill a GPU; a CPU is full with as many as it has lanes.
constexpr std::uint32_t kGpuThreads = 1U << 18U;
constexpr std::uint32_t kCpuThreads = 1U << 12U;
constexpr std::uint32_t kLeastRepeats = 16;
constexpr std::uint32_t kMostRepeats = 1U << 16U;

// Of functions without a textbook's form, by their probes.
constexpr std::string_view kFurther[] = {"GgxDistributionAnisotropic",
                                         "GgxVisibilityAnisotropic",
                                         "SampleVisibleNormal",
                                         "VisibleNormalPdf",
                                         "SheenDistribution",
                                         "SheenVisibility",
                                         "IridescentFresnel",
                                         "RefractDirection",
                                         "ThinTransmission",
                                         "GgxAlbedo",
                                         "GgxMeanAlbedo",
                                         "SheenAlbedo",
                                         "EvaluateBsdf",
                                         "EvaluateUnderSheen",
                                         "BsdfPdf",
                                         "SampleBsdf"};

// A loop of 100,000 samples is no function of shading.
constexpr std::string_view kLeftOut = "RunningMean";

// What is timed by itself: a rung, or a kernel without the function.
struct Timed {
    std::size_t row = 0;
    RungKind kind = RungKind::Single;
    bool isBase = false;                    // without the function
    std::optional<ProbePipeline> pipeline;  // nothing: C++
    void (*call)(const double*, double*) = nullptr;
    std::uint32_t repeats = kLeastRepeats;
    std::vector<double> nanoseconds;  // an evaluation, by round
};

ProbePrecision precisionOf(RungKind kind) {
    switch (kind) {
        case RungKind::Mixed:
            return ProbePrecision::Mixed;
        case RungKind::Half:
            return ProbePrecision::Half;
        case RungKind::Textbook:
        case RungKind::Single:
        case RungKind::Double:
            break;
    }
    return ProbePrecision::Single;
}

std::string_view probeOf(const Probe& probe, RungKind kind) {
    return kind == RungKind::Textbook ? probe.textbook : probe.name;
}

Result<std::uint32_t> countInstructions(const ProbePipeline& pipeline) {
    const Result<SpirvStatistics> statistics = measureSpirv(pipeline.spirv);
    return statistics ? Result<std::uint32_t>(statistics->instructions) : statistics.error();
}

class Climber {
public:
    Climber(ProbeDevice& device, const LadderOptions& options) : device_(device), options_(options) {}

    Result<Ladder> climb();

private:
    Status addRow(const Probe& probe);
    Status addRung(std::size_t row, RungKind kind);
    Status addErrors(LadderRow& row);
    Status measureRounds();
    Status calibrate(Timed& timed);
    Result<double> measureOnce(Timed& timed);
    Result<double> measureDevice(const Timed& timed, std::uint32_t repeats);
    double measureHost(const Timed& timed, std::uint32_t repeats);
    std::uint32_t threads() const {
        return device_.isCpu() ? kCpuThreads : kGpuThreads;
    }
    std::vector<double> timesOf(std::size_t row, RungKind kind) const;
    const Timed* findTimed(std::size_t row, RungKind kind, bool isBase) const;
    void summarise(std::size_t row);

    ProbeDevice& device_;
    const LadderOptions& options_;
    Ladder ladder_;
    std::vector<Timed> timed_;
    std::vector<std::vector<float>> inputs_;  // by row
};

Status Climber::addRung(std::size_t row, RungKind kind) {
    const Probe& probe = ladder_.rows[row].probe;
    const ProbePrecision precision = precisionOf(kind);
    Result<ProbePipeline> pipeline =
        device_.compileTimed(probeOf(probe, kind), probe.inputs, probe.outputs, precision);
    if (!pipeline) {
        return pipeline.error();
    }
    // All in half precision has loads and sums of its own; the others share them.
    const RungKind baseKind = kind == RungKind::Half ? RungKind::Half : RungKind::Single;
    const Timed* base = findTimed(row, baseKind, true);
    if (base == nullptr) {
        Result<ProbePipeline> without =
            device_.compileTimed({}, probe.inputs, probe.outputs, precisionOf(baseKind));
        if (!without) {
            return without.error();
        }
        timed_.push_back({row, baseKind, true, std::move(*without), nullptr, kLeastRepeats, {}});
        base = &timed_.back();
    }
    const Result<std::uint32_t> all = countInstructions(*pipeline);
    const Result<std::uint32_t> around = countInstructions(*base->pipeline);
    if (!all || !around) {
        return all ? around.error() : all.error();
    }
    if (kind == RungKind::Mixed &&
        pipeline->spirv == findTimed(row, RungKind::Single, false)->pipeline->spirv) {
        return okStatus();  // nothing of it is in 16 bits
    }
    // The base sums up inputs, the kernel outputs.
    const int sums = probe.inputs - probe.outputs;
    const auto cost = static_cast<int>(*all) - static_cast<int>(*around) + sums;
    Rung rung;
    rung.kind = kind;
    rung.instructions = static_cast<std::uint32_t>(std::max(cost, 0));
    ladder_.rows[row].rungs.push_back(rung);
    timed_.push_back({row, kind, false, std::move(*pipeline), nullptr, kLeastRepeats, {}});
    return okStatus();
}

Status Climber::addRow(const Probe& probe) {
    const std::size_t row = ladder_.rows.size();
    ladder_.rows.push_back({probe, {}});
    inputs_.push_back(firstInputs(probe, options_.seed, kElements));
    std::vector<RungKind> kinds{RungKind::Single};
    if (!probe.textbook.empty()) {
        kinds.insert(kinds.begin(), RungKind::Textbook);
    }
    if (device_.hasHalf()) {
        kinds.push_back(RungKind::Mixed);
        kinds.push_back(RungKind::Half);
    }
    for (const RungKind kind : kinds) {
        if (Status status = addRung(row, kind); !status) {
            return status;
        }
    }
    const std::span<const ProbeFunction<double>> functions = doubleProbes();
    const auto found = std::ranges::find(functions, probe.name, &ProbeFunction<double>::name);
    Rung twice;
    twice.kind = RungKind::Double;
    ladder_.rows[row].rungs.push_back(twice);
    timed_.push_back({row, RungKind::Double, false, std::nullopt, found->call, kLeastRepeats, {}});
    return addErrors(ladder_.rows[row]);
}

RungErrors errorsOf(const ErrorStatistics& statistics, std::uint64_t undecided, std::uint64_t inputs) {
    const auto count = static_cast<double>(inputs);
    return {statistics.worst(), statistics.median(), static_cast<double>(statistics.notFinite()) / count,
            static_cast<double>(undecided) / count};
}

Status Climber::addErrors(LadderRow& row) {
    std::vector<ProbePrecision> fewer;
    for (const Rung& rung : row.rungs) {
        if (precisionOf(rung.kind) != ProbePrecision::Single) {
            fewer.push_back(precisionOf(rung.kind));
        }
    }
    const Result<ProbeResult> measured = measure(device_, row.probe, {options_.inputs, options_.seed}, fewer);
    if (!measured) {
        return measured.error();
    }
    for (Rung& rung : row.rungs) {
        if (rung.kind == RungKind::Textbook) {
            rung.errors = errorsOf(*measured->textbook, 0, measured->inputs);
        } else if (rung.kind == RungKind::Single) {
            rung.errors = errorsOf(measured->device, measured->undecided, measured->inputs);
        }
        for (const ProbeResult::Fewer& statistics : measured->fewer) {
            if (statistics.precision == precisionOf(rung.kind)) {
                rung.errors = errorsOf(statistics.statistics, statistics.undecided, measured->inputs);
            }
        }
    }
    return okStatus();
}

Result<double> Climber::measureDevice(const Timed& timed, std::uint32_t repeats) {
    device_.setInputs(inputs_[timed.row]);
    return device_.time(*timed.pipeline, kElements, threads(), repeats);
}

// Milliseconds of as many passes over all elements.
double Climber::measureHost(const Timed& timed, std::uint32_t repeats) {
    const std::size_t width = static_cast<std::size_t>(ladder_.rows[timed.row].probe.inputs);
    const std::vector<double> inputs(inputs_[timed.row].begin(), inputs_[timed.row].end());
    std::array<double, kMaxOutputs> outputs{};
    const auto start = std::chrono::steady_clock::now();
    for (std::uint32_t repeat = 0; repeat < repeats; ++repeat) {
        for (std::uint32_t element = 0; element < kElements; ++element) {
            timed.call(inputs.data() + element * width, outputs.data());
        }
    }
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

// Finds how often to repeat; the first run warms up, too.
Status Climber::calibrate(Timed& timed) {
    if (!timed.pipeline) {
        timed.repeats = 1;
    }
    while (timed.repeats < kMostRepeats) {
        const Result<double> once =
            timed.pipeline ? measureDevice(timed, timed.repeats) : measureHost(timed, timed.repeats);
        if (!once) {
            return once.error();
        }
        if (*once >= options_.leastMilliseconds) {
            break;
        }
        timed.repeats *= 2;
    }
    return okStatus();
}

// Nanoseconds of an evaluation.
Result<double> Climber::measureOnce(Timed& timed) {
    constexpr double kNanosecondsInOne = 1e6;
    const Result<double> milliseconds =
        timed.pipeline ? measureDevice(timed, timed.repeats) : measureHost(timed, timed.repeats);
    if (!milliseconds) {
        return milliseconds;
    }
    const double evaluations =
        static_cast<double>(timed.pipeline ? threads() : kElements) * static_cast<double>(timed.repeats);
    return *milliseconds * kNanosecondsInOne / evaluations;
}

// Every kernel once a round, in an order that is drawn anew.
Status Climber::measureRounds() {
    for (Timed& timed : timed_) {
        if (Status status = calibrate(timed); !status) {
            return status;
        }
    }
    std::vector<Timed*> order;
    for (Timed& timed : timed_) {
        order.push_back(&timed);
    }
    std::mt19937_64 engine(options_.seed);
    for (int round = 0; round < options_.rounds; ++round) {
        std::ranges::shuffle(order, engine);
        for (Timed* timed : order) {
            const Result<double> time = measureOnce(*timed);
            if (!time) {
                return time.error();
            }
            timed->nanoseconds.push_back(*time);
        }
    }
    return okStatus();
}

const Timed* Climber::findTimed(std::size_t row, RungKind kind, bool isBase) const {
    const auto found = std::ranges::find_if(timed_, [&](const Timed& timed) {
        return timed.row == row && timed.kind == kind && timed.isBase == isBase;
    });
    return found == timed_.end() ? nullptr : &*found;
}

// By round: what the kernel takes more than one without the function does on the whole. (Less in one round
// than in another by chance, that one would show in the difference.)
std::vector<double> Climber::timesOf(std::size_t row, RungKind kind) const {
    std::vector<double> times = findTimed(row, kind, false)->nanoseconds;
    if (kind != RungKind::Double) {
        const Timed* base = findTimed(row, kind == RungKind::Half ? kind : RungKind::Single, true);
        const double around = spreadOf(base->nanoseconds).median;
        for (double& time : times) {
            time -= around;
        }
    }
    return times;
}

void Climber::summarise(std::size_t row) {
    LadderRow& result = ladder_.rows[row];
    const RungKind reference =
        result.find(RungKind::Textbook) != nullptr ? RungKind::Textbook : RungKind::Single;
    const Spread referenceSpread = spreadOf(timesOf(row, reference));
    for (Rung& rung : result.rungs) {
        std::vector<double> times = timesOf(row, rung.kind);
        rung.nanoseconds = spreadOf(times);
        // The host's time is of another machine; by what is lost in that of the kernel around it nothing is
        // divided.
        if (rung.kind == reference || rung.kind == RungKind::Double || referenceSpread.low <= 0.0) {
            continue;
        }
        for (double& time : times) {
            time /= referenceSpread.median;
        }
        rung.ratio = spreadOf(times);
        rung.tie = isTie(rung.nanoseconds, referenceSpread);
    }
}

Result<Ladder> Climber::climb() {
    ladder_.device = device_.description();
    ladder_.options = options_;
    ladder_.hasHalf = device_.hasHalf();
    for (const Probe& probe : ladderProbes()) {
        if (options_.function.empty() || probe.function == options_.function) {
            if (Status status = addRow(probe); !status) {
                return status.error();
            }
        }
    }
    if (Status status = measureRounds(); !status) {
        return status.error();
    }
    for (std::size_t row = 0; row < ladder_.rows.size(); ++row) {
        summarise(row);
    }
    return std::move(ladder_);
}

}  // namespace

std::string_view nameOf(RungKind kind) {
    switch (kind) {
        case RungKind::Textbook:
            return "textbook";
        case RungKind::Single:
            return "float";
        case RungKind::Mixed:
            return "precision 16";
        case RungKind::Half:
            return "half";
        case RungKind::Double:
            return "double";
    }
    return "";
}

const Rung* LadderRow::find(RungKind kind) const {
    const auto found = std::ranges::find(rungs, kind, &Rung::kind);
    return found == rungs.end() ? nullptr : &*found;
}

LadderCounts countRungs(const Ladder& ladder) {
    LadderCounts counts;
    for (const LadderRow& row : ladder.rows) {
        const Rung* const ours = row.find(RungKind::Single);
        if (row.find(RungKind::Textbook) == nullptr) {
            continue;
        }
        int& counted = !ours->ratio                ? counts.unknown
                       : ours->tie                 ? counts.ties
                       : ours->ratio->median < 1.0 ? counts.faster
                                                   : counts.slower;
        ++counted;
    }
    return counts;
}

std::vector<Probe> ladderProbes() {
    std::vector<Probe> probes;
    std::ranges::copy_if(allProbes(), std::back_inserter(probes), [](const Probe& probe) {
        const bool further = std::ranges::find(kFurther, probe.name) != std::end(kFurther);
        return further || (!probe.textbook.empty() && probe.name != kLeftOut);
    });
    return probes;
}

Result<Ladder> climb(ProbeDevice& device, const LadderOptions& options) {
    return Climber(device, options).climb();
}

}  // namespace glint::numerics
