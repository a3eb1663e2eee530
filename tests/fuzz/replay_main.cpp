// Runs a fuzz target over the files of folders, as a regression test that needs no libFuzzer.
#include "base/files.h"
#include "fuzz/fuzz_target.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

namespace fs = std::filesystem;

namespace {

std::vector<fs::path> filesOf(const fs::path& folder) {
    std::vector<fs::path> files;
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
        if (entry->is_regular_file()) {
            files.push_back(entry->path());
        }
    }
    std::ranges::sort(files);
    return files;
}

bool replay(const fs::path& file) {
    const glint::Result<glint::base::Bytes> bytes = glint::base::readFile(file);
    if (!bytes) {
        std::fprintf(stderr, "%s\n", glint::toString(bytes.error()).c_str());
        return false;
    }
    // The last line of a run that crashes names the file.
    std::printf("%s\n", file.filename().c_str());
    std::fflush(stdout);
    // The copy has exactly the file's size, so that a sanitizer detects reads beyond the end.
    const glint::base::Bytes copy(bytes->begin(), bytes->end());
    LLVMFuzzerTestOneInput(copy.data(), copy.size());
    return true;
}

}  // namespace

int main(int count, char** arguments) {
    std::size_t replayed = 0;
    for (int i = 1; i < count; ++i) {
        for (const fs::path& file : filesOf(arguments[i])) {
            if (!replay(file)) {
                return 1;
            }
            ++replayed;
        }
    }
    std::printf("%zu inputs\n", replayed);
    // A missing folder must not count as one without a crash.
    return replayed == 0 ? 1 : 0;
}
