// A small scene in memory, and a folder for a test's files.
#pragma once

#include "emit/compile.h"
#include "support/shared_modules.h"
#include "support/temporary_folder.h"

#include <filesystem>
#include <string_view>

namespace glint::testing {

// Returns a scene of four materials on one mesh of four triangles: plain; base colour texture; the same image
// as base colour and occlusion with a transform; unlit and masked.
gltf::Scene makeSampleScene();

// Compiles with small settings, and takes modules from the cache of the tests. Fails the test if that fails.
compiler::CompiledPackage compileSample(const compiler::CompileSettings& settings = {});

const compiler::PackageFile* findFile(const compiler::CompiledPackage& package, std::string_view name);
std::string_view textOf(const compiler::PackageFile* file);

using test::TemporaryFolder;

}  // namespace glint::testing
