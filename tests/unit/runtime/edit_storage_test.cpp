// Where a scene that is edited keeps its entries and records.
#include "scene/record_store.h"

#include <glint/scene.h>

#include <gtest/gtest.h>

#include <array>

namespace glint {
namespace {

TEST(EditStorage, HandlesOfRemovedEntriesFindNothing) {
    Slots<int, LightHandle> slots;
    EXPECT_EQ(slots.find({}), nullptr);
    const LightHandle first = slots.add(10);
    const LightHandle second = slots.add(20);
    EXPECT_EQ(*slots.find(first), 10);
    EXPECT_EQ(slots.take(first), 10);
    EXPECT_EQ(slots.find(first), nullptr);
    EXPECT_EQ(slots.end(), 2U);
    const LightHandle third = slots.next();
    EXPECT_EQ(slots.add(30), third);
    EXPECT_EQ(third.index, first.index) << "the lowest free index";
    EXPECT_EQ(slots.find(first), nullptr) << "of another generation";
    EXPECT_EQ(*slots.find(third), 30);
    EXPECT_EQ(slots.count(), 2U);
    slots.take(second);
    EXPECT_EQ(slots.end(), 1U);
    slots.take(third);
    EXPECT_EQ(slots.end(), 0U);
    // No generation comes back, even when the indices do.
    EXPECT_EQ(slots.add(40).index, 0U);
    EXPECT_EQ(slots.find(first), nullptr);
    EXPECT_EQ(slots.find(third), nullptr);
}

TEST(EditStorage, RunsTakeTheLowestRoom) {
    RunAllocator runs;
    EXPECT_EQ(runs.allocate(4), 0U);
    EXPECT_EQ(runs.allocate(2), 4U);
    EXPECT_EQ(runs.allocate(3), 6U);
    EXPECT_EQ(runs.end(), 9U);
    runs.release(0, 4);
    runs.release(4, 2);
    EXPECT_EQ(runs.allocate(6), 0U) << "neighbours become one run";
    runs.release(0, 6);
    EXPECT_EQ(runs.allocate(7), 9U);
    EXPECT_EQ(runs.allocate(5), 0U);
    EXPECT_EQ(runs.allocate(1), 5U);
    runs.release(9, 7);
    EXPECT_EQ(runs.end(), 9U);
    runs.release(0, 5);
    runs.release(6, 3);
    EXPECT_EQ(runs.end(), 6U);
    runs.release(5, 1);
    EXPECT_EQ(runs.end(), 0U);
    EXPECT_EQ(runs.allocate(0), 0U);
    runs.release(0, 0);
}

TEST(EditStorage, RunsTakeTheSmallestRoom) {
    RunAllocator runs;
    for (const std::uint32_t count : {5U, 1U, 3U, 1U, 3U, 1U}) {
        runs.allocate(count);
    }
    runs.release(0, 5);
    runs.release(6, 3);
    runs.release(10, 3);
    EXPECT_EQ(runs.allocate(2), 6U) << "the lowest of two with the same room";
    EXPECT_EQ(runs.allocate(1), 8U);
    EXPECT_EQ(runs.allocate(4), 0U);
}

TEST(EditStorage, RecordsAreDirtyUntilTheyAreCopied) {
    RecordStore store(sizeof(int));
    store.write(0, 7);
    store.write(3, 9);
    store.write(1, 8);
    store.write(1, 5);
    EXPECT_EQ(store.count(), 4U);
    EXPECT_EQ(store.read<int>(1), 5);
    EXPECT_EQ(store.read<int>(2), 0);
    const std::vector<IndexRange> dirty = store.dirty();
    ASSERT_EQ(dirty.size(), 2U);
    EXPECT_EQ(dirty[0].first, 0U);
    EXPECT_EQ(dirty[0].end, 2U);
    EXPECT_EQ(dirty[1].first, 3U);
    EXPECT_EQ(dirty[1].end, 4U);
    store.shrink(2);
    EXPECT_EQ(store.dirty().size(), 1U);
    store.clearDirty();
    EXPECT_TRUE(store.dirty().empty());
    EXPECT_EQ(store.read<int>(0), 7);
    store.touchAll();
    ASSERT_EQ(store.dirty().size(), 1U);
    EXPECT_EQ(store.dirty()[0].end, 2U);
    store.reset(sizeof(int));
    store.touchAll();
    EXPECT_TRUE(store.dirty().empty()) << "a copy of nothing is not allowed";
}

TEST(EditStorage, ReplacedRecordsAreDirtyWhereTheyDiffer) {
    RecordStore store(sizeof(int));
    const auto replace = [&](const std::vector<int>& records) {
        store.clearDirty();
        store.replace(std::span<const int>(records));
        EXPECT_EQ(store.count(), records.size());
        return store.dirty();
    };
    ASSERT_EQ(replace({1, 2, 3, 4}).size(), 1U);
    EXPECT_TRUE(replace({1, 2, 3, 4}).empty());
    const std::vector<IndexRange> middle = replace({1, 5, 6, 4});
    ASSERT_EQ(middle.size(), 1U);
    EXPECT_EQ(middle[0].first, 1U);
    EXPECT_EQ(middle[0].end, 3U);
    EXPECT_EQ(store.read<int>(2), 6);
    EXPECT_EQ(replace({2, 5, 6, 5}).size(), 2U);
    replace({1, 5, 6, 4});
    const std::vector<IndexRange> longer = replace({1, 5, 6, 4, 9});
    ASSERT_EQ(longer.size(), 1U);
    EXPECT_EQ(longer[0].first, 4U);
    EXPECT_EQ(longer[0].end, 5U);
    EXPECT_TRUE(replace({1, 5}).empty());
    EXPECT_TRUE(replace({}).empty());
}

}  // namespace
}  // namespace glint
