// Writes a package to a folder.
#pragma once

#include "emit/package/compiled_package.h"

#include <glint/result.h>

#include <filesystem>

namespace glint::compiler {

// Returns the error that writePackage() would have, as far as it can be known before there is a package: the
// folder holds something else, or takes no files. Leaves nothing behind.
Status checkPackageFolder(const std::filesystem::path& folder);

// Replaces the contents of `folder` by the package. Files that did not change keep their time stamps, and
// files of the earlier package that are no longer part of it are removed. tables.bin is written last, so that
// a reader never sees a mixture that passes its checks. A failure leaves the earlier package whole. It is an
// error if the folder holds something other than a package.
Status writePackage(const CompiledPackage& package, const std::filesystem::path& folder);

}  // namespace glint::compiler
