#include "measure.h"

#include "evaluate.h"

#include <algorithm>
#include <array>
#include <cfloat>
#include <cstdlib>
#include <future>
#include <thread>

namespace glint::numerics {
namespace {

constexpr std::uint32_t kChunk = 4096;

std::uint64_t fromEnvironment(const char* name, std::uint64_t fallback) {
    const char* text = std::getenv(name);
    const std::uint64_t value = text == nullptr ? 0 : std::strtoull(text, nullptr, 10);
    return value == 0 ? fallback : value;
}

template <typename Real>
auto findCall(std::span<const ProbeFunction<Real>> functions, std::string_view name) {
    const auto found = std::ranges::find(functions, name, &ProbeFunction<Real>::name);
    return found == functions.end() ? nullptr : found->call;
}

struct Calls {
    void (*single)(const float*, float*) = nullptr;
    void (*twice)(const double*, double*) = nullptr;
};

Result<Calls> findCalls(std::string_view name) {
    const Calls calls{findCall(probeFunctions<float>(), name), findCall(probeFunctions<double>(), name)};
    if (calls.single == nullptr) {
        return makeError("probe-name", std::string(name),
                         "no probe of that name in probes_*.glsl or textbook.glsl",
                         "name the probe as PROBE() does");
    }
    return calls;
}

// Adds the errors of `values` against `truth`. Both have scale and decision behind the outputs.
template <typename Real>
bool compare(const Probe& probe, const Real* values, const double* truth, const float* inputs,
             ErrorStatistics& statistics) {
    for (int k = 0; k < probe.allOutputs(); ++k) {
        if (!std::isfinite(values[k])) {
            statistics.addNotFinite(k, inputs, probe.inputs);
            return true;
        }
    }
    if (probe.decides()) {
        const int decision = probe.allOutputs() - 1;
        if (static_cast<double>(values[decision]) != truth[decision]) {
            if (probe.givesEdge) {
                statistics.add(truth[0], decision, inputs, probe.inputs);
            }
            return false;
        }
    }
    const double scale = probe.hasScale ? std::abs(truth[probe.outputs]) : 1.0;
    for (int k = 0; k < probe.outputs; ++k) {
        // The smallest normal number replaces a scale of 0, because devices may flush smaller ones.
        const double against =
            std::max({std::abs(truth[k]), probe.bounds.floorShare * scale, static_cast<double>(FLT_MIN)});
        statistics.add(std::abs(static_cast<double>(values[k]) - truth[k]) / against, k, inputs,
                       probe.inputs);
    }
    return true;
}

// One batch of inputs, with the results of each implementation.
struct Batch {
    std::vector<float> inputs;
    std::vector<float> device;
    std::vector<float> textbook;
    std::vector<std::vector<float>> fewer;
};

struct Chunk {
    std::uint32_t first = 0;
    std::uint32_t count = 0;
};

struct ChunkResult {
    ErrorStatistics device;
    ErrorStatistics single;
    ErrorStatistics textbook;
    std::uint64_t undecided = 0;
    std::vector<ProbeResult::Fewer> fewer;
};

ChunkResult compareChunk(const Probe& probe, const Calls& ours, const Calls& textbook, const Batch& batch,
                         Chunk chunk) {
    ChunkResult result;
    result.fewer.resize(batch.fewer.size());
    std::array<double, kMaxInputs> inputs{};
    std::array<double, kMaxOutputs> truth{};
    std::array<double, kMaxOutputs> textbookTruth{};
    std::array<float, kMaxOutputs> single{};
    for (std::uint32_t element = chunk.first; element < chunk.first + chunk.count; ++element) {
        const float* given = batch.inputs.data() + std::size_t{element} * probe.inputs;
        std::copy_n(given, probe.inputs, inputs.begin());
        const std::size_t output = std::size_t{element} * probe.allOutputs();
        ours.twice(inputs.data(), truth.data());
        ours.single(given, single.data());
        result.undecided +=
            compare(probe, batch.device.data() + output, truth.data(), given, result.device) ? 0 : 1;
        compare(probe, single.data(), truth.data(), given, result.single);
        for (std::size_t k = 0; k < batch.fewer.size(); ++k) {
            result.fewer[k].undecided += compare(probe, batch.fewer[k].data() + output, truth.data(), given,
                                                 result.fewer[k].statistics)
                                             ? 0
                                             : 1;
        }
        if (textbook.twice != nullptr) {
            if (probe.textbookAgainstItself) {
                textbook.twice(inputs.data(), textbookTruth.data());
            }
            compare(probe, batch.textbook.data() + output,
                    probe.textbookAgainstItself ? textbookTruth.data() : truth.data(), given,
                    result.textbook);
        }
    }
    return result;
}

// Calls work(chunk) for each chunk of `count` elements, on all cores. Returns the results in the order of the
// chunks.
template <typename Work>
auto forChunks(std::uint32_t count, const Work& work) {
    std::vector<Chunk> chunks;
    for (std::uint32_t first = 0; first < count; first += kChunk) {
        chunks.push_back({first, std::min(kChunk, count - first)});
    }
    std::vector<decltype(work(Chunk{}))> results(chunks.size());
    const std::size_t threads = std::max(1U, std::thread::hardware_concurrency());
    std::vector<std::future<void>> running;
    for (std::size_t thread = 0; thread < threads; ++thread) {
        running.push_back(std::async(std::launch::async, [&, thread] {
            for (std::size_t i = thread; i < chunks.size(); i += threads) {
                results[i] = work(chunks[i]);
            }
        }));
    }
    for (std::future<void>& future : running) {
        future.get();
    }
    return results;
}

void fillInputs(const Probe& probe, std::uint64_t seed, std::uint64_t batch, std::uint32_t count,
                std::vector<float>& inputs) {
    inputs.resize(std::size_t{count} * probe.inputs);
    forChunks(count, [&](Chunk chunk) {
        // Each chunk has its own stream, so that inputs do not depend on the number of cores.
        std::seed_seq sequence{seed, seed >> 32U, batch, std::uint64_t{chunk.first}};
        std::array<std::uint32_t, 2> word{};
        sequence.generate(word.begin(), word.end());
        InputSource source((std::uint64_t{word[0]} << 32U) | word[1]);
        for (std::uint32_t element = chunk.first; element < chunk.first + chunk.count; ++element) {
            source.start(inputs.data() + std::size_t{element} * probe.inputs);
            probe.fill(source);
        }
        return 0;
    });
}

}  // namespace

MeasureOptions optionsFromEnvironment() {
    const MeasureOptions defaults;
    return {fromEnvironment("GLINT_NUMERIC_INPUTS", defaults.inputs),
            fromEnvironment("GLINT_NUMERIC_SEED", defaults.seed)};
}

std::vector<float> firstInputs(const Probe& probe, std::uint64_t seed, std::uint32_t count) {
    std::vector<float> inputs;
    fillInputs(probe, seed, 0, count, inputs);
    return inputs;
}

Result<ProbeResult> measure(ProbeDevice& device, const Probe& probe, const MeasureOptions& options,
                            std::span<const ProbePrecision> fewer) {
    GLINT_TRY(const auto ours, findCalls(probe.name));
    const bool hasTextbook = !probe.textbook.empty();
    GLINT_TRY(const auto textbook, hasTextbook ? findCalls(probe.textbook) : Result<Calls>(Calls{}));
    GLINT_TRY(auto pipeline, device.compile(probe.name, probe.inputs, probe.allOutputs()));
    GLINT_TRY(auto textbookPipeline, hasTextbook
                                         ? device.compile(probe.textbook, probe.inputs, probe.allOutputs())
                                         : Result<ProbePipeline>(ProbePipeline{}));

    std::vector<ProbePipeline> fewerPipelines;
    for (const ProbePrecision precision : fewer) {
        GLINT_TRY(auto made, device.compile(probe.name, probe.inputs, probe.allOutputs(), precision));
        fewerPipelines.push_back(std::move(made));
    }

    ProbeResult result;
    for (const ProbePrecision precision : fewer) {
        result.fewer.push_back({precision, {}, 0});
    }
    result.inputs = probe.inputLimit == 0 ? options.inputs : std::min(options.inputs, probe.inputLimit);
    result.seed = options.seed;
    if (hasTextbook) {
        result.textbook.emplace();
    }
    Batch batch;
    batch.fewer.resize(fewer.size());
    for (std::uint64_t done = 0; done < result.inputs; done += ProbeDevice::kBatch) {
        const auto count =
            static_cast<std::uint32_t>(std::min<std::uint64_t>(ProbeDevice::kBatch, result.inputs - done));
        fillInputs(probe, options.seed, done / ProbeDevice::kBatch, count, batch.inputs);
        batch.device.resize(std::size_t{count} * probe.allOutputs());
        GLINT_TRY_DO(device.run(pipeline, batch.inputs, batch.device));
        if (hasTextbook) {
            batch.textbook.resize(batch.device.size());
            GLINT_TRY_DO(device.run(textbookPipeline, batch.inputs, batch.textbook));
        }
        for (std::size_t k = 0; k < fewer.size(); ++k) {
            batch.fewer[k].resize(batch.device.size());
            GLINT_TRY_DO(device.run(fewerPipelines[k], batch.inputs, batch.fewer[k]));
        }
        const auto chunks =
            forChunks(count, [&](Chunk chunk) { return compareChunk(probe, ours, textbook, batch, chunk); });
        for (const ChunkResult& chunk : chunks) {
            result.device.merge(chunk.device);
            result.single.merge(chunk.single);
            result.undecided += chunk.undecided;
            for (std::size_t k = 0; k < fewer.size(); ++k) {
                result.fewer[k].statistics.merge(chunk.fewer[k].statistics);
                result.fewer[k].undecided += chunk.fewer[k].undecided;
            }
            if (hasTextbook) {
                result.textbook->merge(chunk.textbook);
            }
        }
    }
    return result;
}

}  // namespace glint::numerics
