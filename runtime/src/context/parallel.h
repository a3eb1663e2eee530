// Work on several threads, and exceptions that become errors.
#pragma once

#include <glint/context.h>
#include <glint/result.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace glint {

// Returns the exception that is being handled as an error: "memory-host" for std::bad_alloc, "threads" for
// std::system_error.
Diagnostic caughtError();

// Ends a function-try-block of a public function that returns a Result: no exception leaves the library.
#define GLINT_CATCH                    \
    catch (...) {                      \
        return ::glint::caughtError(); \
    }

inline std::uint32_t threadsOfMachine() {
    return std::max(std::thread::hardware_concurrency(), 1U);
}

// Calls `work` for 0 to count - 1, in this order, on `threads` threads. If the system gives fewer, fewer are
// used. The first exception ends the work, and is thrown when all threads have ended.
template <typename Work>
void forEach(std::size_t count, const Work& work, std::uint32_t threads = threadsOfMachine()) {
    std::atomic<std::size_t> next{0};
    std::atomic<bool> failed{false};
    std::exception_ptr failure;
    const auto take = [&] {
        try {
            for (std::size_t i = next++; i < count && !failed; i = next++) {
                work(i);
            }
        } catch (...) {
            if (!failed.exchange(true)) {
                failure = std::current_exception();
            }
        }
    };
    std::vector<std::thread> helpers;
    try {
        for (std::uint32_t i = 1; i < std::min<std::size_t>(threads, count); ++i) {
            helpers.emplace_back(take);
        }
    } catch (const std::exception&) {
        // No more threads: the existing ones do all the work.
    }
    take();
    for (std::thread& helper : helpers) {
        helper.join();
    }
    if (failure) {
        std::rethrow_exception(failure);
    }
}

// Calls both functions: as forEach() does with two threads, if `together`.
template <typename First, typename Second>
void callBoth(bool together, const First& first, const Second& second) {
    if (together) {
        forEach(
            2, [&](std::size_t i) { i == 0 ? first() : second(); }, 2);
    } else {
        first();
        second();
    }
}

// Runs jobs with HostServices::runJob, or on threads of its own, which it starts as jobs need them.
class Jobs {
public:
    explicit Jobs(const HostServices& services = {}) : run_(services.runJob), message_(services.message) {}
    // Waits for the jobs on threads of its own.
    ~Jobs();
    Jobs(const Jobs&) = delete;
    Jobs& operator=(const Jobs&) = delete;

    // `job` must not throw. Throws if the system gives no thread, or no memory.
    void run(std::function<void()> job);
    // Calls HostServices::message.
    void report(const Diagnostic& message) const;

private:
    void work();

    std::function<void(std::function<void()>)> run_;
    std::function<void(const Diagnostic&)> message_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<std::function<void()>> waiting_;
    std::size_t idle_ = 0;  // threads
    bool ends_ = false;
    std::vector<std::thread> threads_;
};

// Jobs that use an object, which has this as its last member.
class JobGroup {
public:
    explicit JobGroup(Jobs& jobs) : jobs_(&jobs), shared_(std::make_shared<Shared>()) {}
    // Waits for the jobs that have begun. The others do nothing when they run, if ever.
    ~JobGroup();
    JobGroup(const JobGroup&) = delete;
    JobGroup& operator=(const JobGroup&) = delete;

    // As Jobs::run().
    void run(std::function<void()> job);
    Jobs& jobs() const {
        return *jobs_;
    }

private:
    struct Shared {
        std::mutex mutex;
        std::condition_variable changed;
        std::uint32_t running = 0;
        bool ends = false;
    };
    Jobs* jobs_;
    std::shared_ptr<Shared> shared_;
};

}  // namespace glint
