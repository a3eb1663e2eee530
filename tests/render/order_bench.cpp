// Times the orderings: device time of the count and the copy by number of buckets and spread of the hits.
// Each round runs everything once, so that what else the machine does slows all alike. Prints Markdown.
//
//   bench_ordering [ROUNDS [RAYS]]     default 31 and 57600
#include "render/order_problems.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <exception>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace {

using namespace glint;
using namespace glint::testing;
using package::Ordering;

constexpr std::uint32_t kBucketCounts[] = {1, 2, 31, 32, 33, 255, 256, 257, 1024, 1025};
constexpr auto kOrderingCount = static_cast<std::uint32_t>(Ordering::Count);

double quantile(const std::vector<double>& sorted, double q) {
    const double place = q * static_cast<double>(sorted.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const std::size_t above = std::min(below + 1, sorted.size() - 1);
    return sorted[below] + (place - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

// Microseconds: the median, and half of what lies between the quartiles.
std::string cell(std::vector<double> values) {
    if (values.empty()) {
        return "-";
    }
    std::ranges::sort(values);
    const double spread = (quantile(values, 0.75) - quantile(values, 0.25)) / 2.0;
    return fmt::format("{:.0f} ± {:.0f}", quantile(values, 0.5), spread);
}

struct Row {
    std::uint32_t bucketCount = 0;
    Spread spread{};
    OrderProblem problem;
    std::array<std::vector<double>, kOrderingCount> orderings;  // count and copy
    std::vector<double> scans;
};

// One run of each ordering.
Status measure(OrderKernel& kernel, bool counts, Row& row) {
    if (Status status = kernel.load(row.problem); !status) {
        return status;
    }
    for (std::uint32_t i = 0; i < kOrderingCount; ++i) {
        const auto ordering = static_cast<Ordering>(i);
        if (ordering == Ordering::LocalHistogram && row.bucketCount > gpu::kMaxLocalBuckets) {
            continue;
        }
        const Result<OrderResult> result = kernel.run(ordering);
        if (!result) {
            return result.error();
        }
        if (result->errors != 0) {
            return makeError("ordering", std::string(nameOf(ordering)), "the check found an error",
                             "run test_ordering");
        }
        if (counts) {
            row.orderings[i].push_back(1e3 * (result->countMs + result->copyMs));
            row.scans.push_back(1e3 * result->offsetMs);
        }
    }
    return okStatus();
}

void print(const Context& context, const std::vector<Row>& rows, std::uint32_t rounds, std::uint32_t rays) {
    fmt::print(
        "{}, {}; {} hits, {} rounds.\n"
        "Count and copy, and the scan between them: µs, median ± half of the interquartile range.\n\n"
        "| buckets | hits |",
        context.deviceName(), context.driverName(), rays, rounds);
    for (std::uint32_t i = 0; i < kOrderingCount; ++i) {
        fmt::print(" {} |", nameOf(static_cast<Ordering>(i)));
    }
    fmt::print(" scan |\n|---|---|---|---|---|---|---|---|\n");
    for (const Row& row : rows) {
        fmt::print("| {} | {} |", row.bucketCount, nameOf(row.spread));
        for (const std::vector<double>& values : row.orderings) {
            fmt::print(" {} |", cell(values));
        }
        fmt::print(" {} |\n", cell(row.scans));
    }
}

Status measureAll(std::uint32_t rounds, std::uint32_t rays) {
    const Result<std::unique_ptr<Context>> context = Context::createHeadless();
    if (!context) {
        return context.error();
    }
    std::map<std::uint32_t, std::unique_ptr<OrderKernel>> kernels;
    std::vector<Row> rows;
    for (const std::uint32_t bucketCount : kBucketCounts) {
        Result<std::unique_ptr<OrderKernel>> kernel =
            OrderKernel::create(**context, bucketCount - 1, package::HitRecordFormat::Full);
        if (!kernel) {
            return kernel.error();
        }
        kernels.emplace(bucketCount, std::move(*kernel));
        for (const Spread spread : kSpreads) {
            rows.push_back({bucketCount, spread, makeProblem(spread, bucketCount, rays), {}, {}});
        }
    }
    // The first round warms caches and clocks up and does not count.
    for (std::uint32_t round = 0; round <= rounds; ++round) {
        for (Row& row : rows) {
            if (Status status = measure(*kernels.at(row.bucketCount), round > 0, row); !status) {
                return status;
            }
        }
    }
    print(**context, rows, rounds, rays);
    return okStatus();
}

// 0 where the text is no number.
std::uint32_t number(const char* text) {
    std::uint32_t value = 0;
    const char* const end = text + std::strlen(text);
    const auto parsed = std::from_chars(text, end, value);
    return parsed.ec == std::errc() && parsed.ptr == end ? value : 0;
}

}  // namespace

int main(int argc, char** argv) {
    const std::uint32_t rounds = argc > 1 ? number(argv[1]) : 31;
    const std::uint32_t rays = argc > 2 ? number(argv[2]) : 57600;
    if (argc > 3 || rounds == 0 || rays == 0) {
        std::fputs("usage: bench_ordering [ROUNDS [RAYS]]: two numbers of at least 1\n", stderr);
        return 2;
    }
    try {
        if (const Status status = measureAll(rounds, rays); !status) {
            std::fprintf(stderr, "%s\n", toString(status.error()).c_str());
            return 1;
        }
    } catch (const std::exception& error) {
        std::fprintf(stderr, "bench_ordering: %s\n", error.what());
        return 1;
    }
    return 0;
}
