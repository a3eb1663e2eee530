#include "ladder.h"

#include "evaluate.h"
#include "kernel_timer.h"
#include "spirv/statistics.h"

#include <algorithm>
#include <utility>

namespace glint::numerics {
namespace {

// The probes of functions for which there is no textbook form.
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

// A loop of 100,000 samples is not a function of shading.
constexpr std::string_view kLeftOut = "RunningMean";

// A rung, or the kernel around its function.
struct Climbing {
    std::size_t row = 0;
    RungKind kind = RungKind::Single;
    bool isBase = false;  // without the function
    TimedKernel kernel;
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
    const Result<compiler::SpirvStatistics> statistics = compiler::measureSpirv(pipeline.spirv);
    return statistics ? Result<std::uint32_t>(statistics->instructions) : statistics.error();
}

class Climber {
public:
    Climber(ProbeDevice& device, const LadderOptions& options)
        : device_(device), options_(options), timer_(device, options.leastMilliseconds) {}

    Result<Ladder> climb();

private:
    Status addRow(const Probe& probe);
    Status addRung(std::size_t row, RungKind kind);
    Status addErrors(LadderRow& row);
    std::vector<double> timesOf(std::size_t row, RungKind kind) const;
    const TimedKernel* findKernel(std::size_t row, RungKind kind, bool isBase) const;
    void summarise(std::size_t row);

    ProbeDevice& device_;
    const LadderOptions& options_;
    Ladder ladder_;
    KernelTimer timer_;
    std::vector<Climbing> climbing_;
};

Status Climber::addRung(std::size_t row, RungKind kind) {
    const Probe& probe = ladder_.rows[row].probe;
    const ProbePrecision precision = precisionOf(kind);
    GLINT_TRY(auto pipeline,
              device_.compileTimed(probeOf(probe, kind), probe.inputs, probe.outputs, precision));
    // The kernel in half precision has its own loads and sums; the other kinds share them.
    const RungKind baseKind = kind == RungKind::Half ? RungKind::Half : RungKind::Single;
    if (findKernel(row, baseKind, true) == nullptr) {
        GLINT_TRY(auto without, device_.compileTimed({}, probe.inputs, probe.outputs, precisionOf(baseKind)));
        climbing_.push_back({row, baseKind, true, {row, std::move(without)}});
    }
    const Result<std::uint32_t> all = countInstructions(pipeline);
    const Result<std::uint32_t> around = countInstructions(*findKernel(row, baseKind, true)->pipeline);
    if (!all || !around) {
        return all ? around.error() : all.error();
    }
    if (kind == RungKind::Mixed &&
        pipeline.spirv == findKernel(row, RungKind::Single, false)->pipeline->spirv) {
        return okStatus();  // nothing of it is in 16 bits
    }
    // The base sums up inputs; the kernel sums up outputs.
    const int sums = probe.inputs - probe.outputs;
    const auto cost = static_cast<int>(*all) - static_cast<int>(*around) + sums;
    Rung rung;
    rung.kind = kind;
    rung.instructions = static_cast<std::uint32_t>(std::max(cost, 0));
    ladder_.rows[row].rungs.push_back(rung);
    climbing_.push_back({row, kind, false, {row, std::move(pipeline)}});
    return okStatus();
}

Status Climber::addRow(const Probe& probe) {
    const std::size_t row = ladder_.rows.size();
    ladder_.rows.push_back({probe, {}});
    timer_.addInputs(firstInputs(probe, options_.seed, KernelTimer::kElements));
    std::vector<RungKind> kinds{RungKind::Single};
    if (!probe.textbook.empty()) {
        kinds.insert(kinds.begin(), RungKind::Textbook);
    }
    if (device_.hasHalf()) {
        kinds.push_back(RungKind::Mixed);
        kinds.push_back(RungKind::Half);
    }
    for (const RungKind kind : kinds) {
        GLINT_TRY_DO(addRung(row, kind));
    }
    const std::span<const ProbeFunction<double>> functions = probeFunctions<double>();
    const auto found = std::ranges::find(functions, probe.name, &ProbeFunction<double>::name);
    Rung twice;
    twice.kind = RungKind::Double;
    ladder_.rows[row].rungs.push_back(twice);
    climbing_.push_back({row,
                         RungKind::Double,
                         false,
                         {row, std::nullopt, found->call, static_cast<std::size_t>(probe.inputs)}});
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
    GLINT_TRY(const auto measured, measure(device_, row.probe, {options_.inputs, options_.seed}, fewer));
    for (Rung& rung : row.rungs) {
        if (rung.kind == RungKind::Textbook) {
            rung.errors = errorsOf(*measured.textbook, 0, measured.inputs);
        } else if (rung.kind == RungKind::Single) {
            rung.errors = errorsOf(measured.device, measured.undecided, measured.inputs);
        }
        for (const ProbeResult::Fewer& statistics : measured.fewer) {
            if (statistics.precision == precisionOf(rung.kind)) {
                rung.errors = errorsOf(statistics.statistics, statistics.undecided, measured.inputs);
            }
        }
    }
    return okStatus();
}

const TimedKernel* Climber::findKernel(std::size_t row, RungKind kind, bool isBase) const {
    const auto found = std::ranges::find_if(climbing_, [&](const Climbing& climbing) {
        return climbing.row == row && climbing.kind == kind && climbing.isBase == isBase;
    });
    return found == climbing_.end() ? nullptr : &found->kernel;
}

// Returns for each round how much longer the kernel takes than one without the function takes on average.
// (The average is used because a base that was fast by chance in one round would distort the difference.)
std::vector<double> Climber::timesOf(std::size_t row, RungKind kind) const {
    std::vector<double> times = findKernel(row, kind, false)->nanoseconds;
    if (kind != RungKind::Double) {
        const TimedKernel* base = findKernel(row, kind == RungKind::Half ? kind : RungKind::Single, true);
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
        // The host's times are for another processor. A reference whose time is lost in that of the kernel
        // around it can't be divided by.
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
            GLINT_TRY_DO(addRow(probe));
        }
    }
    std::vector<TimedKernel*> kernels;
    for (Climbing& climbing : climbing_) {
        kernels.push_back(&climbing.kernel);
    }
    GLINT_TRY_DO(timer_.measure(kernels, options_.rounds, options_.seed));
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
