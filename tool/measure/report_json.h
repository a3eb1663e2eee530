// The JSON of the bench and of calibrations (docs/schemas).
#pragma once

#include "base/fields.h"

#include <glint/measure/calibration.h>
#include <glint/measure/report.h>

namespace glint::measure {

base::Fields fieldsOf(const BenchMachine*);
base::Fields fieldsOf(const Interval*);
base::Fields fieldsOf(const CalibrationEntry*);
// Reads what is needed to fit costs to it. Values that follow from others, and those of the run, are not read.
base::Fields fieldsOf(const CalibrationReport*);
base::Fields fieldsOf(const BenchReport*);

base::Fields fieldsOf(const DeviceFile*);  // in device_file.cpp

}  // namespace glint::measure
