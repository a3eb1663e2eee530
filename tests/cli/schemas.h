// Checks JSON against the schemas in docs/schemas.
#pragma once

#include <nlohmann/json.hpp>

#include <string>

namespace glint::testing {

// Returns docs/schemas/<name>.json.
nlohmann::json readSchema(const std::string& name);

// Fails the test, with every violation, if `document` does not match docs/schemas/<name>.json.
void expectFits(const std::string& name, const nlohmann::json& document);

// Returns whether it matches, without failing the test.
bool fits(const std::string& name, const nlohmann::json& document);

}  // namespace glint::testing
