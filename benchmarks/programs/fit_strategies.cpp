// glint_fit_strategies: fits a device file again to the measurements of `glint bench --calibrate`. It is for
// benchmarks/fit_strategy_costs.py, and for changes of the model in plan/strategy_cost.h.
#include "base/files.h"
#include "cli/bench/bench.h"
#include "program.h"

#include <glint/measure/device_file.h>

#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

namespace glint {

namespace {

Status fitFile(const std::string& points, const std::string& device) {
    GLINT_TRY(auto read, measure::readCalibrationPoints(points));
    std::vector<Diagnostic> notes;
    const Result<measure::DeviceFile> fitted = measure::fitDevice(std::move(read.device), read.points, notes);
    for (const Diagnostic& note : notes) {
        fmt::print(stderr, "{}\n", toString(note));
    }
    if (!fitted) {
        return fitted.error();
    }
    GLINT_TRY_DO(base::writeFile(device, toText(*fitted)));
    fmt::print("{}", cli::describe(*fitted));
    return okStatus();
}

}  // namespace

}  // namespace glint

int main(int count, char** words) {
    std::string points;
    std::string device;
    return glint::benchmarks::runProgram(
        "Fits a device file again to the measurements of `glint bench --calibrate`.",
        {{"points", &points, "the calibration.json of the measurements", glint::benchmarks::kNeeded},
         {"device", &device, "the device file to write", glint::benchmarks::kNeeded}},
        count, words, [&] { return glint::fitFile(points, device); });
}
