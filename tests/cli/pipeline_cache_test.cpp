// Tests glint render --pipeline-cache: what it stores, and how it treats files that it did not write.
#include "base/files.h"
#include "cli/render_command.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

namespace glint::testing {
namespace {

namespace fs = std::filesystem;

class PipelineCacheFolder : public RenderCommand {
protected:
    nlohmann::json renderWith(const std::string& cache, const std::vector<std::string>& more = {}) const {
        std::vector<std::string> words{"--json", "--pipeline-cache", cache};
        words.insert(words.end(), more.begin(), more.end());
        const Outcome outcome = must(render("a.png", words));
        return outcome.json();
    }

    // Returns the file as if another machine had written it: everything is right except the device.
    static std::string ofAnotherDevice(std::string file) {
        constexpr std::size_t kDeviceAt = 16;
        constexpr std::size_t kChecksumAt = 56;
        constexpr std::size_t kHeaderBytes = 64;
        file[kDeviceAt] = static_cast<char>(file[kDeviceAt] ^ 1);
        std::memset(file.data() + kChecksumAt, 0, sizeof(std::uint64_t));
        const auto bytes = base::asBytes(file);
        const std::uint64_t sum =
            base::hashBytes(bytes.subspan(kHeaderBytes), base::hashBytes(bytes.first(kHeaderBytes)));
        std::memcpy(file.data() + kChecksumAt, &sum, sizeof(sum));
        return file;
    }

    static bool notes(const nlohmann::json& report, const std::string& id) {
        const nlohmann::json& list = report.at("diagnostics");
        return std::ranges::any_of(list, [&](const nlohmann::json& diagnostic) {
            return diagnostic.at("id") == id && diagnostic.at("severity") == "note";
        });
    }
};

TEST_F(PipelineCacheFolder, HasOneFileThatTheNextRunLoads) {
    const nlohmann::json first = renderWith("cache");
    const nlohmann::json& kept = first.at("pipelineCache");
    EXPECT_EQ(kept.at("loadedBytes"), 0);
    EXPECT_GT(kept.at("savedBytes"), 0);
    EXPECT_EQ(fs::file_size(path(kept.at("file").get<std::string>())), kept.at("savedBytes"));
    const nlohmann::json second = renderWith("cache");
    EXPECT_EQ(second.at("pipelineCache").at("file"), kept.at("file"));
    EXPECT_EQ(second.at("pipelineCache").at("loadedBytes"), kept.at("savedBytes"));
    EXPECT_FALSE(notes(second, "pipeline-cache"));
    EXPECT_EQ(std::distance(fs::directory_iterator(path("cache")), fs::directory_iterator()), 1);
}

TEST_F(PipelineCacheFolder, DamagedFilesAreNotedAndReplaced) {
    const nlohmann::json first = renderWith("cache");
    const fs::path file = path(first.at("pipelineCache").at("file").get<std::string>());
    const std::string whole = readText(file);
    std::string damaged = whole;
    damaged.back() = static_cast<char>(damaged.back() ^ 1);
    for (const std::string& text : {damaged, ofAnotherDevice(whole), whole.substr(0, whole.size() - 1),
                                    whole.substr(0, 10), std::string()}) {
        writeText(file, text);
        const nlohmann::json report = renderWith("cache");
        EXPECT_TRUE(notes(report, "pipeline-cache")) << text.size() << " bytes";
        EXPECT_EQ(has(report.at("diagnostics").dump(), "another device"), text == ofAnotherDevice(whole));
        EXPECT_EQ(report.at("pipelineCache").at("loadedBytes"), 0);
        EXPECT_GT(report.at("pipelineCache").at("savedBytes"), 0);
    }
    const nlohmann::json next = renderWith("cache");
    EXPECT_FALSE(notes(next, "pipeline-cache"));
    EXPECT_GT(next.at("pipelineCache").at("loadedBytes"), 0);
}

TEST_F(PipelineCacheFolder, WhereItCantBeWrittenANoteSaysSo) {
    writeText(path("file"), "x");
    const nlohmann::json report = renderWith("file/cache");
    EXPECT_TRUE(notes(report, "cache-write"));
    EXPECT_EQ(report.at("pipelineCache").at("savedBytes"), 0);
}

TEST_F(PipelineCacheFolder, NoneKeepsNothing) {
    EXPECT_TRUE(renderWith("none").at("pipelineCache").is_null());
    EXPECT_FALSE(fs::exists(path("none")));
}

TEST_F(PipelineCacheFolder, IsSharedByRunsAtTheSameTime) {
    const std::string script =
        "for i in 1 2 3 4; do\n"
        "  \"$0\" render \"$1\" -o $i.png --size 8x8 --pipeline-cache shared & pids=\"$pids $!\"\n"
        "done\n"
        "for pid in $pids; do wait $pid || exit 1; done";
    const Outcome outcome = must(runProgram({"sh", "-c", script, commandPath(), scene_}));
    EXPECT_EQ(outcome.err, "");
    EXPECT_EQ(std::distance(fs::directory_iterator(path("shared")), fs::directory_iterator()), 1);
    EXPECT_FALSE(notes(renderWith("shared"), "pipeline-cache"));
}

TEST_F(RenderCommand, ThreadsOfPipelinesAndTheStartAreReported) {
    const Outcome one = must(render("a.png", {"--json", "--pipeline-threads", "1"}));
    EXPECT_EQ(one.json().at("pipelineThreads"), 1);
    const Outcome three = must(render("b.png", {"--json", "--pipeline-threads", "3"}));
    EXPECT_EQ(three.json().at("pipelineThreads"), 3);
    EXPECT_EQ(readText(path("a.png")), readText(path("b.png")));
    const nlohmann::json start = three.json().at("start");
    double sum = start.at("texturesMs").get<double>();  // about 0 where there are none
    for (const char* part : {"deviceMs", "uploadMs", "rendererMs", "firstSampleMs"}) {
        EXPECT_GT(start.at(part).get<double>(), 0.0) << part;
        sum += start.at(part).get<double>();
    }
    EXPECT_NEAR(start.at("totalMs").get<double>(), sum, 1e-6 * sum);
    EXPECT_LE(three.json().at("pipelineCreationMs").get<double>(), start.at("rendererMs").get<double>());
}

// A driver that reports statistics of its pipelines gives a list; another driver gives a note.
TEST_F(RenderCommand, PipelineStatisticsAreListedOrANoteSaysWhyNot) {
    const Outcome outcome = must(render("a.png", {"--json", "--pipeline-statistics"}));
    const nlohmann::json report = outcome.json();
    const nlohmann::json& list = report.at("pipelineStatistics");
    const bool isNoted = has(report.at("diagnostics").dump(), "pipeline-statistics");
    EXPECT_EQ(list.is_null(), isNoted);
    if (!list.is_null()) {
        EXPECT_EQ(list.size(), report.at("footprint").at("pipelines").get<std::size_t>());
    }
}

}  // namespace
}  // namespace glint::testing
