#include "emit/glsl/unit.h"

#include "emit/glsl/items.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace glint::compiler {

std::uint32_t GlslUnit::fileNumber(std::string_view file) {
    // Most lines come from the file of the line before.
    if (!lines_.empty() && files_[lines_.back().file] == file) {
        return lines_.back().file;
    }
    const auto found = std::ranges::find(files_, file);
    if (found == files_.end()) {
        files_.emplace_back(file);
        return static_cast<std::uint32_t>(files_.size() - 1);
    }
    return static_cast<std::uint32_t>(found - files_.begin());
}

void GlslUnit::add(std::string_view line, std::string_view file, int number) {
    const bool blank = trim(line).empty();
    if (blank && afterBlank_) {
        return;
    }
    afterBlank_ = blank;
    lines_.push_back({text_.size(), fileNumber(file), number});
    text_ += line;
    text_ += '\n';
}

void GlslUnit::add(const GlslUnit& other, std::size_t first, std::size_t count) {
    for (std::size_t i = first; i < first + count; ++i) {
        add(other.line(i), other.file(i), other.number(i));
    }
}

std::string_view GlslUnit::line(std::size_t index) const {
    const std::size_t begin = lines_[index].begin;
    const std::size_t end = index + 1 < lines_.size() ? lines_[index + 1].begin : text_.size();
    return std::string_view(text_).substr(begin, end - begin - 1);
}

std::string GlslUnit::withPlaces() const {
    std::string placed;
    placed.reserve(text_.size() + text_.size() / 8);
    bool sawVersion = false;
    // The place that a compiler assumes for the next line.
    std::uint32_t nextFile = 0;
    int nextNumber = 0;
    for (std::size_t i = 0; i < lines_.size(); ++i) {
        const std::string_view text = line(i);
        const Line& place = lines_[i];
        const bool isVersion = !sawVersion && parseDirective(text).word == "version";
        const bool follows = place.number == nextNumber && place.file == nextFile;
        if (sawVersion && !follows && !trim(text).empty()) {
            fmt::format_to(std::back_inserter(placed), "#line {} \"{}\"\n", place.number, files_[place.file]);
            nextFile = place.file;
            nextNumber = place.number;
        }
        placed += text;
        placed += '\n';
        ++nextNumber;
        if (isVersion) {
            placed += "#extension GL_GOOGLE_cpp_style_line_directive : require\n";
            sawVersion = true;
            nextNumber = 0;
        }
    }
    return placed;
}

}  // namespace glint::compiler
