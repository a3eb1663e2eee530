// GCC 12 sees overlapping copies within its own std::string::replace(), which valijson inlines (GCC bug
// 105651).
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wrestrict"
#endif

#include "cli/schemas.h"

#include <gtest/gtest.h>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validation_results.hpp>
#include <valijson/validator.hpp>

#include <fstream>

namespace glint::testing {

namespace {

using Adapter = valijson::adapters::NlohmannJsonAdapter;

nlohmann::json readFile(const std::string& file) {
    std::ifstream stream(std::string(GLINT_SOURCE_DIR "/docs/schemas/") + file);
    nlohmann::json json = nlohmann::json::parse(stream, nullptr, false);
    EXPECT_TRUE(json.is_object()) << file;
    return json;
}

// Returns what is wrong with the document, one line each, or an empty text.
std::string violations(const std::string& name, const nlohmann::json& document) {
    const nlohmann::json text = readSchema(name);
    valijson::Schema schema;
    valijson::SchemaParser parser;
    // References to other files are names only, because all files are in one folder.
    const auto fetch = [](const std::string& file) { return new nlohmann::json(readFile(file)); };
    const auto release = [](const nlohmann::json* json) { delete json; };
    parser.populateSchema(Adapter(text), schema, fetch, release);
    valijson::Validator validator;
    valijson::ValidationResults results;
    if (validator.validate(schema, Adapter(document), &results)) {
        return {};
    }
    std::string list;
    for (const valijson::ValidationResults::Error& error : results) {
        for (const std::string& step : error.context) {
            list += step;
        }
        list += ": " + error.description + "\n";
    }
    return list.empty() ? "it does not fit" : list;
}

}  // namespace

nlohmann::json readSchema(const std::string& name) {
    return readFile(name + ".json");
}

void expectFits(const std::string& name, const nlohmann::json& document) {
    const std::string found = violations(name, document);
    EXPECT_TRUE(found.empty()) << "docs/schemas/" << name << ".json\n" << found << document.dump(2);
}

bool fits(const std::string& name, const nlohmann::json& document) {
    return violations(name, document).empty();
}

}  // namespace glint::testing
