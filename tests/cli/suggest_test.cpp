#include "base/text.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace glint {
namespace {

TEST(Suggest, DistanceCountsEdits) {
    EXPECT_EQ(base::editDistance("", ""), 0);
    EXPECT_EQ(base::editDistance("abc", ""), 3);
    EXPECT_EQ(base::editDistance("kitten", "sitting"), 3);
    EXPECT_EQ(base::editDistance("complie", "compile"), 1);  // a swap is one edit
    EXPECT_EQ(base::editDistance("--ouput", "--output"), 1);
}

TEST(Suggest, NearestIsNearEnough) {
    const std::vector<std::string> words{"compile", "compare", "explain"};
    EXPECT_EQ(base::nearest("complie", words), "compile");
    EXPECT_EQ(base::nearest("compre", words), "compare");
    EXPECT_EQ(base::nearest("xyz", words), "");
    EXPECT_EQ(base::nearest("", words), "");
    EXPECT_EQ(base::nearest(std::string(100'000, 'c'), words), "");
    EXPECT_EQ(base::suggestion("explian", words), "; did you mean explain?");
    EXPECT_EQ(base::suggestion("xyz", words), "");
}

TEST(Suggest, PartsOfNamesFindThem) {
    const std::vector<std::string> names{"Brick", "Marble, table", "Marble, floor"};
    EXPECT_EQ(base::nearest("Marbl", names), "Marble, table");
    EXPECT_EQ(base::nearest("FLOOR", names), "Marble, floor");
    EXPECT_EQ(base::nearest("le", names), "");
    EXPECT_EQ(base::nearest("Brock", names), "Brick");  // a slip comes first
}

TEST(Suggest, EnumerationShowsSomeAndCountsTheRest) {
    const std::vector<std::string> few{"Brick", "", "Marble, table"};
    EXPECT_EQ(base::enumeration(few), " (it has Brick, \"Marble, table\")");
    const std::vector<std::string> many(11, "a");
    EXPECT_EQ(base::enumeration(many), " (it has a, a, a, a, a, a, a, a and 3 more)");
    EXPECT_EQ(base::enumeration({}), "");
}

}  // namespace
}  // namespace glint
