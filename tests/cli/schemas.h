// Holds JSON to the schemas in docs/schemas.
#pragma once

#include <nlohmann/json.hpp>

#include <string>

namespace glint::testing {

// docs/schemas/<name>.json
nlohmann::json readSchema(const std::string& name);

// Fails the test, with every violation, where `document` does not fit docs/schemas/<name>.json.
void expectFits(const std::string& name, const nlohmann::json& document);

// Whether it fits, without a word.
bool fits(const std::string& name, const nlohmann::json& document);

}  // namespace glint::testing
