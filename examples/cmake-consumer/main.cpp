// A program that is compiled together with its materials: the package is in the program itself, and in a
// folder beside it.
#include "cubes.h"
#include "cubes/glint_tables.h"
#include "cubes_package.h"
#include "picture.h"

#include <glint/context.h>

#include <algorithm>
#include <iostream>

namespace {

namespace tables = glint::scene_cubes;

int fail(const glint::Diagnostic& error) {
    std::cerr << glint::toString(error) << '\n';
    return 1;
}

void printShaders(const glint::Package& package) {
    std::cout << tables::kShaderCount << " shaders, " << tables::kBucketCount << " buckets\n";
    for (const glint::package::PrimitiveEntry& entry : package.scene(0).primitives) {
        std::cout << "material " << tables::kScenes[0].materialNames[entry.materialIndex] << ": shader "
                  << entry.shaderId << ' ' << package.string(package.cases()[entry.shaderId].name) << '\n';
    }
}

// Returns whether both packages have the same cases and the same materials.
bool areAlike(const glint::Package& one, const glint::Package& other) {
    return one.caseCount() == other.caseCount() &&
           std::ranges::equal(one.scene(0).materials.bytes, other.scene(0).materials.bytes);
}

}  // namespace

int main(int argc, char** argv) {
    const glint::Result<glint::Package> package = glint::Package::load(tables::embeddedPackage());
    if (!package) {
        return fail(package.error());
    }
    const glint::Result<glint::Package> fromFolder = glint::Package::load(GLINT_PACKAGE_CUBES);
    if (!fromFolder) {
        return fail(fromFolder.error());
    }
    if (package->caseCount() != tables::kShaderCount || !areAlike(*package, *fromFolder)) {
        std::cerr << "the package in the program is not the one in the folder\n";
        return 1;
    }
    printShaders(*package);
    if (argc < 2) {
        return 0;
    }

    const auto context = glint::Context::createHeadless();
    if (!context) {
        return fail(context.error());
    }
    const Cubes cubes;
    const glint::Result<glint::LinearImage> picture = renderPicture(**context, *package, cubes.view());
    if (!picture) {
        return fail(picture.error());
    }
    if (const glint::Status written = writePicture(*picture, argv[1]); !written) {
        return fail(written.error());
    }
    std::cout << "wrote " << argv[1] << '\n';
    return 0;
}
