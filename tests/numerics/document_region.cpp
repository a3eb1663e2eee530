#include "document_region.h"

#include <fmt/format.h>

namespace glint::numerics {

Result<std::string> replaceRegion(const std::string& document, const std::string& name,
                                  const std::string& region) {
    const std::string first = fmt::format("<!-- begin {} -->\n", name);
    const std::string last = fmt::format("<!-- end {} -->", name);
    const std::size_t begin = document.find(first);
    const std::size_t end = document.find(last);
    if (begin == std::string::npos || end == std::string::npos || end < begin) {
        return makeError("report-marker", "", "the document lacks the markers of the generated region",
                         fmt::format("add the lines {}and {}", first, last));
    }
    return document.substr(0, begin + first.size()) + region + document.substr(end);
}

}  // namespace glint::numerics
