#include "materials/declaration_files.h"
#include "materials/declarations.h"

#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <utility>
#include <vector>

namespace glint::materials {

namespace {

MaterialModel readBuiltinModel() {
    std::vector<DeclarationFile> files;
    for (const base::BuiltinFile& file : declarationFiles()) {
        files.push_back({file.name, file.text});
    }
    Result<MaterialModel> model = readDeclarations(files);
    if (!model) {
        // The build runs this before it finishes, so no installed library can come here.
        fmt::print(stderr, "{}\n", toString(model.error()));
        std::abort();
    }
    return std::move(*model);
}

}  // namespace

const MaterialModel& builtinMaterialModel() {
    static const MaterialModel kModel = readBuiltinModel();
    return kModel;
}

}  // namespace glint::materials
