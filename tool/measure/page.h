// The page that shows the measurements of `glint bench`.
#pragma once

#include "base/files.h"

#include <nlohmann/json.hpp>

#include <span>
#include <string>

namespace glint::measure {

struct PageImage {
    std::string name;  // as the report names it: "images/000.png"
    base::Bytes png;
};

// Returns one HTML file that needs no other file and no network: it contains the report, the images that it
// refers to, the styles and the scripts. No text of the report is ever read as markup; bytes that are not
// UTF-8 become U+FFFD. The same input gives the same bytes.
std::string makePage(const nlohmann::ordered_json& report, std::span<const PageImage> images);

// Returns the files, sorted by name. They have static storage.
std::span<const base::BuiltinFile> pageFiles();

}  // namespace glint::measure
