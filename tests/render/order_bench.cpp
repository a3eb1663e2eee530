// Times the orderings: device time of all passes by number of hits, number of buckets and spread of the hits,
// beside a plain copy of as many words in the same run. Each round runs everything once, in the same order,
// so that other load on the machine slows all of them alike. Each run goes over several copies of the
// problem, so that no cache keeps data from the previous run.
#include "render/order_problems.h"
#include "support/quantile.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <exception>
#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace {

using namespace glint;
using namespace glint::testing;
using package::Ordering;
using Clock = std::chrono::steady_clock;

constexpr auto kOrderingCount = static_cast<std::uint32_t>(Ordering::Count);
// Together they are larger than the caches of a GPU.
constexpr std::uint64_t kWordsOfCopies = 64U << 20U;

struct Arguments {
    std::uint32_t rounds = 11;
    std::vector<std::uint32_t> hits{57600};
    std::vector<std::uint32_t> buckets{2, 16, 64, 256, 1024};
    std::vector<std::string> orderings;
    std::string json;
    std::uint32_t warmUpMs = 300;
};

// The milliseconds of one ordering, with one value for each run.
struct Times {
    std::vector<double> count;
    std::vector<double> offset;
    std::vector<double> copy;
    std::vector<double> total;
};

struct Row {
    std::uint32_t hits = 0;
    std::uint32_t buckets = 0;
    Spread spread{};
    std::map<Ordering, Times> orderings;
    std::vector<double> plainCopy;
};

bool holds(Ordering ordering, std::uint32_t buckets) {
    const bool isLocal = ordering == Ordering::LocalHistogram || ordering == Ordering::TileSort;
    return !isLocal || buckets <= gpu::kMaxLocalBuckets;
}

// Returns whether every hit has one slot of its bucket.
bool isOrdered(const OrderProblem& problem, std::uint32_t buckets, const OrderResult& result) {
    std::vector<bool> seen(problem.hits.size());
    std::uint64_t found = 0;
    for (std::uint32_t bucket = 0; bucket < buckets; ++bucket) {
        for (std::uint32_t i = 0; i < result.counts[bucket]; ++i) {
            const std::uint32_t hit = result.slots[result.begins[bucket] + i];
            if (hit >= seen.size() || seen[hit] || bucketOf(problem, hit, buckets) != bucket) {
                return false;
            }
            seen[hit] = true;
            ++found;
        }
    }
    return found == seen.size();
}

Status check(OrderKernel& kernel, const OrderProblem& problem, std::uint32_t buckets, Ordering ordering) {
    if (const Result<std::vector<OrderTime>> times = kernel.times(ordering); !times) {
        return times.error();
    }
    GLINT_TRY(const auto result, kernel.result());
    if (!isOrdered(problem, buckets, result)) {
        return makeError("ordering", std::string(nameOf(ordering)), "a hit is not in its bucket",
                         "run test_ordering");
    }
    return okStatus();
}

Status measure(OrderKernel& kernel, const Arguments& arguments, const OrderProblem& problem, Row& row,
               const std::vector<Ordering>& orderings) {
    const auto copies = static_cast<std::uint32_t>(kWordsOfCopies / row.hits + 2);
    GLINT_TRY_DO(kernel.loadForTimes(problem, copies));
    for (const Ordering ordering : orderings) {
        GLINT_TRY_DO(check(kernel, problem, row.buckets, ordering));
    }
    // Clocks rise under load.
    const Clock::time_point start = Clock::now();
    while (Clock::now() - start < std::chrono::milliseconds(arguments.warmUpMs)) {
        if (const Result<std::vector<double>> copy = kernel.copyTimes(); !copy) {
            return copy.error();
        }
    }
    for (std::uint32_t round = 0; round < arguments.rounds; ++round) {
        GLINT_TRY(const auto copy, kernel.copyTimes());
        row.plainCopy.insert(row.plainCopy.end(), copy.begin(), copy.end());
        for (const Ordering ordering : orderings) {
            GLINT_TRY(const auto times, kernel.times(ordering));
            Times& kept = row.orderings[ordering];
            for (const OrderTime& time : times) {
                kept.count.push_back(time.count);
                kept.offset.push_back(time.offset);
                kept.copy.push_back(time.copy);
                kept.total.push_back(time.total);
            }
        }
    }
    return okStatus();
}

// Returns the bytes that an ordering has to move: each key is read twice, each slot is written once.
std::uint64_t bytesMoved(const Row& row) {
    const std::uint64_t keyBytes = row.buckets <= 0x100 ? 1 : 2;
    return row.hits * (2 * keyBytes + sizeof(std::uint32_t));
}

void printHead(const Context& context, const std::vector<Ordering>& orderings, const Arguments& arguments) {
    fmt::print(
        "{}, {}; {} rounds.\n"
        "All passes of an ordering, µs, median (quartiles), and as a multiple of a copy of 4 bytes a hit.\n\n"
        "| hits | buckets | spread | copy |",
        context.deviceName(), context.driverName(), arguments.rounds);
    std::string rule = "|---|---|---|---|";
    for (const Ordering ordering : orderings) {
        fmt::print(" {} |", nameOf(ordering));
        rule += "---|";
    }
    fmt::print("\n{}\n", rule);
}

