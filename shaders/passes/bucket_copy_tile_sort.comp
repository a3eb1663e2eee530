#version 460
// Last pass of the ordering tile-sort. Workgroups, of which there are as many as run at once, take tiles of hits in turn.
// One sorts a tile in shared memory, takes room in each bucket that the tile has by one atomic, and writes whole runs of
// a bucket side by side. Where buckets begin each workgroup finds out for itself, which spares a pass.
//
// The counters of a tile, scanned in the order of buckets and then of copies, are where hits go in the sorted tile
// (Satish, Harris and Garland, "Designing efficient sorting algorithms for manycore GPUs", 2009).
#extension GL_EXT_control_flow_attributes : require

#define GLINT_SCAN_GROUP_SIZE kThreads
#define GLINT_SCAN_SHUFFLES 1
#include "hit/bucket_scan.glsl"
#include "hit/tile_sort.glsl"

// An H200 has shared memory for three of the small workgroups on a multiprocessor, for two of the next, for one of the
// large ones, whose tiles have twice as many hits of each bucket. A device that cannot run these runs kTileThreads.
// Arrays are as long as the least takes, which is known without the constant.
const uint kLeastThreads = kLocalBuckets <= kSmallTileBuckets ? kSmallTileThreads : kTileThreads;
#if GLINT_CASE_COUNT < 512  // kTileBuckets
layout(local_size_x = kLeastThreads) in;
const uint kThreads = kLeastThreads;
#else
layout(local_size_x = kTileThreads, local_size_x_id = 0) in;
const uint kThreads = gl_WorkGroupSize.x;
#endif
const uint kTileHits = kThreads * kTileHitsOfThread;

#include "hit/scan.glsl"

// Counters of a bucket, so that neighbours with hits of the same one do not wait for each other: an atomic that returns
// takes its turn. Few, as they have to be scanned.
const uint kCopies = clamp(2048u / kLocalBuckets, 1u, 16u);
const uint kCounters = kLocalBuckets * kCopies;
// Odd, so that threads that scan their own read from different banks.
const uint kCountersOfThread = (kCounters + kLeastThreads - 1u) / kLeastThreads | 1u;
// Those that a thread takes room in.
const uint kBucketsOfThread = (kLocalBuckets + kLeastThreads - 1u) / kLeastThreads;
// Words with the keys of a thread's hits.
const uint kKeyWords = kTileHitsOfThread * kKeyBytes / 4u;

shared uint tile[kThreads * max(kCountersOfThread, kTileHitsOfThread)];  // counters; later the sorted hits
shared uint slotOffsets[kLocalBuckets];  // from a place in the sorted tile to the slot, by bucket

// Keys of a thread's hits in the tile that begins with hit `first`.
uint[kKeyWords] loadKeys(KeyArray list, uint first) {
    uint words[kKeyWords];
    uint word = (first / kTileHitsOfThread + gl_LocalInvocationIndex) * kKeyWords;
#if GLINT_CASE_COUNT < 256
    uvec2 pair = KeyPairArray(list).data[word / 2u];
    words[0] = pair.x;
    words[1] = pair.y;
#else
    [[unroll]] for (uint i = 0u; i < kKeyWords; i += 4u) {
        uvec4 keys = list.data[(word + i) / 4u];
        words[i] = keys.x;
        words[i + 1u] = keys.y;
        words[i + 2u] = keys.z;
        words[i + 3u] = keys.w;
    }
#endif
    return words;
}

// Key of the thread's hit `k`.
uint keyAt(uint words[kKeyWords], uint k) {
    return keyOfWord(words[k / kKeysOfWord], k % kKeysOfWord);
}

// Place of a hit in the sorted tile. Hits of one bucket come from each copy in turn, a power of two apart: they are
// spread over the banks.
uint sortedPlace(uint place) {
    return place ^ (place >> 7 & 31u);
}

uint bucketOfThread(uint i) {
    return i * kThreads + scanThread();
}

// Where the buckets of the thread begin. The first workgroup says it to the passes that follow; gaps are cleared by all
// `workgroups` that have a tile.
uint[kBucketsOfThread] scanBuckets(uint workgroups) {
    CounterArray counts = GLINT_FRAME.bucketCounts;
    uint begins[kBucketsOfThread];
    uint slots = 0u;
    [[unroll]] for (uint i = 0u; i < kBucketsOfThread; ++i) {
        uint bucket = bucketOfThread(i);
        bool inside = bucket < kLocalBuckets;
        uint count = inside ? counts.data[bucket] : 0u;
        uint total;
        begins[i] = slots + scanWorkgroup(roomOf(count), total);
        if (inside && gl_WorkGroupID.x == 0u) {
            storeBucket(bucket, begins[i], count);
        }
        if (inside && gl_WorkGroupID.x == bucket % workgroups) {
            clearGap(begins[i], count);
        }
        slots += total;
    }
    if (gl_WorkGroupID.x == 0u && scanThread() == 0u) {
        storeSlotCount(slots);
    }
    return begins;
}

