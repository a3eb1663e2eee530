// Writes the pages of sample_report.h, and the report of the first, into a folder: write_sample_pages DIR
#include "page/sample_report.h"

#include <cstdio>
#include <filesystem>
#include <fstream>

int main(int argc, char** argv) {
    using glint::testing::SamplePage;
    if (argc != 2) {
        std::fputs("usage: write_sample_pages DIR\n", stderr);
        return 2;
    }
    const std::filesystem::path folder(argv[1]);
    std::filesystem::create_directories(folder);
    const std::pair<const char*, SamplePage> pages[] = {{"sample.html", glint::testing::samplePage()},
                                                        {"hostile.html", glint::testing::hostilePage()},
                                                        {"sparse.html", glint::testing::sparsePage()}};
    for (const auto& [name, page] : pages) {
        std::ofstream(folder / name, std::ios::binary) << glint::measure::makePage(page.report, page.images);
    }
    std::ofstream report(folder / "sample.json", std::ios::binary);
    report << pages[0].second.report.dump(1);
    return report.good() ? 0 : 1;
}
