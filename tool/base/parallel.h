// Runs work on several threads.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace glint::base {

// Runs work(0) … work(count - 1) on at most `jobs` threads (0: one for each core). They are started in order,
// and none is started after one has returned false or thrown. Work may wait for work that was started before
// it. What the first has thrown is thrown again when all have ended.
template <typename Work>
void runParallel(std::size_t count, int jobs, const Work& work) {
    std::atomic<std::size_t> next{0};
    std::atomic<bool> failed{false};
    std::mutex mutex;
    std::exception_ptr thrown;
    const auto loop = [&] {
        try {
            for (std::size_t i = next++; i < count && !failed; i = next++) {
                if (!work(i)) {
                    failed = true;
                }
            }
        } catch (...) {
            const std::scoped_lock lock(mutex);
            thrown = thrown ? thrown : std::current_exception();
            failed = true;
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
    threads.clear();  // waits for them
    if (thrown) {
        std::rethrow_exception(thrown);
    }
}

}  // namespace glint::base
