// Adds the hits of a workgroup to their buckets, by the module's ordering: GLINT_ORDERING is package::Ordering. The
// module says before it includes this file which words of FrameConstants it adds to, GLINT_BUCKET_WORDS, and whether it
// needs to know each hit's number in its bucket, GLINT_HITS_NUMBERED. The ordering tile-sort is apart: hit/tile_sort.glsl.
//
// Threads beyond the list take part, with kNoBucket: no thread may have returned before. Subgroups may have 1 to 128
// threads. Conditions of loops are equal in all threads of a subgroup, and no subgroup operation stands in a branch
// that divides one. Only basic, ballot and arithmetic operations: not every device shuffles.
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_arithmetic : require

#include "hit/bindings.glsl"

// Of a thread that has no hit: above every bucket.
const uint kNoBucket = 0xFFFFFFFFu;

uint addToBucket(uint bucket, uint hits) {
    return atomicAdd(GLINT_FRAME.GLINT_BUCKET_WORDS.data[bucket], hits);
}

// Adds to a bucket that the whole subgroup names; gives each thread the number of the first. One atomic, by the first
// thread, whatever its own hit, so that no other broadcast is needed than that from the first.
uint addForSubgroup(uint bucket, uint hits) {
    uint first = 0u;
    if (subgroupElect()) {
        first = addToBucket(bucket, hits);
    }
    return subgroupBroadcastFirst(first);
}

// addHit(): the word before this hit was added; a hit that goes before it in the same bucket has a lower one. Undefined
// for a thread without a hit, and where hits are not numbered.

#if GLINT_ORDERING == 0  // global-atomics

uint addHit(uint bucket) {
    return bucket != kNoBucket ? addToBucket(bucket, 1u) : 0u;
}

#elif GLINT_ORDERING == 1  // wave-loop

// The buckets that the subgroup has, in their order.
uint addHit(uint bucket) {
    uint number = 0u;
    uint next = subgroupMin(bucket);
    while (next != kNoBucket) {
        bool added = bucket == next;
        uvec4 lanes = subgroupBallot(added);
        uint first = addForSubgroup(next, subgroupBallotBitCount(lanes)) + subgroupBallotExclusiveBitCount(lanes);
        number = added ? first : number;
        bucket = added ? kNoBucket : bucket;
        next = subgroupMin(bucket);
    }
    return number;
}

#elif GLINT_ORDERING == 2  // wave-aggregated

// Every bucket there is.
uint addHit(uint bucket) {
    uint number = 0u;
    for (uint next = 0u; next <= GLINT_CASE_COUNT; ++next) {
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
shared uint leadersBefore;               // leaders of the subgroups that came first
shared uint firstNumbers[kRayGroupSize];  // by leader: there are no more of them than threads
#endif

// Lanes whose hits go to this lane's bucket: of each bit of the bucket's number, those that have the same.
uvec4 lanesOfBucket(uint bucket) {
    uvec4 lanes = subgroupBallot(bucket != kNoBucket);
    for (uint bit = 1u; bit <= GLINT_CASE_COUNT; bit <<= 1u) {
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

// The first lane of each bucket leads: all atomics of the subgroup at once. Leaders pass their numbers on through
// shared memory, as lanes of different buckets read from different leaders, which takes a shuffle otherwise.
uint addHit(uint bucket) {
    bool hasHit = bucket != kNoBucket;
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
    // A lane without a hit looks for no leader: its ballot may be empty, and a search in it undefined.
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

// Renderers refuse this ordering where there are more buckets.
shared uint localCounts[min(GLINT_CASE_COUNT + 1u, kMaxLocalBuckets)];

// Only counts of buckets that the workgroup has are touched: the work does not grow with the number of buckets.
uint addHit(uint bucket) {
    bool hasHit = bucket != kNoBucket;
    if (hasHit) {
        atomicExchange(localCounts[bucket], 0u);
    }
    barrier();
    uint rank = hasHit ? atomicAdd(localCounts[bucket], 1u) : 0u;
    barrier();
    // The first hit of each bucket; the count makes room for the number of the first, which it alone writes.
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
