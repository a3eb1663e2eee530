// The JSON of the bench, of calibrations, devices and views (docs/schemas).
#pragma once

#include "base/fields.h"

#include <glint/measure/calibration_report.h>
#include <glint/measure/report.h>

namespace glint::measure {

base::Fields fieldsOf(const BenchMachine*);
base::Fields fieldsOf(const Interval*);
base::Fields fieldsOf(const CalibrationEntry*);
// Reads what is needed to fit costs to it. Values that follow from others, and those of the run, are not
// read.
base::Fields fieldsOf(const CalibrationReport*);
base::Fields fieldsOf(const BenchReport*);

// These stand in device_file.cpp and views/view.cpp.
struct DeviceFile;
base::Fields fieldsOf(const DeviceFile*);
struct View;
base::Fields fieldsOf(const View*);

}  // namespace glint::measure
