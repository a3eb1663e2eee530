#include "base/suggest.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace glint {
namespace {

TEST(Suggest, DistanceCountsEdits) {
    EXPECT_EQ(editDistance("", ""), 0);
    EXPECT_EQ(editDistance("abc", ""), 3);
    EXPECT_EQ(editDistance("kitten", "sitting"), 3);
    EXPECT_EQ(editDistance("complie", "compile"), 1);  // a swap is one edit
    EXPECT_EQ(editDistance("--ouput", "--output"), 1);
}

TEST(Suggest, NearestIsNearEnough) {
    const std::vector<std::string> words{"compile", "compare", "explain"};
    EXPECT_EQ(nearest("complie", words), "compile");
    EXPECT_EQ(nearest("compre", words), "compare");
    EXPECT_EQ(nearest("xyz", words), "");
    EXPECT_EQ(nearest("", words), "");
    EXPECT_EQ(nearest(std::string(100'000, 'c'), words), "");
    EXPECT_EQ(suggestion("explian", words), "; did you mean explain?");
    EXPECT_EQ(suggestion("xyz", words), "");
}

}  // namespace
}  // namespace glint
