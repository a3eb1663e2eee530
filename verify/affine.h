// Affine forms: a value as a linear function of the inputs and an error. They know that terms with the same
// inputs cancel, which intervals do not (Comba and Stolfi 1993, "Affine Arithmetic and its Applications to
// Computer Graphics"). Here only the inputs are symbols. Nonlinear parts and rounding go into the error.
#pragma once

#include "verify/interval.h"
#include "verify/program.h"

#include <span>

namespace glint::verify {

// One form: |value - center - Σ slopes[d] x[d]| <= error for all x[d] in [-1, 1]. The slopes belong to the
// caller.
struct Affine {
    bool isValid = false;
    double center = 0.0;
    double error = 0.0;
    std::span<double> slopes;

    // Σ |slopes| + error.
    double radius() const;
    Interval range() const;
    // Sets it to a constant with an error that covers the interval; invalid if that is infinite.
    void set(const Interval& value);
};

// Each sets `result` to an enclosure of the real result for all values of the operands. `x` and `y` are
// intervals that enclose the operands too. `result` is not valid if an operand is not, or where no line is
// close.
void addAffine(const Affine& a, const Affine& b, double signOfB, Affine& result);
void multiplyAffine(const Affine& a, const Affine& b, Affine& result);
void squareAffine(const Affine& a, Affine& result);
void divideAffine(const Affine& a, const Affine& b, const Interval& y, std::span<double> scratch,
                  Affine& result);
void applyAffine(Function function, const Affine& a, const Interval& x, Affine& result);
void powerAffine(const Affine& a, const Interval& x, double exponent, Affine& result);
// max(a, b), and min(a, b) for sign -1; `difference` encloses a - b.
void maximumAffine(const Affine& a, const Affine& b, double sign, std::span<double> scratch, Affine& result);
void scaleAffine(const Affine& a, double factor, Affine& result);
void copyAffine(const Affine& a, Affine& result);
// Adds the error of rounding a result to the format, with so many further units in the last place.
void roundAffine(Affine& result, Format format, double furtherUnits);

}  // namespace glint::verify
