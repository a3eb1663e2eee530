// The page that shows what `glint bench` measured.
#pragma once

#include "base/files.h"

#include <nlohmann/json.hpp>

#include <span>
#include <string>

namespace glint {

struct PageImage {
    std::string name;  // as the report refers to it: "images/000.png"
    Bytes png;
};

// One HTML file that needs no other and opens without a network: the report, the images that it refers to,
// the styles and the scripts are all in it. No text of the report is ever read as markup; bytes of it that
// are not UTF-8 become U+FFFD. The same input gives the same bytes.
std::string makePage(const nlohmann::ordered_json& report, std::span<const PageImage> images);

}  // namespace glint
