#include "cli/companion.h"

#include <filesystem>
#include <system_error>
#include <unistd.h>

namespace glint::cli {

int startCompanion(const Console& console, const char* program, std::span<const char* const> line,
                   const Diagnostic& missing) {
    std::error_code error;
    const std::string path =
        (std::filesystem::read_symlink("/proc/self/exe", error).parent_path() / program).string();
    std::vector<char*> words{const_cast<char*>(path.c_str())};
    for (const char* const word : line) {
        words.push_back(const_cast<char*>(word));
    }
    words.push_back(nullptr);
    execv(path.c_str(), words.data());
    return fail(console, missing);
}

}  // namespace glint::cli
