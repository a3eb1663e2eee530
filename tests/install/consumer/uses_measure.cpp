// A program that evaluates measurements of its own, and asks which settings are worth measuring.
#include "settings/descriptor.h"

#include <glint/measure/settings.h>
#include <glint/measure/statistics.h>
#include <glint/measure/sweep.h>

#include <iostream>
#include <vector>

int main() {
    const std::vector<double> milliseconds{4.2, 4.0, 4.1, 4.4, 4.0, 4.3, 9.0};
    const glint::measure::Interval interval = glint::measure::intervalOf(milliseconds);
    // With seven values the confidence interval of the median is the whole range.
    if (interval.median != 4.2 || interval.low != 4.0 || interval.high != 9.0) {
        return 1;
    }
    const glint::compiler::Configuration usual =
        glint::compiler::configurationOf(glint::compiler::Settings());
    const std::vector<glint::measure::Setting> settings = glint::measure::settingsFor({}, usual, true);
    const std::vector<glint::compiler::Configuration> singles = glint::measure::singles(settings, usual);
    std::cout << settings.size() << " settings, " << singles.size() << " configurations\n";
    return settings.size() != glint::compiler::settingNames().size() || singles.empty() ? 1 : 0;
}
