#version 460
// The last pass of the ordering tile-sort. There are as many workgroups as can run at once, and they take tiles of hits
// in turn. A workgroup sorts a tile in shared memory, reserves slots in each bucket that occurs in the tile with one
// atomic, and writes whole runs of a bucket side by side. Each workgroup computes for itself where buckets begin, which
// saves a pass.
//
// The counters of a tile, scanned in the order of buckets and then of copies, say where hits go in the sorted tile
// (Satish, Harris and Garland, "Designing efficient sorting algorithms for manycore GPUs", 2009).
#extension GL_EXT_control_flow_attributes : require

#define GLINT_SCAN_GROUP_SIZE kThreads
#define GLINT_SCAN_SHUFFLES 1
#include "order/bucket_scan.glsl"
#include "order/tile_sort.glsl"

// On a multiprocessor, an H200 has shared memory for three of the small workgroups, for two of the next size, or for
// one of the large ones, whose tiles have twice as many hits of each bucket. A device that cannot run the large ones
// runs kTileThreads. Arrays have the length that the smallest workgroup needs, which is known without the
// specialisation constant.
const uint kLeastThreads = kLocalBuckets <= kSmallTileBuckets ? kSmallTileThreads : kTileThreads;
#if GLINT_MOST_BUCKETS <= 512  // kTileBuckets
layout(local_size_x = kLeastThreads) in;
const uint kThreads = kLeastThreads;
#else
layout(local_size_x = kTileThreads, local_size_x_id = 0) in;
const uint kThreads = gl_WorkGroupSize.x;
#endif
const uint kTileHits = kThreads * kTileHitsOfThread;

#include "order/scan.glsl"

// The number of counters of a bucket. With several, neighbours whose hits are in the same bucket do not wait for each
// other, because atomics that return a value are executed in turn. There are few, because they have to be scanned.
const uint kCopies = clamp(2048u / kLocalBuckets, 1u, 16u);
const uint kCounters = kLocalBuckets * kCopies;
// Odd, so that threads that scan their own counters read from different banks.
const uint kCountersOfThread = (kCounters + kLeastThreads - 1u) / kLeastThreads | 1u;
// The number of buckets in which one thread reserves slots.
const uint kBucketsOfThread = (kLocalBuckets + kLeastThreads - 1u) / kLeastThreads;
// The number of words with the keys of a thread's hits.
const uint kKeyWords = kTileHitsOfThread * kKeyBytes / 4u;

shared uint tile[kThreads * max(kCountersOfThread, kTileHitsOfThread)];  // counters; later the sorted hits
shared uint slotOffsets[kLocalBuckets];  // by bucket: the difference between a slot and a place in the sorted tile

// Loads the keys of a thread's hits in the tile that begins with hit `first`.
uint[kKeyWords] loadKeys(KeyArray list, uint first) {
    uint words[kKeyWords];
    uint word = (first / kTileHitsOfThread + gl_LocalInvocationIndex) * kKeyWords;
#if GLINT_MOST_BUCKETS <= 256
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

// Returns the key of the thread's hit `k`.
uint keyAt(uint words[kKeyWords], uint k) {
    return keyOfWord(words[k / kKeysOfWord], k % kKeysOfWord);
}

// Returns the place of a hit in the sorted tile. Hits of one bucket come from each copy in turn, a power of two apart,
// so they are spread over the banks.
uint sortedPlace(uint place) {
    return place ^ (place >> 7 & 31u);
}

uint bucketOfThread(uint i) {
    return i * kThreads + scanThread();
}

// Returns where the buckets of the thread begin. The first workgroup stores that for later passes. All `workgroups`
// that have a tile clear the gaps together.
uint[kBucketsOfThread] scanBuckets(uint workgroups) {
    CounterArray counts = GLINT_FRAME.bucketCounts;
    uint begins[kBucketsOfThread];
    uint buckets = GLINT_FRAME.bucketCount;
    uint slots = 0u;
    [[unroll]] for (uint i = 0u; i < kBucketsOfThread; ++i) {
        uint bucket = bucketOfThread(i);
        bool inside = bucket < buckets;
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

// Turns the number of hits of each counter into their begin in the sorted tile.
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

// Reserves slots for the tile's hits of a bucket that begins at slot `begin`. Returns the bucket's slotOffsets.
uint takeSlots(CounterArray cursors, uint bucket, uint begin, uint hits) {
    uint first = tile[bucket * kCopies];
    uint end = bucket + 1u < kLocalBuckets ? tile[(bucket + 1u) * kCopies] : hits;
    return end > first ? begin + atomicAdd(cursors.data[bucket], end - first) - first : 0u;
}

// A thread's hits in the tile.
struct Hits {
    uint keys[kKeyWords];
    uint count;   // fewer than kTileHitsOfThread in the last tile
    uint first;   // number in the tile of the first hit
    uint places[kTileHitsOfThread];  // place in the counter; later in the sorted tile
};

// `one` is always 1; main() says why it is a parameter.
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

// A word holds the hit's bucket in its upper half, and the hit's number in the tile in its lower half.
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
    // These addresses are read once: for all that a compiler knows, later writes may change the constants, so it would
    // read them again.
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
    // This is always 1, but no compiler can know that. With a constant, an NVIDIA driver (580.159) makes each
    // atomicAdd() wait until the subgroup's threads have compared their addresses, in order to add only once if all are
    // equal.
    uint one = 1u + (hits.keys[0] & rays >> 31);
    uint copy = gl_LocalInvocationIndex % kCopies;
    for (; first < rays; first += stride) {
        // The keys of the next tile are loaded while this one is sorted.
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
