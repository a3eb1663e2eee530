// The copy pass of the ordering tile-sort (shaders/passes/bucket_copy_tile_sort.comp) in CUDA, a tile a block, for
// NVIDIA's profiler, which reads no counters of Vulkan's shaders. 8 Mi hits, 64 buckets, keys in no order.
//
//   nvcc -O3 -std=c++17 -arch=sm_90 benchmarks/programs/tile_sort.cu -o tile_sort
//   ncu --clock-control none --set full -k regex:copyTile --launch-skip 2 --launch-count 1 ./tile_sort
#include <cuda_runtime.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <vector>

namespace {

constexpr unsigned kHits = 1U << 23U;
constexpr int kBuckets = 64;
constexpr int kThreads = 512;
constexpr int kHitsOfThread = 8;
constexpr int kTileHits = kThreads * kHitsOfThread;
constexpr int kCopies = 16;
constexpr int kCounters = (kBuckets + 1) * kCopies;
constexpr int kCountersOfThread = ((kCounters + kThreads - 1) / kThreads) | 1;
constexpr int kSets = 4;
constexpr int kRounds = 40;

void check(cudaError_t error, const char* what) {
    if (error != cudaSuccess) {
        std::fprintf(stderr, "%s: %s\n", what, cudaGetErrorString(error));
        std::exit(1);
    }
}

__device__ unsigned keyOf(unsigned word, int index) {
    return (word >> (8 * index)) & 255U;
}

__device__ unsigned sortedPlace(unsigned place) {
    return place ^ ((place >> 7) & 31U);
}

__device__ unsigned scanBlock(unsigned value, unsigned* sums) {
    const unsigned lane = threadIdx.x & 31U;
    const unsigned warp = threadIdx.x >> 5U;
    unsigned inclusive = value;
#pragma unroll
    for (int distance = 1; distance < 32; distance *= 2) {
        const unsigned below = __shfl_up_sync(~0U, inclusive, distance);
        inclusive += lane >= distance ? below : 0U;
    }
    if (lane == 31) {
        sums[warp] = inclusive;
    }
    __syncthreads();
    const unsigned sum = lane < kThreads / 32 ? sums[lane] : 0U;
    return __reduce_add_sync(~0U, lane < warp ? sum : 0U) + inclusive - value;
}

__global__ void __launch_bounds__(kThreads) copyTile(const uint2* keys, unsigned* slots, unsigned* cursors) {
    __shared__ unsigned tile[kCountersOfThread * kThreads > kTileHits ? kCountersOfThread * kThreads : kTileHits];
    __shared__ unsigned slotOffsets[kBuckets];
    __shared__ unsigned sums[32];
    const unsigned thread = threadIdx.x;
    const unsigned first = blockIdx.x * kTileHits;
    const uint2 pair = keys[first / kHitsOfThread + thread];
    const unsigned words[2] = {pair.x, pair.y};
#pragma unroll
    for (int i = 0; i < kCountersOfThread; ++i) {
        tile[i * kThreads + thread] = 0;
    }
    __syncthreads();
    const unsigned copy = thread % kCopies;
    unsigned places[kHitsOfThread];
#pragma unroll
    for (int k = 0; k < kHitsOfThread; ++k) {
        places[k] = atomicAdd(&tile[keyOf(words[k / 4], k % 4) * kCopies + copy], 1U);
    }
    __syncthreads();
    unsigned counts[kCountersOfThread];
    unsigned sum = 0;
#pragma unroll
    for (int i = 0; i < kCountersOfThread; ++i) {
        counts[i] = tile[thread * kCountersOfThread + i];
        sum += counts[i];
    }
    unsigned begin = scanBlock(sum, sums);
#pragma unroll
    for (int i = 0; i < kCountersOfThread; ++i) {
        tile[thread * kCountersOfThread + i] = begin;
        begin += counts[i];
    }
    __syncthreads();
    unsigned offset = 0;
    if (thread < kBuckets) {
        const unsigned from = tile[thread * kCopies];
        const unsigned to = tile[(thread + 1) * kCopies];
        offset = to > from ? atomicAdd(&cursors[thread], to - from) - from : 0U;
    }
#pragma unroll
    for (int k = 0; k < kHitsOfThread; ++k) {
        places[k] += tile[keyOf(words[k / 4], k % 4) * kCopies + copy];
    }
    __syncthreads();
#pragma unroll
    for (int k = 0; k < kHitsOfThread; ++k) {
        tile[sortedPlace(places[k])] = (keyOf(words[k / 4], k % 4) << 16U) | (thread * kHitsOfThread + k);
    }
    if (thread < kBuckets) {
        slotOffsets[thread] = offset;
    }
    __syncthreads();
#pragma unroll
    for (int k = 0; k < kHitsOfThread; ++k) {
        const unsigned place = thread + k * kThreads;
        const unsigned hit = tile[sortedPlace(place)];
        slots[slotOffsets[hit >> 16U] + place] = first + (hit & 0xFFFFU);
    }
}

}  // namespace

