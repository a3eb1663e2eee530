// The table of docs/effects_accuracy.md.
#pragma once

namespace glint::oracle {

struct Subject;
struct Comparison;

// Prints the row at once. When the program ends, all rows are written as Markdown into effects_accuracy.md
// beside it.
void addRow(const Subject& subject, const Comparison& comparison);

}  // namespace glint::oracle