// From the number of hits of each counter to where they begin in the sorted tile.
void scanCounters() {
    uint first = scanThread() * kCountersOfThread;
    uint counts[kCountersOfThread];
    uint sum = 0u;
    [[unroll]] for (uint i = 0u; i < kCountersOfThread; ++i) {
        counts[i] = tile[first + i];
        sum += counts[i];
    }
    uint total;
    uint begin = scanWorkgroup(sum, total);
    [[unroll]] for (uint i = 0u; i < kCountersOfThread; ++i) {
        tile[first + i] = begin;
        begin += counts[i];
    }
}

// Takes slots for the tile's hits of a bucket that begins at slot `begin`; gives the bucket's slotOffsets.
uint takeSlots(CounterArray cursors, uint bucket, uint begin, uint hits) {
    uint first = tile[bucket * kCopies];
    uint end = bucket + 1u < kLocalBuckets ? tile[(bucket + 1u) * kCopies] : hits;
    return end > first ? begin + atomicAdd(cursors.data[bucket], end - first) - first : 0u;
}

// What a thread knows of its hits in the tile.
struct Hits {
    uint keys[kKeyWords];
    uint count;   // there are fewer than kTileHitsOfThread in the last tile
    uint first;   // number of the first in the tile
    uint places[kTileHitsOfThread];  // in the counter; later in the sorted tile
};

// `one` is 1.
void countHits(inout Hits hits, uint copy, uint one) {
    [[unroll]] for (uint k = 0u; k < kTileHitsOfThread; ++k) {
        if (k < hits.count) {
            hits.places[k] = atomicAdd(tile[keyAt(hits.keys, k) * kCopies + copy], one);
        }
    }
}

void findPlaces(inout Hits hits, uint copy) {
    [[unroll]] for (uint k = 0u; k < kTileHitsOfThread; ++k) {
        if (k < hits.count) {
            hits.places[k] += tile[keyAt(hits.keys, k) * kCopies + copy];
        }
    }
}

// In the upper half of a word the bucket of a hit; in the lower its number in the tile.
void storeHits(Hits hits) {
    [[unroll]] for (uint k = 0u; k < kTileHitsOfThread; ++k) {
        if (k < hits.count) {
            tile[sortedPlace(hits.places[k])] = (keyAt(hits.keys, k) << 16) + (hits.first + k);
        }
    }
}

void writeSlots(OrderedArray slots, uint firstOfTile, uint hitsOfTile) {
    [[unroll]] for (uint k = 0u; k < kTileHitsOfThread; ++k) {
        uint place = k * kThreads + gl_LocalInvocationIndex;
        if (place < hitsOfTile) {
            uint hit = tile[sortedPlace(place)];
            slots.data[slotOffsets[hit >> 16] + place] = firstOfTile + (hit & 0xFFFFu);
        }
    }
}

void main() {
    // What is written may be the constants, as far as a compiler knows: read once, an address is not read anew.
    uint rays = GLINT_FRAME.rayDispatch.data[0].elementCount;
    KeyArray list = GLINT_FRAME.bucketKeys;
    OrderedArray slots = GLINT_FRAME.orderedHits;
    CounterArray cursors = GLINT_FRAME.bucketCursors;
    uint workgroups = clamp((rays + kTileHits - 1u) / kTileHits, 1u, gl_NumWorkGroups.x);
    if (gl_WorkGroupID.x >= workgroups) {
        return;
    }
    uint stride = gl_NumWorkGroups.x * kTileHits;
    uint first = gl_WorkGroupID.x * kTileHits;
    Hits hits;
    hits.keys = loadKeys(list, first);
    hits.first = gl_LocalInvocationIndex * kTileHitsOfThread;
    uint begins[kBucketsOfThread] = scanBuckets(workgroups);
    // 1, which no compiler can know: given the constant, an NVIDIA driver (580.159) makes each atomicAdd() wait until the
    // subgroup's threads have compared their addresses, in order to add once where all are the same.
    uint one = 1u + (hits.keys[0] & rays >> 31);
    uint copy = gl_LocalInvocationIndex % kCopies;
    for (; first < rays; first += stride) {
        // The next tile's keys are on their way while this one is sorted.
        uint next[kKeyWords] = loadKeys(list, first + stride < rays ? first + stride : first);
        uint hitsOfTile = min(rays - first, kTileHits);
        hits.count = hitsOfTile - min(hitsOfTile, hits.first);
        [[unroll]] for (uint i = 0u; i < kCountersOfThread; ++i) {
            tile[i * kThreads + gl_LocalInvocationIndex] = 0u;
        }
        barrier();
        countHits(hits, copy, one);
        barrier();
        scanCounters();
        barrier();
        uint offsets[kBucketsOfThread];
        [[unroll]] for (uint i = 0u; i < kBucketsOfThread; ++i) {
            uint bucket = bucketOfThread(i);
            offsets[i] = bucket < kLocalBuckets ? takeSlots(cursors, bucket, begins[i], hitsOfTile) : 0u;
        }
        findPlaces(hits, copy);
        barrier();
        storeHits(hits);
        [[unroll]] for (uint i = 0u; i < kBucketsOfThread; ++i) {
            if (bucketOfThread(i) < kLocalBuckets) {
                slotOffsets[bucketOfThread(i)] = offsets[i];
            }
        }
        barrier();
        writeSlots(slots, first, hitsOfTile);
        barrier();
        hits.keys = next;
    }
}
