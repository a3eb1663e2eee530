#include "cli/table.h"

#include <gtest/gtest.h>

namespace glint {
namespace {

TEST(Table, NumbersAlignRightAndTextLeft) {
    EXPECT_EQ(formatTable({{"name", "count"}, {"a", "7"}, {"long name", "1234"}, {"b", "-"}}),
              "name       count\n"
              "a              7\n"
              "long name   1234\n"
              "b              -\n");
}

TEST(Table, FieldsAlignLeftAndCountCharactersNotBytes) {
    EXPECT_EQ(formatFields({{"ä", "1"}, {"ab", "22"}, {"c"}}),
              "ä   1\n"
              "ab  22\n"
              "c\n");
}

TEST(Table, BytesHaveUnits) {
    EXPECT_EQ(formatBytes(0), "0 B");
    EXPECT_EQ(formatBytes(1023), "1023 B");
    EXPECT_EQ(formatBytes(1536), "1.5 KiB");
    EXPECT_EQ(formatBytes(3U << 20U), "3.00 MiB");
}

TEST(Table, JoinOfNothingIsADash) {
    EXPECT_EQ(join({}), "-");
    EXPECT_EQ(join({"a", "b"}), "a, b");
}

}  // namespace
}  // namespace glint
