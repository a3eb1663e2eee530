#include "cli/bench_output.h"

#include "base/files.h"
#include "bench/page.h"
#include "cli/settings_file.h"
#include "image/compare.h"
#include "image/png.h"
#include "image/tone.h"

#include <fmt/format.h>

#include <set>
#include <string>
#include <system_error>
#include <vector>

namespace glint {

namespace {

namespace fs = std::filesystem;

constexpr const char* kImages = "images";

Status add(std::vector<PageImage>& pictures, const std::string& name, const DisplayImage& image) {
    Result<Bytes> png = encodePng(image, name);
    if (!png) {
        return png.error();
    }
    pictures.push_back({name, std::move(*png)});
    return okStatus();
}

DisplayImage shown(const LinearImage& image, double exposure) {
    DisplayImage display{image.width, image.height, {}};
    display.pixels.reserve(image.pixels.size());
    for (const std::array<float, 4>& pixel : image.pixels) {
        display.pixels.push_back(toDisplay({pixel[0], pixel[1], pixel[2]}, exposure));
    }
    return display;
}

Result<std::vector<PageImage>> picturesOf(const BenchReport& report) {
    const double exposure = report.reference.exposure;
    std::vector<PageImage> pictures;
    const LinearImage reference = exposed(report.reference.image, exposure);
    Status added = add(pictures, kReferenceImage, shown(report.reference.image, exposure));
    for (std::size_t i = 0; added && i < report.points.size(); ++i) {
        const LinearImage& image = report.points[i].image;
        added = add(pictures, imageName(i), shown(image, exposure));
        if (added) {
            added = add(pictures, errorImageName(i), differenceMap(exposed(image, exposure), reference));
        }
    }
    return added ? Result(std::move(pictures)) : Result<std::vector<PageImage>>(added.error());
}

// Of an earlier bench that had more configurations.
void removeOthers(const fs::path& folder, const std::vector<PageImage>& pictures) {
    std::set<std::string> names;
    for (const PageImage& picture : pictures) {
        names.insert(fs::path(picture.name).filename().string());
    }
    std::error_code ignored;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder / kImages, ignored)) {
        if (entry.path().extension() == ".png" && !names.contains(entry.path().filename().string())) {
            fs::remove(entry.path(), ignored);
        }
    }
}

}  // namespace

Status checkBenchFolder(const fs::path& folder) {
    std::error_code error;
    const fs::file_status status = fs::status(folder, error);
    if (fs::exists(status) && !fs::is_directory(status)) {
        return makeError("bench-folder", folder.string(), "is a file, not a folder", "give another -o");
    }
    if (fs::exists(status) && !fs::is_empty(folder, error) && !fs::exists(folder / kReportFile, error)) {
        return makeError("bench-folder", folder.string(), "holds something else than a bench",
                         "give an empty folder, one that is not there yet, or that of an earlier bench");
    }
    fs::path parent = fs::absolute(folder, error);
    while (!parent.empty() && !fs::exists(parent, error) && parent != parent.parent_path()) {
        parent = parent.parent_path();
    }
    if (!fs::is_directory(parent, error)) {
        return makeError("bench-folder", folder.string(),
                         fmt::format("can't be made: {} is no folder", parent.string()), "give another -o");
    }
    return okStatus();
}

Status writeBench(const BenchReport& report, const fs::path& folder) {
    const Result<std::vector<PageImage>> pictures = picturesOf(report);
    if (!pictures) {
        return pictures.error();
    }
    std::error_code error;
    fs::create_directories(folder / kImages, error);
    if (error) {
        return makeError("bench-folder", folder.string(), "can't be made: " + error.message(),
                         "give another -o");
    }
    for (const PageImage& picture : *pictures) {
        if (Status written = writeFile(folder / picture.name, picture.png); !written) {
            return written;
        }
    }
    if (report.advice && report.advice->point) {
        bench::Configuration settings = report.base;
        for (const auto& [name, value] : report.points[*report.advice->point].configuration) {
            settings[name] = value;
        }
        if (Status written = writeFile(folder / kSettingsFile, settingsText(settings, report.command));
            !written) {
            return written;
        }
    }
    const Json json = toJson(report);
    if (Status written = writeFile(folder / kReportFile, toText(json)); !written) {
        return written;
    }
    if (Status written = writeFile(folder / kPageFile, makePage(json, *pictures)); !written) {
        return written;
    }
    removeOthers(folder, *pictures);
    return okStatus();
}

}  // namespace glint
