#include "unit/emit/text_package.h"

#include "base/files.h"

#include <gtest/gtest.h>

#include <iterator>

namespace glint::testing {

namespace fs = std::filesystem;

compiler::CompiledPackage makePackage(const std::map<std::string, std::string>& contents) {
    compiler::CompiledPackage package;
    std::string list;
    for (const auto& [name, text] : contents) {
        package.files.push_back({name, base::Bytes(text.begin(), text.end())});
        list += list.empty() ? "" : ",";
        list += "{\"file\":\"";
        list += name;
        list += "\"}";
    }
    std::string manifest = "{\"format\":\"glint-package\",\"files\":[";
    manifest += list;
    manifest += "]}";
    package.files.push_back({package::kManifestFile, base::Bytes(manifest.begin(), manifest.end())});
    return package;
}

std::map<std::string, std::string> readFolder(const fs::path& folder) {
    std::map<std::string, std::string> contents;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        if (entry.is_regular_file()) {
            const auto bytes = base::readFile(entry.path());
            EXPECT_TRUE(bytes);
            contents[entry.path().lexically_relative(folder).generic_string()] =
                std::string(bytes->begin(), bytes->end());
        }
    }
    return contents;
}

std::size_t countEntries(const fs::path& folder) {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

}  // namespace glint::testing
