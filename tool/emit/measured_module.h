// SPIR-V of one shader, with its statistics.
#pragma once

#include "cache/module_cache.h"
#include "spirv/compiler.h"

#include <glint/result.h>

#include <optional>
#include <span>
#include <string>

namespace glint::compiler {

// Compiles a shader, or the part that `link` says, and measures it. Has the errors of compileShader() and
// compilePart().
Result<CachedModule> compileMeasured(const ShaderSource& source, const ShaderCompileOptions& options,
                                     const std::optional<LinkNames>& link = {});

// Joins compiled parts, the one with the entry point first, on at most `jobs` threads. If a part can't be
// joined, `source` is compiled as a whole.
Result<CachedModule> joinMeasured(const ShaderSource& source, const ShaderCompileOptions& options,
                                  std::span<const CachedModule* const> parts, int jobs = 1);

// Returns a text that differs between compilers that may give different words for the same source.
std::string moduleCompiler();

}  // namespace glint::compiler
