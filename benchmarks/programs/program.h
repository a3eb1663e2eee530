// The programs that measure Glint share this: their main function, options and the statistics that they
// print.
#pragma once

#include <glint/result.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <variant>
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

// What an option's words have to be.
struct Demand {
    bool present = false;
    int least = 0;  // of a number; there is no bound unless `least` is less than `most`
    int most = 0;
};
constexpr Demand kNeeded{true};

// A value is left as it is if its option is not there, and `--help` shows it as the default.
struct Option {
    const char* name;  // without dashes it is a positional argument
    std::variant<bool*, int*, std::uint32_t*, std::size_t*, std::string*, std::vector<std::string>*> value;
    const char* help;
    Demand demand{};
};

Option widthOption(Size& size);
Option heightOption(Size& size);
Option roundsOption(int& rounds, const char* help);

// Returns the quantile of measured values, of which there must be some.
template <typename Value>
Value quantile(std::vector<Value> values, double share) {
    std::ranges::sort(values);
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

// Reads the command line into the values of `options`, and calls `run`. Returns the exit code. An error is
// printed.
int runProgram(const char* purpose, const std::vector<Option>& options, int count, char** words,
               const std::function<Status()>& run);

}  // namespace glint::benchmarks
