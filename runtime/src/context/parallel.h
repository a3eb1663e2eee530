// Work on all threads of the machine.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <system_error>
#include <thread>
#include <vector>

namespace glint {

inline std::uint32_t threadsOfMachine() {
    return std::max(std::thread::hardware_concurrency(), 1U);
}

// Calls `work` for 0 to count - 1, in this order, on `threads` threads. If the system gives fewer, fewer are
// used.
template <typename Work>
void forEach(std::size_t count, const Work& work, std::uint32_t threads = threadsOfMachine()) {
    std::atomic<std::size_t> next{0};
    const auto take = [&] {
        for (std::size_t i = next++; i < count; i = next++) {
            work(i);
        }
    };
    std::vector<std::thread> helpers;
    for (std::uint32_t i = 1; i < std::min<std::size_t>(threads, count); ++i) {
        try {
            helpers.emplace_back(take);
        } catch (const std::system_error&) {
            break;  // no more threads: the existing ones do all the work
        }
    }
    take();
    for (std::thread& helper : helpers) {
        helper.join();
    }
}

}  // namespace glint
