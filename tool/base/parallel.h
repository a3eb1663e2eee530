// Runs work on several threads.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <system_error>
#include <thread>
#include <vector>

namespace glint::base {

// Runs work(0) … work(count - 1) on at most `jobs` threads (0: one for each core). They are started in order,
// and none is started after one has returned false. Work may wait for work that was started before it.
template <typename Work>
void runParallel(std::size_t count, int jobs, const Work& work) {
    std::atomic<std::size_t> next{0};
    std::atomic<bool> failed{false};
    const auto loop = [&] {
        for (std::size_t i = next++; i < count && !failed; i = next++) {
            if (!work(i)) {
                failed = true;
            }
        }
    };
    const std::size_t wanted =
        jobs > 0 ? static_cast<std::size_t>(jobs) : std::max(1U, std::thread::hardware_concurrency());
    std::vector<std::jthread> threads;
    try {
        // This thread works too, so one thread fewer is started.
        for (std::size_t i = 1; i < std::min(wanted, count); ++i) {
            threads.emplace_back(loop);
        }
    } catch (const std::system_error&) {
        // No more threads can be created, so the existing ones do the work.
    }
    loop();
}

}  // namespace glint::base