void print(const Row& row, const std::vector<Ordering>& orderings) {
    const double copy = test::quantile(row.plainCopy, 0.5);
    fmt::print("| {} | {} | {} | {:.1f} |", row.hits, row.buckets, nameOf(row.spread), 1e3 * copy);
    for (const Ordering ordering : orderings) {
        const auto found = row.orderings.find(ordering);
        if (found == row.orderings.end()) {
            fmt::print(" - |");
            continue;
        }
        const std::vector<double>& total = found->second.total;
        fmt::print(" {:.1f} ({:.1f} to {:.1f}), {:.2f} |", 1e3 * test::quantile(total, 0.5),
                   1e3 * test::quantile(total, 0.25), 1e3 * test::quantile(total, 0.75),
                   test::quantile(total, 0.5) / copy);
    }
    fmt::print("\n");
    std::fflush(stdout);
}

nlohmann::json summary(const std::vector<double>& values) {
    return {{"median", 1e3 * test::quantile(values, 0.5)},
            {"low", 1e3 * test::quantile(values, 0.25)},
            {"high", 1e3 * test::quantile(values, 0.75)}};
}

nlohmann::json toJson(const Row& row) {
    nlohmann::json orderings = nlohmann::json::array();
    for (const auto& [ordering, times] : row.orderings) {
        orderings.push_back({{"ordering", nameOf(ordering)},
                             {"total", summary(times.total)},
                             {"count", summary(times.count)},
                             {"offset", summary(times.offset)},
                             {"copy", summary(times.copy)}});
    }
    return {{"hits", row.hits},
            {"buckets", row.buckets},
            {"spread", nameOf(row.spread)},
            {"bytesMoved", bytesMoved(row)},
            {"plainCopy", summary(row.plainCopy)},
            {"orderings", orderings}};
}

std::vector<Ordering> chosen(const Arguments& arguments) {
    std::vector<Ordering> orderings;
    for (std::uint32_t i = 0; i < kOrderingCount; ++i) {
        const auto ordering = static_cast<Ordering>(i);
        const auto& names = arguments.orderings;
        if (names.empty() || std::ranges::find(names, nameOf(ordering)) != names.end()) {
            orderings.push_back(ordering);
        }
    }
    return orderings;
}

Status measureAll(const Arguments& arguments) {
    GLINT_TRY(const auto context, Context::createHeadless());
    const std::vector<Ordering> orderings = chosen(arguments);
    nlohmann::json report = {{"device", context->deviceName()},
                             {"driver", context->driverName()},
                             {"rounds", arguments.rounds},
                             {"unit", "µs"},
                             {"rows", nlohmann::json::array()}};
    printHead(*context, orderings, arguments);
    for (const std::uint32_t buckets : arguments.buckets) {
        GLINT_TRY(const auto kernel,
                  OrderKernel::create(*context, buckets - 1, package::HitRecordFormat::Full));
        std::vector<Ordering> held;
        std::ranges::copy_if(orderings, std::back_inserter(held),
                             [&](Ordering ordering) { return holds(ordering, buckets); });
        for (const std::uint32_t hits : arguments.hits) {
            for (const Spread spread : kSpreads) {
                Row row{hits, buckets, spread, {}, {}};
                GLINT_TRY_DO(measure(*kernel, arguments, makeProblem(spread, buckets, hits), row, held));
                print(row, orderings);
                report["rows"].push_back(toJson(row));
            }
        }
    }
    if (!arguments.json.empty()) {
        std::ofstream(arguments.json) << report.dump(1) << "\n";
    }
    return okStatus();
}

}  // namespace

int main(int argc, char** argv) {
    try {
        Arguments arguments;
        CLI::App app("Times the orderings of hits on the first Vulkan device; prints Markdown.");
        const auto least = CLI::Range(1, 1 << 30);
        app.add_option("--rounds", arguments.rounds, "Rounds, of several runs each")->check(least);
        app.add_option("--hits", arguments.hits, "Numbers of hits")->delimiter(',')->check(least);
        app.add_option("--buckets", arguments.buckets, "Numbers of buckets")
            ->delimiter(',')
            ->check(CLI::Range(1, 65536));
        app.add_option("--orderings", arguments.orderings, "Which orderings; default all")->delimiter(',');
        app.add_option("--warm-up", arguments.warmUpMs, "Milliseconds of work before each measurement");
        app.add_option("--json", arguments.json, "Also writes this file, with the split by pass");
        CLI11_PARSE(app, argc, argv);
        if (const Status status = measureAll(arguments); !status) {
            std::fprintf(stderr, "%s\n", toString(status.error()).c_str());
            return 1;
        }
    } catch (const std::exception& error) {
        std::fprintf(stderr, "bench_ordering: %s\n", error.what());
        return 1;
    }
    return 0;
}
