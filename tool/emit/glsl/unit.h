// GLSL as the passes of the emitter hand it on: its lines, and where each of them comes from.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace glint::compiler {

// The text of one shader without #include and #line.
class GlslUnit {
public:
    // Adds a line, which has no line break. `file` is named as an #include names it; `number` counts from 1.
    // A blank line at the start, or after a blank line, is left out.
    void add(std::string_view line, std::string_view file, int number);
    // Adds lines of another unit.
    void add(const GlslUnit& other, std::size_t first, std::size_t count);

    // The lines, each with a line break.
    const std::string& text() const {
        return text_;
    }
    // Returns the lines for a compiler: GL_GOOGLE_cpp_style_line_directive is asked for after #version, and a
    // #line directive stands wherever a line does not follow the one before it, so that messages name the
    // real place. A unit without #version has no directives.
    std::string withPlaces() const;

    std::size_t size() const {
        return lines_.size();
    }
    // The index is less than size(). Views live until the unit changes.
    std::string_view line(std::size_t index) const;
    std::string_view file(std::size_t index) const {
        return files_[lines_[index].file];
    }
    int number(std::size_t index) const {
        return lines_[index].number;
    }

private:
    struct Line {
        std::size_t begin = 0;  // in text_
        std::uint32_t file = 0;
        int number = 0;
    };
    std::uint32_t fileNumber(std::string_view file);

    std::string text_;
    std::vector<Line> lines_;
    std::vector<std::string> files_;
    bool afterBlank_ = true;
};

}  // namespace glint::compiler
