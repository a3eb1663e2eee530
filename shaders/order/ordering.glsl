// Adds the hits of a workgroup to their buckets, by the module's ordering (GLINT_ORDERING is package::Ordering). Before
// it includes this file, the module defines GLINT_BUCKET_WORDS, the words of FrameConstants to add to, and
// GLINT_HITS_NUMBERED, which says whether it needs each hit's number in its bucket. The ordering tile-sort is separate:
// order/tile_sort.glsl.
//
// Threads beyond the list take part with kNoGroup, so no thread may have returned before. Subgroups may have 1 to 128
// threads. Conditions of loops are equal in all threads of a subgroup, and no subgroup operation stands in a branch
// that divides one. Only basic, ballot and arithmetic operations are used, because not every device has shuffles.
#include "generated/most_buckets.glsl"
#include "hit/bindings.glsl"

#define GLINT_COUNT_OF(bucket) GLINT_FRAME.GLINT_BUCKET_WORDS.data[bucket]
#include "order/numbering.glsl"

uint addToBucket(uint bucket, uint hits) {
    return atomicAdd(GLINT_COUNT_OF(bucket), hits);
}

// Adds to a bucket that is the same in the whole subgroup, and gives each thread the number of the first hit. The first
// thread does one atomic, whatever its own hit is, so that a broadcast from the first thread is enough.
uint addForSubgroup(uint bucket, uint hits) {
    uint first = 0u;
    if (subgroupElect()) {
        first = addToBucket(bucket, hits);
    }
    return subgroupBroadcastFirst(first);
}

// addHit() returns the word before this hit was added. A hit that comes before it in the same bucket has a lower word.
// The result is undefined for a thread without a hit, and if hits are not numbered.

#if GLINT_ORDERING == 0  // global-atomics

uint addHit(uint bucket) {
    return bucket != kNoGroup ? addToBucket(bucket, 1u) : 0u;
}

#elif GLINT_ORDERING == 1  // wave-loop

// Loops over the buckets in the subgroup, in ascending order.
uint addHit(uint bucket) {
    return numberInGroup(bucket);
}

#elif GLINT_ORDERING == 2  // wave-aggregated

// Loops over all buckets.
uint addHit(uint bucket) {
    uint number = 0u;
    for (uint next = 0u; next < GLINT_FRAME.bucketCount; ++next) {
        bool added = bucket == next;
        uvec4 lanes = subgroupBallot(added);
        uint hits = subgroupBallotBitCount(lanes);
        if (hits > 0u) {
            uint first = addForSubgroup(next, hits) + subgroupBallotExclusiveBitCount(lanes);
            number = added ? first : number;
        }
    }
    return number;
}

#elif GLINT_ORDERING == 3  // wave-ballot

#if GLINT_HITS_NUMBERED
shared uint leadersBefore;               // leaders of the subgroups that came before
shared uint firstNumbers[kRayGroupSize];  // by leader; there are at most as many leaders as threads
#endif

// The lanes whose hits go to this lane's bucket: those that agree in each bit of the bucket's number.
uvec4 lanesOfBucket(uint bucket) {
    uvec4 lanes = subgroupBallot(bucket != kNoGroup);
    for (uint bit = 1u; bit < GLINT_MOST_BUCKETS; bit <<= 1u) {
        bool isSet = (bucket & bit) != 0u;
        uvec4 set = subgroupBallot(isSet);
        lanes &= isSet ? set : ~set;
    }
    return lanes;
}

uvec4 lanesBelow(uint lane) {
    ivec4 bits = clamp(int(lane) - ivec4(0, 32, 64, 96), 0, 32);
    return uvec4(bitfieldInsert(0u, ~0u, 0, bits.x), bitfieldInsert(0u, ~0u, 0, bits.y),
                 bitfieldInsert(0u, ~0u, 0, bits.z), bitfieldInsert(0u, ~0u, 0, bits.w));
}

// The first lane of each bucket leads, so that all atomics of the subgroup happen at once. Leaders pass their numbers
// on through shared memory: lanes of different buckets read from different leaders, which would otherwise take a
// shuffle.
uint addHit(uint bucket) {
    bool hasHit = bucket != kNoGroup;
    uvec4 lanes = lanesOfBucket(bucket);
    uint rank = subgroupBallotExclusiveBitCount(lanes);
    bool leads = hasHit && rank == 0u;
#if GLINT_HITS_NUMBERED
    if (gl_LocalInvocationIndex == 0u) {
        leadersBefore = 0u;
    }
    barrier();
    uvec4 leaders = subgroupBallot(leads);
    uint before = 0u;
    if (subgroupElect()) {
        before = atomicAdd(leadersBefore, subgroupBallotBitCount(leaders));
    }
    before = subgroupBroadcastFirst(before);
    // A lane without a hit looks for no leader, because its ballot may be empty and a search in it is then undefined.
    uint leader = hasHit ? subgroupBallotFindLSB(lanes) : 0u;
    uint place = before + subgroupBallotBitCount(leaders & lanesBelow(leader));
    if (leads) {
        firstNumbers[place] = addToBucket(bucket, subgroupBallotBitCount(lanes));
    }
    barrier();
    return hasHit ? firstNumbers[place] + rank : 0u;
#else
    if (leads) {
        addToBucket(bucket, subgroupBallotBitCount(lanes));
    }
    return 0u;
#endif
}

#elif GLINT_ORDERING == 4  // local-histogram

// Renderers refuse this ordering if there are more buckets.
shared uint localCounts[min(GLINT_MOST_BUCKETS, kMaxLocalBuckets)];

// Only the counts of buckets that the workgroup has are touched, so the work does not grow with the number of buckets.
uint addHit(uint bucket) {
    bool hasHit = bucket != kNoGroup;
    if (hasHit) {
        atomicExchange(localCounts[bucket], 0u);
    }
    barrier();
    uint rank = hasHit ? atomicAdd(localCounts[bucket], 1u) : 0u;
    barrier();
    // The first hit of each bucket adds the count. The word of the count then holds the number of the first hit, which
    // only this thread writes.
    if (hasHit && rank == 0u) {
        localCounts[bucket] = addToBucket(bucket, localCounts[bucket]);
    }
#if GLINT_HITS_NUMBERED
    barrier();
    return hasHit ? localCounts[bucket] + rank : 0u;
#else
    return 0u;
#endif
}

#endif
