// glint_fit_strategies: fits a device file again to the measurements of `glint bench --calibrate`. It is for
// benchmarks/fit_strategy_costs.py, and for changes of the model in plan/strategy_cost.h.
#include "base/files.h"
#include "cli/bench/bench.h"

#include <glint/measure/device_file.h>

#include <fmt/format.h>

#include <cstdio>
#include <exception>

namespace glint {

namespace {

int fail(const Diagnostic& error) {
    fmt::print(stderr, "{}\n", toString(error));
    return 1;
}

int fitFile(const char* points, const char* device) {
    Result<measure::CalibrationPoints> read = measure::readCalibrationPoints(points);
    if (!read) {
        return fail(read.error());
    }
    std::vector<Diagnostic> notes;
    const Result<measure::DeviceFile> fitted =
        measure::fitDevice(std::move(read->device), read->points, notes);
    for (const Diagnostic& note : notes) {
        fmt::print(stderr, "{}\n", toString(note));
    }
    if (!fitted) {
        return fail(fitted.error());
    }
    if (Status written = base::writeFile(device, toText(*fitted)); !written) {
        return fail(written.error());
    }
    fmt::print("{}", cli::describe(*fitted));
    return 0;
}

}  // namespace

}  // namespace glint

int main(int count, char** words) {
    if (count != 3) {
        fmt::print(stderr, "usage: glint_fit_strategies FOLDER/calibration.json DEVICE.json\n");
        return 2;
    }
    try {
        return glint::fitFile(words[1], words[2]);
    } catch (const std::exception& error) {
        fmt::print(stderr, "glint_fit_strategies: {}\n", error.what());
        return 1;
    }
}
