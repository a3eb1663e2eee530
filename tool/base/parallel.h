// Runs work on several threads.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#ifdef __linux__
#include <sys/resource.h>
#endif

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

// Runs `work` on a thread that others interrupt more often, as do the threads that it starts (on Linux;
// elsewhere it runs as usual). Returns its result, or throws its exception. For work that is less urgent than
// other work at the same time.
template <typename Work>
auto runBehind(const Work& work) {
    std::optional<decltype(work())> result;
    std::exception_ptr thrown;
    const auto run = [&] {
#ifdef __linux__
        // On Linux a nice value belongs to a thread, and the threads that it starts inherit it. A thread may
        // not take it back, so this needs one of its own.
        constexpr int kNice = 5;
        setpriority(PRIO_PROCESS, 0, getpriority(PRIO_PROCESS, 0) + kNice);
#endif
        try {
            result = work();
        } catch (...) {
            thrown = std::current_exception();
        }
    };
    try {
        std::jthread(run).join();
    } catch (const std::system_error&) {
        result = work();  // no more threads can be created
    }
    if (thrown) {
        std::rethrow_exception(thrown);
    }
    return std::move(*result);
}

}  // namespace glint::base
