// Fuzzes a list of materials.
#include "base/fields.h"
#include "fuzz/fuzz_target.h"
#include "fuzz/import_bytes.h"
#include "fuzz/schema_mutator.h"
#include "gltf/document/material_list.h"
#include "materials/material_model.h"

const glint::fuzz::InputSchema& glint::fuzz::inputSchema() {
    static const InputSchema kSchema = [] {
        InputSchema schema{base::schemaOf<gltf::MaterialSet>(),
                           {"metallicRoughness", "specularGlossiness", "NORMAL", "TANGENT", "TEXCOORD_0",
                            "TEXCOORD_1", "COLOR_0", "OPAQUE", "MASK", "BLEND"}};
        const materials::MaterialModel& model = materials::builtinMaterialModel();
        for (const materials::Parameter& parameter : model.parameters) {
            schema.words.push_back(parameter.name);
        }
        for (const materials::Feature& feature : model.features) {
            schema.words.push_back(feature.name);
        }
        return schema;
    }();
    return kSchema;
}

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    glint::fuzz::importBytes({data, size}, "materials.json");
    return 0;
}
