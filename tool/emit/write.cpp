#include "emit/compile.h"

namespace glint {
Status writePackage(const CompiledPackage&, const std::filesystem::path&) { return okStatus(); }
}
