// Files that a page of the documents prints.
#pragma once

#include "base/files.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>

namespace glint::test {

// Returns the code of a page that stands below a line with the file's name in bold: "**wax/wax.json**".
inline std::string printedFile(std::string_view page, const std::string& name) {
    const std::size_t title = page.find("**" + name + "**");
    const std::size_t begin = page.find('\n', page.find("```", title)) + 1;
    return title == std::string_view::npos ? ""
                                           : std::string(page.substr(begin, page.find("```", begin) - begin));
}

// Writes files below `folder` as the page in docs/ prints them. Fails the test if it lacks one.
inline void writePrintedFiles(const std::string& page, const std::filesystem::path& folder,
                              std::initializer_list<const char*> names) {
    const Result<base::Bytes> bytes = base::readFile(std::filesystem::path(GLINT_SOURCE_DIR "/docs") / page);
    ASSERT_TRUE(bytes);
    const std::string_view text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
    for (const char* const name : names) {
        const std::string file = printedFile(text, name);
        ASSERT_FALSE(file.empty()) << page << " does not print " << name;
        std::filesystem::create_directories((folder / name).parent_path());
        ASSERT_TRUE(base::writeFile(folder / name, file));
    }
}

}  // namespace glint::test
