// Device files of imaginary devices.
#pragma once

#include <nlohmann/json.hpp>

#include <string>

namespace glint::testing {

// Returns the file of a device called "Planted" on which every other strategy takes ten times as long as
// `fastest`.
nlohmann::json plantedDevice(const std::string& fastest);

}  // namespace glint::testing