int main() {
    std::mt19937_64 random(7);
    std::vector<std::uint8_t> keys(kHits);
    std::vector<unsigned> begins(kBuckets + 1);
    for (std::uint8_t& key : keys) {
        key = static_cast<std::uint8_t>(random() % kBuckets);
        ++begins[key + 1];
    }
    for (int bucket = 0; bucket < kBuckets; ++bucket) {
        begins[bucket + 1] += begins[bucket];
    }
    unsigned* cursors = nullptr;
    uint2* deviceKeys[kSets];
    unsigned* slots[kSets];
    check(cudaMalloc(&cursors, kBuckets * sizeof(unsigned)), "cudaMalloc");
    for (int set = 0; set < kSets; ++set) {
        check(cudaMalloc(&deviceKeys[set], kHits), "cudaMalloc");
        check(cudaMalloc(&slots[set], kHits * sizeof(unsigned)), "cudaMalloc");
        check(cudaMemcpy(deviceKeys[set], keys.data(), kHits, cudaMemcpyHostToDevice), "cudaMemcpy");
    }
    cudaEvent_t start = nullptr;
    cudaEvent_t stop = nullptr;
    check(cudaEventCreate(&start), "cudaEventCreate");
    check(cudaEventCreate(&stop), "cudaEventCreate");
    std::vector<float> times;
    for (int round = 0; round < kRounds; ++round) {
        check(cudaMemcpy(cursors, begins.data(), kBuckets * sizeof(unsigned), cudaMemcpyHostToDevice), "cudaMemcpy");
        check(cudaEventRecord(start), "cudaEventRecord");
        copyTile<<<kHits / kTileHits, kThreads>>>(deviceKeys[round % kSets], slots[round % kSets], cursors);
        check(cudaEventRecord(stop), "cudaEventRecord");
        check(cudaEventSynchronize(stop), "cudaEventSynchronize");
        float milliseconds = 0.0F;
        check(cudaEventElapsedTime(&milliseconds, start, stop), "cudaEventElapsedTime");
        times.push_back(1e3F * milliseconds);
    }
    std::vector<unsigned> hits(kHits);
    check(cudaMemcpy(hits.data(), slots[(kRounds - 1) % kSets], kHits * sizeof(unsigned), cudaMemcpyDeviceToHost),
          "cudaMemcpy");
    for (int bucket = 0; bucket < kBuckets; ++bucket) {
        for (unsigned slot = begins[bucket]; slot < begins[bucket + 1]; ++slot) {
            if (hits[slot] >= kHits || keys[hits[slot]] != bucket) {
                std::fprintf(stderr, "slot %u holds no hit of bucket %d\n", slot, bucket);
                return 1;
            }
        }
    }
    std::sort(times.begin(), times.end());
    std::printf("%.1f us\n", times[times.size() / 2]);
}
