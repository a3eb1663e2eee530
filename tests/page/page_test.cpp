#include "measure/page.h"

#include "page/sample_report.h"

#include <gtest/gtest.h>

#include <regex>

namespace glint::testing {
namespace {

using Json = nlohmann::ordered_json;

std::string htmlOf(const SamplePage& page) {
    return measure::makePage(page.report, page.images);
}

std::size_t countOf(const std::string& text, const std::string& part) {
    std::size_t count = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
        ++count;
    }
    return count;
}

// Returns the content of the script element with this id.
Json dataOf(const std::string& html, const std::string& id) {
    const std::string open = "<script type=\"application/json\" id=\"" + id + "\">";
    const std::size_t start = html.find(open) + open.size();
    return Json::parse(html.substr(start, html.find("</script>", start) - start));
}

TEST(Page, HoldsTheReportAndTheImages) {
    const SamplePage sample = samplePage();
    const std::string html = htmlOf(sample);
    EXPECT_EQ(dataOf(html, "report-data"), sample.report);
    const Json images = dataOf(html, "image-data");
    ASSERT_EQ(images.size(), sample.images.size());
    EXPECT_GT(sample.images.size(), 100U);
    for (const measure::PageImage& image : sample.images) {
        EXPECT_EQ(images.at(image.name).get<std::string>().rfind("data:image/png;base64,iVBORw0KGgo", 0), 0U)
            << image.name;
    }
}

TEST(Page, EncodesEveryLengthOfImage) {
    const std::pair<std::string, std::string> cases[] = {{"", ""},
                                                         {"f", "Zg=="},
                                                         {"fo", "Zm8="},
                                                         {"foo", "Zm9v"},
                                                         {"foob", "Zm9vYg=="},
                                                         {"fooba", "Zm9vYmE="},
                                                         {"foobar", "Zm9vYmFy"}};
    for (const auto& [bytes, expected] : cases) {  // RFC 4648, section 10
        const measure::PageImage image{"a", base::Bytes(bytes.begin(), bytes.end())};
        const std::string html = measure::makePage(samplePage().report, std::span(&image, 1));
        EXPECT_EQ(dataOf(html, "image-data").at("a"), "data:image/png;base64," + expected);
    }
}

TEST(Page, IsOneDocumentWithEveryPart) {
    const std::string html = htmlOf(samplePage());
    for (const char* tag : {"<!DOCTYPE html>", "<style>", "</style>", "</body>", "</html>", "function main()",
                            "color-scheme"}) {
        EXPECT_EQ(countOf(html, tag), std::string(tag) == "color-scheme" ? countOf(html, "color-scheme") : 1U)
            << tag;
    }
    EXPECT_GE(countOf(html, "color-scheme"), 1U);
    EXPECT_EQ(countOf(html, "<script"), 3U);
    EXPECT_EQ(countOf(html, "</script>"), 3U);
    EXPECT_EQ(html.find("{{{"), std::string::npos);
}

// Nothing is fetched: the page contains no address except the name of SVG's elements, and its policy forbids
// fetching.
TEST(Page, RefersToNothingOutside) {
    const std::string html = htmlOf(samplePage());
    const std::regex address(R"((https?:)?//[a-z0-9.]+\.[a-z]{2,}[^\s"']*)");
    for (auto found = std::sregex_iterator(html.begin(), html.end(), address);
         found != std::sregex_iterator(); ++found) {
        EXPECT_EQ(found->str(), "http://www.w3.org/2000/svg");
    }
    EXPECT_NE(html.find("default-src 'none'"), std::string::npos);
    EXPECT_EQ(html.find("@import"), std::string::npos);
    EXPECT_FALSE(std::regex_search(html, std::regex(R"(url\(|<link[^>]*stylesheet|<script[^>]* src=)")));
}

TEST(Page, NamesStayData) {
    const SamplePage hostile = hostilePage();
    const std::string html = htmlOf(hostile);
    EXPECT_EQ(countOf(html, "<script"), 3U);
    EXPECT_EQ(countOf(html, "</script>"), 3U);
    EXPECT_EQ(html.find("<!-- <img"), std::string::npos);
    EXPECT_EQ(html.find("<img src=x"), std::string::npos);
    // Placeholders in a name are not filled in, and bytes that are not UTF-8 are replaced.
    const std::string name = dataOf(html, "report-data").at("scene").at("name");
    EXPECT_NE(name.find("</script><script>"), std::string::npos);
    EXPECT_NE(name.find("{{{css}}} {{report}}"), std::string::npos);
    EXPECT_NE(name.find("\xef\xbf\xbd"), std::string::npos);
}

TEST(Page, SameInputGivesTheSameBytes) {
    EXPECT_EQ(htmlOf(samplePage()), htmlOf(samplePage()));
    EXPECT_EQ(htmlOf(sparsePage()), htmlOf(sparsePage()));
}

}  // namespace
}  // namespace glint::testing
