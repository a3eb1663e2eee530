#include "base/parallel.h"

#include <gtest/gtest.h>

#include <latch>
#include <new>
#include <thread>

namespace glint::base {
namespace {

TEST(RunParallel, ThrowsWhatAnotherThreadHasThrown) {
    const std::thread::id here = std::this_thread::get_id();
    std::latch both(2);
    const auto work = [&](std::size_t) {
        both.arrive_and_wait();
        if (std::this_thread::get_id() != here) {
            throw std::bad_alloc();
        }
        return true;
    };
    EXPECT_THROW(runParallel(2, 2, work), std::bad_alloc);
}

}  // namespace
}  // namespace glint::base
