// The schemas in docs/schemas follow from the fields of types. GLINT_UPDATE_DOCUMENTS=1 in the environment
// writes them instead of comparing them.
#include "base/fields.h"
#include "cli/render/report.h"
#include "emit/package/manifest.h"
#include "gltf/document/material_list.h"
#include "inspect/pipelines.h"
#include "materials/declaration_members.h"
#include "resolve/profile.h"

#include <glint/measure/device_file.h>
#include <glint/measure/report.h>
#include <glint/session/edits.h>

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

namespace glint {
namespace {

using base::Json;

// A schema, or the part of one that a JSON pointer names.
struct Part {
    std::string file;
    std::string pointer;
    Json schema;
};

// The schema of a whole file that glint writes or reads.
Part fileOf(const char* file, const char* title, const Json& schema) {
    Json json{{"$schema", "http://json-schema.org/draft-07/schema#"}, {"title", title}};
    json.update(schema);
    return {file, "", json};
}

// The schema of what a command prints: a result with its diagnostics, or only these.
Part outputOf(const char* file, const char* title, Json schema) {
    schema["required"].push_back("diagnostics");
    schema["properties"]["diagnostics"] = {{"$ref", "common.json#/definitions/diagnostics"}};
    return fileOf(
        file, title,
        {{"anyOf", {{{"$ref", "common.json#/definitions/failure"}}, {{"$ref", "#/definitions/result"}}}},
         {"definitions", {{"result", std::move(schema)}}}});
}

std::vector<Part> parts() {
    using base::schemaOf;
    return {
        outputOf("bench", "glint bench --json; bench.json is the same without diagnostics",
                 schemaOf<measure::BenchReport>()),
        outputOf("calibration",
                 "glint bench --calibrate --json; calibration.json is the same without diagnostics",
                 schemaOf<measure::CalibrationReport>()),
        outputOf("render", "glint render --json; --stats writes the same without diagnostics",
                 schemaOf<cli::RenderReport>()),
        fileOf("edits", "The file of glint render --edits", schemaOf<session::EditList>()),
        fileOf("material_list", "A list of materials without a scene", schemaOf<gltf::MaterialSet>()),
        fileOf("device", "The device file of glint bench --calibrate", schemaOf<measure::DeviceFile>()),
        fileOf("gpu", "A table of --gpu", schemaOf<compiler::GpuCosts>()),
        fileOf("material_feature",
               "The declaration of a material feature; docs/material_features.md explains it",
               materials::declarationSchema()),
        fileOf("manifest", "manifest.json of a package", schemaOf<compiler::Manifest>()),
        fileOf("profile", "The file of glint render --profile", schemaOf<compiler::Profile>()),
        {"common", "/definitions/pipelineReport", schemaOf<inspect::PipelineReport>()},
    };
}

TEST(SchemaFiles, FollowFromTheFields) {
    for (const Part& part : parts()) {
        const std::string path = GLINT_SOURCE_DIR "/docs/schemas/" + part.file + ".json";
        std::ifstream stream(path);
        Json json = Json::parse(stream, nullptr, false);
        ASSERT_TRUE(json.is_object()) << path;
        Json& place = json[Json::json_pointer(part.pointer)];
        if (std::getenv("GLINT_UPDATE_DOCUMENTS") != nullptr) {
            place = part.schema;
            std::ofstream(path) << base::toText(json);
        }
        EXPECT_TRUE(place.dump() == part.schema.dump())
            << path << " does not follow from the fields; GLINT_UPDATE_DOCUMENTS=1 writes it anew";
    }
}

}  // namespace
}  // namespace glint
