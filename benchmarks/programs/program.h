// The programs that measure Glint share this: their main function, options and the statistics that they
// print.
#pragma once

#include <glint/result.h>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <vector>

namespace glint::benchmarks {

// Pixels of a picture.
struct Size {
    std::uint32_t width = 0;
    std::uint32_t height = 0;

    double aspect() const {
        return static_cast<double>(width) / height;
    }
};

inline void addSizeOptions(CLI::App& app, Size& size) {
    app.add_option("--width", size.width, "pixels")->capture_default_str();
    app.add_option("--height", size.height, "pixels")->capture_default_str();
}

inline void addRoundsOption(CLI::App& app, int& rounds, const char* help) {
    app.add_option("--rounds", rounds, help)->check(CLI::Range(1, 10'000))->capture_default_str();
}

// Returns the quantile of measured values, of which there must be some.
template <typename Value>
Value quantile(std::vector<Value> values, double share) {
    std::ranges::sort(values);
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

// Reads the command line into what the options of `app` refer to, and calls `run`. Returns the exit code. An
// error is printed.
template <typename Run>
int runProgram(CLI::App& app, int count, char** words, const Run& run) {
    CLI11_PARSE(app, count, words);
    try {
        const Status status = run();
        if (status) {
            return 0;
        }
        fmt::print(stderr, "{}\n", toString(status.error()));
    } catch (const std::exception& error) {
        fmt::print(stderr, "{}: {}\n", std::filesystem::path(words[0]).filename().string(), error.what());
    }
    return 1;
}

}  // namespace glint::benchmarks
