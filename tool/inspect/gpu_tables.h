// The tables of GPUs in benchmarks/data/gpus, which are compiled in.
#pragma once

#include "base/builtin_file.h"

#include <span>

namespace glint::inspect {

using base::BuiltinFile;

std::span<const BuiltinFile> gpuTables();

}  // namespace glint::inspect
