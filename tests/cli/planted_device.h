// Device files of devices that are not there.
#pragma once

#include <nlohmann/json.hpp>

#include <string>

namespace glint::testing {

// Of a device called "Planted" on which every strategy takes ten times as long as `fastest`.
nlohmann::json plantedDevice(const std::string& fastest);

}  // namespace glint::testing
