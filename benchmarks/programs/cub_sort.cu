// Times CUB's radix sort of pairs beside a copy of device memory, for the tables of docs/performance.md: what a user
// without an ordering of their own would call. Keys of 32 bits, and of as few bytes as hold the bucket, over as few bits
// as needed; values are hit indices of 4 bytes. Prints a row of JSON for each number of hits, of buckets and spread.
//
//   nvcc -O3 -std=c++17 -arch=native -o cub_sort benchmarks/programs/cub_sort.cu
//   cub_sort HITS BUCKETS ROUNDS      lists with commas: cub_sort 1048576,8388608 2,64,1024 11
#include <cub/device/device_radix_sort.cuh>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <numeric>
#include <random>
#include <sstream>
#include <string>
#include <vector>

namespace {

void check(cudaError_t result) {
    if (result != cudaSuccess) {
        std::fprintf(stderr, "cub_sort: %s\n", cudaGetErrorString(result));
        std::exit(1);
    }
}

std::vector<std::uint32_t> numbers(const char* text) {
    std::vector<std::uint32_t> values;
    std::stringstream stream(text);
    for (std::string part; std::getline(stream, part, ',');) {
        values.push_back(static_cast<std::uint32_t>(std::stoul(part)));
    }
    return values;
}

struct Quartiles {
    double low, median, high;
};

Quartiles quartiles(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const auto at = [&](double q) { return values[static_cast<std::size_t>(q * (values.size() - 1))]; };
    return {at(0.25), at(0.5), at(0.75)};
}

void print(const char* name, const Quartiles& q, const char* end) {
    std::printf("\"%s\": {\"low\": %.2f, \"median\": %.2f, \"high\": %.2f}%s", name, q.low, q.median, q.high, end);
}

// Several copies of a problem, which together are larger than what the device caches.
template <typename Key>
struct Problem {
    Key *keys, *sortedKeys;
    std::uint32_t *values, *sortedValues;
};

template <typename Key>
std::vector<Problem<Key>> makeProblems(const std::vector<std::uint32_t>& buckets, std::size_t copies) {
    const std::size_t count = buckets.size();
    const std::vector<Key> keys(buckets.begin(), buckets.end());
    std::vector<std::uint32_t> values(count);
    std::iota(values.begin(), values.end(), 0U);
    std::vector<Problem<Key>> problems(copies);
    for (Problem<Key>& problem : problems) {
        check(cudaMalloc(&problem.keys, count * sizeof(Key)));
        check(cudaMalloc(&problem.sortedKeys, count * sizeof(Key)));
        check(cudaMalloc(&problem.values, count * 4));
        check(cudaMalloc(&problem.sortedValues, count * 4));
        check(cudaMemcpy(problem.keys, keys.data(), count * sizeof(Key), cudaMemcpyHostToDevice));
        check(cudaMemcpy(problem.values, values.data(), count * 4, cudaMemcpyHostToDevice));
    }
    return problems;
}

template <typename Key>
void release(std::vector<Problem<Key>>& problems) {
    for (Problem<Key>& problem : problems) {
        check(cudaFree(problem.keys));
        check(cudaFree(problem.sortedKeys));
        check(cudaFree(problem.values));
        check(cudaFree(problem.sortedValues));
    }
}

template <typename Run>
void time(cudaEvent_t begin, cudaEvent_t end, std::vector<double>& microseconds, const Run& run) {
    check(cudaEventRecord(begin));
    run();
    check(cudaEventRecord(end));
    check(cudaEventSynchronize(end));
    float milliseconds = 0.0F;
    check(cudaEventElapsedTime(&milliseconds, begin, end));
    microseconds.push_back(1e3 * milliseconds);
}

template <typename Key>
void measure(const std::vector<std::uint32_t>& buckets, int bits, std::uint32_t rounds, std::vector<double>& sorts,
             std::vector<double>& copies) {
    const std::size_t count = buckets.size();
    std::vector<Problem<Key>> problems =
        makeProblems<Key>(buckets, std::min<std::size_t>((64U << 20U) / count + 2, 8));
    std::size_t bytes = 0;
    void* scratch = nullptr;
    const auto sort = [&](Problem<Key>& problem) {
        check(cub::DeviceRadixSort::SortPairs(scratch, bytes, problem.keys, problem.sortedKeys, problem.values,
                                              problem.sortedValues, count, 0, bits));
    };
    sort(problems[0]);
    check(cudaMalloc(&scratch, bytes));
    cudaEvent_t begin, end;
    check(cudaEventCreate(&begin));
    check(cudaEventCreate(&end));
    // Clocks rise with work.
    for (int i = 0; i < 300; ++i) {
        sort(problems[i % problems.size()]);
    }
    check(cudaDeviceSynchronize());
    for (std::uint32_t round = 0; round < rounds; ++round) {
        for (Problem<Key>& problem : problems) {
            time(begin, end, copies, [&] {
                check(cudaMemcpyAsync(problem.sortedValues, problem.values, count * 4, cudaMemcpyDeviceToDevice));
            });
            time(begin, end, sorts, [&] { sort(problem); });
        }
    }
    check(cudaFree(scratch));
    release(problems);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 4) {
        std::fputs("usage: cub_sort HITS BUCKETS ROUNDS\n", stderr);
        return 2;
    }
    const std::uint32_t rounds = numbers(argv[3]).at(0);
    for (const std::uint32_t count : numbers(argv[1])) {
        for (const std::uint32_t bucketCount : numbers(argv[2])) {
            int bits = 1;
            while ((1U << bits) < bucketCount) {
                ++bits;
            }
            std::mt19937 random(5);
            std::vector<std::uint32_t> buckets(count);
            for (std::uint32_t& bucket : buckets) {
                bucket = random() % bucketCount;
            }
            std::vector<double> wide, narrow, copies;
            measure<std::uint32_t>(buckets, bits, rounds, wide, copies);
            if (bucketCount <= 256) {
                measure<std::uint8_t>(buckets, bits, rounds, narrow, copies);
            } else {
                measure<std::uint16_t>(buckets, bits, rounds, narrow, copies);
            }
            std::printf("{\"hits\": %u, \"buckets\": %u, ", count, bucketCount);
            print("sort", quartiles(wide), ", ");
            print("sortNarrowKeys", quartiles(narrow), ", ");
            print("copy", quartiles(copies), "}\n");
            std::fflush(stdout);
        }
    }
    return 0;
}
